/** Show one design in full: motion, numbers, checks, drawing and files. */

import * as api from "../core/api.js";
import { AssemblyView } from "../assembly/assembly_view.js";
import { BurmesterCurves } from "../canvas/burmester_curves.js";
import { fetchCognates, createPicker } from "./cognate_choice.js";
import { fetchCycle, addSkeleton } from "../motion/cycle.js";
import { createElement } from "../core/dom.js";
import { createDownloads } from "./design_files.js";
import { Explorer } from "../explorer/explorer.js";
import { ForcesPane } from "../forces/forces.js";
import {
  createChecks,
  createDimensions,
  listFigures,
  createTolerances,
  createTable,
  typeName,
} from "./design_metrics.js";
import { t } from "../core/messages.js";
import { LinkageMotion, listTargets } from "../motion/linkage_motion.js";
import { createThumbnail } from "../motion/thumbnail.js";
import { STEP_COUNT, TURN_STEP_COUNT, VIEWS } from "../motion/motion_views.js";

/** @import { Design, LinkageAnalysis, Linked, LinkedDesign, Problem, Question, Solved } from "../types/values.js" */

const DESIGN_TITLE = t`Checks, drawing and files belong to the design; choose it above the numbers to see them.`;

/** @typedef {import("../motion/motion_views.js").Moving} Moving */
/**
 * @typedef {{choice: import("./cognate_choice.js").Choice, design: LinkedDesign, motion: LinkageAnalysis, circuits:
 *   LinkageAnalysis | null}} Film
 */

export class DesignView {
  /**
   * @param {import("./workbench.js").Workbench} desk
   * @param {Solved} job
   * @param {number} n
   * @param {(problem: Problem, solved?: boolean) => void} state begins another statement
   * @param {Moving | null} [before] what stands still on the stage until this design moves there
   */
  constructor(desk, job, n, state, before = null) {
    this.desk = desk;
    this.state = state;
    /** @type {BurmesterCurves | null} */
    this.curves = null;
    this.gone = new AbortController();
    this.url = "";
    /** @type {Moving | null} */
    this.moving = null;
    this.before = before;
    /** What else is to lie in the picture of a linkage. @type {[number, number][]} */
    this.around = [];
    /** Told whenever something else moves. */
    this.told = () => {};
    /** Shows what moves once more. */
    this.again = () => {};
    /** @type {Explorer | null} */
    this.explorer = null;
    /** @type {ForcesPane | null} */
    this.forces = null;
    /** @type {AssemblyView | null} */
    this.assembly = null;
    /** Whether another design has taken its place. */
    this.ended = false;
    this.forced = desk.forced;
    this.drawing = createElement("figure", { class: "drawing" });
    this.job = job;
    this.n = n;
    this.design = job.result.designs[n];
    this.showBurmester(job, n);
    this.showDesign(job, n, t`Design ${n + 1}`);
  }

  /** Show a design of a job. @param {Solved} job @param {number} n @param {string} title */
  showDesign(job, n, title) {
    this.leave();
    this.job = job;
    this.n = n;
    this.design = job.result.designs[n];
    this.gone = new AbortController();
    this.drawing = createElement("figure", { class: "drawing" });
    const named = `${title}: ${typeName(this.design)}`;
    this.desk.title.replaceChildren(named);
    this.desk.shown = this.design;
    this.desk.stage.offerMotion(true, named);
    this.desk.stage.showMode("watch");
    this.desk.before.replaceChildren();
    this.createExplorer(this.design);
    this.forced.replaceChildren(...this.showForces());
    this.desk.numbers.replaceChildren(...this.showNumbers());
    this.desk.files.replaceChildren(...this.showFiles());
    this.showAssembly();
    this.showMotion(this.gone.signal);
    this.drawStill(this.gone.signal);
  }

  /** Show the numbers of the design. */
  showNumbers() {
    const { design, job } = this;
    return [
      createElement(
        "div",
        { class: "columns" },
        createChecks(design, job.problem),
        createTable(t`Quantities`, listFigures(design), job.problem),
        ...createTolerances(design, job.problem),
        createDimensions(design, job.problem),
      ),
    ];
  }

  /** Show the files and the drawing. */
  showFiles() {
    return [createDownloads(this.job, this.n, this.drawing), this.drawing];
  }

  /** @param {AbortSignal} gone */
  async drawStill(gone) {
    const url = await api.downloadFile(this.job.id, this.n, "svg", gone).catch((error) => {
      if (!gone.aborted) this.drawing.replaceChildren(createElement("figcaption", {}, error.message));
    });
    if (!url) return;
    if (gone.aborted) return URL.revokeObjectURL(url);
    this.url = url;
    this.drawing.replaceChildren(
      createElement("img", { src: url, alt: t`Drawing of design ${this.n + 1} with its dimensions` }),
    );
  }

