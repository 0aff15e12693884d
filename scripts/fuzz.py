#!/usr/bin/env python3
"""Decks that nobody would write: what does the program make of them?  scripts/fuzz.py PROGRAM [--checks N] [--runs N]

Mutates the decks of decks/ (numbers, words, lines, lists, tables; one to four changes each, from a seed) and hands them to
`rdsolve check`. Those that are accepted are run short: a dozen steps and a second of processor time, after which the system asks
them to stop (exit code 75), for a deck that needs hours is a sound one. Faults are: a panic, a signal, an exit code that
docs/messages.md does not know of here, a number that is not finite in a table, a program that does not stop when asked. Runs that
end with exit code 0 are judged by energies and forces in their tables (balance.py). Faulty decks are kept.
"""

import argparse
import collections
import concurrent.futures
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import tempfile
import time

from balance import judge

ROOT = pathlib.Path(__file__).resolve().parent.parent
NUMBER = re.compile(r"(?<![\w.\"])-?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?(?![\w\"])")
WORD = re.compile(r'"[^"\n]*"')
KEY = re.compile(r"^(\s*)([a-z_]+)(\s*=)", re.M)
# 2 and 3: where the short run itself is what does not fit the deck. The signal ends a deck so large that it is still being read.
KNOWN = {"check": {0, 3}, "run": {0, 2, 3, 4, 75, -signal.SIGXCPU}}
STEPS = 12  # of a short run
SECONDS = 1  # of processor time, after which a run is asked to stop; decks of the folder stop within another
GRACE = 20  # of processor time, after which it is killed
WAIT = 600  # on the clock, for one that sleeps
CHEAP = 0.05  # seconds: decks whose short run takes longer are run less often, for the same time in all
ACCEPTED = 0.18  # share of mutated decks that `check` accepts, about


def sources():
    decks = [p for p in sorted((ROOT / "decks").rglob("*.toml")) if p.stat().st_size < 20_000]
    return [(p, p.read_text()) for p in decks]


def other_number(rng, text):
    value = float(text)
    pick = rng.randrange(9)
    if pick == 0:
        value = 0.0
    elif pick == 1:
        value = -value
    elif pick == 2:
        value *= 10.0 ** rng.randint(-12, 12)
    elif pick == 3:
        value = rng.choice([1e300, -1e300, 1e-300, 5e-324, 2.0**53, 1e15])
    elif pick == 4:
        return rng.choice(["nan", "inf", "-inf", '"1.0"', "true", "[]", "1e999", "0x10", "1_000"])
    elif pick == 5:
        value = float(rng.randint(-3, 40))
    elif pick == 6:
        value *= rng.choice([0.5, 2.0, 1.0 + 1e-9, 1.01])
    else:
        value *= 10.0 ** rng.uniform(-2, 2)
    return str(int(value)) if abs(value) < 1e9 and value == int(value) and rng.random() < 0.5 else repr(value)


def mutate(rng, text, words):
    lines = text.split("\n")
    for _ in range(rng.randint(1, 4)):
        pick = rng.randrange(10)
        text = "\n".join(lines)
        if pick < 4 and (found := list(NUMBER.finditer(text))):
            spot = rng.choice(found)
            text = text[: spot.start()] + other_number(rng, spot.group()) + text[spot.end() :]
        elif pick == 4 and (found := list(WORD.finditer(text))):
            spot = rng.choice(found)
            text = text[: spot.start()] + rng.choice(words) + text[spot.end() :]
        elif pick == 5 and (found := list(KEY.finditer(text))):
            spot = rng.choice(found)
            key = rng.choice(found).group(2)
            text = text[: spot.start(2)] + key + text[spot.end(2) :]
        elif pick == 6:
            text = "\n".join(line for i, line in enumerate(lines) if i != rng.randrange(len(lines)))
        elif pick == 7:
            i = rng.randrange(len(lines))
            text = "\n".join(lines[: i + 1] + [lines[i]] + lines[i + 1 :])
        elif pick == 8:
            i, j = sorted(rng.randrange(len(lines) + 1) for _ in range(2))
            block, rest = lines[i : min(j, i + 12)], lines[:i] + lines[min(j, i + 12) :]
            k = rng.randrange(len(rest) + 1)
            text = "\n".join(rest[:k] + block + rest[k:])
        elif found := re.findall(r"\[[^\[\]\n]*,[^\[\]\n]*\]", text):
            old = rng.choice(found)
            parts = old[1:-1].split(",")
            parts = parts[:-1] if rng.random() < 0.5 else parts + [parts[-1]]
            text = text.replace(old, "[" + ",".join(parts) + "]", 1)
        lines = text.split("\n")
    return "\n".join(lines)


