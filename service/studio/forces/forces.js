/** Show the forces of a linkage: arrows on the motion, drive, plots, hodograph and peaks. */

import * as api from "../core/api.js";
import { createElement, formatNumber, toWords } from "../core/dom.js";
import { ForceArrows, collectForces } from "./force_arrows.js";
import { clearRounding } from "./force_scales.js";
import { Hodograph } from "../plots/hodograph.js";
import { LoadEditor } from "./load_editor.js";
import { localizeNumber, t, term } from "../core/messages.js";
import { interpolate, clampIndex } from "../core/player.js";
import { formatBriefly, createPlots, listRuns } from "../plots/plots.js";
import { findPosition } from "../motion/swept_area.js";
import { unitSymbol } from "../core/units.js";

/** @import { LinkageAnalysis, Schemas, Skeleton, Solved } from "../types/values.js" */

/** Samples of a turn, or of the range. */
const STEP_COUNT = 360;

/** Maximum number of lines in one plot: the number of colours. */
const MAX_LINES = 4;

/** Why numbers are missing, or are to be read with care, by the status of a position. @type {Record<string, string>} */
const STATUS_REASONS = {
  not_assembled: t`the linkage cannot be assembled there`,
  dead_centre: t`dead centre: the forces are not determined`,
  load_undetermined: t`the ends of a spring coincide, so its force has no direction`,
  friction_jam: t`friction jams it`,
  stick: t`a joint with friction stands still; its friction is not included`,
  statically_indeterminate: t`statically indeterminate: constraints are redundant; missing forces are not unique`,
};

/** @typedef {(number | null)[]} Series */
/** @typedef {import("../motion/linkage_motion.js").LinkageMotion} Mover */

export class ForcesPane {
  /**
   * @param {HTMLElement} place
   * @param {Solved} job
   * @param {number} n
   * @param {Mover | null} mover the design in motion, where it moves already
   */
  constructor(place, job, n, mover) {
    this.job = job;
    this.n = n;
    this.design = job.result.designs[n];
    this.skeleton = /** @type {Skeleton} */ (this.design.mechanism.skeleton);
    this.mover = mover;
    this.gone = new AbortController();
    /** @type {LinkageAnalysis | null} */
    this.answer = null;
    /** @type {ForceArrows | null} */
    this.arrows = null;
    /** @type {import("../plots/plots.js").PlotMark[]} */
    this.marks = [];
    /** @type {{box: HTMLElement, series: Series, unit: string}[]} */
    this.readings = [];
    /** @type {Hodograph | null} */
    this.hodographed = null;
    /** Where the motion stands in the arrays of the answer. @type {number | null} */
    this.at = null;
    this.hodograph = createElement("div", { class: "plots" });
    this.outside = createElement("span", { class: "note" });
    this.pictures = createElement("div", { class: "borne" });
    // What a design with masses of its own weighs is not for the page to say.
    this.editor = this.design.dynamics
      ? null
      : new LoadEditor(this.skeleton, job.problem, this.isSliding, (block) => this.requestForces(block));
    place.replaceChildren(...(this.editor ? [this.editor.node] : []), this.pictures);
    this.editor?.attach(mover);
    const { forces } = this.design;
    // A remark that begins with a field says that the block does not fit the design, and there is nothing to ask for.
    if (forces?.remark?.startsWith("/"))
      this.pictures.replaceChildren(
        createElement("p", { class: "error" }, t`The design has no forces: ${forces.remark}.`),
      );
    else if (job.problem.dynamics ?? this.design.dynamics) {
      this.pictures.replaceChildren(createElement("p", { class: "note" }, t`Computing the forces …`));
      this.requestForces(null).catch((error) => this.showFailure(error));
    } else
      this.pictures.replaceChildren(
        createElement(
          "p",
          { class: "note" },
          t`The problem states no masses and loads. Add them above to see the forces.`,
        ),
      );
  }

  /**
   * Ask for the forces and show them.
   * @param {Schemas["DesignForcesBlock"] | null} block null for that of the problem
   */
  async requestForces(block) {
    const answer = await api.fetchForces(this.job.id, this.n, STEP_COUNT, block, this.gone.signal);
    if (this.gone.signal.aborted) return;
    this.answer = clearRounding(/** @type {ForcesPane["knownAnswer"]} */ (answer), this.skeleton, this.isSliding);
    this.build();
    this.drawArrows();
  }

