/** Animate a linkage from the arrays of its cycle, at the frame rate of the display. */

import { OtherCircuits, otherBranches, findTracedJoint, branchTrack } from "./circuits.js";
import { createElement, formatNumber, createSvg } from "../core/dom.js";
import { AngleGauge } from "../plots/gauge.js";
import { dragWithPointer } from "../canvas/grip.js";
import { LinkageDrawing, drawnJoints, groundedJoints, translateTo } from "../canvas/linkage_drawing.js";
import { t } from "../core/messages.js";
import { LinkPlanes, planeClass } from "./link_planes.js";
import { Player, interpolate, clampIndex } from "../core/player.js";
import { createPlots } from "../plots/plots.js";
import { qualityPlots, partPlots, partName, listParts } from "../plots/plotted_quantities.js";
import { WorkspaceView } from "../assembly/workspace_view.js";
import { Ruler } from "../canvas/ruler.js";
import { createScene } from "../canvas/stage.js";
import { SpringDrawings, springAnchors, listSprings } from "./springs.js";
import { SweptArea, jointPositions, findPosition, usedRange } from "./swept_area.js";
import { View } from "../core/view.js";

/** @import { Design, LinkageAnalysis, LinkedDesign, Problem, Schemas, Skeleton } from "../types/values.js" */

/** Height of the side view beneath a linkage in planes, with what stands below it, pixels. */
const PLANES_HEIGHT = 300;

/** @typedef {[number, number]} Point */
/** @typedef {{x: (number | null)[], y: (number | null)[]}} Track */
/** @typedef {{x: number, y: number, angle?: number}} Target */

/**
 * A layer of the picture that follows the motion: it receives the input.
 * @typedef {object} Companion
 * @property {SVGElement} node
 * @property {import("../core/view.js").Box} extent what the picture has to show with it, pixels
 * @property {(input: number, now: import("../canvas/linkage_drawing.js").Places, told: boolean) => void} show the
 *   layer at an input; `told`: whether its numbers are shown
 */

export class LinkageMotion {
  /**
   * @param {import("../canvas/stage.js").Frame} frame
   * @param {LinkedDesign} design
   * @param {LinkageAnalysis} motion
   * @param {Problem} problem
   * @param {LinkageAnalysis | null} [circuits] an analysis with `branches`, where there is one
   * @param {Point[]} [around] what else is to lie in the picture
   */
  constructor(frame, design, motion, problem, circuits, around = []) {
    this.frame = frame;
    const stated = /** @type {Schemas["LayoutSpec"] | null | undefined} */ (problem.layout);
    const layered = design.layout && stated;
    this.size = frame.availableSize(layered ? PLANES_HEIGHT : 0);
    this.motion = motion;
    this.skeleton = design.mechanism.skeleton;
    this.count = motion.input_angle.length;
    this.unit = problem.length_unit ?? "mm";
    /** Whether a slide drives. */
    this.slides = this.skeleton.links.every((link) => link.name !== this.skeleton.input_link);
    this.targets = listTargets(problem, design);
    const name = findTracedJoint(this.skeleton);
    this.room = new WorkspaceView(problem, design.mechanism);
    const points = [
      ...around,
      ...springAnchors(listSprings(design, problem)),
      ...this.room.extent,
      ...Object.keys(motion.joints).flatMap((joint) => this.jointTrack(joint)),
      ...this.targets.map((one) => /** @type {Point} */ ([one.x, one.y])),
      ...otherBranches(circuits).flatMap((branch) => branchTrack(branch, name)),
    ];
    this.view = new View(points, ...this.size, 44);
    const planes = design.layout?.planes ?? {};
    this.linkage = new LinkageDrawing(this.view, this.skeleton, {
      classes: Object.fromEntries(Object.entries(planes).map(([name, plane]) => [name, planeClass(Number(plane))])),
    });
    this.circuits = new OtherCircuits(this.view, this.skeleton, circuits);
    const closed = returnsToStart(motion, this.count);
    this.player = new Player({
      count: this.count,
      closed,
      label: t`Input`,
      reading: (at) => this.describePosition(at),
      show: (at, told) => this.show(at, told),
    });
    const range = usedRange(
      motion,
      this.room.cycle ? null : (design.metrics?.used_range ?? design.metrics?.used_stroke),
      closed,
    );
    this.sweep = new SweptArea(
      this.view,
      this.skeleton,
      this.room,
      (at) => jointPositions(motion, at),
      range,
      () => this.player.restrictTo(this.sweep.isShown ? range : null),
    );
    this.closed = closed;
    this.planes =
      design.layout && stated
        ? new LinkPlanes(this.view, this.skeleton, design.layout, problem, stated, (input) => this.lead(input))
        : null;
    this.gauge = motion.transmission_angle?.some((one) => one !== null)
      ? new AngleGauge(t`Transmission angle`, motion.transmission_angle, {
          limit: problem.constraints?.min_transmission_angle,
          measured: motion.min_transmission_angle,
          used: isPartialRange(design) ? design.metrics?.min_transmission_angle : null,
        })
      : null;
    /** @type {import("../plots/plots.js").PlotMark[]} */
    this.marks = [];
    /** @type {Companion | null} */
    this.companion = null;
    this.springs = new SpringDrawings(this.view, this.skeleton, listSprings(design, problem));
    this.picture = this.createLayers();
    this.build(design, problem);
    this.player.begin();
  }

