#!/usr/bin/env python3
"""Roots of a turbine shaft in two bearings of eight coefficients each, by finite elements of Rayleigh beams (Nelson & McVaugh 1976).

    scripts/rotor.py     the roots of decks/rotor_on_bearings/bearings.toml, for one, two and three elements a segment; needs numpy
"""

import tomllib

import numpy as np

from scenes import ROOT

DECK = tomllib.loads((ROOT / "decks" / "rotor_on_bearings" / "bearings.toml").read_text())
POINTS = {name: point[0] for name, point in DECK["points"].items()}


def matrices(pieces: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Mass, gyroscopic moments per speed, and stiffness of the free shaft: y, y', z and z' at each node."""
    steel = DECK["materials"]["steel"]
    modulus, density = steel["youngs_modulus"], steel["density"]
    nodes = pieces * len(DECK["beams"]) + 1
    mass, gyroscopic, stiffness = (np.zeros((4 * nodes, 4 * nodes)) for _ in range(3))
    for number, beam in enumerate(DECK["beams"]):
        section = DECK["sections"][beam["section"]]
        outer, inner = section["radius"], section["radius"] - section["thickness"]
        area, inertia = np.pi * (outer**2 - inner**2), np.pi / 4 * (outer**4 - inner**4)
        h = (POINTS[beam["path"][1]] - POINTS[beam["path"][0]]) / pieces
        bend = np.array([[12, 6 * h, -12, 6 * h], [6 * h, 4 * h * h, -6 * h, 2 * h * h], [-12, -6 * h, 12, -6 * h], [6 * h, 2 * h * h, -6 * h, 4 * h * h]])
        move = np.array([[156, 22 * h, 54, -13 * h], [22 * h, 4 * h * h, 13 * h, -3 * h * h], [54, 13 * h, 156, -22 * h], [-13 * h, -3 * h * h, -22 * h, 4 * h * h]])
        turn = np.array([[36, 3 * h, -36, 3 * h], [3 * h, 4 * h * h, -3 * h, -h * h], [-36, -3 * h, 36, -3 * h], [3 * h, -h * h, -3 * h, 4 * h * h]])
        turn = density * inertia / (30 * h) * turn
        for piece in range(pieces):
            first = 4 * (pieces * number + piece)
            y = [first, first + 1, first + 4, first + 5]
            z = [place + 2 for place in y]
            for plane in (y, z):
                stiffness[np.ix_(plane, plane)] += modulus * inertia / h**3 * bend
                mass[np.ix_(plane, plane)] += density * area * h / 420 * move + turn
            gyroscopic[np.ix_(y, z)] += 2 * turn
            gyroscopic[np.ix_(z, y)] -= 2 * turn
    disc = DECK["bodies"][0]
    polar, across, _ = disc["inertia"]
    at = 4 * place_of(disc["center"][0], pieces)
    mass[[at, at + 2], [at, at + 2]] += disc["mass"]
    mass[[at + 1, at + 3], [at + 1, at + 3]] += across
    gyroscopic[at + 1, at + 3] += polar
    gyroscopic[at + 3, at + 1] -= polar
    return mass, gyroscopic, stiffness


def place_of(x: float, pieces: int) -> int:
    return pieces * sorted(POINTS.values()).index(x)


def roots(pieces: int) -> np.ndarray:
    mass, gyroscopic, stiffness = matrices(pieces)
    damping = DECK["bodies"][0]["angular_velocity"][0] * gyroscopic
    for link in DECK["links"]:
        at = 4 * place_of(POINTS[link["to"]["node"]], pieces)
        place, given = np.ix_([at, at + 2], [at, at + 2]), link["matrices"][0]
        stiffness[place] += given["stiffness"]
        damping[place] += given["damping"]
    size = len(mass)
    one = np.eye(size)
    step = np.block([[np.zeros((size, size)), one], [-np.linalg.solve(mass, stiffness), -np.linalg.solve(mass, damping)]])
    found = np.linalg.eigvals(step)
    found = found[found.imag > 1.0]
    return found[np.argsort(abs(found))]


if __name__ == "__main__":
    for pieces in (1, 2, 3):
        print(pieces, *(f"{root.real:+.3f} {root.imag:+.2f} i" for root in roots(pieces)[:5]), sep="   ")
