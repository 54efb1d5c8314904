/** The numbers of a design: its metrics, its dimensions, and the checks that it has passed. */

import * as api from "./api.js";
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

/** @param {any} value @param {string} [unit] beside a number */
export function text(value, unit = "") {
  return typeof value === "number" ? beside(shown(value), unit) : typeof value === "boolean" ? (value ? "yes" : "no") : words(String(value));
}

/** The unit of a number of a design by its name; empty for a pure number. @param {string} name @param {any} problem */
export function unitFor(name, problem) {
  return symbolOf(api.measures(problem.kind)[name], problem);
}

/** @param {string} number @param {string} unit */
function beside(number, unit) {
  return `${number}${unit === "" || unit === "°" ? unit : ` ${unit}`}`;
}

/** A number of a check with the unit of what the check measures. @param {number} value @param {any} check @param {any} problem */
export function amount(value, check, problem) {
  return beside(shown(value), symbolOf(check.dimension, problem));
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

/** @param {string} title @param {[string, any][]} rows @param {any} [problem] whose units stand beside the numbers */
export function table(title, rows, problem = null) {
  const unit = (/** @type {string} */ name) => (problem ? unitFor(name, problem) : "");
  return el("section", {}, el("h4", {}, title), el("table", { class: "figures" }, el("tbody", {},
    ...rows.map(([name, value]) => el("tr", {}, el("th", { scope: "row" }, words(name)), el("td", {}, text(value, unit(name))))))));
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

/** The dimensions of a mechanism, as deep as they go; curves and skeletons are in the JSON. @param {any} design @param {any} problem */
export function dimensions(design, problem) {
  /** @type {[string, any][]} */
  const rows = [];
  const walk = (/** @type {string} */ name, /** @type {any} */ value, /** @type {string} */ unit) => {
    if (Array.isArray(value)) {
      if (!value.length) return;
      if (value.length <= 4 && value.every((one) => typeof one === "number")) rows.push([name, beside(value.map(shown).join(", "), unit)]);
      else if (value.length <= 8 && value.every((one) => typeof one === "object")) value.forEach((one, k) => walk(`${name} ${k + 1}`, one, unit));
    } else if (value && typeof value === "object") {
      for (const [inner, one] of Object.entries(value)) walk(name ? `${name} ${inner}` : inner, one, unitFor(inner, problem) || unit);
    } else if (value !== null) rows.push([name, text(value, unit)]);
  };
  for (const [name, value] of Object.entries(design.mechanism)) if (!["type", "skeleton", "profile", "pitch_curve", "program", "outer_wall"].includes(name)) walk(name, value, unitFor(name, problem));
  return table("Dimensions", rows);
}
