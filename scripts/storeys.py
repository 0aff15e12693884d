#!/usr/bin/env python3
"""Largest motions and forces of decks/damped_storeys by modal superposition, and by OpenSees with modalDamping in shorter and shorter steps.

    scripts/storeys.py       needs a Python in which `import openseespy.opensees` works (pip install openseespy)
"""

import tomllib
from pathlib import Path

import numpy as np
import openseespy.opensees as ops

from earthquake import record
from scenes import ROOT

COLUMNS = ["first", "fourth", "storey 1", "storey 4", "fourth at the end"]


def run(step: float, path: Path = ROOT / "decks" / "damped_storeys" / "deck.toml") -> list[float]:
    deck = tomllib.loads(path.read_text())
    ops.wipe()
    ops.model("basic", "-ndm", 1, "-ndf", 1)
    masses = {at: entry["mass"] for entry in deck["masses"] for at in ([entry["at"]] if isinstance(entry["at"], str) else entry["at"])}
    ops.node(0, 0.0)
    ops.fix(0, 1)
    for number, name in enumerate(deck["points"], 1):
        ops.node(number, 0.0)
        ops.mass(number, masses[name])
    for number, storey in enumerate(deck["links"], 1):
        ops.uniaxialMaterial("Elastic", number, storey["stiffness"])
        ops.element("zeroLength", number, number - 1, number, "-mat", number, "-dir", 1, "-doRayleigh", 0)
    modal = deck["damping"]["modal"]
    ops.eigen("-fullGenLapack", modal["modes"])
    ops.modalDamping(modal["ratio"])
    ops.timeSeries("Path", 1, "-dt", 0.01, "-values", *record(), "-factor", 1.0)
    ops.pattern("UniformExcitation", 1, 1, "-accel", 1)
    ops.constraints("Plain")
    ops.numberer("Plain")
    ops.system("FullGeneral")
    ops.test("NormDispIncr", 1e-12, 50)
    ops.algorithm("Newton")
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")
    found = [0.0] * 4
    for k in range(round(12.0 / step)):
        assert ops.analyze(1, step) == 0, f"OpenSees does not converge at {k * step}"
        now = [ops.nodeDisp(1, 1), ops.nodeDisp(4, 1), *(ops.eleResponse(e, "material", 1, "stress")[0] for e in (1, 4))]
        found = [max(largest, abs(value)) for largest, value in zip(found, now)]
    return [*found, ops.nodeDisp(4, 1)]


def superposition(step: float = 2.5e-3) -> list[float]:
    """The same by modal coordinates, exact at the steps for a ground acceleration of straight lines."""
    deck = tomllib.loads((ROOT / "decks" / "damped_storeys" / "deck.toml").read_text())
    k = [storey["stiffness"] for storey in deck["links"]]
    m = np.array([deck["masses"][0]["mass"]] * 3 + [deck["masses"][1]["mass"]])
    K = np.diag(k) + np.diag(k[1:] + [0.0]) - np.diag(k[1:], 1) - np.diag(k[1:], -1)
    squares, shapes = np.linalg.eigh(K / np.sqrt(np.outer(m, m)))
    shapes = shapes / np.sqrt(m)[:, None]
    modal = deck["damping"]["modal"]
    count = round(12.0 / step)
    values = record()
    ground = np.interp(np.arange(count + 1) * step, np.arange(len(values)) * 0.01, values)
    motions = []
    for mode, square in enumerate(squares):
        zeta, omega = (modal["ratio"] if mode < modal["modes"] else 0.0), square**0.5
        # Places, velocity, force and its rate: the exponential of this matrix by its series, over a short step.
        A = np.array([[0, 1, 0, 0], [-square, -2 * zeta * omega, 1, 0], [0, 0, 0, 1], [0, 0, 0, 0]]) * step
        E, term = np.eye(4), np.eye(4)
        for n in range(1, 25):
            term = term @ A / n
            E = E + term
        load = -(shapes[:, mode] @ m) * ground
        q, path = np.zeros(2), [0.0]
        for before, after in zip(load, load[1:]):
            q = E[:2, :2] @ q + E[:2, 2] * before + E[:2, 3] * (after - before) / step
            path.append(q[0])
        motions.append(path)
    u = shapes @ np.array(motions)
    found = [u[0], u[3], k[0] * u[0], k[3] * (u[3] - u[2])]
    return [*(abs(row).max() for row in found), u[3][-1]]


if __name__ == "__main__":
    print("| step | " + " | ".join(COLUMNS) + " |")
    print("| exact | " + " | ".join(f"{value:.7g}" for value in superposition()) + " |")
    for step in (5e-3, 2.5e-3, 1.25e-3, 2.5e-4):
        print(f"| {step} | " + " | ".join(f"{value:.6g}" for value in run(step)) + " |", flush=True)
