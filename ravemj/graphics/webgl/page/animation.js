/* Plays a recording: pointers move the view, the bar moves the time, sliders move joints where nothing plays. */
"use strict";

class Player {
  constructor(canvas, scene) {
    const { content, array } = scene;
    this.canvas = canvas;
    this.content = content;
    this.begin(scene);
    canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());  // or it would not be restored
    canvas.addEventListener("webglcontextrestored", () => this.begin(scene));
    this.duration = (content.frames - 1) / content.fps;
    this.channels = content.moving.columns ? columns(content.moving, array) : [];
    this.values = content.values ? columns(content.values, array) : [];
    this.mechanism = content.mechanism && new Mechanism(content.mechanism);
    this.hasFrames = false;
    this.first = this.view = new View(content.view);
    this.time = 0;
    this.speed = 1;
    this.isPlaying = this.duration > 0;
    this.marked = -1;
    new ResizeObserver(() => this.fit()).observe(canvas);
    requestAnimationFrame((now) => this.step(now, now));
  }

  /** Make everything on the graphics card, which may have been lost. */
  begin({ content, array }) {
    this.renderer = new Renderer(this.canvas);
    this.sharpness = new Sharpness(this.renderer, () => { this.isDue = true; });
    this.renderer.load({ content, array });
    const poses = array(content.still.poses);
    content.still.bodies.forEach((body, i) => this.renderer.place(body, ...poses.subarray(7 * i, 7 * i + 7)));
    this.isDue = true;
  }

  /** Widen the vertical angle where the page is narrower than the picture that the view was chosen for. */
  fit() {
    const { fovy, aspect } = this.content.view, { clientWidth, clientHeight } = this.canvas;
    const wider = Math.max(1, aspect * clientHeight / Math.max(clientWidth, 1));
    const angle = 2 * Math.atan(wider * Math.tan(0.5 * fovy));
    [this.first, this.view] = [this.first, this.view].map((view) => new View({ ...view, fovy: angle }));
    this.isDue = true;
  }

  look(view) {
    this.view = view;
    this.isDue = true;
  }

  seek(time) {
    this.time = Math.min(Math.max(time, 0), this.duration);
    this.isDue = true;
  }

  step(now, before) {
    if (this.isPlaying) {
      this.time += this.speed * Math.min(now - before, 100) / 1000;
      if (this.time > this.duration) this.time = this.time < this.duration + 1 ? this.time : 0;  // rests a second
      this.isDue = true;
    }
    if (this.isDue) {
      this.isDue = false;
      this.draw();
    }
    requestAnimationFrame((next) => this.step(next, now));
  }

  /** The number of a channel now, between its frames. */
  sample({ low, step, whole }, frame) {
    const index = Math.min(Math.floor(frame), whole.length - 1), next = Math.min(index + 1, whole.length - 1);
    return low + step * (whole[index] + (frame - index) * (whole[next] - whole[index]));
  }

  get frame() { return Math.min(this.time, this.duration) * this.content.fps; }

  draw() {
    const { content, frame, channels } = this;
    content.moving.bodies.forEach((body, i) => {
      this.renderer.place(body, ...channels.slice(7 * i, 7 * i + 7).map((channel) => this.sample(channel, frame)));
    });
    if (this.mechanism) this.mechanism.place((...pose) => this.renderer.place(...pose));
    const lines = this.hasFrames ? { lines: this.frameLines() } : {};
    if (this.hasFrames || this.renderer.groups.has("frames")) this.renderer.show("frames", lines, (numbers) => numbers);
    const { clientWidth, clientHeight } = this.canvas, ratio = Math.min(window.devicePixelRatio || 1, 2);
    this.sharpness.draw(this.view, this.marked, ratio * clientWidth, ratio * clientHeight);
    this.onDraw();
  }

  onDraw() {}

  jointValues() {
    return this.mechanism ? this.mechanism.values : this.values.map((channel) => this.sample(channel, this.frame));
  }

  /** The axes of all bodies as lines: x red, y green, z blue. */
  frameLines() {
    const length = 0.1 * this.first.distance, places = [], colors = [];
    for (const pose of this.renderer.poses.slice(1)) {
      const at = [pose[3], pose[7], pose[11]];
      for (let axis = 0; axis < 3; axis++) {
        places.push(...at, ...at.map((part, row) => part + length * pose[4 * row + axis]));
        colors.push(...[0, 1, 2].map((part) => (part === axis ? 0.9 : 0.1)), 1);
      }
    }
    const sizes = new Float32Array(places.length / 6).fill(3);
    return { corners: new Float32Array(places), sizes, rgba: new Float32Array(colors) };
  }

  bodyAt(x, y) {
    const scale = this.canvas.width / this.canvas.clientWidth;
    const body = this.renderer.pick(this.view, scale * x, scale * y);
    this.isDue = true;
    return body;
  }
}

