#!/usr/bin/env python3
"""Mechanisms with a reduced part beside the same with all elements: errors over the number of modes, energy, unknowns and times.

    scripts/reduced.py [--program PROGRAM] [crank] [bars] [princeton] [plate] [spin] [tumble] [cab] [exudyn]      without names: all

`crank` is the slider-crank of J. B. Jonker (Multibody Syst. Dyn. 3 (1999)): crank 0.15 m at a constant speed, steel rod 0.3 m long and 6 mm thick, slider
of half the mass of the rod. `bars` is decks/four_bar with a steel tube as coupler. `princeton` is the deck of that name. `plate` is a panel that
swings about two corners, and `spin` one on a hub. `tumble` is a free box of six panels for 100,000 steps. `cab` is the side blow of decks/safety_cab, whose backbone bends. `exudyn` needs a Python with exudyn and
scipy (pip install exudyn scipy).
"""

import argparse
import csv
import json
import math
import re
import subprocess
import tempfile
import time
from pathlib import Path

from scenes import PROGRAM, ROOT

STEEL = '[materials.steel]\nmodel = "elastic"\nyoungs_modulus = 2e11\npoisson_ratio = 0.3\ndensity = 7870.0\n'
SCHEME = '[integrator]\nscheme = "generalized-alpha"\nspectral_radius = 0.9\n'
MOMENTA = (("px", "py", "pz"), ("lx", "ly", "lz"), ("mechanical",))
OUTPUT = '[output]\nnodes = "all"\nevery = 4\n'


def joint(name: str, one: str, other: str, kind: str = "revolute", axis: str = "[0.0, 0.0, 1.0]") -> str:
    return f'[[joints]]\nname = "{name}"\nkind = "{kind}"\naxis = {axis}\nfrom = {one}\nto = {other}\n'


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
[sections]
rod = {{ shape = "circle", radius = 0.003 }}
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
{joint("motor", "{ ground = [0.0, 0.0, 0.0] }", '{ body = "crank" }')}motion = {{ velocity = {speed} }}
{joint("knee", '{ body = "crank", point = [0.15, 0.0, 0.0] }', '{ node = "start" }')}
{joint("wrist", '{ node = "tip" }', '{ body = "slider" }')}
{joint("guide", "{ ground = [0.45, 0.0, 0.0] }", '{ body = "slider" }', "prismatic", "[1.0, 0.0, 0.0]")}
{OUTPUT}"""


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
    return deck + SCHEME + STEEL + coupler + OUTPUT


def princeton(reduced: str) -> str:
    """decks/princeton_beam with 24 elements."""
    deck = re.sub(r"\[\[expect\]\].*", "", (ROOT / "decks/princeton_beam/deck.toml").read_text(), flags=re.S)
    key = f"reduced = {reduced}\n" if reduced else ""
    return deck.replace("elements = 4\n", "elements = 24\n" + key) + OUTPUT


SWINGS = """
[environment]
gravity = [0.0, 0.0, -9.81]
[[supports]]
at = ["a", "d"]
fix = ["ux", "uy", "uz"]
"""
# An edge on a hub that turns about an axis oblique to the panel, at 20 rad/s from 0.4 s on; the panel at rest has 9 Hz.
SPINS = f"""
[[bodies]]
name = "hub"
center = [0.0, 0.2, 0.0]
mass = 1.0
inertia = [1.0, 1.0, 1.0]
[[attachments]]
body = "hub"
nodes = "panel.edge4"
{joint("motor", "{ ground = [0.0, 0.2, 0.0] }", '{ body = "hub" }', axis="[0.0, 0.8, 0.6]")}motion = {{ amplitude = "spin", acceleration = 100.0 }}
[amplitudes.spin]
kind = "sine-squared"
angular_frequency = 7.853981633974483
end = 0.4
"""


def plate(elements: int, form: str, rest: str = SWINGS) -> str:
    """A panel of aluminium that swings about an edge held at two corners, or spins with an edge on a hub."""
    return f"""
