/** Report the nearest miss when no design is feasible, and offer the problem with reachable limits. */

import { createElement, formatNumber, toWords } from "../core/dom.js";
import { formatAmount, joinUnit, metricUnit } from "../design/design_metrics.js";
import { t, term } from "../core/messages.js";
import { readPointer, writePointer } from "../core/pointer.js";
import { createThumbnail } from "../motion/thumbnail.js";

/** @import { Json, Problem, Result, Schemas } from "../types/values.js" */

/** @typedef {Schemas["Gap"]} Gap */
/**
 * How to relax a constraint.
 * @typedef {object} Easing
 * @property {string} text after "Solve "
 * @property {(problem: Problem) => void} apply changes a statement
 */
/** @typedef {{text: string, statement: Problem}} Offer */

/** Separator between the last two items of a list. */
const LAST_SEPARATOR = ` ${t`and`} `;

/** Digits of a relaxed limit. */
const LIMIT_DIGITS = 4;

/** Path of the limit of a check in the problem, where its name differs. @type {Record<string, string[]>} */
const LIMIT_PATHS = {
  transmission_angle: ["constraints", "min_transmission_angle"],
  link_ratio: ["constraints", "max_link_ratio"],
  shortest_link: ["constraints", "link_length", "min"],
  longest_link: ["constraints", "link_length", "max"],
  planes: ["layout", "max_planes"],
  ratio_error: ["tolerance"],
  ratio: ["tolerance"],
  speeds: ["tolerance"],
  ratios: ["tolerance"],
  obstacles: ["space", "clearance"],
  contact_force: ["dynamics", "least_force"],
  min_dwell_share: ["limits", "dwell_share", "min"],
  max_dwell_share: ["limits", "dwell_share", "max"],
};

/**
 * Constraints without a number to relax; they are removed instead.
 * @type {Record<string, {text: string, path: string[], value: Json}>}
 */
const REMOVABLE_DEMANDS = {
  grashof: { text: t`with any class of linkage`, path: ["constraints", "grashof"], value: "any" },
  full_rotation: { text: t`without a full turn of the input`, path: ["constraints", "full_rotation"], value: false },
  box: { text: t`without the box`, path: ["space", "box"], value: null },
  obstacles: { text: t`without the obstacles`, path: ["space", "obstacles"], value: [] },
  fixed_pivot_zones: { text: t`without the zones of fixed pivots`, path: ["space", "fixed_pivots"], value: null },
  moving_pivot_zones: { text: t`without the zones of moving pivots`, path: ["space", "moving_pivots"], value: null },
};

/** Rectangles that are widened by the distance of the pivots from them. @type {Record<string, string[]>} */
const REGION_PATHS = {
  fixed_pivot_region: ["constraints", "fixed_pivot_region"],
  moving_pivot_region: ["constraints", "moving_pivot_region"],
  driver_pivot_region: ["driver_dyad", "pivot_region"],
};

/**
 * The check that each reachable value belongs to, by the name of the value in the answer.
 * @type {Record<string, string>}
 */
const REACHABLE_CHECKS = {
  min_transmission_angle: "transmission_angle",
  max_link_ratio: "link_ratio",
  tolerance: "ratio_error",
};

/**
 * @param {NonNullable<Result["nearest_miss"]>} miss
 * @param {Problem} problem
 * @param {(problem: Problem) => void} solve
 */
export function describeNearMiss(miss, problem, solve) {
  const { design, gaps, reachable } = miss;
  const short = (/** @type {number | number[] | null} */ value) =>
    [value]
      .flat()
      .map((one) => formatNumber(Number(Number(one).toPrecision(4))))
      .join(LAST_SEPARATOR);
  const within = Object.entries(reachable).map(
    ([name, value]) => `${term(name)} ${joinUnit(short(value), reachedUnit(name, problem))}`,
  );
  return createElement(
    "section",
    { id: "miss" },
    createThumbnail(design),
    createElement("strong", {}, t`Nearest miss: ${toWords(design.mechanism.type)}`),
    ...gaps.map((/** @type {Gap} */ gap) =>
      createElement(
        "span",
        { class: "bad" },
        `✗ ${toWords(gap.check)}`,
        typeof gap.value === "number" && ` ${describeValue(gap, gap.value, problem)}`,
        typeof gap.limit === "number" && `, ${t`required ${formatAmount(gap.limit, gap, problem)}`}`,
      ),
    ),
    within.length > 0 &&
      createElement("span", { class: "note" }, t`Reachable with all other constraints: ${within.join("; ")}.`),
    ...listOffers(problem, miss).map(({ text, statement }, k) =>
      createElement("button", { type: "button", class: k ? "small" : "main", onclick: () => solve(statement) }, text),
    ),
  );
}

/**
 * Describe the value of a failed check: a negative distance from obstacles is the depth of a part in one of them.
 * @param {Gap} gap @param {number} value @param {Problem} problem
 */
function describeValue(gap, value, problem) {
  const inside = gap.check === "obstacles" && value < 0;
  return inside ? t`overlap by ${formatAmount(-value, gap, problem)}` : formatAmount(value, gap, problem);
}

/**
 * List the problem with the limits of the nearest miss, and with each constraint relaxed to its reachable value;
 * duplicates are dropped.
 * @param {Problem} problem @param {NonNullable<Result["nearest_miss"]>} miss @returns {Offer[]}
 */
