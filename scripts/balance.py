"""Own checks of a result: does the energy balance, do the forces? From the tables and the deck alone, for fuzz.py.

Python's standard library only.
"""

import csv
import math
import tomllib
from pathlib import Path

STORED = ("kinetic", "strain", "links", "contact")
LOST = ("plastic", "viscoplastic", "damping", "friction", "impact")
# An unbalanced rest that a run owns to in a warning is no silent one; these are the words of those warnings.
OWNED = ("energy", "unstable", "buckles", "nbalanced", "plastic flow", "dissipation", "error_tolerance")
# The program speaks of 2 % of the energy of the motion and of 20 % of the largest energy on the way.
ENERGY = 0.2
# Impulses: of what all forces together could have given, besides the change of each force within a step.
IMPULSE = 0.02
# Forces in statics: convergence is judged against the largest forces of any node, here their sum is taken.
STATICS = 1e-4
# Motions of this part of the scene are those of rounded positions.
STILL = 1e-12
# What multipliers of contacts leave, in parts of the scene.
MULTIPLIERS = 1e-8
# Columns that are empty for what does not have them: complex modes no participation, ends of elements no plastic strain, joints
# of several directions no coordinate; None: any column of the table.
MAY_BE_EMPTY = {"modes.csv": None, "sections.csv": {"plastic_strain"}, "joints.csv": {"coordinate", "rate", "effort", "power"}}
# Forces that only rounding makes, of moments over the size of the scene.
ROUNDING = 1e-9
# Energies of scenes at rest: rounding of velocities of 1e-13, squared.
NOTHING = 1e-24


