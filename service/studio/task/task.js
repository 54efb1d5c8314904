/** The task pane: the problem as form, canvas and JSON, and the choice of kinds and examples. */

import { byId, createElement } from "../core/dom.js";
import { forgetDraft } from "../core/drafts.js";
import * as faults from "../form/field_errors.js";
import { fillForm } from "../form/form.js";
import { firstParagraph, t, translate } from "../core/messages.js";
import { drawCanvas } from "../canvas/statement_canvas.js";

/** @import { Problem } from "../types/values.js" */
/** @import { Change, Store } from "../core/store.js" */

/** So long after the last change of the window's size the canvas is drawn anew. */
const RESIZE_REST_MS = 150;

/**
 * What the task has of the page.
 * @typedef {object} Page
 * @property {() => void} solve
 * @property {(statement: Problem) => void} state begins with another statement
 * @property {(kind: string) => void} resume goes on with what was left of a kind
 * @property {(name: string) => Promise<Node | null> | undefined} picture of an example
 */

export class TaskPane {
  /**
   * @param {Store} store
   * @param {import("../canvas/backdrop.js").Backdrop} backdrop of the canvas
   * @param {Page} page
   */
  constructor(store, backdrop, page) {
    this.store = store;
    this.backdrop = backdrop;
    this.page = page;
    this.fields = byId("fields");
    this.faults = byId("faults");
    this.sketch = byId("sketch");
    this.text = byId("json-text", HTMLTextAreaElement);
    /** The kind whose examples stand there. */
    this.introduced = "";
    store.listen((change) => change.stated && this.show(change));
    this.fields.addEventListener("submit", (/** @type {Event} */ event) => {
      event.preventDefault();
      page.solve();
    });
    this.text.addEventListener("input", () => this.readJson());
    byId("fold").addEventListener("click", () => this.setOpen(this.isFolded));
    let resizing = 0;
    window.addEventListener("resize", () => {
      clearTimeout(resizing);
      resizing = window.setTimeout(() => this.draw(), RESIZE_REST_MS);
    });
  }

  /** The choice of a kind and of an example. */
  createChoices() {
    const { store, page } = this;
    const kind = createElement(
      "select",
      { id: "kind", onchange: () => page.resume(kind.value) },
      ...store.kinds.map((one) => createElement("option", { value: one.kind }, translate(one.title))),
    );
    const example = createElement("select", {
      id: "example",
      onchange: () => {
        if (example.value !== "") page.state(store.examples[Number(example.value)]);
      },
    });
    const back = () => {
      forgetDraft(store.problem.kind);
      page.state(store.kind.example);
    };
    byId("choices").replaceChildren(
      createElement(
        "div",
        { class: "choices" },
        createElement("label", { for: "kind" }, t`Kind`),
        kind,
        createElement("label", { for: "example" }, t`Example`),
        example,
      ),
      createElement(
        "p",
        { class: "note", id: "draft", hidden: true },
        t`Your draft.`,
        " ",
        createElement("button", { type: "button", class: "small", onclick: back }, t`Back to the example`),
      ),
      createElement("p", { class: "note", id: "about" }),
    );
    this.introduced = "";
  }

  /** The kind, its examples, and what it is about. */
  introduceKind() {
    const { kind, examples } = this.store;
    this.introduced = kind.kind;
    byId("kind", HTMLSelectElement).value = kind.kind;
    byId("example").replaceChildren(
      createElement("option", { value: "" }, t`edited`),
      ...examples.map((_, n) => createElement("option", { value: n }, translate(kind.examples[n].name))),
    );
    byId("about").textContent = firstParagraph(kind.description);
  }

  /** Show the present problem everywhere except where it was changed. @param {Change} change */
  show({ by, begun }) {
    const { store, text } = this;
    const { kind } = store.problem;
    const { example } = store;
    if (begun) {
      byId("draft").hidden = true;
      faults.clearErrors(this.fields, this.faults);
      this.fields.replaceChildren();
    }
    if (kind !== this.introduced) this.introduceKind();
    byId("example", HTMLSelectElement).value = example < 0 ? "" : String(example);
    if (by === null || by === "text") fillForm(this.fields, store);
    if (by !== "canvas") this.draw();
    if (by !== "text") text.value = JSON.stringify(store.problem, null, 2);
    text.removeAttribute("aria-invalid");
    byId("json-error").replaceChildren();
  }

  /** Draw the problem as large as the available space permits. */
  draw() {
    if (!this.introduced) return;
    drawCanvas(this.sketch, this.store, this.backdrop);
    if (!this.sketch.childElementCount) this.showExamplePicture();
  }

  /** What is not placed in the plane is shown as its example looks, so that the stage is not empty. */
  async showExamplePicture() {
    const { store, page, sketch } = this;
    const { kind } = store.problem;
    const note = t`This problem has no geometry to place. Enter it next to the stage; Solve shows the motion.`;
    const place = createElement("div", { class: "said" }, createElement("p", { class: "note" }, note));
    sketch.replaceChildren(place);
    const picture = await page.picture(`${kind}-${Math.max(store.example, 0)}`);
    if (picture && place.isConnected) place.prepend(picture);
  }

  /** Take over what is written as JSON, as soon as it is some. */
  readJson() {
    const { store, text } = this;
    try {
      const written = JSON.parse(text.value);
      if (!written || !store.findKind(written)) throw new SyntaxError(t`“kind” must name a kind of problem.`);
      store.replace(written, "text");
    } catch (error) {
      text.setAttribute("aria-invalid", "true");
      byId("json-error").textContent = error instanceof Error ? error.message : String(error);
    }
  }

  /** Whether the task is folded away. */
  get isFolded() {
    return byId("fold").getAttribute("aria-expanded") === "false";
  }

  /** Fold the task away, or show it: in a narrow window it takes a third of the stage's room. @param {boolean} open */
  setOpen(open) {
    byId("fold").setAttribute("aria-expanded", String(open));
    this.draw();
  }

  /** What is wrong, at the fields it belongs to. @param {import("../core/api.js").Refusal} refusal */
  showRefusal(refusal) {
    if (this.isFolded) this.setOpen(true);
    faults.showErrors(this.fields, this.faults, refusal);
  }

  /** Clear all errors. */
  clearErrors() {
    faults.clearErrors(this.fields, this.faults);
  }
}
