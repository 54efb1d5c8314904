/**
 * Find the handles of a problem on the canvas, kind by kind: positions, points, pivots, lines and regions.
 *
 * Handles refer to one problem: they know their path in it, and moving, turning or removing them changes it.
 */

import { t } from "../core/messages.js";
import { readPointer, writePointer } from "../core/pointer.js";
import { smoothCurve, makeSymmetric } from "./curve_shaping.js";

/** @import { Problem, Schemas } from "../types/values.js" */

/** @typedef {[number, number]} Point */

/**
 * @typedef {object} Handle
 * @property {string} name label next to it
 * @property {string} label what it is
 * @property {() => Point} get
 * @property {(x: number, y: number) => void} put
 * @property {{get: () => number, set: (degrees: number) => void}} [turn]
 * @property {() => void} [remove]
 * @property {string} [path] JSON pointer of the object with the fields x, y and angle
 */

/**
 * @typedef {object} Handles
 * @property {Handle[]} handles
 * @property {() => Point[][]} lines drawn between them
 * @property {string} [word] what a double click adds
 * @property {(x: number, y: number) => void} [add]
 * @property {boolean} [freehand] a curve may be drawn
 * @property {{text: string, make: (at: Point, size: number) => void}[]} offers further entries on the canvas
 * @property {{text: string, title: string, make: (fine: (value: number) => number) => void}[]} [shapes] what is done to
 *   a curve as a whole
 */

/** @param {Problem} problem @returns {Handles | null} null for a kind that has no place in the plane */
export function findHandles(problem) {
  /** @type {Record<string, {make(problem: Problem): Handles | null}["make"]>} */
  const makers = {
    motion: motionHandles,
    path: pathHandles,
    quick_return: quickReturnHandles,
    straight_line: straightLineHandles,
    dwell: dwellHandles,
    steering: steeringHandles,
    parallel_motion: parallelMotionHandles,
    function: functionHandles,
  };
  const make = makers[problem.kind];
  const found = make ? make(problem) : null;
  if (found && problem.kind !== "function") addRegionHandles(problem, found);
  return found;
}

/** @param {unknown} value */
const wholeNumber = (value) => Array.isArray(value) && value.length === 2 && value.every(Number.isFinite);

/**
 * Return a handle for a point `[x, y]` of an object.
 * @param {object | null | undefined} owner
 * @param {string} field
 * @param {string} name
 * @param {string} label
 * @param {boolean} [removable]
 * @returns {Handle[]}
 */
function pointHandle(owner, field, name, label, removable = true) {
  if (!owner || !wholeNumber(readPointer(owner, [field]))) return [];
  return [
    {
      name,
      label,
      get: () => /** @type {Point} */ (readPointer(owner, [field])),
      put: (x, y) => writePointer(owner, [field], [x, y]),
      ...(removable ? { remove: () => writePointer(owner, [field], null) } : {}),
    },
  ];
}

/**
 * Return handles for objects with x and y, and with an angle if they turn.
 * @param {{x: number, y: number, angle?: number}[]} list
 * @param {string} field
 * @param {string} word
 * @param {boolean} turning
 * @param {boolean} [fixed] their number is
 */
function listHandles(list, field, word, turning, fixed = false) {
  return list.flatMap((one, k) =>
    Number.isFinite(one?.x) && Number.isFinite(one?.y)
      ? [
          /** @type {Handle} */ ({
            name: String(k + 1),
            label: `${word} ${k + 1}`,
            path: `/problem/${field}/${k}`,
            get: () => [one.x, one.y],
            put: (x, y) => Object.assign(one, { x, y }),
            ...(turning
              ? { turn: { get: () => one.angle ?? 0, set: (/** @type {number} */ angle) => (one.angle = angle) } }
              : {}),
            ...(fixed ? {} : { remove: () => list.splice(list.indexOf(one), 1) }),
          }),
        ]
      : [],
  );
}

