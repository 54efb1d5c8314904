/**
 * A statement on a canvas: what it places in the plane is dragged, turned, added and removed, and curves are sketched.
 */

import { el, shown, svg } from "./dom.js";
import { stroke } from "./freehand.js";
import { grid, snapping } from "./grid.js";
import { Grip, keyed, led } from "./grip.js";
import { chosenPivots, matched, opened, stated } from "./handles.js";
import { t, term } from "./messages.js";
import { areas } from "./room.js";
import { RoomEditor } from "./room_editor.js";
import { Ruler } from "./ruler.js";
import { roomOf } from "./stage.js";
import { View } from "./view.js";
import { Zoom } from "./zoom.js";

/** @import { Problem } from "./types/values.js" */

/** @typedef {import("./handles.js").Handle} Handle */

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
 * @property {Problem} problem whose view it is
 * @property {View | null} view
 * @property {boolean} led whether somebody has led the view somewhere; otherwise all is to be seen
 * @property {import("./room_editor.js").Memory} room
 * @property {{ends: [[number, number], [number, number]] | null}} ruler
 */

/** @type {WeakMap<HTMLElement, Kept>} */
const kept = new WeakMap();

/**
 * @param {HTMLElement} place
 * @param {Problem} problem changed in place
 * @param {boolean} roomy whether the problem may state the room
 * @param {(rebuilt: boolean) => void} changed @param {import("./backdrop.js").Backdrop} backdrop what lies behind it
 */
export function canvas(place, problem, roomy, changed, backdrop) {
  const found = readable(problem);
  const before = kept.get(place);
  const memory =
    before && before.problem === problem
      ? before
      : { problem, view: null, led: false, room: { role: before?.room.role }, ruler: { ends: null } };
  before?.room.pen?.leave();
  kept.set(place, memory);
  const graph = problem.kind === "function";
  const grip = place.contains(document.activeElement) ? document.activeElement?.getAttribute("data-grip") : null;
  const both = graph && roomy && found && (found.handles.length > 0 || found.add);
  const buttons = graph && roomy && found && !both;
  const [width, height] = roomOf(place, TOOLS + (buttons ? BUTTONS : 0));
  /** @type {[number, number]} */
  const size = [both ? width / 2 : width, height];
  place.replaceChildren(
    ...(found
      ? [drawnPlane(place, problem, found, roomy && !graph, memory, changed, graph ? null : backdrop, size)]
      : []),
    // The graph of a function is not the plane in which its linkage lies.
    ...(graph && roomy ? [drawnPlane(place, problem, bare(problem), true, memory, changed, backdrop, size)] : []),
  );
  if (grip)
    /** @type {SVGElement | null} */ (place.querySelector(`[data-grip="${CSS.escape(grip)}"]`))?.focus({
      preventScroll: true,
    });
}

/**
 * A plane in which nothing is placed but the fixed pivots, where they are chosen.
 * @param {Problem} problem
 * @returns {import("./handles.js").Stated}
 */
function bare(problem) {
  return { handles: chosenPivots(problem), lines: () => [], offers: [] };
}

/**
 * A picture of a plane, and what is done in it.
 * @param {HTMLElement} place
 * @param {Problem} problem
 * @param {import("./handles.js").Stated} found
 * @param {boolean} roomy
 * @param {Kept} memory
 * @param {(rebuilt: boolean) => void} changed
 * @param {import("./backdrop.js").Backdrop | null} backdrop
 * @param {[number, number]} room pixels
 * @returns {HTMLElement}
 */
