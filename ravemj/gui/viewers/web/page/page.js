"use strict";
const view = document.getElementById("view"), text = document.getElementById("text");
const context2d = view.getContext("2d");
const buttons = ["left", "middle", "right"];
const LONG_PRESS = 550, FAR = 4, LEAST_SIDE = 16, LARGEST_SIDE = 4096;

// --- the connection

let socket = null, overlay = {}, pendingReadies = 0, sentCount = 0;
let drawing = null;  // what draws in this page; null: the server draws
let messageQueue = Promise.resolve();  // messages are handled one after the other

let tab = crypto.getRandomValues(new Uint32Array(3)).join("-");
try {
  tab = sessionStorage.ravemj ||= tab;  // frames of a tab share it
} catch {}  // browsers may refuse it in frames of other sites
const reconnecting = new Reconnecting(connect, document.body.dataset.lasting !== "");

function send(message) {
  if (!socket || socket.readyState !== WebSocket.OPEN) return;
  socket.send(JSON.stringify(message));
  if (message.type === "ready") return;
  sentCount += 1;
  if (drawing && drawing.predict(message, sentCount, overlay.mode, view.clientHeight)) requestDrawing();
}

function connect() {
  if (socket) socket.close();
  const opened = socket = new WebSocket(new URL("socket?tab=" + tab, location.href.replace(/^http/, "ws")));
  opened.binaryType = "arraybuffer";
  opened.onopen = () => {
    reconnecting.succeed();
    [overlay, sentCount] = [{}, 0];
    if (drawing) drawing.reset();
    sendShape();
    send({ type: "draws", itself: drawing !== null });
    ready();
  };
  opened.onmessage = ({ data }) => {  // one after the other: some take time
    messageQueue = messageQueue.then(() => (opened === socket ? handleMessage(data, opened) : null)).catch((error) => {
      console.error(error);
      if (drawing) showServerPictures(error.message);
    });
  };
  opened.onclose = (event) => {
    if (opened === socket) reconnecting.fail(event.code);
  };
}

function ready() {  // pages that nobody sees take no pictures
  if (document.hidden) pendingReadies += 1;
  else send({ type: "ready" });
}

document.addEventListener("visibilitychange", () => {
  for (; pendingReadies > 0 && !document.hidden; pendingReadies -= 1) send({ type: "ready" });
});

async function handleMessage(data, from) {
  if (typeof data === "string") {
    const message = JSON.parse(data);
    if (message.task) return doTask(message);
    overlay = { ...overlay, ...message };
    tab = overlay.tab || tab;  // another one if a frame beside this one has it
    for (const one of message.changed || []) {
      overlay.controls = overlay.controls.map((other) => (other.name === one.name ? { ...other, ...one } : other));
    }
    isOverlayNew = true;
    if (drawing && message.scene && !await drawing.load(message.scene)) from.close();
  } else if (new Uint8Array(data)[0] > LAST_KIND) {
    showPicture(data, overlay, from);
  } else if (!drawing || await drawing.receive(data)) {
    unacknowledged += 1;
    requestDrawing();
  }
}

// --- pictures and text

let received = 0, newest = 0;

async function showPicture(data, over, from) {
  const number = received += 1;
  try {
    const picture = await createImageBitmap(new Blob([data]));
    if (from === socket && number > newest) {  // a later one may have been decoded first
      newest = number;
      context2d.drawImage(picture, 0, 0, view.width, view.height);
      showOverlay(over);
      drawLabels(over.labels);
    }
    picture.close();
  } finally {
    if (from === socket) ready();
  }
}

function showOverlay(over) {
  const lines = over.lines.join("\n");
  if (text.innerText !== lines) text.innerText = lines;
  text.hidden = lines === "";
  text.style.fontSize = over.textSize ? `${over.textSize}px` : "";
  view.style.cursor = pressed && over.cursor === "grab" ? "" : over.cursor;
  showControls(over.controls);
  showHelp(over.help);
  showTree(over.tree, over.chosen);
  document.title = over.title;
  Object.assign(document.body.dataset, { mode: over.mode, crisp: over.crisp });
  for (const button of document.querySelectorAll("#modes button")) {
    button.setAttribute("aria-pressed", button.dataset.mode === over.mode);
  }
}

