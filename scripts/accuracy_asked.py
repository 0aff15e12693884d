#!/usr/bin/env python3
"""An error asked for with `accuracy`: the error reached, the settings chosen, and the price beside the best equal steps.

    scripts/accuracy_asked.py                 all scenes (half an hour)
    scripts/accuracy_asked.py B1 loop         some of them
    scripts/accuracy_asked.py --fixed F.json  keeps the best equal steps in a file, and reads them there

The error is that of docs/choosing.md: displacements of named nodes and bodies, and rotations of bodies, each as root mean square over
all times of output, relative to its largest change. References are the same deck, refined. Equal steps are searched for over meshes, schemes
and lengths; the best take the least processor time. Times are without the start, that of a run of one step with the same mesh.
Python's standard library only.
"""

import argparse
import csv
import json
import math
import resource
import tempfile
from pathlib import Path
from typing import NamedTuple

import scenes
from accuracy_scenes import MOTIONS, STATICS, Motion
from scenes import ROOT, run

ASKED = (1e-2, 1e-3, 1e-4)
# Steps in an output interval; the search ends where the smallest error is reached or shorter steps no longer help.
DIVISIONS = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128)
LEAST = 0.01
"""Results that change less than this part of the largest change of their kind are relative to this part."""

Vector = list[float]


class History(NamedTuple):
    """Name -> time -> displacement, name -> time -> quaternion, and the largest distance of nodes at the start."""

    moved: dict[str, dict[float, Vector]]
    turned: dict[str, dict[float, Vector]]
    extent: float


def table_of(path: Path) -> list[dict[str, str]]:
    if not path.exists():
        return []
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def history(folder: Path) -> History:
    """The results of a run that `accuracy` counts."""
    moved: dict[str, dict[float, Vector]] = {}
    turned: dict[str, dict[float, Vector]] = {}
    begins: dict[str, Vector] = {}
    for name, kind in (("nodes.csv", "node"), ("bodies.csv", "body")):
        for row in table_of(folder / name):
            label, time = row[kind], round(float(row["time"]), 10)
            at = [float(row[key]) for key in ("x", "y", "z")]
            begins.setdefault(label, at)
            if not label.endswith("]"):
                begin = begins[label]
                moved.setdefault(label, {})[time] = [a - b for a, b in zip(at, begin)]
            if kind == "body":
                turned.setdefault(label, {})[time] = [float(row[key]) for key in ("qw", "qx", "qy", "qz")]
    extent = math.dist(*([pick(at[i] for at in begins.values()) for i in range(3)] for pick in (min, max)))
    return History(moved, turned, extent)


def apart(p: Vector, q: Vector) -> float:
    """The angle between two rotations."""
    return 2.0 * min(math.dist(p, q), math.dist(p, [-x for x in q]))


def angle(q: Vector, begin: Vector) -> float:
    """The angle of a rotation since the start."""
    return 2.0 * math.acos(min(1.0, abs(sum(a * b for a, b in zip(q, begin)))))


def root_mean(own: dict[float, Vector], exact: dict[float, Vector], between) -> float:
    times = [time for time in own if time in exact]
    return math.sqrt(sum(between(own[time], exact[time]) ** 2 for time in times) / len(times))


def part(of: float, scale: float) -> float:
    """A relative error; bodies that do not move may have no scale."""
    return of / scale if of > 0 else 0.0


def error(own: History, exact: History) -> float:
    """The largest error of a result, each relative to its largest change."""
    sizes = {name: max(math.hypot(*u) for u in at.values()) for name, at in exact.moved.items()}
    angles = {name: max(angle(q, at[min(at)]) for q in at.values()) for name, at in exact.turned.items()}
    far, wide = max(sizes.values()), max(angles.values(), default=0.0)
    errors = [part(root_mean(own.moved[name], exact.moved[name], math.dist), max(size, LEAST * far)) for name, size in sizes.items()]
    for name, size in angles.items():
        scale = max(size, LEAST * wide, far / exact.extent if exact.extent > 0 else 0.0)
        errors.append(part(root_mean(own.turned[name], exact.turned[name], apart), scale))
    return max(errors)


