/** A scatter plot of the designs over two quantities; a click or the arrow keys select one. */

import { createElement, rebuild, createSvg } from "../core/dom.js";
import { formatBriefly } from "../design/design_metrics.js";
import { roundSpacing } from "../canvas/grid.js";
import { valueRange, quantityTitle, formatQuantity } from "./shared_metrics.js";
import { t } from "../core/messages.js";

/** @typedef {import("./shared_metrics.js").Quantity} Quantity */

const WIDTH = 336;
const HEIGHT = 236;
const MARGIN = { left: 50, right: 14, top: 28, bottom: 38 };

/** Minimum distance between two ticks, pixels. */
const MIN_TICK_SPACING = [64, 40];

/** Ratio of the extreme values from which an axis is logarithmic, if all values have one sign. */
const MIN_LOGARITHMIC_RATIO = 1000;

/** Maximum number of designs with a label each. */
const MAX_LABELLED = 24;

/**
 * The states of the designs.
 * @typedef {object} DesignStates
 * @property {number} chosen
 * @property {boolean[]} kept designs within the bounds
 * @property {number[]} pinned
 * @property {number[]} front designs on the Pareto front
 */

export class ScatterPlot {
  /**
   * @param {Quantity[]} quantities
   * @param {[number, number]} axes which of them
   * @param {(n: number) => void} choose
   * @param {() => void} turned other axes
   */
  constructor(quantities, axes, choose, turned) {
    this.quantities = quantities;
    this.axes = axes;
    this.choose = choose;
    const pick = (/** @type {0 | 1} */ k, /** @type {string} */ id, /** @type {string} */ text) => {
      const box = createElement(
        "select",
        {
          id,
          onchange: () => {
            this.axes[k] = Number(box.value);
            turned();
          },
        },
        ...quantities.map((one, n) => createElement("option", { value: n }, one.text)),
      );
      box.value = String(axes[k]);
      return createElement("div", { class: "axis" }, createElement("label", { for: id }, text), box);
    };
    this.picture = createSvg("svg", {
      viewBox: `0 0 ${WIDTH} ${HEIGHT}`,
      role: "group",
      "aria-label": t`Designs by two quantities; arrow keys choose`,
      onkeydown: (/** @type {KeyboardEvent} */ event) => this.handleKey(event),
    });
    this.place = createElement("div", { class: "scatter" }, this.picture);
    this.node = createElement(
      "figure",
      {},
      createElement("div", { class: "axes" }, pick(1, "axis-up", t`Up`), pick(0, "axis-across", t`Across`)),
      this.place,
    );
  }

  /** @param {DesignStates} now */
  show(now) {
    this.now = now;
    rebuild([this.place], () => this.picture.replaceChildren(...this.draw(now)));
  }

  /** @param {DesignStates} now */
  draw(now) {
    const [across, up] = this.axes.map((k) => this.quantities[k]);
    const x = createScale(across.values, MARGIN.left, WIDTH - MARGIN.right, MIN_TICK_SPACING[0]);
    const y = createScale(up.values, HEIGHT - MARGIN.bottom, MARGIN.top, MIN_TICK_SPACING[1]);
    this.places = across.values.map((value, n) =>
      value === null || up.values[n] === null
        ? null
        : /** @type {[number, number]} */ ([x.at(value), y.at(/** @type {number} */ (up.values[n]))]),
    );
    const [right, low] = [WIDTH - MARGIN.right, HEIGHT - MARGIN.bottom];
    const few = this.places.length <= MAX_LABELLED;
    return [
      createSvg("rect", { class: "paper", width: WIDTH, height: HEIGHT }),
      ...x.ticks.map((value) =>
        createSvg(
          "g",
          {},
          createSvg("line", { class: "grid", x1: x.at(value), x2: x.at(value), y1: MARGIN.top, y2: low }),
          createSvg(
            "text",
            { class: "tick", x: x.at(value), y: low + 14, "text-anchor": "middle" },
            formatBriefly(value),
          ),
        ),
      ),
      ...y.ticks.map((value) =>
        createSvg(
          "g",
          {},
          createSvg("line", { class: "grid", x1: MARGIN.left, x2: right, y1: y.at(value), y2: y.at(value) }),
          createSvg(
            "text",
            { class: "tick", x: MARGIN.left - 5, y: y.at(value) + 4, "text-anchor": "end" },
            formatBriefly(value),
          ),
        ),
      ),
      createSvg("path", { class: "axis-line", d: `M${MARGIN.left} ${MARGIN.top}V${low}H${right}` }),
      createSvg("text", { class: "axis-name", x: 6, y: 16 }, quantityTitle(up)),
      createSvg("text", { class: "axis-name", x: right, y: HEIGHT - 6, "text-anchor": "end" }, quantityTitle(across)),
      ...[...this.places.keys()]
        .sort((a, b) => Number(a === now.chosen) - Number(b === now.chosen))
        .map((n) => this.createPoint(n, now, few)),
    ];
  }

