/** A statement on a canvas: what it places in the plane is dragged, turned, added and removed, and curves are sketched. */

import { el, shown, svg } from "./dom.js";
import { stated } from "./handles.js";
import { View } from "./view.js";

/** @typedef {import("./handles.js").Handle} Handle */

const WIDTH = 640;
const HEIGHT = 380;
const ARM = 44;

/** How many points a sketched curve becomes. */
const SKETCHED = 24;

/**
 * @param {HTMLElement} place @param {any} problem changed in place
 * @param {(rebuilt: boolean) => void} changed
 */
export function canvas(place, problem, changed) {
  const found = readable(problem);
  if (!found) return place.replaceChildren();
  const { handles, lines, word, add, offers } = found;
  const view = new View(handles.flatMap(({ get, name }) => (name === "ground" ? [] : [get()])), WIDTH, HEIGHT, 80);
  const picture = svg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, class: "canvas", role: "group", "aria-label": "The problem in the plane" });
  const trail = svg("path", { class: "trail" });
  const pen = svg("path", { class: "pen" });
  picture.append(svg("rect", { class: "paper", width: WIDTH, height: HEIGHT }), ...grid(view), trail, pen);
  const redraw = () => trail.setAttribute("d", lines().map((/** @type {any} */ line) => view.path(line)).join(""));
  const drawn = handles.map((handle) => held(handle, view, picture, () => drawn.forEach((one) => one.show()), redraw, changed));
  picture.append(...drawn.map((one) => one.group));
  for (const one of drawn) one.show();
  redraw();

  const mode = el("input", { type: "checkbox", id: "freehand" });
  const put = (/** @type {[number, number]} */ [x, y]) => {
    add?.(view.rounded(x), view.rounded(y));
    changed(true);
  };
  if (add) {
    picture.addEventListener("dblclick", (/** @type {MouseEvent} */ event) => {
      if (!mode.checked) put(view.under(picture, event));
    });
  }
  if (found.freehand) {
    picture.addEventListener("pointerdown", (/** @type {PointerEvent} */ event) => {
      if (mode.checked) sketched(event, view, picture, pen, problem, changed);
    });
  }
  const focused = [...place.querySelectorAll(".target")].indexOf(/** @type {Element} */ (document.activeElement));
  const last = handles.at(-1)?.get() ?? [0, 0];
  const size = (0.4 * WIDTH) / view.scale;
  const how = `Drag to move${handles.some((one) => one.turn) ? ", drag the end to turn" : ""}${add ? "; double-click adds one" : ""}.`;
  // An empty plane says nothing: what may be placed in it stands below.
  picture.toggleAttribute("hidden", !handles.length && !add);
  place.replaceChildren(picture, el("div", { class: "row" },
    add && el("button", { type: "button", class: "small", onclick: () => put([last[0] + 40 / view.scale, last[1]]) }, `Add a ${word}`),
    ...offers.map(({ text, make }) => el("button", { type: "button", class: "small", onclick: () => {
      make([view.rounded(view.middle[0]), view.rounded(view.middle[1])], view.rounded(size));
      changed(true);
    } }, text)),
    found.freehand && el("label", { class: "flag", for: "freehand" }, mode, "Draw freehand"),
    handles.length > 0 && el("span", { class: "note" }, how)));
  if (focused >= 0) /** @type {SVGElement[]} */ ([...place.querySelectorAll(".target")])[focused]?.focus();
}

/** What can be held; nothing while the JSON is not what its kind has. @param {any} problem */
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
 * @param {Handle} handle @param {View} view @param {SVGSVGElement} picture
 * @param {() => void} all shows all handles: some hang together @param {() => void} redraw draws what is between them
 * @param {(rebuilt: boolean) => void} changed
 */
