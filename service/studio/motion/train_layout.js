/** Lay out the gears of each type of train, from teeth and speeds. */

import { t, term } from "../core/messages.js";
import { phaseFacing, pitchRadius } from "./toothed_wheels.js";

/** @import { Design, Mechanism, Problem, Schemas, TrainMotion } from "../types/values.js" */

/** @typedef {import("./toothed_wheels.js").Wheel} Wheel */
/** @typedef {import("./toothed_wheels.js").Point} Point */
/** @typedef {{gears: string[], bodies: string[], carrier: string, distance: number}} PlanetMesh */

/**
 * @param {Pick<Mechanism, "type">} mechanism
 * @param {TrainMotion} motion
 * @param {Pick<Design, "metrics">} design
 * @param {Pick<Problem, "reverted" | "units">} problem
 * @returns {Wheel[]}
 */
export function layOutWheels(mechanism, motion, design, problem) {
  switch (mechanism.type) {
    case "gear_train":
      return layOutOrdinary(/** @type {Schemas["GearTrainAnalysis"]} */ (motion), problem);
    case "planetary_train":
      return layOutPlanetary(
        /** @type {Schemas["PlanetaryMechanism"]} */ (mechanism),
        /** @type {Schemas["PlanetaryAnalysis"]} */ (motion),
        /** @type {Schemas["PlanetaryMetrics"]} */ (design.metrics),
      );
    case "train_series":
      return layOutSeries(
        /** @type {Schemas["TrainSeriesMechanism"]} */ (mechanism),
        /** @type {Schemas["TrainSeriesAnalysis"]} */ (motion),
        /** @type {Schemas["TrainSeriesMetrics"]} */ (design.metrics),
        problem,
      );
    case "gearbox":
      return layOutGearbox(
        /** @type {Schemas["GearboxMechanism"]} */ (mechanism),
        /** @type {Schemas["GearboxAnalysis"]} */ (motion),
      );
    default:
      return layOutLayshaft(
        /** @type {Schemas["LayshaftMechanism"]} */ (mechanism),
        /** @type {Schemas["GearboxAnalysis"]} */ (motion),
      );
  }
}

/**
 * Trains in series: each as it is alone, side by side, at the speed that its input has.
 * @param {Schemas["TrainSeriesMechanism"]} mechanism
 * @param {Schemas["TrainSeriesAnalysis"]} motion
 * @param {Schemas["TrainSeriesMetrics"]} metrics
 * @param {Pick<Problem, "reverted" | "units">} problem
 */
function layOutSeries(mechanism, motion, metrics, problem) {
  /** @type {Wheel[]} */
  const found = [];
  let right = 0;
  const stated = Array.isArray(problem.units) ? problem.units : [];
  mechanism.units.forEach((unit, /** @type {number} */ n) => {
    const own = layOutWheels(unit, motion.units[n], { metrics: metrics.units[n] }, stated[n] ?? {});
    const ends = own.map((wheel) => [
      wheel.centre[0] - pitchRadius(wheel) - wheel.module,
      wheel.centre[0] + pitchRadius(wheel) + wheel.module,
    ]);
    const [low, high] = [Math.min(...ends.map(([end]) => end)), Math.max(...ends.map(([, end]) => end))];
    const aside = n ? right + 0.15 * (high - low) - low : 0;
    right = high + aside;
    const share = motion.shafts[n].speed_ratio;
    found.push(
      ...own.map((wheel) => ({
        ...wheel,
        name: t`Unit ${n + 1}, ${wheel.name}`,
        centre: /** @type {Point} */ ([wheel.centre[0] + aside, wheel.centre[1]]),
        axis: /** @type {Point} */ ([aside, 0]),
        speed: share * wheel.speed,
        ...(wheel.orbit === undefined ? {} : { orbit: share * wheel.orbit }),
      })),
    );
  });
  return found;
}

/**
 * An ordinary train: shafts in a line; those of a reverted train go to and fro, or round a triangle.
 * @param {Schemas["GearTrainAnalysis"]} motion
 * @param {Pick<Problem, "reverted" | "units">} problem
 */
