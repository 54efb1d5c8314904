/** Zoom and pan a picture by wheel, pinch, dragging of the background, and buttons. */

import { createElement } from "../core/dom.js";
import { t } from "../core/messages.js";

/** Zoom factor of a button press, and of a pixel of the wheel. */
const BUTTON_FACTOR = 1.5;
const WHEEL_FACTOR = 1.0015;

/** Pause after which a turn of the wheel has ended. */
const WHEEL_REST_MS = 200;

/** Minimum length of a drag, pixels; less is a click. */
const MIN_DRAG = 4;

/** Limits of the zoom factor. */
const MAX_ZOOM = 40;
const MIN_ZOOM = 0.25;

/** @typedef {import("../core/view.js").Box} Box */

/** Elements that handle the pointer themselves. */
const POINTER_TAKERS = ".led, .hit, .target, .grip, .held, .placing, a, button";

/**
 * The visible part of a picture, in its own pixels; null for all of it.
 * @typedef {{middle: number[], nearness: number} | null} Seen
 */

export class Zoom {
  /**
   * @param {SVGSVGElement} picture
   * @param {object} [on]
   * @param {() => boolean} [on.busy] whether the pointer draws just now
   * @param {(seen: Seen) => void} [on.settled] called with the view when it has been chosen
   */
  constructor(picture, { busy, settled } = {}) {
    this.picture = picture;
    this.busy = busy ?? (() => false);
    this.settled = settled ?? (() => {});
    this.turning = 0;
    /** @type {Map<number, PointerEvent>} */
    this.fingers = new Map();
    /** Whether the user has panned the picture. */
    this.led = false;
    this.nearness = 1;
    /** Size of the picture in the window, pixels; zero while it is hidden. */
    this.room = [0, 0];
    const { x, y, width, height } = picture.viewBox.baseVal;
    /** The whole extent of the picture. @type {Box} */
    this.whole = { x, y, width, height };
    this.middle = [x + width / 2, y + height / 2];
    const button = (/** @type {string} */ text, /** @type {string} */ label, /** @type {() => void} */ act) =>
      createElement(
        "button",
        { type: "button", class: "small", "aria-label": label, title: label, onclick: act },
        text,
      );
    this.buttons = createElement(
      "div",
      { class: "zoom" },
      button("−", t`Zoom out`, () => this.zoomByButton(1 / BUTTON_FACTOR)),
      button("+", t`Zoom in`, () => this.zoomByButton(BUTTON_FACTOR)),
      button(t`Fit`, t`Fit everything`, () => {
        this.fit();
        this.settled(null);
      }),
    );
    // The window, or what else stands on the stage, gives it another size: words and lines keep theirs.
    new ResizeObserver(([{ contentRect }]) => {
      this.room = [contentRect.width, contentRect.height];
      this.updateSizes();
    }).observe(picture);
    picture.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        this.zoomBy(WHEEL_FACTOR ** -event.deltaY, this.toPicture(event));
        clearTimeout(this.turning);
        this.turning = window.setTimeout(() => this.settle(), WHEEL_REST_MS);
      },
      { passive: false },
    );
    picture.addEventListener("pointerdown", (event) => this.takePointer(event));
    picture.addEventListener("pointermove", (event) => this.followPointers(event));
    for (const end of /** @type {const} */ (["pointerup", "pointercancel", "lostpointercapture"])) {
      picture.addEventListener(end, (event) => {
        if (this.fingers.delete(event.pointerId) && !this.fingers.size && this.led) this.settle();
      });
    }
  }

  /** Zoom by the factor of a button. @param {number} factor */
  zoomByButton(factor) {
    this.zoomBy(factor);
    this.settle();
  }

  settle() {
    this.led = false;
    this.settled({ middle: this.middle, nearness: this.nearness });
  }

  /** Show everything, or a new extent. @param {Box} [whole] */
  fit(whole = this.whole) {
    this.whole = whole;
    this.nearness = 1;
    this.middle = [whole.x + whole.width / 2, whole.y + whole.height / 2];
    this.show();
  }

  /** Zoom by a factor about a fixed point. @param {number} factor @param {number[]} [still] */
  zoomBy(factor, still = this.middle) {
    const next = Math.min(MAX_ZOOM, Math.max(MIN_ZOOM, this.nearness * factor));
    const share = this.nearness / next;
    this.nearness = next;
    this.middle = this.middle.map((one, k) => still[k] + share * (one - still[k]));
    this.show();
  }

  show() {
    const [width, height] = [this.whole.width / this.nearness, this.whole.height / this.nearness];
    const [x, y] = [this.middle[0] - width / 2, this.middle[1] - height / 2];
    this.picture.setAttribute("viewBox", `${x} ${y} ${width} ${height}`);
    this.updateSizes();
  }

  /** Update the size of elements that do not scale. */
  updateSizes() {
    const scale = Math.min(this.room[0] / this.whole.width, this.room[1] / this.whole.height) || 1;
    this.picture.style.setProperty("--nearness", String(this.nearness * scale));
  }

  /**
   * Return the position of a pointer in the picture.
   * @param {{clientX: number, clientY: number}} pointer
   * @returns {number[]}
   */
  toPicture(pointer) {
    const matrix = this.picture.getScreenCTM();
    if (!matrix) return this.middle;
    const { x, y } = new DOMPoint(pointer.clientX, pointer.clientY).matrixTransform(matrix.inverse());
    return [x, y];
  }

  /** @param {PointerEvent} event */
  takePointer(event) {
    if (event.button !== 0 || this.busy() || (event.target instanceof Element && event.target.closest(POINTER_TAKERS)))
      return;
    this.fingers.set(event.pointerId, event);
    this.picture.setPointerCapture(event.pointerId);
  }

  /** Pan with one finger, pan and zoom with two. @param {PointerEvent} event */
  followPointers(event) {
    const before = this.fingers.get(event.pointerId);
    if (!before) return;
    const [was, is] = [this.toPicture(before), this.toPicture(event)];
    if (Math.hypot(event.clientX - before.clientX, event.clientY - before.clientY) < MIN_DRAG && !this.led) return;
    this.led = true;
    this.fingers.set(event.pointerId, event);
    const other = [...this.fingers].find(([id]) => id !== event.pointerId)?.[1];
    if (other) {
      const far = (/** @type {PointerEvent} */ { clientX, clientY }) =>
        Math.hypot(clientX - other.clientX, clientY - other.clientY);
      this.zoomBy(far(event) / Math.max(far(before), 1), this.toPicture(other));
    } else {
      this.middle = this.middle.map((one, k) => one + was[k] - is[k]);
      this.show();
    }
  }
}
