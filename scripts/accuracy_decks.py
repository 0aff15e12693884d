#!/usr/bin/env python3
"""Automatic steps in decks of many kinds: the error reached, and the price beside equal steps.

    scripts/accuracy_decks.py                 all decks (some minutes)
    scripts/accuracy_decks.py rotating_blade  some of them

The reference is the same deck with automatic steps by 1e-5. Errors are root mean squares over 50 times, relative to the largest displacement of all
nodes and bodies. Equal steps are doubled in number from 50 on until they reach the error asked for. Python's standard library only.
"""

import argparse
import csv
import math
import subprocess
import tempfile
from pathlib import Path

import scenes
from scenes import ROOT, Run, run

ASKED = (1e-2, 1e-3)
# Decks and their duration.
DECKS = {
    "tossed_cylinder": 4.0,
    "spherical_cap/elastic": 1e-3,
    "colliding_balls": 0.02,
    "bouncing_ball": 2.0,
    "andrews_squeezer": 0.03,
    "rotating_blade": 12.0,
    "caught_by_a_rope": 1.6,
    "plucked_string": 0.199212182,
    "isolated_building": 12.0,
    "heavy_top": 2.0,
    "yielding_oscillator": 1.0,
}
INTERVALS = 50
MOST = 25_600
SCHEMES = ("wilson-theta", "esdirk3")

History = dict[str, dict[float, list[float]]]


def history(folder: Path) -> History:
    """Name -> time -> place, of bodies and of nodes other than the inner ones of parts."""
    found: History = {}
    for name in ("nodes.csv", "bodies.csv"):
        if not (folder / name).exists():
            continue
        with (folder / name).open(newline="") as file:
            for row in csv.DictReader(file):
                label = row.get("node") or row["body"]
                if not label.endswith("]"):
                    at = [float(row[key]) for key in ("x", "y", "z")]
                    found.setdefault(name + label, {})[round(float(row["time"]), 10)] = at
    return found


def error(own: History, exact: History) -> float:
    """The largest error of a node or body, relative to the largest displacement of all."""
    begins = {name: at[min(at)] for name, at in exact.items()}
    largest = max(math.dist(place, begins[name]) for name, at in exact.items() for place in at.values())
    errors = []
    for name, at in own.items():
        times = [time for time in at if time in exact[name]]
        errors.append(math.sqrt(sum(math.dist(at[time], exact[name][time]) ** 2 for time in times) / len(times)))
    return max(errors) / largest


def solved(deck: str, sets: list[str]) -> tuple[History, dict]:
    sets = [f"output={{interval={DECKS[deck] / INTERVALS!r}}}", "expect=[]", *sets]
    with tempfile.TemporaryDirectory() as folder:
        done: Run = run(ROOT / "decks" / deck / "deck.toml", sets, Path(folder))
        return history(done.folder), done.report


def automatic(deck: str, asked: float) -> tuple[History, dict]:
    return solved(deck, ['analysis.time_step="auto"', f"analysis.error_tolerance={asked}", 'integrator={scheme="esdirk3"}'])


def best_equal(deck: str, scheme: str, asked: float, exact: History) -> int | None:
    """The iterations of the longest equal steps that reach the error."""
    count = INTERVALS
    while count <= MOST:
        try:
            own, report = solved(deck, [f"analysis.time_step={DECKS[deck] / count!r}", f'integrator={{scheme="{scheme}"}}'])
            if error(own, exact) <= asked:
                return report["counts"]["iterations"]
        except (RuntimeError, subprocess.SubprocessError):
            pass  # Steps too long for the scene have no equilibrium.
        count *= 2
    return None


def table(decks: list[str]) -> None:
    print("| deck | asked | reached | estimated | steps | iterations: last run + others | over wilson-theta | over esdirk3 |")
    print("|---|---|---|---|---|---|---|---|")
    for deck in decks:
        exact, _ = automatic(deck, 1e-5)
        for asked in ASKED:
            own, report = automatic(deck, asked)
            found, last = report["step_error"], report["counts"]["iterations"]
            best = [best_equal(deck, scheme, asked, exact) for scheme in SCHEMES]
            ratios = ["" if one is None else f"{(last + found['other_iterations']) / one:.1f}" for one in best]
            estimate = "" if found["estimate"] is None else f"{found['estimate']:.1e}"
            print(
                f"| {deck} | {asked:.0e} | {error(own, exact):.1e} | {estimate} | {report['counts']['steps']} |"
                f" {last} + {found['other_iterations']} | {' | '.join(ratios)} |",
                flush=True,
            )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("decks", nargs="*", default=list(DECKS), metavar="DECK")
    parser.add_argument("--program", type=Path, help="instead of a new build")
    asked = parser.parse_args()
    if asked.program:
        scenes.PROGRAM = asked.program
    else:
        scenes.build()
    table(asked.decks)
