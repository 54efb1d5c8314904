/** Explore a linkage by dragging its pins; the service analyses it during the drag. */

import * as api from "../core/api.js";
import { inputAngle } from "../motion/cycle.js";
import { createElement, formatNumber, createSvg, toWords } from "../core/dom.js";
import { couplerCurve, createFacts } from "../motion/linkage_facts.js";
import { Grip, moveWithKeys, dragWithPointer } from "../canvas/grip.js";
import { LinkageDrawing, drawnJoints, translateTo } from "../canvas/linkage_drawing.js";
import { Player, interpolate } from "../core/player.js";
import { DimensionTable } from "./dimension_table.js";
import { listStartingPoints } from "./explored_problem.js";
import { t } from "../core/messages.js";
import { CLOCK_HEIGHT, boardSize, createScene } from "../canvas/stage.js";
import { View } from "../core/view.js";
import { Zoom } from "../canvas/zoom.js";

/** @import { LinkageAnalysis, Linked, Problem, Skeleton } from "../types/values.js" */

const STEP_COUNT = 180;

/** What follows so soon is the same step: a pin that is dragged. */
const BURST_MS = 700;

/** @typedef {[number, number]} Point */

export class Explorer {
  /**
   * @param {HTMLElement} board of the stage
   * @param {HTMLElement} place of its figures
   * @param {Linked} mechanism with its skeleton
   * @param {Problem} problem
   * @param {import("../motion/linkage_motion.js").Target[]} targets as demanded
   * @param {(problem: Problem, solved?: boolean) => void} state called to begin a statement, and to solve it
   */
  constructor(board, place, mechanism, problem, targets, state) {
    const [width, height] = boardSize(board, CLOCK_HEIGHT);
    this.type = mechanism.type;
    this.unit = problem.length_unit ?? "mm";
    this.problem = problem;
    this.skeleton = structuredClone(mechanism.skeleton);
    /** @type {Record<string, Point>} */
    this.joints = this.skeleton.joints;
    this.anchors = slideAnchors(this.skeleton);
    const { P, ...others } = this.joints;
    /** The joint on which P lies, where it is no point of its own. */
    this.doubled = P && Object.keys(others).find((name) => others[name][0] === P[0] && others[name][1] === P[1]);
    this.targets = targets;
    this.state = state;
    this.asking = false;
    this.stale = false;
    /** @type {LinkageAnalysis | null} */
    this.motion = null;
    this.gone = new AbortController();
    /** Where the joints were, the oldest step first, and where they have been taken back from. */
    this.past = /** @type {Record<string, Point>[]} */ ([]);
    this.future = /** @type {Record<string, Point>[]} */ ([]);
    this.noted = -Infinity;
    const step = (/** @type {string} */ name, /** @type {string} */ text, /** @type {() => void} */ act) =>
      createElement(
        "button",
        { type: "button", class: "small", disabled: true, title: name, "aria-label": name, onclick: act },
        text,
      );
    this.steps = {
      back: step(t`Undo the last change to the linkage`, "↶", () => this.undo()),
      forth: step(t`Redo the change`, "↷", () => this.redo()),
    };
    const around = Object.values(this.joints).concat(targets.map((one) => [one.x, one.y]));
    this.view = new View(around, width, height, Math.min(110, 0.2 * Math.min(width, height)));
    this.curve = createSvg("path", { class: "curve" });
    this.linkage = new LinkageDrawing(this.view, this.skeleton, { names: false });
    this.ghost = new LinkageDrawing(this.view, this.skeleton, { names: false, faint: true });
    this.picture = createScene(
      this.view,
      t`The linkage with draggable pins`,
      [
        this.curve,
        ...targets.map((one) =>
          createSvg(
            "g",
            { class: "goal", transform: translateTo(this.view.toPicture(one.x, one.y)) },
            createSvg("circle", {}),
          ),
        ),
        this.ghost.node,
        this.linkage.node,
      ],
      { held: true },
    );
    this.handles = drawnJoints(this.skeleton).map((name) => this.createHandle(name));
    this.picture.append(...this.handles.map(({ grip }) => grip.node));
    this.player = new Player({
      count: STEP_COUNT + 1,
      closed: true,
      name: "explore-",
      label: t`Input`,
      reading: (at) => this.describePosition(at),
      show: (at) => this.moveTo(at),
    });
    this.sizes = new DimensionTable(
      this.skeleton,
      this.unit,
      (places, apart) => this.moveJoints(places, apart),
      () => this.offerStatements(),
    );
    this.facts = createElement("dl", { class: "facts", "aria-live": "polite" });
    this.checks = createElement("ul", { class: "checks" });
    this.buttons = createElement("p", { class: "row" });
    place.replaceChildren(
      createElement(
        "p",
        { class: "note" },
        t`Drag a pin, move it with the arrow keys, or type a dimension; the curve, the motion and the numbers follow. Held dimensions stay the same.`,
      ),
      createElement("p", { class: "row" }, this.steps.back, this.steps.forth),
      this.sizes.node,
      createElement("div", { class: "columns" }, this.facts, this.checks),
      this.buttons,
    );
    board.replaceChildren(
      createElement("div", { class: "stage" }, this.picture, new Zoom(this.picture).buttons),
      this.player.row,
    );
    this.draw();
    this.requestMotion().then(() => this.motion && this.player.begin());
  }

