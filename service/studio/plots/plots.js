/** Small plots over a motion, with a mark at the current position; a click moves the motion there. */

import { saveFile } from "../design/design_files.js";
import { createElement, rebuild, formatNumber, createSvg } from "../core/dom.js";
import { LIST_SEPARATOR, t } from "../core/messages.js";
import { exportCsv, exportPicture } from "./plot_files.js";

const WIDTH = 300;
const HEIGHT = 120;
const MARGIN = { left: 58, right: 10, top: 8, bottom: 20 };

/** Maximum length of a number next to the plot, characters; longer ones are set narrower. */
const NUMBER_CHARACTERS = 7;

/** Maximum number of points of a line; more cannot be distinguished. */
const MAX_POINTS = 400;

/** Values that differ by less than this share of their size are equal but for rounding. */
const NOISE_SHARE = 1e-9;

/** Minimum ratio of a line's range to that of its middle four fifths for which its peaks are cut off. */
const STEEP_RATIO = 8;

/** Share of its range that a plot keeps when it is zoomed in, and the fewest samples that it shows. */
const ZOOM_SHARE = 0.5;
const MIN_SAMPLES = 8;

/** @typedef {(number | null)[]} Series */

/**
 * What of a plot is seen.
 * @typedef {object} SeenRange
 * @property {boolean} whole whether peaks are always shown in full
 * @property {[number, number]} range first and last sample
 */

/**
 * @typedef {object} PlotData
 * @property {string} title
 * @property {Record<string, Series>} lines by name; one line needs none
 * @property {number | null} [limit] a line that is not to be passed
 * @property {boolean[]} [used] samples in the range that matters
 * @property {boolean[]} [gaps] samples at which the quantity is not determined
 * @property {number} [least] differences below it are rounding: what the quantity is measured by
 * @property {number[]} [values] all that is known of the quantity, where the samples are taken from between them
 */

/**
 * A plot whose mark follows the motion; its number is shown on request.
 * @typedef {{figure: HTMLElement, show: (at: number, told: boolean) => void}} PlotMark
 */

/**
 * @param {PlotData[]} wanted @param {number[] | undefined} input degrees, one for each sample
 * @param {(at: number) => void} lead leads the motion to a sample
 * @param {string} [unit] of the input
 * @returns {PlotMark[]}
 */
export function createPlots(wanted, input, lead, unit = "°") {
  return wanted
    .filter(({ lines }) => Object.values(lines).some((series) => series.some(Number.isFinite)))
    .map((one) => createPlot(one, input, lead, unit));
}

/**
 * @param {PlotData} plotted @param {number[] | undefined} input @param {(at: number) => void} lead @param {string} unit
 * @param {Partial<SeenRange>} [seen]
 * @returns {PlotMark}
 */
