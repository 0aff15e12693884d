#!/usr/bin/env python3
"""Error against run time on the reference scenes, beside what other programs need.

    scripts/speed.py                 the table of all scenes (two minutes)
    scripts/speed.py B1 C1           some scenes
    scripts/speed.py --orders        degree of the beam element against error and time
    scripts/speed.py --frames        space frames with rigid floors, 1,000 to 100,000 unknowns
    scripts/speed.py --explicit      explicit schemes on scenes that are not stiff; cost of a step of a long beam

Each setting is run several times; the least time counts. "loop" is the time stepping alone, "process" from start to exit.
The marks of other programs are process CPU seconds of their time loops on one core, best setting found for each, taken on
a machine of about this kind: read them as ratios. Python's standard library only.
"""

import sys
import tempfile
from pathlib import Path

from scenes import SCENES, build, run, unknowns

ERRORS = (1e-2, 1e-3, 1e-4)

# Least loop seconds of the other programs at 1e-2, 1e-3, 1e-4, and which; `part` is the share of it we aim at with
# Wilson-θ alone: half for beams, a fifth of the implicit programs for rigid bodies.
MARKS = {
    "R1": ((0.002, 0.003, 0.0085), "Exudyn, implicit", 0.2),
    "R2": ((0.083, 0.24), "Exudyn, implicit with joint", 0.2),
    "R3": ((0.015, 0.025, 0.048), "MBDyn, DIRK54", 0.2),
    "X2": ((0.006, 0.018, 0.04), "Exudyn", 0.5),
    "B1": ((0.054, 0.23, 1.4), "MBDyn, 3-node beams", 0.5),
    "B2": ((0.012, 0.018, 0.091), "MBDyn, 3-node beams", 0.5),
    "C1": ((0.007, 0.016, 0.043), "MBDyn, 3-node beams", 0.5),
    "C2": ((0.033, 0.12, 0.92), "MBDyn, 3-node beams", 0.5),
    "C4": ((0.12, 0.83), "OpenSees, fibre sections", 0.5),
}

# Of explicit Runge-Kutta schemes; we aim at half.
EXPLICIT = {
    "R1": ((0.0006, 0.0006, 0.0006), "Exudyn, RK44"),
    "R2": ((0.0025, 0.0036, 0.0046), "Exudyn, RK44 and RK67"),
    "R3": ((0.005, 0.008, 0.012), "Exudyn, RK44 and RK67"),
    "B2": ((0.012, 0.018, 0.091), "MBDyn, 3-node beams, implicit"),
}

# Meshes (elements per segment, order) and divisions of the output interval.
LADDERS = {
    "R1": ([None], [4, 8, 16, 32, 64, 128]),
    "R2": ([None], [4, 5, 8, 11, 16, 24, 32, 48]),
    "R3": ([None], [4, 8, 16, 32, 64, 128]),
    "X2": ([None], [4, 8, 16, 32, 64, 128, 256]),
    "B1": ([(1, 4), (2, 3), (2, 4)], [2, 3, 4, 6, 8, 12, 16, 20, 24]),
    "B2": ([(1, 2), (1, 3), (2, 3)], [1, 2, 3, 4, 6]),
    "C1": ([(1, 3), (1, 4), (2, 3)], [1, 2, 3, 4, 5, 6, 8]),
    "C2": ([(1, 3), (1, 4), (2, 3)], [1, 2, 3, 4, 5, 6, 8, 12, 16]),
    "C4": ([(3, 3), (4, 3), (6, 2), (8, 2), (8, 3)], [1, 2, 3, 4, 6, 8]),
}


def settings(name: str):
    meshes, divisions = LADDERS[name]
    for mesh in meshes:
        for division in divisions:
            yield mesh, division


def measure(name: str, repeats: int = 5):
    """(error, loop, process, mesh, step) of every setting."""
    scene = SCENES[name]
    for mesh, division in settings(name):
        sets = scene.step(division) + (scene.mesh(*mesh) if mesh else [])
        try:
            error, loop, process, _ = scene.measure(sets, repeats)
        except RuntimeError as failed:
            print(f"{name} {mesh} /{division}: {failed}", file=sys.stderr)
            continue
        yield error, loop, process, mesh, scene.interval / division


