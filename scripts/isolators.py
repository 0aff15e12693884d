#!/usr/bin/env python3
"""Largest motions and forces of decks/isolated_building by OpenSees, in shorter and shorter steps.

    scripts/isolators.py     needs a Python in which `import openseespy.opensees` works (pip install openseespy)

OpenSees takes its uniaxial material BoucWen, whose hysteretic displacement has the same equation.
"""

import tomllib

import openseespy.opensees as ops

from earthquake import record
from scenes import ROOT

DECK = tomllib.loads((ROOT / "decks" / "isolated_building" / "deck.toml").read_text())
COLUMNS = ["base", "second", "isolators", "storey_1", "base at the end"]


def run(step: float) -> list[float]:
    ops.wipe()
    ops.model("basic", "-ndm", 1, "-ndf", 1)
    for node in range(4):
        ops.node(node, 0.0)
        if node:
            ops.mass(node, DECK["masses"][0]["mass"])
    ops.fix(0, 1)
    isolators, *storeys = DECK["links"]
    k, force, exponent = isolators["stiffness"], isolators["yield_force"], isolators["exponent"]
    half = 0.5 / (force / k) ** exponent
    ops.uniaxialMaterial("BoucWen", 1, isolators["post_yield_stiffness"] / k, k, exponent, half, half, 1.0, 0.0, 0.0, 0.0, 1e-12, 100)
    for number, storey in enumerate(storeys):
        ops.uniaxialMaterial("Elastic", 2 + number, storey["stiffness"], storey["damping"])
    for number in range(3):
        ops.element("zeroLength", 1 + number, number, number + 1, "-mat", 1 + number, "-dir", 1, "-doRayleigh", 0)
    ops.timeSeries("Path", 1, "-dt", 0.01, "-values", *record(), "-factor", 1.0)
    ops.pattern("UniformExcitation", 1, 1, "-accel", 1)
    ops.constraints("Plain")
    ops.numberer("Plain")
    ops.system("BandGeneral")
    ops.test("NormDispIncr", 1e-12, 50)
    ops.algorithm("Newton")
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")
    found = [0.0] * 4
    for k in range(round(12.0 / step)):
        assert ops.analyze(1, step) == 0, f"OpenSees does not converge at {k * step}"
        force = [ops.eleResponse(e, "material", 1, "stress")[0] for e in (1, 2)]
        now = [ops.nodeDisp(1, 1), ops.nodeDisp(3, 1), *force]
        found = [max(largest, abs(value)) for largest, value in zip(found, now)]
    return [*found, ops.nodeDisp(1, 1)]


if __name__ == "__main__":
    print("| step | " + " | ".join(COLUMNS) + " |")
    for step in (5e-3, 2.5e-3, 1.25e-3, 2.5e-4):
        print(f"| {step} | " + " | ".join(f"{value:.6g}" for value in run(step)) + " |")
