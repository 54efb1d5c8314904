/**
 * A picture that is brought nearer and led along: by wheel and pinch at the pointer, by dragging where nothing lies, by
 * buttons.
 */

import { createElement } from "../core/dom.js";
import { t } from "../core/messages.js";

/** How much nearer or farther a press of a button takes the picture, and a step of the wheel. */
const BUTTON_FACTOR = 1.5;
const WHEEL_FACTOR = 1.0015;

/** When the wheel has stood still so long it has been turned. */
const WHEEL_REST_MS = 200;

/** What is led along by less, pixels, was a click. */
const MIN_DRAG = 4;

/** How far it can be brought nearer, and farther. */
const MAX_ZOOM = 40;
const MIN_ZOOM = 0.25;

/** @typedef {import("../core/view.js").Box} Box */

/** What takes the pointer itself. */
const DRAGGABLE = ".led, .hit, .target, .grip, .held, .placing, a, button";

/**
 * What of a picture is seen, in its own pixels; null where all is to be seen.
 * @typedef {{middle: number[], nearness: number} | null} Seen
 */

export class Zoom {
  /**
   * @param {SVGSVGElement} picture
   * @param {object} [on]
   * @param {() => boolean} [on.busy] whether the pointer draws just now
   * @param {(seen: Seen) => void} [on.settled] told what is seen when it has been chosen
   */
  constructor(picture, { busy, settled } = {}) {
    this.picture = picture;
    this.busy = busy ?? (() => false);
    this.settled = settled ?? (() => {});
    this.turning = 0;
    /** @type {Map<number, PointerEvent>} */
    this.fingers = new Map();
    /** Whether they have led the picture somewhere. */
    this.led = false;
    this.nearness = 1;
    /** What the picture has of the window, pixels: nothing while it is hidden. */
    this.room = [0, 0];
    const { x, y, width, height } = picture.viewBox.baseVal;
    /** All there is to be seen. @type {Box} */
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
      button("−", t`Farther`, () => this.zoomByButton(1 / BUTTON_FACTOR)),
      button("+", t`Nearer`, () => this.zoomByButton(BUTTON_FACTOR)),
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

  /** A button is pressed. @param {number} factor */
  zoomByButton(factor) {
    this.zoomBy(factor);
    this.settle();
  }

  settle() {
    this.led = false;
    this.settled({ middle: this.middle, nearness: this.nearness });
  }

  /** All is to be seen, or something else is all. @param {Box} [whole] */
  fit(whole = this.whole) {
    this.whole = whole;
    this.nearness = 1;
    this.middle = [whole.x + whole.width / 2, whole.y + whole.height / 2];
    this.show();
  }

  /** Nearer by a factor, with a point that stays where it is. @param {number} factor @param {number[]} [still] */
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

  /** What keeps its size on the screen is told how much larger all else is. */
  updateSizes() {
    const scale = Math.min(this.room[0] / this.whole.width, this.room[1] / this.whole.height) || 1;
    this.picture.style.setProperty("--nearness", String(this.nearness * scale));
  }

  /** Where of the picture a pointer is. @param {{clientX: number, clientY: number}} pointer @returns {number[]} */
  toPicture(pointer) {
    const matrix = this.picture.getScreenCTM();
    if (!matrix) return this.middle;
    const { x, y } = new DOMPoint(pointer.clientX, pointer.clientY).matrixTransform(matrix.inverse());
    return [x, y];
  }

  /** @param {PointerEvent} event */
  takePointer(event) {
    if (event.button !== 0 || this.busy() || (event.target instanceof Element && event.target.closest(DRAGGABLE)))
      return;
    this.fingers.set(event.pointerId, event);
    this.picture.setPointerCapture(event.pointerId);
  }

  /** One finger leads the picture along, two bring it nearer as well. @param {PointerEvent} event */
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
