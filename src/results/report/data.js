"use strict";
// The numbers of the page: places of cells are base64 of little-endian arrays; all others are in one packed text.

const DATA = JSON.parse(document.getElementById("data").textContent);

function bytes(base64) {
  const text = atob(base64), out = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) out[i] = text.charCodeAt(i);
  return out;
}
let UNPACKED = new Uint8Array();
async function unpack() {
  const packed = new Blob([bytes(JSON.parse(document.getElementById("packed").textContent))]);
  UNPACKED = new Uint8Array(await new Response(packed.stream().pipeThrough(new DecompressionStream("deflate"))).arrayBuffer());
}
/** Rows of a width from the unpacked bytes: the highest bytes of all numbers first, column by column. */
function floats([place, count, width]) {
  const out = new Float32Array(count), whole = new Uint32Array(out.buffer);
  for (let column = 0, at = place; column < width; column++) {
    for (let i = column; i < count; i += width, at++) {
      whole[i] = (UNPACKED[at] << 24) | (UNPACKED[at + count] << 16) | (UNPACKED[at + 2 * count] << 8) | UNPACKED[at + 3 * count];
    }
  }
  return out;
}
const places = base64 => new Uint32Array(bytes(base64).buffer);

/** A table over time: `line(name, column)` is one number a time. */
class History {
  constructor(from) {
    Object.assign(this, { file: from.file, over: from.over, names: from.names, columns: from.columns, kinds: from.kinds, labels: from.labels, bands: from.bands, overLabel: from.over_label });
    this.times = floats(from.times);
    this.values = floats(from.values);
  }
  /** What a column is, with its unit, for an axis. */
  label(column) {
    return column === this.over ? this.overLabel : (this.labels[this.columns.indexOf(column)] ?? column);
  }
  /** Half the width of the band within which the error of a column lies; 0 where it is not known. */
  band(column) {
    return this.bands[this.columns.indexOf(column)] ?? 0;
  }
  line(name, column) {
    const { names, columns, values } = this;
    const stride = names.length * columns.length, first = name * columns.length + columns.indexOf(column);
    return Float32Array.from(this.times, (_, t) => values[t * stride + first]);
  }
}

/** A number in a few digits. */
function few(x, digits = 4) {
  if (!Number.isFinite(x)) return "";
  const size = Math.abs(x);
  return size !== 0 && (size < 1e-3 || size >= 1e6) ? x.toExponential(digits - 2) : String(+x.toPrecision(digits));
}

const style = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const dark = () => matchMedia("(prefers-color-scheme: dark)").matches;

/** Makes an element: `make("label", { className: "x" }, child, "text")`. */
function make(tag, properties = {}, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}

/** Fits a canvas to its size on the page, in device pixels. */
function fit(canvas) {
  const scale = window.devicePixelRatio || 1;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  const [w, h] = [Math.round(width * scale), Math.round(height * scale)];
  if (canvas.width !== w || canvas.height !== h) Object.assign(canvas, { width: w, height: h });
  return { width, height, scale };
}