  /** @param {AbortSignal} gone */
  async showMotion(gone) {
    const { mechanism } = this.design;
    const { frame } = this.desk;
    if (!frame.isIdle) frame.markWaiting(true);
    else
      frame.showMessage(
        createThumbnail(this.design) ?? "",
        createElement("p", { class: "note" }, t`Computing the motion …`),
      );
    try {
      const View = VIEWS[mechanism.type];
      if (View) {
        const turning = await api.fetchMotion(this.job.id, this.n, TURN_STEP_COUNT, gone);
        if (gone.aborted) return;
        this.again = () => this.show(() => new View(frame, this.design, turning, this.job.problem));
        return this.again();
      }
      const at = mechanism.reference_input_angle;
      /** @type {Question} */
      const question = {
        mechanism,
        ...(typeof at === "number" && Number.isFinite(at) ? { motion: { at } } : {}),
        include: ["branches"],
      };
      // One after the other: the service analyses for others too.
      const motion = /** @type {LinkageAnalysis} */ (await api.fetchMotion(this.job.id, this.n, STEP_COUNT, gone));
      // Without other circuits the motion is still worth seeing.
      const circuits = await api.analyse(question, gone).catch(() => null);
      const choices = await fetchCognates(this.design, this.job.problem, gone);
      /** @type {(Film | null)[]} */
      const films = [{ choice: choices[0], design: /** @type {LinkedDesign} */ (this.design), motion, circuits }];
      for (const choice of choices.slice(1)) films.push(await this.fetchFilm(choice));
      if (!gone.aborted) this.offerFilms(films.filter((one) => one !== null));
    } catch (error) {
      if (!gone.aborted)
        frame.showMessage(createElement("p", { class: "error" }, /** @type {Error} */ (error).message));
    }
  }

  /** @param {() => Moving} make @param {boolean} [own] whether it is the design that moves, and not a cognate of it */
  show(make, own = true) {
    this.moving?.stop();
    this.before?.stop();
    this.before = null;
    this.moving = make();
    this.forced.toggleAttribute("hidden", !own);
    this.forces?.attach(this.mover);
    if (this.desk.stage.mode !== "watch") this.moving.pause?.();
    this.told();
  }

  /** The design in motion, where it is a linkage whose motion is shown. */
  get mover() {
    return this.moving instanceof LinkageMotion && !this.forced.hidden ? this.moving : null;
  }

  /**
   * Return the motion of a cognate, or null if it cannot be driven. It shares only the curve with the design and has
   * its own figures.
   * @param {import("./cognate_choice.js").Choice} choice @returns {Promise<Film | null>}
   */
  async fetchFilm(choice) {
    const cycle = await fetchCycle(choice.mechanism, STEP_COUNT, this.gone.signal).catch(() => null);
    return (
      cycle && {
        ...cycle,
        choice,
        design: {
          mechanism: addSkeleton(choice.mechanism, cycle.motion),
          metrics: choice.metrics,
          placement: this.design.placement,
        },
      }
    );
  }

  /**
   * Show the design, with its cognates to switch to: all in one frame, so that the curve stays where it is.
   * @param {Film[]} films
   */
  offerFilms(films) {
    const around =
      films.length < 2
        ? []
        : films.flatMap(({ motion }) =>
            Object.values(motion.joints).flatMap((track) =>
              track.x.map((x, k) => /** @type {[number, number]} */ (x === null ? [NaN, NaN] : [x, track.y[k]])),
            ),
          );
    const show = (/** @type {Film} */ film) => {
      this.again = () =>
        this.show(
          () =>
            new LinkageMotion(this.desk.frame, film.design, film.motion, this.job.problem, film.circuits, [
              ...around,
              ...this.around,
            ]),
          film === films[0],
        );
      this.again();
    };
    show(films[0]);
    if (films.length > 1) {
      this.desk.before.replaceChildren(
        createPicker(
          films.map((film) => film.choice),
          (choice) => {
            const film = films.find((one) => one.choice === choice) ?? films[0];
            show(film);
            this.desk.shown = film.design;
            this.createExplorer(film.design);
            this.desk.numbers.replaceChildren(
              ...(film === films[0] ? this.showNumbers() : createCognateNumbers(film, this.job.problem)),
            );
            this.desk.files.replaceChildren(
              ...(film === films[0] ? this.showFiles() : [createElement("p", { class: "note" }, DESIGN_TITLE)]),
            );
          },
        ),
      );
    }
  }

