#!/usr/bin/env python3
"""Looks at the report of every deck in a headless browser and reads its charts back.

Each deck is run and its page made; a copy of the page gets one more script, which opens every chart (all tables and columns,
energies, steps), notes the numbers that the chart was given and counts the pixels of its lines, and plays the scene to its last
frame with WebGL 2 and, on a second page, without. Compared with the tables: every series is as long as its table is after
thinning, its numbers are those of the table, ranges are finite, no chart and no scene is blank. A column without a number
anywhere may be blank.

    scripts/report_pages.py [--rdsolve target/debug/rdsolve] [--only PART_OF_NAME] [--end-time-factor 1]

Without a browser (chromium-headless-shell, chromium or google-chrome on the path) it says so and ends with 0.
"""

import argparse
import csv
import html
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

BROWSERS = ["chromium-headless-shell", "chromium", "chromium-browser", "google-chrome"]

READER = r"""
<pre id="readback"></pre>
<script>
(() => {
  const out = { charts: [], errors: [], scene: null };
  addEventListener("error", event => out.errors.push(event.message));
  // Pixels of lines: axes and their numbers are grey.
  const inked = canvas => {
    const { width, height } = canvas;
    if (!width || !height) return 0;
    const data = canvas.getContext("2d").getImageData(0, 0, width, height).data;
    let count = 0;
    for (let i = 0; i < data.length; i += 4) {
      const colour = [data[i], data[i + 1], data[i + 2]];
      if (data[i + 3] > 60 && Math.max(...colour) - Math.min(...colour) > 30) count++;
    }
    return count;
  };
  let about = null;
  const show = Plot.prototype.show;
  Plot.prototype.show = function (series, label) {
    show.call(this, series, label);
    if (!about) return;
    const read = array => Array.from(array, x => (Number.isFinite(x) ? x : null));
    out.charts.push({ ...about, x: label.x, y: label.y, pixels: inked(this.canvas),
      series: series.slice(0, 6).map(s => ({ name: s.name, x: read(s.x), y: read(s.own ?? s.y) })) });
  };
  const change = element => element.dispatchEvent(new Event("change"));
  try {
    const boxes = document.querySelectorAll("#energy-plot .keys input");
    about = { chart: "energy", file: "energy.csv", columns: [...boxes].map(box => box.parentElement.title) };
    if (boxes.length) boxes.forEach(box => (box.checked = true)), change(boxes[0]);
    const stacked = document.querySelector("#energy-plot .controls input");
    about = { chart: "energy stacked", file: "energy.csv" };
    if (stacked && boxes.length) stacked.checked = true, change(stacked);
    document.querySelectorAll("#steps-plot input").forEach(radio => {
      about = { chart: "steps", file: "steps.csv", column: radio.parentElement.textContent };
      change(radio);
    });
    const files = document.querySelector("#histories-plot select");
    for (const file of files ? [...files.options].map(option => option.value) : []) {
      about = null;
      files.value = file, change(files);
      const column = document.querySelectorAll("#histories-plot select")[1];
      for (const name of [...column.options].map(option => option.value)) {
        about = { chart: "history", file, column: name };
        column.value = name, change(column);
      }
    }
    about = null;
    if (DATA.scene) {
      const slider = document.getElementById("time");
      slider.value = slider.max;
      slider.dispatchEvent(new Event("input"));
    }
  } catch (problem) { out.errors.push(String(problem.stack)); }
  // The scene is drawn with the next frame.
  requestAnimationFrame(() => requestAnimationFrame(() => {
    try {
      if (DATA.scene) {
        const canvas = document.getElementById("stage"), copy = document.createElement("canvas");
        if (!canvas) throw new Error(document.querySelector(".stage").textContent);
        Object.assign(copy, { width: canvas.width, height: canvas.height });
        copy.getContext("2d").drawImage(canvas, 0, 0);
        const data = copy.getContext("2d").getImageData(0, 0, copy.width, copy.height).data;
        let count = 0;
        for (let i = 3; i < data.length; i += 4) count += data[i] > 0;
        out.scene = { pixels: count, flat: Boolean(window.withoutGl), clock: document.getElementById("clock").textContent };
      }
    } catch (problem) { out.errors.push(String(problem.stack)); }
    document.getElementById("readback").textContent = JSON.stringify(out);
  }));
})();
</script>
"""
WITHOUT_GL = """<script>
window.withoutGl = true;
const getContext = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...more) { return kind === "webgl2" ? null : getContext.call(this, kind, ...more); };
</script>
"""


def browser():
    return next(filter(None, map(shutil.which, BROWSERS)), None)


