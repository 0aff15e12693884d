"""Random mechanisms, as decks and for Exudyn. For differential.py.

Rigid bodies with any inertia on joints, springs and dampers: trees of bodies, closed loops, tops, bodies that fly on springs. Both
programs integrate with schemes of second order; joint forces are those on the first body, at its end of the joint.
"""

import math
from dataclasses import dataclass, field

import numpy as np

from differential_scene import TIMES, Failed, Result, reactions, table

STEPS = 400
# Constraints in the joint's own frame, its z along the axis: three displacements, three rotations.
FREE = {
    "spherical": [1, 1, 1, 0, 0, 0], "revolute": [1, 1, 1, 1, 1, 0], "prismatic": [1, 1, 0, 1, 1, 1],
    "cylindrical": [1, 1, 0, 1, 1, 0], "fixed": [1, 1, 1, 1, 1, 1],
}  # fmt: skip


@dataclass
class Body:
    name: str
    center: np.ndarray
    mass: float
    inertia: np.ndarray
    velocity: np.ndarray = field(default_factory=lambda: np.zeros(3))
    omega: np.ndarray = field(default_factory=lambda: np.zeros(3))


@dataclass
class Joint:
    name: str
    kind: str
    bodies: tuple[str, str]
    """The second may be the ground."""
    point: np.ndarray
    axis: np.ndarray


@dataclass
class Spring:
    bodies: tuple[str, str]
    points: tuple[np.ndarray, np.ndarray]
    free: float
    stiffness: float
    damping: float


