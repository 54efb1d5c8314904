/** Show the planes of a linkage from the side, below its motion, with collisions. */

import { createElement, formatNumber, createSvg, toWords } from "../core/dom.js";
import { groundedJoints } from "../canvas/linkage_drawing.js";
import { t, term } from "../core/messages.js";
import { unitSymbol } from "../core/units.js";

/** @import { Layout, Problem, Schemas, Skeleton } from "../types/values.js" */

/** @typedef {[number, number]} Point */
/** @typedef {import("../canvas/linkage_drawing.js").Places} Places */

const PICTURE_HEIGHT = 210;
const TOP_MARGIN = 12;
const FOOT_HEIGHT = 44;

/** Height of a base, pixels. */
const BASE_HEIGHT = 14;

/** Maximum thickness of a drawn plane, pixels: the side view is not to scale in height. */
const MAX_THICKNESS = 26;

/** Colours of the planes; with more planes they repeat. */
const COLOUR_COUNT = 8;

/** @param {number} plane */
export function planeClass(plane) {
  return `plane p${((plane - 1) % COLOUR_COUNT) + 1}`;
}

/**
 * Wheels as they stand on the ground: those that mesh, or an idler between them.
 * @param {Skeleton} skeleton
 * @returns {Record<string, {centre: Point, radius: number}>}
 */