function held(handle, view, picture, all, redraw, changed) {
  const { name, label, turn } = handle;
  const line = svg("line", { class: "arm" });
  const knob = turn && svg("circle", { class: "knob", r: 7 });
  const dot = svg("circle", { class: "dot", r: 8 });
  const text = svg("text", { dx: 12, dy: 20 }, name);
  const group = svg("g", { class: "target", tabindex: 0, role: "button" }, line, text, dot, knob);
  const show = () => {
    const [x, y] = handle.get();
    const [u, v] = view.at(x, y);
    dot.setAttribute("cx", u);
    dot.setAttribute("cy", v);
    text.setAttribute("x", u);
    text.setAttribute("y", v);
    group.setAttribute("aria-label", `${label}: x ${shown(x)}, y ${shown(y)}${turn ? `, angle ${shown(turn.get())}°` : ""}. Arrow keys move it${turn ? ", page keys turn it" : ""}${handle.remove ? ", Delete removes it" : ""}.`);
    if (!knob || !turn) return;
    const angle = (turn.get() * Math.PI) / 180;
    const [ku, kv] = [u + ARM * Math.cos(angle), v - ARM * Math.sin(angle)];
    knob.setAttribute("cx", ku);
    knob.setAttribute("cy", kv);
    for (const [attribute, value] of Object.entries({ x1: u, y1: v, x2: ku, y2: kv })) line.setAttribute(attribute, String(value));
  };
  const altered = () => {
    for (const field of handle.path ? ["x", "y", "angle"] : []) {
      const box = document.querySelector(`[data-path="${handle.path}/${field}"]`);
      if (box instanceof HTMLInputElement && handle.owner[field] !== undefined) box.value = String(handle.owner[field]);
    }
    all();
    redraw();
    changed(false);
  };
  const drag = (/** @type {SVGElement} */ grip, /** @type {(at: [number, number]) => void} */ moved) => {
    grip.addEventListener("pointerdown", (event) => {
      event.stopPropagation();
      grip.setPointerCapture(event.pointerId);
      const move = (/** @type {PointerEvent} */ now) => {
        moved(view.under(picture, now));
        altered();
      };
      grip.addEventListener("pointermove", move);
      grip.addEventListener("lostpointercapture", () => {
        grip.removeEventListener("pointermove", move);
        changed(true);
      }, { once: true });
    });
  };
  drag(dot, ([x, y]) => handle.put(view.rounded(x), view.rounded(y)));
  if (knob && turn) {
    drag(knob, ([x, y]) => {
      const [px, py] = handle.get();
      turn.set(Math.round((Math.atan2(y - py, x - px) * 180) / Math.PI));
    });
  }
  group.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => {
    const step = view.step(event.shiftKey ? 1 : 10);
    const by = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, step], ArrowDown: [0, -step] }[event.key];
    const way = { PageUp: 1, PageDown: -1 }[event.key];
    const [x, y] = handle.get();
    if (by) handle.put(view.rounded(x + by[0]), view.rounded(y + by[1]));
    else if (way && turn) turn.set(turn.get() + way * (event.shiftKey ? 1 : 5));
    else if (event.key === "Delete" && handle.remove) {
      handle.remove();
      event.preventDefault();
      return changed(true);
    } else return;
    event.preventDefault();
    altered();
  });
  return { group, show };
}

/** A stroke becomes points at equal distances. @param {PointerEvent} event @param {View} view @param {SVGSVGElement} picture @param {SVGElement} pen @param {any} problem @param {(rebuilt: boolean) => void} changed */
function sketched(event, view, picture, pen, problem, changed) {
  /** @type {[number, number][]} */
  const stroke = [view.under(picture, event)];
  picture.setPointerCapture(event.pointerId);
  const move = (/** @type {PointerEvent} */ now) => {
    stroke.push(view.under(picture, now));
    pen.setAttribute("d", view.path(stroke));
  };
  picture.addEventListener("pointermove", move);
  picture.addEventListener("lostpointercapture", () => {
    picture.removeEventListener("pointermove", move);
    pen.removeAttribute("d");
    const points = evenly(stroke, SKETCHED);
    if (points.length < 3) return;
    problem.points = points.map(([x, y]) => ({ x: view.rounded(x), y: view.rounded(y) }));
    changed(true);
  }, { once: true });
}

/** Points at equal distances along a stroke. @param {[number, number][]} stroke @param {number} count @returns {[number, number][]} */
export function evenly(stroke, count) {
  const along = [0];
  for (let k = 1; k < stroke.length; k++) {
    along.push(along[k - 1] + Math.hypot(stroke[k][0] - stroke[k - 1][0], stroke[k][1] - stroke[k - 1][1]));
  }
  const length = along[along.length - 1];
  if (!(length > 0)) return [];
  /** @type {[number, number][]} */
  const points = [];
  for (let k = 0, n = 1; k < count; k++) {
    const s = (length * k) / (count - 1);
    while (n < stroke.length - 1 && along[n] < s) n++;
    const share = along[n] > along[n - 1] ? (s - along[n - 1]) / (along[n] - along[n - 1]) : 0;
    const [before, after] = [stroke[n - 1], stroke[n]];
    points.push([before[0] + share * (after[0] - before[0]), before[1] + share * (after[1] - before[1])]);
  }
  return points;
}

/** Lines at round coordinates. @param {View} view */
function grid(view) {
  const step = view.step(70);
  const [west, north] = view.middle.map((m, c) => m + ((c ? 1 : -1) * (c ? HEIGHT : WIDTH)) / 2 / view.scale);
  const lines = [];
  for (let k = Math.ceil(west / step); lines.length < 60; k++) {
    const [u] = view.at(k * step, 0);
    if (u > WIDTH) break;
    lines.push(svg("line", { class: "grid", x1: u, x2: u, y1: 0, y2: HEIGHT }), svg("text", { class: "tick", x: u + 3, y: HEIGHT - 5 }, shown(k * step)));
  }
  for (let k = Math.floor(north / step), first = lines.length; lines.length < first + 60; k--) {
    const [, v] = view.at(0, k * step);
    if (v > HEIGHT) break;
    lines.push(svg("line", { class: "grid", x1: 0, x2: WIDTH, y1: v, y2: v }), svg("text", { class: "tick", x: 4, y: v - 4 }, shown(k * step)));
  }
  return lines;
}
