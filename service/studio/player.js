/** The clock of a motion: play and pause, speed, a scrubber, and the reading beside it. One motion plays at a time. */

import { el } from "./dom.js";

/** Seconds that a cycle takes at speed 1. */
const CYCLE_S = 4;

/**
 * @typedef {object} Moved
 * @property {number} count samples of the motion
 * @property {boolean} closed whether the last sample is the first again: it then goes on, and otherwise back and forth
 * @property {boolean} [endless] the place counts on beyond the last sample: what turns need not come back after a cycle
 * @property {string} label what the scrubber moves
 * @property {string} [name] before the ids of its controls, where a page has a second one
 * @property {(at: number) => string} reading what stands beside the scrubber
 * @property {(at: number) => void} show called with a place of the arrays, between two samples as a fraction
 */

export class Player {
  /** @param {Moved} moved */
  constructor(moved) {
    this.moved = moved;
    const [scrub, speeds] = [`${moved.name ?? ""}scrub`, `${moved.name ?? ""}speed`];
    this.at = 0;
    this.sense = 1;
    this.rate = 1;
    this.playing = false;
    this.frame = 0;
    this.last = moved.count - 1;
    this.button = el("button", { type: "button", class: "small", onclick: () => (this.playing ? this.stop() : this.play()) }, "Play");
    this.slider = el("input", { type: "range", id: scrub, min: 0, max: this.last, step: "any", value: 0,
      oninput: () => this.lead(this.slider.valueAsNumber),
      onkeydown: (/** @type {KeyboardEvent} */ event) => {
        const by = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageUp: 10, PageDown: -10 }[event.key];
        if (by === undefined) return;
        event.preventDefault();
        this.lead(Math.round(this.at) + by);
      } });
    const speed = el("select", { id: speeds, onchange: () => (this.rate = Number(speed.value)) },
      ...[0.25, 0.5, 1, 2, 4].map((rate) => el("option", { value: rate }, `${rate} ×`)));
    speed.value = "1";
    this.reading = el("output", { for: scrub, class: "reading" });
    this.row = el("div", { class: "row player" }, this.button, el("label", { for: scrub }, moved.label), this.slider, this.reading,
      el("label", { for: speeds }, "Speed"), speed);
  }

  /** Begin: at the first sample, and moving unless the system asks for little motion. */
  begin() {
    this.seek(0);
    if (!matchMedia("(prefers-reduced-motion: reduce)").matches) this.play();
  }

  /** Somebody leads the motion to a place: it stands still there. @param {number} at */
  lead(at) {
    this.stop();
    this.seek(Math.min(this.last, Math.max(0, at)));
  }

  /** @param {number} at */
  seek(at) {
    this.at = at;
    this.slider.value = this.moved.endless && at > this.last ? at % this.last : at;
    const reading = this.moved.reading(at);
    this.reading.value = reading;
    this.slider.setAttribute("aria-valuetext", reading);
    this.moved.show(at);
  }

  play() {
    if (this.playing) return;
    this.playing = true;
    this.button.textContent = "Pause";
    let before = performance.now();
    const step = (/** @type {number} */ now) => {
      if (!this.playing) return;
      let at = this.at + (this.sense * this.rate * this.last * Math.max(0, now - before)) / 1000 / CYCLE_S;
      before = now;
      if (this.moved.endless) at = Math.max(0, at);
      else if (this.moved.closed) at %= this.last;
      else if (at > this.last || at < 0) {
        this.sense = -this.sense;
        at = Math.min(this.last, Math.max(0, at));
      }
      this.seek(at);
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
 * A series at a place between two samples, on a straight line; null where either is unknown.
 * @param {(number | null)[]} series @param {number} at @returns {number | null}
 */
export function between(series, at) {
  const k = Math.min(Math.max(0, Math.floor(at)), series.length - 2);
  const [one, next] = [series[k], series[k + 1]];
  return one === null || next === null ? null : one + (at - k) * (next - one);
}
