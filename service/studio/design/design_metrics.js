/** The numbers of a design: its metrics, its dimensions, and the checks that it has passed. */

import * as api from "../core/api.js";
import { el, shown, words } from "../core/dom.js";
import { BETWEEN, number, t, term, translated } from "../core/messages.js";
import { symbolOf } from "../core/units.js";

/** @import { Design, Problem, Schemas } from "../types/values.js" */

/** What a card shows first of a design's metrics, where the design has it. */
const FIRST = [
  "quality",
  "min_transmission_angle",
  "rms_residual",
  "structural_error",
  "max_error",
  "ratio_error",
  "error",
  "link_ratio",
  "size",
  "input_travel",
  "body_travel_ratio",
  "body_turn_ratio",
  "total_teeth",
  "efficiency",
  "prime_radius",
  "max_pressure_angle",
  "drive",
];

/** What is measured against something else: of that rounding leaves it this much, which is nothing. */
const AGAINST = /** @type {Record<string, string>} */ ({
  drive: "unbalanced_drive",
  rms_drive: "unbalanced_rms_drive",
  entry_speed: "peak_velocity",
});

/**
 * The metrics that are plain numbers or words, the telling ones first.
 * @param {Partial<Design>} design
 * @returns {[string, string | number | boolean][]}
 */
export function figures(design) {
  const metrics = /** @type {Record<string, unknown>} */ (design.metrics ?? {});
  const all = Object.entries(metrics).flatMap(([name, value]) => {
    if (typeof value !== "number" && typeof value !== "string" && typeof value !== "boolean") return [];
    const nil = typeof value === "number" && nothing(value, Number(metrics[AGAINST[name]]));
    return [/** @type {[string, string | number | boolean]} */ ([name, nil ? 0 : value])];
  });
  const rank = (/** @type {string} */ name) => (FIRST.includes(name) ? FIRST.indexOf(name) : FIRST.length);
  return all.sort(([a], [b]) => rank(a) - rank(b));
}

/**
 * Digits of a number for reading, where it is no dimension that is made; all of them are told where the pointer rests.
 */
const DIGITS = 3;

/** What only misses something by rounding, of its size. */
const ROUNDING = 1e-9;

/** Names of what measures by how much something is missed. */
const MISSES = new RegExp(
  "^(reaches|meets|keeps|reproduces)_|(residual|error)$" +
    "|^(dials|ratio|rotation|value|sum_of_squares|(rms|max|curve)_distance)$",
);

/** A limit of a check that is no demand: it bounds what rounding may leave. */
const TOLERANCE = 1e-6;

/** What has no scale of its own, so that it says by itself whether it is rounding alone. */
const BARE = [undefined, "angle", "percent"];

/** A number for reading, with few digits: a whole one has all of its digits. @param {number} value */
export function brief(value) {
  if (!Number.isFinite(value) || Number.isInteger(value)) return shown(value);
  return shown(Math.abs(value) >= 10 ** DIGITS ? Math.round(value) : Number(value.toPrecision(DIGITS)));
}

/** Whether what is left of something is but the rounding of the computer. @param {number} left @param {number} of */
export function nothing(left, of) {
  return Math.abs(left) <= ROUNDING * Math.abs(of);
}

/**
 * Whether a number says that nothing is missed, but for the rounding of the computer.
 * @param {string} name
 * @param {unknown} value
 * @param {string | undefined} dimension
 * @param {number} [size] of the mechanism, where lengths are asked for
 */
export function exact(name, value, dimension, size = 0) {
  if (typeof value !== "number" || !MISSES.test(name)) return false;
  const whole = ROUNDING * size;
  const least = BARE.includes(dimension) ? ROUNDING : ({ length: whole, area: whole * whole }[dimension ?? ""] ?? 0);
  return least > 0 && Math.abs(value) <= least;
}

/**
 * A figure of a design: few digits, `exact` where nothing is missed, and all of its digits where the pointer rests.
 * @param {string} name
 * @param {unknown} value
 * @param {Problem | null} problem whose units stand beside it
 * @param {number} [size] of the mechanism
 * @returns {{text: string, title: string | null}}
 */
