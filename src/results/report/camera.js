// Where the scene is seen from. Matrices are arrays by columns; z is up.

const minus = (a, b) => a.map((x, i) => x - b[i]);
const unit = a => (size => a.map(x => x / size))(Math.hypot(...a) || 1);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

class Camera {
  constructor(least, most) {
    this.box = [least, most];
    this.home();
  }

  /** From in front, a little from the side and above; straight at a scene that is plane. */
  home() {
    const [least, most] = this.box, size = minus(most, least), whole = Math.hypot(...size) || 1;
    this.fit();
    [this.yaw, this.pitch] = [-1.05, 0.4];
    if (size[1] < 1e-3 * whole) [this.yaw, this.pitch] = [-Math.PI / 2, 0];
    else if (size[2] < 1e-3 * whole) [this.yaw, this.pitch] = [-Math.PI / 2, Math.PI / 2];
    else if (size[0] < 1e-3 * whole) [this.yaw, this.pitch] = [0, 0];
  }

  /** The whole scene over all of time. */
  fit() {
    const [least, most] = this.box;
    this.centre = least.map((x, i) => (x + most[i]) / 2);
    this.whole = Math.hypot(...minus(most, least)) || 1;
    this.distance = 1.4 * this.whole;
  }

  from(axis) {
    [this.yaw, this.pitch] = { x: [0, 0], y: [-Math.PI / 2, 0], z: [-Math.PI / 2, Math.PI / 2] }[axis];
  }

  /** Right, up, and out of the screen. */
  axes() {
    const [cy, sy, cp, sp] = [Math.cos(this.yaw), Math.sin(this.yaw), Math.cos(this.pitch), Math.sin(this.pitch)];
    const out = [cp * cy, cp * sy, sp], right = [-sy, cy, 0];
    return [right, cross(out, right), out];
  }

  turn(dx, dy) {
    this.yaw -= 0.008 * dx;
    this.pitch = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, this.pitch + 0.008 * dy));
  }

  shift(dx, dy, height) {
    const [right, up] = this.axes(), part = (0.83 * this.distance) / height;
    this.centre = this.centre.map((x, i) => x - part * (dx * right[i] - dy * up[i]));
  }

  zoom(factor) {
    this.distance = Math.max(1e-3 * this.whole, Math.min(50 * this.whole, this.distance * factor));
  }

  /** From the scene to the clip cube. */
  matrix(aspect) {
    const [r, u, o] = this.axes(), d = this.distance, f = 2.4;
    const near = Math.max(1e-3 * d, d - 3 * this.whole), far = d + 3 * this.whole;
    const at = axis => -axis.reduce((sum, x, i) => sum + x * this.centre[i], 0);
    const [a, b] = [(far + near) / (near - far), (2 * far * near) / (near - far)];
    // Narrow windows see as much to the sides as wide ones do up and down.
    const g = f * Math.min(1, aspect), rows = [[...r, at(r)].map(x => (g / aspect) * x), [...u, at(u)].map(x => g * x)];
    const depth = [...o, at(o) - d];
    rows.push(depth.map((x, i) => a * x + (i === 3 ? b : 0)), depth.map(x => -x));
    return new Float32Array([0, 1, 2, 3].flatMap(i => rows.map(row => row[i])));
  }
}

/** A point on the screen, in pixels; none behind the eye. */
function project(m, p, width, height) {
  const row = i => m[i] * p[0] + m[4 + i] * p[1] + m[8 + i] * p[2] + m[12 + i], w = row(3);
  return w > 0 ? [(row(0) / w * 0.5 + 0.5) * width, (0.5 - row(1) / w * 0.5) * height] : null;
}
