/** Smooth a curve of points, or make it symmetric. */

/** @typedef {[number, number]} Point */

/** Steps inwards and outwards of Taubin's filter: a curve becomes smoother and does not shrink (SIGGRAPH 1995). */
const SHRINK_STEP = 0.5;
const EXPAND_STEP = -0.53;

/** Number of passes for one press of the button. */
const SMOOTHING_ROUNDS = 3;

/**
 * Smooth the points; the ends of an open curve stay fixed.
 * @param {Point[]} points
 * @param {boolean} closed
 * @returns {Point[]}
 */
export function smoothCurve(points, closed) {
  const count = points.length;
  let now = points;
  for (let k = 0; k < 2 * SMOOTHING_ROUNDS; k++) {
    const share = k % 2 ? EXPAND_STEP : SHRINK_STEP;
    const before = now;
    now = before.map((point, n) => {
      if (!closed && (n === 0 || n === count - 1)) return point;
      const [one, other] = [before[(n + count - 1) % count], before[(n + 1) % count]];
      return /** @type {Point} */ (point.map((value, c) => value + share * ((one[c] + other[c]) / 2 - value)));
    });
  }
  return now;
}

/**
 * Make points symmetric: each becomes the mean of itself and the mirror image of its partner. An open curve is mirrored
 * in the perpendicular bisector of its ends. For a closed one, with points z about their mean and partners z[j - k],
 * the best mirror is the line through the mean at half the argument of sum(z[k] z[j - k]); the j with the greatest sum
 * is taken.
 * @param {Point[]} points @param {boolean} closed @returns {Point[]}
 */
export function makeSymmetric(points, closed) {
  const count = points.length;
  const middle = closed
    ? points.reduce(
        ([a, b], [x, y]) => /** @type {Point} */ ([a + x / count, b + y / count]),
        /** @type {Point} */ ([0, 0]),
      )
    : /** @type {Point} */ ([(points[0][0] + points[count - 1][0]) / 2, (points[0][1] + points[count - 1][1]) / 2]);
  const about = points.map(([x, y]) => /** @type {Point} */ ([x - middle[0], y - middle[1]]));
  const partner = (/** @type {number} */ j, /** @type {number} */ k) => (j - k + 2 * count) % count;
  let best = { j: count - 1, size: -1, turn: /** @type {Point} */ ([-1, 0]) };
  for (let j = closed ? 0 : count - 1; j < count; j++) {
    const [re, im] = closed
      ? about.reduce(([a, b], [x, y], k) => {
          const [u, v] = about[partner(j, k)];
          return /** @type {Point} */ ([a + x * u - y * v, b + x * v + y * u]);
        }, /** @type {Point} */ ([0, 0]))
      : [0, 0];
    const size = Math.hypot(re, im);
    if (size > best.size) best = { j, size, turn: size ? [re / size, im / size] : [1, 0] };
  }
  if (!closed) {
    // Mirror across the perpendicular bisector of the ends.
    const [x, y] = about[count - 1];
    const far = x * x + y * y || 1;
    best.turn = [(y * y - x * x) / far, (-2 * x * y) / far];
  }
  const [c, s] = best.turn;
  return about.map(([x, y], k) => {
    const [u, v] = about[partner(best.j, k)];
    const mirrored = [c * u + s * v, s * u - c * v];
    return /** @type {Point} */ ([middle[0] + (x + mirrored[0]) / 2, middle[1] + (y + mirrored[1]) / 2]);
  });
}
