/** Draw a curve freehand: a stroke of the pointer becomes the points of a path. */

/** Number of points of a stroke. */
const POINT_COUNT = 24;

/** Maximum gap between the ends of a closed curve, relative to its length. */
const CLOSING_SHARE = 0.1;

/** @typedef {[number, number]} Point */

/**
 * Draw a stroke from pointer down to pointer up.
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
      // Close the curve; the first point is given once.
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

/** Return true if a stroke is closed. @param {Point[]} way */
function isClosed(way) {
  const far = (/** @type {Point} */ [x, y], /** @type {Point} */ [u, v]) => Math.hypot(u - x, v - y);
  const length = way.slice(1).reduce((sum, point, k) => sum + far(way[k], point), 0);
  return way.length > 3 && far(way[0], way[way.length - 1]) < CLOSING_SHARE * length;
}

/** Resample a stroke at equal distances. @param {Point[]} way @param {number} count @returns {Point[]} */
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
