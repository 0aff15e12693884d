#!/usr/bin/env python3
"""Random sensible scenes, solved by every scheme that applies.  scripts/random_scenes.py PROGRAM [--count N] [--seed S] [--keep FOLDER]

Each scene comes from a seed. A scheme halves its time step until the last halving changes the answer by less than CHANGE; the
answers of all schemes then have to agree. Findings are a warning of a converged run, a scheme that disagrees or does not
converge, a panic, and any exit code but 0. The folder keeps the deck of each finding. Python's standard library only.
"""

import argparse
import collections
import csv
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

IMPLICIT = ["wilson-theta", "newmark", "hht-alpha", "generalized-alpha", "bathe", "esdirk3"]
EXPLICIT = ["central-difference", "runge-kutta"]  # for scenes whose stiffest part the first step resolves
CHANGE = 1e-3  # of the largest value of the answer, by the last halving
HALVINGS = 8
AGREE = 2.0  # a scheme of first order still errs by its last change; of two schemes each adds its own, and each is doubled
FLOOR = 1e-5  # of the largest value: the iteration tolerance summed over the steps
PATIENCE = 60  # seconds for one run
STEEL = {"model": "elastic", "youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7850.0}


def toml(value):
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return json.dumps(value)
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml(entry)}" for key, entry in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(toml(entry) for entry in value) + "]"
    return repr(value)


def deck_text(deck):
    return "".join(f"{key} = {toml(value)}\n" for key, value in deck.items())


def unit(rng):
    v = [rng.gauss(0.0, 1.0) for _ in range(3)]
    length = math.sqrt(sum(x * x for x in v))
    return [x / length for x in v]


def scaled(v, factor):
    return [x * factor for x in v]


def scene(end, step, **tables):
    """A dynamic deck without numerical knobs beyond its step."""
    return {"analysis": {"kind": "dynamic", "end_time": end, "time_step": step}, **tables}


def rectangle(rng, size):
    return {"shape": "rectangle", "width": size * rng.uniform(0.6, 1.4), "height": size}


def period_of_beam(length, height):
    """The first period of a steel cantilever, in seconds."""
    speed = math.sqrt(STEEL["youngs_modulus"] / STEEL["density"])
    return math.tau * length**2 / (3.516 * speed * height / math.sqrt(12.0))


def cantilever(rng):
    length, height = rng.uniform(1.0, 3.0), rng.uniform(0.03, 0.08)
    section = rectangle(rng, height)
    period = period_of_beam(length, min(height, section["width"]))
    force = 210e9 * section["width"] * min(height, section["width"]) ** 3 / 4.0 / length**2 * rng.uniform(0.005, 0.05)
    points = {"a": [0.0, 0.0, 0.0], "b": scaled(unit(rng), length)}
    axis = [x / length for x in points["b"]]
    across = min(([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]), key=lambda e: abs(sum(x * y for x, y in zip(e, axis))))
    beam = {"name": "beam", "path": ["a", "b"], "elements": rng.randint(2, 5), "material": "steel", "section": "s",
            "orientation": across, "order": rng.choice([1, 2, 3])}  # fmt: skip
    rise = {"kind": "table", "points": [[0.0, 0.0], [period * 0.5, 1.0], [period * 9.0, 1.0]]}
    return scene(
        period, period / 60.0, materials={"steel": STEEL}, sections={"s": section}, points=points, beams=[beam],
        supports=[{"at": "a", "fix": "all"}], loads=[{"at": "b", "force": scaled(unit(rng), force), "amplitude": "rise"}],
        amplitudes={"rise": rise}, masses=[{"at": "b", "mass": rng.uniform(1.0, 20.0)}],
    )  # fmt: skip


def shaken_frame(rng):
    height, span, size = rng.uniform(2.5, 4.0), rng.uniform(3.0, 6.0), rng.uniform(0.1, 0.2)
    points = {"a": [0.0, 0.0, 0.0], "b": [0.0, 0.0, height], "c": [span, 0.0, height], "d": [span, 0.0, 0.0]}
    beam = {"name": "frame", "path": ["a", "b", "c", "d"], "elements": 2, "material": "steel", "section": "s",
            "orientation": [0.0, 1.0, 0.0], "order": rng.choice([1, 2])}  # fmt: skip
    motion = {"ux": {"amplitude": "shake", "scale": rng.uniform(0.005, 0.02)}}
    rotations = ["rx", "ry", "rz"]
    return scene(
        1.0, 0.005, materials={"steel": STEEL}, sections={"s": rectangle(rng, size)}, points=points, beams=[beam],
        masses=[{"at": ["b", "c"], "mass": rng.uniform(100.0, 2000.0)}],
        supports=[{"at": ["a", "d"], "fix": ["uy", "uz", *rotations], "motion": motion}],
        amplitudes={"shake": {"kind": "table", "points": [[0.02 * i, math.sin(0.1 * i) ** 4] for i in range(61)]}},
        damping={"stiffness_factor": rng.choice([1e-4, 5e-4])},
    )  # fmt: skip


