/** Animate a cam under its follower, with s v a j diagrams and the pressure angle. */

import { createElement, formatNumber, createSvg } from "../core/dom.js";
import { joinUnit, isRounding } from "../design/design_metrics.js";
import { AngleGauge } from "../plots/gauge.js";
import { t } from "../core/messages.js";
import { interpolate } from "../core/player.js";
import { resampleCurve } from "../plots/plotted_quantities.js";
import { createScene } from "../canvas/stage.js";
import { RotaryView } from "./rotary_view.js";
import { View } from "../core/view.js";

/** @import { Merged, Problem, Schemas } from "../types/values.js" */

/** Length of a follower's stem beyond its roller or face, as a share of the base radius. */
const STEM_LENGTH = 0.8;

/** @typedef {[number, number]} Point */
/** @typedef {Merged<Schemas["CamMechanism"] | Schemas["BarrelCamMechanism"]>} Cam */
/** @typedef {Merged<Schemas["CamAnalysis"] | Schemas["BarrelCamAnalysis"]>} CamMotion */

/**
 * Displacement and its derivatives over the motion, with the pressure angle.
 * @param {Cam} mechanism
 * @param {CamMotion} motion
 * @param {Problem} problem
 * @returns {import("../plots/plots.js").PlotData[]}
 */
export function createDiagrams(mechanism, motion, problem) {
  const { program } = mechanism;
  // A turn of the cam comes back to its beginning.
  const angles = [...program.angle, 360];
  const over = (/** @type {"s" | "v" | "a" | "j"} */ name) =>
    resampleCurve(angles, [...program[name], program[name][0]], motion.input_angle);
  const swings = mechanism.follower.type.startsWith("oscillating");
  const unit = problem.length_unit;
  const rate = swings ? "rad" : unit;
  const titles = {
    s: t`Displacement s (${swings ? "°" : unit})`,
    v: t`Velocity v (${rate}/rad)`,
    a: t`Acceleration a (${rate}/rad²)`,
    j: t`Jerk j (${rate}/rad³)`,
  };
  const lift = Math.max(...program.s) - Math.min(...program.s);
  return [
    .../** @type {const} */ (["s", "v", "a", "j"]).map((name) => ({
      title: titles[name],
      lines: { "": over(name) },
      values: program[name],
      least: lift,
    })),
    {
      title: t`Pressure angle (°)`,
      lines: { "": motion.pressure_angle },
      limit: problem.limits?.pressure_angle,
      least: 1,
    },
  ];
}

/** What a disc cam and a barrel have in common: gauge and diagrams. */
export class CamView extends RotaryView {
  /**
   * @param {import("../canvas/stage.js").Frame} frame
   * @param {Schemas["CamDesign"] | Schemas["BarrelCamDesign"]} design
   * @param {Schemas["CamAnalysis"] | Schemas["BarrelCamAnalysis"]} motion
   * @param {Problem} problem
   */
  constructor(frame, design, motion, problem) {
    super(frame, t`Cam`, motion.input_angle);
    /** @type {CamMotion} */
    this.motion = motion;
    /** @type {Cam} */
    this.mechanism = design.mechanism;
    this.problem = problem;
    // What the scene of each kind decides.
    this.view = new View([], ...this.size);
    this.sense = 1;
    this.radius = 0;
    this.turn = 0;
    /** @type {number[]} */
    this.spin = [];
    const plotted = createDiagrams(this.mechanism, motion, problem);
    this.displacement = plotted[0].lines[""];
    const drawn = this.drawn();
    // A flat face that only moves along has none.
    this.gauge = motion.pressure_angle.some((one) => Number(one) > 0.01)
      ? new AngleGauge(t`Pressure angle`, motion.pressure_angle, {
          limit: problem.limits?.pressure_angle,
          atMost: true,
        })
      : null;
    this.facts = createElement("dl", { class: "facts" });
    this.fill(createScene(this.view, this.label, drawn), [this.gauge?.node, this.facts], plotted);
  }

