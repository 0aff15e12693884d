#!/usr/bin/env python3
"""Shells: error against mesh, time step and run time, beside what other programs need.

    scripts/shells.py REFERENCES               all scenes (ten minutes)
    scripts/shells.py REFERENCES S2b S5        some scenes
    scripts/shells.py REFERENCES --momenta     momenta and energy of the tossed cylinder after the loads

REFERENCES is the folder with S2b_green.csv, S3_elastic.csv and so on, columns of which the first is the time or the load.
Error = rms over all rows / largest value; "loop" is the time stepping alone, least of three runs. The marks of other
programs are seconds of their time loops on one core at the error named: read them as ratios. Python's standard library only.
"""

import csv
import math
import sys
import tempfile
from pathlib import Path
from typing import Callable, NamedTuple

from scenes import ROOT, Run, build, rows, run, unknowns

Table = list[list[float]]


def reference(folder: Path, name: str, columns: int) -> Table:
    """Rows of the first columns, without the comments and the names on top."""
    with (folder / f"{name}.csv").open(newline="") as file:
        lines = list(csv.reader(line for line in file if not line.startswith("#")))
    return [[float(value) for value in line[: columns + 1]] for line in lines[1:]]


def error(found: Table, exact: Table) -> float:
    """Root of the mean of |q - q_ref|^2, divided by max |q_ref|."""
    if len(found) != len(exact):
        raise RuntimeError(f"{len(found)} rows, the reference has {len(exact)}")
    square = sum((a - b) ** 2 for q, r in zip(found, exact) for a, b in zip(q, r))
    return math.sqrt(square / len(exact) / max(sum(b * b for b in r) for r in exact))


class Scene(NamedTuple):
    reference: str
    deck: Callable[[str, tuple, Table], str]
    """Text from the kind of element, the mesh and the reference."""
    columns: list[tuple[str, str]]
    """Named point and column of nodes.csv for each column of the reference."""
    ladder: list[tuple[str, tuple, int]]
    """Kind of element, mesh, divisions of the interval between rows."""
    interval: float = 0.0
    """Between the rows of the reference; 0 where the rows are expected values of a path."""
    marks: str = ""
    sets: tuple[str, ...] = ()
    scale: float = 1.0
    """Times of the run over those of the reference."""


def shipped(name: str, elements: Callable[[tuple], dict[str, list[int]]]) -> Callable[[str, tuple, Table], str]:
    """A deck of the repository with other elements, without the values it expects."""

    def text(kind: str, mesh: tuple, _: Table) -> str:
        deck = (ROOT / "decks" / name / "deck.toml").read_text().split("# ---- expected ----")[0]
        for shell, counts in elements(mesh).items():
            before, after = deck.split(f'name = "{shell}"\n', 1)
            lines = after.split("\n")
            at = next(i for i, line in enumerate(lines) if line.startswith("elements"))
            lines[at] = f'elements = {counts}\nkind = "{kind}"'
            deck = before + f'name = "{shell}"\n' + "\n".join(lines)
        return deck

    return text


