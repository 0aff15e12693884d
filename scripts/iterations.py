#!/usr/bin/env python3
"""Iterations, factorizations and time of the default iteration beside full Newton, over the decks and large sheets of shells.

    scripts/iterations.py                       all decks with an iteration, and the sheets
    scripts/iterations.py first hub_with_blades some of them
    scripts/iterations.py --program target/release/rdsolve --repeats 5

Full Newton is `update = "iteration"`. The last column is the time of the default over that of full Newton; a deck of less than 20 ms is
measured too coarsely to be counted. Python's standard library only.
"""

import argparse
import json
import statistics
import subprocess
import tempfile
from pathlib import Path
from typing import NamedTuple

from scenes import PROGRAM, ROOT

DECKS = ROOT / "decks"
LIMIT_S = 120.0
COARSE_S = 0.02
FULL = ["--set", 'iteration.update="iteration"']

SHEET = """
[analysis]
kind = "dynamic"
end_time = {end}
time_step = {step}
[integrator]
scheme = "{scheme}"
[materials.steel]
model = "elastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
density = 7850.0
[points]
a = [0.0, 0.0, 0.0]
b = [1.0, 0.0, 0.0]
c = [1.0, 1.0, 0.0]
d = [0.0, 1.0, 0.0]
[[shells]]
name = "sheet"
corners = ["a", "b", "c", "d"]
elements = {n}
thickness = 0.002
material = "steel"
[[supports]]
at = "sheet.edge1"
fix = "all"
[[loads]]
at = "sheet"
pressure = {pressure}
amplitude = "blow"
[output]
interval = {end}
[amplitudes.blow]
kind = "sine-squared"
frequency = 20.0
end = 0.05
"""


class Counts(NamedTuple):
    steps: int
    iterations: int
    factorizations: int
    loop_s: float


def measure(program: Path, deck: Path, sets: list[str], repeats: int) -> Counts | str:
    """The counts of a run and its least time; the outcome, where it does not come to its end."""
    least = None
    for _ in range(repeats):
        with tempfile.TemporaryDirectory() as folder:
            command = [str(program), str(deck), "-o", folder, "--quiet", "--overwrite", "--threads", "1", *sets]
            try:
                done = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT_S)
            except subprocess.TimeoutExpired:
                return f"over {LIMIT_S:.0f} s"
            report = Path(folder) / "result.json"
            if done.returncode not in (0, 1) or not report.exists():
                return f"exit {done.returncode}"
            found = json.loads(report.read_text())
        counts, loop = found["counts"], found["timings"]["loop_s"]
        least = loop if least is None else min(least, loop)
        last = Counts(counts["steps"], counts["iterations"], counts["factorizations"], least)
        if least > 2.0:
            break
    return last


def decks(names: list[str]) -> list[Path]:
    found = sorted(DECKS.glob("**/deck.toml"))
    return [deck for deck in found if not names or any(str(deck.relative_to(DECKS)).startswith(name) for name in names)]


def sheets(folder: Path) -> list[Path]:
    """Sheets of 1500, 15,000 and 60,000 unknowns that are struck so that they turn by some degrees, and far."""
    written = []
    for n in (16, 50, 100):
        for pressure in (2e3, 2e5):
            text = SHEET.format(n=n, end=0.02, step=5e-4, scheme="wilson-theta", pressure=pressure)
            path = folder / f"sheet_{n}_{pressure:.0e}.toml"
            path.write_text(text)
            written.append(path)
    return written


def compare(name: str, deck: Path, program: Path, repeats: int) -> float | None:
    """Prints the row of a deck; returns the ratio of times where it is long enough to tell."""
    default = measure(program, deck, [], repeats)
    if isinstance(default, str) or default.iterations == 0:
        return None
    full = measure(program, deck, FULL, repeats)
    row = f"| {name} | {default.steps} | {default.iterations / default.steps:.2f} | {default.factorizations / default.steps:.2f} | {default.loop_s:.4f} |"
    if isinstance(full, str):
        print(f"{row} {full} | | | |", flush=True)
        return None
    ratio = default.loop_s / full.loop_s
    print(
        f"{row} {full.steps} | {full.iterations / full.steps:.2f} | {full.factorizations / full.steps:.2f} | {full.loop_s:.4f} | {ratio:.2f} |",
        flush=True,
    )
    return ratio if max(default.loop_s, full.loop_s) > COARSE_S else None


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("decks", nargs="*", metavar="DECK")
    parser.add_argument("--program", type=Path, default=PROGRAM)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--sheets", action="store_true", help="the sheets alone")
    asked = parser.parse_args()
    print("| deck | steps | iterations a step | factorizations a step | loop s | full Newton: steps | iterations a step | factorizations a step | loop s | time / full Newton |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    ratios = []
    with tempfile.TemporaryDirectory() as folder:
        rows = [] if asked.sheets else [(str(deck.parent.relative_to(DECKS)), deck) for deck in decks(asked.decks)]
        if asked.sheets or not asked.decks:
            rows += [(sheet.stem, sheet) for sheet in sheets(Path(folder))]
        for name, deck in rows:
            ratios.append(compare(name, deck, asked.program, asked.repeats))
    told = [ratio for ratio in ratios if ratio is not None]
    if told:
        print(f"\nTime over full Newton in {len(told)} decks: median {statistics.median(told):.2f}, largest {max(told):.2f}")