  /** What the picture shows, in words. */
  get label() {
    return t`The cam, turning under its follower`;
  }

  /** @returns {Element[]} */
  drawn() {
    return [];
  }

  /** @param {number} _at @param {number} _angle radians that the cam has turned */
  put(_at, _angle) {}

  /** @param {number} at @param {boolean} told */
  show(at, told) {
    const degrees = Number(interpolate(this.motion.input_angle, at));
    this.put(at, (degrees * Math.PI) / 180);
    this.gauge?.show(interpolate(this.motion.pressure_angle, at), told);
  }
}

export class DiscCamView extends CamView {
  get disc() {
    return /** @type {Schemas["CamMechanism"]} */ (this.mechanism);
  }

  get contact() {
    return /** @type {Schemas["CamAnalysis"]} */ (this.motion).contact;
  }

  drawn() {
    const { follower, profile, pitch_curve: pitch, outer_wall: wall, second } = this.disc;
    this.sense = this.mechanism.rotation === "cw" ? -1 : 1;
    this.radius = follower.roller_radius ?? 0;
    this.rolls = follower.type.endsWith("roller");
    this.swings = follower.type.startsWith("oscillating");
    this.base = this.disc.base_radius ?? Number(this.disc.prime_radius) - this.radius;
    const outline = curvePoints(profile);
    const far = Math.max(
      ...outline.map(([x, y]) => Math.hypot(x, y)),
      ...(wall ? curvePoints(wall).map(([x, y]) => Math.hypot(x, y)) : []),
    );
    const high = Math.max(
      ...pitch.x.map((/** @type {number} */ x, /** @type {number} */ k) => Math.hypot(x, pitch.y[k])),
    );
    const reach = this.swings
      ? [(follower.pivot_distance ?? 0) + 0.1 * this.base, 0.2 * this.base]
      : [high + this.radius + STEM_LENGTH * this.base, 0];
    const beside = second
      ? Math.max(...curvePoints(second.pitch_curve).map(([x, y]) => Math.hypot(x, y))) + this.radius
      : 0;
    const wide = Math.max(far, high, beside);
    this.view = new View([[-wide, -wide], [wide, wide], /** @type {Point} */ (reach)], ...this.size, 32);
    const { view } = this;
    const [u, v] = view.toPicture(0, 0);
    const circle = (/** @type {string} */ kind, /** @type {number} */ radius) =>
      createSvg("circle", { class: kind, cx: u, cy: v, r: view.scale * radius });
    this.cam = createSvg(
      "g",
      { class: "cam" },
      wall && createSvg("circle", { class: "disc", cx: u, cy: v, r: 1.06 * view.scale * far }),
      wall && createSvg("path", { class: "hollow", d: `${view.pathData(curvePoints(wall))}Z` }),
      createSvg("path", { class: "profile", d: `${view.pathData(outline)}Z` }),
      second && createSvg("path", { class: "conjugate", d: `${view.pathData(curvePoints(second.profile))}Z` }),
      this.rolls && createSvg("path", { class: "pitch", d: `${view.pathData(curvePoints(pitch))}Z` }),
      createSvg("path", {
        class: "spoke",
        d: view.pathData([
          [0, 0],
          [0.5 * this.base, 0],
        ]),
      }),
    );
    this.spin = this.computeRolling();
    this.wheel = createSvg(
      "g",
      { class: "roller" },
      createSvg("circle", { class: "tyre", r: Math.max(2, view.scale * this.radius) }),
      this.radius > 0 &&
        createSvg("path", {
          d: [0, 60, 120]
            .map((turn) => {
              const [c, s] = [
                0.85 * view.scale * this.radius * Math.cos((turn * Math.PI) / 180),
                0.85 * view.scale * this.radius * Math.sin((turn * Math.PI) / 180),
              ];
              return `M${-c} ${-s}L${c} ${s}`;
            })
            .join(""),
        }),
    );
    this.holder = createSvg("path", { class: "holder" });
    this.other = createSvg(
      "g",
      { class: "roller" },
      createSvg("circle", { class: "tyre", r: Math.max(2, view.scale * this.radius) }),
    );
    this.touch = createSvg("circle", { class: "touch", r: 3.5 });
    this.normal = createSvg("line", { class: "normal" });
    const pivot =
      this.swings &&
      createSvg("circle", { class: "pin", r: 5, cx: view.toPicture(follower.pivot_distance ?? 0, 0)[0], cy: v });
    return [
      circle("rim", this.base),
      this.cam,
      circle("pin", 4 / view.scale),
      this.normal,
      this.holder,
      ...(this.rolls ? [this.wheel] : []),
      ...(second ? [this.other] : []),
      this.touch,
      ...(pivot ? [pivot] : []),
    ];
  }

