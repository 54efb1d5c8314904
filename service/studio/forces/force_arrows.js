/** Draw forces as arrows on the moving linkage, at every pin and slide. */

import { createElement, formatNumber, createSvg } from "../core/dom.js";
import { slideAngle } from "../canvas/linkage_drawing.js";
import { t, term } from "../core/messages.js";
import { interpolate } from "../core/player.js";

/** @import { LinkageAnalysis, Skeleton } from "../types/values.js" */

/** @typedef {[number, number]} Point */
/** @typedef {(number | null)[]} Series */
/**
 * @typedef {{joint: string, on: string, from: string, x: Series, y: Series}} Force what acts on a link at a joint, and
 *   which side it comes from
 */

/** Length of the arrow of the greatest force, as a share of the picture's height. */
const PEAK_SHARE = 0.2;

/** Length and half the width of a head, pixels; a short arrow has a shorter one. */
const ARROW_HEAD = [11, 4.5];

/**
 * Every force in a joint of an answer: of its pin on each of its links, and of the lines of slides.
 * @param {LinkageAnalysis} answer
 * @param {Skeleton} skeleton
 * @param {{joint: string, on: string[], lean: number}[]} slides
 * @returns {Force[]}
 */
export function collectForces(answer, skeleton, slides) {
  const { joints = {}, slides: lines = [] } = answer.dynamics ?? {};
  const pins = Object.entries(joints ?? {}).flatMap(([joint, links]) =>
    Object.entries(links).map(([on, { x, y }]) => ({ joint, on, from: `pin ${joint}`, x, y })),
  );
  return [
    ...pins,
    ...(lines ?? []).flatMap(({ joint, normal, friction }, k) => {
      /** @type {Point[]} */
      const turned = normal.map((across, at) => {
        const along = friction[at];
        if (across === null || along === null) return [NaN, NaN];
        const angle = slideAngle(
          slides[k],
          Object.fromEntries(
            slides[k].on.map((name) => [
              name,
              /** @type {Point} */ ([answer.joints[name].x[at], answer.joints[name].y[at]]),
            ]),
          ),
        );
        return [along * Math.cos(angle) - across * Math.sin(angle), along * Math.sin(angle) + across * Math.cos(angle)];
      });
      const series = (/** @type {number} */ axis, /** @type {number} */ sign) =>
        turned.map((one) => (Number.isFinite(one[axis]) ? sign * one[axis] : null));
      const line = skeleton.slides[k].link;
      return [
        { joint, on: `pin ${joint}`, from: `line of ${line}`, x: series(0, 1), y: series(1, 1) },
        { joint, on: line, from: `pin ${joint}`, x: series(0, -1), y: series(1, -1) },
      ];
    }),
  ];
}

/**
 * One force for each joint, on the moving link that bears most there, and one for each slide, on its pin.
 * @param {Force[]} forces
 */
function selectOnePerJoint(forces) {
  const pinned = forces
    .filter(({ on }) => on !== "ground" && !on.startsWith("pin "))
    .sort((one, other) => peakMagnitude(other) - peakMagnitude(one));
  return [
    ...pinned.filter(({ joint }, k) => pinned.findIndex((other) => other.joint === joint) === k),
    ...forces.filter(({ on }) => on.startsWith("pin ")),
  ];
}

/** @param {Force} force */
function peakMagnitude({ x, y }) {
  return x.reduce(
    (/** @type {number} */ most, one, k) => (one === null ? most : Math.max(most, Math.hypot(one, Number(y[k])))),
    0,
  );
}

/** What a force comes from or acts on, as a person reads it. @param {string} part */
function describePart(part) {
  const [, kind, name] = /^(pin|line of) (.*)$/.exec(part) ?? [];
  return kind === undefined ? term(part) : kind === "pin" ? t`pin ${name}` : t`line of ${term(name)}`;
}

export class ForceArrows {
  /**
   * @param {import("../core/view.js").View} view @param {Force[]} forces @param {string} unit of forces
   * @param {Record<string, {x: Series, y: Series}>} tracks of the joints, over the same arrays as the forces
   * @param {(input: number) => number | null} placeAt place of the forces' arrays at an input
   */
  constructor(view, forces, unit, tracks, placeAt) {
    this.view = view;
    this.placeAt = placeAt;
    this.forces = forces;
    this.peak = Math.max(0, ...forces.map(peakMagnitude));
    /** Pixels for a unit of force. */
    this.scale = this.peak > 0 ? (PEAK_SHARE * view.height) / this.peak : 0;
    this.extent = this.arrowExtent(tracks);
    /** @type {{force: Force, node: SVGElement, shaft: SVGElement, head: SVGElement}[]} */
    this.arrows = [];
    this.layer = createSvg("g", {});
    this.input = NaN;
    /** @type {import("../canvas/linkage_drawing.js").Places} */
    this.now = {};
    this.node = createSvg("g", { class: "forces" }, this.layer, this.createLegend(unit));
    this.choice = createElement(
      "select",
      { id: "force-on", onchange: () => this.chooseLink(this.choice.value) },
      createElement("option", { value: "" }, t`one link per joint`),
      ...[...new Set(forces.map(({ on }) => on))]
        .filter((on) => !on.startsWith("pin "))
        .map((on) => createElement("option", { value: on }, term(on))),
    );
    this.chooseLink("");
  }

