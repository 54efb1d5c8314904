/** Draw the area that a linkage sweeps over its used range: links in their width, and the body. */

import { createElement, createSvg } from "../core/dom.js";
import { outlinePath } from "../canvas/area_hatching.js";
import { t } from "../core/messages.js";
import { interpolate, clampIndex } from "../core/player.js";
import { linkPath } from "../assembly/workspace_view.js";

/** @import { LinkageAnalysis, Skeleton } from "../types/values.js" */

/** @typedef {[number, number]} Point */

/** Number of positions in the swept area, and the interval between outlined ones. */
const POSITION_COUNT = 120;
const OUTLINE_INTERVAL = 12;

export class SweptArea {
  /**
   * @param {import("../core/view.js").View} view @param {Skeleton} skeleton @param
   *   {import("../assembly/workspace_view.js").WorkspaceView} room
   * @param {(at: number) => import("../canvas/linkage_drawing.js").Places} places joints at a place of the motion
   * @param {[number, number]} range of the motion, places of its arrays @param {() => void} toggled
   */
  constructor(view, skeleton, room, places, range, toggled) {
    this.range = range;
    this.box = createElement("input", {
      type: "checkbox",
      id: "sweep",
      onchange: () => {
        if (this.box.checked && !this.node.childElementCount) this.draw(view, skeleton, room, places);
        this.node.toggleAttribute("hidden", !this.box.checked);
        toggled();
      },
    });
    this.node = createSvg("g", { class: "sweep", hidden: true });
    this.control = createElement(
      "label",
      { class: "flag", for: "sweep" },
      this.box,
      room.cycle ? t`Sweep over the whole cycle` : t`Sweep over the used range`,
    );
  }

  get isShown() {
    return this.box.checked;
  }

  /**
   * @param {import("../core/view.js").View} view
   * @param {Skeleton} skeleton
   * @param {import("../assembly/workspace_view.js").WorkspaceView} room
   * @param {(at: number) => import("../canvas/linkage_drawing.js").Places} places
   */
  draw(view, skeleton, room, places) {
    const [from, to] = this.range;
    const stands = Array.from({ length: POSITION_COUNT + 1 }, (_, k) =>
      places(from + ((to - from) * k) / POSITION_COUNT),
    );
    const names = skeleton.links.map((link) => link.name).filter((/** @type {string} */ name) => name !== "ground");
    const links = room.links.map((joints, k) => ({
      name: names[k],
      width: room.width,
      shapes: stands.map((now) => linkPath(view, joints, now)),
    }));
    const body = stands.map((now) => {
      const corners = room.createCarriedBody(now);
      return corners ? outlinePath(view, { circle: null, corners }) : "";
    });
    for (const { name, width, shapes } of [...links, { name: "body", width: 0, shapes: body }]) {
      const part = name === "body" ? "body" : name === skeleton.input_link ? "input" : "";
      this.node.append(
        createSvg("path", {
          class: `swept ${part}`,
          d: shapes.join(""),
          "stroke-width": Math.max(view.scale * width, 1),
        }),
        createSvg("path", {
          class: `ghosts ${part}`,
          d: shapes
            .filter((/** @type {string} */ _, /** @type {number} */ k) => k % (POSITION_COUNT / OUTLINE_INTERVAL) === 0)
            .join(""),
        }),
      );
    }
  }
}

/**
 * The places of a motion's arrays between two inputs; beyond the arrays where the motion comes back to its beginning.
 * @param {LinkageAnalysis} motion
 * @param {[number, number] | null | undefined} used inputs
 * @param {boolean} closed
 * @returns {[number, number]}
 */
export function usedRange(motion, used, closed) {
  const last = motion.input_angle.length - 1;
  const places = used
    ?.map((value) => findPosition(motion.input_angle, value, closed))
    .sort((one, other) => one - other);
  return places ? [places[0], places[1]] : [0, last];
}

/** The place at which a motion has an input. @param {number[]} input @param {number} value @param {boolean} closed */
export function findPosition(input, value, closed) {
  const last = input.length - 1;
  const period = input[last] - input[0];
  const turns = closed ? Math.floor((value - input[0]) / period) : 0;
  const on = value - turns * period;
  const sense = Math.sign(period);
  const next = Math.max(
    1,
    input.findIndex((one, k) => k > 0 && sense * (one - on) >= 0),
  );
  const k = sense * (input[last] - on) < 0 ? last : next;
  const share = (on - input[k - 1]) / (input[k] - input[k - 1] || 1);
  return turns * last + k - 1 + Math.min(1, Math.max(0, share));
}

/**
 * The joints at a place of a motion, which may lie beyond its arrays.
 * @param {LinkageAnalysis} motion
 * @param {number} place
 * @returns {import("../canvas/linkage_drawing.js").Places}
 */
export function jointPositions(motion, place) {
  const at = clampIndex(place, motion.input_angle.length - 1);
  return Object.fromEntries(
    Object.entries(motion.joints).map(([name, track]) => {
      const x = interpolate(track.x, at);
      return [name, x === null ? null : [x, Number(interpolate(track.y, at))]];
    }),
  );
}
