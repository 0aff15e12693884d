#!/usr/bin/env python3
"""A frame of three storeys that yields in an earthquake, beside OpenSees, in finer and finer meshes and steps.

    scripts/earthquake.py             this program alone, against the values of the deck
    scripts/earthquake.py --opensees  both; needs a Python in which `import openseespy.opensees` works (pip install openseespy)
    scripts/earthquake.py --record    writes decks/shaken_frame/quake.AT2 anew: the same bytes wherever it runs

OpenSees takes force-based beam-columns (forceBeamColumn) of fibre sections with the uniaxial material Hardening, elastic shear added to
the section, and the corotational transformation; masses, damping by mass and the record are those of the deck.
"""

import csv
import math
import random
import sys
import tempfile
from pathlib import Path

from scenes import ROOT, build, run

DECK = ROOT / "decks" / "shaken_frame" / "deck.toml"
RECORD = DECK.with_name("quake.AT2")
# What is compared: the largest magnitudes of the displacements of the floors and of the base shear, and the roof at the end.
QUANTITIES = ["ux_1", "ux_2", "ux_3", "shear", "end_3"]

E, NU, RHO, YIELD, HARDENING = 210e9, 0.3, 7850.0, 275e6, 4.2e9
COLUMN = {"width": 0.22, "height": 0.22, "wall": 0.012}
GIRDER = {"height": 0.30, "width": 0.15, "web": 0.0071, "flange": 0.0107}
STOREY, SPAN, FLOOR, GRAVITY, DAMPING, G = 3.2, 6.0, 6000.0, 9.81, 0.4, 9.81


def make_record() -> None:
    """White noise through the filter of Kanai and Tajimi, under an envelope, without a velocity at its end, 0.55 g at its largest."""
    step, count = 0.01, 1001
    dice = random.Random(1940)
    omega, zeta = 2.0 * math.pi * 2.5, 0.6
    x = v = 0.0
    values = []
    for k in range(count):
        t = k * step
        shape = (t / 1.5) ** 2 if t < 1.5 else 1.0 if t < 5.0 else math.exp(-0.7 * (t - 5.0))
        noise = shape * dice.gauss(0.0, 1.0)
        # Symplectic steps of the filter; the absolute acceleration of its mass is what shakes.
        for _ in range(10):
            v += step / 10 * (-noise - 2.0 * zeta * omega * v - omega * omega * x)
            x += step / 10 * v
        values.append(-2.0 * zeta * omega * v - omega * omega * x)
    # What is left of velocity is taken off in the shape of a half sine over all.
    weights = [math.sin(math.pi * k / (count - 1)) for k in range(count)]
    drift = sum(values) / sum(weights)
    values = [value - drift * weight for value, weight in zip(values, weights)]
    values[0] = values[-1] = 0.0
    largest = max(map(abs, values))
    words = [f"{0.55 / largest * value:15.7E}" for value in values]
    lines = ["ARTIFICIAL RECORD", "Noise through the filter of Kanai and Tajimi, see scripts/earthquake.py"]
    lines += ["ACCELERATION TIME SERIES IN UNITS OF G", f"NPTS= {count:6d}, DT= {step:.4f} SEC"]
    lines += ["".join(words[k : k + 5]) for k in range(0, count, 5)]
    RECORD.write_text("\n".join(lines) + "\n")


def record() -> list[float]:
    return [float(word) * G for line in RECORD.read_text().splitlines()[4:] for word in line.split()]


def thin(webs: int, web: float, arm: float, flange: float, height: float) -> float:
    """The shear area of one or two webs with four half flanges, by the energy of the shear flow over middle lines, as this program has it."""
    moment = webs * web * height**3 / 12.0 + 4.0 * arm * flange * (height / 2.0) ** 2
    first = 2.0 / webs * flange * arm * height / 2.0
    arms = 4.0 * flange * (height / 2.0) ** 2 * arm**3 / 3.0
    middle = first**2 * height + first * web * height**3 / 6.0 + web**2 * height**5 / 120.0
    return moment**2 / (arms + webs * middle / web)