/** @param {Schemas["MotionProblem"]} problem @returns {Handles} */
function motionHandles(problem) {
  const { positions } = problem;
  const sides = /** @type {const} */ ([
    ["input_side", "O2", "A"],
    ["output_side", "O4", "B"],
  ]);
  const line = problem.ground_line;
  const chosen = sides.flatMap(([side, fixed, moving]) => [
    ...pointHandle(problem[side], "fixed_pivot", fixed, t`Fixed pivot ${fixed}`),
    ...pointHandle(problem[side], "moving_pivot", moving, t`Moving pivot ${moving} in the first position`),
  ]);
  /** @type {Handle[]} */
  const ground =
    line && wholeNumber(line.point)
      ? [
          {
            name: "ground",
            label: t`Ground line`,
            get: () => line.point,
            put: (x, y) => (line.point = [x, y]),
            turn: { get: () => line.angle, set: (angle) => (line.angle = angle) },
            remove: () => (problem.ground_line = null),
          },
        ]
      : [];
  const offers = sides
    .filter(([side]) => !wholeNumber(problem[side]?.fixed_pivot))
    .map(([side, fixed], k) => ({
      text: t`Choose ${fixed}`,
      make: (/** @type {Point} */ [x, y], /** @type {number} */ size) => {
        problem[side] = { ...problem[side], fixed_pivot: [x + (k ? 0.5 : -0.5) * size, y - 0.6 * size] };
      },
    }));
  return {
    handles: [...listHandles(positions, "positions", t`Position`, true), ...chosen, ...ground],
    word: "position",
    offers,
    lines: () => [
      positions.map((one) => [one.x, one.y]),
      ...(line && ground.length ? [lineThrough(/** @type {Point} */ (line.point), line.angle, 1e4)] : []),
      ...sides.flatMap(([side]) =>
        wholeNumber(problem[side]?.fixed_pivot) && wholeNumber(problem[side]?.moving_pivot)
          ? [/** @type {Point[]} */ ([problem[side]?.fixed_pivot, problem[side]?.moving_pivot])]
          : [],
      ),
    ],
    add: (x, y) => positions.push({ x, y, angle: positions.at(-1)?.angle ?? 0 }),
  };
}

/** @param {Schemas["PathProblem"]} problem @returns {Handles} */
function pathHandles(problem) {
  const pivots = problem.fixed_pivots;
  return {
    handles: [...listHandles(problem.points, "points", t`Point`, false), ...fixedPivotHandles(problem)],
    lines: () => [problem.points.map((one) => [one.x, one.y])],
    word: "point",
    freehand: true,
    shapes: curveTools(problem),
    add: (x, y) => problem.points.push({ x, y }),
    offers: [
      ...(problem.closed && problem.method === "curve_match"
        ? [{ text: t`Leave it free`, make: () => isOpenCurve(problem) }]
        : []),
      pivots
        ? { text: t`Leave the pivots free`, make: () => Object.assign(problem, { fixed_pivots: null }) }
        : {
            text: t`Choose the fixed pivots`,
            make: (/** @type {Point} */ [x, y], /** @type {number} */ size) =>
              (problem.fixed_pivots = {
                input: [x - 0.5 * size, y - 0.7 * size],
                output: [x + 0.5 * size, y - 0.7 * size],
              }),
          },
    ],
  };
}

/** Minimum number of points of a curve. */
const MIN_CURVE_POINTS = 5;

/** List the tools that change the whole curve of a path. @param {Schemas["PathProblem"]} problem */
function curveTools(problem) {
  if (problem.points.length < MIN_CURVE_POINTS) return [];
  const by =
    (/** @type {(points: Point[], closed: boolean) => Point[]} */ shape) =>
    (/** @type {(value: number) => number} */ fine) => {
      const shapes = shape(
        problem.points.map((one) => [one.x, one.y]),
        Boolean(problem.closed),
      );
      problem.points.forEach((one, /** @type {number} */ k) =>
        Object.assign(one, { x: fine(shapes[k][0]), y: fine(shapes[k][1]) }),
      );
    };
  return [
    { text: t`Smooth`, title: t`Make the curve smoother; press again for more`, make: by(smoothCurve) },
    {
      text: t`Symmetric`,
      title: t`Make the curve symmetric about the line that mirrors it best`,
      make: by(makeSymmetric),
    },
  ];
}

/** Return true if the whole curve is matched: it is closed and has no timing. @param {Problem} problem */
export function isMatchedCurve(problem) {
  Object.assign(problem, { closed: true, method: "curve_match" });
  delete problem.timing;
}

/** Return true if the curve is open. @param {Problem} problem */
export function isOpenCurve(problem) {
  delete problem.closed;
  if (problem.method === "curve_match") delete problem.method;
}

