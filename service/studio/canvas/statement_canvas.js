/** Edit a problem on the canvas: drag, turn, add and remove its geometry, and sketch curves. */

import { createElement, formatNumber, createSvg } from "../core/dom.js";
import { drawStroke } from "./freehand.js";
import { drawGrid, snapSpacing } from "./grid.js";
import { Grip, moveWithKeys, dragWithPointer } from "./grip.js";
import { fixedPivotHandles, isMatchedCurve, isOpenCurve, findHandles } from "./handles.js";
import { t, term } from "../core/messages.js";
import { readPointer } from "../core/pointer.js";
import { listAreas } from "./workspace.js";
import { WorkspaceEditor } from "./workspace_editor.js";
import { Ruler } from "./ruler.js";
import { statementPointer } from "../form/form_state.js";
import { boardSize, createScene } from "./stage.js";
import { View } from "../core/view.js";
import { Zoom } from "./zoom.js";

/** @import { Problem } from "../types/values.js" */

/** @typedef {import("./handles.js").Handle} Handle */
/** @typedef {import("./handles.js").Handles} Stated */
/** @typedef {import("../core/store.js").Store} Store */

/** Height of the toolbar below a canvas, pixels. */
const TOOLS_HEIGHT = 117;

/** Height of a row of buttons without a picture, pixels. */
const BUTTONS_HEIGHT = 52;

const KNOB_ARM = 44;

/** Snap step of angles, degrees. */
const SNAP_ANGLE = 15;

/** The chosen tools; they outlive the canvas. */
const toolChoices = { grid: true, snap: false };

/**
 * State that outlives the canvas.
 * @typedef {object} CanvasState
 * @property {number} origin of the statement whose view it is
 * @property {View | null} view
 * @property {boolean} led whether the user has moved the view; otherwise it shows everything
 * @property {import("./workspace_editor.js").EditorState} room
 * @property {{ends: [[number, number], [number, number]] | null}} ruler
 */

/** Handles of a problem that cannot be read. @type {Stated} */
const NO_HANDLES = { handles: [], lines: () => [], offers: [] };

/** @type {WeakMap<HTMLElement, CanvasState>} */
const canvasState = new WeakMap();

/**
 * Draw the problem on the canvas.
 * @param {HTMLElement} place
 * @param {Store} store
 * @param {import("./backdrop.js").Backdrop} backdrop what lies behind it
 */
export function drawCanvas(place, store, backdrop) {
  const { problem, origin, hasWorkspace: roomy } = store;
  const found = readHandles(problem);
  const before = canvasState.get(place);
  const memory =
    before && before.origin === origin
      ? before
      : { origin, view: null, led: false, room: { role: before?.room.role }, ruler: { ends: null } };
  before?.room.pen?.leave();
  canvasState.set(place, memory);
  const graph = problem.kind === "function";
  const grip = place.contains(document.activeElement) ? document.activeElement?.getAttribute("data-grip") : null;
  const both = graph && roomy && found && (found.handles.length > 0 || found.add);
  const buttons = graph && roomy && found && !both;
  const [width, height] = boardSize(place, TOOLS_HEIGHT + (buttons ? BUTTONS_HEIGHT : 0));
  /** @type {[number, number]} */
  const size = [both ? width / 2 : width, height];
  const redrawn = () => drawCanvas(place, store, backdrop);
  place.replaceChildren(
    ...(found ? [drawPlane(redrawn, store, readHandles, roomy && !graph, memory, graph ? null : backdrop, size)] : []),
    // The graph of a function is not the plane of its linkage.
    ...(graph && roomy ? [drawPlane(redrawn, store, bareHandles, true, memory, backdrop, size)] : []),
  );
  if (grip)
    /** @type {SVGElement | null} */ (place.querySelector(`[data-grip="${CSS.escape(grip)}"]`))?.focus({
      preventScroll: true,
    });
}

/**
 * Return the handles of a plane that contains only the given fixed pivots.
 * @param {Problem} problem
 * @returns {Stated}
 */
function bareHandles(problem) {
  return { handles: fixedPivotHandles(problem), lines: () => [], offers: [] };
}

/**
 * A picture of a plane, and what is done in it.
 * @param {() => void} redrawn draws all of it anew
 * @param {Store} store
 * @param {(problem: Problem) => Stated | null} of what of a statement is held in it
 * @param {boolean} roomy
 * @param {CanvasState} memory
 * @param {import("./backdrop.js").Backdrop | null} backdrop
 * @param {[number, number]} room pixels
 * @returns {HTMLElement}
 */
