/** Draw grid lines at round coordinates. */

import { formatNumber, createSvg } from "../core/dom.js";

/** Minimum distance between grid lines, pixels; the numbers fit, also on a phone. */
const MIN_LINE_SPACING = 76;

/** Return 1, 2 or 5 times a power of ten, at least the given length. @param {number} least */
export function roundSpacing(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return ([1, 2, 5].find((digit) => digit * power >= least) ?? 10) * power;
}

/** Minimum distance between snap positions, pixels. */
const SNAP_SPACING = 12;

/** Return the snap spacing of a view, a fraction of its grid. @param {import("../core/view.js").View} view */
export function snapSpacing(view) {
  return roundSpacing(SNAP_SPACING / view.scale);
}

/** @param {import("../core/view.js").View} view */
export function drawGrid(view) {
  const { width, height } = view;
  const step = roundSpacing(MIN_LINE_SPACING / view.scale);
  const [west, north] = view.middle.map((m, c) => m + ((c ? 1 : -1) * (c ? height : width)) / 2 / view.scale);
  const lines = [];
  for (let k = Math.ceil(west / step); lines.length < 60; k++) {
    const [u] = view.toPicture(k * step, 0);
    if (u > width) break;
    lines.push(
      createSvg("line", { class: "grid", x1: u, x2: u, y1: 0, y2: height }),
      createSvg("text", { class: "tick", x: u + 3, y: height - 5 }, formatNumber(Number((k * step).toPrecision(6)))),
    );
  }
  for (let k = Math.floor(north / step), first = lines.length; lines.length < first + 60; k--) {
    const [, v] = view.toPicture(0, k * step);
    if (v > height) break;
    lines.push(
      createSvg("line", { class: "grid", x1: 0, x2: width, y1: v, y2: v }),
      createSvg("text", { class: "tick", x: 4, y: v - 4 }, formatNumber(Number((k * step).toPrecision(6)))),
    );
  }
  return lines;
}
