/** List the plots of a linkage: transmission, error, and the motion of one selected part. */

import { drawnJoints, groundedJoints } from "../canvas/linkage_drawing.js";
import { t, term } from "../core/messages.js";

/** @import { Design, LinkageAnalysis, Problem, Skeleton } from "../types/values.js" */

/** @typedef {import("./plots.js").PlotData} Plotted */
/** @typedef {(number | null)[]} Series */

/**
 * Return the parts whose motion can be plotted, the most important first.
 * @param {LinkageAnalysis} motion
 * @param {Skeleton} skeleton
 * @returns {string[]}
 */
export function listParts(motion, skeleton) {
  const still = groundedJoints(skeleton);
  const joints = drawnJoints(skeleton)
    .filter((name) => !still.includes(name))
    .map((name) => `point ${name}`);
  const links = Object.keys(motion.links ?? {})
    .filter((name) => name !== skeleton.input_link && name !== "ground")
    .map((name) => `link ${name}`);
  const slides = Object.keys(motion.slides ?? {}).map((name) => `slide ${name}`);
  const first = (/** @type {string} */ part) => part === "point P";
  return [...joints.filter(first), ...slides, ...links.reverse(), ...joints.filter((part) => !first(part))];
}

/** A part as a person reads it. @param {string} part */
export function partName(part) {
  const [kind, ...rest] = part.split(" ");
  const name = rest.join(" ");
  return kind === "link" ? t`Link ${term(name)}` : kind === "slide" ? t`Slide ${name}` : t`Point ${name}`;
}

/**
 * Position, velocity and acceleration of a part, by the radian (or length unit) of the input.
 * @param {LinkageAnalysis} motion
 * @param {string} part
 * @param {string} unit of lengths
 * @param {boolean} slides whether the input slides, so that rates are by a length
 * @returns {Plotted[]}
 */
export function partPlots(motion, part, unit, slides) {
  const per = slides ? unit : "rad";
  const [kind, ...rest] = part.split(" ");
  const name = rest.join(" ");
  const what = kind !== "link" ? name : term(name);
  if (kind === "point") {
    const { x, y, vx, vy, ax, ay } = motion.joints[name];
    const size = trackExtent(x, y);
    return [
      { title: t`Position of ${what} (${unit})`, lines: { x, y }, least: size },
      {
        title: t`Velocity of ${what} (${unit}/${per})`,
        lines: { [t`total`]: magnitudes(vx, vy), x: vx, y: vy },
        least: size,
      },
      {
        title: t`Acceleration of ${what} (${unit}/${per}²)`,
        lines: { [t`total`]: magnitudes(ax, ay), x: ax, y: ay },
        least: size,
      },
    ];
  }
  if (kind === "slide") {
    const { position, velocity, acceleration } = motion.slides[name];
    const size = trackExtent(position, position);
    return [
      { title: t`Position of ${what} on its line (${unit})`, lines: { "": position }, least: size },
      { title: t`Velocity of ${what} (${unit}/${per})`, lines: { "": velocity }, least: size },
      { title: t`Acceleration of ${what} (${unit}/${per}²)`, lines: { "": acceleration }, least: size },
    ];
  }
  const { angle, omega, alpha } = motion.links[name];
  return [
    { title: t`Angle of ${what} (°)`, lines: { "": angle }, least: 180 },
    { title: t`Angular velocity of ${what} (rad/${per})`, lines: { "": omega }, least: 1 },
    { title: t`Angular acceleration of ${what} (rad/${per}²)`, lines: { "": alpha }, least: 1 },
  ];
}

/**
 * What a linkage must do well: transmit force, and keep to its function.
 * @param {LinkageAnalysis} motion
 * @param {Partial<Design>} design
 * @param {Problem} problem
 * @returns {Plotted[]}
 */
export function qualityPlots(motion, design, problem) {
  /** @type {Plotted[]} */
  const found = [];
  const error = structuralError(design, problem.length_unit ?? "mm");
  if (error)
    found.push({
      title: error.title,
      lines: { "": resampleCurve(error.at, error.values, motion.input_angle) },
      values: error.values,
    });
  const used = usedSamples(design, motion.input_angle);
  found.push({
    title: t`Transmission angle (°)`,
    lines: { "": motion.transmission_angle ?? [] },
    limit: problem.constraints?.min_transmission_angle,
    least: 90,
    used,
  });
  return found;
}

/**
 * Where the input stands at a target: an angle, or the place of an input that slides.
 * @param {NonNullable<Design["targets"]>[number]} target
 * @returns {number}
 */
function targetInput(target) {
  return target.input_angle ?? target.input_place ?? NaN;
}

/**
 * Which samples lie between the first target and the last: the range that limits are for.
 * @param {Partial<Design>} design
 * @param {number[]} inputs
 * @returns {boolean[] | undefined}
 */
function usedSamples(design, inputs) {
  const at = (design.targets ?? []).map(targetInput);
  if (at.length < 2 || !at.every(Number.isFinite)) return undefined;
  const [low, high] = [Math.min(...at), Math.max(...at)];
  const past = (/** @type {number} */ input) => input - low - 360 * Math.floor((input - low) / 360);
  return high - low >= 360 ? undefined : inputs.map((input) => past(input) <= high - low);
}

/**
 * Structural error as the answer has it.
 * @param {Partial<Design>} design
 * @param {string} unit of lengths
 * @returns {{title: string, at: number[], values: number[]} | null}
 */
function structuralError(design, unit) {
  const structural = design.structural_error;
  if (structural?.curve) {
    return {
      title: t`Structural error (${structural.unit === "degrees" ? "°" : unit})`,
      at: structural.curve.input_angle,
      values: structural.curve.error,
    };
  }
  const targets = design.targets ?? [];
  const errors = targets.map((one) => one.error ?? NaN);
  if (
    targets.length > 2 &&
    errors.every(Number.isFinite) &&
    targets.every((one) => Number.isFinite(targetInput(one)))
  ) {
    return {
      title: t`Steering error (°)`,
      at: targets.map(targetInput),
      values: errors,
    };
  }
  return null;
}

/**
 * A curve over some range, at the samples of a motion; full turns aside, and unknown outside of its range.
 * @param {number[]} at @param {number[]} values @param {number[]} inputs @returns {Series}
 */
export function resampleCurve(at, values, inputs) {
  const order = at.map((_, k) => k).sort((one, other) => at[one] - at[other]);
  const [xs, ys] = [order.map((k) => at[k]), order.map((k) => values[k])];
  const end = xs[xs.length - 1];
  return inputs.map((input) => {
    const x = input - 360 * Math.floor((input - xs[0]) / 360);
    if (x > end) return null;
    let k = 1;
    while (k < xs.length - 1 && xs[k] < x) k++;
    return ys[k - 1] + ((x - xs[k - 1]) / (xs[k] - xs[k - 1] || 1)) * (ys[k] - ys[k - 1]);
  });
}

/** @param {Series} x @param {Series} y @returns {Series} */
function magnitudes(x, y) {
  return x.map((one, k) => (one === null || y[k] === null ? null : Math.hypot(one, Number(y[k]))));
}

/** How far a track reaches. @param {Series} x @param {Series} y */
function trackExtent(x, y) {
  const known = /** @type {number[]} */ ([...x, ...y].filter((one) => one !== null));
  return known.reduce((most, one) => Math.max(most, Math.abs(one)), 0);
}