def read_back(program, page, folder):
    """What the page's charts and its scene show, with and without WebGL 2."""
    found = []
    for flat in (False, True):
        text = page.replace("</body>", READER + "</body>")
        if flat:
            text = text.replace("<script", WITHOUT_GL + "<script", 1)
        path = folder / f"page_{int(flat)}.html"
        path.write_text(text)
        command = [program, "--headless", "--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader", "--window-size=1200,2400",
                   "--virtual-time-budget=4000", "--dump-dom", path.as_uri()]
        done = subprocess.run(command, capture_output=True, text=True, timeout=180)
        match = re.search(r'<pre id="readback">(.*?)</pre>', done.stdout, re.S)
        if not match or not match.group(1):
            raise RuntimeError(f"nothing was read back: {done.stderr[-500:]}")
        found.append(json.loads(html.unescape(match.group(1))))
    return found


def table(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def number(text):
    try:
        return float(text) if math.isfinite(float(text)) else None
    except ValueError:
        return None


def near(a, b):
    # Pages carry Float32.
    return a is None and b is None or a is not None and b is not None and abs(a - b) <= 1e-6 * max(abs(a), abs(b)) + 1e-37


def faults(seen, results):
    """What is wrong with the charts of a page, in words."""
    wrong = [f"script: {error}" for error in seen["errors"]]
    tables = {}
    for chart in seen["charts"]:
        rows = tables.setdefault(chart["file"], table(results / chart["file"]))
        name = f"{chart['chart']} of {chart['file']} {chart.get('column', '')}".strip()
        numbers = [y for series in chart["series"] for y in series["y"] if y is not None]
        if chart["series"] and numbers and not chart["pixels"]:
            wrong.append(f"{name}: blank")
        column = chart.get("column")
        if column and column not in rows[0] or not chart["series"]:
            if column != "time" or not chart["series"]:
                wrong.append(f"{name}: no series")
            continue
        times = sorted({number(row["time"]) for row in rows}) if chart["file"] != "steps.csv" else None
        for series in chart["series"]:
            if len(series["x"]) != len(series["y"]) or any(x is None for x in series["x"]):
                wrong.append(f"{name}: {series['name']}: x and y do not fit")
            # Histories are thinned above so many times only.
            if times and len(times) <= 200 and len(series["x"]) != len(times):
                wrong.append(f"{name}: {series['name']} has {len(series['x'])} of {len(times)} times")
        column = column or chart["series"][0]["name"]
        given = [number(row[column]) for row in rows]
        if any(value is not None for value in given) and not numbers:
            wrong.append(f"{name}: only gaps, where the table has numbers")
        if any(key not in ("step", "time") and number(rows[0][key]) is None and rows[0][key] for key in list(rows[0])[2:3]):
            continue
        # One row a time: the ends are the table's.
        first, last = chart["series"][0]["y"][0], chart["series"][0]["y"][-1]
        if not (near(first, given[0]) and near(last, given[-1])):
            wrong.append(f"{name}: {first} … {last}, the table has {given[0]} … {given[-1]}")
    return wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    root = pathlib.Path(__file__).resolve().parent.parent
    parser.add_argument("--rdsolve", default=str(root / "target/debug/rdsolve"))
    parser.add_argument("--only", default="")
    parser.add_argument("--time-limit", type=float, default=60.0, help="seconds that a run may take; what it has written then is shown")
    options = parser.parse_args()
    program = browser()
    if not program:
        print(f"skipped: no headless browser is installed (looked for {', '.join(BROWSERS)})")
        return 0
    bad = 0
    for deck in sorted((root / "decks").rglob("*.toml")):
        if "[analysis]" not in deck.read_text():
            continue  # words for other decks
        name = str(deck.relative_to(root / "decks").with_suffix("")).removesuffix("/deck")
        if options.only not in name:
            continue
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            command = [options.rdsolve, str(deck), "-o", "x.out", "--quiet"]
            run = subprocess.Popen(command, cwd=folder, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
            try:
                run.wait(options.time_limit)
            except subprocess.TimeoutExpired:
                run.terminate()
                run.wait()
            subprocess.run([options.rdsolve, "report", "x.out", "--quiet"], cwd=folder, check=True)
            page = (folder / "x.html").read_text()
            try:
                gl, flat = read_back(program, page, folder)
            except (RuntimeError, subprocess.TimeoutExpired) as error:
                print(f"{name}: {error}")
                bad += 1
                continue
            wrong = faults(gl, folder / "x.out") + [f"without WebGL 2: {error}" for error in flat["errors"]]
            scenes = [seen["scene"] for seen in (gl, flat)]
            wrong += [f"scene {'without' if i else 'with'} WebGL 2: blank" for i, scene in enumerate(scenes) if scene and not scene["pixels"]]
            pixels = "/".join(str(scene["pixels"]) for scene in scenes if scene) or "no scene"
            print(f"{name}: {len(gl['charts'])} charts, scene {pixels} pixels{', WRONG' if wrong else ''}", flush=True)
            for line in wrong:
                print(f"    {line}")
            bad += bool(wrong)
    print(f"{bad} pages with faults" if bad else "every chart of every page shows its table")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
