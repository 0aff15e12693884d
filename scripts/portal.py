#!/usr/bin/env python3
"""Largest motions and moments of decks/collapsing_portal by OpenSees, in shorter and shorter steps and finer meshes.

    scripts/portal.py        needs a Python in which `import openseespy.opensees` works (pip install openseespy)

OpenSees takes elasticBeamColumn with the corotational transformation, and zeroLength springs of the uniaxial material IMKBilin.
"""

import sys
import tomllib
from pathlib import Path

import openseespy.opensees as ops

from earthquake import record
from scenes import ROOT

COLUMNS = ["drift", "at the end", "foot left", "knee left", "knee right", "turn of the foot"]


def run(step: float, elements: int, path: Path = ROOT / "decks" / "collapsing_portal" / "deck.toml") -> list[float]:
    deck = tomllib.loads(path.read_text())
    section, hinge, mass = deck["sections"]["member"], deck["joints"][0], deck["masses"][0]["mass"]
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    points = {name: (10 * number, at[0], at[2]) for number, (name, at) in enumerate(deck["points"].items(), 1)}
    for number, x, z in points.values():
        ops.node(number, x, z)
    for name in ("left", "right"):
        number = points[f"foot_{name}"][0]
        ops.node(number + 1, *points[f"foot_{name}"][1:])
        ops.fix(number + 1, 1, 1, 1)
        ops.mass(points[f"top_{name}"][0], mass, mass, 1e-9)
    ops.geomTransf("Corotational", 1)
    next_node, next_element = 1000, 1000
    for beam in deck["beams"]:
        first, last = (points[name] for name in beam["path"])
        before = first[0]
        for k in range(1, elements + 1):
            node = last[0]
            if k < elements:
                next_node += 1
                node = next_node
                ops.node(node, *(a + (b - a) * k / elements for a, b in zip(first[1:], last[1:])))
            next_element += 1
            ops.element("elasticBeamColumn", next_element, before, node, section["axial_stiffness"], 1.0, section["bending_stiffness"][0], 1)
            before = node
    d, k, limit, after = (hinge[key] for key in ("deterioration", "stiffness", "yield_moment", "post_yield_stiffness"))
    cap = (limit + after * d["capping"]) / limit
    side = [d["capping"], d["post_capping"], 10.0, limit, cap, d["residual"]]
    never = 1e9
    lost = [d.get(key, never) for key in ("strength", "softening", "unloading")]
    ops.uniaxialMaterial("IMKBilin", 1, k, *side, *side, *lost, 1.0, 1.0, 1.0, 1.0, 1.0)
    pairs = [("foot_left", 1), ("knee_left", points["top_left"][0]), ("knee_right", points["top_right"][0]), ("foot_right", 1)]
    for number, (name, other) in enumerate(pairs, 1):
        node = points[name][0]
        master = node + 1 if other == 1 else other
        ops.equalDOF(master, node, 1, 2)
        ops.element("zeroLength", number, master, node, "-mat", 1, "-dir", 6, "-doRayleigh", 0)
    ops.rayleigh(deck["damping"]["alpha"], 0.0, 0.0, 0.0)

    def solver() -> None:
        ops.constraints("Transformation")
        ops.numberer("RCM")
        ops.system("UmfPack")
        ops.test("NormDispIncr", 1e-10, 100)
        ops.algorithm("Newton")

    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    for name in ("left", "right"):
        ops.load(points[f"top_{name}"][0], 0.0, -9.81 * mass, 0.0)
    solver()
    ops.integrator("LoadControl", 0.1)
    ops.analysis("Static")
    assert ops.analyze(10) == 0, "OpenSees does not find the equilibrium of weight"
    ops.loadConst("-time", 0.0)
    ops.wipeAnalysis()
    ops.timeSeries("Path", 2, "-dt", 0.01, "-values", *record(), "-factor", deck["environment"]["base_acceleration"][0]["scale"] / 9.81)
    ops.pattern("UniformExcitation", 2, 1, "-accel", 2)
    solver()
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")
    found = [0.0] * 5
    for k in range(round(12.0 / step)):
        assert ops.analyze(1, step) == 0, f"OpenSees does not converge at {k * step}"
        moments = [ops.eleResponse(e, "material", 1, "stress")[0] for e in (1, 2, 3)]
        now = [ops.nodeDisp(points["top_left"][0], 1), *moments, ops.eleResponse(1, "material", 1, "strain")[0]]
        found = [max(largest, abs(value)) for largest, value in zip(found, now)]
    return [found[0], ops.nodeDisp(points["top_left"][0], 1), *found[1:]]


if __name__ == "__main__":
    print("| step, elements | " + " | ".join(COLUMNS) + " |")
    for step, elements in ((4e-3, 4), (2e-3, 4), (1e-3, 4), (5e-4, 4), (1e-3, 8)):
        print(f"| {step}, {elements} | " + " | ".join(f"{value:.6g}" for value in run(step, elements)) + " |", flush=True)
