"""Runs rdsolve and reads its results as pandas frames.

    result = rdsolve.run("deck.toml", set={"beams.portal.elements": 24})
    nodes = result["nodes"]           # the table nodes.csv
    nodes.attrs["units"]["ux"]        # "m", where the deck has units = "SI"
"""

import json
import os
import shutil
import subprocess
import sysconfig
import warnings
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

import pandas

__all__ = ["Failed", "Results", "program", "read", "run"]


class Failed(Exception):
    """A command ended with an exit code other than 0. `code` is that code, `said` its messages."""

    def __init__(self, code, said):
        super().__init__(f"rdsolve ended with exit code {code}:\n{said}")
        self.code = code
        self.said = said


def program():
    """The path of the program: RDSOLVE_PROGRAM, else that of this environment, else the first on the path."""
    given = os.environ.get("RDSOLVE_PROGRAM")
    if given:
        return given
    beside = [sysconfig.get_path("scripts"), sysconfig.get_path("scripts", f"{os.name}_user")]
    found = next(filter(None, (shutil.which("rdsolve", path=folder) for folder in beside)), None)
    found = found or shutil.which("rdsolve")
    if found is None:
        raise FileNotFoundError("no program rdsolve on the path; set RDSOLVE_PROGRAM to where it is")
    return found


def run(deck, set=None, output=None, threads=None, resume=False, check=True):
    """Runs a deck and reads its results.

    `set` overrides entries of the deck, as --set does: {"beams.portal.elements": 24}. `output` is the folder of results, by default that of
    the program: the deck's name with .out in the current folder. Results that are there are replaced. With `check` a run that does not end
    with exit code 0 raises Failed; without it, its results carry `exit_code`.
    """
    folder = Path(output) if output is not None else Path(Path(deck).stem + ".out")
    words = ["run", os.fspath(deck), "--output", os.fspath(folder), "--quiet"]
    words.append("--resume" if resume else "--overwrite")
    if threads is not None:
        words += ["--threads", str(threads)]
    for key, value in (set or {}).items():
        words += ["--set", f"{key}={_toml(value)}"]
    done = _call(words)
    # Exit codes 4, 5 and 75 leave results; others leave none of this run.
    if done.returncode != 0 and (check or done.returncode not in (4, 5, 75)):
        raise Failed(done.returncode, done.stderr)
    return read(folder)


def read(folder):
    """The results in a folder."""
    return Results(folder)


class Results(Mapping):
    """Tables of a run by name, as "nodes" for nodes.csv. Each is read when it is asked for and kept."""

    def __init__(self, folder):
        self.folder = Path(folder)
        with open(self.folder / "result.json", encoding="utf-8") as file:
            self.result = json.load(file)
        self._kept = {}

    @property
    def status(self):
        """The word of result.json: "done" or another."""
        return self.result["status"]

    @property
    def exit_code(self):
        """The exit code of the run."""
        return self.result["exit_code"]

    @property
    def warnings(self):
        """The warnings of the run."""
        return self.result["warnings"]

    def __getitem__(self, name):
        if name not in self._kept:
            path = self.folder / f"{name}.csv"
            if not path.is_file():
                raise KeyError(f"{self.folder} has no table {name!r}, but {', '.join(self) or 'none'}")
            rows = _whole_rows(path)
            if not rows:
                raise ValueError(f"{path} has no whole line yet: its run is still writing, or was ended")
            # Texts such as "NA" are names, and every number is read back to the last bit.
            options = {"keep_default_na": False, "na_values": [""]}
            if [int(part) for part in pandas.__version__.split(".")[:2]] < [3, 1]:
                # Later versions do so by default, and warn of the word.
                options["float_precision"] = "round_trip"
            frame = pandas.read_csv(path, nrows=rows - 1, **options)
            known = _columns().get(path.name, {})
            columns = {name: known[name] for name in frame.columns if name in known}
            system = self.result.get("units", "")
            frame.attrs["units"] = {name: column["unit"].get(system, column["unit"][""]) for name, column in columns.items()}
            frame.attrs["meaning"] = {name: column["meaning"] for name, column in columns.items()}
            self._kept[name] = frame
        return self._kept[name]

    def __iter__(self):
        return iter(sorted(path.stem for path in self.folder.glob("*.csv")))

    def __len__(self):
        return sum(1 for _ in self)

    def __repr__(self):
        return f"<rdsolve.Results {self.folder}: {self.status}; {', '.join(self)}>"


def _call(words):
    return subprocess.run([program(), *words], capture_output=True, text=True, encoding="utf-8", check=False)


def _whole_rows(path):
    """The number of lines of a table that have an end: a run that is writing, or was killed, leaves half a row behind them."""
    rows, is_whole, quotes = 0, True, 0
    with path.open("rb") as lines:
        for line in lines:
            # A quoted name may hold line breaks.
            quotes += line.count(b'"')
            is_whole = line.endswith(b"\n") and quotes % 2 == 0
            rows += is_whole
    if rows and not is_whole:
        warnings.warn(f"the last line of {path} is incomplete and omitted", stacklevel=3)
    return rows


@lru_cache(maxsize=None)
def _columns():
    done = _call(["schema", "--results"])
    if done.returncode != 0:
        raise Failed(done.returncode, done.stderr)
    return json.loads(done.stdout)


def _toml(value):
    """A value as TOML; numbers of numpy count as numbers."""
    if hasattr(value, "item") and not hasattr(value, "__len__"):
        value = value.item()
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, (str, os.PathLike)):
        # A text of JSON is one of TOML, but for the surrogate pairs that only escapes of ASCII have.
        return json.dumps(os.fspath(value), ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{json.dumps(key)} = {_toml(item)}" for key, item in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(_toml, value)) + "]"
    raise TypeError(f"{value!r} is no value of a deck")
