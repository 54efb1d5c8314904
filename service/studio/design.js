/** One design in full: its motion, its numbers, its checks, its drawing and its files. */

import * as api from "./api.js";
import { Barrel } from "./barrel.js";
import { Disc } from "./cam.js";
import { cognates, picker } from "./cognates.js";
import { overTheCycle, withSkeleton } from "./cycle.js";
import { el, words } from "./dom.js";
import { downloads } from "./downloads.js";
import { Explorer } from "./explorer.js";
import { Gears } from "./gears.js";
import { checks, dimensions, figures, table } from "./figures.js";
import { Mover } from "./mover.js";

/** Samples of a cycle. */
const STEPS = 240;

/** Of a turn of what has no toggles: a sample a degree. */
const TURN_STEPS = 360;

/** What shows a mechanism that is no linkage. @type {Record<string, new (place: HTMLElement, design: any, motion: any, problem: any) => Moving>} */
const VIEWS = {
  cam: Disc, barrel_cam: Barrel, gear_train: Gears, planetary_train: Gears, gearbox: Gears, layshaft_gearbox: Gears,
};

/** @typedef {{stop: () => void}} Moving */
/** @typedef {{choice: import("./cognates.js").Choice, design: any, motion: any, circuits: any}} Film */

export class Shown {
  /** @param {HTMLElement} place @param {api.Job} job @param {number} n @param {(problem: any) => void} state begins another statement */
  constructor(place, job, n, state) {
    this.job = job;
    this.n = n;
    this.design = job.result.designs[n];
    this.gone = new AbortController();
    /** @type {Moving | null} */
    this.moving = null;
    /** @type {Moving | null} */
    this.explorer = null;
    this.url = "";
    this.stage = el("div", { class: "moving" });
    this.drawing = el("figure", { class: "drawing" });
    this.before = el("div", {});
    place.replaceChildren(el("h3", {}, `Design ${n + 1}: ${words(this.design.mechanism.type)}`), this.before, this.stage, ...this.explored(state),
      downloads(job, n, this.drawing),
      el("div", { class: "columns" }, checks(this.design), table("Quantities", figures(this.design)), dimensions(this.design)), this.drawing);
    this.move();
    this.draw();
  }

  get current() {
    return !this.gone.signal.aborted;
  }

  async draw() {
    const url = await api.file(this.job.id, this.n, "svg").catch((error) => {
      this.drawing.replaceChildren(el("figcaption", {}, error.message));
    });
    if (!url) return;
    if (!this.current) return URL.revokeObjectURL(url);
    this.url = url;
    this.drawing.replaceChildren(el("img", { src: url, alt: `Drawing of design ${this.n + 1} with its dimensions` }));
  }

  async move() {
    const { mechanism } = this.design;
    this.stage.append(el("p", { class: "note" }, "The motion is being computed …"));
    try {
      const View = VIEWS[mechanism.type];
      if (View) {
        const turning = await api.motion(this.job.id, this.n, TURN_STEPS);
        if (this.current) this.show(() => new View(this.stage, this.design, turning, this.job.problem));
        return;
      }
      const at = mechanism.reference_input_angle;
      const question = { mechanism, ...(Number.isFinite(at) ? { motion: { at } } : {}), include: ["branches"] };
      const [motion, circuits, choices] = await Promise.all([
        api.motion(this.job.id, this.n, STEPS),
        // Without other circuits the motion is still worth seeing.
        api.analysis(question, this.gone.signal).catch(() => null),
        cognates(this.design, this.job.problem, this.gone.signal),
      ]);
      const films = await Promise.all(choices.map((choice, k) => (k ? this.film(choice) : { choice, design: this.design, motion, circuits })));
      if (this.current) this.offer(films.filter((one) => one !== null));
    } catch (error) {
      if (this.current) this.stage.replaceChildren(el("p", { class: "error" }, /** @type {Error} */ (error).message));
    }
  }

  /** @param {() => Moving} make */
  show(make) {
    this.moving?.stop();
    this.moving = make();
  }

  /** The motion of a cognate; null where it cannot be driven. @param {import("./cognates.js").Choice} choice @returns {Promise<Film | null>} */
  async film(choice) {
    const found = await overTheCycle(choice.mechanism, STEPS, this.gone.signal).catch(() => null);
    return found && { ...found, choice, design: { ...this.design, mechanism: withSkeleton(choice.mechanism, found.motion) } };
  }

  /** Show the design, with its cognates to switch to: all in one frame, so that the curve stays where it is. @param {Film[]} films */
  offer(films) {
    const around = films.length < 2 ? [] : films.flatMap(({ motion }) => Object.values(motion.joints).flatMap((/** @type {any} */ track) =>
      track.x.map((/** @type {number | null} */ x, /** @type {number} */ k) => (x === null ? [NaN, NaN] : [x, track.y[k]]))));
    const show = (/** @type {Film} */ film) => this.show(() => new Mover(this.stage, film.design, film.motion, this.job.problem, film.circuits, around));
    show(films[0]);
    if (films.length > 1) {
      this.before.replaceChildren(picker(films.map((film) => film.choice), (choice) => show(films.find((film) => film.choice === choice) ?? films[0])));
    }
  }

  /** The place where a linkage's pins are dragged. @param {(problem: any) => void} state */
  explored(state) {
    const { type, skeleton } = this.design.mechanism;
    const { problem } = this.job;
    if (type !== "fourbar" || !skeleton?.joints.P) return [];
    const inside = el("div");
    const details = el("details", { id: "explore", ontoggle: () => {
      this.explorer?.stop();
      this.explorer = details.open ? new Explorer(inside, this.design.mechanism, problem, (joints) => state(begun(problem, joints))) : null;
    } }, el("summary", {}, "Explore: drag its pins"), inside);
    return [details];
  }

  stop() {
    this.gone.abort();
    this.moving?.stop();
    this.explorer?.stop();
    if (this.url) URL.revokeObjectURL(this.url);
  }
}

/** The problem with fixed pivots demanded, where its kind can. @param {any} problem @param {Record<string, [number, number]>} joints */
function begun(problem, { O2, O4 }) {
  const round = (/** @type {[number, number]} */ at) => at.map((one) => Number(one.toPrecision(6)));
  if (problem.kind === "motion") {
    const side = (/** @type {any} */ choices, /** @type {[number, number]} */ at) => ({ dyad: choices.dyad, fixed_pivot: round(at) });
    return { ...problem, input_side: side(problem.input_side, O2), output_side: side(problem.output_side, O4) };
  }
  return "fixed_pivots" in problem ? { ...problem, fixed_pivots: { input: round(O2), output: round(O4) } } : problem;
}