  /** @param {Error} error */
  showFailure(error) {
    if (!this.gone.signal.aborted) this.pictures.replaceChildren(createElement("p", { class: "error" }, error.message));
  }

  /** Let the pictures go with a motion, or with none. @param {Mover | null} mover */
  attach(mover) {
    this.mover = mover;
    this.editor?.attach(mover);
    this.drawArrows();
  }

  /** Draw the arrows in the current picture of the motion. */
  drawArrows() {
    const { answer, mover } = this;
    if (!answer || !mover) return;
    this.arrows = new ForceArrows(
      mover.view,
      collectForces(answer, this.skeleton, mover.linkage.slides),
      this.formatUnit("force"),
      answer.joints,
      (input) => this.findIndex(input),
    );
    const { node, extent } = this.arrows;
    this.pictures
      .querySelector(".force-choice")
      ?.replaceChildren(createElement("label", { for: "force-on" }, "Arrows: forces on"), this.arrows.choice);
    mover.addCompanion({
      node,
      extent,
      show: (input, now, told) => {
        this.arrows?.show(input, now);
        this.show(input, told);
      },
    });
  }

  /** The answer, where it is there. */
  get knownAnswer() {
    return /** @type {LinkageAnalysis & {dynamics: Schemas["DynamicsAnswer"]}} */ (this.answer);
  }

  /** The unit of a quantity as the answer has it; empty where its units are the client's. @param {string} dimension */
  formatUnit(dimension) {
    const { units, length_unit: length } = this.knownAnswer.dynamics;
    return unitSymbol(dimension, { kind: this.job.problem.kind, dynamics: { units }, length_unit: length });
  }

  /** Whether a slide drives, so that the input is a place. */
  get isSliding() {
    const { links, input_link: input } = this.skeleton;
    return links.every((link) => link.name !== input);
  }

  /** An input with its unit. @param {number} input */
  formatInput(input) {
    const rounded = formatNumber(Math.round(10 * input) / 10);
    return this.isSliding ? `${rounded} ${this.knownAnswer.dynamics.length_unit}` : `${rounded}°`;
  }

  /**
   * The place in the answer's arrays at an input; null outside of them.
   * @param {number} input
   * @returns {number | null}
   */
  findIndex(input) {
    const inputs = this.knownAnswer.input_angle;
    const last = inputs.length - 1;
    const [low, high] = [Math.min(inputs[0], inputs[last]), Math.max(inputs[0], inputs[last])];
    const closed = !this.isSliding && Math.abs((high - low) % 360) < 1e-6 && high > low;
    const slack = 1e-6 * (high - low);
    if (!closed && (input < low - slack || input > high + slack)) return null;
    return clampIndex(findPosition(inputs, input, closed), last);
  }

  build() {
    const answer = this.knownAnswer;
    const { dynamics, input_angle: inputs } = answer;
    const lead = (/** @type {number} */ at) => this.mover?.lead(Number(interpolate(inputs, at)));
    const wanted = this.listPlots();
    const made = createPlots(wanted, inputs, lead, this.isSliding ? ` ${dynamics.length_unit}` : "°");
    this.marks = made;
    this.readings = [];
    const wheres = this.listHodographs();
    const pick = createElement(
      "select",
      { id: "hodograph-of", onchange: () => this.traceHodograph(wheres[Number(pick.value)]) },
      ...wheres.map(({ title }, k) => createElement("option", { value: k }, title)),
    );
    this.pictures.replaceChildren(
      createElement("p", { class: "row force-choice" }),
      this.describeNow(),
      ...this.createRemarks(),
      this.createPeaks(),
      createElement("div", { class: "plots force-plots" }, ...made.map(({ figure }) => figure)),
      createElement("div", { class: "row" }, createElement("label", { for: "hodograph-of" }, t`Hodograph of`), pick),
      this.hodograph,
    );
    this.traceHodograph(wheres[0]);
  }

  /** What drives, as it is now. */
  describeNow() {
    const [name, unit] = this.createDriveFacts();
    const box = createElement("output", { class: "reading" }, "–");
    this.readings.push({ box, series: this.knownAnswer.dynamics.drive ?? [], unit });
    return createElement("p", { class: "row drive-now" }, createElement("span", {}, t`${name} now`), box, this.outside);
  }

