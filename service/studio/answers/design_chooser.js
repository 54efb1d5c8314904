/** Choosing among the designs of an answer: by two quantities, by bounds, and by comparing two of them. */

import { Bounds } from "./metric_bounds.js";
import { Comparison, sideBySide } from "./comparison.js";
import { el } from "../core/dom.js";
import { quantities } from "./shared_metrics.js";
import { t, term } from "../core/messages.js";
import { Scatter } from "./scatter_plot.js";

/** @import { Solved } from "../types/values.js" */

/** Of a front, the names of what stands in the metrics under another name. @type {Record<string, string>} */
const FRONT = { rms: "rms_residual" };

export class Choosing {
  /**
   * @param {HTMLElement} place
   * @param {import("../design/workbench.js").Desk} desk
   * @param {Solved} job with two designs at least
   * @param {import("./design_strip.js").Strip} strip @param {() => void} narrowed told when bounds hide designs
   */
  constructor(place, desk, job, strip, narrowed) {
    this.place = place;
    this.desk = desk;
    this.job = job;
    this.strip = strip;
    this.narrowed = narrowed;
    this.designs = job.result.designs;
    this.quantities = quantities(this.designs, job.problem);
    /** @type {number[]} */
    this.front = job.result.front?.designs ?? [];
    /** @type {import("../design/design.js").Shown | null} */
    this.shown = null;
    /** The design that the chosen one is compared with. @type {number | null} */
    this.other = null;
    /** @type {import("./comparison.js").Manner | null} */
    this.manner = null;
    /** @type {Comparison | null} */
    this.comparison = null;
    this.open = false;
    const axes = this.axes();
    this.bounds = new Bounds(this.quantities, () => this.bounded());
    this.scatter = new Scatter(
      this.quantities,
      axes,
      (n) => strip.select(n),
      () => {
        this.bounds.show(this.scatter.axes);
        this.tell();
      },
    );
    this.table = el("div");
    this.pick = el("select", {
      id: "compare-with",
      onchange: () => {
        this.other = this.pick.value === "" ? null : Number(this.pick.value);
        this.compare();
      },
    });
    this.manners = /** @type {const} */ (["beside", "over"]).map((manner) =>
      el(
        "button",
        {
          type: "button",
          class: "small",
          "aria-pressed": "false",
          onclick: () => {
            this.manner = this.manner === manner ? null : manner;
            this.compare();
          },
        },
        manner === "beside" ? t`Side by side` : t`Overlay`,
      ),
    );
    strip.changed = () => this.tell();
  }

  /**
   * Along the front where there is one, else by the first two quantities in which the designs differ.
   * @returns {[number, number]}
   */
  axes() {
    const names = (this.job.result.front?.quantities ?? []).map((/** @type {string} */ name) => FRONT[name] ?? name);
    const of = (/** @type {string} */ name) =>
      this.quantities.findIndex((one) => one.name === name && one.values.some((value) => value !== one.values[0]));
    const found = names.map(of).filter((/** @type {number} */ k) => k >= 0);
    const [up, across] = [...found, ...this.quantities.keys()].filter((k, n, all) => all.indexOf(k) === n);
    return [across ?? up, up];
  }

  /** What the designs of the front are not beaten in. @returns {string[]} */
  beaten() {
    return (this.job.result.front?.quantities ?? []).map((/** @type {string} */ name) => term(FRONT[name] ?? name));
  }

  /** The tab has been opened. */
  opened() {
    this.open = true;
    this.bounds.show(this.scatter.axes);
    this.place.replaceChildren(
      this.scatter.node,
      ...(this.front.length
        ? [el("p", { class: "note" }, t`Ringed: no other design beats it in all of ${this.beaten().join(", ")}.`)]
        : []),
      this.bounds.node,
      el(
        "section",
        { "aria-label": t`Two designs` },
        el("h3", { class: "minor" }, t`Compare`),
        el(
          "div",
          { class: "row" },
          el("label", { for: "compare-with" }, t`With`),
          this.pick,
          el("div", { class: "row", role: "group", "aria-label": t`On the stage` }, ...this.manners),
        ),
        this.table,
      ),
    );
    this.tell();
    this.compare();
  }

  closed() {
    this.open = false;
    this.end();
    this.place.replaceChildren();
  }

  /** Another design is chosen. @param {import("../design/design.js").Shown} shown */
  chosen(shown) {
    this.end();
    this.shown = shown;
    if (this.other === this.strip.chosen) this.other = null;
    this.tell();
    this.compare();
  }

  bounded() {
    this.strip.keep(this.bounds.kept());
    this.narrowed();
    this.tell();
  }

  /** What is shown of all designs. */
  tell() {
    if (!this.open) return;
    const { chosen, pinned } = this.strip;
    this.scatter.show({ chosen, pinned, kept: this.bounds.kept(), front: this.front });
    this.pick.replaceChildren(
      el("option", { value: "" }, "–"),
      ...this.strip.row
        .filter((n) => n !== chosen)
        .map((n) => el("option", { value: n }, t`Design ${n + 1}`, pinned.includes(n) && " ★")),
    );
    this.pick.value = this.other === null ? "" : String(this.other);
  }

  /** Compare the chosen design with another one, as it is asked for now. */
  compare() {
    this.end();
    if (!this.open) return;
    const { designs, other, manner, shown, strip } = this;
    const both = other !== null && [designs[strip.chosen], designs[other]].every((one) => one.mechanism.skeleton);
    this.manners.forEach((button, k) => {
      const of = k ? "over" : "beside";
      button.disabled = other === null || (k === 1 && !both);
      button.setAttribute("aria-pressed", String(manner === of && !button.disabled));
    });
    this.table.replaceChildren(
      other === null
        ? el("p", { class: "note" }, t`Choose a second design: what differs is marked.`)
        : sideBySide(designs, [strip.chosen, other], this.job.problem),
    );
    if (other === null || manner === null || !shown || (manner === "over" && !both)) return;
    this.desk.stage.show("watch");
    this.comparison = new Comparison(this.desk, this.job, other, manner, shown);
  }

  end() {
    this.comparison?.stop();
    this.comparison = null;
  }
}
