/** Animate a flywheel with the varying speed of its shaft. */

import { createElement, formatNumber, createSvg } from "../core/dom.js";
import { t } from "../core/messages.js";
import { interpolate } from "../core/player.js";
import { createScene } from "../canvas/stage.js";
import { RotaryView } from "./rotary_view.js";
import { unitSymbol } from "../core/units.js";
import { View } from "../core/view.js";

/** @import { Problem, Schemas } from "../types/values.js" */

/** @typedef {{angle: number[], torque: number[], speed: number[]}} Course */

export class FlywheelView extends RotaryView {
  /**
   * @param {import("../canvas/stage.js").Frame} frame
   * @param {Schemas["FlywheelDesign"]} design
   * @param {unknown} _motion unused: the design's course contains it
   * @param {Problem} problem
   */
  constructor(frame, design, _motion, problem) {
    const { mechanism, course } = design;
    // Places of the player are equal times.
    const angles = anglesOverTime(course);
    super(frame, t`Shaft`, angles);
    const { radius, inner_radius: inner } = mechanism;
    const [speed, torque] = [unitSymbol("rotational speed", problem), unitSymbol("torque", problem)];
    this.told = [
      {
        name: t`Speed`,
        unit: speed,
        values: course.speed,
        series: valuesOverTime(course, angles, course.speed),
        said: createElement("dd", {}),
      },
      {
        name: t`Torque`,
        unit: torque,
        values: course.torque,
        series: valuesOverTime(course, angles, course.torque),
        said: createElement("dd", {}),
      },
    ];
    const view = new View(
      [
        [-radius, -radius],
        [radius, radius],
      ],
      ...this.size,
      40,
    );
    this.middle = view.toPicture(0, 0);
    const [cx, cy] = this.middle;
    const circle = (/** @type {number} */ far, /** @type {string} */ name) =>
      createSvg("circle", { class: name, cx, cy, r: view.scale * far });
    this.spoke = createSvg("path", {
      class: "spoke",
      d: `M${(view.scale * inner).toFixed(1)} 0H${(view.scale * radius).toFixed(1)}`,
    });
    const wheel = createSvg(
      "g",
      { class: "wheel t0" },
      circle(radius, "teeth"),
      inner > 0 && circle(inner, "hollow"),
      this.spoke,
      createSvg("circle", { class: "pin", cx, cy, r: 3.5 }),
    );
    this.fill(
      createScene(view, t`The flywheel, turning`, [wheel]),
      [
        createElement(
          "dl",
          { class: "facts speeds" },
          ...this.told.flatMap(({ name, said }) => [createElement("dt", {}, name), said]),
        ),
      ],
      this.told.map(({ name, unit, values, series }) => ({
        title: unit ? `${name} (${unit})` : name,
        lines: { "": series },
        values,
      })),
    );
  }

  /** @param {number} at @param {boolean} told */
  show(at, told) {
    const [u, v] = this.middle;
    this.spoke.setAttribute(
      "transform",
      `translate(${u.toFixed(2)} ${v.toFixed(2)}) rotate(${(-Number(interpolate(this.angles, at))).toFixed(3)})`,
    );
    if (!told) return;
    for (const { unit, series, said } of this.told)
      said.textContent = `${formatNumber(Number(Number(interpolate(series, at)).toPrecision(4)))} ${unit}`.trim();
  }
}

/** Angles at equal times over the cycle, degrees. @param {Course} course @returns {number[]} */
function anglesOverTime({ angle, speed }) {
  const times = [0];
  for (let k = 1; k < angle.length; k++)
    times.push(times[k - 1] + (angle[k] - angle[k - 1]) / (0.5 * (speed[k] + speed[k - 1])));
  const whole = times[times.length - 1];
  let k = 1;
  return angle.map((/** @type {number} */ _, /** @type {number} */ n) => {
    const time = (whole * n) / (angle.length - 1);
    while (k < times.length - 1 && times[k] < time) k++;
    const share = (time - times[k - 1]) / (times[k] - times[k - 1]);
    return angle[k - 1] + share * (angle[k] - angle[k - 1]);
  });
}

/**
 * Values that are known over the angle, at the angles of equal times.
 * @param {Course} course
 * @param {number[]} angles
 * @param {number[]} values
 */
function valuesOverTime({ angle }, angles, values) {
  const step = (angle[angle.length - 1] - angle[0]) / (angle.length - 1);
  return angles.map((at) => Number(interpolate(values, Math.min(values.length - 1, (at - angle[0]) / step))));
}
