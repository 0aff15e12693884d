"""The problems of scripts/shell_benchmarks.py: shapes, supports, loads and targets, and their meshes of four kinds of elements.

A mesh is one of quadrilaterals by their corners; triangles are their halves, cut from the first corner to the third; elements of order 2 have
nodes between, on the true surface. Forces are consistent with the shape functions. Sources of the targets:

- MacNeal & Harder, Finite Elem. Anal. Des. 1 (1985): straight, curved and thick twisted beam, roof, hemisphere with a hole.
- Simo, Fox & Rifai, Comput. Methods Appl. Mech. Engrg. 73 (1989): the twisted beam of 0.0032, for a load of 1e-6. Of 0.05: in circulation,
  here confirmed by elements of nine nodes, 48 x 8, which come to 0.998 and 0.999 of it.
- Morley & Morris (1978): the closed hemisphere. Cook, J. Struct. Div. ASCE 100 (1974): the membrane; 23.96 is where fine meshes go.
- Raasch's hook: Knight, AIAA Journal 35 (1997); 5.0220 is of refined solid elements of 20 nodes (FinEtools).
"""

import math
from typing import Callable, NamedTuple

import numpy as np

Parameters = np.ndarray
Where = Callable[[Parameters], bool]
ALL = "ux uy uz rx ry rz"


class Problem(NamedTuple):
    name: str
    target: float
    modulus: float
    poisson: float
    thickness: float
    divisions: tuple[list[tuple[int, ...]], list[tuple[int, ...]]]
    """For elements of order 2, of order 1."""
    quadrilaterals: Callable[[tuple[int, ...]], list[list[Parameters]]]
    """Parameters of the corners of each."""
    point: Callable[[Parameters], np.ndarray]
    normal: Callable[[Parameters], np.ndarray]
    supports: list[tuple[Where, str]]
    measure: list[tuple[Where, int, float]]
    """Nodes, component, weight."""
    surface: Callable[[list[Parameters]], str] | None = None
    """In a deck, of an element with corners of these parameters; None: straight edges, or the mesh comes from a file."""
    point_loads: list[tuple[Where, tuple[float, ...]]] = []
    edge_loads: list[tuple[Where, tuple[float, ...]]] = []
    """The force on all of the edge."""
    area_load: tuple[float, ...] = ()
    mirrored: bool = False
    """A quarter, symmetric about x = 0 and y = 0."""

    def label(self, division: tuple[int, ...]) -> str:
        return " x ".join(map(str, division))


def at(**wanted: float) -> Where:
    """Where parameters a, b, c have these values."""
    return lambda p: all(abs(p["abc".index(key)] - value) < 1e-9 for key, value in wanted.items())


def grid(n: int, m: int, of: Callable[[float, float], tuple[float, ...]]) -> list[list[Parameters]]:
    corner = lambda i, j: np.array(of(i / n, j / m), dtype=float)
    return [[corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)] for j in range(m) for i in range(n)]


# ---- meshes ----

CORNERS = {"Q4": [(-1, -1), (1, -1), (1, 1), (-1, 1)], "T3": [(0, 0), (1, 0), (0, 1)]}
PLACES = {
    **CORNERS,
    "Q8": CORNERS["Q4"] + [(0, -1), (1, 0), (0, 1), (-1, 0)],
    "Q9": CORNERS["Q4"] + [(0, -1), (1, 0), (0, 1), (-1, 0), (0, 0)],
    "T6": CORNERS["T3"] + [(0.5, 0), (0.5, 0.5), (0, 0.5)],
}
POWERS = {
    "Q4": [(0, 0), (1, 0), (0, 1), (1, 1)],
    "T3": [(0, 0), (1, 0), (0, 1)],
    "T6": [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)],
    "Q8": [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (2, 1), (1, 2)],
    "Q9": [(i, j) for i in range(3) for j in range(3)],
}


def shares(kind: str, x: np.ndarray) -> np.ndarray:
    """Integrals of the shape functions over the element."""
    powers, places = POWERS[kind], PLACES[kind]
    term = lambda r, i: r**i if i >= 0 else 0.0
    inverse = np.linalg.inv(np.array([[term(r, i) * term(s, j) for i, j in powers] for r, s in places], dtype=float))
    points, weights = np.polynomial.legendre.leggauss(4)
    total = np.zeros(len(places))
    for u, wu in zip(points, weights):
        for v, wv in zip(points, weights):
            r, s, w = u, v, wu * wv
            if kind[0] == "T":
                # The square, one side of which shrinks to a corner.
                a, b = 0.5 * (1 + u), 0.5 * (1 + v)
                r, s, w = a, b * (1 - a), 0.25 * wu * wv * (1 - a)
            shape = np.array([term(r, i) * term(s, j) for i, j in powers]) @ inverse
            along = [
                np.array([i * term(r, i - 1) * term(s, j) for i, j in powers]) @ inverse @ x,
                np.array([j * term(r, i) * term(s, j - 1) for i, j in powers]) @ inverse @ x,
            ]
            total += w * np.linalg.norm(np.cross(*along)) * shape
    return total


