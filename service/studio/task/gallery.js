/** The gallery of all examples, grouped by purpose; a click loads one and solves it. */

import { byId, createElement, createSvg } from "../core/dom.js";
import { translate } from "../core/messages.js";

/** @import { Problem } from "../types/values.js" */

/** @typedef {{kind: string, n: number, name: string, group: string, line: string, problem: Problem}} Example */

/** In the order of the service. @param {import("../core/api.js").Kind[]} kinds @returns {Example[]} */
export function listExamples(kinds) {
  return kinds.flatMap(({ kind, schema, example, examples }) =>
    /** @type {Problem[]} */ (schema.examples ?? [example]).map((problem, n) => ({
      kind,
      n,
      problem,
      ...examples[n],
    })),
  );
}

export class Gallery {
  /** @param {import("../core/api.js").Kind[]} kinds @param {(example: Example) => void} choose */
  constructor(kinds, choose) {
    this.choose = choose;
    this.dialog = byId("gallery", HTMLDialogElement);
    this.place = byId("gallery-cards");
    /** @type {Promise<Document> | null} */
    this.drawn = null;
    this.pictured = false;
    const examples = listExamples(kinds);
    const groups = [...new Set(examples.map((one) => one.group))];
    const order = PURPOSE_ORDER.concat(groups.filter((one) => !PURPOSE_ORDER.includes(one))).filter((one) =>
      groups.includes(one),
    );
    this.place.replaceChildren(
      ...order.map((group) => {
        const cards = examples
          .filter((one) => one.group === group)
          .map((one) => createElement("li", {}, this.createCard(one)));
        return createElement(
          "section",
          {},
          createElement("h3", {}, translate(group)),
          createElement("ul", { class: "gallery-cards" }, ...cards),
        );
      }),
    );
  }

  /** @param {Example} example */
  createCard(example) {
    const { kind, n, name, line } = example;
    return createElement(
      "button",
      {
        type: "button",
        class: "gallery-card",
        "data-example": `${kind}-${n}`,
        onclick: () => {
          this.dialog.close();
          this.choose(example);
        },
      },
      createElement("span", { class: "gallery-picture" }),
      createElement("strong", {}, translate(name)),
      createElement("span", { class: "note" }, translate(line)),
    );
  }

  open() {
    if (this.dialog.open) return;
    this.dialog.showModal();
    if (!this.pictured) this.fillPictures().catch(() => {});
  }

  /** All pictures come in one file, and take the colours of the page. @returns {Promise<Document>} */
  async fetchPictures() {
    const answer = await fetch("/studio/gallery.svg");
    if (!answer.ok) throw new Error("there are no pictures");
    return new DOMParser().parseFromString(await answer.text(), "image/svg+xml");
  }

  /**
   * The picture of an example; null where it cannot be had.
   * @param {string} key
   * @returns {Promise<SVGElement | null>}
   */
  async findPicture(key) {
    this.drawn ??= this.fetchPictures();
    const drawn = await this.drawn.catch(() => (this.drawn = null));
    const symbol = drawn?.getElementById(key);
    if (!symbol) return null;
    const viewBox = symbol.getAttribute("viewBox");
    const picture = createSvg("svg", { viewBox, class: "thumbnail", "aria-hidden": "true" });
    picture.append(...[...symbol.children].map((one) => document.importNode(one, true)));
    return picture;
  }

  async fillPictures() {
    for (const card of this.place.querySelectorAll("[data-example]")) {
      const picture = await this.findPicture(card.getAttribute("data-example") ?? "");
      if (!picture) return;
      card.querySelector(".gallery-picture")?.replaceChildren(picture);
    }
    this.pictured = true;
  }
}

/** Fields of application, the most common first. */
const PURPOSE_ORDER = [
  "Carry a body",
  "Draw a curve",
  "Make an output follow",
  "Change a speed",
  "Lift and rest",
  "Run smoothly",
];
