/** All examples with their names and pictures, grouped by what a person wants; a click states one and solves it. */

import { byId, el, svg } from "../core/dom.js";
import { translated } from "../core/messages.js";

/** @import { Problem } from "../types/values.js" */

/** @typedef {{kind: string, n: number, name: string, group: string, line: string, problem: Problem}} Example */

/** In the order of the service. @param {import("../core/api.js").Kind[]} kinds @returns {Example[]} */
export function listed(kinds) {
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
    const examples = listed(kinds);
    const groups = [...new Set(examples.map((one) => one.group))];
    const order = ORDER.concat(groups.filter((one) => !ORDER.includes(one))).filter((one) => groups.includes(one));
    this.place.replaceChildren(
      ...order.map((group) => {
        const cards = examples.filter((one) => one.group === group).map((one) => el("li", {}, this.card(one)));
        return el("section", {}, el("h3", {}, translated(group)), el("ul", { class: "gallery-cards" }, ...cards));
      }),
    );
  }

  /** @param {Example} example */
  card(example) {
    const { kind, n, name, line } = example;
    return el(
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
      el("span", { class: "gallery-picture" }),
      el("strong", {}, translated(name)),
      el("span", { class: "note" }, translated(line)),
    );
  }

  open() {
    if (this.dialog.open) return;
    this.dialog.showModal();
    if (!this.pictured) this.pictures().catch(() => {});
  }

  /** All pictures come in one file, and take the colours of the page. @returns {Promise<Document>} */
  async file() {
    const answer = await fetch("/studio/gallery.svg");
    if (!answer.ok) throw new Error("there are no pictures");
    return new DOMParser().parseFromString(await answer.text(), "image/svg+xml");
  }

  /**
   * The picture of an example; null where it cannot be had.
   * @param {string} key
   * @returns {Promise<SVGElement | null>}
   */
  async picture(key) {
    this.drawn ??= this.file();
    const drawn = await this.drawn.catch(() => (this.drawn = null));
    const symbol = drawn?.getElementById(key);
    if (!symbol) return null;
    const viewBox = symbol.getAttribute("viewBox");
    const picture = svg("svg", { viewBox, class: "thumbnail", "aria-hidden": "true" });
    picture.append(...[...symbol.children].map((one) => document.importNode(one, true)));
    return picture;
  }

  async pictures() {
    for (const card of this.place.querySelectorAll("[data-example]")) {
      const picture = await this.picture(card.getAttribute("data-example") ?? "");
      if (!picture) return;
      card.querySelector(".gallery-picture")?.replaceChildren(picture);
    }
    this.pictured = true;
  }
}

/** What a person may want, the most wanted first. */
const ORDER = [
  "Carry a body",
  "Draw a curve",
  "Make an output follow",
  "Change a speed",
  "Lift and rest",
  "Run smoothly",
];
