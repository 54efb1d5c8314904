/** Triangulate parts from the shapes of the service: triangles with normals, and the edges of solids. */

/** @typedef {[number, number]} Point */
/**
 * @typedef {{form: "circle", centre: Point, radius: number} | {form: "corners", corners: Point[], bulges: number[],
 *   smooth: boolean}} Outline
 */
/**
 * @typedef {{form: string, low: number, high: number, outer: Outline, holes: Outline[], twist: number, centre: Point,
 *   profile: Point[], corners: number[][], triangles: number[][]}} Shape
 */

/**
 * A straight piece of an outline, with its outward normals at both ends.
 * @typedef {{from: Point, to: Point, out: [Point, Point]}} Piece
 */

/**
 * Triangulates a region; indices count the points of the outline, then those of the holes.
 * @typedef {(outer: Point[], holes: Point[][]) => number[][]} Triangulate
 */

/** Number of pieces of a circle. */
const CIRCLE_PIECES = 96;

/** Angle between normals from which an edge is drawn, radians. */
const CREASE_ANGLE = 0.6;

/** Twist of a prism per layer, radians. */
const LAYER_TWIST = 0.06;

export class Surface {
  /** @param {Triangulate} triangulate */
  constructor(triangulate) {
    this.triangulate = triangulate;
    /** Three corners per triangle, three coordinates each. @type {number[]} */
    this.places = [];
    /** @type {number[]} */
    this.normals = [];
    /** Two ends per line. @type {number[]} */
    this.edges = [];
  }

  /** @param {Shape} shape */
  add(shape) {
    if (shape.form === "prism") this.addPrism(shape, 0, [0, 0]);
    else if (shape.form === "twisted") this.addPrism(shape, (shape.twist * Math.PI) / 180, shape.centre);
    else this.addMesh(shape);
  }

  /**
   * Add a prism, twisted by an angle over its height.
   * @param {Shape} shape
   * @param {number} twist
   * @param {Point} centre
   */
  addPrism({ low, high, outer, holes }, twist, centre) {
    const outlines = [outer, ...holes].map(splitOutline);
    const layers = Math.max(1, Math.ceil(Math.abs(twist) / LAYER_TWIST));
    const at = Array.from({ length: layers + 1 }, (_, k) => {
      const share = k / layers;
      return { height: low + share * (high - low), turned: createRotation(twist * share, centre) };
    });
    outlines.forEach((outline, n) => {
      const side = n === 0 ? 1 : -1;
      for (const piece of outline) {
        for (let k = 0; k < layers; k++) this.addWall(piece, at[k], at[k + 1], side);
      }
      this.addOutline(outline, at[0]);
      this.addOutline(outline, at[layers]);
      if (layers === 1) this.addCreases(outline, at[0], at[1]);
    });
    const points = outlines.map((outline) => outline.map(({ from }) => from));
    const all = points.flat();
    for (const three of this.triangulate(points[0], points.slice(1))) {
      for (const [{ height, turned }, up] of /** @type {[typeof at[0], number][]} */ ([
        [at[0], -1],
        [at[layers], 1],
      ])) {
        const corners = three.map((k) => turned.place(all[k]));
        const [a, b, c] = corners;
        const left = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0;
        for (const [x, y] of left === up > 0 ? corners : corners.reverse()) this.addCorner(x, y, height, 0, 0, up);
      }
    }
  }

  /**
   * @param {Piece} piece
   * @param {Level} below
   * @param {Level} above
   * @param {number} side 1 of an outline, -1 of a hole
   */
  addWall({ from, to, out }, below, above, side) {
    const [a, b, c, d] = [
      below.turned.place(from),
      below.turned.place(to),
      above.turned.place(to),
      above.turned.place(from),
    ];
    const [na, nb, nc, nd] = [
      below.turned.way(out[0]),
      below.turned.way(out[1]),
      above.turned.way(out[1]),
      above.turned.way(out[0]),
    ];
    /** @type {[Point, number, Point][]} */
    const quad = [
      [a, below.height, na],
      [b, below.height, nb],
      [c, above.height, nc],
      [a, below.height, na],
      [c, above.height, nc],
      [d, above.height, nd],
    ];
    for (const [[x, y], z, [u, v]] of side > 0 ? quad : quad.reverse()) this.addCorner(x, y, z, side * u, side * v, 0);
  }

  /** @param {number} x @param {number} y @param {number} z @param {number} u @param {number} v @param {number} w */
  addCorner(x, y, z, u, v, w) {
    this.places.push(x, y, z);
    this.normals.push(u, v, w);
  }

  /** @param {Piece[]} outline @param {Level} level */
  addOutline(outline, { height, turned }) {
    for (const { from, to } of outline) this.edges.push(...turned.place(from), height, ...turned.place(to), height);
  }

