/**
 * Grips on a picture: dragged by the pointer or moved by keys, large enough for a finger, and labelled for screen
 * readers.
 */

import { createSvg } from "../core/dom.js";

/** @typedef {[number, number]} Point */

/** Radius of a grip, pixels. */
const GRIP_RADIUS = 12;

/** Step of the arrow keys, pixels, rounded to a power of ten of length units; the second value applies with Shift. */
const KEY_STEP = 10;
const FINE_KEY_STEP = 1;

/** Rotation by the Page keys, degrees, without and with Shift. */
const KEY_TURN = 5;
const FINE_KEY_TURN = 1;

export class Grip {
  /**
   * @param {object} looks
   * @param {string} [looks.name] label next to it
   * @param {Point} [looks.beside] where the name stands, pixels from its middle
   * @param {string} [looks.kind] class of the whole
   * @param {string} [looks.dot] class of the visible dot
   * @param {number} [looks.radius] of the visible dot, pixels
   * @param {string} [looks.key] by which it is found again in a picture that is made anew
   * @param {string} [looks.role]
   */
  constructor({
    name = "",
    beside: [dx, dy] = [10, -9],
    kind = "target",
    dot = "dot",
    radius = 7,
    key,
    role = "button",
  }) {
    this.dot = createSvg("circle", { class: dot, r: radius });
    this.hit = createSvg("circle", { class: "hit", r: GRIP_RADIUS });
    this.text = name ? createSvg("text", { dx, dy }, name) : null;
    this.node = createSvg("g", { class: kind, tabindex: 0, role, "data-grip": key }, this.text, this.hit, this.dot);
  }

  /** Move the grip to a point of the picture. @param {Point} place pixels */
  moveTo([u, v]) {
    for (const one of [this.dot, this.hit]) setAttributes(one, { cx: u, cy: v });
    if (this.text) setAttributes(this.text, { x: u, y: v });
  }

  /** @param {string} label */
  setLabel(label) {
    this.node.setAttribute("aria-label", label);
  }
}

/**
 * Drag an element with the pointer, from pointer down to pointer up.
 * @param {Element} node
 * @param {SVGSVGElement} picture
 * @param {import("../core/view.js").View} view
 * @param {object} on
 * @param {(at: Point) => void} [on.taken]
 * @param {(at: Point, event: PointerEvent) => void} on.led
 * @param {() => void} [on.left]
 */
export function dragWithPointer(node, picture, view, { taken, led: follow, left }) {
  node.addEventListener("pointerdown", (down) => {
    const event = /** @type {PointerEvent} */ (down);
    if (event.button !== 0) return;
    // Do not pan the picture below.
    event.stopPropagation();
    node.setPointerCapture(event.pointerId);
    taken?.(view.toPlaneFromPointer(picture, event));
    const gone = new AbortController();
    const { signal } = gone;
    node.addEventListener(
      "pointermove",
      (move) => {
        const now = /** @type {PointerEvent} */ (move);
        if (now.pointerId === event.pointerId) follow(view.toPlaneFromPointer(picture, now), now);
      },
      { signal },
    );
    node.addEventListener(
      "lostpointercapture",
      () => {
        gone.abort();
        left?.();
      },
      { signal },
    );
  });
}

/**
 * Move an element by arrow keys, turn it by Page keys and remove it by Delete or Backspace.
 * @param {Element} node
 * @param {import("../core/view.js").View} view
 * @param {object} on
 * @param {(by: Point) => void} on.moved distance in length units
 * @param {((degrees: number) => void) | null} [on.turned]
 * @param {(() => void) | null} [on.removed]
 */
export function moveWithKeys(node, view, { moved, turned, removed }) {
  node.addEventListener("keydown", (pressed) => {
    const event = /** @type {KeyboardEvent} */ (pressed);
    const step = view.roundStep(event.shiftKey ? FINE_KEY_STEP : KEY_STEP);
    const angle = event.shiftKey ? FINE_KEY_TURN : KEY_TURN;
    /** @type {Record<string, Point>} */
    const ways = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, step], ArrowDown: [0, -step] };
    const turns = /** @type {Record<string, number>} */ ({ PageUp: angle, PageDown: -angle });
    if (event.key in ways) moved(ways[event.key]);
    else if (event.key in turns && turned) turned(turns[event.key]);
    else if (["Delete", "Backspace"].includes(event.key) && removed) removed();
    else return;
    event.preventDefault();
    event.stopPropagation();
  });
}

/** @param {Element} node @param {Record<string, number>} attributes */
function setAttributes(node, attributes) {
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, String(value));
}
