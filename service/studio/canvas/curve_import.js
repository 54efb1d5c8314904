/**
 * A drawing, a table or a picture that is dropped on the page or chosen: its curves are listed, and each becomes what
 * it is chosen for, the points of a path, an area of the room, or the motion of a cam's follower.
 */

import * as api from "../core/api.js";
import { createElement, formatNumber, createSvg } from "../core/dom.js";
import { describeElement, listSkipped, roundToDigits, roundCoordinate, axisSpan } from "./drawing_import.js";
import { formatBriefly } from "../design/design_metrics.js";
import { fitSegments } from "./follower_table.js";
import { t } from "../core/messages.js";
import { availableRoles, stateArea } from "./workspace.js";
import { View } from "../core/view.js";

/** @import { Problem } from "../types/values.js" */

/** @typedef {[number, number]} Point */
/** @typedef {import("../core/api.js").Curve} Curve */
/**
 * @typedef {{name: string, text: string, closed: boolean | null, most: number, state: (statement: Problem, points:
 *   Point[], closed: boolean) => void}} Use what `closed` is null of takes both
 */

const ACCEPTED_FILES = ".svg,.dxf,.csv,.png,.jpg,.jpeg,image/svg+xml,image/vnd.dxf,text/csv,image/png,image/jpeg";

/** Points that a path begins with: as many as a stroke that is drawn freehand. */
const PATH_POINT_COUNT = 24;
/** Angles of a table for a cam. */
const CAM_POINT_COUNT = 48;
const AREA_POINT_COUNT = 1000;

/** Minimum number of points for a curve; a smaller number is requested anew from the file. */
const MIN_POINTS = 3;

export class CurveImport {
  /**
   * @param {HTMLElement} place @param {import("./backdrop.js").Backdrop} backdrop
   * @param {import("../core/store.js").Store} store
   */
  constructor(place, backdrop, store) {
    this.backdrop = backdrop;
    this.store = store;
    this.chooser = createElement("input", {
      type: "file",
      id: "curve-file",
      class: "hidden",
      accept: ACCEPTED_FILES,
      "aria-label": t`Drawing, table or picture`,
      tabindex: -1,
      onchange: () => this.takeFile(this.chooser.files?.[0]),
    });
    this.button = createElement(
      "button",
      { type: "button", class: "small", id: "curve-import", onclick: () => this.chooser.click() },
      t`Import curves`,
    );
    this.hint = createElement("span", { class: "note" }, t`SVG, DXF, CSV or PNG; or drop a file anywhere on the page`);
    this.said = createElement("p", { class: "note", role: "status" });
    this.list = createElement("div", {});
    this.node = createElement(
      "div",
      { id: "curves" },
      this.chooser,
      createElement("div", { class: "row" }, this.button, this.hint),
      this.said,
      this.list,
      backdrop.node,
    );
    place.replaceChildren(this.node);
    this.acceptFiles(place.ownerDocument);
  }

  /** Accept files that are dropped anywhere on the page. @param {Document} page */
  acceptFiles(page) {
    const files = (/** @type {DragEvent} */ event) => event.dataTransfer?.types.includes("Files");
    const over = (/** @type {boolean} */ is) => page.body.classList.toggle("dropping", is);
    page.addEventListener("dragover", (event) => {
      if (!files(event)) return;
      event.preventDefault();
      over(true);
    });
    page.addEventListener("dragleave", (event) => {
      if (!event.relatedTarget) over(false);
    });
    page.addEventListener("drop", (event) => {
      if (!files(event)) return;
      event.preventDefault();
      over(false);
      this.takeFile(event.dataTransfer?.files[0]);
    });
  }

  /** What a curve can become in the statement as it is. @returns {Use[]} */
  listUses() {
    const { problem, hasWorkspace: roomy } = this.store;
    /** @type {Use[]} */
    const uses = [];
    if (problem.kind === "path") {
      uses.push({
        name: "points",
        text: t`Points of the path`,
        closed: null,
        most: PATH_POINT_COUNT,
        state: (statement, points, closed) => {
          statement.points = points.map(([x, y]) => ({ x, y }));
          statement.closed = closed;
        },
      });
    }
    if (problem.kind === "cam") {
      uses.push({
        name: "motion",
        text: t`Motion of the follower`,
        closed: false,
        most: CAM_POINT_COUNT,
        state: (statement, points) => {
          const swings = statement.follower?.type?.startsWith("oscillating");
          statement.segments = fitSegments(points, swings ? Math.PI / 180 : 1);
        },
      });
    }
    if (roomy) {
      uses.push(
        ...availableRoles(problem).map((role) => ({
          name: role.name,
          text: role.text,
          closed: true,
          most: AREA_POINT_COUNT,
          state: (/** @type {Problem} */ statement, /** @type {Point[]} */ points) =>
            void stateArea(statement, role, { polygon: points }),
        })),
      );
    }
    return uses;
  }