export function listOffers(problem, { gaps, reachable }) {
  const whole = gaps.map((/** @type {Gap} */ gap) => easeDemand(problem, gap));
  const single = Object.entries(reachable).map(([name, value]) => demandReachable(problem, name, value));
  const sets = [...(single.length && gaps.length < 2 ? [] : [whole]), ...single.map((one) => [one]), whole];
  const found = sets
    .filter((/** @type {(Easing | null)[]} */ set) => set.length && set.every((one) => one))
    .map((all) => {
      const set = all.filter((one) => one !== null);
      const statement = structuredClone(problem);
      for (const { apply } of set) apply(statement);
      return { text: t`Solve ${set.map((one) => one.text).join(LAST_SEPARATOR)}`, statement };
    });
  return found.filter(
    (one, k) => found.findIndex((other) => JSON.stringify(other.statement) === JSON.stringify(one.statement)) === k,
  );
}

/**
 * Relax a constraint by the amount that the nearest miss violates it.
 * @param {Problem} problem
 * @param {Gap} gap
 * @returns {Easing | null} null if the problem has no such field
 */
function easeDemand(problem, gap) {
  const { check, value, limit } = gap;
  const region = REGION_PATHS[check];
  if (region && typeof value === "number" && readPointer(problem, region)) {
    const by = roundOutwards(value, true);
    return {
      text: t`with ${term(check)} wider by ${formatAmount(by, gap, problem)}`,
      apply: (statement) => {
        for (const way of ["x", "y"]) {
          const sides = readPointer(statement, [...region, way]);
          if (Array.isArray(sides))
            writePointer(statement, [...region, way], [Number(sides[0]) - by, Number(sides[1]) + by]);
        }
      },
    };
  }
  // A link inside an obstacle has no clearance to require.
  if (typeof value === "number" && typeof limit === "number" && !(check === "obstacles" && value <= 0)) {
    const path = LIMIT_PATHS[check] ?? findLimitPath(problem, check, limit);
    if (path && readPointer(problem, path) === limit)
      return changeLimit(
        path,
        check,
        value,
        value > limit,
        formatAmount(roundOutwards(value, value > limit), gap, problem),
      );
  }
  const out = REMOVABLE_DEMANDS[check];
  return out && readPointer(problem, out.path.slice(0, -1))
    ? { text: out.text, apply: (statement) => writePointer(statement, out.path, out.value) }
    : null;
}

/**
 * Relax a constraint to its reachable value.
 * @param {Problem} problem
 * @param {string} name
 * @param {number | number[] | null} value
 * @returns {Easing | null}
 */
function demandReachable(problem, name, value) {
  const check = REACHABLE_CHECKS[name];
  const path = check ? LIMIT_PATHS[check] : [name];
  if (name === "dwell_angles" && Array.isArray(problem.dwells) && Array.isArray(value)) {
    const angles = value.map((one) => roundOutwards(one, false));
    return {
      text: t`with dwells of ${angles.map((one) => `${formatNumber(one)}°`).join(LAST_SEPARATOR)}`,
      apply: (statement) => statement.dwells?.forEach((dwell, k) => (dwell.angle = angles[k])),
    };
  }
  const limit = readPointer(problem, path);
  if (typeof limit !== "number" || typeof value !== "number") return null;
  const told = joinUnit(formatNumber(roundOutwards(value, value > limit)), reachedUnit(name, problem));
  return changeLimit(path, check ?? name, value, value > limit, told);
}

/** Return the unit of a reachable value. @param {string} name @param {Problem} problem */
function reachedUnit(name, problem) {
  return metricUnit(name, problem) || (name.includes("angle") ? "°" : "");
}

/**
 * Describe a changed limit.
 * @param {string[]} path
 * @param {string} check
 * @param {number} value
 * @param {boolean} up
 * @param {string} told
 * @returns {Easing}
 */
function changeLimit(path, check, value, up, told) {
  const name = term(["tolerance", "clearance"].find((one) => one === path.at(-1)) ?? check);
  return {
    text: t`with ${name} ${told}`,
    apply: (statement) => writePointer(statement, path, roundOutwards(value, up)),
  };
}

/** Round a limit to its feasible side. @param {number} value @param {boolean} up */
function roundOutwards(value, up) {
  if (Number.isInteger(value)) return value;
  const step = 10 ** (Math.floor(Math.log10(Math.abs(value) || 1)) + 1 - LIMIT_DIGITS);
  return Number(((up ? Math.ceil : Math.floor)(value / step) * step).toPrecision(LIMIT_DIGITS));
}

/**
 * Find the path of a limit that has the name of its check.
 * @param {unknown} owner
 * @param {string} check
 * @param {number} limit
 * @param {string[]} [above]
 * @returns {string[] | null}
 */
function findLimitPath(owner, check, limit, above = []) {
  if (typeof owner !== "object" || owner === null || Array.isArray(owner)) return null;
  for (const [name, value] of Object.entries(owner)) {
    if ([check, `min_${check}`, `max_${check}`].includes(name) && value === limit) return [...above, name];
    const found = findLimitPath(value, check, limit, [...above, name]);
    if (found) return found;
  }
  return null;
}
