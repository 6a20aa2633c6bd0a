"use strict";
// Tries to connect again after the connection was lost, and says so.

const FIRST_WAIT = 500, LONGEST_WAIT = 10000, GOING_AWAY = 1001;  // ms; the code of a server that ends
const MOST_TRIES = 8;  // for about half a minute, where no later server has this address

class Reconnecting {
  /** Lasting: whether a server that is started anew has the same address. */
  constructor(connect, isLasting) {
    Object.assign(this, { connect, isLasting, tries: 0, timer: 0, isLost: false, hasEnded: false });
    [this.words, this.button] = document.querySelectorAll("#notice span, #notice button");
    this.button.addEventListener("click", () => this.restart());
    window.addEventListener("online", () => this.restart());
    document.addEventListener("visibilitychange", () => { if (!document.hidden) this.restart(); });
  }

  succeed() {
    [this.tries, this.isLost] = [0, false];
    this.say("");
  }

  /** The connection was closed, or could not be opened. */
  fail(code) {
    if (!this.isLost) this.hasEnded = code === GOING_AWAY;
    this.isLost = true;
    if (!this.isLasting && this.hasEnded) return this.say("The viewer has been closed: its server has ended.");
    if (!this.isLasting && this.tries >= MOST_TRIES) {
      return this.say("Connection lost: the server of the viewer has ended, or cannot be reached.", true);
    }
    this.say(`${this.hasEnded ? "The viewer has been closed" : "Connection lost"}, reconnecting …`, true);
    this.timer = setTimeout(() => this.connect(), Math.min(FIRST_WAIT * 2 ** this.tries, LONGEST_WAIT));
    this.tries += 1;
  }

  /** Try now, and then as after the connection was lost. */
  restart() {
    if (this.button.hidden) return;
    clearTimeout(this.timer);
    this.tries = 0;
    this.connect();
  }

  say(words, hasButton = false) {
    this.words.textContent = words;
    this.button.hidden = !hasButton;
    document.body.classList.toggle("is-lost", words !== "");
  }
}
