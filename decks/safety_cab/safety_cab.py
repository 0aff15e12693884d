"""The tractor of decks/safety_cab and its pendulum: writes the decks, runs them, draws the tables of the README.

    python3 decks/safety_cab/safety_cab_mesh.py             # the meshes
    python3 decks/safety_cab/safety_cab.py decks            # rear.toml, front.toml, side.toml: one tractor, three blows
    python3 decks/safety_cab/safety_cab.py run [blow ...]   # runs them and their variants; tables in Markdown on standard output

Python's standard library only.
"""

import csv
import math
import os
import sys
import tempfile
from pathlib import Path

import safety_cab_mesh as geometry
import scenes

FOLDER = geometry.FOLDER
G = 9.81

# ---- what is assumed; the decks say why ----

MASS = 3000.0  # reference mass, kg
WHEELBASE = 2.2
PENDULUM = 2000.0  # kg
FACE, DEPTH = 0.68, 0.60  # of the block
CHAIN = 6.0  # from the pivots to the centre of the block
STEEL = 7850.0
PLATES = {"floor": 0.003, "roof": 0.002, "panels": 0.002}
BOXES = {"posts": (0.050, 0.003), "sills": (0.080, 0.004), "roof_frame": (0.050, 0.003), "rails": (0.040, 0.0025)}
HOUSING, CAST_IRON = (0.18, 0.012), 7200.0  # radius, wall; density
# Mass, centre, size of a box; the engine takes what is left to the reference mass.
LUMPS = {
    "engine": (None, (1.75, 0.0, 0.95), (0.90, 0.55, 0.70)),
    "gearbox": (560.0, (0.20, 0.0, 0.78), (1.00, 0.50, 0.50)),
    "linkage": (160.0, (-0.45, 0.0, 0.75), (0.40, 0.80, 0.40)),
}
# Mass of a wheel, width, stiffness and damping of its tyre.
WHEELS = {"rear": (180.0, 0.34, 3.5e5, 3.0e3), "front": (80.0, 0.26, 2.5e5, 2.0e3)}
HUBS = {
    "rear": (0.0, geometry.REAR_HUB, geometry.BACKBONE_Z),
    "front": (WHEELBASE, geometry.FRONT_HUB, geometry.FRONT_AXLE_Z),
}
SIDES = {"right": -1, "left": 1}
ROPE_STIFFNESS = 1.0e7  # E A, N
ROPE_PULL = 8.0e3  # horizontal part of the tension, N
TIMBER = 0.15  # edge of the beam against the wheels
PROP, PROP_STIFFNESS, PROP_DAMPING = math.radians(30.0), 5e6, 2e4
CHAIN_STIFFNESS, CHAIN_DAMPING = 2.5e6, 2.0e3  # of one of four
SEAT = (0.15, 0.0, 1.52)  # seat index point
# From the seat index point: centre and size of the boxes round the clearance zone.
ZONES = {
    "zone_head": ((0.115, 0.0, 0.555), (0.55, 0.50, 0.51)),
    "zone_hands": ((0.295, 0.0, 0.150), (0.91, 0.50, 0.30)),
}
# Height of fall in m, angle of the chains in degrees, where it goes.
BLOWS = {
    "rear": (2.165e-8 * MASS * (WHEELBASE * 1e3) ** 2 * 1e-3, 20.0, (1.0, 0.0, 0.0)),
    "front": ((125 + 0.02 * MASS) * 1e-3, 20.0, (-1.0, 0.0, 0.0)),
    "side": ((125 + 0.15 * MASS) * 1e-3, 0.0, (0.0, -1.0, 0.0)),
}
# The corner of the roof whose way is called the deflection.
CORNER = {"rear": "top_rear_left", "front": "top_front_right", "side": "top_middle_left"}
GAP = 0.002  # of face and cab at t = 0
# What the block touches; the contact's stiffness and damping, of each point.
STRUCK = ["posts", "roof_frame", "roof"]
STIFFNESS, DAMPING = 3e6, 1e3


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def plus(a, b, factor=1.0):
    return [x + factor * y for x, y in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def length(a):
    return math.sqrt(dot(a, a))


def wheels() -> list[tuple[str, str, list[float]]]:
    """End, side, hub."""
    return [(end, side, [x, sign * y, z]) for end, (x, y, z) in HUBS.items() for side, sign in SIDES.items()]


def ropes() -> list[tuple[str, str, list[float], list[float], float]]:
    """Name, wheel, anchor on the ground, point of the axle, tension. All pull alike and at one height: no moment is left."""
    made = []
    for end, side, (x, y, _) in wheels():
        away, y = (-1.3 if end == "rear" else 1.3), y - math.copysign(0.2, y)
        anchor, point = [x + away, y, 0.05], [x, y, 0.55]
        tension = ROPE_PULL * length(plus(point, anchor, -1)) / abs(away)
        made.append((f"rope_{end}_{side}", f"wheel_{end}_{side}", anchor, point, tension))
    return made


def weigh() -> tuple[float, list[float], float]:
    """Mass and first moment of what the mesh holds; mass of the cab."""
    mesh = geometry.cab(*geometry.MESHES["cab"])
    mass, first, cab = 0.0, [0.0] * 3, 0.0
    for group, cells in mesh.groups.items():
        for cell in cells:
            x = [mesh.nodes[node - 1] for node in cell]
            if group in PLATES:
                part = length(cross(plus(x[2], x[0], -1), plus(x[3], x[1], -1))) / 2 * PLATES[group] * STEEL
            elif group in BOXES:
                width, wall = BOXES[group]
                part = length(plus(x[1], x[0], -1)) * (width**2 - (width - 2 * wall) ** 2) * STEEL
            elif group == "backbone":
                radius, wall = HOUSING
                part = length(plus(x[1], x[0], -1)) * math.pi * (radius**2 - (radius - wall) ** 2) * CAST_IRON
            else:
                continue
            mass, first = mass + part, plus(first, [sum(axis) / len(x) for axis in zip(*x)], part)
            cab += 0.0 if group == "backbone" else part
    return mass, first, cab


def statics() -> dict:
    """The engine's mass, where the centre of mass is, the mass of the cab, the load of each tyre of the lashed tractor."""
    mass, first, cab = weigh()
    for part, centre, _ in LUMPS.values():
        mass, first = mass + (part or 0.0), plus(first, centre, part or 0.0)
    for end, _, hub in wheels():
        mass, first = mass + WHEELS[end][0], plus(first, hub, WHEELS[end][0])
    engine = MASS - mass
    x = plus(first, LUMPS["engine"][1], engine)[0] / MASS
    load = {"rear": MASS * G * (1 - x / WHEELBASE) / 2, "front": MASS * G * x / WHEELBASE / 2}
    for _, wheel, anchor, point, tension in ropes():
        if "left" in wheel:
            load[wheel.split("_")[1]] += tension * (point[2] - anchor[2]) / length(plus(point, anchor, -1))
    return {"engine": engine, "x": x, "cab": cab, "load": load}


def radius(end: str) -> float:
    """Of a tyre without load: at rest it is flatter, by its load over its stiffness."""
    return HUBS[end][2] + statics()["load"][end] / WHEELS[end][2]


def blow(name: str) -> dict:
    """Where the block is and how it moves at t = 0."""
    height, angle, ahead = BLOWS[name]
    width = 2 * geometry.HALF_WIDTH[1]
    aim = {
        "rear": [geometry.REAR[1], width / 2 - width / 6, geometry.ROOF],
        "front": [geometry.FRONT[1], -(width / 2 - width / 6), geometry.ROOF],
        "side": [SEAT[0] + 0.06, width / 2, geometry.ROOF],
    }[name]
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    normal, up = [c * ahead[0], c * ahead[1], -s], [s * ahead[0], s * ahead[1], c]
    side = cross(up, normal)
    # The face stands clear of all posts and roof members that it covers.
    mesh = geometry.cab(*geometry.MESHES["cab"])
    nodes = {mesh.nodes[n - 1] for group in ("posts", "roof_frame") for cell in mesh.groups[group] for n in cell}
    ways = [plus(x, aim, -1) for x in nodes]
    covered = [dot(way, normal) for way in ways if max(abs(dot(way, side)), abs(dot(way, up))) < FACE / 2 + 1e-9]
    face = plus(aim, normal, min(covered) - BOXES["posts"][0] / 2 - GAP)
    centre = plus(face, normal, -DEPTH / 2)
    speed = math.sqrt(2 * G * height)
    pivot = plus(centre, up, CHAIN)
    turn = [value * speed / CHAIN for value in cross(normal, up)]
    about = [PENDULUM / 12 * m for m in (2 * FACE**2, DEPTH**2 + FACE**2, DEPTH**2 + FACE**2)]
    J = [[sum(m * e[i] * e[j] for m, e in zip(about, (normal, side, up))) for j in range(3)] for i in range(3)]
    chains = []
    for a in -1, 1:
        for b in -1, 1:
            top = plus(pivot, side, 0.30 * a)
            end = plus(plus(plus(centre, side, 0.30 * a), normal, 0.25 * b), up, FACE / 2)
            along = plus(top, end, -1)
            pull = PENDULUM * (G * c + speed**2 / CHAIN) / 4 * length(along) / dot(along, up)
            chains.append((top, end, length(along) - pull / CHAIN_STIFFNESS))
    return {
        "height": height, "angle": angle, "speed": speed, "energy": PENDULUM * G * height, "centre": centre, "turn": turn,
        "normal": normal, "side": side, "up": up, "chains": chains,
        "inertia": [J[0][0], J[1][1], J[2][2], J[0][1], J[1][2], J[2][0]],
    }  # fmt: skip


# ---- decks ----


def number(value: float) -> str:
    """Short, and with a point or an exponent: TOML's way to write a float."""
    if value and (abs(value) >= 1e5 or abs(value) < 1e-3):
        mantissa, exponent = f"{value:.8e}".split("e")
        return f"{mantissa.rstrip('0').rstrip('.')}e{int(exponent)}"
    text = f"{value:.9g}"
    return text if "." in text else text + ".0"


def vector(values) -> str:
    return "[" + ", ".join(number(v if abs(v) > 1e-12 else 0.0) for v in values) + "]"


def table(header: str, **keys) -> str:
    def value(v) -> str:
        if isinstance(v, str):
            return v if v[0] in "{[" else f'"{v}"'
        if isinstance(v, bool):
            return str(v).lower()
        return str(v) if isinstance(v, int) else number(v) if isinstance(v, float) else vector(v)

    return "\n".join([header] + [f"{key.rstrip('_')} = {value(v)}" for key, v in keys.items()]) + "\n"


def names(words) -> str:
    return "[" + ", ".join(f'"{word}"' for word in words) + "]"


def on(body: str, point) -> str:
    return f'{{ body = "{body}", point = {vector(point)} }}'


def ground(point) -> str:
    return f"{{ ground = {vector(point)} }}"


def box(centre, size, body: str | None = None, axes=None) -> str:
    words = ['shape = "box"'] + ([f'body = "{body}"'] if body else [])
    words += [f"center = {vector(centre)}", f"size = {vector(size)}"]
    return "{ " + ", ".join(words + ([f"axes = [{', '.join(map(vector, axes))}]"] if axes else [])) + " }"


def sections() -> str:
    return "\n".join(table(f"[sections.{name}]", shape="box", width=w, height=w, thickness=t) for name, (w, t) in BOXES.items())


def parts() -> str:
    made = []
    for name in BOXES:
        toward = [1.0, 0.0, 0.0] if name == "posts" else [0.0, 0.0, 1.0]
        made.append(table("[[beams]]", group=name, material="steel", section=name, orientation=toward, order=2))
    return "\n".join(made + [table("[[shells]]", group=name, thickness=t, material="steel") for name, t in PLATES.items()])


def bodies() -> str:
    made = []
    for name, (mass, centre, size) in LUMPS.items():
        shape = f'{{ kind = "box", size = {vector(size)} }}'
        made.append(table("[[bodies]]", name=name, center=centre, mass=round(mass or statics()["engine"], 1), shape=shape))
    for end, side, hub in wheels():
        mass, width, *_ = WHEELS[end]
        shape = f'kind = "tube", radius = {hub[2]:.3g}, thickness = {0.35 * hub[2]:.3g}, length = {width}, axis = [0.0, 1.0, 0.0]'
        made.append(table("[[bodies]]", name=f"wheel_{end}_{side}", center=hub, mass=mass, shape=f"{{ {shape} }}"))
    return "\n".join(made)


FEET = [(end, side, x[0], sign * geometry.HALF_WIDTH[0])
        for end, x in (("rear", geometry.REAR), ("front", geometry.FRONT)) for side, sign in SIDES.items()]  # fmt: skip


def points() -> str:
    made = [f"bracket_{end}_{side} = {vector([x, y, geometry.FLOOR])}" for end, side, x, y in FEET]
    return "\n".join(made + [f"hub_{end}_{side} = {vector(hub)}" for end, side, hub in wheels()])


def attached() -> str:
    spots = [*LUMPS] + [f"{kind}_{end}_{side}" for kind in ("wheel", "hub") for end, side, _ in wheels()]
    return names(spots + [f"bracket_{end}_{side}" for end, side, *_ in FEET])


def mounts() -> str:
    return "\n".join(
        table("[[links]]", name=f"mount_{end}_{side}", from_=f'{{ node = "bracket_{end}_{side}" }}',
              to=f'{{ node = "foot_{end}_{side}" }}', bushing=[6e6, 6e6, 8e6, 2e4, 2e4, 2e4],
              bushing_damping=[6e3, 6e3, 8e3, 20.0, 20.0, 20.0])
        for end, side, *_ in FEET
    )  # fmt: skip


def tyres() -> str:
    made = []
    for end, (_, _, stiffness, damping) in WHEELS.items():
        made.append(table("[[contacts]]", name=f"tyres_{end}",
                          surface='{ shape = "plane", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }',
                          with_=names([f"hub_{end}_right", f"hub_{end}_left"]), radius=radius(end), stiffness=stiffness,
                          damping=damping, friction=0.7))  # fmt: skip
    return "\n".join(made)


def lashing() -> str:
    made = []
    for name, wheel, anchor, point, tension in ropes():
        long = length(plus(point, anchor, -1))
        stiffness = ROPE_STIFFNESS / long
        made.append(table("[[links]]", name=name, from_=ground(anchor), to=on(wheel, point), law="tension-only",
                          stiffness=float(f"{stiffness:.4g}"), free_length=long - tension / float(f"{stiffness:.4g}")))  # fmt: skip
    return "\n".join(made)


def zones() -> str:
    return "\n".join(
        table("[[contacts]]", name=name, surface=box(plus(SEAT, centre), size, body="gearbox"),
              with_=names(["posts", "roof_frame", "rails", "roof", "panels"]), stiffness=0.0)
        for name, (centre, size) in ZONES.items()
    )  # fmt: skip


COMMON = """\
# {title}
#
# A test of the pendulum for tractors and their safety cabs, as OECD Code 3 and directive 86/298/EEC have it: a block of
# 2000 kg on chains swings into the upper edge of the cab, the tractor being lashed to the ground. One tractor, three decks
# (rear.toml, front.toml, side.toml), written by decks/safety_cab/safety_cab.py; each is a fresh tractor.
#
# This blow: {what}
#
# Assumptions. Code: heights of fall, block, chains' angle (m/100 degrees, at most 20; the side: none), the face centred
# on the upper edge, a sixth of the width from its end (the side: 60 mm ahead of the seat index point), a beam of timber
# against the rear wheels or a prop at 30 degrees against the rim, ropes at less than 30 degrees at both ends of both axles.
# The tractor is made up: {mass:.0f} kg, wheelbase 2.2 m, {rear:.0f} % of the weight on the rear axle. Its engine, gearbox and axle
# housings are bolted together, as one backbone, with the masses of engine, gearbox and linkage on it; brakes hold the
# wheels. The cab ({cab:.0f} kg without glass and fittings) is of cold formed box sections and sheet of steel, yield stress
# 275 MPa, hardening 1 GPa, rate as Cowper and Symonds have it for mild steel (40.4/s, 5). Glass and doors give no strength.
# Joints are rigid; nothing breaks. Tyres: balls of the wheels' radius, linear, that rub on the ground. Mounts: rubber,
# linear, so stiff as if their stops were met. Ropes: wire, 15 mm, E A = 1e7 N, {pull:.1f} kN each. Damping: of mounts, tyres,
# chains and prop; none in the steel.
# The clearance zone is two boxes round it: behind, over and beside the driver, and forward to the wheel.
#
# At t = 0 the block is {gap:.0f} mm from the cab, at the speed of its fall; tyres, ropes and chains carry what they carry at
# rest. Left alone, the tractor moves by 0.04 mm and the roof sags by 0.2 mm.
#
# A rigid tractor is one word: `rigid = true` in the backbone; take it out and it bends. So is another mesh:
# --set mesh.file=cab_fine.msh, or cab_coarse.msh.

title = "{title}"

[analysis]
kind = "dynamic"
end_time = 0.6
time_step = 5e-4

[iteration]
tolerance = 1e-5                      # of forces of 50 kN; the mesh leaves 1e-2

[mesh]
file = "cab.msh"

[environment]
gravity = [0.0, 0.0, -9.81]

# ---- the cab ----

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
orientation = [1.0, 0.0, 1.0]         # round: any direction that none of its beams has
order = 2
rigid = true

{bodies}
[points]
{points}

[[attachments]]
beam = "backbone"
nodes = {attached}

# Rubber mounts at the corners of the floor.

{mounts}
# Tyres, by their radius without load: at rest the hubs are as high as they are drawn.

{tyres}
# Ropes from the ground to the axles.

{ropes}
# ---- the clearance zone ----

{zones}
"""

OUTPUT = """\
[sets]
tops = {tops}

[output]
every = 2
nodes = "tops"
links = true
contacts = true
fields = {{ format = "vtu", every = 20 }}
"""


def held(name: str) -> str:
    """What the wheels stand against."""
    if name == "side":
        x, y, z = HUBS["rear"]
        rim = [x, -(y + WHEELS["rear"][1] / 2), 0.45]
        foot = plus(rim, [0.0, math.cos(PROP), math.sin(PROP)], -rim[2] / math.sin(PROP))
        text = "# A prop from the ground to the rim of the rear wheel on the other side.\n\n"
        return text + table("[[links]]", name="prop", from_=ground(foot), to=on("wheel_rear_right", rim), law="compression-only",
                            stiffness=PROP_STIFFNESS, damping=PROP_DAMPING)  # fmt: skip
    ahead = BLOWS[name][2][0]
    r, (_, _, stiffness, damping) = radius("rear"), WHEELS["rear"]
    # The edge of the beam touches the tyre.
    x = ahead * (math.sqrt(r**2 - (HUBS["rear"][2] - TIMBER) ** 2) + TIMBER / 2)
    where = "in front of" if ahead > 0 else "behind"
    text = f"# A beam of timber on the ground, {where} the rear wheels.\n\n"
    return text + table("[[contacts]]", name="timber", surface=box([x, 0.0, TIMBER / 2], [TIMBER, 2.6, TIMBER]),
                        with_=names(["hub_rear_right", "hub_rear_left"]), radius=r, stiffness=stiffness, damping=damping,
                        friction=0.6)  # fmt: skip


def hull(centre, size, axes) -> str:
    """The shape of a body, a box that stands askew."""
    corners = [centre]
    for edge, axis in zip(size, axes):
        corners = [plus(corner, axis, sign * edge / 2) for corner in corners for sign in (-1, 1)]
    return f'{{ kind = "hull", points = [{", ".join(map(vector, corners))}] }}'


def pendulum(name: str, faces: bool = False) -> str:
    """The block on its chains. It touches points of the cab; with `faces` faces of the roof and lines of frame and posts."""
    now, size = blow(name), [DEPTH, FACE, FACE]
    shape = {"shape": hull(now["centre"], size, [now[axis] for axis in ("normal", "side", "up")])} if faces else {}
    velocity = [v * now["speed"] for v in now["normal"]]
    made = [table("[[bodies]]", name="block", center=now["centre"], mass=PENDULUM, inertia=now["inertia"], velocity=velocity,
                  angular_velocity=now["turn"], **shape)]  # fmt: skip
    for i, (top, end, free) in enumerate(now["chains"], 1):
        made.append(table("[[links]]", name=f"chain_{i}", from_=ground(top), to=on("block", end), law="tension-only",
                          stiffness=CHAIN_STIFFNESS, damping=CHAIN_DAMPING, free_length=free))  # fmt: skip
    if faces:
        # Nodes and crossings: half as many as points along a line, each twice as stiff. At the top of a post both post and frame press.
        made += [table("[[contacts]]", name=f"blow_{part}", surface=f'{{ part = "{part}" }}', with_="block",
                       stiffness=2 * STIFFNESS, damping=2 * DAMPING, friction=0.3) for part in STRUCK]  # fmt: skip
    else:
        surface = box(now["centre"], size, body="block", axes=(now["normal"], now["side"]))
        made.append(table("[[contacts]]", name="blow", surface=surface, with_=names(STRUCK), points=1, stiffness=STIFFNESS,
                          damping=DAMPING, friction=0.3))  # fmt: skip
    return "\n".join(made)


# Where the corner goes the farthest over ground, by cab_fine.msh and half the step. This mesh and step are off by up to 0.4 %.
EXPECTED = {"rear": ("ux", "max", 0.18832), "front": ("ux", "min", -0.11739), "side": ("uy", "min", -0.22291)}


def expected(name: str) -> str:
    energy = BLOWS[name][0] * PENDULUM * G
    quantity, peak, value = EXPECTED[name]
    made = [table("[[expect]]", at=CORNER[name], quantity=quantity, peak=peak, value=value, tolerance=0.01,
                  source="this program, cab_fine.msh, half the step: 0.4 % off at most")]  # fmt: skip
    for zone in ZONES:
        made.append(table("[[expect]]", at=zone, quantity="gap", at_least=0.0, source="OECD Code 3: nothing enters the zone"))
    made.append(table("[[expect]]", at="energy", quantity="numerical", peak="abs", value=0.0,
                      absolute_tolerance=float(round(0.01 * energy)), source="a hundredth of the blow"))
    return "# ---- expected ----\n\n" + "\n".join(made)


def write_decks() -> None:
    rest = statics()
    for name, (height, angle, _) in BLOWS.items():
        speed = math.sqrt(2 * G * height)
        formula = {"rear": "2.165e-8 m L^2", "front": "125 + 0.02 m", "side": "125 + 0.15 m"}[name]
        what = f"from the {name}, H = {formula} = {height * 1e3:.0f} mm, {speed:.2f} m/s,\n# "
        what += f"{PENDULUM * G * height:.0f} J; chains at {angle:.0f} degrees."
        share = (1 - rest["x"] / WHEELBASE) * 100
        text = COMMON.format(
            title=f"A tractor with a safety cab, struck from the {name} by the pendulum", what=what, mass=MASS, rear=share,
            cab=rest["cab"], pull=ropes()[0][4] / 1e3, gap=GAP * 1e3, sections=sections(), parts=parts(), bodies=bodies(),
            points=points(), attached=attached(), mounts=mounts(), tyres=tyres(), ropes=lashing(), zones=zones(),
        )  # fmt: skip
        tops = names(f"top_{end}_{side}" for end in ("rear", "middle", "front") for side in SIDES)
        blocks = [text + "# ---- the pendulum ----\n", pendulum(name), held(name), expected(name), OUTPUT.format(tops=tops)]
        (FOLDER / f"{name}.toml").write_text("\n".join(blocks))


# ---- runs ----


def column(path: Path, key: str, name: str, *columns: str) -> list[list[float]]:
    """[[time, ...]] of one name in a file of rows."""
    with path.open(newline="") as file:
        return [[float(row[c]) for c in ("time", *columns)] for row in csv.DictReader(file) if row[key] == name]


def deflection(folder: Path, name: str) -> tuple[list[float], list[float]]:
    """Times, and how far the struck corner has moved along the blow, seen from the tractor."""
    mesh_nodes = column_of_corner(folder, name)
    body = column(folder / "bodies.csv", "body", "gearbox", "x", "y", "z", "qw", "qx", "qy", "qz")
    ahead = BLOWS[name][2]
    local = []
    for (_, *x), (_, *seat) in zip(mesh_nodes, body):
        R = scenes.rotation(dict(zip(("qw", "qx", "qy", "qz"), seat[3:])))  # by columns
        local.append([dot(axis, plus(x, seat[:3], -1)) for axis in R])
    return [row[0] for row in body], [dot(plus(x, local[0], -1), ahead) for x in local]


def column_of_corner(folder: Path, name: str) -> list[list[float]]:
    """The corner goes by its number in the mesh: it is the node of `tops` that starts there."""
    end, side = CORNER[name].split("_")[1:]
    place = {"rear": geometry.REAR, "middle": geometry.MIDDLE, "front": geometry.FRONT}[end]
    start = [place[1], SIDES[side] * geometry.HALF_WIDTH[1], geometry.ROOF]
    with (folder / "nodes.csv").open(newline="") as file:
        for row in csv.DictReader(file):
            if length(plus([float(row[c]) for c in "xyz"], start, -1)) < 1e-6:
                return column(folder / "nodes.csv", "node", row["node"], "x", "y", "z")
    raise ValueError("the corner is not in nodes.csv")


def dampers(folder: Path, links: list[str], stiffness: float) -> float:
    """What the dampers of one-sided links have taken: the force beyond that of the spring, times the rate."""
    taken = 0.0
    for link in links:
        rows = column(folder / "links.csv", "link", link, "elongation", "rate", "force")
        power = [(force - stiffness * way) * rate if force else 0.0 for _, way, rate, force in rows]
        taken += sum((b[0] - a[0]) * (p + q) / 2 for a, b, p, q in zip(rows, rows[1:], power, power[1:]))
    return taken


def with_faces(name: str, path: Path) -> Path:
    """Writes the deck of a blow, but that the block touches faces and lines."""
    text, points = (FOLDER / f"{name}.toml").read_text(), pendulum(name)
    if points not in text:
        raise ValueError(f"{name}.toml is not as this script writes it")
    text = text.replace(points, pendulum(name, faces=True))
    path.write_text(text.replace('file = "cab.msh"', f'file = "{FOLDER / "cab.msh"}"'))
    return path


def force_of_block(folder: Path, faces: bool) -> float:
    """The largest."""
    contacts = [f"blow_{part}" for part in STRUCK] if faces else ["blow"]
    each = [column(folder / "contacts.csv", "contact", name, "fx", "fy", "fz") for name in contacts]
    return max(length([sum(axis) for axis in zip(*at)][1:]) for at in zip(*each))


def measure(name: str, sets: list[str], folder: Path, threads: int = 1, faces: bool = False) -> dict:
    deck = with_faces(name, folder.with_suffix(".toml")) if faces else FOLDER / f"{name}.toml"
    before = os.times().children_user
    # Variants may miss the deck's deflection: that is what they are for.
    run = scenes.run(deck, [*sets, "expect.0.tolerance=0.2"], folder, threads)
    user_s = os.times().children_user - before
    times, way = deflection(folder, name)
    peak = max(way)
    with (folder / "energy.csv").open(newline="") as file:
        energy = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    mounts = [
        max(length(f) for _, *f in column(folder / "links.csv", "link", f"mount_{end}_{side}", "fx", "fy", "fz"))
        for end, side, *_ in FEET
    ]
    gaps = [min(gap for _, gap in column(folder / "contacts.csv", "contact", zone, "gap")) for zone in ZONES]
    last = times[-1]
    taken = {"chains": dampers(folder, [f"chain_{i}" for i in range(1, 5)], CHAIN_STIFFNESS)}
    taken["prop"] = dampers(folder, ["prop"], PROP_STIFFNESS)
    taken["mounts"] = energy[-1]["damping"] - taken["chains"] - taken["prop"]
    block = column(folder / "bodies.csv", "body", "block", "vx", "vy", "vz")[-1][1:]
    return {
        "taken": taken, "block": PENDULUM / 2 * dot(block, block),
        "peak": peak, "at": times[way.index(peak)], "start": energy[0], "end": energy[-1], "mounts": mounts, "gap": min(gaps),
        "force": force_of_block(folder, faces),
        "set": (lambda tail: sum(tail) / len(tail))([w for t, w in zip(times, way) if t > last - 0.1]),
        "numerical": max(abs(row["numerical"]) for row in energy), "user_s": user_s, "counts": run.report["counts"],
    }  # fmt: skip


VARIANTS = {
    "as it is": [],
    "half the step": ["analysis.time_step=2.5e-4"],
    "cab_coarse.msh": ['mesh.file="cab_coarse.msh"'],
    "cab_fine.msh": ['mesh.file="cab_fine.msh"'],
    "backbone that bends": ["beams.backbone.rigid=false"],
    "rigid floor": ["shells.floor.rigid=true"],
    "rigid roof": ["shells.roof.rigid=true"],
    "three times as stiff a contact": [f"contacts.blow.stiffness={3 * STIFFNESS}"],
}
FACES = {
    "faces and edges": [],
    "faces and edges, three times as stiff": [f"contacts.blow_{part}.stiffness={6 * STIFFNESS}" for part in STRUCK],
}


def run_all(blows: list[str]) -> None:
    scenes.build()
    with tempfile.TemporaryDirectory() as folder:
        out, all_ = Path(folder) / "out", (VARIANTS | FACES).items()
        found = {(b, v): measure(b, sets, out, faces=v in FACES) for b in blows for v, sets in all_}
    print("| blow | H, speed, energy | deflection at | set | least gap to the zone | largest force of the block | of the mounts |")
    print("|---|---|---|---|---|---|---|")
    for b in blows:
        of, now = found[b, "as it is"], blow(b)
        mounts = ", ".join(f"{f / 1e3:.0f}" for f in of["mounts"])
        print(f"| {b} | {now['height'] * 1e3:.0f} mm, {now['speed']:.2f} m/s, {now['energy'] / 1e3:.2f} kJ | {of['peak'] * 1e3:.0f} mm"
              f" at {of['at']:.3f} s | {of['set'] * 1e3:.0f} mm | {of['gap'] * 1e3:.0f} mm"
              f" | {of['force'] / 1e3:.0f} kN | {mounts} kN |")  # fmt: skip
    print("\nJoule, at the end; what is stored, less that at the start:\n")
    lost, kept = ["plastic", "viscoplastic", "friction", "impact"], ["strain", "links", "contact"]
    dampers_of = ["mounts", "chains", "prop"]
    words = lost + [f"dampers of {word}" for word in dampers_of] + ["the block moves on", "kinetic, the rest", *kept, "work of gravity"]
    print(f"| blow | energy | {' | '.join(words)} | numerical, largest |")
    print("|---|---|" + "---|" * (len(words) + 1))
    for b in blows:
        of, energy = found[b, "as it is"], blow(b)["energy"]
        values = [of["end"][word] for word in lost] + [of["taken"][word] for word in dampers_of]
        values += [of["block"], of["end"]["kinetic"] - of["block"]]
        # Tyres, ropes and chains are under load from the start.
        values += [of["end"][word] - of["start"][word] for word in kept + ["external"]]
        row = " | ".join(f"{value:.0f}" for value in values)
        print(f"| {b} | {energy:.0f} | {row} | {of['numerical']:.0f} ({of['numerical'] / energy * 100:.2f} %) |")
    print("\nDeflection, set; change of the deflection; largest force of the block; largest numerical loss; user time:\n")
    print(f"| variant | {' | '.join(blows)} |")
    print("|---|" + "---|" * len(blows))
    for v in VARIANTS | FACES:
        cells = []
        for b in blows:
            of, base = found[b, v], found[b, "as it is"]
            change = f"; {(of['peak'] / base['peak'] - 1) * 100:+.1f} %" if of is not base else ""
            cells.append(f"{of['peak'] * 1e3:.1f}, {of['set'] * 1e3:.1f} mm{change}; {of['force'] / 1e3:.0f} kN;"
                         f" {of['numerical']:.0f} J; {of['user_s']:.1f} s")  # fmt: skip
        print(f"| {v} | {' | '.join(cells)} |")


if __name__ == "__main__":
    match sys.argv[1:]:
        case ["decks"]:
            write_decks()
        case ["run", *blows]:
            run_all(blows or list(BLOWS))
        case _:
            sys.exit(__doc__)
