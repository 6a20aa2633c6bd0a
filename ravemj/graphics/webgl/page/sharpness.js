/* As sharp as leaves time for 30 pictures a second while things move, crisp at rest: ravemj/gui/viewers/sharpness.py. */
"use strict";

const BUDGET = 28e6, REST = 100;  // ns for drawing; ms without a change
const SPARE = 0.7;  // part of the budget that a sharper picture may take, so that sharpness does not go to and fro
const INERTIA = 0.6;  // weight of earlier pictures
const CRISP = { scale: 1, samples: 4, cost: 1 };  // columns and rows as a part of the view's, samples per pixel
const LEVELS = [CRISP, { scale: 1, samples: 1, cost: 0.5 }, { scale: 0.75, samples: 1, cost: 0.36 },
                { scale: 0.5, samples: 1, cost: 0.2 }, { scale: 0.35, samples: 1, cost: 0.15 }];

/** Draws, and measures what that takes; where browsers do not tell, everything is crisp. */
class Sharpness {
  /** The function is called when what has come to rest is to be drawn once more. */
  constructor(renderer, onRest) {
    Object.assign(this, { renderer, onRest, moving: CRISP, isAtRest: false, timed: null });
    this.timer = renderer.gl.getExtension("EXT_disjoint_timer_query_webgl2");
  }

  draw(view, marked, width, height) {
    const { renderer, timer, renderer: { gl } } = this, level = this.isAtRest ? CRISP : this.moving;
    clearTimeout(this.waiting);
    if (level !== CRISP) this.waiting = setTimeout(() => this.rest(), REST);
    this.isAtRest = false;
    this.readTime(gl);
    renderer.resize(level.scale * width, level.scale * height);
    const query = timer && !this.timed ? gl.createQuery() : null;
    if (query) gl.beginQuery(timer.TIME_ELAPSED_EXT, query);
    renderer.draw(view, marked, level);
    if (!query) return;
    gl.endQuery(timer.TIME_ELAPSED_EXT);
    this.timed = { query, level };
  }

  rest() {
    this.isAtRest = true;
    this.onRest();
  }

  /** Choose the next level by the time of an earlier picture, if that is known by now. */
  readTime(gl) {
    if (!this.timed || !gl.getQueryParameter(this.timed.query, gl.QUERY_RESULT_AVAILABLE)) return;
    const { query, level } = this.timed;
    const crisp = gl.getQueryParameter(query, gl.QUERY_RESULT) / level.cost;
    gl.deleteQuery(query);
    this.timed = null;
    this.crisp = this.crisp === undefined ? crisp : INERTIA * this.crisp + (1 - INERTIA) * crisp;
    const budget = ({ cost }) => (cost > this.moving.cost ? SPARE : 1) * BUDGET;
    this.moving = LEVELS.find((one) => this.crisp * one.cost <= budget(one)) || LEVELS[LEVELS.length - 1];
  }
}
