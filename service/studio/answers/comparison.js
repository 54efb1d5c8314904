/** Compare two designs: side by side on the stage or overlaid, with their numbers in one table. */

import * as api from "../core/api.js";
import { drawnJoints, LinkageDrawing } from "../canvas/linkage_drawing.js";
import { createElement, createSvg, toWords } from "../core/dom.js";
import { listDimensions, formatFigure, listFigures, typeName } from "../design/design_metrics.js";
import { LinkageMotion } from "../motion/linkage_motion.js";
import { Frame } from "../canvas/stage.js";
import { jointPositions } from "../motion/swept_area.js";
import { findTracedJoint } from "../motion/circuits.js";
import { t } from "../core/messages.js";
import { STEP_COUNT, TURN_STEP_COUNT, VIEWS } from "../motion/motion_views.js";

/** @import { Design, LinkageAnalysis, Linked, LinkedDesign, Problem, Solved } from "../types/values.js" */

/** @typedef {[number, number]} Point */
/** @typedef {"beside" | "over"} Manner */

/** Relative difference up to which two numbers differ by rounding only. */
const ROUNDING_TOLERANCE = 1e-9;

/** The second half of the stage: a picture that follows the player of the first. */
class SecondFrame extends Frame {
  /** @param {HTMLElement} board @param {string} caption */
  constructor(board, caption) {
    super(board, createElement("div"), createElement("div"));
    this.caption = caption;
  }

  /** @param {import("../canvas/stage.js").View} view */
  fill({ picture }) {
    super.fill({ picture });
    this.board.append(createElement("p", { class: "second-name" }, this.caption));
  }
}

export class Comparison {
  /**
   * @param {import("../design/workbench.js").Workbench} desk @param {Solved} job @param {number} n the other design
   * @param {Manner} manner @param {import("../design/design.js").DesignView} shown the design that is chosen
   */
  constructor(desk, job, n, manner, shown) {
    this.desk = desk;
    this.job = job;
    this.n = n;
    this.manner = manner;
    this.shown = shown;
    this.design = job.result.designs[n];
    this.gone = new AbortController();
    /** @type {import("../motion/motion_views.js").Moving | null} */
    this.moving = null;
    /** Called at each step of the selected design's player. @type {((share: number, told: boolean) => void) | null} */
    this.follow = null;
    this.begin().catch((error) => {
      if (!this.gone.signal.aborted)
        desk.other.replaceChildren(
          createElement("div", { class: "said" }, createElement("p", { class: "error" }, error.message)),
        );
    });
  }

  async begin() {
    const { design, desk, job, manner, shown } = this;
    const linkage = Boolean(design.mechanism.skeleton);
    this.splitStage(manner === "beside");
    const moved = await api.fetchMotion(job.id, this.n, linkage ? STEP_COUNT : TURN_STEP_COUNT, this.gone.signal);
    const motion = /** @type {LinkageAnalysis} */ (moved);
    if (this.gone.signal.aborted) return;
    if (manner === "over") {
      const tracks = Object.values(motion.joints).flatMap((track) => trackPoints(track));
      shown.around = tracks;
      shown.told = () => this.drawOverlay(motion);
      shown.again();
      return;
    }
    const frame = new SecondFrame(desk.other, t`Design ${this.n + 1}: ${typeName(design)}`);
    const View = VIEWS[design.mechanism.type];
    this.moving = View
      ? new View(frame, design, moved, job.problem)
      : new LinkageMotion(frame, /** @type {LinkedDesign} */ (design), motion, job.problem);
    const { player } = this.moving;
    player.stop();
    this.follow = (share, told) => player.seek(share * player.last, told);
    shown.told = () => this.syncWithFirst();
    // The selected design gets half of the stage.
    shown.again();
  }

  /** Follow the player of the selected design. */
  syncWithFirst() {
    const { follow } = this;
    const player = this.shown.moving?.player;
    if (!follow || !player) return;
    player.followers.add(follow);
    follow(player.at / player.last, true);
  }

