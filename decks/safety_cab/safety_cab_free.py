"""The safety cab by free meshes of triangles and of quadrilaterals, as a mesher makes them, beside the meshes of rows and columns.

    python3 -m venv /tmp/gmsh && /tmp/gmsh/bin/pip install gmsh
    /tmp/gmsh/bin/python decks/safety_cab/safety_cab_free.py            # the three blows; a table in Markdown on standard output

Frame, points and backbone are those of decks/safety_cab/safety_cab_mesh.py; each flat piece of sheet between members of the frame is meshed by
Gmsh from the nodes of the frame round it, and shares them. A hole in the roof, for a hatch, is what rows and columns do not have:
there the two kinds of meshes are compared with each other. Needs the package gmsh, which needs the system's libraries of X11 and OpenGL.
"""

import math
import sys
import tempfile
from pathlib import Path

import gmsh
import safety_cab as cab
import safety_cab_mesh as geometry
import scenes

# Centre and radius of the hole in the rear half of the roof, at y = 0.
HOLE = (0.0, 0.22)
FOLDER = geometry.FOLDER
SHEETS = ("floor", "roof", "panels")


def regions(mesh: geometry.Mesh) -> list[tuple[str, list[int], tuple[float, ...]]]:
    """Group, nodes round it and normal of each flat piece of sheet between members of the frame."""
    members = {
        frozenset(pair) for group in ("posts", "sills", "roof_frame", "rails") for pair in mesh.groups[group]
    }
    made = []
    for group in SHEETS:
        left = list(mesh.groups[group])
        while left:
            # Faces that hang together across edges without a member.
            piece, waiting = [], [left.pop()]
            while waiting:
                face = waiting.pop()
                piece.append(face)
                inner = {frozenset(side) for side in zip(face, face[1:] + face[:1])} - members
                near = [other for other in left if inner & {frozenset(s) for s in zip(other, other[1:] + other[:1])}]
                left = [other for other in left if other not in near]
                waiting += near
            sides = [side for face in piece for side in zip(face, face[1:] + face[:1])]
            after = {a: b for a, b in sides if (b, a) not in sides}
            start = min(after)
            ring = [start]
            while after[ring[-1]] != start:
                ring.append(after[ring[-1]])
            x = [mesh.nodes[node - 1] for node in piece[0]]
            made.append((group, ring, cab.cross(cab.plus(x[2], x[0], -1), cab.plus(x[3], x[1], -1))))
    return made


