/* A point of view that pointers move: the arithmetic of ravemj/gui/interaction/viewpoint.py. */
"use strict";

const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** The product of two 3x3 matrices, rows one after the other. */
function multiplied(a, b) {
  const product = new Array(9);
  for (let row = 0; row < 9; row += 3) {
    for (let column = 0; column < 3; column++) {
      product[row + column] = a[row] * b[column] + a[row + 1] * b[3 + column] + a[row + 2] * b[6 + column];
    }
  }
  return product;
}

/** The rotation matrix of a quaternion [w, x, y, z], which need not be of unit length. */
function rotationOf(w, x, y, z) {
  const s = 2 / (w * w + x * x + y * y + z * z);
  return [1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y),
          s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x),
          s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)];
}

/** A camera that looks at a focus. Its axes: image right, image down, viewing direction. */
class View {
  constructor({ rotation, position, fovy, distance }) {
    Object.assign(this, { rotation, position, fovy, distance });
  }

  axis(number) { return [0, 3, 6].map((row) => this.rotation[row + number]); }

  get focus() {
    const forward = this.axis(2);
    return this.position.map((part, i) => part + this.distance * forward[i]);
  }

  /** Pixels or points for a length of 1 at a depth of 1. */
  focal(height) { return 0.5 * height / Math.tan(0.5 * this.fovy); }

  placed(rotation, focus, distance) {
    const position = [0, 1, 2].map((i) => focus[i] - distance * rotation[3 * i + 2]);
    return new View({ rotation, position, fovy: this.fovy, distance });
  }

  /** Turn about the focus by what a pointer went; the height of the view is half a turn. */
  turned(right, down, height) {
    const angle = Math.PI * Math.hypot(right, down) / height;
    if (!angle) return this;
    const s = Math.sin(angle / 2) / Math.hypot(right, down);
    const turn = rotationOf(Math.cos(angle / 2), -down * s, right * s, 0);
    return this.placed(multiplied(this.rotation, turn), this.focus, this.distance);
  }

  /** Move across the viewing direction, so that the focus follows the pointer. */
  shifted(right, down, height) {
    const scale = this.distance / this.focal(height), x = this.axis(0), y = this.axis(1);
    const focus = this.focus.map((part, i) => part - scale * (right * x[i] + down * y[i]));
    return this.placed(this.rotation, focus, this.distance);
  }

  /** Multiply the distance to the focus by e to a power. */
  zoomed(power) {
    const factor = Math.exp(Math.min(Math.max(power, -10), 10));
    const distance = Math.min(Math.max(this.distance * factor, 1e-3), 1e6);
    return this.placed(this.rotation, this.focus, distance);
  }

  /** Where a point of the world is in a picture of so many pixels or points; null behind the eye. */
  projected(point, width, height) {
    const [x, y, depth] = [0, 1, 2].map((number) => this.axis(number)
      .reduce((sum, part, i) => sum + part * (point[i] - this.position[i]), 0));
    const scale = this.focal(height) / depth;
    return depth > 0 ? [0.5 * width + scale * x, 0.5 * height + scale * y] : null;
  }
}
