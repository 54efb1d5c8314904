/** Draw one area on a picture by mouse, finger or keys. */

import { createSvg } from "../core/dom.js";
import { createHatch, outlinePath } from "./area_hatching.js";
import { t } from "../core/messages.js";

/** @typedef {[number, number]} Point */
/** @typedef {import("./workspace.js").Zone} Zone */

/** Distance from the first corner at which a polygon closes, pixels; larger for a finger. */
const CLOSING_DISTANCE = 12;
const TOUCH_CLOSING_DISTANCE = 28;

/** Minimum size of a drag, pixels; less is a click. */
const MIN_DRAG = 4;

/** Size of an area placed by keys, relative to the height of the picture. */
const KEYBOARD_SHARE = 0.3;

export class Pen {
  /**
   * @param {SVGSVGElement} picture
   * @param {import("../core/view.js").View} view
   * @param {string} role
   * @param {import("./workspace.js").Tool} tool
   * @param {{done: (zone: Zone) => void, left: () => void, tell: (text: string) => void}} on
   */
  constructor(picture, view, role, tool, on) {
    this.picture = picture;
    this.view = view;
    this.tool = tool;
    this.on = on;
    /** @type {Point[]} */
    this.corners = [];
    this.gone = new AbortController();
    this.shape = createHatch(role, "");
    this.dots = createSvg("path", { class: "pen-dots" });
    this.sheet = createSvg("rect", { class: "pen-sheet", width: view.width, height: view.height });
    this.node = createSvg("g", {}, this.shape, this.dots, this.sheet);
    picture.append(this.node);
    this.listen();
    this.describeState();
  }

  listen() {
    const { signal } = this.gone;
    /** @param {"pointerdown" | "pointermove" | "pointerup"} name @param {(event: PointerEvent) => void} act */
    const on = (name, act) => this.sheet.addEventListener(name, act, { signal });
    on("pointerdown", (event) => {
      event.stopPropagation();
      this.sheet.setPointerCapture(event.pointerId);
      if (this.tool !== "polygon") this.corners = [this.snapPointer(event)];
    });
    on("pointermove", (event) => this.show(this.snapPointer(event)));
    on("pointerup", (event) =>
      this.tool === "polygon" ? this.addCorner(event) : this.finish(this.snapPointer(event)),
    );
    this.sheet.addEventListener("dblclick", (event) => event.stopPropagation(), { signal });
    // Handle keys everywhere except in text fields.
    document.addEventListener("keydown", (event) => this.handleKey(event), { signal, capture: true });
  }

  /** @param {PointerEvent} event @returns {Point} */
  snapPointer(event) {
    const [x, y] = this.view.toPlaneFromPointer(this.picture, event);
    return [this.view.roundToGrid(x), this.view.roundToGrid(y)];
  }

  /** Return the distance of two points in the picture, pixels. @param {Point} one @param {Point} other */
  pictureDistance(one, other) {
    return this.view.scale * Math.hypot(one[0] - other[0], one[1] - other[1]);
  }

  /** @param {PointerEvent} event */
  addCorner(event) {
    const at = this.snapPointer(event);
    const near = event.pointerType === "touch" ? TOUCH_CLOSING_DISTANCE : CLOSING_DISTANCE;
    const { corners } = this;
    if (corners.length >= 3 && this.pictureDistance(at, corners[0]) < near) return this.finish();
    // A double click also ends the polygon.
    if (corners.length && this.pictureDistance(at, corners[corners.length - 1]) < MIN_DRAG)
      return corners.length >= 3 ? this.finish() : undefined;
    corners.push(at);
    this.show(at);
    this.describeState();
  }

  /** @param {KeyboardEvent} event */
  handleKey(event) {
    if (event.target instanceof HTMLElement && event.target.matches("input, textarea, select")) return;
    if (event.key === "Escape") this.on.left();
    else if (event.key === "Enter") this.handleEnter();
    else if (event.key === "Backspace" && this.corners.length) {
      this.corners.pop();
      this.show(this.corners.at(-1) ?? null);
      this.describeState();
    } else return;
    event.preventDefault();
    event.stopPropagation();
  }

