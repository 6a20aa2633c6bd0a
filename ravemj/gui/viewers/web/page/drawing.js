"use strict";
// Draws what the server sends: surfaces once, then what has changed. The view turns at once; the answer corrects it.

const FRAME = 0, DRAWINGS = 1, LAST_KIND = 2;
const CLICK = 4, NEARER = 0.9, ZOOM = 4;  // as in ravemj/gui/interaction

const canvas = document.createElement("canvas");  // what WebGL draws on; the view is a copy of it
canvas.addEventListener("webglcontextlost", (event) => {
  event.preventDefault();  // or it would not be restored
  showServerPictures("WebGL has stopped");
});
canvas.addEventListener("webglcontextrestored", () => {
  messageQueue = messageQueue.then(() => startDrawing(overlay.scene));
});

class Drawing {
  /** Raises an error where there is no WebGL2. */
  constructor() {
    this.renderer = new Renderer(canvas);
    this.sharpness = new Sharpness(this.renderer, requestDrawing);
    this.reset();
  }

  /** Begin a connection. */
  reset() {
    this.serverView = this.predicted = null;  // the view as the server says, and as it will say
    this.acknowledged = this.predictedBy = 0;  // numbers of messages
    this.resetPointer();
  }

  /** Fetch surfaces; return whether they were there. */
  async load(name) {
    if (this.name === name) return true;
    const answer = await fetch(name).catch(() => ({ ok: false }));
    if (!answer.ok) return false;
    this.renderer.load(await unpacked(await answer.arrayBuffer()));
    this.name = name;
    return true;
  }

  /** Take over a binary message; return whether it is a frame to be drawn. */
  async receive(bytes) {
    const { renderer } = this, [kind] = new Uint32Array(bytes, 0, 1);
    if (kind !== FRAME) {
      const { content, array } = await unpacked(new Uint8Array(bytes, 4));
      renderer.show(kind === DRAWINGS ? "drawings" : "figures", content.drawings, array);
      return false;
    }
    const [, acknowledged, bodies, shapes, cameras] = new Uint32Array(bytes, 0, 5);
    let at = 20;
    const part = (Type, count) => {
      const made = new Type(bytes, at, count);
      at += made.byteLength;
      return made;
    };
    const camera = part(Float32Array, 9 * cameras);
    const positions = part(Float32Array, 3 * bodies), turns = part(Int16Array, 4 * bodies);
    part(Uint32Array, bodies).forEach((body, i) => {
      renderer.place(body, ...positions.subarray(3 * i, 3 * i + 3), ...turns.subarray(4 * i, 4 * i + 4));
    });
    const painted = part(Uint32Array, shapes), colors = part(Uint8Array, 4 * shapes);
    painted.forEach((shape, i) => {
      renderer.shapes[shape].rgba = [...colors.subarray(4 * i, 4 * i + 4)].map((shade) => shade / 255);
    });
    if (cameras) {
      const [x, y, z, w, a, b, c, fovy, distance] = camera;
      this.serverView = new View({ rotation: rotationOf(w, a, b, c), position: [x, y, z], fovy, distance });
    }
    this.acknowledged = acknowledged;
    return true;
  }

  get view() { return this.predicted && this.acknowledged < this.predictedBy ? this.predicted : this.serverView; }

  /** Draw into the canvas of the page. */
  draw() {
    const { width, height } = context2d.canvas;
    if (!this.view || !this.name) return;
    this.sharpness.draw(this.view, -1, width, height);
    context2d.drawImage(canvas, 0, 0, width, height);
  }

  // --- prediction of what the server does with the view, as in ravemj/gui/interaction/pointer_controller.py

  resetPointer() {
    this.buttons = new Set();
    this.press = this.follow = null;
    this.isCenterKeyDown = false;
  }

  /** Do with the view what the server will do with it for a message; return whether that changes anything. */
  predict(message, number, mode, height) {
    const view = this.predictedView(message, mode === "camera", height);
    if (!view || !this.view || !this.view.distance) return false;
    this.predicted = view;
    this.predictedBy = number;
    return true;
  }

  predictedView(message, isCamera, height) {
    const { view } = this, { x, y, steps, tool, amount, button } = message;
    if (!view) return null;
    switch (message.type) {
      case "press":
        this.buttons.add(button);
        this.press = message;
        this.follow = isCamera && !message.touch && !this.isCenterKeyDown ? this.dragFor(message, view, height) : null;
        return null;
      case "move":
      case "release": {
        const right = x - (this.press || message).x, down = y - (this.press || message).y;
        if (this.press && this.press.touch && isCamera && !this.follow && Math.hypot(right, down) > CLICK) {
          this.follow = (across, along) => view.turned(across, along, height);
        }
        const followed = this.follow && this.follow(right, down);
        if (message.type === "release") {
          this.buttons.delete(button);
          this.press = this.follow = null;
        }
        return followed;
      }
      case "wheel": return isCamera ? view.zoomed(Math.log(NEARER) * steps) : null;
      case "fingers": return this.pinched(view, message, height);
      case "use":
        if (tool === "Dolly") return view.zoomed(-ZOOM * amount / height);
        if (tool.startsWith("Rot")) return tool === "RotX" ? view.turned(0, amount, height) : view.turned(amount, 0, height);
        return null;
      case "key": if (message.name === "s") this.isCenterKeyDown = message.pressed; return null;
      case "leave": this.resetPointer(); return null;
      default: return null;
    }
  }

  dragFor({ button, shift }, view, height) {
    if (this.buttons.has("left") && this.buttons.has("middle")) {
      return (right, down) => view.zoomed(-ZOOM * down / height);
    }
    if (button === "middle" || (button === "left" && shift)) return (right, down) => view.shifted(right, down, height);
    return button === "left" ? (right, down) => view.turned(right, down, height) : null;
  }

  pinched(view, { x, y, right, down, spread }, height) {
    const across = x - 0.5 * context2d.canvas.clientWidth, along = y - 0.5 * height;
    return view.zoomed(-Math.log(spread))
      .shifted(across - spread * (across - right), along - spread * (along - down), height);
  }
}

let isOverlayNew = false, unacknowledged = 0, frameRequest = 0;

/** Draw with the screen's next picture, and say so for all frames that have come until then. */
function requestDrawing() {
  frameRequest ||= requestAnimationFrame(() => {
    frameRequest = 0;
    draw();
    for (; unacknowledged > 0; unacknowledged -= 1) ready();
  });
}

function draw() {
  if (!drawing || !drawing.view) return;
  drawing.renderer.look = overlay.look;
  drawing.renderer.hasEdgesOnly = overlay.edges;
  drawing.draw();
  drawLabels(overlay.labels.flatMap(([x, y, z, words]) => {
    const place = drawing.view.projected([x, y, z], view.clientWidth, view.clientHeight);
    return place ? [[...place, words]] : [];
  }));
  if (isOverlayNew) showOverlay(overlay);
  isOverlayNew = false;
}

/** Let this page draw, from surfaces that are known by a name if any are; without WebGL, show pictures. */
async function startDrawing(scene) {
  try {
    drawing = new Drawing();
    document.getElementById("source").hidden = true;
    send({ type: "draws", itself: true });
    if (scene) await drawing.load(scene);
  } catch (error) {
    showServerPictures(error.message);
  }
}

function showServerPictures(why) {
  const source = document.getElementById("source");
  [source.hidden, source.title] = [false, why];
  drawing = null;
  send({ type: "draws", itself: false });
}
