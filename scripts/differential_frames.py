"""Random frames and trusses, as decks and for OpenSees. For differential.py.

Both programs solve the same rod: strains are small where loads are, so that corotational elements (OpenSees) and geometrically
exact ones (here) tend to the same answer with more elements. OpenSees: forceBeamColumn with the Corotational transformation, shear
in the section, masses lumped at nodes without rotary inertia; corotTruss. Its rotations in space are sums of increments and are
compared in a plane only.
"""

import math
from dataclasses import dataclass, field

import numpy as np

from differential_scene import TIMES, Failed, Result, reactions, table

E, NU, RHO = 210e9, 0.3, 7850.0
G = E / (2.0 * (1.0 + NU))
STEPS = {"static": 20, "dynamic": 120, "yielding": 32}


@dataclass
class Member:
    ends: tuple[str, str]
    section: str
    orientation: np.ndarray


@dataclass
class Frame:
    name: str
    kind: str
    """static, dynamic, yielding"""
    plane: bool
    points: dict[str, np.ndarray] = field(default_factory=dict)
    members: list[Member] = field(default_factory=list)
    bars: list[tuple[str, str, float]] = field(default_factory=list)
    sections: dict[str, dict] = field(default_factory=dict)
    clamps: dict[str, str] = field(default_factory=dict)
    """all, or translations"""
    forces: dict[str, np.ndarray] = field(default_factory=dict)
    moments: dict[str, np.ndarray] = field(default_factory=dict)
    masses: dict[str, float] = field(default_factory=dict)
    settlement: dict[str, np.ndarray] = field(default_factory=dict)
    gravity: np.ndarray = field(default_factory=lambda: np.zeros(3))
    history: list[tuple[float, float]] = field(default_factory=list)
    """Factor of the loads over the time of the run, a table."""
    end: float = 1.0
    mass_factor: float = 0.0
    hardening: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Yield stress, modulus, kinematic share"""
    warnings: tuple[str, ...] = ()

    @property
    def family(self) -> str:
        return f"{'plane' if self.plane else 'space'} {self.kind}"

    # ---- this program ----

    def deck(self, level: int) -> dict:
        steps = STEPS[self.kind] * 2**level
        dynamic = self.kind == "dynamic"
        deck = {
            "title": self.name,
            "analysis": {"kind": "dynamic" if dynamic else "static", "end_time": self.end, "time_step": self.end / steps},
            "iteration": {"tolerance": 1e-10},
        }
        if dynamic:
            deck["integrator"] = {"scheme": "newmark"}
        steel = {"youngs_modulus": E, "poisson_ratio": NU, "density": RHO, "model": "elastic"}
        if self.kind == "yielding":
            stress, modulus, share = self.hardening
            steel |= {"model": "elastic-plastic", "yield_stress": stress, "hardening_modulus": modulus, "kinematic_share": share}
        deck["materials"] = {"steel": steel}
        deck["sections"] = {name: self.deck_section(section) for name, section in self.sections.items()}
        deck["points"] = {name: list(x) for name, x in self.points.items()}
        deck["beams"] = [self.deck_beam(i, member, level) for i, member in enumerate(self.members)]
        deck["bars"] = [
            {"name": f"bar{i}", "path": [a, b], "area": area, "material": "steel", "mass": "none"}
            for i, (a, b, area) in enumerate(self.bars)
        ]
        deck["masses"] = [{"at": at, "mass": mass} for at, mass in self.masses.items()]
        deck["supports"] = [{"at": at, "fix": fix} for at, fix in self.clamps.items() if at not in self.settlement]
        for at, way in self.settlement.items():
            motion = {f"u{c}": {"amplitude": "history", "scale": way[i]} for i, c in enumerate("xyz")}
            deck["supports"].append({"at": at, "fix": "rotations", "motion": motion})
        deck["amplitudes"] = {"history": {"kind": "table", "points": [list(p) for p in self.history]}}
        deck["loads"] = [{"at": at, "force": list(f), "amplitude": "history"} for at, f in self.forces.items()]
        deck["loads"] += [{"at": at, "moment": list(m), "amplitude": "history"} for at, m in self.moments.items()]
        if self.gravity.any():
            deck["environment"] = {"gravity": list(self.gravity)}
        if self.mass_factor:
            deck["damping"] = {"mass_factor": self.mass_factor}
        deck["output"] = {"interval": self.end / TIMES, "reactions": True}
        return deck

    def deck_section(self, s: dict) -> dict:
        if self.kind == "yielding":
            fibres = [2, 24] if self.plane else [12, 12]
            return {"shape": "rectangle", "width": s["width"], "height": s["height"], "fibres": fibres}
        if s["shape"] == "rectangle":
            return {"shape": "rectangle", "width": s["width"], "height": s["height"]}
        return {
            "shape": "general", "area": s["A"], "moments": [s["Iy"], s["Iz"]], "torsion_constant": s["J"],
            "shear_areas": [s["Asy"], s["Asz"]],
        }  # fmt: skip

    def deck_beam(self, i: int, member: Member, level: int) -> dict:
        beam = {
            "name": f"beam{i}", "path": list(member.ends), "elements": 3 * 2**level, "material": "steel",
            "section": member.section, "orientation": list(member.orientation), "rotary_inertia": False,
        }  # fmt: skip
        if self.kind == "yielding":
            beam |= {"shear_yields": False, "elements": 6 * 2**level, "order": 2}
        return beam

    def watched(self) -> list[str]:
        return [p for p in self.points if p not in self.clamps]

    def supports(self) -> list[str]:
        return list(self.clamps)

    def read(self, folder) -> Result:
        six = reactions(folder / "reactions.csv", self.supports())
        found = {
            "displacement": table(folder / "nodes.csv", "node", ["ux", "uy", "uz"], self.watched()),
            "reaction": six[..., :3],
        }
        if self.members:
            found["moment"] = six[..., 3:]
        if self.plane and self.members:
            found["rotation"] = table(folder / "nodes.csv", "node", ["ry"], self.watched())
        return found

    # ---- OpenSees ----

    def other(self, level: int) -> Result:
        import openseespy.opensees as ops

        return OpenSees(ops, self, level).run()


class OpenSees:
    """One scene in OpenSees, in space with six degrees of freedom a node."""

    def __init__(self, ops, frame: Frame, level: int):
        self.ops, self.frame, self.level = ops, frame, level
        self.elements = {"static": 6, "dynamic": 5, "yielding": 6}[frame.kind] * 2**level
        self.nodes: dict[str, int] = {}
        self.count = self.element = 0
        self.lumped: dict[int, float] = {}
        self.weights: dict[int, float] = {}

    def node(self, x) -> int:
        self.count += 1
        self.ops.node(self.count, *map(float, x))
        return self.count

    def build(self) -> None:
        ops, frame = self.ops, self.frame
        ops.wipe()
        ops.model("basic", "-ndm", 3, "-ndf", 6 if frame.members else 3)
        self.nodes = {name: self.node(x) for name, x in frame.points.items()}
        self.inner: list[int] = []
        for i, (name, section) in enumerate(frame.sections.items()):
            self.section(i + 1, section)
        for i, member in enumerate(frame.members):
            self.member(i + 1, member)
        for i, (a, b, area) in enumerate(frame.bars):
            ops.uniaxialMaterial("Elastic", 9000 + i, E)
            self.element += 1
            ops.element("corotTruss", self.element, self.nodes[a], self.nodes[b], area, 9000 + i)
        for name, mass in frame.masses.items():
            self.lumped[self.nodes[name]] = self.lumped.get(self.nodes[name], 0.0) + mass
        size = 6 if frame.members else 3
        if frame.kind == "dynamic":
            for node, mass in self.lumped.items():
                ops.mass(node, *[mass] * 3, *[0.0] * (size - 3))
        for name, fix in frame.clamps.items():
            held = [1] * 3 + [1 if fix == "all" else 0] * 3
            if name in frame.settlement:
                held = [0] * 3 + [1] * 3
            ops.fix(self.nodes[name], *held[:size])
        if frame.plane:
            # Motion out of the plane is left out, as this program does.
            for node in range(1, self.count + 1):
                if node not in {self.nodes[name] for name in frame.clamps}:
                    ops.fix(node, *[0, 1, 0, 1, 0, 1][:size])
        if frame.plane and frame.members:
            for name, fix in frame.clamps.items():
                if fix != "all":
                    ops.fix(self.nodes[name], 0, 0, 0, 1, 0, 1)

    def section(self, tag: int, s: dict) -> None:
        ops, frame = self.ops, self.frame
        if frame.kind != "yielding":
            ops.section("Elastic", tag, E, s["A"], s["Iz"], s["Iy"], G, s["J"], s["Asy"] / s["A"], s["Asz"] / s["A"])
            return
        stress, modulus, share = frame.hardening
        ops.uniaxialMaterial("Hardening", tag, E, stress, (1.0 - share) * modulus, share * modulus)
        for i, stiffness in enumerate((G * s["Asy"], G * s["Asz"])):
            ops.uniaxialMaterial("Elastic", 1000 * (i + 1) + tag, stiffness)
        ops.section("Fiber", 5000 + tag, "-GJ", G * s["J"])
        y, z, (ny, nz) = s["width"] / 2, s["height"] / 2, 2**self.level * np.array((2, 48) if frame.plane else (16, 16))
        ops.patch("rect", tag, int(ny), int(nz), -y, -z, y, z)
        ops.section("Aggregator", tag, 1000 + tag, "Vy", 2000 + tag, "Vz", "-section", 5000 + tag)

    def member(self, tag: int, member: Member) -> None:
        ops, n = self.ops, self.elements
        a, b = (self.frame.points[p] for p in member.ends)
        along = (b - a) / np.linalg.norm(b - a)
        z = np.cross(along, member.orientation)
        ops.geomTransf("Corotational", tag, *map(float, z / np.linalg.norm(z)))
        section = list(self.frame.sections).index(member.section) + 1
        ops.beamIntegration("Lobatto", tag, section, 4 if self.frame.kind == "yielding" else 3)
        nodes = [self.nodes[member.ends[0]]] + [self.node(a + (b - a) * i / n) for i in range(1, n)] + [self.nodes[member.ends[1]]]
        mass = RHO * self.frame.sections[member.section]["A"] * np.linalg.norm(b - a) / n
        for one, two in zip(nodes, nodes[1:]):
            self.element += 1
            ops.element("forceBeamColumn", self.element, one, two, tag, tag, "-iter", 50, 1e-12)
            for node in (one, two):
                self.lumped[node] = self.lumped.get(node, 0.0) + mass / 2

    def load(self, step: float) -> None:
        ops, frame = self.ops, self.frame
        times = np.arange(0.0, frame.end + 1.5 * step, step)
        values = np.interp(times, *zip(*frame.history))
        ops.timeSeries("Path", 1, "-dt", step, "-values", *map(float, values), "-useLast")
        ops.pattern("Plain", 1, 1)
        zero = [0.0] * 3
        for name in {**frame.forces, **frame.moments}:
            six = [*frame.forces.get(name, zero), *frame.moments.get(name, zero)]
            ops.load(self.nodes[name], *map(float, six[: 6 if frame.members else 3]))
        for name, way in frame.settlement.items():
            for i in range(3):
                ops.sp(self.nodes[name], i + 1, float(way[i]))
        if frame.gravity.any():
            ops.timeSeries("Linear", 2, "-factor", 1.0 / frame.end)
            ops.pattern("Plain", 2, 2)
            for node, mass in self.lumped.items():
                six = [*(mass * frame.gravity), 0.0, 0.0, 0.0]
                ops.load(node, *map(float, six[: 6 if frame.members else 3]))

    def run(self) -> Result:
        ops, frame = self.ops, self.frame
        self.build()
        steps = STEPS[frame.kind] * 2**self.level
        step = frame.end / steps
        self.load(step)
        ops.constraints("Transformation")
        ops.numberer("RCM")
        ops.system("UmfPack")
        # Newton's method converges quadratically: the last increment is far above what is left.
        ops.test("NormDispIncr", 1e-8, 40, 0)
        ops.algorithm("Newton")
        if frame.kind == "dynamic":
            if frame.mass_factor:
                ops.rayleigh(frame.mass_factor, 0.0, 0.0, 0.0)
            ops.integrator("Newmark", 0.5, 0.25)
            ops.analysis("Transient")
        else:
            ops.integrator("LoadControl", step)
            ops.analysis("Static")
        found: dict[str, list] = {"displacement": [], "reaction": [], "moment": [], "rotation": []}
        for i in range(1, steps + 1):
            if ops.analyze(1, step) if frame.kind == "dynamic" else self.advance(step):
                raise Failed(f"OpenSees does not converge in step {i} of {steps}")
            if i % (steps // TIMES) == 0:
                self.collect(found)
        ops.wipe()
        result = {key: np.array(values) for key, values in found.items()}
        if not frame.members:
            result.pop("moment")
        if not (frame.plane and frame.members):
            result.pop("rotation")
        return result

    def advance(self, step: float) -> int:
        """A load step, in ever shorter ones where it does not converge."""
        ops, end = self.ops, self.ops.getTime() + step
        for pieces in (1, 4, 16, 64):
            ops.integrator("LoadControl", step / pieces)
            while ops.getTime() < end - 1e-9 * step:
                if ops.analyze(1):
                    break
            else:
                return 0
            step = end - ops.getTime()
        return 1

    def collect(self, found: dict[str, list]) -> None:
        ops, frame = self.ops, self.frame
        ops.reactions("-dynamic") if frame.kind == "dynamic" else ops.reactions()
        moved = [ops.nodeDisp(self.nodes[name]) for name in frame.watched()]
        held = [ops.nodeReaction(self.nodes[name]) for name in frame.supports()]
        if frame.gravity.any():
            factor = ops.getTime() / frame.end
            # The weight that OpenSees puts on a held node goes into its reaction there as here.
            assert factor > 0.0
        found["displacement"].append([u[:3] for u in moved])
        found["reaction"].append([r[:3] for r in held])
        if frame.members:
            found["moment"].append([r[3:] for r in held])
            found["rotation"].append([u[4:5] for u in moved])


# ---- random scenes ----


def uniform(rng, low, high):
    return low * (high / low) ** rng.random()


def random_section(rng, length: float, yielding: bool, slender=(20.0, 60.0)) -> dict:
    height = length / uniform(rng, *slender)
    width = height * uniform(rng, 0.4, 2.5)
    A, a, b = width * height, max(width, height), min(width, height)
    series = sum(math.tanh(n * math.pi * a / (2 * b)) / n**5 for n in range(1, 60, 2))
    section = {
        "shape": "rectangle", "width": width, "height": height, "A": A, "Iy": A * height**2 / 12, "Iz": A * width**2 / 12,
        "J": a * b**3 / 3 * (1 - 192 * b / (math.pi**5 * a) * series), "Asy": 5 / 6 * A, "Asz": 5 / 6 * A,
    }  # fmt: skip
    if not yielding and rng.random() < 0.5:
        section |= {"shape": "general", "Asy": A * uniform(rng, 0.2, 0.9), "Asz": A * uniform(rng, 0.2, 0.9)}
        section["J"] *= uniform(rng, 0.3, 1.0)
    return section


def direction(rng, plane: bool) -> np.ndarray:
    v = np.array([rng.gauss(0, 1), 0.0 if plane else rng.gauss(0, 1), rng.gauss(0, 1)])
    return v / np.linalg.norm(v)


def orientation(rng, frame: Frame, ends) -> np.ndarray:
    if frame.plane:
        return np.array([0.0, 1.0, 0.0])
    along = frame.points[ends[1]] - frame.points[ends[0]]
    along = along / np.linalg.norm(along)
    while True:
        v = direction(rng, False)
        if abs(v @ along) < 0.8:
            return v


def join(rng, frame: Frame, *ends: tuple[str, str]) -> None:
    for pair in ends:
        section = rng.choice(list(frame.sections))
        frame.members.append(Member(pair, section, orientation(rng, frame, pair)))


def cantilever(rng, frame: Frame) -> None:
    frame.points["p0"], heading = np.zeros(3), direction(rng, frame.plane)
    for i in range(rng.randint(1, 3)):
        frame.points[f"p{i + 1}"] = frame.points[f"p{i}"] + heading * uniform(rng, 0.5, 1.5)
        while True:
            turned = direction(rng, frame.plane)
            if turned @ heading > -0.5:
                break
        heading = turned
    names = list(frame.points)
    join(rng, frame, *zip(names, names[1:]))
    frame.clamps["p0"] = "all"
    frame.forces[names[-1]] = direction(rng, frame.plane)


def portal(rng, frame: Frame) -> None:
    width, left, right = (uniform(rng, 0.8, 2.0) for _ in range(3))
    tilt = 0.0 if frame.plane else rng.uniform(-0.3, 0.3)
    frame.points |= {
        "foot_left": np.zeros(3), "knee_left": np.array([rng.uniform(-0.2, 0.2), tilt, left]),
        "knee_right": np.array([width, -tilt, right]), "foot_right": np.array([width + rng.uniform(-0.2, 0.2), 0.0, 0.0]),
    }  # fmt: skip
    join(rng, frame, ("foot_left", "knee_left"), ("knee_left", "knee_right"), ("knee_right", "foot_right"))
    frame.clamps["foot_left"] = "all"
    frame.clamps["foot_right"] = "translations" if frame.plane and rng.random() < 0.4 else "all"
    frame.forces["knee_left"] = direction(rng, frame.plane)
    frame.forces["knee_right"] = direction(rng, frame.plane) * rng.random()


def grid(rng, frame: Frame) -> None:
    """Two girders that cross, clamped at their ends; in a plane a tree."""
    if frame.plane:
        return tree(rng, frame)
    ends = [np.array([1.0, 0, 0]), np.array([0, 1.0, 0]), np.array([-1.0, 0, 0]), np.array([0, -1.0, 0])]
    frame.points["middle"] = np.zeros(3)
    for i, end in enumerate(ends[: rng.randint(2, 4)]):
        frame.points[f"e{i}"] = end * uniform(rng, 0.6, 1.6) + np.array([0, 0, rng.uniform(-0.2, 0.2)])
        join(rng, frame, ("middle", f"e{i}"))
        frame.clamps[f"e{i}"] = "all"
    frame.forces["middle"] = direction(rng, frame.plane)


def tree(rng, frame: Frame) -> None:
    """Branches from the ground; their free ends tell the rotations of the nodes that they grow from."""
    frame.points["root"] = np.zeros(3)
    frame.clamps["root"] = "all"
    frame.points["fork"] = direction(rng, frame.plane) * uniform(rng, 0.6, 1.5)
    join(rng, frame, ("root", "fork"))
    for i in range(rng.randint(1, 3)):
        frame.points[f"twig{i}"] = frame.points["fork"] + direction(rng, frame.plane) * uniform(rng, 0.4, 1.2)
        join(rng, frame, ("fork", f"twig{i}"))
    frame.forces["twig0"] = direction(rng, frame.plane)
    if rng.random() < 0.5:
        frame.moments["fork"] = direction(rng, frame.plane) if not frame.plane else np.array([0.0, 1.0, 0.0])


def truss(rng, frame: Frame) -> None:
    """Bars from supports to an apex, in space three or more, in a plane two, with a second apex on top."""
    feet = 2 if frame.plane else rng.randint(3, 4)
    for i in range(feet):
        angle = math.tau * i / feet
        frame.points[f"foot{i}"] = np.array([math.cos(angle), 0.0 if frame.plane else math.sin(angle), 0.0]) * uniform(rng, 0.6, 1.5)
        frame.clamps[f"foot{i}"] = "translations"
    frame.points["apex"] = np.array([0.1 * rng.random(), 0.0 if frame.plane else 0.1 * rng.random(), uniform(rng, 0.5, 2.0)])
    frame.bars = [(f"foot{i}", "apex", 1e-4 * uniform(rng, 0.3, 3.0)) for i in range(feet)]
    frame.points["top"] = frame.points["apex"] + np.array([0.2, 0.0 if frame.plane else 0.3, uniform(rng, 0.4, 1.0)])
    frame.bars += [(f"foot{i}", "top", 1e-4 * uniform(rng, 0.3, 3.0)) for i in range(feet)]
    frame.forces = {"apex": direction(rng, frame.plane), "top": direction(rng, frame.plane)}
    if frame.plane:
        # Nothing holds nodes of bars out of the plane, and nothing moves them.
        frame.bars.append(("apex", "top", 1e-4))


def random_frame(rng, number: int) -> Frame:
    kind = ("static", "static", "dynamic", "yielding")[number % 4]
    frame = Frame(f"frame {number}", kind, plane=rng.random() < 0.5)
    shapes = [cantilever, portal, grid, tree] + ([truss] if kind != "yielding" else [])
    shape = rng.choice(shapes)
    for i in range(rng.randint(1, 2)):
        frame.sections[f"s{i}"] = random_section(rng, 1.0, kind == "yielding", (15.0, 40.0) if kind == "yielding" else (25.0, 80.0))
    shape(rng, frame)
    frame.name += f": {shape.__name__}"
    scale_loads(rng, frame)
    extras(rng, frame)
    return frame


def scale_loads(rng, frame: Frame) -> None:
    extent = max(np.linalg.norm(x - y) for x in frame.points.values() for y in frame.points.values())
    if frame.bars:
        size = 1e-4 * E * uniform(rng, 1e-4, 3e-3)
    else:
        softest = min(frame.sections.values(), key=lambda s: min(s["Iy"], s["Iz"]))
        inertia = softest["Iy"] if frame.plane else min(softest["Iy"], softest["Iz"])
        size = E * inertia / extent**2 * uniform(rng, 0.05, 1.0 if frame.kind != "yielding" else 2.0)
    for forces, arm in ((frame.forces, 1.0), (frame.moments, 0.5 * extent)):
        for name in forces:
            forces[name] = forces[name] * size * arm
    if frame.kind == "yielding":
        # The load at which the outermost fibre of a cantilever of that length would yield, over 0.4 to 0.9.
        moment = size * extent
        stress = moment * softest["height"] / 2 / softest["Iy"]
        frame.hardening = (stress * rng.uniform(0.4, 0.9), E * uniform(rng, 0.01, 0.1), rng.choice([0.0, 1.0, rng.random()]))


def extras(rng, frame: Frame) -> None:
    free = frame.watched()
    if frame.kind == "dynamic":
        if frame.bars:
            frame.masses = {name: uniform(rng, 1.0, 10.0) for name in free}
            stiffness, mass = E * 1e-4, 5.0
            period = math.tau * math.sqrt(mass / stiffness)
        else:
            for name in free:
                if rng.random() < 0.4:
                    frame.masses[name] = RHO * 1e-3 * uniform(rng, 0.1, 3.0)
            s = next(iter(frame.sections.values()))
            period = math.tau / 3.5 * math.sqrt(RHO * s["A"] / (E * s["Iy"]))
        # Loads rise smoothly over half of the time, so that both programs resolve what they excite.
        frame.end = period * uniform(rng, 0.5, 2.0)
        times = np.linspace(0.0, 1.0, 41)
        rise = np.where(times < 0.6, np.sin(math.pi * times / 1.2) ** 2, 1.0)
        frame.history = [(float(t * frame.end), float(v)) for t, v in zip(times, rise)]
        if rng.random() < 0.3:
            frame.mass_factor = rng.random() / frame.end
    elif frame.kind == "yielding":
        cycles = [0.0, 1.0] if rng.random() < 0.4 else [0.0, 1.0, -rng.random(), rng.random(), 0.0]
        frame.history = [(i / (len(cycles) - 1), v) for i, v in enumerate(cycles)]
    else:
        frame.history = [(0.0, 0.0), (1.0, 1.0)]
        if frame.members and rng.random() < 0.3:
            frame.gravity = direction(rng, frame.plane) * 9.81
        held = [name for name, fix in frame.clamps.items() if fix == "all"]
        if frame.members and held and rng.random() < 0.3:
            frame.settlement[rng.choice(held)] = direction(rng, frame.plane) * 0.05
