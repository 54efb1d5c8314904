/** Draw the springs of a linkage as coils between its links. */

import { createSvg } from "../core/dom.js";

/** @import { LinkedDesign, Problem, Schemas, Skeleton } from "../types/values.js" */

/** @typedef {[number, number]} Point */
/** @typedef {Schemas["SpringEnd"]} End */
/** Of a spring that pulls along a line; one that turns has none. @typedef {[End, End]} Ends */

/** Turns of a coil, its half width, and the straight part at either end, pixels. */
const COIL_TURNS = 6;
const COIL_HALF_WIDTH = 5;
const STRAIGHT_LENGTH = 10;

/**
 * The springs of a design: those found for it, or given with its loads.
 * @param {LinkedDesign} design
 * @param {Problem} problem
 * @returns {Ends[]}
 */
export function listSprings(design, problem) {
  const all = /** @type {{ends?: Ends | null}[]} */ (
    design.springs ?? design.dynamics?.springs ?? problem.dynamics?.springs ?? []
  );
  return all.flatMap(({ ends }) => (ends ? [ends] : []));
}

/** Where springs are fixed to the ground. @param {Ends[]} springs @returns {Point[]} */
export function springAnchors(springs) {
  return springs.flatMap((ends) =>
    ends.flatMap(({ link, point }) => (link === "ground" && Array.isArray(point) ? [point] : [])),
  );
}

export class SpringDrawings {
  /** @param {import("../core/view.js").View} view @param {Skeleton} skeleton @param {Ends[]} springs */
  constructor(view, skeleton, springs) {
    this.view = view;
    this.skeleton = skeleton;
    this.springs = springs.map((ends) => ({
      ends,
      coil: createSvg("path", { class: "spring" }),
      hooks: ends.map(() => createSvg("circle", { class: "hook", r: 3 })),
    }));
    this.node = createSvg("g", { class: "springs" }, ...this.springs.flatMap(({ coil, hooks }) => [coil, ...hooks]));
  }

  /** @param {import("../canvas/linkage_drawing.js").Places} places */
  show(places) {
    for (const { ends, coil, hooks } of this.springs) {
      const [from, to] = ends.map((end) => this.carriedPoint(end, places));
      for (const one of [coil, ...hooks]) one.toggleAttribute("hidden", !from || !to);
      if (!from || !to) continue;
      const [start, end] = [this.view.toPicture(...from), this.view.toPicture(...to)];
      coil.setAttribute("d", coilPath(start, end));
      [start, end].forEach(([u, v], k) => {
        hooks[k].setAttribute("cx", u.toFixed(1));
        hooks[k].setAttribute("cy", v.toFixed(1));
      });
    }
  }

  /**
   * Where a point of a link is: it goes with two joints of it.
   * @param {End} end
   * @param {import("../canvas/linkage_drawing.js").Places} places
   * @returns {Point | null}
   */
  carriedPoint({ link, point }, places) {
    if (link === "ground") return Array.isArray(point) ? point : null;
    const [one, other] = this.skeleton.links.find(({ name }) => name === link)?.joints ?? [];
    const [a, b] = [places[one], places[other]];
    const [p, q] = [this.skeleton.joints[one], this.skeleton.joints[other]];
    if (!a || !b || !p || !q) return null;
    const [now, before] = [Math.atan2(b[1] - a[1], b[0] - a[0]), Math.atan2(q[1] - p[1], q[0] - p[0])];
    if (!Array.isArray(point)) {
      const toward = now + ((point.angle ?? 0) * Math.PI) / 180;
      return [a[0] + point.distance * Math.cos(toward), a[1] + point.distance * Math.sin(toward)];
    }
    const [x, y] = point;
    const turn = now - before;
    const [c, s] = [Math.cos(turn), Math.sin(turn)];
    return [a[0] + c * (x - p[0]) - s * (y - p[1]), a[1] + s * (x - p[0]) + c * (y - p[1])];
  }
}

/** A zigzag from one place of the picture to another. @param {Point} from @param {Point} to */
function coilPath([u, v], [x, y]) {
  const length = Math.hypot(x - u, y - v);
  const [c, s] = [(x - u) / (length || 1), (y - v) / (length || 1)];
  const ends = Math.min(STRAIGHT_LENGTH, 0.2 * length);
  const step = (length - 2 * ends) / (2 * COIL_TURNS);
  const place = (/** @type {number} */ along, /** @type {number} */ aside) =>
    `${(u + c * along - s * aside).toFixed(1)} ${(v + s * along + c * aside).toFixed(1)}`;
  const turns = Array.from({ length: 2 * COIL_TURNS }, (_, k) =>
    place(ends + (k + 0.5) * step, k % 2 ? COIL_HALF_WIDTH : -COIL_HALF_WIDTH),
  );
  return `M${[place(0, 0), place(ends, 0), ...turns, place(length - ends, 0), place(length, 0)].join("L")}`;
}
