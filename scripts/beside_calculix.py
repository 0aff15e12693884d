#!/usr/bin/env python3
"""Files of CalculiX beside CalculiX: displacements, reactions and frequencies as a table.

    scripts/beside_calculix.py PROGRAM FILE.inp ...

Files that do not import are passed over. The table has the largest displacement at the end of the last step, the largest difference over it, the
resultants of the reactions, and the lowest frequencies. Debian has the files in the package calculix-ccx-test.
"""

import argparse
import csv
import gzip
import pathlib
import re
import subprocess
import tempfile

ALL, HELD = "BESIDE", "BESIDEHELD"


def text_of(path):
    """The text of a file, which may be packed."""
    data = gzip.open(path).read() if path.suffix == ".gz" else path.read_bytes()
    return data.decode("latin-1").replace("\r", "")


def numbers_of_nodes(text):
    """The numbers of all nodes that the file defines."""
    found, inside = set(), False
    for line in text.splitlines():
        if line.lstrip().startswith("*"):
            is_comment = line.lstrip().startswith("**")
            inside = inside if is_comment else re.match(r"\s*\*node\s*(,|$)", line, re.I) is not None
        elif inside and line.strip():
            found.add(int(line.split(",")[0]))
    return sorted(found)


def supported(text):
    """The nodes and sets that lines of *BOUNDARY name."""
    blocks = re.findall(r"(?im)^\s*\*boundary\b.*\n((?:[^*].*\n)*)", text)
    names = {line.split(",")[0].strip().upper() for block in blocks for line in block.splitlines() if line.strip()}
    return sorted(names)


def with_prints(text):
    """The file with displacements of all its nodes and the sum of the reactions printed at the end of each step."""
    ids = numbers_of_nodes(text)
    rows = [", ".join(map(str, ids[k : k + 8])) for k in range(0, len(ids), 8)]
    first = re.search(r"(?im)^\s*\*step\b", text).start()
    sets = [f"*NSET, NSET={ALL}", *rows, f"*NSET, NSET={HELD}", *supported(text), ""]
    text = text[:first] + "\n".join(sets) + text[first:]
    wanted = f"*NODE PRINT, NSET={HELD}, TOTALS=ONLY\nRF\n*NODE PRINT, NSET={ALL}\nU\n*END STEP"
    return re.sub(r"(?im)^\s*\*end *step.*$", wanted, text)


def floats(words):
    """The numbers of a line; none where a word is no number."""
    try:
        return [float(word) for word in words]
    except ValueError:
        return []


def of_calculix(path):
    """Displacements by node and the total force of the last step, and frequencies."""
    moved, total, frequencies, place = {}, [], [], None
    for line in path.read_text(errors="replace").splitlines():
        row = floats(line.split())
        if f"set {ALL}" in line:
            place = "u" if "displacements" in line else "total"
            moved = {} if place == "u" else moved
        elif "E I G E N V A L U E   O U T P U T" in line:
            place = "f"
        elif "PARTICIPATION" in line or "(" in line and "MODE" not in line and "RAD/TIME" not in line:
            place = None
        elif place == "u" and len(row) == 4:
            moved[int(row[0])] = row[1:]
        elif place == "total" and len(row) == 3:
            total = row
        elif place == "f" and len(row) == 5:
            frequencies.append(row[3])
    return moved, total, frequencies


def table(path):
    """The rows of a table of results, none where it is missing."""
    return list(csv.DictReader(path.open())) if path.exists() else []


def of_rdsolve(folder):
    """The same of results of this program."""
    rows, forces = table(folder / "nodes.csv"), table(folder / "reactions.csv")
    ends = [row for row in rows if row["time"] == rows[-1]["time"] and row["node"].startswith("mesh.")]
    moved = {int(row["node"][5:]): [float(row[key]) for key in ("ux", "uy", "uz")] for row in ends}
    of = lambda key: sum(float(row["value"]) for row in forces if row["direction"] == key and row["time"] == forces[-1]["time"])
    modes = [float(row["frequency"]) for row in table(folder / "modes.csv") if row.get("frequency")]
    return moved, [of(key) for key in ("ux", "uy", "uz")] if forces else [], modes


def run(command, folder):
    """Runs a command; None where it takes too long."""
    try:
        return subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=600)
    except subprocess.TimeoutExpired:
        return None


def beside(program, path):
    """A row of the table; None where the file does not import."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        text = text_of(path)
        (folder / "a.inp").write_text(text)
        (folder / "c.inp").write_text(with_prints(text) if re.search(r"(?im)^\s*\*step\b", text) else text)
        made = run([program, "import", "a.inp", "--from", "calculix", "-o", "deck"], folder)
        if made is None or made.returncode != 0:
            return None
        sets = ["--set", 'output.nodes="all"', "--set", "output.reactions=true"]
        done = run([program, "run", "deck/a.toml", "-o", "out", "--quiet", *sets], folder)
        run(["ccx", "c"], folder)
        theirs = of_calculix(folder / "c.dat") if (folder / "c.dat").exists() else ({}, [], [])
        ours = of_rdsolve(folder / "out")
        code = "stopped" if done is None else f"exit {done.returncode}"
    nodes = ours[0].keys() & theirs[0].keys()
    if ours[2]:
        nodes = []
    largest = [max((abs(x) for node in nodes for x in of[0][node]), default=0.0) for of in (ours, theirs)]
    apart = max((abs(a - b) for node in nodes for a, b in zip(ours[0][node], theirs[0][node])), default=0.0)
    share = f"{apart / largest[1]:.2%}" if largest[1] else "-"
    vector = lambda of: " ".join(f"{x:.4g}" for x in of)
    return [path.name, code, f"{largest[0]:.5g}", f"{largest[1]:.5g}", share, vector(ours[1]), vector(theirs[1])] + [
        " ".join(f"{x:.5g}" for x in of[2][:4]) for of in (ours, theirs)
    ]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=lambda path: str(pathlib.Path(path).resolve()))
    parser.add_argument("files", nargs="+", type=pathlib.Path)
    arguments = parser.parse_args()
    print("| file | rdsolve | displacement | CalculiX | difference | reactions | CalculiX | frequencies | CalculiX |")
    print("|" + "---|" * 9)
    for path in arguments.files:
        row = beside(arguments.program, path)
        if row:
            print("| " + " | ".join(row) + " |", flush=True)


if __name__ == "__main__":
    main()
