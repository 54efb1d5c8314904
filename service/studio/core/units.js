/** Return unit symbols of dimensions: schemas give them as `x-dimension`, checks as `dimension`. */

/** @import { Problem } from "../types/values.js" */

/** @param {Problem} problem */
function unitSymbols(problem) {
  const length = problem.length_unit ?? "mm";
  const arm = problem.kind === "indexing" || String(problem.follower?.type ?? "").startsWith("oscillating");
  const slides =
    problem.mechanism === "slider_crank" ||
    (typeof problem.output === "object" && problem.output?.type === "slider") ||
    (problem.stroke ?? null) !== null;
  const way = slides ? length : "rad";
  const [lift, rate] = arm ? ["°", "rad"] : [length, length];
  const inches = length === "in";
  // Masses and loads have units of their own, except those of cams.
  const own = problem.kind === "cam" ? null : (problem.dynamics?.units ?? problem.units ?? "si");
  const force = inches && own === null ? "lbf" : "N";
  const forces =
    own === "consistent"
      ? {}
      : {
          force,
          stiffness: own === null ? `${force}/${length}` : "N/m",
          mass: inches && own === null ? "lbf·s²/in" : "kg",
          torque: own === null ? `${force}·${length}` : "N·m",
          power: "W",
          density: "kg/m³",
          inertia: "kg·m²",
          "torsion stiffness": "N·m/rad",
          gravity: "m/s²",
          unbalance: "g·mm",
          speed: "m/s",
          energy: "J",
        };
  return /** @type {Record<string, string>} */ ({
    length,
    area: `${length}²`,
    "inverse length": `1/${length}`,
    angle: "°",
    displacement: lift,
    velocity: `${rate}/rad`,
    acceleration: `${rate}/rad²`,
    jerk: `${rate}/rad³`,
    "acceleration squared": `${rate}²/rad³`,
    output: slides ? length : "°",
    "output per radian": `${way}/rad`,
    "output per radian squared": `${way}/rad²`,
    "length per radian": `${length}/rad`,
    "angle per length": `°/${length}`,
    "radian frequency": "rad/s",
    "rotational speed": "1/min",
    percent: "%",
    "balance grade": "mm/s",
    ...forces,
  });
}

/**
 * Return the unit of a dimension, or an empty string.
 * @param {string | undefined} dimension
 * @param {Problem} problem
 */
export function unitSymbol(dimension, problem) {
  return dimension === undefined ? "" : (unitSymbols(problem)[dimension] ?? "");
}

/**
 * Return the unit of a field, or an empty string for a pure number.
 * @param {import("./schema.js").Schema} schema
 * @param {Problem} problem
 */
export function fieldUnit(schema, problem) {
  return unitSymbol(schema["x-dimension"], problem);
}
