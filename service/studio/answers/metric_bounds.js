/** Bounds of quantities, set by sliders: designs beyond them are hidden. */

import { el } from "../core/dom.js";
import { differ, range, told } from "./shared_metrics.js";
import { t } from "../core/messages.js";

/** @typedef {import("./shared_metrics.js").Quantity} Quantity */

/** Places of a slider. */
const STEPS = 100;

export class Bounds {
  /** @param {Quantity[]} quantities @param {() => void} changed */
  constructor(quantities, changed) {
    this.quantities = quantities;
    this.changed = changed;
    /** @type {Map<number, {least: boolean, limit: number}>} */
    this.set = new Map();
    this.rows = el("div", { class: "bounds" });
    this.said = el("span", { role: "status" });
    this.all = el(
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
    this.node = el(
      "section",
      { "aria-label": t`Bounds` },
      el("h3", { class: "minor" }, t`Bounds`),
      this.rows,
      el("p", { class: "row" }, this.said, this.all),
    );
  }

  /** Which designs meet all bounds. @returns {boolean[]} */
  kept() {
    return this.quantities[0].values.map((_, n) =>
      [...this.set].every(([k, { least, limit }]) => {
        const value = this.quantities[k].values[n];
        return value !== null && (least ? value >= limit : value <= limit);
      }),
    );
  }

  /** Sliders for some quantities, and for those that have a bound. @param {number[]} wanted */
  show(wanted) {
    this.shown = wanted;
    const all = [...new Set([...wanted, ...this.set.keys()])].filter((k) => differ(this.quantities[k].values));
    this.rows.replaceChildren(...all.map((k) => this.row(k)));
    this.tell();
  }

  /** @param {number} k */
  row(k) {
    const quantity = this.quantities[k];
    const [low, high] = range(quantity.values);
    const step = (high - low) / STEPS;
    const id = `bound-${k}`;
    let least = this.set.get(k)?.least ?? quantity.more;
    const sense = el(
      "select",
      {
        "aria-label": t`${quantity.text}: which side`,
        onchange: () => {
          least = sense.value === "≥";
          slider.value = String(least ? 0 : STEPS);
          this.set.delete(k);
          say();
          this.told();
        },
      },
      el("option", { value: "≥" }, "≥"),
      el("option", { value: "≤" }, "≤"),
    );
    sense.value = least ? "≥" : "≤";
    const limit = () => this.set.get(k)?.limit ?? (least ? low : high);
    const slider = el("input", {
      type: "range",
      id,
      min: 0,
      max: STEPS,
      step: 1,
      value: Math.round((limit() - low) / step),
      oninput: () => {
        const at = Number(slider.value);
        if (at === (least ? 0 : STEPS)) this.set.delete(k);
        // A slider at its end is at the value that the last design has.
        else this.set.set(k, { least, limit: at === 0 ? low : at === STEPS ? high : low + at * step });
        say();
        this.told();
      },
    });
    const reading = el("output", { for: id, class: "reading" });
    const say = () => {
      reading.value = told(quantity, limit());
      slider.setAttribute("aria-valuetext", `${least ? t`at least` : t`at most`} ${reading.value}`);
    };
    say();
    return el("div", { class: "bound" }, el("label", { for: id }, quantity.text), sense, slider, reading);
  }

  told() {
    this.tell();
    this.changed();
  }

  /** How many meet the bounds. */
  tell() {
    const kept = this.kept();
    const some = kept.filter(Boolean).length;
    this.all.hidden = this.set.size === 0;
    this.said.textContent = this.set.size
      ? this.set.size > 1
        ? t`${some} of ${kept.length} designs meet all of them.`
        : t`${some} of ${kept.length} designs meet it.`
      : t`All ${kept.length} designs are shown.`;
  }
}
