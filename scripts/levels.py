#!/usr/bin/env python3
"""What a release costs beside a build for this processor.  scripts/levels.py NATIVE FOLDER [--runs 5] [--only TEXT]

FOLDER is what scripts/release has made. Runs small and large scenes in turn with the program NATIVE and with each level of instructions
that this processor has; prints the least processor time of the native build and that of the others over it, starting included.
Small scenes are run in rows of up to 20. Programs are run one after the other, so that what else the machine does falls on all of them.
"""
import argparse, math, os, pathlib, resource, subprocess, tempfile

import explicit

ROOT = pathlib.Path(__file__).resolve().parent.parent
LEVELS = ["x86-64-v4", "x86-64-v3", "x86-64"]
DECKS = {"first": 10, "free_body": 20, "right_angle_cantilever": 10, "yielding_portal": 10, "shaken_frame": 1}


def implicit_sheet(material, more=""):
    """A sheet of 99 x 99 quadrilaterals under pressure, 59,400 unknowns, four steps."""
    _, text = explicit.sheet(material, more)
    tables = text[text.index("[materials"):].replace("[100, 100]", "[99, 99]").replace("3e5", "3e3")
    return '[analysis]\nkind = "dynamic"\nend_time = 0.004\ntime_step = 0.001\n[output]\ninterval = 0.004\n' + tables


def implicit_frame():
    """10,362 elements, two steps."""
    _, text = explicit.space_frame(explicit.ELASTIC, explicit.TUBE, True)
    tables = text[text.index("[materials"):]
    return '[analysis]\nkind = "dynamic"\nend_time = 0.002\ntime_step = 0.001\n[output]\ninterval = 0.002\n' + tables


def scenes(folder):
    """Name, how often it is run in a row, arguments."""
    yield "start (`--version`)", 20, ["--version"]
    yield "reading a deck (`check`)", 20, ["check", ROOT / "decks/first/deck.toml"]
    for name, rows in DECKS.items():
        yield f"decks/{name}", rows, [ROOT / f"decks/{name}/deck.toml"]
    made = {
        "implicit, shell, elastic, 59,400 unknowns": implicit_sheet(explicit.ELASTIC),
        "implicit, shell, five yielding layers": implicit_sheet(explicit.YIELDING.replace("1e5", "5e6"), "layers = 5\n"),
        "implicit, beams in space, 10,362 elements": implicit_frame(),
    }
    made |= {f"explicit, {name}": scene()[1] for name, scene in explicit.SCENES.items()}
    for index, (name, text) in enumerate(made.items()):
        deck = folder / f"{index}.toml"
        deck.write_text(text)
        yield name, 1, [deck]


def seconds(program, level, arguments, rows, folder):
    if arguments[0] not in ["--version", "check"]:
        arguments = [*arguments, "-o", folder / "out", "--quiet", "--overwrite", "--threads", "1"]
    environment = os.environ | {"RDSOLVE_INSTRUCTIONS": level}
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    for _ in range(rows):
        done = subprocess.run([program, *arguments], env=environment, capture_output=True, cwd=folder)
        if done.returncode not in (0, 5):
            raise SystemExit(f"{program} {level}: {done.stderr.decode()}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime) / rows


def main():
    p = argparse.ArgumentParser()
    p.add_argument("native", type=pathlib.Path)
    p.add_argument("folder", type=pathlib.Path)
    p.add_argument("--runs", type=int, default=5)
    p.add_argument("--only", default="")
    a = p.parse_args()
    release = (a.folder / "rdsolve").resolve()
    told = subprocess.run([release, "--version"], capture_output=True, text=True).stdout
    levels = [level for level in LEVELS if level in told.split(" of ")[-1].strip().split(", ")]
    # The best is chosen by the program itself, starting from the one for any processor.
    programs = [(a.native.resolve(), "")] + [(release, "" if level == levels[0] else level) for level in levels]
    print(f"| scene | native | {' | '.join(levels)} |\n|---|---|{'---|' * len(levels)}")
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for name, rows, arguments in scenes(folder):
            if a.only not in name:
                continue
            least = [math.inf] * len(programs)
            for _ in range(a.runs):
                for index, (program, level) in enumerate(programs):
                    least[index] = min(least[index], seconds(program, level, arguments, rows, folder))
            native = f"{least[0] * 1e3:.1f} ms" if least[0] < 0.1 else f"{least[0]:.2f} s"
            print(f"| {name} | {native} | {' | '.join(f'{other / least[0]:.2f}' for other in least[1:])} |", flush=True)


main()
