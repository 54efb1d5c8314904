/** Statements that begin with a linkage as it was dragged. */

import { telling } from "./circuits.js";
import { t } from "./messages.js";

/** How many points of a curve a statement takes. */
const POINTS = 24;

/** @typedef {[number, number]} Point */

/**
 * @param {any} problem that the linkage answered
 * @param {any} skeleton
 * @param {any} motion over the cycle
 * @param {any[]} targets
 * @returns {{text: string, statement: () => any}[]}
 */
export function beginnings(problem, skeleton, motion, targets) {
  const found = [];
  const { O2, O4 } = skeleton.joints;
  if (O2 && O4 && problem.kind === "motion") {
    const side = (/** @type {any} */ choices, /** @type {Point} */ at) => ({
      dyad: choices.dyad,
      fixed_pivot: at.map(round),
    });
    found.push({
      text: t`Begin a statement with these fixed pivots`,
      statement: () => ({
        ...problem,
        input_side: side(problem.input_side, O2),
        output_side: side(problem.output_side, O4),
        ground_line: null,
      }),
    });
  }
  if (O2 && O4 && "fixed_pivots" in problem && problem.kind === "path") {
    found.push({
      text: t`Begin a statement with these fixed pivots`,
      statement: () => ({ ...problem, fixed_pivots: { input: O2.map(round), output: O4.map(round) } }),
    });
  }
  if (problem.kind === "motion" && "P" in skeleton.joints) {
    found.push({
      text: t`Begin a statement with the positions that it takes`,
      statement: () => ({ ...problem, positions: taken(problem, skeleton, motion, targets) }),
    });
  }
  const known = curve(motion, telling(skeleton));
  if (known.length > 3) {
    found.push({
      text: t`Begin a path statement with its curve`,
      statement: () => ({
        kind: "path",
        length_unit: problem.length_unit,
        points: spread(known, motion.valid.every(Boolean)),
        closed: motion.valid.every(Boolean),
      }),
    });
  }
  return found;
}

/** @param {number} value */
function round(value) {
  return Number(value.toPrecision(6));
}

/** @param {any} motion @param {string} name @returns {Point[]} */
function curve(motion, name) {
  const { x, y } = motion.joints[name];
  return x
    .map((/** @type {number | null} */ one, /** @type {number} */ k) => [one, y[k]])
    .filter((/** @type {any} */ [one]) => one !== null);
}

/**
 * Points at equal shares of the input.
 * @param {Point[]} known
 * @param {boolean} closed whose last point is the first again
 */
function spread(known, closed) {
  const last = known.length - 1;
  return Array.from({ length: POINTS }, (_, k) => {
    const [x, y] = known[Math.round((k * last) / (closed ? POINTS : POINTS - 1))];
    return { x: round(x), y: round(y) };
  });
}

/**
 * Where the body is when P is nearest to each demanded position.
 * @param {any} problem
 * @param {any} skeleton
 * @param {any} motion
 * @param {any[]} targets
 */
function taken(problem, skeleton, motion, targets) {
  const body = skeleton.links.find((/** @type {any} */ link) => link.joints.includes("P")).name;
  const { x, y } = motion.joints.P;
  const { angle } = motion.links[body];
  const first = problem.positions[0].angle;
  return targets.map((target) => {
    let best = 0;
    let least = Infinity;
    x.forEach((/** @type {number | null} */ one, /** @type {number} */ k) => {
      const away = one === null ? Infinity : Math.hypot(one - target.x, y[k] - target.y);
      if (away < least) [least, best] = [away, k];
    });
    const turned = first + angle[best] - angle[0];
    return {
      x: round(x[best]),
      y: round(y[best]),
      angle: round(turned + 360 * Math.round((target.angle - turned) / 360)),
    };
  });
}
