"use strict";
// The bodies, links and joints: a click selects in the picture, and what is selected in the picture is marked here.

const tree = document.getElementById("tree"), rows = tree.querySelector("[role=tree]");
const search = tree.querySelector("input");
const MARKS = { body: "▣", link: "◆", joint: "↻" };
let selected = "", shownNodes = null;

function showTree(nodes, chosen) {  // an empty list: it is folded
  if (nodes !== shownNodes) {
    shownNodes = nodes;
    tree.hidden = nodes.length === 0;
    rows.replaceChildren(...nodes.map(createRow));
    selected = "";
    filterRows();
  }
  if (tree.hidden || selected === chosen.join()) return;
  selected = chosen.join();
  let last = null;
  for (const row of rows.children) {
    const isChosen = chosen.includes(row.dataset.name);
    row.setAttribute("aria-selected", isChosen);
    if (isChosen && row.dataset.name === chosen[chosen.length - 1]) last = row;
  }
  if (last) last.scrollIntoView({ block: "nearest" });
}

function createRow([name, text, kind, depth]) {
  const row = document.createElement("button");
  row.type = "button";
  row.tabIndex = -1;
  row.dataset.name = name;
  row.dataset.kind = kind;
  row.setAttribute("role", "treeitem");
  row.setAttribute("aria-level", depth + 1);
  row.style.setProperty("--depth", Math.min(depth, 12));
  row.title = `${kind} ${text}`;
  showName(row, `${MARKS[kind]} ${text}`);
  row.addEventListener("click", () => send({ type: "operate", name, value: 0 }));
  return row;
}

function showName(element, name) {  // long names break behind what separates their words
  element.replaceChildren(...name.split(/(?<=[_./:-])|(?<=[a-z])(?=[A-Z])/).flatMap((part, i) => {
    return i ? [document.createElement("wbr"), part] : [part];
  }));
}

function filterRows() {  // show only rows whose names contain all words of the search
  const words = search.value.toLowerCase().split(/\s+/);
  rows.classList.toggle("is-flat", search.value.trim() !== "");
  let first = null;
  for (const row of rows.children) {
    const name = row.textContent.toLowerCase();
    row.hidden = !words.every((word) => name.includes(word));
    first ||= row.hidden ? null : row;
  }
  if (first) first.tabIndex = 0;
}
search.addEventListener("input", filterRows);

function moveFocus(from, step) {  // from the search or a row to the next one that is shown
  const stops = [search, ...[...rows.children].filter((row) => !row.hidden)];
  const next = stops[stops.indexOf(from) + step];
  if (next) next.focus();
}

tree.addEventListener("keydown", (event) => {
  const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
  if (event.key === "Escape" && event.target === search) {
    search.value = "";
    filterRows();
  }
  if (step) moveFocus(event.target, step);
  else if (event.key === "Enter" && event.target === search) {
    const first = [...rows.children].find((row) => !row.hidden);
    if (first) first.click();
  } else return;
  event.preventDefault();
});