@dataclass
class Mechanism:
    name: str
    family: str
    bodies: list[Body] = field(default_factory=list)
    joints: list[Joint] = field(default_factory=list)
    springs: list[Spring] = field(default_factory=list)
    gravity: np.ndarray = field(default_factory=lambda: np.array([0.0, 0.0, -9.81]))
    end: float = 1.0
    scheme: str = "newmark"

    # ---- this program ----

    def deck(self, level: int) -> dict:
        end = lambda body, point: {"ground": list(point)} if body == "ground" else {"body": body, "point": list(point)}
        inertia = lambda J: [J[0, 0], J[1, 1], J[2, 2], J[0, 1], J[1, 2], J[2, 0]]
        return {
            "title": self.name,
            "analysis": {"kind": "dynamic", "end_time": self.end, "time_step": self.end / (STEPS * 2**level), "plane": "off"},
            "integrator": {"scheme": self.scheme},
            "iteration": {"tolerance": 1e-10},
            "bodies": [
                {"name": b.name, "center": list(b.center), "mass": b.mass, "inertia": inertia(b.inertia),
                 "velocity": list(b.velocity), "angular_velocity": list(b.omega)}
                for b in self.bodies
            ],
            "joints": [
                {"name": j.name, "kind": j.kind, "from": end(j.bodies[0], j.point), "to": end(j.bodies[1], j.point)}
                | ({"axis": list(j.axis)} if j.kind in ("revolute", "prismatic", "cylindrical") else {})
                for j in self.joints
            ],
            "links": [
                {"name": f"spring{i}", "from": end(s.bodies[0], s.points[0]), "to": end(s.bodies[1], s.points[1]),
                 "free_length": s.free, "stiffness": s.stiffness, "damping": s.damping}
                for i, s in enumerate(self.springs)
            ],
            "environment": {"gravity": list(self.gravity)},
            "output": {"interval": self.end / TIMES, "reactions": True},
        }  # fmt: skip

    def read(self, folder) -> Result:
        names, bodies = [b.name for b in self.bodies], folder / "bodies.csv"
        start = np.array([b.center for b in self.bodies])
        q = table(bodies, "body", ["qw", "qx", "qy", "qz"], names)
        result = {
            "displacement": table(bodies, "body", ["x", "y", "z"], names) - start,
            "rotation": np.array([[matrix(*body).ravel() for body in bodies_] for bodies_ in q]),
            "velocity": table(bodies, "body", ["vx", "vy", "vz"], names),
            "angular velocity": table(bodies, "body", ["wx", "wy", "wz"], names),
        }
        if self.joints:
            rows = [j.name + (".to" if j.bodies[1] == "ground" else "") for j in self.joints]
            result["joint force"] = reactions(folder / "reactions.csv", rows)[..., :3]
        return result

    # ---- Exudyn ----

    def other(self, level: int) -> Result:
        import exudyn as exu

        container = exu.SystemContainer()
        mbs = container.AddSystem()
        sensors = self.build(exu, mbs)
        mbs.Assemble()
        settings = exu.SimulationSettings()
        steps = STEPS * 2**level
        settings.timeIntegration.numberOfSteps = steps
        settings.timeIntegration.endTime = self.end
        settings.timeIntegration.verboseMode = 0
        settings.timeIntegration.newton.relativeTolerance = 1e-10
        settings.timeIntegration.newton.absoluteTolerance = 1e-12
        settings.timeIntegration.generalizedAlpha.spectralRadius = 0.9
        settings.solutionSettings.writeSolutionToFile = False
        settings.solutionSettings.sensorsWritePeriod = self.end / TIMES
        try:
            mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.GeneralizedAlpha, showHints=False)
        except Exception as error:  # whatever it raises, it gave no answer
            raise Failed(f"Exudyn: {str(error)[:200]}") from error
        return self.collect(mbs, sensors)

    def build(self, exu, mbs):
        from exudyn.utilities import RigidBodyInertia, SensorBody, SensorObject

        ground = mbs.CreateGround()
        numbers, sensors = {"ground": ground}, {}
        for b in self.bodies:
            numbers[b.name] = mbs.CreateRigidBody(
                referencePosition=b.center, inertia=RigidBodyInertia(mass=b.mass, inertiaTensor=b.inertia),
                initialVelocity=b.velocity, initialAngularVelocity=b.omega, gravity=list(self.gravity),
            )  # fmt: skip
            for kind in ("Displacement", "RotationMatrix", "Velocity", "AngularVelocity"):
                sensors[b.name, kind] = mbs.AddSensor(
                    SensorBody(bodyNumber=numbers[b.name], storeInternal=True, outputVariableType=getattr(exu.OutputVariableType, kind))
                )
        local = lambda body, point: list(point if body == "ground" else point - self.body(body).center)
        for j in self.joints:
            number = mbs.CreateGenericJoint(
                itemNumbers=[numbers[j.bodies[0]], numbers[j.bodies[1]]], position=list(j.point), rotationMatrixAxes=frame(j.axis),
                constrainedAxes=FREE[j.kind], show=False,
            )  # fmt: skip
            sensors[j.name] = mbs.AddSensor(
                SensorObject(objectNumber=number, storeInternal=True, outputVariableType=exu.OutputVariableType.ForceLocal)
            )
        for s in self.springs:
            mbs.CreateSpringDamper(
                itemNumbers=[numbers[name] for name in s.bodies], localPosition0=local(s.bodies[0], s.points[0]),
                localPosition1=local(s.bodies[1], s.points[1]), referenceLength=s.free, stiffness=s.stiffness, damping=s.damping,
                show=False,
            )  # fmt: skip
        return sensors

    def collect(self, mbs, sensors) -> Result:
        def history(key):
            data = np.asarray(mbs.GetSensorStoredData(sensors[key]))
            wanted = np.linspace(self.end / TIMES, self.end, TIMES)
            rows = [int(np.argmin(abs(data[:, 0] - t))) for t in wanted]
            if max(abs(data[rows, 0] - wanted)) > 1e-6 * self.end:
                raise Failed("Exudyn: no values at the times wanted")
            return data[rows, 1:]

        def all_bodies(kind):
            return np.stack([history((b.name, kind)) for b in self.bodies], axis=1)

        rotation = all_bodies("RotationMatrix")
        result = {
            "displacement": all_bodies("Displacement"), "rotation": rotation,
            "velocity": all_bodies("Velocity"), "angular velocity": all_bodies("AngularVelocity"),
        }  # fmt: skip
        if self.joints:
            names = [b.name for b in self.bodies]
            forces = []
            for j in self.joints:
                turned = rotation[:, names.index(j.bodies[0])].reshape(-1, 3, 3) @ frame(j.axis)
                forces.append(np.einsum("tij,tj->ti", turned, history(j.name)[:, :3]))
            result["joint force"] = np.stack(forces, axis=1)
        return result

    def body(self, name: str) -> Body:
        return next(b for b in self.bodies if b.name == name)


