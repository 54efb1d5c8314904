/**
 * The dimensions of an explored linkage: their values, and the joints that satisfy given ones.
 *
 * A link of two joints has a length; each further joint has its distance from the first one, and the angle there from
 * the line to the second. Given dimensions are met with the least movement of the joints: the shortest Newton step to
 * c(x) = 0 is −Jᵀ(JJᵀ)⁻¹c.
 */

/** @import { Skeleton } from "../types/values.js" */

/** @typedef {[number, number]} Point */
/** @typedef {Record<string, Point>} Joints */
/**
 * @typedef {object} Dimension
 * @property {string} link
 * @property {string[]} joints two of a length; three of an angle: where it is, from where, to where
 */

const MAX_STEPS = 40;

/** What is missed by less, of the linkage's size, is kept. */
const RESIDUAL_TOLERANCE = 1e-9;

/** Changes of coordinates from which slopes are taken, of the linkage's size. */
const DIFFERENCE_STEP = 1e-6;

/** Damping as a share of the greatest squared slope; it keeps redundant dimensions solvable. */
const DAMPING = 1e-12;

/**
 * Dimensions that say how large each link is, the ground among them.
 * @param {Skeleton} skeleton
 * @returns {Dimension[]}
 */
export function listDimensions({ links, joints }) {
  return links.flatMap(({ name, joints: [first, second, ...others] }) => {
    if (second === undefined) return [];
    const apart = others.filter((one) => distance(joints[first], joints[one]) > 0);
    return [
      { link: name, joints: [first, second] },
      ...apart.flatMap((one) => [
        { link: name, joints: [first, one] },
        { link: name, joints: [first, second, one] },
      ]),
    ];
  });
}

/** Its value: a length, or an angle in degrees. @param {Dimension} dimension @param {Joints} places */
export function dimensionValue({ joints: [at, from, to] }, places) {
  if (to === undefined) return distance(places[at], places[from]);
  const turned = direction(places[at], places[to]) - direction(places[at], places[from]);
  return (Math.atan2(Math.sin(turned), Math.cos(turned)) * 180) / Math.PI;
}

/**
 * What is to hold: a dimension has a value, or that of another one.
 * @typedef {{dimension: Dimension, value?: number, other?: Dimension}} Demand
 */

/**
 * Return the joints, moved as little as possible, that satisfy all demands; null if none were found.
 * @param {Joints} places
 * @param {Demand[]} demands
 * @param {string[]} still joints that stay where they are
 * @returns {Joints | null}
 */
export function solveDemands(places, demands, still) {
  const names = Object.keys(places).filter((name) => !still.includes(name));
  const found = structuredClone(places);
  const all = Object.values(places);
  const size = Math.max(...all.map((one) => distance(one, all[0])));
  const missed = () => demands.map((demand) => demandResidual(demand, found));
  for (let step = 0; step <= MAX_STEPS; step++) {
    const now = missed();
    if (now.every((one) => Math.abs(one) <= RESIDUAL_TOLERANCE * size)) return found;
    const slopes = names.flatMap((name) =>
      [0, 1].map((axis) => {
        found[name][axis] += DIFFERENCE_STEP * size;
        const changed = missed();
        found[name][axis] -= DIFFERENCE_STEP * size;
        return changed.map((one, k) => (one - now[k]) / (DIFFERENCE_STEP * size));
      }),
    );
    const shares = solveSymmetric(
      now.map((_, i) => now.map((_, j) => slopes.reduce((sum, column) => sum + column[i] * column[j], 0))),
      now,
    );
    const steps = slopes.map((column) => -column.reduce((sum, one, k) => sum + one * shares[k], 0));
    if (!steps.every(Number.isFinite)) return null;
    // Not farther at once than the linkage is large.
    const most = Math.max(size, ...steps.map(Math.abs)) / size;
    names.forEach((name, k) => {
      found[name][0] += steps[2 * k] / most;
      found[name][1] += steps[2 * k + 1] / most;
    });
  }
  return null;
}

/** By how much a demand is missed, as a length. @param {Demand} demand @param {Joints} places */
function demandResidual({ dimension, value, other }, places) {
  const wanted = other ? dimensionValue(other, places) : Number(value);
  const away = dimensionValue(dimension, places) - wanted;
  if (dimension.joints.length === 2) return away;
  const [at, , to] = dimension.joints;
  const turned = (away * Math.PI) / 180;
  return Math.atan2(Math.sin(turned), Math.cos(turned)) * distance(places[at], places[to]);
}

/**
 * Solve a symmetric system by elimination, with damping for redundant equations.
 * @param {number[][]} matrix
 * @param {number[]} right
 */
function solveSymmetric(matrix, right) {
  const most = Math.max(...matrix.map((row, k) => row[k]));
  const rows = matrix.map((row, i) => [...row.map((one, j) => one + (i === j ? DAMPING * most : 0)), right[i]]);
  rows.forEach((pivot, k) => {
    for (const row of rows.slice(k + 1)) {
      const share = row[k] / pivot[k];
      for (let j = k; j < row.length; j++) row[j] -= share * pivot[j];
    }
  });
  const found = right.map(() => 0);
  for (let k = rows.length - 1; k >= 0; k--) {
    const known = found.reduce((sum, one, j) => (j > k ? sum + rows[k][j] * one : sum), 0);
    found[k] = (rows[k][right.length] - known) / rows[k][k];
  }
  return found;
}

/** @param {Point} one @param {Point} other */
function distance([x, y], [u, v]) {
  return Math.hypot(u - x, v - y);
}

/** @param {Point} from @param {Point} to radians */
function direction([x, y], [u, v]) {
  return Math.atan2(v - y, u - x);
}
