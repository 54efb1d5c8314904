/** A piston engine that turns: its cylinders side by side, each seen along the shaft with its own axis upwards. */

import { el, shown, svg } from "../core/dom.js";
import { t } from "../core/messages.js";
import { between } from "../core/player.js";
import { scene } from "../canvas/stage.js";
import { Turning } from "./rotary_view.js";
import { View } from "../core/view.js";

/** @import { Problem, Schemas } from "../types/values.js" */

/** From one cylinder to the next, and the bore, in radii of the crank. */
const COLUMN = 2.5;
const BORE = 1.5;

/** How high a piston is, and how far the bore goes on above it at the top, in radii of the crank. */
const PISTON = 0.6;
const HEAD = 0.4;

/** From the crank at its lowest to the foot of a cylinder's number, pixels: a pin is between them. */
const CALLED = 22;

/** @typedef {[number, number]} Point */
/** @typedef {Schemas["EngineDesign"]["mechanism"]["cylinders"][number]} Cylinder */

export class Engine extends Turning {
  /**
   * @param {import("../canvas/stage.js").Frame} frame
   * @param {Schemas["EngineDesign"]} design
   * @param {Schemas["EngineAnalysis"]} motion
   * @param {Problem} problem
   */
  constructor(frame, design, motion, problem) {
    super(frame, t`Crank`, motion.input_angle, { endless: true });
    const { crank, rod, cylinders } = design.mechanism;
    this.motion = motion;
    this.crank = crank;
    const side = ((COLUMN * (cylinders.length - 1) + 2) * crank) / 2;
    const corners = /** @type {Point[]} */ ([
      [-side, -1.5 * crank],
      [side, rod + (1 + PISTON / 2 + HEAD) * crank],
    ]);
    this.view = new View(corners, ...this.size, 32);
    this.drawings = cylinders.map((cylinder, /** @type {number} */ n) =>
      this.column(cylinder, COLUMN * crank * (n - (cylinders.length - 1) / 2), rod),
    );
    const picture = scene(
      this.view,
      t`The cylinders, turning`,
      this.drawings.map((one) => one.node),
    );
    const fires = design.firing.orders[0];
    this.fill(
      picture,
      [
        el(
          "dl",
          { class: "facts speeds" },
          el("dt", {}, t`Firing order`),
          el("dd", {}, fires.order.join("-")),
          ...fires.order.flatMap((/** @type {number} */ number, /** @type {number} */ k) => [
            el("dt", {}, t`Cylinder ${number}`),
            el("dd", {}, `${shown(fires.angles[k])}°`),
          ]),
        ),
        el(
          "p",
          { class: "note" },
          t`The cylinders from the front to the back; each is seen with its own axis upwards.`,
        ),
      ],
      this.plotted(problem.length_unit ?? "mm"),
    );
  }

  /** How the piston of the first cylinder moves; the others move as it does, later. @param {string} unit */
  plotted(unit) {
    const { place, velocity, acceleration } = this.motion.cylinders[0];
    return [
      { title: t`Piston 1 above the crank (${unit})`, lines: { "": place } },
      { title: t`Velocity of piston 1 (${unit}/rad)`, lines: { "": velocity }, least: this.crank },
      { title: t`Acceleration of piston 1 (${unit}/rad²)`, lines: { "": acceleration }, least: this.crank },
    ];
  }

  /** @param {Cylinder} cylinder @param {number} x @param {number} rod */
  column(cylinder, x, rod) {
    const { view, crank: radius } = this;
    const half = (BORE / 2) * radius;
    const [u, v] = view.at(x, 0);
    const [left, top] = view.at(x - half, rod + (1 + PISTON / 2 + HEAD) * radius);
    const foot = view.at(x, rod - (1 + PISTON / 2) * radius)[1];
    const right = 2 * u - left;
    const [crank, link] = [svg("path", { class: "link input" }), svg("path", { class: "link" })];
    const piston = svg("rect", { class: "pin", x: left, width: right - left, height: view.scale * PISTON * radius });
    const pins = [0, 1].map(() => svg("circle", { class: "pin", r: 3.5 }));
    const node = svg(
      "g",
      {},
      svg("title", {}, t`Cylinder ${cylinder.number}`),
      svg("path", { class: "bore", d: `M${left} ${foot}V${top}H${right}V${foot}` }),
      piston,
      link,
      crank,
      ...pins,
      svg("circle", { class: "pin", cx: u, cy: v, r: 3.5 }),
      svg("text", { class: "called", x: u, y: view.at(x, -radius)[1] + CALLED }, cylinder.number),
    );
    return { cylinder, x, node, crank, link, piston, pins };
  }

  /** @param {number} at */
  show(at) {
    const { view } = this;
    const input = this.over(this.angles, at);
    this.drawings.forEach(({ cylinder, x, crank, link, piston, pins }, /** @type {number} */ n) => {
      // Upwards is the cylinder's axis; to the left of it is left.
      const turn = ((input - cylinder.phase - cylinder.axis) * Math.PI) / 180;
      const throwAt = /** @type {Point} */ ([x - this.crank * Math.sin(turn), this.crank * Math.cos(turn)]);
      const high = /** @type {Point} */ ([x, Number(between(this.motion.cylinders[n].place, this.within(at)))]);
      crank.setAttribute("d", view.path([[x, 0], throwAt]));
      link.setAttribute("d", view.path([throwAt, high]));
      piston.setAttribute("y", view.at(x, high[1] + (PISTON / 2) * this.crank)[1].toFixed(2));
      pins.forEach((pin, k) => {
        const [u, v] = view.at(...(k ? high : throwAt));
        pin.setAttribute("cx", u.toFixed(2));
        pin.setAttribute("cy", v.toFixed(2));
      });
    });
  }
}
