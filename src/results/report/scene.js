// The moving scene in WebGL 2: faces with flat light, lines as strips of some width, points as discs, edges as hairlines.

const FACES = [`#version 300 es
in vec3 p; in float v; uniform mat4 M; out float value; out vec3 at;
void main() { gl_Position = M * vec4(p, 1.0); value = v; at = p; }`, `#version 300 es
precision highp float; in float value; in vec3 at; uniform sampler2D scale; uniform vec3 plain, toward; out vec4 colour;
void main() {
  vec3 n = normalize(cross(dFdx(at), dFdy(at)));
  float light = 0.7 + 0.3 * abs(dot(n, toward));
  vec3 c = value < -0.5 ? plain : texture(scale, vec2(value, 0.5)).rgb;
  colour = vec4(c * light, 1.0);
}`];
const STRIPS = [`#version 300 es
in vec3 p, q; in float side, v; uniform mat4 M; uniform vec2 size; uniform float width; out float value;
void main() {
  vec4 a = M * vec4(p, 1.0), b = M * vec4(q, 1.0);
  vec2 along = (b.xy / b.w - a.xy / a.w) * size;
  along = length(along) > 1e-6 ? normalize(along) : vec2(1.0, 0.0);
  a.xy += side * width * vec2(-along.y, along.x) / size * a.w;
  a.z -= 2e-4 * a.w;
  gl_Position = a; value = v;
}`, `#version 300 es
precision highp float; in float value; uniform sampler2D scale; uniform vec4 plain; out vec4 colour;
void main() { colour = value < -0.5 ? plain : vec4(texture(scale, vec2(value, 0.5)).rgb, 1.0); }`];
const DISCS = [`#version 300 es
in vec3 p; in float v; uniform mat4 M; uniform float width; out float value;
void main() { gl_Position = M * vec4(p, 1.0); gl_Position.z -= 3e-4 * gl_Position.w; gl_PointSize = width; value = v; }`, `#version 300 es
precision highp float; in float value; uniform sampler2D scale; uniform vec4 plain; out vec4 colour;
void main() {
  if (length(gl_PointCoord - 0.5) > 0.5) discard;
  colour = value < -0.5 ? plain : vec4(texture(scale, vec2(value, 0.5)).rgb, 1.0);
}`];

// Blue over green to red, to be seen on light and on dark.
const SCALE = [[66, 92, 205], [52, 148, 206], [62, 178, 140], [150, 196, 66], [236, 186, 52], [236, 122, 46], [207, 48, 48]];
const scaleColour = s => {
  const x = Math.max(0, Math.min(1, s)) * (SCALE.length - 1), i = Math.min(Math.floor(x), SCALE.length - 2);
  return SCALE[i].map((c, k) => Math.round(c + (x - i) * (SCALE[i + 1][k] - c)));
};

const [BEAM, BAR, SHELL, LINK, BODY] = [0, 1, 2, 3, 4];
/** Stresses that beams alone have. */
const OF_BEAMS = ["sigma_max", "sigma_min", "tau_max"];

class Scene {
  constructor(from) {
    Object.assign(this, { labels: from.labels, kinds: bytes(from.kinds) });
    for (const key of ["times", "x0", "u"]) this[key] = floats(from[key]);
    for (const key of ["triangles", "triangleCells", "lines", "lineCells", "edges"]) this[key] = places(from[key]);
    this.fields = new Map(from.fields.map(field => [field.name, floats(field.values)]));
    this.count = this.x0.length / 3;
    this.marks = from.marks;
    this.extrude(from.marks);
    const [bottom, top] = ["von_mises_bottom", "von_mises_top"].map(name => this.fields.get(name));
    if (bottom && top) {
      const beams = this.fields.get("von_mises");
      this.fields.set("von_mises", bottom.map((x, i) => Math.max(x, top[i], beams ? beams[i] : 0)));
      this.stressed = beams ? [BEAM, SHELL] : [SHELL];
    } else this.stressed = [BEAM];
    this.at = new Float32Array(this.x0.length + 3 * this.corners.length);
  }

