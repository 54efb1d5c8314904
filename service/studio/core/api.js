/** Call the public API of the service. The studio has no other source of data. */

import { language, t } from "./messages.js";
import { tabStore } from "./storage.js";

/** @import { Analysis, LinkageAnalysis, Mechanism, Problem, Question, Schemas } from "../types/values.js" */

/** @typedef {Schemas["FieldError"]} FieldError */
/** @typedef {Schemas["Progress"]} Progress */
/** @typedef {Schemas["JobListItem"]} JobItem */
/** @typedef {import("../types/values.js").Job} Job */
/**
 * @typedef {{kind: string, title: string, description: string, schema: import("./schema.js").Schema, example: Problem,
 *   files: Record<string, string[]>, examples: {name: string, group: string, line: string}[], measures:
 *   Record<string, string>}} Kind
 */
/**
 * @typedef {{element: string, id: string | null, name: string | null, layer: string | null, polygon: [number, number][]
 *   | null, circle: {center: [number, number], radius: number} | null, area: number, joined: number}} DrawnOutline
 */
/**
 * @typedef {{element: string, id: string | null, name: string | null, layer: string | null, reason: string}}
 *   SkippedElement
 */
/**
 * @typedef {{millimetres_per_unit: number | null, length_unit: string | null, scale: number, tolerance: number,
 *   outlines: DrawnOutline[], left_out: SkippedElement[], left_out_count: number}} Outlines
 */

/**
 * @typedef {{element: string, id: string | null, name: string | null, layer: string | null, points: {x: number, y:
 *   number}[], closed: boolean, length: number, tolerance: number, joined: number}} Curve
 */
/**
 * @typedef {{format: string, millimetres_per_unit: number | null, length_unit: string | null, scale: number, curves:
 *   Curve[], left_out: SkippedElement[], left_out_count: number}} Curves
 */

const KEY_STORAGE = "mechsynth.key";
const RECONNECT_MS = 1000;

/** Number of tries while the service is busy, and the pause between them. */
const BUSY_TRIES = 4;
const BUSY_MS = 5000;

/** An error response of the service (problem+json). */
export class Refusal extends Error {
  /** @param {Partial<Schemas["ProblemDetails"]>} problem @param {number} status */
  constructor(problem, status) {
    super(problem.detail ?? t`The service answered with status ${status}.`);
    this.status = status;
    this.title = problem.title ?? t`Error`;
    /** @type {FieldError[]} */
    this.errors = problem.errors ?? [];
  }
}

/** Return the API key; it is stored for this tab only. */
export function readKey() {
  return tabStore.read(KEY_STORAGE) ?? "";
}

/** @param {string} value */
export function writeKey(value) {
  tabStore.write(KEY_STORAGE, value || null);
}

/**
 * @param {string} path
 * @param {RequestInit} [options]
 */
async function ask(path, options = {}) {
  const headers = new Headers(options.headers);
  if (readKey()) headers.set("Authorization", `Bearer ${readKey()}`);
  // The language of the page may have been chosen in it, and then differs from that of the browser.
  headers.set("Accept-Language", language);
  const answer = await fetch(path, { ...options, headers });
  if (!answer.ok) throw new Refusal(await answer.json().catch(() => ({})), answer.status);
  return answer;
}

/**
 * Repeat a request while the service is busy (503).
 * @template T @param {() => Promise<T>} asked @param {AbortSignal} [signal] @returns {Promise<T>}
 */
async function retryWhileBusy(asked, signal) {
  for (let left = BUSY_TRIES; ; left--) {
    try {
      return await asked();
    } catch (error) {
      if (!(error instanceof Refusal) || error.status !== 503 || left <= 1 || signal?.aborted) throw error;
      await new Promise((done) => setTimeout(done, BUSY_MS));
    }
  }
}

/** @param {string} path @param {unknown} body @param {AbortSignal} [signal] */
function post(path, body, signal) {
  const headers = { "Content-Type": "application/json" };
  return ask(path, { method: "POST", headers, body: JSON.stringify(body), signal });
}

/** @type {Kind[]} */
let knownKinds = [];

let servesSolids = false;

/** @type {string[]} */
let mechanismsWithParts = [];

/** @returns {Promise<Kind[]>} */
export async function fetchKinds() {
  const answer = await (await ask("/v1/problems")).json();
  knownKinds = answer.problems;
  servesSolids = answer.solids;
  mechanismsWithParts = answer.parts;
  return knownKinds;
}

/** Return the dimensions of the metrics of a kind, by name. @param {string} kind */
export function metricDimensions(kind) {
  return knownKinds.find((one) => one.kind === kind)?.measures ?? {};
}

