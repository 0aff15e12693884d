"""Draws docs/pictures/blows.svg: the tractor at rest (grey) and where the struck corner has gone the farthest, three times.

Python's standard library only.
"""

import math
import tempfile
from pathlib import Path

import safety_cab as cab
import safety_cab_mesh as geometry
import scenes

INK, SOFT, BLUE, RED = "#24292f", "#b8c0c8", "#1f6feb", "#c4432b"
SCALE, WIDTH, HEIGHT = 72.0, 340, 300
# Azimuth from +x and height of the eye, degrees.
EYES = {"rear": (128.0, 14.0), "front": (-38.0, 14.0), "side": (152.0, 14.0)}


class View:
    def __init__(self, azimuth: float, height: float):
        a, h = math.radians(azimuth), math.radians(height)
        toward = [math.cos(a) * math.cos(h), math.sin(a) * math.cos(h), math.sin(h)]
        self.right = [-math.sin(a), math.cos(a), 0.0]
        self.up = cab.cross(toward, self.right)
        self.toward = toward

    def __call__(self, x) -> tuple[float, float]:
        x = cab.plus(x, (0.9, 0.0, 1.30), -1)
        return WIDTH / 2 + SCALE * cab.dot(x, self.right), HEIGHT / 2 + 8 - SCALE * cab.dot(x, self.up)


def path(points, colour: str, width: float, extra: str = 'fill="none"') -> str:
    at = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    return f'<polyline points="{at}" stroke="{colour}" stroke-width="{width}" stroke-linejoin="round" {extra}/>'


def move(body: dict, rest: dict, x) -> list[float]:
    """Where a point of a body at rest has gone."""
    R, R0 = scenes.rotation(body), scenes.rotation(rest)
    local = [cab.dot(axis, cab.plus(x, scenes.position(rest), -1)) for axis in R0]
    return cab.plus(scenes.position(body), [sum(c * axis[i] for c, axis in zip(local, R)) for i in range(3)])


def chain(cells: list[tuple[int, int]]) -> list[list[int]]:
    """Segments as lines, the fewer the better."""
    lines: list[list[int]] = []
    for a, b in cells:
        if lines and lines[-1][-1] == a:
            lines[-1].append(b)
        else:
            lines.append([a, b])
    return lines


def faces(cells, colour: str, opacity: float) -> str:
    """One path for all of them."""
    d = "".join("M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in cell) + "Z" for cell in cells)
    return f'<path d="{d}" stroke="{colour}" stroke-width="0.15" fill="{colour}" fill-opacity="{opacity}"/>'


def zones(view: View, body: dict, rest: dict) -> list[str]:
    """Edges of the boxes round the clearance zone."""
    made = []
    for centre, size in cab.ZONES.values():
        corner = lambda signs: view(move(body, rest, [s + c + k * e / 2 for s, c, k, e in zip(cab.SEAT, centre, signs, size)]))  # noqa: E731
        for z in -1, 1:
            made.append(path([corner((a, b, z)) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1))], INK, 0.6))
        for a, b in (-1, -1), (1, -1), (1, 1), (-1, 1):
            made.append(path([corner((a, b, -1)), corner((a, b, 1))], INK, 0.6))
    return made


def tractor(view: View, nodes: dict, bodies: dict, rest: dict, colour: str) -> list[str]:
    mesh, made = geometry.cab(*geometry.MESHES["cab"]), []

    def at(n: int):
        label = f"mesh.{n}"
        return view(scenes.position(nodes[label]) if label in nodes else move(bodies["gearbox"], rest["gearbox"], mesh.nodes[n - 1]))

    for end, side, hub in cab.wheels():
        r, half = hub[2], cab.WHEELS[end][1] / 2
        for y in -half, half:
            ring = [[hub[0] + r * math.cos(k * math.pi / 12), hub[1] + y, hub[2] + r * math.sin(k * math.pi / 12)] for k in range(25)]
            ring = [view(move(bodies["gearbox"], rest["gearbox"], x)) for x in ring]
            made.append(path(ring, colour, 0.9, f'fill="{colour}" fill-opacity="0.05"'))
    made += [path(map(at, line), colour, 5, 'fill="none" opacity="0.35"') for line in chain(mesh.groups["backbone"])]
    for group, opacity in ("roof", 0.05), ("panels", 0.04):
        made.append(faces([map(at, face) for face in mesh.groups[group]], colour, opacity))
    for group, width in ("sills", 1.6), ("rails", 1.0), ("posts", 1.8), ("roof_frame", 1.8):
        made += [path(map(at, line), colour, width) for line in chain(mesh.groups[group])]
    return made


def block_of(view: View, body: dict, rest: dict, now: dict, colour: str, opacity: float) -> list[str]:
    half = {"normal": cab.DEPTH / 2, "side": cab.FACE / 2, "up": cab.FACE / 2}
    made = []
    for out, one, two in ("normal", "side", "up"), ("side", "up", "normal"), ("up", "normal", "side"):
        for sign in -1, 1:
            middle = cab.plus(now["centre"], now[out], sign * half[out])
            corners = [cab.plus(cab.plus(middle, now[one], a * half[one]), now[two], b * half[two])
                       for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1))]  # fmt: skip
            corners = [move(body, rest, x) for x in corners]
            n = cab.cross(cab.plus(corners[1], corners[0], -1), cab.plus(corners[2], corners[1], -1))
            if sign * cab.dot(n, view.toward) > 0:
                made.append(path(map(view, corners), colour, 1.2, f'fill="{colour}" fill-opacity="{opacity}"'))
    return made


def panel(name: str, folder: Path) -> list[str]:
    scenes.run(cab.FOLDER / f"{name}.toml", ['output.nodes="all"', "analysis.end_time=0.25"], folder, 2)
    nodes, bodies = scenes.rows(folder / "nodes.csv"), scenes.rows(folder / "bodies.csv")
    times, way = cab.deflection(folder, name)
    peak = max(range(len(way)), key=way.__getitem__)
    time, view, now = times[peak], View(*EYES[name]), cab.blow(name)
    rest, then = bodies[0.0], bodies[time]
    made = tractor(view, nodes[0.0], rest, rest, SOFT)
    made += block_of(view, rest["block"], rest["block"], now, SOFT, 0.08)
    for _, _, anchor, point, _ in cab.ropes():
        made.append(path([view(anchor), view(move(then["gearbox"], rest["gearbox"], point))], INK, 0.7))
    made += tractor(view, nodes[time], then, rest, BLUE)
    made += zones(view, then["gearbox"], rest["gearbox"])
    made += block_of(view, then["block"], rest["block"], now, RED, 0.18)
    label = f"{name}, {now['energy'] / 1e3:.1f} kJ: {way[peak] * 1e3:.0f} mm after {time * 1e3:.0f} ms"
    made.append(f'<text x="{WIDTH / 2}" y="{HEIGHT - 6}" text-anchor="middle" fill="{INK}">{label}</text>')
    return made


def main() -> None:
    scenes.build()
    out = [scenes.picture_head(3 * WIDTH, HEIGHT, "A tractor with a cab at rest and where the struck corner has gone the farthest, after three blows")]
    with tempfile.TemporaryDirectory() as folder:
        for i, name in enumerate(cab.BLOWS):
            out += [f'<g transform="translate({i * WIDTH} 0)">', *panel(name, Path(folder) / "out"), "</g>"]
    (scenes.ROOT / "docs" / "pictures" / "blows.svg").write_text("\n".join(out + ["</svg>", ""]))


if __name__ == "__main__":
    main()