function layOutOrdinary(motion, problem) {
  const distances = motion.centre_distances;
  const stages = distances.length;
  const back = problem.reverted && Math.max(...distances) - Math.min(...distances) <= 1e-9 * Math.max(...distances);
  /** @type {Wheel[]} */
  const found = [];
  let shaft = /** @type {Point} */ ([0, 0]);
  for (let stage = 1; stage <= stages; stage++) {
    const ahead = !back ? 0 : stages === 3 ? (2 * Math.PI * (stage - 1)) / 3 : Math.PI * ((stage - 1) % 2);
    /** @type {Wheel | null} */
    let before = null;
    const gears = motion.gears.filter((one) => one.stage === stage);
    const kind = motion.meshes.find((mesh) => mesh.stage === stage)?.type;
    const inside = kind === "internal";
    // A pinion that drives a ring meshes with it on the side away from the ring's axis.
    const contact = inside && gears[0].teeth < gears[1].teeth ? ahead + Math.PI : ahead;
    // Shifted gears are shown by their working pitch circles, which touch; an idler's stage has none.
    // Bevel gears are shown as if spread out in one plane, a worm as the circle that it is from its end.
    const apart =
      gears.length === 2 && !inside && kind !== "bevel" && kind !== "worm"
        ? distances[stage - 1] / (0.5 * gears[0].module * (gears[0].teeth + gears[1].teeth))
        : 1;
    const wide = Math.abs(apart - 1) > 1e-9 ? apart : 1;
    for (const gear of gears) {
      /** @type {Wheel} */
      const wheel = {
        name: t`Stage ${stage} ${term(gear.role)}`,
        teeth: gear.teeth,
        module: gear.module * wide,
        centre: shaft,
        tooth: contact,
        speed: gear.speed_ratio,
        tone: stage - 1,
        ...(inside ? { internal: gear.teeth === Math.max(...gears.map((one) => one.teeth)) } : {}),
        ...(kind === "worm" && gear.role === "driver" ? { module: gear.pitch_diameter / gear.teeth, idle: true } : {}),
      };
      if (before) {
        const far = inside
          ? Math.abs(pitchRadius(before) - pitchRadius(wheel))
          : pitchRadius(before) + pitchRadius(wheel);
        wheel.centre = [before.centre[0] + far * Math.cos(ahead), before.centre[1] + far * Math.sin(ahead)];
        wheel.tooth = phaseFacing(before, wheel, contact);
      }
      found.push(wheel);
      before = wheel;
      shaft = wheel.centre;
    }
  }
  return found;
}

/**
 * A planetary train: the meshes determine the body of each gear.
 * @param {Schemas["PlanetaryMechanism"]} mechanism
 * @param {Schemas["PlanetaryAnalysis"]} motion
 * @param {Schemas["PlanetaryMetrics"]} metrics
 */
function layOutPlanetary(mechanism, motion, metrics) {
  /** @type {PlanetMesh[]} */
  const meshes = metrics.meshes.map((mesh, k) => ({
    gears: mesh.gears,
    bodies: [motion.meshes[k].first, motion.meshes[k].second],
    carrier: motion.meshes[k].carrier,
    // Bevel gears, whose axes cross, are shown as if spread out in one plane.
    distance:
      mesh.centre_distance ?? 0.5 * mechanism.module * mesh.gears.reduce((sum, name) => sum + mechanism.teeth[name], 0),
  }));
  /** @type {Record<string, Schemas["PlanetaryAnalysis"]["bodies"][number]>} */
  const bodies = Object.fromEntries(motion.bodies.map((body) => [body.name, body]));
  const bodyOf = Object.fromEntries(meshes.flatMap((mesh) => mesh.gears.map((gear, k) => [gear, mesh.bodies[k]])));
  const carrierOf = Object.fromEntries(
    meshes.flatMap((mesh) => mesh.bodies.filter((body) => bodies[body].planet).map((body) => [body, mesh.carrier])),
  );
  const pins = carrierPins(meshes, bodies);
  const names = Object.keys(mechanism.teeth).filter((name) => name in bodyOf);
  /** @type {Record<string, Wheel>} */
  const first = Object.fromEntries(
    names.map((name, k) => {
      const body = bodyOf[name];
      return [
        name,
        {
          name,
          teeth: mechanism.teeth[name],
          module: mechanism.module,
          internal: name.startsWith("ring"),
          centre: pins[body] ?? [0, 0],
          tooth: NaN,
          speed: bodies[body].speed ?? 0,
          orbit: bodies[carrierOf[body]]?.speed ?? 0,
          tone: k,
        },
      ];
    }),
  );
  const mates = (/** @type {string} */ gear) =>
    meshes.filter((mesh) => mesh.gears.includes(gear)).map((mesh) => mesh.gears[mesh.gears[0] === gear ? 1 : 0]);
  // The first copies: from gear to gear, each facing the one before.
  for (const start of names) {
    if (!Number.isNaN(first[start].tooth)) continue;
    first[start].tooth = 0;
    for (const waiting = [start]; waiting.length;) {
      const known = /** @type {string} */ (waiting.pop());
      for (const mate of mates(known)) {
        if (!Number.isNaN(first[mate].tooth)) continue;
        first[mate].tooth = phaseFacing(first[known], first[mate], meshDirection(first[known], first[mate]));
        waiting.push(mate);
      }
    }
  }
  return names.flatMap((name) => {
    const body = bodyOf[name];
    if (!bodies[body].planet) return [first[name]];
    const { divisions, steps } = mechanism.places[body] ?? { divisions: 1, steps: [0] };
    return steps.map((/** @type {number} */ step, /** @type {number} */ copy) => {
      const turn = (2 * Math.PI * step) / divisions;
      const wheel = { ...first[name], name: `${name} ${copy + 1}`, centre: rotatePoint(first[name].centre, turn) };
      wheel.tooth =
        first[name].tooth +
        findPlanetRotation(
          names.filter((one) => bodyOf[one] === body),
          first,
          mates,
          turn,
        );
      return wheel;
    });
  });
}

