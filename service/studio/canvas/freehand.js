/** A curve drawn freehand: a stroke of the pointer becomes the points of a path. */

/** How many points a stroke becomes. */
const POINT_COUNT = 24;

/** Ends that lie nearer to each other than this share of the way are one: the curve is closed. */
const CLOSING_SHARE = 0.1;

/** @typedef {[number, number]} Point */

/**
 * Draw from where the pointer went down to where it is let go.
 * @param {PointerEvent} event
 * @param {import("../core/view.js").View} view
 * @param {SVGSVGElement} picture
 * @param {SVGElement} pen
 * @param {(points: Point[], closed: boolean) => void} drawn
 */
export function drawStroke(event, view, picture, pen, drawn) {
  /** @type {Point[]} */
  const way = [view.toPlaneFromPointer(picture, event)];
  picture.setPointerCapture(event.pointerId);
  const move = (/** @type {PointerEvent} */ now) => {
    way.push(view.toPlaneFromPointer(picture, now));
    pen.setAttribute("d", view.pathData(way));
  };
  picture.addEventListener("pointermove", move);
  picture.addEventListener(
    "lostpointercapture",
    () => {
      picture.removeEventListener("pointermove", move);
      pen.removeAttribute("d");
      const closed = isClosed(way);
      // Round and back to the first point, which is stated once.
      const points = closed
        ? resample([...way, way[0]], POINT_COUNT + 1).slice(0, POINT_COUNT)
        : resample(way, POINT_COUNT);
      if (points.length >= 3)
        drawn(
          points.map(([x, y]) => [view.roundToPixel(x), view.roundToPixel(y)]),
          closed,
        );
    },
    { once: true },
  );
}

/** Whether a way comes back to where it began. @param {Point[]} way */
function isClosed(way) {
  const far = (/** @type {Point} */ [x, y], /** @type {Point} */ [u, v]) => Math.hypot(u - x, v - y);
  const length = way.slice(1).reduce((sum, point, k) => sum + far(way[k], point), 0);
  return way.length > 3 && far(way[0], way[way.length - 1]) < CLOSING_SHARE * length;
}

/** Points at equal distances along a way. @param {Point[]} way @param {number} count @returns {Point[]} */
function resample(way, count) {
  const along = [0];
  for (let k = 1; k < way.length; k++) {
    along.push(along[k - 1] + Math.hypot(way[k][0] - way[k - 1][0], way[k][1] - way[k - 1][1]));
  }
  const length = along[along.length - 1];
  if (!(length > 0)) return [];
  /** @type {Point[]} */
  const points = [];
  for (let k = 0, n = 1; k < count; k++) {
    const s = (length * k) / (count - 1);
    while (n < way.length - 1 && along[n] < s) n++;
    const share = along[n] > along[n - 1] ? (s - along[n - 1]) / (along[n] - along[n - 1]) : 0;
    const [before, after] = [way[n - 1], way[n]];
    points.push([before[0] + share * (after[0] - before[0]), before[1] + share * (after[1] - before[1])]);
  }
  return points;
}
