// Puts the page together: the scene, the energy, the histories, the steps.

const byId = id => document.getElementById(id);
let histories = [];
const table = file => histories.find(history => history.file === file);

/** A plot with a list of lines to tick beside it. */
function plotWith(parent) {
  const area = make("div"), whole = make("div", { className: "plot" }, area);
  parent.append(whole);
  return [new Plot(area), whole];
}

function choice(parent, text, options, value, change) {
  const select = make("select", {}, ...options.map(option => make("option", { value: option, textContent: option })));
  select.value = value;
  select.addEventListener("change", () => change(select.value));
  parent.append(make("label", {}, `${text} `, select));
  return select;
}

function energy(history) {
  const names = history.columns.filter(name => history.kinds[history.columns.indexOf(name)] === "energy" && history.line(0, name).some(x => x !== 0));
  byId("energy").hidden = !names.length;
  const parent = byId("energy-plot"), [plot, whole] = plotWith(parent);
  const kept = ["kinetic", "strain", "links", "contact"], spent = ["plastic", "viscoplastic", "damping", "friction", "impact"];
  let [ticked, stacked] = [[], false];
  const series = i => ({ name: names[i], colour: colour(i), x: history.times, y: history.line(0, names[i]), band: history.band(names[i]) });
  const draw = () => {
    let base = new Float32Array(history.times.length);
    const drawn = ticked.map(i => {
      const one = series(i);
      if (!stacked || ![...kept, ...spent].includes(names[i])) return one;
      const y = base.map((x, t) => x + (one.y[t] || 0));
      const area = { ...one, y, base, own: one.y };
      base = y;
      return area;
    });
    const unit = history.label("kinetic").replace(/^kinetic/, "");
    plot.show(drawn, { x: history.label(history.over), y: (stacked ? "energy, stored and dissipated, stacked" : "energy") + unit });
  };
  keys(whole, names, i => names[i] !== "mechanical", chosen => ((ticked = chosen), draw()));
  const controls = make("div", { className: "controls" }), box = make("input", { type: "checkbox" });
  box.addEventListener("change", () => ((stacked = box.checked), draw()));
  controls.append(make("label", {}, box, " stacked"));
  parent.append(controls);
}

/** Columns of other tables with rows at the same times, for force over displacement: by a label, the table, the place of the name and the column. */
function columnsBeside(history, all) {
  const most = 400, beside = new Map(), { times, over } = history;
  for (const other of all) {
    const alike = other !== history && other.over === over && other.times.length === times.length && other.times.every((t, i) => t === times[i]);
    if (!alike) continue;
    other.names.forEach((name, i) => {
      for (const column of other.columns.filter(column => column !== "step")) {
        if (beside.size < most) beside.set([`${other.file}:`, name, column].filter(Boolean).join(" "), { history: other, name: i, column });
      }
    });
  }
  return beside;
}

function browse(all) {
  const parent = byId("histories-plot"), controls = make("div", { className: "controls" });
  const [plot, whole] = plotWith(parent);
  parent.prepend(controls);
  let list = null, selects = [];
  const open = file => {
    const history = table(file), { names, columns } = history;
    selects.forEach(select => select.parentElement.remove());
    list?.remove();
    // What says most: the displacement that varies most, else the first column.
    const reach = name => {
      const lines = names.slice(0, 50).map((_, i) => range([history.line(i, name)]));
      return Math.max(...lines.map(([least, most]) => most - least));
    };
    const motions = columns.filter(name => ["ux", "uy", "uz"].includes(name));
    let y = motions.length ? motions.reduce((a, b) => (reach(b) > reach(a) ? b : a)) : columns.find(name => name !== "step");
    const others = columnsBeside(history, all);
    let [x, ticked] = [history.over, []];
    const along = i => {
      if (x === history.over) return history.times;
      const other = others.get(x);
      return other ? other.history.line(other.name, other.column) : history.line(i, x);
    };
    const draw = () => {
      const series = ticked.map(i => ({
        name: names[i] || y,
        colour: colour(i),
        x: along(i),
        y: y === history.over ? history.times : history.line(i, y),
        band: history.band(y),
      }));
      plot.show(series, { x: history.label(x), y: history.label(y) });
    };
    selects = [
      choice(controls, "Column", [...columns, history.over], y, value => ((y = value), draw())),
      choice(controls, "over", [history.over, ...columns, ...others.keys()], x, value => ((x = value), draw())),
    ];
    list = keys(whole, names, i => i < 6, chosen => ((ticked = chosen), draw()));
  };
  choice(controls, "Table", all.map(history => history.file), all[0].file, open);
  open(all[0].file);
}

