/** The state that the controls of a form share: the displayed problem and its changes. */

import { readPointer, pointerNames, writePointer } from "../core/pointer.js";

/** @import { Json, Problem } from "../types/values.js" */
/** @import { Schema } from "../core/schema.js" */
/** @import { Store } from "../core/store.js" */

/** The path of the statement itself, which all pointers begin with, as in what the service says of faults. */
export const STATEMENT_POINTER = "/problem";

export class FormState {
  /**
   * @param {Store} store
   * @param {{path: string, value: Json}[]} [looked] values shown for fields without an entry; they become part
   *   of the problem with the first change below them
   */
  constructor(store, looked = []) {
    this.store = store;
    this.looked = looked;
  }

  /** The schema of the statement. @returns {Schema} */
  get root() {
    return this.store.kind.schema;
  }

  /** The statement as it is shown. @returns {Problem} */
  get problem() {
    const { problem } = this.store;
    return this.looked.some(({ path }) => isMissing(problem, path))
      ? this.fillPreviews(structuredClone(problem))
      : problem;
  }

  /** @param {Problem} statement changed in place */
  fillPreviews(statement) {
    for (const { path, value } of this.looked)
      if (isMissing(statement, path)) writePointer(statement, statementPointer(path), structuredClone(value));
    return statement;
  }

  /** What stands at a pointer. @param {string} path */
  readValue(path) {
    return readPointer(this.problem, statementPointer(path));
  }

  /**
   * State a value, or leave it out.
   * @param {string} path
   * @param {Json | undefined} value
   * @param {boolean} [remade] whether the form has other controls then
   */
  writeValue(path, value, remade = false) {
    // Removing a field must not write the values that are only shown.
    if (value === undefined)
      this.store.change((statement) => writePointer(statement, statementPointer(path), value), editorFor(remade));
    else this.change((statement) => writePointer(statement, statementPointer(path), value), remade);
  }

  /** @param {(statement: Problem) => void} change @param {boolean} [remade] */
  change(change, remade = false) {
    this.store.change((statement) => change(this.fillPreviews(statement)), editorFor(remade));
  }

  /** Return a form state that shows a value where none is given. @param {string} path @param {Json} value */
  preview(path, value) {
    return new FormState(this.store, [...this.looked, { path, value }]);
  }
}

/** @param {boolean} remade */
function editorFor(remade) {
  return remade ? null : "form";
}

/** The place of a pointer in the statement. @param {string} path */
export function statementPointer(path) {
  return pointerNames(path).slice(1);
}

/** @param {Problem} statement @param {string} path */
function isMissing(statement, path) {
  return (readPointer(statement, statementPointer(path)) ?? null) === null;
}
