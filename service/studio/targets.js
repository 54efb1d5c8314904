/** The positions or points of a statement on a canvas: dragged, turned, added, and sketched. */

import { el, shown, svg } from "./dom.js";
import { View } from "./view.js";

/** @typedef {{x: number, y: number, angle?: number}} Target */

const WIDTH = 640;
const HEIGHT = 380;
const ARM = 44;

/** How many points a sketched curve becomes. */
const SKETCHED = 24;

/** Which list of a problem is drawn. @param {any} problem @returns {"positions" | "points" | null} */
export function drawn(problem) {
  return problem.kind === "motion" ? "positions" : problem.kind === "path" ? "points" : null;
}

/**
 * @param {HTMLElement} place @param {any} problem changed in place
 * @param {(rebuilt: boolean) => void} changed
 */
export function canvas(place, problem, changed) {
  const name = drawn(problem);
  if (!name || !Array.isArray(problem[name])) return place.replaceChildren();
  /** @type {Target[]} */
  const targets = problem[name];
  const known = targets.filter((one) => Number.isFinite(one?.x) && Number.isFinite(one?.y));
  const view = new View(known.map((one) => [one.x, one.y]), WIDTH, HEIGHT, 80);
  const turning = name === "positions";
  const word = turning ? "Position" : "Point";
  const picture = svg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, class: "canvas", role: "group", "aria-label": `${word}s of the problem` });
  const trail = svg("path", { class: "trail" });
  const pen = svg("path", { class: "pen" });
  picture.append(svg("rect", { class: "paper", width: WIDTH, height: HEIGHT }), ...grid(view), trail, pen);
  const redraw = () => trail.setAttribute("d", view.path(known.map((one) => [one.x, one.y])));
  redraw();
  const mode = el("input", { type: "checkbox", id: "freehand" });

  targets.forEach((target, k) => {
    if (!known.includes(target)) return;
    const line = svg("line", { class: "arm" });
    const knob = turning && svg("circle", { class: "knob", r: 7 });
    const dot = svg("circle", { class: "dot", r: 8 });
    const text = svg("text", { dx: 12, dy: 20 }, k + 1);
    const group = svg("g", { class: "target", tabindex: 0, role: "button" }, line, text, dot, knob);
    const show = () => {
      const [u, v] = view.at(target.x, target.y);
      dot.setAttribute("cx", u);
      dot.setAttribute("cy", v);
      text.setAttribute("x", u);
      text.setAttribute("y", v);
      const turn = turning ? `, angle ${shown(target.angle)}°` : "";
      group.setAttribute("aria-label", `${word} ${k + 1}: x ${shown(target.x)}, y ${shown(target.y)}${turn}. Arrow keys move it${turning ? ", page keys turn it" : ""}, Delete removes it.`);
      if (knob) {
        const angle = ((target.angle ?? 0) * Math.PI) / 180;
        const [ku, kv] = [u + ARM * Math.cos(angle), v - ARM * Math.sin(angle)];
        knob.setAttribute("cx", ku);
        knob.setAttribute("cy", kv);
        for (const [attribute, value] of Object.entries({ x1: u, y1: v, x2: ku, y2: kv })) line.setAttribute(attribute, String(value));
      }
      redraw();
    };
    const put = (/** @type {Partial<Target>} */ values) => {
      Object.assign(target, values);
      for (const [field, value] of Object.entries(values)) {
        const box = document.querySelector(`[data-path="/problem/${name}/${k}/${field}"]`);
        if (box instanceof HTMLInputElement) box.value = String(value);
      }
      show();
      changed(false);
    };
    const drag = (/** @type {SVGElement} */ grip, /** @type {(at: [number, number]) => void} */ moved) => {
      grip.addEventListener("pointerdown", (event) => {
        event.stopPropagation();
        grip.setPointerCapture(event.pointerId);
        const move = (/** @type {PointerEvent} */ now) => moved(view.under(picture, now));
        grip.addEventListener("pointermove", move);
        grip.addEventListener("lostpointercapture", () => {
          grip.removeEventListener("pointermove", move);
          changed(true);
        }, { once: true });
      });
    };
    drag(dot, ([x, y]) => put({ x: view.rounded(x), y: view.rounded(y) }));
    if (knob) drag(knob, ([x, y]) => put({ angle: Math.round((Math.atan2(y - target.y, x - target.x) * 180) / Math.PI) }));
    group.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => {
      const step = view.step(event.shiftKey ? 1 : 10);
      const by = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, step], ArrowDown: [0, -step] }[event.key];
      const turn = { PageUp: 1, PageDown: -1 }[event.key];
      if (by) put({ x: view.rounded(target.x + by[0]), y: view.rounded(target.y + by[1]) });
      else if (turn && turning) put({ angle: (target.angle ?? 0) + turn * (event.shiftKey ? 1 : 5) });
      else if (event.key === "Delete") {
        targets.splice(k, 1);
        changed(true);
      } else return;
      event.preventDefault();
    });
    show();
    picture.append(group);
  });

  const add = (/** @type {[number, number]} */ [x, y]) => {
    targets.push({ x: view.rounded(x), y: view.rounded(y), ...(turning ? { angle: targets.at(-1)?.angle ?? 0 } : {}) });
    changed(true);
  };
  picture.addEventListener("dblclick", (/** @type {MouseEvent} */ event) => {
    if (!mode.checked) add(view.under(picture, event));
  });
  picture.addEventListener("pointerdown", (/** @type {PointerEvent} */ event) => {
    if (!mode.checked) return;
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
  });
  const focused = [...place.querySelectorAll(".target")].indexOf(/** @type {Element} */ (document.activeElement));
  place.replaceChildren(picture, el("div", { class: "row" },
    el("button", { type: "button", class: "small", onclick: () => {
      const last = targets.at(-1) ?? { x: 0, y: 0 };
      add([last.x + 40 / view.scale, last.y]);
    } }, `Add a ${word.toLowerCase()}`),
    !turning && el("label", { class: "flag", for: "freehand" }, mode, "Draw freehand"),
    el("span", { class: "note" }, turning ? "Drag to move, drag the end to turn; double-click adds one." : "Drag to move; double-click adds one.")));
  if (focused >= 0) /** @type {SVGElement[]} */ ([...place.querySelectorAll(".target")])[focused]?.focus();
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
    points.push([0, 1].map((c) => stroke[n - 1][c] + share * (stroke[n][c] - stroke[n - 1][c])));
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
