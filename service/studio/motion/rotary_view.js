/** The base of all rotating views: player, picture and plots. */

import { createElement, formatNumber } from "../core/dom.js";
import { t } from "../core/messages.js";
import { Player, interpolate } from "../core/player.js";
import { createPlots } from "../plots/plots.js";

export class RotaryView {
  /**
   * @param {import("../canvas/stage.js").Frame} frame
   * @param {string} label of what drives it
   * @param {number[]} angles of what drives it, degrees, over a turn
   * @param {{endless?: boolean}} [manner] whether it goes on turn after turn, since it need not come back after one
   */
  constructor(frame, label, angles, { endless = false } = {}) {
    this.frame = frame;
    this.size = frame.availableSize();
    this.angles = angles;
    /** What is on the stage. @type {SVGSVGElement | null} */
    this.picture = null;
    /** @type {import("../plots/plots.js").PlotMark[]} */
    this.marks = [];
    this.player = new Player({
      count: angles.length,
      closed: true,
      endless,
      label,
      reading: (at) => `${formatNumber(Math.round(10 * this.interpolateSeries(angles, at)) / 10)}°`,
      show: (at, told) => {
        this.show(at, told);
        for (const mark of this.marks) mark.show(this.clampPosition(at), told);
      },
    });
  }

  /**
   * Take the stage, and begin.
   * @param {SVGSVGElement} picture
   * @param {(Node | null | false | undefined)[]} beside
   * @param {import("../plots/plots.js").PlotData[]} [plotted] over the angles
   * @param {(Node | null)[]} [below] on the stage, beneath the picture
   */
  fill(picture, beside, plotted = [], below = []) {
    this.picture = picture;
    this.marks = createPlots(plotted, this.angles, (at) => this.player.leadTo(at));
    this.frame.fill({
      picture,
      clock: this.player.row,
      below,
      beside,
      plots: [
        this.marks.length > 0
          ? createElement("div", { class: "plots" }, ...this.marks.map((mark) => mark.figure))
          : createElement("p", { class: "note" }, t`All speeds are constant; there is nothing to plot.`),
      ],
    });
    this.player.begin();
  }

  /** A value that grows turn after turn by as much as over one. @param {number[]} series @param {number} at */
  interpolateSeries(series, at) {
    const last = series.length - 1;
    const turns = Math.floor(at / last);
    return turns * (series[last] - series[0]) + Number(interpolate(series, at - turns * last));
  }

  /** A place of the arrays within the first turn. @param {number} at */
  clampPosition(at) {
    const last = this.angles.length - 1;
    return this.player.moved.endless ? at - last * Math.floor(at / last) : at;
  }

  /**
   * Show it at a place of its arrays, between samples as a fraction.
   * @param {number} _at
   * @param {boolean} _told whether its numbers are shown
   */
  show(_at, _told) {}

  pause() {
    this.player.stop();
  }

  stop() {
    this.player.stop();
  }
}