  /**
   * What the picture has to show with the arrows, pixels.
   * @param {Record<string, {x: Series, y: Series}>} tracks
   * @returns {import("../core/view.js").Box}
   */
  arrowExtent(tracks) {
    const { x: west, y: north, width, height } = this.view.box;
    const sides = [west, north, west + width, north + height];
    for (const { joint, x, y } of this.forces) {
      x.forEach((one, k) => {
        const [px, py] = [tracks[joint].x[k], tracks[joint].y[k]];
        if (one === null || px === null || py === null) return;
        const [u, v] = this.view.toPicture(px, py);
        const [tip, top] = [u + this.scale * one, v - this.scale * Number(y[k])];
        sides[0] = Math.min(sides[0], tip - ARROW_HEAD[1]);
        sides[1] = Math.min(sides[1], top - ARROW_HEAD[1]);
        sides[2] = Math.max(sides[2], tip + ARROW_HEAD[1]);
        sides[3] = Math.max(sides[3], top + ARROW_HEAD[1]);
      });
    }
    return { x: sides[0], y: sides[1], width: sides[2] - sides[0], height: sides[3] - sides[1] };
  }

  /** Draw the forces on one link, or one for each joint. @param {string} link */
  chooseLink(link) {
    const chosen = link ? this.forces.filter(({ on }) => on === link) : selectOnePerJoint(this.forces);
    this.arrows = chosen.map((force) => {
      const [shaft, head] = [
        createSvg("line", { class: "shaft-of-force" }),
        createSvg("path", { class: "head-of-force" }),
      ];
      return {
        force,
        shaft,
        head,
        node: createSvg(
          "g",
          { class: "force", "data-joint": force.joint, "data-on": force.on },
          createSvg("title", {}, t`Force of ${describePart(force.from)} on ${describePart(force.on)}`),
          shaft,
          head,
        ),
      };
    });
    this.layer.replaceChildren(...this.arrows.map(({ node }) => node));
    if (Number.isFinite(this.input)) this.show(this.input, this.now);
  }

  /** An arrow of a round number, and what it stands for. @param {string} unit */
  createLegend(unit) {
    const [x, y] = [this.extent.x + 12, this.extent.y + this.extent.height - 12];
    if (!this.peak) return createSvg("text", { class: "force-scale", x, y }, t`No joint carries a force.`);
    const power = 10 ** Math.floor(Math.log10(this.peak));
    const value = power * ([5, 2, 1].find((one) => one * power <= this.peak) ?? 1);
    const length = this.scale * value;
    const [shaft, head] = [
      createSvg("line", { class: "shaft-of-force" }),
      createSvg("path", { class: "head-of-force" }),
    ];
    drawArrow(shaft, head, [x, y], [length, 0]);
    return createSvg(
      "g",
      { class: "force-scale", "data-force": value, "data-length": length },
      shaft,
      head,
      createSvg("text", { x: x + length + 10, y: y + 4 }, `${formatNumber(value)} ${unit}`.trim()),
    );
  }

  /** @param {number} input @param {import("../canvas/linkage_drawing.js").Places} now */
  show(input, now) {
    this.input = input;
    this.now = now;
    const at = this.placeAt(input);
    for (const { force, node, shaft, head } of this.arrows) {
      const place = now[force.joint];
      const [x, y] = at === null ? [null, null] : [interpolate(force.x, at), interpolate(force.y, at)];
      node.toggleAttribute("hidden", !place || x === null || y === null);
      if (place && x !== null && y !== null)
        drawArrow(shaft, head, this.view.toPicture(...place), [this.scale * x, -this.scale * y]);
    }
  }
}

/** @param {SVGElement} shaft @param {SVGElement} head @param {Point} from @param {Point} by pixels */
function drawArrow(shaft, head, [u, v], [du, dv]) {
  const length = Math.hypot(du, dv);
  for (const [name, value] of Object.entries({ x1: u, y1: v, x2: u + du, y2: v + dv }))
    shaft.setAttribute(name, value.toFixed(2));
  if (!(length > 1e-3)) return head.setAttribute("d", "");
  const [long, half] = ARROW_HEAD.map((one) => one * Math.min(1, length / ARROW_HEAD[0]));
  const [c, s] = [du / length, dv / length];
  const corner = (/** @type {number} */ side) =>
    `${(u + du - long * c - side * half * s).toFixed(2)} ${(v + dv - long * s + side * half * c).toFixed(2)}`;
  head.setAttribute("d", `M${(u + du).toFixed(2)} ${(v + dv).toFixed(2)}L${corner(1)}L${corner(-1)}Z`);
}
