"use strict";
// Scatter plots and a sortable table of the cases of a sweep; the numbers stand in the page itself.

const { columns, rows, folders, varied, collected } = JSON.parse(document.getElementById("data").textContent);
const byId = id => document.getElementById(id);
const colour = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const make = (tag, properties = {}, ...children) => {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
};
const number = text => (text.trim() === "" ? NaN : Number(text));
const few = x => (x !== 0 && (Math.abs(x) < 1e-3 || Math.abs(x) >= 1e6) ? x.toExponential(2) : String(+x.toPrecision(4)));
// Numbers of a run have up to 17 digits.
const shown = text => (text.length > 9 && !Number.isNaN(number(text)) ? String(+number(text).toPrecision(7)) : text);

/** A choice among columns, given by their places. */
function choice(label, places, first, chosen) {
  const select = make("select");
  for (const place of places) select.append(make("option", { value: place, textContent: columns[place] }));
  select.value = first;
  select.addEventListener("change", () => chosen(Number(select.value)));
  byId("controls").append(make("label", {}, label, " ", select), " ");
}

/** Draws one number of each case over another; cases without a number are left out. */
function scatter(x, y) {
  const canvas = byId("scatter"), scale = window.devicePixelRatio || 1;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  Object.assign(canvas, { width: width * scale, height: height * scale });
  const c = canvas.getContext("2d");
  c.setTransform(scale, 0, 0, scale, 0, 0);
  c.clearRect(0, 0, width, height);
  const points = rows.map((row, k) => [number(row[x]), number(row[y]), k]).filter(([a, b]) => Number.isFinite(a) && Number.isFinite(b));
  const span = values => {
    const [least, most] = [Math.min(...values), Math.max(...values)], pad = 0.05 * (most - least) || Math.abs(least) || 1;
    return [least - pad, most + pad];
  };
  c.font = "12px system-ui, sans-serif";
  c.fillStyle = colour("--faint");
  if (!points.length) return c.fillText("no case has numbers in both columns", 20, 30);
  const [x0, x1] = span(points.map(p => p[0])), [y0, y1] = span(points.map(p => p[1]));
  const X = a => 70 + ((a - x0) / (x1 - x0)) * (width - 90), Y = b => height - 34 - ((b - y0) / (y1 - y0)) * (height - 60);
  c.strokeStyle = colour("--line");
  c.strokeRect(70, 26, width - 90, height - 60);
  for (let k = 0; k <= 4; k++) {
    const [a, b] = [x0 + ((x1 - x0) * k) / 4, y0 + ((y1 - y0) * k) / 4];
    c.textAlign = "center";
    c.fillText(few(a), X(a), height - 16);
    c.textAlign = "right";
    c.fillText(few(b), 64, Y(b) + 4);
  }
  c.textAlign = "left";
  c.fillText(columns[y], 70, 16);
  c.textAlign = "right";
  c.fillText(columns[x], width - 20, height - 2);
  c.fillStyle = colour("--accent");
  for (const [a, b] of points) {
    c.beginPath();
    c.arc(X(a), Y(b), 3, 0, 7);
    c.fill();
  }
}

/** Shows the rows in the order of a column; a second click turns it round. */
let [sorted, upwards] = [0, true];
function table() {
  const order = rows.map((_, k) => k).sort((a, b) => {
    const [p, q] = [rows[a][sorted], rows[b][sorted]], [m, n] = [number(p), number(q)];
    const way = Number.isNaN(m) || Number.isNaN(n) ? p.localeCompare(q) : m - n;
    return (upwards ? way : -way) || a - b;
  });
  const head = make("tr");
  columns.forEach((name, place) => {
    const cell = make("th", { textContent: name + (place === sorted ? (upwards ? " ↑" : " ↓") : "") });
    cell.style.cursor = "pointer";
    cell.addEventListener("click", () => {
      [sorted, upwards] = [place, place === sorted ? !upwards : true];
      table();
    });
    head.append(cell);
  });
  const body = make("tbody");
  for (const k of order) {
    const row = make("tr");
    rows[k].forEach((text, place) => row.append(make("td", { title: text }, place || !folders[k] ? shown(text) : make("a", { href: folders[k] + "/", textContent: text }))));
    body.append(row);
  }
  byId("cases").replaceChildren(make("thead", {}, head), body);
}

let [x, y] = [varied[0], collected[0]];
const draw = () => scatter(x, y);
if (varied.length && collected.length) {
  choice("over", [...varied, ...collected], x, place => ((x = place), draw()));
  choice("shown", collected, y, place => ((y = place), draw()));
  new ResizeObserver(draw).observe(byId("scatter"));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
} else {
  byId("plot").hidden = true;
}
table();
