/** Animate a Geneva drive: the crank turns steadily, the wheel in steps. */

import { createElement, formatNumber, createSvg } from "../core/dom.js";
import { t } from "../core/messages.js";
import { createScene } from "../canvas/stage.js";
import { RotaryView } from "./rotary_view.js";
import { View } from "../core/view.js";

/** @import { Merged, Schemas } from "../types/values.js" */

/** Steps of a drawn arc. */
const ARC_STEPS = 48;

/** From the wheel's axis to where the crank of a spherical drive is shown, in radii of the sphere. */
const CRANK_DISTANCE = 2.4;

/** @typedef {[number, number]} Point */

export class GenevaView extends RotaryView {
  /**
   * @param {import("../canvas/stage.js").Frame} frame
   * @param {Merged<Schemas["IndexingDesign"]>} design
   * @param {Schemas["GenevaAnalysis"]} motion
   */
  constructor(frame, design, motion) {
    super(frame, t`Crank`, motion.input_angle, { endless: true });
    const { mechanism } = design;
    this.motion = motion;
    const external = mechanism.type === "geneva_external";
    const spherical = mechanism.type === "geneva_spherical";
    /** The wheel turns against the crank, or with it. */
    this.sense = external ? -1 : 1;
    // Half an index of the crank, by the axes' angles.
    const half = external ? 90 - 180 / mechanism.stations : spherical ? 90 : 90 + 180 / mechanism.stations;
    // As the first roller enters a slot, the crank turning counter-clockwise; that of a sphere is seen along its own
    // axis.
    this.begin = {
      wheel: (-this.sense * 180) / mechanism.stations,
      crank: (external ? 180 : spherical ? 90 : 0) - half,
    };
    const { disc, rollers, reach, centre } = spherical
      ? sphericalCap(/** @type {Schemas["SphericalGenevaMechanism"]} */ (mechanism))
      : crankOutline(/** @type {Schemas["GenevaMechanism"]} */ (mechanism));
    const wheel = curvePoints(mechanism.profile);
    const outside = mechanism.ring_radius ?? Math.max(...wheel.map(([x, y]) => Math.hypot(x, y)));
    const far = reach + mechanism.roller_diameter / 2;
    /** Before the crank, where that is not the input. */
    this.link = mechanism.drag_link ?? null;
    this.centre = centre;
    const wide = this.link
      ? [
          [this.link.input_pivot[0] - this.link.input, -this.link.input],
          [this.link.input_pivot[0] + this.link.input, this.link.input],
        ]
      : [];
    const view = new View(
      /** @type {Point[]} */ ([
        [-outside, -outside],
        [outside, outside],
        [centre - far, -far],
        [centre + far, far],
        ...wide,
      ]),
      ...this.size,
      40,
    );
    this.view = view;
    this.bars = createSvg("path", { class: "link" });
    this.axes = [view.toPicture(0, 0), view.toPicture(centre, 0)];
    const [[u, v]] = this.axes;
    this.wheel = createSvg("path", { class: "teeth", d: `${view.pathData(wheel)}Z` });
    const pins = rollers.map(([x, y]) => view.toPicture(x + centre, y));
    this.crank = createSvg(
      "g",
      {},
      createSvg("path", {
        class: "teeth",
        d: `${view.pathData(disc.map(([x, y]) => /** @type {Point} */ ([x + centre, y])))}Z`,
      }),
      createSvg("path", {
        class: "spoke",
        d: pins.map((pin) => `M${this.axes[1].join(" ")}L${pin.join(" ")}`).join(""),
      }),
      ...pins.map(([cx, cy]) =>
        createSvg("circle", { class: "tyre", cx, cy, r: (view.scale * mechanism.roller_diameter) / 2 }),
      ),
    );
    const picture = createScene(view, t`The Geneva drive, turning`, [
      mechanism.ring_radius &&
        createSvg(
          "g",
          { class: "wheel t0" },
          createSvg("circle", { class: "pitch", cx: u, cy: v, r: view.scale * mechanism.ring_radius }),
        ),
      createSvg("g", { class: "wheel t0" }, this.wheel),
      createSvg("g", { class: "wheel t1" }, this.crank),
      this.link && this.bars,
      ...this.axes.map(([cx, cy]) => createSvg("circle", { class: "pin", cx, cy, r: 3.5 })),
    ]);
    this.angle = createElement("dd", {});
    this.state = createElement("dd", {});
    this.fill(
      picture,
      [
        createElement(
          "dl",
          { class: "facts speeds" },
          createElement("dt", {}, t`Wheel`),
          this.angle,
          createElement("dt", {}, t`Motion`),
          this.state,
        ),
      ],
      [
        { title: t`Wheel turned (°)`, lines: { "": motion.angle } },
        { title: t`Velocity v (${"rad"}/rad)`, lines: { "": motion.omega } },
        { title: t`Acceleration a (${"rad"}/rad²)`, lines: { "": motion.alpha } },
      ],
    );
  }

