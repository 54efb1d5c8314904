/** A flywheel that turns, with a spoke that shows how far; faster and slower as its shaft does. */

import { el, shown, svg } from "./dom.js";
import { t } from "./messages.js";
import { Player, between } from "./player.js";
import { View } from "./view.js";

/** @import { Schemas } from "./types/values.js" */

/** @typedef {{angle: number[], torque: number[], speed: number[]}} Course */

export class Flywheel {
  /** @param {import("./stage.js").Frame} frame @param {Schemas["FlywheelDesign"]} design */
  constructor(frame, design) {
    const [width, height] = frame.size();
    const { mechanism, course } = design;
    const { radius, inner_radius: inner } = mechanism;
    // Places of the player are equal times.
    this.angles = turned(course);
    this.speeds = inTime(course, this.angles, course.speed);
    this.torques = inTime(course, this.angles, course.torque);
    this.view = new View(
      [
        [-radius, -radius],
        [radius, radius],
      ],
      width,
      height,
      40,
    );
    this.middle = this.view.at(0, 0);
    const circle = (/** @type {number} */ far, /** @type {string} */ name) =>
      svg("circle", { class: name, cx: this.middle[0], cy: this.middle[1], r: this.view.scale * far });
    this.spoke = svg("path", {
      class: "spoke",
      d: `M${(this.view.scale * inner).toFixed(1)} 0H${(this.view.scale * radius).toFixed(1)}`,
    });
    this.picture = svg(
      "svg",
      { viewBox: `0 0 ${width} ${height}`, class: "canvas", role: "img", "aria-label": t`The flywheel, turning` },
      svg("rect", { class: "paper", width, height }),
      svg(
        "g",
        { class: "wheel t0" },
        circle(radius, "teeth"),
        inner > 0 && circle(inner, "hollow"),
        this.spoke,
        svg("circle", { class: "pin", cx: this.middle[0], cy: this.middle[1], r: 3.5 }),
      ),
    );
    this.speed = el("dd", {});
    this.torque = el("dd", {});
    this.player = new Player({
      count: course.angle.length,
      closed: true,
      label: t`Shaft`,
      reading: (at) => `${shown(Math.round(10 * Number(between(this.angles, at))) / 10)}°`,
      show: (at) => this.show(at),
    });
    frame.fill({
      picture: this.picture,
      clock: this.player.row,
      beside: [
        el(
          "dl",
          { class: "facts speeds" },
          el("dt", {}, t`Speed, rev/min`),
          this.speed,
          el("dt", {}, t`Torque`),
          this.torque,
        ),
      ],
    });
    this.player.begin();
  }

  /** @param {number} at */
  show(at) {
    const [u, v] = this.middle;
    this.spoke.setAttribute(
      "transform",
      `translate(${u.toFixed(2)} ${v.toFixed(2)}) rotate(${(-Number(between(this.angles, at))).toFixed(3)})`,
    );
    this.speed.textContent = shown(Number(Number(between(this.speeds, at)).toPrecision(5)));
    this.torque.textContent = shown(Number(Number(between(this.torques, at)).toPrecision(4)));
  }

  stop() {
    this.player.stop();
  }
}

/** Angles at equal times over the cycle, degrees. @param {Course} course @returns {number[]} */
function turned({ angle, speed }) {
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
function inTime({ angle }, angles, values) {
  const step = (angle[angle.length - 1] - angle[0]) / (angle.length - 1);
  return angles.map((at) => Number(between(values, Math.min(values.length - 1, (at - angle[0]) / step))));
}
