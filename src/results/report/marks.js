// Supports, loads and joints over the scene, on a plain 2D canvas: nothing hides them.

const [HELD, LOADED, HINGED] = ["#6f7782", "#d6336c", "#8250df"];

class Marks {
  constructor({ supports, loads, joints }) {
    Object.assign(this, { supports, loads, joints });
    const most = (from, to) => Math.max(...loads.map(row => Math.hypot(...row.slice(from, to))), 0);
    [this.force, this.moment] = [most(4, 7), most(7, 10)];
    this.some = supports.length + loads.length + joints.length > 0;
  }

  /** Draws the marks at positions `at` of all points; `length` is that of the largest arrow, in the units of the scene. */
  draw(c, { M, width, height, at, length }) {
    const place = ([point, ...way]) => [0, 1, 2].map(i => at[3 * point + i] + way[i]);
    const screen = p => project(M, p, width, height);
    c.lineWidth = 1.6;
    for (const row of this.supports) this.support(c, place(row), row[4], screen, length);
    for (const row of this.joints) {
      const p = screen(place(row));
      if (!p) continue;
      c.strokeStyle = HINGED;
      c.beginPath();
      c.arc(...p, 5, 0, 7);
      c.stroke();
    }
    for (const row of this.loads) {
      this.arrow(c, place(row), row.slice(4, 7), this.force, 1, screen, length);
      this.arrow(c, place(row), row.slice(7, 10), this.moment, 2, screen, length);
    }
  }

  /** A square where nothing moves, a triangle where nothing translates, else a bar along each direction that is held. */
  support(c, place, dofs, screen, length) {
    const p = screen(place);
    if (!p) return;
    c.strokeStyle = c.fillStyle = HELD;
    c.beginPath();
    if (dofs === 63) c.rect(p[0] - 5, p[1] - 5, 10, 10);
    else if ((dofs & 7) === 7) c.moveTo(p[0], p[1]), c.lineTo(p[0] + 7, p[1] + 12), c.lineTo(p[0] - 7, p[1] + 12), c.closePath();
    else {
      for (let i = 0; i < 3; i++) {
        const end = dofs & (1 << i) && screen(place.map((x, k) => x - (k === i ? 0.35 * length : 0)));
        if (end) c.moveTo(...p), c.lineTo(...end), c.arc(...end, 2, 0, 7);
      }
      c.arc(...p, 3, 0, 7);
      return c.stroke();
    }
    c.globalAlpha = 0.55;
    c.fill();
    c.globalAlpha = 1;
    c.stroke();
  }

  /** An arrow that ends at a place, or, of a moment, begins there with two heads. */
  arrow(c, place, vector, most, heads, screen, length) {
    const size = Math.hypot(...vector);
    if (size < 1e-6 * most || !size) return;
    const reach = (0.3 + 0.7 * (size / most)) * length, other = place.map((x, i) => x - (heads === 1 ? 1 : -1) * reach * vector[i] / size);
    const [from, to] = (heads === 1 ? [other, place] : [place, other]).map(screen);
    if (!from || !to) return;
    const along = minus(to, from), far = Math.hypot(...along);
    c.strokeStyle = c.fillStyle = LOADED;
    c.beginPath();
    if (far < 3) c.arc(...to, 3, 0, 7);
    else {
      const [ux, uy] = along.map(x => x / far);
      c.moveTo(...from), c.lineTo(...to), c.stroke();
      c.beginPath();
      for (let k = 0; k < heads; k++) {
        const [x, y] = [to[0] - 7 * k * ux, to[1] - 7 * k * uy];
        c.moveTo(x, y), c.lineTo(x - 8 * ux + 3.5 * uy, y - 8 * uy - 3.5 * ux), c.lineTo(x - 8 * ux - 3.5 * uy, y - 8 * uy + 3.5 * ux), c.closePath();
      }
    }
    c.fill();
  }
}
