#!/usr/bin/env python3
"""Values that the decks of decks/tutorial/ expect, from formulas and small programs that know nothing of rdsolve.

    scripts/tutorial_values.py

Prints one line for each value. Python's standard library only; some seconds.
"""

import bisect
import math
import tomllib
from pathlib import Path

TUTORIAL = Path(__file__).resolve().parent.parent / "decks" / "tutorial"
E, NU, RHO = 210e9, 0.3, 7850.0
G = E / (2.0 * (1.0 + NU))


def deck(name: str) -> dict:
    return tomllib.loads((TUTORIAL / f"{name}.toml").read_text())


# ---- plane frames of straight members, small displacements: exact two-node Timoshenko beams, lumped masses ----


def box(width: float, height: float, t: float) -> tuple[float, float, float]:
    """Area, second moment for bending in the plane of the height, shear area for forces along the height (Jourawski)."""
    area = width * height - (width - 2 * t) * (height - 2 * t)
    moment = (width * height**3 - (width - 2 * t) * (height - 2 * t) ** 3) / 12.0
    b, h = width - t, height - t  # middle lines
    inertia = t * h**3 / 6.0 + t * b * h * h / 2.0
    # Static moment: grows along half a flange to t b h/4, then along half a web by t y.
    steps, energy = 400, 0.0
    for k in range(steps):
        s = (k + 0.5) / steps
        energy += 4 * (t * h / 2 * s * b / 2) ** 2 / t * (b / 2) / steps
        y = h / 2 * (1.0 - s)
        energy += 4 * (t * h * b / 4 + t * (h * h / 4 - y * y) / 2) ** 2 / t * (h / 2) / steps
    return area, moment, inertia**2 / energy


def stiffness(length: float, area: float, moment: float, shear_area: float) -> list[list[float]]:
    """Axial, lateral, rotation of both ends; local axes."""
    phi = 12.0 * E * moment / (G * shear_area * length**2)
    a = E * area / length
    k = E * moment / (length**3 * (1.0 + phi))
    l = length
    K = [[0.0] * 6 for _ in range(6)]
    for i, j, v in [(0, 0, a), (0, 3, -a), (3, 3, a)]:
        K[i][j] = K[j][i] = v
    bend = {(1, 1): 12, (1, 2): 6 * l, (1, 4): -12, (1, 5): 6 * l, (2, 2): (4 + phi) * l * l, (2, 4): -6 * l}
    bend |= {(2, 5): (2 - phi) * l * l, (4, 4): 12, (4, 5): -6 * l, (5, 5): (4 + phi) * l * l}
    for (i, j), v in bend.items():
        K[i][j] = K[j][i] = k * v
    return K


