/** A piston engine that turns: its cylinders side by side, each seen along the shaft with its own axis upwards. */

import { el, shown, svg } from "./dom.js";
import { t } from "./messages.js";
import { Player, between } from "./player.js";

/** @import { Schemas } from "./types/values.js" */

/** Room above and below, pixels. */
const EDGE = 24;

export class Engine {
  /**
   * @param {import("./stage.js").Frame} frame
   * @param {Schemas["EngineDesign"]} design
   * @param {Schemas["EngineAnalysis"]} motion
   */
  constructor(frame, design, motion) {
    const [width, height] = frame.size();
    const { mechanism } = design;
    this.motion = motion;
    this.crank = mechanism.crank;
    const count = mechanism.cylinders.length;
    const column = width / count;
    /** Pixels for a length unit. */
    this.scale = Math.min((height - 2 * EDGE) / (mechanism.rod + 2.8 * this.crank), (0.9 * column) / (2 * this.crank));
    // A single cylinder stands in the middle, and not at the top.
    const top = Math.max(EDGE, 0.5 * (height - this.scale * (mechanism.rod + 2.8 * this.crank)));
    this.low = top + this.scale * (mechanism.rod + 1.7 * this.crank);
    this.picture = svg(
      "svg",
      { viewBox: `0 0 ${width} ${height}`, class: "canvas", role: "img", "aria-label": t`The cylinders, turning` },
      svg("rect", { class: "paper", width, height }),
    );
    this.drawings = mechanism.cylinders.map((cylinder, /** @type {number} */ n) => {
      const middle = column * (n + 0.5);
      const half = 0.75 * this.scale * this.crank;
      const crank = svg("path", { class: "link input" });
      const rod = svg("path", { class: "link" });
      const piston = svg("rect", {
        class: "pin",
        x: middle - half,
        width: 2 * half,
        height: 0.6 * this.scale * this.crank,
      });
      const foot = this.low - this.scale * (mechanism.rod - this.crank);
      const walls = svg("path", {
        class: "ground",
        d: [middle - half, middle + half].map((wall) => `M${wall} ${top}V${foot}`).join(""),
      });
      this.picture.append(
        svg(
          "g",
          {},
          svg("title", {}, t`Cylinder ${cylinder.number}`),
          walls,
          rod,
          crank,
          piston,
          svg("circle", { class: "pin", cx: middle, cy: this.low, r: 3.5 }),
        ),
      );
      return { cylinder, middle, crank, rod, piston };
    });
    const fires = design.firing.orders[0];
    this.player = new Player({
      count: motion.input_angle.length,
      closed: true,
      endless: true,
      label: t`Crank`,
      reading: (at) => `${shown(Math.round(10 * this.degrees(at)) / 10)}°`,
      show: (at) => this.show(at),
    });
    frame.fill({
      picture: this.picture,
      clock: this.player.row,
      beside: [
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
    });
    this.player.begin();
  }

  /** Crank angle, which goes on turn after turn. @param {number} at */
  degrees(at) {
    const last = this.motion.input_angle.length - 1;
    const turns = Math.floor(at / last);
    return 360 * turns + Number(between(this.motion.input_angle, at - turns * last));
  }

  /** @param {number} at */
  show(at) {
    const last = this.motion.input_angle.length - 1;
    const within = at - last * Math.floor(at / last);
    const input = this.degrees(at);
    this.drawings.forEach(({ cylinder, middle, crank, rod, piston }, /** @type {number} */ n) => {
      // Upwards is the cylinder's axis; to the left of it is left.
      const turn = ((input - cylinder.phase - cylinder.axis) * Math.PI) / 180;
      const [u, v] = [
        middle - this.scale * this.crank * Math.sin(turn),
        this.low - this.scale * this.crank * Math.cos(turn),
      ];
      const top = this.low - this.scale * Number(between(this.motion.cylinders[n].place, within));
      crank.setAttribute("d", `M${middle} ${this.low}L${u.toFixed(2)} ${v.toFixed(2)}`);
      rod.setAttribute("d", `M${u.toFixed(2)} ${v.toFixed(2)}L${middle} ${top.toFixed(2)}`);
      piston.setAttribute("y", (top - 0.3 * this.scale * this.crank).toFixed(2));
    });
  }

  stop() {
    this.player.stop();
  }
}