  /** @param {string} name @returns {Point[]} */
  jointTrack(name) {
    const { x, y } = this.motion.joints[name];
    return x.map((one, k) => (one === null ? [NaN, NaN] : [one, Number(y[k])]));
  }

  /** Everything on the stage, one thing over the other. */
  createLayers() {
    const { view, skeleton } = this;
    const still = groundedJoints(skeleton);
    const moving = drawnJoints(skeleton).filter((name) => !still.includes(name));
    return createScene(view, t`The linkage in motion`, [
      this.sweep.node,
      this.room.draw(view),
      this.circuits.node,
      ...moving.map((name) =>
        createSvg("path", { class: name === "P" ? "curve" : "trail", d: view.pathData(this.jointTrack(name)) }),
      ),
      ...this.drawToggles(),
      ...this.targets.map((one, k) => this.createTarget(one, k)),
      this.springs.node,
      this.linkage.node,
    ]);
  }

  /** @param {LinkedDesign} design @param {Problem} problem */
  build(design, problem) {
    const { view, skeleton } = this;
    this.dragInput(groundedJoints(skeleton));
    const { slides, unit } = this;
    const along = slides ? ` ${unit}` : "°";
    const ruler = new Ruler(this.picture, view, unit, () => this.currentPlaces());
    const plotted = (/** @type {import("../plots/plots.js").PlotData[]} */ wanted) =>
      createPlots(wanted, this.motion.input_angle, (at) => this.player.leadTo(at), along);
    const force = plotted(qualityPlots(this.motion, design, problem));
    const box = createElement("div", { class: "plots" });
    const choices = listParts(this.motion, skeleton);
    const choose = (/** @type {string} */ part) => {
      this.marks = [...force, ...plotted(partPlots(this.motion, part, unit, slides))];
      box.replaceChildren(...this.marks.map((mark) => mark.figure));
      for (const mark of this.marks) mark.show(this.player.at, true);
    };
    const pick = createElement(
      "select",
      { id: "part", onchange: () => choose(pick.value) },
      ...choices.map((part) => createElement("option", { value: part }, partName(part))),
    );
    this.frame.fill({
      picture: this.picture,
      tools: [ruler.button],
      clock: this.player.row,
      below: [this.planes?.node],
      beside: [this.gauge?.node, this.sweep.control, this.circuits.control, ...this.room.legend],
      plots: [
        createElement(
          "div",
          { class: "row" },
          createElement("label", { for: "part" }, t`Plots of`),
          pick,
          createElement(
            "span",
            { class: "note" },
            slides
              ? t`Rates are per unit of input travel. Click in a plot to move there.`
              : t`Rates are per radian of the input. Click in a plot to move there.`,
          ),
        ),
        box,
      ],
    });
    if (choices.length) choose(choices[0]);
  }

