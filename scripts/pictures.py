#!/usr/bin/env python3
"""Draws the pictures of docs/pictures: section axes and signs, joints, contact, shells, stages, and the error of the schemes.

    scripts/pictures.py

Every picture follows the light or dark setting of the reader. Python's standard library only.
"""

import cmath
import math
from pathlib import Path

FOLDER = Path(__file__).resolve().parent.parent / "docs" / "pictures"
STYLE = """
.p{font:13px Helvetica,Arial,sans-serif}
.p text{fill:#24292f}.p .dim{fill:#57606a}.p .bold{font-weight:bold}
.p .ink{stroke:#24292f;fill:none;stroke-width:1.6}.p .thin{stroke:#8c959f;fill:none}
.p .face{fill:#8c959f;fill-opacity:.18;stroke:#57606a}.p .solid{fill:#8c959f;fill-opacity:.5;stroke:#57606a}
.p .a{stroke:#0969da;fill:none;stroke-width:2}.p .b{stroke:#cf222e;fill:none;stroke-width:2}.p .c{stroke:#1a7f37;fill:none;stroke-width:2}
.p .d{stroke:#8250df;fill:none;stroke-width:2}.p .e{stroke:#bf8700;fill:none;stroke-width:2}.p .f{stroke:#57606a;fill:none;stroke-width:2}
.p text.a{fill:#0969da;stroke:none}.p text.b{fill:#cf222e;stroke:none}.p text.c{fill:#1a7f37;stroke:none}
.p text.d{fill:#8250df;stroke:none}.p text.e{fill:#9a6700;stroke:none}.p text.f{fill:#57606a;stroke:none}
@media (prefers-color-scheme:dark){.p text{fill:#e6edf3}.p .dim{fill:#9198a1}.p .ink{stroke:#e6edf3}.p .face,.p .solid{stroke:#9198a1}
.p .a{stroke:#4493f8}.p .b{stroke:#f85149}.p .c{stroke:#3fb950}.p .d{stroke:#ab7df8}.p .e{stroke:#d29922}.p .f{stroke:#9198a1}
.p text.a{fill:#4493f8}.p text.b{fill:#f85149}.p text.c{fill:#3fb950}.p text.d{fill:#ab7df8}.p text.e{fill:#d29922}.p text.f{fill:#9198a1}}
""".replace("\n", "")


class Picture:
    """An SVG file, built from top to bottom."""

    def __init__(self, width: float, height: float, label: str):
        self.head = (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {height:g}" width="{width:g}" class="p" role="img" aria-label="{label}">'
            f"<title>{label}</title><style>{STYLE}</style>"
        )
        self.parts: list[str] = []

    def text(self, x, y, words, kind="", anchor="start"):
        self.parts.append(f'<text x="{x:.1f}" y="{y:.1f}" class="{kind}" text-anchor="{anchor}">{words}</text>')

    def line(self, points, kind="ink", extra=""):
        at = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        self.parts.append(f'<polyline points="{at}" class="{kind}" {extra}/>')

    def area(self, points, kind="face"):
        at = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        self.parts.append(f'<polygon points="{at}" class="{kind}"/>')

    def circle(self, x, y, r, kind="ink"):
        self.parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{r:.1f}" class="{kind}"/>')

    def arrow(self, a, b, kind="a", double=False):
        """A force from a to b; with two heads a moment about the line."""
        (x, y), (X, Y) = a, b
        length = math.hypot(X - x, Y - y)
        u, v = (X - x) / length, (Y - y) / length
        self.line([a, b], kind)
        for back in (0.0, 7.0) if double else (0.0,):
            tip = (X - back * u, Y - back * v)
            self.line([(tip[0] - 8 * u - 4 * v, tip[1] - 8 * v + 4 * u), tip, (tip[0] - 8 * u + 4 * v, tip[1] - 8 * v - 4 * u)], kind)

    def save(self, name: str):
        (FOLDER / f"{name}.svg").write_text(self.head + "\n" + "\n".join(self.parts) + "\n</svg>\n")


def oblique(origin, scale=1.0):
    """x to the lower right, y to the upper right, z up."""
    ox, oy = origin

    def at(x, y, z):
        return ox + scale * (0.92 * x + 0.55 * y), oy + scale * (0.26 * x - 0.36 * y - z)

    return at


