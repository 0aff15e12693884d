#!/usr/bin/env python3
"""Largest motions and forces of decks/pendulum_bearings and decks/lead_rubber_bearings by OpenSees, in shorter and shorter steps.

    scripts/bearings.py      needs a Python in which `import openseespy.opensees` works (pip install openseespy)

OpenSees takes its elements singleFPBearing, with friction by the speed, and elastomericBearingPlasticity. Its slider does not rise on the dish, so the
weight on it stays constant. `pendulum` integrates the equations with the rise by central differences in steps of 1e-5 s.
"""

import math
import tomllib

import openseespy.opensees as ops

from earthquake import record
from scenes import ROOT

COLUMNS = ["base x", "base y", "top x", "bearing x", "bearing y", "storey x", "base x at the end", "base y at the end"]


def run(name: str, step: float) -> list[float]:
    deck = tomllib.loads((ROOT / "decks" / name / "deck.toml").read_text())
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    for node in range(3):
        ops.node(node, 0.0, 0.0, 0.0)
        if node:
            mass = deck["masses"][node - 1]["mass"]
            ops.mass(node, mass, mass, mass, 0.0, 0.0, 0.0)
        ops.fix(node, *([1] * 6 if node == 0 else [0, 0, 0, 1, 1, 1]))
    bearing, *storeys = deck["links"]
    for number, storey in enumerate(storeys):
        ops.uniaxialMaterial("Elastic", 1 + number, storey["stiffness"], storey["damping"])
    ops.uniaxialMaterial("Elastic", 4, bearing["axial_stiffness"])
    ops.uniaxialMaterial("Elastic", 5, 1.0)
    others = ["-P", 4, "-T", 5, "-My", 5, "-Mz", 5, "-orient", 0.0, 0.0, 1.0, 1.0, 0.0, 0.0]
    if bearing["law"] == "friction-pendulum":
        friction = bearing["friction"]
        ops.frictionModel("VelDependent", 1, friction["slow"], friction["fast"], friction["rate"])
        ops.element("singleFPBearing", 1, 0, 1, 1, bearing["radius"], bearing["stiffness"], *others, "-iter", 50, 1e-6)
    else:
        k, force, after = bearing["stiffness"], bearing["yield_force"], bearing["post_yield_stiffness"]
        lead = force * (1.0 - after / k)
        ops.element("elastomericBearingPlasticity", 1, 0, 1, k, lead, after / k, 0.0, 1.0, *others)
    ops.element("zeroLength", 2, 1, 2, "-mat", 1, 2, 3, "-dir", 1, 2, 3, "-doRayleigh", 0)
    ops.constraints("Plain")
    ops.numberer("Plain")
    ops.system("UmfPack")
    ops.test("NormDispIncr", 1e-11, 100)
    ops.algorithm("Newton")
    if "gravity" in deck.get("environment", {}):
        ops.timeSeries("Linear", 1)
        ops.pattern("Plain", 1, 1)
        for node in (1, 2):
            ops.load(node, 0.0, 0.0, -9.81 * deck["masses"][node - 1]["mass"], 0.0, 0.0, 0.0)
        ops.integrator("LoadControl", 0.1)
        ops.analysis("Static")
        assert ops.analyze(10) == 0, "OpenSees does not find the equilibrium of weight"
        ops.loadConst("-time", 0.0)
        ops.wipeAnalysis()
        ops.constraints("Plain")
        ops.numberer("Plain")
        ops.system("UmfPack")
        ops.test("NormDispIncr", 1e-11, 100)
        ops.algorithm("Newton")
    for axis, shake in enumerate(deck["environment"]["base_acceleration"]):
        ops.timeSeries("Path", 10 + axis, "-dt", 0.01, "-values", *record(), "-factor", shake["scale"] / 9.81)
        ops.pattern("UniformExcitation", 10 + axis, 1 + axis, "-accel", 10 + axis)
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")
    found = [0.0] * 6
    for k in range(round(12.0 / step)):
        assert ops.analyze(1, step) == 0, f"OpenSees does not converge at {k * step}"
        bearing_force, storey_force = ops.eleForce(1), ops.eleForce(2)
        moved = [ops.nodeDisp(1, 1), ops.nodeDisp(1, 2), ops.nodeDisp(2, 1)]
        now = [*moved, -bearing_force[0], -bearing_force[1], -storey_force[0]]
        found = [max(largest, abs(value)) for largest, value in zip(found, now)]
    return [*found, ops.nodeDisp(1, 1), ops.nodeDisp(1, 2)]


def pendulum(step: float) -> list[float]:
    """The equations of decks/pendulum_bearings by central differences: displacements of base and top, then the slip of the friction spring."""
    deck = tomllib.loads((ROOT / "decks" / "pendulum_bearings" / "deck.toml").read_text())
    m, M = (mass["mass"] for mass in deck["masses"])
    bearing, *storeys = deck["links"]
    k, c = [storey["stiffness"] for storey in storeys], [storey["damping"] for storey in storeys]
    radius, stick, axial, mu = bearing["radius"], bearing["stiffness"], bearing["axial_stiffness"], bearing["friction"]
    scales = [shake["scale"] / 9.81 for shake in deck["environment"]["base_acceleration"]]
    ground = record()
    u, w = [0.0, 0.0, -(m + M) * 9.81 / axial], [0.0, 0.0, -(m + M) * 9.81 / axial - M * 9.81 / k[2]]
    v, vw, slip = [0.0] * 3, [0.0] * 3, [0.0, 0.0]
    found = [0.0] * 6
    for n in range(round(12.0 / step) + 1):
        press = axial * max((u[0] ** 2 + u[1] ** 2) / (2.0 * radius) - u[2], 0.0)
        limit = press * (mu["fast"] - (mu["fast"] - mu["slow"]) * math.exp(-mu["rate"] * math.hypot(v[0], v[1])))
        q = [stick * (u[i] - slip[i]) for i in (0, 1)]
        size = math.hypot(*q)
        if size > limit:
            q = [limit / size * part for part in q]
            slip = [u[i] - q[i] / stick for i in (0, 1)]
        force = [press * u[0] / radius + q[0], press * u[1] / radius + q[1], -press]
        storey = [k[i] * (w[i] - u[i]) + c[i] * (vw[i] - v[i]) for i in range(3)]
        now = [u[0], u[1], w[0], force[0], force[1], storey[0]]
        found = [max(largest, abs(value)) for largest, value in zip(found, now)]
        place = n * step / 0.01
        low = min(int(place), len(ground) - 1)
        a = ground[low] + (place - low) * (ground[min(low + 1, len(ground) - 1)] - ground[low])
        shake = [scales[0] * a, scales[1] * a, 9.81]
        for i in range(3):
            v[i] += step * ((storey[i] - force[i]) / m - shake[i])
            vw[i] += step * (-storey[i] / M - shake[i])
            u[i] += step * v[i]
            w[i] += step * vw[i]
    return [*found, u[0], u[1]]


if __name__ == "__main__":
    for name in ("pendulum_bearings", "lead_rubber_bearings"):
        print(f"{name}\n| step | " + " | ".join(COLUMNS) + " |")
        for step in (5e-3, 2.5e-3, 1.25e-3, 2.5e-4):
            print(f"| {step} | " + " | ".join(f"{value:.6g}" for value in run(name, step)) + " |", flush=True)
    print("pendulum_bearings with the rise")
    for step in (2e-5, 1e-5):
        print(f"| {step} | " + " | ".join(f"{value:.6g}" for value in pendulum(step)) + " |", flush=True)