  /** Upright edges where an outline has corners. @param {Piece[]} outline @param {Level} below @param {Level} above */
  addCreases(outline, below, above) {
    outline.forEach(({ from, out }, k) => {
      const before = outline[(k + outline.length - 1) % outline.length].out[1];
      if (out[0][0] * before[0] + out[0][1] * before[1] < Math.cos(CREASE_ANGLE))
        this.edges.push(...from, below.height, ...from, above.height);
    });
  }

  /** @param {Shape} shape */
  addMesh({ corners, triangles }) {
    /** The normals of the triangles at an edge, by the numbers of its ends. @type {Map<string, number[]>} */
    const beside = new Map();
    for (const three of triangles) {
      const [a, b, c] = three.map((k) => corners[k]);
      const [p, q] = [[0, 1, 2].map((k) => b[k] - a[k]), [0, 1, 2].map((k) => c[k] - a[k])];
      const cross = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
      const size = Math.hypot(...cross) || 1;
      const normal = cross.map((one) => one / size);
      for (const corner of [a, b, c]) this.addCorner(corner[0], corner[1], corner[2], normal[0], normal[1], normal[2]);
      three.forEach((one, n) => {
        const other = three[(n + 1) % 3];
        const key = one < other ? `${one} ${other}` : `${other} ${one}`;
        const before = beside.get(key);
        if (!before) beside.set(key, normal);
        else if (before.reduce((sum, value, k) => sum + value * normal[k], 0) < Math.cos(CREASE_ANGLE))
          this.edges.push(...corners[one], ...corners[other]);
      });
    }
  }
}

/** @typedef {{height: number, turned: ReturnType<typeof createRotation>}} Level */

/** How places and directions are turned about a centre. @param {number} angle @param {Point} centre */
function createRotation(angle, [x, y]) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  /** @param {Point} way @returns {Point} */
  const way = ([u, v]) => [c * u - s * v, s * u + c * v];
  return {
    way,
    /** @param {Point} place @returns {Point} */
    place(place) {
      const [u, v] = way([place[0] - x, place[1] - y]);
      return [x + u, y + v];
    },
  };
}

/** An outline in straight pieces, counter-clockwise. @param {Outline} outline @returns {Piece[]} */
export function splitOutline(outline) {
  if (outline.form === "circle") return sampleArc(outline.centre, outline.radius, 0, 2 * Math.PI);
  const { corners, bulges } = outline;
  const found = corners.flatMap((from, k) => {
    const to = corners[(k + 1) % corners.length];
    const bulge = bulges[k];
    const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    const long = Math.hypot(dx, dy);
    if (long === 0) return [];
    if (bulge === 0) {
      const out = /** @type {Point} */ ([dy / long, -dx / long]);
      return [/** @type {Piece} */ ({ from, to, out: [out, out] })];
    }
    const away = (1 - bulge * bulge) / (4 * bulge);
    const centre = /** @type {Point} */ ([(from[0] + to[0]) / 2 - away * dy, (from[1] + to[1]) / 2 + away * dx]);
    return sampleArc(
      centre,
      Math.hypot(from[0] - centre[0], from[1] - centre[1]),
      Math.atan2(from[1] - centre[1], from[0] - centre[0]),
      4 * Math.atan(bulge),
    );
  });
  return outline.smooth ? smoothNormals(found) : found;
}

/**
 * @param {Point} centre
 * @param {number} radius
 * @param {number} begin
 * @param {number} angle signed
 * @returns {Piece[]}
 */
function sampleArc(centre, radius, begin, angle) {
  const count = Math.max(2, Math.ceil((Math.abs(angle) / (2 * Math.PI)) * CIRCLE_PIECES));
  const side = Math.sign(angle);
  const ways = Array.from({ length: count + 1 }, (_, k) => begin + (angle * k) / count).map((at) => [
    Math.cos(at),
    Math.sin(at),
  ]);
  const places = ways.map(([x, y]) => /** @type {Point} */ ([centre[0] + radius * x, centre[1] + radius * y]));
  return ways.slice(1).map((way, k) => ({
    from: places[k],
    to: places[k + 1],
    out: [
      [side * ways[k][0], side * ways[k][1]],
      [side * way[0], side * way[1]],
    ],
  }));
}

/** Pieces of a smooth curve: their normals go over into one another. @param {Piece[]} found @returns {Piece[]} */
function smoothNormals(found) {
  /** @param {Point} one @param {Point} other @returns {Point} */
  const between = (one, other) => {
    const [x, y] = [one[0] + other[0], one[1] + other[1]];
    const size = Math.hypot(x, y) || 1;
    return [x / size, y / size];
  };
  return found.map(({ from, to, out: [out] }, k) => ({
    from,
    to,
    out: [
      between(out, found[(k + found.length - 1) % found.length].out[0]),
      between(out, found[(k + 1) % found.length].out[0]),
    ],
  }));
}