def section_axes():
    p = Picture(820, 300, "Section axes of a beam and positive section forces")
    at = oblique((40, 150))
    w, h, length = 44, 34, 190
    corners = lambda x: [(x, -w, -h), (x, w, -h), (x, w, h), (x, -w, h)]
    front, back = [at(*c) for c in corners(length)], [at(*c) for c in corners(0)]
    p.area([back[3], back[2], front[2], front[3]])
    p.area([back[0], back[3], front[3], front[0]])
    p.area(front, "solid")
    c = at(length, 0, 0)
    for tip, name in (((length + 110, 0, 0), "x"), ((length, 130, 0), "y: `orientation`"), ((length, 0, 95), "z")):
        e = at(*tip)
        p.arrow(c, e, "ink")
        p.text(e[0] + 6, e[1] + 4, name.replace("`", ""), "bold")
    p.text(40, 40, "width along y, height along z")
    p.text(40, 282, "The cut face looks along +x: forces of the part beyond on the part before.", "dim")
    at = oblique((470, 170))
    face = [at(0, -w, -h), at(0, w, -h), at(0, w, h), at(0, -w, h)]
    p.area(face, "solid")
    o = at(0, 0, 0)
    for tip, name, kind, double in (
        ((100, 0, 0), "N, T", "a", False),
        ((70, 0, 0), "", "a", True),
        ((0, 120, 0), "Vy, My", "b", False),
        ((0, 90, 0), "", "b", True),
        ((0, 0, 110), "Vz, Mz", "c", False),
        ((0, 0, 80), "", "c", True),
    ):
        e = at(*tip)
        p.arrow(o, e, kind, double)
        if name:
            p.text(e[0] + 8, e[1] + 4, name, kind)
    p.text(560, 238, "single arrow: force")
    p.text(560, 256, "double arrow: moment, right-handed")
    p.text(560, 40, "My &gt; 0: tension at +z")
    p.text(560, 58, "Mz &gt; 0: tension at −y")
    p.save("section_axes")


# Kind, free rotations, free displacements: `o` about or along the joint's axis, `x` across it.
JOINTS = [
    ("spherical", "all rotations", "none"),
    ("revolute", "about the axis", "none"),
    ("universal", "about two arms", "none"),
    ("fixed", "none", "none"),
    ("prismatic", "none", "along the axis"),
    ("cylindrical", "about the axis", "along the axis"),
    ("screw", "about the axis,", "coupled to it"),
    ("planar", "about the normal", "in the plane"),
    ("in-line", "all rotations", "along the axis"),
    ("in-plane", "all rotations", "in the plane"),
    ("distance", "all rotations", "at a distance"),
]


def arc(p, x, y, rx, ry, kind):
    points = [(x + rx * math.cos(t / 20 * math.pi), y + ry * math.sin(t / 20 * math.pi)) for t in range(3, 33)]
    p.line(points, kind)
    (a, b), (c, d) = points[-2], points[-1]
    p.arrow((a, b), (c, d), kind)