class Done(NamedTuple):
    history: History
    report: dict
    seconds: float
    """Processor time."""


def solved(motion: Motion, sets: list[str]) -> Done:
    """A run of a deck with these overrides."""
    rows = [f"output.interval={motion.interval!r}"] if motion.interval else []
    sets = [*rows, "output.energy=false", "expect=[]", *motion.common, *sets]
    with tempfile.TemporaryDirectory() as folder:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = run(ROOT / motion.deck, sets, Path(folder))
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        return Done(history(done.folder), done.report, seconds)


def equal(motion: Motion, mesh: tuple[str, ...], scheme: str, division: int) -> list[str]:
    """The overrides for equal steps."""
    return [*mesh, f"analysis.time_step={motion.interval / division!r}", f'integrator={{scheme="{scheme}"}}']


def asking(motion: Motion, asked: float) -> list[str]:
    """The overrides for an error."""
    return [*motion.begin, f"analysis.accuracy={asked}", 'analysis.time_step="auto"', f'integrator={{scheme="{motion.scheme}"}}']


Setting = tuple[float, float, int, list[str]]
"""Error, seconds, iterations, overrides."""


def searched(motion: Motion, exact: History) -> list[Setting]:
    """All equal steps that were tried."""
    found: list[Setting] = []
    for mesh in motion.meshes:
        for scheme in motion.schemes:
            last = math.inf
            for division in DIVISIONS:
                sets = equal(motion, mesh, scheme, division)
                try:
                    done = solved(motion, sets)
                except RuntimeError:
                    continue  # steps too long for the scene
                reached = error(done.history, exact)
                found.append((reached, done.seconds, done.report["counts"]["iterations"], sets))
                if reached <= ASKED[-1] or (last < ASKED[0] and reached > 0.8 * last):
                    break
                last = reached
    return found


def best(found: list[Setting], asked: float) -> Setting | None:
    """The cheapest setting that errs by no more than this."""
    return min((setting for setting in found if setting[0] <= asked), key=lambda setting: setting[1], default=None)


def iterations(report: dict) -> list[int]:
    """Those of the pilot runs, of the runs for the error of the steps, of that with a coarser mesh, and of the last run."""
    found, mesh = report.get("step_error") or {}, report.get("mesh") or {}
    others = [found.get("other_iterations", 0), mesh.get("iterations", 0)]
    return [report["accuracy"]["pilot_iterations"], *others, report["counts"]["iterations"]]


def factorizations(report: dict) -> int:
    found, mesh = report.get("step_error") or {}, report.get("mesh") or {}
    others = found.get("other_factorizations", 0) + mesh.get("factorizations", 0)
    return report["accuracy"]["pilot_factorizations"] + others + report["counts"]["factorizations"]


def chosen(report: dict) -> str:
    words = [entry.replace("analysis.", "") for entry in report["accuracy"]["settings"]]
    return ", ".join(word for word in words if not word.startswith('time_step="auto'))


def start(motion: Motion, sets: list[str]) -> float:
    """Seconds of a run of one step with these overrides, which is hardly more than the start."""
    kept = [entry for entry in sets if not entry.startswith(("analysis.time_step=", "analysis.accuracy="))]
    try:
        return solved(motion, [*kept, f"analysis.end_time={motion.interval!r}", f"analysis.time_step={motion.interval!r}"]).seconds
    except RuntimeError:
        return 0.002  # one step too long to converge


def prices(motion: Motion, asked: float, setting: Setting | None, repeats: int) -> tuple[Done, float, float]:
    """A run by `accuracy`, its seconds, and those of the best equal steps; each without the start of the same mesh, taken by turns."""
    own, other = [math.inf] * 2, [math.inf] * 2
    for _ in range(repeats):
        done = solved(motion, asking(motion, asked))
        own = [min(own[0], done.seconds), min(own[1], start(motion, asking(motion, asked)))]
        if setting:
            other = [min(other[0], solved(motion, setting[3]).seconds), min(other[1], start(motion, setting[3]))]
    return done, own[0] - own[1], other[0] - other[1] if setting else math.nan