function drawLabels(labels) {  // texts in the world: [column, row, text]
  const ratio = view.width / Math.max(1, view.clientWidth);
  context2d.font = `${12 * ratio}px system-ui, sans-serif`;
  context2d.lineWidth = 3 * ratio;
  context2d.lineJoin = "round";
  context2d.textAlign = "center";
  context2d.strokeStyle = "rgba(255, 255, 255, 0.8)";
  context2d.fillStyle = "#20242c";
  for (const [x, y, words] of labels) {
    context2d.strokeText(words, x * ratio, y * ratio);
    context2d.fillText(words, x * ratio, y * ratio);
  }
}

function sendShape() {
  const ratio = Math.min(Math.max(window.devicePixelRatio || 1, 0.1), 10);
  const width = Math.max(1, view.clientWidth), height = Math.max(1, view.clientHeight);
  const columns = Math.round(width * ratio), rows = Math.round(height * ratio);
  if (view.width !== columns || view.height !== rows) {
    const kept = document.createElement("canvas");  // what is seen until the next picture comes
    [kept.width, kept.height] = [view.width, view.height];
    kept.getContext("2d").drawImage(view, 0, 0);
    [view.width, view.height] = [columns, rows];
    context2d.drawImage(kept, 0, 0, columns, rows);
    requestDrawing();
  }
  send({ type: "shape", ...pictureShape(width, height, ratio) });
}

/** Shape of the view in pictures of the server, which have bounds. */
function pictureShape(width, height, ratio) {
  const most = Math.min(ratio, LARGEST_SIDE / Math.max(width, height));
  const least = Math.ceil(LEAST_SIDE / most);
  return { width: Math.max(width, least), height: Math.max(height, least), ratio: most };
}

let resizeTimer = 0;
window.addEventListener("resize", () => {
  clearTimeout(resizeTimer);
  resizeTimer = setTimeout(sendShape, 100);  // each size costs the server new buffers
});

// --- mouse and keys

function sendMouse(type, event) {
  const button = buttons[event.button];
  if (!button) return;
  const held = { ctrl: event.ctrlKey || event.metaKey, shift: event.shiftKey, touch: false };
  send({ type, x: event.clientX, y: event.clientY, button, ...held });
}

let pressed = false;
view.addEventListener("mousedown", (event) => {
  view.focus({ focusVisible: false });
  pressed = true;
  sendMouse("press", event);
  event.preventDefault();
});
window.addEventListener("mouseup", (event) => {
  if (!pressed) return;
  pressed = event.buttons !== 0;
  sendMouse("release", event);
});
window.addEventListener("mousemove", (event) => {
  const inside = pressed || event.target === view;
  send(inside ? { type: "move", x: event.clientX, y: event.clientY } : { type: "move", x: -1, y: -1 });
});
document.documentElement.addEventListener("mouseleave", () => {
  if (!pressed) send({ type: "move", x: -1, y: -1 });
});
window.addEventListener("contextmenu", (event) => event.preventDefault());
view.addEventListener("auxclick", (event) => event.preventDefault());
view.addEventListener("wheel", (event) => {
  if (!isWheelHere(event, (words) => toast(words, 1500))) return;
  const steps = event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? event.deltaY / 100 : event.deltaY / 3;
  send({ type: "wheel", steps: Math.max(-10, Math.min(10, -steps)) });
  event.preventDefault();
}, { passive: false });

const KNOWN_KEYS = /^(Escape|[a-z0-9?=+-]|Home|F1)$/i;  // Space and arrows are for what has the focus
window.addEventListener("keydown", (event) => {
  const isTyping = event.target.matches("input:not([type=range])");
  if (isTyping && event.key === "Escape") view.focus({ focusVisible: false });
  if (!KNOWN_KEYS.test(event.key) || isTyping || event.ctrlKey || event.altKey || event.metaKey) return;
  if (event.key === "F1" || event.key === "Home") event.preventDefault();
  if (!event.repeat) send({ type: "key", name: event.key, pressed: true });
});
window.addEventListener("keyup", (event) => {
  if (KNOWN_KEYS.test(event.key)) send({ type: "key", name: event.key, pressed: false });
});
window.addEventListener("blur", () => {
  pressed = false;
  send({ type: "leave" });
});

// --- fingers: one turns or drags, two shift and zoom, a tap selects, a long press is a click with Ctrl

const fingers = new Map();
let longPressTimer = 0, touchStart = null, isPinching = false;

function sendTouch(type, event, ctrl = false) {
  send({ type, x: event.clientX, y: event.clientY, button: "left", ctrl, shift: false, touch: true });
}

function pinch() {
  const [one, other] = [...fingers.values()];
  const x = (one.x + other.x) / 2, y = (one.y + other.y) / 2;
  return { x, y, apart: Math.max(1, Math.hypot(one.x - other.x, one.y - other.y)) };
}