def truss(rng):
    side = rng.uniform(0.8, 1.5)
    points = {"a": [0.0, 0.0, 0.0], "b": [side, 0.0, 0.0], "c": [side / 2.0, side, 0.0], "top": [side / 2.0, side / 3.0, side]}
    bars = [{"name": f"bar_{foot}", "path": [foot, "top"], "material": "steel", "area": rng.uniform(1e-4, 5e-4)} for foot in "abc"]
    mass = rng.uniform(200.0, 2000.0)
    period = math.tau * math.sqrt(mass * side / (210e9 * 2e-4))
    force = scaled(unit(rng), rng.uniform(1e3, 1e4))
    return scene(
        3.0 * period, period / 60.0, materials={"steel": STEEL}, points=points, bars=bars, masses=[{"at": "top", "mass": mass}],
        supports=[{"at": ["a", "b", "c"], "fix": ["ux", "uy", "uz"]}], loads=[{"at": "top", "force": force}],
    )  # fmt: skip


def pendulum(rng):
    """A chain of bodies on joints of all kinds that hold a point."""
    bodies, joints, hook = [], [], [0.0, 0.0, 0.0]
    way, last = unit(rng), {"ground": [0.0, 0.0, 0.0]}
    for i in range(rng.randint(1, 3)):
        length = rng.uniform(0.3, 1.0)
        center = [h + w * length / 2.0 for h, w in zip(hook, way)]
        mass = rng.uniform(1.0, 5.0)
        inertia = [mass * length**2 * rng.uniform(0.06, 0.1) for _ in range(3)]
        bodies.append({"name": f"b{i}", "center": center, "mass": mass, "inertia": inertia})
        joint = {"name": f"j{i}", "kind": rng.choice(["ball", "hinge", "universal"]), "to": {"body": f"b{i}", "point": hook}}
        joint["from"] = last if i == 0 else {**last, "point": hook}
        if joint["kind"] != "ball":
            joint["axis"] = [0.0, 1.0, 0.0]
        if joint["kind"] == "universal":
            joint["cross_axis"] = [1.0, 0.0, 0.0]
        joints.append(joint)
        hook, last = [h + w * length for h, w in zip(hook, way)], {"body": f"b{i}"}
    return scene(0.5, 0.005, environment={"gravity": [0.0, 0.0, -9.81]}, bodies=bodies, joints=joints)


def bodies_on_springs(rng):
    bodies, links, last = [], [], {"ground": [0.0, 0.0, 0.0]}
    for i in range(rng.randint(1, 4)):
        center = [0.5 * (i + 1), rng.uniform(-0.1, 0.1), rng.uniform(-0.1, 0.1)]
        bodies.append({"name": f"b{i}", "center": center, "mass": rng.uniform(1.0, 5.0),
                       "inertia": [rng.uniform(0.06, 0.1) for _ in range(3)], "velocity": scaled(unit(rng), rng.uniform(0.0, 0.5)),
                       "angular_velocity": scaled(unit(rng), rng.uniform(0.0, 3.0))})  # fmt: skip
        point = [center[0] - 0.15, *center[1:]]
        links.append({"name": f"l{i}", "from": last, "to": {"body": f"b{i}", "point": point},
                      "stiffness": rng.uniform(500.0, 5000.0), "damping": rng.uniform(0.0, 10.0)})  # fmt: skip
        last = {"body": f"b{i}", "point": [center[0] + 0.15, *center[1:]]}
    return scene(0.5, 0.005, bodies=bodies, links=links)


def bushings(rng):
    stiffness = [rng.uniform(1e3, 1e4) for _ in range(3)] + [rng.uniform(50.0, 500.0) for _ in range(3)]
    body = {"name": "b0", "center": [0.0, 0.0, 0.0], "mass": rng.uniform(1.0, 5.0), "inertia": [rng.uniform(0.06, 0.1) for _ in range(3)],
            "velocity": scaled(unit(rng), 0.5), "angular_velocity": scaled(unit(rng), rng.uniform(0.5, 3.0))}  # fmt: skip
    link = {"name": "bush", "from": {"body": "b0"}, "to": {"ground": [0.0, 0.0, 0.0]}, "bushing": stiffness}
    return scene(0.5, 0.005, bodies=[body], links=[link])


