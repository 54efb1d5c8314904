/** Start problems from an explored linkage. */

import { findTracedJoint } from "../motion/circuits.js";
import { t } from "../core/messages.js";

/** @import { LinkageAnalysis, Problem, Schemas, Skeleton } from "../types/values.js" */

/** How many points of a curve a statement takes. */
const POINT_COUNT = 24;

/** @typedef {[number, number]} Point */
/** @typedef {{text: string, statement: () => Problem, solved?: boolean}} StartingPoint solved at once */

/**
 * @param {Problem} problem that the linkage answered
 * @param {Skeleton} skeleton
 * @param {LinkageAnalysis} motion over the cycle
 * @param {import("../motion/linkage_motion.js").Target[]} targets
 * @param {boolean} held whether dimensions are held, which a fit does not know
 * @returns {StartingPoint[]}
 */
export function listStartingPoints(problem, skeleton, motion, targets, held) {
  /** @type {StartingPoint[]} */
  const found = [];
  const { O2, O4, A, B, P } = skeleton.joints;
  const free = problem.timing !== "prescribed" && !problem.stance && !problem.placement_free?.length;
  if (
    problem.kind === "path" &&
    free &&
    skeleton.links.length === 4 &&
    !skeleton.slides?.length &&
    O2 &&
    A &&
    B &&
    O4 &&
    P
  )
    found.push({
      text: held ? t`Optimise from here, with held dimensions free` : t`Optimise from here`,
      solved: true,
      statement: () => ({
        ...problem,
        method: "least_squares",
        mechanism: "fourbar",
        mechanisms: null,
        start: { O2: roundPoint(O2), A: roundPoint(A), B: roundPoint(B), O4: roundPoint(O4), P: roundPoint(P) },
      }),
    });
  if (O2 && O4 && problem.kind === "motion") {
    const side = (/** @type {Partial<Schemas["DyadChoices"]> | undefined} */ choices, /** @type {Point} */ at) => ({
      dyad: choices?.dyad,
      fixed_pivot: roundPoint(at),
    });
    found.push({
      text: t`Start a problem with these fixed pivots`,
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
      text: t`Start a problem with these fixed pivots`,
      statement: () => ({ ...problem, fixed_pivots: { input: roundPoint(O2), output: roundPoint(O4) } }),
    });
  }
  if (problem.kind === "motion" && "P" in skeleton.joints) {
    found.push({
      text: t`Start a problem with the positions it reaches`,
      statement: () => ({ ...problem, positions: describePositions(problem, skeleton, motion, targets) }),
    });
  }
  const known = jointCurve(motion, findTracedJoint(skeleton));
  if (known.length > 3) {
    found.push({
      text: t`Start a path problem with its curve`,
      statement: () => ({
        kind: "path",
        length_unit: problem.length_unit,
        points: spreadEvenly(known, motion.valid.every(Boolean)),
        closed: motion.valid.every(Boolean),
      }),
    });
  }
  return found;
}

/** @param {Point} point @returns {Point} */
function roundPoint([x, y]) {
  return [roundValue(x), roundValue(y)];
}

/** @param {number} value */
function roundValue(value) {
  return Number(value.toPrecision(6));
}

/** @param {LinkageAnalysis} motion @param {string} name @returns {Point[]} */
function jointCurve(motion, name) {
  const { x, y } = motion.joints[name];
  return x.flatMap((one, k) => (one === null ? [] : [/** @type {Point} */ ([one, y[k]])]));
}

/**
 * Points at equal shares of the input.
 * @param {Point[]} known
 * @param {boolean} closed whose last point is the first again
 */
function spreadEvenly(known, closed) {
  const last = known.length - 1;
  return Array.from({ length: POINT_COUNT }, (_, k) => {
    const [x, y] = known[Math.round((k * last) / (closed ? POINT_COUNT : POINT_COUNT - 1))];
    return { x: roundValue(x), y: roundValue(y) };
  });
}

/**
 * Where the body is when P is nearest to each demanded position.
 * @param {Problem} problem
 * @param {Skeleton} skeleton
 * @param {LinkageAnalysis} motion
 * @param {import("../motion/linkage_motion.js").Target[]} targets
 */
function describePositions(problem, skeleton, motion, targets) {
  const body = skeleton.links.find((link) => link.joints.includes("P"))?.name ?? "";
  const { x, y } = motion.joints.P;
  const { angle } = motion.links[body];
  const first = problem.positions?.[0]?.angle ?? 0;
  return targets.map((target) => {
    let best = 0;
    let least = Infinity;
    x.forEach((one, k) => {
      const away = one === null ? Infinity : Math.hypot(one - target.x, Number(y[k]) - target.y);
      if (away < least) [least, best] = [away, k];
    });
    const turned = first + Number(angle[best]) - Number(angle[0]);
    return {
      x: roundValue(Number(x[best])),
      y: roundValue(Number(y[best])),
      angle: roundValue(turned + 360 * Math.round(((target.angle ?? 0) - turned) / 360)),
    };
  });
}
