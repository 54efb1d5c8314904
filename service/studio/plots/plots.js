/** Small plots over a motion, each with a mark where the motion stands; a click leads the motion there. */

import { saved } from "../design/design_files.js";
import { el, remade, shown, svg } from "../core/dom.js";
import { BETWEEN, t } from "../core/messages.js";
import { comma, pictured } from "./plot_files.js";

const WIDTH = 300;
const HEIGHT = 120;
const EDGE = { left: 58, right: 10, top: 8, bottom: 20 };

/** Characters that a number beside the plot has room for; one of more is set narrower. */
const BESIDE = 7;

/** Greatest number of points of a line; more cannot be told apart. */
const POINTS = 400;

/** Values that differ by less than this share of their size are equal but for rounding. */
const NOISE = 1e-9;

/** A line whose range is so many times that of its middle four fifths is shown without its peaks. */
const STEEP = 8;

/** How much of a plot a nearer look has of the one before, and the fewest samples of one. */
const NEARER = 0.5;
const FEWEST = 8;

/** @typedef {(number | null)[]} Series */

/**
 * What of a plot is seen.
 * @typedef {object} Seen
 * @property {boolean} whole whether peaks are shown whatever becomes of the rest
 * @property {[number, number]} range first and last sample
 */

/**
 * @typedef {object} Plotted
 * @property {string} title
 * @property {Record<string, Series>} lines by name; one line needs none
 * @property {number | null} [limit] a line that is not to be passed
 * @property {boolean[]} [used] samples in the range that matters
 * @property {boolean[]} [gaps] samples at which the quantity is not determined
 * @property {number} [least] differences below it are rounding: what the quantity is measured by
 * @property {number[]} [values] all that is known of the quantity, where the samples are taken from between them
 */

/**
 * A plot whose mark follows the motion; its number is told where that is asked for.
 * @typedef {{figure: HTMLElement, show: (at: number, told: boolean) => void}} Mark
 */

/**
 * @param {Plotted[]} wanted @param {number[] | undefined} input degrees, one for each sample
 * @param {(at: number) => void} lead leads the motion to a sample
 * @param {string} [unit] of the input
 * @returns {Mark[]}
 */
export function plots(wanted, input, lead, unit = "°") {
  return wanted
    .filter(({ lines }) => Object.values(lines).some((series) => series.some(Number.isFinite)))
    .map((one) => plot(one, input, lead, unit));
}

/**
 * @param {Plotted} plotted @param {number[] | undefined} input @param {(at: number) => void} lead @param {string} unit
 * @param {Partial<Seen>} [seen]
 * @returns {Mark}
 */
