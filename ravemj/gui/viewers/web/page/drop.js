"use strict";
// Files that are dropped on the page go to the other side in pieces, which adds them to the environment.

let uploading = Promise.resolve();
const PIECE = 570, MOST_AHEAD = 1 << 20;  // bytes: messages are small, and should not wait behind long files
const MOST_LETTERS = 100;

window.addEventListener("dragover", (event) => event.preventDefault());
window.addEventListener("drop", (event) => {
  event.preventDefault();
  const files = [...event.dataTransfer.files];
  uploading = uploading.then(() => upload(files));  // one drop after the other: pieces say no drop
});

/** The name that a file has on the other side: letters of any alphabet, at most the last 100 of them. */
function fileName(name) {
  const letters = [...name.normalize().replace(/[^\p{L}\p{N}_() .+-]/gu, "_")].slice(-MOST_LETTERS).join("");
  return letters.replace(/^[ .+)-]/, "_");
}

async function upload(files) {
  const to = socket;
  for (const file of files) {
    toast(`Sending ${file.name} …`);
    const bytes = new Uint8Array(await file.arrayBuffer()), isLastFile = file === files[files.length - 1];
    const name = fileName(file.name);
    for (let at = 0; at === 0 || at < bytes.length; at += PIECE) {
      while (socket.bufferedAmount > MOST_AHEAD) await new Promise((done) => setTimeout(done, 20));
      if (socket !== to) return toast(`The connection was lost while ${file.name} was sent: drop it again`);
      const data = btoa(String.fromCharCode(...bytes.subarray(at, at + PIECE)));
      send({ type: "piece", name, data, last: isLastFile && at + PIECE >= bytes.length });
    }
  }
}
