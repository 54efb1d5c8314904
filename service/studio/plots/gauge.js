/** A gauge of an angle from 0° to 90° with its current value, its minimum and its limit. */

import { createElement, formatNumber, createSvg } from "../core/dom.js";
import { t } from "../core/messages.js";

const WIDTH = 190;
const RADIUS = 70;
const CENTRE = [92, 82];

/** @param {number} degrees @param {number} radius @returns {[number, number]} */
function dialPoint(degrees, radius) {
  const turn = Math.PI * (1 - degrees / 90);
  return [CENTRE[0] + radius * Math.cos(turn), CENTRE[1] - radius * Math.sin(turn)];
}

/** An arc from one angle to another. @param {number} from @param {number} to @param {string} kind */
function arcPath(from, to, kind) {
  const [[x, y], [u, v]] = [dialPoint(from, RADIUS), dialPoint(to, RADIUS)];
  return createSvg("path", { class: kind, d: `M${x} ${y}A${RADIUS} ${RADIUS} 0 0 1 ${u} ${v}` });
}

/** @param {number | null} angle */
export function formatDegrees(angle) {
  return angle === null ? "–" : `${formatNumber(Math.round(10 * angle) / 10)}°`;
}

export class AngleGauge {
  /**
   * @param {string} title @param {(number | null)[]} series over the motion
   * @param {{
   *   limit: number | null | undefined,
   *   measured?: number | null,
   *   used?: number | null,
   *   atMost?: boolean,
   * }} bound which the angle keeps above, or below; its extreme over the whole motion, between the samples too, if it
   *   was measured; and its extreme in the range that is used, where that is not the whole motion
   */
  constructor(title, series, { limit, measured, used, atMost = false }) {
    const known = /** @type {number[]} */ (series.filter((one) => one !== null));
    const whole = measured ?? (atMost ? Math.max(...known) : Math.min(...known));
    const extreme = used ?? whole;
    const told = atMost ? t`maximum ${formatDegrees(extreme)}` : t`minimum ${formatDegrees(extreme)}`;
    const partly = Math.abs(whole - extreme) > 0.5;
    this.needle = createSvg("path", { class: "needle" });
    const [x, y] = dialPoint(Math.min(90, extreme), RADIUS + 9);
    const [u, v] = dialPoint(Math.min(90, extreme), RADIUS - 9);
    this.now = createElement("output", { class: "reading" });
    this.limit = limit;
    this.atMost = atMost;
    const bad =
      typeof limit === "number" &&
      limit > 0 &&
      limit < 90 &&
      (atMost ? arcPath(limit, 90, "dial beyond") : arcPath(0, limit, "dial beyond"));
    this.node = createElement(
      "figure",
      { class: "gauge" },
      createElement("figcaption", {}, title, this.now),
      createSvg(
        "svg",
        {
          viewBox: `0 0 ${WIDTH} 104`,
          role: "img",
          "aria-label": [
            `${title}: ${told}`,
            partly && t`between the targets; ${formatDegrees(whole)} over the whole motion`,
            typeof limit === "number" && t`limit ${formatDegrees(limit)}`,
          ]
            .filter(Boolean)
            .join(", "),
        },
        arcPath(0, 90, "dial"),
        bad,
        createSvg("line", { class: "least", x1: x, y1: y, x2: u, y2: v }),
        this.needle,
        createSvg("circle", { class: "pin", r: 3.5, cx: CENTRE[0], cy: CENTRE[1] }),
        ...[0, 30, 60, 90].map((mark) => {
          const [tx, ty] = dialPoint(mark, RADIUS - 15);
          return createSvg("text", { class: "tick", x: tx, y: ty + 3, "text-anchor": "middle" }, mark);
        }),
        createSvg("text", { x: CENTRE[0], y: 101, "text-anchor": "middle" }, told),
      ),
      partly &&
        createElement("p", { class: "note" }, t`between the targets; ${formatDegrees(whole)} over the whole motion`),
    );
  }

  /** @param {number | null} angle @param {boolean} told whether its number is shown */
  show(angle, told) {
    if (told) this.now.value = formatDegrees(angle);
    this.needle.toggleAttribute("hidden", angle === null);
    if (angle === null) return;
    const [x, y] = dialPoint(Math.min(90, Math.max(0, angle)), RADIUS - 4);
    this.needle.setAttribute("d", `M${CENTRE[0]} ${CENTRE[1]}L${x.toFixed(1)} ${y.toFixed(1)}`);
    const beyond =
      typeof this.limit === "number" && (this.atMost ? angle > this.limit + 1e-6 : angle < this.limit - 1e-6);
    this.needle.classList.toggle("beyond", beyond);
  }
}