export function figure(name, value, problem, size) {
  const unit = problem ? unitFor(name, problem) : "";
  if (typeof value !== "number") return { text: text(value), title: null };
  const plain = problem && exact(name, value, api.measures(problem.kind)[name], size);
  return { text: plain ? t`exact` : beside(brief(value), unit), title: beside(number(value), unit) };
}

/** The type of a design as a person reads it. @param {Partial<Design>} design */
export function typeOf({ mechanism, springs }) {
  if (mechanism?.type !== "skeleton") return words(String(mechanism?.type));
  return springs?.length ? t`Sprung linkage` : t`Linkage`;
}

/** What is written short. @type {Record<string, string>} */
const SHORT = { cw: t`clockwise`, ccw: t`counterclockwise` };

/** @param {unknown} value @param {string} [unit] beside a number */
export function text(value, unit = "") {
  if (typeof value === "string" && value in SHORT) return SHORT[value];
  return typeof value === "number"
    ? beside(shown(value), unit)
    : typeof value === "boolean"
      ? value
        ? t`yes`
        : t`no`
      : words(String(value));
}

/**
 * The unit of a number of a design by its name; empty for a pure number.
 * @param {string} name
 * @param {Problem} problem
 */
export function unitFor(name, problem) {
  return symbolOf(api.measures(problem.kind)[name], problem);
}

/** A number with its unit. @param {string} number @param {string} unit */
export function beside(number, unit) {
  return `${number}${unit === "" || unit === "°" ? unit : ` ${unit}`}`;
}

/**
 * A number of a check with the unit of what the check measures.
 * @param {number} value
 * @param {Pick<Schemas["Check"], "dimension">} check
 * @param {Problem} problem
 */
export function amount(value, check, problem) {
  return beside(shown(value), symbolOf(check.dimension ?? undefined, problem));
}

/**
 * Value and limit of a check; with as many digits as it takes to tell the two apart.
 * @param {Schemas["Check"]} check
 * @param {Problem} problem
 */
function measured(check, problem) {
  const { name, passed, dimension } = check;
  const value = Number(check.value);
  const unit = symbolOf(dimension ?? undefined, problem);
  const limit = typeof check.limit === "number" ? check.limit : null;
  const rounded = limit !== null && Math.abs(limit) <= TOLERANCE && Math.abs(value) <= ROUNDING;
  const close = !passed || (limit !== null && brief(value) === brief(limit));
  const told = (/** @type {(value: number) => string} */ as) =>
    `${beside(as(value), unit)}${limit === null ? "" : `, ${t`limit ${beside(as(limit), unit)}`}`}`;
  return el(
    "span",
    { class: "note", title: told(number) },
    passed && (exact(name, value, dimension ?? undefined) || rounded)
      ? ` ${t`exact`}`
      : ` ${told(close ? shown : brief)}`,
  );
}

/** @param {Partial<Design>} design @param {Problem} problem */
export function checks(design, problem) {
  return el(
    "section",
    {},
    el("h4", {}, t`Checks`),
    el(
      "ul",
      { class: "checks" },
      ...(design.verification?.checks ?? []).map((check) =>
        el(
          "li",
          { class: check.passed ? "good" : "bad" },
          el("span", {}, check.passed ? "✓ " : "✗ "),
          words(check.name),
          typeof check.value === "number" && measured(check, problem),
          el("span", { class: "hidden" }, " ", check.passed ? t`passed` : t`failed`),
        ),
      ),
    ),
  );
}

/**
 * @param {string} title
 * @param {[string, unknown][]} rows
 * @param {Problem | null} [problem] whose units stand beside the numbers
 */
export function table(title, rows, problem = null) {
  const size = Number(rows.find(([name]) => name === "size")?.[1]) || undefined;
  return rowed(
    title,
    rows.map(([name, value]) => [name, figure(name, value, problem, size)]),
  );
}

