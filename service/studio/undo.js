/** What has been stated, step by step, to go back and forth in. */

/** @import { Problem } from "./types/values.js" */

/** Edits that follow one another so soon are one step: a number that is typed, a point that is dragged. */
const BURST_MS = 700;

/** Steps that are kept. */
const MOST = 200;

/** Statements as JSON, the oldest first in both. @typedef {{past: string[], future: string[]}} Steps */

export class Undo {
  /** @param {(statement: Problem) => void} apply @param {HTMLButtonElement} back @param {HTMLButtonElement} forth */
  constructor(apply, back, forth) {
    this.apply = apply;
    this.buttons = { back, forth };
    /** @type {string[]} */
    this.past = [];
    /** @type {string[]} */
    this.future = [];
    this.now = "";
    this.noted = 0;
    back.addEventListener("click", () => this.undo());
    forth.addEventListener("click", () => this.redo());
    this.tell();
  }

  /**
   * Note the statement as it is now.
   * @param {Problem} statement
   * @param {boolean} [apart] whether it is a step of its own however soon it follows
   */
  note(statement, apart = false) {
    const text = JSON.stringify(statement);
    if (text === this.now) return;
    const time = performance.now();
    if (this.now && (apart || time - this.noted > BURST_MS)) this.past = [...this.past, this.now].slice(-MOST);
    this.noted = apart ? -Infinity : time;
    this.now = text;
    this.future = [];
    this.tell();
  }

  /** @returns {Steps} */
  get steps() {
    return { past: this.past, future: this.future };
  }

  /** Go on from where another page has ended, with the same statement. @param {Steps} steps */
  resume({ past, future }) {
    this.past = past;
    this.future = future;
    this.tell();
  }

  undo() {
    const before = this.past.pop();
    if (before === undefined) return;
    this.future.push(this.now);
    this.go(before);
  }

  redo() {
    const next = this.future.pop();
    if (next === undefined) return;
    this.past.push(this.now);
    this.go(next);
  }

  /** @param {string} text */
  go(text) {
    this.now = text;
    this.noted = -Infinity;
    this.tell();
    this.apply(JSON.parse(text));
  }

  tell() {
    this.buttons.back.disabled = !this.past.length;
    this.buttons.forth.disabled = !this.future.length;
  }
}
