// Lines over time, or over each other, on a 2D canvas.

const COLOURS = ["#2f7ed8", "#e0662b", "#2a9d5c", "#b44fc0", "#c9a227", "#d43d51", "#17a2b8", "#8d6e63", "#7a7fd6", "#7f8c3a"];
const colour = i => COLOURS[i % COLOURS.length];

/** Round numbers across a range, about `count` of them. */
function ticks(least, most, count) {
  const raw = (most - least) / count, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].find(k => k * power >= raw) * power, out = [];
  for (let k = Math.ceil(least / step - 1e-9); k * step <= most + 1e-9 * step; k++) out.push(+(k * step).toPrecision(12));
  return out;
}

function range(arrays) {
  let [least, most] = [Infinity, -Infinity];
  for (const array of arrays) for (const x of array) if (Number.isFinite(x)) (least = Math.min(least, x)), (most = Math.max(most, x));
  if (least > most) return [0, 1];
  const pad = most > least ? 0 : Math.abs(least) || 1;
  return [least - pad, most + pad];
}

/** A canvas that shows `series`: [{ name, colour, x, y, base, band }], areas down to `base` where there is one, bands of half the width `band`. */
class Plot {
  constructor(parent) {
    this.canvas = make("canvas");
    parent.append(this.canvas);
    this.series = [];
    this.pointer = null;
    this.canvas.addEventListener("pointermove", event => ((this.pointer = [event.offsetX, event.offsetY]), this.draw()));
    this.canvas.addEventListener("pointerleave", () => ((this.pointer = null), this.draw()));
    new ResizeObserver(() => this.draw()).observe(this.canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
  }

  show(series, label) {
    Object.assign(this, { series, label });
    this.draw();
  }

  draw() {
    const { width, height, scale } = fit(this.canvas);
    if (!width) return;
    const c = this.canvas.getContext("2d");
    c.setTransform(scale, 0, 0, scale, 0, 0);
    c.clearRect(0, 0, width, height);
    c.font = "12px system-ui, sans-serif";
    const [x0, x1] = range(this.series.map(s => s.x));
    let [y0, y1] = range(this.series.flatMap(s => (s.base ? [s.y, s.base] : [s.y])));
    [y0, y1] = [y0 - 0.04 * (y1 - y0), y1 + 0.04 * (y1 - y0)];
    const yTicks = ticks(y0, y1, height / 50);
    const left = 14 + Math.max(...yTicks.map(y => c.measureText(few(y)).width)), [right, top, bottom] = [width - 12, 22, height - 24];
    const X = x => left + ((x - x0) / (x1 - x0)) * (right - left), Y = y => bottom - ((y - y0) / (y1 - y0)) * (bottom - top);

    c.lineWidth = 1;
    c.strokeStyle = style("--line");
    c.fillStyle = style("--faint");
    c.beginPath();
    c.textAlign = "right";
    c.textBaseline = "middle";
    for (const y of yTicks) c.moveTo(left, Y(y)), c.lineTo(right, Y(y)), c.fillText(few(y), left - 6, Y(y));
    c.textAlign = "center";
    c.textBaseline = "top";
    for (const x of ticks(x0, x1, Math.max(2, width / 110))) c.moveTo(X(x), top), c.lineTo(X(x), bottom), c.fillText(few(x), X(x), bottom + 6);
    c.stroke();
    if (/^time\b/.test(this.label?.x ?? "")) this.stages(c, X, [left, right, top, bottom]);
    c.textAlign = "left";
    c.fillText(this.label?.y ?? "", left, 4);
    c.textAlign = "right";
    c.fillText(this.label?.x ?? "", right, 4);

    c.save();
    c.beginPath();
    c.rect(left, top - 2, right - left, bottom - top + 4);
    c.clip();
    c.lineJoin = "round";
    for (const s of this.series) this.line(c, s, X, Y);
    c.restore();
    if (this.pointer && this.series.length) this.read(c, X, Y, right);
  }

  /** Marks the ends of stages along the time, and names each where there is room. */
  stages(c, X, [left, right, top, bottom]) {
    c.save();
    c.textAlign = "left";
    let from = left;
    for (const [name, end] of DATA.stages) {
      const to = Math.min(Math.max(X(end), left), right);
      if (c.measureText(name).width < to - from - 6) c.fillText(name, from + 4, top + 2);
      if (to < right - 1) {
        c.setLineDash([4, 4]);
        c.strokeStyle = style("--faint");
        c.beginPath();
        c.moveTo(to, top), c.lineTo(to, bottom);
        c.stroke();
      }
      from = to;
    }
    c.restore();
  }

  line(c, { x, y, base, band, colour }, X, Y) {
    if (base) {
      c.beginPath();
      for (let i = 0; i < x.length; i++) c.lineTo(X(x[i]), Y(y[i]));
      for (let i = x.length - 1; i >= 0; i--) c.lineTo(X(x[i]), Y(base[i]));
      c.globalAlpha = 0.55;
      c.fillStyle = colour;
      c.fill();
      c.globalAlpha = 1;
      return;
    }
    if (band > 0) this.band(c, { x, y, band, colour }, X, Y);
    c.strokeStyle = c.fillStyle = colour;
    c.lineWidth = 1.6;
    c.beginPath();
    const has = i => Number.isFinite(y[i]) && Number.isFinite(x[i]);
    for (let i = 0; i < x.length; i++) if (has(i)) has(i - 1) ? c.lineTo(X(x[i]), Y(y[i])) : c.moveTo(X(x[i]), Y(y[i]));
    c.stroke();
    // A number between gaps, or alone, has no line.
    for (let i = 0; i < x.length; i++) {
      if (!has(i) || has(i - 1) || has(i + 1)) continue;
      c.beginPath();
      c.arc(X(x[i]), Y(y[i]), 2.5, 0, 7);
      c.fill();
    }
  }

  /** What errors leave open on both sides of a line, each piece between gaps for itself. */
  band(c, { x, y, band, colour }, X, Y) {
    c.globalAlpha = 0.18;
    c.fillStyle = colour;
    for (let i = 1; i < x.length; i++) {
      if (![x[i - 1], y[i - 1], x[i], y[i]].every(Number.isFinite)) continue;
      c.beginPath();
      for (const [k, side] of [[i - 1, 1], [i, 1], [i, -1], [i - 1, -1]]) c.lineTo(X(x[k]), Y(y[k] + side * band));
      c.fill();
    }
    c.globalAlpha = 1;
  }

  /** Says what lies under the pointer: the point nearest to it. */
  read(c, X, Y, right) {
    const [px, py] = this.pointer;
    let best = null;
    for (const s of this.series) for (let i = 0; i < s.x.length; i++) {
      const far = Math.hypot(X(s.x[i]) - px, Y(s.y[i]) - py);
      if (far < (best?.far ?? 60)) best = { far, s, i };
    }
    if (!best) return;
    const { s, i } = best, [x, y] = [X(s.x[i]), Y(s.y[i])];
    const text = `${s.name}  ${few(s.x[i], 5)}, ${few(s.own ? s.own[i] : s.y[i], 6)}`, wide = c.measureText(text).width;
    c.fillStyle = s.colour;
    c.beginPath();
    c.arc(x, y, 4, 0, 7);
    c.fill();
    const at = Math.min(x + 10, right - wide - 8), up = Math.max(y - 28, 2);
    c.fillStyle = style("--card");
    c.fillRect(at - 5, up, wide + 10, 20);
    c.strokeStyle = style("--line");
    c.strokeRect(at - 5, up, wide + 10, 20);
    c.fillStyle = style("--ink");
    c.textAlign = "left";
    c.textBaseline = "middle";
    c.fillText(text, at, up + 10);
  }
}

/** Boxes to tick, each with the colour of its line. `change` gets the ticked ones. */
function keys(parent, names, ticked, change) {
  const list = make("div", { className: "keys" });
  const boxes = names.map((name, i) => {
    const box = make("input", { type: "checkbox", checked: ticked(i) });
    const mark = make("i");
    mark.style.background = colour(i);
    list.append(make("label", { title: name }, box, mark, name || "all"));
    box.addEventListener("change", () => change(chosen()));
    return box;
  });
  const chosen = () => boxes.flatMap((box, i) => (box.checked ? [i] : []));
  parent.append(list);
  change(chosen());
  return list;
}
