#!/usr/bin/env python3
"""Beams that yield: which element, how many fibres, which step, which iteration.

    scripts/yielding.py --elements   rules of integration and orders against error, portal_and_block
    scripts/yielding.py --fibres     fibres against error, portal_and_block
    scripts/yielding.py --steps      time step against error, portal_and_block, with the slope
    scripts/yielding.py --methods    tangent stiffness, initial load and auto, portal_and_block and a frame of ten storeys

Errors are the root mean square over all output times, relative to the largest displacement. Python's standard library only.
"""

import csv
import math
import sys
import tempfile
from pathlib import Path

from scenes import ROOT, build, run

PORTAL = ROOT / "decks" / "portal_and_block"
COLUMNS = (("nodes.csv", "node", "knee_left", "ux"), ("bodies.csv", "body", "block", "x"))


def histories(folder: Path, columns) -> list[list[float]]:
    out = []
    for file, key, name, quantity in columns:
        with open(folder / file) as rows:
            out.append([float(row[quantity]) for row in csv.DictReader(rows) if row[key] == name])
    return out


def error(found: list[list[float]], reference: list[list[float]]) -> float:
    count = len(reference[0])
    assert all(len(column) == count for column in found)
    largest = max(math.hypot(*row) for row in zip(*reference))
    squares = sum((a - b) ** 2 for f, r in zip(found, reference) for a, b in zip(f, r))
    return math.sqrt(squares / count) / largest


def portal_reference() -> list[list[float]]:
    with open(PORTAL / "reference.csv") as rows:
        table = [[float(number) for number in row[1:]] for row in list(csv.reader(rows))[1:]]
    return [list(column) for column in zip(*table)]


class Measured:
    """The fastest of some runs of a deck."""

    def __init__(self, deck: Path, sets: list[str], columns, repeats: int = 3):
        with tempfile.TemporaryDirectory() as folder:
            runs = [run(deck, sets, Path(folder)) for _ in range(repeats)]
            self.histories = histories(Path(folder), columns)
        self.loop = min(r.loop_s for r in runs)
        self.counts = runs[0].report["counts"]


def portal(*sets: str, repeats: int = 3) -> Measured:
    return Measured(PORTAL / "deck.toml", list(sets), COLUMNS, repeats)