/** Return true if the service makes solids, not only outlines. */
export function makesSolids() {
  return servesSolids;
}

/** Return true if parts exist for a type of mechanism. @param {Mechanism} mechanism */
export function hasParts(mechanism) {
  return Boolean(mechanism.skeleton) || mechanismsWithParts.includes(mechanism.type);
}

/**
 * Download the parts of a design as a zip; return an object URL, which the caller revokes.
 * @param {string} id @param {number} design @param {Record<string, string>} sizes what they are made of
 */
export async function downloadParts(id, design, sizes) {
  const path = `/v1/jobs/${encodeURIComponent(id)}/designs/${design}/parts?${new URLSearchParams(sizes)}`;
  return URL.createObjectURL(await (await retryWhileBusy(() => ask(path))).blob());
}

/**
 * Download a file of one part of a design; return an object URL, which the caller revokes.
 * @param {string} id
 * @param {number} design
 * @param {string} item
 * @param {string} form
 * @param {Record<string, string>} sizes
 */
export async function downloadPart(id, design, item, form, sizes) {
  const parts = `/v1/jobs/${encodeURIComponent(id)}/designs/${design}/parts`;
  const path = `${parts}/${encodeURIComponent(item)}.${form}?${new URLSearchParams(sizes)}`;
  return URL.createObjectURL(await (await retryWhileBusy(() => ask(path))).blob());
}

/**
 * Fetch the parts of a design and their motion.
 * @param {string} id
 * @param {number} design
 * @param {Record<string, string>} query sizes and positions
 * @param {AbortSignal} signal
 * @returns {Promise<import("../assembly/assembly_view.js").Assembly>}
 */
export async function fetchAssembly(id, design, query, signal) {
  const path = `/v1/jobs/${encodeURIComponent(id)}/designs/${design}/assembly?${new URLSearchParams(query)}`;
  return (await retryWhileBusy(() => ask(path, { signal }), signal)).json();
}

/**
 * Return the file formats of a type of mechanism.
 * @param {string} kind
 * @param {string} mechanism
 * @returns {string[]}
 */
export function fileFormats(kind, mechanism) {
  return knownKinds.find((one) => one.kind === kind)?.files[mechanism] ?? [];
}

/**
 * Fetch the address at which PMKS+ opens a linkage.
 * @param {string} id
 * @param {number} design
 * @returns {Promise<string>}
 */
export async function fetchPmksAddress(id, design) {
  return (await (await ask(`/v1/jobs/${encodeURIComponent(id)}/designs/${design}/pmks`)).json()).url;
}

/** Return the address of the report of a job, with assemblies. @param {string} id */
export function reportAddress(id) {
  return `/v1/jobs/${encodeURIComponent(id)}/report.html?assemblies=true`;
}

/** Download the report of a job; return an object URL, which the caller revokes. @param {string} id */
export async function downloadReport(id) {
  return URL.createObjectURL(await (await retryWhileBusy(() => ask(reportAddress(id)))).blob());
}

/** @param {Problem} problem @param {string | null} label @returns {Promise<Job>} */
export async function submitJob(problem, label) {
  return (await post("/v1/jobs", { problem, label })).json();
}

/**
 * Solve a small problem and wait for its answer.
 * @param {Problem} problem
 * @param {string} label
 * @param {AbortSignal} signal
 * @returns {Promise<Job>}
 */
export async function solveNow(problem, label, signal) {
  const headers = { "Content-Type": "application/json", Prefer: "wait=20" };
  return (await ask("/v1/jobs", { method: "POST", headers, body: JSON.stringify({ problem, label }), signal })).json();
}

/** @param {string} id @returns {Promise<Job>} */
export async function fetchJob(id) {
  return (await ask(`/v1/jobs/${encodeURIComponent(id)}`)).json();
}

/**
 * @param {string} kind
 * @param {string | null} cursor
 * @returns {Promise<{jobs: JobItem[], next_cursor: string | null}>}
 */
export async function listJobs(kind, cursor) {
  const query = new URLSearchParams({ limit: "20" });
  if (kind) query.set("kind", kind);
  if (cursor) query.set("cursor", cursor);
  return (await ask(`/v1/jobs?${query}`)).json();
}

/** Cancel an unfinished job, or remove a finished one. @param {string} id */
export async function removeJob(id) {
  await ask(`/v1/jobs/${encodeURIComponent(id)}`, { method: "DELETE" });
}

/**
 * @param {string} id @param {number} design @param {number} steps @param {AbortSignal} [signal]
 * @returns {Promise<Analysis>}
 */
