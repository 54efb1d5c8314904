/** Choose among the designs of an answer by a scatter plot, by bounds and by comparison. */

import { MetricBounds } from "./metric_bounds.js";
import { Comparison, compareNumbers } from "./comparison.js";
import { createElement } from "../core/dom.js";
import { collectQuantities } from "./shared_metrics.js";
import { t, term } from "../core/messages.js";
import { ScatterPlot } from "./scatter_plot.js";

/** @import { Solved } from "../types/values.js" */

/** Names of metrics that differ from the names in the Pareto front. @type {Record<string, string>} */
const FRONT_METRICS = { rms: "rms_residual" };

export class DesignChooser {
  /**
   * @param {HTMLElement} place
   * @param {import("../design/workbench.js").Workbench} desk
   * @param {Solved} job with two designs at least
   * @param {import("./design_strip.js").DesignStrip} strip @param {() => void} narrowed called when bounds hide designs
   */
  constructor(place, desk, job, strip, narrowed) {
    this.place = place;
    this.desk = desk;
    this.job = job;
    this.strip = strip;
    this.narrowed = narrowed;
    this.designs = job.result.designs;
    this.quantities = collectQuantities(this.designs, job.problem);
    /** @type {number[]} */
    this.front = job.result.front?.designs ?? [];
    /** @type {import("../design/design.js").DesignView | null} */
    this.shown = null;
    /** The design compared with the selected one. @type {number | null} */
    this.other = null;
    /** @type {import("./comparison.js").Manner | null} */
    this.manner = null;
    /** @type {Comparison | null} */
    this.comparison = null;
    this.open = false;
    const axes = this.chooseAxes();
    this.bounds = new MetricBounds(this.quantities, () => this.applyBounds());
    this.scatter = new ScatterPlot(
      this.quantities,
      axes,
      (n) => strip.select(n),
      () => {
        this.bounds.show(this.scatter.axes);
        this.update();
      },
    );
    this.table = createElement("div");
    this.pick = createElement("select", {
      id: "compare-with",
      onchange: () => {
        this.other = this.pick.value === "" ? null : Number(this.pick.value);
        this.compare();
      },
    });
    this.manners = /** @type {const} */ (["beside", "over"]).map((manner) =>
      createElement(
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
    strip.changed = () => this.update();
  }

  /**
   * Choose the axes: the objectives of the Pareto front, or else the first two quantities that vary.
   * @returns {[number, number]}
   */
  chooseAxes() {
    const names = (this.job.result.front?.quantities ?? []).map(
      (/** @type {string} */ name) => FRONT_METRICS[name] ?? name,
    );
    const of = (/** @type {string} */ name) =>
      this.quantities.findIndex((one) => one.name === name && one.values.some((value) => value !== one.values[0]));
    const found = names.map(of).filter((/** @type {number} */ k) => k >= 0);
    const [up, across] = [...found, ...this.quantities.keys()].filter((k, n, all) => all.indexOf(k) === n);
    return [across ?? up, up];
  }

  /** List the objectives of the Pareto front. @returns {string[]} */
  listObjectives() {
    return (this.job.result.front?.quantities ?? []).map((/** @type {string} */ name) =>
      term(FRONT_METRICS[name] ?? name),
    );
  }

  /** The tab has been opened. */
  handleOpen() {
    this.open = true;
    this.bounds.show(this.scatter.axes);
    this.place.replaceChildren(
      this.scatter.node,
      ...(this.front.length
        ? [
            createElement(
              "p",
              { class: "note" },
              t`Ringed: no other design is better in all of ${this.listObjectives().join(", ")}.`,
            ),
          ]
        : []),
      this.bounds.node,
      createElement(
        "section",
        { "aria-label": t`Two designs` },
        createElement("h3", { class: "minor" }, t`Compare`),
        createElement(
          "div",
          { class: "row" },
          createElement("label", { for: "compare-with" }, t`With`),
          this.pick,
          createElement("div", { class: "row", role: "group", "aria-label": t`On the stage` }, ...this.manners),
        ),
        this.table,
      ),
    );
    this.update();
    this.compare();
  }

  handleClose() {
    this.open = false;
    this.endComparison();
    this.place.replaceChildren();
  }

  /** Update after another design was selected. @param {import("../design/design.js").DesignView} shown */
  showChosen(shown) {
    this.endComparison();
    this.shown = shown;
    if (this.other === this.strip.chosen) this.other = null;
    this.update();
    this.compare();
  }

  applyBounds() {
    this.strip.filter(this.bounds.listKept());
    this.narrowed();
    this.update();
  }

  /** Update the plot and the bounds. */
  update() {
    if (!this.open) return;
    const { chosen, pinned } = this.strip;
    this.scatter.show({ chosen, pinned, kept: this.bounds.listKept(), front: this.front });
    this.pick.replaceChildren(
      createElement("option", { value: "" }, "–"),
      ...this.strip.row
        .filter((n) => n !== chosen)
        .map((n) => createElement("option", { value: n }, t`Design ${n + 1}`, pinned.includes(n) && " ★")),
    );
    this.pick.value = this.other === null ? "" : String(this.other);
  }

  /** Compare the selected design with the second one in the chosen manner. */
  compare() {
    this.endComparison();
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
        ? createElement("p", { class: "note" }, t`Choose a second design; differences are marked.`)
        : compareNumbers(designs, [strip.chosen, other], this.job.problem),
    );
    if (other === null || manner === null || !shown || (manner === "over" && !both)) return;
    this.desk.stage.showMode("watch");
    this.comparison = new Comparison(this.desk, this.job, other, manner, shown);
  }

  endComparison() {
    this.comparison?.stop();
    this.comparison = null;
  }
}