function drawnPlane(
  place,
  problem,
  { handles, lines, word, add, offers, freehand, shapes = [] },
  roomy,
  memory,
  changed,
  backdrop,
  room,
) {
  const corners = roomy ? areas(problem.space).flatMap((area) => area.extent) : [];
  const points = [...handles.flatMap(({ get, name }) => (name === "ground" ? [] : [get()])), ...corners];
  const fits = memory.view?.width === room[0] && memory.view.height === room[1] && memory.view.suits(points);
  const view =
    roomy && memory.view && (memory.led || fits)
      ? memory.view
      : new View(points, ...room, corners.length ? 40 : 0.2 * Math.min(...room));
  const { width, height } = view;
  if (roomy) memory.view = view;
  view.snap = tools.snap ? snapping(view) : 0;
  const picture = svg("svg", {
    viewBox: `0 0 ${width} ${height}`,
    class: "canvas",
    role: "group",
    "aria-label": t`The problem in the plane`,
  });
  const trail = svg("path", { class: "trail" });
  const pen = svg("path", { class: "pen" });
  const areasOf = roomy ? new RoomEditor(picture, view, problem, memory.room, changed) : null;
  picture.append(
    svg("rect", { class: "paper", width, height }),
    ...(backdrop?.drawn(view, picture) ?? []),
    ...(tools.grid ? grid(view) : []),
    ...(areasOf ? [areasOf.node] : []),
    trail,
    pen,
  );
  const redraw = () =>
    trail.setAttribute(
      "d",
      lines()
        .map((line) => view.path(line))
        .join(""),
    );
  const drawn = handles.map((handle, k) =>
    held(handle, `${word ?? "handle"}${k}`, view, picture, () => drawn.forEach((one) => one.show()), redraw, changed),
  );
  picture.append(...drawn.map((one) => one.group));
  for (const one of drawn) one.show();
  redraw();
  // Coordinates of a graph are no lengths.
  const ruler =
    word === "pair"
      ? null
      : new Ruler(picture, view, problem.length_unit ?? "mm", () => handles.map((one) => one.get()), memory.ruler);
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
          changed(true);
        },
      },
      text,
    );
  const chosen = el(
    "div",
    { class: "canvas-tools", role: "group", "aria-label": t`Tools of the canvas` },
    ...shapes.map(({ text, title, make }) =>
      el(
        "button",
        {
          type: "button",
          class: "small",
          title,
          onclick: () => {
            make((value) => view.fine(value));
            changed(true);
          },
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
            if (seen) {
              const {
                middle: [x, y],
                nearness,
              } = seen;
              view.middle = [
                view.middle[0] + (x - width / 2) / view.scale,
                view.middle[1] - (y - height / 2) / view.scale,
              ];
              view.scale *= nearness;
            }
            Object.assign(memory, { view: seen && view, led: seen !== null });
            canvas(place, problem, roomy, changed, backdrop);
          },
        })
      : null;
  const put = (/** @type {[number, number]} */ [x, y]) => {
    add?.(view.rounded(x), view.rounded(y));
    changed(true);
  };
  if (add) {
    picture.addEventListener("dblclick", (/** @type {MouseEvent} */ event) => {
      if (!mode.checked) put(view.under(picture, event));
    });
  }
  picture.addEventListener("pointerdown", (/** @type {PointerEvent} */ event) => {
    if (!mode.checked) return;
    stroke(event, view, picture, pen, (way, closed) => {
      problem.points = way.map(([x, y]) => ({ x, y }));
      if (closed) matched(problem);
      else opened(problem);
      changed(true);
    });
  });
  const last = handles.at(-1)?.get() ?? [0, 0];
  const size = (0.4 * Math.min(width, 640)) / view.scale;
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
        ...offers.map(({ text, make }) =>
          el(
            "button",
            {
              type: "button",
              class: "small",
              onclick: () => {
                make([view.rounded(view.middle[0]), view.rounded(view.middle[1])], view.rounded(size));
                changed(true);
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

/**
 * A handle on the canvas: a dot, and a knob where it turns.
 * @param {Handle} handle @param {string} key @param {View} view @param {SVGSVGElement} picture
 * @param {() => void} all shows all handles: some hang together @param {() => void} redraw draws what is between them
 * @param {(rebuilt: boolean) => void} changed
 */
function held(handle, key, view, picture, all, redraw, changed) {
  const { name, label, turn } = handle;
  const grip = new Grip({ name, beside: [12, 20], radius: 8, key });
  const group = grip.node;
  const line = svg("line", { class: "arm" });
  const [end, knob] = turn
    ? [svg("circle", { class: "hit", r: 12 }), svg("circle", { class: "knob", r: 7 })]
    : [null, null];
  group.prepend(line);
  if (end && knob) group.append(end, knob);
  const show = () => {
    const [x, y] = handle.get();
    const [u, v] = view.at(x, y);
    grip.put([u, v]);
    const turned = turn ? `, ${t`angle ${shown(turn.get())}°`}` : "";
    const keys = [t`Arrow keys move it`, turn && t`page keys turn it`, handle.remove && t`Delete removes it`];
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
  const altered = () => {
    for (const field of handle.path ? /** @type {const} */ (["x", "y", "angle"]) : []) {
      const box = document.querySelector(`[data-path="${handle.path}/${field}"]`);
      const value = handle.owner?.[field];
      if (box instanceof HTMLInputElement && value !== undefined) box.value = String(value);
    }
    all();
    redraw();
    changed(false);
  };
  const put = (/** @type {SVGElement} */ part, /** @type {(at: [number, number]) => void} */ moved) =>
    led(part, picture, view, {
      led: (at, now) => {
        view.freely(() => moved(at), now.altKey);
        altered();
      },
      left: () => changed(true),
    });
  for (const one of [grip.dot, grip.hit]) put(one, ([x, y]) => handle.put(view.rounded(x), view.rounded(y)));
  if (knob && end && turn) {
    for (const one of [knob, end]) {
      put(one, ([x, y]) => {
        const [px, py] = handle.get();
        const step = view.snap ? SNAP_TURN : 1;
        turn.set(step * Math.round((Math.atan2(y - py, x - px) * 180) / Math.PI / step));
      });
    }
  }
  const { remove } = handle;
  keyed(group, view, {
    moved: ([dx, dy]) => {
      const [x, y] = handle.get();
      handle.put(view.fine(x + dx), view.fine(y + dy));
      altered();
    },
    turned:
      turn &&
      ((by) => {
        turn.set(turn.get() + by);
        altered();
      }),
    removed:
      remove &&
      (() => {
        remove();
        changed(true);
      }),
  });
  return { group, show };
}
