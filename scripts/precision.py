#!/usr/bin/env python3
"""Error against run time of four scenes, and what schemes do where steps are too long: the picture and the table of the README.

    scripts/precision.py            # some minutes; draws docs/pictures/precision.svg, prints both tables as Markdown

Each scene is a `rdsolve study` of its deck, with schemes and automatic steps. Two more lines are `accuracy` from a poor mesh, whose time includes
pilot runs, and the best equal steps over several meshes. Other programs' loops are marked with crosses (see
the README for where they come from; measured on another machine). Then scripts/stability.py. Python's standard library only.
"""

import csv
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import scenes
import stability
from accuracy_asked import DIVISIONS, asking, equal
from accuracy_scenes import MOTIONS
from scenes import ROOT, SCENES, build

IMPLICIT = "wilson-theta,newmark,generalized-alpha,bathe"
TOLERANCES = "1e-2,3e-3,1e-3,3e-4,1e-4"
REPEATS = 5
LONGEST = 10.0
"""Seconds of the last run of a line by `accuracy`."""


class Panel:
    def __init__(self, title, folder, options, marks):
        self.title, self.folder, self.options, self.marks = title, folder, options, marks


PANELS = [
    Panel("R3: two bodies on springs", "two_bodies_on_springs", ["--schemes", IMPLICIT + ",runge-kutta"], [(0.005, 1e-2), (0.008, 1e-3), (0.012, 1e-4)]),
    Panel("B1: right-angle cantilever", "right_angle_cantilever", ["--set", "beams.legs.order=3", "--schemes", IMPLICIT], [(0.054, 1e-2), (0.23, 1e-3), (1.4, 1e-4)]),
    Panel("C1: block on a cantilever", "block_on_cantilever", ["--schemes", IMPLICIT], [(0.007, 1e-2), (0.016, 1e-3), (0.043, 1e-4)]),
    Panel("C4: steel portal hit by a block", "portal_and_block", ["--schemes", "wilson-theta,generalized-alpha,bathe"], [(0.12, 1e-2), (0.83, 1e-3)]),
]
COLOURS = {"wilson-theta": "#3b7dd8", "newmark": "#b38a12", "generalized-alpha": "#2f9e63", "bathe": "#b058c4", "runge-kutta": "#1f9aa8", "best equal steps": "#7c7f86", "accuracy": "#e07b00"}
WIDTHS = {"best equal steps": 3.5, "accuracy": 3.0}
WIDTH, HEIGHT, LEFT, TOP, BELOW = 360.0, 250.0, 62.0, 34.0, 52.0


