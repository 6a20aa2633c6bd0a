"use strict";
// The bodies, links and joints: a click selects in the picture, and what is selected in the picture is marked here.

const tree = document.getElementById("tree"), branches = tree.querySelector("[role=tree]");
const search = tree.querySelector("input");
const MARKS = { body: "▣", link: "◆", joint: "↻" };
let marked = "", listed = null;

function showTree(nodes, chosen) {  // an empty list: it is folded
  if (nodes !== listed) {
    listed = nodes;
    tree.hidden = nodes.length === 0;
    branches.replaceChildren(...nodes.map(branch));
    marked = "";
    sift();
  }
  if (tree.hidden || marked === chosen.join()) return;
  marked = chosen.join();
  let last = null;
  for (const row of branches.children) {
    const isChosen = chosen.includes(row.dataset.name);
    row.setAttribute("aria-selected", isChosen);
    if (isChosen && row.dataset.name === chosen[chosen.length - 1]) last = row;
  }
  if (last) last.scrollIntoView({ block: "nearest" });
}

function branch([name, text, kind, depth]) {
  const row = document.createElement("button");
  row.type = "button";
  row.tabIndex = -1;
  row.dataset.name = name;
  row.dataset.kind = kind;
  row.setAttribute("role", "treeitem");
  row.setAttribute("aria-level", depth + 1);
  row.style.setProperty("--depth", Math.min(depth, 12));
  row.title = `${kind} ${text}`;
  row.textContent = `${MARKS[kind]} ${text}`;
  row.addEventListener("click", () => send({ type: "operate", name, value: 0 }));
  return row;
}

function sift() {  // show only what has the words of the search in its name
  const words = search.value.toLowerCase().split(/\s+/);
  let first = null;
  for (const row of branches.children) {
    const name = row.textContent.toLowerCase();
    row.hidden = !words.every((word) => name.includes(word));
    first ||= row.hidden ? null : row;
  }
  if (first) first.tabIndex = 0;
}
search.addEventListener("input", sift);

function walk(from, step) {  // from the search or a row to the next one that is shown
  const rows = [search, ...[...branches.children].filter((row) => !row.hidden)];
  const next = rows[rows.indexOf(from) + step];
  if (next) next.focus();
}

tree.addEventListener("keydown", (event) => {
  const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
  if (step) walk(event.target, step);
  else if (event.key === "Enter" && event.target === search) {
    const first = [...branches.children].find((row) => !row.hidden);
    if (first) first.click();
  } else return;
  event.preventDefault();
});
