#!/usr/bin/env python3
"""An error asked for with `accuracy`: the error reached, the settings chosen and the cost.

    scripts/accuracy_asked.py                 all scenes (some minutes)
    scripts/accuracy_asked.py B1 frame        some of them

Motions begin with one element of order 2 a segment and no time step; the portal frame C4 begins with one of order 3. Their references are those of scripts/scenes.py. Static scenes have
as reference the same deck with a much finer mesh and shorter load steps. Python's standard library only.
"""

import argparse
import csv
import math
import resource
import tempfile
from pathlib import Path
from typing import NamedTuple

import scenes
from scenes import ROOT, SCENES, run

ASKED = (1e-2, 1e-3, 1e-4)
MOTIONS = ("R1", "R2", "R3", "B1", "B2", "C1", "C2", "C4")
# Mesh and division of the output interval of the cheapest equal steps (Wilson-theta) in the table of scripts/speed.py.
BEST = {
    "R1": {1e-3: (None, 16), 1e-4: (None, 32)},
    "R2": {1e-3: (None, 5)},
    "R3": {1e-3: (None, 32), 1e-4: (None, 128)},
    "B1": {1e-2: ((1, 4), 2), 1e-3: ((1, 4), 6), 1e-4: ((2, 4), 20)},
    "B2": {1e-2: ((1, 2), 1), 1e-3: ((1, 3), 3), 1e-4: ((2, 3), 6)},
    "C1": {1e-2: ((1, 3), 1), 1e-3: ((1, 3), 2), 1e-4: ((1, 3), 4)},
    "C2": {1e-2: ((1, 3), 2), 1e-3: ((1, 4), 5), 1e-4: ((1, 4), 16)},
    "C4": {1e-2: ((3, 3), 2), 1e-3: ((8, 3), 4)},
}


class Compared(NamedTuple):
    """A scene whose reference is the same deck with a finer mesh, shorter steps or stiffer contacts."""

    deck: str
    begin: tuple[str, ...]
    """Overrides that the run begins with."""
    fine: tuple[str, ...]
    """Overrides of the reference."""


COMPARED = {
    "frame": Compared(
        "princeton_beam",
        ("beams.0.elements=1", "beams.0.order=1"),
        ("beams.0.elements=16", "beams.0.order=4"),
    ),
    "yielding": Compared(
        "plastic_collapse",
        ("analysis.end_time=0.8", "analysis.time_step=0.1", "beams.0.elements=1"),
        ("analysis.end_time=0.8", "analysis.time_step=0.02", "beams.0.elements=96"),
    ),
    "contact": Compared("tip_on_stop", (), ("contacts.0.stiffness=1e9", "beams.0.elements=4")),
    "shell": Compared(
        "pinched_hemisphere",
        ("shells.0.elements=4", "analysis.time_step=80.0"),
        ("shells.0.elements=48", "analysis.time_step=80.0"),
    ),
}

History = dict[str, dict[float, list[float]]]


def displacements(folder: Path) -> History:
    """Name -> time -> displacement, of nodes.csv without the inner nodes of parts."""
    found: History = {}
    with (folder / "nodes.csv").open(newline="") as file:
        for row in csv.DictReader(file):
            if not row["node"].endswith("]"):
                moved = [float(row[key]) for key in ("ux", "uy", "uz")]
                found.setdefault(row["node"], {})[round(float(row["time"]), 9)] = moved
    return found


def difference(own: History, exact: History) -> float:
    """The largest error of a node, relative to its largest displacement, or to a hundredth of the largest of all."""
    largest = {name: max(math.hypot(*u) for u in at.values()) for name, at in exact.items()}
    least, errors = 0.01 * max(largest.values()), []
    for name, at in own.items():
        times = [time for time in at if time in exact[name]]
        mean = sum(math.dist(at[time], exact[name][time]) ** 2 for time in times) / len(times)
        errors.append(math.sqrt(mean) / max(largest[name], least))
    return max(errors)


def chosen(report: dict) -> str:
    words = [entry.replace("analysis.", "").replace("beams.0.", "") for entry in report["accuracy"]["settings"]]
    return ", ".join(word for word in words if not word.startswith("time_step=\"auto"))


