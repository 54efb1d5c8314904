/** Designs by two of their quantities: a click or the arrow keys choose one. */

import { el, remade, svg } from "../core/dom.js";
import { brief } from "../design/design_metrics.js";
import { spacing } from "../canvas/grid.js";
import { range, titled, told } from "./shared_metrics.js";
import { t } from "../core/messages.js";

/** @typedef {import("./shared_metrics.js").Quantity} Quantity */

const WIDTH = 336;
const HEIGHT = 236;
const EDGE = { left: 50, right: 14, top: 28, bottom: 38 };

/** Between two ticks at least, pixels. */
const APART = [64, 40];

/** Where values of one sign differ by more than this factor, equal factors are equally far apart. */
const WIDE = 1000;

/** Up to so many designs have their numbers beside them. */
const NUMBERED = 24;

/**
 * What is told of the designs.
 * @typedef {object} Told
 * @property {number} chosen
 * @property {boolean[]} kept what meets the bounds
 * @property {number[]} pinned
 * @property {number[]} front what no other beats
 */

export class Scatter {
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
      const box = el(
        "select",
        {
          id,
          onchange: () => {
            this.axes[k] = Number(box.value);
            turned();
          },
        },
        ...quantities.map((one, n) => el("option", { value: n }, one.text)),
      );
      box.value = String(axes[k]);
      return el("div", { class: "axis" }, el("label", { for: id }, text), box);
    };
    this.picture = svg("svg", {
      viewBox: `0 0 ${WIDTH} ${HEIGHT}`,
      role: "group",
      "aria-label": t`Designs by two quantities; arrow keys choose`,
      onkeydown: (/** @type {KeyboardEvent} */ event) => this.keyed(event),
    });
    this.place = el("div", { class: "scatter" }, this.picture);
    this.node = el(
      "figure",
      {},
      el("div", { class: "axes" }, pick(1, "axis-up", t`Up`), pick(0, "axis-across", t`Across`)),
      this.place,
    );
  }

  /** @param {Told} now */
  show(now) {
    this.now = now;
    remade([this.place], () => this.picture.replaceChildren(...this.drawn(now)));
  }

  /** @param {Told} now */
  drawn(now) {
    const [across, up] = this.axes.map((k) => this.quantities[k]);
    const x = scale(across.values, EDGE.left, WIDTH - EDGE.right, APART[0]);
    const y = scale(up.values, HEIGHT - EDGE.bottom, EDGE.top, APART[1]);
    this.places = across.values.map((value, n) =>
      value === null || up.values[n] === null
        ? null
        : /** @type {[number, number]} */ ([x.at(value), y.at(/** @type {number} */ (up.values[n]))]),
    );
    const [right, low] = [WIDTH - EDGE.right, HEIGHT - EDGE.bottom];
    const few = this.places.length <= NUMBERED;
    return [
      svg("rect", { class: "paper", width: WIDTH, height: HEIGHT }),
      ...x.ticks.map((value) =>
        svg(
          "g",
          {},
          svg("line", { class: "grid", x1: x.at(value), x2: x.at(value), y1: EDGE.top, y2: low }),
          svg("text", { class: "tick", x: x.at(value), y: low + 14, "text-anchor": "middle" }, brief(value)),
        ),
      ),
      ...y.ticks.map((value) =>
        svg(
          "g",
          {},
          svg("line", { class: "grid", x1: EDGE.left, x2: right, y1: y.at(value), y2: y.at(value) }),
          svg("text", { class: "tick", x: EDGE.left - 5, y: y.at(value) + 4, "text-anchor": "end" }, brief(value)),
        ),
      ),
      svg("path", { class: "axis-line", d: `M${EDGE.left} ${EDGE.top}V${low}H${right}` }),
      svg("text", { class: "axis-name", x: 6, y: 16 }, titled(up)),
      svg("text", { class: "axis-name", x: right, y: HEIGHT - 6, "text-anchor": "end" }, titled(across)),
      ...[...this.places.keys()]
        .sort((a, b) => Number(a === now.chosen) - Number(b === now.chosen))
        .map((n) => this.point(n, now, few)),
    ];
  }

  /** @param {number} n @param {Told} now @param {boolean} few */
  point(n, now, few) {
    const place = this.places?.[n];
    if (!place) return "";
    const [u, v] = place;
    const [across, up] = this.axes.map((k) => this.quantities[k]);
    const says = [
      t`Design ${n + 1}`,
      ...[up, across].map((one) => `${one.text} ${told(one, Number(one.values[n]))}`),
      ...(now.front.includes(n) ? [t`no other beats it`] : []),
      ...(now.pinned.includes(n) ? [t`pinned`] : []),
    ].join(", ");
    const marks = [now.chosen === n && "chosen", !now.kept[n] && "beyond", now.pinned.includes(n) && "pinned"]
      .filter(Boolean)
      .join(" ");
    return svg(
      "g",
      {
        class: `spot ${marks}`,
        tabindex: n === this.stop(now) ? 0 : -1,
        role: "button",
        "aria-pressed": String(n === now.chosen),
        "aria-label": says,
        "data-grip": `spot${n}`,
        "aria-disabled": now.kept[n] ? null : "true",
        onclick: () => this.choose(n),
      },
      svg("title", {}, says),
      svg("circle", { class: "hit", cx: u, cy: v, r: 12 }),
      now.front.includes(n) && svg("circle", { class: "ring", cx: u, cy: v, r: 8 }),
      now.pinned.includes(n)
        ? svg("path", { class: "spot-mark", d: `M${u} ${v - 6}L${u + 6} ${v}L${u} ${v + 6}L${u - 6} ${v}Z` })
        : svg("circle", { class: "spot-mark", cx: u, cy: v, r: 4.5 }),
      few &&
        svg(
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

  /** The design at which the keys stop. @param {Told} now */
  stop(now) {
    const there = (/** @type {number} */ n) => Boolean(this.places?.[n]);
    return there(now.chosen) ? now.chosen : (this.places?.findIndex((one) => one !== null) ?? -1);
  }

  /** To the next design to the right, to the left, above or below. @param {KeyboardEvent} event */
  keyed(event) {
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
 * Where values lie between two places of a picture, and the round ones among them.
 * @param {(number | null)[]} values @param {number} from @param {number} to @param {number} apart
 * @returns {{at: (value: number) => number, ticks: number[]}}
 */
function scale(values, from, to, apart) {
  let [low, high] = range(values);
  if (low > 0 && high / low > WIDE) {
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
  const step = spacing(((high - low) * apart) / Math.abs(to - from));
  if (!steady)
    for (let k = Math.ceil(low / step); k * step <= high; k++) ticks.push(Number((k * step).toPrecision(12)));
  return { at: (value) => from + ((value - low) / (high - low)) * (to - from), ticks };
}
