/**
 * The room on the canvas of a statement: areas are drawn, chosen, moved, shaped and removed, with the pointer and by
 * keys.
 */

import { formatPoints } from "../form/controls.js";
import { createElement, formatNumber, createSvg, toWords } from "../core/dom.js";
import { DrawingImport } from "./drawing_import.js";
import { Grip, moveWithKeys, dragWithPointer } from "./grip.js";
import { createHatch, createLegend, outlinePath } from "./area_hatching.js";
import { t } from "../core/messages.js";
import { Pen } from "./pen.js";
import { listAreas, availableRoles, stateArea } from "./workspace.js";

/** @typedef {[number, number]} Point */
/** @typedef {import("./workspace.js").Area} Area */
/** @typedef {import("./workspace.js").Tool} Tool */

/** Minimum length of a drag, pixels. */
const MIN_DRAG = 3;

const TOOLS = /** @type {Tool[]} */ (["polygon", "rectangle", "circle"]);

/**
 * What outlives a canvas that is made anew.
 * @typedef {object} EditorState
 * @property {string} [chosen] JSON pointer of the area that is chosen
 * @property {string} [role] that is drawn next
 * @property {Pen | null} [pen]
 * @property {DrawingImport} [drawing] that is being imported
 */

export class WorkspaceEditor {
  /**
   * @param {SVGSVGElement} picture @param {import("../core/view.js").View} view @param
   *   {import("../core/store.js").Store} store
   * @param {EditorState} memory
   */
  constructor(picture, view, store, memory) {
    this.picture = picture;
    this.view = view;
    this.store = store;
    this.memory = memory;
    this.areas = listAreas(store.problem.space);
    memory.pen?.leave();
    memory.pen = null;
    this.node = createSvg("g", { class: "room" }, ...this.areas.map((area) => this.createAreaHandle(area)));
    this.said = createElement("p", { class: "note", role: "status" });
    // What was found in a drawing stands there until it is placed; it speaks to the canvas as it is then.
    this.drawing = memory.drawing ??= new DrawingImport(store, () => {});
    this.drawing.placed = (path) => {
      memory.chosen = path;
      this.putPenAway();
    };
    this.tools = this.createToolbar();
    this.putPenAway();
  }

  get chosen() {
    return this.areas.find((one) => one.path === this.memory.chosen);
  }

  /** An area as it is now. @param {string} path @returns {Area} */
  findArea(path) {
    return /** @type {Area} */ (this.areas.find((one) => one.path === path));
  }

  /**
   * @param {string} path of an area
   * @param {(area: Area) => void} act
   * @param {import("../core/store.js").Editor | null} [by]
   */
  change(path, act, by = null) {
    this.store.change((statement) => {
      const area = listAreas(statement.space).find((one) => one.path === path);
      if (area) act(area);
    }, by);
    this.areas = listAreas(this.store.problem.space);
  }

  /** What draws: the role first, then the shape. */
  createToolbar() {
    const { memory } = this;
    const roles = availableRoles(this.store.problem);
    const role = () => roles.find((one) => one.name === pick.value) ?? roles[0];
    const pick = createElement(
      "select",
      {
        id: "room-role",
        onchange: () => {
          memory.role = pick.value;
          this.putPenAway();
          fit();
        },
      },
      ...roles.map((one) => createElement("option", { value: one.name }, one.text)),
    );
    pick.value = (roles.find((one) => one.name === memory.role) ?? roles[0]).name;
    const buttons = TOOLS.map((tool) =>
      createElement(
        "button",
        {
          type: "button",
          class: "small",
          "aria-pressed": "false",
          "data-tool": tool,
          onclick: () => {
            const again = memory.pen?.tool === tool;
            this.putPenAway();
            if (!again) this.takePen(role(), tool);
          },
        },
        toWords(tool),
      ),
    );
    const fit = () => buttons.forEach((button, k) => (button.disabled = !role().tools.includes(TOOLS[k])));
    fit();
    this.remover = createElement(
      "button",
      {
        type: "button",
        class: "small",
        disabled: !this.chosen,
        onclick: () => {
          if (this.chosen) this.remove(this.chosen);
        },
      },
      t`Delete`,
    );
    const used = roles.filter((one) => this.areas.some((area) => area.role === one));
    return createElement(
      "fieldset",
      { class: "choice", id: "room-tools" },
      createElement("legend", {}, t`Workspace`),
      createElement(
        "div",
        { class: "row" },
        createElement("label", { for: "room-role" }, t`Draw`),
        pick,
        createElement("div", { class: "row", role: "group", "aria-label": t`Shape` }, ...buttons),
        this.remover,
        this.drawing.button,
      ),
      this.said,
      this.drawing.node,
      used.length > 0 && createLegend(used),
    );
  }

