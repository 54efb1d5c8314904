/**
 * The room of a linkage, `space` of a statement: zones, box, outline of the body and obstacles as areas of the plane.
 */

import { t } from "../core/messages.js";

import { isContainer, writePointer } from "../core/pointer.js";

/** @import { Problem } from "../types/values.js" */

/** @typedef {[number, number]} Point */
/** @typedef {{polygon?: Point[] | null, circle?: {center: Point, radius: number} | null, frame?: string}} Zone */
/** @typedef {"polygon" | "rectangle" | "circle"} Tool */
/** A zone, the corners of an outline, or the two of a box, as its role says. @typedef {Zone | Point[]} Shape */
/** What has shapes by names or, where a pivot has several zones, by numbers. @typedef {Record<string, Shape>} Owner */
/** The block: its groups, or lists, and the box. @typedef {Record<string, Owner | Shape[]>} Block */

/**
 * What an area is for.
 * @typedef {object} Role
 * @property {string} name
 * @property {string} text
 * @property {string} mark what stands in it
 * @property {string[]} field its path in the block
 * @property {Tool[]} tools what draws it
 */

/** @type {Role[]} */
export const ROLES = [
  {
    name: "o2",
    text: t`Zone for O2 (fixed pivot, input)`,
    mark: "O2",
    field: ["fixed_pivots", "input"],
    tools: ["polygon", "rectangle", "circle"],
  },
  {
    name: "o4",
    text: t`Zone for O4 (fixed pivot, output)`,
    mark: "O4",
    field: ["fixed_pivots", "output"],
    tools: ["polygon", "rectangle", "circle"],
  },
  {
    name: "a",
    text: t`Zone for A (moving pivot, input)`,
    mark: "A",
    field: ["moving_pivots", "input"],
    tools: ["polygon", "rectangle", "circle"],
  },
  {
    name: "b",
    text: t`Zone for B (moving pivot, output)`,
    mark: "B",
    field: ["moving_pivots", "output"],
    tools: ["polygon", "rectangle", "circle"],
  },
  { name: "obstacle", text: t`Obstacle`, mark: "", field: ["obstacles"], tools: ["polygon", "rectangle", "circle"] },
  { name: "box", text: t`Box around everything`, mark: "box", field: ["box"], tools: ["rectangle"] },
  {
    name: "body",
    text: t`Outline of the body`,
    mark: "body",
    field: ["body", "outline"],
    tools: ["polygon", "rectangle"],
  },
];

/** The roles that areas of a problem can have: only a body that is carried has an outline. @param {Problem} problem */
export function availableRoles(problem) {
  return ROLES.filter((role) => role.name !== "body" || problem.kind === "motion");
}

/** A place of the statement that holds an area: a zone, the corners of an outline, or the two corners of a box. */
export class Area {
  /**
   * @param {Block} space
   * @param {Role} role
   * @param {string} path JSON pointer
   * @param {Owner} owner
   * @param {string} key of the value in it
   * @param {number} number among those of its role, 0 where it is alone
   */
  constructor(space, role, path, owner, key, number) {
    this.space = space;
    this.role = role;
    this.path = path;
    this.owner = owner;
    this.key = key;
    this.label = `${role.text}${number ? `, ${number}` : ""}`;
  }

  get value() {
    return this.owner[this.key];
  }

  /** Of a circle. @returns {{center: Point, radius: number} | null} */
  get circle() {
    return Array.isArray(this.value) ? null : (this.value.circle ?? null);
  }

  /** Return the given corners. @returns {Point[]} */
  get points() {
    return Array.isArray(this.value) ? this.value : (this.value.polygon ?? []);
  }

  /** Corners in order; none of a circle. @returns {Point[]} */
  get corners() {
    if (this.role.name === "box") {
      const [[left, low], [right, high]] = this.points;
      return [
        [left, low],
        [right, low],
        [right, high],
        [left, high],
      ];
    }
    return this.points;
  }

  /** Points that a picture of it must show. @returns {Point[]} */
  get extent() {
    const { circle, corners } = this;
    if (!circle) return corners;
    const {
      center: [x, y],
      radius,
    } = circle;
    return [
      [x - radius, y - radius],
      [x + radius, y + radius],
    ];
  }

  /**
   * Where its name stands: the corner that is farthest up, and of those to the left; of a circle its highest point.
   * @returns {Point}
   */
  get labelPoint() {
    const { circle, corners } = this;
    if (circle) return [circle.center[0], circle.center[1] + circle.radius];
    return corners.reduce((best, corner) =>
      corner[1] > best[1] || (corner[1] === best[1] && corner[0] < best[0]) ? corner : best,
    );
  }

  /** Whether more corners make sense. */
  get hasFreeCorners() {
    return this.role.name !== "box" && !this.circle;
  }

  /** Put a corner elsewhere. @param {number} k @param {Point} point */
  moveCorner(k, [x, y]) {
    if (this.role.name !== "box") {
      this.corners[k] = [x, y];
      return;
    }
    const [low, high] = this.points;
    const [left, below] = [k === 0 || k === 3, k < 2];
    if (left ? x < high[0] : x > low[0]) (left ? low : high)[0] = x;
    if (below ? y < high[1] : y > low[1]) (below ? low : high)[1] = y;
  }