  /** Close the polygon, or place an area in the middle if nothing is drawn yet. */
  handleEnter() {
    if (this.tool === "polygon" && this.corners.length) {
      if (this.corners.length >= 3) this.finish();
      return;
    }
    const { view } = this;
    const [x, y] = view.middle.map((one) => view.roundToGrid(one));
    const half = view.roundToGrid((0.5 * KEYBOARD_SHARE * view.height) / view.scale);
    this.on.done(
      this.tool === "circle"
        ? { circle: { center: [x, y], radius: half } }
        : {
            polygon: [
              [x - half, y - half],
              [x + half, y - half],
              [x + half, y + half],
              [x - half, y + half],
            ],
          },
    );
  }

  /** @param {Point} [last] */
  finish(last) {
    if (this.tool === "polygon") return this.on.done({ polygon: this.corners });
    if (!this.corners.length || !last) return;
    const zone = this.spanZone(this.corners[0], last);
    this.corners = [];
    if (zone) this.on.done(zone);
    else this.show(null);
  }

  /**
   * Return the rectangle or circle between two points, or null if it is empty.
   * @param {Point} from
   * @param {Point} to
   * @returns {Zone | null}
   */
  spanZone(from, to) {
    const [width, height] = [Math.abs(to[0] - from[0]), Math.abs(to[1] - from[1])];
    if (this.tool === "circle") {
      const radius = Number(Math.hypot(width, height).toPrecision(4));
      return radius * this.view.scale < MIN_DRAG ? null : { circle: { center: from, radius } };
    }
    if (Math.min(width, height) * this.view.scale < MIN_DRAG) return null;
    const [left, low] = [Math.min(from[0], to[0]), Math.min(from[1], to[1])];
    const [right, high] = [Math.max(from[0], to[0]), Math.max(from[1], to[1])];
    return {
      polygon: [
        [left, low],
        [right, low],
        [right, high],
        [left, high],
      ],
    };
  }

  /** Show the unfinished area up to the pointer. @param {Point | null} at */
  show(at) {
    const { view, corners } = this;
    const zone = at && corners.length && this.tool !== "polygon" ? this.spanZone(corners[0], at) : null;
    const line = this.tool === "polygon" ? [...corners, ...(at ? [at] : [])] : (zone?.polygon ?? []);
    const circle = zone?.circle ?? null;
    this.shape.setAttribute(
      "d",
      circle || (zone && line.length)
        ? outlinePath(view, { circle, corners: line })
        : corners.length && line.length > 1
          ? view.pathData(line)
          : "",
    );
    this.dots.setAttribute(
      "d",
      (this.tool === "polygon" ? corners : [])
        .map((corner) => {
          const [u, v] = view.toPicture(...corner);
          return `M${u - 4} ${v}a4 4 0 1 0 8 0a4 4 0 1 0 -8 0Z`;
        })
        .join(""),
    );
    if (circle) this.on.tell(t`Radius ${circle.radius}`);
    else if (zone)
      this.on.tell(`${view.roundToGrid(line[2][0] - line[0][0])} × ${view.roundToGrid(line[2][1] - line[0][1])}`);
    else if (at && corners.length) this.on.tell(`x ${at[0]}, y ${at[1]}. ${this.describeTool()}`);
  }

  describeState() {
    this.on.tell(this.describeTool());
  }

  describeTool() {
    if (this.tool === "rectangle")
      return t`Drag from corner to corner. Enter places one in the middle, Escape cancels.`;
    if (this.tool === "circle") return t`Drag outward from the centre. Enter places one in the middle, Escape cancels.`;
    if (!this.corners.length) return t`Click the corners. Enter places one in the middle, Escape cancels.`;
    return this.corners.length < 3
      ? t`Click the next corner. Backspace removes the last one, Escape cancels.`
      : t`Click the first corner or press Enter to close it. Backspace removes the last one.`;
  }

  leave() {
    this.gone.abort();
    this.node.remove();
  }
}
