#!/usr/bin/env python3
"""Frequencies of a cantilever plate that spins about the normal through the middle of its clamped edge, after Rayleigh and Ritz.  Needs numpy and scipy.

Membrane forces are those of plane stress under the centrifugal force at the deformed places. Deflections are x² times Legendre polynomials. Thin plate, no
rotary inertia. Coriolis forces lie in the plane, so they do not act on small deflections.
"""

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg import eigh

a = b = 1.0
h, E, nu, rho = 0.01, 7e10, 0.3, 2700.0
D, C = E * h**3 / 12 / (1 - nu**2), E * h / (1 - nu**2)
T = np.sqrt(rho * h * a**4 / D)


def functions(count, at, scale, shift, power):
    """Values and two derivatives of x^power P_k at places, by the size of the range."""
    x, found = scale * at + shift, []
    for k in range(count):
        P = legendre.Legendre.basis(k)
        values = [P.deriv(d)(x) * scale**d for d in range(3)]
        powers = [at**power, power * at ** max(power - 1, 0), power * (power - 1) * at ** max(power - 2, 0)]
        found.append([
            powers[0] * values[0],
            powers[1] * values[0] + powers[0] * values[1],
            powers[2] * values[0] + 2 * powers[1] * values[1] + powers[0] * values[2],
        ])
    return found


def frequencies(speed, n, m):
    points, weights = legendre.leggauss(30)
    X, Y = 0.5 * a * (points + 1), 0.5 * b * points
    W = np.outer(0.5 * a * weights, 0.5 * b * weights).ravel()
    across = functions(m, Y, 2 / b, 0.0, 0)

    def grid(along, i, j):
        return np.array([np.outer(f[i], g[j]).ravel() for f in along for g in across])

    along = functions(n, X, 2 / a, -1.0, 1)
    u, ux, uy = (grid(along, i, j) for i, j in ((0, 0), (1, 0), (0, 1)))
    product = lambda f, g, weight=1.0: (f * W * weight) @ g.T
    cross = C * (nu * product(ux, uy) + 0.5 * (1 - nu) * product(uy, ux))
    K = np.block([
        [C * (product(ux, ux) + 0.5 * (1 - nu) * product(uy, uy)), cross],
        [cross.T, C * (product(uy, uy) + 0.5 * (1 - nu) * product(ux, ux))],
    ])
    mass, zero = rho * h * product(u, u), np.zeros_like(cross)
    K -= speed**2 * np.block([[mass, zero], [zero, mass]])
    places = [np.outer(X, np.ones_like(Y)).ravel(), np.outer(np.ones_like(X), Y).ravel()]
    p, q = np.split(np.linalg.solve(K, rho * h * speed**2 * np.concatenate([(u * W) @ place for place in places])), 2)
    ex, ey, gxy = p @ ux, q @ uy, p @ uy + q @ ux
    Nx, Ny, Nxy = C * (ex + nu * ey), C * (ey + nu * ex), 0.5 * C * (1 - nu) * gxy
    along = functions(n, X, 2 / a, -1.0, 2)
    w, wx, wy, wxx, wyy, wxy = (grid(along, i, j) for i, j in ((0, 0), (1, 0), (0, 1), (2, 0), (0, 2), (1, 1)))
    K = D * (product(wxx, wxx) + product(wyy, wyy) + nu * (product(wxx, wyy) + product(wyy, wxx)) + 2 * (1 - nu) * product(wxy, wxy))
    K += product(wx, wx, Nx) + product(wy, wy, Ny) + product(wx, wy, Nxy) + product(wy, wx, Nxy)
    return np.sqrt(eigh(K, rho * h * product(w, w), eigvals_only=True)[:5])


for gamma in (0, 1, 2, 5, 10):
    for n, m in ((10, 9), (13, 12)):
        found = frequencies(gamma / T, n, m)
        print(f"speed {gamma}/T, {n} x {m}: T omega", *(f"{T * of:.4f}" for of in found), " Hz", *(f"{of / 2 / np.pi:.4f}" for of in found))