  /** The crank, or the slider, can be taken by its pin and led along its way. @param {string[]} still */
  dragInput(still) {
    const name = findInputPin(this.skeleton, still);
    const pin = this.linkage.pins.find((one) => one.name === name);
    if (!pin) return;
    pin.dot.classList.add("led");
    // A finger is less exact than what is drawn.
    const hit = createSvg("circle", { class: "hit" });
    pin.dot.before(hit);
    const { x, y } = this.motion.joints[pin.name];
    for (const grip of [pin.dot, hit]) {
      dragWithPointer(grip, this.picture, this.view, {
        taken: () => this.player.stop(),
        led: (at) => this.player.leadTo(nearestIndex(x, y, at, this.player.at)),
      });
    }
  }

  /** The linkage at the toggles that end its branch, and the crank's pin at those of every circuit. */
  drawToggles() {
    const { motion, skeleton, view } = this;
    const ends = this.listToggleSamples().map((k) => {
      const ghost = new LinkageDrawing(view, skeleton, { names: false, faint: true });
      ghost.moveTo(
        Object.fromEntries(
          Object.keys(motion.joints).map((name) => [
            name,
            motion.joints[name].x[k] === null ? null : this.jointTrack(name)[k],
          ]),
        ),
      );
      ghost.node.setAttribute("class", "faint toggle");
      return ghost.node;
    });
    const still = groundedJoints(skeleton);
    const link = skeleton.links.find((one) => one.name === skeleton.input_link);
    const [pivot, pin] = [
      link?.joints.find((/** @type {string} */ one) => still.includes(one)),
      findInputPin(skeleton, still),
    ];
    if (!pivot || !pin || !link) return ends;
    const [[ox, oy], [ax, ay]] = [skeleton.joints[pivot], skeleton.joints[pin]];
    const crank = Math.hypot(ax - ox, ay - oy);
    return [
      ...ends,
      ...motion.toggles.map((/** @type {number} */ degrees) => {
        const angle = (degrees * Math.PI) / 180;
        const place = view.toPicture(ox + crank * Math.cos(angle), oy + crank * Math.sin(angle));
        return createSvg(
          "g",
          { class: "stop", transform: translateTo(place) },
          createSvg("title", {}, t`Toggle at ${formatNumber(Math.round(10 * degrees) / 10)}°`),
          createSvg("path", { d: "M-5 -5l10 10m0 -10l-10 10" }),
        );
      }),
    ];
  }

  /** Samples at which the motion ends at a toggle. @returns {number[]} */
  listToggleSamples() {
    const here = this.motion.circuits.flatMap((one) => one.branches).find((one) => one.reference);
    return here && !here.full ? [0, this.count - 1] : [];
  }

  /** @param {Target} one @param {number} k */
  createTarget(one, k) {
    const angle = ((one.angle ?? 0) * Math.PI) / 180;
    return createSvg(
      "g",
      { class: "goal", transform: translateTo(this.view.toPicture(one.x, one.y)) },
      createSvg("circle", {}),
      one.angle !== undefined && createSvg("line", { x2: 26 * Math.cos(angle), y2: -26 * Math.sin(angle) }),
      this.targets.length <= 12 && createSvg("text", { dx: "0.6em", dy: "1.15em" }, k + 1),
    );
  }

  /** Where all joints are now. @returns {Point[]} */
  currentPlaces() {
    return Object.values(this.currentJoints()).filter((one) => one !== null);
  }

  /** The same by the joints' names. */
  currentJoints() {
    return jointPositions(this.motion, this.player.at);
  }

  /**
   * Show the motion at a place of its arrays, between samples on a straight line.
   * @param {number} at
   * @param {boolean} [told] whether its numbers are shown
   */
  show(at, told = true) {
    const now = jointPositions(this.motion, at);
    this.linkage.moveTo(now);
    this.springs.show(now);
    this.room.show(now);
    this.planes?.show(now);
    this.circuits.show(interpolate(this.motion.input_angle, at));
    this.gauge?.show(interpolate(this.motion.transmission_angle, at), told);
    this.companion?.show(Number(interpolate(this.motion.input_angle, at)), now, told);
    for (const mark of this.marks) mark.show(at, told);
  }

