/** Summarize the analysis of a linkage. */

import { findTracedJoint } from "./circuits.js";
import { formatNumber, toWords } from "../core/dom.js";
import { formatDegrees } from "../plots/gauge.js";
import { t } from "../core/messages.js";

/** @import { LinkageAnalysis, Skeleton } from "../types/values.js" */

/** @typedef {[number, number]} Point */

/**
 * The curve of a linkage's characteristic point over a motion; NaN where it is not reached.
 * @param {LinkageAnalysis} answer
 * @param {Skeleton} skeleton
 * @returns {Point[]}
 */
export function couplerCurve(answer, skeleton) {
  const { x, y } = answer.joints[findTracedJoint(skeleton)];
  return x.map((one, k) => (one === null ? [NaN, NaN] : [one, Number(y[k])]));
}

/**
 * How far a target is from the line between two samples of the curve; infinitely where one of them is not reached.
 * @param {{x: number, y: number}} target
 * @param {Point} from
 * @param {Point} to
 */
function distanceToLine({ x, y }, [px, py], [qx, qy]) {
  const [dx, dy] = [qx - px, qy - py];
  const share = Math.min(1, Math.max(0, ((x - px) * dx + (y - py) * dy) / (dx * dx + dy * dy || 1)));
  const far = Math.hypot(px + share * dx - x, py + share * dy - y);
  return Number.isNaN(far) ? Infinity : far;
}

/**
 * @typedef {object} LinkageFacts
 * @property {Record<string, string>} facts
 * @property {boolean} turns whether the input turns through
 * @property {number | null} least transmission angle, degrees
 * @property {string | null} grashof
 * @property {number[]} missed how far each target is from the curve
 */

/**
 * @param {LinkageAnalysis} answer of the analysis over a turn of its input
 * @param {Skeleton} skeleton
 * @param {{x: number, y: number}[]} targets
 * @param {string} unit of lengths
 * @returns {LinkageFacts}
 */
export function createFacts(answer, skeleton, targets, unit) {
  const curve = couplerCurve(answer, skeleton);
  const least = answer.min_transmission_angle;
  const missed =
    "P" in skeleton.joints
      ? targets.map((target) =>
          curve.slice(1).reduce((least, to, k) => Math.min(least, distanceToLine(target, curve[k], to)), Infinity),
        )
      : [];
  const turns = answer.valid.every(Boolean);
  const { grashof } = answer.classification;
  const farthest = `${formatNumber(Number(Math.max(...missed).toPrecision(3)))} ${unit}`;
  return {
    turns,
    least,
    grashof,
    missed,
    facts: {
      ...(grashof ? { [t`Grashof`]: toWords(grashof) } : {}),
      [t`Full input rotation`]: turns ? t`yes` : t`no`,
      [t`Minimum transmission angle`]: formatDegrees(least),
      ...(missed.length ? { [t`Largest distance of a target from the curve`]: farthest } : {}),
      [t`Circuits`]: formatNumber(answer.circuits.length),
    },
  };
}