def speed(names: list[str]) -> None:
    print("| scene | error | setting | loop s | process s | other program, loop s | ratio | aim |")
    print("|---|---|---|---|---|---|---|---|")
    for name in names:
        found = list(measure(name))
        marks, program, part = MARKS[name]
        for wanted, mark in zip(ERRORS, marks):
            reached = [m for m in found if m[0] <= wanted]
            if not reached:
                print(f"| {name} | {wanted:.0e} | not reached | | | {mark} ({program}) | | {part} |")
                continue
            error, loop, process, mesh, step = min(reached, key=lambda m: m[1])
            what = f"dt {step:.3g}" + (f", {mesh[0]} x order {mesh[1]}" if mesh else "")
            print(
                f"| {name} | {wanted:.0e} | {what}: {error:.1e} | {loop:.4f} | {process:.4f} |"
                f" {mark} ({program}) | {loop / mark:.2f} | {part} |",
                flush=True,
            )


def explicit() -> None:
    """Least loop seconds of the explicit schemes, of steps of a given length and of their own."""
    table = "| scene | error | setting | loop s | process s | other program, loop s | ratio |\n|---|---|---|---|---|---|---|"
    print(table)
    for name, (marks, program) in EXPLICIT.items():
        scene = SCENES[name]
        found = []
        meshes = [scene.mesh(*mesh) for mesh in ((4, 1), (1, 2), (2, 2), (1, 3), (2, 3))] if scene.beams else [[]]
        schemes = [("central-difference", "")] if scene.beams else []
        schemes += [("runge-kutta", ""), ("runge-kutta", ", order = 5")]
        for word, more in schemes:
            integrator = [f'integrator={{ scheme = "{word}"{more} }}']
            lengths = [(f"dt {scene.interval / d:.3g}", scene.step(d)) for d in (1, 2, 3, 4)] if word == "runge-kutta" else []
            lengths.append(("auto", ['analysis.time_step="auto"']))
            for mesh in meshes:
                for length, sets in lengths:
                    try:
                        error, loop, process, _ = scene.measure(integrator + sets + mesh, 9)
                    except RuntimeError:
                        continue  # beyond the limit of stability
                    what = f"{word}{more}, {length}" + (f", {' '.join(mesh)}" if mesh else "")
                    found.append((error, loop, process, what))
        for wanted, mark in zip(ERRORS, marks):
            reached = [m for m in found if m[0] <= wanted]
            if not reached:
                print(f"| {name} | {wanted:.0e} | not reached | | | {mark} ({program}) | |")
                continue
            error, loop, process, what = min(reached, key=lambda m: m[1])
            ratio = f"{mark} ({program}) | {loop / mark:.2f}"
            print(f"| {name} | {wanted:.0e} | {what}: {error:.1e} | {loop:.5f} | {process:.4f} | {ratio} |", flush=True)
    for elements in (100, 1000):
        sets = [f"beams.rod.elements={elements}", "beams.rod.order=1", 'integrator={ scheme = "central-difference" }']
        sets += ["analysis.end_time=10.0", 'analysis.time_step="auto"', "output.interval=10.0"]
        loop, _, report = SCENES["B2"].cost(sets)
        step = loop / report["counts"]["steps"]
        print(f"{elements} elements of order 1: {1e6 * step:.1f} us a step, {1e9 * step / elements:.0f} ns an element")


def orders() -> None:
    """Error of the mesh at steps so small that the scheme's own error hides nothing, per degree and number of elements."""
    print("| scene | order | elements a segment | unknowns | error | loop s |")
    print("|---|---|---|---|---|---|")
    for name, division in (("B1", 32), ("B2", 32), ("C2", 64)):
        for order in (1, 2, 3, 4):
            for elements in (1, 2, 4, 8) if order > 1 else (2, 4, 8, 16):
                sets = SCENES[name].step(division) + SCENES[name].mesh(elements, order)
                error, loop, _, report = SCENES[name].measure(sets, 2)
                print(f"| {name} | {order} | {elements} | {unknowns(report)} | {error:.1e} | {loop:.4f} |", flush=True)


