/** Places within JSON, by the names that lead to them, as a JSON pointer (RFC 6901) has them. */

/** @import { Json } from "../types/values.js" */

/** The names of a pointer. @param {string} pointer */
export function pointerNames(pointer) {
  return pointer
    .split("/")
    .slice(1)
    .map((one) => one.replaceAll("~1", "/").replaceAll("~0", "~"));
}

/** A name as a pointer has it. @param {string} name */
export function escapeName(name) {
  return name.replaceAll("~", "~0").replaceAll("/", "~1");
}

/** What stands at a place; undefined where nothing does. @param {object} root @param {string[]} path */
export function readPointer(root, path) {
  return path.reduce(
    (inner, name) => (ensureObject(inner) ? inner[name] : undefined),
    /** @type {Json | undefined} */ (/** @type {unknown} */ (root)),
  );
}

/**
 * Put something at a place, with groups on the way to it where there are none; undefined takes away what is there.
 * @param {object} root changed in place
 * @param {string[]} path
 * @param {Json | undefined} value
 */
export function writePointer(root, path, value) {
  let inner = /** @type {Record<string, Json | undefined>} */ (root);
  for (const name of path.slice(0, -1)) {
    const next = inner[name];
    if (ensureObject(next)) inner = next;
    else if (value === undefined) return;
    else inner = inner[name] = {};
  }
  const name = path[path.length - 1];
  if (value !== undefined) inner[name] = value;
  else if (Array.isArray(inner)) inner.splice(Number(name), 1);
  else delete inner[name];
}

/**
 * Whether something stands within a value: of a list by its numbers.
 * @param {Json | undefined} value
 * @returns {value is Record<string, Json | undefined>}
 */
export function ensureObject(value) {
  return typeof value === "object" && value !== null;
}