  /** Take the pen. @param {import("./workspace.js").Role} role @param {Tool} tool */
  takePen(role, tool) {
    this.memory.pen = new Pen(this.picture, this.view, role.name, tool, {
      tell: (text) => (this.said.textContent = text),
      left: () => this.putPenAway(),
      done: (zone) => {
        // It is chosen, and the pen away, when the canvas is made anew.
        this.store.change((statement) => {
          this.memory.chosen = stateArea(statement, role, zone);
          this.putPenAway();
        });
      },
    });
    this.tools.querySelector(`[data-tool="${tool}"]`)?.setAttribute("aria-pressed", "true");
    this.picture.classList.add("drawing");
    // What is drawn on must be seen.
    this.picture.scrollIntoView({ block: "nearest" });
  }

  /** Put the pen away. */
  putPenAway() {
    this.memory.pen?.leave();
    this.memory.pen = null;
    this.picture.classList.remove("drawing");
    this.describeActions();
    for (const button of this.tools.querySelectorAll("[data-tool]")) button.setAttribute("aria-pressed", "false");
  }

  /** What can be done now. */
  describeActions() {
    const { chosen } = this;
    const ways = [
      chosen?.circle ? t`drag it or its radius` : t`drag it or its corners`,
      chosen?.hasFreeCorners && t`double-click a side for another corner`,
    ];
    this.said.textContent = !chosen
      ? t`Choose what to draw and a shape, then draw it in the picture.`
      : `${chosen.label}: ${ways.filter(Boolean).join("; ")}.`;
  }

  /** @param {Area} area */
  choose(area) {
    if (this.memory.chosen === area.path) return;
    this.memory.chosen = area.path;
    this.node.replaceChildren(...this.areas.map((one) => this.createAreaHandle(one)));
    if (this.remover) this.remover.disabled = false;
    this.describeActions();
  }

  /** @param {Area} area */
  remove(area) {
    this.memory.chosen = undefined;
    this.change(area.path, (one) => one.remove());
  }

  /** An area that can be taken hold of, with its corners where it is chosen. @param {Area} area */
  createAreaHandle(area) {
    const { path } = area;
    const chosen = path === this.memory.chosen;
    const shape = createHatch(area.role.name);
    const mark = createSvg("text", { class: `area-mark ${area.role.name}` }, area.role.mark);
    const body = createSvg(
      "g",
      { class: `held ${chosen ? "chosen" : ""}`, tabindex: 0, role: "button", "data-grip": path },
      shape,
      mark,
    );
    const grips = chosen ? this.createGrips(area, () => show()) : [];
    const show = () => {
      const { circle, corners, label, labelPoint: top } = this.findArea(path);
      shape.setAttribute("d", outlinePath(this.view, { circle, corners }));
      const [u, v] = this.view.toPicture(...top);
      mark.setAttribute("x", String(u));
      mark.setAttribute("y", String(v));
      const what = circle ? t`circle of radius ${formatNumber(circle.radius)}` : t`${corners.length} corners`;
      body.setAttribute("aria-label", `${label}, ${what}. ${t`Arrow keys move it, Delete removes it.`}`);
      for (const grip of grips) grip.show();
    };
    const shift = (/** @type {Point} */ by) => {
      this.change(path, (one) => one.shift(by, (value) => this.view.roundToPixel(value)), "canvas");
      this.updateFields(this.findArea(path));
      show();
    };
    this.followPointer(body, () => this.choose(area), shift, path);
    body.addEventListener("focus", () => {
      if (!body.matches(":focus-visible") || this.memory.chosen === path) return;
      this.choose(area);
      this.focus(path);
    });
    if (area.hasFreeCorners)
      body.addEventListener("dblclick", (/** @type {MouseEvent} */ event) => this.splitSide(area, event));
    this.followKeys(body, shift, () => this.remove(area));
    show();
    return createSvg("g", {}, body, ...grips.map((one) => one.node));
  }

  /** The fields of the form go with what is moved. @param {Area} area */
  updateFields(area) {
    const { path, circle } = area;
    const shape = ["box", "body"].includes(area.role.name) ? "" : "/polygon";
    const says = circle
      ? { [`${path}/circle/center`]: circle.center.join(", "), [`${path}/circle/radius`]: String(circle.radius) }
      : { [path + shape]: formatPoints(area.role.name === "box" ? area.value : area.corners) };
    for (const [field, text] of Object.entries(says)) {
      const box = document.querySelector(`[data-path="${field}"]`);
      if (box instanceof HTMLInputElement || box instanceof HTMLTextAreaElement) box.value = text;
    }
  }

