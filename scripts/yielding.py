#!/usr/bin/env python3
"""Beams that yield: which element, how many fibres, which step, which iteration.

    scripts/yielding.py --elements   rules of integration and orders against error, portal_and_block
    scripts/yielding.py --fibres     fibres against error, portal_and_block
    scripts/yielding.py --steps      time step against error, portal_and_block, with the slope
    scripts/yielding.py --methods    tangent stiffness, initial load and auto, portal_and_block and a frame of ten storeys

Errors are the root mean square over all output times, relative to the largest displacement. Python's standard library only.
"""

import math
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

from scenes import SCENES, Scene, build, run

PORTAL = SCENES["C4"]


class Measured(NamedTuple):
    """The fastest of some runs."""

    history: list[list[float]]
    loop: float
    counts: dict


def measured(scene: Scene, deck: Path, sets: list[str], repeats: int = 3) -> Measured:
    with tempfile.TemporaryDirectory() as folder:
        runs = [run(deck, sets + ["expect=[]"], Path(folder)) for _ in range(repeats)]
        history = scene.history(Path(folder))
    return Measured(history, min(r.loop_s for r in runs), runs[0].report["counts"])


def error(found: list[list[float]], reference: list[list[float]]) -> float:
    assert len(found) == len(reference)
    largest = max(math.hypot(*row) for row in reference)
    squares = sum((a - b) ** 2 for f, r in zip(found, reference) for a, b in zip(f, r))
    return math.sqrt(squares / len(reference)) / largest


def portal(*sets: str, repeats: int = 3) -> Measured:
    return measured(PORTAL, PORTAL.deck, list(sets), repeats)


def elements() -> None:
    reference = PORTAL.reference()
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
                made = portal(
                    f"beams.portal.elements={count}",
                    f"beams.portal.order={order}",
                    f"beams.portal.points={order + more}",
                    f'beams.portal.integration="{rule}"',
                    "sections.square.fibres=[2,40]",
                    repeats=1,
                )
                cells.append(f"{error(made.history, reference):.1e} ({made.loop:.2f} s)")
            print(f"| {order} | {count} | " + " | ".join(cells) + " |", flush=True)


def fibres() -> None:
    reference = PORTAL.reference()
    print("| fibres over the height | error | loop s |\n|---|---|---|")
    for count in (4, 6, 8, 10, 12, 16, 20, 24, 40):
        made = portal(f"sections.square.fibres=[2,{count}]", "beams.portal.elements=16")
        print(f"| {count} | {error(made.history, reference):.1e} | {made.loop:.3f} |", flush=True)


def steps() -> None:
    """Against the same mesh with a step of a fortieth of the output interval."""
    finest = portal("analysis.time_step=3.75e-5", repeats=1).history
    print("| time step | error | slope | loop s |\n|---|---|---|---|")
    last = None
    for division in (1, 2, 4, 8, 16):
        made = portal(f"analysis.time_step={1.5e-3 / division}")
        size = error(made.history, finest)
        slope = f"{math.log2(last / size):.2f}" if last else ""
        last = size
        print(f"| {1.5e-3 / division:.3g} | {size:.1e} | {slope} | {made.loop:.3f} |", flush=True)


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
    for word in words:
        made = portal(f'iteration.method="{word}"')
        row("portal_and_block", word, made, error(made.history, PORTAL.reference()))
    tower = Scene("ten storeys", "", 0.05, lambda at: [at["p00_10"]["ux"], at["p21_10"]["uy"]])
    with tempfile.TemporaryDirectory() as folder:
        deck = Path(folder) / "deck.toml"
        deck.write_text(ten_storeys())
        finest = measured(tower, deck, ["analysis.time_step=1.25e-3"], 1).history
        for word in words:
            made = measured(tower, deck, [f'iteration.method="{word}"'])
            row("ten storeys", word, made, error(made.history, finest))


def row(scene: str, word: str, made: Measured, size: float) -> None:
    counts = made.counts
    print(
        f"| {scene} | {word} | {counts['iterations']} | {counts['factorizations']} | {made.loop:.3f} | {size:.2e} |",
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
