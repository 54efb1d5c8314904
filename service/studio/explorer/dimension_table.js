/** The table of a linkage's dimensions: each is typed, held, or made equal to another one. */

import { el, words } from "../core/dom.js";
import { dimensionsOf, settled, valueOf } from "./linkage_dimensions.js";
import { grounded } from "../canvas/linkage_drawing.js";
import { t } from "../core/messages.js";

/** @import { Skeleton } from "../types/values.js" */

/** @typedef {import("./linkage_dimensions.js").Dimension} Dimension */
/** @typedef {import("./linkage_dimensions.js").Joints} Joints */
/** @typedef {{dimension: Dimension, field: HTMLInputElement, held: HTMLInputElement, same: HTMLSelectElement}} Row */

/** Digits of a dimension that is shown. */
const DIGITS = 6;

export class Sizes {
  /**
   * @param {Skeleton} skeleton
   * @param {string} unit of lengths
   * @param {(places: Joints, apart: boolean) => void} moved told where the joints have gone, and whether that is a step
   *   of its own
   * @param {() => void} bound told when something else is held or equal
   */
  constructor(skeleton, unit, moved, bound) {
    this.still = grounded(skeleton);
    this.moved = moved;
    this.bound = bound;
    /** @type {Joints} */
    this.places = skeleton.joints;
    const all = dimensionsOf(skeleton);
    this.rows = all.map((dimension, k) => this.row(dimension, k, all));
    this.told = el("p", { class: "note", role: "status" });
    const heads = [t`Dimension`, t`Value`, t`Held`, t`Equal to`];
    this.node = el(
      "section",
      { class: "sizes-of" },
      el(
        "table",
        {},
        el("thead", {}, el("tr", {}, ...heads.map((head) => el("th", { scope: "col" }, head)))),
        el(
          "tbody",
          {},
          ...this.rows.map(({ dimension, field, held, same }) =>
            el(
              "tr",
              {},
              el(
                "th",
                { scope: "row" },
                named(dimension),
                " ",
                el("span", { class: "unit" }, measure(dimension, unit)),
              ),
              ...[field, held, same].map((one) => el("td", {}, one)),
            ),
          ),
        ),
      ),
      this.told,
    );
    this.show(this.places);
  }

  /** @param {Dimension} dimension @param {number} k @param {Dimension[]} all @returns {Row} */
  row(dimension, k, all) {
    const name = named(dimension);
    const field = el("input", {
      type: "number",
      step: "any",
      "aria-label": name,
      onchange: () => this.type(k, field.valueAsNumber),
    });
    const held = el("input", { type: "checkbox", "aria-label": t`Hold ${name}`, onchange: () => this.bound() });
    const alike = all.flatMap((one, n) =>
      n !== k && one.joints.length === dimension.joints.length ? [{ one, n }] : [],
    );
    const same = el(
      "select",
      { "aria-label": t`${name} equals`, onchange: () => this.equate(k) },
      el("option", { value: "" }, "–"),
      ...alike.map(({ one, n }) => el("option", { value: n }, between(one))),
    );
    return { dimension, field, held, same };
  }

  /** What holds wherever the joints go. @returns {import("./linkage_dimensions.js").Demand[]} */
  get demands() {
    return this.rows.flatMap(({ dimension, held, same }) => [
      ...(held.checked ? [{ dimension, value: valueOf(dimension, this.places) }] : []),
      ...(same.value ? [{ dimension, other: this.rows[Number(same.value)].dimension }] : []),
    ]);
  }

  /** A dimension is typed: the others stay, but for those that equal it. @param {number} k @param {number} value */
  type(k, value) {
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
      value: linked.has(n) ? value : valueOf(one, this.places),
    }));
    // The ground itself is changed at its further pivots.
    const grounds = dimension.link === "ground";
    this.put(settled(this.places, demands, grounds ? this.still.slice(0, 1) : this.still), true);
  }

  /** A dimension gets the value of another one. @param {number} k */
  equate(k) {
    const { same } = this.rows[k];
    this.bound();
    if (same.value) this.type(k, valueOf(this.rows[Number(same.value)].dimension, this.places));
  }

  /** A joint is drawn: the others go where what is held stays. @param {string} name @param {[number, number]} at */
  draw(name, at) {
    const still = [...new Set([...this.still, name])];
    this.put(settled({ ...this.places, [name]: at }, this.demands, still));
  }

  /** The joints stand elsewhere, whatever is held. @param {Joints} places */
  take(places) {
    this.told.textContent = "";
    this.places = { ...this.places, ...places };
    this.show(this.places);
  }

  /** @param {Joints | null} found @param {boolean} [apart] whether it is a step of its own */
  put(found, apart = false) {
    this.told.textContent = found ? "" : t`No linkage near this one has these dimensions together.`;
    if (!found) return this.show(this.places);
    this.places = found;
    this.show(found);
    this.moved(found, apart);
  }

  /** @param {Joints} places */
  show(places) {
    for (const { dimension, field } of this.rows)
      field.value = String(Number(valueOf(dimension, places).toPrecision(DIGITS)));
  }
}

/** Its joints, as it stands in a table. @param {Dimension} dimension */
function between({ joints: [at, from, to] }) {
  return to === undefined ? `${at}–${from}` : `∠${from}${at}${to}`;
}

/** @param {Dimension} dimension */
function named(dimension) {
  return `${words(dimension.link)} ${between(dimension)}`;
}

/** @param {Dimension} dimension @param {string} unit */
function measure({ joints }, unit) {
  return joints.length === 2 ? `(${unit})` : "(°)";
}
