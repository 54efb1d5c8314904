/** Animate a barrel cam: its unrolled groove passes the roller, which moves along the axis. */

import { CamView } from "./cam.js";
import { createSvg } from "../core/dom.js";
import { t } from "../core/messages.js";
import { interpolate } from "../core/player.js";
import { View } from "../core/view.js";

/** @import { Schemas } from "../types/values.js" */

/** @typedef {[number, number]} Point */

export class BarrelCamView extends CamView {
  get label() {
    return t`The unrolled groove of the barrel, moving past the roller`;
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
    this.groove = createSvg(
      "g",
      { class: "cam" },
      ...[lower, upper].map((wall) => createSvg("path", { class: "wall", d: view.pathData(thrice(wall)) })),
      createSvg("path", { class: "pitch", d: view.pathData(thrice(pitch)) }),
    );
    const [u, top] = view.toPicture(0, ceiling);
    const [, bottom] = view.toPicture(0, floor);
    const [west] = view.toPicture(-this.turn / 2, 0);
    const [east] = view.toPicture(this.turn / 2, 0);
    this.roller = createSvg("circle", { class: "tyre", cx: u, r: view.scale * follower.roller_radius });
    const clip = createSvg(
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
      createSvg("rect", { class: "drum", x: west, y: top, width: east - west, height: bottom - top }),
      clip,
      createSvg("line", { class: "rail", x1: u, y1: top, x2: u, y2: bottom }),
      this.roller,
    ];
  }

  /** @param {number} at @param {number} angle */
  put(at, angle) {
    const height = Number(interpolate(this.displacement, at));
    this.groove?.setAttribute("transform", `translate(${(-this.view.scale * this.turn * angle) / (2 * Math.PI)} 0)`);
    this.roller?.setAttribute("cy", String(this.view.toPicture(0, height)[1]));
  }
}
