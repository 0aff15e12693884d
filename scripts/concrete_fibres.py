#!/usr/bin/env python3
"""Reference values of concrete and reinforcing steel by OpenSees (pip install openseespy).

Prints the stresses of Concrete02 and Steel02 along a history of strains, and a cantilever column of fibres that is pushed to and fro. The values
stand in src/mechanics/materials/uniaxial/tests.rs, tests/mechanics/concrete.rs and decks/reinforced_column.
"""

import math

import openseespy.opensees as ops

FC, E, FCU, ECU, FT, ETS, RATIO = 30e6, 30e9, 6e6, 0.006, 2.5e6, 2e9, 0.1


def along(define, turns, steps=2000):
    """Stress at each turn of a path of strains, in small steps."""
    ops.wipe()
    define()
    ops.testUniaxialMaterial(1)
    strain, out = 0.0, []
    for turn in turns:
        for k in range(1, steps + 1):
            ops.setStrain(strain + (turn - strain) * k / steps)
        strain = turn
        out.append((turn, ops.getStress()))
    return out


def concrete():
    ops.uniaxialMaterial("Concrete02", 1, -FC, -2 * FC / E, -FCU, -ECU, RATIO, FT, ETS)


def steel(*isotropic):
    ops.uniaxialMaterial("Steel02", 1, 500e6, 200e9, 0.01, 20.0, 0.925, 0.15, *isotropic)


def column(cyclic):
    """A cantilever of 3 m, 0.4 m x 0.5 m, with 8 bars, under its axial force; fibres as rows along the depth."""
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    cover = ("Concrete02", 1, -30e6, -0.002, -6e6, -0.006, 0.1, 2.5e6, 2e9)
    core = ("Concrete02", 2, -39e6, -0.0026, -7.8e6, -0.02, 0.1, 2.5e6, 2e9)
    ops.uniaxialMaterial(*cover)
    ops.uniaxialMaterial(*core)
    ops.uniaxialMaterial("Steel02", 3, 500e6, 200e9, 0.01, 20.0, 0.925, 0.15)
    ops.section("Fiber", 1)
    b, h, c, n = 0.4, 0.5, 0.04, 60
    ops.patch("rect", 2, n, 1, -h / 2 + c, -b / 2 + c, h / 2 - c, b / 2 - c)
    ops.patch("rect", 1, 6, 1, -h / 2, -b / 2, -h / 2 + c, b / 2)
    ops.patch("rect", 1, 6, 1, h / 2 - c, -b / 2, h / 2, b / 2)
    ops.patch("rect", 1, n, 1, -h / 2 + c, -b / 2, h / 2 - c, -b / 2 + c)
    ops.patch("rect", 1, n, 1, -h / 2 + c, b / 2 - c, h / 2 - c, b / 2)
    area = math.pi * 0.02**2 / 4
    for y, count in [(-0.19, 3), (0.0, 2), (0.19, 3)]:
        for _ in range(count):
            ops.fiber(y, 0.0, area, 3)
            ops.fiber(y, 0.0, -area, 2)
    elements = 4
    for i in range(elements + 1):
        ops.node(i, 3.0 * i / elements, 0.0)
    ops.fix(0, 1, 1, 1)
    ops.geomTransf("Corotational", 1)
    ops.beamIntegration("Legendre", 1, 1, 2)
    for i in range(elements):
        ops.element("dispBeamColumn", i, i, i + 1, 1, 1)
    return elements


if __name__ == "__main__":
    turns = [-0.001, -0.0002, -0.0015, 0.0006, -0.003, -0.0021, -0.0026, -0.0005, 0.001, -0.005, -0.001, -0.008, 0.0]
    print("Concrete02", [(t, round(s, 1)) for t, s in along(concrete, turns)])
    turns = [0.004, -0.001, 0.003, -0.008, 0.01, 0.002, 0.012, -0.012]
    print("Steel02", [(t, round(s, 1)) for t, s in along(steel, turns)])
    isotropic = (0.05, 4.0, 0.03, 5.0)
    print("Steel02 isotropic", [(t, round(s, 1)) for t, s in along(lambda: steel(*isotropic), turns)])
