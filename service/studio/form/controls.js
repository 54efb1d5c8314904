/** Create the controls of single values for forms and tables. */

import { createElement, toWords } from "../core/dom.js";
import { t, term } from "../core/messages.js";

/** @import { Json, Schemas } from "../types/values.js" */

/**
 * @param {string[]} choices
 * @param {unknown} value
 * @param {boolean} nullable
 * @param {(value: Json | undefined) => void} set
 */
export function createChoice(choices, value, nullable, set) {
  const names = nullable ? ["", ...choices] : choices;
  const box = createElement(
    "select",
    { onchange: () => set(box.value === "" ? undefined : box.value) },
    ...names.map((one) => createElement("option", { value: one }, one === "" ? "–" : term(String(one)))),
  );
  box.value = String(value ?? names[0]);
  return box;
}

/** @param {unknown} value @param {unknown} fallback @param {(value: Json | undefined) => void} set */
export function createNumberBox(value, fallback, set) {
  const box = createElement("input", {
    type: "number",
    step: "any",
    inputmode: "decimal",
    placeholder: typeof fallback === "number" ? fallback : "",
    oninput: () => set(box.value === "" ? undefined : box.valueAsNumber),
  });
  if (typeof value === "number") box.value = String(value);
  return box;
}

/**
 * @param {unknown} value
 * @param {unknown} fallback
 * @param {(value: Json | undefined) => void} set
 * @param {(text: string) => Json} read
 */
export function createTextBox(value, fallback, set, read) {
  const written = (/** @type {unknown} */ one) =>
    Array.isArray(one) ? one.map((part) => part ?? "open").join(", ") : String(one ?? "");
  const box = createElement("input", {
    type: "text",
    spellcheck: "false",
    placeholder: written(fallback),
    oninput: () => set(box.value.trim() === "" ? undefined : read(box.value.trim())),
  });
  if (value !== undefined && value !== null) box.value = written(value);
  return box;
}

/** Points as text, one to a line. @param {unknown} points */
export function formatPoints(points) {
  return Array.isArray(points)
    ? points.map((point) => (Array.isArray(point) ? point.join(", ") : String(point))).join("\n")
    : "";
}

/**
 * Points of the plane, one to a line: `120, 35`. Text that is not a number stays as typed, and the service reports it.
 * @param {unknown} value @param {(value: Json | undefined) => void} set
 */
export function createPointsBox(value, set) {
  const box = createElement("textarea", {
    rows: 4,
    spellcheck: "false",
    placeholder: "0, 0\n100, 0\n100, 50",
    oninput: () => {
      const points = box.value
        .split("\n")
        .map((/** @type {string} */ line) => line.trim())
        .filter(Boolean);
      set(
        points.length
          ? points.map((/** @type {string} */ line) =>
              line
                .split(/[,;\s]+/)
                .filter(Boolean)
                .map(parseNumber),
            )
          : undefined,
      );
    },
  });
  box.value = formatPoints(value);
  return box;
}

/**
 * What a statement has as an analysis has it, such as a mechanism: its JSON. Nothing is set while the text is none.
 * @param {unknown} value @param {(value: Json | undefined) => void} set
 */
export function createJsonBox(value, set) {
  const box = createElement("textarea", {
    rows: 8,
    spellcheck: "false",
    placeholder: "{ }",
    oninput: () => {
      const text = box.value.trim();
      try {
        set(text === "" ? undefined : JSON.parse(text));
        box.setCustomValidity("");
      } catch {
        box.setCustomValidity(t`This is not valid JSON yet.`);
      }
    },
  });
  if (value !== undefined && value !== null) box.value = JSON.stringify(value, null, 1);
  return box;
}

/** A number where the text is one. @param {string} text */
export function parseNumber(text) {
  const value = Number(text);
  return Number.isFinite(value) ? value : text;
}

let ids = 0;

/**
 * Some of several words, in the order in which they are listed.
 * @param {string} name
 * @param {string} note
 * @param {string} path
 * @param {string[]} all
 * @param {string[]} value
 * @param {(value: Json | undefined) => void} set
 */
export function createChoices(name, note, path, all, value, set) {
  const boxes = all.map((one) => {
    const box = createElement("input", {
      type: "checkbox",
      id: `c${++ids}`,
      onchange: () => {
        const chosen = all.filter((_, k) => boxes[k].checked);
        set(chosen);
      },
    });
    box.checked = value.includes(one);
    return box;
  });
  return createElement(
    "fieldset",
    { class: "field", "data-path": path, tabindex: -1 },
    createElement("legend", {}, toWords(name)),
    ...boxes.map((box, k) => createElement("label", { class: "flag", for: box.id }, box, term(all[k]))),
    createElement("p", { class: "error" }),
    note && createElement("p", { class: "note" }, note),
  );
}

/**
 * Tooth numbers of a stock, with the number of equal gears: `20, 24 × 3, 30`.
 * @param {unknown} value
 * @param {(value: Json | undefined) => void} set
 */
export function createStockBox(value, set) {
  const written = (/** @type {string | number | Schemas["StockedGear"]} */ one) =>
    typeof one === "object" && one !== null ? `${one.teeth} × ${one.count ?? 1}` : String(one);
  const box = createElement("input", {
    type: "text",
    spellcheck: "false",
    oninput: () => {
      const parts = box.value
        .split(/[,;\n\t]+/)
        .map((/** @type {string} */ part) => part.trim())
        .filter(Boolean);
      set(parts.length ? parts.map(parseStock) : undefined);
    },
  });
  if (Array.isArray(value)) box.value = value.map(written).join(", ");
  return box;
}

/** Text that is not a number stays as typed, and the service reports it. @param {string} part */
function parseStock(part) {
  const [, teeth, count] = /^(\d+)\s*[×x*]\s*(\d+)$/.exec(part) ?? [];
  if (teeth) return { teeth: Number(teeth), count: Number(count) };
  return Number.isFinite(Number(part)) ? Number(part) : part;
}
