#!/usr/bin/env python3
"""Random scenes against independent programs: scripts/differential.py PROGRAM [--scenes N] [--seed S] [--only TEXT]

Frames and trusses against OpenSees (package openseespy), mechanisms against Exudyn (package exudyn). Both programs compute each scene
twice, with meshes and steps halved together; differences are those of the values extrapolated from the two, relative to the largest
value of that quantity in the scene. Each pair also says how far a program's own two answers are apart: `left` is what both programs
leave of that once extrapolated, and a scene passes where its difference is below that and a floor. What does not pass is computed
again with shorter steps and finer meshes, and what does not pass then is kept with its deck. The script makes its own environment in target/differential; where a program cannot be had, its scenes are left out in words.
"""

import argparse
import importlib
import os
import random
import subprocess
import sys
import time
import warnings
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
HOME = ROOT / "target" / "differential"
NEEDED = ["numpy", "openseespy", "exudyn"]

# What extrapolation leaves of the difference between a program's two answers: a third with plain second order and nothing
# extrapolated; half of that is asked, since orders are those of ever shorter steps.
LEFT = {"displacement": 1 / 6, "rotation": 1 / 6, "velocity": 1 / 6, "angular velocity": 1 / 6}
# Where material yields, orders are irregular: the same there, without extrapolation.
# Forces follow accelerations, whose order is lower with some schemes: the two answers' own difference.
# Scenes are of metres and seconds: what stands still is measured against a millimetre.
STANDS_STILL = 1e-3
# Below it lie convergence of the iterations and, of frames, strains of 1e-3 that one program takes for small and the other not.
FLOOR = {"mechanism": 1e-6, "plane": 1e-4, "space": 1e-4}
# Halvings of steps, and of elements and fibres, of scenes that do not pass at once; fibres in space would take OpenSees hours.
FINER = {"mechanism": (3, 4), "plane": (2, 3), "space": (1, 2), "space yielding": None}


def finer(scene) -> tuple[int, int] | None:
    return FINER.get(scene.family, FINER.get(scene.family.split()[0].rstrip(":")))


def in_own_environment() -> None:
    """Goes on in the environment that has the other programs, made where it is not there."""
    python = HOME / "bin" / "python"
    if Path(sys.prefix).resolve() == HOME.resolve():
        return
    if not python.exists():
        print(f"making {HOME}", flush=True)
        subprocess.run([sys.executable, "-m", "venv", str(HOME)], check=True)
        for package in NEEDED:
            done = subprocess.run([str(python), "-m", "pip", "install", "-q", package], capture_output=True, text=True)
            if done.returncode:
                print(f"{package} cannot be installed: {done.stderr.strip().splitlines()[-1:]}")
    os.execv(python, [str(python), *sys.argv])


def available(module: str, hint: str) -> bool:
    try:
        importlib.import_module(module)
        return True
    except Exception as error:  # ImportError, or what the package makes of a missing library
        print(f"skipped: {module} cannot be loaded ({error}); {hint}")
        return False


def floor(scene) -> float:
    return FLOOR[scene.family.split()[0].rstrip(":")]


def passes(scene, found) -> bool:
    return all(difference <= left + floor(scene) for difference, left in found.values())


def compare(scene, program, levels=(0, 1)):
    """Differences and what both programs leave, by quantity; and the warnings of this one."""
    import numpy as np

    from differential_scene import run

    ours, said = zip(*(run(program, scene.deck(level), scene.read) for level in levels))
    theirs = [scene.other(level) for level in levels]
    found = {}
    for key in ours[1]:
        a, b = ([r[key] for r in pair] for pair in (ours, theirs))
        plain = key not in LEFT or "yielding" in scene.family
        of = (lambda x: x[1]) if plain else (lambda x: x[1] + (x[1] - x[0]) / 3)
        least = STANDS_STILL if scene.family.startswith("mechanism") else 1e-300
        scale = max(np.abs(a[1]).max(), np.abs(b[1]).max(), least)
        own = sum(np.abs(x[1] - x[0]).max() for x in (a, b)) / scale
        found[key] = (np.abs(of(a) - of(b)).max() / scale, (1.0 if plain else LEFT[key]) * own)
    return found, [w for pair in said for w in pair]


def percentile(values: list[float], share: float) -> float:
    values = sorted(values)
    return values[min(len(values) - 1, int(share * len(values)))]


def say_distribution(differences: dict[tuple[str, str], list[float]]) -> None:
    print(f"\n{'scenes':24}{'quantity':18}{'number':>7}{'median':>10}{'90 %':>10}{'99 %':>10}{'largest':>10}")
    for (family, quantity), values in sorted(differences.items()):
        cells = "".join(f"{v:10.1e}" for v in (*(percentile(values, s) for s in (0.5, 0.9, 0.99)), max(values)))
        print(f"{family:24}{quantity:18}{len(values):7}{cells}")


def scenes(options):
    """Half frames, half mechanisms, as far as their programs are there."""
    from differential_frames import random_frame
    from differential_mechanisms import random_mechanism

    hint = "its scenes are left out"
    makers = []
    if available("openseespy.opensees", f"{hint} (it needs libblas3 and liblapack3)"):
        makers.append(random_frame)
    if available("exudyn", hint):
        makers.append(random_mechanism)
    for i in range(options.scenes if makers else 0):
        maker = makers[i % len(makers)]
        scene = maker(random.Random(f"{options.seed} {i}"), i // len(makers))
        if options.only in scene.name + scene.family:
            yield i, scene


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("--scenes", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", help="scenes whose name or family has this text")
    parser.add_argument("--keep", default=ROOT / "target" / "differential_faults", help="folder for decks of scenes that do not pass")
    options = parser.parse_args()
    in_own_environment()
    from differential_scene import Failed, deck_text

    warnings.simplefilter("ignore")
    program, keep = str(Path(options.program).resolve()), Path(options.keep)
    differences, worst, failed, again, began = {}, [], [], [], time.time()
    for i, scene in scenes(options):
        try:
            found, said = compare(scene, program)
            if not passes(scene, found) and (levels := finer(scene)):
                again.append(i)
                found, said = compare(scene, program, levels)
        except Failed as failure:
            failed.append((i, scene, str(failure)))
        else:
            for key, (difference, left) in found.items():
                differences.setdefault((scene.family, key), []).append(difference)
                over = difference / (left + floor(scene))
                worst.append((over, difference, left, key, i, scene, said))
    say_distribution(differences)
    worst.sort(key=lambda entry: -entry[0])
    print(f"\n{time.time() - began:.0f} s; the worst, as multiples of what both programs leave:")
    for over, difference, left, key, i, scene, said in worst[:15]:
        print(f"{over:8.2f}  {difference:.1e} against {left:.1e}  {key:16} {i}: {scene.name} ({scene.family}) {' | '.join(said)[:150]}")
    for i, scene, failure in failed:
        print(f"not compared: {i}: {scene.name} ({scene.family}): {failure}")
    beyond = {entry[4]: entry[5] for entry in worst if entry[0] > 1.0}
    for i, scene in list(beyond.items()) + [(i, scene) for i, scene, _ in failed]:
        keep.mkdir(parents=True, exist_ok=True)
        (keep / f"{options.seed}_{i}.toml").write_text(deck_text(scene.deck(1)))
    print(f"{len({e[4] for e in worst})} scenes compared ({len(again)} of them with finer steps as well), "
          f"{len(beyond)} beyond what both programs leave, {len(failed)} not compared")
    return 1 if beyond else 0


if __name__ == "__main__":
    sys.exit(main())
