/** Tasks of a minute each, step by step: where a step stands, what it says, and when it is done. */

import { t } from "../core/messages.js";

/** @import { Problem } from "../types/values.js" */

/**
 * What a step is judged by.
 * @typedef {object} StepContext
 * @property {Problem} problem as it is stated
 * @property {Problem} before as it was when the step began
 * @property {boolean} answered whether there are answers to what is stated
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
  text: t`Solve it: every design that is shown is driven and measured first.`,
  done: ({ answered }) => answered,
};

/** @type {Guide[]} */
export const GUIDES = [
  {
    name: t`A lid on a cabinet`,
    line: t`Drag it open, fence the pivots, choose by size.`,
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
        text: t`Say where the hinges may be: with “Zone for O2” chosen, press Rectangle and drag a generous one below the lid.`,
        done: ({ problem }) => Boolean(problem.space?.fixed_pivots?.input ?? problem.space?.fixed_pivots?.output),
      },
      SOLVE_STEP,
      {
        at: "#choosing .scatter, #tab-compare, #answers",
        tab: "compare",
        stage: "watch",
        text: t`Compare shows all designs by two numbers. Choose the smallest: a click, or the arrow keys.`,
        done: (now) => (isShown("#choosing .scatter") && chosenNumber() !== now.chosen) || isShown("#miss"),
      },
    ],
  },
  {
    name: t`A foot that walks`,
    line: t`Draw a step, compare two legs, take one home.`,
    kind: "path",
    example: "Foot path",
    steps: [
      {
        at: "#freehand",
        tab: "task",
        stage: "state",
        text: t`The path of a foot: flat below, lifted above. Switch “Draw freehand” on and draw your own, back to where it began; or move its points by the arrow keys.`,
        done: ({ problem, before }) => hasChanged(problem.points, before.points),
      },
      SOLVE_STEP,
      {
        at: "#compare-with, #tab-compare",
        tab: "compare",
        stage: "watch",
        text: t`Under Compare, choose a second design: the numbers that differ are marked.`,
        done: ({ answered }) =>
          isShown("#choosing .side-by-side") || (answered && document.querySelectorAll(".card").length < 2),
      },
      {
        at: "#downloads, #tab-files",
        tab: "files",
        stage: "watch",
        text: t`Files has the drawings. Take the DXF home.`,
        done: () => document.querySelector("#downloads")?.getAttribute("data-taken") === "DXF",
      },
    ],
  },
  {
    name: t`A valve cam`,
    line: t`A lift, a least radius, and the jerk that it costs.`,
    kind: "cam",
    example: "Valve cam",
    steps: [
      {
        at: '[data-path="/problem/segments/0/lift"]',
        tab: "task",
        stage: "state",
        text: t`How far the valve opens. Give the rise another lift, in the first row, as 8 mm, and the fall below it the same.`,
        done: ({ problem, before }) =>
          hasChanged(problem.segments, before.segments) && problem.segments?.[0]?.lift === problem.segments?.[1]?.lift,
      },
      {
        at: '[data-path="/problem/limits/min_radius"], [data-path="/problem/limits"]',
        tab: "task",
        stage: "state",
        text: t`How sharply the cam may be curved, against wear. Ask for a greater radius: the cam becomes larger.`,
        done: ({ problem, before }) => hasChanged(problem.limits, before.limits),
      },
      SOLVE_STEP,
      {
        at: "#plots .plot, #tab-plots",
        tab: "plots",
        stage: "watch",
        text: t`Plots shows what the follower does. The jerk is the last of its rates: it is what shakes.`,
        done: () => isShown("#plots .plot"),
      },
    ],
  },
];
