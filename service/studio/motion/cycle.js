/** Fetch the cycle of a linkage: a full turn of a crank, or from toggle to toggle. */

import * as api from "../core/api.js";
import { groundedJoints } from "../canvas/linkage_drawing.js";

/** @import { LinkageAnalysis, Linked, Mechanism, Skeleton } from "../types/values.js" */

/**
 * Input angle of the configuration in which a skeleton stands, degrees; null where a slide drives.
 * @param {Skeleton} skeleton
 * @returns {number | null}
 */
export function inputAngle(skeleton) {
  const link = skeleton.links.find((one) => one.name === skeleton.input_link);
  const [one, other] = link?.joints.map((/** @type {string} */ name) => skeleton.joints[name]) ?? [];
  if (!link || !one || !other) return null;
  // The input angle is that of the line from the fixed pivot.
  const back = !groundedJoints(skeleton).includes(link.joints[0]);
  const sign = back ? -1 : 1;
  return (Math.atan2(sign * (other[1] - one[1]), sign * (other[0] - one[0])) * 180) / Math.PI;
}

/**
 * The motion over the cycle, and an analysis with all branches.
 * @param {Mechanism} mechanism @param {number} steps @param {AbortSignal} signal
 * @returns {Promise<{motion: LinkageAnalysis, circuits: LinkageAnalysis}>}
 */
export async function fetchCycle(mechanism, steps, signal) {
  const at = mechanism.reference_input_angle ?? (mechanism.skeleton ? inputAngle(mechanism.skeleton) : null);
  if (at === null || mechanism.driven_by === "slider") {
    const motion = await api.analyse({ mechanism, include: ["branches"] }, signal);
    return { motion, circuits: motion };
  }
  const circuits = await api.analyse({ mechanism, motion: { at }, include: ["branches"] }, signal);
  const here = circuits.circuits.flatMap((one) => one.branches).find((one) => one.reference);
  const from = here && !here.full ? at - (at - here.from - 360 * Math.floor((at - here.from) / 360)) : at;
  const to = from + (here ? here.to - here.from : 360);
  return { motion: await api.analyse({ mechanism, motion: { from, to, steps } }, signal), circuits };
}

/**
 * A mechanism given by its dimensions, with its skeleton in the reference position of the motion.
 * @param {Mechanism} mechanism
 * @param {LinkageAnalysis} motion
 * @returns {Linked}
 */
export function addSkeleton(mechanism, motion) {
  if (mechanism.skeleton) return /** @type {Linked} */ (mechanism);
  const k = motion.valid.indexOf(true);
  const joints = Object.fromEntries(
    Object.entries(motion.joints).map(([name, track]) => [
      name,
      /** @type {[number, number]} */ ([track.x[k], track.y[k]]),
    ]),
  );
  const links = [
    ["ground", "O2", "O4"],
    ["input", "O2", "A"],
    ["coupler", "A", "B", ...("P" in joints ? ["P"] : [])],
    ["output", "O4", "B"],
  ];
  return {
    ...mechanism,
    skeleton: {
      joints,
      links: links.map(([name, ...on]) => ({ name, joints: on })),
      slides: [],
      gears: [],
      input_link: "input",
    },
  };
}
