/** Sliders that bound metrics; designs outside the bounds are hidden. */

import { createElement } from "../core/dom.js";
import { valuesDiffer, valueRange, formatQuantity } from "./shared_metrics.js";
import { t } from "../core/messages.js";

/** @typedef {import("./shared_metrics.js").Quantity} Quantity */

/** Steps of a slider. */
const SLIDER_STEPS = 100;

export class MetricBounds {
  /** @param {Quantity[]} quantities @param {() => void} changed */
  constructor(quantities, changed) {
    this.quantities = quantities;
    this.changed = changed;
    /** @type {Map<number, {least: boolean, limit: number}>} */
    this.set = new Map();
    this.rows = createElement("div", { class: "bounds" });
    this.said = createElement("span", { role: "status" });
    this.all = createElement(
      "button",
      {
        type: "button",
        class: "small",
        onclick: () => {
          this.set.clear();
          this.show(this.shown);
          changed();
        },
      },
      t`Show all`,
    );
    /** @type {number[]} */
    this.shown = [];
    this.node = createElement(
      "section",
      { "aria-label": t`Bounds` },
      createElement("h3", { class: "minor" }, t`Bounds`),
      this.rows,
      createElement("p", { class: "row" }, this.said, this.all),
    );
  }

  /** List which designs are within all bounds. @returns {boolean[]} */
  listKept() {
    return this.quantities[0].values.map((_, n) =>
      [...this.set].every(([k, { least, limit }]) => {
        const value = this.quantities[k].values[n];
        return value !== null && (least ? value >= limit : value <= limit);
      }),
    );
  }

  /** Show sliders for the given quantities and for those already bounded. @param {number[]} wanted */
  show(wanted) {
    this.shown = wanted;
    const all = [...new Set([...wanted, ...this.set.keys()])].filter((k) => valuesDiffer(this.quantities[k].values));
    this.rows.replaceChildren(...all.map((k) => this.createRow(k)));
    this.showCount();
  }

  /** @param {number} k */
  createRow(k) {
    const quantity = this.quantities[k];
    const [low, high] = valueRange(quantity.values);
    const step = (high - low) / SLIDER_STEPS;
    const id = `bound-${k}`;
    let least = this.set.get(k)?.least ?? quantity.more;
    const sense = createElement(
      "select",
      {
        "aria-label": t`${quantity.text}: direction of the bound`,
        onchange: () => {
          least = sense.value === "≥";
          slider.value = String(least ? 0 : SLIDER_STEPS);
          this.set.delete(k);
          say();
          this.handleInput();
        },
      },
      createElement("option", { value: "≥" }, "≥"),
      createElement("option", { value: "≤" }, "≤"),
    );
    sense.value = least ? "≥" : "≤";
    const limit = () => this.set.get(k)?.limit ?? (least ? low : high);
    const slider = createElement("input", {
      type: "range",
      id,
      min: 0,
      max: SLIDER_STEPS,
      step: 1,
      value: Math.round((limit() - low) / step),
      oninput: () => {
        const at = Number(slider.value);
        if (at === (least ? 0 : SLIDER_STEPS)) this.set.delete(k);
        // At its end, a slider equals the extreme value of the designs.
        else this.set.set(k, { least, limit: at === 0 ? low : at === SLIDER_STEPS ? high : low + at * step });
        say();
        this.handleInput();
      },
    });
    const reading = createElement("output", { for: id, class: "reading" });
    const say = () => {
      reading.value = formatQuantity(quantity, limit());
      slider.setAttribute("aria-valuetext", `${least ? t`at least` : t`at most`} ${reading.value}`);
    };
    say();
    return createElement(
      "div",
      { class: "bound" },
      createElement("label", { for: id }, quantity.text),
      sense,
      slider,
      reading,
    );
  }

  handleInput() {
    this.showCount();
    this.changed();
  }

  /** Show how many designs are within the bounds. */
  showCount() {
    const kept = this.listKept();
    const some = kept.filter(Boolean).length;
    this.all.hidden = this.set.size === 0;
    this.said.textContent = this.set.size
      ? this.set.size > 1
        ? t`${some} of ${kept.length} designs meet all of them.`
        : t`${some} of ${kept.length} designs meet it.`
      : t`All ${kept.length} designs are shown.`;
  }
}
