/** Create a thumbnail of a design from its dimensions. */

import { createSvg } from "../core/dom.js";
import { View } from "../core/view.js";

/** @import { Design, Metrics, OneMechanism, Skeleton } from "../types/values.js" */

const WIDTH = 150;
const HEIGHT = 84;

/** @typedef {[number, number]} Point */
/** @typedef {{centre: Point, radius: number}} Circle */
/**
 * What stages of trains and of gearboxes have.
 * @typedef {{driver: number, driven: number, module?: number, pairs?: {driver: number, driven: number}[], type?:
 *   string, helix_angle?: number, diameter_quotient?: number}} Stage
 */
/** @typedef {{stages: Stage[], idlers?: {stage: number, teeth: number}[]}} Train */

/** @param {Design} design @param {Point[]} [curve] the path of a linkage's characteristic point */
export function createThumbnail(design, curve = []) {
  const drawing = thumbnailShapes(design, curve);
  return (
    drawing &&
    createSvg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, class: "thumbnail", "aria-hidden": "true" }, ...drawing)
  );
}

/** @param {Design} design @param {Point[]} curve @returns {Element[] | null} */
function thumbnailShapes({ mechanism, metrics }, curve) {
  if (mechanism.skeleton?.joints) return linkageShapes(mechanism.skeleton, curve);
  if (mechanism.profile)
    return outlineShapes(
      [mechanism.profile, mechanism.outer_wall, mechanism.second?.profile].flatMap((curve) => curve ?? []),
      true,
    );
  if (mechanism.lower_wall && mechanism.upper_wall)
    return outlineShapes([mechanism.lower_wall, mechanism.upper_wall], false);
  const listed = circleShapes(/** @type {OneMechanism} */ (mechanism), metrics);
  if (!listed.length) return null;
  const view = new View(
    listed.flatMap(
      ({ centre: [x, y], radius }) =>
        /** @type {Point[]} */ ([
          [x - radius, y - radius],
          [x + radius, y + radius],
        ]),
    ),
    WIDTH,
    HEIGHT,
    4,
  );
  return listed.map(({ centre, radius }) => {
    const [u, v] = view.toPicture(...centre);
    return createSvg("circle", { class: "link", cx: u, cy: v, r: view.scale * radius });
  });
}

/** In its first position. @param {Skeleton} skeleton @param {Point[]} curve */
function linkageShapes(skeleton, curve) {
  const view = new View([...Object.values(skeleton.joints), ...curve], WIDTH, HEIGHT, curve.length ? 6 : 12);
  const path = view.pathData(curve);
  return [
    ...(path ? [createSvg("path", { class: "curve", d: path })] : []),
    ...skeleton.links
      .filter((link) => link.name !== "ground")
      .map((link) =>
        createSvg("path", {
          class: `link ${link.name === skeleton.input_link ? "input" : ""}`,
          d:
            view.pathData(link.joints.map((/** @type {string} */ name) => skeleton.joints[name])) +
            (link.joints.length > 2 ? "Z" : ""),
        }),
      ),
    ...Object.values(skeleton.joints).map(([x, y]) => {
      const [u, v] = view.toPicture(x, y);
      return createSvg("circle", { class: "pin", r: 2.5, cx: u, cy: v });
    }),
  ];
}

/** Contours of a cam, or the walls of a groove. @param {{x: number[], y: number[]}[]} curves @param {boolean} closed */
function outlineShapes(curves, closed) {
  const lines = curves.map((curve) =>
    curve.x.map((/** @type {number} */ x, /** @type {number} */ k) => /** @type {Point} */ ([x, curve.y[k]])),
  );
  const view = new View([...lines.flat(), .../** @type {Point[]} */ (closed ? [[0, 0]] : [])], WIDTH, HEIGHT, 6);
  const [u, v] = view.toPicture(0, 0);
  return [
    ...lines.map((line) =>
      createSvg("path", { class: closed ? "link" : "link input", d: `${view.pathData(line)}${closed ? "Z" : ""}` }),
    ),
    ...(closed ? [createSvg("circle", { class: "pin", r: 2.5, cx: u, cy: v })] : []),
  ];
}