function longPress() {
  const event = touchStart;
  touchStart = null;
  if (navigator.vibrate) navigator.vibrate(15);
  send({ type: "leave" });
  sendTouch("press", event, true);
  sendTouch("release", event, true);
  send({ type: "leave" });
}

view.addEventListener("pointerdown", (event) => {
  if (event.pointerType !== "touch") return;
  event.preventDefault();  // no events of a mouse in its wake
  view.setPointerCapture(event.pointerId);
  fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  clearTimeout(longPressTimer);
  if (fingers.size === 1) {
    touchStart = event;
    isPinching = false;
    sendTouch("press", event);
    longPressTimer = setTimeout(longPress, LONG_PRESS);
  } else {
    touchStart = null;
    isPinching = true;
    send({ type: "leave" });
  }
});

view.addEventListener("pointermove", (event) => {
  const finger = fingers.get(event.pointerId);
  if (!finger) return;
  const before = fingers.size === 2 ? pinch() : null;
  [finger.x, finger.y] = [event.clientX, event.clientY];
  if (before) {
    const now = pinch();
    const [right, down, spread] = [now.x - before.x, now.y - before.y, now.apart / before.apart];
    send({ type: "fingers", x: now.x, y: now.y, right, down, spread });
  } else if (touchStart && !isPinching) {
    const distance = Math.hypot(event.clientX - touchStart.clientX, event.clientY - touchStart.clientY);
    if (distance > FAR) clearTimeout(longPressTimer);
    send({ type: "move", x: event.clientX, y: event.clientY });
  }
});

function endTouch(event) {
  if (!fingers.delete(event.pointerId)) return;
  clearTimeout(longPressTimer);
  if (touchStart && !isPinching && event.type === "pointerup") sendTouch("release", event);
  touchStart = null;
  send({ type: "leave" });  // a finger that is gone points at nothing
}
view.addEventListener("pointerup", endTouch);
view.addEventListener("pointercancel", endTouch);

// --- buttons and wheels

for (const button of document.querySelectorAll("#modes button")) {
  button.addEventListener("click", () => send({ type: "use", tool: button.dataset.tool, amount: 0 }));
}

class Wheel {
  constructor(element) {
    this.element = element;
    this.upright = element.getAttribute("aria-orientation") === "vertical";
    this.offset = 0;  // to the right or down
    this.at = null;
    element.addEventListener("pointerdown", (event) => {
      element.setPointerCapture(event.pointerId);
      this.at = this.place(event);
    });
    element.addEventListener("pointermove", (event) => {
      if (this.at === null) return;
      this.turn(this.place(event) - this.at);
      this.at = this.place(event);
    });
    for (const end of ["pointerup", "pointercancel"]) element.addEventListener(end, () => { this.at = null; });
    element.addEventListener("keydown", (event) => this.press(event));
  }

  place(event) {
    return this.upright ? event.clientY : event.clientX;
  }

  press(event) {
    const more = this.upright ? -1 : 1;  // up and right are more
    const steps = { ArrowUp: 10, ArrowRight: 10, ArrowDown: -10, ArrowLeft: -10, PageUp: 60, PageDown: -60 };
    if (!(event.key in steps) || event.ctrlKey || event.altKey || event.metaKey) return;
    this.turn(more * steps[event.key]);
    event.preventDefault();
  }

  turn(amount) {
    if (amount === 0) return;
    this.offset += amount;
    send({ type: "use", tool: this.element.dataset.tool, amount });
    this.element.style.setProperty("--turn", this.offset + "px");
    const value = this.upright ? -this.offset : this.offset;
    if (this.element.dataset.tool === "Dolly") {
      this.element.setAttribute("aria-valuenow", Math.round(Math.max(-1000, Math.min(1000, value))));
      this.element.setAttribute("aria-valuetext", `${Math.abs(Math.round(value))} ${value < 0 ? "nearer" : "farther"}`);
    } else {
      const degrees = Math.round(180 * value / Math.max(1, view.clientHeight));
      const wrapped = ((degrees + 180) % 360 + 360) % 360 - 180;
      this.element.setAttribute("aria-valuenow", wrapped);
      this.element.setAttribute("aria-valuetext", `${wrapped} degrees`);
    }
  }
}

for (const element of document.querySelectorAll("[role=slider]")) new Wheel(element);
connect();  // which takes its time
if (new URLSearchParams(location.search).has("pictures")) showServerPictures("the address asks for pictures");
else messageQueue = startDrawing(document.body.dataset.scene);  // most likely what the server will name