/**
 * How far a copy of a planet is turned itself so that all its gears mesh: the best of its first gear's tooth places.
 * @param {string[]} own
 * @param {Record<string, Wheel>} first
 * @param {(gear: string) => string[]} mates
 * @param {number} turn
 */
function findPlanetRotation(own, first, mates, turn) {
  const pairs = own.flatMap((gear) =>
    mates(gear)
      .filter((mate) => first[mate].centre[0] === 0 && first[mate].centre[1] === 0)
      .map((mate) => [gear, mate]),
  );
  if (!pairs.length) return turn;
  const wanted = ([gear, mate] = pairs[0]) => {
    const there = { ...first[gear], centre: rotatePoint(first[gear].centre, turn) };
    return phaseFacing(first[mate], there, meshDirection(first[mate], there)) - first[gear].tooth;
  };
  const base = wanted();
  const pitch = (2 * Math.PI) / first[pairs[0][0]].teeth;
  let best = base;
  let least = Infinity;
  for (let k = 0; k < first[pairs[0][0]].teeth; k++) {
    const misfit = pairs.slice(1).reduce((sum, pair) => {
      const tooth = (2 * Math.PI) / first[pair[0]].teeth;
      const off = base + pitch * k - wanted(pair);
      return sum + Math.abs(off - tooth * Math.round(off / tooth));
    }, 0);
    if (misfit < least - 1e-9) [least, best] = [misfit, base + pitch * k];
  }
  return best;
}

/**
 * Pins of the first planets: by their distance from the axis, those of one set beside each other.
 * @param {PlanetMesh[]} meshes
 * @param {Record<string, {planet: boolean}>} bodies
 * @returns {Record<string, Point>}
 */
function carrierPins(meshes, bodies) {
  /** @type {Record<string, number>} */
  const far = {};
  for (const {
    bodies: [one, other],
    distance,
  } of meshes) {
    if (bodies[one].planet !== bodies[other].planet) far[bodies[one].planet ? one : other] = distance;
  }
  /** @type {Record<string, Point>} */
  const found = {};
  for (const planet of Object.keys(far)) {
    const beside = meshes.find(
      (mesh) => mesh.bodies.includes(planet) && mesh.bodies.some((body) => body !== planet && body in found),
    );
    if (!beside) found[planet] = [far[planet], 0];
    else {
      const [x, y] = found[beside.bodies.find((body) => body !== planet) ?? ""];
      const there = Math.hypot(x, y);
      const cosine = (there ** 2 + far[planet] ** 2 - beside.distance ** 2) / (2 * there * far[planet]);
      const angle = Math.atan2(y, x) + Math.acos(Math.min(1, Math.max(-1, cosine)));
      found[planet] = [far[planet] * Math.cos(angle), far[planet] * Math.sin(angle)];
    }
  }
  return found;
}

/** Direction from the centre of one gear to its contact with another. @param {Wheel} one @param {Wheel} other */
function meshDirection(one, other) {
  const [[x, y], [u, v]] = [one.centre, other.centre];
  // With internal teeth the contact lies beyond the planet, as seen from the axis.
  if (one.internal || other.internal) return x || y ? Math.atan2(y, x) : Math.atan2(v, u);
  return Math.atan2(v - y, u - x);
}

