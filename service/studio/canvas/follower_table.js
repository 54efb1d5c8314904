/** Convert a tabulated follower motion into cam segments by a periodic cubic spline. */

import { t } from "../core/messages.js";

/** @import { Problem } from "../types/values.js" */

/** @typedef {[number, number]} Point */

/** One turn, degrees. */
const TURN_DEGREES = 360;

/** Maximum gap between the last and the first displacement, relative to the travel, for a closed motion. */
const CLOSING_SHARE = 0.02;

/** @param {number} value */
function roundAngle(value) {
  return Number(value.toPrecision(12));
}

/**
 * The segments of a motion through points: x is turned into cam angles so that all of it is one turn.
 * @param {Point[]} points
 * @param {number} unit of displacements in their derivatives: 1, or radians in a degree for an arm
 * @returns {NonNullable<Problem["segments"]>}
 */
export function fitSegments(points, unit) {
  const [first, last] = [points[0], points[points.length - 1]];
  const span = last[0] - first[0];
  const ordered = span < 0 ? [...points].reverse() : points;
  if (points.length < 4) throw new Error(t`A motion needs at least four points.`);
  if (ordered.some(([x], k) => k > 0 && !(x > ordered[k - 1][0])))
    throw new Error(t`The curve turns back; a motion needs exactly one displacement at each angle.`);
  const heights = ordered.map(([, y]) => y);
  const low = Math.min(...heights);
  const travel = Math.max(...heights) - low;
  if (!(travel > 0)) throw new Error(t`The follower never moves.`);
  if (Math.abs(last[1] - first[1]) > CLOSING_SHARE * travel)
    throw new Error(t`The motion must end at its initial displacement, because a cam turns around.`);
  const angles = ordered.map(([x]) => roundAngle((TURN_DEGREES * (x - ordered[0][0])) / Math.abs(span)));
  const lifts = heights.slice(0, -1).map((y) => roundAngle(y - low));
  const widths = lifts.map((_, k) => angles[k + 1] - angles[k]);
  const turns = widths.map((one) => (one * Math.PI) / 180);
  const bends = solvePeriodicSpline(turns, lifts);
  const count = lifts.length;
  const state = (/** @type {number} */ k, /** @type {number} */ angle) => {
    const next = (k + 1) % count;
    const speed = (lifts[next] - lifts[k]) / turns[k] - (turns[k] * (2 * bends[k] + bends[next])) / 6;
    return { angle, s: lifts[k], v: roundAngle(speed * unit), a: roundAngle(bends[k] * unit) };
  };
  return lifts.map((_, k) => ({
    motion: "polynomial",
    angle: roundAngle(widths[k]),
    conditions: [state(k, 0), state((k + 1) % count, roundAngle(widths[k]))],
  }));
}

/**
 * Second derivatives at the points of the cubic spline that closes: of each piece to the next the slopes agree
 * (de Boor, A Practical Guide to Splines, ch. IV), and the last piece leads to the first point.
 * @param {number[]} widths @param {number[]} heights @returns {number[]}
 */
function solvePeriodicSpline(widths, heights) {
  const count = heights.length;
  const rows = heights.map((height, k) => {
    const [before, next] = [(k + count - 1) % count, (k + 1) % count];
    const row = new Array(count + 1).fill(0);
    row[before] += widths[before];
    row[k] += 2 * (widths[before] + widths[k]);
    row[next] += widths[k];
    row[count] = 6 * ((heights[next] - height) / widths[k] - (height - heights[before]) / widths[before]);
    return row;
  });
  // The matrix is diagonally dominant, so no pivoting is needed.
  for (let k = 0; k < count; k++) {
    for (let below = k + 1; below < count; below++) {
      const share = rows[below][k] / rows[k][k];
      if (share) for (let c = k; c <= count; c++) rows[below][c] -= share * rows[k][c];
    }
  }
  for (let k = count - 1; k >= 0; k--) {
    for (let c = k + 1; c < count; c++) rows[k][count] -= rows[k][c] * rows[c][count];
    rows[k][count] /= rows[k][k];
  }
  return rows.map((row) => row[count]);
}
