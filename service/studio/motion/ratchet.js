/** Animate a ratchet wheel under its pawls. */

import { createElement, createSvg } from "../core/dom.js";
import { t } from "../core/messages.js";
import { interpolate } from "../core/player.js";
import { createScene } from "../canvas/stage.js";
import { RotaryView } from "./rotary_view.js";
import { View } from "../core/view.js";

/** @import { Schemas } from "../types/values.js" */

/** @typedef {[number, number]} Point */

export class RatchetView extends RotaryView {
  /**
   * @param {import("../canvas/stage.js").Frame} frame
   * @param {Schemas["RatchetDesign"]} design
   * @param {Schemas["RatchetAnalysis"]} motion
   */
  constructor(frame, design, motion) {
    super(frame, t`Wheel`, motion.input_angle);
    const { mechanism } = design;
    this.motion = motion;
    const teeth = /** @type {Point[]} */ (
      mechanism.profile.x.map((/** @type {number} */ x, /** @type {number} */ k) => [x, mechanism.profile.y[k]])
    );
    const radius = mechanism.wheel_radius;
    const pivots = mechanism.pawls.map((pawl) => pawl.pivot);
    const view = new View([[-radius, -radius], [radius, radius], ...pivots], ...this.size, 40);
    this.axis = view.toPicture(0, 0);
    this.wheel = createSvg("path", { class: "teeth", d: `${view.pathData(teeth)}Z` });
    this.pawls = mechanism.pawls.map((pawl) => {
      const [u, v] = view.toPicture(pawl.pivot[0], pawl.pivot[1]);
      return {
        at: [u, v],
        bar: createSvg("path", {
          class: "link",
          d: view.pathData([pawl.pivot, noseAtHeight(pawl, mechanism.tooth_height), pawl.nose]),
        }),
      };
    });
    const picture = createScene(view, t`The ratchet, turning`, [
      createSvg("g", { class: "wheel t0" }, this.wheel),
      ...this.pawls.map((pawl) => pawl.bar),
      ...[this.axis, ...this.pawls.map((pawl) => pawl.at)].map(([cx, cy]) =>
        createSvg("circle", { class: "pin", cx, cy, r: 3.5 }),
      ),
    ]);
    const lifts = Object.fromEntries(
      motion.pawls.map((pawl, /** @type {number} */ k) => [motion.pawls.length > 1 ? `${k + 1}` : "", pawl.lift]),
    );
    this.fill(
      picture,
      [
        createElement(
          "p",
          { class: "note" },
          t`The wheel advances; the pawl stops it from turning back past the next stop.`,
        ),
      ],
      [{ title: t`Lift of pawls (°)`, lines: lifts }],
    );
  }

  /** @param {number} at */
  show(at) {
    const [u, v] = this.axis;
    this.wheel.setAttribute(
      "transform",
      `rotate(${(-Number(interpolate(this.motion.input_angle, at))).toFixed(3)} ${u.toFixed(2)} ${v.toFixed(2)})`,
    );
    this.pawls.forEach((pawl, /** @type {number} */ k) => {
      const lift = Number(interpolate(this.motion.pawls[k].lift, at));
      pawl.bar.setAttribute(
        "transform",
        `rotate(${lift.toFixed(3)} ${pawl.at[0].toFixed(2)} ${pawl.at[1].toFixed(2)})`,
      );
    });
  }
}

/**
 * Where a pawl turns down to its nose, above the tips.
 * @param {Schemas["Pawl"]} pawl
 * @param {number} height
 * @returns {Point}
 */
function noseAtHeight({ nose: [x, y] }, height) {
  const share = 1 + (1.9 * height) / Math.hypot(x, y);
  return [share * x, share * y];
}