  /** @param {File | undefined} file */
  async takeFile(file) {
    if (!file) return;
    this.file = file;
    this.list.replaceChildren();
    if (/\.jpe?g$/i.test(file.name)) {
      await this.layBehind(file);
    } else {
      const [first] = this.listUses();
      await this.readCurves(first?.most ?? AREA_POINT_COUNT);
    }
    // Reset the input, so that a changed file can be chosen again.
    this.chooser.value = "";
  }

  /** Read the accepted file with at most `most` points for each curve. @param {number} most */
  async readCurves(most) {
    const { file } = this;
    if (!file) return;
    const unit = this.store.problem.length_unit ?? "mm";
    this.said.textContent = t`Reading ${file.name} …`;
    this.button.disabled = true;
    try {
      const found = await api.importCurves(file, unit, most);
      // An area is as it is drawn, however few points a path is to have.
      const areas =
        most < AREA_POINT_COUNT && this.listUses().some(({ closed }) => closed)
          ? await api.importCurves(file, unit, AREA_POINT_COUNT)
          : found;
      if (file === this.file) this.show(file, found, areas, unit, most);
    } catch (error) {
      const why =
        error instanceof api.Refusal
          ? error.errors.map((one) => createElement("li", {}, `${one.path.slice(1)}: ${one.detail}`))
          : [];
      this.said.textContent = `${file.name}: ${error instanceof Error ? error.message : error}`;
      // What cannot be read may still be traced over.
      this.list.replaceChildren(
        ...(why.length ? [createElement("ul", { class: "reasons" }, ...why)] : []),
        ...(/\.png$/i.test(file.name) ? [this.createLayerButton(file, null)] : []),
      );
    } finally {
      this.button.disabled = false;
    }
  }

  /**
   * The curves, each with the choice of its use.
   * @param {File} file
   * @param {api.Curves} found
   * @param {api.Curves} areas the same with more points
   * @param {string} unit
   * @param {number} most
   */
  show(file, found, areas, unit, most) {
    const uses = this.listUses();
    const { origin } = this.store;
    const scale = createElement("input", {
      type: "number",
      id: "curve-scale",
      step: "any",
      min: 0,
      value: Number(found.scale.toPrecision(9)),
      oninput: () => told(),
    });
    const count = createElement("input", {
      type: "number",
      id: "curve-points",
      step: 1,
      min: MIN_POINTS,
      max: 10000,
      value: most,
      onchange: () => this.readCurves(Math.max(MIN_POINTS, count.valueAsNumber || most)),
    });
    const laid = () => found.format === "png" && this.backdrop.picture?.name === file.name && this.backdrop.placed;
    const factor = () => (laid() || scale.valueAsNumber > 0 ? scale.valueAsNumber / found.scale : NaN);
    /** @param {Curve} curve @returns {Point[]} */
    const placed = ({ points }) =>
      points.map(({ x, y }) => {
        const [u, v] = laid()
          ? this.backdrop.toPlane([x / found.scale, y / found.scale])
          : [x * factor(), y * factor()];
        return [roundCoordinate(u), roundCoordinate(v)];
      });
    const rows = found.curves.map((curve, k) => createRow(curve, k, uses));
    const place = createElement(
      "button",
      {
        type: "button",
        class: "small",
        id: "curve-place",
        onclick: () => this.placeCurves(file.name, rows, (k, area) => placed((area ? areas : found).curves[k])),
      },
      t`Use`,
    );
    const told = () => {
      for (const { curve, size } of rows) {
        const points = placed(curve);
        const [width, height] = [axisSpan(points, 0), axisSpan(points, 1)];
        const counted = curve.closed ? t`${points.length} points, closed` : t`${points.length} points, open`;
        size.textContent = `${formatBriefly(width)} × ${formatBriefly(height)} ${unit}, ${counted}`;
        size.title = `${roundToDigits(width)} × ${roundToDigits(height)} ${unit}`;
      }
      place.disabled =
        this.store.origin !== origin || rows.every(({ use }) => !use.value) || !(laid() || Number.isFinite(factor()));
    };
    for (const { use } of rows) use.addEventListener("change", told);
    const states =
      found.format === "png" && found.length_unit === null
        ? t`the picture states no scale; one pixel is taken as ${formatNumber(found.scale)} ${unit}`
        : found.length_unit === null
          ? t`the file states no unit; its numbers are taken as ${unit}`
          : t`one unit of the file is ${formatNumber(found.millimetres_per_unit)} mm`;
    const counted = found.curves.length === 1 ? t`1 curve` : t`${found.curves.length} curves`;
    this.said.textContent = `${file.name}: ${counted}; ${states}.`;
    if (!uses.length) this.said.append(" ", t`This kind of problem takes no curves.`);
    this.list.replaceChildren(
      createElement(
        "div",
        { class: "row" },
        createElement("label", { for: "curve-scale" }, t`Scale (${unit} per unit of the file)`),
        scale,
        createElement("label", { for: "curve-points" }, t`Maximum number of points`),
        count,
      ),
      createElement("ul", { class: "drawn", "aria-label": t`Curves in ${file.name}` }, ...rows.map(({ node }) => node)),
      listSkipped(found),
      createElement(
        "div",
        { class: "row" },
        place,
        found.format === "png" && this.createLayerButton(file, found.length_unit === null ? null : found.scale),
        createElement("button", { type: "button", class: "small", onclick: () => this.close("") }, t`Close`),
      ),
    );
    this.told = told;
    told();
  }