def matrix(w, x, y, z) -> np.ndarray:
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])  # fmt: skip


def frame(axis: np.ndarray) -> np.ndarray:
    """Columns x, y, z with z along the axis."""
    z = axis / np.linalg.norm(axis)
    x = np.cross(np.eye(3)[np.argmin(abs(z))], z)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])


# ---- random scenes ----


def uniform(rng, low, high):
    return low * (high / low) ** rng.random()


def unit(rng) -> np.ndarray:
    v = np.array([rng.gauss(0, 1) for _ in range(3)])
    return v / np.linalg.norm(v)


def random_body(rng, name: str, center) -> Body:
    """Moments of inertia that a body of three masses on three axes has."""
    mass, a, b, c = uniform(rng, 0.3, 30.0), *(uniform(rng, 0.05, 0.4) ** 2 for _ in range(3))
    axes = frame(unit(rng)) if rng.random() < 0.7 else np.eye(3)
    principal = np.diag([b + c, c + a, a + b]) * mass
    inertia = axes @ principal @ axes.T
    return Body(name, np.array(center), mass, (inertia + inertia.T) / 2)


def turn_as_one(mechanism: Mechanism, omega: np.ndarray, about: np.ndarray) -> None:
    for b in mechanism.bodies:
        b.omega, b.velocity = omega, np.cross(omega, b.center - about)


def tree(rng, mechanism: Mechanism, kinds: list[str], count: int) -> None:
    """Bodies each on an earlier one or on the ground, by a joint at a point near both."""
    for i in range(count):
        parent = mechanism.bodies[rng.randrange(max(0, i - 2), i)] if i else None
        joint = np.zeros(3) if parent is None else parent.center + unit(rng) * uniform(rng, 0.1, 0.6)
        body = random_body(rng, f"b{i}", joint + unit(rng) * uniform(rng, 0.1, 0.7))
        mechanism.bodies.append(body)
        kind = rng.choice(kinds)
        mechanism.joints.append(Joint(f"j{i}", kind, (body.name, parent.name if parent else "ground"), joint, unit(rng)))


def chain(rng) -> Mechanism:
    mechanism = Mechanism("pendulums", "mechanism: chain")
    tree(rng, mechanism, ["spherical", "revolute"], rng.randint(1, 4))
    first = mechanism.joints[0]
    about = first.axis if first.kind == "revolute" else unit(rng)
    turn_as_one(mechanism, about * rng.uniform(0.0, 6.0), first.point)
    return mechanism


def sliders(rng) -> Mechanism:
    mechanism = Mechanism("sliders", "mechanism: sliders")
    tree(rng, mechanism, ["prismatic", "cylindrical", "revolute", "spherical", "fixed"], rng.randint(1, 4))
    mechanism.joints[0].kind = rng.choice(["prismatic", "cylindrical"])
    speed = mechanism.joints[0].axis * rng.uniform(-2.0, 2.0)
    for b in mechanism.bodies:
        b.velocity = speed
    add_springs(rng, mechanism, rng.randint(1, 3))
    return mechanism


