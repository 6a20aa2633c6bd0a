/* Forward kinematics of what sliders.py packs, as MuJoCo computes it. */
"use strict";

const product = ([a, b, c, d], [w, x, y, z]) => [  // of quaternions wxyz
  a * w - b * x - c * y - d * z, a * x + b * w + c * z - d * y, a * y - b * z + c * w + d * x, a * z + b * y - c * x + d * w];

function turned(quaternion, [x, y, z]) {
  const r = rotationOf(...quaternion);
  return [0, 3, 6].map((row) => r[row] * x + r[row + 1] * y + r[row + 2] * z);
}

const sum = (a, b, factor = 1) => a.map((part, i) => part + factor * b[i]);

/** The number at a fraction of a table of evenly spaced ones. */
function between(table, fraction) {
  const at = fraction * (table.length - 1), low = Math.min(Math.floor(at), table.length - 2);
  return table[low] + (at - low) * (table[low + 1] - table[low]);
}

class Mechanism {
  constructor({ sliders, joints, bodies }) {
    Object.assign(this, { sliders, joints, bodies });
    this.values = sliders.map(({ value }) => value);
  }

  /** Positions of the joints: what they are at first, and what sliders that were moved change. */
  positions() {
    const positions = this.joints.map(({ value }) => value);
    this.sliders.forEach(({ low, high, value, tables }, i) => {
      const fraction = (number) => (number - low) / (high - low);
      for (const [joint, table] of tables) {
        positions[joint] += between(table, fraction(this.values[i])) - between(table, fraction(value));
      }
    });
    return positions;
  }

  /** Call a function with the number, position and quaternion wxyz of each body that moves. */
  place(put) {
    const positions = this.positions(), poses = [];
    for (const { body, parent, position, quaternion, joints } of this.bodies) {
      let at = position, q = quaternion;
      if (parent >= 0) {
        const outer = poses[parent];
        [at, q] = [sum(outer.at, turned(outer.q, position)), product(outer.q, quaternion)];
      }
      for (const joint of joints) {
        const { slides, axis, anchor, start } = this.joints[joint], moved = positions[joint] - start;
        if (slides) {
          at = sum(at, turned(q, axis), moved);
          continue;
        }
        const fixed = sum(at, turned(q, anchor));
        q = product(q, [Math.cos(moved / 2), ...axis.map((part) => Math.sin(moved / 2) * part)]);
        at = sum(fixed, turned(q, anchor), -1);
      }
      poses.push({ at, q });
      put(body, ...at, ...q);
    }
  }
}