function createPlot(plotted, input, lead, unit, { whole = false, range: looked } = {}) {
  const { title, lines, limit, used, gaps, least = 0, values = [] } = plotted;
  const samples = Object.values(lines)[0].length - 1;
  const [start, end] = looked ?? [0, samples];
  const part = (/** @type {Series} */ series) => series.map((one, k) => (k < start || k > end ? null : one));
  const all = Object.values(lines).map(part);
  // A peak between two samples is one of the whole.
  const known = /** @type {number[]} */ ([...all.flat(), ...(looked ? [] : values)].filter(Number.isFinite));
  const extremes = [known.reduce((a, b) => Math.min(a, b)), known.reduce((a, b) => Math.max(a, b))];
  const calm = middleRange(known, extremes);
  const telling = whole ? extremes : calm;
  // A peak beyond all bounds makes nothing of the rest.
  const noise = NOISE_SHARE * Math.max(calm[1] - calm[0], least);
  const cut = extremes.filter((one, k) => one !== telling[k]);
  let [low, high] = typeof limit === "number" ? [Math.min(telling[0], limit), Math.max(telling[1], limit)] : telling;
  const steady = high - low <= NOISE_SHARE * Math.max(Math.abs(low), Math.abs(high), least);
  const range = steady ? Math.max(1, Math.abs(high)) : high - low;
  const ticks = steady ? [low] : [low, high];
  [low, high] = [low - 0.05 * range, high + 0.05 * range];
  const x = (/** @type {number} */ k) =>
    MARGIN.left + ((WIDTH - MARGIN.left - MARGIN.right) * (Math.min(end, Math.max(start, k)) - start)) / (end - start);
  const y = (/** @type {number} */ value) =>
    MARGIN.top + ((HEIGHT - MARGIN.top - MARGIN.bottom) * (high - Math.min(high, Math.max(low, value)))) / (high - low);
  const data = (/** @type {Series} */ series) => {
    let path = "";
    let pen = "M";
    for (let k = start; k <= end; k += Math.max(1, Math.floor((end - start) / MAX_POINTS))) {
      const value = series[k];
      if (value === null || !Number.isFinite(value)) pen = "M";
      else {
        path += `${pen}${x(k).toFixed(1)} ${y(value).toFixed(1)}`;
        pen = "L";
      }
    }
    return path;
  };
  const mark = createSvg("line", { class: "mark", y1: MARGIN.top, y2: HEIGHT - MARGIN.bottom });
  const cursor = createSvg("line", { class: "cursor", y1: MARGIN.top, y2: HEIGHT - MARGIN.bottom, hidden: true });
  /** Where the pointer is. @type {number | null} */
  let pointed = null;
  const reading = createElement("span", { class: "reading" });
  const names = Object.keys(lines);
  const picture = createSvg(
    "svg",
    {
      viewBox: `0 0 ${WIDTH} ${HEIGHT}`,
      role: "img",
      "aria-label": t`${title}: from ${formatNumber(extremes[0])} to ${formatNumber(extremes[1])}`,
    },
    createSvg("rect", { class: "paper", width: WIDTH, height: HEIGHT }),
    ...listRuns(used ?? []).map(([from, to]) =>
      createSvg("rect", {
        class: "used",
        x: x(from),
        y: MARGIN.top,
        width: x(to) - x(from),
        height: HEIGHT - MARGIN.top - MARGIN.bottom,
      }),
    ),
    ...listRuns(gaps ?? []).map(([from, to]) =>
      createSvg("rect", {
        class: "gap",
        x: x(from) - 1,
        y: MARGIN.top,
        width: x(to) - x(from) + 2,
        height: HEIGHT - MARGIN.top - MARGIN.bottom,
      }),
    ),
    low < 0 &&
      high > 0 &&
      createSvg("line", { class: "zero", x1: MARGIN.left, x2: WIDTH - MARGIN.right, y1: y(0), y2: y(0) }),
    ...ticks.map((value) => {
      const told = formatBriefly(value, 1e-6 * range);
      const narrower = told.length > NUMBER_CHARACTERS && {
        textLength: MARGIN.left - 8,
        lengthAdjust: "spacingAndGlyphs",
      };
      return createSvg(
        "g",
        {},
        createSvg("line", { class: "grid", x1: MARGIN.left, x2: WIDTH - MARGIN.right, y1: y(value), y2: y(value) }),
        createSvg(
          "text",
          { class: "tick", x: MARGIN.left - 5, y: y(value) + 4, "text-anchor": "end", ...narrower },
          told,
        ),
      );
    }),
    typeof limit === "number" &&
      createSvg("line", { class: "limit", x1: MARGIN.left, x2: WIDTH - MARGIN.right, y1: y(limit), y2: y(limit) }),
    input &&
      createSvg(
        "text",
        { class: "tick", x: MARGIN.left, y: HEIGHT - 5 },
        `${formatNumber(Math.round(input[start]))}${unit}`,
      ),
    input &&
      createSvg(
        "text",
        { class: "tick", x: WIDTH - MARGIN.right, y: HEIGHT - 5, "text-anchor": "end" },
        `${formatNumber(Math.round(input[end]))}${unit}`,
      ),
    ...all.map((series, k) => createSvg("path", { class: `series s${k}`, d: data(series) })),
    ...all.flatMap((series) =>
      findPeaks(series, telling).map(([k, value]) => peakMark(x(k), y(value), value > telling[1])),
    ),
    mark,
    cursor,
  );
  const under = (/** @type {PointerEvent} */ event) => {
    const box = picture.getBoundingClientRect();
    const u = ((event.clientX - box.left) / box.width) * WIDTH;
    return Math.min(
      end,
      Math.max(start, start + ((u - MARGIN.left) / (WIDTH - MARGIN.left - MARGIN.right)) * (end - start)),
    );
  };
  const follow = (/** @type {PointerEvent} */ event) => lead(under(event));
  // Show the value at the pointer while it rests on the plot.
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
  const caption = createElement(
    "figcaption",
    {},
    createElement(
      "span",
      {},
      title,
      ...(names.length > 1
        ? names.flatMap((name, k) => [" ", createElement("span", { class: `key s${k}` }, name)])
        : []),
    ),
    reading,
  );
  let at = 0;
  /** @type {PlotMark["show"] | null} the plot in its other range, which has taken the place of this one */
  let other = null;
  const look = (/** @type {Partial<SeenRange>} */ seen) => {
    const open = more.open;
    const next = createPlot(plotted, input, lead, unit, { whole, range: looked, ...seen });
    other = next.show;
    rebuild([figure], () => {
      figure.replaceChildren(...next.figure.childNodes);
      /** @type {HTMLDetailsElement} */ (figure.querySelector(".plot-more")).open = open;
    });
    other(at, true);
  };
  const zoom = (/** @type {number} */ share) => {
    const wide = Math.min(samples, Math.max(MIN_SAMPLES, Math.round((end - start) * share)));
    const from = Math.min(samples - wide, Math.max(0, Math.round(at - wide / 2)));
    look({ range: [from, from + wide] });
  };
  const small = (
    /** @type {string} */ text,
    /** @type {string} */ label,
    /** @type {() => void} */ act,
    disabled = false,
  ) =>
    createElement(
      "button",
      { type: "button", class: "small", "aria-label": `${label}: ${title}`, title: label, disabled, onclick: act },
      text,
    );
  const name = title
    .toLowerCase()
    .replace(/[^\p{L}\p{N}]+/gu, "-")
    .replace(/^-|-$/g, "");
  const more = createElement(
    "details",
    { class: "plot-more" },
    createElement("summary", { "aria-label": t`More on: ${title}`, title: t`Zoom and download` }, "⋯"),
    createElement(
      "div",
      { class: "row" },
      small("−", t`Zoom out`, () => zoom(1 / ZOOM_SHARE), end - start >= samples),
      small("+", t`Zoom in at the current position`, () => zoom(ZOOM_SHARE), end - start <= MIN_SAMPLES),
      small("CSV", t`Download the numbers as CSV`, () => saveFile(exportCsv(title, lines, input, unit), `${name}.csv`)),
      small(t`Picture`, t`Download the picture`, async () =>
        saveFile(await exportPicture(picture, title), `${name}.png`),
      ),
    ),
  );
  const button =
    (cut.length > 0 || whole) &&
    createElement(
      "button",
      { type: "button", class: "small cut", onclick: () => look({ whole: !whole }) },
      whole
        ? t`Cut the peaks`
        : cut.length > 1
          ? t`Peaks ${cut.map((one) => formatBriefly(one)).join(` ${t`and`} `)} cut; show all`
          : t`Peak ${formatBriefly(cut[0])} cut; show all`,
    );
  const figure = createElement("figure", { class: "plot" }, caption, picture, button, more);
  const read = (/** @type {number} */ k) => {
    const place =
      input && pointed !== null ? `${formatNumber(Math.round(10 * input[Math.round(k)]) / 10)}${unit}: ` : "";
    reading.textContent =
      place +
      Object.values(lines)
        .map((series) => formatBriefly(series[Math.round(k)], noise))
        .join(LIST_SEPARATOR);
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
function findPeaks(series, [low, high]) {
  const out = series.map((one) => one !== null && Number.isFinite(one) && (one < low || one > high));
  return listRuns(out).map(([from, to]) => {
    let at = from;
    for (let k = from; k <= to; k++) if (Math.abs(Number(series[k])) > Math.abs(Number(series[at]))) at = k;
    return [at, Number(series[at])];
  });
}

/** A mark where a line goes on beyond the picture. @param {number} u @param {number} v @param {boolean} up */
function peakMark(u, v, up) {
  const way = up ? 5 : -5;
  return createSvg("path", { class: "beyond-mark", d: `M${u - 4} ${v}h8l-4 ${-way}Z` });
}

/**
 * The range worth seeing: towards a toggle rates grow beyond all bounds, and would flatten what is between.
 * @param {number[]} known
 * @param {number[]} extremes
 */
function middleRange(known, extremes) {
  const order = [...known].sort((one, other) => one - other);
  const [least, most] = [order[Math.floor(0.1 * (order.length - 1))], order[Math.ceil(0.9 * (order.length - 1))]];
  const spread = most - least;
  if (!(extremes[1] - extremes[0] > STEEP_RATIO * spread) || !(spread > 0)) return extremes;
  return [Math.max(extremes[0], least - spread), Math.min(extremes[1], most + spread)];
}

/** First and last of every run of samples. @param {boolean[]} used @returns {[number, number][]} */
export function listRuns(used) {
  /** @type {[number, number][]} */
  const found = [];
  used.forEach((one, k) => {
    if (!one) return;
    if (k > 0 && used[k - 1]) found[found.length - 1][1] = k;
    else found.push([k, k]);
  });
  return found;
}

/** Format with three digits; 0 below `noise`. @param {number | null | undefined} value @param {number} [noise] */
export function formatBriefly(value, noise = 0) {
  if (value === null || value === undefined) return "–";
  return Math.abs(value) < noise ? "0" : formatNumber(Number(value.toPrecision(3)));
}
