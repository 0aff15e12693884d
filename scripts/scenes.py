"""The scenes that are measured, how to run them and how far they are from their references. For the other scripts here.

Python's standard library only.
"""

import csv
import json
import math
import os
import subprocess
import tempfile
import time
from pathlib import Path
from typing import Callable, NamedTuple

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "target" / "release" / "rdsolve"

# Colours of pictures on light ground, and the same on dark ground.
ON_DARK = {"#24292f": "#e6edf3", "#7d8790": "#9198a1", "#b8c0c8": "#6e7681", "#e4e8ec": "#30363d", "#1f6feb": "#4493f8", "#c4432b": "#f85149"}


def picture_head(width: float, height: float, title: str) -> str:
    """The head of an SVG file that names itself and follows the light or dark setting of the reader."""
    rules = "".join(f'[stroke="{light}"]{{stroke:{dark}}}[fill="{light}"]{{fill:{dark}}}' for light, dark in ON_DARK.items())
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {height:g}" font-family="Helvetica, Arial, sans-serif" font-size="13" role="img">'
        f"<title>{title}</title><style>@media(prefers-color-scheme:dark){{{rules}}}</style>"
    )


def build() -> None:
    subprocess.run(["cargo", "build", "--release", "--locked", "--quiet"], cwd=ROOT, check=True)


class Run(NamedTuple):
    folder: Path
    process_s: float
    """From start to exit, as the parent sees it."""
    report: dict
    """result.json"""

    @property
    def loop_s(self) -> float:
        """Seconds of the time loop, with those of pilot runs."""
        timings = self.report["timings"]
        return timings["loop_s"] + timings.get("pilots_s", 0.0)


def run(deck: Path, sets: list[str], folder: Path, threads: int = 1) -> Run:
    """Runs a deck quietly; a run that does not reach its end is an error."""
    arguments = [str(PROGRAM), str(deck), "-o", str(folder), "--quiet", "--overwrite", "--threads", str(threads)]
    for entry in sets:
        arguments += ["--set", entry]
    began = time.perf_counter()
    # Nothing of Python's is copied, unlike with fork: 1 ms less.
    child = os.posix_spawn(arguments[0], arguments, os.environ)
    _, status = os.waitpid(child, 0)
    process_s = time.perf_counter() - began
    if code := os.waitstatus_to_exitcode(status):
        raise RuntimeError(f"exit code {code}: {' '.join(arguments)}")
    return Run(folder, process_s, json.loads((folder / "result.json").read_text()))


Rows = dict[float, dict[str, dict[str, float]]]


def rows(path: Path) -> Rows:
    """time -> name -> column -> value, of a nodes.csv or bodies.csv."""
    found: Rows = {}
    with path.open(newline="") as file:
        for row in csv.DictReader(file):
            name = row.pop("node", None) or row.pop("body")
            time_ = float(row.pop("time"))
            found.setdefault(time_, {})[name] = {key: float(value) for key, value in row.items() if key not in ("stage", "case", "set")}
    return found


