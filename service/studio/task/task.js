/** The task: what is stated, in the form, on the canvas and as JSON, and the kinds and examples it is chosen from. */

import { byId, el } from "../core/dom.js";
import { forgetDraft } from "../core/drafts.js";
import * as faults from "../form/field_errors.js";
import { fill } from "../form/form.js";
import { prose, t, translated } from "../core/messages.js";
import { canvas } from "../canvas/statement_canvas.js";

/** @import { Problem } from "../types/values.js" */
/** @import { Change, Store } from "../core/store.js" */

/** So long after the last change of the window's size the canvas is drawn anew. */
const RESIZED_MS = 150;

/**
 * What the task has of the page.
 * @typedef {object} Page
 * @property {() => void} solve
 * @property {(statement: Problem) => void} state begins with another statement
 * @property {(kind: string) => void} resume goes on with what was left of a kind
 * @property {(name: string) => Promise<Node | null> | undefined} picture of an example
 */

export class Task {
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
    this.text.addEventListener("input", () => this.read());
    byId("fold").addEventListener("click", () => this.unfold(this.folded));
    let resizing = 0;
    window.addEventListener("resize", () => {
      clearTimeout(resizing);
      resizing = window.setTimeout(() => this.draw(), RESIZED_MS);
    });
  }

  /** The choice of a kind and of an example. */
  choices() {
    const { store, page } = this;
    const kind = el(
      "select",
      { id: "kind", onchange: () => page.resume(kind.value) },
      ...store.kinds.map((one) => el("option", { value: one.kind }, translated(one.title))),
    );
    const example = el("select", {
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
      el(
        "div",
        { class: "choices" },
        el("label", { for: "kind" }, t`Kind`),
        kind,
        el("label", { for: "example" }, t`Example`),
        example,
      ),
      el(
        "p",
        { class: "note", id: "draft", hidden: true },
        t`Your draft, as you left it.`,
        " ",
        el("button", { type: "button", class: "small", onclick: back }, t`Back to the example`),
      ),
      el("p", { class: "note", id: "about" }),
    );
    this.introduced = "";
  }

  /** The kind, its examples, and what it is about. */
  introduce() {
    const { kind, examples } = this.store;
    this.introduced = kind.kind;
    byId("kind", HTMLSelectElement).value = kind.kind;
    byId("example").replaceChildren(
      el("option", { value: "" }, t`as edited`),
      ...examples.map((_, n) => el("option", { value: n }, translated(kind.examples[n].name))),
    );
    byId("about").textContent = prose(kind.description);
  }

  /** Show what is stated now; where it was changed it is seen already. @param {Change} change */
  show({ by, begun }) {
    const { store, text } = this;
    const { kind } = store.problem;
    const { example } = store;
    if (begun) {
      byId("draft").hidden = true;
      faults.clear(this.fields, this.faults);
      this.fields.replaceChildren();
    }
    if (kind !== this.introduced) this.introduce();
    byId("example", HTMLSelectElement).value = example < 0 ? "" : String(example);
    if (by === null || by === "text") fill(this.fields, store);
    if (by !== "canvas") this.draw();
    if (by !== "text") text.value = JSON.stringify(store.problem, null, 2);
    text.removeAttribute("aria-invalid");
    byId("json-error").replaceChildren();
  }

  /** Draw what is stated, as large as there is room now. */
  draw() {
    if (!this.introduced) return;
    canvas(this.sketch, this.store, this.backdrop);
    if (!this.sketch.childElementCount) this.outline();
  }

  /** What is not placed in the plane is shown as its example looks, so that the stage is not empty. */
  async outline() {
    const { store, page, sketch } = this;
    const { kind } = store.problem;
    const note = t`Nothing of this is placed in the plane: it is stated beside the stage. Solve shows it in motion.`;
    const place = el("div", { class: "said" }, el("p", { class: "note" }, note));
    sketch.replaceChildren(place);
    const picture = await page.picture(`${kind}-${Math.max(store.example, 0)}`);
    if (picture && place.isConnected) place.prepend(picture);
  }

  /** Take over what is written as JSON, as soon as it is some. */
  read() {
    const { store, text } = this;
    try {
      const written = JSON.parse(text.value);
      if (!written || !store.kindOf(written)) throw new SyntaxError(t`“kind” must name a kind of problem.`);
      store.write(written, "text");
    } catch (error) {
      text.setAttribute("aria-invalid", "true");
      byId("json-error").textContent = error instanceof Error ? error.message : String(error);
    }
  }

  /** Whether the task is folded away. */
  get folded() {
    return byId("fold").getAttribute("aria-expanded") === "false";
  }

  /** Fold the task away, or show it: in a narrow window it takes a third of the stage's room. @param {boolean} open */
  unfold(open) {
    byId("fold").setAttribute("aria-expanded", String(open));
    this.draw();
  }

  /** What is wrong, at the fields it belongs to. @param {import("../core/api.js").Refused} refusal */
  refused(refusal) {
    if (this.folded) this.unfold(true);
    faults.tell(this.fields, this.faults, refusal);
  }

  /** Nothing is wrong any more. */
  clear() {
    faults.clear(this.fields, this.faults);
  }
}