/** @param {Schemas["QuickReturnProblem"]} problem @returns {Handles} */
function quickReturnHandles(problem) {
  const offers = [];
  if (!problem.positions) {
    offers.push({
      text: t`Add both limit positions`,
      make: (/** @type {Point} */ [x, y], /** @type {number} */ size) => {
        // Limit positions define the swing; a swing or a stroke would be redundant.
        Object.assign(problem, {
          swing: null,
          stroke: null,
          positions: [
            { x, y, angle: 0 },
            { x: x + size, y: y + 0.3 * size, angle: 50 },
          ],
        });
      },
    });
  }
  if (problem.positions && !wholeNumber(problem.rotopole))
    offers.push({
      text: t`Choose the rocker's pivot`,
      make: (/** @type {Point} */ [x, y], /** @type {number} */ size) => (problem.rotopole = [x, y + size]),
    });
  if (!problem.positions && !wholeNumber(problem.crank_pivot))
    offers.push({
      text: t`Choose the crank's pivot`,
      make: (/** @type {Point} */ [x, y]) => (problem.crank_pivot = [x, y]),
    });
  const crank = pointHandle(problem, "crank_pivot", "O2", t`Fixed pivot O2 of the crank`);
  for (const one of crank)
    one.turn = { get: () => problem.ground_angle ?? 0, set: (angle) => (problem.ground_angle = angle) };
  return {
    handles: [
      ...listHandles(problem.positions ?? [], "positions", t`Limit position`, true, true),
      ...pointHandle(problem, "rotopole", "O4", t`Pivot of the rocker`),
      ...crank,
    ],
    lines: () => (problem.positions ? [problem.positions.map((one) => [one.x, one.y])] : []),
    offers: problem.positions
      ? [
          ...offers,
          {
            text: t`Leave the positions free`,
            make: () => Object.assign(problem, { positions: null, rotopole: null, swing: 45 }),
          },
        ]
      : offers,
  };
}

/** @param {Schemas["StraightLineProblem"]} problem @returns {Handles} */
function straightLineHandles(problem) {
  const start = () => /** @type {Point} */ (problem.start ?? [0, 0]);
  const end = () => {
    const [x, y] = start();
    const angle = ((problem.direction ?? 0) * Math.PI) / 180;
    return /** @type {Point} */ ([x + problem.length * Math.cos(angle), y + problem.length * Math.sin(angle)]);
  };
  return {
    offers: [],
    lines: () => [[start(), end()]],
    handles: [
      { name: "start", label: t`Start of the line`, get: start, put: (x, y) => (problem.start = [x, y]) },
      {
        name: "end",
        label: t`End of the line`,
        get: end,
        put: (x, y) => {
          const [dx, dy] = [x - start()[0], y - start()[1]];
          if (!Math.hypot(dx, dy)) return;
          Object.assign(problem, {
            length: Number(Math.hypot(dx, dy).toPrecision(6)),
            direction: Number(((Math.atan2(dy, dx) * 180) / Math.PI).toFixed(2)),
          });
        },
      },
    ],
  };
}

/** @param {Schemas["DwellProblem"]} problem @returns {Handles} */
function dwellHandles(problem) {
  const get = () => /** @type {Point} */ (problem.pivot ?? [0, 0]);
  const crank = () => problem.crank ?? 10;
  return {
    offers: [],
    lines: () => [circlePath(get(), crank())],
    handles: [
      { name: "O2", label: t`Fixed pivot O2 of the crank`, get, put: (x, y) => (problem.pivot = [x, y]) },
      ...(problem.crank
        ? [
            /** @type {Handle} */ ({
              name: "crank",
              label: t`Length of the crank`,
              get: () => [get()[0] + crank(), get()[1]],
              put: (x, y) =>
                (problem.crank = Number(Math.hypot(x - get()[0], y - get()[1]).toPrecision(6)) || problem.crank),
            }),
          ]
        : []),
    ],
  };
}

/**
 * Return the handles of a car seen from above: kingpins in front, rear axle behind.
 * @param {Schemas["SteeringProblem"]} problem
 * @returns {Handles}
 */