  /**
   * The place where a linkage's pins are dragged.
   * @param {LinkedDesign | Design} design the design or a cognate of it
   */
  createExplorer(design) {
    const { mechanism } = design;
    const { problem } = this.job;
    const { drawer, stage, exploring, explore } = this.desk;
    this.leaveExplorer();
    this.desk.offerExploring(Boolean(mechanism.skeleton));
    drawer.setReaction(
      "explore",
      mechanism.skeleton
        ? {
            opened: () => {
              // Two motions at once are one too many, for the eye and for the display.
              this.moving?.pause?.();
              this.leaveExplorer();
              stage.showMode("explore");
              this.explorer = this.desk.explorer = new Explorer(
                exploring,
                explore,
                /** @type {Linked} */ (mechanism),
                problem,
                listTargets(problem, design),
                this.state,
              );
            },
            closed: () => {
              this.leaveExplorer();
              exploring.replaceChildren();
              if (stage.mode === "explore") stage.showMode("watch");
            },
          }
        : null,
    );
  }

  /** The place of a linkage's forces: open where the problem states what it weighs and carries. */
  showForces() {
    const { design, job, n } = this;
    if (VIEWS[design.mechanism.type] || !design.mechanism.skeleton) return [];
    const inside = createElement("div");
    const details = createElement(
      "details",
      {
        id: "forces",
        open: Boolean(job.problem.dynamics ?? design.dynamics),
        ontoggle: () => {
          this.forces?.stop();
          this.forces = details.open && details.isConnected ? new ForcesPane(inside, job, n, this.mover) : null;
        },
      },
      createElement("summary", {}, t`Forces: loads and drive`),
      inside,
    );
    return [details];
  }

  /** The place of a design's parts in three dimensions, beside what moves; they are made when it is opened. */
  showAssembly() {
    const { drawer, stage, built, assembly } = this.desk;
    const there = api.hasParts(this.design.mechanism);
    drawer.setReaction(
      "assembly",
      there
        ? {
            opened: () => {
              this.assembly?.stop();
              stage.showMode("watch");
              built.hidden = false;
              built.parentElement?.classList.add("split");
              this.assembly = new AssemblyView(
                assembly,
                this.job,
                this.n,
                () => (this.forced.hidden ? null : this.moving),
                built,
              );
            },
            closed: () => {
              this.assembly?.stop();
              this.assembly = null;
              built.hidden = true;
              built.parentElement?.classList.remove("split");
              built.replaceChildren();
              assembly.replaceChildren();
            },
          }
        : null,
    );
    drawer.setAvailable("assembly", there);
  }

  /** Burmester's curves, where the job has them. @param {Solved} job @param {number} n */
  showBurmester(job, n) {
    const { mechanism } = job.result.designs[n];
    const { drawer, curves } = this.desk;
    const there = Boolean(job.result.curves?.length) && mechanism.type === "fourbar";
    const split = (/** @type {boolean} */ is) => {
      curves.hidden = !is;
      curves.parentElement?.classList.toggle("split", is);
    };
    drawer.setReaction(
      "curves",
      there
        ? {
            opened: () => {
              split(true);
              this.curves = new BurmesterCurves(curves, job, job.result.designs[n], (solved) =>
                this.showDesign(solved, 0, t`On these pivots`),
              );
            },
            closed: () => {
              split(false);
              this.curves?.stop();
              this.curves = null;
              curves.replaceChildren();
              if (this.job !== job && !this.ended) this.showDesign(job, n, t`Design ${n + 1}`);
            },
          }
        : null,
    );
    drawer.setAvailable("curves", there);
  }

  leaveExplorer() {
    this.explorer?.stop();
    this.explorer = this.desk.explorer = null;
  }

  leave() {
    this.gone.abort();
    this.moving?.stop();
    this.before = this.moving ?? this.before;
    this.moving = null;
    this.leaveExplorer();
    this.forces?.stop();
    this.forces = null;
    this.assembly?.stop();
    this.assembly = null;
    if (this.url) URL.revokeObjectURL(this.url);
    this.url = "";
  }

  stop() {
    this.ended = true;
    this.desk.drawer.setReaction("explore", null);
    this.desk.drawer.setReaction("curves", null);
    this.desk.drawer.setReaction("assembly", null);
    this.told = () => {};
    this.leave();
  }
}

/**
 * The figures of a cognate: its measurements and its dimensions.
 * @param {Film} film
 * @param {Problem} problem
 */
function createCognateNumbers({ choice, design }, problem) {
  const measured = listFigures(design);
  return [
    createElement("p", { class: "note" }, DESIGN_TITLE),
    createElement(
      "div",
      { class: "columns" },
      measured.length > 0 &&
        createTable(
          t`Quantities of the ${`${choice.name.charAt(0).toLowerCase()}${choice.name.slice(1)}`}`,
          measured,
          problem,
        ),
      createDimensions(design, problem),
    ),
  ];
}