def sides(kind: str, element: list[int]) -> list[list[int]]:
    """Nodes along each side: corner, the one between, corner."""
    count = 3 if kind[0] == "T" else 4
    ends = [[element[k], element[(k + 1) % count]] for k in range(count)]
    if kind in ("Q4", "T3"):
        return ends
    return [[a, element[count + k], b] for k, (a, b) in enumerate(ends)]


class Mesh:
    """Nodes with positions x and parameters; elements as lists of nodes."""

    def __init__(self, problem: Problem, division: tuple[int, ...], kind: str):
        self.kind, self.problem = kind, problem
        self.x: list[np.ndarray] = []
        self.parameters: list[Parameters] = []
        self.found: dict[tuple[float, ...], int] = {}
        self.elements = []
        for corners in problem.quadrilaterals(division):
            if kind[0] == "Q":
                self.elements.append(self.element(corners))
            else:
                a, b, c, d = corners
                self.elements += [self.element([a, b, c]), self.element([a, c, d])]
        self.used = sorted({node for nodes in self.elements for node in nodes})

    def node(self, parameters: Parameters) -> int:
        x = self.problem.point(parameters)
        key = tuple(round(float(c), 7) + 0.0 for c in x)
        if key not in self.found:
            self.found[key] = len(self.x)
            self.x.append(x)
            self.parameters.append(parameters)
        return self.found[key]

    def element(self, corners: list[Parameters]) -> list[int]:
        nodes = [self.node(p) for p in corners]
        if self.kind in ("Q8", "Q9", "T6"):
            nodes += [self.node(0.5 * (a + b)) for a, b in zip(corners, corners[1:] + corners[:1])]
        if self.kind == "Q9":
            nodes.append(self.node(sum(corners) / 4))
        return nodes

    def nodes(self, where: Where) -> list[int]:
        return [node for node in self.used if where(self.parameters[node])]

    def edges(self, where: Where) -> list[list[int]]:
        inside = set(self.nodes(where))
        return [side for nodes in self.elements for side in sides(self.kind, nodes) if inside.issuperset(side)]

    def length(self, side: list[int]) -> float:
        return float(np.linalg.norm(self.x[side[-1]] - self.x[side[0]]))

    def turn(self, nodes: list[int]) -> np.ndarray:
        """Along the normal about which the corners go counter-clockwise."""
        a, b, c = (self.x[node] for node in nodes[:3])
        return np.cross(b - a, c - b)

    def forces(self, problem: Problem) -> dict[int, np.ndarray]:
        total = {node: np.zeros(3) for node in self.used}
        for where, force in problem.point_loads:
            for node in self.nodes(where):
                total[node] += force
        for where, force in problem.edge_loads:
            lines = self.edges(where)
            all_ = sum(self.length(side) for side in lines)
            for side in lines:
                weights = [0.5, 0.5] if len(side) == 2 else [1 / 6, 2 / 3, 1 / 6]
                for node, weight in zip(side, weights):
                    total[node] += weight * self.length(side) / all_ * np.array(force)
        if problem.area_load:
            for nodes in self.elements:
                for node, share in zip(nodes, shares(self.kind, np.array([self.x[n] for n in nodes]))):
                    total[node] += share * np.array(problem.area_load)
        return {node: force for node, force in total.items() if force.any()}


# ---- problems ----

UP = lambda p: np.array([0.0, 0.0, 1.0])
SAME = lambda p: p


