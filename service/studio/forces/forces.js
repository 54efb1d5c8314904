/** What a linkage design bears: arrows on the linkage that moves, what drives it, plots, hodograph and peaks. */

import * as api from "../core/api.js";
import { el, shown, words } from "../core/dom.js";
import { ForceArrows, forcesIn } from "./force_arrows.js";
import { cleared } from "./force_scales.js";
import { Hodograph } from "../plots/hodograph.js";
import { LoadEditor } from "./load_editor.js";
import { foreign, number, t, term, translated } from "../core/messages.js";
import { between, within } from "../core/player.js";
import { brief, plots, runs } from "../plots/plots.js";
import { placeOf } from "../motion/swept_area.js";
import { symbolOf } from "../core/units.js";

/** @import { LinkageAnalysis, Schemas, Skeleton, Solved } from "../types/values.js" */

/** Samples of a turn, or of the range. */
const STEPS = 360;

/** Lines of one plot: so many colours there are. */
const TOGETHER = 4;

/** Why numbers are missing, or are to be read with care, by the status of a position. @type {Record<string, string>} */
const REASONS = {
  not_assembled: t`the linkage does not close there`,
  dead_centre: t`dead centre: the forces are not determined`,
  load_undetermined: t`the ends of a spring meet, and its force has no direction`,
  friction_jam: t`it jams by friction`,
  stick: t`something with friction stands still: the numbers are those without its friction`,
  statically_indeterminate: t`statically indeterminate: constraints are redundant, and where no number stands the force is not unique`,
};

/** @typedef {(number | null)[]} Series */
/** @typedef {import("../motion/linkage_motion.js").Mover} Mover */

