#!/usr/bin/env python3
"""A frame of three storeys that is pushed over by a pattern of forces, beside OpenSees, in finer and finer meshes.

    scripts/pushover.py             this program alone
    scripts/pushover.py --opensees  both; needs a Python in which `import openseespy.opensees` works (pip install openseespy)

OpenSees takes the frame of earthquake.py under its weight, and the integrator DisplacementControl at its roof. The table has the base shear in
N at three displacements of the roof.
"""

import json
import sys
import tempfile
from pathlib import Path

from earthquake import Frame
from scenes import ROOT, build, run

DECK = ROOT / "decks" / "pushed_frame" / "deck.toml"
PLACES = [0.1, 0.3, 0.6]
PATTERN = {1: 100e3, 2: 200e3, 3: 300e3}


def opensees(elements: int, layers: int, increment: float) -> list[float]:
    ops = Frame(elements, layers).ops
    ops.constraints("Plain")
    ops.numberer("RCM")
    ops.system("UmfPack")
    ops.test("NormDispIncr", 1e-9, 50)
    ops.algorithm("Newton")
    ops.integrator("LoadControl", 0.5)
    ops.analysis("Static")
    assert ops.analyze(2) == 0
    ops.loadConst("-time", 0.0)
    ops.timeSeries("Linear", 2)
    ops.pattern("Plain", 2, 2)
    for storey, force in PATTERN.items():
        ops.load(storey, force, 0.0, 0.0)
    # The first step is shorter by what the weight has moved the roof.
    count, found = round(PLACES[-1] / increment), []
    ops.integrator("DisplacementControl", 3, 1, increment - ops.nodeDisp(3, 1))
    for step in range(count):
        assert ops.analyze(1) == 0, f"OpenSees does not converge at {step * increment} m"
        ops.integrator("DisplacementControl", 3, 1, increment)
        if any(abs(ops.nodeDisp(3, 1) - place) < 1e-6 for place in PLACES):
            found.append(ops.getTime() * sum(PATTERN.values()))
    return found


def ours(sets: list[str]) -> list[float]:
    with tempfile.TemporaryDirectory() as folder:
        run(DECK, sets, Path(folder))
        found = json.loads((Path(folder) / "result.json").read_text())["expectations"]
        return [(row["value"] - 1.0) * sum(PATTERN.values()) for row in found]


def main() -> None:
    build()
    print("| run | " + " | ".join(f"{place} m" for place in PLACES) + " |\n|" + "---|" * (len(PLACES) + 1))
    for elements, layers, increment in ((4, 16, 0.01), (8, 32, 0.01), (8, 32, 0.005), (16, 64, 0.005)):
        sets = [f"beams.{name}.elements={elements}" for name in ("left", "right", "girder_1", "girder_2", "girder_3")]
        sets += [f"sections.{name}.fibres=[{layers}, 2]" for name in ("column", "girder")]
        runs = {"rdsolve": ours(sets + [f"stages.push.increment={increment}"])}
        if "--opensees" in sys.argv:
            runs["OpenSees"] = opensees(elements, layers, increment)
        for name, values in runs.items():
            print(f"| {name}, {elements} elements a member, {layers} layers, {increment} m | " + " | ".join(f"{value:.6g}" for value in values) + " |")


if __name__ == "__main__":
    main()