  /** Lead the motion to an input. @param {number} input */
  lead(input) {
    this.player.leadTo(clampIndex(findPosition(this.motion.input_angle, input, this.closed), this.count - 1));
  }

  /**
   * Draw something into the picture that goes with the motion, or nothing any more.
   * @param {Companion | null} companion
   */
  addCompanion(companion) {
    this.companion?.node.remove();
    this.companion = companion;
    if (companion) this.picture.append(companion.node);
    const box = companion?.extent ?? this.view.box;
    const [width, height] = this.size;
    const more = Math.max(0, -box.x, box.x + box.width - width, -box.y, box.y + box.height - height);
    // The view from the side stays in line with all of the picture.
    const whole = { x: -more, y: -more, width: width + 2 * more, height: height + 2 * more };
    this.frame.zoom?.fit(this.planes && companion ? whole : box);
    this.planes?.widen(more);
    this.show(this.player.at);
  }

  /** @param {number} at */
  describePosition(at) {
    const input = Number(interpolate(this.motion.input_angle, at));
    return `${formatNumber(Math.round(10 * input) / 10)}${this.slides ? ` ${this.unit}` : "°"}`;
  }

  pause() {
    this.player.stop();
  }

  stop() {
    this.player.stop();
  }
}

/**
 * The pin by which the input is led: of the crank, or of the slide that drives.
 * @param {Skeleton} skeleton
 * @param {string[]} still
 * @returns {string | undefined}
 */
function findInputPin(skeleton, still) {
  const link = skeleton.links.find((one) => one.name === skeleton.input_link);
  return link ? link.joints.find((/** @type {string} */ one) => !still.includes(one)) : skeleton.input_link;
}

/**
 * The demanded positions or points, where a design that was placed freely has them.
 * @param {Problem} problem
 * @param {Partial<Design> | null} design
 * @returns {Target[]}
 */
export function listTargets(problem, design) {
  const listed = (problem.positions ?? problem.points ?? []).filter((one) => Number.isFinite(one?.x));
  const placed = design?.placement;
  if (!placed) return listed;
  const turn = (placed.rotation * Math.PI) / 180;
  const [c, s] = [placed.size * Math.cos(turn), placed.size * Math.sin(turn)];
  return listed.map((/** @type {Target} */ { x, y }) => ({
    x: c * x - s * y + placed.shift[0],
    y: s * x + c * y + placed.shift[1],
  }));
}

/**
 * Whether a limit was measured over a part of the motion: between the targets of a design, or over what its cognate
 * uses.
 * @param {LinkedDesign} design
 */
function isPartialRange(design) {
  return (
    Number.isFinite(design.metrics?.min_transmission_angle) &&
    (design.targets === undefined || design.targets.length > 1)
  );
}

/** Whether the last configuration is the first again. @param {LinkageAnalysis} motion @param {number} count */
function returnsToStart(motion, count) {
  const tracks = Object.values(/** @type {Record<string, Track>} */ (motion.joints));
  const spread = Math.max(
    ...tracks.map((track) => Math.max(...track.x.map(Number)) - Math.min(...track.x.map(Number))),
  );
  const last = count - 1;
  return tracks.every(
    ({ x, y }) =>
      x[0] !== null &&
      x[last] !== null &&
      Math.hypot(Number(x[0]) - Number(x[last]), Number(y[0]) - Number(y[last])) < 1e-6 * Math.max(spread, 1e-300),
  );
}

/**
 * The sample of a track that is nearest to a point; of equally near ones, as where a crank turns twice, the one at
 * hand.
 * @param {(number | null)[]} x @param {(number | null)[]} y @param {Point} point @param {number} at
 */
function nearestIndex(x, y, point, at) {
  const away = x.map((one, k) => (one === null ? Infinity : Math.hypot(one - point[0], Number(y[k]) - point[1])));
  const least = Math.min(...away);
  let best = away.indexOf(least);
  for (let k = 0; k < away.length; k++) {
    if (away[k] <= least * (1 + 1e-6) && Math.abs(k - at) < Math.abs(best - at)) best = k;
  }
  return best;
}