/**
 * A machine-tool gearbox, its shafts in a line; the pairs that are not engaged are circles.
 * @param {Schemas["GearboxMechanism"]} mechanism
 * @param {Schemas["GearboxAnalysis"]} motion
 */
function layOutGearbox(mechanism, motion) {
  /** @type {Wheel[]} */
  const found = [];
  let at = 0;
  mechanism.stages.forEach((stage, /** @type {number} */ n) => {
    const [from, to] = [at, at + stage.centre_distance];
    stage.pairs.forEach((pair, /** @type {number} */ k) => {
      const idle = motion.engaged[n] !== k;
      const common = { module: mechanism.module, tone: n, idle };
      /** @type {Wheel} */
      const one = {
        ...common,
        name: t`Stage ${n + 1}, pair ${k + 1}, driver`,
        teeth: pair.driver,
        centre: [from, 0],
        tooth: 0,
        speed: motion.shafts[n].speed_ratio,
      };
      /** @type {Wheel} */
      const other = {
        ...common,
        name: t`Stage ${n + 1}, pair ${k + 1}, driven`,
        teeth: pair.driven,
        centre: [to, 0],
        tooth: 0,
        speed: motion.shafts[n + 1].speed_ratio,
      };
      other.tooth = phaseFacing(one, other, 0);
      found.push(one, other);
    });
    at = to;
  });
  return found.sort((one, other) => Number(other.idle) - Number(one.idle));
}

/**
 * A layshaft gearbox: input and main shaft on one axis, the layshaft parallel to it, reverse by an idler.
 * @param {Schemas["LayshaftMechanism"]} mechanism
 * @param {Schemas["GearboxAnalysis"]} motion
 */
function layOutLayshaft(mechanism, motion) {
  const { head, gears, reverse, module } = mechanism;
  const [input, lay, main] = motion.shafts.map((shaft) => shaft.speed_ratio);
  const distance = mechanism.centre_distance;
  const engaged = motion.engaged[0];
  /** @type {Wheel[]} */
  const found = [];
  const add = (
    /** @type {string} */ name,
    /** @type {number} */ tone,
    /** @type {boolean} */ idle,
    /** @type {[number, number, Point, string][]} */ row,
  ) => {
    /** @type {Wheel | null} */
    let before = null;
    for (const [teeth, speed, centre, shaft] of row) {
      /** @type {Wheel} */
      const wheel = { name: `${name}, ${shaft}`, teeth, module, centre, tooth: 0, speed, tone, idle };
      if (before)
        wheel.tooth = phaseFacing(
          before,
          wheel,
          Math.atan2(centre[1] - before.centre[1], centre[0] - before.centre[0]),
        );
      found.push(wheel);
      before = wheel;
    }
  };
  const [axis, beside] = /** @type {[Point, Point]} */ ([
    [0, 0],
    [distance, 0],
  ]);
  gears.forEach((pair, /** @type {number} */ k) => {
    if (pair.layshaft !== null)
      add(t`Gear ${k + 1}`, 1, k !== engaged, [
        [pair.layshaft, lay, beside, t`on the layshaft`],
        [Number(pair.mainshaft), main, axis, t`on the main shaft`],
      ]);
  });
  if (reverse) {
    const [near, far] = [
      (module * (reverse.idler + reverse.layshaft)) / 2,
      (module * (reverse.idler + reverse.mainshaft)) / 2,
    ];
    const x = (distance ** 2 + far ** 2 - near ** 2) / (2 * distance);
    const centre = /** @type {Point} */ ([x, Math.sqrt(Math.max(far ** 2 - x ** 2, 0))]);
    const back = engaged === gears.length;
    add(t`Reverse`, 2, !back, [
      [reverse.layshaft, lay, beside, t`on the layshaft`],
      [reverse.idler, (-lay * reverse.layshaft) / reverse.idler, centre, t`on the idler's pin`],
      [reverse.mainshaft, main, axis, t`on the main shaft`],
    ]);
  }
  add(t`Head`, 0, false, [
    [head.driver, input, axis, t`on the input shaft`],
    [head.driven, lay, beside, t`on the layshaft`],
  ]);
  return found.sort((one, other) => Number(other.idle) - Number(one.idle));
}

/** @param {Point} point @param {number} angle @returns {Point} */
function rotatePoint([x, y], angle) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return [c * x - s * y, s * x + c * y];
}
