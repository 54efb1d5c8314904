/** Format the metrics, dimensions and checks of a design. */

import * as api from "../core/api.js";
import { createElement, formatNumber, toWords } from "../core/dom.js";
import { LIST_SEPARATOR, localizeNumber, t, term } from "../core/messages.js";
import { unitSymbol } from "../core/units.js";

/** @import { Design, Problem, Schemas } from "../types/values.js" */

/** Metrics that a card shows first. */
const LEADING_METRICS = [
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
const ROUNDING_RESIDUES = /** @type {Record<string, string>} */ ({
  drive: "unbalanced_drive",
  rms_drive: "unbalanced_rms_drive",
  entry_speed: "peak_velocity",
});

/**
 * The metrics that are plain numbers or words, the most important first.
 * @param {Partial<Design>} design
 * @returns {[string, string | number | boolean][]}
 */
export function listFigures(design) {
  const metrics = /** @type {Record<string, unknown>} */ (design.metrics ?? {});
  const all = Object.entries(metrics).flatMap(([name, value]) => {
    if (typeof value !== "number" && typeof value !== "string" && typeof value !== "boolean") return [];
    const nil = typeof value === "number" && isRounding(value, Number(metrics[ROUNDING_RESIDUES[name]]));
    return [/** @type {[string, string | number | boolean]} */ ([name, nil ? 0 : value])];
  });
  const rank = (/** @type {string} */ name) =>
    LEADING_METRICS.includes(name) ? LEADING_METRICS.indexOf(name) : LEADING_METRICS.length;
  return all.sort(([a], [b]) => rank(a) - rank(b));
}

/**
 * Digits shown of a number that is not a dimension to be made; all digits are shown under the pointer.
 */
const DIGITS = 3;

/** What only misses something by rounding, of its size. */
const ROUNDING_TOLERANCE = 1e-9;

/** Names of what measures by how much something is missed. */
const MISS_PATTERN = new RegExp(
  "^(reaches|meets|keeps|reproduces)_|(residual|error)$" +
    "|^(dials|ratio|rotation|value|sum_of_squares|(rms|max|curve)_distance)$",
);

/** A limit of a check that is no demand: it bounds what rounding may leave. */
const MAX_TOLERANCE = 1e-6;

/** What has no scale of its own, so that it says by itself whether it is rounding alone. */
const SCALE_FREE = [undefined, "angle", "percent"];

/** A number for reading, with few digits: a whole one has all of its digits. @param {number} value */
export function formatBriefly(value) {
  if (!Number.isFinite(value) || Number.isInteger(value)) return formatNumber(value);
  return formatNumber(Math.abs(value) >= 10 ** DIGITS ? Math.round(value) : Number(value.toPrecision(DIGITS)));
}

/** Whether what is left of something is but the rounding of the computer. @param {number} left @param {number} of */
export function isRounding(left, of) {
  return Math.abs(left) <= ROUNDING_TOLERANCE * Math.abs(of);
}

/**
 * Whether a number says that nothing is missed, but for the rounding of the computer.
 * @param {string} name
 * @param {unknown} value
 * @param {string | undefined} dimension
 * @param {number} [size] of the mechanism, for lengths
 */
export function isExact(name, value, dimension, size = 0) {
  if (typeof value !== "number" || !MISS_PATTERN.test(name)) return false;
  const whole = ROUNDING_TOLERANCE * size;
  const least = SCALE_FREE.includes(dimension)
    ? ROUNDING_TOLERANCE
    : ({ length: whole, area: whole * whole }[dimension ?? ""] ?? 0);
  return least > 0 && Math.abs(value) <= least;
}

/**
 * A figure of a design: few digits, `exact` for an error of zero, and all digits under the pointer.
 * @param {string} name
 * @param {unknown} value
 * @param {Problem | null} problem whose units are shown with it
 * @param {number} [size] of the mechanism
 * @returns {{text: string, title: string | null}}
 */
export function formatFigure(name, value, problem, size) {
  const unit = problem ? metricUnit(name, problem) : "";
  if (typeof value !== "number") return { text: formatWithUnit(value), title: null };
  const plain = problem && isExact(name, value, api.metricDimensions(problem.kind)[name], size);
  return {
    text: plain ? t`exact` : joinUnit(formatBriefly(value), unit),
    title: joinUnit(localizeNumber(value), unit),
  };
}

/** The type of a design as a person reads it. @param {Partial<Design>} design */
export function typeName({ mechanism, springs }) {
  if (mechanism?.type !== "skeleton") return toWords(String(mechanism?.type));
  return springs?.length ? t`Sprung linkage` : t`Linkage`;
}

/** What is written short. @type {Record<string, string>} */
const ABBREVIATIONS = { cw: t`clockwise`, ccw: t`counterclockwise` };

/** @param {unknown} value @param {string} [unit] shown after a number */
export function formatWithUnit(value, unit = "") {
  if (typeof value === "string" && value in ABBREVIATIONS) return ABBREVIATIONS[value];
  return typeof value === "number"
    ? joinUnit(formatNumber(value), unit)
    : typeof value === "boolean"
      ? value
        ? t`yes`
        : t`no`
      : toWords(String(value));
}

/**
 * The unit of a number of a design by its name; empty for a pure number.
 * @param {string} name
 * @param {Problem} problem
 */
export function metricUnit(name, problem) {
  return unitSymbol(api.metricDimensions(problem.kind)[name], problem);
}

/** A number with its unit. @param {string} number @param {string} unit */
export function joinUnit(number, unit) {
  return `${number}${unit === "" || unit === "°" ? unit : ` ${unit}`}`;
}

/**
 * A number of a check with the unit of what the check measures.
 * @param {number} value
 * @param {Pick<Schemas["Check"], "dimension">} check
 * @param {Problem} problem
 */
export function formatAmount(value, check, problem) {
  return joinUnit(formatNumber(value), unitSymbol(check.dimension ?? undefined, problem));
}

/**
 * Value and limit of a check, with enough digits to distinguish them.
 * @param {Schemas["Check"]} check
 * @param {Problem} problem
 */
function formatCheck(check, problem) {
  const { name, passed, dimension } = check;
  const value = Number(check.value);
  const unit = unitSymbol(dimension ?? undefined, problem);
  const limit = typeof check.limit === "number" ? check.limit : null;
  const rounded = limit !== null && Math.abs(limit) <= MAX_TOLERANCE && Math.abs(value) <= ROUNDING_TOLERANCE;
  const close = !passed || (limit !== null && formatBriefly(value) === formatBriefly(limit));
  const told = (/** @type {(value: number) => string} */ as) =>
    `${joinUnit(as(value), unit)}${limit === null ? "" : `, ${t`limit ${joinUnit(as(limit), unit)}`}`}`;
  return createElement(
    "span",
    { class: "note", title: told(localizeNumber) },
    passed && (isExact(name, value, dimension ?? undefined) || rounded)
      ? ` ${t`exact`}`
      : ` ${told(close ? formatNumber : formatBriefly)}`,
  );
}

/** @param {Partial<Design>} design @param {Problem} problem */
export function createChecks(design, problem) {
  return createElement(
    "section",
    {},
    createElement("h4", {}, t`Checks`),
    createElement(
      "ul",
      { class: "checks" },
      ...(design.verification?.checks ?? []).map((check) =>
        createElement(
          "li",
          { class: check.passed ? "good" : "bad" },
          createElement("span", {}, check.passed ? "✓ " : "✗ "),
          toWords(check.name),
          typeof check.value === "number" && formatCheck(check, problem),
          check.detail && createElement("span", { class: "note" }, ` ${check.detail}`),
          createElement("span", { class: "hidden" }, " ", check.passed ? t`passed` : t`failed`),
        ),
      ),
    ),
  );
}

/**
 * @param {string} title
 * @param {[string, unknown][]} rows
 * @param {Problem | null} [problem] whose units are shown with the numbers
 */
export function createTable(title, rows, problem = null) {
  const size = Number(rows.find(([name]) => name === "size")?.[1]) || undefined;
  return createNumberTable(
    title,
    rows.map(([name, value]) => [name, formatFigure(name, value, problem, size)]),
  );
}

/** @param {string} title @param {[string, {text: string, title: string | null}][]} rows */
function createNumberTable(title, rows) {
  return createElement(
    "section",
    {},
    createElement("h4", {}, title),
    createElement(
      "table",
      { class: "figures" },
      createElement(
        "tbody",
        {},
        ...rows.map(([name, told]) =>
          createElement(
            "tr",
            {},
            createElement("th", { scope: "row" }, toWords(name)),
            createElement("td", { title: told.title }, told.text),
          ),
        ),
      ),
    ),
  );
}

/**
 * What becomes of a design as a shop makes it: nothing where the problem does not ask.
 * @param {Partial<Design>} design
 * @param {Problem} problem whose units are shown with the numbers
 * @returns {HTMLElement[]}
 */
export function createTolerances(design, problem) {
  const told = design.manufacture;
  if (!told) return [];
  const share = design.metrics?.yield;
  const { worst_case: worst, cost } = told;
  const [length, angle] = [unitSymbol("length", problem), unitSymbol("angle", problem)];
  /** @type {[string, unknown, string?][]} */
  const rows = [
    [t`yield`, share?.value],
    [t`yield, at least`, share?.low],
    [t`yield, at most`, share?.high],
    [t`largest error`, worst?.max_error, length],
    [t`largest angle error`, worst?.max_angle_error, angle],
    [t`critical tolerances`, told.matter?.join(", ") || undefined],
    [t`error growth by rounding, rms residual`, cost?.rms_residual],
    [t`error growth by rounding`, cost?.max_error, length],
    [t`remark`, told.remark || undefined],
    ...Object.entries(told.dimensions ?? {}).map(
      ([name, value]) =>
        /** @type {[string, unknown, string]} */ ([
          t`manufactured: ${name.split(".").map(term).join(" ")}`,
          value,
          length,
        ]),
    ),
  ];
  const stated = rows.filter(([, value]) => value !== undefined && value !== null);
  return [
    createNumberTable(
      t`As manufactured`,
      stated.map(([name, value, unit = ""]) => [
        name,
        typeof value === "number"
          ? { text: joinUnit(formatBriefly(value), unit), title: joinUnit(localizeNumber(value), unit) }
          : { text: formatWithUnit(value), title: null },
      ]),
    ),
  ];
}

/**
 * The dimensions of a mechanism, as they are made, as deep as they go; curves and skeletons are in the JSON.
 * @param {Partial<Design>} design
 * @param {Problem} problem
 */
export function createDimensions(design, problem) {
  const rows = listDimensions(design, problem);
  return rows.length > 0 && createNumberTable(t`Dimensions`, rows);
}

/**
 * Names and values of the dimensions.
 * @param {Partial<Design>} design
 * @param {Problem} problem
 * @returns {[string, {text: string, title: string | null}][]}
 */
export function listDimensions(design, problem) {
  /** @type {[string, {text: string, title: string | null}][]} */
  const rows = [];
  const row = (/** @type {string} */ name, /** @type {number[]} */ all, /** @type {string} */ unit) =>
    rows.push([
      name,
      {
        text: joinUnit(all.map(formatNumber).join(LIST_SEPARATOR), unit),
        title: joinUnit(all.map(localizeNumber).join(LIST_SEPARATOR), unit),
      },
    ]);
  const walk = (/** @type {string} */ name, /** @type {unknown} */ value, /** @type {string} */ unit) => {
    if (Array.isArray(value)) {
      if (!value.length) return;
      if (value.length <= 4 && value.every((one) => typeof one === "number")) row(name, value, unit);
      else if (value.length <= 8 && value.every((one) => typeof one === "object"))
        value.forEach((one, k) => walk(`${name} ${k + 1}`, one, unit));
    } else if (value && typeof value === "object") {
      for (const [inner, one] of Object.entries(value))
        walk(name ? `${name} ${term(inner)}` : term(inner), one, metricUnit(inner, problem) || unit);
    } else if (typeof value === "number") row(name, [value], unit);
    else if (value !== null) rows.push([name, { text: formatWithUnit(value), title: null }]);
  };
  // Springs are numbered as they stand.
  walk(
    t`spring`,
    (design.springs ?? []).map(({ number: _, ...spring }) => spring),
    "",
  );
  for (const [name, value] of Object.entries(design.mechanism ?? {}))
    if (!["type", "skeleton", "profile", "pitch_curve", "program", "outer_wall"].includes(name))
      walk(term(name), value, metricUnit(name, problem));
  return rows;
}
