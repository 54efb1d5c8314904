/** Show the errors of a problem at their fields. */

import { createElement } from "../core/dom.js";
import { t, term } from "../core/messages.js";

let error_ids = 0;

/** @param {HTMLElement} form @param {HTMLElement} list */
export function clearErrors(form, list) {
  list.replaceChildren();
  for (const slot of form.querySelectorAll(".error")) slot.replaceChildren();
  for (const control of form.querySelectorAll("[aria-invalid]")) {
    control.removeAttribute("aria-invalid");
    control.removeAttribute("title");
  }
}

/**
 * @param {HTMLElement} form @param {HTMLElement} list
 * @param {{message: string, errors: import("../core/api.js").FieldError[]}} refusal
 */
export function showErrors(form, list, refusal) {
  clearErrors(form, list);
  /** @type {HTMLElement | null} */
  let first = null;
  const lost = [];
  for (const fault of refusal.errors) {
    const place = nearestControl(form, fault.path);
    if (!place) {
      lost.push(fault);
      continue;
    }
    place.control.setAttribute("aria-invalid", "true");
    const rest = fault.path.slice(place.path.length + 1);
    const [row, name] = fault.path.split("/").slice(-2);
    const cell = place.control.parentElement?.matches("td") && /^\d+$/.test(row);
    const where = cell ? `${t`Row ${Number(row) + 1}, ${term(name)}`}: ` : rest ? `${rest}: ` : "";
    const said = createElement(
      "span",
      { id: `fault${++error_ids}` },
      where,
      createElement("span", {}, `${fault.detail} `),
    );
    place.slot?.append(said);
    if (cell) {
      place.control.setAttribute("aria-describedby", said.id);
      place.control.title = fault.detail;
    }
    place.control.closest(".table.brief")?.classList.remove("brief");
    for (let above = place.control.closest("details"); above; above = above.parentElement?.closest("details") ?? null)
      above.open = true;
    first ??= place.control;
  }
  list.append(
    createElement("p", { class: "error" }, refusal.message),
    ...(lost.length
      ? [
          createElement(
            "ul",
            {},
            ...lost.map((fault) => createElement("li", {}, `${fault.path || t`the problem`}: ${fault.detail}`)),
          ),
        ]
      : []),
  );
  first?.focus();
  first?.scrollIntoView({ block: "nearest" });
}

/**
 * The control at a JSON pointer, or at the nearest place above it.
 * @param {HTMLElement} form
 * @param {string} pointer
 */
function nearestControl(form, pointer) {
  // Groups have their controls only when they are open.
  const parts = pointer.split("/");
  for (let k = 3; k <= parts.length; k++) {
    const above = parts.slice(0, k).join("/");
    for (const path of [above, `${above}/`])
      form.querySelector(`details[data-path="${CSS.escape(path)}"]`)?.dispatchEvent(new Event("reveal"));
  }
  for (let path = pointer; path.split("/").length > 2; path = path.slice(0, path.lastIndexOf("/"))) {
    const found = /** @type {HTMLElement | null} */ (form.querySelector(`[data-path="${CSS.escape(path)}"]`));
    if (!found) continue;
    const slot = found.matches(".field")
      ? found.querySelector(":scope > .error")
      : found.closest(".field")?.querySelector(":scope > .error");
    return { control: found, path, slot };
  }
  return null;
}
