#!/usr/bin/env python3
"""Automatic steps: the error that is asked for, the one that is reached, and what it costs.

    scripts/accuracy.py                all scenes with a reference (two minutes)
    scripts/accuracy.py B1 R3          some of them
    scripts/accuracy.py --scheme wilson-theta

Nothing but the error and the mesh is given. The cost is that of all runs that were made for it, the unseen ones included; beside it
stands the scheme of the deck in equal steps whose length was searched for (scripts/speed.py). Python's standard library only.
"""

import argparse

from scenes import SCENES, build

ASKED = (1e-2, 1e-3, 1e-4, 1e-5)
# Elements a segment and order; errors of these meshes are 6e-4, 5e-4, 2e-4, 4e-4, 7e-4 and, finer, 6e-5, 1e-5, 1e-5, 5e-5, 7e-4.
COARSE = {"B1": (1, 4), "B2": (1, 3), "C1": (1, 3), "C2": (1, 4), "C4": (8, 3)}
FINE = {"B1": (2, 4), "B2": (2, 3), "C1": (1, 4), "C2": (1, 4), "C4": (8, 3)}


def accuracy(names: list[str], scheme: str) -> None:
    print("| scene | asked | reached | estimated | steps | iterations: last run + others | factorizations | loop s |")
    print("|---|---|---|---|---|---|---|---|")
    for name in names:
        scene = SCENES[name]
        for asked in ASKED:
            sets = ['analysis.time_step="auto"', f"analysis.error_tolerance={asked}", f'integrator={{scheme="{scheme}"}}']
            meshes = COARSE if asked > 5e-3 else FINE
            if name in meshes:
                sets += scene.mesh(*meshes[name])
            try:
                error, loop, _, report = scene.measure(sets, 7)
            except RuntimeError as failed:
                print(f"| {name} | {asked:.0e} | {failed} |")
                continue
            counts, found = report["counts"], report["step_error"]
            estimate = "" if found["estimate"] is None else f"{found['estimate']:.1e}"
            print(
                f"| {name} | {asked:.0e} | {error:.1e} | {estimate} | {counts['steps']} |"
                f" {counts['iterations']} + {found['other_iterations']} |"
                f" {counts['factorizations'] + found['other_factorizations']} | {loop:.4f} |",
                flush=True,
            )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("scenes", nargs="*", default=list(SCENES), metavar="SCENE")
    parser.add_argument("--scheme", default="esdirk3")
    asked = parser.parse_args()
    build()
    accuracy(asked.scenes or list(SCENES), asked.scheme)
