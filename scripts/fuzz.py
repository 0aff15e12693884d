#!/usr/bin/env python3
"""Decks that nobody would write: what does the program make of them?  scripts/fuzz.py PROGRAM [--checks N] [--runs N]

Mutates the decks of decks/ (numbers, words, lines, lists, tables; one to four changes each, from a seed) and hands them to
`rdsolve check`. Those that are accepted are run short. Faults are: a panic, a signal, an exit code that docs/messages.md does
not know of here, a number that is not finite in a table, a run that does not come to an end. Runs that end with exit code 0 are judged by the balance of
energy as written: what the scheme has added or removed, against the largest energy, without a warning. Faulty decks are kept.
"""
import argparse, collections, concurrent.futures, csv, math, os, pathlib, random, re, shutil, subprocess, sys, tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
NUMBER = re.compile(r"(?<![\w.\"])-?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?(?![\w\"])")
WORD = re.compile(r'"[^"\n]*"')
KEY = re.compile(r"^(\s*)([a-z_]+)(\s*=)", re.M)
KNOWN = {"check": {0, 3}, "run": {0, 3, 4, 5}}
SECONDS = 20  # of a check or a short run: a deck of the folder takes less than one
STEPS = 12  # of a short run


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
    return str(int(value)) if value == int(value) and abs(value) < 1e9 and rng.random() < 0.5 else repr(value)


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


def call(command):
    try:
        done = subprocess.run(command, capture_output=True, timeout=SECONDS)
        return done.returncode, done.stderr.decode(errors="replace")
    except subprocess.TimeoutExpired:
        return "time-out", ""


def complaint(kind, code, said):
    if "panicked" in said:
        return "panic"
    return None if code in KNOWN[kind] else f"{kind}: {code}"


def judge(folder, said):
    """A fault in the tables of a run that came to its end."""
    for path in folder.glob("*.csv"):
        with path.open() as file:
            for row in csv.reader(file):
                if any(cell.lower().lstrip("-") in ("nan", "inf", "infinity") for cell in row):
                    return f"not finite: {path.name}"
    energy = folder / "energy.csv"
    if not energy.exists():
        return None
    rows = list(csv.DictReader(energy.open()))
    if not rows or "numerical" not in rows[0]:
        return None
    of = lambda row, *names: sum(abs(float(row[name] or 0.0)) for name in names if name in row)
    peak = max(of(row, "kinetic", "strain", "links", "contact", "plastic", "viscoplastic") for row in rows)
    lost = max(abs(float(row["numerical"] or 0.0)) for row in rows)
    if not math.isfinite(peak) or (lost > 0.2 * peak and peak > 0.0 and "warning" not in said):
        return f"energy: {lost:.2e} of {peak:.2e}"
    return None


def one(job):
    program, seed, run = job
    rng = random.Random(seed)
    path, text = rng.choice(DECKS)
    deck = mutate(rng, text, WORDS)
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for mesh in path.parent.glob("*.msh"):
            (folder / mesh.name).symlink_to(mesh)
        file, out = folder / "deck.toml", folder / "out"
        file.write_text(deck)
        code, said = call([program, "check", str(file)])
        fault = complaint("check", code, said)
        if fault or code != 0 or not run:
            return seed, code, fault, deck
        step = re.search(r"^time_step\s*=\s*([-+.eE\d]+)", deck, re.M)
        sets = ["--set", f"analysis.end_time={STEPS * float(step.group(1))!r}"] if step and float(step.group(1)) > 0 else []
        code, said = call([program, "run", str(file), "-o", str(out), *sets])
        if code == 3 and sets:  # expectations, stops and amplitudes may lie behind the new end
            return seed, "shortened", None, deck
        fault = complaint("run", code, said)
        if not fault and code == 0:
            fault = judge(out, said)
        return seed, f"run {code}", fault, deck


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("--checks", type=int, default=2000)
    parser.add_argument("--runs", type=int, default=200, help="of the accepted ones, the first so many are run")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--keep", default="fuzz_faults", help="folder for faulty decks")
    options = parser.parse_args()
    program = str(pathlib.Path(options.program).resolve())
    counts, faults, ran = collections.Counter(), collections.Counter(), 0
    keep = pathlib.Path(options.keep)
    # About one deck in five is accepted.
    every = max(1, options.checks // (5 * max(options.runs, 1)))
    jobs = ((program, options.seed * 10**9 + i, i % every == 0) for i in range(options.checks))
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for seed, code, fault, deck in pool.map(one, jobs):
            counts[code] += 1
            if fault:
                faults[fault.split(":")[0]] += 1
                keep.mkdir(exist_ok=True)
                (keep / f"{seed}.toml").write_text(f"# {fault}\n{deck}")
                print(f"{seed}: {fault}", flush=True)
    print("ends:", dict(counts))
    print("faults:", dict(faults) or "none")
    return 1 if faults else 0


DECKS = sources()
WORDS = sorted({word for _, text in DECKS for word in WORD.findall(text)})
if __name__ == "__main__":
    sys.exit(main())
