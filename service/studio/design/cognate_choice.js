/** The fourbars that trace the same coupler curve (Roberts, Chebyshev), to be switched in place. */

import * as api from "../core/api.js";
import { createElement, formatNumber, toWords } from "../core/dom.js";
import { t } from "../core/messages.js";

/** @import { Design, Mechanism, Metrics, Problem, Question, Schemas } from "../types/values.js" */

/**
 * @typedef {{name: string, mechanism: Mechanism, note: string, metrics: Partial<Metrics>}} Choice with what was
 *   measured of it
 */

/** Kinds whose answer is the curve of P and not the turning of the body. */
const CURVE_KINDS = ["path", "straight_line"];

/**
 * The design and its cognates; one choice only where there are none.
 * @param {Design} design @param {Problem} problem @param {AbortSignal} signal @returns {Promise<Choice[]>}
 */
export async function fetchCognates(design, problem, signal) {
  const { mechanism } = design;
  const own = { name: t`Design`, mechanism, note: design.cognate_choice ?? "", metrics: design.metrics ?? {} };
  if (mechanism.type !== "fourbar" || !CURVE_KINDS.includes(problem.kind)) return [own];
  if (design.cognates?.length) {
    return [
      own,
      ...design.cognates.map((cognate) => {
        const { side, mechanism: its, ...metrics } = cognate;
        return {
          name: side === "left" ? t`Left cognate` : t`Right cognate`,
          mechanism: its,
          note: describeCognate(cognate),
          metrics: /** @type {Partial<Metrics>} */ (metrics),
        };
      }),
    ];
  }
  /** @type {Question} */
  const question = { mechanism, motion: { at: Number(mechanism.reference_input_angle) }, include: ["cognates"] };
  const pair = await api.analyse(question, signal).then(
    (answer) => answer.fourbar?.cognates,
    () => null,
  );
  if (!pair) return [own];
  return [
    own,
    {
      name: t`Left cognate`,
      mechanism: /** @type {Mechanism} */ (pair.left),
      metrics: {},
      note: t`It traces the same curve; its input turns with the design's coupler.`,
    },
    {
      name: t`Right cognate`,
      mechanism: /** @type {Mechanism} */ (pair.right),
      metrics: {},
      note: t`It traces the same curve; its input turns with the design's input.`,
    },
  ];
}

/** @param {Schemas["PathCognate"]} one a cognate as measured */
function describeCognate(one) {
  const angle = formatNumber(Math.round(10 * one.min_transmission_angle) / 10);
  const able = [
    t`${toWords(one.grashof)}, minimum transmission angle ${angle}°`,
    one.same_timing ? t`keeps the crank angles` : t`has other crank angles`,
    one.same_branch ? t`passes all targets without a toggle` : t`passes a toggle between the targets`,
    t`traces the curve within ${formatNumber(Number(one.deviation.toPrecision(2)))}`,
  ];
  return `${able.join("; ")}.`;
}

/** @param {Choice[]} choices @param {(choice: Choice) => void} choose */
export function createPicker(choices, choose) {
  const notes = choices.map((one) => createElement("span", {}, one.note));
  const note = createElement("span", { class: "note" }, notes[0]);
  return createElement(
    "fieldset",
    { id: "cognates", class: "row choice" },
    createElement("legend", {}, t`Same curve from`),
    ...choices.map((one, k) => {
      const box = createElement("input", {
        type: "radio",
        name: "cognate",
        id: `cognate-${k}`,
        onchange: () => {
          note.replaceChildren(notes[k]);
          choose(one);
        },
      });
      box.checked = k === 0;
      return createElement("label", { class: "flag", for: `cognate-${k}` }, box, one.name);
    }),
    note,
  );
}