  /** @param {number} n @param {DesignStates} now @param {boolean} few */
  createPoint(n, now, few) {
    const place = this.places?.[n];
    if (!place) return "";
    const [u, v] = place;
    const [across, up] = this.axes.map((k) => this.quantities[k]);
    const says = [
      t`Design ${n + 1}`,
      ...[up, across].map((one) => `${one.text} ${formatQuantity(one, Number(one.values[n]))}`),
      ...(now.front.includes(n) ? [t`no other is better`] : []),
      ...(now.pinned.includes(n) ? [t`pinned`] : []),
    ].join(", ");
    const marks = [now.chosen === n && "chosen", !now.kept[n] && "beyond", now.pinned.includes(n) && "pinned"]
      .filter(Boolean)
      .join(" ");
    return createSvg(
      "g",
      {
        class: `spot ${marks}`,
        tabindex: n === this.findTabStop(now) ? 0 : -1,
        role: "button",
        "aria-pressed": String(n === now.chosen),
        "aria-label": says,
        "data-grip": `spot${n}`,
        "aria-disabled": now.kept[n] ? null : "true",
        onclick: () => this.choose(n),
      },
      createSvg("title", {}, says),
      createSvg("circle", { class: "hit", cx: u, cy: v, r: 12 }),
      now.front.includes(n) && createSvg("circle", { class: "ring", cx: u, cy: v, r: 8 }),
      now.pinned.includes(n)
        ? createSvg("path", { class: "spot-mark", d: `M${u} ${v - 6}L${u + 6} ${v}L${u} ${v + 6}L${u - 6} ${v}Z` })
        : createSvg("circle", { class: "spot-mark", cx: u, cy: v, r: 4.5 }),
      few &&
        createSvg(
          "text",
          {
            class: "tick",
            x: u > WIDTH - 34 ? u - 10 : u + 10,
            y: v - 5,
            "text-anchor": u > WIDTH - 34 ? "end" : "start",
          },
          n + 1,
        ),
    );
  }

  /** Return the design that receives the keyboard focus. @param {DesignStates} now */
  findTabStop(now) {
    const there = (/** @type {number} */ n) => Boolean(this.places?.[n]);
    return there(now.chosen) ? now.chosen : (this.places?.findIndex((one) => one !== null) ?? -1);
  }

  /** Select the next design to the right, to the left, above or below. @param {KeyboardEvent} event */
  handleKey(event) {
    const way = { ArrowRight: [0, 1], ArrowLeft: [0, -1], ArrowUp: [1, -1], ArrowDown: [1, 1] }[event.key];
    const { now, places } = this;
    if (!way || !now || !places) return;
    event.preventDefault();
    const [axis, sense] = way;
    const order = [...places.keys()]
      .filter((n) => places[n] && now.kept[n])
      .sort((a, b) => sense * (Number(places[a]?.[axis]) - Number(places[b]?.[axis])) || a - b);
    const next = order[order.indexOf(now.chosen) + 1];
    if (next === undefined) return;
    this.choose(next);
    /** @type {SVGElement | null} */ (this.picture.querySelector(`[data-grip="spot${next}"]`))?.focus({
      preventScroll: true,
    });
  }
}

/**
 * Create the scale of an axis and its round ticks.
 * @param {(number | null)[]} values @param {number} from @param {number} to @param {number} apart
 * @returns {{at: (value: number) => number, ticks: number[]}}
 */
function createScale(values, from, to, apart) {
  let [low, high] = valueRange(values);
  if (low > 0 && high / low > MIN_LOGARITHMIC_RATIO) {
    const [a, b] = [Math.floor(Math.log10(low)), Math.ceil(Math.log10(high))];
    const every = Math.ceil(((b - a) * apart) / Math.abs(to - from));
    const ticks = [];
    for (let power = a; power <= b; power += every) ticks.push(10 ** power);
    return { at: (value) => from + ((Math.log10(value) - a) / (b - a)) * (to - from), ticks };
  }
  const steady = high - low <= 1e-9 * Math.max(Math.abs(low), Math.abs(high));
  const more = steady ? Math.abs(high) || 1 : 0.08 * (high - low);
  const ticks = steady ? [high] : [];
  [low, high] = [low - more, high + more];
  const step = roundSpacing(((high - low) * apart) / Math.abs(to - from));
  if (!steady)
    for (let k = Math.ceil(low / step); k * step <= high; k++) ticks.push(Number((k * step).toPrecision(12)));
  return { at: (value) => from + ((value - low) / (high - low)) * (to - from), ticks };
}