/** @param {string} title @param {[string, {text: string, title: string | null}][]} rows */
function rowed(title, rows) {
  return el(
    "section",
    {},
    el("h4", {}, title),
    el(
      "table",
      { class: "figures" },
      el(
        "tbody",
        {},
        ...rows.map(([name, told]) =>
          el("tr", {}, el("th", { scope: "row" }, words(name)), el("td", { title: told.title }, told.text)),
        ),
      ),
    ),
  );
}

/**
 * What becomes of a design as a shop makes it: nothing where the problem does not ask.
 * @param {Partial<Design>} design
 * @param {Problem} problem whose units stand beside the numbers
 * @returns {HTMLElement[]}
 */
export function made(design, problem) {
  const told = design.manufacture;
  if (!told) return [];
  const share = design.metrics?.yield;
  const { worst_case: worst, cost } = told;
  const [length, angle] = [symbolOf("length", problem), symbolOf("angle", problem)];
  /** @type {[string, unknown, string?][]} */
  const rows = [
    [t`yield`, share?.value],
    [t`yield, at least`, share?.low],
    [t`yield, at most`, share?.high],
    [t`worst error`, worst?.max_error, length],
    [t`worst angle error`, worst?.max_angle_error, angle],
    [t`tolerances that matter`, told.matter?.join(", ") || undefined],
    [t`rounding cost, rms residual`, cost?.rms_residual],
    [t`rounding cost, error`, cost?.max_error, length],
    [t`remark`, translated(told.remark ?? "") || undefined],
    ...Object.entries(told.dimensions ?? {}).map(
      ([name, value]) =>
        /** @type {[string, unknown, string]} */ ([t`made: ${name.split(".").map(term).join(" ")}`, value, length]),
    ),
  ];
  const stated = rows.filter(([, value]) => value !== undefined && value !== null);
  return [
    rowed(
      t`As it is made`,
      stated.map(([name, value, unit = ""]) => [
        name,
        typeof value === "number"
          ? { text: beside(brief(value), unit), title: beside(number(value), unit) }
          : { text: text(value), title: null },
      ]),
    ),
  ];
}

/**
 * The dimensions of a mechanism, as they are made, as deep as they go; curves and skeletons are in the JSON.
 * @param {Partial<Design>} design
 * @param {Problem} problem
 */
export function dimensions(design, problem) {
  const rows = dimensionRows(design, problem);
  return rows.length > 0 && rowed(t`Dimensions`, rows);
}

/**
 * Names and values of the dimensions.
 * @param {Partial<Design>} design
 * @param {Problem} problem
 * @returns {[string, {text: string, title: string | null}][]}
 */
export function dimensionRows(design, problem) {
  /** @type {[string, {text: string, title: string | null}][]} */
  const rows = [];
  const row = (/** @type {string} */ name, /** @type {number[]} */ all, /** @type {string} */ unit) =>
    rows.push([
      name,
      { text: beside(all.map(shown).join(BETWEEN), unit), title: beside(all.map(number).join(BETWEEN), unit) },
    ]);
  const walk = (/** @type {string} */ name, /** @type {unknown} */ value, /** @type {string} */ unit) => {
    if (Array.isArray(value)) {
      if (!value.length) return;
      if (value.length <= 4 && value.every((one) => typeof one === "number")) row(name, value, unit);
      else if (value.length <= 8 && value.every((one) => typeof one === "object"))
        value.forEach((one, k) => walk(`${name} ${k + 1}`, one, unit));
    } else if (value && typeof value === "object") {
      for (const [inner, one] of Object.entries(value))
        walk(name ? `${name} ${term(inner)}` : term(inner), one, unitFor(inner, problem) || unit);
    } else if (typeof value === "number") row(name, [value], unit);
    else if (value !== null) rows.push([name, { text: text(value), title: null }]);
  };
  // Springs are numbered as they stand.
  walk(
    t`spring`,
    (design.springs ?? []).map(({ number: _, ...spring }) => spring),
    "",
  );
  for (const [name, value] of Object.entries(design.mechanism ?? {}))
    if (!["type", "skeleton", "profile", "pitch_curve", "program", "outer_wall"].includes(name))
      walk(term(name), value, unitFor(name, problem));
  return rows;
}
