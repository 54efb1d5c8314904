/** Draw a linkage: links, slides and pins at given joint positions. */

import { createSvg } from "../core/dom.js";

/** @import { Schemas, Skeleton } from "../types/values.js" */

/** @typedef {[number, number]} Point */
/** @typedef {Record<string, Point | null>} Places */
/** @typedef {import("../core/view.js").View} View */

/** Return the fixed joints. @param {Skeleton} skeleton @returns {string[]} */
export function groundedJoints(skeleton) {
  return skeleton.links.find((link) => link.name === "ground")?.joints ?? [];
}

/**
 * Return the joints to draw; an unrequested coupler point coincides with another joint.
 * @param {Skeleton} skeleton
 * @returns {string[]}
 */
export function drawnJoints(skeleton) {
  const [px, py] = skeleton.joints.P ?? [NaN, NaN];
  const doubled = Object.entries(skeleton.joints).some(([name, [x, y]]) => name !== "P" && x === px && y === py);
  return Object.keys(skeleton.joints).filter((name) => name !== "P" || !doubled);
}

/**
 * Return the angle of a slide line, radians, from the joints of its link.
 * @param {{on: string[], lean: number}} slide
 * @param {Places} places
 */
export function slideAngle({ on, lean }, places) {
  const [a, b] = on.map((name) => places[name]);
  return a && b ? lean + Math.atan2(b[1] - a[1], b[0] - a[0]) : lean;
}

/** Return the transform that moves a drawing from the origin to a point of the picture. @param {Point} place */
export function translateTo([u, v]) {
  return `translate(${u.toFixed(2)} ${v.toFixed(2)})`;
}

export class LinkageDrawing {
  /**
   * @param {View} view
   * @param {Skeleton} skeleton
   * @param {{names?: boolean, faint?: boolean, classes?: Record<string, string>}} [manner] classes of links by their
   *   names
   */
  constructor(view, skeleton, { names = true, faint = false, classes = {} } = {}) {
    this.view = view;
    this.links = skeleton.links
      .filter((link) => link.name !== "ground")
      .map((link) => ({
        joints: link.joints,
        path: createSvg("path", {
          class: `link ${link.name === skeleton.input_link ? "input" : ""} ${classes[link.name] ?? ""}`,
        }),
      }));
    this.slides = (skeleton.slides ?? []).map((slide) => this.createSlide(skeleton, slide));
    this.pins = drawnJoints(skeleton).map((name) => {
      const dot = createSvg("circle", { class: name === "P" ? "point" : "pin" });
      const text = names && createSvg("text", { dx: "0.6em", dy: "-0.55em" }, name);
      return { name, dot, node: createSvg("g", { class: "joined" }, dot, text) };
    });
    const still = groundedJoints(skeleton).map((name) => this.createPivot(skeleton.joints[name]));
    this.node = createSvg(
      "g",
      { class: faint ? "faint" : "live" },
      ...this.slides.map((one) => one.rail),
      ...still,
      ...this.links.map((one) => one.path),
      ...this.slides.map((one) => one.block),
      ...this.pins.map((one) => one.node),
    );
  }

  /** @param {Point | undefined} at */
  createPivot(at) {
    if (!at) return null;
    return createSvg(
      "g",
      { transform: translateTo(this.view.toPicture(...at)) },
      createSvg("path", { class: "ground", d: "M0 0l-9 15h18Z" }),
    );
  }

  /**
   * Create the block and the line of a slide; the line of a moving link follows from two joints.
   * @param {Skeleton} skeleton
   * @param {Schemas["Slide"]} slide
   */
  createSlide(skeleton, slide) {
    const angle = (slide.angle * Math.PI) / 180;
    const link = skeleton.links.find((one) => one.name === slide.link);
    const on = slide.link === "ground" ? [] : (link?.joints ?? []);
    const rail = createSvg("line", { class: "rail" });
    const block = createSvg(
      "g",
      {},
      createSvg("rect", { class: "block", x: -12, y: -7, width: 24, height: 14, rx: 2 }),
    );
    const [a, b] = on.map((/** @type {string} */ name) => skeleton.joints[name]);
    const lean = b ? angle - Math.atan2(b[1] - a[1], b[0] - a[0]) : angle;
    return { joint: slide.joint, on, lean, rail, block };
  }

  /** @param {Places} places */
  moveTo(places) {
    for (const { joints, path } of this.links) {
      const points = joints.map((name) => places[name]).filter((one) => !!one);
      const known = points.length === joints.length;
      path.setAttribute("d", known ? `${this.view.pathData(points)}${points.length > 2 ? "Z" : ""}` : "");
    }
    for (const { joint, on, lean, rail, block } of this.slides) {
      const at = places[joint];
      const [a, b] = on.map((/** @type {string} */ name) => places[name]);
      block.toggleAttribute("hidden", !at);
      rail.toggleAttribute("hidden", !at);
      if (!at) continue;
      const angle = a && !b ? Math.atan2(at[1] - a[1], at[0] - a[0]) : slideAngle({ on, lean }, places);
      const [u, v] = this.view.toPicture(...at);
      const [c, s] = [900 * Math.cos(angle), -900 * Math.sin(angle)];
      for (const [name, value] of Object.entries({ x1: u - c, y1: v - s, x2: u + c, y2: v + s }))
        rail.setAttribute(name, String(value));
      block.setAttribute("transform", `${translateTo([u, v])} rotate(${((-angle * 180) / Math.PI).toFixed(1)})`);
    }
    for (const { name, node } of this.pins) {
      const point = places[name];
      node.toggleAttribute("hidden", !point);
      if (point) node.setAttribute("transform", translateTo(this.view.toPicture(...point)));
    }
  }
}
