/** Store drafts in the browser: the last problem of each kind, and the undo steps of the most recent one. */

import { localStore } from "./storage.js";

/** @import { Problem } from "../types/values.js" */

const STORAGE_PREFIX = "mechsynth.draft";

/** Maximum size of the stored steps, characters: a few dozen problems of usual size. */
const MAX_STEPS_LENGTH = 60_000;

/** @typedef {{problem: Problem, label: string, job: string}} Draft `job` has the answers beside which it was edited */
/** @typedef {import("./undo.js").Steps} Steps */

/** Return the draft of a kind, if there is one. @param {string} kind @returns {Draft | null} */
export function readDraft(kind) {
  const draft = readStored(`${STORAGE_PREFIX}.${kind}`);
  return draft?.problem?.kind === kind
    ? { problem: draft.problem, label: String(draft.label ?? ""), job: String(draft.job ?? "") }
    : null;
}

/** Return the kind of the most recent draft, or an empty string. */
export function readLastKind() {
  const kind = readStored(STORAGE_PREFIX)?.kind;
  return typeof kind === "string" && readDraft(kind) ? kind : "";
}

/** Return the undo steps of the most recent draft. @returns {Steps} */
export function readLastSteps() {
  const { past, future } = readStored(STORAGE_PREFIX) ?? {};
  const texts = (/** @type {unknown} */ listed) =>
    Array.isArray(listed) ? listed.filter((one) => typeof one === "string") : [];
  return { past: texts(past), future: texts(future) };
}

/**
 * @param {Problem} problem @param {string} label @param {Steps} steps
 * @param {string} job the job of its answers; empty without answers
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

/** Return the newest steps that fit. @param {string[]} texts */
function newestThatFit(texts) {
  let room = MAX_STEPS_LENGTH;
  const from = texts.findLastIndex((text) => (room -= text.length) < 0);
  return texts.slice(from + 1);
}

/**
 * Read a stored value; another version of the page may have written it.
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