def straight() -> list[Problem]:
    def quadrilaterals(shape: str):
        def of(division):
            n, m = division

            def place(s: float, t: float):
                k = s * 6
                slant = 0.0 if shape == "rectangles" or k < 0.5 or k > 5.5 else 0.1
                if shape == "trapezoids" and round(k) % 2 == 0:
                    slant = -slant
                return k + slant * (2 * t - 1), 0.2 * t, 0.0

            return grid(n, m, place)

        return of

    tip, low, high = at(a=6.0), at(a=6.0, b=0.0), at(a=6.0, b=0.2)
    rows = [
        ("extension", 3e-5, dict(edge_loads=[(tip, (1.0, 0.0, 0.0))]), [(low, 0, 0.5), (high, 0, 0.5)]),
        ("in-plane shear", 0.1081, dict(edge_loads=[(tip, (0.0, 1.0, 0.0))]), [(low, 1, 0.5), (high, 1, 0.5)]),
        ("out-of-plane shear", 0.4321, dict(edge_loads=[(tip, (0.0, 0.0, 1.0))]), [(low, 2, 0.5), (high, 2, 0.5)]),
        ("twist", 0.03208, dict(point_loads=[(low, (0, 0, -5.0)), (high, (0, 0, 5.0))]), [(low, 2, -5.0), (high, 2, 5.0)]),
    ]
    return [
        Problem(
            f"straight beam, {shape}: {name}", target, 1e7, 0.3, 0.1, ([(6, 1)], [(6, 1)]), quadrilaterals(shape), SAME, UP,
            [(at(a=0.0), ALL)], measure, **loads,
        )
        for shape in ("rectangles", "trapezoids", "parallelograms")
        for name, target, loads, measure in rows
    ]


def curved() -> list[Problem]:
    def point(p):
        return np.array([p[0] * math.cos(p[1]), p[0] * math.sin(p[1]), 0.0])

    end = 0.5 * math.pi
    return [
        Problem(
            f"curved beam, {name}", target, 1e7, 0.25, 0.1, ([(1, 6)], [(1, 6)]),
            lambda division: grid(*division, lambda s, t: (4.12 + 0.2 * s, end * t)), point, UP, [(at(b=0.0), ALL)],
            [(at(a=4.12, b=end), dof, 0.5), (at(a=4.32, b=end), dof, 0.5)],
            lambda _: '{ kind = "cylinder", axis = [0.0, 0.0, 1.0] }', edge_loads=[(at(b=end), force)],
        )
        for name, target, force, dof in (("in plane", 0.08734, (0.0, 1.0, 0.0), 1), ("out of plane", 0.5022, (0.0, 0.0, 1.0), 2))
    ]


def twisted() -> list[Problem]:
    rate = 0.5 * math.pi / 12

    def point(p):
        return np.array([p[0], p[1] * math.cos(rate * p[0]), p[1] * math.sin(rate * p[0])])

    def normal(p):
        sin, cos = math.sin(rate * p[0]), math.cos(rate * p[0])
        n = np.cross([1.0, -p[1] * rate * sin, p[1] * rate * cos], [0.0, cos, sin])
        return n / np.linalg.norm(n)

    rows = [
        (0.32, "in plane", 5.424e-3, 2), (0.32, "out of plane", 1.754e-3, 1),
        (0.05, "in plane", 1.390, 2), (0.05, "out of plane", 0.3431, 1),
        (0.0032, "in plane", 5.256e3, 2), (0.0032, "out of plane", 1.294e3, 1),
    ]
    return [
        Problem(
            f"twisted beam, {thickness}, {name}", target, 29e6, 0.22, thickness, ([(12, 2)], [(12, 2)]),
            lambda division: grid(*division, lambda s, t: (12 * s, 1.1 * t - 0.55)), point, normal, [(at(a=0.0), ALL)],
            [(at(a=12.0, b=0.0), dof, 1.0)], edge_loads=[(at(a=12.0), tuple(float(k == dof) for k in range(3)))],
        )
        for thickness, name, target, dof in rows
    ]


def roof() -> Problem:
    def normal(p):
        return np.array([math.sin(p[1]), 0.0, math.cos(p[1])])

    side = math.radians(40)
    return Problem(
        "Scordelis-Lo roof", 0.3024, 4.32e8, 0.0, 0.25, ([(2, 2), (4, 4), (8, 8)], [(4, 4), (8, 8), (16, 16)]),
        lambda division: grid(*division, lambda s, t: (25 * s, side * t)),
        lambda p: 25 * normal(p) + np.array([0.0, p[0], 0.0]), normal,
        [(at(b=0.0), "ux ry rz"), (at(a=0.0), "uy rx rz"), (at(a=25.0), "ux uz")], [(at(a=0.0, b=side), 2, -1.0)],
        lambda _: '{ kind = "cylinder", axis = [0.0, 1.0, 0.0] }', area_load=(0.0, 0.0, -90.0), mirrored=True,
    )


