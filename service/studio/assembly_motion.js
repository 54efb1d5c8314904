/** Where the parts of an assembly are at an input: between two of those that the service tells, on a straight line. */

/**
 * @typedef {{origins: number[][], along: number[][], normals: number[][]}} Standing
 * @typedef {{pivot: [number, number], angles: number[], places: [number, number][], frame: Standing | null}} Carrier
 * @typedef {{quantity: "angle" | "place", low: number, high: number, reference: number, closed: boolean, values: number[]}} Inputs
 */

export class AssemblyMotion {
  /** @param {Inputs} inputs @param {Carrier[]} carriers */
  constructor(inputs, carriers) {
    this.inputs = inputs;
    this.carriers = carriers;
  }

  /**
   * The place of an input in the arrays, as a fraction; the nearest there is where the parts were not made for it.
   * @param {number} input @returns {{at: number, within: boolean}}
   */
  place(input) {
    const { values, low, high, closed, quantity } = this.inputs;
    const count = values.length;
    if (count < 2) return { at: 0, within: true };
    const step = values[1] - values[0];
    const round = closed ? high - low : quantity === "angle" ? 360 : 0;
    const near = 1e-6 * (high - low);
    let value = input;
    if (round > 0) {
      value = low + (((input - low) % round) + round) % round;
      // What lies beyond a range that does not come back may be nearer to its beginning.
      if (!closed && value > high && low + round - value < value - high) value -= round;
      if (round - (value - low) < near) value = low;
    }
    const within = value >= low - near && value <= high + near;
    const at = (value - values[0]) / step;
    return { at: closed ? at : Math.min(count - 1, Math.max(0, at)), within };
  }

  /**
   * Where a carrier is: the angle by which it has turned, radians, and the place of its pivot.
   * @param {Carrier} carrier @param {number} at @returns {{angle: number, place: [number, number]}}
   */
  carried({ angles, places }, at) {
    const count = angles.length;
    const k = Math.min(Math.max(0, Math.floor(at)), this.inputs.closed ? count - 1 : Math.max(0, count - 2));
    const next = (k + 1) % count;
    const share = count > 1 ? at - k : 0;
    let ahead = angles[next];
    if (next < k) {
      // After a cycle it is as it was, but for whole turns.
      const step = angles[k] - angles[Math.max(0, k - 1)];
      ahead += 360 * Math.round((angles[k] + step - ahead) / 360);
    }
    const [[x, y], [u, v]] = [places[k], places[next]];
    return { angle: ((angles[k] + share * (ahead - angles[k])) * Math.PI) / 180, place: [x + share * (u - x), y + share * (v - y)] };
  }
}
