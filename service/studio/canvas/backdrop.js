/** A picture behind the canvas, to trace over: it is laid there, and scaled by two points whose distance is known. */

import { createElement, formatNumber, createSvg } from "../core/dom.js";
import { t } from "../core/messages.js";

/** @typedef {[number, number]} Point */

/** How strongly the picture shows through. */
const OPACITY = 0.45;

/** The share of the canvas that a picture takes which has no scale yet. */
const INITIAL_SHARE = 0.8;

export class Backdrop {
  /** @param {() => void} changed the canvas is to be drawn anew */
  constructor(changed) {
    this.changed = changed;
    /** @type {{url: string, name: string, width: number, height: number} | null} */
    this.picture = null;
    /**
     * Length units in a pixel, and where the lower left corner lies; null until it is seen for the first time.
     * @type {{scale: number, corner: Point} | null}
     */
    this.placed = null;
    /** Points that have been clicked; null while none are requested. @type {Point[] | null} */
    this.picked = null;
    this.unit = "mm";
    this.node = createElement("div", { id: "backdrop" });
  }

  /**
   * Lay a picture behind the canvas.
   * @param {File} file
   * @param {string} unit
   * @param {number | null} scale length units in a pixel, where they are known
   */
  async lay(file, unit, scale) {
    const url = URL.createObjectURL(file);
    const image = new Image();
    image.src = url;
    try {
      await image.decode();
    } catch {
      URL.revokeObjectURL(url);
      throw new Error(t`${file.name} is not a picture that a browser can show.`);
    }
    this.clear();
    this.unit = unit;
    this.picture = { url, name: file.name, width: image.naturalWidth, height: image.naturalHeight };
    this.placed = scale === null ? null : { scale, corner: [0, 0] };
    this.show();
  }

  /** Take it away. */
  clear() {
    if (this.picture) URL.revokeObjectURL(this.picture.url);
    this.picture = this.placed = this.picked = null;
    this.show();
  }

  /**
   * Where a point of the picture, in pixels from its lower left corner, lies in the plane.
   * @param {Point} point
   * @returns {Point}
   */
  toPlane([x, y]) {
    const { scale, corner } = this.placed ?? { scale: 1, corner: [0, 0] };
    return [corner[0] + scale * x, corner[1] + scale * y];
  }

  /**
   * What is drawn of it on a canvas; clicks go to it while it is being scaled.
   * @param {import("../core/view.js").View} view
   * @param {SVGSVGElement} canvas
   * @returns {SVGElement[]}
   */
  draw(view, canvas) {
    const { picture } = this;
    if (!picture) return [];
    if (!this.placed) {
      const scale = (INITIAL_SHARE * Math.min(view.width / picture.width, view.height / picture.height)) / view.scale;
      this.placed = {
        scale,
        corner: [view.middle[0] - 0.5 * scale * picture.width, view.middle[1] - 0.5 * scale * picture.height],
      };
      this.show(false);
    }
    const { scale, corner } = this.placed;
    const [u, v] = view.toPicture(corner[0], corner[1] + scale * picture.height);
    const size = scale * view.scale;
    const marks = createSvg("g", { class: "marks" });
    const mark = () =>
      marks.replaceChildren(
        ...(this.picked ?? []).map((point) => {
          const [x, y] = view.toPicture(...point);
          return createSvg("path", { class: "mark", d: `M${x - 8} ${y}h16M${x} ${y - 8}v16` });
        }),
      );
    mark();
    canvas.addEventListener(
      "pointerdown",
      (event) => {
        if (!this.picked || this.picked.length >= 2) return;
        // Nothing else on the canvas is meant.
        event.stopImmediatePropagation();
        event.preventDefault();
        this.picked.push(view.toPlaneFromPointer(canvas, event));
        mark();
        this.show(false);
      },
      { capture: true },
    );
    return [
      createSvg("image", {
        href: picture.url,
        x: u,
        y: v,
        width: size * picture.width,
        height: size * picture.height,
        opacity: OPACITY,
        preserveAspectRatio: "none",
        class: "backdrop",
      }),
      marks,
    ];
  }

  /** Its controls. @param {boolean} [redraw] */
  show(redraw = true) {
    const { picture, picked, placed, unit } = this;
    if (!picture) this.node.replaceChildren();
    else {
      const button = (/** @type {string} */ id, /** @type {string} */ text, /** @type {() => void} */ act) =>
        createElement("button", { type: "button", class: "small", id, onclick: act }, text);
      const width = createElement("input", {
        type: "number",
        id: "backdrop-width",
        step: "any",
        min: 0,
        value: placed ? Number((placed.scale * picture.width).toPrecision(6)) : "",
        onchange: () => this.rescale(width.valueAsNumber / picture.width, placed?.corner ?? [0, 0]),
      });
      const apart = picked?.length === 2 ? Math.hypot(picked[1][0] - picked[0][0], picked[1][1] - picked[0][1]) : NaN;
      const distance = createElement("input", {
        type: "number",
        id: "backdrop-distance",
        step: "any",
        min: 0,
        value: Number(apart.toPrecision(6)),
      });
      const set = () =>
        this.rescale(((placed?.scale ?? 1) * distance.valueAsNumber) / apart, /** @type {Point[]} */ (picked)[0]);
      this.node.replaceChildren(
        createElement(
          "fieldset",
          { class: "choice" },
          createElement("legend", {}, t`Behind the canvas: ${picture.name}`),
          createElement(
            "div",
            { class: "row" },
            createElement("label", { for: "backdrop-width" }, t`Its width (${unit})`),
            width,
            button("backdrop-pick", picked ? t`Cancel` : t`Scale by two points`, () => {
              this.picked = picked ? null : [];
              this.show();
            }),
            button("backdrop-clear", t`Remove picture`, () => this.clear()),
          ),
          createElement(
            "p",
            { class: "note", role: "status" },
            !picked
              ? t`One pixel is ${formatNumber(placed?.scale)} ${unit}.`
              : [t`Click one end of a known length.`, t`Click the other end.`, t`Enter the length.`][picked.length],
          ),
          picked?.length === 2 &&
            apart > 0 &&
            createElement(
              "div",
              { class: "row" },
              createElement("label", { for: "backdrop-distance" }, t`Distance between the points (${unit})`),
              distance,
              button("backdrop-set", t`Set`, set),
            ),
        ),
      );
      if (picked?.length === 2) distance.focus();
    }
    if (redraw) this.changed();
  }

  /**
   * Another scale, with a point of the plane that stays under the same point of the picture.
   * @param {number} scale
   * @param {Point} still
   */
  rescale(scale, [x, y]) {
    if (!(scale > 0) || !Number.isFinite(scale) || !this.placed) return;
    const { scale: before, corner } = this.placed;
    const by = scale / before;
    this.placed = { scale, corner: [x + by * (corner[0] - x), y + by * (corner[1] - y)] };
    this.picked = null;
    this.show();
  }
}