function wheelBodies(skeleton) {
  const still = groundedJoints(skeleton);
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

export class LinkPlanes {
  /**
   * @param {import("../core/view.js").View} view of the linkage: both pictures stand one above the other
   * @param {Skeleton} skeleton
   * @param {Layout} layout
   * @param {Problem} problem
   * @param {Schemas["LayoutSpec"]} stated the requested layout
   * @param {(input: number) => void} lead leads the motion to an input
   */
  constructor(view, skeleton, layout, problem, stated, lead) {
    this.view = view;
    this.floor = PICTURE_HEIGHT - FOOT_HEIGHT - BASE_HEIGHT;
    /** Pixels for a length unit upward. */
    this.scale = 1;
    /** @type {{name: string, bar: SVGElement}[]} */
    this.bars = [];
    /** @type {{name: string, width: number, bar: SVGElement, text: SVGElement}[]} */
    this.pins = [];
    /** @type {SVGElement | null} */
    this.side = null;
    this.wheels = wheelBodies(skeleton);
    this.layout = layout;
    this.skeleton = skeleton;
    this.stated = stated;
    const unit = unitSymbol("length", problem);
    const listed = Object.entries(layout.planes).sort(([, one], [, other]) => other - one);
    this.node = createElement(
      "section",
      { class: "planes", "aria-label": t`Planes` },
      createElement(
        "h3",
        { class: "minor" },
        layout.remark
          ? t`No layout`
          : [
              layout.count === 1 ? t`1 plane` : t`${layout.count} planes`,
              layout.least && t`the minimum number`,
              t`height ${formatNumber(Number(layout.height.toPrecision(4)))} ${unit}`,
            ]
              .filter(Boolean)
              .join(", "),
      ),
      layout.remark && createElement("p", { class: "note" }, layout.remark),
      listed.length > 0 && this.createPicture(),
      listed.length > 0 &&
        createElement(
          "ul",
          { class: "legend", "aria-label": t`Links by plane` },
          ...listed.map(([name, plane]) =>
            createElement(
              "li",
              {},
              createSvg(
                "svg",
                { viewBox: "0 0 26 16", width: 26, height: 16, "aria-hidden": "true" },
                createSvg("rect", { class: `slab ${planeClass(plane)}`, x: 1, y: 1, width: 24, height: 14, rx: 3 }),
                createSvg("text", { class: "plane-number", x: 13, y: 12.5 }, plane),
              ),
              createElement("span", { class: "hidden" }, t`Plane ${plane}`, ": "),
              toWords(name),
            ),
          ),
        ),
      listed.length > 0 &&
        createElement("p", { class: "note" }, t`Horizontally aligned with the picture above; vertically not to scale.`),
      layout.stub_shafts.length > 0 &&
        createElement(
          "p",
          { class: "note" },
          t`Stub shafts at ${layout.stub_shafts.join(", ")}: no shaft can pass through all planes there.`,
        ),
      ...this.createClashes(unit, lead),
    );
  }

  /** @param {string} unit @param {(input: number) => void} lead */
  createClashes(unit, lead) {
    const { clashes, free_range: range, free_stroke: stroke } = this.layout;
    if (!clashes.length)
      return [createElement("p", { class: "good" }, `✓ ${t`No collision in the motion checked.`}`)].filter(
        () => !this.layout.remark,
      );
    const rounded = (/** @type {number} */ value) => formatNumber(Math.round(10 * value) / 10);
    const free = range
      ? t`${`${rounded(range[0])}°`} to ${`${rounded(range[1])}°`}`
      : stroke
        ? t`${formatNumber(stroke[0])} to ${`${formatNumber(stroke[1])} ${unit}`}`
        : "";
    return [
      createElement(
        "ul",
        { class: "clashes" },
        ...clashes.map(({ parts, distance, input_angle: angle, input_place: place }) => {
          const at = angle ?? place ?? NaN;
          return createElement(
            "li",
            {},
            createElement("span", { class: "bad" }, `✗ ${t`${toWords(parts[0])} and ${term(parts[1])}`}: `),
            distance < 0
              ? t`${formatNumber(Number((-distance).toPrecision(3)))} ${unit} overlap`
              : t`${formatNumber(Number(distance.toPrecision(3)))} ${unit} apart`,
            " ",
            Number.isFinite(at) &&
              createElement(
                "button",
                { type: "button", class: "small", onclick: () => lead(at) },
                t`Go to ${`${rounded(at)}${angle === undefined ? ` ${unit}` : "°"}`}`,
              ),
          );
        }),
      ),
      createElement(
        "p",
        { class: "note" },
        free ? t`No collision from ${free}.` : t`No part of the motion is free of collisions.`,
      ),
    ];
  }

  /** The empty picture with its bases; links and pins come with the motion. */
  createPicture() {
    const { layout, stated, view } = this;
    const pitch = stated.thickness + (stated.gap ?? 0);
    const second = Object.values(layout.pins).some(([, high]) => high > layout.count);
    const room = PICTURE_HEIGHT - TOP_MARGIN - FOOT_HEIGHT - BASE_HEIGHT * (second ? 2 : 1);
    this.scale = Math.min(
      MAX_THICKNESS / stated.thickness,
      room / (layout.count * pitch + (second ? (stated.gap ?? 0) : 0)),
    );
    const ceiling = this.floor - this.scale * (layout.count * pitch + (stated.gap ?? 0));
    const base = (/** @type {number} */ y) =>
      createSvg("rect", { class: "base", x: 30, y, width: view.width - 60, height: BASE_HEIGHT });
    this.bars = Object.entries(layout.planes).map(([name, plane]) => ({
      name,
      bar: createSvg("rect", {
        class: `slab ${planeClass(plane)}`,
        y: this.planeTop(plane) - this.scale * stated.thickness,
        height: this.scale * stated.thickness,
        rx: 3,
      }),
    }));
    this.pins = Object.entries(layout.pins).map(([name, [low, high]], k) => {
      const bottom = low === 0 ? this.floor + BASE_HEIGHT : this.planeTop(low);
      const top = high > layout.count ? ceiling - BASE_HEIGHT : this.planeTop(high) - this.scale * stated.thickness;
      const width = Math.max(4, view.scale * stated.pin_diameter);
      return {
        name,
        width,
        bar: createSvg("rect", {
          class: `shaft ${layout.stub_shafts.includes(name) ? "stub" : ""}`,
          y: top,
          height: bottom - top,
          width,
        }),
        text: createSvg("text", { class: "joint", y: PICTURE_HEIGHT - (k % 2 ? 6 : 24) }, name),
      };
    });
    this.side = createSvg(
      "svg",
      {
        viewBox: `0 0 ${view.width} ${PICTURE_HEIGHT}`,
        class: "canvas side",
        role: "img",
        "aria-label": second
          ? t`The linkage from the side: ${layout.count} planes between two bases`
          : t`The linkage from the side: ${layout.count} planes on a base`,
      },
      createSvg("rect", { class: "paper", width: view.width, height: PICTURE_HEIGHT }),
      base(this.floor),
      second && base(ceiling - BASE_HEIGHT),
      ...Array.from({ length: layout.count }, (_, k) =>
        createSvg(
          "text",
          { class: "tick", x: 10, y: this.planeTop(k + 1) - 0.5 * this.scale * stated.thickness + 4 },
          k + 1,
        ),
      ),
      ...this.bars.map(({ bar }) => bar),
      ...this.pins.flatMap(({ bar, text }) => [bar, text]),
    );
    return this.side;
  }

  /** Stay in line with the picture above where it shows more on either side. @param {number} more pixels */
  widen(more) {
    const frame = { x: -more, width: this.view.width + 2 * more };
    this.side?.setAttribute("viewBox", `${frame.x} 0 ${frame.width} ${PICTURE_HEIGHT}`);
    for (const [name, value] of Object.entries(frame)) this.side?.firstElementChild?.setAttribute(name, String(value));
  }

  /** Where a plane begins, pixels from above. @param {number} plane */
  planeTop(plane) {
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
        : this.linkSpan(name).map((joint) => places[joint]?.[0] ?? NaN);
      barSpan(
        bar,
        this.view.toPicture(Math.min(...xs) - half, 0)[0],
        this.view.toPicture(Math.max(...xs) + half, 0)[0],
      );
    }
    for (const { name, width, bar, text } of this.pins) {
      const [u] = this.view.toPicture(places[name]?.[0] ?? NaN, 0);
      barSpan(bar, u - width / 2, u + width / 2);
      text.toggleAttribute("hidden", !Number.isFinite(u));
      if (Number.isFinite(u)) text.setAttribute("x", u.toFixed(1));
    }
  }

  /** The joints that a plate takes in, those in its slots among them. @param {string} name @returns {string[]} */
  linkSpan(name) {
    const link = this.skeleton.links.find((one) => one.name === name);
    const slots = (this.skeleton.slides ?? []).filter((slide) => slide.link === name).map((slide) => slide.joint);
    return [...(link?.joints ?? []), ...slots];
  }
}

/** @param {SVGElement} bar @param {number} from @param {number} to */
function barSpan(bar, from, to) {
  const known = Number.isFinite(from) && Number.isFinite(to);
  bar.toggleAttribute("hidden", !known);
  if (!known) return;
  bar.setAttribute("x", from.toFixed(1));
  bar.setAttribute("width", (to - from).toFixed(1));
}
