/** Animate a rotor: correction planes with masses, and bearing forces. */

import { createElement, formatNumber, createSvg } from "../core/dom.js";
import { joinUnit, isRounding } from "../design/design_metrics.js";
import { t } from "../core/messages.js";
import { createScene } from "../canvas/stage.js";
import { RotaryView } from "./rotary_view.js";
import { unitSymbol } from "../core/units.js";
import { View } from "../core/view.js";

/** @import { Problem, Schemas } from "../types/values.js" */

/** From one face to the next, in radii of a face. */
const FACE_SPACING = 2.4;

/** @typedef {[number, number]} Point */

export class RotorView extends RotaryView {
  /**
   * @param {import("../canvas/stage.js").Frame} frame
   * @param {Schemas["RotorDesign"]} design
   * @param {Schemas["RotorAnalysis"]} motion
   * @param {Problem} problem
   */
  constructor(frame, design, motion, problem) {
    super(frame, t`Rotor`, motion.input_angle);
    const { mechanism, metrics } = design;
    const count = mechanism.planes.length;
    const side = (FACE_SPACING * (count - 1)) / 2 + 1;
    const corners = /** @type {Point[]} */ ([
      [-side, -1.3],
      [side, 1],
    ]);
    this.view = new View(corners, ...this.size, 32);
    this.faces = mechanism.planes.map((/** @type {number} */ z, /** @type {number} */ n) =>
      this.createFace(
        mechanism,
        n,
        FACE_SPACING * (n - (count - 1) / 2),
        `z ${formatNumber(z)} ${problem.length_unit}`,
      ),
    );
    const names = [t`Before`, t`After`];
    const facts = (metrics.bearings ?? []).flatMap((bearing) =>
      [bearing.before, isRounding(bearing.after, bearing.before) ? 0 : bearing.after].flatMap((force, k) => [
        createElement("dt", {}, `${names[k]}, ${t`bearing at ${formatNumber(bearing.z)} ${problem.length_unit}`}`),
        createElement("dd", {}, joinUnit(formatNumber(Number(force.toPrecision(4))), unitSymbol("force", problem))),
      ]),
    );
    const lines = Object.fromEntries(
      motion.bearings.map((bearing, /** @type {number} */ n) => [t`bearing ${n + 1}`, bearing.force.x]),
    );
    // By what there was is measured whether anything is left, at the speed of the motion.
    const speed = (Number(problem.rpm) * Math.PI) / 30;
    const least = Math.max(...(metrics.bearings ?? []).map((one) => one.before / speed ** 2), 1e-9);
    const unit = unitSymbol("force", problem);
    const title = t`Force on the bearings at 1 rad/s, along x`;
    this.fill(
      createScene(
        this.view,
        t`The planes of correction, turning with the rotor`,
        this.faces.map((one) => one.node),
      ),
      [
        createElement("dl", { class: "facts" }, ...facts),
        createElement("p", { class: "note" }, t`Filled: added masses. Open: removed masses.`),
      ],
      motion.bearings.length ? [{ title: unit ? `${title} (${unit})` : title, lines, least }] : [],
    );
  }

  /** @param {Schemas["RotorMechanism"]} mechanism @param {number} plane @param {number} x @param {string} name */
  createFace(mechanism, plane, x, name) {
    const { view } = this;
    const [u, v] = view.toPicture(x, 0);
    const rim = view.scale;
    const all = mechanism.corrections;
    const reach = Math.max(...all.map((one) => one.radius ?? one.unbalance), 1e-300);
    const heaviest = Math.max(...all.map((one) => one.unbalance), 1e-300);
    const marks = all
      .filter((one) => one.plane === plane)
      .map((one) => {
        const far = (0.85 * rim * (one.radius ?? one.unbalance)) / reach;
        const angle = (one.angle * Math.PI) / 180;
        return createSvg("circle", {
          class: one.removed ? "tyre" : "added",
          cx: u + far * Math.cos(angle),
          cy: v - far * Math.sin(angle),
          r: 3 + 8 * Math.sqrt(one.unbalance / heaviest),
        });
      });
    const turning = createSvg("g", {}, createSvg("line", { class: "arm", x1: u, y1: v, x2: u + rim, y2: v }), ...marks);
    const node = createSvg(
      "g",
      {},
      createSvg("circle", { class: "link", cx: u, cy: v, r: rim }),
      turning,
      createSvg("circle", { class: "pin", cx: u, cy: v, r: 3.5 }),
      createSvg("text", { class: "called", x: u, y: view.toPicture(x, -1.2)[1] }, name),
    );
    return { node, turning, u, v };
  }

  /** @param {number} at */
  show(at) {
    for (const { turning, u, v } of this.faces)
      turning.setAttribute("transform", `rotate(${-this.interpolateSeries(this.angles, at)} ${u} ${v})`);
  }
}
