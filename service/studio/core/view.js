/** Map the plane of a mechanism (y up, any unit) to a picture (y down, pixels) and back. */

/** @typedef {[number, number]} Point */
/** @typedef {{x: number, y: number, width: number, height: number}} Box */

export class View {
  /**
   * Create the view that shows all points with a margin.
   * @param {Point[]} points @param {number} width @param {number} height @param {number} [margin] pixels
   */
  constructor(points, width, height, margin = 40) {
    const known = points.filter(([x, y]) => Number.isFinite(x) && Number.isFinite(y));
    const xs = known.length ? known.map(([x]) => x) : [0];
    const ys = known.length ? known.map(([, y]) => y) : [0];
    const [west, east] = [xs.reduce((a, b) => Math.min(a, b)), xs.reduce((a, b) => Math.max(a, b))];
    const [south, north] = [ys.reduce((a, b) => Math.min(a, b)), ys.reduce((a, b) => Math.max(a, b))];
    const size = Math.max(east - west, north - south);
    /** Pixels for a length unit; a single point stands in the middle of a hundred units. */
    this.scale =
      size > 0
        ? Math.min(
            (width - 2 * margin) / Math.max(east - west, 1e-9 * size),
            (height - 2 * margin) / Math.max(north - south, 1e-9 * size),
          )
        : (width - 2 * margin) / 100;
    this.middle = /** @type {Point} */ ([(west + east) / 2, (south + north) / 2]);
    this.width = width;
    this.height = height;
    /** What of the picture the points take with their margin, pixels: width and height about its middle. */
    this.taken =
      size > 0 ? [east - west, north - south].map((one) => Math.round(this.scale * one + 2 * margin)) : [width, height];
    /** Snap step of coordinates, length units; 0 for none. */
    this.snap = 0;
  }

  /** Return true if the points lie in the picture and fill enough of it. @param {Point[]} points */
  fits(points) {
    const places = points.map((point) => this.toPicture(...point)).filter((place) => place.every(Number.isFinite));
    const us = places.map(([u]) => u);
    const vs = places.map(([, v]) => v);
    const [west, east, north, south] = [Math.min(...us), Math.max(...us), Math.min(...vs), Math.max(...vs)];
    return (
      west >= 0 &&
      east <= this.width &&
      north >= 0 &&
      south <= this.height &&
      (places.length < 2 || Math.max((east - west) / this.width, (south - north) / this.height) > 0.15)
    );
  }

  /** The part of the picture that shows the points: it fits into any room, wide or high. @returns {Box} */
  get box() {
    const [width, height] = this.taken;
    return { x: (this.width - width) / 2, y: (this.height - height) / 2, width, height };
  }

  /** All of the picture. @returns {Box} */
  get bounds() {
    return { x: 0, y: 0, width: this.width, height: this.height };
  }

  /** @param {number} x @param {number} y @returns {Point} */
  toPicture(x, y) {
    return [this.width / 2 + this.scale * (x - this.middle[0]), this.height / 2 - this.scale * (y - this.middle[1])];
  }

  /**
   * Return the point of the plane under the pointer.
   * @param {SVGSVGElement} picture
   * @param {{clientX: number, clientY: number}} pointer
   * @returns {Point}
   */
  toPlaneFromPointer(picture, pointer) {
    const matrix = picture.getScreenCTM();
    if (!matrix) return [NaN, NaN];
    const { x, y } = new DOMPoint(pointer.clientX, pointer.clientY).matrixTransform(matrix.inverse());
    return this.toPlane(x, y);
  }

  /** Return the point of the plane at a point of the picture. @param {number} u @param {number} v @returns {Point} */
  toPlane(u, v) {
    return [this.middle[0] + (u - this.width / 2) / this.scale, this.middle[1] - (v - this.height / 2) / this.scale];
  }

  /** Zoom in on a place of the picture by a factor. @param {number[]} place pixels @param {number} nearness */
  zoomTo([u, v], nearness) {
    this.middle = this.toPlane(u, v);
    this.scale *= nearness;
  }

  /** A round step of about `pixels`. @param {number} pixels */
  roundStep(pixels) {
    return 10 ** Math.round(Math.log10(pixels / this.scale));
  }

  /** Round a value to the snap step, or else to a pixel. @param {number} value */
  roundToGrid(value) {
    return this.snap ? nearestMultiple(value, this.snap) : this.roundToPixel(value);
  }

  /** Round a value to a pixel. @param {number} value */
  roundToPixel(value) {
    return nearestMultiple(value, this.roundStep(0.5));
  }

  /** Run a function without snapping. @param {() => void} act @param {boolean} [really] */
  withoutSnapping(act, really = true) {
    const { snap } = this;
    if (really) this.snap = 0;
    act();
    this.snap = snap;
  }

  /** Return path data of points; unknown points break the line. @param {Point[]} points */
  pathData(points) {
    let pen = "M";
    let data = "";
    for (const [x, y] of points) {
      if (!Number.isFinite(x) || !Number.isFinite(y) || x === null || y === null) {
        pen = "M";
        continue;
      }
      const [u, v] = this.toPicture(x, y);
      data += `${pen}${u.toFixed(1)} ${v.toFixed(1)}`;
      pen = "L";
    }
    return data;
  }
}

/** Return the nearest multiple of a step. @param {number} value @param {number} step */
function nearestMultiple(value, step) {
  return Number((Math.round(value / step) * step).toPrecision(12));
}