  /** @param {number} at */
  show(at) {
    const { motion, begin, sense } = this;
    const turned = this.interpolateSeries(motion.angle, at);
    const turns = [begin.wheel + sense * turned, begin.crank + this.interpolateSeries(motion.crank, at)];
    if (this.link)
      this.bars.setAttribute(
        "d",
        this.view.pathData(
          chainBars(
            this.link,
            this.centre,
            this.link.entry_angle + this.interpolateSeries(motion.input_angle, at),
            turns[1],
          ),
        ),
      );
    [this.wheel, this.crank].forEach((part, k) => {
      part.setAttribute(
        "transform",
        `rotate(${(-turns[k]).toFixed(3)} ${this.axes[k][0].toFixed(2)} ${this.axes[k][1].toFixed(2)})`,
      );
    });
    this.angle.textContent = `${formatNumber(Math.round(10 * turned) / 10)}°`;
    this.state.textContent = motion.moves[Math.round(this.clampPosition(at))] ? t`turns` : t`rests, locked`;
  }
}

/**
 * Disc and rollers of a plane drive, about the crank's axis, with the first roller along x.
 * @param {Schemas["GenevaMechanism"]} mechanism
 */
function crankOutline(mechanism) {
  const { angle, outer_radius: outer, inner_radius: inner } = mechanism.disc;
  const edge = (/** @type {number[]} */ radii) => radii.map((radius, k) => fromPolar(radius, angle[k]));
  const rollers = Array.from({ length: mechanism.rollers }, (_, k) =>
    fromPolar(mechanism.crank_radius, (360 * k) / mechanism.rollers),
  );
  const disc = inner.some((/** @type {number} */ radius) => radius > 0)
    ? [...edge(outer), ...edge(inner).reverse()]
    : edge(outer);
  return { disc, rollers, reach: mechanism.crank_radius, centre: mechanism.center_distance };
}

/**
 * Input, coupler and output of a drag link.
 * @param {Schemas["DragLinkDriver"]} link
 * @param {number} centre
 * @param {number} input
 * @param {number} crank degrees
 * @returns {Point[]}
 */
function chainBars(link, centre, input, crank) {
  const [x, y] = link.input_pivot;
  const [u, v] = fromPolar(link.input, input + 180);
  const [s, t] = fromPolar(link.output, crank - link.crank_offset);
  return [
    [x, y],
    [x + u, y + v],
    [centre + s, t],
    [centre, 0],
  ];
}

/**
 * Cap and roller of a spherical drive, seen along the crank's axis, with the roller along x.
 * @param {Schemas["SphericalGenevaMechanism"]} mechanism
 */
function sphericalCap(mechanism) {
  const radius = mechanism.sphere_radius * Math.sin((mechanism.cap_angle * Math.PI) / 180);
  const end = 90 + (Math.asin(Math.min(1, mechanism.cap_offset / radius)) * 180) / Math.PI;
  const disc = Array.from({ length: ARC_STEPS + 1 }, (_, k) =>
    fromPolar(radius, end + ((360 - 2 * end) * k) / ARC_STEPS),
  );
  const reach = mechanism.sphere_radius * Math.sin((mechanism.cone_angle * Math.PI) / 180);
  return {
    disc,
    rollers: [/** @type {Point} */ ([reach, 0])],
    reach,
    centre: CRANK_DISTANCE * mechanism.sphere_radius,
  };
}

/** @param {number} radius @param {number} degrees @returns {Point} */
function fromPolar(radius, degrees) {
  const angle = (degrees * Math.PI) / 180;
  return [radius * Math.cos(angle), radius * Math.sin(angle)];
}

/** @param {{x: number[], y: number[]}} curve @returns {Point[]} */
function curvePoints({ x, y }) {
  return x.map((one, k) => [one, y[k]]);
}
