/** Keyboard shortcuts and the sheet that lists them. Single letters act outside of fields only, and can be disabled. */

import { byId, createElement } from "../core/dom.js";
import { t } from "../core/messages.js";
import { localStore } from "../core/storage.js";

const DISABLED_STORAGE = "mechsynth.letters-off";

/**
 * @typedef {object} Binding
 * @property {string[]} keys
 * @property {string} shown in the sheet; empty where another one speaks for it
 * @property {string} text
 * @property {(event: KeyboardEvent) => void} act
 * @property {boolean} [everywhere] in fields, too
 */

export class Keyboard {
  /** @param {Binding[]} bindings */
  constructor(bindings) {
    this.bindings = bindings;
    this.sheet = byId("keys", HTMLDialogElement);
    const letters = byId("letters", HTMLInputElement);
    letters.checked = localStore.read(DISABLED_STORAGE) === null;
    letters.addEventListener("change", () => localStore.write(DISABLED_STORAGE, letters.checked ? null : "1"));
    this.letters = letters;
    const cap = (/** @type {string} */ one) => (one === t`or` ? ` ${one} ` : createElement("kbd", {}, one));
    const caps = (/** @type {string} */ shown) => shown.split(" ").map(cap);
    byId("keys-list").replaceChildren(
      ...bindings
        .filter(({ shown }) => shown)
        .map(({ shown, text }) =>
          createElement("div", {}, createElement("dt", {}, ...caps(shown)), createElement("dd", {}, text)),
        ),
    );
    document.addEventListener("keydown", (event) => this.handleKey(event));
  }

  open() {
    if (!this.sheet.open) this.sheet.showModal();
  }

  /** @param {KeyboardEvent} event */
  handleKey(event) {
    const name = keyName(event);
    const found = this.bindings.find((one) => one.keys.includes(name));
    if (!found || event.defaultPrevented || event.altKey) return;
    if (!found.everywhere && (takesKeys(event.target) || !this.letters.checked)) return;
    event.preventDefault();
    found.act(event);
  }
}

/** Name a key as in the bindings; Shift is left out for typed characters. @param {KeyboardEvent} event */
function keyName(event) {
  const ctrl = event.ctrlKey || event.metaKey;
  const typed = event.key.length === 1;
  const shift = event.shiftKey && (ctrl || !typed);
  return `${ctrl ? "Ctrl+" : ""}${shift ? "Shift+" : ""}${typed ? event.key.toLowerCase() : event.key}`;
}

/** What has a use of its own for keys. */
const KEY_TAKERS = "input, select, textarea, button, a, summary, .target, .held, .grip, [role=tab]";

/** Whether what has the focus has a use of its own for keys, or a dialog is open. @param {EventTarget | null} target */
function takesKeys(target) {
  if (document.querySelector("dialog[open]")) return true;
  const taken = target instanceof Element ? target.closest(KEY_TAKERS) : null;
  // What stands in a dialog that has been closed may have the focus for a moment.
  return taken !== null && taken.getClientRects().length > 0;
}

/** The first of some elements that is shown. @param {string} selector @returns {HTMLElement | null} */
export function findVisible(selector) {
  const all = /** @type {NodeListOf<HTMLElement>} */ (document.querySelectorAll(selector));
  return [...all].find((one) => one.getClientRects().length) ?? null;
}

/** The scrubber that is shown. */
function findScrubber() {
  const slider = findVisible(".player input[type=range]");
  return slider instanceof HTMLInputElement ? slider : null;
}

/** Degrees on, or back, on the scrubber that is shown. @param {number} by share of a step of a degree */
export function scrubBy(by) {
  const slider = findScrubber();
  if (!slider) return;
  const most = Number(slider.max);
  slider.value = String(Math.min(most, Math.max(0, slider.valueAsNumber + (by * most) / 360)));
  slider.dispatchEvent(new Event("input"));
}

/** Lead the motion that is shown to a share of its way. @param {number} share */
export function scrubTo(share) {
  const slider = findScrubber();
  if (!slider) return;
  slider.value = String(share * Number(slider.max));
  slider.dispatchEvent(new Event("input"));
}
