/** Forces as arrows on the linkage that moves: at every pin and slide, with the length that a force has. */

import { el, shown, svg } from "../core/dom.js";
import { slope } from "../canvas/linkage_drawing.js";
import { t, term } from "../core/messages.js";
import { between } from "../core/player.js";

/** @import { LinkageAnalysis, Skeleton } from "../types/values.js" */

/** @typedef {[number, number]} Point */
/** @typedef {(number | null)[]} Series */
/**
 * @typedef {{joint: string, on: string, from: string, x: Series, y: Series}} Force what acts on a link at a joint, and
 *   which side it comes from
 */

/** The greatest force is so much of the picture's height. */
const SHARE = 0.2;

/** Length and half the width of a head, pixels; a short arrow has a shorter one. */
const HEAD = [11, 4.5];

/**
 * Every force in a joint of an answer: of its pin on each of its links, and of the lines of slides.
 * @param {LinkageAnalysis} answer
 * @param {Skeleton} skeleton
 * @param {{joint: string, on: string[], lean: number}[]} slides
 * @returns {Force[]}
 */
export function forcesIn(answer, skeleton, slides) {
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
        const angle = slope(
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
function once(forces) {
  const pinned = forces
    .filter(({ on }) => on !== "ground" && !on.startsWith("pin "))
    .sort((one, other) => peakOf(other) - peakOf(one));
  return [
    ...pinned.filter(({ joint }, k) => pinned.findIndex((other) => other.joint === joint) === k),
    ...forces.filter(({ on }) => on.startsWith("pin ")),
  ];
}

/** @param {Force} force */
function peakOf({ x, y }) {
  return x.reduce(
    (/** @type {number} */ most, one, k) => (one === null ? most : Math.max(most, Math.hypot(one, Number(y[k])))),
    0,
  );
}

/** What a force comes from or acts on, as a person reads it. @param {string} part */
function called(part) {
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
    this.peak = Math.max(0, ...forces.map(peakOf));
    /** Pixels for a unit of force. */
    this.scale = this.peak > 0 ? (SHARE * view.height) / this.peak : 0;
    this.extent = this.reach(tracks);
    /** @type {{force: Force, node: SVGElement, shaft: SVGElement, head: SVGElement}[]} */
    this.arrows = [];
    this.layer = svg("g", {});
    this.input = NaN;
    /** @type {import("../canvas/linkage_drawing.js").Places} */
    this.now = {};
    this.node = svg("g", { class: "forces" }, this.layer, this.legend(unit));
    this.choice = el(
      "select",
      { id: "force-on", onchange: () => this.choose(this.choice.value) },
      el("option", { value: "" }, t`a link of each joint`),
      ...[...new Set(forces.map(({ on }) => on))]
        .filter((on) => !on.startsWith("pin "))
        .map((on) => el("option", { value: on }, term(on))),
    );
    this.choose("");
  }

  /**
   * What the picture has to show with the arrows, pixels.
   * @param {Record<string, {x: Series, y: Series}>} tracks
   * @returns {import("../core/view.js").Box}
   */
  reach(tracks) {
    const { x: west, y: north, width, height } = this.view.box;
    const sides = [west, north, west + width, north + height];
    for (const { joint, x, y } of this.forces) {
      x.forEach((one, k) => {
        const [px, py] = [tracks[joint].x[k], tracks[joint].y[k]];
        if (one === null || px === null || py === null) return;
        const [u, v] = this.view.at(px, py);
        const [tip, top] = [u + this.scale * one, v - this.scale * Number(y[k])];
        sides[0] = Math.min(sides[0], tip - HEAD[1]);
        sides[1] = Math.min(sides[1], top - HEAD[1]);
        sides[2] = Math.max(sides[2], tip + HEAD[1]);
        sides[3] = Math.max(sides[3], top + HEAD[1]);
      });
    }
    return { x: sides[0], y: sides[1], width: sides[2] - sides[0], height: sides[3] - sides[1] };
  }

  /** Draw the forces on one link, or one for each joint. @param {string} link */
  choose(link) {
    const chosen = link ? this.forces.filter(({ on }) => on === link) : once(this.forces);
    this.arrows = chosen.map((force) => {
      const [shaft, head] = [svg("line", { class: "shaft-of-force" }), svg("path", { class: "head-of-force" })];
      return {
        force,
        shaft,
        head,
        node: svg(
          "g",
          { class: "force", "data-joint": force.joint, "data-on": force.on },
          svg("title", {}, t`Force of ${called(force.from)} on ${called(force.on)}`),
          shaft,
          head,
        ),
      };
    });
    this.layer.replaceChildren(...this.arrows.map(({ node }) => node));
    if (Number.isFinite(this.input)) this.show(this.input, this.now);
  }

  /** An arrow of a round number, and what it stands for. @param {string} unit */
  legend(unit) {
    const [x, y] = [this.extent.x + 12, this.extent.y + this.extent.height - 12];
    if (!this.peak) return svg("text", { class: "force-scale", x, y }, t`No joint bears a force.`);
    const power = 10 ** Math.floor(Math.log10(this.peak));
    const value = power * ([5, 2, 1].find((one) => one * power <= this.peak) ?? 1);
    const length = this.scale * value;
    const [shaft, head] = [svg("line", { class: "shaft-of-force" }), svg("path", { class: "head-of-force" })];
    draw(shaft, head, [x, y], [length, 0]);
    return svg(
      "g",
      { class: "force-scale", "data-force": value, "data-length": length },
      shaft,
      head,
      svg("text", { x: x + length + 10, y: y + 4 }, `${shown(value)} ${unit}`.trim()),
    );
  }

  /** @param {number} input @param {import("../canvas/linkage_drawing.js").Places} now */
  show(input, now) {
    this.input = input;
    this.now = now;
    const at = this.placeAt(input);
    for (const { force, node, shaft, head } of this.arrows) {
      const place = now[force.joint];
      const [x, y] = at === null ? [null, null] : [between(force.x, at), between(force.y, at)];
      node.toggleAttribute("hidden", !place || x === null || y === null);
      if (place && x !== null && y !== null)
        draw(shaft, head, this.view.at(...place), [this.scale * x, -this.scale * y]);
    }
  }
}

/** @param {SVGElement} shaft @param {SVGElement} head @param {Point} from @param {Point} by pixels */
function draw(shaft, head, [u, v], [du, dv]) {
  const length = Math.hypot(du, dv);
  for (const [name, value] of Object.entries({ x1: u, y1: v, x2: u + du, y2: v + dv }))
    shaft.setAttribute(name, value.toFixed(2));
  if (!(length > 1e-3)) return head.setAttribute("d", "");
  const [long, half] = HEAD.map((one) => one * Math.min(1, length / HEAD[0]));
  const [c, s] = [du / length, dv / length];
  const corner = (/** @type {number} */ side) =>
    `${(u + du - long * c - side * half * s).toFixed(2)} ${(v + dv - long * s + side * half * c).toFixed(2)}`;
  head.setAttribute("d", `M${(u + du).toFixed(2)} ${(v + dv).toFixed(2)}L${corner(1)}L${corner(-1)}Z`);
}
