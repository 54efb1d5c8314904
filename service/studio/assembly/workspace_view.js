/** The room in the picture of an answer: what stands, and the body that moves. */

import { createSvg } from "../core/dom.js";
import { createHatch, createLegend, outlinePath } from "../canvas/area_hatching.js";
import { listAreas } from "../canvas/workspace.js";

/** @import { Mechanism, Problem } from "../types/values.js" */

/** @typedef {[number, number]} Point */
/** @typedef {import("../canvas/linkage_drawing.js").Places} Places */

/** How a link lies: its turn, and where that takes a point. @typedef {{turn: Point, from: Point, to: Point}} Pose */

export class WorkspaceView {
  /** @param {Problem} problem @param {Mechanism} mechanism with its skeleton */
  constructor(problem, mechanism) {
    this.areas = listAreas(problem.space);
    this.skeleton = mechanism.skeleton;
    const first = problem.positions?.[0];
    const body = this.areas.find((one) => one.role.name === "body");
    /** Corners of the body as it lies at the first target. @type {Point[]} */
    this.body = body && first ? alignCorners(body.corners, first, mechanism) : [];
    const joints =
      this.skeleton?.links.find((link) => link.name !== "ground" && link.joints.includes("P"))?.joints ?? [];
    this.carrier = farthestPair(joints, this.skeleton?.joints ?? {});
    this.standing = this.areas.filter((one) => one !== body);
    /** Joints of each moving link; the coupler of a body that has an outline is a bar. @type {string[][]} */
    this.links = (this.skeleton?.links ?? [])
      .filter((link) => link.name !== "ground")
      .map((link) => link.joints.filter((/** @type {string} */ name) => !(this.body.length && name === "P")));
    this.width = Number(problem.space?.link_width ?? 0);
    this.cycle = problem.space?.over === "cycle";
  }

  /** Points that a picture of it shows. @returns {Point[]} */
  get extent() {
    return [...this.standing.flatMap((area) => area.extent), ...this.body];
  }

  /** @param {import("../core/view.js").View} view */
  draw(view) {
    this.view = view;
    this.path = createHatch("body", "");
    this.plates = this.width
      ? this.links.map(() => createSvg("path", { class: "plate", "stroke-width": view.scale * this.width }))
      : [];
    return createSvg(
      "g",
      { class: "room still" },
      ...this.standing.map((area) => {
        const [u, v] = view.toPicture(...area.labelPoint);
        return createSvg(
          "g",
          {},
          createSvg("title", {}, area.label),
          createHatch(area.role.name, outlinePath(view, area)),
          area.role.name !== "box" &&
            createSvg("text", { class: `area-mark ${area.role.name}`, x: u, y: v }, area.role.mark),
        );
      }),
      ...this.plates,
      this.path,
    );
  }

  /** What the hatches mean; nothing where there is no room. @returns {Element[]} */
  get legend() {
    const roles = [...new Set(this.areas.map((area) => area.role))];
    return roles.length ? [createLegend(roles)] : [];
  }

  /**
   * Corners of the body while the joints are there; null where they are not known.
   * @param {Places} places
   * @returns {Point[] | null}
   */
  createCarriedBody(places) {
    const { skeleton } = this;
    if (!this.body.length || !this.carrier || !skeleton) return null;
    const pose = segmentPose(
      this.carrier.map((name) => skeleton.joints[name]),
      this.carrier.map((name) => places[name]),
    );
    return pose && this.body.map((corner) => applyPose(pose, corner));
  }

  /** @param {Places} places */
  show(places) {
    const corners = this.createCarriedBody(places);
    this.path?.setAttribute("d", corners && this.view ? outlinePath(this.view, { circle: null, corners }) : "");
    this.plates?.forEach((plate, k) =>
      plate.setAttribute("d", this.view ? linkPath(this.view, this.links[k], places) : ""),
    );
  }
}

/**
 * The line of a link, which is drawn as wide as the link.
 * @param {import("../core/view.js").View} view
 * @param {string[]} joints
 * @param {Places} places
 */
export function linkPath(view, joints, places) {
  const points = joints.map((name) => places[name]);
  return points.every(Boolean)
    ? `${view.pathData(/** @type {Point[]} */ (points))}${points.length > 2 ? "Z" : ""}`
    : "";
}

/**
 * The outline of a body that a fit has put elsewhere in its first position.
 * @param {Point[]} corners
 * @param {import("../motion/linkage_motion.js").Target} first
 * @param {Mechanism} mechanism
 * @returns {Point[]}
 */
function alignCorners(corners, first, mechanism) {
  const stands = mechanism.reference_body_angle ?? first.angle ?? 0;
  const turn = ((stands - (first.angle ?? 0)) * Math.PI) / 180;
  const to = mechanism.skeleton?.joints.P;
  const pose = to && {
    turn: /** @type {Point} */ ([Math.cos(turn), Math.sin(turn)]),
    from: /** @type {Point} */ ([first.x, first.y]),
    to,
  };
  return pose ? corners.map((corner) => applyPose(pose, corner)) : corners;
}

/**
 * The two joints of a link that tell its turn best.
 * @param {string[]} joints
 * @param {Record<string, Point>} at
 * @returns {[string, string] | null}
 */
function farthestPair(joints, at) {
  const pairs = joints.flatMap((one, k) =>
    joints.slice(k + 1).map((other) => /** @type {[string, string]} */ ([one, other])),
  );
  const apart = ([one, other] = ["", ""]) => Math.hypot(at[one][0] - at[other][0], at[one][1] - at[other][1]);
  const best = pairs.sort((one, other) => apart(other) - apart(one))[0];
  return best && apart(best) > 0 ? best : null;
}

/**
 * How two points of a link have moved.
 * @param {(Point | null)[]} from
 * @param {(Point | null)[]} to
 * @returns {Pose | null}
 */
function segmentPose([a, b], [c, d]) {
  if (!a || !b || !c || !d) return null;
  const [ux, uy, vx, vy] = [b[0] - a[0], b[1] - a[1], d[0] - c[0], d[1] - c[1]];
  const size = Math.hypot(ux, uy) * Math.hypot(vx, vy);
  return size ? { turn: [(ux * vx + uy * vy) / size, (ux * vy - uy * vx) / size], from: a, to: c } : null;
}

/** @param {Pose} pose @param {Point} point @returns {Point} */
function applyPose({ turn: [c, s], from, to }, [x, y]) {
  const [dx, dy] = [x - from[0], y - from[1]];
  return [to[0] + c * dx - s * dy, to[1] + s * dx + c * dy];
}
