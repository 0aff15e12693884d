#!/usr/bin/env python3
"""Error against time of explicit and implicit steps in three blows; draws docs/pictures/explicit_or_implicit.svg.

    scripts/explicit_or_implicit.py              # ten minutes
    scripts/explicit_or_implicit.py panel box    # some of the scenes; draws nothing

A tractor's cab struck by a pendulum, a thin box dropped on an edge and a panel under a ball. The error of a run is the rms difference of
one displacement from that of the reference, over the largest change of it. The reference has Bathe's steps of a quarter of the shortest.
Explicit runs take the critical step; 2, 5 and 10 are multiples of it by mass scaling. Python's standard library only.
"""

import csv
import math
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

import precision
from scenes import ROOT, build, run


class Scene(NamedTuple):
    title: str
    deck: str
    sets: list
    table: str
    name: str
    column: str
    steps: list
    """Of the implicit schemes, the longest first."""
    interval: float
    """Of the rows that are compared."""
    nodes: str = "named"


PANEL = ["shells.plate.elements=16", "shells.plate.thickness=0.01", 'shells.plate.mass="lumped"', "bodies.ball.mass=5.0", "analysis.end_time=0.03"]
SCENES = {
    "panel": Scene("Panel under a ball", "ball_on_free_plate/deck.toml", PANEL, "bodies", "ball", "z", [4e-4, 2e-4, 1e-4, 5e-5, 2.5e-5], 4e-4),
    "box": Scene("Thin box dropped on an edge", "dropped_box/deck.toml", [], "bodies", "weight", "z", [2e-5, 1e-5, 5e-6, 2.5e-6], 2e-5),
    "cab": Scene(
        "Cab struck from the front", "safety_cab/front.toml", ['mesh.file="cab_coarse.msh"', "analysis.end_time=0.2"], "nodes",
        "mesh.35", "ux", [4e-3, 2e-3, 1e-3, 5e-4], 4e-3, "tops",
    ),
}  # fmt: skip
IMPLICIT = ["wilson-theta", "generalized-alpha", "bathe"]


def history(scene: Scene, settings: list, folder: Path) -> tuple[list, float, float]:
    """Values at the times that are compared, seconds of the loop, and the mean step."""
    sets = [*scene.sets, "expect=[]", f'output={{ nodes = "{scene.nodes}", interval = {scene.interval} }}', *settings]
    result = run(ROOT / "decks" / scene.deck, sets, folder)
    with (folder / f"{scene.table}.csv").open(newline="") as file:
        rows = [row for row in csv.DictReader(file) if row.get("node", row.get("body")) == scene.name]
    count = result.report["counts"]["steps"]
    return [float(row[scene.column]) for row in rows], result.loop_s, float(rows[-1]["time"]) / count


def measure(scene: Scene, folder: Path) -> list[dict]:
    fixed = lambda scheme, step: [f'integrator.scheme="{scheme}"', f"analysis.time_step={step}"]
    truth, _, _ = history(scene, fixed("bathe", scene.steps[-1] / 4), folder)
    span = max(truth) - min(truth)
    explicit = ['integrator.scheme="central-difference"', 'analysis.time_step="auto"']
    values, _, critical = history(scene, explicit, folder)
    runs = [("central-difference", explicit), ("central-difference, no scaling", [*explicit, 'integrator.mass_scaling="off"'])]
    runs += [("central-difference", [*explicit, f"integrator.mass_scaling_step={times * critical / 0.8}"]) for times in (2, 5, 10)]
    runs += [(scheme, fixed(scheme, step)) for scheme in IMPLICIT for step in scene.steps]
    found = []
    for scheme, settings in runs:
        values, loop_s, step = history(scene, settings, folder)
        again = history(scene, settings, folder)[1] if loop_s < 5.0 else loop_s
        error = math.sqrt(sum((a - b) ** 2 for a, b in zip(values, truth)) / len(truth)) / span
        found.append({"scheme": scheme, "loop_s": min(loop_s, again), "error": error, "error_tolerance": ""})
        print(f"| {scene.title} | {scheme} | {step:.2g} | {error:.1e} | {found[-1]['loop_s']:.3g} |", flush=True)
    return found


def main() -> None:
    build()
    names = sys.argv[1:] or list(SCENES)
    print("| scene | scheme | mean step, s | error | loop, s |\n|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        panels = [(precision.Panel(SCENES[name].title, "", [], []), measure(SCENES[name], Path(folder) / name)) for name in names]
    if names == list(SCENES):
        precision.COLOURS["central-difference"] = "#c4432b"
        (ROOT / "docs" / "pictures" / "explicit_or_implicit.svg").write_text(precision.picture(panels))


if __name__ == "__main__":
    main()
