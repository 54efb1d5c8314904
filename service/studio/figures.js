/** The numbers of a design: its metrics, its dimensions, and the checks that it has passed. */

import { el, shown, words } from "./dom.js";
import { symbolOf } from "./units.js";

/** What a card shows first of a design's metrics, where the design has it. */
const FIRST = ["quality", "min_transmission_angle", "rms_residual", "structural_error", "max_error", "ratio_error", "error",
  "link_ratio", "size", "input_travel", "body_travel_ratio", "body_turn_ratio", "total_teeth", "efficiency", "prime_radius", "max_pressure_angle"];

/** The metrics that are plain numbers or words, the telling ones first. @param {any} design @returns {[string, any][]} */
export function figures(design) {
  const all = Object.entries(design.metrics ?? {}).filter(([, value]) => ["number", "string", "boolean"].includes(typeof value));
  const rank = (/** @type {string} */ name) => (FIRST.includes(name) ? FIRST.indexOf(name) : FIRST.length);
  return all.sort(([a], [b]) => rank(a) - rank(b));
}

/** @param {any} value */
export function text(value) {
  return typeof value === "number" ? shown(value) : typeof value === "boolean" ? (value ? "yes" : "no") : words(String(value));
}

/** A number of a check with the unit of what the check measures. @param {number} value @param {any} check @param {any} problem */
export function amount(value, check, problem) {
  const unit = symbolOf(check.dimension, problem);
  return `${shown(value)}${unit === "" || unit === "°" ? unit : ` ${unit}`}`;
}

/** @param {any} design @param {any} problem */
export function checks(design, problem) {
  return el("section", {}, el("h4", {}, "Checks"), el("ul", { class: "checks" },
    ...(design.verification?.checks ?? []).map((/** @type {any} */ check) => el("li", { class: check.passed ? "good" : "bad" },
      el("span", {}, check.passed ? "✓ " : "✗ "), words(check.name),
      typeof check.value === "number" && el("span", { class: "note" },
        ` ${amount(check.value, check, problem)}${typeof check.limit === "number" ? `, limit ${amount(check.limit, check, problem)}` : ""}`),
      el("span", { class: "hidden" }, check.passed ? " passed" : " failed")))));
}

/** @param {string} title @param {[string, any][]} rows */
export function table(title, rows) {
  return el("section", {}, el("h4", {}, title), el("table", { class: "figures" }, el("tbody", {},
    ...rows.map(([name, value]) => el("tr", {}, el("th", { scope: "row" }, words(name)), el("td", {}, text(value)))))));
}

/** What becomes of a design as a shop makes it: nothing where the problem does not ask. @param {any} design @returns {HTMLElement[]} */
export function made(design) {
  const told = design.manufacture;
  if (!told) return [];
  const share = design.metrics?.yield;
  const { worst_case: worst, cost } = told;
  /** @type {[string, any][]} */
  const rows = [["yield", share?.value], ["yield, at least", share?.low], ["yield, at most", share?.high],
    ["worst error", worst?.max_error], ["worst angle error, °", worst?.max_angle_error],
    ["tolerances that matter", told.matter?.join(", ") || undefined],
    ["rounding cost, rms residual", cost?.rms_residual], ["rounding cost, error", cost?.max_error], ["remark", told.remark],
    ...Object.entries(told.dimensions ?? {}).map(([name, value]) => /** @type {[string, any]} */ ([`made: ${name.replaceAll(".", " ")}`, value]))];
  return [table("As it is made", rows.filter(([, value]) => value !== undefined && value !== null))];
}

/** The dimensions of a mechanism, as deep as they go; curves and skeletons are in the JSON. @param {any} design */
export function dimensions(design) {
  /** @type {[string, any][]} */
  const rows = [];
  const walk = (/** @type {string} */ name, /** @type {any} */ value) => {
    if (Array.isArray(value)) {
      if (!value.length) return;
      if (value.length <= 4 && value.every((one) => typeof one === "number")) rows.push([name, value.map(shown).join(", ")]);
      else if (value.length <= 8 && value.every((one) => typeof one === "object")) value.forEach((one, k) => walk(`${name} ${k + 1}`, one));
    } else if (value && typeof value === "object") {
      for (const [inner, one] of Object.entries(value)) walk(name ? `${name} ${inner}` : inner, one);
    } else if (value !== null) rows.push([name, value]);
  };
  for (const [name, value] of Object.entries(design.mechanism)) if (!["type", "skeleton", "profile", "pitch_curve", "program", "outer_wall"].includes(name)) walk(name, value);
  return table("Dimensions", rows);
}
