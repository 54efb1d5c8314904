/** Undo and redo the edits of the problem. */

/** @import { Problem } from "../types/values.js" */

/** Edits within this time form one step, such as typing a number or dragging a point. */
const BURST_MS = 700;

/** Maximum number of steps. */
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
   * Record the current problem as a step.
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

  /** Restore the steps of an earlier page with the same problem. @param {Steps} steps */
  resume({ past, future }) {
    this.past = past;
    this.future = future;
  }

  /** Return the previous problem, or null. */
  undo() {
    return this.step(this.past, this.future);
  }

  /** Return the problem that was undone last, or null. */
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