def fill(mesh: geometry.Mesh, group: str, ring: list[int], normal, kind: str, hole: bool) -> None:
    """A free mesh between the nodes of the ring, into the group."""
    gmsh.model.add(group)
    geo = gmsh.model.geo
    x = [mesh.nodes[node - 1] for node in ring]
    side = sum(math.dist(a, b) for a, b in zip(x, x[1:] + x[:1])) / len(x)
    points = [geo.addPoint(*at, side) for at in x]
    lines = [geo.addLine(a, b) for a, b in zip(points, points[1:] + points[:1])]
    loops = [geo.addCurveLoop(lines)]
    if hole:
        round_ = 4 * max(2, round(2 * math.pi * HOLE[1] / side / 4))
        middle = geo.addPoint(HOLE[0], 0.0, geometry.ROOF)
        rim = [geo.addPoint(HOLE[0] + HOLE[1] * dx, HOLE[1] * dy, geometry.ROOF, side) for dx, dy in ((1, 0), (0, 1), (-1, 0), (0, -1))]
        arcs = [geo.addCircleArc(a, middle, b) for a, b in zip(rim, rim[1:] + rim[:1])]
        for arc in arcs:
            geo.mesh.setTransfiniteCurve(arc, round_ // 4 + 1)
        loops.append(geo.addCurveLoop(arcs))
    for line in lines:
        geo.mesh.setTransfiniteCurve(line, 2)
    surface = geo.addPlaneSurface(loops)
    geo.synchronize()
    if kind == "quadrilateral":
        gmsh.model.mesh.setRecombine(2, surface)
    # Frontal, for triangles and for quadrilaterals.
    gmsh.option.setNumber("Mesh.Algorithm", 8 if kind == "quadrilateral" else 6)
    gmsh.model.mesh.generate(2)
    tags, places, _ = gmsh.model.mesh.getNodes(includeBoundary=True)
    at = {int(tag): mesh.node(*places[3 * i : 3 * i + 3]) for i, tag in enumerate(tags)}
    kinds, _, nodes = gmsh.model.mesh.getElements(2)
    for shape, flat in zip(kinds, nodes):
        corners = {2: 3, 3: 4}[int(shape)]
        for i in range(0, len(flat), corners):
            cell = [at[int(tag)] for tag in flat[i : i + corners]]
            a, b, c = (mesh.nodes[node - 1] for node in cell[:3])
            up = cab.dot(cab.cross(cab.plus(b, a, -1), cab.plus(c, a, -1)), normal) > 0
            mesh.add(group, *(cell if up else cell[::-1]))
    gmsh.model.remove()


def free(name: str, kind: str, hole: bool) -> geometry.Mesh:
    """The cab with the frame of the mesh `name` of rows and columns."""
    mesh = geometry.cab(*geometry.MESHES[name])
    pieces = regions(mesh)
    for group in SHEETS:
        del mesh.groups[group]
    for group, ring, normal in pieces:
        x = [mesh.nodes[node - 1][0] for node in ring]
        fill(mesh, group, ring, normal, kind, hole and group == "roof" and min(x) < HOLE[0] < max(x))
    # Nodes inside the sheets of rows and columns are no longer used.
    used = sorted({node for cells in mesh.groups.values() for cell in cells for node in cell})
    number = {node: i for i, node in enumerate(used, 1)}
    mesh.nodes = [mesh.nodes[node - 1] for node in used]
    mesh.groups = {group: [tuple(number[node] for node in cell) for cell in cells] for group, cells in mesh.groups.items()}
    return mesh


def write(mesh: geometry.Mesh, path: Path) -> str:
    """Writes the mesh with groups of both shapes; returns how many there are of each."""
    shapes = {1: (15, 0), 2: (1, 1), 3: (2, 2), 4: (3, 2)}
    out = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(mesh.groups))]
    out += [f'{shapes[len(cells[0])][1]} {tag} "{name}"' for tag, (name, cells) in enumerate(mesh.groups.items(), 1)]
    out += ["$EndPhysicalNames", "$Nodes", str(len(mesh.nodes))]
    out += [f"{i} {x:.12g} {y:.12g} {z:.12g}" for i, (x, y, z) in enumerate(mesh.nodes, 1)]
    all_ = [(tag, cell) for tag, cells in enumerate(mesh.groups.values(), 1) for cell in cells]
    out += ["$EndNodes", "$Elements", str(len(all_))]
    out += [f"{i} {shapes[len(cell)][0]} 2 {tag} {tag} {' '.join(map(str, cell))}" for i, (tag, cell) in enumerate(all_, 1)]
    path.write_text("\n".join(out + ["$EndElements", ""]))
    count = {n: sum(len(cell) == n for _, cell in all_) for n in (3, 4)}
    return f"{count[3]} triangles, {count[4]} quadrilaterals"


# The cab is deflected the most at 0.08 to 0.17 s.
END = "analysis.end_time=0.2"


def run(blows: list[str]) -> None:
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    print(f"| frame, mesh of the sheets | {' | '.join(blows)} |")
    print("|---|" + "---|" * len(blows))
    with tempfile.TemporaryDirectory() as place:
        out, fine = Path(place) / "out", {}
        for name in "cab_fine", "cab":
            for kind, hole in ("rows", False), ("quadrilateral", False), ("triangle", False), ("quadrilateral", True), ("triangle", True):
                path = FOLDER / f"{name}.msh"
                label = f"{name}.msh, rows and columns"
                if kind != "rows":
                    path = Path(place) / f"{name}_{kind}_{hole}.msh"
                    label = f"{name}.msh, free: {write(free(name, kind, hole), path)}{', a hole in the roof' if hole else ''}"
                peaks = {blow: cab.measure(blow, [f'mesh.file="{path}"', END], out)["peak"] for blow in blows}
                fine.setdefault(hole, peaks)
                cells = [f"{peaks[b] * 1e3:.1f} mm ({(peaks[b] / fine[hole][b] - 1) * 100:+.1f} %)" for b in blows]
                print(f"| {label} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    scenes.build()
    run(sys.argv[1:] or list(cab.BLOWS))
