/**
 * A statement on a canvas: what it places in the plane is dragged, turned, added and removed, and curves are sketched.
 */

import { el, shown, svg } from "../core/dom.js";
import { stroke } from "./freehand.js";
import { grid, snapping } from "./grid.js";
import { Grip, keyed, led } from "./grip.js";
import { chosenPivots, matched, opened, stated } from "./handles.js";
import { t, term } from "../core/messages.js";
import { at } from "../core/pointer.js";
import { areas } from "./workspace.js";
import { RoomEditor } from "./workspace_editor.js";
import { Ruler } from "./ruler.js";
import { within } from "../form/form_state.js";
import { roomOf, scene } from "./stage.js";
import { View } from "../core/view.js";
import { Zoom } from "./zoom.js";

/** @import { Problem } from "../types/values.js" */

/** @typedef {import("./handles.js").Handle} Handle */
/** @typedef {import("./handles.js").Stated} Stated */
/** @typedef {import("../core/store.js").Store} Store */

/** Height of the tools below a canvas, pixels. */
const TOOLS = 117;

/** The same of a row of buttons that stands without a picture. */
const BUTTONS = 52;

const ARM = 44;

/** What angles snap to, degrees. */
const SNAP_TURN = 15;

/** What somebody has chosen of the tools; it outlives every canvas. */
const tools = { grid: true, snap: false };

/**
 * What of a canvas outlives its being made anew.
 * @typedef {object} Kept
 * @property {number} origin of the statement whose view it is
 * @property {View | null} view
 * @property {boolean} led whether somebody has led the view somewhere; otherwise all is to be seen
 * @property {import("./workspace_editor.js").Memory} room
 * @property {{ends: [[number, number], [number, number]] | null}} ruler
 */

/** Where the statement cannot be read there is nothing to hold. @type {Stated} */
const NOTHING = { handles: [], lines: () => [], offers: [] };

/** @type {WeakMap<HTMLElement, Kept>} */
const kept = new WeakMap();

/**
 * Draw what is stated on the canvas.
 * @param {HTMLElement} place
 * @param {Store} store
 * @param {import("./backdrop.js").Backdrop} backdrop what lies behind it
 */
export function canvas(place, store, backdrop) {
  const { problem, origin, roomy } = store;
  const found = readable(problem);
  const before = kept.get(place);
  const memory =
    before && before.origin === origin
      ? before
      : { origin, view: null, led: false, room: { role: before?.room.role }, ruler: { ends: null } };
  before?.room.pen?.leave();
  kept.set(place, memory);
  const graph = problem.kind === "function";
  const grip = place.contains(document.activeElement) ? document.activeElement?.getAttribute("data-grip") : null;
  const both = graph && roomy && found && (found.handles.length > 0 || found.add);
  const buttons = graph && roomy && found && !both;
  const [width, height] = roomOf(place, TOOLS + (buttons ? BUTTONS : 0));
  /** @type {[number, number]} */
  const size = [both ? width / 2 : width, height];
  const redrawn = () => canvas(place, store, backdrop);
  place.replaceChildren(
    ...(found ? [drawnPlane(redrawn, store, readable, roomy && !graph, memory, graph ? null : backdrop, size)] : []),
    // The graph of a function is not the plane in which its linkage lies.
    ...(graph && roomy ? [drawnPlane(redrawn, store, bare, true, memory, backdrop, size)] : []),
  );
  if (grip)
    /** @type {SVGElement | null} */ (place.querySelector(`[data-grip="${CSS.escape(grip)}"]`))?.focus({
      preventScroll: true,
    });
}

/**
 * A plane in which nothing is placed but the fixed pivots, where they are chosen.
 * @param {Problem} problem
 * @returns {Stated}
 */
function bare(problem) {
  return { handles: chosenPivots(problem), lines: () => [], offers: [] };
}

/**
 * A picture of a plane, and what is done in it.
 * @param {() => void} redrawn draws all of it anew
 * @param {Store} store
 * @param {(problem: Problem) => Stated | null} of what of a statement is held in it
 * @param {boolean} roomy
 * @param {Kept} memory
 * @param {import("./backdrop.js").Backdrop | null} backdrop
 * @param {[number, number]} room pixels
 * @returns {HTMLElement}
 */
