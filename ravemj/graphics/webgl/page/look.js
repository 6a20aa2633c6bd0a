/* Background, floor, lights and shadows, as ravemj/graphics/webgl/look.py packs them. */
"use strict";

const SHADOW_SIZE = 2048, SOFTWARE = /swiftshader|llvmpipe|softpipe|swrast|software|basic render/i;

/* Which part of the main light comes to a point: sixteen samples of the shadow map around it. */
const SHADOW = `
uniform mediump sampler2DShadow shadows; uniform mat4 toLight; uniform bool hasShadows; uniform float spread;
float litPart(vec3 at) {
  if (!hasShadows) return 1.0;
  vec3 p = (toLight * vec4(at, 1.0)).xyz * 0.5 + 0.5;
  if (p.z < 0.0 || any(lessThan(p.xy, vec2(0.0))) || any(greaterThan(p.xy, vec2(1.0)))) return 1.0;
  float sum = 0.0;
  for (int i = 0; i < 16; i++) {
    vec2 aside = (vec2(float(i & 3), float(i >> 2)) - 1.5) / 1.5 * spread;
    sum += texture(shadows, vec3(p.xy + aside, min(p.z, 1.0)));
  }
  return sum / 16.0;
}`;

/* One triangle that covers the picture, with the ray of each pixel. */
const BACKDROP_VERTEX = `#version 300 es
uniform vec3 right, down, forward;
out vec3 ray;
void main() {
  vec2 place = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0;
  ray = forward + place.x * right - place.y * down;
  gl_Position = vec4(place, 1.0, 1.0);
}`;

const BACKDROP_FRAGMENT = `#version 300 es
precision highp float;
uniform vec3 sky[3], eye, colour; uniform float height, cell, width, lines, pixel, shade; uniform vec3 fade;
uniform bool hasFloor;
in vec3 ray; out vec4 seen;
${SHADOW}
vec2 covered(vec2 place, vec2 footprint) {
  vec2 apart = abs(place - round(place)), size = max(footprint, 1e-9);
  vec2 part = clamp(0.5 + (0.5 * width - apart) / size, 0.0, 1.0) * min(vec2(1.0), width / size);
  return mix(part, vec2(width), clamp(2.0 * size - 1.0, 0.0, 1.0));
}
void main() {
  float rise = ray.z / length(ray);
  vec3 found = mix(sky[1], rise > 0.0 ? sky[0] : sky[2], abs(rise));
  float depth = (eye.z - height) / max(-ray.z, 1e-9);
  if (hasFloor && ray.z < 0.0) {
    vec3 at = vec3(eye.xy + depth * ray.xy, height);
    float across = pixel * depth / cell, along = across * length(ray) / -ray.z;
    vec2 level = abs(ray.xy) / max(length(ray.xy), 1e-9);
    vec2 part = covered(at.xy / cell, across + level * (along - across));
    float dark = 1.0 - (1.0 - lines) * (1.0 - (1.0 - part.x) * (1.0 - part.y));
    float faded = clamp((depth - fade.x) / (fade.y - fade.x), 0.0, 1.0);
    vec3 near = dark * colour * (1.0 - shade * (1.0 - litPart(at)));
    found = mix(near, depth < fade.z ? sky[1] : found, faded);
  }
  seen = vec4(found, 1.0);
}`;

/** The direction of a light in the world: one that casts shadows comes from above. */
function directionOf({ direction, inCamera, casts }, view, steepness) {
  const length = Math.hypot(...direction), d = direction.map((part) => part / length);
  if (!inCamera) return d;
  const [x, y, z] = [0, 1, 2].map((number) => view.axis(number));
  const towards = [0, 1, 2].map((i) => d[0] * x[i] + d[1] * y[i] + d[2] * z[i]);
  if (!casts || towards[2] <= -steepness) return towards;
  const level = Math.hypot(towards[0], towards[1]);
  if (level <= 1e-9) return [0, 0, -1];
  const factor = Math.sqrt(1 - steepness * steepness) / level;
  return [factor * towards[0], factor * towards[1], -steepness];
}

