#!/usr/bin/env python3
"""Mechanisms with a reduced part beside the same with all elements: errors over the number of modes, energy, unknowns and times.

    scripts/reduced.py [--program PROGRAM] [crank] [bars] [plate] [cab]      without names: all

`crank` is the slider-crank of J. B. Jonker (Multibody Syst. Dyn. 3 (1999)): crank 0.15 m at a constant speed, steel rod 0.3 m long and 6 mm thick, slider
of half the mass of the rod. `bars` is decks/four_bar with a steel tube as coupler. `plate` is a panel that swings about an edge, `cab` the side blow of
decks/safety_cab, whose backbone bends.
"""

import argparse
import csv
import json
import math
import re
import subprocess
import tempfile
from pathlib import Path

from scenes import PROGRAM, ROOT

STEEL = '[materials.steel]\nmodel = "elastic"\nyoungs_modulus = 2e11\npoisson_ratio = 0.3\ndensity = 7870.0\n'
SCHEME = '[integrator]\nscheme = "generalized-alpha"\nspectral_radius = 0.9\n'
NONE = None


def beam(ends: tuple[str, str], reduced: str, section: str) -> str:
    """A beam of 24 elements; `reduced` is the value of its key, or empty for all elements."""
    key = f"reduced = {reduced}\n" if reduced else ""
    return (
        f'[[beams]]\nname = "rod"\npath = ["{ends[0]}", "{ends[1]}"]\nelements = 24\nmaterial = "steel"\nsection = "{section}"\n'
        f'orientation = [0.0, 0.0, 1.0]\nmass = "consistent"\n{key}'
    )


def crank(speed: float, reduced: str) -> str:
    turns = 2.0 * math.pi / speed
    rod = math.pi * 0.003**2 * 0.3 * 7870.0
    spin = -speed * 0.15 / 0.3
    return f"""
[analysis]
kind = "dynamic"
end_time = {turns}
time_step = {turns / 720}
plane = "off"
{SCHEME}{STEEL}
[sections.rod]
shape = "circle"
radius = 0.003
[points]
start = [0.15, 0.0, 0.0]
tip = [0.45, 0.0, 0.0]
{beam(("start", "tip"), reduced, "rod")}
[[initial]]
at = ["rod"]
velocity = [0.0, {0.15 * speed}, 0.0]
angular_velocity = [0.0, 0.0, {spin}]
about = [0.15, 0.0, 0.0]
[[bodies]]
name = "crank"
center = [0.075, 0.0, 0.0]
mass = 0.1
inertia = [1e-4, 1e-4, 1e-4]
velocity = [0.0, {0.075 * speed}, 0.0]
angular_velocity = [0.0, 0.0, {speed}]
[[bodies]]
name = "slider"
center = [0.45, 0.0, 0.0]
mass = {0.5 * rod}
inertia = [1e-5, 1e-5, 1e-5]
[[joints]]
name = "motor"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
from = {{ ground = [0.0, 0.0, 0.0] }}
to = {{ body = "crank" }}
motion = {{ velocity = {speed} }}
[[joints]]
name = "knee"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
from = {{ body = "crank", point = [0.15, 0.0, 0.0] }}
to = {{ node = "start" }}
[[joints]]
name = "wrist"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
from = {{ node = "tip" }}
to = {{ body = "slider" }}
[[joints]]
name = "guide"
kind = "prismatic"
axis = [1.0, 0.0, 0.0]
from = {{ ground = [0.45, 0.0, 0.0] }}
to = {{ body = "slider" }}
[output]
nodes = "all"
every = 4
"""


def bars(reduced: str) -> str:
    """decks/four_bar with a coupler of its mass that bends, for four turns of the crank."""
    deck = (ROOT / "decks/four_bar/deck.toml").read_text()
    deck = re.sub(r"\[\[expect\]\].*", "", deck, flags=re.S).replace("end_time = 110.0", "end_time = 4.0").replace("0.0025", "0.002")
    body = re.compile(r'\[\[bodies\]\]\nname = "coupler".*?\n\n', re.S)
    tube = 3.5 / 3.5  # mass per length
    radius, thickness = 0.03, 0.03 - math.sqrt(0.03**2 - tube / (7870.0 * math.pi))
    coupler = (
        f'[sections.tube]\nshape = "tube"\nradius = {radius}\nthickness = {thickness}\n'
        + beam(("k2", "t2"), reduced, "tube")
        + '[[initial]]\nat = ["rod"]\nvelocity = [6.283185307179586, 0.0, 0.0]\nangular_velocity = [0.0, 0.0, 0.61885276203975792]\nabout = [0.0, 1.0, 0.0]\n'
    )
    deck = body.sub("", deck).replace('to = { body = "coupler" }', 'to = { node = "k2" }', 1).replace('to = { body = "coupler" }', 'to = { node = "t2" }')
    deck = deck.replace("[points]\n", "[points]\nk2 = [0.0, 1.0, 0.0]\nt2 = [2.9872189505317297, 2.8238758021269184, 0.0]\n")
    return deck + SCHEME + STEEL + coupler + '[output]\nnodes = "all"\nevery = 4\n'


