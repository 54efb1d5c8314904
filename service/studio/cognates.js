/** The fourbars that trace the same coupler curve (Roberts, Chebyshev), to be switched in place. */

import * as api from "./api.js";
import { el, shown, words } from "./dom.js";

/** @typedef {{name: string, mechanism: any, note: string}} Choice */

/** Kinds whose answer is the curve of P and not the turning of the body. */
const BY_CURVE = ["path", "straight_line"];

/**
 * The design and its cognates; one choice only where there are none.
 * @param {any} design @param {any} problem @param {AbortSignal} signal @returns {Promise<Choice[]>}
 */
export async function cognates(design, problem, signal) {
  const { mechanism } = design;
  const own = { name: "Design", mechanism, note: design.cognate_choice ?? "" };
  if (mechanism.type !== "fourbar" || !BY_CURVE.includes(problem.kind)) return [own];
  if (design.cognates?.length) {
    return [own, ...design.cognates.map((/** @type {any} */ one) => ({ name: `${words(one.side)} cognate`, mechanism: one.mechanism, note: told(one) }))];
  }
  const question = { mechanism, motion: { at: mechanism.reference_input_angle }, include: ["cognates"] };
  const found = await api.analysis(question, signal).then((answer) => answer.fourbar.cognates, () => null);
  if (!found) return [own];
  return [own, { name: "Left cognate", mechanism: found.left, note: "It traces the same curve; its input turns with the design's coupler." },
    { name: "Right cognate", mechanism: found.right, note: "It traces the same curve; its input turns with the design's input." }];
}

/** @param {any} one a cognate as measured */
function told(one) {
  const able = [
    `${words(one.grashof)}, transmits at ${shown(Math.round(10 * one.min_transmission_angle) / 10)}° at least`,
    one.same_timing ? "keeps the crank angles" : "has other crank angles",
    one.same_branch ? "passes all targets without a toggle" : "passes a toggle between the targets",
    `traces the curve within ${shown(Number(one.deviation.toPrecision(2)))}`,
  ];
  return `${able.join("; ")}.`;
}

/** @param {Choice[]} choices @param {(choice: Choice) => void} choose */
export function picker(choices, choose) {
  const note = el("span", { class: "note" }, choices[0].note);
  return el("fieldset", { id: "cognates", class: "row choice" }, el("legend", {}, "The same curve by"),
    ...choices.map((one, k) => {
      const box = el("input", { type: "radio", name: "cognate", id: `cognate-${k}`, onchange: () => {
        note.replaceChildren(one.note);
        choose(one);
      } });
      box.checked = k === 0;
      return el("label", { class: "flag", for: `cognate-${k}` }, box, one.name);
    }), note);
}
