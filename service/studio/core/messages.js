/**
 * The language of the page: its texts, by what they are in English, and the numbers in them.
 *
 * The sources say what they say in English. The tag t looks a text of the page up among the messages of the chosen
 * language,
 * and translated a text of the service; what is not found there stays English. English itself has no messages and waits
 * for none.
 */

import { localStore } from "./storage.js";

/** The language of the sources. */
const SOURCE_LANGUAGE = "en";

/** Under which name the choice is kept. */
const STORAGE_NAME = "mechsynth.language";

/** What the person reads of an element that is no text of its own. */
const TEXT_ATTRIBUTES = ["aria-label", "title", "placeholder", "content"];

/**
 * The languages that the page has: the head of the page lists them.
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

/** The language that the page speaks. */
export const language = chooseLanguage();

/** What separates whole numbers from fractions in that language. */
const DECIMAL_SEPARATOR =
  new Intl.NumberFormat(language).formatToParts(0.5).find((part) => part.type === "decimal")?.value ?? ".";

/** What separates the numbers of a list: a comma may be a decimal one. */
export const LIST_SEPARATOR = DECIMAL_SEPARATOR === "," ? "; " : ", ";

/** Counts from here on have their digits in groups of three. */
const MIN_GROUPED = 10_000;

/** A number in English prose: what stands in its place is a number too. */
const NUMBER_PATTERN = /(?<![\w{])[-−]?\d+(?:\u202f\d{3})*(?:\.\d+)?(?:e[-+]?\d+)?(?![\w}])/g;

/** Texts by what they are in English; of English itself none. @type {Record<string, string>} */
const messages = language === SOURCE_LANGUAGE ? {} : await fetchMessages(languages[language].messages);

/** What was chosen, or the first of the languages of the browser that there is. */
function chooseLanguage() {
  const wanted = [localStore.read(STORAGE_NAME) ?? "", ...navigator.languages.map((one) => one.split("-")[0])];
  return wanted.find((one) => one in languages) ?? SOURCE_LANGUAGE;
}

/** The page is then read anew: texts are looked up as they are written. @param {string} code */
export function switchLanguage(code) {
  localStore.write(STORAGE_NAME, code);
  location.reload();
}

/**
 * Where they do not come, the page speaks English.
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
 * A text of the page in its language, as the tag of a template; values stand as `{0}`, `{1}` in what is looked up.
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
 * A text of the service in the language of the page. It may have numbers in it: `72 starts` is found as `{0} starts`.
 * @param {string} text
 */
export function translate(text) {
  if (language === SOURCE_LANGUAGE || text in messages) return messages[text] ?? text;
  /** @type {string[]} */
  const values = [];
  const message = messages[text.replace(NUMBER_PATTERN, (one) => `{${values.push(localizeNumber(one)) - 1}}`)];
  return message === undefined ? text : fillPlaces(message, values);
}

/** The language of a text of the service, where it is not that of the page. @param {string} text */
export function foreignLanguage(text) {
  return language !== SOURCE_LANGUAGE && translate(text) === text ? SOURCE_LANGUAGE : null;
}

/** The first paragraph of a description, as prose. @param {string | undefined} description */
export function firstParagraph(description = "") {
  const said = translate(description.split("\n\n")[0].replaceAll("`", "").replaceAll("\n", " "));
  // Names of fields, as they stand at them.
  return said.replace(/\b[a-z]{2,}(_[a-z]+)+\b/g, (name) => term(name));
}

/** What follows a number after a space, and stays with it. */
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

/** What is not called as it is written. @type {Record<string, string>} */
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

/** A whole number in a sentence, its digits in groups of three, as the service writes it. @param {number} value */
export function groupDigits(value) {
  const digits = String(value);
  return value < MIN_GROUPED ? digits : digits.replace(/\B(?=(\d{3})+$)/g, "\u202f");
}

/** A number as the language writes it; its digits are those that it has. @param {number | string} value */
export function localizeNumber(value) {
  return DECIMAL_SEPARATOR === "." ? String(value) : String(value).replace(".", DECIMAL_SEPARATOR);
}

/** Put what stands in the page from the beginning into its language. */
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

/** A text of the page's markup; the space around it stays. @param {string} text */
function translateMarkup(text) {
  const bare = text.trim();
  return text.replace(bare, () => messages[bare.replace(/\s+/g, " ")] ?? bare);
}