def plate(elements: int, modes: int | None) -> str:
    """A panel of aluminium that swings about an edge held at two corners."""
    reduced = "" if modes is None else f"reduced = {modes}\n"
    return f"""
[analysis]
kind = "dynamic"
end_time = 0.4
time_step = 1e-3
{SCHEME}
[environment]
gravity = [0.0, 0.0, -9.81]
[materials.metal]
model = "elastic"
youngs_modulus = 7e10
poisson_ratio = 0.3
density = 2700.0
[points]
a = [0.0, 0.0, 0.0]
b = [0.6, 0.0, 0.0]
c = [0.6, 0.4, 0.0]
d = [0.0, 0.4, 0.0]
[[shells]]
name = "panel"
corners = ["a", "b", "c", "d"]
elements = [{elements}, {elements}]
thickness = 0.004
material = "metal"
{reduced}
[[supports]]
at = ["a", "d"]
fix = ["ux", "uy", "uz"]
[output]
nodes = "all"
every = 4
"""


class Result:
    """Places of nodes by time and name, energies, and the report of a run."""

    def __init__(self, program: str, deck: str | Path, *arguments: str):
        with tempfile.TemporaryDirectory() as folder:
            path = deck
            if isinstance(deck, str):
                path = Path(folder) / "deck.toml"
                path.write_text(deck)
            out = Path(folder) / "out"
            done = subprocess.run([program, "run", path, "-o", out, "--quiet", "--threads", "1", *arguments], capture_output=True, text=True)
            if done.returncode not in (0, 5):
                raise SystemExit(done.stderr)
            self.report = json.loads((out / "result.json").read_text())
            with (out / "nodes.csv").open() as file:
                self.x = {(row["time"], row["node"]): tuple(float(row[axis]) for axis in "xyz") for row in csv.DictReader(file)}
            with (out / "energy.csv").open() as file:
                self.energies = [{key: float(value or 0.0) for key, value in row.items()} for row in csv.DictReader(file)]

    def timings(self) -> str:
        timings, counts = self.report["timings"], self.report["counts"]
        return f"{timings['read_s']:.3f} | {timings['loop_s']:.3f} | {counts['iterations']}"

    def drift(self) -> float:
        """The largest change of mechanical energy less the work put in and taken, as a part of the largest kinetic energy."""
        balance = [e["mechanical"] - e["external"] for e in self.energies]
        return max(abs(b - balance[0]) for b in balance) / max(e["kinetic"] for e in self.energies)


def difference(a: Result, b: Result) -> float:
    shared = [key for key in a.x if key in b.x]
    return max(math.dist(a.x[key], b.x[key]) for key in shared)


def table(title: str, program: str, deck, forms: list, size: float) -> None:
    """Prints errors as a part of a size beside the first of the forms."""
    print(f"\n{title}\n\n| form | largest error | energy drift | read s | loop s | iterations |\n|---|---|---|---|---|---|")
    full = None
    for name, *arguments in forms:
        result = Result(program, deck(*arguments))
        full = full or result
        print(f"| {name} | {difference(full, result) / size:.1e} | {result.drift():.0e} | {result.timings()} |", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=str(PROGRAM))
    parser.add_argument("scenes", nargs="*", default=["crank", "bars", "plate", "cab"])
    asked = parser.parse_args()
    pieces = [(f"{modes} modes, {count} pieces", f"{{ modes = {modes}, pieces = {count} }}") for count in (1, 2, 4) for modes in (0, 1, 3, 6)]
    linear = [(f"{modes} modes, linear", f"{{ modes = {modes}, geometric_stiffness = false }}") for modes in (3, 6)]
    forms = [("all elements", ""), *pieces, *linear]
    if "crank" in asked.scenes:
        for speed in (30.0, 150.0):
            title = f"Slider-crank at {speed:g} rad/s; errors of places as a part of the rod"
            table(title, asked.program, crank, [(name, speed, reduced) for name, reduced in forms], 0.3)
    if "bars" in asked.scenes:
        table("Four-bar linkage; errors of places as a part of the coupler", asked.program, bars, forms, 3.5)
    if "plate" in asked.scenes:
        for elements in (10, 20, 30):
            forms = [("all elements", elements, NONE)] + [(f"{modes} modes", elements, modes) for modes in (5, 20, 40)]
            table(f"Panel of {elements} by {elements} elements; errors of places as a part of 0.6 m", asked.program, plate, forms, 0.6)
    if "cab" in asked.scenes:
        print("\nSafety cab, side blow; errors of places as a part of 0.1 m\n\n| backbone | largest error | read s | loop s | iterations |\n|---|---|---|---|---|")
        deck, full = ROOT / "decks/safety_cab/side.toml", None
        for form in ("rigid=false", "rigid=true", "reduced=0", "reduced=5", "reduced=20"):
            free = [] if form.startswith("rigid") else ["--set", "beams.backbone.rigid=false"]
            result = Result(asked.program, deck, *free, "--set", f"beams.backbone.{form}")
            full = full or result
            print(f"| `{form}` | {difference(full, result) / 0.1:.1e} | {result.timings()} |", flush=True)


main()