  /** @returns {[string, string]} name and unit of what drives */
  createDriveFacts() {
    return this.isSliding ? [t`Drive force`, this.formatUnit("force")] : [t`Drive torque`, this.formatUnit("torque")];
  }

  /** @returns {import("../plots/plots.js").PlotData[]} */
  listPlots() {
    const { dynamics } = this.knownAnswer;
    const unknown = dynamics.status.map(
      (/** @type {string} */ one) => !["ok", "stick", "statically_indeterminate"].includes(one),
    );
    const [name, unit] = this.createDriveFacts();
    const titled = (/** @type {string} */ title, /** @type {string} */ of) => (of ? `${title} (${of})` : title);
    const force = this.formatUnit("force");
    const joints = Object.entries(dynamics.joints ?? {}).map(
      ([joint, links]) => /** @type {[string, Series]} */ ([joint, greatestMagnitudes(Object.values(links))]),
    );
    const chunks = Array.from({ length: Math.ceil(joints.length / MAX_LINES) }, (_, k) =>
      joints.slice(k * MAX_LINES, (k + 1) * MAX_LINES),
    );
    const { shaking } = dynamics;
    /** @type {import("../plots/plots.js").PlotData[]} */
    const all = [
      { title: titled(name, unit), lines: { "": dynamics.drive ?? [] } },
      ...chunks.map((some) => ({
        title: titled(some.length > 1 ? t`Pin forces` : t`Pin force ${some[0][0]}`, force),
        lines: Object.fromEntries(some),
      })),
      ...(shaking
        ? [
            {
              title: titled(t`Shaking force`, force),
              lines: { total: greatestMagnitudes([shaking.force]), x: shaking.force.x, y: shaking.force.y },
            },
            { title: titled(t`Shaking moment`, this.formatUnit("torque")), lines: { "": shaking.moment } },
          ]
        : []),
    ];
    return all.map((one) => ({
      ...one,
      gaps: Object.values(one.lines)[0].map((value, k) => unknown[k] || value === null),
    }));
  }

  /** What there is a hodograph of. @returns {{title: string, x: Series, y: Series}[]} */
  listHodographs() {
    const { joints, shaking } = this.knownAnswer.dynamics;
    return [
      ...Object.entries(joints ?? {}).flatMap(([joint, links]) =>
        Object.entries(links).map(([on, { x, y }]) => ({
          title: t`pin ${joint} on ${term(on)}`,
          x,
          y,
        })),
      ),
      ...(shaking ? [{ title: t`shaking force`, x: shaking.force.x, y: shaking.force.y }] : []),
    ];
  }

  /** @param {{title: string, x: Series, y: Series} | undefined} chosen */
  traceHodograph(chosen) {
    if (!chosen) return;
    const drawn = new Hodograph(toWords(chosen.title), chosen.x, chosen.y, this.formatUnit("force"));
    this.hodograph?.replaceChildren(drawn.figure);
    this.hodographed = drawn;
    drawn.show(this.at, true);
  }

  /** Where numbers are missing and why, and what is to be known of all of them. */
  createRemarks() {
    const { dynamics, input_angle: inputs } = this.knownAnswer;
    const found = [...new Set(/** @type {string[]} */ (dynamics.status))]
      .filter((one) => one !== "ok")
      .flatMap((status) =>
        listRuns(dynamics.status.map((/** @type {string} */ one) => one === status)).map(([from, to]) =>
          createElement(
            "li",
            {},
            createElement(
              "button",
              { type: "button", class: "small", onclick: () => this.mover?.lead(inputs[from]) },
              from === to
                ? this.formatInput(inputs[from])
                : t`${this.formatInput(inputs[from])} to ${this.formatInput(inputs[to])}`,
            ),
            ` ${STATUS_REASONS[status] ?? toWords(status)}`,
          ),
        ),
      );
    return [
      ...(found.length ? [createElement("ul", { class: "gaps" }, ...found)] : []),
      ...dynamics.warnings.map((/** @type {string} */ one) => createElement("p", { class: "note" }, one)),
    ];
  }

