// The moving scene where there is no WebGL 2: the same picture on a plain 2D canvas, faces from the farthest to the nearest.

class FlatPainter {
  constructor(canvas, scene) {
    this.c = canvas.getContext("2d");
    if (!this.c) throw new Error("this browser draws on no canvas");
    Object.assign(this, { canvas, scene });
  }

  /** Draws a frame, as `Painter.draw` does. */
  draw({ camera, at, ghost, values, byPoint, least, most, edges, ink, line, plain }) {
    const { c, scene, canvas } = this, { width, height, scale } = fit(canvas);
    const M = camera.matrix(width / height), [, , toward] = camera.axes();
    c.setTransform(scale, 0, 0, scale, 0, 0);
    c.clearRect(0, 0, width, height);
    c.lineCap = c.lineJoin = "round";
    const over = most > least ? 1 / (most - least) : 0;
    const css = colour => `rgb(${colour.slice(0, 3).map(x => Math.round(255 * x)).join()})`;
    const shade = (other, points, cell) => {
      let x = values ? values[cell] : NaN;
      if (values && byPoint) x = points.reduce((sum, point) => sum + values[scene.base(point)], 0) / points.length;
      return Number.isFinite(x) ? scaleColour((x - least) * over).map(x => x / 255) : other;
    };
    const flat = from => {
      const out = new Array(from.length / 3);
      for (let i = 0; i < out.length; i++) out[i] = project(M, from.subarray(3 * i, 3 * i + 3), width, height);
      return out;
    };
    const on = flat(at), strokes = (list, places, wide, colour) => {
      c.lineWidth = wide;
      for (let i = 0; i < list.length; i += 2) {
        const ends = [list[i], list[i + 1]], [a, b] = ends.map(point => places[point]);
        if (!a || !b) continue;
        c.strokeStyle = colour(ends, i / 2);
        c.beginPath();
        c.moveTo(...a);
        c.lineTo(...b);
        c.stroke();
      }
    };
    this.faces(on, at, toward, (points, cell) => shade(plain, points, cell));
    strokes(scene.lines, on, 3, (ends, i) => css(shade(ink, ends, scene.lineCells[i])));
    c.globalAlpha = 0.35;
    if (edges) strokes(scene.edges, on, 1, () => css(ink));
    c.globalAlpha = 1;
    if (ghost) {
      const before = flat(scene.x0);
      strokes(scene.lines, before, 1.5, () => css(line));
      strokes(scene.edges, before, 1, () => css(line));
    }
    if (scene.labels.length) on.forEach((place, point) => {
      if (!place) return;
      c.fillStyle = css(byPoint ? shade(ink, [point]) : ink);
      c.beginPath();
      c.arc(...place, 4.5, 0, 7);
      c.fill();
    });
    return { M, width, height };
  }

  /** Triangles by the distance of their centres along the view, each with flat light. */
  faces(on, at, toward, colour) {
    const { c, scene: { triangles, triangleCells } } = this, count = triangles.length / 3;
    const corner = (i, k) => [0, 1, 2].map(j => at[3 * triangles[3 * i + k] + j]);
    const depth = new Float32Array(count), order = new Uint32Array(count);
    for (let i = 0; i < count; i++) {
      order[i] = i;
      for (let k = 0; k < 3; k++) for (let j = 0; j < 3; j++) depth[i] += toward[j] * at[3 * triangles[3 * i + k] + j];
    }
    order.sort((a, b) => depth[a] - depth[b] || a - b);
    c.lineWidth = 0.7;
    for (const i of order) {
      const points = [0, 1, 2].map(k => triangles[3 * i + k]), places = points.map(point => on[point]);
      if (places.some(place => !place)) continue;
      const [a, b, d] = [0, 1, 2].map(k => corner(i, k)), n = cross(minus(b, a), minus(d, a)), size = Math.hypot(...n) || 1;
      const light = 0.7 + 0.3 * Math.abs(n.reduce((sum, x, j) => sum + x * toward[j], 0)) / size;
      c.fillStyle = c.strokeStyle = `rgb(${colour(points, triangleCells[i]).map(x => Math.round(255 * light * x)).join()})`;
      c.beginPath();
      places.forEach(place => c.lineTo(...place));
      c.closePath();
      c.fill();
      // Closes the seams between neighbours.
      c.stroke();
    }
  }
}

/** What draws the scene on a canvas: WebGL 2 where the browser has it. Gives the canvas too: one that has failed takes no other. */
function painterFor(canvas, scene) {
  try {
    return [new Painter(canvas, scene), canvas];
  } catch {
    const fresh = canvas.cloneNode();
    canvas.replaceWith(fresh);
    return [new FlatPainter(fresh, scene), fresh];
  }
}
