/** Play a motion: play and pause, speed, scrubber and reading. Only one motion plays at a time. */

import { createElement } from "./dom.js";
import { t } from "./messages.js";

/** Duration of a cycle at speed 1, seconds. */
const CYCLE_SECONDS = 4;

/** Interval between updates of the numbers during play, milliseconds; faster changes cannot be read. */
const READING_INTERVAL_MS = 100;

/**
 * @typedef {object} Moved
 * @property {number} count samples of the motion
 * @property {boolean} closed whether the last sample is the first again: it then goes on, and otherwise back and forth
 * @property {boolean} [endless] the place counts on beyond the last sample: what turns need not come back after a cycle
 * @property {string} label what the scrubber moves
 * @property {string} [name] before the ids of its controls, where a page has a second one
 * @property {(at: number) => string} reading text next to the scrubber
 * @property {(at: number, told: boolean) => void} show called with a place of the arrays, between two samples as a
 *   fraction, and whether its numbers are shown
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
    /** Where it goes back and forth, instead of over all of it. @type {[number, number] | null} */
    this.range = null;
    this.last = moved.count - 1;
    /** Listeners, called at every change of the share. @type {Set<(share: number, told: boolean) => void>} */
    this.followers = new Set();
    this.button = createElement(
      "button",
      {
        type: "button",
        id: `${moved.name ?? ""}play`,
        class: "small",
        onclick: () => (this.playing ? this.stop() : this.play()),
      },
      t`Play`,
    );
    this.slider = createElement("input", {
      type: "range",
      id: scrub,
      min: 0,
      max: this.last,
      step: "any",
      value: 0,
      oninput: () => this.leadTo(this.slider.valueAsNumber),
      onkeydown: (/** @type {KeyboardEvent} */ event) => {
        const by = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageUp: 10, PageDown: -10 }[event.key];
        // It stands still there, also where it is there already.
        const to = by === undefined ? { Home: 0, End: this.last }[event.key] : Math.round(this.at) + by;
        if (to === undefined) return;
        event.preventDefault();
        this.leadTo(to);
      },
    });
    const speed = createElement(
      "select",
      { id: speeds, onchange: () => (this.rate = Number(speed.value)) },
      ...[0.25, 0.5, 1, 2, 4].map((rate) => createElement("option", { value: rate }, `${rate}×`)),
    );
    speed.value = "1";
    this.reading = createElement("output", { for: scrub, class: "reading" });
    this.row = createElement(
      "div",
      { class: "row player" },
      this.button,
      createElement("label", { for: scrub }, moved.label),
      this.slider,
      this.reading,
      createElement("label", { for: speeds }, t`Speed`),
      speed,
    );
  }

  /** Begin: at the first place, and moving unless the system asks for little motion. */
  begin() {
    this.sense = 1;
    this.seek(this.range?.[0] ?? 0);
    if (!matchMedia("(prefers-reduced-motion: reduce)").matches) this.play();
  }

  /** Somebody leads the motion to a place: it stands still there. @param {number} at */
  leadTo(at) {
    this.stop();
    this.seek(Math.min(this.last, Math.max(0, at)));
  }

  /**
   * Keep to a part of the motion, and play it: where the motion comes back, the part may lie beyond its ends.
   * @param {[number, number] | null} range
   */
  restrictTo(range) {
    this.range = range;
    if (range) this.begin();
    else this.at = clampIndex(this.at, this.last);
  }

  /** @param {number} at @param {boolean} [told] whether its numbers are shown */
  seek(at, told = true) {
    this.at = at;
    if (!this.moved.endless) at = clampIndex(at, this.last);
    this.slider.value = String(this.moved.endless && at > this.last ? at % this.last : at);
    if (told) {
      const reading = this.moved.reading(at);
      this.reading.value = reading;
      this.slider.setAttribute("aria-valuetext", reading);
    }
    this.moved.show(at, told);
    for (const follow of this.followers) follow(at / this.last, told);
  }

  play() {
    if (this.playing) return;
    this.playing = true;
    this.button.textContent = t`Pause`;
    if (this.range) this.at = this.range[0] + clampIndex(this.at - this.range[0], this.last);
    let before = performance.now();
    let toldAt = before;
    const step = (/** @type {number} */ now) => {
      if (!this.playing) return;
      let at = this.at + (this.sense * this.rate * this.last * Math.max(0, now - before)) / 1000 / CYCLE_SECONDS;
      before = now;
      const [from, to] = this.range ?? [0, this.last];
      if (this.moved.endless) at = Math.max(0, at);
      else if (this.moved.closed && !this.range) at %= this.last;
      else if (at > to || at < from) {
        this.sense = at > to ? -1 : 1;
        at = Math.min(to, Math.max(from, at));
      }
      const told = now - toldAt >= READING_INTERVAL_MS;
      if (told) toldAt = now;
      this.seek(at, told);
      this.frame = requestAnimationFrame(step);
    };
    this.frame = requestAnimationFrame(step);
  }

  stop() {
    cancelAnimationFrame(this.frame);
    this.button.textContent = t`Play`;
    if (!this.playing) return;
    this.playing = false;
    // Show the numbers of a motion that stands still.
    this.seek(this.at);
  }
}

/** A place beyond the arrays of a motion that comes back, within them. @param {number} at @param {number} last */
export function clampIndex(at, last) {
  return at >= 0 && at <= last ? at : at - last * Math.floor(at / last);
}

/**
 * A series at a place between two samples, on a straight line; null where either is unknown.
 * @param {(number | null)[]} series @param {number} at @returns {number | null}
 */
export function interpolate(series, at) {
  const k = Math.min(Math.max(0, Math.floor(at)), series.length - 2);
  const [one, next] = [series[k], series[k + 1]];
  return one === null || next === null ? null : one + (at - k) * (next - one);
}