def landing_ball(rng):
    radius = rng.uniform(0.05, 0.2)
    mass = 7850.0 * 4.0 / 3.0 * math.pi * radius**3
    body = {"name": "ball", "center": [0.0, 0.0, radius + 0.002], "shape": {"kind": "sphere", "radius": radius}, "mass": mass,
            "velocity": [rng.uniform(0.0, 0.2), 0.0, -rng.uniform(0.3, 1.0)]}  # fmt: skip
    stiffness = mass * (math.tau / 0.02) ** 2
    contact = {"name": "floor", "surface": {"shape": "plane", "point": [0.0, 0.0, 0.0], "normal": [0.0, 0.0, 1.0]}, "with": "ball",
               "stiffness": stiffness, "friction": rng.choice([0.0, 0.3])}  # fmt: skip
    return scene(0.04, 2e-4, environment={"gravity": [0.0, 0.0, -9.81]}, bodies=[body], contacts=[contact])


def plate(rng):
    """Flat or curved, of four corners or three, pressed softly."""
    side, thickness = rng.uniform(0.5, 1.0), rng.uniform(0.008, 0.02)
    rise = rng.choice([0.0, 0.2 * side])
    radius = (side**2 / 4.0 + rise**2) / (2.0 * rise) if rise else 0.0
    points = {"a": [0.0, 0.0, 0.0], "b": [side, 0.0, 0.0], "c": [side, side, 0.0], "d": [0.0, side, 0.0]}
    shell = {"name": "plate", "corners": ["a", "b", "c", "d"], "elements": [4, 4], "thickness": thickness, "material": "steel"}
    if rise:
        shell["surface"] = {"kind": "cylinder", "center": [side / 2.0, 0.0, rise - radius], "axis": [0.0, 1.0, 0.0]}
    if rng.random() < 0.4:
        shell["kind"] = "triangle"
    frequency = 3.29 / side**2 * math.sqrt(210e9 * thickness**2 / (12.0 * 0.91 * 7850.0)) / 1.05
    pressure = 210e9 * thickness**4 / side**4 * rng.uniform(0.05, 0.5)
    ramp = {"kind": "table", "points": [[0.0, 0.0], [1.0 / frequency, 1.0], [9.0 / frequency, 1.0]]}
    return scene(
        1.5 / frequency, 0.02 / frequency, materials={"steel": STEEL}, points=points, shells=[shell],
        supports=[{"at": ["plate.edge2", "plate.edge4"], "fix": "all"}],
        loads=[{"at": "plate", "pressure": pressure, "amplitude": "ramp"}], amplitudes={"ramp": ramp},
    )  # fmt: skip


def body_on_beam(rng):
    """A heavy body attached to the end of a cantilever: flexible and rigid in one scene."""
    deck = cantilever(rng)
    end = deck["points"]["b"]
    mass = rng.uniform(5.0, 50.0)
    deck["bodies"] = [{"name": "block", "center": end, "mass": mass, "inertia": [mass * rng.uniform(0.005, 0.01)] * 3}]
    deck["attachments"] = [{"body": "block", "nodes": "b"}]
    deck["analysis"]["end_time"] *= 1.5
    del deck["masses"]
    return deck


def yielding_cantilever(rng):
    deck = cantilever(rng)
    section = deck["sections"]["s"]
    section["fibres"] = [8, 8]
    deck["materials"]["steel"] = {**STEEL, "model": "elastic-plastic", "yield_stress": 235e6, "hardening_modulus": 5e9}
    deck["beams"][0] |= {"shear_yields": False, "order": 2}
    thin = min(section["width"], section["height"])
    moment = 235e6 * section["width"] * section["height"] * thin / 6.0
    load = deck["loads"][0]
    length = math.sqrt(sum(x * x for x in deck["points"]["b"]))
    size = math.sqrt(sum(x * x for x in load["force"]))
    load["force"] = scaled(load["force"], rng.uniform(0.8, 1.4) * moment / length / size)
    return deck


def weight_then_motion(rng):
    """A static stage, then a load that acts at once."""
    deck = cantilever(rng)
    analysis = deck.pop("analysis")
    deck["environment"] = {"gravity": [0.0, 0.0, -9.81]}
    deck["loads"][0] |= {"stages": ["motion"]}
    del deck["loads"][0]["amplitude"], deck["amplitudes"]
    weight = {"name": "weight", "kind": "static", "duration": 1.0, "time_step": 0.5}
    motion = {"name": "motion", "kind": "dynamic", "duration": analysis["end_time"], "time_step": analysis["time_step"]}
    return {"stages": [weight, motion], **deck}


KINDS = [cantilever, shaken_frame, truss, pendulum, bodies_on_springs, bushings, landing_ball, plate, body_on_beam,
         yielding_cantilever, weight_then_motion]  # fmt: skip


