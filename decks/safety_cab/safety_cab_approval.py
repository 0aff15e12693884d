"""Writes decks/safety_cab/approval.toml: the three blows, a crushing test and the pull of the belts on one cab, by stages.

    python3 decks/safety_cab/safety_cab.py decks            # first: rear.toml, front.toml, side.toml, from which this one is made
    python3 decks/safety_cab/safety_cab_approval.py         # approval.toml

Python's standard library only.
"""

import re
import tomllib

import safety_cab_mesh as geometry

BLOWS = ["rear", "front", "side"]
# Name, duration, time or load step. Between two blows the tractor comes to rest.
STAGES = {
    "rear": (0.4, 5e-4),
    "rest_rear": (0.1, 0.02),
    "front": (0.35, 5e-4),
    "rest_front": (0.1, 0.02),
    "side": (0.4, 5e-4),
    "rest_side": (0.1, 0.02),
    "crush": (1.0, 0.02),
    "belts": (0.1, 0.02),
}
# The pendulum is moved back by what the blows before have bent the cab towards it, and a little.
MOVED = {"rear": [0.0, 0.0, 0.0], "front": [0.09, 0.0, 0.0], "side": [0.0, 0.04, 0.0]}
CRUSH = 20.0 * 3000.0  # N, 20 N for each kg of the reference mass

HEAD = """# A tractor with a safety cab: the whole approval in one deck
#
# The cab of rear.toml, front.toml and side.toml takes all three blows one after the other, is crushed by a beam across its roof
# with 20 N for each kilogram of the tractor, and then holds the pull of a seat belt at the feet of its middle posts. What one
# stage bends, the next one finds; between two blows a static stage brings the tractor to rest, as the test does, and the pendulum is
# placed anew. Written by decks/safety_cab/safety_cab_approval.py.
#
# Beside what the three decks assume: two doors, rigid, 28 kg each, hang on the front posts with hinges that turn from 0 to 1.4 rad and
# rub, and on a latch that tears at 6 kN; the bolts of the mounts tear at 90 kN of tension or 70 kN of shear. A belt pulls with 2.5 kN forward and as much
# upward on either side. Doors give the cab no strength: they carry their weight, and what the latch holds.

title = "A tractor with a safety cab: three blows, crushing and belts"

"""

DOOR = """
[[bodies]]
name = "door_{side}"
center = [0.725, {y}, 1.85]
mass = 28.0
shape = {{ kind = "box", size = [0.6, 0.03, 1.2] }}

[[joints]]
name = "hinge_{side}"
kind = "revolute"
axis = [0.0, 0.0, {sign}]
from = {{ node = "foot_front_{side}" }}
to = {{ body = "door_{side}" }}
limits = [0.0, 1.4]
limit_stiffness = 2e4
restitution = 0.3
friction_moment = 3.0

[[links]]
name = "latch_{side}"
from = {{ body = "door_{side}", point = [0.425, {y}, 1.85] }}
to = {{ node = "foot_middle_{side}" }}
bushing = [5e6, 5e6, 5e6, 0.0, 0.0, 0.0]
bushing_damping = [500.0, 500.0, 500.0, 0.0, 0.0, 0.0]
failure = {{ normal = 6e3, shear = 6e3 }}
"""

CRUSHING = """
# ---- the crushing test: a beam that a press drives down until it carries the force ----

[[bodies]]
name = "beam"
center = [0.85, 0.0, 2.9]
mass = 300.0
inertia = [50.0, 10.0, 50.0]

[[supports]]
at = "beam"
fix = ["ux", "uy", "rx", "ry", "rz"]

[[supports]]
at = "beam"
fix = "uz"
stages = {others}

[[supports]]
name = "ram"
at = "beam"
motion = {{ uz = {{ scale = -0.4 }} }}
stages = "crush"

[[contacts]]
name = "press"
surface = {{ shape = "box", body = "beam", center = [0.85, 0.0, 2.9], size = [0.25, 2.0, 0.25] }}
with = ["posts", "roof_frame", "roof"]
points = 1
stiffness = 3e6
stages = "crush"

# ---- the belts ----

[[loads]]
name = "belts"
at = ["foot_middle_left", "foot_middle_right"]
force = [2500.0, 0.0, 2500.0]
stages = "belts"
"""

OUTPUT = """
[sets]
tops = ["top_rear_right", "top_rear_left", "top_middle_right", "top_middle_left", "top_front_right", "top_front_left"]

[output]
every = 4
nodes = "tops"
links = true
contacts = true
joints = true
reactions = true
fields = { format = "vtu", every = 20 }
"""

