#!/usr/bin/env python3
"""Draws the pictures of docs/gallery.md: runs every deck with field files and takes `rdsolve report --picture` of its results.

    scripts/gallery.py [--rdsolve target/release/rdsolve] [--only PART_OF_NAME] [--jobs 2]

Python's standard library only; an optimised program needs some minutes.
"""

import argparse
import pathlib
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

ROOT = pathlib.Path(__file__).resolve().parent.parent
# Decks whose last time shows little: the time that shows the problem.
TIMES = {"reinforced_column": 6.0}
# Decks whose displacements are too small to see.
FACTORS = {}


def name(deck: pathlib.Path) -> str:
    """The folder of a deck below decks/, or its file where a folder holds several."""
    below = deck.relative_to(ROOT / "decks").as_posix()
    return below.removesuffix("/deck.toml").removesuffix(".toml")


def draw(program: str, deck: pathlib.Path) -> str:
    """Runs a deck and draws its picture; the reason where that fails."""
    picture = ROOT / "docs" / "gallery" / f"{name(deck)}.svg"
    picture.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        results = f"{folder}/{deck.parent.name}.out"
        run = [program, "run", str(deck), "-o", results, "--quiet", "--threads", "1", "--set", 'output.fields.format="vtu"']
        subprocess.run(run, cwd=ROOT, capture_output=True)  # a deck may fail by intention: its results are drawn up to there
        report = [program, "report", results, "--picture", "--width", "240", "-o", str(picture), "--overwrite"]
        for option, values in (("--time", TIMES), ("--magnify", FACTORS)):
            if name(deck) in values:
                report += [option, str(values[name(deck)])]
        drawn = subprocess.run(report, capture_output=True, text=True)
    return f"{name(deck)}: {(drawn.stdout or drawn.stderr).strip()}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rdsolve", default=str(ROOT / "target" / "release" / "rdsolve"))
    parser.add_argument("--only", default="")
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args()
    decks = [deck for deck in sorted((ROOT / "decks").rglob("*.toml")) if options.only in name(deck)]
    if not decks:
        sys.exit(f"no deck has `{options.only}` in its name")
    with ThreadPoolExecutor(options.jobs) as pool:
        for line in pool.map(lambda deck: draw(options.rdsolve, deck), decks):
            print(line, flush=True)


if __name__ == "__main__":
    main()
