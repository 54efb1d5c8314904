/** The planes in which a linkage is built: from the side, beneath its motion, with what clashes. */

import { el, shown, svg, words } from "../core/dom.js";
import { grounded } from "../canvas/linkage_drawing.js";
import { foreign, t, term, translated } from "../core/messages.js";
import { symbolOf } from "../core/units.js";

/** @import { Layout, Problem, Schemas, Skeleton } from "../types/values.js" */

/** @typedef {[number, number]} Point */
/** @typedef {import("../canvas/linkage_drawing.js").Places} Places */

const HEIGHT = 210;
const TOP = 12;
const FOOT = 44;

/** Height of a base, pixels. */
const BASE = 14;

/** Planes are never drawn thicker than so many pixels: the side view is not to scale upward. */
const THICKEST = 26;

/** The colours that there are; with more planes they begin again. */
const COLOURS = 8;

/** @param {number} plane */
export function planeClass(plane) {
  return `plane p${((plane - 1) % COLOURS) + 1}`;
}

/**
 * Wheels as they stand on the ground: those that mesh, or an idler between them.
 * @param {Skeleton} skeleton
 * @returns {Record<string, {centre: Point, radius: number}>}
 */
function wheels(skeleton) {
  const still = grounded(skeleton);
  return Object.fromEntries(
    (skeleton.gears ?? []).flatMap(({ links, ratio }) => {
      const [o, q] = links
        .map((name) => skeleton.links.find((link) => link.name === name)?.joints.find((joint) => still.includes(joint)))
        .map((joint) => skeleton.joints[joint ?? ""]);
      if (!o || !q) return [];
      const idled = ratio > 0 ? 2 * Math.min(1, ratio) : 0;
      const unit = Math.hypot(q[0] - o[0], q[1] - o[1]) / (1 + Math.abs(ratio) + idled);
      const share = (Math.abs(ratio) + 0.5 * idled) / (1 + Math.abs(ratio) + idled);
      return [
        [t`gear of ${links[0]}`, { centre: o, radius: Math.abs(ratio) * unit }],
        [t`gear of ${links[1]}`, { centre: q, radius: unit }],
        ...(idled
          ? [
              [
                "idler",
                { centre: [o[0] + share * (q[0] - o[0]), o[1] + share * (q[1] - o[1])], radius: 0.5 * idled * unit },
              ],
            ]
          : []),
      ];
    }),
  );
}

export class Planes {
  /**
   * @param {import("../core/view.js").View} view of the linkage: both pictures stand one above the other
   * @param {Skeleton} skeleton
   * @param {Layout} layout
   * @param {Problem} problem
   * @param {Schemas["StatedLayout"]} stated what planes are asked for
   * @param {(input: number) => void} lead leads the motion to an input
   */
  constructor(view, skeleton, layout, problem, stated, lead) {
    this.view = view;
    this.floor = HEIGHT - FOOT - BASE;
    /** Pixels for a length unit upward. */
    this.scale = 1;
    /** @type {{name: string, bar: SVGElement}[]} */
    this.bars = [];
    /** @type {{name: string, width: number, bar: SVGElement, text: SVGElement}[]} */
    this.pins = [];
    /** @type {SVGElement | null} */
    this.side = null;
    this.wheels = wheels(skeleton);
    this.layout = layout;
    this.skeleton = skeleton;
    this.stated = stated;
    const unit = symbolOf("length", problem);
    const listed = Object.entries(layout.planes).sort(([, one], [, other]) => other - one);
    this.node = el(
      "section",
      { class: "planes", "aria-label": t`Planes` },
      el(
        "h3",
        { class: "minor" },
        layout.remark
          ? t`No layout`
          : [
              layout.count === 1 ? t`1 plane` : t`${layout.count} planes`,
              layout.least && t`the fewest there are`,
              t`${shown(Number(layout.height.toPrecision(4)))} ${unit} high`,
            ]
              .filter(Boolean)
              .join(", "),
      ),
      layout.remark && el("p", { class: "note", lang: foreign(layout.remark) }, translated(layout.remark)),
      listed.length > 0 && this.picture(),
      listed.length > 0 &&
        el(
          "ul",
          { class: "legend", "aria-label": t`Links by plane` },
          ...listed.map(([name, plane]) =>
            el(
              "li",
              {},
              svg(
                "svg",
                { viewBox: "0 0 26 16", width: 26, height: 16, "aria-hidden": "true" },
                svg("rect", { class: `slab ${planeClass(plane)}`, x: 1, y: 1, width: 24, height: 14, rx: 3 }),
                svg("text", { class: "plane-number", x: 13, y: 12.5 }, plane),
              ),
              el("span", { class: "hidden" }, t`Plane ${plane}`, ": "),
              words(name),
            ),
          ),
        ),
      listed.length > 0 &&
        el("p", { class: "note" }, t`Across it is in line with the picture above; upward it is not to scale.`),
      layout.stub_shafts.length > 0 &&
        el(
          "p",
          { class: "note" },
          t`Stub shafts at ${layout.stub_shafts.join(", ")}: no shaft can pass all planes there.`,
        ),
      ...this.clashes(unit, lead),
    );
  }

