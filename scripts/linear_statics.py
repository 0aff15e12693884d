#!/usr/bin/env python3
"""Linear statics of a plate beside CalculiX, and load cases per second.

    scripts/linear_statics.py PROGRAM [--runs 3] [--elements 100 204]

Both programs read one input file: a clamped plate of n by n four-node shells under pressure. CalculiX makes solids of them, and so has other
unknowns. Runs take turns, and the least time of each counts. Load cases share one factorization: the table has their time each.
"""

import argparse
import os
import pathlib
import resource
import subprocess
import tempfile
import time


def plate(n):
    """The input file of a clamped plate with n by n elements."""
    side = n + 1
    nodes = [f"{1 + i + side * j}, {i / n!r}, {j / n!r}, 0." for j in range(side) for i in range(side)]
    corners = lambda i, j: [1 + i + side * j, 2 + i + side * j, 2 + i + side * (j + 1), 1 + i + side * (j + 1)]
    cells = [", ".join(map(str, [1 + i + n * j, *corners(i, j)])) for j in range(n) for i in range(n)]
    edge = [1 + i + side * j for j in range(side) for i in range(side) if i in (0, n) or j in (0, n)]
    return "\n".join(
        ["*NODE, NSET=ALL", *nodes, "*ELEMENT, TYPE=S4, ELSET=PLATE", *cells, "*NSET, NSET=EDGE", *map(str, edge)]
        + ["*MATERIAL, NAME=STEEL", "*ELASTIC", "2.1E11, 0.3", "*SHELL SECTION, ELSET=PLATE, MATERIAL=STEEL", "0.01"]
        + ["*BOUNDARY", "EDGE, 1, 6", "*STEP", "*STATIC", "*DLOAD", "PLATE, P, 1000.", "*NODE FILE", "U", "*END STEP", ""]
    )


def timed(command, folder):
    """Wall and processor time of a command in seconds."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return time.perf_counter() - start, spent


def deflection(path):
    """The largest displacement in the first block of an frd file."""
    largest, inside = 0.0, False
    for line in path.read_text(errors="replace").splitlines():
        if line.startswith(" -4  DISP"):
            inside = True
        elif inside and line.startswith(" -1"):
            largest = max(largest, *(abs(float(line[13 + 12 * i : 25 + 12 * i])) for i in range(3)))
        elif inside and line.startswith(" -3"):
            break
    return largest


def with_cases(deck, count):
    """A deck with so many load cases, each a force at one node."""
    loads = "".join(
        f'\n[[loads]]\nname = "f{k}"\nat = "mesh.{100 + 7 * k}"\nforce = [0.0, 0.0, {1.0 + k}]\n'
        f'\n[[load_cases]]\nname = "c{k}"\nloads = "f{k}"\n'
        for k in range(count)
    )
    kept = deck[: deck.index("[[loads]]")] + deck[deck.index("[output]") :]
    lines = [line for line in kept.splitlines() if not line.startswith(("end_time", "time_step", "fields", "# "))]
    return "\n".join(lines) + "\n" + loads


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--elements", type=int, nargs="+", default=[100, 204])
    parser.add_argument("--cases", type=int, default=50)
    arguments = parser.parse_args()
    program = str(arguments.program.resolve())
    os.environ.setdefault("OMP_NUM_THREADS", "2")
    for n in arguments.elements:
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "plate.inp").write_text(plate(n))
            subprocess.run([program, "import", "plate.inp", "--from", "calculix"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
            (folder / "cases.toml").write_text(with_cases((folder / "plate.toml").read_text(), arguments.cases))
            (folder / "one.toml").write_text(with_cases((folder / "plate.toml").read_text(), 1))
            rows = {"rdsolve": [], "CalculiX": [], "cases": [], "one": []}
            for run in range(arguments.runs):
                rows["rdsolve"].append(timed([program, "plate.toml", "-o", f"r{run}"], folder))
                rows["CalculiX"].append(timed(["ccx", "plate"], folder))
                rows["cases"].append(timed([program, "cases.toml", "-o", f"c{run}"], folder))
                rows["one"].append(timed([program, "one.toml", "-o", f"o{run}"], folder))
            least = {key: [min(column) for column in zip(*times)] for key, times in rows.items()}
            each = (least["cases"][1] - least["one"][1]) / (arguments.cases - 1)
            ours, theirs = deflection(folder / "r0" / "fields.frd"), deflection(folder / "plate.frd")
            print(f"{n} by {n} elements, {6 * (n + 1) ** 2} unknowns: deflections {ours:.5e} and {theirs:.5e}")
            for key in ("rdsolve", "CalculiX"):
                print(f"  {key}: {least[key][0]:.2f} s, processor {least[key][1]:.2f} s")
            print(f"  each further load case: {each:.3f} s of a processor")


if __name__ == "__main__":
    main()