def study(panel: Panel, folder: Path) -> list[dict]:
    deck = ROOT / "decks" / panel.folder / "deck.toml"
    arguments = [str(scenes.PROGRAM), "study", str(deck), "-o", str(folder), "--quiet", "--error-tolerances", TOLERANCES, *panel.options]
    arguments += ["--repeats", str(REPEATS), "--budget", "1.5", "--set", "expect=[]", "--wanted-error", "1e-2,1e-3,1e-4"]
    done = subprocess.run(arguments, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{panel.title}: exit code {done.returncode}\n{done.stderr}")
    print(f"\n{panel.title}\n\n```\n{done.stdout.rstrip()}\n```")
    with (folder / "study.csv").open(newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["status"] == "done" and row["error"]]
    return rows + with_meshes(panel.title.split(":")[0])


def with_meshes(name: str) -> list[dict]:
    """Rows of the best equal steps over all meshes, and of `accuracy`."""
    motion = MOTIONS[name]
    settings = (equal(motion, mesh, scheme, division) for mesh in motion.meshes for scheme in motion.schemes for division in DIVISIONS)
    found = sorted(done for sets in settings if (done := measured(name, sets)))
    # No cheaper setting errs less.
    best = [(loop, error) for k, (loop, error) in enumerate(found) if all(error < other for _, other in found[:k])]
    own: list[tuple[float, float]] = []
    for asked in TOLERANCES.split(","):
        if not own or own[-1][0] < LONGEST:
            own += filter(None, [measured(name, asking(motion, float(asked)))])
    lines = {"best equal steps": best, "accuracy": own}
    rows = [{"scheme": scheme, "error_tolerance": "", "loop_s": loop, "error": error} for scheme, of in lines.items() for loop, error in of]
    print("\n".join(f"{row['scheme']}: {row['loop_s']:.4f} s, error {row['error']:.1e}" for row in rows), flush=True)
    return rows


def measured(name: str, sets: list[str]) -> tuple[float, float] | None:
    """Seconds and error of a run; none where it fails."""
    try:
        error, loop, _, _ = SCENES[name].measure(sets, REPEATS)
    except RuntimeError:
        return None
    return loop, error


class Axis:
    def __init__(self, values, start, end):
        logs = [math.log10(value) for value in values]
        self.low, self.high = min(logs) - 0.15, max(logs) + 0.15
        self.start, self.end = start, end

    def at(self, value):
        return self.start + (math.log10(value) - self.low) / (self.high - self.low) * (self.end - self.start)

    def decades(self):
        return [10.0**k for k in range(math.ceil(self.low), math.floor(self.high) + 1)]


def titles(left: float, top: float) -> list[str]:
    """What the axes are; errors have no unit."""
    middle, side = top + HEIGHT / 2, left - 48
    return [
        f'<text x="{left + WIDTH / 2:.1f}" y="{top + HEIGHT + 32:.1f}" text-anchor="middle">time of the loop, s</text>',
        f'<text x="{side:.1f}" y="{middle:.1f}" text-anchor="middle" transform="rotate(-90 {side:.1f} {middle:.1f})">error, rms / largest value</text>',
    ]


def draw(panel: Panel, rows: list[dict], left: float, top: float) -> str:
    times = [float(row["loop_s"]) for row in rows] + [time for time, _ in panel.marks]
    errors = [float(row["error"]) for row in rows] + [error for _, error in panel.marks]
    x, y = Axis(times, left, left + WIDTH), Axis(errors, top + HEIGHT, top)
    out = [f'<text x="{left}" y="{top - 8}" font-weight="bold">{panel.title}</text>']
    for value in x.decades():
        at = x.at(value)
        out.append(f'<line class="rule" x1="{at:.1f}" y1="{top}" x2="{at:.1f}" y2="{top + HEIGHT}"/>')
        out.append(f'<text x="{at:.1f}" y="{top + HEIGHT + 16}" text-anchor="middle">{value:g}</text>')
    for value in y.decades():
        at = y.at(value)
        out.append(f'<line class="rule" x1="{left}" y1="{at:.1f}" x2="{left + WIDTH}" y2="{at:.1f}"/>')
        out.append(f'<text x="{left - 6}" y="{at + 4:.1f}" text-anchor="end">{value:.0e}</text>')
    out.append(f'<rect class="edge" x="{left}" y="{top}" width="{WIDTH}" height="{HEIGHT}"/>')
    out += titles(left, top)
    lines: dict = {}
    for row in rows:
        lines.setdefault((row["scheme"], bool(row["error_tolerance"])), []).append((float(row["loop_s"]), float(row["error"])))
    for (scheme, automatic), points in lines.items():
        colour = COLOURS.get(scheme.split(":")[0], "#7c7f86")
        at = [(x.at(time), y.at(error)) for time, error in points]
        dash = ' stroke-dasharray="5 3"' if automatic else ""
        out.append(f'<polyline points="{" ".join(f"{a:.1f},{b:.1f}" for a, b in at)}" fill="none" stroke="{colour}" stroke-width="{WIDTHS.get(scheme, 1.8)}"{dash}/>')
        fill = "none" if automatic else colour
        out += [f'<circle cx="{a:.1f}" cy="{b:.1f}" r="2.6" fill="{fill}" stroke="{colour}"/>' for a, b in at]
    for time, error in panel.marks:
        a, b = x.at(time), y.at(error)
        out.append(f'<path class="mark" d="M{a - 4:.1f} {b - 4:.1f}l8 8m0 -8l-8 8"/>')
    return "\n".join(out)


def picture(panels: list[tuple[Panel, list[dict]]]) -> str:
    step_x, step_y = WIDTH + LEFT + 24, HEIGHT + TOP + BELOW
    parts = [draw(panel, rows, LEFT + (k % 2) * step_x, TOP + (k // 2) * step_y) for k, (panel, rows) in enumerate(panels)]
    whole, tall = 2 * step_x + 10, 2 * step_y + 40
    foot = tall + 6
    legend, at = [], LEFT
    drawn = {row["scheme"].split(":")[0] for _, rows in panels for row in rows}
    for name, colour in ((name, colour) for name, colour in COLOURS.items() if name in drawn):
        legend.append(f'<line x1="{at}" y1="{tall - 20}" x2="{at + 22}" y2="{tall - 20}" stroke="{colour}" stroke-width="2"/>')
        legend.append(f'<text x="{at + 28}" y="{tall - 16}">{name}</text>')
        at += 42 + 6.6 * len(name)
    legend.append(f'<text x="{LEFT}" y="{foot}">dashed: automatic steps; x: best of other programs</text>')
    style = (
        ".p{font:12px sans-serif}.p text{fill:#57606a}.p .rule{stroke:#808890;stroke-opacity:.25}.p .edge{fill:none;stroke:#808890}"
        ".p .mark{stroke:#c4432b;stroke-width:1.8;fill:none}@media(prefers-color-scheme:dark){.p text{fill:#9198a1}}"
    )
    label = "Error against the time of the loop, four scenes"
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {whole:.0f} {foot + 10:.0f}" class="p" role="img"><title>{label}</title>'
    return "\n".join([head, f"<style>{style}</style>", *parts, *legend, "</svg>\n"])


def main() -> None:
    build()
    with tempfile.TemporaryDirectory() as folder:
        panels = [(panel, study(panel, Path(folder) / panel.folder)) for panel in PANELS]
    (ROOT / "docs" / "pictures" / "precision.svg").write_text(picture(panels))
    print()
    stability.main()


if __name__ == "__main__":
    main()
