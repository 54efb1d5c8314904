/** Collect the quantities that all designs of an answer have, as axes and bounds. */

import { toWords } from "../core/dom.js";
import { formatBriefly, isExact, listFigures, metricUnit } from "../design/design_metrics.js";
import * as api from "../core/api.js";
import { t, term } from "../core/messages.js";
import { unitSymbol } from "../core/units.js";

/** @import { Design, Problem, Schemas } from "../types/values.js" */

/**
 * A quantity of all designs.
 * @typedef {object} Quantity
 * @property {string} name name in the answer; checks have the prefix `check:`
 * @property {string} text
 * @property {string} unit
 * @property {(number | null)[]} values one for each design; misses within rounding are 0
 * @property {boolean} more whether larger is better
 */

/** Quantities for which larger is better; for all others smaller is. */
const MORE_IS_BETTER = /^(quality|yield|min_.*|.*efficiency|.*_share|locking_angle|transmission_angle)$/;

/** @param {Design[]} designs @param {Problem} problem @returns {Quantity[]} the most important first */
export function collectQuantities(designs, problem) {
  const names = [
    ...new Set(
      designs.flatMap((design) =>
        listFigures(design)
          .filter(([, value]) => typeof value === "number")
          .map(([name]) => name),
      ),
    ),
  ];
  const sizes = designs.map((design) => design.metrics?.size);
  const found = names.map((name) =>
    createQuantity(
      name,
      toWords(name),
      metricUnit(name, problem),
      designs.map((design, n) =>
        clearRounding(
          name,
          /** @type {Record<string, unknown>} */ (design.metrics ?? {})[name],
          api.metricDimensions(problem.kind)[name],
          sizes[n],
        ),
      ),
    ),
  );
  for (const check of collectChecks(designs)) {
    const values = designs.map((design, n) => {
      const one = (design.verification?.checks ?? []).find((other) => other.name === check.name);
      return clearRounding(check.name, one?.value, check.dimension ?? undefined, sizes[n]);
    });
    const told = found.some((one) => one.values.every((value, n) => value === values[n]));
    if (!told && valuesDiffer(values))
      found.push(
        createQuantity(
          `check:${check.name}`,
          t`Check: ${term(check.name)}`,
          unitSymbol(check.dimension ?? undefined, problem),
          values,
        ),
      );
  }
  // A quantity that is equal for all designs is no choice.
  return [...found.filter((one) => valuesDiffer(one.values)), ...found.filter((one) => !valuesDiffer(one.values))];
}

/**
 * @param {string} name
 * @param {string} text
 * @param {string} unit
 * @param {(number | null)[]} values
 * @returns {Quantity}
 */
function createQuantity(name, text, unit, values) {
  return { name, text, unit, values, more: MORE_IS_BETTER.test(name.replace("check:", "")) };
}

/** Collect each check that has a value, once. @param {Design[]} designs @returns {Schemas["Check"][]} */
function collectChecks(designs) {
  const all = designs
    .flatMap((design) => design.verification?.checks ?? [])
    .filter((one) => typeof one.value === "number");
  return all.filter((one, k) => all.findIndex((other) => other.name === one.name) === k);
}

/**
 * @param {string} name
 * @param {unknown} value
 * @param {string | undefined} dimension
 * @param {number | undefined} size
 * @returns {number | null}
 */
function clearRounding(name, value, dimension, size) {
  if (typeof value !== "number" || !Number.isFinite(value)) return null;
  return isExact(name, value, dimension, size) ? 0 : value;
}

/** Return true if the values vary. @param {(number | null)[]} values */
export function valuesDiffer(values) {
  const [low, high] = valueRange(values);
  return high - low > 1e-9 * Math.max(Math.abs(low), Math.abs(high));
}

/**
 * Return the minimum and the maximum of the known values.
 * @param {(number | null)[]} values
 * @returns {[number, number]}
 */
export function valueRange(values) {
  const known = values.filter((one) => one !== null);
  return known.length ? [known.reduce((a, b) => Math.min(a, b)), known.reduce((a, b) => Math.max(a, b))] : [0, 0];
}

/** Format a value with its unit, with three digits. @param {Quantity} quantity @param {number} value */
export function formatQuantity({ unit }, value) {
  return `${formatBriefly(value)}${unit === "" || unit === "°" ? unit : ` ${unit}`}`;
}

/** Return the name of a quantity with its unit. @param {Quantity} quantity */
export function quantityTitle({ text, unit }) {
  return unit ? `${text} (${unit})` : text;
}