function steeringHandles(problem) {
  const half = () => problem.pivot_distance / 2;
  const digits = (/** @type {number} */ value) => Number(Math.max(value, 1e-6).toPrecision(6));
  const track = () => (problem.track ?? problem.pivot_distance) / 2;
  return {
    offers: problem.track
      ? []
      : [{ text: t`Add the track`, make: () => (problem.track = digits(1.2 * problem.pivot_distance)) }],
    lines: () => [
      [
        [-half(), 0],
        [half(), 0],
      ],
      [
        [0, 0],
        [0, -problem.wheelbase],
      ],
      [
        [-track(), -problem.wheelbase],
        [track(), -problem.wheelbase],
      ],
    ],
    handles: [
      {
        name: "kingpin",
        label: t`Kingpin`,
        get: () => [half(), 0],
        put: (x) => (problem.pivot_distance = digits(2 * Math.abs(x))),
      },
      {
        name: t`rear axle`,
        label: t`Rear axle`,
        get: () => [0, -problem.wheelbase],
        put: (_, y) => (problem.wheelbase = digits(-y)),
      },
      ...(problem.track
        ? [
            /** @type {Handle} */ ({
              name: "wheel",
              label: t`Rear wheel`,
              get: () => [track(), -problem.wheelbase],
              put: (x) => (problem.track = digits(2 * Math.abs(x))),
              remove: () => (problem.track = null),
            }),
          ]
        : []),
    ],
  };
}

/**
 * Return handles for the joints of the fourbar whose curve is followed.
 * @param {Schemas["ParallelMotionProblem"]} problem
 * @returns {Handles | null}
 */
function parallelMotionHandles(problem) {
  const { linkage } = problem;
  if (!linkage) return null;
  const joints = assembleFourbar(linkage);
  if (!joints) return null;
  const restate = () => {
    const { O2, O4, A, B, P } = joints;
    const far = (/** @type {Point} */ [x, y], /** @type {Point} */ [u, v]) =>
      Number(Math.max(Math.hypot(u - x, v - y), 1e-9).toPrecision(9));
    const heading = (/** @type {Point} */ [x, y], /** @type {Point} */ [u, v]) =>
      (Math.atan2(v - y, u - x) * 180) / Math.PI;
    const cross = (O4[0] - A[0]) * (B[1] - A[1]) - (O4[1] - A[1]) * (B[0] - A[0]);
    Object.assign(linkage, {
      fixed_pivots: { input: O2, output: O4 },
      links: { input: far(O2, A), coupler: far(A, B), output: far(O4, B) },
      coupler_point: { distance: far(A, P), angle: Number((heading(A, P) - heading(A, B)).toFixed(6)) },
      assembly: cross < 0 ? "crossed" : "open",
      reference_input_angle: Number(heading(O2, A).toFixed(6)),
    });
  };
  return {
    offers: [],
    lines: () => [
      [joints.O2, joints.A, joints.B, joints.O4],
      [joints.A, joints.P, joints.B],
    ],
    handles: Object.keys(joints).map((name) => ({
      name,
      label: t`Joint ${name} of the linkage`,
      get: () => joints[name],
      put: (x, y) => {
        joints[name] = [x, y];
        restate();
      },
    })),
  };
}

/** Relative rounding of lengths, with a margin for its effect on squares. */
const ROUNDING_SHARE = 1e-7;

/**
 * Return the joints of a fourbar at its reference input, or at the first input where it can be assembled.
 * @param {NonNullable<Schemas["ParallelMotionProblem"]["linkage"]>} linkage
 * @returns {Record<string, Point> | null}
 */
function assembleFourbar(linkage) {
  const { fixed_pivots: pivots, links, coupler_point: at, assembly, reference_input_angle: reference } = linkage;
  if (!wholeNumber(pivots?.input) || !wholeNumber(pivots?.output)) return null;
  for (let k = 0; k < 360; k++) {
    const input = (((reference ?? 30) + k) * Math.PI) / 180;
    const A = /** @type {Point} */ ([
      pivots.input[0] + links.input * Math.cos(input),
      pivots.input[1] + links.input * Math.sin(input),
    ]);
    const [dx, dy] = [pivots.output[0] - A[0], pivots.output[1] - A[1]];
    const diagonal = Math.hypot(dx, dy);
    const along = (links.coupler ** 2 - links.output ** 2 + diagonal ** 2) / (2 * diagonal);
    // Rounded joints in a straight line may be slightly farther apart than the links reach.
    const square = links.coupler ** 2 - along ** 2;
    const rounded = Math.abs(square) < ROUNDING_SHARE * links.coupler ** 2;
    const up = rounded ? 0 : Math.sqrt(square) * (assembly === "crossed" ? -1 : 1);
    if (!Number.isFinite(up)) continue;
    const B = /** @type {Point} */ ([
      A[0] + (along * dx - up * dy) / diagonal,
      A[1] + (along * dy + up * dx) / diagonal,
    ]);
    const heading = Math.atan2(B[1] - A[1], B[0] - A[0]) + ((at.angle ?? 0) * Math.PI) / 180;
    return {
      O2: /** @type {Point} */ ([...pivots.input]),
      O4: /** @type {Point} */ ([...pivots.output]),
      A,
      B,
      P: [A[0] + at.distance * Math.cos(heading), A[1] + at.distance * Math.sin(heading)],
    };
  }
  return null;
}