  /** Adds faces around the lines of beams with a section: corners hang on a point, and turn with the line. */
  extrude({ sections, sectionY, cellSections }) {
    this.corners = [];
    if (!sectionY) return;
    const of = bytes(cellSections), y = floats(sectionY), triangles = [...this.triangles], cells = [...this.triangleCells];
    const circle = radius => Array.from({ length: 12 }, (_, i) => [Math.cos(i * Math.PI / 6), Math.sin(i * Math.PI / 6)].map(x => radius * x));
    const rims = ({ radius, walls, y, z }) => radius
      ? [circle(radius)]
      : (walls ?? [[...y, ...z]]).map(([left, right, low, high]) => [[left, low], [right, low], [right, high], [left, high]]);
    for (let i = 0; i < this.lines.length; i += 2) {
      const cell = this.lineCells[i / 2], section = of[cell];
      if (!section) continue;
      const ends = [this.lines[i], this.lines[i + 1]];
      for (const round of rims(sections[section - 1])) {
        const n = round.length, first = this.count + this.corners.length;
        for (const point of ends) for (const [a, b] of round) this.corners.push({ point, ends, axis: y.subarray(3 * point, 3 * point + 3), a, b });
        const face = (...points) => (triangles.push(...points.map(k => first + k)), cells.push(cell));
        for (let k = 0; k < n; k++) {
          const next = (k + 1) % n;
          face(k, next, n + next), face(k, n + next, n + k);
          if (k > 1) face(0, k - 1, k), face(n, n + k, n + k - 1);
        }
      }
    }
    [this.triangles, this.triangleCells] = [Uint32Array.from(triangles), Uint32Array.from(cells)];
  }

  /** The point that a corner hangs on, or the point itself. */
  base(point) {
    return point < this.count ? point : this.corners[point - this.count].point;
  }

  /** Positions at a frame, displacements magnified. */
  place(frame, factor) {
    const { x0, u, at } = this, first = frame * x0.length;
    for (let i = 0; i < x0.length; i++) at[i] = x0[i] + factor * u[first + i];
    this.corners.forEach(({ point, ends: [from, to], axis, a, b }, k) => {
      const t = unit([0, 1, 2].map(i => at[3 * to + i] - at[3 * from + i])), along = t[0] * axis[0] + t[1] * axis[1] + t[2] * axis[2];
      const y = unit(t.map((x, i) => axis[i] - along * x)), z = cross(t, y);
      for (let i = 0; i < 3; i++) at[3 * (this.count + k) + i] = at[3 * point + i] + a * y[i] + b * z[i];
    });
    return at;
  }

  /** Least and most of each coordinate, over all frames. */
  box(factor = 1) {
    const [least, most] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
    for (let frame = 0; frame < this.times.length; frame++) {
      this.place(frame, factor).forEach((x, i) => {
        if (!Number.isFinite(x)) return;
        least[i % 3] = Math.min(least[i % 3], x);
        most[i % 3] = Math.max(most[i % 3], x);
      });
    }
    return [least, most];
  }

  /** Numbers to colour by at a frame: by point for displacements, else by cell; NaN where a cell has none. */
  values(field, frame) {
    if (field === "displacement") {
      const first = frame * this.x0.length, { u } = this;
      return Float32Array.from({ length: this.count }, (_, i) => Math.hypot(u[first + 3 * i], u[first + 3 * i + 1], u[first + 3 * i + 2]));
    }
    const cells = this.kinds.length, all = this.fields.get(field).subarray(frame * cells, (frame + 1) * cells);
    const of = new Map([["plastic_strain", [BEAM, BAR, SHELL]], ["von_mises", this.stressed], ...OF_BEAMS.map(name => [name, [BEAM]])]);
    const carrying = of.get(field) ?? [SHELL], has = kind => carrying.includes(kind);
    return all.map((x, cell) => (has(this.kinds[cell]) ? x : NaN));
  }

  /** Values of cells as values of points: the mean over the faces round a point, or else over its lines. */
  smooth(ofCells) {
    this.around ??= [[this.triangles, this.triangleCells, 3], [this.lines, this.lineCells, 2]].map(([points, cells, size]) => {
      const pairs = new Map();
      points.forEach((corner, i) => {
        const point = this.base(corner), cell = cells[Math.floor(i / size)];
        pairs.set(point * this.kinds.length + cell, [point, cell]);
      });
      return [...pairs.values()];
    });
    const mean = new Float32Array(this.count).fill(NaN);
    for (const pairs of this.around) {
      const [sum, many] = [new Float32Array(this.count), new Uint32Array(this.count)];
      for (const [point, cell] of pairs) if (Number.isFinite(ofCells[cell])) (sum[point] += ofCells[cell]), many[point]++;
      many.forEach((count, point) => count && Number.isNaN(mean[point]) && (mean[point] = sum[point] / count));
    }
    return mean;
  }

  range(field) {
    let [least, most] = [Infinity, -Infinity];
    for (let frame = 0; frame < this.times.length; frame++) {
      for (const x of this.values(field, frame)) if (Number.isFinite(x)) (least = Math.min(least, x)), (most = Math.max(most, x));
    }
    return least <= most ? [least, most] : [0, 0];
  }
}

class Painter {
  constructor(canvas, scene) {
    this.gl = canvas.getContext("webgl2", { antialias: true, alpha: true, premultipliedAlpha: false, preserveDrawingBuffer: true });
    if (!this.gl) throw new Error("this browser has no WebGL 2");
    Object.assign(this, { canvas, scene });
    const { gl } = this;
    this.programs = [FACES, STRIPS, DISCS].map(sources => this.program(sources));
    this.buffers = new Map();
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    const pixels = new Uint8Array(256 * 4);
    for (let i = 0; i < 256; i++) pixels.set([...scaleColour(i / 255), 255], 4 * i);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    this.strip = this.strips(scene.lines);
    this.hair = this.strips(scene.edges);
  }

