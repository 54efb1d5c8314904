/** The table of a linkage's dimensions: each is typed, held, or made equal to another one. */

import { createElement, toWords } from "../core/dom.js";
import { listDimensions, solveDemands, dimensionValue } from "./linkage_dimensions.js";
import { groundedJoints } from "../canvas/linkage_drawing.js";
import { t } from "../core/messages.js";

/** @import { Skeleton } from "../types/values.js" */

/** @typedef {import("./linkage_dimensions.js").Dimension} Dimension */
/** @typedef {import("./linkage_dimensions.js").Joints} Joints */
/** @typedef {{dimension: Dimension, field: HTMLInputElement, held: HTMLInputElement, same: HTMLSelectElement}} Row */

/** Digits of a dimension that is shown. */
const DIMENSION_DIGITS = 6;

export class DimensionTable {
  /**
   * @param {Skeleton} skeleton
   * @param {string} unit of lengths
   * @param {(places: Joints, apart: boolean) => void} moved called with the new joints, and whether that is a step
   *   of its own
   * @param {() => void} bound called when the fixed or equal dimensions change
   */
  constructor(skeleton, unit, moved, bound) {
    this.still = groundedJoints(skeleton);
    this.moved = moved;
    this.bound = bound;
    /** @type {Joints} */
    this.places = skeleton.joints;
    const all = listDimensions(skeleton);
    this.rows = all.map((dimension, k) => this.createRow(dimension, k, all));
    this.told = createElement("p", { class: "note", role: "status" });
    const heads = [t`Dimension`, t`Value`, t`Held`, t`Equal to`];
    this.node = createElement(
      "section",
      { class: "sizes-of" },
      createElement(
        "table",
        {},
        createElement(
          "thead",
          {},
          createElement("tr", {}, ...heads.map((head) => createElement("th", { scope: "col" }, head))),
        ),
        createElement(
          "tbody",
          {},
          ...this.rows.map(({ dimension, field, held, same }) =>
            createElement(
              "tr",
              {},
              createElement(
                "th",
                { scope: "row" },
                describeDimension(dimension),
                " ",
                createElement("span", { class: "unit" }, formatDimension(dimension, unit)),
              ),
              ...[field, held, same].map((one) => createElement("td", {}, one)),
            ),
          ),
        ),
      ),
      this.told,
    );
    this.show(this.places);
  }

  /** @param {Dimension} dimension @param {number} k @param {Dimension[]} all @returns {Row} */
  createRow(dimension, k, all) {
    const name = describeDimension(dimension);
    const field = createElement("input", {
      type: "number",
      step: "any",
      "aria-label": name,
      onchange: () => this.setValue(k, field.valueAsNumber),
    });
    const held = createElement("input", {
      type: "checkbox",
      "aria-label": t`Hold ${name}`,
      onchange: () => this.bound(),
    });
    const alike = all.flatMap((one, n) =>
      n !== k && one.joints.length === dimension.joints.length ? [{ one, n }] : [],
    );
    const same = createElement(
      "select",
      { "aria-label": t`${name} equals`, onchange: () => this.setEqual(k) },
      createElement("option", { value: "" }, "–"),
      ...alike.map(({ one, n }) => createElement("option", { value: n }, describeJoints(one))),
    );
    return { dimension, field, held, same };
  }

  /** What holds wherever the joints go. @returns {import("./linkage_dimensions.js").Demand[]} */
  get demands() {
    return this.rows.flatMap(({ dimension, held, same }) => [
      ...(held.checked ? [{ dimension, value: dimensionValue(dimension, this.places) }] : []),
      ...(same.value ? [{ dimension, other: this.rows[Number(same.value)].dimension }] : []),
    ]);
  }

  /** A dimension is typed: the others stay, but for those that equal it. @param {number} k @param {number} value */
  setValue(k, value) {
    const { dimension } = this.rows[k];
    if (!Number.isFinite(value) || (dimension.joints.length === 2 && value <= 0)) return this.show(this.places);
    const linked = new Set([k]);
    for (let before = 0; before < linked.size;) {
      before = linked.size;
      this.rows.forEach(({ same }, n) => {
        if (same.value && (linked.has(n) || linked.has(Number(same.value)))) linked.add(n).add(Number(same.value));
      });
    }
    const demands = this.rows.map(({ dimension: one }, n) => ({
      dimension: one,
      value: linked.has(n) ? value : dimensionValue(one, this.places),
    }));
    // The ground itself is changed at its further pivots.
    const grounds = dimension.link === "ground";
    this.applySolution(solveDemands(this.places, demands, grounds ? this.still.slice(0, 1) : this.still), true);
  }

  /** A dimension gets the value of another one. @param {number} k */
  setEqual(k) {
    const { same } = this.rows[k];
    this.bound();
    if (same.value) this.setValue(k, dimensionValue(this.rows[Number(same.value)].dimension, this.places));
  }

  /** A joint is drawn: the others go where what is held stays. @param {string} name @param {[number, number]} at */
  dragJoint(name, at) {
    const still = [...new Set([...this.still, name])];
    this.applySolution(solveDemands({ ...this.places, [name]: at }, this.demands, still));
  }

  /** Move the joints regardless of fixed dimensions. @param {Joints} places */
  moveJoints(places) {
    this.told.textContent = "";
    this.places = { ...this.places, ...places };
    this.show(this.places);
  }

  /** @param {Joints | null} found @param {boolean} [apart] whether it is a step of its own */
  applySolution(found, apart = false) {
    this.told.textContent = found ? "" : t`No linkage near this one has all these dimensions.`;
    if (!found) return this.show(this.places);
    this.places = found;
    this.show(found);
    this.moved(found, apart);
  }

  /** @param {Joints} places */
  show(places) {
    for (const { dimension, field } of this.rows)
      field.value = String(Number(dimensionValue(dimension, places).toPrecision(DIMENSION_DIGITS)));
  }
}

/** Its joints, as it stands in a table. @param {Dimension} dimension */
function describeJoints({ joints: [at, from, to] }) {
  return to === undefined ? `${at}–${from}` : `∠${from}${at}${to}`;
}

/** @param {Dimension} dimension */
function describeDimension(dimension) {
  return `${toWords(dimension.link)} ${describeJoints(dimension)}`;
}

/** @param {Dimension} dimension @param {string} unit */
function formatDimension({ joints }, unit) {
  return joints.length === 2 ? `(${unit})` : "(°)";
}
