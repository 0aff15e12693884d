#!/usr/bin/env python3
"""What a user sees of each scheme where steps are too long: tables as Markdown.

    scripts/stability.py

Three scenes of the decks: the stiff chain of three masses (X1, decks/extreme/stiff_spring_chain), the stiff pendulum over ten periods
(X2, decks/extreme/stiff_pendulum) and the free body beside its separatrix over 50 s (R1, decks/free_body); then Wilson-theta on the
chain about its limit. Python's standard library only.
"""

import json
import subprocess
import tempfile
from pathlib import Path

from scenes import PROGRAM, ROOT, build, rows

SCHEMES = {
    "wilson-theta 1.4": '{scheme="wilson-theta"}',
    "newmark (trapezoidal)": '{scheme="newmark"}',
    "newmark, gamma 0.6": '{scheme="newmark",gamma=0.6}',
    "hht-alpha -0.05": '{scheme="hht-alpha"}',
    "hht-alpha -0.3": '{scheme="hht-alpha",alpha=-0.3}',
    "generalized-alpha 0.8": '{scheme="generalized-alpha"}',
    "generalized-alpha 0.5": '{scheme="generalized-alpha",spectral_radius=0.5}',
    "generalized-alpha 0": '{scheme="generalized-alpha",spectral_radius=0.0}',
    "bathe": '{scheme="bathe"}',
}

CHAIN, PENDULUM, BODY = "extreme/stiff_spring_chain", "extreme/stiff_pendulum", "free_body"
WEIGHT = 3.0 * 9.8 * 3.0443
"""m g L of the pendulum."""


class Failed(Exception):
    """The run ended before its end, at this time."""


def simulate(deck: str, sets: list[str], folder: Path) -> list[str]:
    """Runs a deck without its expected values; returns the warnings."""
    arguments = [str(PROGRAM), str(ROOT / "decks" / deck / "deck.toml"), "-o", str(folder), "--quiet", "--overwrite"]
    for entry in sets + ["expect=[]"]:
        arguments += ["--set", entry]
    subprocess.run(arguments, capture_output=True)
    report = json.loads((folder / "result.json").read_text())
    if report["status"] != "done":
        raise Failed(report["reason"].split(":")[0])
    return report["warnings"]


def column(folder: Path, table: str, name: str, keys: list[str]) -> list[list[float]]:
    history = rows(folder / table)
    return [[history[time][name][key] for key in keys] for time in sorted(history)]


def chain(scheme: str, folder: Path) -> list[str]:
    """a2 after steps 1, 2, 3, its largest size in the first ten steps, and that in the last ten of 200."""
    simulate(CHAIN, [f"integrator={scheme}"], folder)
    a = [row[0] for row in column(folder, "nodes.csv", "m2", ["ax"])]
    first = [f"{value:.2f}" for value in a[1:4]]
    return first + [f"{max(map(abs, part)):.3g}" for part in (a[1:11], a[-10:])]


def pendulum(scheme: str, folder: Path, division: int) -> str:
    """Kinetic energy and weight over m g L: largest gain over ten periods, at 20 * division steps a period."""
    step = f"analysis.time_step={0.2066761 / division!r}"
    try:
        simulate(PENDULUM, [f"integrator={scheme}", step], folder)
    except Failed as failed:
        return f"ends {failed}"
    at = column(folder, "nodes.csv", "bob", ["vx", "vy", "vz", "z"])
    energies = [(1.5 * sum(v * v for v in row[:3]) + 3.0 * 9.8 * row[3]) / WEIGHT for row in at]
    return f"{max(energies):+.1e}, {energies[-1]:+.1e}"


def body(scheme: str, folder: Path, step: float) -> str:
    """Energy at the end over that at the start, less one."""
    simulate(BODY, [f"integrator={scheme}", f"analysis.time_step={step!r}", "output.interval=50.0"], folder)
    lines = (folder / "energy.csv").read_text().splitlines()
    kinetic = [float(line.split(",")[2]) for line in lines[1:]]
    return f"{kinetic[-1] / kinetic[0] - 1:+.1e}"


def limit(theta: float, folder: Path) -> list[str]:
    warnings = simulate(CHAIN, [f'integrator={{scheme="wilson-theta",theta={theta}}}'], folder)
    v = [abs(row[0]) for row in column(folder, "nodes.csv", "m2", ["vx"])]
    said = "yes" if any("unconditionally stable" in warning for warning in warnings) else "no"
    return [f"{theta}", said, f"{max(v[:11]):.3g}", f"{max(v[-10:]):.3g}"]


def table(head: list[str], lines: list[list[str]]) -> None:
    for line in [head, ["---"] * len(head)] + lines:
        print("| " + " | ".join(line) + " |")
    print()


def main() -> None:
    build()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        head = ["scheme", "a2 after steps 1", "2", "3", "largest in 10", "in the last 10 of 200"]
        table(head, [[label, *chain(scheme, folder)] for label, scheme in SCHEMES.items()])
        head = ["scheme", "X2: 20 steps a period", "80", "320", "R1: steps of 0.1", "of 0.025"]
        lines = [
            [label, *(pendulum(scheme, folder, n) for n in (1, 4, 16)), *(body(scheme, folder, dt) for dt in (0.1, 0.025))]
            for label, scheme in SCHEMES.items()
        ]
        table(head, lines)
        head = ["theta", "warned of", "largest v2 in 10 steps", "in the last 10 of 200"]
        table(head, [limit(theta, folder) for theta in (1.2, 1.3, 1.36, 1.37, 1.4)])


if __name__ == "__main__":
    main()