/**
 * Pitch circles; of a flywheel its own, of an engine those of its throws.
 * @param {OneMechanism} mechanism
 * @param {Partial<Metrics> | undefined} metrics
 * @returns {Circle[]}
 */
function circleShapes(mechanism, metrics) {
  const module = "module" in mechanism ? mechanism.module : NaN;
  if (mechanism.type === "rotor") {
    const reach = Math.max(...mechanism.corrections.map((one) => one.radius ?? one.unbalance), 1e-300);
    return [
      { centre: [0, 0], radius: 1.2 * reach },
      ...mechanism.corrections.map((one) => {
        const far = one.radius ?? one.unbalance;
        const angle = (one.angle * Math.PI) / 180;
        return /** @type {Circle} */ ({
          centre: [far * Math.cos(angle), far * Math.sin(angle)],
          radius: 0.12 * reach,
        });
      }),
    ];
  }
  if (mechanism.type === "engine")
    return mechanism.throws.map((_, n) => ({
      centre: [2.2 * mechanism.crank * n, 0],
      radius: mechanism.crank,
    }));
  if (mechanism.type === "flywheel")
    return [mechanism.radius, mechanism.inner_radius].filter(Boolean).map((radius) => ({ centre: [0, 0], radius }));
  const row = (/** @type {[number, number, number, number][]} */ pairs) =>
    pairs.flatMap(
      ([from, to, one, other]) =>
        /** @type {Circle[]} */ ([
          { centre: [from, 0], radius: one },
          { centre: [to, 0], radius: other },
        ]),
    );
  if (mechanism.type === "layshaft_gearbox") {
    const pairs = [
      mechanism.head,
      ...mechanism.gears.filter((one) => one.layshaft).map((one) => ({ driver: one.mainshaft, driven: one.layshaft })),
    ];
    return row(
      pairs.map((pair) => [
        0,
        mechanism.centre_distance,
        (module * Number(pair.driver)) / 2,
        (module * Number(pair.driven)) / 2,
      ]),
    );
  }
  if ("stages" in mechanism) {
    let at = 0;
    const { stages, idlers } = /** @type {Train} */ (mechanism);
    return stages.flatMap((stage, n) => {
      const pairs = stage.pairs ?? [stage];
      const idle = (idlers ?? []).filter((one) => one.stage === n + 1).reduce((sum, one) => sum + one.teeth, 0);
      const size = stage.module ?? module;
      const from = at;
      // The axes of a ring and its pinion are the difference of the radii apart. The thickness of a worm does not
      // depend on its threads.
      const first = stage.type === "worm" ? Number(stage.diameter_quotient) : pairs[0].driver;
      const wide = stage.type === "helical" ? 1 / Math.cos(((stage.helix_angle ?? 0) * Math.PI) / 180) : 1;
      at +=
        size *
        wide *
        ((stage.type === "internal" ? Math.abs(pairs[0].driven - first) : first + pairs[0].driven) / 2 + idle);
      return row(
        pairs.map((pair) => [
          from,
          at,
          (size * wide * (stage.type === "worm" ? first : pair.driver)) / 2,
          (size * wide * pair.driven) / 2,
        ]),
      );
    });
  }
  if ("units" in mechanism) {
    let right = 0;
    return mechanism.units.flatMap((unit, /** @type {number} */ n) => {
      const own = circleShapes(unit, metrics?.units?.[n]);
      const left = Math.min(...own.map((one) => one.centre[0] - one.radius));
      const aside = right - left;
      right = 1.1 * (Math.max(...own.map((one) => one.centre[0] + one.radius)) + aside);
      return own.map((one) => /** @type {Circle} */ ({ ...one, centre: [one.centre[0] + aside, one.centre[1]] }));
    });
  }
  if (!("teeth" in mechanism)) return [];
  const far = Object.fromEntries(
    (metrics?.meshes ?? []).flatMap((mesh) => (mesh.gears ?? []).map((name) => [name, mesh.centre_distance])),
  );
  return Object.entries(mechanism.teeth).map(([name, teeth]) => ({
    centre: name.startsWith("planet") ? [far[name] ?? 0, 0] : [0, 0],
    radius: (module * Number(teeth)) / 2,
  }));
}
