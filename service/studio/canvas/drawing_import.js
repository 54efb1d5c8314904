/** A drawing that another program made: its outlines are listed, each is given a use, and they are placed as drawn. */

import * as api from "../core/api.js";
import { el, shown, svg } from "../core/dom.js";
import { brief } from "../design/design_metrics.js";
import { outline } from "./area_hatching.js";
import { number, t } from "../core/messages.js";
import { rolesOf, stateArea } from "./workspace.js";
import { View } from "../core/view.js";

/** @import { Problem } from "../types/values.js" */

/** @typedef {[number, number]} Point */
/** @typedef {import("./workspace.js").Role} Role */
/** @typedef {import("../core/api.js").Drawn} Drawn */

/** Digits of a coordinate that is placed: more than any drawing is made to. */
const DIGITS = 9;

export class DrawingImport {
  /**
   * @param {import("../core/store.js").Store} store
   * @param {(path: string | undefined) => void} placed told the area that is chosen before anything shows it
   */
  constructor(store, placed) {
    this.store = store;
    this.placed = placed;
    this.file = el("input", {
      type: "file",
      id: "drawing-file",
      class: "hidden",
      accept: ".svg,.dxf,image/svg+xml,image/vnd.dxf",
      "aria-label": t`Drawing, SVG or DXF`,
      tabindex: -1,
      onchange: () => this.read(),
    });
    this.button = el("button", { type: "button", class: "small", onclick: () => this.file.click() }, t`Import drawing`);
    this.said = el("p", { class: "note", role: "status" });
    this.list = el("div", {});
    /** What is under the button, and outlives a canvas that is made anew. */
    this.node = el("div", { id: "drawing" }, this.file, this.said, this.list);
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
      this.show(file.name, await api.outlines(file, this.store.problem.length_unit ?? "mm"));
    } catch (error) {
      const why =
        error instanceof api.Refused
          ? error.errors.map((one) => el("li", {}, `${one.path.slice(1)}: ${one.detail}`))
          : [];
      this.said.textContent = `${file.name}: ${error instanceof Error ? error.message : error}`;
      this.list.replaceChildren(...(why.length ? [el("ul", { class: "reasons" }, ...why)] : []));
    } finally {
      this.button.disabled = false;
      // The same file may have been changed, and is read again when it is chosen again.
      this.file.value = "";
    }
  }

  /** The outlines, each with the choice of its use. @param {string} name @param {api.Outlines} found */
  show(name, found) {
    const unit = this.store.problem.length_unit ?? "mm";
    const scale = el("input", {
      type: "number",
      id: "drawing-scale",
      step: "any",
      min: 0,
      value: Number(found.scale.toPrecision(DIGITS)),
      oninput: () => told(),
    });
    const factor = () => (scale.valueAsNumber > 0 ? scale.valueAsNumber / found.scale : NaN);
    const rows = found.outlines.map((one, k) => this.row(one, k));
    const place = el(
      "button",
      { type: "button", class: "small", id: "drawing-place", onclick: () => this.place(name, rows, factor()) },
      t`Place`,
    );
    const told = () => {
      for (const row of rows) row.told(factor(), unit);
      place.disabled = !Number.isFinite(factor()) || rows.every((row) => !row.use.value);
    };
    const all = el(
      "select",
      {
        id: "drawing-all",
        onchange: () => {
          for (const { use } of rows)
            if ([...use.options].some((one) => one.value === all.value)) use.value = all.value;
          told();
        },
      },
      ...this.options(rolesOf(this.store.problem)),
    );
    for (const { use } of rows) use.addEventListener("change", told);
    const states =
      found.millimetres_per_unit === null
        ? t`the drawing states no unit, and its numbers are taken as ${unit}`
        : t`a unit of the drawing is ${shown(found.millimetres_per_unit)} mm`;
    const counted = found.outlines.length === 1 ? t`1 closed outline` : t`${found.outlines.length} closed outlines`;
    const rounded = t`Curves are polygons within ${brief(found.tolerance)} ${unit}.`;
    this.said.textContent = `${name}: ${counted}; ${states}. ${rounded}`;
    this.list.replaceChildren(
      el(
        "div",
        { class: "row" },
        el("label", { for: "drawing-scale" }, t`Scale (${unit} in a unit of the drawing)`),
        scale,
        rows.length > 1 && el("label", { for: "drawing-all" }, t`All as`),
        rows.length > 1 && all,
      ),
      el("ul", { class: "drawn", "aria-label": t`Outlines in ${name}` }, ...rows.map((row) => row.node)),
      leftOut(found),
      el(
        "div",
        { class: "row" },
        place,
        el("button", { type: "button", class: "small", onclick: () => this.close("") }, t`Close`),
      ),
    );
    told();
  }

  /**
   * One outline: how it looks, what it is called, how large it is, and what it becomes.
   * @param {Drawn} one
   * @param {number} k
   */
  row(one, k) {
    const corners = one.polygon ?? [];
    const points = one.circle ? around(one.circle) : corners;
    const view = new View(points, 46, 34, 3);
    const size = el("p", { class: "note" });
    const id = `drawn${k}`;
    const fitting = rolesOf(this.store.problem).filter(
      (role) => role.name === "box" || role.tools.includes(one.circle ? "circle" : "polygon"),
    );
    const use = el("select", { id }, ...this.options(fitting));
    const node = el(
      "li",
      {},
      svg(
        "svg",
        { viewBox: "0 0 46 34", width: 46, height: 34, "aria-hidden": "true" },
        svg("path", { class: "area", d: outline(view, { circle: one.circle, corners }) }),
      ),
      el("div", {}, el("label", { for: id }, called(one)), size),
      use,
    );
    const told = (/** @type {number} */ factor, /** @type {string} */ unit) => {
      const [width, height] = [0, 1].map((axis) => factor * spread(points, axis));
      const told = (/** @type {(value: number) => string} */ as) =>
        one.circle ? `⌀ ${as(width)} ${unit}` : `${as(width)} × ${as(height)} ${unit}`;
      size.textContent = one.circle ? told(brief) : `${told(brief)}, ${t`${corners.length} corners`}`;
      size.title = told(precise);
    };
    return { one, node, use, told };
  }

  /** @param {Role[]} roles */
  options(roles) {
    return [
      el("option", { value: "" }, t`not placed`),
      ...roles.map((role) => el("option", { value: role.name }, role.text)),
    ];
  }

  /** @param {string} name @param {{one: Drawn, use: HTMLSelectElement}[]} rows @param {number} factor */
  place(name, rows, factor) {
    const { store } = this;
    const before = stated(store.problem.space);
    const used = rows.flatMap(({ one, use }) => {
      const role = rolesOf(store.problem).find((each) => each.name === use.value);
      return role ? [{ one, role }] : [];
    });
    store.change((statement) => {
      let path;
      for (const { one, role } of used) {
        const circle = one.circle && {
          center: scaled(one.circle.center, factor),
          radius: rounded(one.circle.radius * factor),
        };
        const corners = (circle && role.name === "box" ? around(circle) : (one.polygon ?? [])).map((point) =>
          circle ? point : scaled(point, factor),
        );
        path = stateArea(statement, role, circle && role.name !== "box" ? { circle } : { polygon: corners });
      }
      this.placed(path);
    });
    this.last = { before, after: stated(store.problem.space) };
    const count = used.length;
    this.close(`${count === 1 ? t`1 area placed from ${name}.` : t`${count} areas placed from ${name}.`} `);
    this.said.append(
      el("button", { type: "button", class: "small", id: "drawing-undo", onclick: () => this.undo() }, t`Undo`),
    );
  }

  /** The room as it was before; what was changed in it since then would be lost, so then it stays. */
  undo() {
    const { last, store } = this;
    if (!last) return;
    if (stated(store.problem.space) !== last.after) {
      this.said.textContent = t`The room has been changed since; choose what is to go, and delete it.`;
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

/** A room as text, without the empty groups in which the form has room for fields. @param {Problem["space"]} space */
function stated(space) {
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
 * What was left out of a file, and why; nothing where all was taken.
 * @param {{left_out: import("../core/api.js").LeftOut[], left_out_count: number}} found
 */
export function leftOut({ left_out, left_out_count }) {
  if (!left_out_count) return "";
  return el(
    "details",
    {},
    el("summary", {}, t`${left_out_count} left out`),
    el("ul", { class: "reasons" }, ...left_out.map((one) => el("li", {}, `${called(one)}: ${one.reason}`))),
  );
}

/** @param {{element: string, id: string | null, name: string | null, layer: string | null}} one */
export function called({ element, id, name, layer }) {
  const own = [name, id].filter((text) => text !== null).join(", ") || element;
  return layer === null ? own : t`${own} on ${layer}`;
}

/** Corners of the square around a circle. @param {{center: Point, radius: number}} circle @returns {Point[]} */
function around({ center: [x, y], radius }) {
  return [
    [x - radius, y - radius],
    [x + radius, y - radius],
    [x + radius, y + radius],
    [x - radius, y + radius],
  ];
}

/** @param {Point[]} points @param {number} axis */
export function spread(points, axis) {
  const values = points.map((point) => point[axis]);
  return Math.max(...values) - Math.min(...values);
}

/** @param {Point} point @param {number} factor @returns {Point} */
function scaled([x, y], factor) {
  return [rounded(x * factor), rounded(y * factor)];
}

/** @param {number} value */
export function rounded(value) {
  return Number(value.toPrecision(DIGITS));
}

/** All digits that a coordinate has when it is placed. @param {number} value */
export function precise(value) {
  return number(rounded(value));
}
