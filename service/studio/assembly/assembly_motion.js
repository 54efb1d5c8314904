/** Interpolate the poses of the parts of an assembly between the inputs that the service computed. */

/**
 * @typedef {{origins: number[][], along: number[][], normals: number[][]}} PlaneFrame
 * @typedef {{pivot: [number, number], angles: number[], places: [number, number][], frame: PlaneFrame | null}} Carrier
 * @typedef {{quantity: "angle" | "place", low: number, high: number, reference: number, closed: boolean, endless:
 *   boolean, values: number[]}} Inputs
 */

export class AssemblyMotion {
  /** @param {Inputs} inputs @param {Carrier[]} carriers */
  constructor(inputs, carriers) {
    this.inputs = inputs;
    this.carriers = carriers;
    /** The circle of each carrier, if all turn uniformly without end. @type {Map<Carrier, Orbit>} */
    this.orbits = new Map(inputs.endless ? carriers.map((carrier) => [carrier, findOrbit(carrier.places)]) : []);
  }

  /**
   * Find the fractional index of an input in the arrays, or the nearest one if the parts do not cover it.
   * @param {number} input @returns {{at: number, within: boolean}}
   */
  findIndex(input) {
    const { values, low, high, closed, endless, quantity } = this.inputs;
    const count = values.length;
    if (count < 2) return { at: 0, within: true };
    const step = values[1] - values[0];
    if (endless) return { at: (input - values[0]) / step, within: true };
    const round = closed ? high - low : quantity === "angle" ? 360 : 0;
    const near = 1e-6 * (high - low);
    let value = input;
    if (round > 0) {
      value = low + ((((input - low) % round) + round) % round);
      // An input beyond a range that does not return may be nearer to its start.
      if (!closed && value > high && low + round - value < value - high) value -= round;
      if (round - (value - low) < near) value = low;
    }
    const within = value >= low - near && value <= high + near;
    const at = (value - values[0]) / step;
    return { at: closed ? at : Math.min(count - 1, Math.max(0, at)), within };
  }

  /**
   * Return the pose of a carrier: its rotation, radians, and the position of its pivot.
   * @param {Carrier} carrier @param {number} at @returns {{angle: number, place: [number, number]}}
   */
  carrierPose(carrier, at) {
    const { angles, places } = carrier;
    const count = angles.length;
    const round = this.orbits.get(carrier);
    if (round) {
      const angle = ((angles[0] + (at * (angles[count - 1] - angles[0])) / Math.max(1, count - 1)) * Math.PI) / 180;
      const [[x, y], [u, v]] = [round.centre, round.arm];
      const [c, s] = [Math.cos(round.step * at), Math.sin(round.step * at)];
      return { angle, place: [x + c * u - s * v, y + s * u + c * v] };
    }
    const k = Math.min(Math.max(0, Math.floor(at)), this.inputs.closed ? count - 1 : Math.max(0, count - 2));
    const next = (k + 1) % count;
    const share = count > 1 ? at - k : 0;
    let ahead = angles[next];
    if (next < k) {
      // After a cycle the pose repeats up to whole turns; an indexed wheel advances by the same angle again.
      const step = angles[k] - angles[Math.max(0, k - 1)];
      const back = ahead + 360 * Math.round((angles[k] + step - ahead) / 360);
      ahead = Math.abs(angles[k] + step - back) < 1 + 2 * Math.abs(step) ? back : angles[k] + step;
    }
    const [[x, y], [u, v]] = [places[k], places[next]];
    return {
      angle: ((angles[k] + share * (ahead - angles[k])) * Math.PI) / 180,
      place: [x + share * (u - x), y + share * (v - y)],
    };
  }
}

/** @typedef {{centre: [number, number], arm: [number, number], step: number}} Orbit */

/**
 * Fit the circle through evenly spaced points, and the angle between neighbours.
 * @param {[number, number][]} places
 * @returns {Orbit}
 */
function findOrbit(places) {
  const still = { centre: places[0], arm: /** @type {[number, number]} */ ([0, 0]), step: 0 };
  if (places.length < 3) return still;
  const [[ax, ay], [bx, by], [cx, cy]] = places;
  const [ux, uy, vx, vy] = [bx - ax, by - ay, cx - bx, cy - by];
  const size = Math.max(...places.map(([x, y]) => Math.hypot(x - ax, y - ay)));
  if (size < 1e-9 * Math.max(1, Math.hypot(ax, ay))) return still;
  const step = Math.atan2(ux * vy - uy * vx, ux * vx + uy * vy);
  // The centre lies on the bisector of a chord, at the distance given by the central angle.
  const away = 0.5 / Math.tan(step / 2);
  const centre = /** @type {[number, number]} */ ([(ax + bx) / 2 - away * uy, (ay + by) / 2 + away * ux]);
  return { centre, arm: [ax - centre[0], ay - centre[1]], step };
}