function plot(plotted, input, lead, unit, { whole = false, range: looked } = {}) {
  const { title, lines, limit, used, gaps, least = 0, values = [] } = plotted;
  const samples = Object.values(lines)[0].length - 1;
  const [start, end] = looked ?? [0, samples];
  const part = (/** @type {Series} */ series) => series.map((one, k) => (k < start || k > end ? null : one));
  const all = Object.values(lines).map(part);
  // A peak between two samples is one of the whole.
  const known = /** @type {number[]} */ ([...all.flat(), ...(looked ? [] : values)].filter(Number.isFinite));
  const extremes = [known.reduce((a, b) => Math.min(a, b)), known.reduce((a, b) => Math.max(a, b))];
  const calm = middle(known, extremes);
  const telling = whole ? extremes : calm;
  // A peak beyond all bounds makes nothing of the rest.
  const noise = NOISE * Math.max(calm[1] - calm[0], least);
  const cut = extremes.filter((one, k) => one !== telling[k]);
  let [low, high] = typeof limit === "number" ? [Math.min(telling[0], limit), Math.max(telling[1], limit)] : telling;
  const steady = high - low <= NOISE * Math.max(Math.abs(low), Math.abs(high), least);
  const range = steady ? Math.max(1, Math.abs(high)) : high - low;
  const ticks = steady ? [low] : [low, high];
  [low, high] = [low - 0.05 * range, high + 0.05 * range];
  const x = (/** @type {number} */ k) =>
    EDGE.left + ((WIDTH - EDGE.left - EDGE.right) * (Math.min(end, Math.max(start, k)) - start)) / (end - start);
  const y = (/** @type {number} */ value) =>
    EDGE.top + ((HEIGHT - EDGE.top - EDGE.bottom) * (high - Math.min(high, Math.max(low, value)))) / (high - low);
  const data = (/** @type {Series} */ series) => {
    let path = "";
    let pen = "M";
    for (let k = start; k <= end; k += Math.max(1, Math.floor((end - start) / POINTS))) {
      const value = series[k];
      if (value === null || !Number.isFinite(value)) pen = "M";
      else {
        path += `${pen}${x(k).toFixed(1)} ${y(value).toFixed(1)}`;
        pen = "L";
      }
    }
    return path;
  };
  const mark = svg("line", { class: "mark", y1: EDGE.top, y2: HEIGHT - EDGE.bottom });
  const cursor = svg("line", { class: "cursor", y1: EDGE.top, y2: HEIGHT - EDGE.bottom, hidden: true });
  /** Where the pointer is. @type {number | null} */
  let pointed = null;
  const reading = el("span", { class: "reading" });
  const names = Object.keys(lines);
  const picture = svg(
    "svg",
    {
      viewBox: `0 0 ${WIDTH} ${HEIGHT}`,
      role: "img",
      "aria-label": t`${title}: from ${shown(extremes[0])} to ${shown(extremes[1])}`,
    },
    svg("rect", { class: "paper", width: WIDTH, height: HEIGHT }),
    ...runs(used ?? []).map(([from, to]) =>
      svg("rect", {
        class: "used",
        x: x(from),
        y: EDGE.top,
        width: x(to) - x(from),
        height: HEIGHT - EDGE.top - EDGE.bottom,
      }),
    ),
    ...runs(gaps ?? []).map(([from, to]) =>
      svg("rect", {
        class: "gap",
        x: x(from) - 1,
        y: EDGE.top,
        width: x(to) - x(from) + 2,
        height: HEIGHT - EDGE.top - EDGE.bottom,
      }),
    ),
    low < 0 && high > 0 && svg("line", { class: "zero", x1: EDGE.left, x2: WIDTH - EDGE.right, y1: y(0), y2: y(0) }),
    ...ticks.map((value) => {
      const told = brief(value, 1e-6 * range);
      const narrower = told.length > BESIDE && { textLength: EDGE.left - 8, lengthAdjust: "spacingAndGlyphs" };
      return svg(
        "g",
        {},
        svg("line", { class: "grid", x1: EDGE.left, x2: WIDTH - EDGE.right, y1: y(value), y2: y(value) }),
        svg("text", { class: "tick", x: EDGE.left - 5, y: y(value) + 4, "text-anchor": "end", ...narrower }, told),
      );
    }),
    typeof limit === "number" &&
      svg("line", { class: "limit", x1: EDGE.left, x2: WIDTH - EDGE.right, y1: y(limit), y2: y(limit) }),
    input && svg("text", { class: "tick", x: EDGE.left, y: HEIGHT - 5 }, `${shown(Math.round(input[start]))}${unit}`),
    input &&
      svg(
        "text",
        { class: "tick", x: WIDTH - EDGE.right, y: HEIGHT - 5, "text-anchor": "end" },
        `${shown(Math.round(input[end]))}${unit}`,
      ),
    ...all.map((series, k) => svg("path", { class: `series s${k}`, d: data(series) })),
    ...all.flatMap((series) => peaks(series, telling).map(([k, value]) => beyond(x(k), y(value), value > telling[1]))),
    mark,
    cursor,
  );
  const under = (/** @type {PointerEvent} */ event) => {
    const box = picture.getBoundingClientRect();
    const u = ((event.clientX - box.left) / box.width) * WIDTH;
    return Math.min(end, Math.max(start, start + ((u - EDGE.left) / (WIDTH - EDGE.left - EDGE.right)) * (end - start)));
  };
  const follow = (/** @type {PointerEvent} */ event) => lead(under(event));
  // What stands at the pointer is told as long as it rests on the plot.
  picture.addEventListener("pointermove", (/** @type {PointerEvent} */ event) => {
    const k = under(event);
    pointed = k;
    for (const [name, value] of Object.entries({ x1: x(k), x2: x(k) })) cursor.setAttribute(name, String(value));
    cursor.removeAttribute("hidden");
    read(k);
  });
  picture.addEventListener("pointerleave", () => {
    pointed = null;
    cursor.setAttribute("hidden", "");
    read(at);
  });
  picture.addEventListener("pointerdown", (/** @type {PointerEvent} */ event) => {
    picture.setPointerCapture(event.pointerId);
    follow(event);
    picture.addEventListener("pointermove", follow);
    picture.addEventListener("lostpointercapture", () => picture.removeEventListener("pointermove", follow), {
      once: true,
    });
  });
  const caption = el(
    "figcaption",
    {},
    el(
      "span",
      {},
      title,
      ...(names.length > 1 ? names.flatMap((name, k) => [" ", el("span", { class: `key s${k}` }, name)]) : []),
    ),
    reading,
  );
  let at = 0;
  /** @type {Mark["show"] | null} the plot in its other range, which has taken the place of this one */
  let other = null;
  const look = (/** @type {Partial<Seen>} */ seen) => {
    const open = more.open;
    const next = plot(plotted, input, lead, unit, { whole, range: looked, ...seen });
    other = next.show;
    remade([figure], () => {
      figure.replaceChildren(...next.figure.childNodes);
      /** @type {HTMLDetailsElement} */ (figure.querySelector(".plot-more")).open = open;
    });
    other(at, true);
  };
  const nearer = (/** @type {number} */ share) => {
    const wide = Math.min(samples, Math.max(FEWEST, Math.round((end - start) * share)));
    const from = Math.min(samples - wide, Math.max(0, Math.round(at - wide / 2)));
    look({ range: [from, from + wide] });
  };
  const small = (
    /** @type {string} */ text,
    /** @type {string} */ label,
    /** @type {() => void} */ act,
    disabled = false,
  ) =>
    el(
      "button",
      { type: "button", class: "small", "aria-label": `${label}: ${title}`, title: label, disabled, onclick: act },
      text,
    );
  const name = title
    .toLowerCase()
    .replace(/[^\p{L}\p{N}]+/gu, "-")
    .replace(/^-|-$/g, "");
  const more = el(
    "details",
    { class: "plot-more" },
    el("summary", { "aria-label": t`More of: ${title}`, title: t`Look nearer, take it home` }, "⋯"),
    el(
      "div",
      { class: "row" },
      small("−", t`Farther`, () => nearer(1 / NEARER), end - start >= samples),
      small("+", t`Nearer to where the motion stands`, () => nearer(NEARER), end - start <= FEWEST),
      small("CSV", t`Take the numbers home as CSV`, () => saved(comma(title, lines, input, unit), `${name}.csv`)),
      small(t`Picture`, t`Take the picture home`, async () => saved(await pictured(picture, title), `${name}.png`)),
    ),
  );
  const button =
    (cut.length > 0 || whole) &&
    el(
      "button",
      { type: "button", class: "small cut", onclick: () => look({ whole: !whole }) },
      whole
        ? t`Cut the peaks`
        : cut.length > 1
          ? t`Peaks ${cut.map((one) => brief(one)).join(` ${t`and`} `)} cut; show all`
          : t`Peak ${brief(cut[0])} cut; show all`,
    );
  const figure = el("figure", { class: "plot" }, caption, picture, button, more);
  const read = (/** @type {number} */ k) => {
    const place = input && pointed !== null ? `${shown(Math.round(10 * input[Math.round(k)]) / 10)}${unit}: ` : "";
    reading.textContent =
      place +
      Object.values(lines)
        .map((series) => brief(series[Math.round(k)], noise))
        .join(BETWEEN);
  };
  const show = (/** @type {number} */ now, /** @type {boolean} */ told) => {
    at = now;
    if (other) return other(now, told);
    mark.toggleAttribute("hidden", at < start || at > end);
    mark.setAttribute("transform", `translate(${x(at)})`);
    if (told && pointed === null) read(at);
  };
  return { figure, show };
}