  /** The greatest of everything, with the input at which it stands and the value that it has now. */
  createPeaks() {
    const { extremes, power, joints, shaking, drive } = this.knownAnswer.dynamics;
    const [name, unit] = this.createDriveFacts();
    const [force, torque] = [this.formatUnit("force"), this.formatUnit("torque")];
    /** @type {[string, number | null, number | null, string, Series | null][]} */
    const rows = [
      [t`${name}, maximum`, extremes.drive.max, extremes.drive.at, unit, drive ?? null],
      [t`${name}, minimum`, extremes.drive.min, extremes.drive.at_min, unit, null],
      ...Object.entries(extremes.joints).map(
        ([joint, peak]) =>
          /** @type {[string, number | null, number | null, string, Series | null]} */ ([
            t`Pin force ${joint}`,
            peak.max,
            peak.at,
            force,
            joints?.[joint] ? greatestMagnitudes(Object.values(joints[joint])) : null,
          ]),
      ),
      [
        t`Shaking force`,
        extremes.shaking_force.max,
        extremes.shaking_force.at,
        force,
        shaking ? greatestMagnitudes([shaking.force]) : null,
      ],
      [t`Shaking moment`, extremes.shaking_moment.max, extremes.shaking_moment.at, torque, shaking?.moment ?? null],
      [t`Power of the drive`, power.peak, null, this.formatUnit("power"), null],
    ];
    return createElement(
      "div",
      { class: "table" },
      createElement(
        "table",
        { class: "figures peaks" },
        createElement(
          "thead",
          {},
          createElement(
            "tr",
            {},
            ...[t`Peaks`, t`Value`, t`At the input`, t`Now`].map((head) => createElement("th", { scope: "col" }, head)),
          ),
        ),
        createElement(
          "tbody",
          {},
          ...rows.map(([title, value, at, of, series]) => {
            const box = createElement("td", { class: "reading" });
            if (series) this.readings.push({ box, series, unit: of });
            return createElement(
              "tr",
              {},
              createElement("th", { scope: "row" }, title),
              value === null
                ? createElement("td", {}, "–")
                : createElement(
                    "td",
                    { title: `${localizeNumber(value)} ${of}`.trim() },
                    `${formatBriefly(value)} ${of}`.trim(),
                  ),
              createElement(
                "td",
                {},
                at === null
                  ? "–"
                  : createElement(
                      "button",
                      {
                        type: "button",
                        class: "small",
                        "aria-label": t`${title}: go to ${this.formatInput(at)}`,
                        onclick: () => this.mover?.lead(at),
                      },
                      this.formatInput(at),
                    ),
              ),
              box,
            );
          }),
        ),
      ),
    );
  }

  /** @param {number} input @param {boolean} told whether its numbers are shown */
  show(input, told) {
    const at = this.findIndex(input);
    this.at = at;
    if (at !== null) for (const mark of this.marks) mark.show(at, told);
    this.hodographed?.show(at, told);
    if (told) this.showReadings(at);
  }

  /** Tell the numbers at a place of the answer's arrays. @param {number | null} at */
  showReadings(at) {
    const inputs = this.knownAnswer.input_angle;
    for (const { box, series, unit } of this.readings) {
      const value = at === null || !series.length ? null : interpolate(series, at);
      box.textContent = value === null ? "–" : `${formatBriefly(value)} ${unit}`.trim();
    }
    const status = at === null ? "ok" : this.knownAnswer.dynamics.status[Math.round(at)];
    const [first, last] = [inputs[0], inputs[inputs.length - 1]].map((end) => this.formatInput(end));
    const said =
      at === null
        ? t`Forces are available from ${first} to ${last}, the range in which the design was verified.`
        : (STATUS_REASONS[status] ?? "");
    if (this.outside.textContent !== said) this.outside.textContent = said;
  }

  stop() {
    this.gone.abort();
    this.editor?.attach(null);
    this.mover?.addCompanion(null);
  }
}

/**
 * The greatest magnitude of several forces at each place.
 * @param {{x: Series, y: Series}[]} forces
 * @returns {Series}
 */
function greatestMagnitudes(forces) {
  return forces[0].x.map((_, k) => {
    const sizes = forces.map(({ x, y }) =>
      x[k] === null || y[k] === null ? null : Math.hypot(Number(x[k]), Number(y[k])),
    );
    return sizes.some((size) => size === null) ? null : Math.max(.../** @type {number[]} */ (sizes));
  });
}
