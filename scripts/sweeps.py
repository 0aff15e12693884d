#!/usr/bin/env python3
"""Measures the processor time of a sweep per case.  scripts/sweeps.py PROGRAM [OTHER] [--cases 1000] [--runs 3]

Sweeps the mass of the block in decks/block_on_cantilever (one element of order 3, steps of 10 ms) on one core, with all tables kept and
with `keep = "summary"`, and runs the programs in turn: least processor time over the runs, and the time of the loops of the same run.
"""
import argparse, json, os, pathlib, resource, subprocess, tempfile, time

DECK = pathlib.Path(__file__).resolve().parent.parent / "decks/block_on_cantilever/deck.toml"
SWEEP = """keep = "{keep}"
deck = "{deck}"
[vary]
"analysis.time_step" = [0.01]
"beams.beam.elements" = [1]
"beams.beam.order" = [3]
"expect" = [[]]
"bodies.block.mass" = {{ from = 1.5, to = 2.5, steps = {cases} }}
[collect]
z = {{ at = "block", quantity = "z", peak = "min" }}
"""


def run(program, sweep, out):
    before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    subprocess.run([program, "sweep", sweep, "-o", out, "--jobs", "1", "--quiet"], check=True)
    wall, after = time.perf_counter() - began, resource.getrusage(resource.RUSAGE_CHILDREN)
    results = [json.loads(path.read_text())["timings"] for path in out.glob("*/result.json")]
    return (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, wall, sum(r["loop_s"] for r in results))


def main():
    p = argparse.ArgumentParser()
    p.add_argument("programs", nargs="+")
    p.add_argument("--cases", type=int, default=1000)
    p.add_argument("--runs", type=int, default=3)
    a = p.parse_args()
    print("| kept | program | processor, ms a case | start to end, ms | loops, ms | cases a second of processor time |\n|---|---|---|---|---|---|")
    for keep in ["all", "summary"]:
        least = {}
        for turn in range(a.runs):
            for program in a.programs:
                # A new folder each time: file systems are slow where files have just been removed.
                with tempfile.TemporaryDirectory(dir="/dev/shm" if os.path.isdir("/dev/shm") else None) as folder:
                    folder = pathlib.Path(folder)
                    sweep = folder / "sweep.toml"
                    sweep.write_text(SWEEP.format(keep=keep, deck=DECK, cases=a.cases))
                    least[program] = min(least.get(program, (1e9,)), run(program, sweep, folder / "out"))
        for program, (processor, wall, loops) in least.items():
            per = [f"{1e3 * s / a.cases:.2f}" if s else "" for s in (processor, wall, loops)]
            print(f"| {keep} | {pathlib.Path(program).name} | {' | '.join(per)} | {a.cases / processor:.0f} |", flush=True)


if __name__ == "__main__":
    main()