def cap(plastic: bool) -> Callable[[str, tuple, Table], str]:
    """A quarter of the cap in three patches drawn flat and put on the sphere, every node a point: (n,); or triangles at the
    pole and rings of quadrilaterals round it: (around, along)."""
    opening, radius = math.radians(26.67), 22.27

    def point(name: str, away: float, round_: float) -> str:
        x = [math.sin(away) * math.cos(round_), math.sin(away) * math.sin(round_), math.cos(away)]
        return f"{name} = {[radius * c for c in x]}\n"

    def shell(name: str, corners: list[str], elements: object, kind: str, surface: str) -> str:
        kind = "triangle" if len(corners) == 3 else kind
        return (
            f'[[shells]]\nname = "{name}"\ncorners = {corners}\nelements = {elements}\nkind = "{kind}"\nthickness = 0.41\n'
            f'material = "metal"\nsurface = {{ kind = "sphere"{surface} }}\n'
        ).replace("'", '"')

    def squares(kind: str, n: int) -> tuple[str, str, dict[str, list[str]]]:
        points, at = "", {}
        groups: dict[str, list[str]] = {"all": [], "rim": [], "low": [], "left": []}
        h = math.sqrt(0.5)
        corners = {"o": (0, 0), "p": (0.5, 0), "q": (0.4, 0.4), "r": (0, 0.5), "s": (1, 0), "t": (h, h), "u": (0, 1)}

        def node(x: float, y: float) -> str:
            nonlocal points
            key = (round(x, 9), round(y, 9))
            if key not in at:
                at[key] = f"n{len(at)}"
                far, round_ = math.hypot(x, y), math.atan2(y, x)
                # The rim of the drawing is two chords.
                rim = math.cos(math.pi / 8) / math.cos(round_ % (math.pi / 4) - math.pi / 8)
                far *= 1 + (far / rim) ** 2 * (1 / rim - 1)
                name = {(0.0, 0.0): "apex", (0.5, 0.0): "half"}.get(key, at[key])
                at[key] = name
                points += point(name, opening * far, round_)
                if abs(far - 1) < 1e-9:
                    groups["rim"].append(name)
                if abs(y) < 1e-9:
                    groups["low"].append(name)
                if abs(x) < 1e-9:
                    groups["left"].append(name)
            return at[key]

        shells = ""
        for patch in ("opqr", "pstq", "qtur"):
            (xa, ya), (xb, yb), (xc, yc), (xd, yd) = (corners[c] for c in patch)

            def on(i: int, j: int) -> str:
                s, t = i / n, j / n
                mix = lambda a, b, c, d: (1 - t) * ((1 - s) * a + s * b) + t * ((1 - s) * d + s * c)
                return node(mix(xa, xb, xc, xd), mix(ya, yb, yc, yd))

            for j in range(n):
                for i in range(n):
                    a, b, c, d = on(i, j), on(i + 1, j), on(i + 1, j + 1), on(i, j + 1)
                    name = f"{patch}_{i}_{j}"
                    groups["all"].append(name)
                    # Diagonals in turn, so that none leads.
                    turned = [a, b, c, d] if (i + j) % 2 == 0 else [b, c, d, a]
                    shells += shell(name, turned, 1, kind, "")
        return points, shells, groups

    def rings(kind: str, around: int, along: int) -> tuple[str, str, dict[str, list[str]]]:
        points = point("apex", 0.0, 0.0)
        groups = {"all": [], "rim": [], "low": ["apex"], "left": ["apex"]}
        shells = ""
        for k in range(around + 1):
            round_ = math.pi / 2 * k / around
            names = ["half" if k == 0 else f"half_{k}", f"ring_{k}", f"rim_{k}"]
            for name, away in zip(names, (0.5, 1 / along, 1.0)):
                points += point(name, opening * away, round_)
        half = lambda k: "half" if k == 0 else f"half_{k}"
        for k in range(around):
            l = k + 1
            shells += shell(f"tip_{k}", ["apex", f"ring_{k}", f"ring_{l}"], 1, kind, "")
            axis = ", axis = [0.0, 0.0, 1.0]"
            shells += shell(f"in_{k}", [f"ring_{k}", half(k), half(l), f"ring_{l}"], [along // 2 - 1, 1], kind, axis)
            shells += shell(f"out_{k}", [half(k), f"rim_{k}", f"rim_{l}", half(l)], [along // 2, 1], kind, axis)
            groups["all"] += [f"tip_{k}", f"in_{k}", f"out_{k}"]
            groups["rim"].append(f"out_{k}.edge2")
        last = around - 1
        groups["low"] += ["tip_0.edge1", "in_0.edge1", "out_0.edge1"]
        groups["left"] += [f"tip_{last}.edge3", f"in_{last}.edge3", f"out_{last}.edge3"]
        return points, shells, groups

    def text(kind: str, mesh: tuple, _: Table) -> str:
        points, shells, groups = squares(kind, *mesh) if len(mesh) == 1 else rings(kind, *mesh)
        material = 'model = "elastic-plastic"\nyield_stress = 24e3\nhardening_modulus = 2.142857e5\n'
        return (
            f'[analysis]\nkind = "dynamic"\nend_time = 1e-3\ntime_step = 5e-6\n[materials.metal]\n'
            f'{material if plastic else ELASTIC}youngs_modulus = 10.5e6\npoisson_ratio = 0.3\ndensity = 2.45e-4\n'
            f'[points]\n{points}{shells}[[supports]]\nat = {groups["rim"]}\nfix = "all"\n'
            f'[[supports]]\nat = {groups["low"]}\nfix = ["uy", "rx", "rz"]\n'
            f'[[supports]]\nat = {groups["left"]}\nfix = ["ux", "ry", "rz"]\n'
            f'[[loads]]\nat = {groups["all"]}\npressure = 600.0\n[output]\ninterval = 5e-6\nnodes = ["apex", "half"]\n'
        ).replace("'", '"')

    return text


ELASTIC = 'model = "elastic"\n'


def static(modulus: float, poisson: float, control: str = "") -> str:
    return (
        f'[analysis]\nkind = "static"\nend_time = 1.0\ntime_step = 0.05\n{control}[iteration]\nlimit = 40\n'
        f'[materials.m]\n{ELASTIC}youngs_modulus = {modulus}\npoisson_ratio = {poisson}\n[points]\n'
    )


def annulus(kind: str, mesh: tuple, _: Table) -> str:
    """(across, around)"""
    text, shells = static(21e6, 0.0), ""
    for k in range(5):
        cos, sin = math.cos(k * math.pi / 2), math.sin(k * math.pi / 2)
        text += f"i{k} = [{6 * cos}, {6 * sin}, 0.0]\no{k} = [{10 * cos}, {10 * sin}, 0.0]\n"
    for k in range(4):
        shells += (
            f'[[shells]]\nname = "q{k}"\ncorners = ["i{k}", "o{k}", "o{k + 1}", "i{k + 1}"]\n'
            f'elements = [{mesh[0]}, {mesh[1] // 4}]\nkind = "{kind}"\nthickness = 0.03\nmaterial = "m"\n'
            'surface = { kind = "cylinder", axis = [0.0, 0.0, 1.0] }\n'
        )
    return (
        f'{text}{shells}[[supports]]\nat = "q0.edge1"\nfix = "all"\n'
        '[[loads]]\nat = "q3.edge3"\nforce_per_length = [0.0, 0.0, 0.8]\n'
        '[output]\ninterval = 0.025\nnodes = ["i4", "o4"]\n'
    )


def strip(length: float, load: str) -> Callable[[str, tuple, Table], str]:
    def text(kind: str, mesh: tuple, _: Table) -> str:
        return (
            f"{static(1.2e6, 0.0)}a = [0.0, 0.0, 0.0]\nb = [{length}, 0.0, 0.0]\nc = [{length}, 1.0, 0.0]\nd = [0.0, 1.0, 0.0]\n"
            f'[[shells]]\nname = "strip"\ncorners = ["a", "b", "c", "d"]\nelements = {list(mesh)}\nkind = "{kind}"\n'
            f'thickness = 0.1\nmaterial = "m"\n[[supports]]\nat = "strip.edge4"\nfix = "all"\n[[loads]]\n{load}\n'
            '[output]\ninterval = 0.05\nnodes = ["b"]\n'
        )

    return text


def expected(at: str, quantity: str, where: str) -> str:
    """A value to be stopped at; any will do."""
    return f'[[expect]]\nat = "{at}"\nquantity = "{quantity}"\n{where}\nvalue = 0.0\nabsolute_tolerance = 1e9\n'


def cylinder(kind: str, mesh: tuple, exact: Table) -> str:
    """Along the path, for it snaps: values where the load first comes to those of the table."""
    text = static(30e3, 0.3, 'control = "arc-length"\n') + (
        "crown = [0.0, 0.0, 100.0]\nside = [100.0, 0.0, 0.0]\nfar_side = [100.0, 100.0, 0.0]\nfar_crown = [0.0, 100.0, 100.0]\n"
        f'[[shells]]\nname = "c"\ncorners = ["crown", "far_crown", "far_side", "side"]\nelements = {list(mesh)}\nkind = "{kind}"\n'
        'thickness = 1.0\nmaterial = "m"\nsurface = { kind = "cylinder", axis = [0.0, 1.0, 0.0] }\n'
        '[[supports]]\nat = "c.edge1"\nfix = ["ux", "ry", "rz"]\n[[supports]]\nat = "c.edge3"\nfix = ["uz", "rx", "ry"]\n'
        '[[supports]]\nat = "c.edge4"\nfix = ["uy", "rx", "rz"]\n[[supports]]\nat = "c.edge2"\nfix = ["ux", "uz"]\n'
        '[[loads]]\nat = "crown"\nforce = [0.0, 0.0, -3000.0]\n'
    )
    for load, _, _ in exact[1:]:
        text += expected("crown", "uz", f"time = {load}") + expected("side", "ux", f"time = {load}")
    return text


def passes(exact: Table) -> list[tuple[float, int]]:
    """Deflections of the table and how often they were passed before; without those beyond the full load, and those within 1 %
    of where the deflection turns back, to which another path may never come."""
    way = [w for _, w in exact]
    turns = [b for a, b, c in zip(way, way[1:], way[2:]) if (b - a) * (c - b) < 0]
    clear = lambda w: all(abs(w - turn) > 0.01 * turn for turn in turns)
    before = lambda k: sum((a - way[k]) * (b - way[k]) < 0 for a, b in zip(way[: k - 1], way[1:k]))
    return [(w, before(k)) for k, (p, w) in enumerate(exact) if k > 0 and p <= 1.0 and clear(w)]


def roof(name: str) -> Callable[[str, tuple, Table], str]:
    """Along the path: the load where the deflection passes those of the table, which may turn back."""

    def text(kind: str, mesh: tuple, exact: Table) -> str:
        deck = shipped(name, lambda mesh: {"roof": list(mesh)})(kind, mesh, exact)
        for w, before in passes(exact):
            where = f'when = {{ at = "crown", quantity = "uz", value = {-w}, pass = {1 + before} }}'
            deck += expected("analysis", "time", where)
        return deck

    return text



def quarters(mesh: tuple) -> dict[str, list[int]]:
    return {f"q{k}": [mesh[0] // 4, mesh[1]] for k in (1, 2, 3, 4)}


def lengths(mesh: tuple) -> dict[str, list[int]]:
    n, m = mesh
    return {"first": [n, m // 2], "second": [n, m // 4], "third": [n, m // 4]}


def patches(mesh: tuple) -> dict[str, list[int]]:
    n, m = mesh
    parts = zip((1, 2, 3, 4), (m // 2, m // 4, m // 16, 3 * m // 16))
    return {f"{side}_{k}": [n // 2, count] for k, count in parts for side in ("inner", "outer")}


Q, T = "quadrilateral", "triangle"
EDGE = [(point, column) for point in "abcd" for column in ("ux", "uy", "uz")]
CROWN = [("crown_half", "uz"), ("crown_three_quarters", "uz")]

SCENES = {
    "S2b": Scene(
        "S2b_green",
        shipped("struck_panel/smooth", lengths),
        CROWN,
        [(Q, (4, 8), 1), (Q, (8, 16), 1), (Q, (8, 16), 2), (Q, (12, 24), 2), (Q, (16, 32), 2), (Q, (24, 48), 4),
         (T, (8, 16), 2), (T, (12, 24), 2), (T, (16, 32), 2)],
        5e-6,
        "OpenSees: 7.8e-2 in 10 s, 2.3e-2 in 42 s",
    ),
    "S2": Scene(
        "S2_green",
        shipped("struck_panel/patch", patches),
        CROWN,
        [(Q, (8, 16), 1), (Q, (8, 16), 2), (Q, (12, 16), 2), (Q, (16, 16), 2), (Q, (16, 32), 2), (T, (16, 32), 2)],
        5e-6,
    ),
    "S3e": Scene(
        "S3_elastic",
        cap(False),
        [("apex", "uz")],
        [(Q, (4,), 1), (Q, (8,), 1), (Q, (8,), 2), (Q, (12,), 2), (Q, (16,), 2), (Q, (8, 16), 1), (Q, (8, 16), 2), (Q, (8, 24), 2),
         (Q, (12, 32), 2), (T, (8,), 1), (T, (8,), 2), (T, (12,), 2), (T, (16,), 4)],
        5e-6,
        "OpenSees: 2.4e-2 in 87 s, 7.1e-3 in 176 s",
    ),
    "S3p": Scene(
        "S3_plastic",
        cap(True),
        [("apex", "uz")],
        [(Q, (4,), 1), (Q, (8,), 1), (Q, (8,), 2), (Q, (12,), 2), (Q, (16,), 2), (Q, (8, 16), 2), (Q, (8, 24), 2), (Q, (12, 32), 2),
         (T, (8,), 2), (T, (12,), 2)],
        5e-6,
    ),
    "S5": Scene(
        "S5",
        shipped("tossed_cylinder", quarters),
        EDGE,
        [(Q, (16, 2), 1), (Q, (16, 2), 2), (Q, (24, 2), 1), (Q, (32, 2), 2), (Q, (32, 4), 1), (Q, (32, 4), 2), (Q, (64, 4), 4),
         (T, (16, 2), 1), (T, (24, 2), 1), (T, (32, 4), 1), (T, (32, 4), 2)],
        0.02,
        "Kratos: 7.1e-3 in 8.3 s, 1.6e-3 in 50 s",
    ),
    "annulus": Scene(
        "S1_slit_annulus",
        annulus,
        [("i4", "uz"), ("o4", "uz")],
        [(Q, (6, 40), 1), (Q, (10, 80), 1), (T, (6, 40), 1), (T, (10, 80), 1)],
        0.025,
        "Kratos: 5.5e-3 in 18 s, 5.4e-4 in 77 s",
    ),
    "hemisphere": Scene(
        "S1_hemisphere",
        shipped("pinched_hemisphere", lambda mesh: {"cap": list(mesh)}),
        [("pulled", "uy"), ("pushed", "-ux")],
        [(Q, (8, 8), 1), (Q, (16, 16), 1), (Q, (32, 32), 1), (T, (16, 16), 1), (T, (32, 32), 1)],
        20.0,
        "Kratos: 2.9e-2 in 1.7 s, 2.7e-3 in 8 s",
        ("output.interval=20.0",),
        400.0,
    ),
    "cylinder": Scene("S1_pinched_cylinder", cylinder, [("crown", "-"), ("side", "")], [(Q, (32, 32), 1), (Q, (40, 40), 1), (T, (40, 40), 1)]),
    "roof": Scene("S1_hinged_roof_12.7", roof("hinged_roof"), [("", "")], [(Q, (8, 8), 1), (Q, (16, 16), 1), (T, (16, 16), 1)]),
    "thin roof": Scene("S1_hinged_roof_6.35", roof("hinged_roof/thin"), [("", "")], [(Q, (8, 8), 1), (Q, (16, 16), 1), (T, (16, 16), 1)]),
    "shear": Scene(
        "S1_cantilever_shear", strip(10.0, 'at = "strip.edge2"\nforce_per_length = [0.0, 0.0, 4.0]'), [("b", "-ux"), ("b", "uz")],
        [(Q, (16, 1), 1), (T, (16, 1), 1)], 0.05,
    ),
    "moment": Scene(
        "S1_cantilever_moment", strip(12.0, 'at = ["b", "c"]\nmoment = [0.0, -26.179938779914945, 0.0]'), [("b", "-ux"), ("b", "uz")],
        [(Q, (16, 1), 1), (T, (16, 1), 1)], 0.05,
    ),
}


def history(scene: Scene, done: Run, exact: Table) -> Table:
    if scene.interval == 0.0:
        values = [e["value"] for e in done.report["expectations"]]
        if None in values:
            raise RuntimeError(f"{values.count(None)} of {len(values)} values never reached")
        count = len(scene.columns)
        sign = [-1.0 if column == "-" else 1.0 for _, column in scene.columns]
        return [[0.0] * count] + [
            [s * v for s, v in zip(sign, values[k : k + count])] for k in range(0, len(values), count)
        ]
    at = rows(done.folder / "nodes.csv")
    scale = scene.scale
    moments = [min(at, key=lambda t: abs(t - scale * row[0])) for row in exact]
    assert all(abs(t - scale * row[0]) < 1e-6 * scale for t, row in zip(moments, exact))
    value = lambda moment, point, column: (
        -moment[point][column[1:]] if column[0] == "-" else moment[point][column]
    )
    return [[value(at[t], point, column) for point, column in scene.columns] for t in moments]


class Measured(NamedTuple):
    error: float
    loop: float
    process: float
    report: dict


def measure(scene: Scene, exact: Table, setting: tuple[str, tuple, int], more: list[str], repeats: int, budget: float) -> Measured:
    kind, mesh, division = setting
    paths = scene.interval == 0.0
    sets = [*scene.sets, *more, "output.energy=false"]
    if not paths:
        sets.append(f"analysis.time_step={scene.interval / division!r}")
    # The path of the roof gives the load at a deflection, all others displacements at a time or load.
    wanted = [row[1:] for row in exact]
    if scene.columns[0][0] == "":
        kept = [w for w, _ in passes(exact)]
        wanted = [row[:1] for row in exact if row[1] == 0.0 or row[1] in kept]
    loop = process = math.inf
    with tempfile.TemporaryDirectory() as folder:
        deck = Path(folder) / "deck.toml"
        deck.write_text(scene.deck(kind, mesh, exact))
        spent = 0.0
        for _ in range(repeats):
            done = run(deck, sets, Path(folder) / "out")
            loop, process = min(loop, done.loop_s), min(process, done.process_s)
            spent += done.process_s
            if spent > budget:
                break
        size = error(history(scene, done, exact), wanted)
    return Measured(size, loop, process, done.report)


def speed(folder: Path, names: list[str], more: list[str]) -> None:
    print("| scene | elements | dt | unknowns | steps | iterations | factorizations | error | loop s | process s | others |")
    print("|" + "---|" * 11)
    for name in names:
        scene = SCENES[name]
        exact = reference(folder, scene.reference, max(len(scene.columns), 1))
        found = []
        for setting in scene.ladder:
            kind, mesh, division = setting
            what = f"{' x '.join(map(str, mesh))} {kind}s"
            try:
                m = measure(scene, exact, setting, more, 3, 6.0)
            except RuntimeError as failed:
                print(f"| {name} | {what} | | {failed} |", flush=True)
                continue
            found.append((m.loop, m.error, what, setting[2]))
            counts = m.report["counts"]
            step = f"{scene.interval / division:.3g}" if scene.interval else ""
            print(
                f"| {name} | {what} | {step} | {unknowns(m.report)} | {counts['steps']} | {counts['iterations']} |"
                f" {counts['factorizations']} | {m.error:.1e} | {m.loop:.3f} | {m.process:.3f} | {scene.marks} |",
                flush=True,
            )
        for wanted in (2e-2, 1e-2, 5e-3):
            if reached := [entry for entry in found if entry[1] <= wanted]:
                loop, size, what, division = min(reached)
                step = f", dt {scene.interval / division:.3g}" if scene.interval else ""
                print(f"| {name} | cheapest to {wanted:.1%}: {what}{step} | | | | | | {size:.1e} | {loop:.3f} | | |", flush=True)


def momenta(folder: Path) -> None:
    """Of the tossed cylinder, from the end of the loads on."""
    angular = (36.51, 43.66, -54.42)
    scene = SCENES["S5"]
    exact = reference(folder, "S5", 12)
    print("| elements | dt | |p - (5, 0, 0)| | |L - L(1)| | |L - L_ref| | energy at 1 | its change to 4 |\n" + "|---" * 7 + "|")
    for mesh, division in (((16, 2), 1), ((16, 2), 2), ((32, 4), 1), ((32, 4), 2), ((32, 4), 4), ((32, 4), 8)):
        with tempfile.TemporaryDirectory() as out:
            deck = Path(out) / "deck.toml"
            deck.write_text(scene.deck(Q, mesh, exact))
            run(deck, [f"analysis.time_step={scene.interval / division!r}"], Path(out) / "out")
            with (Path(out) / "out" / "energy.csv").open(newline="") as file:
                lines = [{k: float(v) for k, v in line.items() if k != "stage"} for line in csv.DictReader(file)]
        after = [line for line in lines if line["time"] > 1 - 1e-9]
        far = lambda keys, to: max(math.dist([line[k] for k in keys], to) for line in after)
        first = after[0]
        energy = [line["kinetic"] + line["strain"] for line in after]
        print(
            f"| {mesh[0]} x {mesh[1]} | {scene.interval / division:.3g} | {far(('px', 'py', 'pz'), (5, 0, 0)):.1e} |"
            f" {far(('lx', 'ly', 'lz'), [first[k] for k in ('lx', 'ly', 'lz')]):.1e} | {far(('lx', 'ly', 'lz'), angular):.1e} |"
            f" {energy[0]:.3f} | {energy[-1] / energy[0] - 1:+.1e} |",
            flush=True,
        )


if __name__ == "__main__":
    words = [word for word in sys.argv[1:] if not word.startswith("--") and "=" not in word]
    more = [word for word in sys.argv[1:] if "=" in word]
    if not words or not Path(words[0]).is_dir():
        sys.exit(__doc__)
    if unknown := [word for word in words[1:] if word not in SCENES]:
        sys.exit(f"unknown: {', '.join(unknown)}; known: {', '.join(SCENES)}")
    build()
    if "--momenta" in sys.argv:
        momenta(Path(words[0]))
    else:
        speed(Path(words[0]), words[1:] or list(SCENES), more)
