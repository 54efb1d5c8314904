/** The numbers that the designs of an answer have in common: what they are chosen by. */

import { words } from "../core/dom.js";
import { brief, exact, figures, unitFor } from "../design/design_metrics.js";
import * as api from "../core/api.js";
import { t, term } from "../core/messages.js";
import { symbolOf } from "../core/units.js";

/** @import { Design, Problem, Schemas } from "../types/values.js" */

/**
 * A quantity of all designs.
 * @typedef {object} Quantity
 * @property {string} name as the answer has it; of a check with `check:` before it
 * @property {string} text
 * @property {string} unit
 * @property {(number | null)[]} values one for each design; what only misses by rounding is 0
 * @property {boolean} more whether more of it is better
 */

/** Of what more is better; of all else less is. */
const MORE = /^(quality|yield|min_.*|.*efficiency|.*_share|locking_angle|transmission_angle)$/;

/** @param {Design[]} designs @param {Problem} problem @returns {Quantity[]} the telling ones first */
export function quantities(designs, problem) {
  const names = [
    ...new Set(
      designs.flatMap((design) =>
        figures(design)
          .filter(([, value]) => typeof value === "number")
          .map(([name]) => name),
      ),
    ),
  ];
  const sizes = designs.map((design) => design.metrics?.size);
  const found = names.map((name) =>
    made(
      name,
      words(name),
      unitFor(name, problem),
      designs.map((design, n) =>
        plain(
          name,
          /** @type {Record<string, unknown>} */ (design.metrics ?? {})[name],
          api.measures(problem.kind)[name],
          sizes[n],
        ),
      ),
    ),
  );
  for (const check of checksOf(designs)) {
    const values = designs.map((design, n) => {
      const one = (design.verification?.checks ?? []).find((other) => other.name === check.name);
      return plain(check.name, one?.value, check.dimension ?? undefined, sizes[n]);
    });
    const told = found.some((one) => one.values.every((value, n) => value === values[n]));
    if (!told && differ(values))
      found.push(
        made(
          `check:${check.name}`,
          t`Check: ${term(check.name)}`,
          symbolOf(check.dimension ?? undefined, problem),
          values,
        ),
      );
  }
  // What all have alike is no choice.
  return [...found.filter((one) => differ(one.values)), ...found.filter((one) => !differ(one.values))];
}

/**
 * @param {string} name
 * @param {string} text
 * @param {string} unit
 * @param {(number | null)[]} values
 * @returns {Quantity}
 */
function made(name, text, unit, values) {
  return { name, text, unit, values, more: MORE.test(name.replace("check:", "")) };
}

/** Every check with a number, once. @param {Design[]} designs @returns {Schemas["Check"][]} */
function checksOf(designs) {
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
function plain(name, value, dimension, size) {
  if (typeof value !== "number" || !Number.isFinite(value)) return null;
  return exact(name, value, dimension, size) ? 0 : value;
}

/** Whether there is a choice at all. @param {(number | null)[]} values */
export function differ(values) {
  const [low, high] = range(values);
  return high - low > 1e-9 * Math.max(Math.abs(low), Math.abs(high));
}

/** Least and greatest of those that are known. @param {(number | null)[]} values @returns {[number, number]} */
export function range(values) {
  const known = values.filter((one) => one !== null);
  return known.length ? [known.reduce((a, b) => Math.min(a, b)), known.reduce((a, b) => Math.max(a, b))] : [0, 0];
}

/** A number with its unit, three digits. @param {Quantity} quantity @param {number} value */
export function told({ unit }, value) {
  return `${brief(value)}${unit === "" || unit === "°" ? unit : ` ${unit}`}`;
}

/** Its name with its unit. @param {Quantity} quantity */
export function titled({ text, unit }) {
  return unit ? `${text} (${unit})` : text;
}
