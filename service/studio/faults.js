/** What is wrong with a statement, said at the fields it belongs to. */

import { el } from "./dom.js";

/** @param {HTMLElement} form @param {HTMLElement} list */
export function clear(form, list) {
  list.replaceChildren();
  for (const slot of form.querySelectorAll(".error")) slot.replaceChildren();
  for (const control of form.querySelectorAll("[aria-invalid]")) control.removeAttribute("aria-invalid");
}

/**
 * @param {HTMLElement} form @param {HTMLElement} list
 * @param {{message: string, errors: import("./api.js").FieldError[]}} refusal
 */
export function tell(form, list, refusal) {
  clear(form, list);
  /** @type {HTMLElement | null} */
  let first = null;
  const lost = [];
  for (const fault of refusal.errors) {
    const place = nearest(form, fault.path);
    if (!place) {
      lost.push(fault);
      continue;
    }
    place.control.setAttribute("aria-invalid", "true");
    const rest = fault.path.slice(place.path.length + 1);
    const where = place.control.closest("td") ? `${fault.path.split("/").slice(-2).join(" ")}: ` : rest ? `${rest}: ` : "";
    place.slot?.append(el("span", {}, `${where}${fault.detail} `));
    first ??= place.control;
  }
  list.append(el("p", { class: "error" }, refusal.message),
    ...(lost.length ? [el("ul", {}, ...lost.map((fault) => el("li", {}, `${fault.path || "the statement"}: ${fault.detail}`)))] : []));
  first?.focus();
}

/** The control at a JSON pointer, or at the nearest place above it. @param {HTMLElement} form @param {string} pointer */
function nearest(form, pointer) {
  for (let path = pointer; path.split("/").length > 2; path = path.slice(0, path.lastIndexOf("/"))) {
    for (let found = /** @type {HTMLElement | null} */ (form.querySelector(`[data-path="${CSS.escape(path)}"]`)); found; ) {
      for (let above = found.closest("details"); above; above = above.parentElement?.closest("details") ?? null) above.open = true;
      const slot = found.matches(".field") ? found.querySelector(":scope > .error") : found.closest(".field")?.querySelector(":scope > .error");
      return { control: found, path, slot };
    }
  }
  return null;
}
