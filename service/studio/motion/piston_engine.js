/** Animate a piston engine: cylinders side by side, each with its own axis upwards. */

import { createElement, formatNumber, createSvg } from "../core/dom.js";
import { t } from "../core/messages.js";
import { interpolate } from "../core/player.js";
import { createScene } from "../canvas/stage.js";
import { RotaryView } from "./rotary_view.js";
import { View } from "../core/view.js";

/** @import { Problem, Schemas } from "../types/values.js" */

/** From one cylinder to the next, and the bore, in radii of the crank. */
const COLUMN_WIDTH = 2.5;
const BORE_WIDTH = 1.5;

/** How high a piston is, and how far the bore goes on above it at the top, in radii of the crank. */
const PISTON_HEIGHT = 0.6;
const HEAD_CLEARANCE = 0.4;

/** Distance from the lowest crank to the number of a cylinder, pixels. */
const NUMBER_OFFSET = 22;

/** @typedef {[number, number]} Point */
/** @typedef {Schemas["EngineDesign"]["mechanism"]["cylinders"][number]} Cylinder */

export class PistonEngineView extends RotaryView {
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
    const side = ((COLUMN_WIDTH * (cylinders.length - 1) + 2) * crank) / 2;
    const corners = /** @type {Point[]} */ ([
      [-side, -1.5 * crank],
      [side, rod + (1 + PISTON_HEIGHT / 2 + HEAD_CLEARANCE) * crank],
    ]);
    this.view = new View(corners, ...this.size, 32);
    this.drawings = cylinders.map((cylinder, /** @type {number} */ n) =>
      this.createColumn(cylinder, COLUMN_WIDTH * crank * (n - (cylinders.length - 1) / 2), rod),
    );
    const picture = createScene(
      this.view,
      t`The cylinders, turning`,
      this.drawings.map((one) => one.node),
    );
    const fires = design.firing.orders[0];
    this.fill(
      picture,
      [
        createElement(
          "dl",
          { class: "facts speeds" },
          createElement("dt", {}, t`Firing order`),
          createElement("dd", {}, fires.order.join("-")),
          ...fires.order.flatMap((/** @type {number} */ number, /** @type {number} */ k) => [
            createElement("dt", {}, t`Cylinder ${number}`),
            createElement("dd", {}, `${formatNumber(fires.angles[k])}°`),
          ]),
        ),
        createElement("p", { class: "note" }, t`The cylinders from front to back, each with its own axis upwards.`),
      ],
      this.listPlots(problem.length_unit ?? "mm"),
    );
  }

  /** How the piston of the first cylinder moves; the others move as it does, later. @param {string} unit */
  listPlots(unit) {
    const { place, velocity, acceleration } = this.motion.cylinders[0];
    return [
      { title: t`Piston 1 above the crank (${unit})`, lines: { "": place } },
      { title: t`Velocity of piston 1 (${unit}/rad)`, lines: { "": velocity }, least: this.crank },
      { title: t`Acceleration of piston 1 (${unit}/rad²)`, lines: { "": acceleration }, least: this.crank },
    ];
  }

  /** @param {Cylinder} cylinder @param {number} x @param {number} rod */
  createColumn(cylinder, x, rod) {
    const { view, crank: radius } = this;
    const half = (BORE_WIDTH / 2) * radius;
    const [u, v] = view.toPicture(x, 0);
    const [left, top] = view.toPicture(x - half, rod + (1 + PISTON_HEIGHT / 2 + HEAD_CLEARANCE) * radius);
    const foot = view.toPicture(x, rod - (1 + PISTON_HEIGHT / 2) * radius)[1];
    const right = 2 * u - left;
    const [crank, link] = [createSvg("path", { class: "link input" }), createSvg("path", { class: "link" })];
    const piston = createSvg("rect", {
      class: "pin",
      x: left,
      width: right - left,
      height: view.scale * PISTON_HEIGHT * radius,
    });
    const pins = [0, 1].map(() => createSvg("circle", { class: "pin", r: 3.5 }));
    const node = createSvg(
      "g",
      {},
      createSvg("title", {}, t`Cylinder ${cylinder.number}`),
      createSvg("path", { class: "bore", d: `M${left} ${foot}V${top}H${right}V${foot}` }),
      piston,
      link,
      crank,
      ...pins,
      createSvg("circle", { class: "pin", cx: u, cy: v, r: 3.5 }),
      createSvg("text", { class: "called", x: u, y: view.toPicture(x, -radius)[1] + NUMBER_OFFSET }, cylinder.number),
    );
    return { cylinder, x, node, crank, link, piston, pins };
  }

  /** @param {number} at */
  show(at) {
    const { view } = this;
    const input = this.interpolateSeries(this.angles, at);
    this.drawings.forEach(({ cylinder, x, crank, link, piston, pins }, /** @type {number} */ n) => {
      // Upwards is the cylinder's axis; to the left of it is left.
      const turn = ((input - cylinder.phase - cylinder.axis) * Math.PI) / 180;
      const throwAt = /** @type {Point} */ ([x - this.crank * Math.sin(turn), this.crank * Math.cos(turn)]);
      const high = /** @type {Point} */ ([
        x,
        Number(interpolate(this.motion.cylinders[n].place, this.clampPosition(at))),
      ]);
      crank.setAttribute("d", view.pathData([[x, 0], throwAt]));
      link.setAttribute("d", view.pathData([throwAt, high]));
      piston.setAttribute("y", view.toPicture(x, high[1] + (PISTON_HEIGHT / 2) * this.crank)[1].toFixed(2));
      pins.forEach((pin, k) => {
        const [u, v] = view.toPicture(...(k ? high : throwAt));
        pin.setAttribute("cx", u.toFixed(2));
        pin.setAttribute("cy", v.toFixed(2));
      });
    });
  }
}