  /** @param {string} name */
  createHandle(name) {
    const grip = new Grip({ name, dot: name === "P" ? "dot point" : "dot" });
    const put = (/** @type {Point} */ at) => this.sizes.dragJoint(name, at);
    let goesOn = false;
    dragWithPointer(grip.node, this.picture, this.view, {
      // While a pin is led the picture has that to follow; the motion goes on when it is let go.
      taken: () => {
        goesOn = this.player.playing;
        this.player.stop();
      },
      led: put,
      left: () => {
        if (goesOn && !this.gone.signal.aborted) this.player.play();
      },
    });
    moveWithKeys(grip.node, this.view, {
      moved: ([dx, dy]) => put([this.joints[name][0] + dx, this.joints[name][1] + dy]),
    });
    return { name, grip };
  }

  /**
   * The joints have gone somewhere else.
   * @param {Record<string, Point>} places
   * @param {boolean} apart whether that is a step of its own
   */
  moveJoints(places, apart) {
    const now = performance.now();
    if (apart || now - this.noted > BURST_MS) {
      this.past.push(structuredClone(this.joints));
      this.future = [];
    }
    this.noted = apart ? -Infinity : now;
    this.placeJoints(places);
  }

  /** Take the last step back. @returns {boolean} whether there was one */
  undo() {
    return this.restoreStep(this.past, this.future);
  }

  /** Do it again. @returns {boolean} whether there was one */
  redo() {
    return this.restoreStep(this.future, this.past);
  }

  /** @param {Record<string, Point>[]} from @param {Record<string, Point>[]} to */
  restoreStep(from, to) {
    const places = from.pop();
    if (!places) return false;
    to.push(structuredClone(this.joints));
    this.noted = -Infinity;
    this.sizes.moveJoints(places);
    this.placeJoints(places);
    return true;
  }

  /** @param {Record<string, Point>} places */
  placeJoints(places) {
    Object.assign(this.joints, places);
    this.steps.back.disabled = !this.past.length;
    this.steps.forth.disabled = !this.future.length;
    const on = this.doubled;
    if (on) this.joints.P = [...this.joints[on]];
    this.carrySlides();
    this.draw();
    this.requestMotion();
  }

  /** Lines of slides go with the joints that they pass: turned about the pivot that they pass too, or shifted. */
  carrySlides() {
    this.skeleton.slides?.forEach((slide, /** @type {number} */ k) => {
      const [x, y] = this.joints[slide.joint];
      const through = this.anchors[k] && this.joints[this.anchors[k]];
      if (through) {
        slide.point = [...through];
        slide.angle = (Math.atan2(y - through[1], x - through[0]) * 180) / Math.PI;
      } else slide.point = [x, y];
    });
  }

  draw() {
    this.linkage.moveTo(this.joints);
    for (const { name, grip } of this.handles) {
      const [x, y] = this.joints[name];
      grip.moveTo(this.view.toPicture(x, y));
      grip.setLabel(`${name}: x ${formatNumber(x)}, y ${formatNumber(y)}. ${t`Arrow keys move it.`}`);
    }
  }

  /** Ask for the motion; while an answer is awaited only the newest question is kept. */
  async requestMotion() {
    // What is written beneath is of the linkage before, until the answer is there.
    for (const place of [this.facts, this.checks]) place.setAttribute("aria-busy", "true");
    if (this.asking) {
      this.stale = true;
      return;
    }
    this.asking = true;
    do {
      this.stale = false;
      const from = inputAngle(this.skeleton);
      const motion = from === null ? {} : { motion: { from, to: from + 360, steps: STEP_COUNT } };
      try {
        this.showAnswer(
          await api.analyse({ mechanism: { type: this.type, skeleton: this.skeleton }, ...motion }, this.gone.signal),
        );
      } catch (error) {
        if (this.gone.signal.aborted) return;
        /** @type {LinkageAnalysis | null} */
        this.motion = null;
        this.curve.removeAttribute("d");
        this.ghost.node.setAttribute("hidden", "");
        const refused = /** @type {api.Refusal} */ (error);
        for (const one of [this.facts, this.checks, this.buttons]) delete one.dataset.said;
        this.facts.replaceChildren(
          createElement("dt", {}, t`Refused`),
          createElement("dd", {}, refused.errors?.[0]?.detail ?? refused.message),
        );
        this.checks.replaceChildren();
        this.buttons.replaceChildren();
      }
    } while (this.stale);
    for (const place of [this.facts, this.checks]) place.removeAttribute("aria-busy");
    this.asking = false;
  }

