/** A barrel cam: its groove, unrolled, passes the roller, which moves along the axis. */

import { Cammed } from "./cam.js";
import { svg } from "../core/dom.js";
import { t } from "../core/messages.js";
import { between } from "../core/player.js";
import { View } from "../core/view.js";

/** @import { Schemas } from "../types/values.js" */

/** @typedef {[number, number]} Point */

export class Barrel extends Cammed {
  get label() {
    return t`The groove of the barrel, unrolled, passing the roller`;
  }

  drawn() {
    const {
      cylinder_radius: radius,
      follower,
      lower_wall: lower,
      upper_wall: upper,
      pitch_curve: pitch,
    } = /** @type {Schemas["BarrelCamMechanism"]} */ (this.mechanism);
    this.turn = 2 * Math.PI * radius;
    const [floor, ceiling] = [
      Math.min(...lower.y) - follower.roller_radius,
      Math.max(...upper.y) + follower.roller_radius,
    ];
    this.view = new View(
      [
        [-this.turn / 2, floor],
        [this.turn / 2, ceiling],
      ],
      ...this.size,
      32,
    );
    const { view } = this;
    // Three turns side by side, so that one is always in the picture.
    const thrice = (/** @type {{x: number[], y: number[]}} */ curve) =>
      [-1, 0, 1].flatMap((n) =>
        curve.x.map(
          (/** @type {number} */ x, /** @type {number} */ k) => /** @type {Point} */ ([x + n * this.turn, curve.y[k]]),
        ),
      );
    this.groove = svg(
      "g",
      { class: "cam" },
      ...[lower, upper].map((wall) => svg("path", { class: "wall", d: view.path(thrice(wall)) })),
      svg("path", { class: "pitch", d: view.path(thrice(pitch)) }),
    );
    const [u, top] = view.at(0, ceiling);
    const [, bottom] = view.at(0, floor);
    const [west] = view.at(-this.turn / 2, 0);
    const [east] = view.at(this.turn / 2, 0);
    this.roller = svg("circle", { class: "tyre", cx: u, r: view.scale * follower.roller_radius });
    const clip = svg(
      "svg",
      {
        x: west,
        y: top,
        width: east - west,
        height: bottom - top,
        viewBox: `${west} ${top} ${east - west} ${bottom - top}`,
      },
      this.groove,
    );
    return [
      svg("rect", { class: "drum", x: west, y: top, width: east - west, height: bottom - top }),
      clip,
      svg("line", { class: "rail", x1: u, y1: top, x2: u, y2: bottom }),
      this.roller,
    ];
  }

  /** @param {number} at @param {number} angle */
  put(at, angle) {
    const height = Number(between(this.displacement, at));
    this.groove?.setAttribute("transform", `translate(${(-this.view.scale * this.turn * angle) / (2 * Math.PI)} 0)`);
    this.roller?.setAttribute("cy", String(this.view.at(0, height)[1]));
  }
}