  program(sources) {
    const { gl } = this, program = gl.createProgram();
    sources.forEach((source, i) => {
      const shader = gl.createShader(i ? gl.FRAGMENT_SHADER : gl.VERTEX_SHADER);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    });
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program) || "no shaders");
    return program;
  }

  /** Two triangles a segment: for each corner its point, the other end, its side. */
  strips(lines) {
    const near = [], other = [], side = [];
    for (let i = 0; i < lines.length; i += 2) {
      const [a, b] = [lines[i], lines[i + 1]];
      // Seen from its other end a corner lies on the other side.
      near.push(a, a, b, b, a, b), other.push(b, b, a, a, b, a), side.push(1, -1, 1, 1, 1, -1);
    }
    return { near, other, side: new Float32Array(side), count: near.length };
  }

  attribute(program, name, data, size) {
    const { gl } = this, key = `${name} ${this.programs.indexOf(program)}`, at = gl.getAttribLocation(program, name);
    if (at < 0) return;
    if (!this.buffers.has(key)) this.buffers.set(key, gl.createBuffer());
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers.get(key));
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, size, gl.FLOAT, false, 0, 0);
  }

  /** Draws a frame; `values` by point or cell, on the scale from `least` to `most`. */
  draw({ camera, at, ghost, values, byPoint, least, most, edges, ink, line, plain }) {
    const { gl, scene, canvas } = this, { width, height, scale } = fit(canvas);
    const M = camera.matrix(width / height), [, , toward] = camera.axes();
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    const over = most > least ? 1 / (most - least) : 0;
    const shade = (point, cell) => {
      const x = values ? values[byPoint ? scene.base(point) : cell] : NaN;
      return Number.isFinite(x) ? (x - least) * over : -1;
    };
    const points = (list, from = at) => {
      const out = new Float32Array(3 * list.length);
      for (let i = 0; i < list.length; i++) for (let k = 0; k < 3; k++) out[3 * i + k] = from[3 * list[i] + k];
      return out;
    };
    const use = (program, uniforms) => {
      gl.useProgram(program);
      gl.uniformMatrix4fv(gl.getUniformLocation(program, "M"), false, M);
      for (const [name, value] of Object.entries(uniforms)) {
        const at = gl.getUniformLocation(program, name);
        typeof value === "number" ? gl.uniform1f(at, value) : gl[`uniform${value.length}fv`](at, value);
      }
    };
    const strip = (of, from, width, colour, shades) => {
      const [, program] = this.programs;
      use(program, { size: [canvas.width, canvas.height], width: width * scale, plain: colour });
      this.attribute(program, "p", points(of.near, from), 3);
      this.attribute(program, "q", points(of.other, from), 3);
      this.attribute(program, "side", of.side, 1);
      this.attribute(program, "v", shades ?? new Float32Array(of.count).fill(-1), 1);
      gl.drawArrays(gl.TRIANGLES, 0, of.count);
    };

    if (scene.triangles.length) {
      const [program] = this.programs, { triangles, triangleCells } = scene;
      use(program, { plain, toward });
      gl.enable(gl.POLYGON_OFFSET_FILL);
      gl.polygonOffset(2, 2);
      this.attribute(program, "p", points(triangles), 3);
      this.attribute(program, "v", Float32Array.from(triangles, (point, i) => shade(point, triangleCells[Math.floor(i / 3)])), 1);
      gl.drawArrays(gl.TRIANGLES, 0, triangles.length);
      gl.disable(gl.POLYGON_OFFSET_FILL);
    }
    if (this.strip.count) {
      const shades = Float32Array.from(this.strip.near, (point, i) => shade(point, scene.lineCells[Math.floor(i / 6)]));
      strip(this.strip, at, 3, [...ink, 1], shades);
    }
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    if (edges && this.hair.count) strip(this.hair, at, 1, [...ink, 0.35]);
    if (ghost) {
      if (this.strip.count) strip(this.strip, scene.x0, 1.5, [...line, 1]);
      if (this.hair.count) strip(this.hair, scene.x0, 1, [...line, 1]);
    }
    gl.disable(gl.BLEND);
    if (scene.labels.length) {
      const [, , program] = this.programs, all = Uint32Array.from({ length: scene.count }, (_, i) => i);
      use(program, { width: 9 * scale, plain: [...ink, 1] });
      this.attribute(program, "p", at, 3);
      this.attribute(program, "v", Float32Array.from(all, point => shade(byPoint ? point : -1)), 1);
      gl.drawArrays(gl.POINTS, 0, scene.count);
    }
    return { M, width, height };
  }
}
