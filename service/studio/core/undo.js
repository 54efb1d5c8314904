/** What has been stated, step by step, to go back and forth in. */

/** @import { Problem } from "../types/values.js" */

/** Edits that follow one another so soon are one step: a number that is typed, a point that is dragged. */
const BURST_MS = 700;

/** Steps that are kept. */
const MAX_STEPS = 200;

/** Statements as JSON, the oldest first in both. @typedef {{past: string[], future: string[]}} Steps */

export class Undo {
  constructor() {
    /** @type {string[]} */
    this.past = [];
    /** @type {string[]} */
    this.future = [];
    this.now = "";
    this.noted = 0;
  }

  /**
   * Note the statement as it is now.
   * @param {Problem} statement
   * @param {boolean} [apart] whether it is a step of its own however soon it follows
   */
  record(statement, apart = false) {
    const text = JSON.stringify(statement);
    if (text === this.now) return;
    const time = performance.now();
    if (this.now && (apart || time - this.noted > BURST_MS)) this.past = [...this.past, this.now].slice(-MAX_STEPS);
    this.noted = apart ? -Infinity : time;
    this.now = text;
    this.future = [];
  }

  /** @returns {Steps} */
  get steps() {
    return { past: this.past, future: this.future };
  }

  /** Go on from where another page has ended, with the same statement. @param {Steps} steps */
  resume({ past, future }) {
    this.past = past;
    this.future = future;
  }

  /** The statement before; null where there is none. */
  undo() {
    return this.step(this.past, this.future);
  }

  /** The statement that was gone back from; null where there is none. */
  redo() {
    return this.step(this.future, this.past);
  }

  /** @param {string[]} from @param {string[]} to @returns {Problem | null} */
  step(from, to) {
    const text = from.pop();
    if (text === undefined) return null;
    to.push(this.now);
    this.now = text;
    this.noted = -Infinity;
    return JSON.parse(text);
  }
}