[analysis]
kind = "dynamic"
end_time = {0.4 if rest == SWINGS else 0.6}
time_step = 1e-3
{SCHEME}{rest}
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
elements = [{elements}, {min(elements, 8) if rest == SPINS else elements}]
thickness = 0.004
material = "metal"
{form}
{OUTPUT}"""


def box(steps: int, step: float, reduced: str) -> str:
    """A free box of six panels that tumbles about its middle axis, with momenta written at 1000 instants."""
    size = (0.5, 0.35, 0.2)
    corners = {f"p{i}{j}{k}": [i * size[0], j * size[1], k * size[2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)}
    points = "".join(f"{name} = {at}\n" for name, at in corners.items())
    faces = ["000 010 110 100", "001 101 111 011", "000 100 101 001", "010 011 111 110", "000 001 011 010", "100 110 111 101"]
    shells = "".join(
        f'[[shells]]\nname = "side{n}"\ncorners = [{", ".join(f"{chr(34)}p{c}{chr(34)}" for c in face.split())}]\nelements = 4\n'
        f'thickness = 0.002\nmaterial = "steel"\n' for n, face in enumerate(faces)
    )
    names = ", ".join(f'"side{n}"' for n in range(6))
    together = f'[[parts]]\nname = "box"\nparts = [{names}]\nreduced = {reduced}\n' if reduced else ""
    return f"""
