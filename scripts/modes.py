#!/usr/bin/env python3
"""Modes of a large frame against ARPACK: scripts/modes.py PROGRAM [--storeys N] [--modes M]

Writes a space frame of N storeys with some 170,000 unknowns, finds its modes by PROGRAM, exports its matrices by a test of this
crate and finds the same modes by scipy (eigsh about a shift, with SuperLU). Prints the largest relative difference of ω² and both
times. The script makes its own environment in target/modes.
"""

import argparse
import csv
import os
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
HOME = ROOT / "target" / "modes"


def in_own_environment() -> None:
    """Goes on in the environment that has scipy, made where it is not there."""
    python = HOME / "bin" / "python"
    if Path(sys.prefix).resolve() == HOME.resolve():
        return
    if not python.exists():
        subprocess.run([sys.executable, "-m", "venv", str(HOME)], check=True)
        subprocess.run([str(python), "-m", "pip", "install", "-q", "scipy"], check=True)
    os.execv(python, [str(python), *sys.argv])


def frame(storeys: int, modes: int) -> str:
    """A building of 5 by 6 bays, braced by nothing, each member cut into elements of second order."""
    lines = [
        "[analysis]", 'kind = "modal"', f"modes = {modes}",
        "[materials.steel]", 'model = "elastic"', "youngs_modulus = 210e9", "poisson_ratio = 0.3", "density = 7850.0",
        "[sections.post]", 'shape = "rectangle"', "width = 0.4", "height = 0.3",
        "[sections.girder]", 'shape = "rectangle"', "width = 0.2", "height = 0.35",
        "[points]",
    ]
    name = lambda i, j, k: f"p{i}_{j}_{k}"
    for k in range(storeys + 1):
        for i in range(6):
            for j in range(7):
                lines.append(f"{name(i, j, k)} = [{5.0 * i}, {6.0 * j}, {3.5 * k}]")
    beams = []
    for k in range(1, storeys + 1):
        for i in range(6):
            for j in range(7):
                beams.append((name(i, j, k - 1), name(i, j, k), "post", "[1.0, 0.0, 0.0]"))
                if i < 5:
                    beams.append((name(i, j, k), name(i + 1, j, k), "girder", "[0.0, 1.0, 0.0]"))
                if j < 6:
                    beams.append((name(i, j, k), name(i, j + 1, k), "girder", "[1.0, 0.0, 0.0]"))
    for number, (a, b, section, orientation) in enumerate(beams):
        lines += [
            "[[beams]]", f'name = "b{number}"', f'path = ["{a}", "{b}"]', "elements = 4", "order = 2", 'material = "steel"',
            f'section = "{section}"', f"orientation = {orientation}",
        ]
    feet = ", ".join(f'"{name(i, j, 0)}"' for i in range(6) for j in range(7))
    lines += ["[[supports]]", f"at = [{feet}]", 'fix = "all"', "[output]", 'nodes = ["p0_0_1"]', "energy = false"]
    return "\n".join(lines) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--storeys", type=int, default=34)
    parser.add_argument("--modes", type=int, default=20)
    args = parser.parse_args()
    in_own_environment()
    import math

    import scipy.io
    from scipy.sparse.linalg import eigsh

    work = HOME / "work"
    work.mkdir(parents=True, exist_ok=True)
    deck = work / "frame.toml"
    deck.write_text(frame(args.storeys, args.modes))
    began = time.time()
    subprocess.run([args.program, str(deck), "-o", str(work / "frame.out"), "--overwrite", "--quiet"], check=True)
    print(f"program: {time.time() - began:.1f} s")
    with open(work / "frame.out" / "modes.csv") as file:
        ours = [float(row["angular_frequency"]) ** 2 for row in csv.DictReader(file)]
    export = [args.program, "check", str(deck), "--export-matrices", str(work)]
    subprocess.run(export, check=True, stdout=subprocess.DEVNULL)
    k, m = (scipy.io.mmread(work / file).tocsc() for file in ("K.mtx", "M.mtx"))
    began = time.time()
    theirs = sorted(eigsh(k, args.modes, m, sigma=0.5 * ours[0], which="LM", tol=1e-13, return_eigenvectors=False))
    print(f"eigsh: {time.time() - began:.1f} s, {k.shape[0]} unknowns, {k.nnz} entries")
    worst = max(abs(a / b - 1.0) for a, b in zip(ours, theirs))
    print(f"lowest {math.sqrt(ours[0]) / 2 / math.pi:.6f} Hz, largest relative difference of omega^2: {worst:.1e}")
    if worst > 1e-8:
        sys.exit(1)


if __name__ == "__main__":
    main()
