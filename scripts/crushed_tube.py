#!/usr/bin/env python3
"""A square steel tube crushed along its axis until its walls lie upon themselves, against a published mean crushing force.

    scripts/crushed_tube.py                       18 x 12 elements at 20 m/s (ten seconds)
    scripts/crushed_tube.py --meshes 14,9 18,12 27,18 --speeds 20 10

A quarter of the tube, 50 mm wide from middle to middle of its walls and 1.6 mm thick, one fold high, between two plates; a shell that touches
itself. W. Abramowicz and N. Jones, Int. J. Impact Engng 2 (1984) 179-208 and 4 (1986) 243-270: symmetric folds of tubes c wide and t thick,
rigid and perfectly plastic with the flow stress s, are 1.966 (t c^2)^(1/3) = 31.2 mm high, end when they are 0.73 of that shorter, 22.8 mm, and
take the mean force 13.06 s t^2 (c/t)^(1/3). For s stands half the sum of yield stress and strength: material that hardens linearly, 230 + 736 e
MPa, carries most at e = 1 - 230/736, with a strength of 370 MPa. So s = 300 MPa, 31.6 kN, and 180.0 J for the quarter. Tubes tested scatter by
some 15 % about the formula. Python's standard library only.
"""

import argparse
import csv
import math
import os
import subprocess
import tempfile

PROGRAM = os.environ.get("RDSOLVE", "target/release/rdsolve")
WIDTH, THICKNESS, ROUND, HEIGHT, WAY = 50.0, 1.6, 3.2, 31.2, 22.8
FORMULA = 0.25 * 13.06 * 300e6 * 1.6e-3**2 * (WIDTH / THICKNESS) ** (1 / 3) * WAY * 1e-3

DECK = """
[analysis]
kind = "dynamic"
end_time = {end}
time_step = "auto"
[integrator]
scheme = "central-difference"
[mesh]
file = "tube.msh"
[materials.steel]
model = "elastic-plastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
density = 7850.0
yield_stress = 230e6
hardening_modulus = 736e6
[[shells]]
group = "tube"
thickness = 1.6e-3
material = "steel"
strain = "logarithmic"
[[bodies]]
name = "ram"
center = [0.0, 0.0, 31.2e-3]
mass = 0.01
inertia = [1e-6, 1e-6, 1e-6]
[[supports]]
at = "foot"
fix = "all"
[[supports]]
at = ["head", "ram"]
fix = ["ux", "uy", "rx", "ry", "rz"]
motion = {{ uz = {{ scale = -{speed}, amplitude = "push", history = "velocity" }} }}
[amplitudes.push]
kind = "ramp"
end = 2e-4
[[supports]]
at = "cut_x"
fix = ["uy", "rx", "rz"]
[[supports]]
at = "cut_y"
fix = ["ux", "ry", "rz"]
[[contacts]]
name = "folds"
surface = {{ part = "tube" }}
with = "itself"
[[contacts]]
name = "lower plate"
surface = {{ shape = "plane", point = [0.0, 0.0, -0.8e-3], normal = [0.0, 0.0, 1.0] }}
with = "tube"
[[contacts]]
name = "upper plate"
surface = {{ shape = "plane", body = "ram", point = [0.0, 0.0, 32.0e-3], normal = [0.0, 0.0, -1.0] }}
with = "tube"
[output]
interval = {interval}
contacts = true
"""


