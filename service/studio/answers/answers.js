/** Show the answer of a job: the search summary, the designs as cards, and the selected design in full. */

import * as api from "../core/api.js";
import { DesignChooser } from "./design_chooser.js";
import { createElement } from "../core/dom.js";
import { DesignView } from "../design/design.js";
import { groupDigits, formatText, t, term } from "../core/messages.js";
import { describeNearMiss } from "./near_misses.js";
import { DesignStrip } from "./design_strip.js";

/** @import { Problem, Result, Solved } from "../types/values.js" */

/** @type {DesignView | null} */
let chooser = null;
/** @type {DesignStrip | null} */
let strip = null;

/**
 * Clear the answer of the previous job.
 * @param {HTMLElement} place
 * @param {import("../design/workbench.js").Workbench} desk
 */
export function clearAnswers(place, desk) {
  chooser?.stop();
  chooser = null;
  strip = null;
  place.replaceChildren();
  desk.drawer.setReaction("compare", null);
  for (const name of ["assembly", "compare"]) desk.drawer.setAvailable(name, false);
  desk.clear();
}

/**
 * @param {HTMLElement} place @param {import("../design/workbench.js").Workbench} desk @param {api.Job} job
 * @param {(problem: Problem) => void} state begins another statement
 * @param {(problem: Problem) => void} solve states and solves one
 */
export function showAnswer(place, desk, job, state, solve) {
  clearAnswers(place, desk);
  if (!job.result) {
    place.append(
      createElement(
        "p",
        { class: job.status === "failed" ? "error" : "note" },
        job.status === "failed"
          ? `${job.error?.title ?? t`Failed`}: ${job.error?.detail ?? ""}`
          : t`The job was ${term(job.status)}.`,
      ),
    );
    desk.stage.offerMotion(false);
    return;
  }
  const solved = /** @type {Solved} */ (job);
  const { designs, search, summary, nearest_miss } = solved.result;
  /** @type {DesignChooser | null} */
  let choosing = null;
  const row = (strip = new DesignStrip(solved, (n) => {
    chooser?.stop();
    chooser = new DesignView(desk, solved, n, state, chooser?.before);
    choosing?.showChosen(chooser);
  }));
  const count = createElement("p", { class: "warn", role: "status" });
  const choice =
    designs.length > 1
      ? new DesignChooser(desk.choosing, desk, solved, row, () => {
          const kept = row.kept.filter(Boolean).length;
          count.textContent =
            kept < designs.length ? t`${kept} of ${designs.length} designs meet the bounds and are shown.` : "";
        })
      : null;
  choosing = choice;
  place.append(
    createElement(
      "div",
      { class: "known", tabindex: 0, role: "group", "aria-label": t`Search summary` },
      createElement("p", { class: "warn outdated" }, t`Answers to an earlier problem.`),
      count,
      ...describeSearch(search, designs.length, summary),
      createElement("p", { class: "note summary" }, formatText(summary)),
    ),
    row.node,
  );
  if (designs.length) row.select(0);
  desk.drawer.setReaction(
    "compare",
    choice && { opened: () => choice.handleOpen(), closed: () => choice.handleClose() },
  );
  desk.drawer.setAvailable("compare", choice !== null);
  if (designs.length) return;
  desk.stage.offerMotion(true, nearest_miss ? t`No design found; the nearest miss` : t`No design found`);
  desk.frame.showMessage(
    ...(nearest_miss
      ? [describeNearMiss(nearest_miss, job.problem, solve)]
      : [createElement("p", { class: "note" }, summary)]),
  );
  desk.stage.showMode("watch");
}

/** Select a design by its number. @param {number} number */
export function selectDesign(number) {
  if (strip?.kept[number - 1]) strip.select(number - 1);
}

/** Select the design this many cards further. @param {number} by */
export function moveSelection(by) {
  const shown = strip?.row.filter((n) => strip?.kept[n]) ?? [];
  const next = shown[shown.indexOf(strip?.chosen ?? -1) + by];
  if (next !== undefined) strip?.select(next);
}

/** Pin or unpin the selected design. */
export function togglePin() {
  if (strip && strip.chosen >= 0) strip.pin(strip.chosen);
}

/**
 * Describe the completeness of the search and the reasons for rejections, unless the summary contains them.
 * @param {Partial<Result["search"]> | undefined} search
 * @param {number} found
 * @param {string} summary
 */
function describeSearch(search, found, summary) {
  if (!search) return [];
  const counted = Object.entries(search.rejected ?? {})
    .filter(([, n]) => n)
    .map(([why, n]) => `${term(why)} ${groupDigits(n)}`);
  const sure = search.complete
    ? found
      ? t`Complete: the search covered everything that the problem allows; the best designs are shown.`
      : t`Complete: no design exists.`
    : found
      ? t`Not complete: there may be other designs.`
      : t`No design found; this does not prove that none exists.`;
  const told = counted.length > 0 && !summary.includes("Rejected:");
  return [
    createElement("p", { class: "verdict" }, sure),
    told && createElement("p", { class: "note" }, t`Rejected: ${counted.join(", ")}.`),
  ].filter((one) => one !== false);
}