  /** @param {string} unit @param {(input: number) => void} lead */
  clashes(unit, lead) {
    const { clashes, free_range: range, free_stroke: stroke } = this.layout;
    if (!clashes.length)
      return [el("p", { class: "good" }, `✓ ${t`Nothing clashes over the motion that is looked at.`}`)].filter(
        () => !this.layout.remark,
      );
    const rounded = (/** @type {number} */ value) => shown(Math.round(10 * value) / 10);
    const free = range
      ? t`${`${rounded(range[0])}°`} to ${`${rounded(range[1])}°`}`
      : stroke
        ? t`${shown(stroke[0])} to ${`${shown(stroke[1])} ${unit}`}`
        : "";
    return [
      el(
        "ul",
        { class: "clashes" },
        ...clashes.map(({ parts, distance, input_angle: angle, input_place: place }) => {
          const at = angle ?? place ?? NaN;
          return el(
            "li",
            {},
            el("span", { class: "bad" }, `✗ ${t`${words(parts[0])} and ${term(parts[1])}`}: `),
            distance < 0
              ? t`${shown(Number((-distance).toPrecision(3)))} ${unit} into each other`
              : t`${shown(Number(distance.toPrecision(3)))} ${unit} apart`,
            " ",
            Number.isFinite(at) &&
              el(
                "button",
                { type: "button", class: "small", onclick: () => lead(at) },
                t`Go to ${`${rounded(at)}${angle === undefined ? ` ${unit}` : "°"}`}`,
              ),
          );
        }),
      ),
      el(
        "p",
        { class: "note" },
        free ? t`Nothing clashes from ${free}.` : t`No part of the motion is free of clashes.`,
      ),
    ];
  }