def ladder(deck, scheme, level):
    """The deck with one scheme and its step halved so many times."""
    deck = {**deck, "integrator": {"scheme": scheme}, "iteration": {"tolerance": 1e-9}}
    if "stages" in deck:
        deck["stages"] = [{**s, "time_step": s["time_step"] / 2**level} if s["kind"] == "dynamic" else s for s in deck["stages"]]
        end = sum(s["duration"] for s in deck["stages"])
    else:
        deck["analysis"] = {**deck["analysis"], "time_step": deck["analysis"]["time_step"] / 2**level}
        end = deck["analysis"]["end_time"]
    shells = {"nodes": [shell["name"] for shell in deck["shells"]]} if "shells" in deck else {}
    return {**deck, "output": {"interval": end, **shells}}
RESOLVED = {"truss", "pendulum", "bodies_on_springs", "bushings", "landing_ball"}


class Finding(Exception):
    """Kind, scheme, and what was seen."""


def answer(program, deck, folder):
    """Displacements of nodes and positions of bodies at the end, and the warnings."""
    file, out = folder / "deck.toml", folder / "out"
    file.write_text(deck_text(deck))
    command = [program, "run", file, "-o", out, "--quiet", "--overwrite", "--threads", "1"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE)
    except subprocess.TimeoutExpired:
        raise Finding(f"no end in {PATIENCE} s") from None
    if done.returncode:
        raise Finding(f"exit code {done.returncode}: {done.stderr.strip()[:600]}")
    values = []
    for name, columns in (("nodes.csv", ("ux", "uy", "uz")), ("bodies.csv", ("x", "y", "z"))):
        if (out / name).exists():
            with (out / name).open(newline="") as table:
                rows = list(csv.DictReader(table))
            first, last = float(rows[0]["time"]), float(rows[-1]["time"])
            start = {r["node" if name[0] == "n" else "body"]: r for r in rows if float(r["time"]) == first}
            for row in rows:
                if float(row["time"]) == last:
                    at = start[row["node" if name[0] == "n" else "body"]]
                    values += [float(row[c]) - float(at[c]) for c in columns]
    return values, json.loads((out / "result.json").read_text()).get("warnings", [])


def distance(a, b):
    return max((abs(x - y) for x, y in zip(a, b)), default=0.0)


def converged(program, deck, scheme, folder):
    """Answer, last change and warnings of the shortest steps."""
    before, change, seen = None, math.inf, []
    for level in range(HALVINGS):
        values, warnings = answer(program, ladder(deck, scheme, level), folder)
        if not all(map(math.isfinite, values)):
            raise Finding("a result is not finite")
        size = max(map(abs, values), default=0.0)
        if size == 0.0:
            raise Finding("nothing moves, so the answers cannot be compared")
        if before is not None:
            change = distance(before, values)
            if change <= CHANGE * size:
                return values, change, warnings
        before, seen = values, warnings
    raise Finding(f"no convergence: the last of {HALVINGS - 1} halvings changes {change:.3g} of {size:.3g}; {seen}")


def judge(program, deck, schemes, folder):
    """Findings of one scene over the schemes."""
    found, answers = [], {}
    for scheme in schemes:
        try:
            values, change, warnings = converged(program, deck, scheme, folder)
        except Finding as finding:
            found.append((scheme, str(finding)))
            continue
        answers[scheme] = values, change
        found += [(scheme, f"warning: {w}") for w in warnings]
    for scheme, (values, change) in answers.items():
        size = max(map(abs, values), default=0.0)
        others = [(distance(values, v), AGREE * (change + c) + FLOOR * size, o) for o, (v, c) in answers.items() if o != scheme]
        if others and all(gap > bound for gap, bound, _ in others):
            gap, bound, other = min(others)
            found.append((scheme, f"differs from all others, least from {other} by {gap:.3g} (bound {bound:.3g}, size {size:.3g})"))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--keep", type=pathlib.Path, default=pathlib.Path("random_scenes"))
    arguments = parser.parse_args()
    faulty, counts = 0, collections.Counter()
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(arguments.seed, arguments.seed + arguments.count):
            make = KINDS[seed % len(KINDS)]
            deck = make(random.Random(seed))
            counts[make.__name__] += 1
            schemes = IMPLICIT + (EXPLICIT if make.__name__ in RESOLVED else [])
            found = judge(arguments.program, deck, schemes, pathlib.Path(folder))
            if not found:
                continue
            faulty += 1
            arguments.keep.mkdir(parents=True, exist_ok=True)
            (arguments.keep / f"{seed}.toml").write_text(deck_text(ladder(deck, found[0][0], 0)))
            for scheme, text in found:
                print(f"{seed} {make.__name__} {scheme}: {text}", flush=True)
    print(f"{arguments.count} scenes, {faulty} with findings; " + ", ".join(f"{n} {k}" for k, n in counts.items()))
    return 1 if faulty else 0


if __name__ == "__main__":
    sys.exit(main())