class Frame:
    """Nodes (x, z) with unknowns ux, uz and the rotation; members cut into elements."""

    def __init__(self, points: dict, members: list, fixed: list[str], masses: dict, pieces: int):
        self.nodes, self.index = list(points.values()), {name: k for k, name in enumerate(points)}
        elements = []
        for a, b, section in members:
            (xa, za), (xb, zb) = points[a], points[b]
            chain = [self.index[a]]
            for k in range(1, pieces):
                self.nodes.append((xa + (xb - xa) * k / pieces, za + (zb - za) * k / pieces))
                chain.append(len(self.nodes) - 1)
            chain.append(self.index[b])
            elements += [(i, j, section) for i, j in zip(chain, chain[1:])]
        held = {3 * self.index[name] + d for name in fixed for d in range(3)}
        self.free = [d for d in range(3 * len(self.nodes)) if d not in held]
        at = {d: k for k, d in enumerate(self.free)}
        n = len(self.free)
        self.K, self.m = [[0.0] * n for _ in range(n)], [0.0] * n
        for name, mass in masses.items():
            for d in (0, 1):
                self.m[at[3 * self.index[name] + d]] += mass
        for i, j, (area, moment, shear_area) in elements:
            dx, dz = self.nodes[j][0] - self.nodes[i][0], self.nodes[j][1] - self.nodes[i][1]
            length = math.hypot(dx, dz)
            c, s = dx / length, dz / length
            turn = [[c, s, 0], [-s, c, 0], [0, 0, 1]]
            T = [[turn[r % 3][q % 3] if r // 3 == q // 3 else 0.0 for q in range(6)] for r in range(6)]
            k = stiffness(length, area, moment, shear_area)
            kT = [[sum(k[r][p] * T[p][q] for p in range(6)) for q in range(6)] for r in range(6)]
            local = [[sum(T[p][r] * kT[p][q] for p in range(6)) for q in range(6)] for r in range(6)]
            rows = [3 * i, 3 * i + 1, 3 * i + 2, 3 * j, 3 * j + 1, 3 * j + 2]
            for r in range(6):
                for q in range(6):
                    if rows[r] in at and rows[q] in at:
                        self.K[at[rows[r]]][at[rows[q]]] += local[r][q]
                half = RHO * length / 2.0
                if rows[r] in at:
                    self.m[at[rows[r]]] += half * (moment if rows[r] % 3 == 2 else area)
        self.at = {(name, d): at.get(3 * k + d) for name, k in self.index.items() for d in range(3)}

    def march(self, force, alpha: float, end: float, dt: float, probe: int) -> list[tuple[float, float]]:
        """M a + alpha M v + K u = f(t), trapezoidal rule with steps far below every period that counts."""
        n = len(self.m)
        A = [[self.K[i][j] for j in range(n)] for i in range(n)]
        for i in range(n):
            A[i][i] += self.m[i] * (4.0 / dt**2 + 2.0 * alpha / dt)
        L = factor(A)
        u, v = [0.0] * n, [0.0] * n
        f = force(0.0)
        a = [f[i] / self.m[i] for i in range(n)]
        out, steps = [(0.0, 0.0)], round(end / dt)
        for k in range(1, steps + 1):
            f = force(k * dt)
            guess = [(4.0 / dt**2) * u[i] + (4.0 / dt) * v[i] + a[i] + alpha * (2.0 / dt * u[i] + v[i]) for i in range(n)]
            new = solve(L, [f[i] + self.m[i] * guess[i] for i in range(n)])
            rate = [2.0 / dt * (new[i] - u[i]) - v[i] for i in range(n)]
            a = [4.0 / dt**2 * (new[i] - u[i]) - 4.0 / dt * v[i] - a[i] for i in range(n)]
            u, v = new, rate
            out.append((k * dt, u[probe]))
        return out


def factor(A: list[list[float]]) -> list[list[float]]:
    """Cholesky factor, row by row."""
    n = len(A)
    L = [[0.0] * (i + 1) for i in range(n)]
    for i in range(n):
        for j in range(i + 1):
            s = A[i][j] - sum(p * q for p, q in zip(L[i][:j], L[j][:j]))
            L[i][j] = math.sqrt(s) if i == j else s / L[j][j]
    return L


def solve(L: list[list[float]], r: list[float]) -> list[float]:
    n = len(L)
    y = []
    for i in range(n):
        y.append((r[i] - sum(p * q for p, q in zip(L[i], y))) / L[i][i])
    for i in reversed(range(n)):
        y[i] /= L[i][i]
        for j in range(i):
            y[j] -= L[i][j] * y[i]
    return y


def table(points: list, t: float) -> float:
    for (t0, a0), (t1, a1) in zip(points, points[1:]):
        if t0 <= t <= t1:
            return a0 + (a1 - a0) * (t - t0) / (t1 - t0)
    return 0.0


def sections(d: dict) -> dict:
    return {name: box(s["width"], s["height"], s["thickness"]) for name, s in d["sections"].items()}


def earthquake() -> None:
    d = deck("earthquake")
    points = {name: (x, z) for name, (x, _, z) in d["points"].items()}
    kinds = sections(d)
    members = [(*beam["path"], kinds[beam["section"]]) for beam in d["beams"]]
    masses = {name: d["masses"][0]["mass"] for name in d["masses"][0]["at"]}
    frame = Frame(points, members, d["supports"][0]["at"], masses, 4)
    record = d["amplitudes"]["quake"]["points"]
    sideways = {k for k, dof in enumerate(frame.free) if dof % 3 == 0}

    def force(t):
        ground = table(record, t)
        return [-frame.m[i] * ground if i in sideways else 0.0 for i in range(len(frame.m))]

    u = frame.march(force, d["damping"]["alpha"], d["analysis"]["end_time"], 5e-4, frame.at["knee_left", 0])
    for what, (t, value) in [("largest", max(u, key=lambda p: p[1])), ("smallest", min(u, key=lambda p: p[1]))]:
        print(f"earthquake: {what} ux of knee_left {value:.6e} m at t = {t:.4f} s")


def mast() -> None:
    d = deck("mast")
    tube, head = d["sections"]["tube"], d["masses"][0]["mass"]
    r, q = tube["radius"], tube["radius"] - tube["thickness"]
    area = math.pi * (r * r - q * q)
    section = (area, math.pi / 4 * (r**4 - q**4), area / 2)
    points = {name: (x, z) for name, (x, _, z) in d["points"].items()}
    frame = Frame(points, [("foot", "head", section)], ["foot"], {"head": head}, 12)
    push, gust, at = d["loads"][0]["force"][0], d["amplitudes"]["gust"], frame.at["head", 0]

    def force(t):
        f = [0.0] * len(frame.m)
        if t < gust["end"]:
            f[at] = push * math.sin(2 * math.pi * gust["frequency"] * t) ** 2
        return f

    u = frame.march(force, d["damping"]["alpha"], d["analysis"]["end_time"], 1e-3, at)
    t, value = max(u, key=lambda p: p[1])
    print(f"mast: largest ux of head {value:.6e} m at t = {t:.4f} s, {u[-1][1]:.6e} m at the end")


# ---- a portal pushed over: columns with plastic zones, second-order moments of the weight ----


def moment(kappa: float, b: float, h: float, yield_stress: float, H: float) -> float:
    """Of a rectangle whose fibres harden linearly; no axial force."""
    Et, elastic = E * H / (E + H), yield_stress / E
    core = min(h / 2.0, elastic / kappa)
    inner = 2.0 * b * E * kappa * core**3 / 3.0
    outer = 2.0 * b * ((yield_stress - Et * elastic) * (h * h / 4 - core**2) / 2 + Et * kappa * (h**3 / 8 - core**3) / 3)
    return inner + outer


def pushover() -> None:
    d = deck("pushover")
    column, girder, steel = d["sections"]["column"], d["sections"]["girder"], d["materials"]["steel"]
    h, span = d["points"]["knee_left"][2], d["points"]["knee_right"][0]
    weight, push = -d["loads"][0]["force"][2], d["loads"][1]["force"][0]
    b, t = column["width"], column["height"]
    law = lambda kappa: moment(kappa, b, t, steel["yield_stress"], steel["hardening_modulus"])

    # Curvature over moment, tabulated once.
    kappas = [1e-4 * 1.01**k for k in range(1200)]
    moments = [law(kappa) for kappa in kappas]

    def curvature(M):
        k = bisect.bisect(moments, M)
        if k == 0:
            return M / moments[0] * kappas[0]
        part = (M - moments[k - 1]) / (moments[k] - moments[k - 1])
        return kappas[k - 1] + part * (kappas[k] - kappas[k - 1])

    bend, shear = E * girder["width"] * girder["height"] ** 3 / 12, G * b * t * 5 / 6

    def half(V, lean):
        """From the middle of a column, where M = 0, to its end, midpoint rule: sway and what the end's angle is off by."""
        n = 400
        ds = h / 2 / n
        x, theta, M = 0.0, lean, 0.0
        for _ in range(n):
            angle = theta - curvature(M) * ds / 2
            slope = V * math.cos(angle) + weight * math.sin(angle)
            x += (math.sin(angle) + V / shear) * ds
            theta -= curvature(M + slope * ds / 2) * ds
            M += slope * ds
        # The feet do not turn, the knees as the girder lets them: on the average half of that.
        return x, theta - M * span / (6 * bend) / 2

    def root(function, low, high):
        for _ in range(40):
            middle = (low + high) / 2
            low, high = (middle, high) if function(middle) < 0 else (low, middle)
        return (low + high) / 2

    for u in (0.1, 0.2):
        # For a lean of the middle the shear force that the end's angle asks for, then the lean that gives the sway.
        force = lambda lean: root(lambda V: -half(V, lean)[1], 0.0, 12e3)
        lean = root(lambda lean: 2 * half(force(lean), lean)[0] - u, u / h, 1.6 * u / h)
        print(f"pushover: load factor {2 * force(lean) / push:.4f} where the sway is {u} m")


# ---- a four-bar linkage: positions by circles, forces by Newton and Euler from differences of positions ----


def four_bar() -> None:
    d = deck("four_bar")
    a, A0, B0 = 0.15, d["points"]["pin_a"][:2], d["points"]["pin_b"][:2]
    P = d["joints"][2]["to"]["ground"][:2]
    b, c = math.dist(A0, B0), math.dist(B0, P)
    omega, rise = d["supports"][0]["motion"]["rz"]["scale"], d["amplitudes"]["start_up"]["points"][1][0]

    def pins(t):
        phi = math.pi / 2 + omega * (t * t / (2 * rise) if t < rise else t - rise / 2)
        A = (a * math.cos(phi), a * math.sin(phi))
        dx, dy = P[0] - A[0], P[1] - A[1]
        r = math.hypot(dx, dy)
        along = (b * b - c * c + r * r) / (2 * r)
        off = math.sqrt(b * b - along * along)
        return A, (A[0] + (along * dx - off * dy) / r, A[1] + (along * dy + off * dx) / r)

    def state(t):
        """Centre and angle of coupler and rocker."""
        A, B = pins(t)
        bars = [(A, B), (P, B)]
        return [(*((p + q) / 2 for p, q in zip(s, e)), math.atan2(e[1] - s[1], e[0] - s[0])) for s, e in bars]

    def acceleration(t, k):
        e = 1e-4
        return [(p - 2 * q + r) / e**2 for p, q, r in zip(state(t + e)[k], state(t)[k], state(t - e)[k])]

    t, e = 1.9, 1e-5
    (_, _, before), (x, y, _), (_, _, after) = state(t - e)[1], state(t)[1], state(t + e)[1]
    print(f"four_bar: rocker x {x:.6f} m, y {y:.6f} m, wz {(after - before) / (2 * e):.5f} rad/s at t = {t} s")

    # Unknown: forces at A and B on the coupler, at P on the rocker; -B on the rocker.
    A, B = pins(t)
    rows, right = [], []
    for k, (length, ends) in enumerate([(b, ((A, 0, 1), (B, 2, 1))), (c, ((B, 2, -1), (P, 4, 1)))]):
        m = 7850.0 * math.pi * 0.01**2 * length
        centre, (ax, ay, alpha) = state(t)[k], acceleration(t, k)
        force = [[0.0] * 6 for _ in range(3)]
        for at, column, sign in ends:
            force[0][column] += sign
            force[1][column + 1] += sign
            force[2][column] -= sign * (at[1] - centre[1])
            force[2][column + 1] += sign * (at[0] - centre[0])
        rows += force
        right += [m * ax, m * ay, m * (3 * 0.01**2 + length**2) / 12 * alpha]
    x = gauss(rows, right)
    print(f"four_bar: the ground pushes the rocker at P by {x[4]:.4f} N, {x[5]:.4f} N; A: {x[0]:.4f} N, {x[1]:.4f} N on the coupler")


def gauss(A: list[list[float]], r: list[float]) -> list[float]:
    """Elimination with pivots."""
    n, M = len(r), [row + [value] for row, value in zip(A, r)]
    for k in range(n):
        p = max(range(k, n), key=lambda i: abs(M[i][k]))
        M[k], M[p] = M[p], M[k]
        for i in range(n):
            if i != k:
                f = M[i][k] / M[k][k]
                M[i] = [x - f * y for x, y in zip(M[i], M[k])]
    return [M[i][n] / M[i][i] for i in range(n)]


if __name__ == "__main__":
    earthquake()
    mast()
    pushover()
    four_bar()