def hemisphere() -> Problem:
    def normal(p):
        return np.array([math.cos(p[1]) * math.cos(p[0]), math.cos(p[1]) * math.sin(p[0]), math.sin(p[1])])

    end, top = 0.5 * math.pi, math.radians(72)
    return Problem(
        "hemisphere with a hole", 0.0940, 6.825e7, 0.3, 0.04, ([(2, 2), (4, 4), (8, 8)], [(4, 4), (8, 8), (16, 16)]),
        lambda division: grid(*division, lambda s, t: (end * s, top * t)), lambda p: 10 * normal(p), normal,
        [(at(a=0.0), "uy rx rz"), (at(a=end), "ux ry rz"), (at(a=0.0, b=0.0), "uz")], [(at(a=0.0, b=0.0), 0, -1.0)],
        lambda _: '{ kind = "sphere", axis = [0.0, 0.0, 1.0] }',
        point_loads=[(at(a=0.0, b=0.0), (-1.0, 0.0, 0.0)), (at(a=end, b=0.0), (0.0, 1.0, 0.0))], mirrored=True,
    )


def closed() -> Problem:
    def normal(p):
        return p / np.linalg.norm(p)

    def quadrilaterals(division):
        """Three quarters of the faces of a cube, put on the sphere."""
        n = division[0]
        turn = lambda s, t: (1.0, math.tan(0.25 * math.pi * s), math.tan(0.25 * math.pi * t))
        on = lambda p: tuple(10 * normal(np.array(p)))
        return [
            quadrilateral for k in range(3)
            for quadrilateral in grid(n, n, lambda s, t: on([turn(s, t)[(axis - k) % 3] for axis in range(3)]))
        ]

    class Closed(Problem):
        def label(self, division):
            return f"3 x {division[0]} x {division[0]}"

    return Closed(
        "hemisphere, closed", 0.0924, 6.825e7, 0.3, 0.04, ([(1,), (2,), (4,)], [(2,), (4,), (8,)]), quadrilaterals,
        lambda p: 10 * normal(p), normal, [(at(b=0.0), "uy rx rz"), (at(a=0.0), "ux ry rz"), (at(a=0.0, b=0.0), "uz")],
        [(at(b=0.0, c=0.0), 0, -1.0)], lambda _: '{ kind = "sphere" }',
        point_loads=[(at(b=0.0, c=0.0), (-1.0, 0.0, 0.0)), (at(a=0.0, c=0.0), (0.0, 1.0, 0.0))], mirrored=True,
    )


def hook() -> Problem:
    far = 60 * np.array([math.cos(math.radians(120)), math.sin(math.radians(120)), 0.0])

    def normal(p):
        # Of the first arc outwards, of the second inwards: they go on in each other.
        angle = math.radians(180 - p[0] if p[0] <= 60 else 120 + p[0] - 60)
        return np.array([math.cos(angle), math.sin(angle), 0.0])

    def point(p):
        return (14 * normal(p) if p[0] <= 60 else far - 46 * normal(p)) + np.array([0.0, 0.0, p[1]])

    def surface(corners):
        center = [0.0, 0.0, 0.0] if max(p[0] for p in corners) <= 60 + 1e-9 else [float(c) for c in far]
        return f'{{ kind = "cylinder", axis = [0.0, 0.0, 1.0], center = {center} }}'

    def quadrilaterals(division):
        n, m = division
        bend = 2 * n // 9
        along = lambda k: 60 * k / bend if k <= bend else 60 + 150 * (k - bend) / (n - bend)
        return grid(n, m, lambda s, t: (along(round(s * n)), 20 * t))

    return Problem(
        "Raasch's hook", 5.0220, 3300.0, 0.35, 2.0, ([(9, 1), (18, 2)], [(18, 2), (36, 4), (72, 8)]), quadrilaterals, point, normal,
        [(at(a=0.0), ALL)], [(at(a=210.0, b=0.0), 2, 0.5), (at(a=210.0, b=20.0), 2, 0.5)], surface,
        edge_loads=[(at(a=210.0), (0.0, 0.0, 1.0))],
    )


def cook() -> Problem:
    def place(s, t):
        low, high = 44 * s, 44 + 16 * s
        return 48 * s, low + t * (high - low), 0.0

    return Problem(
        "Cook's membrane", 23.96, 1.0, 1 / 3, 1.0, ([(2, 2), (4, 4), (8, 8)], [(2, 2), (4, 4), (8, 8), (16, 16)]),
        lambda division: grid(*division, place), SAME, UP, [(at(a=0.0), ALL)], [(at(a=48.0, b=52.0), 1, 1.0)],
        edge_loads=[(at(a=48.0), (0.0, 1.0, 0.0))],
    )


def problems() -> list[Problem]:
    return [*straight(), *curved(), *twisted(), roof(), hemisphere(), closed(), hook(), cook()]
