/** Controls of a single value, as forms and tables have them. */

import { el } from "./dom.js";

/** @param {string[]} choices @param {any} value @param {boolean} nullable @param {(value: any) => void} set */
export function choice(choices, value, nullable, set) {
  const names = nullable ? ["", ...choices] : choices;
  const box = el("select", { onchange: () => set(box.value === "" ? undefined : box.value) },
    ...names.map((one) => el("option", { value: one }, one === "" ? "–" : String(one).replaceAll("_", " "))));
  box.value = value ?? names[0];
  return box;
}

/** @param {any} value @param {any} fallback @param {(value: any) => void} set */
export function numberBox(value, fallback, set) {
  const box = el("input", { type: "number", step: "any", inputmode: "decimal",
    placeholder: typeof fallback === "number" ? fallback : "",
    oninput: () => set(box.value === "" ? undefined : box.valueAsNumber) });
  if (typeof value === "number") box.value = value;
  return box;
}
