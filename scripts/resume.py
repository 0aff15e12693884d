#!/usr/bin/env python3
"""Kills runs at random instants, lets them go on with --resume, and compares all that they leave with runs that never stopped.

    scripts/resume.py [--program target/release/rdsolve] [--kills 100] [--seed 1] [--set KEY=VALUE] [--chosen | DECK ...]

Every deck (all below decks/ by default) is run once whole; then it is begun again and again, each time stopped at a random instant by
SIGKILL or SIGTERM and resumed, until it has been stopped as often as asked; on the way a run may be stopped several times. Tables,
fields, counts, warnings and expected values must be the same to the last byte. Prints a line for each deck; exits with 1 where any differs.
`--chosen` takes fourteen decks instead that cover every scheme, contact with friction, heaps of hulls and capsules, material that yields,
joints with drives, automatic steps, a path by arc length, stages and a frequency response, with steps so short that kills fall inside the
run.
"""

import argparse
import json
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# What tells the clock, or how often the run was begun.
OWN = {"result.json", "run.log", "run.list", "run.lock", "run.checkpoint", "run.checkpoint.tmp"}
SAME = ["status", "reason", "counts", "warnings", "expectations", "error_bars", "step_error", "joint_violation", "rotation_drift"]
# What has a part in a checkpoint, in runs of about a second: deck, overrides.
CHOSEN = [
    ("flying_beam", ["integrator.scheme=wilson-theta"]),
    ("block_on_incline", ["integrator={scheme='newmark'}"]),
    ("stick_slip", ["integrator={scheme='generalized-alpha'}", "analysis.time_step=1e-4"]),
    ("clamped_beam_impulse", ["integrator={scheme='bathe'}", "analysis.time_step=2e-5"]),
    ("slider_crank", ["integrator={scheme='esdirk3'}", "analysis.time_step=5e-4"]),
    ("right_angle_cantilever", ["integrator={scheme='hht-alpha'}", "analysis.time_step=auto", "analysis.end_time=6.0", "expect=[]"]),
    ("bouncing_ball", ["integrator={scheme='central-difference'}", "analysis.time_step=2e-5"]),
    ("robot_arm", []),
    ("plastic_collapse/portal", []),
    ("lees_frame", []),
    ("protective_frame", []),
    ("shaken_machine", ["analysis.frequencies.steps=100001"]),
    ("thrown_stones", []),
    ("whipped_chain", []),
]


def left(folder):
    """The files of a run by name, and what its result says of it."""
    files = {path.name: path.read_bytes() for path in folder.iterdir() if path.name not in OWN}
    result = json.loads((folder / "result.json").read_text())
    return files, {key: result.get(key) for key in SAME}


class Runner:
    def __init__(self, program, deck, sets, apart):
        self.command = [program, str(deck), "--quiet", "--set", f"output.checkpoint={apart}"]
        for text in sets:
            self.command += ["--set", text]

    def run(self, folder, resume, until=None, how=signal.SIGKILL):
        """The exit code of a run that is stopped after so many seconds; None where it was killed."""
        command = self.command + ["--threads", random.choice("12"), "-o", str(folder)] + (["--resume"] if resume else [])
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        if until is not None:
            try:
                process.wait(until)
            except subprocess.TimeoutExpired:
                process.send_signal(how)
        said = process.communicate()[1].decode()
        code = process.returncode
        if code not in (0, 4, 5, 75, -signal.SIGKILL, -signal.SIGTERM):
            raise SystemExit(f"{' '.join(command)}: exit code {code}\n{said}")
        return code


def check(program, deck, sets, kills, dice, scratch):
    whole = scratch / "whole"
    begun = time.time()
    runner = Runner(program, deck, sets, 1e9)
    runner.run(whole, False)
    took = time.time() - begun
    # Some ten checkpoints a run, and the same options in each.
    apart = max(1e-3, took / dice.uniform(5.0, 40.0))
    runner = Runner(program, deck, sets, apart)
    expected = left(whole)
    stops = runs = signals = largest = 0
    while stops < kills:
        folder = scratch / "stopped"
        shutil.rmtree(folder, ignore_errors=True)
        resume = False
        runs += 1
        while True:
            how = dice.choice([signal.SIGKILL, signal.SIGKILL, signal.SIGTERM])
            code = runner.run(folder, resume, dice.uniform(0.0, 1.1 * took), how)
            checkpoint = folder / "run.checkpoint"
            if checkpoint.exists():
                largest = max(largest, checkpoint.stat().st_size)
            if (folder / "result.json").exists() and code in (0, 4, 5):
                break
            stops += 1
            signals += how == signal.SIGTERM
            resume = True
        found = left(folder)
        if found != expected:
            names = [name for name in expected[0].keys() | found[0].keys() if expected[0].get(name) != found[0].get(name)]
            told = [key for key in SAME if expected[1][key] != found[1][key]]
            kept = Path(tempfile.mkdtemp(prefix="resume_differs_"))
            shutil.copytree(scratch, kept / "runs")
            return f"DIFFERS in {names + told}, see {kept}", True
    size = sum(map(len, expected[0].values()))
    line = f"{stops} stops ({signals} by SIGTERM) of {runs} runs of {took:.2f} s, {len(expected[0])} files of {size} bytes"
    return f"{line} the same; checkpoints up to {largest} bytes", False


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(ROOT / "target/release/rdsolve"))
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--set", action="append", default=[], help="an entry of the decks, as for the program")
    parser.add_argument("--chosen", action="store_true", help="the fourteen decks that cover all that a checkpoint holds")
    parser.add_argument("decks", nargs="*", type=Path)
    args = parser.parse_args()
    decks = [(deck, []) for deck in args.decks or sorted(ROOT.glob("decks/**/deck.toml"))]
    if args.chosen:
        decks = [(ROOT / "decks" / name / "deck.toml", sets) for name, sets in CHOSEN]
    differs = False
    for deck, sets in decks:
        dice = random.Random(f"{args.seed} {deck.name} {deck.parent.name}")
        with tempfile.TemporaryDirectory(prefix="resume_") as scratch:
            line, wrong = check(args.program, deck, sets + args.set, args.kills, dice, Path(scratch))
        differs |= wrong
        print(f"{' '.join([str(deck), *sets])}: {line}", flush=True)
    sys.exit(1 if differs else 0)


if __name__ == "__main__":
    main()
