/** A ruler on a picture: two draggable ends with their distance and direction. */

import { createElement, formatNumber, createSvg } from "../core/dom.js";
import { formatBriefly } from "../design/design_metrics.js";
import { Grip, moveWithKeys, dragWithPointer } from "./grip.js";
import { t } from "../core/messages.js";

/** @typedef {[number, number]} Point */

/** Distance at which an end snaps to a target, pixels. */
const CATCH_DISTANCE = 10;

export class Ruler {
  /**
   * @param {SVGSVGElement} picture @param {import("../core/view.js").View} view @param {string} unit of lengths
   * @param {() => Point[]} points what the ends are caught by
   * @param {{ends: [Point, Point] | null}} memory outlives a picture that is made anew
   */
  constructor(picture, view, unit, points, memory = { ends: null }) {
    this.picture = picture;
    this.view = view;
    this.unit = unit;
    this.points = points;
    this.memory = memory;
    this.line = createSvg("line", { class: "ruler-line" });
    this.text = createSvg("text", { class: "ruler-text", "text-anchor": "middle" });
    this.title = createSvg("title");
    this.grips = [0, 1].map((k) => this.createGrip(k));
    this.node = createSvg(
      "g",
      { class: "ruler" },
      this.line,
      createSvg("g", {}, this.title, this.text),
      ...this.grips.map((one) => one.node),
    );
    this.button = createElement(
      "button",
      {
        type: "button",
        class: "small",
        "aria-pressed": "false",
        title: t`Ruler: drag its ends (R)`,
        "data-tool": "ruler",
        onclick: () => this.toggle(),
      },
      t`Ruler`,
    );
    this.show();
  }

  /** Show or hide the ruler. */
  toggle() {
    const [width, height] = [this.view.width / this.view.scale, this.view.height / this.view.scale];
    const [x, y] = this.view.middle;
    this.memory.ends = this.memory.ends
      ? null
      : [
          this.snapToTarget([x - 0.2 * width, y - 0.2 * height]),
          this.snapToTarget([x + 0.2 * width, y - 0.2 * height]),
        ];
    this.show();
    if (this.memory.ends) this.grips[1].node.focus({ preventScroll: true });
  }

  /** @param {number} k */
  createGrip(k) {
    const grip = new Grip({ kind: "grip", dot: "ruler-end", radius: 5, key: `ruler${k}` });
    grip.setLabel(t`End ${k + 1} of the ruler`);
    const put = (/** @type {Point} */ at) => {
      if (this.memory.ends) this.memory.ends[k] = at;
      this.show();
    };
    dragWithPointer(grip.node, this.picture, this.view, { led: (at) => put(this.snapToTarget(at)) });
    moveWithKeys(grip.node, this.view, {
      moved: ([dx, dy]) => {
        const end = this.memory.ends?.[k];
        if (end) put([this.view.roundToPixel(end[0] + dx), this.view.roundToPixel(end[1] + dy)]);
      },
      removed: () => {
        this.toggle();
        this.button.focus();
      },
    });
    return grip;
  }

  /** Return the target near a point, or else the point itself. @param {Point} place @returns {Point} */
  snapToTarget(place) {
    const far = (/** @type {Point} */ [x, y]) => this.view.scale * Math.hypot(x - place[0], y - place[1]);
    const near = this.points()
      .filter((one) => far(one) < CATCH_DISTANCE)
      .sort((one, other) => far(one) - far(other))[0];
    return near ? [...near] : [this.view.roundToPixel(place[0]), this.view.roundToPixel(place[1])];
  }

  show() {
    const { ends } = this.memory;
    this.button.setAttribute("aria-pressed", String(Boolean(ends)));
    if (!ends) return this.node.remove();
    // Append it once; moving the element during a drag would release the pointer.
    if (!this.node.parentNode) this.picture.append(this.node);
    const [[x, y], [u, v]] = ends.map((end) => this.view.toPicture(...end));
    for (const [name, value] of Object.entries({ x1: x, y1: y, x2: u, y2: v }))
      this.line.setAttribute(name, String(value));
    const [dx, dy] = [ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]];
    const [length, angle] = [Math.hypot(dx, dy), (Math.atan2(dy, dx) * 180) / Math.PI];
    const unit = this.unit && ` ${this.unit}`;
    this.text.textContent = `${formatBriefly(length)}${unit}, ${formatBriefly(Number(angle.toFixed(1)))}°`;
    this.title.textContent = t`${length}${unit}, ${angle}°; across ${dx}${unit}, up ${dy}${unit}`;
    this.text.setAttribute("x", String((x + u) / 2));
    this.text.setAttribute("y", String((y + v) / 2 - 9));
    const keys = t`it measures ${this.text.textContent}. Arrow keys move it, Delete removes the ruler.`;
    this.grips.forEach((grip, k) => {
      const [ex, ey] = ends[k];
      grip.moveTo(this.view.toPicture(ex, ey));
      grip.setLabel(`${t`End ${k + 1} of the ruler`}: x ${formatNumber(ex)}, y ${formatNumber(ey)}; ${keys}`);
    });
  }
}
