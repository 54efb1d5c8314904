/**
 * Create elements without markup: every text becomes a text node, so no text of the service or of a user is parsed as
 * HTML.
 */

import { localizeNumber, term } from "./messages.js";

/** @typedef {Node | string | number | null | undefined | false} Child */
/** Listeners say themselves of which sort their event is. @typedef {(event: never) => void} Listener */
/** @typedef {Record<string, string | number | boolean | null | undefined | Listener>} Attributes */

const SVG = "http://www.w3.org/2000/svg";

/**
 * @template {Element} T
 * @param {T} element
 * @param {Attributes} attributes `onclick` and the like are listeners; false, null and undefined leave an attribute out
 * @param {Child[]} children
 * @returns {T}
 */
function addContent(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === false || value === null || value === undefined) continue;
    if (typeof value === "function") element.addEventListener(name.slice(2), /** @type {EventListener} */ (value));
    else element.setAttribute(name, value === true ? "" : String(value));
  }
  for (const child of children) {
    if (child !== null && child !== undefined && child !== false) {
      element.append(child instanceof Node ? child : String(child));
    }
  }
  return element;
}

/**
 * Create an HTML element.
 * @template {keyof HTMLElementTagNameMap} Tag
 * @param {Tag} tag
 * @param {Attributes} [attributes]
 * @param {...Child} children
 */
export function createElement(tag, attributes = {}, ...children) {
  return addContent(document.createElement(tag), attributes, children);
}

/**
 * Create an SVG element.
 * @template {keyof SVGElementTagNameMap} Tag
 * @param {Tag} tag
 * @param {Attributes} [attributes]
 * @param {...Child} children
 */
export function createSvg(tag, attributes = {}, ...children) {
  return addContent(document.createElementNS(SVG, tag), attributes, children);
}

/**
 * Return the element with an id.
 * @template {HTMLElement} [T = HTMLElement]
 * @param {string} id
 * @param {new () => T} [type] of which it is
 * @returns {T}
 */
export function byId(id, type) {
  const found = document.getElementById(id);
  if (!(found instanceof (type ?? HTMLElement))) throw new Error(`the page has no such element ${id}`);
  return /** @type {T} */ (found);
}

/** Return the key by which a rebuilt element is found: its id or its label. @param {Element} one */
function focusKey(one) {
  return one.id || one.getAttribute("data-grip") || one.getAttribute("aria-label") || one.textContent;
}

/**
 * Rebuild the content of some elements and keep the focus: it returns to the element with the same id or label, or else
 * to the container.
 * @param {HTMLElement[]} places
 * @param {() => void} make
 */
export function rebuild(places, make) {
  const before = document.activeElement;
  const place = before ? places.find((one) => one.contains(before)) : undefined;
  const name = before && focusKey(before);
  make();
  if (!place || !before || before.isConnected) return;
  const all = [...place.querySelectorAll("a, button, input, select, summary, [tabindex]")];
  const again = all.find((one) => one.tagName === before.tagName && focusKey(one) === name);
  if (!again && !place.hasAttribute("tabindex")) place.tabIndex = -1;
  /** @type {HTMLElement} */ (again ?? place).focus({ preventScroll: true });
}

/**
 * `min_transmission_angle` as words: `Min transmission angle`.
 * @param {string} name
 */
export function toWords(name) {
  const text = term(name);
  return text.charAt(0).toUpperCase() + text.slice(1);
}

/**
 * Format a number with at most six digits; small ones as powers of ten.
 * @param {number | null | undefined} value
 */
export function formatNumber(value) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (Number.isInteger(value) && Math.abs(value) < 1e7) return localizeNumber(value).replace("-", "−");
  const digits = Number(value.toPrecision(5));
  if (digits === 0 || (Math.abs(digits) >= 1e-4 && Math.abs(digits) < 1e7))
    return localizeNumber(digits).replaceAll("-", "−");
  const [factor, power] = digits.toExponential().split("e");
  const raised = [...power.replace("+", "")].map((one) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(one)]);
  return `${localizeNumber(factor).replace("-", "−")}·10${raised.join("")}`;
}