def call(command, stop_after=None):
    """Exit code and standard error; beyond the limits of processor time the system asks, then kills."""
    limits = f"ulimit -S -t {stop_after or GRACE}; ulimit -H -t {GRACE}; "
    shell = ["sh", "-c", limits + 'exec "$@"', "sh"]
    try:
        done = subprocess.run(shell + command, capture_output=True, timeout=WAIT)
        return done.returncode, done.stderr.decode(errors="replace")
    except subprocess.TimeoutExpired:
        return "time-out", ""


def complaint(kind, code, said):
    if "panicked" in said:
        return "panic"
    return None if code in KNOWN[kind] else f"{kind}: {code}"


def short_run(program, file, out, deck):
    """Exit code, what was said, and the end time if it is not the deck's own."""
    sets, end = ["--set", "expect=[]", "--set", "output.reactions=true"], None
    if (step := re.search(r"^time_step\s*=\s*([-+.eE\d]+)", deck, re.M)) and float(step.group(1)) > 0:
        end = STEPS * float(step.group(1))
        sets += ["--set", f"analysis.end_time={end!r}"]
    code, said = call([program, "run", str(file), "-o", str(out), "--threads", "1", *sets], SECONDS)
    return code, said, end


def one(job):
    program, seed, share = job
    rng = random.Random(seed)
    path, text = rng.choice(DECKS)
    deck = mutate(rng, text, WORDS)
    run = rng.random() < share * min(1.0, CHEAP / COST.get(path, CHEAP))
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for mesh in path.parent.glob("*.msh"):
            (folder / mesh.name).symlink_to(mesh)
        file, out = folder / "deck.toml", folder / "out"
        file.write_text(deck)
        code, said = call([program, "check", str(file)])
        fault = complaint("check", code, said)
        if fault or code != 0 or not run:
            return seed, f"check {code}", fault, deck
        code, said, end = short_run(program, file, out, deck)
        fault = complaint("run", code, said)
        if not fault and code == 0:
            fault = judge(deck, out, end, said)
        return seed, f"run {code}", fault, deck


def measure(program):
    """Seconds that the short run of each deck takes as it stands."""
    for path, text in DECKS:
        with tempfile.TemporaryDirectory() as folder:
            began = time.perf_counter()
            short_run(program, path, pathlib.Path(folder) / "out", text)
            COST[path] = time.perf_counter() - began


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("--checks", type=int, default=2000)
    parser.add_argument("--runs", type=int, default=200, help="so many, about, of the accepted ones are run")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--keep", default=ROOT / "target" / "fuzz_faults", help="folder for faulty decks")
    options = parser.parse_args()
    program = str(pathlib.Path(options.program).resolve())
    measure(program)
    chance = sum(min(1.0, CHEAP / COST[path]) for path, _ in DECKS) / len(DECKS)
    share = options.runs / (ACCEPTED * chance * max(options.checks, 1))
    counts, faults = collections.Counter(), collections.Counter()
    keep = pathlib.Path(options.keep)
    jobs = ((program, options.seed * 10**9 + i, share) for i in range(options.checks))
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for seed, code, fault, deck in pool.map(one, jobs):
            counts[code] += 1
            if fault:
                faults[fault.split(":")[0]] += 1
                keep.mkdir(parents=True, exist_ok=True)
                (keep / f"{seed}.toml").write_text(f"# {fault}\n{deck}")
                print(f"{seed}: {fault}", flush=True)
    print("ends:", dict(counts))
    print("faults:", dict(faults) or "none")
    return 1 if faults else 0


DECKS = sources()
COST = {}
WORDS = sorted({word for _, text in DECKS for word in WORD.findall(text)})
if __name__ == "__main__":
    sys.exit(main())