def add_springs(rng, mechanism: Mechanism, count: int) -> None:
    for _ in range(count):
        body = rng.choice(mechanism.bodies)
        others = [b for b in mechanism.bodies if b is not body]
        other = rng.choice(others + [None])
        here = body.center + unit(rng) * 0.2
        there = (other.center if other else body.center) + unit(rng) * (0.2 if other else 1.0)
        length = float(np.linalg.norm(here - there))
        if length < 0.1:
            continue
        stiffness = body.mass * uniform(rng, 3.0, 15.0) ** 2
        damping = rng.choice([0.0, 0.05 * math.sqrt(stiffness * body.mass)])
        bodies = (body.name, other.name if other else "ground")
        mechanism.springs.append(Spring(bodies, (here, there), length * rng.uniform(0.7, 1.2), stiffness, damping))


def top(rng) -> Mechanism:
    mechanism = Mechanism("top", "mechanism: top")
    axis = unit(rng)
    body = random_body(rng, "top", axis * uniform(rng, 0.1, 0.5))
    if rng.random() < 0.5:
        # A symmetric one that spins fast.
        a, c = uniform(rng, 0.05, 0.2), uniform(rng, 0.1, 0.3)
        body.inertia = body.mass * (a**2 * np.eye(3) + min(c**2, 0.9 * a**2) * np.outer(axis, axis))
    mechanism.bodies.append(body)
    mechanism.joints.append(Joint("pivot", "spherical", ("top", "ground"), np.zeros(3), unit(rng)))
    turn_as_one(mechanism, axis * uniform(rng, 3.0, 30.0) + unit(rng), np.zeros(3))
    return mechanism


def flying(rng) -> Mechanism:
    mechanism = Mechanism("bodies on springs", "mechanism: springs")
    for i in range(rng.randint(1, 3)):
        body = random_body(rng, f"b{i}", [1.0 * i, rng.uniform(-0.3, 0.3), rng.uniform(-0.3, 0.3)])
        body.velocity, body.omega = unit(rng) * rng.uniform(0, 1), unit(rng) * rng.uniform(0, 5)
        mechanism.bodies.append(body)
    add_springs(rng, mechanism, rng.randint(2, 6))
    return mechanism


def loop(rng) -> Mechanism:
    """Crank, coupler and rocker: revolute, spherical, cylindrical or spherical, revolute, so that nothing is held twice."""
    mechanism = Mechanism("four bars", "mechanism: loop")
    a, d = np.zeros(3), np.array([uniform(rng, 0.8, 1.6), rng.uniform(-0.2, 0.2), 0.0])
    b, c = a + unit(rng) * uniform(rng, 0.3, 0.8), d + np.array([rng.uniform(-0.3, 0.3), rng.uniform(-0.3, 0.3), uniform(rng, 0.4, 1.0)])
    for name, p, q in (("crank", a, b), ("coupler", b, c), ("rocker", c, d)):
        mechanism.bodies.append(random_body(rng, name, (p + q) / 2 + unit(rng) * 0.05))
    mechanism.joints = [
        Joint("A", "revolute", ("crank", "ground"), a, np.cross(unit(rng), b - a)),
        Joint("B", "spherical", ("crank", "coupler"), b, unit(rng)),
        Joint("C", rng.choice(["spherical", "cylindrical"]), ("coupler", "rocker"), c, unit(rng)),
        Joint("D", "revolute", ("rocker", "ground"), d, np.cross(unit(rng), d - c)),
    ]
    if rng.random() < 0.5:
        add_springs(rng, mechanism, 1)
    return mechanism


def random_mechanism(rng, number: int) -> Mechanism:
    mechanism = (chain, sliders, top, flying, loop)[number % 5](rng)
    mechanism.name = f"mechanism {number}: {mechanism.name}"
    if rng.random() < 0.3:
        mechanism.gravity = unit(rng) * 9.81
    mechanism.end = uniform(rng, 0.4, 1.2)
    mechanism.scheme = rng.choice(["newmark", "wilson-theta", "generalized-alpha", "bathe", "hht-alpha"])
    return mechanism
