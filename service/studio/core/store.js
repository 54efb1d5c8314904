/** The store: the current problem, the submitted and the answered one, and the undo steps. */

import { findMismatch, removeDefaults, propertiesOf, canonicalText } from "./schema.js";
import { Undo } from "./undo.js";

/** @import { Problem } from "../types/values.js" */
/** @import { Kind } from "./api.js" */
/** @import { Steps } from "./undo.js" */

/** @typedef {"form" | "canvas" | "text"} Editor */

/**
 * A change, as listeners receive it.
 * @typedef {object} Change
 * @property {boolean} stated whether the problem has changed; otherwise its answer has
 * @property {Editor | null} by where it was changed and is seen already; null where all that shows it is made anew
 * @property {boolean} edited whether the user changed it, by an edit, undo or redo
 * @property {boolean} begun whether it was begun with, and not made of the one before
 */

/** Problems are immutable: each change creates a new one. */
export class Store {
  constructor() {
    /** The kinds of problems of the service. @type {Kind[]} */
    this.kinds = [];
    /** The current problem; empty until the kinds are known. @type {Problem} */
    this.problem = /** @type {Problem} */ ({});
    /** Counts the problems that do not derive from the previous one; remembered state belongs to one count. */
    this.origin = 0;
    /** The last submitted problem. @type {{id: string, problem: Problem | null}} */
    this.posted = { id: "", problem: null };
    /** The problem whose answers are shown; null if there are none. @type {Problem | null} */
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

  /** Return the kind of the current problem. */
  get kind() {
    return this.findKind(this.problem) ?? this.kinds[0];
  }

  /** @param {Problem} statement */
  findKind(statement) {
    return this.kinds.find((one) => one.kind === statement.kind);
  }

  /** Whether the kind has a workspace. */
  get hasWorkspace() {
    return "space" in propertiesOf(this.kind.schema);
  }

  /** Return the examples of the kind. @returns {Problem[]} */
  get examples() {
    return this.kind.schema.examples ?? [this.kind.example];
  }

  /** Return the index of the current example, or -1. */
  get example() {
    const now = this.canonicalText(this.problem);
    return this.examples.findIndex((one) => this.canonicalText(one) === now);
  }

  /** Whether the shown answers belong to an earlier problem. */
  get stale() {
    return this.answered !== null && this.canonicalText(this.answered) !== this.canonicalText(this.problem);
  }

  /** Return the text by which problems are compared. @param {Problem} statement */
  canonicalText(statement) {
    const known = this.spellings.get(statement);
    if (known !== undefined) return known;
    const text = canonicalText(statement, this.findKind(statement)?.schema);
    this.spellings.set(statement, text);
    return text;
  }

  /** Return a problem without the defaults that the service fills in. @param {Problem} statement @returns {Problem} */
  removeDefaults(statement) {
    return removeDefaults(statement, this.findKind(statement)?.schema);
  }

  /**
   * Return true if a problem matches the schema of its kind; another version of the service may have written it.
   * @param {Problem} one
   */
  matchesSchema(one) {
    const schema = this.findKind(one)?.schema;
    return schema !== undefined && findMismatch(one, schema, schema) === null;
  }

  /**
   * Change the problem. If `change` throws, the problem stays unchanged.
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

  /** Notify all views after a drag on the canvas has ended. */
  notifySettled() {
    this.notify({ edited: true });
  }

  /** Replace the problem by an edited text. @param {Problem} statement @param {Editor} by */
  replace(statement, by) {
    const begun = statement.kind !== this.problem.kind;
    this.adopt(statement);
    this.past.record(this.problem);
    this.notify({ by, edited: true, begun });
  }

  /**
   * Start with another problem.
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

  /** Record that the answers of a job are shown. @param {string} id */
  recordAnswer(id) {
    this.answered = this.posted.id === id ? this.posted.problem : this.problem;
    this.notify({ stated: false });
  }

  /** Record that no answers are shown. */
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