def mesh(around: int, high: int) -> str:
    """A quarter with `around` elements, two of them round the corner, and `high` over the height; the first fold is drawn as an imperfection,
    1 mm out at one wall and in at the other."""
    half, flat = 0.5 * WIDTH, 0.5 * WIDTH - ROUND
    on_flat = (around - 2) // 2
    path = [(half, flat * i / on_flat, "x") for i in range(on_flat)]
    for i in range(3):
        angle = 0.25 * math.pi * i
        path.append((flat + ROUND * math.cos(angle), flat + ROUND * math.sin(angle), None))
    path += [(flat * (on_flat - i) / on_flat, half, "y") for i in range(1, on_flat + 1)]
    nodes = []
    for j in range(high + 1):
        z = HEIGHT * j / high
        bulge = 0.5 * (1.0 - math.cos(2.0 * math.pi * z / HEIGHT))
        for x, y, wall in path:
            out = x + bulge * math.cos(0.5 * math.pi * y / flat) if wall == "x" else x
            inward = y - bulge * math.cos(0.5 * math.pi * x / flat) if wall == "y" else y
            nodes.append((out, inward, z))
    last = len(path) - 1

    def number(i: int, j: int) -> int:
        return j * len(path) + i + 1

    elements = [(1, 1, [number(i, 0), number(i + 1, 0)]) for i in range(last)]
    elements += [(1, 2, [number(i, high), number(i + 1, high)]) for i in range(last)]
    elements += [(1, group, [number(i, j), number(i, j + 1)]) for j in range(high) for i, group in ((0, 3), (last, 4))]
    for j in range(high):
        elements += [
            (3, 5, [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)]) for i in range(last)
        ]
    names = [(1, 1, "foot"), (1, 2, "head"), (1, 3, "cut_x"), (1, 4, "cut_y"), (2, 5, "tube")]
    text = f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{len(names)}\n"
    text += "".join(f'{dimension} {group} "{name}"\n' for dimension, group, name in names)
    text += f"$EndPhysicalNames\n$Nodes\n{len(nodes)}\n"
    for k, place in enumerate(nodes):
        text += f"{k + 1} " + " ".join(f"{1e-3 * x:.8g}" for x in place) + "\n"
    text += f"$EndNodes\n$Elements\n{len(elements)}\n"
    for k, (kind, group, ends) in enumerate(elements):
        text += f"{k + 1} {kind} 2 {group} {group} " + " ".join(map(str, ends)) + "\n"
    return text + "$EndElements\n"


def crush(around: int, high: int, speed: float) -> None:
    """Runs one tube and prints a row of the table."""
    end = 1e-4 + WAY * 1e-3 / speed
    with tempfile.TemporaryDirectory() as folder:
        with open(f"{folder}/tube.msh", "w") as file:
            file.write(mesh(around, high))
        with open(f"{folder}/deck.toml", "w") as file:
            file.write(DECK.format(end=end, speed=speed, interval=end / 50))
        before = os.times().children_user
        ran = subprocess.run(
            [PROGRAM, f"{folder}/deck.toml", "-o", f"{folder}/out", "--threads", "1", "--quiet"], capture_output=True, text=True
        )
        seconds = os.times().children_user - before
        with open(f"{folder}/out/energy.csv") as file:
            rows = list(csv.DictReader(file))
    last, kinetic = rows[-1], float(rows[-1]["kinetic"])
    reached = float(last["time"]) >= end * (1.0 - 1e-9)
    work = float(last["external"])
    force = 4e-3 * work / (WAY * 1e-3)
    what = f"{work:.1f} | {force:.1f} | {100 * (work / FORMULA - 1):+.0f}" if reached else f"ends at {last['time']} s | |"
    numerical = max((float(row["numerical"]) for row in rows), key=abs)
    print(
        f"| {around} x {high} | {speed:g} | {last['step']} | {what} | {numerical:.1g} | {100 * kinetic / work:.1f} | {seconds:.1f} |",
        flush=True,
    )
    if ran.returncode != 0:
        print(ran.stderr.strip().splitlines()[-1])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--meshes", nargs="+", default=["18,12"], help="elements round a quarter, an even number, and over the height")
    parser.add_argument("--speeds", nargs="+", type=float, default=[20.0], help="m/s")
    given = parser.parse_args()
    print("| elements | speed, m/s | steps | work, J | mean force, kN | off, % | `numerical`, J | kinetic at the end, % | CPU, s |")
    print("|---|---|---|---|---|---|---|---|---|")
    for speed in given.speeds:
        for sizes in given.meshes:
            around, high = map(int, sizes.split(","))
            crush(around, high, speed)


if __name__ == "__main__":
    main()
