#!/usr/bin/env python3
"""Draws decks/first/cab.svg, the picture of the README, from a run of decks/first/deck.toml.

Left: the cab at rest and where its sway is greatest, displacements eight times as large. Right: the struck corner and the
block over time. Python's standard library only.
"""

import csv
import subprocess
import tempfile
from pathlib import Path

from scenes import PROGRAM, ROOT, build, picture_head

FRAME = ROOT / "decks" / "first"
LARGER = 8.0
TITLE = "A block of 120 kg at 4 m/s meets a cab on rubber mounts"
INK, SOFT, BLUE, RED = "#24292f", "#b8c0c8", "#1f6feb", "#c4432b"

# Parts in the order of their nodes; the sills come back to where they start.
POSTS = [[f"foot_{i}"] + [f"post_{i}[{k}]" for k in range(1, 6)] + [f"knee_{i}"] for i in range(1, 5)]
SILLS = [n for i in range(4) for n in (f"foot_{i + 1}", f"sills[{3 * i + 1}]", f"sills[{3 * i + 2}]")] + ["foot_1"]
ROOF = [f"knee_{i}" for i in (1, 2, 3, 4, 1)]


def table(path: Path, name: str) -> dict:
    """time -> name -> row of numbers."""
    found: dict = {}
    with path.open(newline="") as file:
        for row in csv.DictReader(file):
            key = row.pop(name)
            found.setdefault(float(row["time"]), {})[key] = {k: float(v) for k, v in row.items() if k not in ("stage", "case", "set")}
    return found


def project(x: float, y: float, z: float) -> tuple[float, float]:
    """Oblique view, metres to picture."""
    return 172.0 + 128.0 * (x + 0.42 * y), 352.0 - 128.0 * (z + 0.24 * y)


def line(points, colour: str, width: float, extra: str = "") -> str:
    at = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    return f'<polyline points="{at}" fill="none" stroke="{colour}" stroke-width="{width}" stroke-linejoin="round" {extra}/>'


def cab(nodes: dict, rest: dict, scale: float, colour: str, width: float) -> str:
    def at(name: str):
        n, r = nodes[name], rest[name]
        return project(*(r[c] + scale * (n[c] - r[c]) for c in "xyz"))

    roof = " ".join(f"{x:.1f},{y:.1f}" for x, y in map(at, ROOF))
    fill = f'<polygon points="{roof}" fill="{colour}" fill-opacity="0.12"/>'
    parts = [line(map(at, path), colour, width) for path in POSTS + [SILLS]]
    return fill + "".join(parts) + line(map(at, ROOF), colour, width + 1.2)


def block(body: dict, colour: str, opacity: float) -> str:
    x, y, z = (body[c] for c in "xyz")
    h = 0.2
    faces = [
        [(-h, -h, -h), (h, -h, -h), (h, -h, h), (-h, -h, h)],
        [(-h, -h, h), (h, -h, h), (h, h, h), (-h, h, h)],
        [(h, -h, -h), (h, h, -h), (h, h, h), (h, -h, h)],
    ]
    out = ""
    for face, shade in zip(faces, (1.0, 0.7, 0.85)):
        at = " ".join("{:.1f},{:.1f}".format(*project(x + a, y + b, z + c)) for a, b, c in face)
        out += f'<polygon points="{at}" fill="{colour}" fill-opacity="{opacity * shade:.2f}" stroke="{colour}" stroke-width="0.8"/>'
    return out


def text(x: float, y: float, what: str, colour: str = INK, anchor: str = "start", size: int = 12) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}" font-size="{size}" text-anchor="{anchor}">{what}</text>'


def plot(top: float, label: str, series, ticks: list[float], colour: str, end: float) -> str:
    """One history with its axes; `series` of (time, value)."""
    left, right, height = 520.0, 868.0, 112.0
    low, high = ticks[0], ticks[-1]
    X = lambda t: left + (right - left) * t / end
    Y = lambda v: top + height * (high - v) / (high - low)
    out = ""
    for tick in ticks:
        out += line([(left, Y(tick)), (right, Y(tick))], "#e4e8ec", 1)
        out += text(left - 6, Y(tick) + 4, f"{tick:g}", INK, "end", 11)
    for k in range(6):
        t = 0.05 * k
        out += line([(X(t), top + height), (X(t), top + height + 4)], INK, 1)
        out += text(X(t), top + height + 17, f"{t:g}", INK, "middle", 11)
    out += line([(left, top), (left, top + height), (right, top + height)], INK, 1)
    out += text(left, top - 9, label, colour, size=12)
    return out + line([(X(t), Y(v)) for t, v in series], colour, 1.8)


def main() -> None:
    build()
    with tempfile.TemporaryDirectory() as folder:
        sets = ["output.nodes=all", "output.every=2", "output.fields.every=100000"]
        command = [str(PROGRAM), str(FRAME / "deck.toml"), "-o", folder, "--quiet", "--overwrite"]
        subprocess.run(command + [w for s in sets for w in ("--set", s)], check=True)
        nodes, bodies = table(Path(folder) / "nodes.csv", "node"), table(Path(folder) / "bodies.csv", "body")
    times = sorted(nodes)
    sway = [(t, 1000.0 * nodes[t]["knee_1"]["ux"]) for t in times]
    speed = [(t, bodies[t]["block"]["vx"]) for t in times]
    peak = max(sway, key=lambda s: s[1])[0]
    rest = nodes[0.0]
    out = [
        picture_head(900, 400, TITLE),
        block(bodies[0.0]["block"], SOFT, 0.5),
        cab(rest, rest, 1.0, SOFT, 2.0),
        cab(nodes[peak], rest, LARGER, BLUE, 2.4),
        block(bodies[peak]["block"], RED, 0.75),
        text(24, 28, TITLE, size=14),
        text(24, 388, "at rest", "#7d8790"),
        text(74, 388, f"t = {peak:.3f} s, displacements x {LARGER:g}", BLUE),
        text(290, 388, "cab 1.5 x 1.2 x 1.6 m", "#7d8790"),
        plot(60, "struck corner, displacement along the blow, mm", sway, [-50, 0, 50, 100], BLUE, times[-1]),
        plot(228, "block, velocity, m/s", speed, [-4, -2, 0, 2, 4], RED, times[-1]),
        text(694, 204, "time, s", INK, "middle", 12),
        text(694, 378, "time, s", INK, "middle", 12),
        "</svg>",
    ]
    (FRAME / "cab.svg").write_text("\n".join(out) + "\n")


if __name__ == "__main__":
    main()