function drawPlane(redrawn, store, of, roomy, memory, backdrop, room) {
  const { problem } = store;
  /** What is held now. @type {Stated} */
  let found = NO_HANDLES;
  const look = () => (found = of(store.problem) ?? NO_HANDLES);
  const { handles, word, add, offers, freehand, shapes = [] } = look();
  /** @param {(found: Stated, statement: Problem) => void} act @param {import("../core/store.js").Editor | null} [by] */
  const change = (act, by) => {
    store.change((statement) => act(of(statement) ?? NO_HANDLES, statement), by);
    look();
  };
  const corners = roomy ? listAreas(problem.space).flatMap((area) => area.extent) : [];
  const points = [...handles.flatMap(({ get, name }) => (name === "ground" ? [] : [get()])), ...corners];
  const fits = memory.view?.width === room[0] && memory.view.height === room[1] && memory.view.fits(points);
  const view =
    roomy && memory.view && (memory.led || fits)
      ? memory.view
      : new View(points, ...room, corners.length ? 40 : 0.2 * Math.min(...room));
  if (roomy) memory.view = view;
  view.snap = toolChoices.snap ? snapSpacing(view) : 0;
  const picture = createScene(view, t`The problem in the plane`, [], { held: true, whole: true });
  const trail = createSvg("path", { class: "trail" });
  const pen = createSvg("path", { class: "pen" });
  const areasOf = roomy ? new WorkspaceEditor(picture, view, store, memory.room) : null;
  picture.append(
    createSvg("rect", { class: "paper", ...view.bounds }),
    ...(backdrop?.draw(view, picture) ?? []),
    ...(toolChoices.grid ? drawGrid(view) : []),
    ...(areasOf ? [areasOf.node] : []),
    trail,
    pen,
  );
  const redraw = () =>
    trail.setAttribute(
      "d",
      found
        .lines()
        .map((line) => view.pathData(line))
        .join(""),
    );
  const show = () => {
    for (const one of drawn) one.show();
    redraw();
  };
  const drawn = handles.map((_, k) =>
    createHandle(`${word ?? "handle"}${k}`, view, picture, {
      handle: () => found.handles[k],
      change: (act) => {
        change(({ handles }) => act(handles[k]), "canvas");
        updateFields(store.problem, found.handles[k].path);
        show();
      },
      remove: () => change(({ handles }) => handles[k].remove?.()),
      left: () => store.notifySettled(),
    }),
  );
  picture.append(...drawn.map((one) => one.group));
  show();
  // Coordinates of a graph are no lengths.
  const ruler =
    word === "pair"
      ? null
      : new Ruler(
          picture,
          view,
          problem.length_unit ?? "mm",
          () => found.handles.map((one) => one.get()),
          memory.ruler,
        );
  const toggle = (/** @type {"grid" | "snap"} */ name, /** @type {string} */ text, /** @type {string} */ title) =>
    createElement(
      "button",
      {
        type: "button",
        class: "small",
        title,
        "aria-pressed": String(toolChoices[name]),
        "data-tool": name,
        onclick: () => {
          toolChoices[name] = !toolChoices[name];
          redrawn();
        },
      },
      text,
    );
  const chosen = createElement(
    "div",
    { class: "canvas-tools", role: "group", "aria-label": t`Tools of the canvas` },
    ...shapes.map(({ text, title }, k) =>
      createElement(
        "button",
        {
          type: "button",
          class: "small",
          title,
          onclick: () => change(({ shapes = [] }) => shapes[k].make((value) => view.roundToPixel(value))),
        },
        text,
      ),
    ),
    toggle("grid", t`Grid`, t`Lines at round coordinates`),
    toggle(
      "snap",
      t`Snap`,
      t`Coordinates snap to ${formatNumber(snapSpacing(view))}, angles to ${SNAP_ANGLE}°; hold Alt to disable`,
    ),
    ruler?.button,
  );

  const mode = createElement("input", { type: "checkbox", id: "freehand" });
  // Somewhere else the plane is drawn anew: its lines, and what coordinates are rounded to, are those of the new scale.
  const zoom =
    roomy && backdrop
      ? new Zoom(picture, {
          busy: () => mode.checked,
          settled: (seen) => {
            if (seen) view.zoomTo(seen.middle, seen.nearness);
            Object.assign(memory, { view: seen && view, led: seen !== null });
            redrawn();
          },
        })
      : null;
  const put = (/** @type {[number, number]} */ [x, y]) => {
    change(({ add }) => add?.(view.roundToGrid(x), view.roundToGrid(y)));
  };
  if (add) {
    picture.addEventListener("dblclick", (/** @type {MouseEvent} */ event) => {
      if (!mode.checked) put(view.toPlaneFromPointer(picture, event));
    });
  }
  picture.addEventListener("pointerdown", (/** @type {PointerEvent} */ event) => {
    if (!mode.checked) return;
    drawStroke(event, view, picture, pen, (way, closed) => {
      change((_, statement) => {
        statement.points = way.map(([x, y]) => ({ x, y }));
        if (closed) isMatchedCurve(statement);
        else isOpenCurve(statement);
      });
    });
  });
  const last = handles.at(-1)?.get() ?? [0, 0];
  const size = (0.4 * Math.min(view.width, 640)) / view.scale;
  const how = [
    freehand && problem.closed && t`Closed: the designs match the whole curve.`,
    handles.some((one) => one.turn) ? t`Drag to move, drag the end to turn.` : t`Drag to move.`,
    add && t`Double-click to add one.`,
  ]
    .filter(Boolean)
    .join(" ");
  // An empty plane says nothing: what may be placed in it stands below.
  picture.toggleAttribute("hidden", !handles.length && !add && !roomy);
  if (picture.hasAttribute("hidden")) chosen.hidden = true;
  return createElement(
    "div",
    { class: "plane" },
    createElement("div", { class: "stage" }, picture, chosen),
    createElement(
      "div",
      { class: "bar" },
      createElement(
        "div",
        { class: "row" },
        add &&
          createElement(
            "button",
            { type: "button", class: "small", onclick: () => put([last[0] + 40 / view.scale, last[1]]) },
            t`Add a ${term(word ?? "")}`,
          ),
        ...offers.map(({ text }, k) =>
          createElement(
            "button",
            {
              type: "button",
              class: "small",
              onclick: () => {
                const middle = /** @type {[number, number]} */ (view.middle.map((one) => view.roundToGrid(one)));
                change(({ offers }) => offers[k].make(middle, view.roundToGrid(size)));
              },
            },
            text,
          ),
        ),
        freehand && createElement("label", { class: "flag", for: "freehand" }, mode, t`Draw freehand`),
        zoom?.buttons,
        handles.length > 0 && createElement("span", { class: "note", title: how }, how),
      ),
      areasOf?.tools,
    ),
  );
}

