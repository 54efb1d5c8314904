/** Import a drawing: list its outlines, assign a role to each, and place them as drawn. */

import * as api from "../core/api.js";
import { createElement, formatNumber, createSvg } from "../core/dom.js";
import { formatBriefly } from "../design/design_metrics.js";
import { outlinePath } from "./area_hatching.js";
import { localizeNumber, t } from "../core/messages.js";
import { availableRoles, stateArea } from "./workspace.js";
import { View } from "../core/view.js";

/** @import { Problem } from "../types/values.js" */

/** @typedef {[number, number]} Point */
/** @typedef {import("./workspace.js").Role} Role */
/** @typedef {import("../core/api.js").DrawnOutline} Drawn */

/** Digits of imported coordinates: more than any drawing is accurate to. */
const COORDINATE_DIGITS = 9;

export class DrawingImport {
  /**
   * @param {import("../core/store.js").Store} store
   * @param {(path: string | undefined) => void} placed called with the chosen area before anything shows it
   */
  constructor(store, placed) {
    this.store = store;
    this.placed = placed;
    this.file = createElement("input", {
      type: "file",
      id: "drawing-file",
      class: "hidden",
      accept: ".svg,.dxf,image/svg+xml,image/vnd.dxf",
      "aria-label": t`Drawing, SVG or DXF`,
      tabindex: -1,
      onchange: () => this.read(),
    });
    this.button = createElement(
      "button",
      { type: "button", class: "small", onclick: () => this.file.click() },
      t`Import drawing`,
    );
    this.said = createElement("p", { class: "note", role: "status" });
    this.list = createElement("div", {});
    /** The content below the button; it outlives the canvas. */
    this.node = createElement("div", { id: "drawing" }, this.file, this.said, this.list);
    /** @type {{before: string, after: string} | null} the room before and after what was placed last */
    this.last = null;
  }

  async read() {
    const [file] = this.file.files ?? [];
    if (!file) return;
    this.list.replaceChildren();
    this.said.textContent = t`Reading ${file.name} …`;
    this.button.disabled = true;
    try {
      this.show(file.name, await api.importOutlines(file, this.store.problem.length_unit ?? "mm"));
    } catch (error) {
      const why =
        error instanceof api.Refusal
          ? error.errors.map((one) => createElement("li", {}, `${one.path.slice(1)}: ${one.detail}`))
          : [];
      this.said.textContent = `${file.name}: ${error instanceof Error ? error.message : error}`;
      this.list.replaceChildren(...(why.length ? [createElement("ul", { class: "reasons" }, ...why)] : []));
    } finally {
      this.button.disabled = false;
      // Reset the input, so that a changed file can be chosen again.
      this.file.value = "";
    }
  }

  /** Show the outlines, each with a choice of its role. @param {string} name @param {api.Outlines} found */
  show(name, found) {
    const unit = this.store.problem.length_unit ?? "mm";
    const scale = createElement("input", {
      type: "number",
      id: "drawing-scale",
      step: "any",
      min: 0,
      value: Number(found.scale.toPrecision(COORDINATE_DIGITS)),
      oninput: () => told(),
    });
    const factor = () => (scale.valueAsNumber > 0 ? scale.valueAsNumber / found.scale : NaN);
    const rows = found.outlines.map((one, k) => this.createRow(one, k));
    const place = createElement(
      "button",
      { type: "button", class: "small", id: "drawing-place", onclick: () => this.placeOutlines(name, rows, factor()) },
      t`Place`,
    );
    const told = () => {
      for (const row of rows) row.told(factor(), unit);
      place.disabled = !Number.isFinite(factor()) || rows.every((row) => !row.use.value);
    };
    const all = createElement(
      "select",
      {
        id: "drawing-all",
        onchange: () => {
          for (const { use } of rows)
            if ([...use.options].some((one) => one.value === all.value)) use.value = all.value;
          told();
        },
      },
      ...this.createOptions(availableRoles(this.store.problem)),
    );
    for (const { use } of rows) use.addEventListener("change", told);
    const states =
      found.millimetres_per_unit === null
        ? t`the drawing states no unit; its numbers are taken as ${unit}`
        : t`one unit of the drawing is ${formatNumber(found.millimetres_per_unit)} mm`;
    const counted = found.outlines.length === 1 ? t`1 closed outline` : t`${found.outlines.length} closed outlines`;
    const rounded = t`Curves are approximated by polygons within ${formatBriefly(found.tolerance)} ${unit}.`;
    this.said.textContent = `${name}: ${counted}; ${states}. ${rounded}`;
    this.list.replaceChildren(
      createElement(
        "div",
        { class: "row" },
        createElement("label", { for: "drawing-scale" }, t`Scale (${unit} per unit of the drawing)`),
        scale,
        rows.length > 1 && createElement("label", { for: "drawing-all" }, t`Use all as`),
        rows.length > 1 && all,
      ),
      createElement("ul", { class: "drawn", "aria-label": t`Outlines in ${name}` }, ...rows.map((row) => row.node)),
      listSkipped(found),
      createElement(
        "div",
        { class: "row" },
        place,
        createElement("button", { type: "button", class: "small", onclick: () => this.close("") }, t`Close`),
      ),
    );
    told();
  }

