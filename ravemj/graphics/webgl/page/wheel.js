/* In a frame, the wheel scrolls the page around it until somebody clicks into the frame, as on embedded maps. */
"use strict";

const isFramed = window.parent !== window;
let isWheelWanted = !isFramed;

if (isFramed) {
  document.documentElement.style.overscrollBehavior = document.body.style.overscrollBehavior = "auto";
  window.addEventListener("pointerdown", () => { isWheelWanted = true; }, { capture: true });
  window.addEventListener("blur", () => { isWheelWanted = false; });
  document.documentElement.addEventListener("pointerleave", ({ buttons }) => { if (!buttons) isWheelWanted = false; });
}

/** Whether a turn of the wheel is for the view; if not, say how it would be. */
function isWheelHere(event, say) {
  if (isWheelWanted || event.ctrlKey || event.metaKey) return true;
  const key = navigator.platform.startsWith("Mac") ? "⌘" : "Ctrl";
  say(`Click here, or hold ${key}, to zoom with the wheel`);
  return false;
}