function drawnPlane(redrawn, store, of, roomy, memory, backdrop, room) {
  const { problem } = store;
  /** What is held now. @type {Stated} */
  let found = NOTHING;
  const look = () => (found = of(store.problem) ?? NOTHING);
  const { handles, word, add, offers, freehand, shapes = [] } = look();
  /** @param {(found: Stated, statement: Problem) => void} act @param {import("../core/store.js").Editor | null} [by] */
  const change = (act, by) => {
    store.change((statement) => act(of(statement) ?? NOTHING, statement), by);
    look();
  };
  const corners = roomy ? areas(problem.space).flatMap((area) => area.extent) : [];
  const points = [...handles.flatMap(({ get, name }) => (name === "ground" ? [] : [get()])), ...corners];
  const fits = memory.view?.width === room[0] && memory.view.height === room[1] && memory.view.suits(points);
  const view =
    roomy && memory.view && (memory.led || fits)
      ? memory.view
      : new View(points, ...room, corners.length ? 40 : 0.2 * Math.min(...room));
  if (roomy) memory.view = view;
  view.snap = tools.snap ? snapping(view) : 0;
  const picture = scene(view, t`The problem in the plane`, [], { held: true, whole: true });
  const trail = svg("path", { class: "trail" });
  const pen = svg("path", { class: "pen" });
  const areasOf = roomy ? new RoomEditor(picture, view, store, memory.room) : null;
  picture.append(
    svg("rect", { class: "paper", ...view.room }),
    ...(backdrop?.drawn(view, picture) ?? []),
    ...(tools.grid ? grid(view) : []),
    ...(areasOf ? [areasOf.node] : []),
    trail,
    pen,
  );
  const redraw = () =>
    trail.setAttribute(
      "d",
      found
        .lines()
        .map((line) => view.path(line))
        .join(""),
    );
  const show = () => {
    for (const one of drawn) one.show();
    redraw();
  };
  const drawn = handles.map((_, k) =>
    held(`${word ?? "handle"}${k}`, view, picture, {
      handle: () => found.handles[k],
      change: (act) => {
        change(({ handles }) => act(handles[k]), "canvas");
        told(store.problem, found.handles[k].path);
        show();
      },
      remove: () => change(({ handles }) => handles[k].remove?.()),
      left: () => store.settle(),
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
    el(
      "button",
      {
        type: "button",
        class: "small",
        title,
        "aria-pressed": String(tools[name]),
        "data-tool": name,
        onclick: () => {
          tools[name] = !tools[name];
          redrawn();
        },
      },
      text,
    );
  const chosen = el(
    "div",
    { class: "canvas-tools", role: "group", "aria-label": t`Tools of the canvas` },
    ...shapes.map(({ text, title }, k) =>
      el(
        "button",
        {
          type: "button",
          class: "small",
          title,
          onclick: () => change(({ shapes = [] }) => shapes[k].make((value) => view.fine(value))),
        },
        text,
      ),
    ),
    toggle("grid", t`Grid`, t`Lines at round coordinates`),
    toggle("snap", t`Snap`, t`Places snap to ${shown(snapping(view))}, angles to ${SNAP_TURN}°; Alt lets them be`),
    ruler?.button,
  );

  const mode = el("input", { type: "checkbox", id: "freehand" });
  // Somewhere else the plane is drawn anew: its lines, and what coordinates are rounded to, are those of the new scale.
  const zoom =
    roomy && backdrop
      ? new Zoom(picture, {
          busy: () => mode.checked,
          settled: (seen) => {
            if (seen) view.look(seen.middle, seen.nearness);
            Object.assign(memory, { view: seen && view, led: seen !== null });
            redrawn();
          },
        })
      : null;
  const put = (/** @type {[number, number]} */ [x, y]) => {
    change(({ add }) => add?.(view.rounded(x), view.rounded(y)));
  };
  if (add) {
    picture.addEventListener("dblclick", (/** @type {MouseEvent} */ event) => {
      if (!mode.checked) put(view.under(picture, event));
    });
  }
  picture.addEventListener("pointerdown", (/** @type {PointerEvent} */ event) => {
    if (!mode.checked) return;
    stroke(event, view, picture, pen, (way, closed) => {
      change((_, statement) => {
        statement.points = way.map(([x, y]) => ({ x, y }));
        if (closed) matched(statement);
        else opened(statement);
      });
    });
  });
  const last = handles.at(-1)?.get() ?? [0, 0];
  const size = (0.4 * Math.min(view.width, 640)) / view.scale;
  const how = [
    freehand && problem.closed && t`Closed: the whole curve is matched.`,
    handles.some((one) => one.turn) ? t`Drag to move, drag the end to turn.` : t`Drag to move.`,
    add && t`A double click adds one.`,
  ]
    .filter(Boolean)
    .join(" ");
  // An empty plane says nothing: what may be placed in it stands below.
  picture.toggleAttribute("hidden", !handles.length && !add && !roomy);
  if (picture.hasAttribute("hidden")) chosen.hidden = true;
  return el(
    "div",
    { class: "plane" },
    el("div", { class: "stage" }, picture, chosen),
    el(
      "div",
      { class: "bar" },
      el(
        "div",
        { class: "row" },
        add &&
          el(
            "button",
            { type: "button", class: "small", onclick: () => put([last[0] + 40 / view.scale, last[1]]) },
            t`Add a ${term(word ?? "")}`,
          ),
        ...offers.map(({ text }, k) =>
          el(
            "button",
            {
              type: "button",
              class: "small",
              onclick: () => {
                const middle = /** @type {[number, number]} */ (view.middle.map((one) => view.rounded(one)));
                change(({ offers }) => offers[k].make(middle, view.rounded(size)));
              },
            },
            text,
          ),
        ),
        freehand && el("label", { class: "flag", for: "freehand" }, mode, t`Draw freehand`),
        zoom?.buttons,
        handles.length > 0 && el("span", { class: "note", title: how }, how),
      ),
      areasOf?.tools,
    ),
  );
}

/** What can be held; nothing while the JSON is not what its kind has. @param {Problem} problem */
function readable(problem) {
  try {
    const found = stated(problem);
    found?.lines();
    return found;
  } catch (error) {
    if (error instanceof TypeError) return null;
    throw error;
  }
}

/** The fields of the form go along with what is led. @param {Problem} problem @param {string | undefined} path */
function told(problem, path) {
  for (const field of path ? ["x", "y", "angle"] : []) {
    const box = document.querySelector(`[data-path="${path}/${field}"]`);
    const value = at(problem, within(`${path}/${field}`));
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
function held(key, view, picture, { handle, change, remove, left }) {
  const { name, label, turn, remove: removable } = handle();
  const grip = new Grip({ name, beside: [12, 20], radius: 8, key });
  const group = grip.node;
  const line = svg("line", { class: "arm" });
  const [end, knob] = turn
    ? [svg("circle", { class: "hit", r: 12 }), svg("circle", { class: "knob", r: 7 })]
    : [null, null];
  group.prepend(line);
  if (end && knob) group.append(end, knob);
  const show = () => {
    const { get, turn } = handle();
    const [x, y] = get();
    const [u, v] = view.at(x, y);
    grip.put([u, v]);
    const turned = turn ? `, ${t`angle ${shown(turn.get())}°`}` : "";
    const keys = [t`Arrow keys move it`, turn && t`page keys turn it`, removable && t`Delete removes it`];
    grip.call(`${label}: x ${shown(x)}, y ${shown(y)}${turned}. ${keys.filter(Boolean).join(", ")}.`);
    if (!knob || !end || !turn) return;
    const angle = (turn.get() * Math.PI) / 180;
    const [ku, kv] = [u + ARM * Math.cos(angle), v - ARM * Math.sin(angle)];
    for (const one of [knob, end]) {
      one.setAttribute("cx", String(ku));
      one.setAttribute("cy", String(kv));
    }
    for (const [attribute, value] of Object.entries({ x1: u, y1: v, x2: ku, y2: kv }))
      line.setAttribute(attribute, String(value));
  };
  /** @param {SVGElement} part @param {(handle: Handle, at: [number, number]) => void} moved */
  const lead = (part, moved) =>
    led(part, picture, view, {
      led: (at, now) => view.freely(() => change((one) => moved(one, at)), now.altKey),
      left,
    });
  for (const one of [grip.dot, grip.hit]) lead(one, (handle, [x, y]) => handle.put(view.rounded(x), view.rounded(y)));
  if (knob && end) {
    for (const one of [knob, end]) {
      lead(one, ({ get, turn }, [x, y]) => {
        const [px, py] = get();
        const step = view.snap ? SNAP_TURN : 1;
        turn?.set(step * Math.round((Math.atan2(y - py, x - px) * 180) / Math.PI / step));
      });
    }
  }
  keyed(group, view, {
    moved: ([dx, dy]) =>
      change(({ get, put }) => {
        const [x, y] = get();
        put(view.fine(x + dx), view.fine(y + dy));
      }),
    turned: turn && ((by) => change(({ turn }) => turn?.set(turn.get() + by))),
    removed: removable && remove,
  });
  return { group, show };
}