def iterations(report: dict) -> list[int]:
    """Those of the pilot runs, of the runs for the error of the steps, of that with a coarser mesh, and of the last run."""
    found, mesh = report.get("step_error") or {}, report.get("mesh") or {}
    others = [found.get("other_iterations", 0), mesh.get("iterations", 0)]
    return [report["accuracy"]["pilot_iterations"], *others, report["counts"]["iterations"]]


def timed(deck: Path, sets: list[str], folder: Path) -> tuple[scenes.Run, float]:
    """A run and its seconds of processor time, start and files included."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = run(deck, sets, folder)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return done, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def motion(name: str, asked: float, scheme: str | None) -> tuple[float, dict, float]:
    """A run by the scheme that automatic steps choose where a deck has none, or by another."""
    scene = SCENES[name]
    scheme = scheme or ("esdirk3" if scene.beams else "runge-kutta")
    sets = [f"analysis.accuracy={asked}", 'analysis.time_step="auto"', f'integrator={{scheme="{scheme}"}}', "expect=[]"]
    sets += ["output.energy=false", *scene.mesh(1, 3 if name == "C4" else 2)]
    with tempfile.TemporaryDirectory() as folder:
        done, seconds = timed(scene.deck, sets, Path(folder))
        return scene.error(done.folder), done.report, seconds


def compared(name: str, asked: float, exact: dict[str, History]) -> tuple[float, dict, float]:
    scene = COMPARED[name]
    deck = ROOT / "decks" / scene.deck / "deck.toml"
    with tempfile.TemporaryDirectory() as folder:
        if name not in exact:
            exact[name] = displacements(run(deck, [*scene.fine, "expect=[]"], Path(folder)).folder)
        done, seconds = timed(deck, [f"analysis.accuracy={asked}", *scene.begin, "expect=[]"], Path(folder))
        return difference(displacements(done.folder), exact[name]), done.report, seconds


def best_fixed(name: str, asked: float) -> int:
    """The iterations of the best equal steps that scripts/speed.py has found."""
    (mesh, division), scene = BEST[name][asked], SCENES[name]
    sets = [*(scene.mesh(*mesh) if mesh else []), *scene.step(division), "expect=[]", "output.energy=false"]
    with tempfile.TemporaryDirectory() as folder:
        return run(scene.deck, sets, Path(folder)).report["counts"]["iterations"]


def line(name: str, asked: float, error: float, report: dict, seconds: float) -> str:
    accuracy = report["accuracy"]
    mesh = "" if accuracy["mesh"] is None else f"{accuracy['mesh']:.1e}"
    steps = (report.get("step_error") or {}).get("estimate") or accuracy.get("load_steps")
    steps = "" if steps is None else f"{steps:.1e}"
    parts = iterations(report)
    best = f"{sum(parts) / best_fixed(name, asked):.1f}" if asked in BEST.get(name, {}) else ""
    return (
        f"| {name} | {asked:.0e} | {error:.1e} | {error / asked:.2f} | {mesh} | {steps} | {chosen(report)} |"
        f" {accuracy['pilot_runs']} | {' + '.join(str(part) for part in parts)} = {sum(parts)} | {seconds:.2f} | {best} |"
    )


def table(names: list[str], scheme: str | None) -> None:
    print("| scene | asked | reached | reached / asked | mesh, estimated | steps, estimated | chosen | pilots | iterations: pilots, steps, mesh, last | s | over best fixed |")
    print("|---|---|---|---|---|---|---|---|---|---|---|")
    exact: dict[str, History] = {}
    for name in names:
        for asked in ASKED:
            try:
                is_motion = name in MOTIONS
                error, report, seconds = motion(name, asked, scheme) if is_motion else compared(name, asked, exact)
            except RuntimeError as failed:
                print(f"| {name} | {asked:.0e} | {failed} |")
                continue
            print(line(name, asked, error, report, seconds), flush=True)
            for remark in report["accuracy"]["remarks"]:
                print(f"  {name}, {asked:.0e}: {remark}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("scenes", nargs="*", default=[*MOTIONS, *COMPARED], metavar="SCENE")
    parser.add_argument("--scheme", help="instead of the one that automatic steps choose")
    parser.add_argument("--program", type=Path, help="instead of a new build")
    asked = parser.parse_args()
    if asked.program:
        scenes.PROGRAM = asked.program
    else:
        scenes.build()
    table(asked.scenes, asked.scheme)