export async function fetchMotion(id, design, steps, signal) {
  const path = `/v1/jobs/${encodeURIComponent(id)}/designs/${design}/motion?steps=${steps}`;
  return (await retryWhileBusy(() => ask(path, { signal }), signal)).json();
}

/**
 * Fetch the motion of a design with forces, for the `dynamics` of its problem or for the given block.
 * @param {string} id
 * @param {number} design
 * @param {number} steps
 * @param {Schemas["DesignForcesBlock"] | null} block null for the problem's own
 * @param {AbortSignal} signal
 * @returns {Promise<LinkageAnalysis>}
 */
export async function fetchForces(id, design, steps, block, signal) {
  const path = `/v1/jobs/${encodeURIComponent(id)}/designs/${design}/forces?steps=${steps}`;
  const asked = () => (block === null ? ask(path, { signal }) : post(path, { dynamics: block }, signal));
  return (await retryWhileBusy(asked, signal)).json();
}

/**
 * @template {Analysis} [Answer=LinkageAnalysis] type of the answer; by default that of a linkage
 * @param {Question} question @param {AbortSignal} signal @returns {Promise<Answer>}
 */
export async function analyse(question, signal) {
  return (await retryWhileBusy(() => post("/v1/analyses", question, signal), signal)).json();
}

/**
 * Read the closed outlines of a drawing.
 * @param {Blob} drawing
 * @param {string} unit of the answer, where the drawing states its own
 * @returns {Promise<Outlines>}
 */
export async function importOutlines(drawing, unit) {
  const headers = { "Content-Type": "application/octet-stream" };
  const asked = () =>
    ask(`/v1/outlines?${new URLSearchParams({ length_unit: unit })}`, { method: "POST", headers, body: drawing });
  return (await retryWhileBusy(asked)).json();
}

/**
 * Read the curves of a drawing, a table or a picture.
 * @param {File} file
 * @param {string} unit of the answer, where the file states its own
 * @param {number} most points of a curve
 * @returns {Promise<Curves>}
 */
export async function importCurves(file, unit, most) {
  // Some systems know no type for a table.
  const headers = { "Content-Type": "application/octet-stream" };
  const query = new URLSearchParams({ length_unit: unit, max_points: String(most) });
  return (await retryWhileBusy(() => ask(`/v1/imports?${query}`, { method: "POST", headers, body: file }))).json();
}

/**
 * Download a file of a design; return an object URL, which the caller revokes.
 * @param {string} id @param {number} design @param {string} form @param {AbortSignal} [signal]
 */
export async function downloadFile(id, design, form, signal) {
  const answer = await ask(`/v1/jobs/${encodeURIComponent(id)}/designs/${design}.${form}`, { signal });
  return URL.createObjectURL(await answer.blob());
}

/**
 * Follow a job to its end by its server-sent events. The stream is read from a response, because `EventSource` cannot
 * send a key; a broken stream is resumed after the last event.
 *
 * @param {string} id
 * @param {(event: string, data: Job & Partial<Progress>) => void} tell
 * @param {AbortSignal} signal
 */
export async function followJob(id, tell, signal) {
  let last = "";
  let ended = false;
  while (!ended && !signal.aborted) {
    try {
      const headers = last ? { "Last-Event-ID": last } : undefined;
      const answer = await ask(`/v1/jobs/${encodeURIComponent(id)}/events`, { headers, signal });
      if (answer.status === 204 || !answer.body) return;
      const reader = answer.body.pipeThrough(new TextDecoderStream()).getReader();
      for (let text = "", part; !(part = await reader.read()).done;) {
        text += part.value;
        const blocks = text.split("\n\n");
        text = blocks.pop() ?? "";
        for (const block of blocks) {
          const event = parseEvent(block);
          if (!event) continue;
          last = event.id || last;
          ended ||= event.name === "removed" || ["succeeded", "failed", "cancelled"].includes(event.data.status);
          tell(event.name, event.data);
        }
      }
    } catch (error) {
      if (signal.aborted) return;
      if (error instanceof Refusal && error.status !== 503) throw error;
    }
    if (!ended) await new Promise((done) => setTimeout(done, RECONNECT_MS));
  }
}

/** @param {string} block */
function parseEvent(block) {
  const event = { name: "message", id: "", text: "" };
  for (const line of block.split("\n")) {
    const [, field, value] = /^(\w+): ?(.*)$/.exec(line) ?? [];
    if (field === "event") event.name = value;
    else if (field === "id") event.id = value;
    else if (field === "data") event.text += value;
  }
  return event.text ? { name: event.name, id: event.id, data: JSON.parse(event.text) } : null;
}
