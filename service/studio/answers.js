/** The answer of a job: what is known, the designs as cards, and the selected design in full. */

import * as api from "./api.js";
import { el, shown, words } from "./dom.js";
import { Shown } from "./design.js";
import { amount, figure, figures } from "./figures.js";
import { thumbnail } from "./thumbnail.js";

/** How long keys must rest on a card before it is shown. */
const PASSING_MS = 150;

/** @type {Shown | null} */
let chosen = null;
let passing = 0;

/** Show nothing of the job before. @param {HTMLElement} place @param {import("./desk.js").Desk} desk */
export function leave(place, desk) {
  chosen?.stop();
  chosen = null;
  place.replaceChildren();
  desk.drawer.offer("assembly", false);
  desk.clear();
}

/**
 * @param {HTMLElement} place @param {import("./desk.js").Desk} desk @param {api.Job} job
 * @param {(problem: any) => void} state begins another statement @param {(problem: any) => void} solve states and solves one
 */
export function answer(place, desk, job, state, solve) {
  leave(place, desk);
  if (!job.result) {
    place.append(el("p", { class: job.status === "failed" ? "error" : "note" },
      job.status === "failed" ? `${job.error?.title ?? "Failed"}: ${job.error?.detail ?? ""}` : `The job was ${job.status}.`));
    desk.stage.offer(false);
    return;
  }
  const { designs, search, summary, nearest_miss } = job.result;
  const cards = designs.map((/** @type {any} */ design, /** @type {number} */ n) => card(design, n, job.problem, () => {
    cards.forEach((/** @type {HTMLElement} */ one, /** @type {number} */ k) => one.setAttribute("aria-pressed", String(k === n)));
    chosen?.stop();
    chosen = new Shown(desk, job, n, state, chosen?.before);
  }));
  place.append(
    el("div", { class: "known", tabindex: 0, role: "group", "aria-label": "What is known" },
      el("p", { class: "summary" }, summary), el("p", { class: "note" }, known(search, designs.length))),
    el("div", { class: "cards", role: "group", "aria-label": "Designs, best first; arrow keys choose", onkeydown: (/** @type {KeyboardEvent} */ event) => choose(cards, event) }, ...cards));
  cards[0]?.click();
  if (designs.length) return;
  desk.stage.offer(true, nearest_miss ? "None found; this comes nearest" : "None found");
  desk.frame.say(...(nearest_miss ? [missed(nearest_miss, job.problem, solve)] : [el("p", { class: "note" }, summary)]));
  desk.stage.show("watch");
}

/**
 * Arrow keys, Home and End go from card to card and choose.
 * @param {HTMLElement[]} cards
 * @param {KeyboardEvent} event
 */
function choose(cards, event) {
  const at = cards.indexOf(/** @type {HTMLElement} */ (document.activeElement));
  const to = { ArrowRight: at + 1, ArrowDown: at + 1, ArrowLeft: at - 1, ArrowUp: at - 1, Home: 0, End: cards.length - 1 }[event.key];
  if (at < 0 || to === undefined) return;
  event.preventDefault();
  const next = cards[Math.min(cards.length - 1, Math.max(0, to))];
  next.focus();
  // A card that is only passed by is not shown.
  clearTimeout(passing);
  passing = setTimeout(() => {
    if (next === document.activeElement && next.getAttribute("aria-pressed") !== "true") next.click();
  }, PASSING_MS);
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

/**
 * What comes nearest where no design satisfies all demands, and the same problem with what is within reach.
 * @param {any} miss @param {any} problem @param {(problem: any) => void} solve
 */
function missed({ design, gaps, reachable }, problem, solve) {
  const short = (/** @type {any} */ value) => [value].flat().map((one) => shown(Number(one.toPrecision(4)))).join(" and ");
  const within = Object.entries(reachable).map(([name, value]) => `${words(name).toLowerCase()} ${short(value)}`);
  return el("section", { id: "miss" }, thumbnail(design),
    el("strong", {}, `Nearest miss: ${words(design.mechanism.type)}`),
    ...gaps.map((/** @type {any} */ gap) => el("span", { class: "bad" }, `✗ ${words(gap.check)}`,
      typeof gap.value === "number" && ` ${amount(gap.value, gap, problem)}`,
      typeof gap.limit === "number" && `, demanded ${amount(gap.limit, gap, problem)}`)),
    within.length > 0 && el("span", { class: "note" }, `Within reach beside all other demands: ${within.join("; ")}.`),
    ...Object.entries(reachable).flatMap(([name, value]) => eased(problem, name, value)).map(({ text: said, statement }) =>
      el("button", { type: "button", class: "main", onclick: () => solve(statement) }, said)));
}

/** Digits of a limit that is eased. */
const DIGITS = 4;

/**
 * The problem with a limit that is within reach; nothing where the limit is no single number.
 * @param {any} problem @param {string} name @param {any} value that is reached @returns {{text: string, statement: any}[]}
 */
function eased(problem, name, value) {
  if (typeof value !== "number" || typeof problem.constraints?.[name] !== "number") return [];
  // Rounded to the side on which it is reached.
  const step = 10 ** (Math.floor(Math.log10(Math.abs(value) || 1)) + 1 - DIGITS);
  const least = problem.constraints[name] > value;
  const limit = Number(((least ? Math.floor : Math.ceil)(value / step) * step).toPrecision(DIGITS));
  const unit = name.endsWith("angle") ? "°" : "";
  return [{ text: `Solve with ${shown(limit)}${unit}`, statement: { ...problem, constraints: { ...problem.constraints, [name]: limit } } }];
}

/** @param {any} design @param {number} n @param {any} problem @param {() => void} choose */
function card(design, n, problem, choose) {
  const passed = design.verification?.passed;
  return el("button", { type: "button", class: "card", "aria-pressed": "false", onclick: choose },
    thumbnail(design),
    el("span", { class: "told" },
      el("strong", { title: words(design.mechanism.type) }, `${n + 1}. ${words(design.mechanism.type)}`),
      el("span", { class: passed ? "good" : "bad" }, passed ? "✓ verified" : "✗ fails a check"),
      ...figures(design).slice(0, 1).map(([name, value]) => {
        const told = figure(name, value, problem, design.metrics?.size);
        return el("span", { class: "figure", title: told.title }, el("span", {}, words(name)), el("span", {}, told.text));
      })));
}