[analysis]
kind = "dynamic"
end_time = {steps * step}
time_step = {step}
[integrator]
scheme = "generalized-alpha"
spectral_radius = 0.9
[iteration]
tolerance = 1e-8
{STEEL}[points]
{points}{shells}{together}[[initial]]
at = [{names}]
velocity = [1.0, 2.0, 3.0]
angular_velocity = [0.05, 8.0, 0.03]
about = [0.25, 0.175, 0.1]
[output]
nodes = ["p000"]
every = {steps // 1000}
energy = true
"""


def tumble(program: str, steps: int) -> None:
    """Prints the drift of momenta and energy of the box in tenths of the run."""
    print(f"\nBox that tumbles for {steps} steps; change from the start as a part of the size there\n")
    print("| tenth of the run | linear momentum | angular momentum | energy |\n|---|---|---|---|")
    rows = Result(program, box(steps, 2e-3, "4")).energies
    size = [math.hypot(*(rows[0][k] for k in of)) for of in MOMENTA]
    off = [[math.dist([row[k] for k in of], [rows[0][k] for k in of]) / s for of, s in zip(MOMENTA, size)] for row in rows]
    for tenth in (0, 4, 9):
        part = off[len(off) * tenth // 10 : len(off) * (tenth + 1) // 10]
        print(f"| {tenth + 1} | " + " | ".join(f"{max(row[k] for row in part):.1e}" for k in range(3)) + " |", flush=True)


def exudyn(program: str, modes: int) -> None:
    """The swinging panel by ObjectFFRFreducedOrder of Exudyn with our matrices, without rotations, by the same method of Craig and Bampton."""
    import exudyn as exu
    import numpy as np
    import scipy
    from exudyn.FEM import FEMinterface, ObjectFFRFreducedOrderInterface
    from exudyn.utilities import MarkerBodyPosition, MarkerSuperElementPosition, ObjectGround, SensorSuperElement, SphericalJoint

    ours = {form: Result(program, plate(20, form).replace("every = 4", "every = 1")) for form in ("", f"reduced = {modes}")}
    with tempfile.TemporaryDirectory() as folder:
        deck = Path(folder) / "deck.toml"
        deck.write_text(plate(20, "", ""))
        subprocess.run([program, "check", deck, "--export-matrices", folder], check=True, stdout=subprocess.DEVNULL)
        K, M = (scipy.io.mmread(Path(folder) / f"{name}.mtx").toarray() for name in "KM")
        rows = list(csv.DictReader((Path(folder) / "dofs.csv").open()))
    moved, turned = ([i for i, row in enumerate(rows) if row["direction"][0] == kind] for kind in "ur")
    K = K[np.ix_(moved, moved)] - K[np.ix_(moved, turned)] @ np.linalg.solve(K[np.ix_(turned, turned)], K[np.ix_(turned, moved)])
    M = M[np.ix_(moved, moved)]
    names = [rows[i]["node"] for i in moved[::3]]
    places = np.array([ours[""].x[("0.0", name)] for name in names])
    held = [3 * names.index(name) + axis for name in "ad" for axis in range(3)]
    inner = [i for i in range(len(moved)) if i not in held]
    shapes = np.zeros((len(moved), 6 + modes))
    shapes[held, :6] = np.eye(6)
    shapes[inner, :6] = -np.linalg.solve(K[np.ix_(inner, inner)], K[np.ix_(inner, held)])
    shapes[inner, 6:] = scipy.linalg.eigh(K[np.ix_(inner, inner)], M[np.ix_(inner, inner)], subset_by_index=[0, modes - 1])[1]
    # The first six are the rigid motions, which the frame has.
    basis = shapes @ scipy.linalg.eigh(shapes.T @ K @ shapes, shapes.T @ M @ shapes)[1][:, 6:]
    part = FEMinterface()
    part.nodes, part.modeBasis = {"Position": places}, {"matrix": basis, "type": "HCBmodes"}
    part.massMatrix, part.stiffnessMatrix = scipy.sparse.csr_matrix(M), scipy.sparse.csr_matrix(K)
    part.surface = [{"Name": "none", "Trigs": np.zeros((0, 3), int), "Quads": np.zeros((0, 4), int)}]
    mbs = exu.SystemContainer().AddSystem()
    panel = ObjectFFRFreducedOrderInterface(part).AddObjectFFRFreducedOrder(mbs, gravity=[0, 0, -9.81])["oFFRFreducedOrder"]
    ground = mbs.AddObject(ObjectGround())
    for name in "ad":
        on_panel = mbs.AddMarker(MarkerSuperElementPosition(bodyNumber=panel, meshNodeNumbers=[names.index(name)], weightingFactors=[1.0]))
        on_ground = mbs.AddMarker(MarkerBodyPosition(bodyNumber=ground, localPosition=list(places[names.index(name)])))
        mbs.AddObject(SphericalJoint(markerNumbers=[on_ground, on_panel]))
    position = {"storeInternal": True, "outputVariableType": exu.OutputVariableType.Position}
    sensors = {name: mbs.AddSensor(SensorSuperElement(bodyNumber=panel, meshNodeNumber=names.index(name), **position)) for name in "bc"}
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = 0.4, 400
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.9
    settings.solutionSettings.sensorsWritePeriod, settings.solutionSettings.writeSolutionToFile = 1e-3, False
    began = time.process_time()
    mbs.SolveDynamic(settings)
    print(f"\nExudyn, {modes} modes: {time.process_time() - began:.3f} s")
    for form, result in ours.items():
        off = 0.0
        for (at, name), x in result.x.items():
            if name in sensors:
                rows = mbs.GetSensorStoredData(sensors[name])
                off = max(off, math.dist(rows[np.abs(rows[:, 0] - float(at)).argmin(), 1:], x))
        print(f"{off / 0.6:.1e} from `{form}`, whose steps take {result.report['timings']['loop_s']:.3f} s")


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
        return max(abs(b - balance[0]) for b in balance) / (max(e["kinetic"] for e in self.energies) or math.inf)


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
    parser.add_argument("scenes", nargs="*", default=["crank", "bars", "princeton", "plate", "spin", "tumble", "cab", "exudyn"])
    asked = parser.parse_args()
    pieces = [(f"{modes} modes, {count} pieces", f"{{ modes = {modes}, pieces = {count} }}") for count in (1, 2, 4) for modes in (0, 1, 3, 6)]
    forms = [("all elements", ""), *pieces, ("6 modes, linear", "{ modes = 6, geometric_stiffness = false }")]
    panels = [("all elements", ""), ("rigid", "rigid = true"), *((f"{modes} modes", f"reduced = {modes}") for modes in (0, 5, 20, 40))]
    if "crank" in asked.scenes:
        for speed in (30.0, 150.0):
            title = f"Slider-crank at {speed:g} rad/s; errors of places as a part of the rod"
            table(title, asked.program, crank, [(name, speed, reduced) for name, reduced in forms], 0.3)
    if "bars" in asked.scenes:
        table("Four-bar linkage; errors of places as a part of the coupler", asked.program, bars, forms, 3.5)
    if "princeton" in asked.scenes:
        more = [("6 modes, 8 pieces", "{ modes = 6, pieces = 8 }")]
        table("Princeton beam; errors of places as a part of its length", asked.program, princeton, forms[:-1] + more, 0.508)
    for scene, rest, meshes in (("plate", SWINGS, (10, 20, 30)), ("spin", SPINS, (24,))):
        for elements in meshes if scene in asked.scenes else ():
            title = f"Panel that {scene}s, {elements} elements along an edge; errors of places as a part of 0.6 m"
            table(title, asked.program, plate, [(name, elements, form, rest) for name, form in panels], 0.6)
    if "tumble" in asked.scenes:
        tumble(asked.program, 100_000)
    if "cab" in asked.scenes:
        print("\nSafety cab, side blow; errors of places as a part of 0.1 m\n\n| backbone | largest error | read s | loop s | iterations |\n|---|---|---|---|---|")
        deck, full = ROOT / "decks/safety_cab/side.toml", None
        for form in ("rigid=false", "rigid=true", "reduced=0", "reduced=5", "reduced=20"):
            free = [] if form.startswith("rigid") else ["--set", "beams.backbone.rigid=false"]
            result = Result(asked.program, deck, *free, "--set", f"beams.backbone.{form}")
            full = full or result
            print(f"| `{form}` | {difference(full, result) / 0.1:.1e} | {result.timings()} |", flush=True)
    if "exudyn" in asked.scenes:
        exudyn(asked.program, 20)


main()
