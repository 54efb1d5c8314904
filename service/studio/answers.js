/** The answer of a job: what is known, the designs as cards, and the selected design in full. */

import * as api from "./api.js";
import { el, shown, svg, words } from "./dom.js";
import { Explorer } from "./explorer.js";
import { Mover } from "./mover.js";
import { View } from "./view.js";

const FORMS = ["svg", "dxf", "csv", "gif"];

/** What a card shows first of a design's metrics, where the design has it. */
const FIRST = ["quality", "min_transmission_angle", "rms_residual", "structural_error", "max_error", "ratio_error", "error",
  "link_ratio", "size", "total_teeth", "efficiency", "prime_radius", "max_pressure_angle"];

/** @type {Mover | null} */
let mover = null;
/** @type {Explorer | null} */
let explorer = null;
/** @type {string[]} */
let urls = [];

/** Show nothing of the job before. @param {HTMLElement} place */
export function leave(place) {
  still();
  for (const url of urls) URL.revokeObjectURL(url);
  urls = [];
  place.replaceChildren();
}

/** Nothing moves any more. */
function still() {
  mover?.stop();
  explorer?.stop();
  mover = null;
  explorer = null;
}

/** @param {HTMLElement} place @param {api.Job} job @param {(problem: any) => void} state begins another statement */
export function answer(place, job, state) {
  leave(place);
  if (!job.result) {
    place.append(el("p", { class: job.status === "failed" ? "error" : "note" },
      job.status === "failed" ? `${job.error?.title ?? "Failed"}: ${job.error?.detail ?? ""}` : `The job was ${job.status}.`));
    return;
  }
  const { designs, search, summary } = job.result;
  const detail = el("div", { id: "design" });
  const cards = designs.map((/** @type {any} */ design, /** @type {number} */ n) => card(design, n, () => {
    cards.forEach((/** @type {HTMLElement} */ one, /** @type {number} */ k) => one.setAttribute("aria-pressed", String(k === n)));
    select(detail, job, n, state);
  }));
  place.append(
    el("p", { class: "summary" }, summary),
    el("p", { class: "note" }, known(search, designs.length)),
    el("div", { class: "cards", role: "group", "aria-label": "Designs, best first" }, ...cards),
    detail);
  cards[0]?.click();
}

/** What the search has shown, in a sentence. @param {any} search @param {number} found */
function known(search, found) {
  if (!search) return "";
  const counted = Object.entries(search.rejected ?? {}).filter(([, n]) => n).map(([why, n]) => `${words(why).toLowerCase()} ${n}`);
  const sure = search.complete
    ? found ? "Complete: the search has left out nothing that the problem allows; the best are shown." : "Complete: no design exists."
    : found ? "Not complete: there may be others." : "None found; that is no proof that none exists.";
  return `${sure} ${counted.length ? `Left out: ${counted.join(", ")}.` : ""}`;
}

/** The metrics that are plain numbers or words, the telling ones first. @param {any} design @returns {[string, any][]} */
function figures(design) {
  const all = Object.entries(design.metrics ?? {}).filter(([, value]) => ["number", "string", "boolean"].includes(typeof value));
  const rank = (/** @type {string} */ name) => (FIRST.includes(name) ? FIRST.indexOf(name) : FIRST.length);
  return all.sort(([a], [b]) => rank(a) - rank(b));
}

/** @param {any} value */
function text(value) {
  return typeof value === "number" ? shown(value) : typeof value === "boolean" ? (value ? "yes" : "no") : words(String(value));
}

/** @param {any} design @param {number} n @param {() => void} choose */
function card(design, n, choose) {
  const passed = design.verification?.passed;
  return el("button", { type: "button", class: "card", "aria-pressed": "false", onclick: choose },
    thumbnail(design.mechanism.skeleton),
    el("strong", {}, `${n + 1}. ${words(design.mechanism.type)}`),
    el("span", { class: passed ? "good" : "bad" }, passed ? "✓ verified" : "✗ fails a check"),
    ...figures(design).slice(0, 4).map(([name, value]) => el("span", { class: "figure" }, el("span", {}, words(name)), el("span", {}, text(value)))));
}

/** A linkage in its first position. @param {any} skeleton */
function thumbnail(skeleton) {
  if (!skeleton?.joints) return null;
  const view = new View(Object.values(skeleton.joints), 150, 84, 12);
  return svg("svg", { viewBox: "0 0 150 84", class: "thumbnail", "aria-hidden": "true" },
    ...skeleton.links.filter((/** @type {any} */ link) => link.name !== "ground").map((/** @type {any} */ link) =>
      svg("path", { class: "link", d: `${view.path(link.joints.map((/** @type {string} */ name) => skeleton.joints[name]))}${link.joints.length > 2 ? "Z" : ""}` })),
    ...Object.values(skeleton.joints).map((/** @type {any} */ [x, y]) => {
      const [u, v] = view.at(x, y);
      return svg("circle", { class: "pin", r: 2.5, cx: u, cy: v });
    }));
}