/**
 * The places at which a line leaves the range, and how far it goes there.
 * @param {Series} series
 * @param {number[]} range
 * @returns {[number, number][]}
 */
function peaks(series, [low, high]) {
  const out = series.map((one) => one !== null && Number.isFinite(one) && (one < low || one > high));
  return runs(out).map(([from, to]) => {
    let at = from;
    for (let k = from; k <= to; k++) if (Math.abs(Number(series[k])) > Math.abs(Number(series[at]))) at = k;
    return [at, Number(series[at])];
  });
}

/** A mark where a line goes on beyond the picture. @param {number} u @param {number} v @param {boolean} up */
function beyond(u, v, up) {
  const way = up ? 5 : -5;
  return svg("path", { class: "beyond-mark", d: `M${u - 4} ${v}h8l-4 ${-way}Z` });
}

/**
 * The range worth seeing: towards a toggle rates grow beyond all bounds, and would flatten what is between.
 * @param {number[]} known
 * @param {number[]} extremes
 */
function middle(known, extremes) {
  const order = [...known].sort((one, other) => one - other);
  const [least, most] = [order[Math.floor(0.1 * (order.length - 1))], order[Math.ceil(0.9 * (order.length - 1))]];
  const spread = most - least;
  if (!(extremes[1] - extremes[0] > STEEP * spread) || !(spread > 0)) return extremes;
  return [Math.max(extremes[0], least - spread), Math.min(extremes[1], most + spread)];
}

/** First and last of every run of samples. @param {boolean[]} used @returns {[number, number][]} */
export function runs(used) {
  /** @type {[number, number][]} */
  const found = [];
  used.forEach((one, k) => {
    if (!one) return;
    if (k > 0 && used[k - 1]) found[found.length - 1][1] = k;
    else found.push([k, k]);
  });
  return found;
}

/** Three digits; what is below `noise` is nothing. @param {number | null | undefined} value @param {number} [noise] */
export function brief(value, noise = 0) {
  if (value === null || value === undefined) return "–";
  return Math.abs(value) < noise ? "0" : shown(Number(value.toPrecision(3)));
}
