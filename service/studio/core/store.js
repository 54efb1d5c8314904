/** The statement that is being made, what was posted and what was answered, and the steps between which one goes. */

import { findMismatch, removeDefaults, propertiesOf, canonicalText } from "./schema.js";
import { Undo } from "./undo.js";

/** @import { Problem } from "../types/values.js" */
/** @import { Kind } from "./api.js" */
/** @import { Steps } from "./undo.js" */

/** @typedef {"form" | "canvas" | "text"} Editor */

/**
 * What listeners are told.
 * @typedef {object} Change
 * @property {boolean} stated whether the statement is another one; otherwise its answer is
 * @property {Editor | null} by where it was changed and is seen already; null where all that shows it is made anew
 * @property {boolean} edited whether somebody changed it, or went a step back or forth
 * @property {boolean} begun whether it was begun with, and not made of the one before
 */

/**
 * No statement is ever changed: each change makes another one, and those before stay as they were.
 */
export class Store {
  constructor() {
    /** What the service can be asked. @type {Kind[]} */
    this.kinds = [];
    /** Nothing is stated until the kinds are known. @type {Problem} */
    this.problem = /** @type {Problem} */ ({});
    /** Counts the statements that were not made of the one before, as what is remembered of one is not of another. */
    this.origin = 0;
    /** The statement that was posted last. @type {{id: string, problem: Problem | null}} */
    this.posted = { id: "", problem: null };
    /** The statement whose answers are shown; null while there are none. @type {Problem | null} */
    this.answered = null;
    this.past = new Undo();
    /** @type {WeakMap<Problem, string>} */
    this.spellings = new WeakMap();
    /** @type {((change: Change) => void)[]} */
    this.listeners = [];
  }

  /** @param {(change: Change) => void} listener */
  listen(listener) {
    this.listeners.push(listener);
  }

  /** @param {Partial<Change>} change */
  notify({ stated = true, by = null, edited = false, begun = false }) {
    for (const listener of this.listeners) listener({ stated, by, edited, begun });
  }

  /** The kind of the statement. */
  get kind() {
    return this.findKind(this.problem) ?? this.kinds[0];
  }

  /** @param {Problem} statement */
  findKind(statement) {
    return this.kinds.find((one) => one.kind === statement.kind);
  }

  /** Whether the statement may say what room there is. */
  get hasWorkspace() {
    return "space" in propertiesOf(this.kind.schema);
  }

  /** The examples of the kind. @returns {Problem[]} */
  get examples() {
    return this.kind.schema.examples ?? [this.kind.example];
  }

  /** The number of the example that is stated; -1 where none is. */
  get example() {
    const now = this.canonicalText(this.problem);
    return this.examples.findIndex((one) => this.canonicalText(one) === now);
  }

  /** Whether the answers that are shown are not those to the statement as it is now. */
  get stale() {
    return this.answered !== null && this.canonicalText(this.answered) !== this.canonicalText(this.problem);
  }

  /** A statement as it is compared with others. @param {Problem} statement */
  canonicalText(statement) {
    const known = this.spellings.get(statement);
    if (known !== undefined) return known;
    const text = canonicalText(statement, this.findKind(statement)?.schema);
    this.spellings.set(statement, text);
    return text;
  }

  /** A statement without what the service has written out. @param {Problem} statement @returns {Problem} */
  removeDefaults(statement) {
    return removeDefaults(statement, this.findKind(statement)?.schema);
  }

  /** Whether a statement has the form of its kind: it may be of another version of the service. @param {Problem} one */
  matchesSchema(one) {
    const schema = this.findKind(one)?.schema;
    return schema !== undefined && findMismatch(one, schema, schema) === null;
  }

  /**
   * Change the statement. Where `change` throws, it stays as it was.
   * @param {(statement: Problem) => void} change is given a copy to work on
   * @param {Editor | null} [by]
   */
  change(change, by = null) {
    const statement = structuredClone(this.problem);
    change(statement);
    this.problem = deepFreeze(statement);
    this.past.record(this.problem);
    this.notify({ by, edited: true });
  }

  /** What was led on the canvas is let go: all that shows it is made anew. */
  notifySettled() {
    this.notify({ edited: true });
  }

  /** Have what was written in place of the statement. @param {Problem} statement @param {Editor} by */
  replace(statement, by) {
    const begun = statement.kind !== this.problem.kind;
    this.adopt(statement);
    this.past.record(this.problem);
    this.notify({ by, edited: true, begun });
  }

  /**
   * Begin with another statement.
   * @param {Problem} statement
   * @param {Steps} [steps] that have led to it, on a page before
   */
  begin(statement, steps) {
    this.adopt(statement);
    this.past.record(this.problem, true);
    if (steps) this.past.resume(steps);
    this.notify({ begun: true });
  }

  undo() {
    this.step(this.past.undo());
  }

  redo() {
    this.step(this.past.redo());
  }

  /** @param {Problem | null} statement */
  step(statement) {
    if (!statement) return;
    const begun = statement.kind !== this.problem.kind;
    this.adopt(statement);
    this.notify({ edited: true, begun });
  }

  /** @param {Problem} statement */
  adopt(statement) {
    this.problem = deepFreeze(structuredClone(statement));
    this.origin += 1;
  }

  /** @param {string} id of the job @param {Problem} problem */
  recordSubmission(id, problem) {
    this.posted = { id, problem };
  }

  /** The answers of a job are shown: to what was posted, or to what its address has just brought. @param {string} id */
  recordAnswer(id) {
    this.answered = this.posted.id === id ? this.posted.problem : this.problem;
    this.notify({ stated: false });
  }

  /** No answers are shown any more. */
  forgetAnswer() {
    this.posted = { id: "", problem: null };
    this.answered = null;
    this.notify({ stated: false });
  }
}

/** @template T @param {T} value @returns {T} of which nothing can be changed any more */
function deepFreeze(value) {
  if (typeof value === "object" && value !== null) Object.values(Object.freeze(value)).forEach(deepFreeze);
  return value;
}
