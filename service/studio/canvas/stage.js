/** The stage in the middle of the window: it shows the problem, the motion of a design, or the explored linkage. */

import { byId, createElement, rebuild, createSvg } from "../core/dom.js";
import { Zoom } from "./zoom.js";

/** @typedef {"state" | "watch" | "explore"} Mode */

/** Minimum size of a picture, pixels. */
const MIN_SIZE = [320, 220];

/** Height of the player below a picture, pixels. */
export const CLOCK_HEIGHT = 48;

/**
 * The parts of a view of a mechanism.
 * @typedef {object} View
 * @property {SVGSVGElement | HTMLElement} picture takes the stage
 * @property {HTMLElement[]} [tools] over the picture, before those that zoom
 * @property {HTMLElement} [clock] the row of its player, below the picture
 * @property {(Node | string | null | undefined | false)[]} [below] on the stage, beneath the picture
 * @property {(Node | string | null | undefined | false)[]} [beside] in the drawer, with the numbers
 * @property {(Node | string | null | undefined | false)[]} [plots] in the drawer, with the plots
 */

/** The frame in which a moving mechanism is shown. */
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
   * Return width and height available for a picture, pixels, less the height of elements below it.
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

  /** Mark the picture as outdated while the next motion is loading. @param {boolean} is */
  markWaiting(is) {
    for (const place of [this.board, this.beside, this.plots]) place.classList.toggle("waiting", is);
  }

  /** Show a message in place of the picture. @param {...(Node | string)} said */
  showMessage(...said) {
    this.zoom = null;
    this.markWaiting(false);
    this.board.replaceChildren(createElement("div", { class: "said" }, ...said));
    this.beside.replaceChildren();
    this.plots.replaceChildren();
  }

  /** Whether no picture is shown; a picture stays until the next one is ready. */
  get isIdle() {
    return !this.board.querySelector(".stage");
  }
}

/**
 * Create a picture of the plane, as large as the available space.
 * @param {import("../core/view.js").View} view
 * @param {string} label label for screen readers
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
 * Return the size available for a picture on a board, shown or hidden.
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
    /** Whether a motion is available. */
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

  /** Set whether a motion is available. @param {boolean} is @param {string} [caption] */
  offerMotion(is, caption = "") {
    this.watching = is;
    this.buttons.watch.disabled = !is;
    this.caption.textContent = caption;
    if (!is) this.showMode("state");
  }
}
