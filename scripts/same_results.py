#!/usr/bin/env python3
"""Do two builds of the program compute the same numbers?  scripts/same_results.py OLD NEW [--filter TEXT] [--decks-only]

Runs every deck of decks/ with both programs, as it stands and in variants (schemes, iteration methods, automatic steps, all
outputs), and compares exit codes, counts, expectations, every column of every table and every array of every field file to
the last bit. Nothing may differ. Results of OLD are kept in --cache.
"""
import argparse, concurrent.futures, csv, hashlib, json, os, pathlib, re, shutil, struct, subprocess, sys, zlib

ROOT = pathlib.Path(__file__).resolve().parent.parent
EVERYTHING = ["output.reactions=true", "output.sections=true", "output.layers=true", "output.parts=true", 'output.nodes="all"']
VARIANTS = {
    "": [],
    "all-outputs": EVERYTHING,
    "newmark": ['integrator={scheme="newmark"}'],
    "hht": ['integrator={scheme="hht-alpha"}'],
    "galpha": ['integrator={scheme="generalized-alpha"}'],
    "bathe": ['integrator={scheme="bathe"}'],
    "central": ['integrator={scheme="central-difference"}', 'analysis.time_step="auto"'],
    "rk": ['integrator={scheme="runge-kutta"}', 'analysis.time_step="auto"', "analysis.error_tolerance=1e-4"],
    "rk5": ['integrator={scheme="runge-kutta",order=5}', 'analysis.time_step="auto"', "analysis.error_tolerance=1e-3"],
    "auto": ['analysis.time_step="auto"', "analysis.error_tolerance=1e-2"],
    "bathe-auto": ['integrator={scheme="bathe"}', 'analysis.time_step="auto"', "analysis.error_tolerance=1e-2"],
    "tangent": ['iteration.method="tangent-stiffness"', 'iteration.update="iteration"'],
    "initial": ['iteration.method="initial-load"'],
    "stepwise": ['iteration.update="step"'],
    "arc": ['analysis.control="arc-length"'],
}

def run(program, deck, variant, out, seconds):
    if out.exists():
        shutil.rmtree(out)
    out.parent.mkdir(parents=True, exist_ok=True)
    command = [program, str(deck), "-o", str(out), "--quiet", "--overwrite"]
    for item in VARIANTS[variant]:
        command += ["--set", item]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=seconds)
        return done.returncode
    except subprocess.TimeoutExpired:
        return "timeout"

def arrays(path):
    """The digest of each array of a grid, by name; the numbers stand behind the XML, compressed in blocks."""
    head, _, data = path.read_bytes().partition(b'<AppendedData encoding="raw">\n_')
    found = {}
    for name, offset in re.findall(rb'<DataArray [^>]*Name="(\w+)"[^>]*offset="(\d+)"', head):
        offset = int(offset)
        blocks = struct.unpack_from("<Q", data, offset)[0]
        sizes, at, plain = struct.unpack_from(f"<{blocks}Q", data, offset + 24), offset + 8 * (3 + blocks), hashlib.sha256()
        for size in sizes:
            plain.update(zlib.decompress(data[at : at + size]))
            at += size
        found[name.decode()] = plain.hexdigest()
    return found

def tables(folder):
    found = {}
    for path in sorted(folder.glob("*.csv")):
        rows = list(csv.reader(path.open()))
        names = rows[0]
        for i, name in enumerate(names):
            found[f"{path.name}:{name}"] = hashlib.sha256("\n".join(r[i] for r in rows[1:] if i < len(r)).encode()).hexdigest()
        found[f"{path.name}: columns"] = sorted(names)
    for path in sorted(folder.glob("**/*.vtu")):
        found[str(path.relative_to(folder))] = arrays(path)
    result = folder / "result.json"
    if result.exists():
        data = json.loads(result.read_text())
        found["counts"] = {k: v for k, v in data.get("counts", {}).items() if k in ("steps", "iterations", "factorizations", "solves", "cuts")}
        found["status"] = [data.get("status"), data.get("exit_code")]
        found["expectations"] = [[e.get("value"), e.get("time"), e.get("passed")] for e in data.get("expectations", [])]
    return found

def main():
    p = argparse.ArgumentParser()
    p.add_argument("old"), p.add_argument("new")
    p.add_argument("--filter", default="")
    p.add_argument("--decks-only", action="store_true")
    p.add_argument("--seconds", type=float, default=30)
    p.add_argument("--cache", default=None, help="folder where digests of OLD are kept")
    p.add_argument("--jobs", type=int, default=2)
    p.add_argument("--work", default="/tmp/same_results")
    p.add_argument("--root", default=None, help="the checkout whose decks NEW runs; default: that of this script")
    p.add_argument("--old-root", default=None, help="the checkout whose decks OLD runs; default: the same; decks that it has not are left out")
    a = p.parse_args()
    global ROOT
    ROOT = pathlib.Path(a.root) if a.root else ROOT
    work = pathlib.Path(a.work)
    cache = pathlib.Path(a.cache) if a.cache else work / "cache"
    cache.mkdir(parents=True, exist_ok=True)
    old_root = pathlib.Path(a.old_root) if a.old_root else ROOT
    version = hashlib.sha256(pathlib.Path(a.old).read_bytes()).hexdigest()[:12]
    cases = []
    for deck in sorted((ROOT / "decks").rglob("*.toml")):
        text = deck.read_text()
        if "[analysis]" not in text and "analysis" not in text:
            continue
        before = old_root / deck.relative_to(ROOT)
        if not before.exists():
            continue
        for variant in VARIANTS:
            name = str(deck.relative_to(ROOT / "decks")).removesuffix(".toml").replace("/", "+") + ("@" + variant if variant else "")
            if (a.decks_only and variant) or a.filter not in name:
                continue
            cases.append((name, deck, before, variant))

    def one(case):
        name, deck, before, variant = case
        kept = cache / f"{version}-{name}-{hashlib.sha256(before.read_bytes()).hexdigest()[:8]}.json"
        if kept.exists():
            old = json.loads(kept.read_text())
        else:
            out = work / "old" / name
            code = run(a.old, before, variant, out, a.seconds)
            old = {"exit": code, **(tables(out) if code in (0, 4, 5) else {})}
            kept.write_text(json.dumps(old))
            shutil.rmtree(out, ignore_errors=True)
        if old["exit"] in ("timeout", 3):
            if old["exit"] == 3 and variant:
                return name, "refused", []
            if old["exit"] == "timeout":
                return name, "timeout", []
        out = work / f"new{os.getpid()}" / name
        code = run(a.new, deck, variant, out, 4 * a.seconds)
        new = {"exit": code, **(tables(out) if code in (0, 4, 5) else {})}
        new = json.loads(json.dumps(new))
        shutil.rmtree(out, ignore_errors=True)
        missing = [k for k in old if old[k] != new.get(k)] + [k + " (new)" for k in new if k not in old]
        return name, "compared", missing

    totals, bad = {}, 0
    with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
        for name, what, missing in pool.map(one, cases):
            totals[what] = totals.get(what, 0) + 1
            if missing:
                bad += 1
                print(f"DIFFERS {name}: {', '.join(missing[:8])}{' …' if len(missing) > 8 else ''}", flush=True)
    print(f"{totals.get('compared', 0)} runs compared, {bad} differ; {totals.get('refused', 0)} variants refused by the deck, {totals.get('timeout', 0)} beyond the time limit")
    shutil.rmtree(work / f"new{os.getpid()}", ignore_errors=True)
    sys.exit(1 if bad else 0)

main()
