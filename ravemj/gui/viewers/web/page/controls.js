"use strict";
// Playing a motion, saving, and a slider for each joint: built from what the server says there is.

const QUIET = 400;  // after so long without a touch [ms], a slider shows what the server says
const PLAYING = ["back", "play", "forward", "seek", "speed"];
const TOGGLES = ["joints", "view", "display", "tree", "help"];
const CONTAINERS = { playing: "motion", "joint tools": "joint-tools" };  // of groups whose element has another id
const ICONS = {
  back: "M6 5h2.4v14H6zM19 5v14L9.5 12z",
  forward: "M15.6 5H18v14h-2.4zM5 5v14l9.5-7z",
  play: "M7 4.5v15l12-7.5z",
  pause: "M6.5 5h3.8v14H6.5zM13.7 5h3.8v14h-3.8z",
};
[ICONS.run, ICONS.step] = [ICONS.play, ICONS.forward];
const entries = new Map();  // by the names of controls: the row of each, and for sliders what is in it

function showControls(controls) {
  const motion = document.getElementById("motion");
  const names = new Set(controls.map((control) => control.name));
  for (const [name, entry] of entries) {
    if (names.has(name)) continue;
    entry.row.remove();
    entries.delete(name);
  }
  for (const control of controls) {
    if (!entries.has(control.name)) entries.set(control.name, createControl(control));
    updateControl(entries.get(control.name), control);
  }
  motion.hidden = !names.has("seek");
  document.getElementById("time").hidden = !names.has("run");
  for (const group of ["joints", "menu"]) {
    document.getElementById(group).hidden = !controls.some((control) => control.group === group);
  }
  document.body.classList.toggle("has-motion", !motion.hidden);
}

function createControl({ name, group, lower, upper }) {
  const entry = lower < upper ? createSlider(name) : name === "clock" ? createText(name) : createButton(name);
  const order = (row) => PLAYING.indexOf(row.dataset.name);
  const container = document.getElementById(CONTAINERS[group] || group);
  const next = group === "playing" ? [...container.children].find((other) => order(other) > order(entry.row)) : null;
  container.insertBefore(entry.row, next || null);
  return entry;
}

function createButton(name) {
  const row = document.createElement("button");
  row.type = "button";
  row.dataset.name = name;
  row.addEventListener("click", () => send({ type: "operate", name, value: 0 }));
  return { row };
}

function createText(name) {
  const row = document.createElement("output");
  row.dataset.name = name;
  return { row };
}

function createSlider(name) {
  const row = document.createElement("label"), title = document.createElement("span");
  const input = document.createElement("input");
  const output = document.createElement(name === "seek" ? "output" : "input");
  if (name !== "seek") output.className = "number";
  row.dataset.name = name;
  input.type = "range";
  input.step = "any";
  const entry = { row, title, input, output, touched: -QUIET };
  input.addEventListener("input", () => {
    entry.touched = performance.now();
    send({ type: "operate", name, value: Number(input.value) });
  });
  output.addEventListener("change", () => {  // a number was typed, in the unit that is shown
    const number = parseFloat(output.value), perUnit = output.dataset.unit === "deg" ? Math.PI / 180 : 1;
    if (Number.isFinite(number)) send({ type: "operate", name, value: Math.max(-1e5, Math.min(1e5, number * perUnit)) });
    output.blur();
  });
  output.addEventListener("keydown", (event) => {  // what was there stays
    if (event.key === "Escape") output.value = output.dataset.text;
  });
  row.append(title, input, output);
  return entry;
}