class Frame:
    """The frame in OpenSees: so many elements to a member, a storey of a column or half a girder."""

    def __init__(self, elements: int, layers: int) -> None:
        import openseespy.opensees as ops

        self.ops, self.next_node, self.next_element, self.areas = ops, 1000, 1, {}
        ops.wipe()
        ops.model("basic", "-ndm", 2, "-ndf", 3)
        ops.uniaxialMaterial("Hardening", 1, E, YIELD, 0.0, HARDENING)
        # Both sections are rectangles: height from, height to, width, layers.
        b, t = COLUMN["width"], COLUMN["wall"]
        h, flange, web = GIRDER["height"] / 2, GIRDER["flange"], GIRDER["web"]
        ends = lambda half, t, width: [(-half, t - half, width, 4), (half - t, half, width, 4)]
        self.section(1, ends(b / 2, t, b) + [(t - b / 2, b / 2 - t, 2 * t, layers)], thin(2, t, (b - t) / 2, t, b - t))
        wide = GIRDER["width"]
        girder = ends(h, flange, wide) + [(flange - h, h - flange, web, layers)]
        self.section(2, girder, thin(1, web, wide / 2, flange, 2 * h - flange))
        ops.geomTransf("Corotational", 1)
        for line in range(3):
            for storey in range(4):
                if line != 1 or storey > 0:
                    ops.node(10 * line + storey, line * SPAN / 2, storey * STOREY)
        for line in (0, 20):
            ops.fix(line, 1, 1, 1)
            for storey in range(3):
                self.member(line + storey, line + storey + 1, 1, elements)
        for storey in (1, 2, 3):
            for line in (0, 10):
                self.member(line + storey, line + 10 + storey, 2, elements)
        self.weights()

    def section(self, tag: int, parts: list, shear: float) -> None:
        ops = self.ops
        self.areas[tag] = sum((top - bottom) * width for bottom, top, width, _ in parts)
        ops.uniaxialMaterial("Elastic", 10 + tag, E / 2 / (1 + NU) * shear)
        ops.section("Fiber", 10 + tag)
        for bottom, top, width, count in parts:
            ops.patch("rect", 1, count, 1, bottom, -width / 2, top, width / 2)
        ops.section("Aggregator", tag, 10 + tag, "Vy", "-section", 10 + tag)
        ops.beamIntegration("Lobatto", tag, tag, 5)

    def member(self, first: int, last: int, section: int, elements: int) -> None:
        ops = self.ops
        (x, y), (u, v) = ops.nodeCoord(first), ops.nodeCoord(last)
        # Short ones at the ends, where hinges form.
        lengths = [math.exp(-1.0 * abs(2.0 * (k + 0.5) / elements - 1.0)) for k in range(elements)]
        places = [sum(lengths[: k + 1]) / sum(lengths) for k in range(elements)]
        before = first
        for k, place in enumerate(places):
            node = last
            if k + 1 < elements:
                node = self.next_node = self.next_node + 1
                ops.node(node, x + place * (u - x), y + place * (v - y))
            mass = RHO * self.areas[section]
            ops.element("forceBeamColumn", self.next_element, before, node, 1, section, "-mass", mass, "-iter", 50, 1e-12)
            self.next_element += 1
            before = node

    def weights(self) -> None:
        ops = self.ops
        for line in (0, 10, 20):
            for storey in (1, 2, 3):
                ops.mass(line + storey, FLOOR, FLOOR, 0.0)
        # The weight of all: lumped as the mass is.
        total = {node: [FLOOR if node < 100 and node % 10 else 0.0] for node in ops.getNodeTags()}
        for element in ops.getEleTags():
            a, b = ops.eleNodes(element)
            (x, y), (u, v) = ops.nodeCoord(a), ops.nodeCoord(b)
            section = 1 if abs(x - u) < 1e-9 else 2
            half = RHO * self.areas[section] * math.hypot(x - u, y - v) / 2
            total[a].append(half)
            total[b].append(half)
        ops.timeSeries("Linear", 1)
        ops.pattern("Plain", 1, 1)
        for node, parts in total.items():
            ops.load(node, 0.0, -GRAVITY * sum(parts), 0.0)

    def run(self, step: float, end: float) -> dict[str, float]:
        ops = self.ops
        ops.constraints("Plain")
        ops.numberer("RCM")
        ops.system("UmfPack")
        ops.test("NormDispIncr", 1e-9, 50)
        ops.algorithm("Newton")
        ops.integrator("LoadControl", 0.5)
        ops.analysis("Static")
        assert ops.analyze(2) == 0
        ops.loadConst("-time", 0.0)
        ops.wipeAnalysis()
        ops.rayleigh(DAMPING, 0.0, 0.0, 0.0)
        ops.timeSeries("Path", 2, "-dt", 0.01, "-values", *record(), "-factor", 1.0)
        ops.pattern("UniformExcitation", 2, 1, "-accel", 2)
        ops.constraints("Plain")
        ops.numberer("RCM")
        ops.system("UmfPack")
        ops.test("NormDispIncr", 1e-9, 50)
        ops.algorithm("Newton")
        ops.integrator("Newmark", 0.5, 0.25)
        ops.analysis("Transient")
        found = dict.fromkeys(QUANTITIES, 0.0)
        for k in range(round(end / step)):
            assert ops.analyze(1, step) == 0, f"OpenSees does not converge at t = {k * step}"
            ops.reactions()
            now = {f"ux_{storey}": ops.nodeDisp(storey, 1) for storey in (1, 2, 3)}
            now["shear"] = ops.nodeReaction(0, 1) + ops.nodeReaction(20, 1)
            for name, value in now.items():
                found[name] = max(found[name], abs(value))
        found["end_3"] = ops.nodeDisp(3, 1)
        return found


