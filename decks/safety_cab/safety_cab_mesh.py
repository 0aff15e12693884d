"""Writes the meshes of decks/safety_cab: the tractor's backbone and its cab, as Gmsh ASCII 2.2.

    python3 decks/safety_cab/safety_cab_mesh.py          # cab_coarse.msh, cab.msh, cab_fine.msh, into decks/safety_cab

x forward, y to the left, z up, metres; x = 0 at the rear axle, z = 0 on the ground. Groups of segments are beams, groups
of quadrilaterals shells, groups of one node named points. Python's standard library only.
"""

import sys
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
sys.path.append(str(FOLDER.parent.parent / "scripts"))  # where `scenes` is, which runs a deck

# The cab, between its floor and its roof; walls lean inwards, straight.
FLOOR, WAIST, ROOF = 1.05, 1.65, 2.60
REAR, MIDDLE, FRONT = (-0.42, -0.40), (0.40, 0.40), (1.20, 1.05)  # x at the floor, at the roof
HALF_WIDTH = (0.74, 0.68)
# The backbone: engine, gearbox and axle housings bolted together.
BACKBONE_X = [-0.30, 0.00, 0.40, 0.80, 1.20, 1.70, 2.20, 2.50]
BACKBONE_Z, FRONT_AXLE_Z = 0.75, 0.60
REAR_HUB, FRONT_HUB = 0.95, 0.80
# Elements: along x in each half of the cab, across, up to the waist, from there to the roof; along a piece of the backbone.
MESHES = {"cab_coarse": (3, 6, 2, 4, 1), "cab": (5, 10, 4, 6, 1), "cab_fine": (10, 20, 8, 12, 2)}


class Mesh:
    def __init__(self):
        self.nodes, self.index, self.groups = [], {}, {}

    def node(self, *x: float) -> int:
        key = tuple(round(value, 9) for value in x)
        if key not in self.index:
            self.nodes.append(key)
            self.index[key] = len(self.nodes)
        return self.index[key]

    def add(self, group: str, *nodes: int) -> None:
        self.groups.setdefault(group, []).append(nodes)

    def line(self, group: str, nodes: list[int]) -> None:
        for pair in zip(nodes, nodes[1:]):
            self.add(group, *pair)

    def faces(self, group: str, rows: list[list[int]]) -> None:
        for low, high in zip(rows, rows[1:]):
            for a, b, c, d in zip(low, low[1:], high[1:], high):
                self.add(group, a, b, c, d)

    def write(self, path: Path) -> None:
        # element type of Gmsh: a point, a segment, a quadrilateral; dimension
        kinds = {1: (15, 0), 2: (1, 1), 4: (3, 2)}
        out = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(self.groups))]
        for tag, (name, cells) in enumerate(self.groups.items(), 1):
            out.append(f'{kinds[len(cells[0])][1]} {tag} "{name}"')
        out += ["$EndPhysicalNames", "$Nodes", str(len(self.nodes))]
        out += [f"{i} {x:.9g} {y:.9g} {z:.9g}" for i, (x, y, z) in enumerate(self.nodes, 1)]
        out += ["$EndNodes", "$Elements", str(sum(map(len, self.groups.values())))]
        number = 0
        for tag, cells in enumerate(self.groups.values(), 1):
            for cell in cells:
                number += 1
                out.append(f"{number} {kinds[len(cell)][0]} 2 {tag} {tag} {' '.join(map(str, cell))}")
        path.write_text("\n".join(out + ["$EndElements", ""]))


def spread(start: float, end: float, count: int) -> list[float]:
    return [start + (end - start) * i / count for i in range(count + 1)]


def cab(nx: int, ny: int, low: int, up: int, pieces: int) -> Mesh:
    mesh = Mesh()
    levels = spread(FLOOR, WAIST, low) + spread(WAIST, ROOF, up)[1:]

    def at(ends: tuple[float, float], z: float) -> float:
        return ends[0] + (ends[1] - ends[0]) * (z - FLOOR) / (ROOF - FLOOR)

    def stations(z: float) -> list[float]:
        return spread(at(REAR, z), at(MIDDLE, z), nx) + spread(at(MIDDLE, z), at(FRONT, z), nx)[1:]

    def across(z: float, x: float) -> list[int]:
        width = at(HALF_WIDTH, z)
        return [mesh.node(x, y, z) for y in spread(-width, width, ny)]

    def side(z: float, sign: int) -> list[int]:
        return [mesh.node(x, sign * at(HALF_WIDTH, z), z) for x in stations(z)]

    def frame(group: str, z: float, middle: bool) -> None:
        x = stations(z)
        for sign in (-1, 1):
            mesh.line(group, side(z, sign))
        for i in (0, nx, 2 * nx) if middle else (0, 2 * nx):
            mesh.line(group, across(z, x[i]))

    for name, ends in ("rear", REAR), ("middle", MIDDLE), ("front", FRONT):
        for letter, sign in ("right", -1), ("left", 1):
            column = [mesh.node(at(ends, z), sign * at(HALF_WIDTH, z), z) for z in levels]
            mesh.line("posts", column)
            mesh.add(f"foot_{name}_{letter}", column[0])
            mesh.add(f"top_{name}_{letter}", column[-1])
    frame("sills", FLOOR, True)
    frame("roof_frame", ROOF, True)
    # Rails at the waist, with the panels below them, normals outwards; the door is on the left, in the front half.
    below = levels[: low + 1]
    for pick in 0, 2 * nx:
        mesh.line("rails", across(WAIST, stations(WAIST)[pick]))
        mesh.faces("panels", [across(z, stations(z)[pick])[:: 1 if pick else -1] for z in below])
    for sign, end in (-1, 2 * nx), (1, nx):
        mesh.line("rails", side(WAIST, sign)[: end + 1])
        mesh.faces("panels", [side(z, sign)[: end + 1][::-sign] for z in below])
    mesh.faces("floor", [across(FLOOR, x) for x in stations(FLOOR)])
    mesh.faces("roof", [across(ROOF, x) for x in stations(ROOF)])

    def piece(start: tuple, end: tuple) -> list[int]:
        steps = [spread(a, b, pieces) for a, b in zip(start, end)]
        return [mesh.node(*x) for x in zip(*steps)]

    def hub(start: tuple, end: tuple, halves: int) -> None:
        stops = list(zip(*(spread(a, b, halves) for a, b in zip(start, end))))
        for a, b in zip(stops, stops[1:]):
            mesh.line("backbone", piece(a, b))

    for a, b in zip(BACKBONE_X, BACKBONE_X[1:]):
        mesh.line("backbone", piece((a, 0.0, BACKBONE_Z), (b, 0.0, BACKBONE_Z)))
    mesh.line("backbone", piece((2.20, 0.0, BACKBONE_Z), (2.20, 0.0, FRONT_AXLE_Z)))
    for sign in -1, 1:
        hub((0.0, 0.0, BACKBONE_Z), (0.0, sign * REAR_HUB, BACKBONE_Z), 3)
        hub((2.20, 0.0, FRONT_AXLE_Z), (2.20, sign * FRONT_HUB, FRONT_AXLE_Z), 2)
    return mesh


if __name__ == "__main__":
    for name, counts in MESHES.items():
        made = cab(*counts)
        made.write(FOLDER / f"{name}.msh")
        print(f"{name}.msh: {len(made.nodes)} nodes,", {g: len(c) for g, c in made.groups.items() if len(c[0]) > 1})
