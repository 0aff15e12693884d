"""What the differential test shares: decks, runs of this program, results as arrays. For differential.py; needs numpy."""

import csv
import json
import subprocess
import tempfile
from pathlib import Path

import numpy as np

TIMES = 4
"""Results are compared at so many equal parts of the run."""

PATIENCE = 300
"""Seconds for a run that takes less than one, unless it is near a limit load that it cannot pass."""

Result = dict[str, np.ndarray]
"""Quantity -> values: time, thing, component."""


class Failed(Exception):
    """A program gave no answer, and why."""


def toml(value) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return json.dumps(value)
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml(entry)}" for key, entry in value.items()) + " }"
    if isinstance(value, (list, tuple, np.ndarray)):
        return "[" + ", ".join(toml(entry) for entry in value) + "]"
    return repr(value if isinstance(value, int) else float(value))


def deck_text(deck: dict) -> str:
    """Tables of tables and lists of tables at the top, everything below in lines."""
    head, body = [], []
    for key, value in deck.items():
        if isinstance(value, list):
            for table in value:
                body.append(f"\n[[{key}]]\n" + "".join(f"{k} = {toml(v)}\n" for k, v in table.items()))
        elif isinstance(value, dict):
            if key in ("materials", "sections", "amplitudes"):
                for name, table in value.items():
                    body.append(f"\n[{key}.{name}]\n" + "".join(f"{k} = {toml(v)}\n" for k, v in table.items()))
            else:
                body.append(f"\n[{key}]\n" + "".join(f"{k} = {toml(v)}\n" for k, v in value.items()))
        else:
            head.append(f"{key} = {toml(value)}\n")
    return "".join(head + body)


def table(path: Path, key: str, columns: list[str], names: list[str]) -> np.ndarray:
    """Rows of a table as time x name x column."""
    times: dict[float, dict[str, list[float]]] = {}
    with path.open(newline="") as file:
        for row in csv.DictReader(file):
            times.setdefault(float(row["time"]), {})[row[key]] = [float(row[c]) for c in columns]
    return np.array([[times[t][name] for name in names] for t in sorted(times)][1:])


def reactions(path: Path, names: list[str]) -> np.ndarray:
    """Forces and moments at supports and joints, zero where nothing is held."""
    axes = ("ux", "uy", "uz", "rx", "ry", "rz")
    times: dict[float, dict[str, np.ndarray]] = {}
    with path.open(newline="") as file:
        for row in csv.DictReader(file):
            six = times.setdefault(float(row["time"]), {}).setdefault(row["node"], np.zeros(6))
            six[axes.index(row["direction"])] = float(row["value"])
    return np.array([[times[t].get(name, np.zeros(6)) for name in names] for t in sorted(times)][1:])


def run(program: str, deck: dict, read) -> tuple[Result, list[str]]:
    """The result as `read` takes it from the folder, and the warnings of the run."""
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "deck.toml").write_text(deck_text(deck))
        out = folder / "out"
        command = [program, "run", str(folder / "deck.toml"), "-o", str(out), "--quiet", "--threads", "1"]
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE)
        except subprocess.TimeoutExpired as late:
            raise Failed(f"it takes longer than {PATIENCE} s") from late
        if done.returncode:
            raise Failed(f"exit code {done.returncode}: {done.stderr.strip()[:300]}")
        return read(out), json.loads((out / "result.json").read_text()).get("warnings", [])
