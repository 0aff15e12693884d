#!/usr/bin/env python3
"""Reference values of concrete and reinforcing steel by OpenSees (pip install openseespy).

Prints the stresses of Concrete02 and Steel02 along a history of strains, and a cantilever column of fibres that is pushed to and fro. The values
stand in src/mechanics/materials/uniaxial/tests.rs, decks/reinforced_column.
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


def column(elements, rows, points):
    """Base shear of a cantilever of 3 m, 0.4 m x 0.5 m with 8 bars, under 800 kN, whose top is pushed to and fro; fibres as rows along the depth."""
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    ops.uniaxialMaterial("Concrete02", 1, -30e6, -0.002, -6e6, -0.006, 0.1, 2.5e6, 2e9)
    ops.uniaxialMaterial("Concrete02", 2, -39e6, -0.0026, -7.8e6, -0.03, 0.1, 2.5e6, 2e9)
    ops.uniaxialMaterial("Steel02", 3, 500e6, 200e9, 0.01, 20.0, 0.925, 0.15)
    ops.section("Fiber", 1)
    b, h, c = 0.4, 0.5, 0.04
    ops.patch("rect", 2, rows, 1, -h / 2 + c, -b / 2 + c, h / 2 - c, b / 2 - c)
    ops.patch("rect", 1, 6, 1, -h / 2, -b / 2, -h / 2 + c, b / 2)
    ops.patch("rect", 1, 6, 1, h / 2 - c, -b / 2, h / 2, b / 2)
    ops.patch("rect", 1, rows, 1, -h / 2 + c, -b / 2, h / 2 - c, -b / 2 + c)
    ops.patch("rect", 1, rows, 1, -h / 2 + c, b / 2 - c, h / 2 - c, b / 2)
    area = math.pi * 0.02**2 / 4
    for y, count in [(-0.19, 3), (0.0, 2), (0.19, 3)]:
        ops.fiber(y, 0.0, count * area, 3)
        ops.fiber(y, 0.0, -count * area, 2)
    for i in range(elements + 1):
        ops.node(i, 3.0 * i / elements, 0.0)
    ops.fix(0, 1, 1, 1)
    ops.geomTransf("Corotational", 1)
    ops.beamIntegration("Legendre", 1, 1, points)
    for i in range(elements):
        ops.element("forceBeamColumn", i, i, i + 1, 1, 1, "-iter", 100, 1e-12)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    ops.load(elements, -800e3, 0.0, 0.0)
    ops.constraints("Plain")
    ops.numberer("RCM")
    ops.system("UmfPack")
    ops.test("NormUnbalance", 1e-3, 200)
    ops.algorithm("KrylovNewton")
    ops.integrator("LoadControl", 0.1)
    ops.analysis("Static")
    if ops.analyze(10):
        raise SystemExit("no equilibrium under the axial force")
    ops.loadConst("-time", 0.0)
    ops.timeSeries("Linear", 2)
    ops.pattern("Plain", 2, 2)
    ops.load(elements, 0.0, 1.0, 0.0)
    at, out = 0.0, []
    for turn in [0.01, -0.01, 0.02, -0.02, 0.03, -0.03, 0.0]:
        steps = round(abs(turn - at) / 0.00025)
        ops.integrator("DisplacementControl", elements, 2, (turn - at) / steps)
        if ops.analyze(steps):
            raise SystemExit(f"no equilibrium on the way to {turn}")
        at = turn
        out.append((turn, round(ops.getTime(), 1)))
    return out


def moment_curvature(rows):
    """Moments of the section of example 2.1 of the OpenSees manual, kip and inch, under 180 kip; bars take the place of concrete."""
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    ops.uniaxialMaterial("Concrete01", 1, -6.0, -0.004, -5.0, -0.014)
    ops.uniaxialMaterial("Concrete01", 2, -5.0, -0.002, 0.0, -0.006)
    ops.uniaxialMaterial("Steel01", 3, 60.0, 30000.0, 0.01)
    ops.section("Fiber", 1)
    y, z, cover, bar = 12.0, 7.5, 1.5, 0.6
    ops.patch("rect", 1, rows, 1, cover - y, cover - z, y - cover, z - cover)
    ops.patch("rect", 2, rows, 1, -y, z - cover, y, z)
    ops.patch("rect", 2, rows, 1, -y, -z, y, cover - z)
    ops.patch("rect", 2, rows // 10, 1, -y, cover - z, cover - y, z - cover)
    ops.patch("rect", 2, rows // 10, 1, y - cover, cover - z, y, z - cover)
    for at, count in [(y - cover, 3), (0.0, 2), (cover - y, 3)]:
        ops.fiber(at, 0.0, count * bar, 3)
        ops.fiber(at, 0.0, -count * bar, 1)
    ops.node(1, 0.0, 0.0)
    ops.node(2, 0.0, 0.0)
    ops.fix(1, 1, 1, 1)
    ops.fix(2, 0, 1, 0)
    ops.element("zeroLengthSection", 1, 1, 2, 1)
    ops.timeSeries("Constant", 1)
    ops.pattern("Plain", 1, 1)
    ops.load(2, -180.0, 0.0, 0.0)
    ops.system("BandGeneral")
    ops.numberer("Plain")
    ops.constraints("Plain")
    ops.test("NormUnbalance", 1e-8, 100)
    ops.algorithm("Newton")
    ops.integrator("LoadControl", 0.0)
    ops.analysis("Static")
    ops.analyze(1)
    ops.timeSeries("Linear", 2)
    ops.pattern("Plain", 2, 2)
    ops.load(2, 0.0, 0.0, 1.0)
    first = 60.0 / 30000.0 / (0.7 * (24.0 - cover))
    out = []
    ops.integrator("DisplacementControl", 2, 3, 0.01 * first)
    for k in range(1, 1501):
        if ops.analyze(1):
            raise SystemExit("no equilibrium of the section")
        if k in (50, 100, 200, 500, 1000, 1500):
            out.append((k // 50 / 2, round(ops.getTime(), 3)))
    return out


if __name__ == "__main__":
    turns = [-0.001, -0.0002, -0.0015, 0.0006, -0.003, -0.0021, -0.0026, -0.0005, 0.001, -0.005, -0.001, -0.008, 0.0]
    print("Concrete02", [(t, round(s, 1)) for t, s in along(concrete, turns)])
    turns = [0.004, -0.001, 0.003, -0.008, 0.01, 0.002, 0.012, -0.012]
    print("Steel02", [(t, round(s, 1)) for t, s in along(steel, turns)])
    isotropic = (0.05, 4.0, 0.03, 5.0)
    print("Steel02 isotropic", [(t, round(s, 1)) for t, s in along(lambda: steel(*isotropic), turns)])
    for elements, rows, points in [(4, 40, 4), (8, 100, 5)]:
        print("column", elements, rows, points, column(elements, rows, points))
    for rows in (100, 1000):
        print("moment and curvature", rows, moment_curvature(rows))
