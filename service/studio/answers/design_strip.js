/** The designs of an answer as a row of cards: pinned designs first, then best first. */

import { createElement, toWords } from "../core/dom.js";
import { formatFigure, listFigures, typeName } from "../design/design_metrics.js";
import { t } from "../core/messages.js";
import { setPinned, listPinned } from "../core/pinned_designs.js";
import { createThumbnail } from "../motion/thumbnail.js";

/** @import { Design, Problem, Solved } from "../types/values.js" */

/** How long the keyboard must rest on a card before its design is shown. */
const KEY_REST_MS = 150;

export class DesignStrip {
  /** @param {Solved} job with its result @param {(n: number) => void} choose */
  constructor(job, choose) {
    this.job = job;
    this.choose = choose;
    this.chosen = -1;
    this.passing = 0;
    const { designs } = job.result;
    /** What meets the bounds. @type {boolean[]} */
    this.kept = designs.map(() => true);
    /** @type {HTMLElement[]} */
    this.cards = designs.map((design, /** @type {number} */ n) =>
      createCard(design, n, job.problem, () => this.select(n)),
    );
    this.pins = this.cards.map((_, n) =>
      createElement(
        "button",
        {
          type: "button",
          class: "pin-button",
          "aria-label": t`Pin design ${n + 1}`,
          title: t`Pin it to list it first`,
          "aria-pressed": "false",
          onclick: () => this.pin(n),
        },
        "☆",
      ),
    );
    this.slots = this.cards.map((one, n) => createElement("div", { class: "slot" }, one, this.pins[n]));
    this.pinned = listPinned(job.id).filter((n) => n < this.cards.length);
    /** Told when pins change. */
    this.changed = () => {};
    this.node = createElement("div", {
      class: "cards",
      role: "group",
      "aria-label": t`Designs, best first; arrow keys choose`,
      onkeydown: (/** @type {KeyboardEvent} */ event) => this.handleKey(event),
    });
    this.sortCards();
  }

  /** The numbers of the designs in their displayed order. */
  get row() {
    return [...this.pinned, ...this.cards.map((_, n) => n).filter((n) => !this.pinned.includes(n))];
  }

  sortCards() {
    const focused = document.activeElement;
    this.node.replaceChildren(...this.row.map((n) => this.slots[n]));
    this.pins.forEach((button, n) => {
      const is = this.pinned.includes(n);
      button.setAttribute("aria-pressed", String(is));
      button.textContent = is ? "★" : "☆";
    });
    if (focused instanceof HTMLElement && this.node.contains(focused)) focused.focus({ preventScroll: true });
  }

  /** Select a design. @param {number} n */
  select(n) {
    this.chosen = n;
    this.cards.forEach((one, k) => one.setAttribute("aria-pressed", String(k === n)));
    this.cards[n].scrollIntoView({ block: "nearest", inline: "nearest" });
    this.choose(n);
  }

  /** Pin or unpin a design. @param {number} n */
  pin(n) {
    this.pinned = setPinned(this.job.id, n, !this.pinned.includes(n));
    this.sortCards();
    this.cards[n].scrollIntoView({ block: "nearest", inline: "nearest" });
    this.changed();
  }

  /** Show only the designs within the bounds. @param {boolean[]} kept */
  filter(kept) {
    this.kept = kept;
    this.slots.forEach((slot, n) => slot.toggleAttribute("hidden", !kept[n]));
  }

  /** Select cards by the arrow keys, Home and End. @param {KeyboardEvent} event */
  handleKey(event) {
    const shown = this.row.filter((n) => this.kept[n]);
    const at = shown.findIndex((n) => this.cards[n] === document.activeElement);
    const to = {
      ArrowRight: at + 1,
      ArrowDown: at + 1,
      ArrowLeft: at - 1,
      ArrowUp: at - 1,
      Home: 0,
      End: shown.length - 1,
    }[event.key];
    if (at < 0 || to === undefined) return;
    event.preventDefault();
    const n = shown[Math.min(shown.length - 1, Math.max(0, to))];
    this.cards[n].focus();
    // Do not show the designs that the selection only passes.
    clearTimeout(this.passing);
    this.passing = setTimeout(() => {
      if (this.cards[n] === document.activeElement && this.chosen !== n) this.select(n);
    }, KEY_REST_MS);
  }
}

/** @param {Design} design @param {number} n @param {Problem} problem @param {() => void} choose */
function createCard(design, n, problem, choose) {
  const passed = design.verification?.passed;
  return createElement(
    "button",
    { type: "button", class: "card", "data-design": n + 1, "aria-pressed": "false", onclick: choose },
    createThumbnail(design),
    createElement(
      "span",
      { class: "told" },
      createElement("strong", { title: typeName(design) }, `${n + 1}. ${typeName(design)}`),
      createElement("span", { class: passed ? "good" : "bad" }, passed ? `✓ ${t`verified`}` : `✗ ${t`fails a check`}`),
      ...listFigures(design)
        .slice(0, 1)
        .map(([name, value]) => {
          const told = formatFigure(name, value, problem, design.metrics?.size);
          return createElement(
            "span",
            { class: "figure", title: told.title },
            createElement("span", {}, toWords(name)),
            createElement("span", {}, told.text),
          );
        }),
    ),
  );
}