/** @param {HTMLElement} place @param {api.Job} job @param {number} n @param {(problem: any) => void} state */
async function select(place, job, n, state) {
  still();
  const design = job.result.designs[n];
  const moving = el("div", { class: "moving" });
  const drawing = el("figure", { class: "drawing" });
  const downloads = el("p", { class: "row", id: "downloads" }, el("span", {}, "Take home"));
  place.replaceChildren(el("h3", {}, `Design ${n + 1}: ${words(design.mechanism.type)}`), moving, ...explored(design, job, state), downloads,
    el("div", { class: "columns" }, checks(design), table("Quantities", figures(design)), dimensions(design)), drawing);
  downloads.append(...FORMS.map((form) => el("button", { type: "button", class: "small", onclick: async (/** @type {any} */ event) => {
    const button = event.currentTarget;
    button.disabled = true;
    const url = await api.file(job.id, n, form).catch((error) => downloads.append(el("span", { class: "error" }, ` ${error.message}`)));
    button.disabled = false;
    if (url) save(url, `${job.kind}-${n}.${form}`);
  } }, form.toUpperCase())), el("button", { type: "button", class: "small", onclick: async () => {
    const image = drawing.querySelector("img");
    const url = image && await raster(image);
    if (url) save(url, `${job.kind}-${n}.png`);
  } }, "PNG"), el("button", { type: "button", class: "small", onclick: () => {
    const parts = [JSON.stringify({ problem: job.problem, result: job.result }, null, 1)];
    save(URL.createObjectURL(new Blob(parts, { type: "application/json" })), `${job.kind}.json`);
  } }, "JSON"));
  const current = () => place.contains(moving);
  const draw = async () => {
    const url = await api.file(job.id, n, "svg").catch((error) => {
      drawing.replaceChildren(el("figcaption", {}, error.message));
    });
    if (!url || !current()) return;
    urls.push(url);
    drawing.replaceChildren(el("img", { src: url, alt: `Drawing of design ${n + 1} with its dimensions` }));
  };
  const move = async () => {
    if (!design.mechanism.skeleton) return;
    moving.append(el("p", { class: "note" }, "The motion is being computed …"));
    const motion = await api.motion(job.id, n, 240).catch((error) => ({ error }));
    if (!current()) return;
    if (!motion.joints) {
      moving.replaceChildren(motion.error ? el("p", { class: "error" }, motion.error.message) : "");
      return;
    }
    mover = new Mover(moving, design, motion, job.problem);
  };
  await Promise.all([move(), draw()]);
}

/** The drawing in pixels, two for one of its own. @param {HTMLImageElement} image @returns {Promise<string | null>} */
async function raster(image) {
  await image.decode();
  const canvas = el("canvas", { width: 2 * image.naturalWidth, height: 2 * image.naturalHeight });
  const pen = canvas.getContext("2d");
  pen.fillStyle = "white";
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.drawImage(image, 0, 0, canvas.width, canvas.height);
  return new Promise((done) => canvas.toBlob((/** @type {Blob | null} */ blob) => done(blob && URL.createObjectURL(blob)), "image/png"));
}

/** The place where a fourbar's pins are dragged. @param {any} design @param {api.Job} job @param {(problem: any) => void} state */
function explored(design, job, state) {
  const { type, skeleton } = design.mechanism;
  if (type !== "fourbar" || !skeleton?.joints.P) return [];
  const inside = el("div");
  const details = el("details", { id: "explore", ontoggle: () => {
    explorer?.stop();
    explorer = details.open ? new Explorer(inside, design.mechanism, job.problem, (joints) => state(begun(job.problem, joints))) : null;
  } }, el("summary", {}, "Explore: drag its pins"), inside);
  return [details];
}

/** The problem with fixed pivots demanded, where its kind can. @param {any} problem @param {Record<string, [number, number]>} joints */
function begun(problem, { O2, O4 }) {
  const round = (/** @type {[number, number]} */ at) => at.map((one) => Number(one.toPrecision(6)));
  if (problem.kind === "motion") {
    const side = (/** @type {any} */ choices, /** @type {[number, number]} */ at) => ({ dyad: choices.dyad, fixed_pivot: round(at) });
    return { ...problem, input_side: side(problem.input_side, O2), output_side: side(problem.output_side, O4) };
  }
  return "fixed_pivots" in problem ? { ...problem, fixed_pivots: { input: round(O2), output: round(O4) } } : problem;
}

/** @param {string} url @param {string} name */
function save(url, name) {
  el("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}

/** @param {any} design */
function checks(design) {
  return el("section", {}, el("h4", {}, "Checks"), el("ul", { class: "checks" },
    ...(design.verification?.checks ?? []).map((/** @type {any} */ check) => el("li", { class: check.passed ? "good" : "bad" },
      el("span", {}, check.passed ? "✓ " : "✗ "), words(check.name),
      typeof check.value === "number" && el("span", { class: "note" },
        ` ${shown(check.value)}${typeof check.limit === "number" ? `, limit ${shown(check.limit)}` : ""}`),
      el("span", { class: "hidden" }, check.passed ? " passed" : " failed")))));
}

/** @param {string} title @param {[string, any][]} rows */
function table(title, rows) {
  return el("section", {}, el("h4", {}, title), el("table", { class: "figures" }, el("tbody", {},
    ...rows.map(([name, value]) => el("tr", {}, el("th", { scope: "row" }, words(name)), el("td", {}, text(value)))))));
}

/** The dimensions of a mechanism, as deep as they go; curves and skeletons are in the JSON. @param {any} design */
function dimensions(design) {
  /** @type {[string, any][]} */
  const rows = [];
  const walk = (/** @type {string} */ name, /** @type {any} */ value) => {
    if (Array.isArray(value)) {
      if (value.length <= 4 && value.every((one) => typeof one === "number")) rows.push([name, value.map(shown).join(", ")]);
      else if (value.length <= 8 && value.every((one) => typeof one === "object")) value.forEach((one, k) => walk(`${name} ${k + 1}`, one));
    } else if (value && typeof value === "object") {
      for (const [inner, one] of Object.entries(value)) walk(name ? `${name} ${inner}` : inner, one);
    } else if (value !== null) rows.push([name, value]);
  };
  for (const [name, value] of Object.entries(design.mechanism)) if (!["type", "skeleton", "profile", "pitch_curve", "program", "outer_wall"].includes(name)) walk(name, value);
  return table("Dimensions", rows);
}