/**
 * Return handles for given fixed pivots of a function's linkage; they lie in the plane, not in the graph.
 * @param {Problem} problem
 * @returns {Handle[]}
 */
export function fixedPivotHandles(problem) {
  const pivots = problem.fixed_pivots;
  return [
    ...pointHandle(pivots, "input", "O2", t`Fixed pivot O2`, false),
    ...pointHandle(pivots, "output", "O4", t`Fixed pivot O4`, false),
  ];
}

/**
 * Return handles for the pairs of a function, as points of its graph.
 * @param {Schemas["FunctionProblem"]} problem
 * @returns {Handles}
 */
function functionHandles(problem) {
  const pairs = problem.pairs ?? [];
  return {
    word: "pair",
    lines: () => [pairs.map((one) => [one.input, one.output])],
    handles: pairs.map((one, /** @type {number} */ k) => ({
      name: String(k + 1),
      label: t`Pair ${k + 1}, input across and output up`,
      get: () => [one.input, one.output],
      put: (/** @type {number} */ x, /** @type {number} */ y) => Object.assign(one, { input: x, output: y }),
      remove: () => pairs.splice(pairs.indexOf(one), 1),
    })),
    ...(problem.pairs
      ? { add: (/** @type {number} */ x, /** @type {number} */ y) => pairs.push({ input: x, output: y }) }
      : {}),
    offers: problem.pairs
      ? []
      : [
          {
            text: t`Use pairs instead`,
            make: () => {
              for (const name of /** @type {const} */ ([
                "function",
                "precision_points",
                "criterion",
                "input_range",
                "output_range",
                "scales",
                "zeros",
              ]))
                delete problem[name];
              problem.pairs = [
                { input: 40, output: 70 },
                { input: 55, output: 85 },
                { input: 70, output: 95 },
              ];
            },
          },
        ],
  };
}

/** Add handles for the pivot regions: two corners each. @param {Problem} problem @param {Handles} found */
function addRegionHandles(problem, found) {
  const { constraints } = problem;
  for (const [field, name] of /** @type {const} */ ([
    ["fixed_pivot_region", t`fixed pivots`],
    ["moving_pivot_region", t`moving pivots`],
  ])) {
    const region = constraints?.[field];
    if (!constraints || !region || !wholeNumber(region.x) || !wholeNumber(region.y)) continue;
    const { lines } = found;
    found.lines = () => [
      ...lines(),
      [
        [region.x[0], region.y[0]],
        [region.x[1], region.y[0]],
        [region.x[1], region.y[1]],
        [region.x[0], region.y[1]],
        [region.x[0], region.y[0]],
      ],
    ];
    found.handles.push(
      ...[0, 1].map((k) => ({
        name: k ? name : "",
        label: k ? t`Region of ${name}, upper right corner` : t`Region of ${name}, lower left corner`,
        get: () => /** @type {Point} */ ([region.x[k], region.y[k]]),
        put: (/** @type {number} */ x, /** @type {number} */ y) => {
          region.x[k] = k ? Math.max(x, region.x[0]) : Math.min(x, region.x[1]);
          region.y[k] = k ? Math.max(y, region.y[0]) : Math.min(y, region.y[1]);
        },
        remove: () => (constraints[field] = null),
      })),
    );
  }
}

/** @param {Point} at @param {number} degrees @param {number} far @returns {Point[]} */
function lineThrough([x, y], degrees, far) {
  const angle = (degrees * Math.PI) / 180;
  return [
    [x - far * Math.cos(angle), y - far * Math.sin(angle)],
    [x + far * Math.cos(angle), y + far * Math.sin(angle)],
  ];
}

/** @param {Point} at @param {number} radius @returns {Point[]} */
function circlePath([x, y], radius) {
  return Array.from({ length: 49 }, (_, k) => [
    x + radius * Math.cos((k * Math.PI) / 24),
    y + radius * Math.sin((k * Math.PI) / 24),
  ]);
}
