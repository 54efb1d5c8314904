/**
 * Statements that have been edited: the last one of each kind, and the steps that led to the last of all. The browser
 * keeps them.
 */

import { localStore } from "./storage.js";

/** @import { Problem } from "../types/values.js" */

const STORAGE_PREFIX = "mechsynth.draft";

/** How much of the steps is kept, characters: statements of the usual size by the dozen. */
const MAX_STEPS_LENGTH = 60_000;

/** @typedef {{problem: Problem, label: string, job: string}} Draft `job` has the answers beside which it was edited */
/** @typedef {import("./undo.js").Steps} Steps */

/** The last statement of a kind, where one was left. @param {string} kind @returns {Draft | null} */
export function readDraft(kind) {
  const draft = readStored(`${STORAGE_PREFIX}.${kind}`);
  return draft?.problem?.kind === kind
    ? { problem: draft.problem, label: String(draft.label ?? ""), job: String(draft.job ?? "") }
    : null;
}

/** The kind of the statement that was edited last; empty where there is none. */
export function readLastKind() {
  const kind = readStored(STORAGE_PREFIX)?.kind;
  return typeof kind === "string" && readDraft(kind) ? kind : "";
}

/** The steps that led to it. @returns {Steps} */
export function readLastSteps() {
  const { past, future } = readStored(STORAGE_PREFIX) ?? {};
  const texts = (/** @type {unknown} */ listed) =>
    Array.isArray(listed) ? listed.filter((one) => typeof one === "string") : [];
  return { past: texts(past), future: texts(future) };
}

/**
 * @param {Problem} problem @param {string} label @param {Steps} steps
 * @param {string} job whose answers stand beside it; empty where there are none
 */
export function keepDraft(problem, label, { past, future }, job) {
  localStore.write(`${STORAGE_PREFIX}.${problem.kind}`, JSON.stringify({ problem, label, job }));
  localStore.write(
    STORAGE_PREFIX,
    JSON.stringify({ kind: problem.kind, past: newestThatFit(past), future: newestThatFit(future) }),
  );
}

/** @param {string} kind */
export function forgetDraft(kind) {
  localStore.write(`${STORAGE_PREFIX}.${kind}`, null);
  if (readStored(STORAGE_PREFIX)?.kind === kind) localStore.write(STORAGE_PREFIX, null);
}

/** As many of the newest as are kept. @param {string[]} texts */
function newestThatFit(texts) {
  let room = MAX_STEPS_LENGTH;
  const from = texts.findLastIndex((text) => (room -= text.length) < 0);
  return texts.slice(from + 1);
}

/**
 * What is kept under a name: another version of the page may have kept it.
 * @param {string} name
 * @returns {Partial<Record<"label" | "job" | "kind" | "past" | "future", unknown> & {problem: Problem}> | null}
 */
function readStored(name) {
  try {
    return JSON.parse(localStore.read(name) ?? "null");
  } catch {
    return null;
  }
}