  /** Another corner behind the corner `k`. @param {number} k @param {Point} point */
  insertCorner(k, point) {
    this.corners.splice(k + 1, 0, point);
  }

  /** @param {number} k */
  removeCorner(k) {
    if (this.hasFreeCorners && this.corners.length > 3) this.corners.splice(k, 1);
  }

  /** Move all of it. @param {Point} by @param {(value: number) => number} rounded */
  shift([dx, dy], rounded) {
    const moved = (/** @type {Point} */ [x, y]) => /** @type {Point} */ ([rounded(x + dx), rounded(y + dy)]);
    if (this.circle) this.circle.center = moved(this.circle.center);
    else if (this.role.name === "box") this.owner[this.key] = this.points.map(moved);
    else this.corners.forEach((corner, k) => (this.corners[k] = moved(corner)));
  }

  /** Remove it from the problem, with parents that become empty. */
  remove() {
    const {
      space,
      owner,
      role: {
        field: [outer, inner],
      },
    } = this;
    if (Array.isArray(owner)) {
      owner.splice(Number(this.key), 1);
      if (inner && owner.length === 1) writePointer(space, [outer, inner], owner[0]);
      else if (!owner.length) writePointer(space, inner ? [outer, inner] : [outer], undefined);
    } else delete owner[this.key];
    if (inner && space[outer] && Object.values(space[outer]).every((one) => (one ?? null) === null))
      delete space[outer];
  }
}

/**
 * Return whether the shape can be drawn; a shape that is being typed may be incomplete.
 * @param {Role} role
 * @param {Shape | null | undefined} value
 */
function isDrawable(role, value) {
  const point = (/** @type {unknown} */ one) => Array.isArray(one) && one.length === 2 && one.every(Number.isFinite);
  if (role.name === "box") return Array.isArray(value) && value.length === 2 && value.every(point);
  const corners = Array.isArray(value) ? value : value?.polygon;
  if (corners) return Array.isArray(corners) && corners.length >= 3 && corners.every(point);
  const circle = Array.isArray(value) ? null : value?.circle;
  return Boolean(circle) && point(circle?.center) && Number(circle?.radius) > 0;
}

/**
 * All areas of a block, in the order in which they are drawn.
 * @param {Problem["space"]} stated
 * @returns {Area[]}
 */
export function listAreas(stated) {
  if (!isContainer(stated)) return [];
  const space = /** @type {Block} */ (/** @type {unknown} */ (stated));
  const drawn = ["box", "obstacle", "body"];
  const order = [...drawn, ...ROLES.map(({ name }) => name).filter((name) => !drawn.includes(name))];
  return order.flatMap((name) => {
    const role = /** @type {Role} */ (ROLES.find((one) => one.name === name));
    const {
      field: [outer, inner],
    } = role;
    const owner = /** @type {Owner | undefined} */ (inner ? space[outer] : space);
    const key = inner ?? outer;
    const value = owner?.[key];
    const path = `/problem/space/${role.field.join("/")}`;
    if (!owner || !value) return [];
    if (!Array.isArray(value) || name === "box" || name === "body")
      return isDrawable(role, value) ? [new Area(space, role, path, owner, key, 0)] : [];
    const zones = /** @type {Owner} */ (/** @type {unknown} */ (value));
    return Object.entries(zones).flatMap(([k, zone]) =>
      isDrawable(role, zone) ? [new Area(space, role, `${path}/${k}`, zones, k, Number(k) + 1)] : [],
    );
  });
}

/**
 * State an area: a pivot may have several zones, and there may be several obstacles; a box or an outline takes the
 * place of the one before.
 * @param {Problem} problem changed in place @param {Role} role @param {Zone} zone @returns {string} its JSON pointer
 */
export function stateArea(problem, role, zone) {
  const space = (problem.space ??= {});
  const {
    field: [outer, inner],
  } = role;
  const path = `/problem/space/${role.field.join("/")}`;
  if (role.name === "box") {
    const xs = zone.polygon?.map(([x]) => x) ?? [];
    const ys = zone.polygon?.map(([, y]) => y) ?? [];
    space.box = [
      [Math.min(...xs), Math.min(...ys)],
      [Math.max(...xs), Math.max(...ys)],
    ];
    return path;
  }
  if (role.name === "body") {
    space.body = { outline: zone.polygon ?? [] };
    return path;
  }
  if (!inner) {
    space.obstacles = [...(space.obstacles ?? []), zone];
    return `${path}/${space.obstacles.length - 1}`;
  }
  const groups = /** @type {Record<string, Record<string, Zone | Zone[]>>} */ (space);
  const owner = (groups[outer] ??= {});
  const before = owner[inner];
  if (!before) {
    owner[inner] = zone;
    return path;
  }
  const zones = (owner[inner] = [...(Array.isArray(before) ? before : [before]), zone]);
  return `${path}/${zones.length - 1}`;
}