  /**
   * How far the roller has turned at each sample: its contact has gone along it as far as along the profile.
   * @returns {number[]} radians
   */
  computeRolling() {
    const { x, y } = this.contact;
    if (!this.rolls || !(this.radius > 0)) return [];
    let travelled = 0;
    let before = 0;
    return x.map(Number).map((one, k) => {
      if (k > 0) travelled += Math.hypot(one - Number(x[k - 1]), Number(y[k]) - Number(y[k - 1]));
      const angle = (this.motion.input_angle[k] * Math.PI) / 180;
      const [[cx, cy], [tx, ty]] = [this.followerCentre(angle), rotatePoint([one, Number(y[k])], this.sense * angle)];
      let toward = Math.atan2(ty - cy, tx - cx);
      toward += 2 * Math.PI * Math.round((before - toward) / (2 * Math.PI));
      before = toward;
      return toward - (this.sense * travelled) / this.radius;
    });
  }

  /** Of the roller, in the ground's frame. @param {number} angle @returns {Point} */
  followerCentre(angle) {
    const { angle: at, x, y } = this.mechanism.pitch_curve;
    const past = (/** @type {number} */ from, /** @type {number} */ to) =>
      to - from - 360 * Math.floor((to - from) / 360);
    const degrees = past(0, (angle * 180) / Math.PI);
    // Points stand closer where the cam is curved most.
    let [k, end] = [0, at.length];
    while (end - k > 1) {
      const middle = (k + end) >> 1;
      if (at[middle] <= degrees) k = middle;
      else end = middle;
    }
    const next = (k + 1) % at.length;
    const share = past(at[k], degrees) / (past(at[k], at[next]) || 360);
    return rotatePoint([x[k] + share * (x[next] - x[k]), y[k] + share * (y[next] - y[k])], this.sense * angle);
  }

