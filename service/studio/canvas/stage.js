/**
 * The stage in the middle of the window: a statement is drawn on it, a design moves on it, a linkage is explored on it.
 */

import { byId, createElement, rebuild, createSvg } from "../core/dom.js";
import { Zoom } from "./zoom.js";

/** @typedef {"state" | "watch" | "explore"} Mode */

/** Room of a picture where the window gives none, pixels. */
const MIN_SIZE = [320, 220];

/** Height that the clock below a picture has, pixels. */
export const CLOCK_HEIGHT = 48;

/**
 * What a view of a mechanism consists of.
 * @typedef {object} View
 * @property {SVGSVGElement | HTMLElement} picture takes the stage
 * @property {HTMLElement[]} [tools] over the picture, before those that bring it nearer
 * @property {HTMLElement} [clock] the row of its player, below the picture
 * @property {(Node | string | null | undefined | false)[]} [below] on the stage, beneath the picture
 * @property {(Node | string | null | undefined | false)[]} [beside] in the drawer, with the numbers
 * @property {(Node | string | null | undefined | false)[]} [plots] in the drawer, with the plots
 */

/** Where a mechanism that moves is shown, whatever shows it. */
export class Frame {
  /** @param {HTMLElement} board of the stage @param {HTMLElement} beside @param {HTMLElement} plots */
  constructor(board, beside, plots) {
    this.board = board;
    this.beside = beside;
    this.plots = plots;
    /** @type {Zoom | null} */
    this.zoom = null;
  }

  /**
   * Width and height that a picture has, pixels, as much less as something beneath it takes.
   * @param {number} [less]
   * @returns {[number, number]}
   */
  availableSize(less = 0) {
    return boardSize(this.board, CLOCK_HEIGHT + less);
  }

  /** @param {View} view */
  fill({ picture, tools = [], clock, below = [], beside = [], plots = [] }) {
    this.zoom = picture instanceof SVGSVGElement ? new Zoom(picture) : null;
    this.zoom?.buttons.prepend(...tools);
    const stage = createElement("div", { class: "stage" }, picture, this.zoom?.buttons, ...below);
    this.markWaiting(false);
    rebuild([this.board, this.beside, this.plots], () => {
      this.board.replaceChildren(stage, ...(clock ? [clock] : []));
      this.beside.replaceChildren(createElement("div", { class: "beside" }, ...beside));
      this.plots.replaceChildren(...plots.filter((one) => one instanceof Node));
    });
  }

  /** What is shown is of the design before, until the motion of the next one is there. @param {boolean} is */
  markWaiting(is) {
    for (const place of [this.board, this.beside, this.plots]) place.classList.toggle("waiting", is);
  }

  /** Say something in the place of a picture. @param {...(Node | string)} said */
  showMessage(...said) {
    this.zoom = null;
    this.markWaiting(false);
    this.board.replaceChildren(createElement("div", { class: "said" }, ...said));
    this.beside.replaceChildren();
    this.plots.replaceChildren();
  }

  /** Whether nothing is shown: a picture stays until the next one is there. */
  get isIdle() {
    return !this.board.querySelector(".stage");
  }
}

/**
 * A picture of the plane: what its view shows, as large as there is room.
 * @param {import("../core/view.js").View} view
 * @param {string} label what it shows, for who hears the page
 * @param {import("../core/dom.js").Child[]} drawn
 * @param {object} [use]
 * @param {boolean} [use.held] whether something in it is taken hold of
 * @param {boolean} [use.whole] whether it goes to the edges of its room, as a grid does, and not of what points take
 * @returns {SVGSVGElement}
 */
export function createScene(view, label, drawn, { held = false, whole = false } = {}) {
  const { x, y, width, height } = whole ? view.bounds : view.box;
  return createSvg(
    "svg",
    {
      viewBox: `${x} ${y} ${width} ${height}`,
      class: held ? "canvas drag" : "canvas",
      role: held ? "group" : "img",
      "aria-label": label,
    },
    ...drawn,
  );
}

/**
 * The room that a board of the stage has for a picture, whether it is shown just now or not.
 * @param {HTMLElement} board
 * @param {number} less
 * @returns {[number, number]}
 */
export function boardSize(board, less) {
  const boards = board.parentElement ?? board;
  const halves = boards.classList.contains("split") ? 2 : 1;
  return [Math.max(MIN_SIZE[0], boards.clientWidth / halves), Math.max(MIN_SIZE[1], boards.clientHeight - less)];
}

export class Stage {
  constructor() {
    this.place = byId("stage");
    this.frame = new Frame(byId("watch"), byId("beside"), byId("plots"));
    this.caption = byId("caption");
    this.buttons = { state: byId("mode-state"), watch: byId("mode-watch", HTMLButtonElement) };
    /** Whether there is anything to watch. */
    this.watching = false;
    this.buttons.state.addEventListener("click", () => this.showMode("state"));
    this.buttons.watch.addEventListener("click", () => this.showMode("watch"));
    /** Told whenever something else is shown. @type {(mode: Mode) => void} */
    this.changed = () => {};
  }

  /** @returns {Mode} */
  get mode() {
    return /** @type {Mode} */ (this.place.dataset.mode);
  }

  /** @param {Mode} mode */
  showMode(mode) {
    if (mode !== "state" && !this.watching) mode = "state";
    const before = this.mode;
    this.place.dataset.mode = mode;
    this.buttons.state.setAttribute("aria-pressed", String(mode === "state"));
    this.buttons.watch.setAttribute("aria-pressed", String(mode !== "state"));
    if (before !== mode) this.changed(mode);
  }

  /** Say whether there is a mechanism to be watched. @param {boolean} is @param {string} [caption] */
  offerMotion(is, caption = "") {
    this.watching = is;
    this.buttons.watch.disabled = !is;
    this.caption.textContent = caption;
    if (!is) this.showMode("state");
  }
}