  /** @param {LinkageAnalysis} answer */
  showAnswer(answer) {
    this.motion = answer;
    this.curve.setAttribute("d", this.view.pathData(couplerCurve(answer, this.skeleton)));
    const { facts, turns, least, grashof, missed } = createFacts(answer, this.skeleton, this.targets, this.unit);
    renewContent(this.facts, Object.entries(facts), ([name, value]) => [
      createElement("dt", {}, name),
      createElement("dd", {}, value),
    ]);
    this.showChecks(turns, least, grashof, missed);
    this.offerStatements();
    this.moveTo(this.player.at);
  }

  /** Buttons of the statements that begin with the linkage as it is. */
  offerStatements() {
    const { motion } = this;
    if (!motion) return;
    const held = this.sizes.demands.length > 0;
    const offered = () => listStartingPoints(this.problem, this.skeleton, this.motion ?? motion, this.targets, held);
    renewContent(
      this.buttons,
      offered().map(({ text }) => text),
      (text) => [
        createElement(
          "button",
          {
            type: "button",
            class: "small",
            onclick: () =>
              offered()
                .filter((one) => one.text === text)
                .forEach(({ statement, solved }) => this.state(statement(), solved)),
          },
          text,
        ),
      ],
    );
  }

  /**
   * List the checks of the problem that can be evaluated at once.
   * @param {boolean} turns
   * @param {number | null} least
   * @param {string | null} grashof
   * @param {number[]} missed
   */
  showChecks(turns, least, grashof, missed) {
    const wanted = this.problem.constraints ?? {};
    const size = Math.max(
      ...Object.values(this.joints).map(([x, y]) => Math.hypot(x - this.joints.O2?.[0], y - this.joints.O2?.[1])),
    );
    /** @type {[string, boolean][]} */
    const checks = [];
    // The curve is sampled: distances below the spacing of the samples are not resolved.
    if (missed.length)
      checks.push([
        t`Passes the targets within ${`${formatNumber(Number((0.01 * size).toPrecision(2)))} ${this.unit}`}`,
        Math.max(...missed) <= 0.01 * size,
      ]);
    if (wanted.full_rotation) checks.push([t`Full rotation`, turns]);
    if (wanted.min_transmission_angle)
      checks.push([
        t`Transmission angle of at least ${formatNumber(wanted.min_transmission_angle)}° over the whole motion`,
        least !== null && least >= wanted.min_transmission_angle,
      ]);
    if (wanted.grashof && wanted.grashof !== "any" && grashof) {
      checks.push([
        toWords(wanted.grashof),
        wanted.grashof === "non_grashof" ? grashof === "rocker_rocker" : grashof === wanted.grashof,
      ]);
    }
    renewContent(this.checks, checks, ([name, passed]) => [
      createElement(
        "li",
        { class: passed ? "good" : "bad" },
        createElement("span", {}, passed ? "✓ " : "✗ "),
        name,
        createElement("span", { class: "hidden" }, " ", passed ? t`passed` : t`failed`),
      ),
    ]);
  }

  /** @param {number} at */
  moveTo(at) {
    const { motion } = this;
    this.ghost.node.toggleAttribute("hidden", !motion);
    if (!motion) return;
    this.ghost.moveTo(
      Object.fromEntries(
        Object.entries(motion.joints).map(([name, track]) => {
          const x = interpolate(track.x, at);
          return [name, x === null ? null : [x, Number(interpolate(track.y, at))]];
        }),
      ),
    );
  }

  /** @param {number} at */
  describePosition(at) {
    const input = this.motion && interpolate(this.motion.input_angle, Math.min(at, this.motion.input_angle.length - 1));
    const unit = inputAngle(this.skeleton) === null ? ` ${this.unit}` : "°";
    return input === null ? "–" : `${formatNumber(Math.round(10 * input) / 10)}${unit}`;
  }

  stop() {
    this.gone.abort();
    this.player.stop();
  }
}

/**
 * Fill a place anew where it is to say something else; otherwise the page need not be laid out again.
 * @template T @param {HTMLElement} place @param {T[]} said @param {(one: T) => Element[]} make
 */
function renewContent(place, said, make) {
  const now = JSON.stringify(said);
  if (place.dataset.said === now) return;
  place.dataset.said = now;
  place.replaceChildren(...said.flatMap(make));
}

/**
 * Of each slide the joint of its own link that its line passes, if there is one.
 * @param {Skeleton} skeleton
 * @returns {(string | null)[]}
 */
function slideAnchors(skeleton) {
  const places = /** @type {Point[]} */ (Object.values(skeleton.joints));
  const size = Math.max(...places.map(([x, y]) => Math.hypot(x - places[0][0], y - places[0][1])));
  return (skeleton.slides ?? []).map((slide) => {
    if (slide.link === "ground") return null;
    const on = skeleton.links.find((link) => link.name === slide.link)?.joints ?? [];
    const angle = (slide.angle * Math.PI) / 180;
    return (
      on.find((/** @type {string} */ name) => {
        const [dx, dy] = [skeleton.joints[name][0] - slide.point[0], skeleton.joints[name][1] - slide.point[1]];
        return name !== slide.joint && Math.abs(dy * Math.cos(angle) - dx * Math.sin(angle)) < 1e-9 * size;
      }) ?? null
    );
  });
}
