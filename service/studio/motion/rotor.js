/** A rotor that turns: its planes of correction with their masses, and the forces on its bearings beside it. */

import { el, shown, svg } from "../core/dom.js";
import { beside, nothing } from "../design/design_metrics.js";
import { t } from "../core/messages.js";
import { scene } from "../canvas/stage.js";
import { Turning } from "./rotary_view.js";
import { symbolOf } from "../core/units.js";
import { View } from "../core/view.js";

/** @import { Problem, Schemas } from "../types/values.js" */

/** From one face to the next, in radii of a face. */
const APART = 2.4;

/** @typedef {[number, number]} Point */

export class Rotor extends Turning {
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
    const side = (APART * (count - 1)) / 2 + 1;
    const corners = /** @type {Point[]} */ ([
      [-side, -1.3],
      [side, 1],
    ]);
    this.view = new View(corners, ...this.size, 32);
    this.faces = mechanism.planes.map((/** @type {number} */ z, /** @type {number} */ n) =>
      this.face(mechanism, n, APART * (n - (count - 1) / 2), `z ${shown(z)} ${problem.length_unit}`),
    );
    const names = [t`Before`, t`After`];
    const facts = (metrics.bearings ?? []).flatMap((bearing) =>
      [bearing.before, nothing(bearing.after, bearing.before) ? 0 : bearing.after].flatMap((force, k) => [
        el("dt", {}, `${names[k]}, ${t`bearing at ${shown(bearing.z)} ${problem.length_unit}`}`),
        el("dd", {}, beside(shown(Number(force.toPrecision(4))), symbolOf("force", problem))),
      ]),
    );
    const lines = Object.fromEntries(
      motion.bearings.map((bearing, /** @type {number} */ n) => [t`bearing ${n + 1}`, bearing.force.x]),
    );
    // By what there was is measured whether anything is left, at the speed of the motion.
    const speed = (Number(problem.rpm) * Math.PI) / 30;
    const least = Math.max(...(metrics.bearings ?? []).map((one) => one.before / speed ** 2), 1e-9);
    const unit = symbolOf("force", problem);
    const title = t`Force on the bearings at 1 rad/s, along x`;
    this.fill(
      scene(
        this.view,
        t`The planes of correction, turning with the rotor`,
        this.faces.map((one) => one.node),
      ),
      [
        el("dl", { class: "facts" }, ...facts),
        el("p", { class: "note" }, t`Filled: masses that are added. Open: masses that are taken away.`),
      ],
      motion.bearings.length ? [{ title: unit ? `${title} (${unit})` : title, lines, least }] : [],
    );
  }

  /** @param {Schemas["RotorMechanism"]} mechanism @param {number} plane @param {number} x @param {string} name */
  face(mechanism, plane, x, name) {
    const { view } = this;
    const [u, v] = view.at(x, 0);
    const rim = view.scale;
    const all = mechanism.corrections;
    const reach = Math.max(...all.map((one) => one.radius ?? one.unbalance), 1e-300);
    const heaviest = Math.max(...all.map((one) => one.unbalance), 1e-300);
    const marks = all
      .filter((one) => one.plane === plane)
      .map((one) => {
        const far = (0.85 * rim * (one.radius ?? one.unbalance)) / reach;
        const angle = (one.angle * Math.PI) / 180;
        return svg("circle", {
          class: one.removed ? "tyre" : "added",
          cx: u + far * Math.cos(angle),
          cy: v - far * Math.sin(angle),
          r: 3 + 8 * Math.sqrt(one.unbalance / heaviest),
        });
      });
    const turning = svg("g", {}, svg("line", { class: "arm", x1: u, y1: v, x2: u + rim, y2: v }), ...marks);
    const node = svg(
      "g",
      {},
      svg("circle", { class: "link", cx: u, cy: v, r: rim }),
      turning,
      svg("circle", { class: "pin", cx: u, cy: v, r: 3.5 }),
      svg("text", { class: "called", x: u, y: view.at(x, -1.2)[1] }, name),
    );
    return { node, turning, u, v };
  }

  /** @param {number} at */
  show(at) {
    for (const { turning, u, v } of this.faces)
      turning.setAttribute("transform", `rotate(${-this.over(this.angles, at)} ${u} ${v})`);
  }
}