def numbers(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def not_finite(folder: Path, said: str) -> str | None:
    """A table with a number that is none; a field that is empty for want of a number is to be told of."""
    for path in sorted(folder.glob("*.csv")):
        told, allowed = f"empty in {path.name}" in said, MAY_BE_EMPTY.get(path.name, set())
        with path.open(newline="") as file:
            for row in csv.DictReader(file):
                empty = {column for column, cell in row.items() if cell == ""}
                silent = empty and not told and allowed is not None and not empty <= allowed
                if silent or any(str(cell).lower().lstrip("-") in ("nan", "inf", "infinity") for cell in row.values()):
                    return f"not finite: {path.name}"
    return None


def energy(rows: list[dict[str, str]], owned: bool, floor: float = 0.0) -> str | None:
    """Stored + lost = at the start + work, from the columns themselves; a rest below the floor is none."""
    if not rows or "kinetic" not in rows[0]:
        return None
    of = lambda row, names: [float(row.get(name) or 0.0) for name in names]
    start = sum(of(rows[0], STORED))
    rest = peak = 0.0
    for row in rows:
        stored, lost, work = of(row, STORED), of(row, LOST), float(row.get("external") or 0.0)
        if abs(sum(stored) - float(row["mechanical"])) > 1e-9 * sum(map(abs, stored)):
            return f"energy: mechanical is not the sum of its parts at t = {row['time']}"
        peak = max(peak, sum(map(abs, stored + lost)), abs(work))
        rest = max(rest, abs(start + work - sum(stored) - sum(lost)))
    if rest > max(ENERGY * peak, floor, NOTHING) and not owned:
        return f"energy: {rest:.2e} of {peak:.2e} missing"
    return None


def amplitude(table: dict, time: float) -> float:
    kind, start, end = table["kind"], table.get("start", 0.0), table.get("end", math.inf)
    if kind == "constant":
        return 1.0
    if kind == "ramp":
        return min(max((time - start) / (end - start), 0.0), 1.0)
    if kind == "table":
        points = table["points"]
        if time < points[0][0]:
            return 0.0 if table.get("before") == "zero" else points[0][1]
        for (t0, a0), (t1, a1) in zip(points, points[1:]):
            if time <= t1:
                return a0 + (a1 - a0) * (time - t0) / (t1 - t0)
        return 0.0 if table.get("after") == "zero" else points[-1][1]
    if not start <= time <= end:
        return 0.0
    if kind == "step":
        return 1.0
    phase = table.get("angular_frequency", math.tau * table.get("frequency", 0.0)) * (time - start)
    return math.sin(phase + table.get("phase", 0.0)) if kind == "sine" else math.sin(phase) ** 2


def plain(deck: dict) -> bool:
    """All that acts from outside stands in reactions.csv or is a force on named points, so that forces can be added up here."""
    loads, damping = deck.get("loads", []), deck.get("damping", {})
    names = set(deck.get("points", {})) | {body["name"] for body in deck.get("bodies", [])}
    at = lambda load: [load["at"]] if isinstance(load["at"], str) else load["at"]
    odd = {"follower", "pressure", "force_per_area", "force_per_length", "local", "part", "stages"}
    written = {"file", "scale", "shift", "stage"}
    return (
        "stages" not in deck
        and not any(written & set(amplitude) for amplitude in deck.get("amplitudes", {}).values())
        and all(not odd & set(load) and set(at(load)) <= names and len(set(at(load))) == len(at(load)) for load in loads)
        and not {"mass_factor", "alpha", "nodal"} & set(damping)
        and "base_acceleration" not in deck.get("environment", {})
        and deck["analysis"].get("control", "time") == "time"
        and "interval" not in deck.get("output", {})
        and deck.get("output", {}).get("every", 1) == 1
    )


def applied(deck: dict, time: float, end: float) -> list[list[float]]:
    """Each force on a point, at a time."""
    forces = []
    for load in deck.get("loads", []):
        if "amplitude" in load:
            factor = amplitude(deck["amplitudes"][load["amplitude"]], time)
        else:
            factor = time / end if deck["analysis"]["kind"] == "static" else 1.0
        count = 1 if isinstance(load["at"], str) else len(load["at"])
        forces += [[factor * f for f in load.get("force", [0.0] * 3)]] * count
    return forces


def extent(deck: dict) -> float:
    places = list(deck.get("points", {}).values()) + [body["center"] for body in deck.get("bodies", []) if "center" in body]
    return max((max(c) - min(c) for c in zip(*places)), default=0.0)


def moved(folder: Path) -> float:
    """The largest displacement of a named point."""
    rows = numbers(folder / "nodes.csv")
    return max((abs(float(row[u] or 0.0)) for row in rows for u in ("ux", "uy", "uz")), default=math.inf)


def forces(deck: dict, folder: Path, rows: list[dict[str, str]], end: float, owned: bool) -> str | None:
    """Reactions + loads = rate of momentum, over each step; directions in which gravity acts are left out."""
    if not plain(deck) or owned or not (folder / "reactions.csv").exists():
        return None
    if (folder / "nodes.csv").exists() and moved(folder) < STILL * extent(deck):
        return None
    joints = {joint["name"] for joint in deck.get("joints", [])}
    acting: dict[str, list[list[float]]] = {row["time"]: applied(deck, float(row["time"]), end) for row in rows}
    twist = 0.0
    for row in numbers(folder / "reactions.csv"):
        if row["direction"] in ("rx", "ry", "rz"):
            twist = max(twist, abs(float(row["value"])))
        # Rows under a joint's own name are of one between two parts.
        if row["direction"] in ("ux", "uy", "uz") and row["node"] not in joints and row["time"] in acting:
            axis = ("ux", "uy", "uz").index(row["direction"])
            acting[row["time"]].append([float(row["value"]) if i == axis else 0.0 for i in range(3)])
    gravity = deck.get("environment", {}).get("gravity", [0.0] * 3)
    times = [float(row["time"]) for row in rows]
    floor = ROUNDING * twist / (extent(deck) or 1.0)
    sizes = [sum(map(abs, sum(acting[row["time"]], []))) for row in rows]
    fastest = max(abs(float(row["p" + axis])) for row in rows for axis in "xyz")
    for axis in (i for i in range(3) if gravity[i] == 0.0):
        sums = [sum(f[axis] for f in acting[row["time"]]) for row in rows]
        if deck["analysis"]["kind"] == "static":
            # The first row is the state from which load steps begin: forces that act at once are balanced in the second.
            worst = max(zip(map(abs, sums[1:]), times[1:]), default=(0.0, 0.0))
            if worst[0] > STATICS * max(sizes) + floor:
                return f"equilibrium: {worst[0]:.2e} of {max(sizes):.2e} along {'xyz'[axis]} at t = {worst[1]}"
            continue
        momenta = [float(row["p" + "xyz"[axis]]) for row in rows]
        given = could = unseen = 0.0
        for i in range(1, len(rows)):
            dt = times[i] - times[i - 1]
            given += dt * (sums[i] + sums[i - 1]) / 2.0
            could += dt * (sizes[i] + sizes[i - 1]) / 2.0
            unseen += dt * abs(sums[i] - sums[i - 1])
            rest = abs(momenta[i] - momenta[0] - given)
            scale = could + fastest
            if rest > unseen + IMPULSE * scale and scale > 0.0:
                return f"momentum: {rest:.2e} of {scale:.2e} along {'xyz'[axis]} at t = {times[i]}"
    return None


def judge(text: str, folder: Path, end: float | None, said: str) -> str | None:
    """A fault of a run that was accepted; `end` where the deck's own end time was replaced."""
    if fault := not_finite(folder, said):
        return fault
    if not (folder / "energy.csv").exists() or "empty in " in said:
        return None
    rows, deck = numbers(folder / "energy.csv"), tomllib.loads(text)
    warnings = [line for line in said.splitlines() if line.startswith("warning")]
    owned = any(word in line for line in warnings for word in OWNED)
    if "stages" in deck or "end_time" not in deck["analysis"]:
        return energy(rows, owned or "stages" in deck)
    end = end if end is not None else deck["analysis"]["end_time"]
    # In statics what acts at once does more work than is stored on the way to equilibrium.
    at_once = deck["analysis"]["kind"] == "static" and any(any(force) for force in applied(deck, 0.0, end))
    # Multipliers leave depths and slips of 1e-8 of the size, whose work is no energy of the scene.
    acting = sum(map(abs, sum(applied(deck, end, end), [])), 0.0) if plain(deck) else 0.0
    floor = MULTIPLIERS * acting * (extent(deck) or 1.0) if "augmented-lagrangian" in text else 0.0
    return energy(rows, owned or at_once, floor) or forces(deck, folder, rows, end, owned)
