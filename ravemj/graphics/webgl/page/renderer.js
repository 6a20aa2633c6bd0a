/* Draws what packing.py packs, with WebGL2: lit surfaces, points and lines of constant width. */
"use strict";

const TYPES = { i8: Int8Array, u16: Uint16Array, u32: Uint32Array, f32: Float32Array };

/** Unpack compressed bytes: the document, and a function that returns the array of a name in it. */
async function unpacked(compressed) {
  const stream = new Blob([compressed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = await new Response(stream).arrayBuffer();
  const length = new DataView(bytes).getUint32(0, true);
  const content = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
  const array = ({ at, count, type }) => new TYPES[type](bytes, 4 + length + at, count);
  return { content, array };
}

/** Turn differences into what they are the differences of; sums wrap around. */
function summed(differences) {
  const sums = differences.slice();
  for (let i = 1; i < sums.length; i++) sums[i] += sums[i - 1];
  return sums;
}

/** The columns of a quantized array, each with whole numbers, its least number and its step. */
function columns({ low, step, columns: name }, array) {
  const all = array(name), rows = all.length / low.length;
  return low.map((least, i) => ({ low: least, step: step[i], whole: summed(all.subarray(i * rows, (i + 1) * rows)) }));
}

/* A shape's matrix comes as three rows, for one shape or, with a divisor, for many of one mesh. */
const SURFACE_VERTEX = `#version 300 es
uniform mat4 clip;
uniform vec3 low, step_;
in vec3 position; in vec2 folded; in vec4 row0, row1, row2, rgba;
out vec3 at, normal; out vec4 color;
vec3 unfolded(vec2 square) {
  vec3 n = vec3(square, 1.0 - abs(square.x) - abs(square.y));
  if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
  return n;
}
void main() {
  vec4 p = vec4(low + step_ * position, 1.0);
  at = vec3(dot(row0, p), dot(row1, p), dot(row2, p));
  mat3 m = transpose(mat3(row0.xyz, row1.xyz, row2.xyz));
  mat3 cofactors = mat3(cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1]));
  normal = cofactors * unfolded(max(folded, -1.0));
  color = rgba;
  gl_Position = clip * vec4(at, 1.0);
}`;

/* OpenGL's light as MuJoCo sets it up: ambient, diffuse, and half of the specular light with an exponent of 64. */
const SURFACE_FRAGMENT = `#version 300 es
precision highp float;
const int MOST = 8;
uniform vec3 eye, ambient, diffuse[MOST], specular[MOST], direction[MOST];
uniform int lights; uniform bool isLit; uniform float gloss;
in vec3 at, normal; in vec4 color;
out vec4 pixel;
void main() {
  if (!isLit) { pixel = color; return; }
  vec3 towards = normalize(eye - at), n = normalize(normal);
  if (dot(n, towards) < 0.0) n = -n;
  vec3 light = ambient, shine = vec3(0.0);
  for (int i = 0; i < MOST; i++) {
    if (i >= lights) break;
    float cosine = dot(n, -direction[i]);
    if (cosine <= 0.0) continue;
    light += cosine * diffuse[i];
    shine += pow(max(dot(n, normalize(towards - direction[i])), 0.0), 64.0) * specular[i];
  }
  pixel = vec4(min(color.rgb * light + gloss * shine, 1.0), color.a);
}`;

/* Lines of constant width, and points, which are lines without length. */
const LINE_VERTEX = `#version 300 es
uniform mat4 clip; uniform vec2 size; uniform float near;
in vec2 corner; in vec3 start, end; in float width; in vec4 rgba;
out vec4 color;
void main() {
  vec4 a = clip * vec4(start, 1.0), b = clip * vec4(end, 1.0);
  bool isPoint = start == end;
  if (a.w < near && b.w > near) a = mix(a, b, (near - a.w) / (b.w - a.w));
  if (b.w < near && a.w > near) b = mix(b, a, (near - b.w) / (a.w - b.w));
  vec2 along = (b.xy / b.w - a.xy / a.w) * size;
  along = isPoint || length(along) < 1e-6 ? vec2(1.0, 0.0) : normalize(along);
  vec2 aside = vec2(-along.y, along.x) * corner.y;
  vec4 p = corner.x < 0.0 ? a : b;
  vec2 beyond = isPoint ? along * corner.x : vec2(0.0);
  float nearer = 2e-6 * max(width, 1.0);  // wide lines cover narrow ones in the same place
  gl_Position = p + vec4((aside + beyond) * max(width, 1.0) / size * p.w, -nearer * p.w, 0.0);
  color = rgba;
}`;

const LINE_FRAGMENT = `#version 300 es
precision highp float;
in vec4 color; out vec4 pixel;
void main() { pixel = color; }`;

/** A program with the places of its attributes and uniforms as fields. */
function program(gl, vertex, fragment) {
  const made = gl.createProgram(), places = {};
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
  for (let i = 0; i < gl.getProgramParameter(made, gl.ACTIVE_ATTRIBUTES); i++) {
    const { name } = gl.getActiveAttrib(made, i);
    places[name] = gl.getAttribLocation(made, name);
  }
  for (let i = 0; i < gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS); i++) {
    const { name } = gl.getActiveUniform(made, i);
    places[name.replace("[0]", "")] = gl.getUniformLocation(made, name);
  }
  return { made, ...places };
}

class Renderer {
  /** Raises an error where there is no WebGL2. */
  constructor(canvas) {
    const gl = canvas.getContext("webgl2", { alpha: false, antialias: true });
    if (!gl) throw new Error("this browser has no WebGL2");
    this.gl = gl;
    this.surface = program(gl, SURFACE_VERTEX, SURFACE_FRAGMENT);
    this.line = program(gl, LINE_VERTEX, LINE_FRAGMENT);
    this.parts = new Map();
    this.groups = new Map();
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  }

  /** Take over a scene; poses of its bodies are set with `place`. */
  load({ content, array }) {
    const { gl } = this;
    this.content = content;
    this.poses = content.bodies.map(() => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]);
    this.remake("surfaces", () => { this.meshes = content.meshes.map((mesh) => this.mesh(mesh, array)); });
    this.ball = (instances) => this.mesh(content.ball, array, instances);
    this.shapes = content.shapes.map((shape) => ({ ...shape, world: new Array(12) }));
    this.reach = this.shapes.map((shape) => this.radius(shape));
    if (content.drawings) this.show("drawings", content.drawings, array);
    const lights = content.lights, sum = (i) => lights.reduce((total, { ambient }) => total + ambient[i], 0);
    gl.useProgram(this.surface.made);
    gl.uniform1i(this.surface.lights, lights.length);
    gl.uniform3fv(this.surface.ambient, [0, 1, 2].map(sum));
    gl.uniform3fv(this.surface.diffuse, lights.flatMap(({ diffuse }) => diffuse));
    gl.uniform3fv(this.surface.specular, lights.flatMap(({ specular }) => specular));
  }

  /** Make a part of what is on the graphics card anew. */
  remake(part, make) {
    for (const free of this.parts.get(part) || []) free();
    this.parts.set(part, this.made = []);
    make();
  }

  /** Draw points, lines, spheres and triangles in place of those that were shown under a name. */
  show(name, { lines, points, spheres, triangles }, array) {
    this.remake(name, () => this.groups.set(name, {
      strokes: [lines, points].filter(Boolean).map((batch) => this.stroke(batch, array)),
      balls: spheres && this.ballsOf(spheres, array),
      facets: triangles ? [true, false].map((isSolid) => this.facetsOf(triangles, array, isSolid)) : [],
      marks: [lines, points, spheres, triangles].filter(Boolean).map(({ corners }) => array(corners)),
    }));
  }

  buffer(content, target = this.gl.ARRAY_BUFFER) {
    const made = this.gl.createBuffer();
    this.made.push(() => this.gl.deleteBuffer(made));
    this.gl.bindBuffer(target, made);
    this.gl.bufferData(target, content, this.gl.STATIC_DRAW);
    return made;
  }

  attribute(place, buffer, size, type, { stride = 0, offset = 0, divisor = 0, normalized = false } = {}) {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, size, type, normalized, stride, offset);
    gl.vertexAttribDivisor(place, divisor);
  }

  vertices(fill) {
    const { gl } = this, made = gl.createVertexArray();
    this.made.push(() => gl.deleteVertexArray(made));
    gl.bindVertexArray(made);
    fill();
    gl.bindVertexArray(null);
    return made;
  }

  /** A mesh on the graphics card, for shapes one at a time or, with instances, for many at once. */
  mesh({ positions, normals, corners }, array, instances = () => {}) {
    const { gl, surface } = this;
    const axes = columns(positions, array), count = axes[0].whole.length, whole = new Uint16Array(3 * count);
    axes.forEach((axis, i) => axis.whole.forEach((number, at) => { whole[3 * at + i] = number; }));
    const indices = summed(array(corners)), faces = this.buffer(indices, gl.ELEMENT_ARRAY_BUFFER);
    const vertices = this.vertices(() => {
      this.attribute(surface.position, this.buffer(whole), 3, gl.UNSIGNED_SHORT);
      this.attribute(surface.folded, this.buffer(array(normals)), 2, gl.BYTE, { normalized: true });
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, faces);
      instances();
    });
    const low = axes.map((axis) => axis.low), step = axes.map((axis) => axis.step);
    const far = axes.map(({ low: least, step: by }) => Math.max(Math.abs(least), Math.abs(least + 65535 * by)));
    const type = indices instanceof Uint16Array ? gl.UNSIGNED_SHORT : gl.UNSIGNED_INT;
    return { vertices, low, step, far, type, indices, faces, count: indices.length };
  }

  /** How far a shape reaches from the origin of its mesh, at most. */
  radius({ mesh, rows }) {
    const far = this.meshes[mesh].far;
    return Math.hypot(...[0, 4, 8].map((row) => Math.abs(rows[row]) * far[0] + Math.abs(rows[row + 1]) * far[1]
                                                + Math.abs(rows[row + 2]) * far[2]));
  }

  stroke({ corners, sizes, rgba }, array) {
    const { gl, line } = this, places = array(corners), widths = array(sizes);
    const isPoint = places.length === 3 * widths.length, stride = isPoint ? 12 : 24;
    const ends = this.buffer(places);
    const vertices = this.vertices(() => {
      this.attribute(line.corner, this.buffer(new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1])), 2, gl.FLOAT);
      this.attribute(line.start, ends, 3, gl.FLOAT, { stride, divisor: 1 });
      this.attribute(line.end, ends, 3, gl.FLOAT, { stride, offset: stride - 12, divisor: 1 });
      this.attribute(line.width, this.buffer(widths), 1, gl.FLOAT, { divisor: 1 });
      this.attribute(line.rgba, this.buffer(array(rgba)), 4, gl.FLOAT, { divisor: 1 });
    });
    return { vertices, count: widths.length };
  }

  ballsOf({ corners, sizes, rgba }, array) {
    const { gl, surface } = this, centers = array(corners), radii = array(sizes);
    const rows = new Float32Array(12 * radii.length);
    radii.forEach((radius, i) => [0, 1, 2].forEach((row) => {
      rows[12 * i + 5 * row] = radius;
      rows[12 * i + 4 * row + 3] = centers[3 * i + row];
    }));
    const mesh = this.ball(() => {
      const placed = this.buffer(rows);
      [surface.row0, surface.row1, surface.row2].forEach((place, row) => {
        this.attribute(place, placed, 4, gl.FLOAT, { stride: 48, offset: 16 * row, divisor: 1 });
      });
      this.attribute(surface.rgba, this.buffer(array(rgba)), 4, gl.FLOAT, { divisor: 1 });
    });
    return { ...mesh, instances: radii.length };
  }

  /** Triangles that nothing shines through, or the others. */
  facetsOf({ corners, rgba }, array, isSolid) {
    const { gl, surface } = this, all = array(corners), shade = array(rgba);
    const chosen = [...shade.keys()].filter((i) => i % 4 === 3 && (shade[i] >= 1) === isSolid).map((i) => (i - 3) / 4);
    const places = new Float32Array(9 * chosen.length), colors = new Float32Array(4 * chosen.length);
    chosen.forEach((from, to) => {
      places.set(all.subarray(9 * from, 9 * from + 9), 9 * to);
      colors.set(shade.subarray(4 * from, 4 * from + 4), 4 * to);
    });
    const count = 3 * chosen.length;
    const normals = new Int8Array(2 * count), shades = new Float32Array(4 * count);
    for (let i = 0; i < count; i += 3) {
      const [a, b, c] = [0, 3, 6].map((start) => places.subarray(3 * i + start, 3 * i + start + 3));
      const n = cross([0, 1, 2].map((k) => b[k] - a[k]), [0, 1, 2].map((k) => c[k] - a[k]));
      const length = Math.abs(n[0]) + Math.abs(n[1]) + Math.abs(n[2]) || 1;
      let [x, y] = [n[0] / length, n[1] / length];
      if (n[2] < 0) [x, y] = [(1 - Math.abs(y)) * (x < 0 ? -1 : 1), (1 - Math.abs(x)) * (y < 0 ? -1 : 1)];
      for (let k = i; k < i + 3; k++) {
        normals.set([Math.round(127 * x), Math.round(127 * y)], 2 * k);
        shades.set(colors.subarray(4 * i / 3, 4 * i / 3 + 4), 4 * k);
      }
    }
    const vertices = this.vertices(() => {
      this.attribute(surface.position, this.buffer(places), 3, gl.FLOAT);
      this.attribute(surface.folded, this.buffer(normals), 2, gl.BYTE, { normalized: true });
      this.attribute(surface.rgba, this.buffer(shades), 4, gl.FLOAT);
    });
    return { vertices, count };
  }

  /** Set the pose of a body: position and quaternion wxyz. */
  place(body, x, y, z, ...quaternion) {
    const r = rotationOf(...quaternion);
    this.poses[body] = [r[0], r[1], r[2], x, r[3], r[4], r[5], y, r[6], r[7], r[8], z];
  }

  /** Draw the scene as a view sees it. */
  draw(view, marked = -1) {
    const { gl, background } = this;
    this.prepare(view);
    gl.clearColor(...(background || this.content.background), 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.setUp(view, true);
    const clear = this.shapes.filter(({ rgba }) => rgba[3] > 0 && rgba[3] < 1);
    for (const shape of this.shapes) if (shape.rgba[3] >= 1) this.drawShape(shape, this.tinted(shape, marked));
    gl.enable(gl.BLEND);
    for (const group of this.groups.values()) this.drawGroup(group);
    clear.sort((a, b) => b.depth - a.depth);
    gl.depthMask(false);
    gl.useProgram(this.surface.made);
    for (const shape of clear) this.drawShape(shape, this.tinted(shape, marked));
    for (const { facets } of this.groups.values()) if (facets.length) this.drawFacets(facets[1]);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }

  tinted({ rgba, body }, marked) {
    return body === marked ? [...rgba.slice(0, 3).map((part) => 0.65 * part + 0.35), rgba[3]] : rgba;
  }

  /** Return the body that is seen at a pixel from the upper left corner; -1 where none is. */
  pick(view, x, y) {
    const { gl } = this, pixel = new Uint8Array(4);
    this.prepare(view);
    gl.clearColor(0, 0, 0, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.setUp(view, false);
    gl.enable(gl.SCISSOR_TEST);
    const row = gl.drawingBufferHeight - 1 - Math.floor(y);
    gl.scissor(Math.floor(x), row, 1, 1);
    for (const shape of this.shapes) {
      const code = shape.body + 1;
      this.drawShape(shape, [(code & 255) / 255, (code >> 8 & 255) / 255, 0, 1]);
    }
    gl.readPixels(Math.floor(x), row, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    gl.disable(gl.SCISSOR_TEST);
    return pixel[0] + 256 * pixel[1] - 1;
  }

  /** Bring shapes to their bodies, and find between which depths they are. */
  prepare(view) {
    const forward = view.axis(2);
    let near = Infinity, far = 0;
    const seen = (x, y, z, radius) => {
      const depth = (x - view.position[0]) * forward[0] + (y - view.position[1]) * forward[1]
                    + (z - view.position[2]) * forward[2];
      near = Math.min(near, depth - radius);
      far = Math.max(far, depth + radius);
      return depth;
    };
    this.shapes.forEach((shape, number) => {
      const a = this.poses[shape.body], b = shape.rows, to = shape.world;
      for (let row = 0; row < 12; row += 4) {
        for (let column = 0; column < 4; column++) {
          to[row + column] = a[row] * b[column] + a[row + 1] * b[4 + column] + a[row + 2] * b[8 + column];
        }
        to[row + 3] += a[row + 3];
      }
      shape.depth = seen(to[3], to[7], to[11], this.reach[number]);
    });
    for (const places of [...this.groups.values()].flatMap(({ marks }) => marks)) {
      for (let i = 0; i < places.length; i += 3) seen(places[i], places[i + 1], places[i + 2], 0.1);
    }
    far = Math.max(1.01 * far, 1e-3);
    this.depths = [Math.max(0.99 * near, 1e-4 * far), far];
  }

  setUp(view, isLit) {
    const { gl, surface, line } = this, [near, far] = this.depths;
    const width = gl.drawingBufferWidth, height = gl.drawingBufferHeight;
    const x = view.axis(0), y = view.axis(1), z = view.axis(2), focal = view.focal(height);
    const dot = (axis) => -axis.reduce((sum, part, i) => sum + part * view.position[i], 0);
    const rows = [[2 * focal / width, x], [-2 * focal / height, y], [(far + near) / (far - near), z], [1, z]];
    const clip = new Float32Array(16);
    rows.forEach(([scale, axis], row) => {
      for (let i = 0; i < 3; i++) clip[4 * i + row] = scale * axis[i];
      clip[12 + row] = scale * dot(axis) - (row === 2 ? 2 * far * near / (far - near) : 0);
    });
    gl.viewport(0, 0, width, height);
    gl.useProgram(line.made);
    gl.uniformMatrix4fv(line.clip, false, clip);
    gl.uniform2f(line.size, width, height);
    gl.uniform1f(line.near, near);
    gl.useProgram(surface.made);
    gl.uniformMatrix4fv(surface.clip, false, clip);
    gl.uniform3fv(surface.eye, view.position);
    gl.uniform1i(surface.isLit, isLit);
    gl.uniform1f(surface.gloss, 0.5);
    gl.uniform3fv(surface.direction, this.content.lights.flatMap(({ direction }) => direction || z));
  }

  drawShape({ mesh: number, world }, rgba) {
    const { gl, surface } = this, mesh = this.meshes[number];
    gl.bindVertexArray(mesh.vertices);
    gl.uniform3fv(surface.low, mesh.low);
    gl.uniform3fv(surface.step_, mesh.step);
    [surface.row0, surface.row1, surface.row2].forEach((place, row) => {
      gl.vertexAttrib4f(place, world[4 * row], world[4 * row + 1], world[4 * row + 2], world[4 * row + 3]);
    });
    gl.vertexAttrib4f(surface.rgba, ...rgba);
    if (this.hasEdgesOnly) this.drawEdges(mesh);
    else gl.drawElements(gl.TRIANGLES, mesh.count, mesh.type, 0);
  }

  drawEdges(mesh) {
    const { gl } = this, { indices, faces, count, type } = mesh;
    if (!mesh.edges) {
      const ends = indices.constructor.from({ length: 2 * count }, (_, i) => {
        const corner = i >> 1, side = (corner % 3 + i % 2) % 3;
        return indices[corner - corner % 3 + side];
      });
      this.made = this.parts.get("surfaces");
      mesh.edges = this.buffer(ends, gl.ELEMENT_ARRAY_BUFFER);
    }
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, mesh.edges);
    gl.drawElements(gl.LINES, 2 * count, type, 0);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, faces);
  }

  drawGroup({ strokes, balls, facets }) {
    const { gl, surface } = this;
    gl.useProgram(surface.made);
    gl.uniform1f(surface.gloss, 0);
    if (balls) {
      gl.bindVertexArray(balls.vertices);
      gl.uniform3fv(surface.low, balls.low);
      gl.uniform3fv(surface.step_, balls.step);
      gl.drawElementsInstanced(gl.TRIANGLES, balls.count, balls.type, 0, balls.instances);
    }
    gl.uniform1f(surface.gloss, 0.5);
    if (facets.length) this.drawFacets(facets[0]);
    gl.useProgram(this.line.made);
    for (const { vertices, count } of strokes) {
      gl.bindVertexArray(vertices);
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
    }
  }

  drawFacets({ vertices, count }) {
    const { gl, surface } = this;
    gl.uniform1f(surface.gloss, 0);
    gl.bindVertexArray(vertices);
    gl.uniform3f(surface.low, 0, 0, 0);
    gl.uniform3f(surface.step_, 1, 1, 1);
    [surface.row0, surface.row1, surface.row2].forEach((place, row) => {
      gl.vertexAttrib4f(place, row === 0, row === 1, row === 2, 0);
    });
    gl.drawArrays(gl.TRIANGLES, 0, count);
    gl.uniform1f(surface.gloss, 0.5);
  }
}
