/** The answer of a job: what is known, the designs as cards, and the selected design in full. */

import * as api from "../core/api.js";
import { Choosing } from "./design_chooser.js";
import { el } from "../core/dom.js";
import { Shown } from "../design/design.js";
import { foreign, grouped, readable, t, term, translated } from "../core/messages.js";
import { missed } from "./near_misses.js";
import { Strip } from "./design_strip.js";

/** @import { Problem, Result, Solved } from "../types/values.js" */

/** @type {Shown | null} */
let chosen = null;
/** @type {Strip | null} */
let strip = null;

/** Show nothing of the job before. @param {HTMLElement} place @param {import("../design/workbench.js").Desk} desk */
export function leave(place, desk) {
  chosen?.stop();
  chosen = null;
  strip = null;
  place.replaceChildren();
  desk.drawer.on("compare", null);
  for (const name of ["assembly", "compare"]) desk.drawer.offer(name, false);
  desk.clear();
}

/**
 * @param {HTMLElement} place @param {import("../design/workbench.js").Desk} desk @param {api.Job} job
 * @param {(problem: Problem) => void} state begins another statement
 * @param {(problem: Problem) => void} solve states and solves one
 */
export function answer(place, desk, job, state, solve) {
  leave(place, desk);
  if (!job.result) {
    place.append(
      el(
        "p",
        { class: job.status === "failed" ? "error" : "note" },
        job.status === "failed"
          ? `${translated(job.error?.title ?? "Failed")}: ${translated(job.error?.detail ?? "")}`
          : t`The job was ${term(job.status)}.`,
      ),
    );
    desk.stage.offer(false);
    return;
  }
  const solved = /** @type {Solved} */ (job);
  const { designs, search, summary, nearest_miss } = solved.result;
  /** @type {Choosing | null} */
  let choosing = null;
  const row = (strip = new Strip(solved, (n) => {
    chosen?.stop();
    chosen = new Shown(desk, solved, n, state, chosen?.before);
    choosing?.chosen(chosen);
  }));
  const count = el("p", { class: "warn", role: "status" });
  const choice =
    designs.length > 1
      ? new Choosing(desk.choosing, desk, solved, row, () => {
          const kept = row.kept.filter(Boolean).length;
          count.textContent =
            kept < designs.length ? t`${kept} of ${designs.length} designs meet the bounds and are shown.` : "";
        })
      : null;
  choosing = choice;
  place.append(
    el(
      "div",
      { class: "known", tabindex: 0, role: "group", "aria-label": t`What is known` },
      el("p", { class: "warn outdated" }, t`Answers to an earlier statement.`),
      count,
      ...known(search, designs.length, summary),
      el("p", { class: "note summary", lang: foreign(summary) }, readable(translated(summary))),
    ),
    row.node,
  );
  if (designs.length) row.select(0);
  desk.drawer.on("compare", choice && { opened: () => choice.opened(), closed: () => choice.closed() });
  desk.drawer.offer("compare", choice !== null);
  if (designs.length) return;
  desk.stage.offer(true, nearest_miss ? t`None found; this comes nearest` : t`None found`);
  desk.frame.say(
    ...(nearest_miss
      ? [missed(nearest_miss, job.problem, solve)]
      : [el("p", { class: "note", lang: foreign(summary) }, translated(summary))]),
  );
  desk.stage.show("watch");
}

/** Choose a design by its number. @param {number} number */
export function select(number) {
  if (strip?.kept[number - 1]) strip.select(number - 1);
}

/** Choose the design that stands so many further in the row. @param {number} by */
export function further(by) {
  const shown = strip?.row.filter((n) => strip?.kept[n]) ?? [];
  const next = shown[shown.indexOf(strip?.chosen ?? -1) + by];
  if (next !== undefined) strip?.select(next);
}

/** Pin the chosen design, or take its pin away. */
export function pin() {
  if (strip && strip.chosen >= 0) strip.pin(strip.chosen);
}

/**
 * What the search has shown, in a sentence, and what it has left out, where the summary does not tell that.
 * @param {Partial<Result["search"]> | undefined} search
 * @param {number} found
 * @param {string} summary
 */
function known(search, found, summary) {
  if (!search) return [];
  const counted = Object.entries(search.rejected ?? {})
    .filter(([, n]) => n)
    .map(([why, n]) => `${term(why)} ${grouped(n)}`);
  const sure = search.complete
    ? found
      ? t`Complete: the search has left out nothing that the problem allows; the best are shown.`
      : t`Complete: no design exists.`
    : found
      ? t`Not complete: there may be others.`
      : t`None found; that is no proof that none exists.`;
  const told = counted.length > 0 && !summary.includes("Rejected:");
  return [
    el("p", { class: "verdict" }, sure),
    told && el("p", { class: "note" }, t`Left out: ${counted.join(", ")}.`),
  ].filter((one) => one !== false);
}
