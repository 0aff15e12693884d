"""The tractor of decks/safety_cab, struck by the pendulum: its decks, its runs, its tables.

    python3 scripts/safety_cab.py decks            # writes rear.toml, front.toml, side.toml
"""

import math
import sys
from pathlib import Path

import safety_cab_mesh as geometry

FOLDER = geometry.FOLDER

# ---- what is decided here, and not by the deck ----

MASS = 3000.0  # reference mass, kg
WHEELBASE = 2.2
G = 9.81
PENDULUM = 2000.0  # kg
FACE, DEPTH = 0.68, 0.60  # of the block
CHAIN = 6.0  # from the pivots to the centre of the block
DENSITY = 7850.0
PLATES = {"floor": 0.003, "roof": 0.002, "panels": 0.002}
BOXES = {"posts": (0.050, 0.003), "sills": (0.080, 0.004), "roof_frame": (0.050, 0.003), "rails": (0.040, 0.0025)}
TUBE, CAST = (0.18, 0.012), 7200.0
# name: mass, centre, size of a box; the engine takes what is left to the reference mass.
LUMPS = {
    "engine": [None, (1.75, 0.0, 0.95), (0.90, 0.55, 0.70)],
    "gearbox": [560.0, (0.20, 0.0, 0.78), (1.00, 0.50, 0.50)],
    "linkage": [160.0, (-0.45, 0.0, 0.75), (0.40, 0.80, 0.40)],
}
# name: mass, radius under no load, width, x, y, tyre stiffness, damping
WHEELS = {}
for sign, side in (-1, "right"), (1, "left"):
    WHEELS[f"wheel_rear_{side}"] = (180.0, 0.75, 0.34, 0.0, sign * 0.95, 3.5e5, 3.0e3)
    WHEELS[f"wheel_front_{side}"] = (80.0, 0.60, 0.26, WHEELBASE, sign * 0.80, 2.5e5, 2.0e3)
