/* Draws what packing.py packs, with WebGL2: lit surfaces, points and lines of constant width. */
"use strict";

const HERE = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0], SOLID = [0, 0, 0, 1], CLEAR = [0, 0, 0, 0.5];
const FOREGROUND = 0.01;  // part of the depth of the bodies at which drawings are seen still: less costs bodies digits
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

/** The opacity with which something clear is drawn twice. */
const opacity = (both) => 1 - Math.sqrt(1 - Math.min(both, 1));

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
uniform int lights; uniform bool isLit, casts[MOST]; uniform float gloss, nudge;
in vec3 at, normal; in vec4 color;
out vec4 pixel;
${SHADOW}
void main() {
  if (!isLit) { pixel = color; return; }
  vec3 towards = normalize(eye - at), n = normalize(normal);
  if (dot(n, towards) < 0.0) n = -n;
  vec3 light = ambient, shine = vec3(0.0);
  for (int i = 0; i < MOST; i++) {
    if (i >= lights) break;
    float cosine = dot(n, -direction[i]);
    if (cosine <= 0.0) continue;
    float part = casts[i] ? litPart(at + nudge * n) : 1.0;
    light += part * cosine * diffuse[i];
    shine += part * pow(max(dot(n, normalize(towards - direction[i])), 0.0), 64.0) * specular[i];
  }
  pixel = vec4(min(color.rgb * light + gloss * shine, 1.0), color.a);
}`;

/* Lines of constant width, and points, which are lines without length. They are clipped to twice the view: the depth of
   ends that are far outside would be interpolated with too few digits. */
const LINE_VERTEX = `#version 300 es
const vec4 SIDES[4] = vec4[4](vec4(1, 0, 0, 2), vec4(-1, 0, 0, 2), vec4(0, 1, 0, 2), vec4(0, -1, 0, 2));
uniform mat4 clip; uniform vec2 size; uniform float near, scale;
in vec2 corner; in vec3 start, end; in float width; in vec4 rgba;
out vec4 color;
void cut(inout vec2 part, float from, float to) {
  if (max(from, to) < 0.0) part = vec2(1.0, 0.0);
  else if (from < 0.0) part.x = max(part.x, from / (from - to));
  else if (to < 0.0) part.y = min(part.y, from / (from - to));
}
void main() {
  vec4 from = clip * vec4(start, 1.0), to = clip * vec4(end, 1.0);
  bool isPoint = start == end;
  vec2 part = vec2(0.0, 1.0);
  cut(part, from.w - near, to.w - near);
  for (int i = 0; i < 4; i++) cut(part, dot(SIDES[i], from), dot(SIDES[i], to));
  if (part.x > part.y) { gl_Position = vec4(0.0, 0.0, 2.0, 1.0); return; }  // nothing of it is in the view
  vec4 a = mix(from, to, part.x), b = mix(from, to, part.y);
  vec2 along = (b.xy / b.w - a.xy / a.w) * size;
  along = isPoint || length(along) < 1e-6 ? vec2(1.0, 0.0) : normalize(along);
  vec2 aside = vec2(-along.y, along.x) * corner.y;
  vec4 p = corner.x < 0.0 ? a : b;
  vec2 beyond = isPoint ? along * corner.x : vec2(0.0);
  float nearer = 5e-7 * max(width, 1.0);  // steps of the depth: wide lines cover narrow ones
  gl_Position = p + vec4((aside + beyond) * max(scale * width, 1.0) / size * p.w, -nearer * p.w, 0.0);
  color = rgba;
}`;

const LINE_FRAGMENT = `#version 300 es
precision highp float;
in vec4 color; out vec4 pixel;
void main() { pixel = color; }`;

/** A program with the places of its attributes and uniforms as fields. */
function compile(gl, vertex, fragment) {
  const program = gl.createProgram(), places = {};
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_ATTRIBUTES); i++) {
    const { name } = gl.getActiveAttrib(program, i);
    places[name] = gl.getAttribLocation(program, name);
  }
  for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); i++) {
    const { name } = gl.getActiveUniform(program, i);
    places[name.replace("[0]", "")] = gl.getUniformLocation(program, name);
  }
  return { program, ...places };
}

class Renderer {
  /** Raises an error where there is no WebGL2. */
  constructor(canvas) {
    const gl = canvas.getContext("webgl2", { antialias: false });  // crisp pictures have a framebuffer of their own
    if (!gl) throw new Error("this browser has no WebGL2");
    this.gl = gl;
    this.surface = compile(gl, SURFACE_VERTEX, SURFACE_FRAGMENT);
    this.line = compile(gl, LINE_VERTEX, LINE_FRAGMENT);
    this.backdrop = new Backdrop(gl);
    this.shadowMap = new ShadowMap(gl);
    this.isWeak = isSoftware(gl);
    this.parts = new Map();
    this.groups = new Map();
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);  // the page is opaque
    this.samples = { framebuffer: gl.createFramebuffer(), color: gl.createRenderbuffer(), depth: gl.createRenderbuffer() };
  }

  /** Take over a scene; poses of its bodies are set with `place`. */
  load({ content, array }) {
    const { gl } = this;
    this.content = content;
    this.poses = content.bodies.map(() => HERE);
    this.remake("surfaces", () => {
      const meshes = content.meshes.map((mesh) => this.mesh(mesh, array));
      this.shapes = content.shapes.map((shape) => ({ ...shape, mesh: meshes[shape.mesh], world: new Array(12) }));
    });
    this.ball = (instances) => this.mesh(content.ball, array, instances);
    if (content.drawings) this.show("drawings", content.drawings, array);
    if (content.look) this.look = content.look;
  }

  /** Hand the lights of the look to the program of surfaces. */
  setLights(view) {
    const { gl, surface, look: { lights, steepness } } = this;
    const sum = (i) => lights.reduce((total, { ambient }) => total + ambient[i], 0);
    gl.uniform1i(surface.lights, lights.length);
    gl.uniform3fv(surface.ambient, [0, 1, 2].map(sum));
    for (const name of ["diffuse", "specular"]) gl.uniform3fv(surface[name], lights.flatMap((light) => light[name]));
    gl.uniform3fv(surface.direction, lights.flatMap((light) => directionOf(light, view, steepness)));
    gl.uniform1iv(surface.casts, lights.map(({ casts }) => casts));
    gl.uniform1f(surface.nudge, 2 * (this.shadowMap.radius || 0) / SHADOW_SIZE);
    this.shadowMap.use(surface);
  }

  /** Find out what the main light sees, if there is time. */
  castShadows(view, level) {
    const { gl, surface, shadowMap, look: { lights, shadows, steepness } } = this, light = lights.find(({ casts }) => casts);
    const isWanted = shadows === null ? !this.isWeak && level.scale === 1 : shadows;
    shadowMap.isOn = Boolean(isWanted && light && !this.hasEdgesOnly) &&
      shadowMap.aim(directionOf(light, view, steepness), this.shapes);
    if (!shadowMap.isOn) return;
    shadowMap.begin();
    gl.useProgram(surface.program);
    gl.uniformMatrix4fv(surface.clip, false, shadowMap.clip);
    gl.uniform1i(surface.isLit, false);
    for (const shape of this.shapes) if (shape.rgba[3] >= 1) this.drawShape(shape, SOLID);
    shadowMap.end();
  }

  /** Make a part of what is on the graphics card anew. */
  remake(part, make) {
    this.gl.bindVertexArray(null);  // or new indices would become those of what was drawn last
    for (const free of this.parts.get(part) || []) free();
    this.parts.set(part, this.disposers = []);
    make();
  }

  /** Draw points, lines, spheres and triangles in place of those that were shown under a name. */
  show(name, { lines, points, spheres, triangles }, array) {
    this.remake(name, () => this.groups.set(name, {
      strokes: [lines, points].filter(Boolean).map((batch) => this.stroke(batch, array)),
      figures: [...(spheres ? this.ballsOf(spheres, array) : []), ...(triangles ? this.facetsOf(triangles, array) : [])],
      marks: [lines, points, spheres, triangles].filter(Boolean).map((batch) => ({
        places: array(batch.corners),
        reach: batch === spheres ? array(batch.sizes).reduce((most, size) => Math.max(most, size), 0) : 0.1,
      })),
    }));
  }

  buffer(content, target = this.gl.ARRAY_BUFFER) {
    const buffer = this.gl.createBuffer();
    this.disposers.push(() => this.gl.deleteBuffer(buffer));
    this.gl.bindBuffer(target, buffer);
    this.gl.bufferData(target, content, this.gl.STATIC_DRAW);
    return buffer;
  }

  attribute(place, buffer, size, type, { stride = 0, offset = 0, divisor = 0, normalized = false } = {}) {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, size, type, normalized, stride, offset);
    gl.vertexAttribDivisor(place, divisor);
  }

  vertices(fill) {
    const { gl } = this, vertexArray = gl.createVertexArray();
    this.disposers.push(() => gl.deleteVertexArray(vertexArray));
    gl.bindVertexArray(vertexArray);
    fill();
    gl.bindVertexArray(null);
    return vertexArray;
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
    const half = axes.map((axis) => 0.5 * axis.step * axis.whole.reduce((most, number) => Math.max(most, number), 0));
    const type = indices instanceof Uint16Array ? gl.UNSIGNED_SHORT : gl.UNSIGNED_INT;
    return { vertices, low, step, half, type, indices, faces, count: indices.length };
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

  /** All spheres that nothing shines through as one figure; each of the others as one of its own. */
  ballsOf({ corners, sizes, rgba }, array) {
    const { gl, surface } = this, centers = array(corners), shades = array(rgba), solid = [], clear = [];
    const balls = [...array(sizes)].map((radius, i) => {
      const [x, y, z] = centers.subarray(3 * i, 3 * i + 3), [red, green, blue, alpha] = shades.subarray(4 * i, 4 * i + 4);
      const world = [radius, 0, 0, x, 0, radius, 0, y, 0, 0, radius, z];
      return { world, rgba: [red, green, blue, opacity(alpha)], reach: radius };
    });
    for (const ball of balls) (ball.rgba[3] < 1 ? clear : solid).push(ball);
    const mesh = this.ball(() => {
      const placed = this.buffer(new Float32Array(solid.flatMap(({ world }) => world)));
      [surface.row0, surface.row1, surface.row2].forEach((place, row) => {
        this.attribute(place, placed, 4, gl.FLOAT, { stride: 48, offset: 16 * row, divisor: 1 });
      });
      const painted = this.buffer(new Float32Array(solid.flatMap((ball) => ball.rgba)));
      this.attribute(surface.rgba, painted, 4, gl.FLOAT, { divisor: 1 });
    });
    const one = clear.length ? this.ball() : null;
    return [{ mesh: { ...mesh, instances: solid.length }, world: HERE, rgba: SOLID },
            ...clear.map((ball) => ({ ...ball, mesh: one }))];
  }

  /** All triangles that nothing shines through as one figure; each of the others as one of its own. */
  facetsOf({ corners, rgba }, array) {
    const { gl, surface } = this, places = array(corners), colors = array(rgba), count = places.length / 3;
    const normals = new Int8Array(2 * count), shades = new Float32Array(4 * count), solid = [], clear = [];
    for (let i = 0; i < count; i += 3) {
      const [a, b, c] = [0, 3, 6].map((start) => places.subarray(3 * i + start, 3 * i + start + 3));
      const n = cross([0, 1, 2].map((k) => b[k] - a[k]), [0, 1, 2].map((k) => c[k] - a[k]));
      const length = Math.abs(n[0]) + Math.abs(n[1]) + Math.abs(n[2]) || 1;
      let [x, y] = [n[0] / length, n[1] / length];
      if (n[2] < 0) [x, y] = [(1 - Math.abs(y)) * (x < 0 ? -1 : 1), (1 - Math.abs(x)) * (y < 0 ? -1 : 1)];
      for (let k = i; k < i + 3; k++) {
        normals.set([Math.round(127 * x), Math.round(127 * y)], 2 * k);
        shades.set(colors.subarray(4 * i / 3, 4 * i / 3 + 3), 4 * k);
        shades[4 * k + 3] = opacity(colors[4 * i / 3 + 3]);
      }
      const isClear = shades[4 * i + 3] < 1;
      (isClear ? clear : solid).push(i, i + 1, i + 2);
    }
    const faces = this.buffer(new Uint32Array([...solid, ...clear]), gl.ELEMENT_ARRAY_BUFFER);
    const vertices = this.vertices(() => {
      this.attribute(surface.position, this.buffer(places), 3, gl.FLOAT);
      this.attribute(surface.folded, this.buffer(normals), 2, gl.BYTE, { normalized: true });
      this.attribute(surface.rgba, this.buffer(shades), 4, gl.FLOAT);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, faces);
    });
    const mesh = { vertices, low: [0, 0, 0], step: [1, 1, 1], type: gl.UNSIGNED_INT };
    const each = clear.filter((_, i) => i % 3 === 0).map((corner, i) => {
      const [a, b, c] = [0, 3, 6].map((start) => places.subarray(3 * corner + start, 3 * corner + start + 3));
      const reach = Math.max(...[b, c].map((end) => Math.hypot(...end.map((part, k) => part - a[k]))));
      return { mesh: { ...mesh, first: solid.length + 3 * i, count: 3 }, world: HERE, center: a, isFlat: true, reach, rgba: CLEAR };
    });
    return [{ mesh: { ...mesh, count: solid.length }, world: HERE, rgba: SOLID }, ...each];
  }

  /** Set the pose of a body: position and quaternion wxyz. */
  place(body, x, y, z, ...quaternion) {
    const r = rotationOf(...quaternion);
    this.poses[body] = [r[0], r[1], r[2], x, r[3], r[4], r[5], y, r[6], r[7], r[8], z];
  }

  /** Give pictures another size [pixels]. */
  resize(...size) {
    const { canvas } = this.gl, [width, height] = size.map((length) => Math.max(1, Math.round(length)));
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
  }

  /** Draw the scene as a view sees it, with some samples for each pixel. */
  draw(view, marked, level) {
    const { samples, scale } = level;
    this.prepare(view);
    this.castShadows(view, level);
    if (samples === 1) return this.drawAll(view, marked, scale);
    const { gl } = this, size = [gl.drawingBufferWidth, gl.drawingBufferHeight];
    this.bindSamples(samples, ...size);
    this.drawAll(view, marked, scale);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
    gl.blitFramebuffer(0, 0, ...size, 0, 0, ...size, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  /** Draw with several samples for each pixel from now on. */
  bindSamples(samples, width, height) {
    const { gl } = this, { framebuffer, color, depth } = this.samples;
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    if (this.samples.width === width && this.samples.height === height) return;
    Object.assign(this.samples, { width, height });
    for (const [buffer, format, attachment] of [[color, gl.RGBA8, gl.COLOR_ATTACHMENT0],
                                                [depth, gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT]]) {
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
      gl.renderbufferStorageMultisample(gl.RENDERBUFFER, samples, format, width, height);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, attachment, gl.RENDERBUFFER, buffer);
    }
  }

  drawAll(view, marked, scale) {
    const { gl } = this;
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.viewport(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight);
    this.backdrop.draw(view, this.look, this.shadowMap);
    this.setUp(view, true, scale);
    this.setLights(view);
    const figures = [...this.groups.values()].flatMap((group) => group.figures);
    const all = [...this.shapes, ...figures], isSolid = ({ rgba }) => rgba[3] >= 1;
    for (const shape of all.filter(isSolid)) this.drawShape(shape, this.tinted(shape, marked));
    gl.enable(gl.BLEND);
    gl.useProgram(this.line.program);
    for (const { vertices, count } of [...this.groups.values()].flatMap((group) => group.strokes)) {
      gl.bindVertexArray(vertices);
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
    }
    gl.useProgram(this.surface.program);
    gl.depthMask(false);
    this.drawClear(all.filter((shape) => shape.rgba[3] > 0 && !isSolid(shape)), view, marked);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }

  /** Draw what is clear as MuJoCo does: fronts twice, from the nearest to the farthest and the other way round. */
  drawClear(shapes, { position }, marked) {
    const { gl } = this;
    const distance = ({ world, center = [world[3], world[7], world[11]], reach }) => (
      Math.hypot(...position.map((part, i) => part - center[i])) - reach);
    const sorted = shapes.map((shape) => [distance(shape), shape]).sort(([a], [b]) => a - b);
    for (let pass = 0; pass < 2; pass++) {
      for (const [, shape] of sorted) {
        gl[shape.isFlat ? "disable" : "enable"](gl.CULL_FACE);
        this.drawShape(shape, this.tinted(shape, marked));
      }
      sorted.reverse();
    }
    gl.disable(gl.CULL_FACE);
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

  /** Bring shapes to their bodies, and find between which depths they and the drawings are. */
  prepare(view) {
    const [px, py, pz] = view.position, [fx, fy, fz] = view.axis(2);
    const depth = (x, y, z) => (x - px) * fx + (y - py) * fy + (z - pz) * fz;
    let near = Infinity, nearest = Infinity, far = 0;
    for (const shape of this.shapes) {
      const a = this.poses[shape.body], b = shape.rows, to = shape.world, { low, half } = shape.mesh;
      for (let row = 0; row < 12; row += 4) {
        for (let column = 0; column < 4; column++) {
          to[row + column] = a[row] * b[column] + a[row + 1] * b[4 + column] + a[row + 2] * b[8 + column];
        }
        to[row + 3] += a[row + 3];
      }
      let middle = depth(to[3], to[7], to[11]), reach = 0;  // of the box that holds the mesh
      for (let axis = 0; axis < 3; axis++) {
        const slope = fx * to[axis] + fy * to[4 + axis] + fz * to[8 + axis];
        middle += slope * (low[axis] + half[axis]);
        reach += Math.abs(slope) * half[axis];
      }
      near = Math.min(near, middle - reach);
      far = Math.max(far, middle + reach);
    }
    for (const { places, reach } of [...this.groups.values()].flatMap(({ marks }) => marks)) {
      for (let i = 0; i < places.length; i += 3) {
        const middle = depth(places[i], places[i + 1], places[i + 2]);
        nearest = Math.min(nearest, middle - reach);
        far = Math.max(far, middle + reach);
      }
    }
    far = Math.max(1.01 * far, 1e-3);
    near = Math.min(near, far);
    this.depths = [Math.max(0.99 * Math.min(near, Math.max(nearest, FOREGROUND * near)), 1e-4 * far), far];
  }

  setUp(view, isLit, scale = 1) {
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
    gl.useProgram(line.program);
    gl.uniformMatrix4fv(line.clip, false, clip);
    gl.uniform2f(line.size, width, height);
    gl.uniform1f(line.scale, scale);
    gl.uniform1f(line.near, near);
    gl.useProgram(surface.program);
    gl.uniformMatrix4fv(surface.clip, false, clip);
    gl.uniform3fv(surface.eye, view.position);
    gl.uniform1i(surface.isLit, isLit);
  }

  /** Draw a shape of a body, or a figure. */
  drawShape({ mesh, world, body }, rgba) {
    const { gl, surface } = this, { vertices, count, type, instances, first = 0 } = mesh;
    gl.bindVertexArray(vertices);
    gl.uniform3fv(surface.low, mesh.low);
    gl.uniform3fv(surface.step_, mesh.step);
    gl.uniform1f(surface.gloss, body === undefined ? 0 : 0.5);
    [surface.row0, surface.row1, surface.row2].forEach((place, row) => {
      gl.vertexAttrib4f(place, world[4 * row], world[4 * row + 1], world[4 * row + 2], world[4 * row + 3]);
    });
    gl.vertexAttrib4f(surface.rgba, ...rgba);
    if (this.hasEdgesOnly && body !== undefined) this.drawEdges(mesh);
    else if (instances !== undefined) gl.drawElementsInstanced(gl.TRIANGLES, count, type, 0, instances);
    else gl.drawElements(gl.TRIANGLES, count, type, 4 * first);
  }

  drawEdges(mesh) {
    const { gl } = this, { indices, faces, count, type } = mesh;
    if (!mesh.edges) {
      const ends = indices.constructor.from({ length: 2 * count }, (_, i) => {
        const corner = i >> 1, side = (corner % 3 + i % 2) % 3;
        return indices[corner - corner % 3 + side];
      });
      this.disposers = this.parts.get("surfaces");
      mesh.edges = this.buffer(ends, gl.ELEMENT_ARRAY_BUFFER);
    }
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, mesh.edges);
    gl.drawElements(gl.LINES, 2 * count, type, 0);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, faces);
  }
}
