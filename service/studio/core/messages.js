/**
 * Translate the texts of the page and format their numbers. The English text is the key.
 *
 * The sources say what they say in English. The tag t looks a text of the page up among the messages of the chosen
 * language, and translate() a description of the service; texts not found there stay English. English itself has no
 * messages and waits for none. Answers and errors of the service arrive in the language of the page.
 */

import { localStore } from "./storage.js";

/** Language of the texts in the sources. */
const SOURCE_LANGUAGE = "en";

/** Name under which the choice is stored. */
const STORAGE_NAME = "mechsynth.language";

/** Attributes with text for the user. */
const TEXT_ATTRIBUTES = ["aria-label", "title", "placeholder", "content"];

/**
 * The available languages, listed in the head of the page.
 * @type {Record<string, {name: string, messages: string}>}
 */
export const languages = {
  [SOURCE_LANGUAGE]: { name: "English", messages: "" },
  ...Object.fromEntries(
    [.../** @type {NodeListOf<HTMLLinkElement>} */ (document.querySelectorAll("link[hreflang]"))].map((link) => [
      link.hreflang,
      { name: link.title, messages: link.href },
    ]),
  ),
};

/** The chosen language. */
export const language = chooseLanguage();

/** Decimal separator of the language. */
const DECIMAL_SEPARATOR =
  new Intl.NumberFormat(language).formatToParts(0.5).find((part) => part.type === "decimal")?.value ?? ".";

/** Separator of the numbers in a list; a comma may be the decimal separator. */
export const LIST_SEPARATOR = DECIMAL_SEPARATOR === "," ? "; " : ", ";

/** Smallest number whose digits are grouped by three. */
const MIN_GROUPED = 10_000;

/** Translations by English text; empty for English. @type {Record<string, string>} */
const messages = language === SOURCE_LANGUAGE ? {} : await fetchMessages(languages[language].messages);

/** Return the stored choice, or the first available language of the browser. */
function chooseLanguage() {
  const wanted = [localStore.read(STORAGE_NAME) ?? "", ...navigator.languages.map((one) => one.split("-")[0])];
  return wanted.find((one) => one in languages) ?? SOURCE_LANGUAGE;
}

/** Switch the language and reload the page, because texts are looked up when they are written. @param {string} code */
export function switchLanguage(code) {
  localStore.write(STORAGE_NAME, code);
  location.reload();
}

/**
 * Fetch the translations; if that fails, the page stays English.
 * @param {string} address
 * @returns {Promise<Record<string, string>>}
 */
async function fetchMessages(address) {
  try {
    return await (await fetch(address)).json();
  } catch {
    return {};
  }
}

/**
 * Translate a text of the page; a template tag. Values appear as `{0}`, `{1}` in the key.
 * @param {TemplateStringsArray} parts @param {...(string | number | null | undefined)} values
 */
export function t(parts, ...values) {
  const key = parts.reduce((text, part, k) => `${text}{${k - 1}}${part}`);
  return fillPlaces(
    messages[key] ?? key,
    values.map((one) => (typeof one === "number" ? localizeNumber(one) : String(one))),
  );
}

/** @param {string} message @param {string[]} values */
function fillPlaces(message, values) {
  return values.length ? message.replace(/\{(\d+)\}/g, (place, k) => values[Number(k)] ?? place) : message;
}

/**
 * Translate a title, a name or a description of the service. Its messages are in the language of the page already.
 * @param {string} text
 */
export function translate(text) {
  return messages[text] ?? text;
}

/** Return the language of a text of the service if it has no translation. @param {string} text */
export function foreignLanguage(text) {
  return language !== SOURCE_LANGUAGE && translate(text) === text ? SOURCE_LANGUAGE : null;
}

/** Return the first paragraph of a description as plain text. @param {string | undefined} description */
export function firstParagraph(description = "") {
  const said = translate(description.split("\n\n")[0].replaceAll("`", "").replaceAll("\n", " "));
  // Replace names of fields by their labels.
  return said.replace(/\b[a-z]{2,}(_[a-z]+)+\b/g, (name) => term(name));
}

/** Matches a number with a unit, which must not be separated. */
const UNIT_PATTERN = /(\d) (%|mm|cm|m|in|kg|g|J|W|N|s)(?![\p{L}\p{N}])/gu;

/**
 * A text of the service with numbers as the page writes them: 2.34e-06 is 2.34·10⁻⁶, 2 ° is 2°, and 5 % and 5 mm are
 * not divided at the end of a line.
 * @param {string} text
 */
export function formatText(text) {
  const begun =
    text.charAt(0).toUpperCase() +
    text
      .slice(1)
      .replace(/(\d) °/g, "$1°")
      .replace(UNIT_PATTERN, "$1\u00a0$2");
  return begun.replace(/(\d)e([+-])0*(\d+)\b/g, (_, digit, sign, power) => {
    const raised = [...power].map((one) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[Number(one)]).join("");
    return `${digit}·10${sign === "-" ? "⁻" : ""}${raised}`;
  });
}

/** Terms that differ from their names. @type {Record<string, string>} */
const SPECIAL_TERMS = {
  "watt 1": "Watt I",
  "watt 2": "Watt II",
  "stephenson 1": "Stephenson I",
  "stephenson 2": "Stephenson II",
  "stephenson 3": "Stephenson III",
  "geneva external": "external Geneva drive",
  "geneva internal": "internal Geneva drive",
  "geneva spherical": "spherical Geneva drive",
};

/** `min_transmission_angle` as it stands within a sentence: `min transmission angle`. @param {string} name */
export function term(name) {
  const plain = name.replaceAll("_", " ");
  return messages[plain] ?? SPECIAL_TERMS[plain] ?? plain;
}

/** Group the digits of a whole number by three, as the service does. @param {number} value */
export function groupDigits(value) {
  const digits = String(value);
  return value < MIN_GROUPED ? digits : digits.replace(/\B(?=(\d{3})+$)/g, "\u202f");
}

/** Write a number with the decimal separator of the language. @param {number | string} value */
export function localizeNumber(value) {
  return DECIMAL_SEPARATOR === "." ? String(value) : String(value).replace(".", DECIMAL_SEPARATOR);
}

/** Translate the static markup of the page. */
export function translatePage() {
  document.documentElement.lang = language;
  if (language === SOURCE_LANGUAGE) return;
  const walker = document.createTreeWalker(document.documentElement, NodeFilter.SHOW_TEXT | NodeFilter.SHOW_ELEMENT);
  while (walker.nextNode()) {
    const node = walker.currentNode;
    if (node instanceof Element) {
      for (const name of TEXT_ATTRIBUTES)
        if (node.hasAttribute(name)) node.setAttribute(name, translateMarkup(String(node.getAttribute(name))));
    } else if (node.textContent) node.textContent = translateMarkup(node.textContent);
  }
}

/** Translate a text of the markup and keep its surrounding space. @param {string} text */
function translateMarkup(text) {
  const bare = text.trim();
  return text.replace(bare, () => messages[bare.replace(/\s+/g, " ")] ?? bare);
}
