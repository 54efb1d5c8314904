/** A linkage in motion: the arrays of its cycle, drawn at the display's own rate. */

import { el, shown, svg } from "./dom.js";
import { plots } from "./plots.js";
import { View } from "./view.js";

const WIDTH = 640;
const HEIGHT = 420;

/** Seconds that a cycle takes at speed 1. */
const CYCLE_S = 4;

/** @typedef {{x: (number | null)[], y: (number | null)[]}} Track */

export class Mover {
  /** @param {HTMLElement} place @param {any} design @param {any} motion @param {any} problem */
  constructor(place, design, motion, problem) {
    this.motion = motion;
    this.skeleton = design.mechanism.skeleton;
    this.count = motion.input_angle?.length ?? Object.values(/** @type {Record<string, Track>} */ (motion.joints))[0].x.length;
    /** Where in the arrays the motion stands, between two samples as a fraction. */
    this.at = 0;
    this.sense = 1;
    this.rate = 1;
    this.playing = false;
    this.frame = 0;
    this.closed = this.returns();
    const tracks = /** @type {Record<string, Track>} */ (motion.joints);
    const targets = problem.positions ?? problem.points ?? [];
    const points = [...Object.values(tracks).flatMap((track) => track.x.map((x, k) => [x, track.y[k]])), ...targets.map((/** @type {any} */ one) => [one.x, one.y])]
      .filter(([x, y]) => x !== null && y !== null);
    this.view = new View(/** @type {any} */ (points), WIDTH, HEIGHT, 34);
    this.build(place, targets);
    this.show(0);
    if (!matchMedia("(prefers-reduced-motion: reduce)").matches) this.play();
  }

  /** Whether the last configuration is the first again: the motion then goes on, and otherwise back and forth. */
  returns() {
    const tracks = Object.values(/** @type {Record<string, Track>} */ (this.motion.joints));
    const spread = Math.max(...tracks.map((track) => Math.max(...track.x.map(Number)) - Math.min(...track.x.map(Number))));
    const last = this.count - 1;
    return tracks.every(({ x, y }) => x[0] !== null && x[last] !== null
      && Math.hypot(Number(x[0]) - Number(x[last]), Number(y[0]) - Number(y[last])) < 1e-6 * Math.max(spread, 1e-300));
  }