def elements() -> None:
    reference = portal_reference()
    rules = [("gauss", 0), ("lobatto", 0), ("gauss", 1), ("lobatto", 1)]
    names = {0: "order points", 1: "one more"}
    print("| order | elements a leg | " + " | ".join(f"{rule}, {names[more]}" for rule, more in rules) + " |")
    print("|---" * (2 + len(rules)) + "|")
    for order in (1, 2, 3, 4):
        for count in (12 // order, 24 // order, 48 // order):
            cells = []
            for rule, more in rules:
                if rule == "lobatto" and order + more < 3:
                    cells.append("")
                    continue
                measured = portal(
                    f"beams.portal.elements={count}",
                    f"beams.portal.order={order}",
                    f"beams.portal.points={order + more}",
                    f'beams.portal.integration="{rule}"',
                    "sections.square.fibres=[2,40]",
                    repeats=1,
                )
                cells.append(f"{error(measured.histories, reference):.1e} ({measured.loop:.2f} s)")
            print(f"| {order} | {count} | " + " | ".join(cells) + " |", flush=True)


def fibres() -> None:
    reference = portal_reference()
    print("| fibres over the height | error | loop s |\n|---|---|---|")
    for count in (4, 6, 8, 10, 12, 16, 20, 24, 40):
        measured = portal(f"sections.square.fibres=[2,{count}]", "beams.portal.elements=16")
        print(f"| {count} | {error(measured.histories, reference):.1e} | {measured.loop:.3f} |", flush=True)


def steps() -> None:
    """Against the same mesh with a step of a fortieth of the output interval."""
    finest = portal("analysis.time_step=3.75e-5", repeats=1).histories
    print("| time step | error | slope | loop s |\n|---|---|---|---|")
    last = None
    for division in (1, 2, 4, 8, 16):
        measured = portal(f"analysis.time_step={1.5e-3 / division}")
        size = error(measured.histories, finest)
        slope = f"{math.log2(last / size):.2f}" if last else ""
        last = size
        print(f"| {1.5e-3 / division:.3g} | {size:.1e} | {slope} | {measured.loop:.3f} |", flush=True)


def ten_storeys() -> str:
    """A space frame of two bays by one and ten storeys, shaken until it yields."""
    bays, depth, storeys = 2, 1, 10
    name = lambda i, j, k: f"p{i}{j}_{k}"
    grid = [(i, j) for i in range(bays + 1) for j in range(depth + 1)]
    text = [
        'title = "Ten storeys, shaken"',
        '[analysis]\nkind = "dynamic"\nend_time = 3.0\ntime_step = 1e-2',
        "[materials.steel]",
        'model = "elastic-plastic"\nyoungs_modulus = 210e9\npoisson_ratio = 0.3\ndensity = 7850.0',
        "yield_stress = 355e6\nhardening_modulus = 2e9",
        '[sections.column]\nshape = "box"\nwidth = 0.3\nheight = 0.3\nthickness = 0.012',
        '[sections.girder]\nshape = "i"\nheight = 0.36\nwidth = 0.17\nweb_thickness = 0.008\nflange_thickness = 0.0127',
        "[points]",
    ]
    text += [f"{name(i, j, k)} = [{6.0 * i}, {6.0 * j}, {3.0 * k}]" for k in range(storeys + 1) for i, j in grid]

    def beam(label: str, path: list[str], section: str, orientation: str) -> str:
        quoted = ", ".join(f'"{point}"' for point in path)
        return (
            f'[[beams]]\nname = "{label}"\npath = [{quoted}]\nelements = 2\nmaterial = "steel"\n'
            f'section = "{section}"\norientation = {orientation}'
        )

    for i, j in grid:
        path = [name(i, j, k) for k in range(storeys + 1)]
        text.append(beam(f"column_{i}{j}", path, "column", "[1.0, 0.0, 0.0]"))
    for k in range(1, storeys + 1):
        for j in range(depth + 1):
            path = [name(i, j, k) for i in range(bays + 1)]
            text.append(beam(f"along_{j}_{k}", path, "girder", "[0.0, 1.0, 0.0]"))
        for i in range(bays + 1):
            path = [name(i, j, k) for j in range(depth + 1)]
            text.append(beam(f"across_{i}_{k}", path, "girder", "[1.0, 0.0, 0.0]"))
    floors = ", ".join(f'"{name(i, j, k)}"' for k in range(1, storeys + 1) for i, j in grid)
    feet = ", ".join(f'"{name(i, j, 0)}"' for i, j in grid)
    text += [
        f"[[masses]]\nat = [{floors}]\nmass = 8e3",
        f'[[supports]]\nat = [{feet}]\nfix = "all"',
        '[amplitudes.shock]\nkind = "table"\npoints = [[0.0, 0.0], [0.3, 1.0], [0.9, -1.0], [1.2, 0.0]]',
        '[[environment.base_acceleration]]\ndirection = [1.0, 0.4, 0.0]\namplitude = "shock"\nscale = 9.0',
        "[output]\ninterval = 0.05",
    ]
    return "\n".join(text) + "\n"


def methods() -> None:
    print("| scene | method | iterations | factorizations | loop s | error |\n|---|---|---|---|---|---|")
    words = ("tangent-stiffness", "initial-load", "auto")
    sets = ["beams.portal.elements=8", "sections.square.fibres=[2,16]", "analysis.time_step=3.75e-4"]
    for word in words:
        measured = portal(*sets, f'iteration.method="{word}"')
        row("portal_and_block", word, measured, error(measured.histories, portal_reference()))
    with tempfile.TemporaryDirectory() as folder:
        deck = Path(folder) / "deck.toml"
        deck.write_text(ten_storeys())
        top = (("nodes.csv", "node", "p00_10", "ux"), ("nodes.csv", "node", "p21_10", "uy"))
        finest = Measured(deck, ["analysis.time_step=1.25e-3"], top, 1).histories
        for word in words:
            measured = Measured(deck, [f'iteration.method="{word}"'], top)
            row("ten storeys", word, measured, error(measured.histories, finest))


def row(scene: str, word: str, measured: Measured, size: float) -> None:
    counts = measured.counts
    print(
        f"| {scene} | {word} | {counts['iterations']} | {counts['factorizations']} | {measured.loop:.3f} | {size:.2e} |",
        flush=True,
    )


STUDIES = {"--elements": elements, "--fibres": fibres, "--steps": steps, "--methods": methods}

if __name__ == "__main__":
    chosen = sys.argv[1:] or list(STUDIES)
    if unknown := [word for word in chosen if word not in STUDIES]:
        sys.exit(f"unknown: {', '.join(unknown)}\n{__doc__}")
    build()
    for word in chosen:
        STUDIES[word]()