function steps(history) {
  const [plot, whole] = plotWith(byId("steps-plot"));
  const columns = history.columns.filter(name => name !== "step");
  // A load that falls is at one time more than once.
  const falls = history.times.some((t, i) => i > 0 && t < history.times[i - 1]);
  const over = falls && history.columns.includes("step") ? "step" : "time";
  const x = over === "step" ? history.line(0, "step") : history.times;
  const show = i => plot.show([{ name: columns[i], colour: colour(i), x, y: history.line(0, columns[i]) }], { x: history.label(over), y: history.label(columns[i]) });
  const list = make("div", { className: "keys" });
  columns.forEach((name, i) => {
    const pick = make("input", { type: "radio", name: "steps", checked: name === "iterations" });
    pick.addEventListener("change", () => show(i));
    list.append(make("label", {}, pick, name));
  });
  whole.append(list);
  show(Math.max(0, columns.indexOf("iterations")));
}

const rgb = text => [1, 3, 5].map(i => parseInt(text.slice(i, i + 2), 16) / 255);
const wordy = field => field.replaceAll("_", " ").replace("von mises", "von Mises");

function stage(from) {
  byId("scene").hidden = false;
  const scene = new Scene(from), overlay = byId("overlay");
  let painter, canvas;
  try {
    [painter, canvas] = painterFor(byId("stage"), scene);
  } catch (problem) {
    document.querySelector(".stage").textContent = `The scene cannot be drawn: ${problem.message}.`;
    return;
  }
  const camera = new Camera(...scene.box()), last = scene.times.length - 1;
  const [slider, play, magnify, select] = ["time", "play", "magnify", "field"].map(byId);
  slider.max = last;
  // Marks where stages begin.
  const ticks = make("datalist", { id: "stages" });
  if (!from.modes.length) for (const [name, end] of DATA.stages.slice(0, -1)) {
    const frame = scene.times.findLastIndex(time => time <= end * (1 + 1e-6));
    if (frame >= 0) ticks.append(make("option", { value: frame, label: name }));
  }
  slider.after(ticks);
  slider.setAttribute("list", "stages");
  const present = [...scene.fields.keys()], first = ["von_mises", "plastic_strain"].filter(name => present.includes(name));
  const offered = ["none", "displacement", ...first, ...present.filter(name => !first.includes(name))];
  for (const name of offered) select.append(make("option", { value: name, textContent: wordy(name) }));
  select.value = first[0] ?? "displacement";
  const unit = field => from.units[field === "displacement" ? field : /^(von_mises|sigma|tau)/.test(field) ? "stress" : ""] ?? "";
  const ranges = new Map(), rangeOf = field => ranges.get(field) ?? ranges.set(field, scene.range(field)).get(field);
  byId("names-label").hidden = !scene.labels.length;
  const marks = new Marks(scene.marks);
  byId("marks-label").hidden = !marks.some;
  if (scene.edges.length > 60000) byId("edges").checked = false;

  let [waiting, playing] = [false, null];
  const draw = () => {
    waiting = false;
    const frame = +slider.value, field = select.value, shown = field !== "none";
    const [least, most] = shown ? rangeOf(field) : [0, 0];
    const smooth = shown && field !== "displacement" && byId("smooth").checked;
    const factor = Number.isFinite(magnify.valueAsNumber) ? magnify.valueAsNumber : 1;
    const seen = painter.draw({
      camera, least, most,
      at: scene.place(frame, factor),
      ghost: byId("ghost").checked,
      edges: byId("edges").checked,
      values: shown ? (smooth ? scene.smooth(scene.values(field, frame)) : scene.values(field, frame)) : null,
      byPoint: smooth || field === "displacement",
      ink: rgb(style("--ink")),
      line: rgb(style("--faint")),
      plain: dark() ? [0.5, 0.53, 0.57] : [0.72, 0.74, 0.77],
    });
    const mode = from.modes[Math.floor(scene.times[frame]) - 1];
    const within = mode ? null : DATA.stages.find(([, end]) => scene.times[frame] <= end * (1 + 1e-6));
    byId("clock").textContent = mode ?? `t = ${few(scene.times[frame], 5)}${from.clock}${within ? `, ${within[0]}` : ""}`;
    byId("legend").hidden = !shown;
    byId("legend-name").textContent = wordy(field) + (unit(field) && ` (${unit(field)})`);
    byId("legend-least").textContent = few(least);
    byId("legend-most").textContent = few(most);
    aside(seen);
  };
  const later = () => waiting || ((waiting = true), requestAnimationFrame(draw));

  /** Axes in the corner, and names. */
  const aside = ({ M, width, height }) => {
    const { scale } = fit(overlay), c = overlay.getContext("2d"), [right, up] = camera.axes();
    c.setTransform(scale, 0, 0, scale, 0, 0);
    c.clearRect(0, 0, width, height);
    c.font = "12px system-ui, sans-serif";
    ["x", "y", "z"].forEach((name, i) => {
      const [x, y] = [44 + 26 * right[i], height - 44 - 26 * up[i]];
      c.strokeStyle = c.fillStyle = ["#d9534f", "#3c9d4e", "#4a7fe0"][i];
      c.lineWidth = 2;
      c.beginPath();
      c.moveTo(44, height - 44);
      c.lineTo(x, y);
      c.stroke();
      c.fillText(name, 41 + 36 * right[i], height - 40 - 36 * up[i]);
    });
    if (marks.some && byId("marks").checked) marks.draw(c, { M, width, height, at: scene.at, length: 0.12 * camera.whole });
    if (!scene.labels.length || !byId("names").checked || scene.labels.length > 200) return;
    c.fillStyle = style("--faint");
    scene.labels.forEach((label, i) => {
      const place = project(M, scene.at.subarray(3 * i, 3 * i + 3), width, height);
      if (place) c.fillText(label, place[0] + 7, place[1] - 5);
    });
  };

  const stop = () => {
    cancelAnimationFrame(playing?.id);
    playing = null;
    play.textContent = "Play";
  };
  // As long for any run: some seconds from its first time to its last.
  const seconds = Math.min(8, Math.max(3, scene.times.length / 20));
  const tick = now => {
    playing.id = requestAnimationFrame(tick);
    const frame = playing.frame + ((now - playing.since) / 1000 / seconds) * last;
    slider.value = Math.floor(frame) % (last + 1);
    draw();
  };
  play.addEventListener("click", () => {
    if (playing) return stop();
    playing = { frame: +slider.value, since: performance.now() };
    play.textContent = "Pause";
    playing.id = requestAnimationFrame(tick);
  });
  slider.addEventListener("input", () => (stop(), later()));
  for (const id of ["magnify", "field", "smooth", "edges", "ghost", "marks", "names"]) byId(id).addEventListener("input", later);
  for (const button of document.querySelectorAll("[data-view]")) {
    button.addEventListener("click", () => {
      const view = button.dataset.view;
      if (view === "fit") {
        camera.box = scene.box(magnify.valueAsNumber || 1);
        camera.fit();
      } else {
        camera.from(view);
      }
      later();
    });
  }

  const fingers = new Map();
  canvas.addEventListener("pointerdown", event => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  canvas.addEventListener("pointermove", event => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const now = [event.clientX, event.clientY], [dx, dy] = minus(now, before);
    const other = [...fingers].find(([id]) => id !== event.pointerId)?.[1];
    if (other) camera.zoom(Math.hypot(...minus(before, other)) / (Math.hypot(...minus(now, other)) || 1));
    else if (event.shiftKey || event.buttons & 6) camera.shift(dx, dy, canvas.clientHeight);
    else camera.turn(dx, dy);
    fingers.set(event.pointerId, now);
    later();
  });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, event => fingers.delete(event.pointerId));
  canvas.addEventListener("contextmenu", event => event.preventDefault());
  canvas.addEventListener("wheel", event => {
    event.preventDefault();
    camera.zoom(Math.exp(0.0012 * event.deltaY));
    later();
  }, { passive: false });
  new ResizeObserver(later).observe(canvas);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", later);

  const bar = byId("legend-bar"), ink = bar.getContext("2d");
  for (let x = 0; x < bar.width; x++) {
    ink.fillStyle = `rgb(${scaleColour(x / (bar.width - 1))})`;
    ink.fillRect(x, 0, 1, bar.height);
  }
  draw();
}

async function start() {
  await unpack();
  histories = DATA.histories.map(from => new History(from));
  const plain = histories.filter(history => history.columns.some(name => name !== "step"));
  const shown = [["energy", table("energy.csv"), energy], ["steps", table("steps.csv"), steps]];
  for (const [id, history, show] of shown) {
    byId(id).hidden = !history;
    if (history) show(history);
  }
  byId("histories").hidden = !plain.length;
  if (plain.length) browse(plain);
  if (DATA.scene) stage(DATA.scene);
}
start().catch(problem => document.body.prepend(make("p", { textContent: `The plots cannot be drawn: ${problem.message}. A browser of 2023 or newer is needed.` })));
