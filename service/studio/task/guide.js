/** Guide the user through a task: a note next to the element of each step, which can be closed at any time. */

import { byId, createElement } from "../core/dom.js";
import { GUIDES } from "./guide_steps.js";
import { t } from "../core/messages.js";

/** @import { Problem } from "../types/values.js" */

/** @typedef {import("./guide_steps.js").Guide} Guide */

/** How often it is looked whether a step is done and where its thing stands, milliseconds. */
const POLL_MS = 200;

/** Between the note and what it speaks of, pixels. */
const NOTE_GAP = 12;

/**
 * What a guide has of the page.
 * @typedef {object} Page
 * @property {(kind: string, example: string) => void} state begins with an example by its name
 * @property {() => Problem} problem in its present state
 * @property {() => boolean} answered whether the present problem has answers
 * @property {import("../design/workbench.js").Workbench} desk
 */

export class GuideRunner {
  /** @param {Page} page */
  constructor(page) {
    this.page = page;
    /** @type {Guide | null} */
    this.guide = null;
    this.n = 0;
    /** @type {Problem | null} */
    this.before = null;
    this.chosen = "";
    this.timer = 0;
    /** @type {Element | null} */
    this.thing = null;
    this.count = createElement("span", { class: "note" });
    this.text = createElement("p", { role: "status" });
    this.there = createElement(
      "button",
      { type: "button", class: "small", onclick: () => this.goToTarget() },
      t`Go there`,
    );
    this.on = createElement(
      "button",
      { type: "button", class: "small", onclick: () => this.showStep(this.n + 1) },
      t`Skip`,
    );
    this.note = createElement(
      "section",
      {
        id: "guide",
        class: "guide",
        "aria-label": t`Guided task`,
        hidden: true,
        onkeydown: (/** @type {KeyboardEvent} */ event) => {
          if (event.key !== "Escape") return;
          event.stopPropagation();
          this.leave();
        },
      },
      this.count,
      this.text,
      createElement(
        "div",
        { class: "row" },
        this.there,
        this.on,
        createElement("button", { type: "button", class: "small", onclick: () => this.leave() }, t`Cancel`),
      ),
    );
    // Before the panels, so that the keys come to it first.
    byId("status").after(this.note);
  }

  /** The guided tasks as buttons. @param {() => void} begun */
  createButtons(begun) {
    return GUIDES.map((guide) =>
      createElement(
        "button",
        {
          type: "button",
          class: "guide-start",
          onclick: () => {
            begun();
            this.begin(guide);
          },
        },
        createElement("strong", {}, guide.name),
        createElement("span", { class: "note" }, guide.line),
      ),
    );
  }

  /** @param {Guide} guide */
  begin(guide) {
    this.leave();
    this.page.state(guide.kind, guide.example);
    this.guide = guide;
    this.note.hidden = false;
    this.showStep(0);
    this.there.focus();
    this.timer = setInterval(() => this.checkStep(), POLL_MS);
  }

  /** @param {number} n */
  showStep(n) {
    const { guide, page } = this;
    if (!guide) return;
    if (n > guide.steps.length) return this.leave();
    this.n = n;
    const step = guide.steps[n];
    this.before = page.problem();
    this.chosen = document.querySelector('.card[aria-pressed="true"]')?.getAttribute("data-design") ?? "";
    this.count.textContent = step ? t`${guide.name}, ${n + 1} of ${guide.steps.length}` : guide.name;
    this.text.textContent = step?.text ?? t`That is all. Everything can be undone, changed and solved again.`;
    this.there.hidden = !step;
    this.on.textContent = step ? t`Skip` : t`Done`;
    if (step?.stage) page.desk.stage.showMode(step.stage);
    if (step && ["task", "answers"].includes(step.tab)) page.desk.drawer.selectTab(step.tab);
    this.checkStep();
  }

  /** Go on where the step is done; otherwise stand beside its thing, wherever that is now. */
  checkStep() {
    const step = this.guide?.steps[this.n];
    if (
      step?.done({
        problem: this.page.problem(),
        before: this.before ?? this.page.problem(),
        answered: this.page.answered(),
        chosen: this.chosen,
      })
    )
      return this.showStep(this.n + 1);
    const thing = step
      ? ([...document.querySelectorAll(step.at)]
          .sort((a, b) => selectorRank(step.at, a) - selectorRank(step.at, b))
          .find((one) => one.getClientRects().length) ?? null)
      : null;
    if (thing !== this.thing) {
      this.thing?.classList.remove("guided");
      this.thing = thing;
      thing?.classList.add("guided");
      thing?.scrollIntoView({ block: "nearest", inline: "nearest" });
    }
    this.placeNote();
  }

  /** Beside the thing, where there is room. */
  placeNote() {
    const box = this.thing?.getBoundingClientRect();
    const { offsetWidth: width, offsetHeight: height } = this.note;
    // A small screen has it over the part that the step is not about.
    this.note.classList.toggle("low", Boolean(this.thing?.closest("#stage")));
    if (!box || innerWidth <= 860) {
      this.note.style.left = this.note.style.top = "";
      return;
    }
    const [right, left] = [box.right + NOTE_GAP + width <= innerWidth, box.left - NOTE_GAP - width >= 0];
    const x = right
      ? box.right + NOTE_GAP
      : left
        ? box.left - NOTE_GAP - width
        : Math.min(innerWidth - width - NOTE_GAP, Math.max(NOTE_GAP, box.left));
    const y =
      right || left
        ? box.top + (box.height - height) / 2
        : box.top - NOTE_GAP - height >= 0
          ? box.top - NOTE_GAP - height
          : box.bottom + NOTE_GAP;
    this.note.style.left = `${Math.round(x)}px`;
    this.note.style.top = `${Math.round(Math.min(innerHeight - height - NOTE_GAP, Math.max(NOTE_GAP, y)))}px`;
  }

  /** To what the step speaks of: its tab is opened, and it has the focus. */
  goToTarget() {
    const step = this.guide?.steps[this.n];
    if (!step) return;
    if (!["task", "answers"].includes(step.tab)) this.page.desk.drawer.pressTab(step.tab);
    this.checkStep();
    const within = "button:not([disabled]), input, select, [tabindex='0']";
    const thing = this.thing?.matches(within) ? this.thing : (this.thing?.querySelector(within) ?? this.thing);
    /** @type {HTMLElement | null} */ (thing)?.focus();
  }

  leave() {
    clearInterval(this.timer);
    this.guide = null;
    this.thing?.classList.remove("guided");
    this.thing = null;
    const had = this.note.contains(document.activeElement);
    this.note.hidden = true;
    if (had) byId("gallery-open").focus();
  }
}

/** Which of the selectors of a list an element answers to. @param {string} list @param {Element} one */
function selectorRank(list, one) {
  return list.split(", ").findIndex((selector) => one.matches(selector));
}
