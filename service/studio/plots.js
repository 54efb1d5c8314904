/** Small plots of a motion against its input, each with a mark where the motion stands. */

import { el, shown, svg } from "./dom.js";

const WIDTH = 300;
const HEIGHT = 120;
const EDGE = { left: 46, right: 10, top: 8, bottom: 20 };

/** Greatest number of points of a line; more cannot be told apart. */
const POINTS = 400;

/** Angles and ratios that differ by less are equal but for rounding. */
const NOISE = 1e-9;

/** @typedef {(number | null)[]} Series */

/** The quantities worth a plot, as far as the motion has them. @param {any} motion @param {any} skeleton @returns {[string, Series][]} */
function quantities(motion, skeleton) {
  /** @type {[string, Series][]} */
  const found = [];
  if (motion.transmission_angle?.some((/** @type {any} */ one) => one !== null)) found.push(["Transmission angle (°)", motion.transmission_angle]);
  const point = motion.joints.P;
  const magnitude = (/** @type {Series} */ x, /** @type {Series} */ y) => x.map((one, k) => (one === null || y[k] === null ? null : Math.hypot(one, Number(y[k]))));
  if (point?.vx) found.push(["Speed of P (by rad)", magnitude(point.vx, point.vy)], ["Acceleration of P (by rad²)", magnitude(point.ax, point.ay)]);
  for (const [name, slide] of Object.entries(motion.slides ?? {})) {
    found.push([`Position of ${name}`, slide.position], [`Velocity of ${name}`, slide.velocity]);
  }
  const driven = skeleton.links.map((/** @type {any} */ link) => link.name).filter((/** @type {string} */ name) => name !== "ground" && name !== skeleton.input_link);
  const last = motion.links?.[driven.at(-1)];
  if (last) found.push([`Angle of ${driven.at(-1)} (°)`, last.angle], [`Angular velocity ratio of ${driven.at(-1)}`, last.omega]);
  return found.filter(([, series]) => Array.isArray(series) && series.some((one) => one !== null)).slice(0, 6);
}

/**
 * @param {any} motion @param {any} skeleton
 * @returns {{figure: HTMLElement, show: (at: number) => void}[]}
 */
export function plots(motion, skeleton) {
  return quantities(motion, skeleton).map(([title, series]) => plot(title, series, motion.input_angle));
}

/** @param {string} title @param {Series} series @param {number[] | undefined} input */
function plot(title, series, input) {
  const known = /** @type {number[]} */ (series.filter((one) => one !== null));
  let low = Math.min(...known);
  let high = Math.max(...known);
  const steady = high - low <= NOISE * Math.max(Math.abs(low), Math.abs(high), title.startsWith("Ang") ? 1 : 0);
  const range = steady ? Math.max(1, Math.abs(high)) : high - low;
  [low, high] = [low - 0.05 * range, high + 0.05 * range];
  const last = series.length - 1;
  const x = (/** @type {number} */ k) => EDGE.left + ((WIDTH - EDGE.left - EDGE.right) * k) / last;
  const y = (/** @type {number} */ value) => EDGE.top + ((HEIGHT - EDGE.top - EDGE.bottom) * (high - value)) / (high - low);
  let data = "";
  let pen = "M";
  for (let k = 0; k <= last; k += Math.max(1, Math.floor(last / POINTS))) {
    const value = series[k];
    if (value === null) pen = "M";
    else {
      data += `${pen}${x(k).toFixed(1)} ${y(value).toFixed(1)}`;
      pen = "L";
    }
  }
  const mark = svg("line", { class: "mark", y1: EDGE.top, y2: HEIGHT - EDGE.bottom });
  const reading = el("span", { class: "reading" });
  const ends = input ? [input[0], input[last]] : [0, last];
  const figure = el("figure", {},
    el("figcaption", {}, title, reading),
    svg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": `${title}: from ${shown(Math.min(...known))} to ${shown(Math.max(...known))}` },
      svg("rect", { class: "paper", width: WIDTH, height: HEIGHT }),
      ...[low + 0.05 * range, high - 0.05 * range].map((value) => svg("g", {},
        svg("line", { class: "grid", x1: EDGE.left, x2: WIDTH - EDGE.right, y1: y(value), y2: y(value) }),
        svg("text", { class: "tick", x: EDGE.left - 5, y: y(value) + 4, "text-anchor": "end" }, brief(value)))),
      svg("text", { class: "tick", x: EDGE.left, y: HEIGHT - 5 }, input ? `${Math.round(ends[0])}°` : ""),
      svg("text", { class: "tick", x: WIDTH - EDGE.right, y: HEIGHT - 5, "text-anchor": "end" }, input ? `${Math.round(ends[1])}°` : ""),
      svg("path", { class: "series", d: data }), mark));
  const show = (/** @type {number} */ at) => {
    mark.setAttribute("x1", String(x(at)));
    mark.setAttribute("x2", String(x(at)));
    reading.textContent = brief(series[Math.round(at)]);
  };
  return { figure, show };
}

/** Three digits. @param {number | null} value */
function brief(value) {
  return value === null ? "–" : shown(Number(value.toPrecision(3)));
}
