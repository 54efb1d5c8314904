/**
 * Scales of forces and torques of a linkage; values below rounding of these scales are zero.
 *
 * A balanced linkage needs no drive, but the computed sum of its loads is 1e-15 instead of 0. The scale of forces is
 * the greatest force at a pin or on the frame; that of torques is the greatest drive or moment, or this force on an arm
 * as long as the linkage.
 */

import { isRounding } from "../design/design_metrics.js";

/** @import { LinkageAnalysis, Schemas, Skeleton } from "../types/values.js" */

/** @typedef {LinkageAnalysis & {dynamics: Schemas["DynamicsAnswer"]}} ForceAnswer */
/** @typedef {(number | null)[]} Series */

/** Length units in metres. @type {Record<string, number>} */
const METRES = { mm: 1e-3, cm: 1e-2, m: 1, in: 0.0254 };

/** Return the diagonal of the box around all joints. @param {Skeleton} skeleton */
function linkageSize({ joints }) {
  const [xs, ys] = [0, 1].map((axis) => Object.values(joints).map((at) => at[axis]));
  return Math.hypot(Math.max(...xs) - Math.min(...xs), Math.max(...ys) - Math.min(...ys));
}

/** @param {(number | null | undefined)[]} values */
function greatestMagnitude(values) {
  return Math.max(0, ...values.map((one) => Math.abs(one ?? 0)));
}

/**
 * An answer in which what is rounding alone is 0.
 * @param {ForceAnswer} answer
 * @param {Skeleton} skeleton
 * @param {boolean} sliding whether a force drives, and no torque
 * @returns {ForceAnswer}
 */
export function clearRounding(answer, skeleton, sliding) {
  const { dynamics } = answer;
  const { extremes, joints, shaking, power } = dynamics;
  const { drive, shaking_force: frame, shaking_moment: moment } = extremes;
  const drives = [drive.max, drive.min];
  const pins = Object.values(extremes.joints).map(({ max }) => max);
  const force = greatestMagnitude([...pins, frame.max, ...(sliding ? drives : [])]);
  const metre = dynamics.units === "si" ? (METRES[dynamics.length_unit ?? "mm"] ?? 1) : 1;
  const torque = greatestMagnitude([moment.max, force * metre * linkageSize(skeleton), ...(sliding ? [] : drives)]);
  const against = (/** @type {number} */ of) => {
    const one = (/** @type {number | null} */ value) => (value !== null && isRounding(value, of) ? 0 : value);
    return { one, all: (/** @type {Series} */ series) => series.map(one) };
  };
  const [forces, torques] = [against(force), against(torque)];
  const driving = sliding ? forces : torques;
  const vector = (/** @type {{x: Series, y: Series}} */ { x, y }) => ({ x: forces.all(x), y: forces.all(y) });
  const idle = drives.every((one) => driving.one(one) === 0);
  const each = Object.entries(joints ?? {}).map(([joint, links]) => [
    joint,
    Object.fromEntries(Object.entries(links).map(([link, on]) => [link, vector(on)])),
  ]);
  return {
    ...answer,
    dynamics: {
      ...dynamics,
      drive: dynamics.drive && driving.all(dynamics.drive),
      joints: joints && Object.fromEntries(each),
      shaking: shaking && { ...shaking, force: vector(shaking.force), moment: torques.all(shaking.moment) },
      // A drive that is nothing has no power.
      power: idle ? { ...power, peak: power.peak && 0, mean: power.mean && 0 } : power,
      extremes: {
        ...extremes,
        drive: {
          // Nothing is greatest nowhere.
          at: idle ? null : drive.at,
          at_min: idle ? null : drive.at_min,
          max: driving.one(drive.max),
          min: driving.one(drive.min),
          mean: driving.one(drive.mean),
          rms: driving.one(drive.rms),
        },
        joints: Object.fromEntries(
          Object.entries(extremes.joints).map(([joint, peak]) => [joint, { ...peak, max: forces.one(peak.max) }]),
        ),
        shaking_force: { ...frame, max: forces.one(frame.max) },
        shaking_moment: { ...moment, max: torques.one(moment.max) },
      },
    },
  };
}