def ours(sets: list[str]) -> dict[str, float]:
    """The same of this program."""
    with tempfile.TemporaryDirectory() as folder:
        run(DECK, sets + ["expect=[]", "output={ every = 1, joints = true }"], Path(folder))
        table = lambda name: csv.DictReader((Path(folder) / name).open(newline=""))
        found = dict.fromkeys(QUANTITIES, 0.0)
        for row in table("nodes.csv"):
            if row["stage"] == "quake" and row["node"] in ("left_1", "left_2", "left_3"):
                name, value = f"ux_{row['node'][-1]}", float(row["ux"])
                found[name] = max(found[name], abs(value))
                if name == "ux_3":
                    found["end_3"] = value
        for row in table("joints.csv"):
            if row["stage"] == "quake":
                found["shear"] = max(found["shear"], abs(float(row["fx"])))
        return found


def line(name: str, found: dict[str, float]) -> None:
    print(f"| {name} | " + " | ".join(f"{found[key]:.6g}" for key in QUANTITIES) + " |", flush=True)


def main() -> None:
    if "--record" in sys.argv:
        make_record()
        return
    build()
    print("| run | " + " | ".join(QUANTITIES) + " |\n|" + "---|" * (len(QUANTITIES) + 1))
    settings = ((4, 16, 5e-3), (4, 16, 2.5e-3), (8, 32, 2.5e-3), (8, 32, 1.25e-3))
    for elements, fibres, step in settings:
        sets = [f"beams.{name}.elements={elements}" for name in ("left", "right", "girder_1", "girder_2", "girder_3")]
        sets += [f"sections.{name}.fibres=[{fibres}, 2]" for name in ("column", "girder")]
        sets += [f"stages.quake.time_step={step}"]
        line(f"rdsolve, {elements} elements a member, {fibres} fibres, dt {step}", ours(sets))
    if "--opensees" in sys.argv:
        for elements, layers, step in settings:
            found = Frame(elements, layers).run(step, 12.0)
            line(f"OpenSees, {elements} elements a member, {layers} layers, dt {step}", found)


if __name__ == "__main__":
    main()