def rotation(q: dict[str, float]) -> list[list[float]]:
    """Columns of the rotation matrix of qw, qx, qy, qz."""
    w, x, y, z = (q[key] for key in ("qw", "qx", "qy", "qz"))
    return [
        [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
        [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
        [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)],
    ]


def position(row: dict[str, float]) -> list[float]:
    return [row["x"], row["y"], row["z"]]


def body_omega(row: dict[str, float]) -> list[float]:
    omega = [row["wx"], row["wy"], row["wz"]]
    return [sum(c * o for c, o in zip(column, omega)) for column in rotation(row)]


Moment = dict[str, dict[str, float]]
"""Name -> column -> value at one time, bodies and nodes together."""


def free_body(at: Moment) -> list[float]:
    body = at["body"]
    return body_omega(body) + sum(rotation(body), [])


def two_bodies(at: Moment) -> list[float]:
    a, b = at["a"], at["b"]
    return position(a) + position(b) + body_omega(a) + body_omega(b)


def hub(at: Moment) -> list[float]:
    """The angle is continued over whole turns in `history`."""
    q = at["hub"]
    return [2 * math.atan2(q["qz"], q["qw"])] + [at[tip][axis] for tip in ("tip_1", "tip_2") for axis in "xy"]


def unwrap(history: list[list[float]]) -> None:
    """The first column, an angle, without jumps."""
    for before, now in zip(history, history[1:]):
        now[0] += round((before[0] - now[0]) / math.tau) * math.tau


class Scene(NamedTuple):
    name: str
    folder: str
    interval: float
    """Between the times of reference.csv."""
    quantities: Callable[[Moment], list[float]]
    beams: tuple[str, ...] = ()
    angle_first: bool = False

    @property
    def deck(self) -> Path:
        return ROOT / "decks" / self.folder / "deck.toml"

    def mesh(self, elements: int, order: int) -> list[str]:
        """Overrides; elements are per segment of a path."""
        return [f"beams.{b}.{key}={value}" for b in self.beams for key, value in (("elements", elements), ("order", order))]

    def step(self, division: int) -> list[str]:
        return [f"analysis.time_step={self.interval / division!r}"]

    def history(self, folder: Path) -> list[list[float]]:
        """The quantities of a run at its output times."""
        moments: Rows = {}
        for name in ("nodes.csv", "bodies.csv"):
            if (folder / name).exists():
                for time_, at in rows(folder / name).items():
                    moments.setdefault(time_, {}).update(at)
        history = [self.quantities(moments[time_]) for time_ in sorted(moments)]
        if self.angle_first:
            unwrap(history)
        return history

    def reference(self) -> list[list[float]]:
        with (self.deck.parent / "reference.csv").open(newline="") as file:
            return [[float(value) for value in row[1:]] for row in list(csv.reader(file))[1:]]

    def error(self, folder: Path) -> float:
        """Root of the mean of |q - q_ref|^2 over the 201 times, divided by max |q_ref|."""
        history, exact = self.history(folder), self.reference()
        if len(history) != len(exact):
            raise RuntimeError(f"{self.name}: {len(history)} times, the reference has {len(exact)}")
        square = sum((a - b) ** 2 for q, r in zip(history, exact) for a, b in zip(q, r))
        largest = max(sum(b * b for b in r) for r in exact)
        return math.sqrt(square / len(exact) / largest)

    def measure(self, sets: list[str], repeats: int, budget: float = 2.0) -> tuple[float, float, float, dict]:
        """Error, least seconds of the time loop, least seconds of the process, result.json of the last run. Repeats end
        early where they take longer than `budget` seconds together."""
        # Energies and expected values would cost further evaluations; the 201 times are those of the deck.
        sets = sets + ["output.energy=false", "expect=[]"]
        loop, process, began = math.inf, math.inf, time.perf_counter()
        with tempfile.TemporaryDirectory() as folder:
            for repeat in range(repeats):
                done = run(self.deck, sets, Path(folder))
                loop, process = min(loop, done.loop_s), min(process, done.process_s)
                if repeat == 0:
                    error = self.error(done.folder)
                if time.perf_counter() - began > budget:
                    break
        return error, loop, process, done.report

    def cost(self, sets: list[str], repeats: int = 3) -> tuple[float, float, dict]:
        """Least seconds of the time loop and of the process, and result.json, whatever the output times are."""
        sets = sets + ["output.energy=false", "expect=[]"]
        with tempfile.TemporaryDirectory() as folder:
            done = [run(self.deck, sets, Path(folder)) for _ in range(repeats)]
        return min(d.loop_s for d in done), min(d.process_s for d in done), done[-1].report


SCENES = {
    scene.name: scene
    for scene in [
        Scene("R1", "free_body", 0.25, free_body),
        Scene("R2", "heavy_top/pivot", 0.01, lambda at: position(at["top"])),
        Scene("R3", "two_bodies_on_springs", 0.025, two_bodies),
        Scene("X2", "extreme/stiff_pendulum", 0.2066761, lambda at: [at["bob"]["x"], at["bob"]["z"]]),
        Scene("B1", "right_angle_cantilever", 0.15, lambda at: [at["elbow"]["uz"], at["tip"]["uz"]], ("legs",)),
        Scene("B2", "flying_beam", 0.05, lambda at: sum((position(at[n]) for n in ("a", "middle", "b")), []), ("rod",)),
        Scene("C1", "block_on_cantilever", 0.01, lambda at: position(at["block"]) + position(at["tip"]), ("beam",)),
        Scene("C2", "hub_with_blades", 0.015, hub, ("blade_1", "blade_2"), angle_first=True),
        Scene("C4", "portal_and_block", 0.0015, lambda at: [at["knee_left"]["ux"], at["block"]["x"]], ("portal",)),
    ]
}


def unknowns(report: dict) -> int:
    return report["sizes"]["unknowns"]
