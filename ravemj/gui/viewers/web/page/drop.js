"use strict";
// Files that are dropped on the page go to the other side in pieces, which adds them to the environment.

let uploading = Promise.resolve();
const PIECE = 570, MOST_LETTERS = 100, MOST_NAME = 255, MOST_AHEAD = 1 << 20;  // bytes: messages are small, and should not wait behind long files

window.addEventListener("dragover", (event) => event.preventDefault());
window.addEventListener("drop", (event) => {
  event.preventDefault();
  const files = [...event.dataTransfer.files];
  uploading = uploading.then(() => upload(files));  // one drop after the other: pieces say no drop
});

/** A name that file systems take: letters of any alphabet, the last 100 of them, within 255 bytes with the suffix. */
function fileName(name) {
  const letters = [...name.replace(/[^\p{L}\p{N}_() .+-]/gu, "_").replace(/^[^\p{L}\p{N}_(]/u, "_")].slice(-MOST_LETTERS);
  if (!/[\p{L}\p{N}_(]/u.test(letters[0])) letters[0] = "_";
  const suffix = letters.splice(letters.lastIndexOf(".") + 1 ? letters.lastIndexOf(".") : letters.length).join("");
  const size = (words) => new TextEncoder().encode(words).length;
  while (size(letters.join("") + suffix) > MOST_NAME) letters.pop();
  return letters.join("") + suffix;
}

async function upload(files) {
  for (const file of files) {
    toast(`Sending ${file.name} …`);
    const bytes = new Uint8Array(await file.arrayBuffer()), isLastFile = file === files[files.length - 1];
    const name = fileName(file.name);
    for (let at = 0; at === 0 || at < bytes.length; at += PIECE) {
      while (socket.bufferedAmount > MOST_AHEAD) await new Promise((done) => setTimeout(done, 20));
      const data = btoa(String.fromCharCode(...bytes.subarray(at, at + PIECE)));
      send({ type: "piece", name, data, last: isLastFile && at + PIECE >= bytes.length });
    }
  }
}
