/** The hodograph of a force: its components against each other over the motion, with a mark where the motion stands. */

import { el, shown, svg } from "../core/dom.js";
import { t } from "../core/messages.js";
import { between } from "../core/player.js";
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
    // Both axes have one scale, and the origin is the middle: what is seen is a direction.
    this.view = new View(
      [
        [-peak, -peak],
        [peak, peak],
      ],
      SIZE,
      SIZE,
      MARGIN,
    );
    const [u, v] = this.view.at(0, 0);
    this.ray = svg("line", { class: "mark", x1: u, y1: v });
    this.dot = svg("circle", { class: "hodograph-now", r: 4.5 });
    this.reading = el("span", { class: "reading" });
    this.unit = unit;
    this.figure = el(
      "figure",
      { class: "plot hodograph" },
      el("figcaption", {}, el("span", {}, title), this.reading),
      svg(
        "svg",
        {
          viewBox: `0 0 ${SIZE} ${SIZE}`,
          role: "img",
          "aria-label": t`${title}: up to ${shown(Number(peak.toPrecision(4)))} ${unit}`,
        },
        svg("rect", { class: "paper", width: SIZE, height: SIZE }),
        svg("circle", { class: "grid round", cx: u, cy: v, r: SIZE / 2 - MARGIN }),
        svg("line", { class: "zero", x1: MARGIN, x2: SIZE - MARGIN, y1: v, y2: v }),
        svg("line", { class: "zero", y1: MARGIN, y2: SIZE - MARGIN, x1: u, x2: u }),
        svg("text", { class: "tick", x: SIZE - 4, y: v - 5, "text-anchor": "end" }, "x"),
        svg("text", { class: "tick", x: u + 6, y: 14 }, "y"),
        svg(
          "text",
          { class: "tick", x: 6, y: SIZE - 8 },
          t`Circle: ${shown(Number(peak.toPrecision(3)))} ${unit}`.trim(),
        ),
        svg("path", { class: "series s0", d: this.view.path(points) }),
        this.ray,
        this.dot,
      ),
    );
  }

  /** @param {number | null} at a place of the series @param {boolean} told whether its numbers are told */
  show(at, told) {
    const [x, y] = at === null ? [null, null] : [between(this.x, at), between(this.y, at)];
    const known = x !== null && y !== null;
    this.ray.toggleAttribute("hidden", !known);
    this.dot.toggleAttribute("hidden", !known);
    if (told)
      this.reading.textContent = known
        ? `x ${shown(Number(x.toPrecision(3)))}, y ${shown(Number(y.toPrecision(3)))} ${this.unit}`
        : "–";
    if (!known) return;
    const [u, v] = this.view.at(x, y);
    for (const [name, value] of Object.entries({ x2: u, y2: v })) this.ray.setAttribute(name, String(value));
    for (const [name, value] of Object.entries({ cx: u, cy: v })) this.dot.setAttribute(name, String(value));
  }
}