export class Forces {
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
    /** @type {import("../plots/plots.js").Mark[]} */
    this.marks = [];
    /** @type {{box: HTMLElement, series: Series, unit: string}[]} */
    this.readings = [];
    /** @type {Hodograph | null} */
    this.hodographed = null;
    /** Where the motion stands in the arrays of the answer. @type {number | null} */
    this.at = null;
    this.hodograph = el("div", { class: "plots" });
    this.outside = el("span", { class: "note" });
    this.pictures = el("div", { class: "borne" });
    // What a design with masses of its own weighs is not for the page to say.
    this.editor = this.design.dynamics
      ? null
      : new LoadEditor(this.skeleton, job.problem, this.sliding, (block) => this.ask(block));
    place.replaceChildren(...(this.editor ? [this.editor.node] : []), this.pictures);
    this.editor?.attach(mover);
    const { forces } = this.design;
    // A remark that begins with a field says that the block does not fit the design, and there is nothing to ask for.
    if (forces?.remark?.startsWith("/"))
      this.pictures.replaceChildren(el("p", { class: "error" }, t`The design has no forces: ${forces.remark}.`));
    else if (job.problem.dynamics ?? this.design.dynamics) {
      this.pictures.replaceChildren(el("p", { class: "note" }, t`The forces are being computed …`));
      this.ask(null).catch((error) => this.fail(error));
    } else
      this.pictures.replaceChildren(
        el(
          "p",
          { class: "note" },
          t`The problem does not state what the linkage weighs and carries: its forces are not known until that is stated above.`,
        ),
      );
  }

  /**
   * Ask for the forces and show them.
   * @param {Schemas["DesignForcesBlock"] | null} block null for that of the problem
   */
  async ask(block) {
    const answer = await api.forces(this.job.id, this.n, STEPS, block, this.gone.signal);
    if (this.gone.signal.aborted) return;
    this.answer = cleared(/** @type {Forces["known"]} */ (answer), this.skeleton, this.sliding);
    this.build();
    this.put();
  }

  /** @param {Error} error */
  fail(error) {
    if (!this.gone.signal.aborted) this.pictures.replaceChildren(el("p", { class: "error" }, error.message));
  }

  /** Let the pictures go with a motion, or with none. @param {Mover | null} mover */
  attach(mover) {
    this.mover = mover;
    this.editor?.attach(mover);
    this.put();
  }

  /** The arrows, in the picture of the motion that there is. */
  put() {
    const { answer, mover } = this;
    if (!answer || !mover) return;
    this.arrows = new ForceArrows(
      mover.view,
      forcesIn(answer, this.skeleton, mover.linkage.slides),
      this.unit("force"),
      answer.joints,
      (input) => this.placeAt(input),
    );
    const { node, extent } = this.arrows;
    this.pictures
      .querySelector(".force-choice")
      ?.replaceChildren(el("label", { for: "force-on" }, "Arrows: forces on"), this.arrows.choice);
    mover.accompany({
      node,
      extent,
      show: (input, now, told) => {
        this.arrows?.show(input, now);
        this.show(input, told);
      },
    });
  }

  /** The answer, where it is there. */
  get known() {
    return /** @type {LinkageAnalysis & {dynamics: Schemas["DynamicsAnswer"]}} */ (this.answer);
  }

  /** The unit of a quantity as the answer has it; empty where its units are the client's. @param {string} dimension */
  unit(dimension) {
    const { units, length_unit: length } = this.known.dynamics;
    return symbolOf(dimension, { kind: this.job.problem.kind, dynamics: { units }, length_unit: length });
  }

  /** Whether a slide drives, so that the input is a place. */
  get sliding() {
    const { links, input_link: input } = this.skeleton;
    return links.every((link) => link.name !== input);
  }

  /** An input with its unit. @param {number} input */
  input(input) {
    const rounded = shown(Math.round(10 * input) / 10);
    return this.sliding ? `${rounded} ${this.known.dynamics.length_unit}` : `${rounded}°`;
  }

  /**
   * The place in the answer's arrays at an input; null outside of them.
   * @param {number} input
   * @returns {number | null}
   */
  placeAt(input) {
    const inputs = this.known.input_angle;
    const last = inputs.length - 1;
    const [low, high] = [Math.min(inputs[0], inputs[last]), Math.max(inputs[0], inputs[last])];
    const closed = !this.sliding && Math.abs((high - low) % 360) < 1e-6 && high > low;
    const slack = 1e-6 * (high - low);
    if (!closed && (input < low - slack || input > high + slack)) return null;
    return within(placeOf(inputs, input, closed), last);
  }

  build() {
    const answer = this.known;
    const { dynamics, input_angle: inputs } = answer;
    const lead = (/** @type {number} */ at) => this.mover?.lead(Number(between(inputs, at)));
    const wanted = this.plotted();
    const made = plots(wanted, inputs, lead, this.sliding ? ` ${dynamics.length_unit}` : "°");
    this.marks = made;
    this.readings = [];
    const wheres = this.hodographs();
    const pick = el(
      "select",
      { id: "hodograph-of", onchange: () => this.trace(wheres[Number(pick.value)]) },
      ...wheres.map(({ title }, k) => el("option", { value: k }, title)),
    );
    this.pictures.replaceChildren(
      el("p", { class: "row force-choice" }),
      this.now(),
      ...this.remarks(),
      this.peaks(),
      el("div", { class: "plots force-plots" }, ...made.map(({ figure }) => figure)),
      el("div", { class: "row" }, el("label", { for: "hodograph-of" }, t`Hodograph of`), pick),
      this.hodograph,
    );
    this.trace(wheres[0]);
  }

  /** What drives, as it is now. */
  now() {
    const [name, unit] = this.driven();
    const box = el("output", { class: "reading" }, "–");
    this.readings.push({ box, series: this.known.dynamics.drive ?? [], unit });
    return el("p", { class: "row drive-now" }, el("span", {}, t`${name} now`), box, this.outside);
  }

  /** @returns {[string, string]} name and unit of what drives */
  driven() {
    return this.sliding ? [t`Drive force`, this.unit("force")] : [t`Drive torque`, this.unit("torque")];
  }

  /** @returns {import("../plots/plots.js").Plotted[]} */
  plotted() {
    const { dynamics } = this.known;
    const unknown = dynamics.status.map(
      (/** @type {string} */ one) => !["ok", "stick", "statically_indeterminate"].includes(one),
    );
    const [name, unit] = this.driven();
    const titled = (/** @type {string} */ title, /** @type {string} */ of) => (of ? `${title} (${of})` : title);
    const force = this.unit("force");
    const joints = Object.entries(dynamics.joints ?? {}).map(
      ([joint, links]) => /** @type {[string, Series]} */ ([joint, greatest(Object.values(links))]),
    );
    const chunks = Array.from({ length: Math.ceil(joints.length / TOGETHER) }, (_, k) =>
      joints.slice(k * TOGETHER, (k + 1) * TOGETHER),
    );
    const { shaking } = dynamics;
    /** @type {import("../plots/plots.js").Plotted[]} */
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
              lines: { total: greatest([shaking.force]), x: shaking.force.x, y: shaking.force.y },
            },
            { title: titled(t`Shaking moment`, this.unit("torque")), lines: { "": shaking.moment } },
          ]
        : []),
    ];
    return all.map((one) => ({
      ...one,
      gaps: Object.values(one.lines)[0].map((value, k) => unknown[k] || value === null),
    }));
  }

  /** What there is a hodograph of. @returns {{title: string, x: Series, y: Series}[]} */
  hodographs() {
    const { joints, shaking } = this.known.dynamics;
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
  trace(chosen) {
    if (!chosen) return;
    const drawn = new Hodograph(words(chosen.title), chosen.x, chosen.y, this.unit("force"));
    this.hodograph?.replaceChildren(drawn.figure);
    this.hodographed = drawn;
    drawn.show(this.at, true);
  }

  /** Where numbers are missing and why, and what is to be known of all of them. */
  remarks() {
    const { dynamics, input_angle: inputs } = this.known;
    const found = [...new Set(/** @type {string[]} */ (dynamics.status))]
      .filter((one) => one !== "ok")
      .flatMap((status) =>
        runs(dynamics.status.map((/** @type {string} */ one) => one === status)).map(([from, to]) =>
          el(
            "li",
            {},
            el(
              "button",
              { type: "button", class: "small", onclick: () => this.mover?.lead(inputs[from]) },
              from === to ? this.input(inputs[from]) : t`${this.input(inputs[from])} to ${this.input(inputs[to])}`,
            ),
            ` ${REASONS[status] ?? words(status)}`,
          ),
        ),
      );
    return [
      ...(found.length ? [el("ul", { class: "gaps" }, ...found)] : []),
      ...dynamics.warnings.map((/** @type {string} */ one) =>
        el("p", { class: "note", lang: foreign(one) }, translated(one)),
      ),
    ];
  }

  /** The greatest of everything, with the input at which it stands and the value that it has now. */
  peaks() {
    const { extremes, power, joints, shaking, drive } = this.known.dynamics;
    const [name, unit] = this.driven();
    const [force, torque] = [this.unit("force"), this.unit("torque")];
    /** @type {[string, number | null, number | null, string, Series | null][]} */
    const rows = [
      [t`${name}, greatest`, extremes.drive.max, extremes.drive.at, unit, drive ?? null],
      [t`${name}, least`, extremes.drive.min, extremes.drive.at_min, unit, null],
      ...Object.entries(extremes.joints).map(
        ([joint, peak]) =>
          /** @type {[string, number | null, number | null, string, Series | null]} */ ([
            t`Pin force ${joint}`,
            peak.max,
            peak.at,
            force,
            joints?.[joint] ? greatest(Object.values(joints[joint])) : null,
          ]),
      ),
      [
        t`Shaking force`,
        extremes.shaking_force.max,
        extremes.shaking_force.at,
        force,
        shaking ? greatest([shaking.force]) : null,
      ],
      [t`Shaking moment`, extremes.shaking_moment.max, extremes.shaking_moment.at, torque, shaking?.moment ?? null],
      [t`Power of the drive`, power.peak, null, this.unit("power"), null],
    ];
    return el(
      "div",
      { class: "table" },
      el(
        "table",
        { class: "figures peaks" },
        el(
          "thead",
          {},
          el(
            "tr",
            {},
            ...[t`Peaks`, t`Value`, t`At the input`, t`Now`].map((head) => el("th", { scope: "col" }, head)),
          ),
        ),
        el(
          "tbody",
          {},
          ...rows.map(([title, value, at, of, series]) => {
            const box = el("td", { class: "reading" });
            if (series) this.readings.push({ box, series, unit: of });
            return el(
              "tr",
              {},
              el("th", { scope: "row" }, title),
              value === null
                ? el("td", {}, "–")
                : el("td", { title: `${number(value)} ${of}`.trim() }, `${brief(value)} ${of}`.trim()),
              el(
                "td",
                {},
                at === null
                  ? "–"
                  : el(
                      "button",
                      {
                        type: "button",
                        class: "small",
                        "aria-label": t`${title}: go to ${this.input(at)}`,
                        onclick: () => this.mover?.lead(at),
                      },
                      this.input(at),
                    ),
              ),
              box,
            );
          }),
        ),
      ),
    );
  }

  /** @param {number} input @param {boolean} told whether numbers are told of it */
  show(input, told) {
    const at = this.placeAt(input);
    this.at = at;
    if (at !== null) for (const mark of this.marks) mark.show(at, told);
    this.hodographed?.show(at, told);
    if (told) this.read(at);
  }

  /** Tell the numbers at a place of the answer's arrays. @param {number | null} at */
  read(at) {
    const inputs = this.known.input_angle;
    for (const { box, series, unit } of this.readings) {
      const value = at === null || !series.length ? null : between(series, at);
      box.textContent = value === null ? "–" : `${brief(value)} ${unit}`.trim();
    }
    const status = at === null ? "ok" : this.known.dynamics.status[Math.round(at)];
    const [first, last] = [inputs[0], inputs[inputs.length - 1]].map((end) => this.input(end));
    const said =
      at === null
        ? t`Forces are known from ${first} to ${last}, the range that the design was verified along.`
        : (REASONS[status] ?? "");
    if (this.outside.textContent !== said) this.outside.textContent = said;
  }

  stop() {
    this.gone.abort();
    this.editor?.attach(null);
    this.mover?.accompany(null);
  }
}

/**
 * The greatest magnitude of several forces at each place.
 * @param {{x: Series, y: Series}[]} forces
 * @returns {Series}
 */
function greatest(forces) {
  return forces[0].x.map((_, k) => {
    const sizes = forces.map(({ x, y }) =>
      x[k] === null || y[k] === null ? null : Math.hypot(Number(x[k]), Number(y[k])),
    );
    return sizes.some((size) => size === null) ? null : Math.max(.../** @type {number[]} */ (sizes));
  });
}
