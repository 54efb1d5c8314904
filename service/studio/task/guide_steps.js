/** The guided tasks: position, text and end condition of each step. */

import { t } from "../core/messages.js";

/** @import { Problem } from "../types/values.js" */

/**
 * What a step is judged by.
 * @typedef {object} StepContext
 * @property {Problem} problem in its present state
 * @property {Problem} before as it was when the step began
 * @property {boolean} answered whether the present problem has answers
 * @property {string} chosen the number of the design that was chosen when the step began
 */

/**
 * @typedef {object} Step
 * @property {string} at a selector; the first that is shown counts
 * @property {string} text
 * @property {"task" | "answers" | "compare" | "plots" | "files"} tab what a phone shows, and a drawer that lies over
 *   the stage
 * @property {"state" | "watch"} [stage]
 * @property {(now: StepContext) => boolean} done
 */

/** @typedef {{name: string, line: string, kind: string, example: string, steps: Step[]}} Guide */

const isShown = (/** @type {string} */ selector) =>
  [...document.querySelectorAll(selector)].some((one) => one.getClientRects().length > 0);
const hasChanged = (/** @type {unknown} */ one, /** @type {unknown} */ other) =>
  JSON.stringify(one) !== JSON.stringify(other);
const chosenNumber = () => document.querySelector('.card[aria-pressed="true"]')?.getAttribute("data-design") ?? "";

/** @type {Step} */
const SOLVE_STEP = {
  at: "#solve, #progress",
  tab: "task",
  text: t`Solve it. Every design shown has been simulated and verified.`,
  done: ({ answered }) => answered,
};

/** @type {Guide[]} */
export const GUIDES = [
  {
    name: t`A lid on a cabinet`,
    line: t`Open it, limit the pivots, choose by size.`,
    kind: "motion",
    example: "Hatch lid",
    steps: [
      {
        at: '#sketch [data-grip="position2"], #sketch .target',
        tab: "task",
        stage: "state",
        text: t`Position 3 is the open lid. Drag it farther, or move it with the arrow keys; its end turns it.`,
        done: ({ problem, before }) => hasChanged(problem.positions, before.positions),
      },
      {
        at: "#room-tools",
        tab: "task",
        stage: "state",
        text: t`Limit the hinges: with “Zone for O2” chosen, press Rectangle and drag a generous one below the lid.`,
        done: ({ problem }) => Boolean(problem.space?.fixed_pivots?.input ?? problem.space?.fixed_pivots?.output),
      },
      SOLVE_STEP,
      {
        at: "#choosing .scatter, #tab-compare, #answers",
        tab: "compare",
        stage: "watch",
        text: t`Compare plots all designs by two quantities. Choose the smallest by a click or the arrow keys.`,
        done: (now) => (isShown("#choosing .scatter") && chosenNumber() !== now.chosen) || isShown("#miss"),
      },
    ],
  },
  {
    name: t`A foot that walks`,
    line: t`Draw a step, compare two legs, download one.`,
    kind: "path",
    example: "Foot path",
    steps: [
      {
        at: "#freehand",
        tab: "task",
        stage: "state",
        text: t`The path of a foot: flat below, lifted above. Switch on “Draw freehand” and draw your own closed path, or move its points with the arrow keys.`,
        done: ({ problem, before }) => hasChanged(problem.points, before.points),
      },
      SOLVE_STEP,
      {
        at: "#compare-with, #tab-compare",
        tab: "compare",
        stage: "watch",
        text: t`Under Compare, choose a second design; different numbers are marked.`,
        done: ({ answered }) =>
          isShown("#choosing .side-by-side") || (answered && document.querySelectorAll(".card").length < 2),
      },
      {
        at: "#downloads, #tab-files",
        tab: "files",
        stage: "watch",
        text: t`Files lists the drawings. Download the DXF.`,
        done: () => document.querySelector("#downloads")?.getAttribute("data-taken") === "DXF",
      },
    ],
  },
  {
    name: t`A valve cam`,
    line: t`A lift, a minimum radius, and the resulting jerk.`,
    kind: "cam",
    example: "Valve cam",
    steps: [
      {
        at: '[data-path="/problem/segments/0/lift"]',
        tab: "task",
        stage: "state",
        text: t`This is the valve lift. Change the lift of the rise in the first row, for example to 8 mm, and that of the fall below it to the same value.`,
        done: ({ problem, before }) =>
          hasChanged(problem.segments, before.segments) && problem.segments?.[0]?.lift === problem.segments?.[1]?.lift,
      },
      {
        at: '[data-path="/problem/limits/min_radius"], [data-path="/problem/limits"]',
        tab: "task",
        stage: "state",
        text: t`This is the minimum radius of curvature, a limit against wear. Enter a larger radius; the cam becomes larger.`,
        done: ({ problem, before }) => hasChanged(problem.limits, before.limits),
      },
      SOLVE_STEP,
      {
        at: "#plots .plot, #tab-plots",
        tab: "plots",
        stage: "watch",
        text: t`Plots shows the motion of the follower. The jerk is the last curve; it causes vibration.`,
        done: () => isShown("#plots .plot"),
      },
    ],
  },
];