  /**
   * Create the row of an outline: thumbnail, name, size and role.
   * @param {Drawn} one
   * @param {number} k
   */
  createRow(one, k) {
    const corners = one.polygon ?? [];
    const points = one.circle ? boundingSquare(one.circle) : corners;
    const view = new View(points, 46, 34, 3);
    const size = createElement("p", { class: "note" });
    const id = `drawn${k}`;
    const fitting = availableRoles(this.store.problem).filter(
      (role) => role.name === "box" || role.tools.includes(one.circle ? "circle" : "polygon"),
    );
    const use = createElement("select", { id }, ...this.createOptions(fitting));
    const node = createElement(
      "li",
      {},
      createSvg(
        "svg",
        { viewBox: "0 0 46 34", width: 46, height: 34, "aria-hidden": "true" },
        createSvg("path", { class: "area", d: outlinePath(view, { circle: one.circle, corners }) }),
      ),
      createElement("div", {}, createElement("label", { for: id }, describeElement(one)), size),
      use,
    );
    const told = (/** @type {number} */ factor, /** @type {string} */ unit) => {
      const [width, height] = [0, 1].map((axis) => factor * axisSpan(points, axis));
      const told = (/** @type {(value: number) => string} */ as) =>
        one.circle ? `⌀ ${as(width)} ${unit}` : `${as(width)} × ${as(height)} ${unit}`;
      size.textContent = one.circle ? told(formatBriefly) : `${told(formatBriefly)}, ${t`${corners.length} corners`}`;
      size.title = told(roundToDigits);
    };
    return { one, node, use, told };
  }

  /** @param {Role[]} roles */
  createOptions(roles) {
    return [
      createElement("option", { value: "" }, t`not placed`),
      ...roles.map((role) => createElement("option", { value: role.name }, role.text)),
    ];
  }

  /** @param {string} name @param {{one: Drawn, use: HTMLSelectElement}[]} rows @param {number} factor */
  placeOutlines(name, rows, factor) {
    const { store } = this;
    const before = serializeSpace(store.problem.space);
    const used = rows.flatMap(({ one, use }) => {
      const role = availableRoles(store.problem).find((each) => each.name === use.value);
      return role ? [{ one, role }] : [];
    });
    store.change((statement) => {
      let path;
      for (const { one, role } of used) {
        const circle = one.circle && {
          center: scalePoint(one.circle.center, factor),
          radius: roundCoordinate(one.circle.radius * factor),
        };
        const corners = (circle && role.name === "box" ? boundingSquare(circle) : (one.polygon ?? [])).map((point) =>
          circle ? point : scalePoint(point, factor),
        );
        path = stateArea(statement, role, circle && role.name !== "box" ? { circle } : { polygon: corners });
      }
      this.placed(path);
    });
    this.last = { before, after: serializeSpace(store.problem.space) };
    const count = used.length;
    this.close(`${count === 1 ? t`1 area placed from ${name}.` : t`${count} areas placed from ${name}.`} `);
    this.said.append(
      createElement(
        "button",
        { type: "button", class: "small", id: "drawing-undo", onclick: () => this.undo() },
        t`Undo`,
      ),
    );
  }

  /** Restore the previous workspace, unless it was changed since. */
  undo() {
    const { last, store } = this;
    if (!last) return;
    if (serializeSpace(store.problem.space) !== last.after) {
      this.said.textContent = t`The workspace has changed since; select the areas to remove and delete them.`;
      return;
    }
    const before = JSON.parse(last.before);
    this.last = null;
    this.close(t`Undone.`);
    store.change((statement) => {
      if (before === null) delete statement.space;
      else statement.space = before;
      this.placed(undefined);
    });
  }

  /** @param {string} said */
  close(said) {
    this.said.replaceChildren(said);
    this.list.replaceChildren();
  }
}

/** Serialize a workspace without the empty groups that the form adds. @param {Problem["space"]} space */
function serializeSpace(space) {
  const empty = (/** @type {unknown} */ value) =>
    typeof value === "object" && value !== null && !Array.isArray(value) && !Object.keys(value).length;
  return JSON.stringify(space ?? null, (_, value) =>
    value && !Array.isArray(value) && typeof value === "object"
      ? Object.fromEntries(
          Object.entries(value)
            .filter(([, inner]) => inner !== null && !empty(inner))
            .sort(),
        )
      : value,
  );
}

/**
 * List the skipped elements of a file with reasons, if there are any.
 * @param {{left_out: import("../core/api.js").SkippedElement[], left_out_count: number}} found
 */
export function listSkipped({ left_out, left_out_count }) {
  if (!left_out_count) return "";
  return createElement(
    "details",
    {},
    createElement("summary", {}, t`${left_out_count} skipped`),
    createElement(
      "ul",
      { class: "reasons" },
      ...left_out.map((one) => createElement("li", {}, `${describeElement(one)}: ${one.reason}`)),
    ),
  );
}

/** @param {{element: string, id: string | null, name: string | null, layer: string | null}} one */
export function describeElement({ element, id, name, layer }) {
  const own = [name, id].filter((text) => text !== null).join(", ") || element;
  return layer === null ? own : t`${own} on ${layer}`;
}

/**
 * Return the corners of the square around a circle.
 * @param {{center: Point, radius: number}} circle
 * @returns {Point[]}
 */
function boundingSquare({ center: [x, y], radius }) {
  return [
    [x - radius, y - radius],
    [x + radius, y - radius],
    [x + radius, y + radius],
    [x - radius, y + radius],
  ];
}

/** @param {Point[]} points @param {number} axis */
export function axisSpan(points, axis) {
  const values = points.map((point) => point[axis]);
  return Math.max(...values) - Math.min(...values);
}

/** @param {Point} point @param {number} factor @returns {Point} */
function scalePoint([x, y], factor) {
  return [roundCoordinate(x * factor), roundCoordinate(y * factor)];
}

/** @param {number} value */
export function roundCoordinate(value) {
  return Number(value.toPrecision(COORDINATE_DIGITS));
}

/** Round a coordinate to the digits of imports. @param {number} value */
export function roundToDigits(value) {
  return localizeNumber(roundCoordinate(value));
}