/** Whether the processor draws, which has no time for shadows. */
function isSoftware(gl) {
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  return SOFTWARE.test(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
}

/** Background and floor behind the bodies. */
class Backdrop {
  constructor(gl) {
    Object.assign(this, { gl, program: compile(gl, BACKDROP_VERTEX, BACKDROP_FRAGMENT), nothing: gl.createVertexArray() });
  }

  draw(view, { sky, floor, lights, steepness }, shadowMap) {
    const { gl, program } = this, height = gl.drawingBufferHeight, width = gl.drawingBufferWidth;
    const focal = view.focal(height), scaled = (axis, size) => view.axis(axis).map((part) => part * 0.5 * size / focal);
    const isAbove = floor && view.position[2] - floor.height > 1e-6 * floor.radius;
    gl.useProgram(program.program);
    gl.uniform3fv(program.right, scaled(0, width));
    gl.uniform3fv(program.down, scaled(1, height));
    gl.uniform3fv(program.forward, view.axis(2));
    gl.uniform3fv(program.eye, view.position);
    gl.uniform3fv(program.sky, sky.flat());
    gl.uniform1i(program.hasFloor, isAbove);
    shadowMap.use(program);
    if (isAbove) {
      const away = Math.hypot(...floor.center.map((part, i) => part - view.position[i]));
      const [start, end, reach] = floor.fade, faded = away + end * floor.radius;
      gl.uniform3f(program.fade, away + start * floor.radius, faded, reach * faded);
      gl.uniform3fv(program.colour, floor.colour);
      for (const name of ["height", "cell", "width", "lines"]) gl.uniform1f(program[name], floor[name]);
      gl.uniform1f(program.pixel, 1 / focal);
      gl.uniform1f(program.shade, this.shade(view, lights, steepness, Math.max(...floor.colour)));
    }
    gl.depthMask(false);
    gl.disable(gl.DEPTH_TEST);
    gl.bindVertexArray(this.nothing);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.enable(gl.DEPTH_TEST);
    gl.depthMask(true);
  }

  /** Fraction of the light on the floor that lights with shadows give, with a lower bound on that light. */
  shade(view, lights, steepness, least) {
    const mean = (parts) => parts.reduce((sum, part) => sum + part, 0) / 3;
    let all = 0, kept = 0;
    for (const light of lights) {
      const direct = mean(light.diffuse) * Math.max(-directionOf(light, view, steepness)[2], 0);
      all += mean(light.ambient) + direct;
      kept += light.casts ? direct : 0;
    }
    return kept / Math.max(all, least);
  }
}

/** The depths that a light sees, from which shadows are found. */
class ShadowMap {
  constructor(gl) {
    this.gl = gl;
    this.isOn = false;
    this.framebuffer = this.texture = null;
    this.clip = new Float32Array(16);
  }

  begin() {
    const { gl } = this;
    if (!this.framebuffer) {
      this.texture = gl.createTexture();
      gl.bindTexture(gl.TEXTURE_2D, this.texture);
      gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, SHADOW_SIZE, SHADOW_SIZE);
      for (const [name, value] of [[gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE], [gl.TEXTURE_COMPARE_FUNC, gl.LEQUAL],
                                   [gl.TEXTURE_MIN_FILTER, gl.LINEAR], [gl.TEXTURE_MAG_FILTER, gl.LINEAR],
                                   [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE]]) {
        gl.texParameteri(gl.TEXTURE_2D, name, value);
      }
      this.framebuffer = gl.createFramebuffer();
      gl.bindFramebuffer(gl.FRAMEBUFFER, this.framebuffer);
      gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.texture, 0);
    }
    gl.bindTexture(gl.TEXTURE_2D, null);  // or it would be read while it is written
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.framebuffer);
    gl.viewport(0, 0, SHADOW_SIZE, SHADOW_SIZE);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(2, 8);
  }

  end() {
    const { gl } = this;
    gl.disable(gl.POLYGON_OFFSET_FILL);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
  }

  /** Look along a direction at all shapes. */
  aim(direction, shapes) {
    const low = [Infinity, Infinity, Infinity], high = low.map((part) => -part);
    for (const { world, reach, mesh } of shapes) {
      if (mesh.half[2] === 0) continue;  // a plane, which casts no shadow that is seen
      [world[3], world[7], world[11]].forEach((part, i) => {
        low[i] = Math.min(low[i], part - reach);
        high[i] = Math.max(high[i], part + reach);
      });
    }
    this.radius = Math.max(0.5 * Math.hypot(...low.map((part, i) => high[i] - part)), 1e-6);
    const center = low.map((part, i) => 0.5 * (part + high[i]));
    const normalized = (v) => v.map((part) => part / Math.hypot(...v));
    const right = normalized(cross(direction, Math.abs(direction[2]) > 0.99 ? [0, 1, 0] : [0, 0, 1]));
    [right, cross(direction, right), direction].forEach((axis, row) => {
      for (let i = 0; i < 3; i++) this.clip[4 * i + row] = axis[i] / this.radius;
      this.clip[12 + row] = -axis.reduce((sum, part, i) => sum + part * center[i], 0) / this.radius;
    });
    this.clip[15] = 1;
    return Number.isFinite(this.radius);
  }

  /** Let a program find shadows. */
  use(program) {
    const { gl } = this;
    gl.uniform1i(program.hasShadows, this.isOn);
    gl.uniformMatrix4fv(program.toLight, false, this.clip);
    gl.uniform1f(program.spread, 2 / SHADOW_SIZE);
  }
}
