/** Draw the hodograph of a force, with a mark at the current position. */

import { createElement, formatNumber, createSvg } from "../core/dom.js";
import { t } from "../core/messages.js";
import { interpolate } from "../core/player.js";
import { View } from "../core/view.js";

const SIZE = 300;
const MARGIN = 30;

/** @typedef {(number | null)[]} Series */

export class Hodograph {
  /** @param {string} title @param {Series} x @param {Series} y @param {string} unit */
  constructor(title, x, y, unit) {
    this.x = x;
    this.y = y;
    const points = x.map(
      (one, k) => /** @type {[number, number]} */ (one === null || y[k] === null ? [NaN, NaN] : [one, Number(y[k])]),
    );
    const peak = points.reduce(
      (most, point) => (Number.isFinite(point[0]) ? Math.max(most, Math.hypot(...point)) : most),
      0,
    );
    // Both axes have the same scale and the origin is in the middle, so that directions are true.
    this.view = new View(
      [
        [-peak, -peak],
        [peak, peak],
      ],
      SIZE,
      SIZE,
      MARGIN,
    );
    const [u, v] = this.view.toPicture(0, 0);
    this.ray = createSvg("line", { class: "mark", x1: u, y1: v });
    this.dot = createSvg("circle", { class: "hodograph-now", r: 4.5 });
    this.reading = createElement("span", { class: "reading" });
    this.unit = unit;
    this.figure = createElement(
      "figure",
      { class: "plot hodograph" },
      createElement("figcaption", {}, createElement("span", {}, title), this.reading),
      createSvg(
        "svg",
        {
          viewBox: `0 0 ${SIZE} ${SIZE}`,
          role: "img",
          "aria-label": t`${title}: up to ${formatNumber(Number(peak.toPrecision(4)))} ${unit}`,
        },
        createSvg("rect", { class: "paper", width: SIZE, height: SIZE }),
        createSvg("circle", { class: "grid round", cx: u, cy: v, r: SIZE / 2 - MARGIN }),
        createSvg("line", { class: "zero", x1: MARGIN, x2: SIZE - MARGIN, y1: v, y2: v }),
        createSvg("line", { class: "zero", y1: MARGIN, y2: SIZE - MARGIN, x1: u, x2: u }),
        createSvg("text", { class: "tick", x: SIZE - 4, y: v - 5, "text-anchor": "end" }, "x"),
        createSvg("text", { class: "tick", x: u + 6, y: 14 }, "y"),
        createSvg(
          "text",
          { class: "tick", x: 6, y: SIZE - 8 },
          t`Circle: ${formatNumber(Number(peak.toPrecision(3)))} ${unit}`.trim(),
        ),
        createSvg("path", { class: "series s0", d: this.view.pathData(points) }),
        this.ray,
        this.dot,
      ),
    );
  }

  /** @param {number | null} at a place of the series @param {boolean} told whether its numbers are shown */
  show(at, told) {
    const [x, y] = at === null ? [null, null] : [interpolate(this.x, at), interpolate(this.y, at)];
    const known = x !== null && y !== null;
    this.ray.toggleAttribute("hidden", !known);
    this.dot.toggleAttribute("hidden", !known);
    if (told)
      this.reading.textContent = known
        ? `x ${formatNumber(Number(x.toPrecision(3)))}, y ${formatNumber(Number(y.toPrecision(3)))} ${this.unit}`
        : "–";
    if (!known) return;
    const [u, v] = this.view.toPicture(x, y);
    for (const [name, value] of Object.entries({ x2: u, y2: v })) this.ray.setAttribute(name, String(value));
    for (const [name, value] of Object.entries({ cx: u, cy: v })) this.dot.setAttribute(name, String(value));
  }
}