def joints():
    p = Picture(820, 470, "Kinds of joints and the motions that they leave free")
    for k, (name, turns, slides) in enumerate(JOINTS):
        x, y = 20 + 200 * (k % 4), 20 + 152 * (k // 4)
        cx, cy = x + 92, y + 54
        axis = [(cx - 62, cy), (cx + 62, cy)]
        if name in ("spherical", "in-line", "in-plane", "distance"):
            p.circle(cx, cy, 13, "solid")
            p.circle(cx, cy, 19, "ink")
        elif name == "planar":
            p.area([(cx - 26, cy - 8), (cx + 14, cy - 8), (cx + 26, cy + 4), (cx - 14, cy + 4)], "solid")
        else:
            p.area([(cx - 20, cy - 13), (cx + 20, cy - 13), (cx + 20, cy + 13), (cx - 20, cy + 13)], "solid")
        if name in ("revolute", "cylindrical", "screw", "prismatic", "in-line"):
            p.line(axis, "thin", 'stroke-dasharray="8 3 2 3"')
        if name == "universal":
            p.line([(cx - 46, cy), (cx + 46, cy)], "ink")
            p.line([(cx, cy - 34), (cx, cy + 34)], "ink")
            arc(p, cx + 44, cy, 6, 13, "a")
            arc(p, cx, cy - 32, 13, 6, "a")
        if name in ("in-plane", "planar"):
            p.area([(cx - 62, cy + 12), (cx + 30, cy + 12), (cx + 62, cy + 30), (cx - 30, cy + 30)])
            p.arrow((cx, cy + 21), (cx + 44, cy + 21), "b")
            p.arrow((cx, cy + 21), (cx + 17, cy + 29), "b")
        if turns.startswith("about the"):
            if name == "planar":
                arc(p, cx, cy - 22, 15, 6, "a")
            else:
                arc(p, cx + 44, cy, 7, 16, "a")
        if turns == "all rotations":
            arc(p, cx, cy - 4, 27, 27, "a")
        if "along the axis" in slides or "coupled" in slides:
            p.arrow((cx + 22, cy + 26), (cx + 66, cy + 26), "b")
            p.arrow((cx - 22, cy + 26), (cx - 66, cy + 26), "b")
        if name == "distance":
            p.line([(cx - 70, cy + 22), (cx - 13, cy + 5)], "ink")
            p.circle(cx - 72, cy + 23, 4, "solid")
        p.text(cx, y + 108, name, "bold", "middle")
        p.text(cx, y + 125, turns, "a", "middle")
        p.text(cx, y + 141, slides, "b", "middle")
    p.text(640, 380, "blue: free rotation", "a")
    p.text(640, 400, "red: free displacement", "b")
    p.text(640, 420, "dashed: axis", "dim")
    p.save("joints")


TOUCH = ["plane", "box, hull", "cylinder", "capsule", "sphere, point", "shell faces", "beam, bar, edge"]
# full, corners (points of the body and nodes of the other), prism, nodes, - for not detected.
TABLE = {
    ("box, hull", "plane"): "full", ("cylinder", "plane"): "full", ("capsule", "plane"): "ends", ("sphere, point", "plane"): "full",
    ("shell faces", "plane"): "nodes", ("beam, bar, edge", "plane"): "nodes",
    ("box, hull", "box, hull"): "full", ("cylinder", "box, hull"): "full", ("capsule", "box, hull"): "full", ("sphere, point", "box, hull"): "full",
    ("cylinder", "cylinder"): "full", ("capsule", "cylinder"): "full", ("sphere, point", "cylinder"): "full",
    ("capsule", "capsule"): "full", ("sphere, point", "capsule"): "full", ("sphere, point", "sphere, point"): "full",
    ("box, hull", "shell faces"): "corners", ("cylinder", "shell faces"): "16 a rim", ("capsule", "shell faces"): "ends",
    ("sphere, point", "shell faces"): "full", ("shell faces", "shell faces"): "nodes", ("beam, bar, edge", "shell faces"): "nodes",
    ("box, hull", "beam, bar, edge"): "edges", ("cylinder", "beam, bar, edge"): "prism", ("capsule", "beam, bar, edge"): "full",
    ("sphere, point", "beam, bar, edge"): "full", ("beam, bar, edge", "beam, bar, edge"): "full", ("shell faces", "beam, bar, edge"): "nodes",
}  # fmt: skip
SHADE = {"full": "c", "corners": "a", "ends": "a", "16 a rim": "a", "edges": "a", "prism": "a", "nodes": "e"}


def contact():
    p = Picture(880, 372, "Contact: which pairs touch, and with which part of their surface")
    left, top, w, h = 140, 70, 103, 34
    p.text(left + 3.5 * w, 24, "surface", "bold", "middle")
    p.text(20, 58, "touching part", "bold")
    for j, name in enumerate(TOUCH):
        p.text(left + (j + 0.5) * w, 58, name, "", "middle")
        p.text(20, top + (j + 0.65) * h, name)
        for i, other in enumerate(TOUCH):
            x, y = left + i * w, top + j * h
            p.line([(x, y), (x + w, y), (x + w, y + h), (x, y + h), (x, y)], "thin")
            how = TABLE.get((name, other)) or TABLE.get((other, name), "–" if (name, other) == ("plane", "plane") else "")
            if how:
                p.text(x + w / 2, y + 0.65 * h, how, SHADE.get(how, "dim"), "middle")
    y = top + 7 * h + 22
    p.text(20, y, "green: the whole surface, with corners, edges, rims and faces.", "c")
    p.text(20, y + 19, "blue: these points of a body, and the nodes of the other part on the body's surface.", "a")
    p.text(520, y, "orange: nodes, and points between them.", "e")
    p.save("contact")


def shell():
    p = Picture(820, 300, "Shell: corners, normal, axes, layers and positive resultants")
    at = oblique((60, 150), 1.0)
    q = [at(0, 0, 0), at(170, 0, 0), at(170, 150, 0), at(0, 150, 0)]
    p.area(q)
    for k, c in enumerate(q):
        p.text(c[0] + (-16 if k in (0, 3) else 8), c[1] + (16 if k < 2 else -6), str(k + 1), "bold")
    c = at(85, 75, 0)
    p.arrow(c, at(85, 75, 100), "b")
    p.text(c[0] + 8, c[1] - 92, "normal: top", "b")
    p.arrow(c, at(165, 75, 0), "a")
    p.text(at(165, 75, 0)[0] + 6, at(165, 75, 0)[1] + 10, "1: axis", "a")
    p.arrow(c, at(85, 145, 0), "a")
    p.text(at(85, 145, 0)[0] + 6, at(85, 145, 0)[1] - 4, "2", "a")
    p.text(30, 270, "Corners run counter-clockwise about the normal.", "dim")
    p.text(30, 288, "Pressure acts against the normal.", "dim")
    x, y = 370, 70
    p.text(x, y - 18, "layers, from the bottom up", "bold")
    for k in range(5):
        p.area([(x, y + 24 * k), (x + 150, y + 24 * k), (x + 150, y + 24 * (k + 1)), (x, y + 24 * (k + 1))], "face")
        p.text(x + 158, y + 24 * k + 17, f"layer {4 - k}", "dim")
    p.arrow((x - 14, y + 60), (x - 14, y + 4), "b")
    p.text(x - 22, y + 30, "z", "b", "end")
    p.text(x, y + 140, "z = 0 at the mid-surface", "dim")
    x, y = 620, 130
    p.area([(x, y - 16), (x + 110, y - 16), (x + 110, y + 16), (x, y + 16)], "solid")
    p.arrow((x + 112, y), (x + 160, y), "a")
    p.text(x + 150, y + 20, "N11", "a")
    p.arrow((x + 112, y - 12), (x + 142, y - 12), "c")
    p.arrow((x + 142, y + 12), (x + 112, y + 12), "c")
    p.text(x + 118, y - 20, "M11", "c")
    p.text(x - 10, y + 60, "M11 &gt; 0: tension at the top")
    p.text(x - 10, y + 78, "N11 &gt; 0: tension")
    p.text(x - 10, y + 96, "Q1 = ∂M11/∂1 + ∂M12/∂2")
    p.save("shell")


def stages():
    p = Picture(820, 250, "Stages of one deck on a time line: what continues and what changes")
    spans = [(0, 190, "weight", "static"), (190, 430, "impact", "dynamic"), (430, 520, "modes", "modal"), (520, 760, "rest", "static")]
    y = 60
    for a, b, name, kind in spans:
        p.area([(40 + a, y), (40 + b - 4, y), (40 + b - 4, y + 44), (40 + a, y + 44)], "face")
        p.text(40 + (a + b) / 2, y + 19, name, "bold", "middle")
        p.text(40 + (a + b) / 2, y + 37, kind, "dim", "middle")
    p.arrow((40, 122), (790, 122), "ink")
    p.text(792, 140, "time", "", "end")
    p.text(480 + 25, 140, "no time passes", "dim", "middle")
    rows = [
        ("positions, stresses, contacts", [(0, 760)], "c"),
        ("velocities", [(190, 430)], "a"),
        ("load without an amplitude: grows, then stays", [(0, 760)], "b"),
        ("support with stages = [\"weight\"]", [(0, 190)], "e"),
    ]
    for k, (words, parts, kind) in enumerate(rows):
        h = 164 + 24 * k
        for a, b in parts:
            if kind == "b":
                p.line([(40 + a, h + 6), (40 + 190, h - 8), (40 + b, h - 8)], kind)
            else:
                p.line([(40 + a, h), (40 + b, h)], kind)
        p.text(46 + (200 if kind == "e" else 440 if kind == "a" else 300), h + (4 if kind in "ea" else -4 if kind == "c" else 8), words, kind)
    p.text(40, 34, "[[stages]]", "bold")
    p.save("stages")


def generalized(om, am, af):
    """Amplification matrix of (u, Δt v, Δt² a) for inertia weight am, force weight af, Ω = om."""
    g = 0.5 - am + af
    b = 0.25 * (1 - am + af) ** 2
    o = om * om
    den = (1 - am) + o * (1 - af) * b
    row = [-(o * (1 - af) + o * af) / den, -o * (1 - af) / den, -(am + o * (1 - af) * (0.5 - b)) / den]
    return [
        [1 + b * row[0], 1 + b * row[1], 0.5 - b + b * row[2]],
        [g * row[0], 1 + g * row[1], 1 - g + g * row[2]],
        row,
    ]


def wilson(om, theta=1.4):
    """Linear acceleration over θ steps, equilibrium at their end."""
    o, t = om * om, theta
    den = 1 + o * t * t / 6
    end = [-o / den, -o * t / den, -o * t * t / 3 / den]  # a at t + θΔt from (u, v, a)
    a1 = [e / t + (1 - 1 / t) * d for e, d in zip(end, (0, 0, 1))]
    return [
        [1 + a1[0] / 6, 1 + a1[1] / 6, 1 / 3 + a1[2] / 6],
        [a1[0] / 2, 1 + a1[1] / 2, 0.5 + a1[2] / 2],
        a1,
    ]


def eigenvalue(matrix, guess):
    """The eigenvalue of a 3 x 3 matrix next to a guess, by Newton's method on its characteristic polynomial."""
    (a, b, c), (d, e, f), (g, h, i) = matrix
    t = a + e + i
    m = a * e - b * d + a * i - c * g + e * i - f * h
    det = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    z = guess
    for _ in range(60):
        z -= (z**3 - t * z**2 + m * z - det) / (3 * z**2 - 2 * t * z + m)
    return z


def bathe(om):
    """Stability function of the trapezoidal rule and backward differences, both with the weight 1 − 1/√2."""
    z, g = 1j * om, 2 - math.sqrt(2)
    mid = (1 + g * z / 2) / (1 - g * z / 2)
    return (mid / (g * (2 - g)) - (1 - g) ** 2 / (g * (2 - g))) / (1 - (1 - g) / (2 - g) * z)


def esdirk3(om):
    r, z, g = math.sqrt(2), 1j * om, 9 / 40
    a3, a4, a43 = 9 * (1 + r) / 80, (22 + 15 * r) / (80 * (1 + r)), -7 / (40 * (1 + r))
    b1, b3, b4 = (2398 + 1205 * r) / (2835 * (4 + 3 * r)), -2374 * (1 + 2 * r) / (2835 * (5 + 3 * r)), 5827 / 7560
    rates = [z]
    for row in ([g], [a3, a3], [a4, a4, a43], [b1, b1, b3, b4]):
        y = 1 + sum(w * k for w, k in zip(row, rates))
        rates.append(z * y / (1 - g * z))
    return rates[-1] / z


def radius(rho):
    return (2 * rho - 1) / (rho + 1), rho / (rho + 1)


SCHEMES = [
    ("wilson-theta", 1, lambda o: eigenvalue(wilson(o), cmath.exp(1j * o)), "b"),
    ("newmark (no damping)", 1, lambda o: eigenvalue(generalized(o, 0, 0), cmath.exp(1j * o)), "f"),
    ("hht-alpha −0.05", 1, lambda o: eigenvalue(generalized(o, 0, 0.05), cmath.exp(1j * o)), "e"),
    ("generalized-alpha 0.8", 1, lambda o: eigenvalue(generalized(o, *radius(0.8)), cmath.exp(1j * o)), "d"),
    ("bathe", 2, bathe, "a"),
    ("esdirk3", 4, esdirk3, "c"),
]


def schemes():
    p = Picture(860, 405, "Damping and period error of the implicit schemes over the number of solutions a period")
    for left, title, measure, low in (
        (70, "amplitude lost in a period, %", lambda lam, om: 100 * (1 - abs(lam) ** (2 * math.pi / abs(cmath.phase(lam)))), 1e-4),
        (490, "period too long, %", lambda lam, om: 100 * (om / abs(cmath.phase(lam)) - 1), 1e-4),
    ):
        top, w, h, high = 40, 330, 270, 1e2
        X = lambda n: left + w * (math.log10(n) - 1) / 1.5
        Y = lambda v: top + h * math.log10(high / v) / math.log10(high / low)
        p.text(left, 24, title, "bold")
        for v in (1e-4, 1e-3, 1e-2, 1e-1, 1, 10, 100):
            p.line([(left, Y(v)), (left + w, Y(v))], "thin", 'stroke-opacity=".35"')
            p.text(left - 6, Y(v) + 4, f"{v:g}", "dim", "end")
        for n in (10, 20, 50, 100, 200):
            p.line([(X(n), top), (X(n), top + h)], "thin", 'stroke-opacity=".35"')
            p.text(X(n), top + h + 18, f"{n}", "dim", "middle")
        p.text(left + w / 2, top + h + 38, "solutions a period (steps × stages)", "", "middle")
        labels = []
        for name, stages_, value, kind in SCHEMES:
            points = []
            for k in range(61):
                n = 10 ** (1 + 1.5 * k / 60)
                om = 2 * math.pi * stages_ / n
                v = abs(measure(value(om), om))
                if low <= v <= high:
                    points.append((X(n), Y(v)))
            if len(points) > 1:
                p.line(points, kind)
    for k, (name, _, _, kind) in enumerate(SCHEMES):
        p.text(70 + 260 * (k % 3), 372 + 18 * (k // 3), name, kind)
    p.save("schemes")


def main():
    FOLDER.mkdir(exist_ok=True)
    for draw in (section_axes, joints, contact, shell, stages, schemes):
        draw()


if __name__ == "__main__":
    main()