  /** @param {HTMLElement} place @param {any[]} targets */
  build(place, targets) {
    const { view, skeleton } = this;
    const ground = skeleton.links.find((/** @type {any} */ link) => link.name === "ground")?.joints ?? [];
    const track = (/** @type {string} */ name) => {
      const { x, y } = this.motion.joints[name];
      return x.map((/** @type {number} */ one, /** @type {number} */ k) => /** @type {[number, number]} */ (one === null ? [NaN, NaN] : [one, y[k]]));
    };
    const moving = Object.keys(this.motion.joints).filter((name) => !ground.includes(name));
    this.links = skeleton.links.filter((/** @type {any} */ link) => link.name !== "ground").map((/** @type {any} */ link) =>
      ({ joints: link.joints, path: svg("path", { class: `link ${link.name === skeleton.input_link ? "input" : ""}` }) }));
    this.pins = Object.keys(this.motion.joints).map((name) =>
      ({ name, dot: svg("circle", { class: name === "P" ? "point" : "pin", r: name === "P" ? 5 : 4 }), text: svg("text", { dx: 8, dy: -7 }, name) }));
    const picture = svg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, class: "canvas", role: "img", "aria-label": "The linkage in motion" },
      svg("rect", { class: "paper", width: WIDTH, height: HEIGHT }),
      ...moving.map((name) => svg("path", { class: name === "P" ? "curve" : "trail", d: view.path(track(name)) })),
      ...(skeleton.slides ?? []).filter((/** @type {any} */ slide) => slide.link === "ground" && slide.point).map((/** @type {any} */ slide) => this.line(slide)),
      ...targets.filter((one) => Number.isFinite(one?.x)).map((one, k) => this.target(one, k)),
      ...ground.map((/** @type {string} */ name) => this.pivot(name)),
      ...this.links.map((/** @type {any} */ link) => link.path),
      ...this.pins.flatMap((pin) => [pin.dot, pin.text]));
    this.picture = picture;
    this.drags(ground);
    this.button = el("button", { type: "button", class: "small", onclick: () => (this.playing ? this.stop() : this.play()) }, "Pause");
    this.slider = el("input", { type: "range", id: "scrub", min: 0, max: this.count - 1, step: "any", value: 0, oninput: () => {
      this.stop();
      this.show(this.slider.valueAsNumber);
    }, onkeydown: (/** @type {KeyboardEvent} */ event) => {
      const by = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageUp: 10, PageDown: -10 }[event.key];
      if (by === undefined) return;
      event.preventDefault();
      this.stop();
      this.show(Math.min(this.count - 1, Math.max(0, Math.round(this.at) + by)));
    } });
    const speed = el("select", { id: "speed", onchange: () => (this.rate = Number(speed.value)) },
      ...[0.25, 0.5, 1, 2, 4].map((rate) => el("option", { value: rate }, `${rate} ×`)));
    speed.value = "1";
    this.reading = el("output", { for: "scrub", class: "reading" });
    this.marks = plots(this.motion, this.skeleton);
    place.replaceChildren(picture,
      el("div", { class: "row" }, this.button, el("label", { for: "scrub" }, "Input"), this.slider, this.reading,
        el("label", { for: "speed" }, "Speed"), speed),
      el("div", { class: "plots" }, ...this.marks.map((mark) => mark.figure)));
  }

  /** The crank, or the slider, can be taken by its pin and led along its way. @param {string[]} ground */
  drags(ground) {
    const input = this.skeleton.links.find((/** @type {any} */ link) => link.name === this.skeleton.input_link);
    const name = input?.joints.find((/** @type {string} */ one) => !ground.includes(one));
    const pin = this.pins.find((/** @type {any} */ one) => one.name === name);
    if (!pin) return;
    pin.dot.classList.add("led");
    pin.dot.setAttribute("r", "7");
    const { x, y } = this.motion.joints[name];
    pin.dot.addEventListener("pointerdown", (/** @type {PointerEvent} */ event) => {
      this.stop();
      pin.dot.setPointerCapture(event.pointerId);
      const move = (/** @type {PointerEvent} */ now) => this.show(nearest(x, y, this.view.under(this.picture, now), this.at));
      pin.dot.addEventListener("pointermove", move);
      pin.dot.addEventListener("lostpointercapture", () => pin.dot.removeEventListener("pointermove", move), { once: true });
    });
  }

  /** @param {any} slide */
  line(slide) {
    const [u, v] = this.view.at(slide.point[0], slide.point[1]);
    const angle = (slide.angle * Math.PI) / 180;
    const [c, s] = [900 * Math.cos(angle), 900 * Math.sin(angle)];
    return svg("line", { class: "rail", x1: u - c, y1: v + s, x2: u + c, y2: v - s });
  }

  /** @param {{x: number, y: number, angle?: number}} one @param {number} k */
  target(one, k) {
    const [u, v] = this.view.at(one.x, one.y);
    const angle = ((one.angle ?? 0) * Math.PI) / 180;
    return svg("g", { class: "goal" }, svg("circle", { cx: u, cy: v, r: 5 }),
      one.angle !== undefined && svg("line", { x1: u, y1: v, x2: u + 26 * Math.cos(angle), y2: v - 26 * Math.sin(angle) }),
      svg("text", { x: u, y: v, dx: 8, dy: 15 }, k + 1));
  }

  /** @param {string} name */
  pivot(name) {
    const { x, y } = this.motion.joints[name] ?? { x: [NaN], y: [NaN] };
    const [u, v] = this.view.at(x[0], y[0]);
    return Number.isFinite(u) ? svg("path", { class: "ground", d: `M${u} ${v}l-9 15h18Z` }) : "";
  }

  /** Show the motion at a place of its arrays, between samples on a straight line. @param {number} at */
  show(at) {
    this.at = at;
    const k = Math.min(Math.floor(at), this.count - 2);
    const share = at - k;
    /** @type {Record<string, [number, number] | null>} */
    const now = {};
    for (const [name, { x, y }] of Object.entries(/** @type {Record<string, any>} */ (this.motion.joints))) {
      now[name] = x[k] === null || x[k + 1] === null ? null
        : [x[k] + share * (x[k + 1] - x[k]), y[k] + share * (y[k + 1] - y[k])];
    }
    for (const { joints, path } of this.links) {
      const points = joints.map((/** @type {string} */ name) => now[name]);
      const known = points.every((/** @type {any} */ one) => one);
      path.setAttribute("d", known ? `${this.view.path(points)}${points.length > 2 ? "Z" : ""}` : "");
    }
    for (const { name, dot, text } of this.pins) {
      const point = now[name];
      dot.toggleAttribute("hidden", !point);
      if (!point) continue;
      const [u, v] = this.view.at(point[0], point[1]);
      dot.setAttribute("cx", u);
      dot.setAttribute("cy", v);
      text.setAttribute("x", u);
      text.setAttribute("y", v);
    }
    this.slider.value = at;
    const input = this.motion.input_angle;
    this.reading.value = input ? `${shown(Math.round(10 * (input[k] + share * (input[k + 1] - input[k]))) / 10)}°` : `${Math.round((100 * at) / (this.count - 1))} %`;
    this.slider.setAttribute("aria-valuetext", this.reading.value);
    for (const mark of this.marks) mark.show(at);
  }

  play() {
    if (this.playing) return;
    this.playing = true;
    this.button.textContent = "Pause";
    let before = performance.now();
    const step = (/** @type {number} */ now) => {
      if (!this.playing) return;
      const last = this.count - 1;
      let at = this.at + (this.sense * this.rate * last * Math.max(0, now - before)) / 1000 / CYCLE_S;
      before = now;
      if (this.closed) at %= last;
      else if (at > last || at < 0) {
        this.sense = -this.sense;
        at = Math.min(last, Math.max(0, at));
      }
      this.show(at);
      this.frame = requestAnimationFrame(step);
    };
    this.frame = requestAnimationFrame(step);
  }

  stop() {
    this.playing = false;
    cancelAnimationFrame(this.frame);
    this.button.textContent = "Play";
  }
}

/**
 * The sample of a track that is nearest to a point; of equally near ones, as where a crank turns twice, the one at hand.
 * @param {(number | null)[]} x @param {(number | null)[]} y @param {[number, number]} point @param {number} at
 */
function nearest(x, y, point, at) {
  const away = x.map((one, k) => (one === null ? Infinity : Math.hypot(one - point[0], Number(y[k]) - point[1])));
  const least = Math.min(...away);
  let best = away.indexOf(least);
  for (let k = 0; k < away.length; k++) {
    if (away[k] <= least * (1 + 1e-6) && Math.abs(k - at) < Math.abs(best - at)) best = k;
  }
  return best;
}