/** What can be held; nothing while the JSON is not what its kind has. @param {Problem} problem */
function readHandles(problem) {
  try {
    const found = findHandles(problem);
    found?.lines();
    return found;
  } catch (error) {
    if (error instanceof TypeError) return null;
    throw error;
  }
}

/** The fields of the form go along with what is led. @param {Problem} problem @param {string | undefined} path */
function updateFields(problem, path) {
  for (const field of path ? ["x", "y", "angle"] : []) {
    const box = document.querySelector(`[data-path="${path}/${field}"]`);
    const value = readPointer(problem, statementPointer(`${path}/${field}`));
    if (box instanceof HTMLInputElement && value !== undefined) box.value = String(value);
  }
}

/**
 * A handle on the canvas: a dot, and a knob where it turns.
 * @param {string} key @param {View} view @param {SVGSVGElement} picture
 * @param {object} on
 * @param {() => Handle} on.handle as it is now
 * @param {(act: (handle: Handle) => void) => void} on.change what it is the handle of
 * @param {() => void} on.remove
 * @param {() => void} on.left it is let go
 */
function createHandle(key, view, picture, { handle, change, remove, left }) {
  const { name, label, turn, remove: removable } = handle();
  const grip = new Grip({ name, beside: [12, 20], radius: 8, key });
  const group = grip.node;
  const line = createSvg("line", { class: "arm" });
  const [end, knob] = turn
    ? [createSvg("circle", { class: "hit", r: 12 }), createSvg("circle", { class: "knob", r: 7 })]
    : [null, null];
  group.prepend(line);
  if (end && knob) group.append(end, knob);
  const show = () => {
    const { get, turn } = handle();
    const [x, y] = get();
    const [u, v] = view.toPicture(x, y);
    grip.moveTo([u, v]);
    const turned = turn ? `, ${t`angle ${formatNumber(turn.get())}°`}` : "";
    const keys = [t`Arrow keys move it`, turn && t`Page keys turn it`, removable && t`Delete removes it`];
    grip.setLabel(`${label}: x ${formatNumber(x)}, y ${formatNumber(y)}${turned}. ${keys.filter(Boolean).join(", ")}.`);
    if (!knob || !end || !turn) return;
    const angle = (turn.get() * Math.PI) / 180;
    const [ku, kv] = [u + KNOB_ARM * Math.cos(angle), v - KNOB_ARM * Math.sin(angle)];
    for (const one of [knob, end]) {
      one.setAttribute("cx", String(ku));
      one.setAttribute("cy", String(kv));
    }
    for (const [attribute, value] of Object.entries({ x1: u, y1: v, x2: ku, y2: kv }))
      line.setAttribute(attribute, String(value));
  };
  /** @param {SVGElement} part @param {(handle: Handle, at: [number, number]) => void} moved */
  const lead = (part, moved) =>
    dragWithPointer(part, picture, view, {
      led: (at, now) => view.withoutSnapping(() => change((one) => moved(one, at)), now.altKey),
      left,
    });
  for (const one of [grip.dot, grip.hit])
    lead(one, (handle, [x, y]) => handle.put(view.roundToGrid(x), view.roundToGrid(y)));
  if (knob && end) {
    for (const one of [knob, end]) {
      lead(one, ({ get, turn }, [x, y]) => {
        const [px, py] = get();
        const step = view.snap ? SNAP_ANGLE : 1;
        turn?.set(step * Math.round((Math.atan2(y - py, x - px) * 180) / Math.PI / step));
      });
    }
  }
  moveWithKeys(group, view, {
    moved: ([dx, dy]) =>
      change(({ get, put }) => {
        const [x, y] = get();
        put(view.roundToPixel(x + dx), view.roundToPixel(y + dy));
      }),
    turned: turn && ((by) => change(({ turn }) => turn?.set(turn.get() + by))),
    removed: removable && remove,
  });
  return { group, show };
}
