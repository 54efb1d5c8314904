/** A linkage as a drawing: links, slides and pins, put where the joints are. */

import { svg } from "../core/dom.js";

/** @import { Schemas, Skeleton } from "../types/values.js" */

/** @typedef {[number, number]} Point */
/** @typedef {Record<string, Point | null>} Places */
/** @typedef {import("../core/view.js").View} View */

/** Joints that stand still. @param {Skeleton} skeleton @returns {string[]} */
export function grounded(skeleton) {
  return skeleton.links.find((link) => link.name === "ground")?.joints ?? [];
}

/**
 * Joints worth a drawing: a coupler point that nobody asked for lies on another joint.
 * @param {Skeleton} skeleton
 * @returns {string[]}
 */
export function drawn(skeleton) {
  const [px, py] = skeleton.joints.P ?? [NaN, NaN];
  const doubled = Object.entries(skeleton.joints).some(([name, [x, y]]) => name !== "P" && x === px && y === py);
  return Object.keys(skeleton.joints).filter((name) => name !== "P" || !doubled);
}

/**
 * Where the line of a slide points, radians, from the joints of its link.
 * @param {{on: string[], lean: number}} slide
 * @param {Places} places
 */
export function slope({ on, lean }, places) {
  const [a, b] = on.map((name) => places[name]);
  return a && b ? lean + Math.atan2(b[1] - a[1], b[0] - a[0]) : lean;
}

/** What puts something that is drawn about the origin to a place of the picture. @param {Point} place */
export function placed([u, v]) {
  return `translate(${u.toFixed(2)} ${v.toFixed(2)})`;
}

export class Linkage {
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
        path: svg("path", {
          class: `link ${link.name === skeleton.input_link ? "input" : ""} ${classes[link.name] ?? ""}`,
        }),
      }));
    this.slides = (skeleton.slides ?? []).map((slide) => this.slide(skeleton, slide));
    this.pins = drawn(skeleton).map((name) => {
      const dot = svg("circle", { class: name === "P" ? "point" : "pin" });
      const text = names && svg("text", { dx: "0.6em", dy: "-0.55em" }, name);
      return { name, dot, node: svg("g", { class: "joined" }, dot, text) };
    });
    const still = grounded(skeleton).map((name) => this.pivot(skeleton.joints[name]));
    this.node = svg(
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
  pivot(at) {
    if (!at) return null;
    return svg("g", { transform: placed(this.view.at(...at)) }, svg("path", { class: "ground", d: "M0 0l-9 15h18Z" }));
  }

  /**
   * A block on its line; a line of a moving link is known by two joints of it.
   * @param {Skeleton} skeleton
   * @param {Schemas["Slide"]} slide
   */
  slide(skeleton, slide) {
    const angle = (slide.angle * Math.PI) / 180;
    const link = skeleton.links.find((one) => one.name === slide.link);
    const on = slide.link === "ground" ? [] : (link?.joints ?? []);
    const rail = svg("line", { class: "rail" });
    const block = svg("g", {}, svg("rect", { class: "block", x: -12, y: -7, width: 24, height: 14, rx: 2 }));
    const [a, b] = on.map((/** @type {string} */ name) => skeleton.joints[name]);
    const lean = b ? angle - Math.atan2(b[1] - a[1], b[0] - a[0]) : angle;
    return { joint: slide.joint, on, lean, rail, block };
  }

  /** @param {Places} places */
  show(places) {
    for (const { joints, path } of this.links) {
      const points = joints.map((name) => places[name]).filter((one) => !!one);
      const known = points.length === joints.length;
      path.setAttribute("d", known ? `${this.view.path(points)}${points.length > 2 ? "Z" : ""}` : "");
    }
    for (const { joint, on, lean, rail, block } of this.slides) {
      const at = places[joint];
      const [a, b] = on.map((/** @type {string} */ name) => places[name]);
      block.toggleAttribute("hidden", !at);
      rail.toggleAttribute("hidden", !at);
      if (!at) continue;
      const angle = a && !b ? Math.atan2(at[1] - a[1], at[0] - a[0]) : slope({ on, lean }, places);
      const [u, v] = this.view.at(...at);
      const [c, s] = [900 * Math.cos(angle), -900 * Math.sin(angle)];
      for (const [name, value] of Object.entries({ x1: u - c, y1: v - s, x2: u + c, y2: v + s }))
        rail.setAttribute(name, String(value));
      block.setAttribute("transform", `${placed([u, v])} rotate(${((-angle * 180) / Math.PI).toFixed(1)})`);
    }
    for (const { name, node } of this.pins) {
      const point = places[name];
      node.toggleAttribute("hidden", !point);
      if (point) node.setAttribute("transform", placed(this.view.at(...point)));
    }
  }
}