# At, quantity, when, the value with cab_fine.msh, tolerance: what that mesh and half the steps change, 1.1 and 0.2 %, and a little.
EXPECTED = [
    ("top_rear_left", "ux", 'stage = "rear"\npeak = "max"', 0.18802, 0.015),
    ("top_front_right", "ux", 'stage = "front"\npeak = "min"', -0.0940, 0.015),
    ("top_middle_left", "uy", 'stage = "side"\npeak = "min"', -0.21908, 0.015),
    ("top_front_left", "uz", 'stage = "crush"\npeak = "min"', -0.051746, 0.015),
]
ZONES = """
[[expect]]
at = "zone_head"
quantity = "gap"
at_least = 0.0
source = "OECD Code 3: nothing enters the zone, neither by blows nor by crushing"

[[expect]]
at = "zone_hands"
quantity = "gap"
at_least = 0.0
source = "OECD Code 3: nothing enters the zone, neither by blows nor by crushing"

# Four stages of motion and their blows of 6.2, 3.6 and 11.3 kJ.
[[expect]]
at = "energy"
quantity = "numerical"
peak = "abs"
value = 0.0
absolute_tolerance = 210.0
source = "a hundredth of the blows"
"""


def listed(names: list[str]) -> str:
    return "[" + ", ".join(f'"{name}"' for name in names) + "]"


def part(text: str, begin: str, end: str) -> str:
    return text.split(begin, 1)[1].split(end, 1)[0]


def pendulum(blow: str, text: str) -> str:
    """The pendulum of one blow and what props the tractor, there in its stage alone."""
    own = part(text, "# ---- the pendulum ----\n", "# ---- expected ----")
    block, prop = own.split("# A ", 1)

    def move(found: re.Match) -> str:
        x = tomllib.loads("x = " + found.group(2))["x"]
        return found.group(1) + str([round(a + b, 9) for a, b in zip(x, MOVED[blow])])

    block = re.sub(r"((?:center|ground|point) = )(\[[^\]]*\])", move, block)
    own = (block + "# A " + prop).replace('"block"', f'"block_{blow}"')
    own = re.sub(r'name = "(chain_\d|blow|timber|prop)"', rf'name = "\1_{blow}"\nstages = "{blow}"', own)
    # It hangs where it is until its stage, which lets it go with the speed of its fall.
    rates = re.search(r"velocity = (\[.*\])\nangular_velocity = (\[.*\])\n", own)
    own = own.replace(rates.group(0), "")
    return f"""# ---- the pendulum: {blow} ----
{own.rstrip()}

[[initial]]
at = "block_{blow}"
velocity = {rates.group(1)}
angular_velocity = {rates.group(2)}
stages = "{blow}"

[[supports]]
at = "block_{blow}"
fix = "all"
stages = {listed([stage for stage in STAGES if stage != blow])}

"""


def stage(name: str) -> str:
    duration, step = STAGES[name]
    kind = "dynamic" if name in BLOWS else "static"
    stop = f'stop = {{ load = "ram", force = {CRUSH} }}\n' if name == "crush" else ""
    return f'[[stages]]\nname = "{name}"\nkind = "{kind}"\nduration = {duration}\ntime_step = {step}\n{stop}\n'


def expected(at: str, quantity: str, when: str, value: float, tolerance: float) -> str:
    source = "this program, cab_fine.msh"
    return f"""
[[expect]]
at = "{at}"
quantity = "{quantity}"
{when}
value = {value}
tolerance = {tolerance}
source = "{source}"
"""


def main() -> None:
    decks = {blow: (geometry.FOLDER / f"{blow}.toml").read_text() for blow in BLOWS}
    tractor = part(decks["side"], "[iteration]", "# ---- the pendulum ----")
    tractor = re.sub(r"(bushing_damping = .*\n)", r"\1failure = { normal = 90e3, shear = 70e3 }\n", tractor)
    text = HEAD + "".join(stage(name) for name in STAGES) + "[iteration]" + tractor
    text += "# ---- the doors ----\n"
    for side, y in (("left", 0.7), ("right", -0.7)):
        text += DOOR.format(side=side, y=y, sign=1.0 if y > 0 else -1.0)
    text += "\n" + "".join(pendulum(blow, decks[blow]) for blow in BLOWS)
    text += CRUSHING.format(others=listed([name for name in STAGES if name != "crush"])).lstrip()
    text += OUTPUT
    text += "\n# ---- expected ----\n" + "".join(expected(*row) for row in EXPECTED) + ZONES
    (geometry.FOLDER / "approval.toml").write_text(text)


if __name__ == "__main__":
    main()
