/** A fourbar whose pins are dragged: what it does then, as the analysis core says, while it is dragged. */

import * as api from "./api.js";
import { el, shown, svg, words } from "./dom.js";
import { View } from "./view.js";

const WIDTH = 640;
const HEIGHT = 420;
const STEPS = 180;

/** @typedef {[number, number]} Point */

export class Explorer {
  /**
   * @param {HTMLElement} place @param {any} mechanism a fourbar with its skeleton @param {any} problem
   * @param {(joints: Record<string, Point>) => void} keep called to begin a statement with these pivots
   */
  constructor(place, mechanism, problem, keep) {
    this.skeleton = structuredClone(mechanism.skeleton);
    /** @type {Record<string, Point>} */
    this.joints = this.skeleton.joints;
    this.targets = (problem.positions ?? problem.points ?? []).filter((/** @type {any} */ one) => Number.isFinite(one?.x));
    this.asking = false;
    this.stale = false;
    this.gone = new AbortController();
    const around = Object.values(this.joints).concat(this.targets.map((/** @type {any} */ one) => [one.x, one.y]));
    this.view = new View(around, WIDTH, HEIGHT, 110);
    this.curve = svg("path", { class: "curve" });
    this.links = this.skeleton.links.filter((/** @type {any} */ link) => link.name !== "ground").map((/** @type {any} */ link) =>
      ({ joints: link.joints, path: svg("path", { class: `link ${link.name === this.skeleton.input_link ? "input" : ""}` }) }));
    this.handles = Object.keys(this.joints).map((name) => this.handle(name));
    this.picture = svg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, class: "canvas drag", role: "group", "aria-label": "The linkage, its pins to be dragged" },
      svg("rect", { class: "paper", width: WIDTH, height: HEIGHT }), this.curve,
      ...this.targets.map((/** @type {any} */ one) => {
        const [u, v] = this.view.at(one.x, one.y);
        return svg("g", { class: "goal" }, svg("circle", { cx: u, cy: v, r: 5 }));
      }),
      ...this.links.map((/** @type {any} */ link) => link.path), ...this.handles.map((handle) => handle.group));
    this.facts = el("dl", { class: "facts", "aria-live": "polite" });
    place.replaceChildren(
      el("p", { class: "note" }, "Drag a pin, or move it with the arrow keys: the curve and the figures are those of the linkage as it is then."),
      this.picture, this.facts,
      el("button", { type: "button", class: "small", onclick: () => keep(this.joints) }, "Begin a statement with these fixed pivots"));
    this.draw();
    this.ask();
  }

  /** @param {string} name */
  handle(name) {
    const dot = svg("circle", { class: name === "P" ? "dot point" : "dot", r: 7 });
    const text = svg("text", { dx: 10, dy: -9 }, name);
    const group = svg("g", { class: "target", tabindex: 0, role: "button" }, text, dot);
    const put = (/** @type {Point} */ at) => {
      this.joints[name] = at;
      this.draw();
      this.ask();
    };
    dot.addEventListener("pointerdown", (/** @type {PointerEvent} */ event) => {
      dot.setPointerCapture(event.pointerId);
      const move = (/** @type {PointerEvent} */ now) => put(this.view.under(this.picture, now));
      dot.addEventListener("pointermove", move);
      dot.addEventListener("lostpointercapture", () => dot.removeEventListener("pointermove", move), { once: true });
    });
    group.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => {
      const step = this.view.step(event.shiftKey ? 1 : 10);
      const by = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, step], ArrowDown: [0, -step] }[event.key];
      if (!by) return;
      event.preventDefault();
      put([this.joints[name][0] + by[0], this.joints[name][1] + by[1]]);
    });
    return { name, dot, text, group };
  }

  draw() {
    for (const { joints, path } of this.links) {
      path.setAttribute("d", `${this.view.path(joints.map((/** @type {string} */ name) => this.joints[name]))}${joints.length > 2 ? "Z" : ""}`);
    }
    for (const { name, dot, text, group } of this.handles) {
      const [x, y] = this.joints[name];
      const [u, v] = this.view.at(x, y);
      dot.setAttribute("cx", u);
      dot.setAttribute("cy", v);
      text.setAttribute("x", u);
      text.setAttribute("y", v);
      group.setAttribute("aria-label", `${name}: x ${shown(x)}, y ${shown(y)}. Arrow keys move it.`);
    }
  }

  /** Ask for the motion; while an answer is awaited only the newest question is kept. */
  async ask() {
    if (this.asking) {
      this.stale = true;
      return;
    }
    this.asking = true;
    do {
      this.stale = false;
      const { O2, A } = this.joints;
      const from = (Math.atan2(A[1] - O2[1], A[0] - O2[0]) * 180) / Math.PI;
      const question = { mechanism: { type: "fourbar", skeleton: this.skeleton }, motion: { from, to: from + 360, steps: STEPS } };
      try {
        this.tell(await api.analysis(question, this.gone.signal));
      } catch (error) {
        if (this.gone.signal.aborted) return;
        this.curve.removeAttribute("d");
        const refused = /** @type {api.Refused} */ (error);
        this.facts.replaceChildren(el("dt", {}, "Refused"), el("dd", {}, refused.errors?.[0]?.detail ?? refused.message));
      }
    } while (this.stale);
    this.asking = false;
  }

  /** @param {any} answer */
  tell(answer) {
    const { x, y } = answer.joints.P;
    /** @type {Point[]} */
    const points = x.map((/** @type {number | null} */ one, /** @type {number} */ k) => (one === null ? [NaN, NaN] : [one, y[k]]));
    this.curve.setAttribute("d", this.view.path(points));
    const angles = answer.transmission_angle.filter((/** @type {number | null} */ one) => one !== null);
    const missed = this.targets.map((/** @type {any} */ target) =>
      points.reduce((least, [px, py]) => (px === px ? Math.min(least, Math.hypot(px - target.x, py - target.y)) : least), Infinity));
    const facts = {
      "Grashof": words(answer.classification.grashof ?? "unknown"),
      "Input turns through": answer.valid.every(Boolean) ? "yes" : "no",
      "Least transmission angle": angles.length ? `${shown(Math.round(10 * Math.min(...angles)) / 10)}°` : "–",
      ...(missed.length ? { "Farthest target from the curve": shown(Number(Math.max(...missed).toPrecision(3))) } : {}),
    };
    this.facts.replaceChildren(...Object.entries(facts).flatMap(([name, value]) => [el("dt", {}, name), el("dd", {}, value)]));
  }

  stop() {
    this.gone.abort();
  }
}
