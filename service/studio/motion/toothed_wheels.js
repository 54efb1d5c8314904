/** Draw toothed wheels and place them with their teeth in mesh. */

import { createSvg } from "../core/dom.js";
import { t } from "../core/messages.js";

/** @typedef {[number, number]} Point */

/**
 * @typedef {object} Wheel
 * @property {string} name
 * @property {number} teeth
 * @property {number} module
 * @property {boolean} [internal]
 * @property {Point} centre at input angle 0
 * @property {number} tooth angle of one tooth's middle at input angle 0, radians
 * @property {number} speed its rotation over the input's
 * @property {number} [orbit] rotation of the carrier that its pin is on, over the input's
 * @property {Point} [axis] about which it goes round, the origin where there is none
 * @property {number} tone which colour it has
 * @property {boolean} [idle] not engaged
 */

/** Pitch radius. @param {Wheel} wheel */
export function pitchRadius(wheel) {
  return 0.5 * wheel.module * wheel.teeth;
}

/**
 * Angle of a tooth of `other` so that a space of it faces the tooth of `one` nearest to their contact, which lies in
 * the
 * direction `ahead` of the centre of `one`.
 * @param {Wheel} one @param {Wheel} other @param {number} ahead
 */
export function phaseFacing(one, other, ahead) {
  const pitch = (2 * Math.PI) / one.teeth;
  const off = one.tooth - ahead;
  const past = ((off - pitch * Math.round(off / pitch)) * one.teeth) / other.teeth;
  return one.internal || other.internal
    ? ahead + past + Math.PI / other.teeth
    : ahead + Math.PI - past + Math.PI / other.teeth;
}

/**
 * Teeth as straight flanks around the origin, the first in the direction x; pixels.
 * @param {Wheel} wheel
 * @param {number} scale
 */
function toothOutline(wheel, scale) {
  const m = scale * wheel.module;
  const r = (m * wheel.teeth) / 2;
  const out = wheel.internal ? -1 : 1;
  const quarter = Math.PI / (2 * wheel.teeth);
  const lean = (m * Math.tan(Math.PI / 9)) / r;
  const corners = [
    [r - out * 1.25 * m, -quarter - 1.25 * lean],
    [r + out * m, -quarter + lean],
    [r + out * m, quarter - lean],
    [r - out * 1.25 * m, quarter + 1.25 * lean],
  ];
  let data = "";
  for (let k = 0; k < wheel.teeth; k++) {
    for (const [far, angle] of corners) {
      const turn = angle + (2 * Math.PI * k) / wheel.teeth;
      data += `${data ? "L" : "M"}${(far * Math.cos(turn)).toFixed(1)} ${(-far * Math.sin(turn)).toFixed(1)}`;
    }
  }
  const rim = r + 3 * m;
  return `${data}Z${wheel.internal ? `M${rim} 0A${rim} ${rim} 0 1 0 ${-rim} 0A${rim} ${rim} 0 1 0 ${rim} 0Z` : ""}`;
}

/** A wheel as a drawing, and what turns it. @param {import("../core/view.js").View} view @param {Wheel} wheel */
export function createWheel(view, wheel) {
  const r = view.scale * pitchRadius(wheel);
  const spoke = wheel.internal
    ? [r + view.scale * 1.4 * wheel.module, r + view.scale * 2.9 * wheel.module]
    : [0, 0.8 * r];
  const node = createSvg(
    "g",
    { class: `wheel t${wheel.tone % 4}${wheel.idle ? " idle" : ""}` },
    createSvg("title", {}, t`${wheel.name}: ${wheel.teeth} teeth`),
    !wheel.idle && createSvg("path", { class: "teeth", "fill-rule": "evenodd", d: toothOutline(wheel, view.scale) }),
    createSvg("circle", { class: "pitch", r }),
    !wheel.idle && createSvg("path", { class: "spoke", d: `M${spoke[0]} 0H${spoke[1]}` }),
    !wheel.internal && createSvg("circle", { class: "pin", r: 3.5 }),
  );
  const turn = (/** @type {number} */ input) => {
    const [x, y] = placeWheel(wheel, input);
    const [u, v] = view.toPicture(x, y);
    const angle = wheel.tooth + wheel.speed * input;
    node.setAttribute(
      "transform",
      `translate(${u.toFixed(2)} ${v.toFixed(2)}) rotate(${((-angle * 180) / Math.PI).toFixed(3)})`,
    );
  };
  return { node, turn };
}

/** Where a wheel's centre is. @param {Wheel} wheel @param {number} input radians @returns {Point} */
export function placeWheel(wheel, input) {
  const [x, y] = wheel.centre;
  if (!wheel.orbit) return [x, y];
  const [c, s] = [Math.cos(wheel.orbit * input), Math.sin(wheel.orbit * input)];
  const [u, v] = wheel.axis ?? [0, 0];
  return [u + c * (x - u) - s * (y - v), v + s * (x - u) + c * (y - v)];
}
