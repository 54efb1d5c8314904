/** Animate gears with their pitch circles and teeth; gearboxes in the engaged gear. */

import * as api from "../core/api.js";
import { createElement, formatNumber, createSvg, toWords } from "../core/dom.js";
import { t, term } from "../core/messages.js";
import { createScene } from "../canvas/stage.js";
import { layOutWheels } from "./train_layout.js";
import { RotaryView } from "./rotary_view.js";
import { View } from "../core/view.js";
import { createWheel, placeWheel, pitchRadius } from "./toothed_wheels.js";

/** @import { Design, Merged, Problem, Schemas, TrainMotion } from "../types/values.js" */

export class GearsView extends RotaryView {
  /**
   * @param {import("../canvas/stage.js").Frame} frame
   * @param {Design} design
   * @param {TrainMotion} motion
   * @param {Problem} problem
   */
  constructor(frame, design, motion, problem) {
    super(frame, t`Input`, motion.input_angle, { endless: true });
    this.design = design;
    this.problem = problem;
    /** @type {Merged<TrainMotion>} */
    this.motion = motion;
    this.gone = new AbortController();
    this.facts = createElement("dl", { class: "facts speeds" });
    this.view = new View([], ...this.size);
    /** @type {ReturnType<typeof createWheel>[]} */
    this.drawings = [];
    /** @type {{wheel: import("./toothed_wheels.js").Wheel, line: SVGLineElement}[]} */
    this.arms = [];
    const note = t`Circles are pitch circles. Gears turn at their computed speeds; at speed 1, the input takes four seconds per turn.`;
    this.fill(this.build(), [this.facts, createElement("p", { class: "note" }, note)], [], [this.createGearChoice()]);
  }

  /** Draw the gears of the motion as it is, and tell their speeds. */
  build() {
    const { mechanism } = this.design;
    const listed = layOutWheels(mechanism, /** @type {TrainMotion} */ (this.motion), this.design, this.problem);
    const corners = listed.flatMap((wheel) =>
      [0, 1, 2, 3].flatMap((quarter) => {
        const far = pitchRadius(wheel) + (wheel.internal ? 3 : 1) * wheel.module;
        const [x, y] = placeWheel(wheel, wheel.orbit ? (quarter * Math.PI) / 2 / wheel.orbit : 0);
        return /** @type {[number, number][]} */ ([
          [x - far, y - far],
          [x + far, y + far],
        ]);
      }),
    );
    const view = new View(corners, ...this.size, 40);
    // Rings lie behind, and what is not engaged behind those.
    const order = [...listed].sort((one, other) => Number(other.internal ?? false) - Number(one.internal ?? false));
    this.drawings = order.map((wheel) => createWheel(view, wheel));
    const arms = listed.filter(
      (wheel) => wheel.orbit !== undefined && (wheel.centre[0] !== (wheel.axis?.[0] ?? 0) || wheel.centre[1]),
    );
    this.arms = arms.map((wheel) => ({ wheel, line: createSvg("line", { class: "arm" }) }));
    this.view = view;
    this.facts.replaceChildren(
      ...this.createSpeedTable().flatMap(([name, speed]) => [
        createElement("dt", {}, name),
        createElement("dd", {}, speed),
      ]),
    );
    return createScene(view, t`The gears, turning`, [
      ...this.drawings.map((one) => one.node),
      ...this.arms.map((one) => one.line),
    ]);
  }

  /** @returns {[string, string][]} */
  createSpeedTable() {
    const { bodies, shafts = [], gears = [] } = this.motion;
    const told = (/** @type {number | null | undefined} */ ratio) =>
      ratio === null || ratio === undefined ? t`open` : t`${formatNumber(Number(ratio.toPrecision(6)))} × input`;
    if (bodies) return bodies.map((body) => [toWords(body.name), body.speed === 0 ? t`held` : told(body.speed)]);
    if (this.motion.units)
      return shafts.map((shaft, k) => [
        k === 0 ? t`Input` : k === shafts.length - 1 ? t`Output` : t`Shaft ${k + 1}`,
        told(shaft.speed_ratio),
      ]);
    if (shafts?.[0]?.name) return shafts.map((shaft) => [toWords(String(shaft.name)), told(shaft.speed_ratio)]);
    return gears.map((gear) => [
      t`Stage ${gear.stage} ${term(gear.role)}, ${gear.teeth} teeth`,
      told(gear.speed_ratio),
    ]);
  }

  /** Build the choice of the engaged gear of a gearbox, for the drawing and the assembly. */
  createGearChoice() {
    const { mechanism } = this.design;
    const { speeds } = this.motion;
    if (!speeds?.[0]?.engaged) return null;
    const boxed = mechanism.type === "gearbox";
    const name = (/** @type {Schemas["EngagedSpeed"]} */ one) =>
      boxed
        ? t`pairs ${one.engaged.map((/** @type {number} */ k) => k + 1).join(", ")}`
        : one.engaged[0] === mechanism.gears?.length
          ? t`reverse`
          : t`gear ${one.engaged[0] + 1}`;
    const pick = createElement(
      "select",
      { id: "engaged", onchange: () => this.engage(speeds[Number(pick.value)].engaged) },
      ...speeds.map((one, k) =>
        createElement(
          "option",
          { value: k },
          t`${name(one)}: ${formatNumber(Number(one.speed_ratio.toPrecision(4)))} × input`,
        ),
      ),
    );
    pick.value = String(speeds.findIndex((one) => String(one.engaged) === String(this.motion.engaged)));
    return createElement(
      "div",
      { class: "row engaging" },
      createElement("label", { for: "engaged" }, t`Engaged`),
      pick,
    );
  }

  /** @param {number[]} engaged */
  async engage(engaged) {
    const { mechanism } = this.design;
    const which =
      mechanism.type === "gearbox"
        ? { engaged }
        : { gear: engaged[0] === mechanism.gears?.length ? "reverse" : engaged[0] + 1 };
    const motion = { from: 0, to: 360, steps: this.motion.input_angle.length - 1 };
    const found = await api.analyse({ mechanism, motion, ...which }, this.gone.signal).catch((error) => {
      if (!this.gone.signal.aborted)
        this.facts.replaceChildren(createElement("dt", {}, t`Refused`), createElement("dd", {}, error.message));
    });
    if (!found || this.gone.signal.aborted) return;
    this.motion = found;
    this.picture?.replaceChildren(...this.build().childNodes);
    this.show(this.player.at);
  }

  /** @param {number} at */
  show(at) {
    const input = (this.interpolateSeries(this.angles, at) * Math.PI) / 180;
    for (const { turn } of this.drawings) turn(input);
    for (const { wheel, line } of this.arms) {
      const [[u, v], [x, y]] = [
        this.view.toPicture(...(wheel.axis ?? /** @type {[number, number]} */ ([0, 0]))),
        this.view.toPicture(...placeWheel(wheel, input)),
      ];
      for (const [name, value] of Object.entries({ x1: u, y1: v, x2: x, y2: y }))
        line.setAttribute(name, value.toFixed(2));
    }
  }

  stop() {
    this.gone.abort();
    super.stop();
  }
}