  /** Draw the second design over the selected one. @param {LinkageAnalysis} motion */
  drawOverlay(motion) {
    const { mover } = this.shown;
    if (!mover) return;
    const { skeleton } = /** @type {Linked} */ (this.design.mechanism);
    const linkage = new LinkageDrawing(mover.view, skeleton, { names: false });
    linkage.node.setAttribute("class", "overlaid");
    const name = findTracedJoint(skeleton);
    const track = motion.joints[name];
    if (drawnJoints(skeleton).includes(name))
      linkage.node.prepend(createSvg("path", { class: "curve other", d: mover.view.pathData(trackPoints(track)) }));
    mover.picture.append(linkage.node);
    const last = motion.input_angle.length - 1;
    this.follow = (share) => linkage.moveTo(jointPositions(motion, share * last));
    this.syncWithFirst();
  }

  /** @param {boolean} is whether the stage shows two */
  splitStage(is) {
    const { other } = this.desk;
    other.hidden = !is;
    other.parentElement?.classList.toggle("split", is);
    other.replaceChildren(
      ...(is
        ? [createElement("div", { class: "said" }, createElement("p", { class: "note" }, t`Computing the motion …`))]
        : []),
    );
  }

  stop() {
    this.gone.abort();
    this.moving?.stop();
    this.splitStage(false);
    const { shown } = this;
    shown.told = () => {};
    shown.around = [];
    if (this.follow && !shown.ended) shown.again();
  }
}

/** @param {{x: (number | null)[], y: (number | null)[]}} track @returns {Point[]} */
function trackPoints({ x, y }) {
  return x.map((one, k) => (one === null ? [NaN, NaN] : [one, Number(y[k])]));
}

/**
 * Create a table with the numbers of two designs; different numbers are marked.
 * @param {Design[]} designs
 * @param {[number, number]} which
 * @param {Problem} problem
 */
export function compareNumbers(designs, which, problem) {
  const [one, other] = which.map((n) => designs[n]);
  const told = [one, other].map(
    (design) =>
      new Map(
        listFigures(design).map(([name, value]) => [name, formatFigure(name, value, problem, design.metrics?.size)]),
      ),
  );
  const sizes = [one, other].map((design) => new Map(listDimensions(design, problem)));
  const names = (/** @type {Map<string, Cell>[]} */ maps) => [...new Set(maps.flatMap((map) => [...map.keys()]))];
  const rows = (/** @type {Map<string, {text: string, title: string | null}>[]} */ maps) =>
    names(maps).map((name) => {
      const [a, b] = maps.map((map) => map.get(name) ?? { text: "–", title: null });
      const differs = !cellsAgree(a, b);
      // Use as many digits as distinguish the two.
      const close = differs && a.text === b.text;
      return createElement(
        "tr",
        { class: differs ? "differs" : null },
        createElement(
          "th",
          { scope: "row" },
          toWords(name),
          differs && createElement("span", { class: "hidden" }, ", ", t`differs`),
        ),
        ...[a, b].map((cell) => createElement("td", { title: cell.title }, close ? cell.title : cell.text)),
      );
    });
  return createElement(
    "div",
    { class: "side-by-side" },
    createElement(
      "table",
      { class: "figures" },
      createElement(
        "thead",
        {},
        createElement(
          "tr",
          {},
          createElement("th", { scope: "col" }, t`Quantities`),
          ...which.map((n) => createElement("th", { scope: "col" }, t`Design ${n + 1}`)),
        ),
      ),
      createElement("tbody", {}, ...rows(told)),
      createElement(
        "tbody",
        {},
        createElement("tr", {}, createElement("th", { scope: "rowgroup", colspan: 3, class: "part" }, t`Dimensions`)),
        ...rows(sizes),
      ),
    ),
  );
}

/** @typedef {{text: string, title: string | null}} Cell */

/** Return true if two cells are equal up to rounding. @param {Cell} one @param {Cell} other */
function cellsAgree(one, other) {
  if (one.title === null || other.title === null || one.text === "exact") return one.text === other.text;
  const [a, b] = [one.title, other.title].map((text) => text.split(", ").map(parseFloat));
  return (
    a.length === b.length &&
    a.every((value, k) => Math.abs(value - b[k]) <= ROUNDING_TOLERANCE * Math.max(Math.abs(value), Math.abs(b[k])))
  );
}