def line(name: str, asked: float, exact: History, setting: Setting | None, repeats: int) -> str:
    done, own, other = prices(MOTIONS[name], asked, setting, repeats)
    reached, report = error(done.history, exact), done.report
    told, parts = report["accuracy"], iterations(report)
    mesh = "" if told["mesh"] is None else f"{told['mesh']:.1e}"
    found = report.get("step_error") or {}
    steps = found.get("estimate") or told.get("load_steps")
    steps = "" if steps is None else f"{steps:.1e}"
    price = ["", "", ""]
    if setting:
        # A run that takes no longer than its start has no price in seconds.
        in_seconds = f"{own / other:.1f}" if own > 0 and other > 0 else ""
        price = [f"{sum(parts) / setting[2]:.1f}", in_seconds, f"{setting[0]:.1e}: " + " ".join(setting[3])]
    return (
        f"| {name} | {asked:.0e} | {reached:.1e} | {reached / asked:.2f} | {mesh} | {steps} | {chosen(report)} | {told['pilot_runs']},"
        f" {found.get('runs', 0)} | {' + '.join(str(part) for part in parts)} = {sum(parts)} | {factorizations(report)} | {own:.4f} | {' | '.join(price)} |"
    )


def motions(names: list[str], fixed: Path | None, asked: tuple[float, ...], repeats: int) -> None:
    print(
        "| scene | asked | reached | reached / asked | mesh, estimated | steps, estimated | chosen | runs: pilots, others | iterations: pilots,"
        " others, mesh, last | factorizations | s | iterations over best | s over best | best equal steps |"
    )
    print("|" + "---|" * 14)
    kept = json.loads(fixed.read_text()) if fixed and fixed.exists() else {}
    for name in names:
        motion = MOTIONS[name]
        exact = solved(motion, list(motion.fine)).history
        if name not in kept:
            kept[name] = {"known to": error(solved(motion, list(motion.check)).history, exact), "found": searched(motion, exact)}
            if fixed:
                fixed.write_text(json.dumps(kept))
        print(f"{name}: a coarser reference differs by {kept[name]['known to']:.1e}")
        for wanted in asked:
            try:
                print(line(name, wanted, exact, best(kept[name]["found"], wanted), repeats), flush=True)
            except RuntimeError as failed:
                print(f"| {name} | {wanted:.0e} | {failed} |", flush=True)


def statics(names: list[str], asked: tuple[float, ...]) -> None:
    """Scenes of load steps, whose references have a much finer mesh."""
    for name in names:
        scene = STATICS[name]
        exact = solved(scene, list(scene.fine)).history
        for wanted in asked:
            try:
                done = solved(scene, [*scene.begin, f"analysis.accuracy={wanted}"])
            except RuntimeError as failed:
                print(f"| {name} | {wanted:.0e} | {failed} |")
                continue
            reached, told = error(done.history, exact), done.report["accuracy"]
            parts = iterations(done.report)
            print(f"| {name} | {wanted:.0e} | {reached:.1e} | {reached / wanted:.2f} | {chosen(done.report)} | {told['pilot_runs']} | {sum(parts)} | {done.seconds:.3f} |", flush=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("scenes", nargs="*", default=[*MOTIONS, *STATICS], metavar="SCENE")
    parser.add_argument("--asked", type=float, nargs="+", default=ASKED)
    parser.add_argument("--fixed", type=Path, help="file of the best equal steps")
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--program", type=Path, help="instead of a new build")
    given = parser.parse_args()
    if given.repeats < 1:
        parser.error("--repeats must be at least 1")
    if given.program:
        scenes.PROGRAM = given.program
    else:
        scenes.build()
    motions([name for name in given.scenes if name in MOTIONS], given.fixed, tuple(given.asked), given.repeats)
    statics([name for name in given.scenes if name in STATICS], tuple(given.asked))
