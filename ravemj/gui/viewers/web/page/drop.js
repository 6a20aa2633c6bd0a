"use strict";
// Files that are dropped on the page go to the other side in pieces, which adds them to the environment.

const PIECE = 570, MOST_AHEAD = 1 << 20;  // bytes: messages are small, and should not wait behind long files

window.addEventListener("dragover", (event) => event.preventDefault());
window.addEventListener("drop", (event) => {
  event.preventDefault();
  upload([...event.dataTransfer.files]);
});

async function upload(files) {
  for (const file of files) {
    toast(`Sending ${file.name} …`);
    const bytes = new Uint8Array(await file.arrayBuffer()), isLastFile = file === files[files.length - 1];
    const name = file.name.replace(/[^\w() .+-]/g, "_").replace(/^[^\w(]/, "_").slice(-100);
    for (let at = 0; at === 0 || at < bytes.length; at += PIECE) {
      while (socket.bufferedAmount > MOST_AHEAD) await new Promise((done) => setTimeout(done, 20));
      const data = btoa(String.fromCharCode(...bytes.subarray(at, at + PIECE)));
      send({ type: "piece", name, data, last: isLastFile && at + PIECE >= bytes.length });
    }
  }
}
