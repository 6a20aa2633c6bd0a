"use strict";
// Files that are dropped on the page go to the other side in pieces, which adds them to the environment.

let uploading = Promise.resolve();
const PIECE = 570, MOST_AHEAD = 1 << 20;  // bytes: messages are small, and should not wait behind long files
const MOST_LETTERS = 100, DEEPEST = 8, MOST_FILES = 2000;

window.addEventListener("dragover", (event) => event.preventDefault());
window.addEventListener("drop", (event) => {
  event.preventDefault();
  const entries = [...event.dataTransfer.items].map((item) => item.webkitGetAsEntry && item.webkitGetAsEntry());
  const plain = [...event.dataTransfer.files].map((file) => [fileName(file.name), file]);
  const files = entries.some((entry) => entry && entry.isDirectory) ? inside(entries.filter(Boolean), "") : plain;
  uploading = uploading.then(async () => upload(await files));  // one drop after the other: pieces say no drop
});

/** The files in some folders, and files, each with its path. */
async function inside(entries, above) {
  const found = [];
  for (const entry of entries) {
    const path = above + fileName(entry.name);
    if (entry.isFile) found.push([path, await new Promise((done, failed) => entry.file(done, failed))]);
    else if (above.split("/").length <= DEEPEST) found.push(...await inside(await listed(entry), `${path}/`));
    if (found.length > MOST_FILES) break;
  }
  return found;
}

/** All entries of a folder, which a browser hands out in parts. */
async function listed(folder) {
  const reader = folder.createReader(), all = [];
  for (;;) {
    const part = await new Promise((done, failed) => reader.readEntries(done, failed));
    if (part.length === 0) return all;
    all.push(...part);
  }
}

/** The name that a file has on the other side: letters of any alphabet, at most the last 100 of them. */
function fileName(name) {
  const letters = [...name.normalize().replace(/[^\p{L}\p{N}_() .+-]/gu, "_")].slice(-MOST_LETTERS).join("");
  return letters.replace(/^[ .+)-]/, "_");
}

async function upload(files) {
  const to = socket;
  for (const [name, file] of files) {
    toast(`Sending ${file.name} …`);
    const bytes = new Uint8Array(await file.arrayBuffer()), isLastFile = file === files[files.length - 1][1];
    for (let at = 0; at === 0 || at < bytes.length; at += PIECE) {
      while (socket.bufferedAmount > MOST_AHEAD) await new Promise((done) => setTimeout(done, 20));
      if (socket !== to) return toast(`The connection was lost while ${file.name} was sent: drop it again`);
      const data = btoa(String.fromCharCode(...bytes.subarray(at, at + PIECE)));
      send({ type: "piece", name, data, last: isLastFile && at + PIECE >= bytes.length });
    }
  }
}