ROPE_STIFFNESS = 1.0e7  # E A of 15 mm wire rope, N
ROPE_TENSION = 8.0e3


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def plus(a, b, factor=1.0):
    return [x + factor * y for x, y in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def length(a):
    return math.sqrt(dot(a, a))


def mass_of_mesh() -> tuple[float, list[float], float]:
    """Mass and first moment of all that the mesh holds, and the mass of the cab alone."""
    mesh = geometry.cab(*geometry.MESHES["cab"])
    mass, first, of_cab = 0.0, [0.0] * 3, 0.0
    for group, cells in mesh.groups.items():
        for cell in cells:
            x = [mesh.nodes[node - 1] for node in cell]
            middle = [sum(axis) / len(x) for axis in zip(*x)]
            if group in PLATES:
                area = length(cross(plus(x[2], x[0], -1), plus(x[3], x[1], -1))) / 2
                weight = area * PLATES[group] * DENSITY
            elif group in BOXES:
                width, wall = BOXES[group]
                weight = length(plus(x[1], x[0], -1)) * (width**2 - (width - 2 * wall) ** 2) * DENSITY
            elif group == "backbone":
                radius, wall = TUBE
                weight = length(plus(x[1], x[0], -1)) * math.pi * (radius**2 - (radius - wall) ** 2) * CAST
            else:
                continue
            mass, first = mass + weight, plus(first, middle, weight)
            of_cab += weight if group != "backbone" else 0.0
    return mass, first, of_cab


def ropes() -> list[tuple[str, str, list[float], list[float], float]]:
    """name, wheel, anchor, point at the end of the axle, tension; front and rear pull the same."""
    made = []
    for sign, side in (-1, "right"), (1, "left"):
        for end, anchor, point in (
            ("rear", [-1.30, sign * 0.75, 0.05], [0.0, sign * 0.75, 0.55]),
            ("front", [WHEELBASE + 1.30, sign * 0.62, 0.05], [WHEELBASE, sign * 0.62, 0.55]),
        ):
            along = plus(point, anchor, -1)
            tension = ROPE_TENSION * length(along) / abs(along[0])
            made.append((f"rope_{end}_{side}", f"wheel_{end}_{side}", anchor, point, tension))
    return made


def statics() -> dict:
    """The engine's mass and the loads of the tyres in the tractor at rest, lashed."""
    mass, first, of_cab = mass_of_mesh()
    for weight, centre, _ in (lump for lump in LUMPS.values() if lump[0]):
        mass, first = mass + weight, plus(first, centre, weight)
    for weight, _, _, x, y, *_ in WHEELS.values():
        mass, first = mass + weight, plus(first, (x, y, 0.0), weight)
    engine = MASS - mass
    first = plus(first, LUMPS["engine"][1], engine)
    x = first[0] / MASS
    load = {"front": MASS * G * x / WHEELBASE, "rear": MASS * G * (1 - x / WHEELBASE)}
    for _, wheel, anchor, point, tension in ropes():
        down = tension * (point[2] - anchor[2]) / length(plus(point, anchor, -1))
        load["rear" if "rear" in wheel else "front"] += down
    # The ropes pull to both sides by the same force at the same height: no moment of theirs is left.
    return {"engine": engine, "centre": x, "of_cab": of_cab, "load": {end: f / 2 for end, f in load.items()}}


BLOWS = {
    # height of fall in m, angle of the chains in degrees, where it goes, what the face is centred on
    "rear": (2.165e-8 * MASS * (WHEELBASE * 1e3) ** 2 * 1e-3, 20.0, (1.0, 0.0, 0.0)),
    "front": ((125 + 0.02 * MASS) * 1e-3, 20.0, (-1.0, 0.0, 0.0)),
    "side": ((125 + 0.15 * MASS) * 1e-3, 0.0, (0.0, -1.0, 0.0)),
}
SEAT = (0.15, 0.0, 1.52)  # seat index point
GAP = 0.002  # of face and cab at t = 0


def reach(aim, side, up) -> list:
    """Nodes of posts and roof that the face covers."""
    mesh = geometry.cab(*geometry.MESHES["cab"])
    nodes = {mesh.nodes[n - 1] for group in ("roof_frame", "posts") for cell in mesh.groups[group] for n in cell}
    half = FACE / 2 + 1e-9
    return [x for x in sorted(nodes) if all(abs(dot(plus(x, aim, -1), axis)) <= half for axis in (side, up))]


def blow(name: str) -> dict:
    """Where the block is, and how it moves, at t = 0."""
    height, angle, ahead = BLOWS[name]
    width = 2 * geometry.HALF_WIDTH[1]
    skin = BOXES["roof_frame"][0] / 2
    aim: list[float] = {
        "rear": [geometry.REAR[1], width / 2 - width / 6, geometry.ROOF],
        "front": [geometry.FRONT[1], -(width / 2 - width / 6), geometry.ROOF],
        "side": [SEAT[0] + 0.06, width / 2, geometry.ROOF],
    }[name]
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    normal = [c * ahead[0], c * ahead[1], -s]
    up = [s * ahead[0], s * ahead[1], c]
    side = cross(up, normal)
    # Out from where it is aimed at, so far that the face stands clear of all that it covers.
    depths = [dot(normal, plus(x, aim, -1)) for x in reach(aim, side, up)]
    face = plus(aim, normal, min(depths) - skin - GAP)
    centre = plus(face, normal, -DEPTH / 2)
    speed = math.sqrt(2 * G * height)
    pivot = plus(centre, up, CHAIN)
    turn = [value * speed / CHAIN for value in cross(plus(centre, pivot, -1), normal)]
    turn = [value / CHAIN for value in turn]
    J = [PENDULUM / 12 * m for m in (2 * FACE**2, DEPTH**2 + FACE**2, DEPTH**2 + FACE**2)]  # about normal, side, up
    inertia = [[sum(J[k] * e[i] * e[j] for k, e in enumerate((normal, side, up))) for j in range(3)] for i in range(3)]
    chains = []
    stiffness = 2.5e6
    for a in -1, 1:
        for b in -1, 1:
            top = plus(pivot, side, a * 0.30)
            end = plus(plus(plus(centre, side, a * 0.30), normal, b * 0.25), up, FACE / 2)
            along = plus(top, end, -1)
            pull = PENDULUM * (G * c + speed**2 / CHAIN) / 4 * length(along) / dot(along, up)
            chains.append((top, end, stiffness, length(along) - pull / stiffness))
    return dict(height=height, angle=angle, speed=speed, energy=PENDULUM * G * height, normal=normal, up=up, side=side,
                centre=centre, face=face, turn=turn, inertia=inertia, chains=chains, aim=aim)


# ---- text ----


def number(value: float) -> str:
    text = f"{value:.10g}"
    return text if any(c in text for c in ".e") else text + ".0"


def vector(values) -> str:
    return "[" + ", ".join(number(v if abs(v) > 1e-12 else 0.0) for v in values) + "]"


COMMON = """\
[analysis]
kind = "dynamic"
end_time = 0.6
time_step = 5e-4

[iteration]
tolerance = 1e-5

[mesh]
file = "cab.msh"                      # or cab_coarse.msh, cab_fine.msh

[environment]
gravity = [0.0, 0.0, -9.81]

# ---- the cab: six posts, frames of box section, sheet steel ----

[materials.steel]
model = "elastic-viscoplastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
density = 7850.0
yield_stress = 275e6
hardening_modulus = 1e9
viscosity = {{ law = "power", rate = 40.4, exponent = 5.0 }}

{sections}
{parts}
# ---- the tractor ----

[materials.cast_iron]
model = "elastic"
youngs_modulus = 110e9
poisson_ratio = 0.27
density = 7200.0

[sections.housing]
shape = "tube"
radius = 0.18
thickness = 0.012

[[beams]]
group = "backbone"
material = "cast_iron"
section = "housing"
orientation = [1.0, 0.0, 1.0]         # a tube: any direction but those of its axes
order = 2
rigid = true
{bodies}
[points]
{brackets}
[[attachments]]
beam = "backbone"
nodes = [{attached}]
{mounts}
{tyres}
{ropes}"""


def table(header: str, **keys) -> str:
    def value(v) -> str:
        if isinstance(v, str):
            return v if v.startswith("{") else f'"{v}"'
        if isinstance(v, bool):
            return str(v).lower()
        return number(v) if isinstance(v, float) else str(v) if isinstance(v, int) else vector(v)
    return "\n".join([header] + [f"{key} = {value(v)}" for key, v in keys.items()]) + "\n"


def place(body: str, point) -> str:
    return f'{{ body = "{body}", point = {vector(point)} }}'


def ground(point) -> str:
    return f"{{ ground = {vector(point)} }}"


FEET = [(name, side) for name in ("rear", "front") for side in ("right", "left")]


def common() -> str:
    rest = statics()
    sections = [table(f"[sections.{name}]", shape="box", width=w, height=w, thickness=t) for name, (w, t) in BOXES.items()]
    parts = []
    for name in BOXES:
        toward = [1.0, 0.0, 0.0] if name == "posts" else [0.0, 0.0, 1.0]
        parts.append(table("[[beams]]", group=name, material="steel", section=name, orientation=toward, order=2))
    parts += [table("[[shells]]", group=name, thickness=t, material="steel") for name, t in PLATES.items()]
    bodies = []
    for name, (mass, centre, size) in LUMPS.items():
        shape = f'{{ kind = "box", size = {vector(size)} }}'
        bodies.append(table("[[bodies]]", name=name, center=centre, mass=float(mass or rest["engine"]), shape=shape))
    for name, (mass, radius, width, x, y, *_) in WHEELS.items():
        height = geometry.BACKBONE_Z if "rear" in name else geometry.FRONT_AXLE_Z
        shape = f'{{ kind = "tube", radius = {radius}, thickness = {0.35 * radius:.3g}, length = {width}, axis = [0.0, 1.0, 0.0] }}'
        bodies.append(table("[[bodies]]", name=name, center=[x, y, height], mass=mass, shape=shape))
    brackets, mounts = [], []
    for name, side in FEET:
        x = geometry.REAR[0] if name == "rear" else geometry.FRONT[0]
        y = geometry.HALF_WIDTH[0] * (-1 if side == "right" else 1)
        brackets.append(f"bracket_{name}_{side} = {vector([x, y, geometry.FLOOR])}")
        mounts.append(table("[[links]]", name=f"mount_{name}_{side}", **{"from": f'{{ node = "bracket_{name}_{side}" }}'},
                            to=f'{{ node = "foot_{name}_{side}" }}', bushing=[6e6, 6e6, 8e6, 2e4, 2e4, 2e4],
                            bushing_damping=[6e3, 6e3, 8e3, 20.0, 20.0, 20.0]))
    tyres = []
    for name, (mass, radius, width, x, y, stiffness, damping) in WHEELS.items():
        end = "rear" if "rear" in name else "front"
        sink = rest["load"][end] / stiffness
        tyres.append(table("[[links]]", name=name.replace("wheel", "tyre"), **{"from": ground([x, y, 0.0])},
                           to=place(name, [x, y, 0.0]), law="compression-only", stiffness=stiffness, damping=damping,
                           direction=[0.0, 0.0, 1.0], free_length=sink))
        tyres.append(table("[[links]]", name=name.replace("wheel", "grip"), **{"from": ground([x, y, 0.0])},
                           to=place(name, [x, y, 0.0]), bushing=[2e5, 2e5, 0.0, 0.0, 0.0, 0.0],
                           bushing_damping=[2e3, 2e3, 0.0, 0.0, 0.0, 0.0]))
    lashed = []
    for name, wheel, anchor, point, tension in ropes():
        long = length(plus(point, anchor, -1))
        stiffness = ROPE_STIFFNESS / long
        lashed.append(table("[[links]]", name=name, **{"from": ground(anchor)}, to=place(wheel, point),
                            law="tension-only", stiffness=stiffness, free_length=long - tension / stiffness))
    attached = [*LUMPS, *WHEELS, *(f"bracket_{name}_{side}" for name, side in FEET)]
    join = "\n".join
    return COMMON.format(sections=join(sections), parts=join(parts), bodies="\n" + join(bodies),
                         brackets=join(brackets) + "\n", attached=", ".join(f'"{name}"' for name in attached),
                         mounts="\n" + join(mounts), tyres=join(tyres), ropes=join(lashed))


TIMBER = 0.15  # edge of the beam against the wheels
PROP = math.radians(30.0)


def held(name: str) -> list[str]:
    """What the wheels stand against."""
    made = []
    _, radius, _, _, y, stiffness, damping = WHEELS["wheel_rear_left"]
    if name == "side":
        rim = [0.0, -(y + 0.17), 0.45]
        foot = plus(rim, [0.0, math.cos(PROP), math.sin(PROP)], -0.45 / math.sin(PROP))
        return [table("[[links]]", name="prop", **{"from": ground(foot)}, to=place("wheel_rear_right", rim),
                      law="compression-only", stiffness=5e6, damping=2e4)]
    ahead = BLOWS[name][2][0]
    # Where a round tyre meets the edge of the beam that lies on the ground.
    x = ahead * math.sqrt(radius**2 - (geometry.BACKBONE_Z - TIMBER) ** 2)
    for side, sign in ("right", -1), ("left", 1):
        at = [x, sign * y, TIMBER]
        made.append(table("[[links]]", name=f"wedge_{side}", **{"from": place(f"wheel_rear_{side}", at)}, to=ground(at),
                          law="compression-only", stiffness=stiffness, damping=damping, direction=[ahead, 0.0, 0.0]))
    return made


def struck(name: str) -> str:
    now = blow(name)
    J = now["inertia"]
    six = [J[0][0], J[1][1], J[2][2], J[0][1], J[1][2], J[2][0]]
    text = [table("[[bodies]]", name="block", center=now["centre"], mass=PENDULUM, inertia=six,
                  velocity=[v * now["speed"] for v in now["normal"]], angular_velocity=now["turn"])]
    for i, (top, end, stiffness, free) in enumerate(now["chains"], 1):
        text.append(table("[[links]]", name=f"chain_{i}", **{"from": ground(top)}, to=place("block", end), law="tension-only",
                          stiffness=stiffness, damping=2e3, free_length=free))
    text += held(name)
    # bumpers, for the time being
    mesh = geometry.cab(*geometry.MESHES["cab"])
    nodes = sorted({n for g in ("roof_frame", "posts") for c in mesh.groups[g] for n in c})
    for n in nodes:
        x = mesh.nodes[n - 1]
        d = plus(x, now["face"], -1)
        depth = dot(d, now["normal"])
        if abs(dot(d, now["side"])) <= FACE / 2 and abs(dot(d, now["up"])) <= FACE / 2 and -0.05 < depth < 0.15:
            text.append(table("[[links]]", name=f"bumper_{n}", **{"from": place("block", plus(x, now["normal"], -depth))},
                              to=f'{{ node = "mesh.{n}" }}', law="compression-only", stiffness=5e6, damping=1e3,
                              direction=now["normal"], gap=max(depth - 0.03, 0.0)))
    return "\n".join(text)


def decks() -> None:
    for name in BLOWS:
        head = f'title = "Tractor with a safety cab, struck from the {name}"\n\n'
        tail = '[output]\nevery = 4\nlinks = true\nnodes = ["roof_frame", "posts"]\nfields = { format = "vtu", every = 40 }\n'
        (FOLDER / f"{name}.toml").write_text(head + common() + "\n" + struck(name) + "\n" + tail)


if __name__ == "__main__":
    if sys.argv[1:] == ["decks"]:
        decks()