function updateControl(entry, control) {
  if (entry.input) {
    const { input, title, output } = entry;
    if (title.textContent !== control.label) showName(title, control.label);
    [input.min, input.max] = [control.lower, control.upper];
    const isHeld = input.matches(":active") || performance.now() - entry.touched < QUIET;
    if (!isHeld) input.value = control.value;
    input.setAttribute("aria-valuetext", control.text);
    if (output.className !== "number") output.textContent = control.text;
    else {
      input.setAttribute("aria-label", control.label);
      output.setAttribute("aria-label", `${control.label}, value`);
      const unit = output.dataset.unit = control.text.split(" ").pop();
      const [low, high] = [control.lower, control.upper].map((end) => (unit === "deg" ? 180 / Math.PI : 1) * end);
      title.title = `${control.label}: ${low.toFixed(2)} to ${high.toFixed(2)} ${unit}`;
      output.dataset.text = control.text;
      if (document.activeElement !== output) output.value = control.text;
    }
    return;
  }
  const { row } = entry;
  const isRunning = ["play", "run"].includes(control.name) && control.is_on;
  const icon = ICONS[isRunning ? "pause" : control.name];
  const label = ["speed", "pace"].includes(control.name) ? `${control.label} ${control.text}` : control.label;
  row.title = label;
  row.setAttribute("aria-label", label);
  row.dataset.on = control.is_on === true;
  if (TOGGLES.includes(control.name)) row.setAttribute("aria-expanded", control.is_on);
  if (!icon) row.textContent = control.text;
  else if (row.dataset.icon !== icon) {
    row.dataset.icon = icon;
    row.innerHTML = `<svg viewBox="0 0 24 24" aria-hidden="true"><path d="${icon}"/></svg>`;
  }
}

// --- help: headings, and rows of what is wanted and what to do for it

function showHelp(sections) {
  const help = document.getElementById("help");
  help.hidden = sections.length === 0;
  if (help.hidden || help.childElementCount) return;
  const columns = document.createElement("div");
  help.append(columns);
  if (matchMedia("(pointer: coarse)").matches) sections = [sections[sections.length - 1], ...sections.slice(0, -1)];
  for (const [title, rows] of sections) {
    const heading = document.createElement("h2"), list = document.createElement("dl");
    heading.textContent = title;
    for (const [to, how] of rows) {
      const term = document.createElement("dt"), gesture = document.createElement("dd");
      [term.textContent, gesture.textContent] = [to, how];
      list.append(term, gesture);
    }
    const section = document.createElement("section");
    section.append(heading, list);
    columns.append(section);
  }
}
document.getElementById("help").addEventListener("click", () => send({ type: "operate", name: "help", value: 0 }));

// --- keys of the view, while there is a motion, or simulation time

const KEYS = { " ": ["play", "run"], ArrowLeft: ["back"], ArrowRight: ["forward", "step"] };
window.addEventListener("keydown", (event) => {
  const name = (KEYS[event.key] || []).find((one) => entries.has(one));
  const isForControl = event.target !== document.body && event.target.id !== "view";
  if (!name || isForControl || event.ctrlKey || event.altKey || event.metaKey) return;
  event.preventDefault();
  if (!event.repeat || !["play", "run"].includes(name)) send({ type: "operate", name, value: 0 });
});

// --- what only a browser can do

function doTask({ task, name, data, text }) {
  if (task === "save") save(name, data);
  if (task === "copy") copy(text);
}

function save(name, data) {
  const bytes = Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0));
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([bytes], { type: name.endsWith(".mp4") ? "video/mp4" : "image/png" }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  toast(`Saved ${name} where this browser keeps downloads`);
}

async function copy(text) {
  try {
    await navigator.clipboard.writeText(text);
    toast(`Copied ${text.replace(/\[.*\]/, "[…]")}`);
  } catch {
    if (copyOldWay(text)) toast(`Copied ${text.replace(/\[.*\]/, "[…]")}`);
    else prompt("The browser lets no page copy; this is the line:", text);
  }
}

function copyOldWay(text) {  // where pages have no clipboard: on other machines without https
  const area = document.createElement("textarea"), before = document.activeElement;
  area.value = text;
  document.body.append(area);
  area.select();
  const isCopied = document.execCommand("copy");
  area.remove();
  if (before) before.focus({ focusVisible: false });
  return isCopied;
}

let toastTimer = 0;
function toast(words, duration = 6000) {
  const element = document.getElementById("toast");
  element.textContent = words;
  clearTimeout(toastTimer);
  toastTimer = setTimeout(() => { element.textContent = ""; }, duration);
}