/** Let the mouse and fingers turn, move and zoom the view. */
function followPointers(player, canvas, onHover) {
  const pointers = new Map();
  const height = () => canvas.clientHeight;
  const middle = () => {
    const all = [...pointers.values()];
    return { x: (all[0].x + all[1].x) / 2, y: (all[0].y + all[1].y) / 2,
             spread: Math.hypot(all[0].x - all[1].x, all[0].y - all[1].y) };
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.focus({ preventScroll: true });
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
    event.preventDefault();
  });
  canvas.addEventListener("pointermove", (event) => {
    const last = pointers.get(event.pointerId);
    if (!last) return onHover(event.offsetX, event.offsetY);
    const before = pointers.size === 2 ? middle() : null;
    pointers.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
    if (before) {
      const after = middle();
      const view = player.view.zoomed(-Math.log(Math.max(after.spread, 1) / Math.max(before.spread, 1)));
      return player.look(view.shifted(after.x - before.x, after.y - before.y, height()));
    }
    const right = event.offsetX - last.x, down = event.offsetY - last.y;
    const isShift = event.shiftKey || event.buttons & 6;
    player.look(isShift ? player.view.shifted(right, down, height()) : player.view.turned(right, down, height()));
  });
  for (const name of ["pointerup", "pointercancel", "lostpointercapture"]) {
    canvas.addEventListener(name, (event) => pointers.delete(event.pointerId));
  }
  canvas.addEventListener("pointerleave", () => onHover(-1, -1));
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  const hint = document.getElementById("hint");
  let hintTimer = 0;
  const say = (words) => {
    [hint.textContent, hint.hidden] = [words, false];
    clearTimeout(hintTimer);
    hintTimer = setTimeout(() => { hint.hidden = true; }, 1500);
  };
  canvas.addEventListener("wheel", (event) => {
    if (!isWheelHere(event, say)) return;
    const lines = event.deltaMode === 1 ? event.deltaY : event.deltaY / 40;
    player.look(player.view.zoomed(Math.max(-3, Math.min(3, lines)) * 0.06));
    event.preventDefault();
  }, { passive: false });
}

/** Add a slider that moves a joint. */
function addSlider(player, cell, { name, low, high }, i) {
  const slider = document.createElement("input"), { values } = player.mechanism;
  Object.assign(slider, { type: "range", min: low, max: high, step: "any", value: values[i] });
  slider.setAttribute("aria-label", name);
  slider.addEventListener("input", () => { [values[i], player.isDue] = [Number(slider.value), true]; });
  cell.append(slider);
}

/** Connect the bar, the keys and what is shown under the pointer. */
function connectControls(player) {
  const element = (id) => document.getElementById(id);
  const [canvas, play, time, clock, table, label] = ["view", "play", "time", "clock", "values", "label"].map(element);
  time.max = player.duration;
  const run = (isPlaying) => {
    if (isPlaying && player.time >= player.duration) player.time = 0;
    player.isPlaying = isPlaying && player.duration > 0;
    document.body.classList.toggle("is-playing", player.isPlaying);
    play.setAttribute("aria-label", player.isPlaying ? "Pause" : "Play");
    player.isDue = true;
  };
  const { mechanism } = player;
  const cells = (mechanism ? mechanism.sliders : player.content.joints).map(({ name, unit, low, high }, i) => {
    const row = table.insertRow();
    row.insertCell().textContent = name;
    if (mechanism) addSlider(player, row.insertCell(), { name, low, high }, i);
    const value = row.insertCell();
    return (number) => { value.textContent = `${number.toFixed(3)} ${unit}`; };
  });
  player.onDraw = () => {
    time.value = player.time;
    clock.textContent = `${Math.min(player.time, player.duration).toFixed(2)} s of ${player.duration.toFixed(2)} s`;
    if (!table.hidden) player.jointValues().forEach((number, i) => cells[i](number));
  };
  const showValues = () => {
    table.hidden = !table.hidden;
    element("joints").setAttribute("aria-pressed", !table.hidden);
    player.isDue = true;
  };
  const showFrames = () => {
    player.hasFrames = !player.hasFrames;
    element("frames").setAttribute("aria-pressed", player.hasFrames);
    player.isDue = true;
  };
  const keys = { " ": () => run(!player.isPlaying), j: showValues, f: showFrames, Home: () => player.look(player.first),
                 ArrowRight: () => { run(false); player.seek(player.time + 1 / player.content.fps); },
                 ArrowLeft: () => { run(false); player.seek(player.time - 1 / player.content.fps); } };
  play.addEventListener("click", () => run(!player.isPlaying));
  time.addEventListener("input", () => { run(false); player.seek(Number(time.value)); });
  element("speed").addEventListener("change", (event) => { player.speed = Number(event.target.value); });
  element("joints").addEventListener("click", showValues);
  element("frames").addEventListener("click", showFrames);
  element("joints").hidden = !cells.length;
  document.body.classList.toggle("is-still", !player.duration);
  if (mechanism && cells.length && window.innerWidth >= 600) showValues();
  element("home").addEventListener("click", () => player.look(player.first));
  window.addEventListener("keydown", (event) => {
    if (![document.body, canvas].includes(event.target)) return;  // keys of buttons and sliders are theirs
    if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    keys[event.key]();
    event.preventDefault();
  });
  followPointers(player, canvas, (x, y) => {
    const body = x < 0 ? -1 : player.bodyAt(x, y);
    player.marked = body;
    label.hidden = body < 0;
    label.textContent = body < 0 ? "" : player.content.bodies[body];
    label.style.left = `${Math.min(x + 14, canvas.clientWidth - label.offsetWidth - 4)}px`;
    label.style.top = `${Math.max(y - 30, 4)}px`;
  });
  run(player.isPlaying);
}

unpacked(Uint8Array.from(atob(document.getElementById("scene").textContent), (letter) => letter.charCodeAt(0)))
  .then((scene) => {
    const player = new Player(document.getElementById("view"), scene);
    connectControls(player);
    document.getElementById("notes").open = innerWidth >= 600;  // on a phone they would cover the picture
    window.ravemj = player;  // for scripts of pages that hold this one
  })
  .catch((error) => {
    const box = document.getElementById("error");
    box.hidden = false;
    box.textContent = `This browser cannot show the motion: ${error.message}`;
  });