  /** @param {number} at @param {number} angle */
  put(at, angle) {
    const {
      view,
      mechanism: { follower },
    } = this;
    const [u, v] = view.toPicture(0, 0);
    this.cam?.setAttribute("transform", `rotate(${(-this.sense * angle * 180) / Math.PI} ${u} ${v})`);
    const [across, up] = [interpolate(this.contact.x, at), interpolate(this.contact.y, at)];
    if (across === null || up === null) return;
    const touching = rotatePoint([across, up], this.sense * angle);
    const [tu, tv] = view.toPicture(...touching);
    this.touch?.setAttribute("cx", String(tu));
    this.touch?.setAttribute("cy", String(tv));
    if (this.rolls) {
      const centre = this.followerCentre(angle);
      const [cu, cv] = view.toPicture(...centre);
      const spin = this.spin.length ? Number(interpolate(this.spin, at)) : 0;
      this.wheel?.setAttribute(
        "transform",
        `translate(${cu.toFixed(2)} ${cv.toFixed(2)}) rotate(${((-spin * 180) / Math.PI).toFixed(2)})`,
      );
      for (const [name, value] of Object.entries({ x1: tu, y1: tv, x2: 3 * cu - 2 * tu, y2: 3 * cv - 2 * tv }))
        this.normal?.setAttribute(name, String(value));
      const end = /** @type {Point} */ (
        this.swings
          ? [follower.pivot_distance ?? 0, 0]
          : [centre[0] + this.radius + STEM_LENGTH * (this.base ?? 0), centre[1]]
      );
      const other = this.oppositeCentre(centre);
      this.holder?.setAttribute(
        "d",
        view.pathData(other ? [...(this.swings ? [centre, end, other] : [other, centre, end])] : [centre, end]),
      );
      if (other)
        this.other?.setAttribute(
          "transform",
          `translate(${view
            .toPicture(...other)
            .map((one) => one.toFixed(2))
            .join(" ")})`,
        );
    } else this.holder?.setAttribute("d", this.facePath(touching));
    const what = this.swings ? t`Arm` : t`Follower`;
    this.facts?.replaceChildren(createElement("dt", {}, what), createElement("dd", {}, this.followerDisplacement(at)));
  }

  /**
   * The second roller of conjugate cams, which the same follower carries.
   * @param {Point} centre
   * @returns {Point | null}
   */
  oppositeCentre([x, y]) {
    const { second, follower } = this.mechanism;
    if (!second) return null;
    if (!this.swings) return [x - (second.roller_distance ?? 0), y];
    const [u, v] = rotatePoint(
      [x - (follower.pivot_distance ?? 0), y],
      (-this.sense * (follower.sense ?? 1) * ((second.arm_angle ?? 0) * Math.PI)) / 180,
    );
    return [(follower.pivot_distance ?? 0) + u, v];
  }

  /** Displacement of the follower. @param {number} at */
  followerDisplacement(at) {
    const { s } = this.mechanism.program;
    const value = Number(interpolate(this.displacement, at));
    const lift = Math.max(...s) - Math.min(...s);
    const told = formatNumber(isRounding(value, lift) ? 0 : Number(value.toPrecision(4)));
    return joinUnit(told, this.swings ? "°" : String(this.problem.length_unit ?? "mm"));
  }

  /** A flat face through the contact, with what carries it. @param {Point} touching */
  facePath(touching) {
    const {
      view,
      mechanism: { follower },
      base = 0,
    } = this;
    const [x, y] = touching;
    if (!this.swings) {
      const half = Math.max(0.45 * base, 1.1 * Math.abs(y));
      return (
        view.pathData([
          [x, -half],
          [x, half],
        ]) +
        view.pathData([
          [x, 0],
          [x + STEM_LENGTH * base, 0],
        ])
      );
    }
    const [rx, ry] = [x - (follower.pivot_distance ?? 0), y];
    const offset = follower.face_offset ?? 0;
    const foot = Math.sqrt(Math.max(rx * rx + ry * ry - offset * offset, 0));
    // reach / (foot − i offset·sense): the direction of the face, away from the pivot.
    const [c, s] = [foot, -offset * (follower.sense ?? 1)];
    const size = c * c + s * s || 1;
    const [ax, ay] = [(rx * c + ry * s) / size, (ry * c - rx * s) / size];
    const near = rx * ax + ry * ay;
    const start = /** @type {Point} */ ([x - near * ax, y - near * ay]);
    return (
      view.pathData([start, [x + 0.35 * base * ax, y + 0.35 * base * ay]]) +
      view.pathData([start, [follower.pivot_distance ?? 0, 0]])
    );
  }
}

/** @param {Point} point @param {number} angle @returns {Point} */
function rotatePoint([x, y], angle) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return [c * x - s * y, s * x + c * y];
}

/** @param {{x: number[], y: number[]}} curve @returns {Point[]} */
function curvePoints({ x, y }) {
  return x.map((one, k) => [one, y[k]]);
}