  /** The empty picture with its bases; links and pins come with the motion. */
  picture() {
    const { layout, stated, view } = this;
    const pitch = stated.thickness + (stated.gap ?? 0);
    const second = Object.values(layout.pins).some(([, high]) => high > layout.count);
    const room = HEIGHT - TOP - FOOT - BASE * (second ? 2 : 1);
    this.scale = Math.min(
      THICKEST / stated.thickness,
      room / (layout.count * pitch + (second ? (stated.gap ?? 0) : 0)),
    );
    const ceiling = this.floor - this.scale * (layout.count * pitch + (stated.gap ?? 0));
    const base = (/** @type {number} */ y) =>
      svg("rect", { class: "base", x: 30, y, width: view.width - 60, height: BASE });
    this.bars = Object.entries(layout.planes).map(([name, plane]) => ({
      name,
      bar: svg("rect", {
        class: `slab ${planeClass(plane)}`,
        y: this.below(plane) - this.scale * stated.thickness,
        height: this.scale * stated.thickness,
        rx: 3,
      }),
    }));
    this.pins = Object.entries(layout.pins).map(([name, [low, high]], k) => {
      const bottom = low === 0 ? this.floor + BASE : this.below(low);
      const top = high > layout.count ? ceiling - BASE : this.below(high) - this.scale * stated.thickness;
      const width = Math.max(4, view.scale * stated.pin_diameter);
      return {
        name,
        width,
        bar: svg("rect", {
          class: `shaft ${layout.stub_shafts.includes(name) ? "stub" : ""}`,
          y: top,
          height: bottom - top,
          width,
        }),
        text: svg("text", { class: "joint", y: HEIGHT - (k % 2 ? 6 : 24) }, name),
      };
    });
    this.side = svg(
      "svg",
      {
        viewBox: `0 0 ${view.width} ${HEIGHT}`,
        class: "canvas side",
        role: "img",
        "aria-label": second
          ? t`The linkage from the side: ${layout.count} planes between two bases`
          : t`The linkage from the side: ${layout.count} planes on a base`,
      },
      svg("rect", { class: "paper", width: view.width, height: HEIGHT }),
      base(this.floor),
      second && base(ceiling - BASE),
      ...Array.from({ length: layout.count }, (_, k) =>
        svg("text", { class: "tick", x: 10, y: this.below(k + 1) - 0.5 * this.scale * stated.thickness + 4 }, k + 1),
      ),
      ...this.bars.map(({ bar }) => bar),
      ...this.pins.flatMap(({ bar, text }) => [bar, text]),
    );
    return this.side;
  }

  /** Stay in line with the picture above where it shows more on either side. @param {number} more pixels */
  widen(more) {
    const frame = { x: -more, width: this.view.width + 2 * more };
    this.side?.setAttribute("viewBox", `${frame.x} 0 ${frame.width} ${HEIGHT}`);
    for (const [name, value] of Object.entries(frame)) this.side?.firstElementChild?.setAttribute(name, String(value));
  }

  /** Where a plane begins, pixels from above. @param {number} plane */
  below(plane) {
    const { thickness, gap = 0 } = this.stated;
    return this.floor - this.scale * ((plane - 1) * (thickness + gap) + gap);
  }

  /** @param {Places} places */
  show(places) {
    const half = 0.5 * this.stated.link_width;
    for (const { name, bar } of this.bars) {
      const wheel = this.wheels[name];
      const xs = wheel
        ? [wheel.centre[0] - wheel.radius + half, wheel.centre[0] + wheel.radius - half]
        : this.on(name).map((joint) => places[joint]?.[0] ?? NaN);
      span(bar, this.view.at(Math.min(...xs) - half, 0)[0], this.view.at(Math.max(...xs) + half, 0)[0]);
    }
    for (const { name, width, bar, text } of this.pins) {
      const [u] = this.view.at(places[name]?.[0] ?? NaN, 0);
      span(bar, u - width / 2, u + width / 2);
      text.toggleAttribute("hidden", !Number.isFinite(u));
      if (Number.isFinite(u)) text.setAttribute("x", u.toFixed(1));
    }
  }

  /** The joints that a plate takes in, those in its slots among them. @param {string} name @returns {string[]} */
  on(name) {
    const link = this.skeleton.links.find((one) => one.name === name);
    const slots = (this.skeleton.slides ?? []).filter((slide) => slide.link === name).map((slide) => slide.joint);
    return [...(link?.joints ?? []), ...slots];
  }
}

/** @param {SVGElement} bar @param {number} from @param {number} to */
function span(bar, from, to) {
  const known = Number.isFinite(from) && Number.isFinite(to);
  bar.toggleAttribute("hidden", !known);
  if (!known) return;
  bar.setAttribute("x", from.toFixed(1));
  bar.setAttribute("width", (to - from).toFixed(1));
}