  /** The button that lays a picture behind the canvas. @param {File} file @param {number | null} scale */
  createLayerButton(file, scale) {
    return createElement(
      "button",
      { type: "button", class: "small", id: "curve-behind", onclick: () => this.layBehind(file, scale) },
      t`Lay it behind the canvas`,
    );
  }

  /** @param {File} file @param {number | null} [scale] */
  async layBehind(file, scale = null) {
    try {
      await this.backdrop.lay(file, this.store.problem.length_unit ?? "mm", scale);
      this.said.textContent = t`${file.name} lies behind the canvas.`;
      this.told?.();
    } catch (error) {
      this.said.textContent = error instanceof Error ? error.message : String(error);
    }
  }

  /**
   * @param {string} name
   * @param {{curve: Curve, use: HTMLSelectElement}[]} rows
   * @param {(k: number, area: boolean) => Point[]} placed
   */
  placeCurves(name, rows, placed) {
    const uses = this.listUses();
    const used = rows.flatMap(({ curve, use }, k) => {
      const chosen = uses.find((one) => one.name === use.value);
      return chosen ? [{ chosen, curve, k }] : [];
    });
    const count = used.length;
    try {
      this.store.change((statement) => {
        for (const { chosen, curve, k } of used)
          chosen.state(statement, placed(k, chosen.closed === true), curve.closed);
      });
    } catch (error) {
      this.said.textContent = `${name}: ${error instanceof Error ? error.message : error}`;
      return;
    }
    this.close(count === 1 ? t`1 curve taken from ${name}.` : t`${count} curves taken from ${name}.`);
  }

  /** @param {string} said */
  close(said) {
    this.told = undefined;
    this.said.textContent = said;
    this.list.replaceChildren();
  }
}

/**
 * Create the row of a curve: thumbnail, name, size and use.
 * @param {Curve} curve
 * @param {number} k
 * @param {Use[]} uses
 */
function createRow(curve, k, uses) {
  const points = curve.points.map(({ x, y }) => /** @type {Point} */ ([x, y]));
  const view = new View(points, 46, 34, 3);
  const size = createElement("p", { class: "note" });
  const id = `curve${k}`;
  const use = createElement(
    "select",
    { id },
    createElement("option", { value: "" }, t`not used`),
    ...uses
      .filter(({ closed }) => closed === null || closed === curve.closed)
      .map(({ name, text }) => createElement("option", { value: name }, text)),
  );
  const node = createElement(
    "li",
    {},
    createSvg(
      "svg",
      { viewBox: "0 0 46 34", width: 46, height: 34, "aria-hidden": "true" },
      createSvg("path", { class: "area", d: `${view.pathData(points)}${curve.closed ? "Z" : ""}` }),
    ),
    createElement("div", {}, createElement("label", { for: id }, describeElement(curve)), size),
    use,
  );
  return { curve, node, use, size };
}
