"""The scenes of scripts/accuracy_asked.py: where a run begins, which equal steps stand beside it, and the reference."""

from typing import NamedTuple

from scenes import SCENES


class Motion(NamedTuple):
    """A deck and its settings, as overrides."""

    deck: str
    interval: float
    """Between times of output; 0 for those of the deck."""
    begin: tuple[str, ...] = ()
    """The run by `accuracy`."""
    fine: tuple[str, ...] = ()
    """The reference."""
    check: tuple[str, ...] = ()
    """A coarser reference; its difference tells how well the reference is known."""
    scheme: str = "esdirk3"
    meshes: tuple[tuple[str, ...], ...] = ((),)
    """Of equal steps."""
    schemes: tuple[str, ...] = ("wilson-theta", "esdirk3")
    common: tuple[str, ...] = ()
    """Of all runs."""


def beams(name: str, begin: tuple[int, int], meshes: tuple, fine: tuple[int, int, int]) -> Motion:
    """A scene of beams; meshes are elements and order, the reference also has steps in an interval."""
    scene = SCENES[name]
    elements, order, division = fine
    esdirk3 = 'integrator={scheme="esdirk3"}'
    reference = (*scene.mesh(elements, order), *scene.step(division), esdirk3)
    coarser = (*scene.mesh(elements, order), *scene.step(division // 2), esdirk3)
    ladder = tuple(tuple(scene.mesh(*mesh)) for mesh in meshes)
    return Motion(f"decks/{scene.folder}/deck.toml", scene.interval, tuple(scene.mesh(*begin)), reference, coarser, meshes=ladder)


def bodies(name: str) -> Motion:
    scene = SCENES[name]
    automatic = ('analysis.time_step="auto"', 'integrator={scheme="runge-kutta"}')
    fine, check = ((*automatic, f"analysis.error_tolerance={tolerance}") for tolerance in (1e-9, 1e-7))
    schemes = ("wilson-theta", "esdirk3", "runge-kutta")
    return Motion(f"decks/{scene.folder}/deck.toml", scene.interval, (), fine, check, "runge-kutta", schemes=schemes)


DEFAULT = "wilson-theta"
"""The scheme of decks that give none, as choosing.md advises where contact or yielding makes motion that is not smooth."""

MOTIONS = {
    **{name: bodies(name) for name in ("R1", "R2", "R3")},
    "B1": beams("B1", (1, 2), ((1, 3), (1, 4), (2, 3), (2, 4)), (8, 4, 64)),
    "B2": beams("B2", (1, 2), ((1, 2), (1, 3), (1, 4), (2, 3)), (4, 4, 64)),
    "C1": beams("C1", (1, 2), ((1, 2), (1, 3), (1, 4), (2, 3)), (4, 4, 64)),
    "C2": beams("C2", (1, 2), ((1, 3), (1, 4), (2, 3), (2, 4)), (4, 4, 64)),
    "C4": beams("C4", (1, 3), ((3, 3), (4, 3), (8, 3), (16, 3)), (32, 3, 16))._replace(scheme=DEFAULT),
}


def patches(sizes: dict[str, tuple[int, int]], times: float) -> tuple[str, ...]:
    """Overrides for so many times the elements of patches of shells."""
    return tuple(f"shells.{name}.elements=[{int(a * times)}, {int(b * times)}]" for name, (a, b) in sizes.items())


def small_steps(interval: float, division: int) -> tuple[str, ...]:
    return (f"analysis.time_step={interval / division!r}", 'integrator={scheme="esdirk3"}')


def shells(deck: str, interval: float, sizes: dict[str, tuple[int, int]], division: int, common: tuple[str, ...] = ()) -> Motion:
    """A scene of shells from a coarse mesh."""
    fine, check = ((*patches(sizes, 4), *small_steps(interval, n)) for n in (division, division // 2))
    meshes = tuple(patches(sizes, times) for times in (1, 2, 3))
    return Motion(deck, interval, patches(sizes, 1), fine, check, meshes=meshes, common=common)


def alone(deck: str, interval: float, division: int, common: tuple[str, ...] = (), meshes: tuple = ((),), finest: tuple[str, ...] = ()) -> Motion:
    """A scene with these meshes; the run by `accuracy` begins with the first."""
    fine, check = ((*finest, *small_steps(interval, n)) for n in (division, division // 2))
    return Motion(deck, interval, meshes[0], fine, check, meshes=meshes, common=common)


def frame(elements: tuple[int, int, int], order: int) -> tuple[str, ...]:
    return (f"beams.frame.elements={list(elements)}", f"beams.frame.order={order}")


def blow(elements: tuple[int, int], order: int) -> tuple[str, ...]:
    names = zip(("outside", "charge"), elements)
    return tuple(entry for name, count in names for entry in (f"beams.{name}.elements={count}", f"beams.{name}.order={order}"))


CYLINDER = {name: (4, 2) for name in ("q1", "q2", "q3", "q4")}
PANEL = {"first": (4, 4), "second": (4, 2), "third": (4, 2)}
# Lee's frame under a sudden load above its limit load, with mass and damping.
SNAPS = (
    'analysis={kind="dynamic", end_time=15.0, time_step=0.1}',
    "sections.strip.mass_per_length=1e-3",
    "sections.strip.inertia_per_length=[1e-4, 1e-4, 1e-4]",
    "damping={alpha=0.5}",
)

PLATE = tuple((f"shells.plate.elements={n}",) for n in (3, 6, 9))
BLADE = tuple((f"beams.blade.elements={n}", f"beams.blade.order={k}") for n, k in ((1, 2), (1, 3), (1, 4), (2, 3)))
FRAME = tuple(frame(*mesh) for mesh in (((1, 1, 1), 2), ((1, 1, 1), 4), ((2, 1, 2), 3), ((2, 1, 2), 4)))
BEAM = tuple(blow(*mesh) for mesh in (((4, 1), 3), ((8, 2), 3), ((16, 4), 3)))

MOTIONS |= {
    "shell": shells("decks/tossed_cylinder/deck.toml", 0.02, CYLINDER, 8, ("analysis.end_time=1.0",)),
    "yielding shell": shells("decks/struck_panel/smooth/deck.toml", 2e-5, PANEL, 8, ("analysis.end_time=6e-4",)),
    "contact": alone("decks/ball_on_free_plate/deck.toml", 1e-3, 64, (), PLATE, ("shells.plate.elements=12",))._replace(scheme=DEFAULT),
    "loop": alone("decks/andrews_squeezer/deck.toml", 6e-4, 256),
    "rotor": alone("decks/rotating_blade/deck.toml", 0.06, 128, ("analysis.end_time=3.0",), BLADE, ("beams.blade.elements=4", "beams.blade.order=4")),
    "X2": alone("decks/extreme/stiff_pendulum/deck.toml", 0.2066761, 512),
    "cable": alone("decks/caught_by_a_rope/deck.toml", 0.032, 512),
    "earthquake": alone("decks/isolated_building/deck.toml", 0.02, 64),
    "tumbling": alone("decks/heavy_top/deck.toml", 0.01, 256)._replace(scheme="runge-kutta", schemes=("wilson-theta", "esdirk3", "runge-kutta")),
    "snap-through": alone("decks/lees_frame/deck.toml", 0.1, 32, SNAPS, FRAME, frame((8, 2, 8), 4)),
    "blow": alone("decks/clamped_beam_impulse/deck.toml", 1e-5, 32, (), BEAM, blow((32, 8), 3))._replace(scheme=DEFAULT),
}


def loads(deck: str, begin: tuple[str, ...], fine: tuple[str, ...], common: tuple[str, ...] = ()) -> Motion:
    """A scene of load steps with the output of its deck."""
    return Motion(f"decks/{deck}/deck.toml", 0.0, begin, fine, common=common)


STATICS = {
    "frame": loads("princeton_beam", ("beams.0.elements=1", "beams.0.order=1"), ("beams.0.elements=16", "beams.0.order=4")),
    "plastic beam": loads(
        "plastic_collapse",
        ("analysis.time_step=0.1", "beams.0.elements=1"),
        ("analysis.time_step=0.02", "beams.0.elements=96"),
        ("analysis.end_time=0.8",),
    ),
    "stop": loads("tip_on_stop", (), ("contacts.0.stiffness=1e9", "beams.0.elements=4")),
    "hemisphere": loads("pinched_hemisphere", ("shells.0.elements=4",), ("shells.0.elements=48",), ("analysis.time_step=80.0",)),
}