  /** A double click on a side makes another corner. @param {Area} area @param {MouseEvent} event */
  splitSide(area, event) {
    event.stopPropagation();
    const at = this.view.toPlaneFromPointer(this.picture, event);
    const { corners } = area;
    const away = corners.map((corner, k) => distanceToSide(at, corner, corners[(k + 1) % corners.length]));
    const k = away.indexOf(Math.min(...away));
    if (this.view.scale * away[k] > 10) return;
    this.change(area.path, (one) => one.insertCorner(k, [this.view.roundToGrid(at[0]), this.view.roundToGrid(at[1])]));
  }

  /**
   * The corners of an area, or the end of a circle's radius.
   * @param {Area} area
   * @param {() => void} all shows all of it
   */
  createGrips({ path, circle, corners, hasFreeCorners: free, label }, all) {
    const { view } = this;
    /** @type {{name: string, get: (area: Area) => Point, put: (area: Area, point: Point) => void}[]} */
    const places = circle
      ? [
          {
            name: t`Radius of ${label}`,
            get: ({ circle }) => (circle ? [circle.center[0] + circle.radius, circle.center[1]] : [0, 0]),
            put: ({ circle }, [x, y]) => {
              if (!circle) return;
              const radius = Number(Math.hypot(x - circle.center[0], y - circle.center[1]).toPrecision(4));
              if (radius > 0) circle.radius = radius;
            },
          },
        ]
      : corners.map((_, k) => ({
          name: t`Corner ${k + 1} of ${label}`,
          get: (area) => area.corners[k],
          put: (area, point) => area.moveCorner(k, point),
        }));
    return places.map(({ name, get, put }, k) => {
      const key = `${path}#${k}`;
      const grip = new Grip({ kind: "grip", dot: "corner", radius: 5, key });
      const show = () => {
        const [x, y] = get(this.findArea(path));
        grip.moveTo(view.toPicture(x, y));
        const more = free && corners.length > 3 ? t`Arrow keys move it, Delete removes it.` : t`Arrow keys move it.`;
        grip.setLabel(`${name}: x ${formatNumber(x)}, y ${formatNumber(y)}. ${more}`);
      };
      const move = (/** @type {Point} */ [dx, dy]) => {
        const moved = (/** @type {Area} */ area) => {
          const [x, y] = get(area);
          put(area, [view.roundToGrid(x + dx), view.roundToGrid(y + dy)]);
        };
        this.change(path, moved, "canvas");
        this.updateFields(this.findArea(path));
        all();
      };
      this.followPointer(grip.node, () => {}, move, key);
      this.followKeys(grip.node, move, () => this.change(path, (area) => area.removeCorner(k)));
      return { node: grip.node, show };
    });
  }

  /**
   * What is dragged by the pointer: each step is taken from where it was let go.
   * @param {SVGElement} grip
   * @param {() => void} taken
   * @param {(by: Point) => void} move
   * @param {string} key
   */
  followPointer(grip, taken, move, key) {
    const { picture, view } = this;
    /** @type {Point} */
    let before = [0, 0];
    let moved = false;
    dragWithPointer(grip, picture, view, {
      taken: (at) => {
        before = at;
        moved = false;
      },
      led: (at, now) => {
        const by = /** @type {Point} */ ([at[0] - before[0], at[1] - before[1]].map((one) => view.roundToGrid(one)));
        if (!moved && view.scale * Math.hypot(...by) < MIN_DRAG) return;
        moved = true;
        before = [before[0] + by[0], before[1] + by[1]];
        view.withoutSnapping(() => move(by), now.altKey);
      },
      left: () => {
        taken();
        if (moved) this.store.notifySettled();
        else this.focus(key);
      },
    });
  }

  /** @param {SVGElement} grip @param {(by: Point) => void} move @param {() => void} remove */
  followKeys(grip, move, remove) {
    moveWithKeys(grip, this.view, {
      moved: (by) => this.view.withoutSnapping(() => move(by)),
      removed: remove,
    });
  }

  /** @param {string} key */
  focus(key) {
    /** @type {SVGElement | null} */ (this.picture.querySelector(`[data-grip="${CSS.escape(key)}"]`))?.focus({
      preventScroll: true,
    });
  }
}

/** From a point to the side between two corners. @param {Point} point @param {Point} from @param {Point} to */
function distanceToSide([x, y], [ax, ay], [bx, by]) {
  const [dx, dy] = [bx - ax, by - ay];
  const share = Math.min(1, Math.max(0, ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1)));
  return Math.hypot(x - ax - share * dx, y - ay - share * dy);
}
