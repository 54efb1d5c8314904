/** A rotor that turns: its planes of correction with their masses, and the forces on its bearings beside it. */

import { el, shown, svg } from "./dom.js";
import { t } from "./messages.js";
import { Player, between } from "./player.js";
import { plots } from "./plots.js";
import { symbolOf } from "./units.js";

/** @import { Problem, Schemas } from "./types/values.js" */

/** Radius of a face as a share of the room that it has. */
const RIM = 0.4;

export class Rotor {
  /**
   * @param {import("./stage.js").Frame} frame
   * @param {Schemas["RotorDesign"]} design
   * @param {Schemas["RotorAnalysis"]} motion
   * @param {Problem} problem
   */
  constructor(frame, design, motion, problem) {
    this.size = frame.size();
    const [width, height] = this.size;
    const { mechanism, metrics } = design;
    this.motion = motion;
    this.player = new Player({
      count: motion.input_angle.length,
      closed: true,
      label: t`Rotor`,
      reading: (at) => `${shown(Math.round(10 * this.degrees(at)) / 10)}°`,
      show: (at) => this.show(at),
    });
    this.faces = mechanism.planes.map((/** @type {number} */ _z, /** @type {number} */ n) => this.face(mechanism, n));
    const names = [t`Before`, t`After`];
    const facts = (metrics.bearings ?? []).flatMap((bearing) =>
      [bearing.before, bearing.after].flatMap((force, k) => [
        el("dt", {}, `${names[k]}, ${t`bearing at ${shown(bearing.z)} ${problem.length_unit}`}`),
        el("dd", {}, `${shown(Number(force.toPrecision(4)))} ${symbolOf("force", problem)}`),
      ]),
    );
    const picture = svg(
      "svg",
      {
        viewBox: `0 0 ${width} ${height}`,
        class: "canvas",
        role: "img",
        "aria-label": t`The planes of correction, turning with the rotor`,
      },
      svg("rect", { class: "paper", width, height }),
      ...this.faces.map((one) => one.node),
    );
    const lines = Object.fromEntries(
      motion.bearings.map((bearing, /** @type {number} */ n) => [t`bearing ${n + 1}`, bearing.force.x]),
    );
    this.marks = motion.bearings.length
      ? plots([{ title: t`Force on the bearings at 1 rad/s, along x`, lines, least: 1e-9 }], motion.input_angle, (at) =>
          this.player.lead(at),
        )
      : [];
    frame.fill({
      picture,
      clock: this.player.row,
      beside: [
        el("dl", { class: "facts" }, ...facts),
        el("p", { class: "note" }, t`Filled: masses that are added. Open: masses that are taken away.`),
      ],
      plots: [el("div", { class: "plots" }, ...this.marks.map((mark) => mark.figure))],
    });
    this.player.begin();
  }

  /** @param {Schemas["RotorMechanism"]} mechanism @param {number} plane */
  face(mechanism, plane) {
    const [width, height] = this.size;
    const room = width / mechanism.planes.length;
    const [u, v, rim] = [room * (plane + 0.5), height / 2, RIM * Math.min(room, height)];
    const all = mechanism.corrections;
    const reach = Math.max(...all.map((one) => one.radius ?? one.unbalance), 1e-300);
    const heaviest = Math.max(...all.map((one) => one.unbalance), 1e-300);
    const marks = all
      .filter((one) => one.plane === plane)
      .map((one) => {
        const far = (0.85 * rim * (one.radius ?? one.unbalance)) / reach;
        const angle = (one.angle * Math.PI) / 180;
        return svg("circle", {
          class: one.removed ? "tyre" : "pin",
          cx: u + far * Math.cos(angle),
          cy: v - far * Math.sin(angle),
          r: 3 + 8 * Math.sqrt(one.unbalance / heaviest),
        });
      });
    const turning = svg("g", {}, svg("line", { class: "arm", x1: u, y1: v, x2: u + rim, y2: v }), ...marks);
    return { node: svg("g", {}, svg("circle", { class: "link", cx: u, cy: v, r: rim }), turning), turning, u, v };
  }

  /** @param {number} at */
  degrees(at) {
    return Number(between(this.motion.input_angle, at));
  }

  /** @param {number} at */
  show(at) {
    for (const { turning, u, v } of this.faces)
      turning.setAttribute("transform", `rotate(${-this.degrees(at)} ${u} ${v})`);
    for (const mark of this.marks) mark.show(at);
  }

  pause() {
    this.player.stop();
  }

  stop() {
    this.player.stop();
  }
}