def frame(storeys: int, bays: int) -> str:
    """A space frame of square bays whose floors are rigid bodies but for the columns' heads of every second storey."""
    text = """
[analysis]
kind = "dynamic"
end_time = 0.02
time_step = 1e-3

[materials.steel]
model = "elastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
density = 7850.0

[sections.column]
shape = "box"
width = 0.3
height = 0.3
thickness = 0.012

[environment]
gravity = [0.0, 0.0, -9.81]
base_acceleration = [{ direction = [1.0, 0.0, 0.0], amplitude = "shake", scale = 3.0 }]

[amplitudes.shake]
kind = "sine"
frequency = 2.0

[output]
nodes = ["p0_0_0"]
energy = false

[points]
"""
    span, height = 6.0, 3.5
    grid = [(i, j) for i in range(bays + 1) for j in range(bays + 1)]
    for k in range(storeys + 1):
        text += "".join(f"p{i}_{j}_{k} = [{span * i}, {span * j}, {height * k}]\n" for i, j in grid)
    for i, j in grid:
        path = ", ".join(f'"p{i}_{j}_{k}"' for k in range(storeys + 1))
        text += f"""
[[beams]]
name = "column{i}_{j}"
path = [{path}]
elements = 2
order = 1
material = "steel"
section = "column"
orientation = [1.0, 0.0, 0.0]
"""
    for k in range(1, storeys + 1):
        rows = [[(i, j) for i in range(bays + 1)] for j in range(bays + 1)]
        columns = [[(i, j) for j in range(bays + 1)] for i in range(bays + 1)]
        if k % 2:  # a floor of beams; every second one is a rigid slab
            for n, line in enumerate(rows + columns):
                path = ", ".join(f'"p{i}_{j}_{k}"' for i, j in line)
                text += f"""
[[beams]]
name = "floor{k}_{n}"
path = [{path}]
elements = 2
order = 1
material = "steel"
section = "column"
orientation = [0.0, 0.0, 1.0]
"""
        else:
            nodes = ", ".join(f'"p{i}_{j}_{k}"' for i, j in grid)
            side = span * bays
            text += f"""
[[bodies]]
name = "slab{k}"
center = [{side / 2}, {side / 2}, {height * k}]
mass = {side * side * 500.0}
shape = {{ kind = "box", size = [{side}, {side}, 0.2] }}

[[attachments]]
body = "slab{k}"
nodes = [{nodes}]
"""
    feet = ", ".join(f'"p{i}_{j}_0"' for i, j in grid)
    return text + f"\n[[supports]]\nat = [{feet}]\nfix = \"all\"\n"


def frames() -> None:
    print("| storeys, bays | unknowns | plan s | steps | iterations | factorizations | loop s | s per step | memory MB |")
    print("|---|---|---|---|---|---|---|---|---|")
    for storeys, bays in ((6, 3), (16, 8), (40, 16)):
        with tempfile.TemporaryDirectory() as folder:
            deck = Path(folder) / "frame.toml"
            deck.write_text(frame(storeys, bays))
            for threads in (1, 2):
                report = run(deck, [], Path(folder) / "out", threads).report
                counts, times = report["counts"], report["timings"]
                print(
                    f"| {storeys}, {bays}, {threads} thread{'s' * (threads > 1)} | {unknowns(report)} | {times['plan_s']:.3f} |"
                    f" {counts['steps']} | {counts['iterations']} | {counts['factorizations']} | {times['loop_s']:.3f} |"
                    f" {times['loop_s'] / counts['steps']:.4f} | {report['peak_memory_bytes'] / 1e6:.0f} |",
                    flush=True,
                )


if __name__ == "__main__":
    build()
    words = sys.argv[1:]
    if "--orders" in words:
        orders()
    elif "--frames" in words:
        frames()
    elif "--explicit" in words:
        explicit()
    else:
        speed(words or list(MARKS))
