/** Read and write values in JSON by JSON pointers (RFC 6901). */

/** @import { Json } from "../types/values.js" */

/** Split a pointer into names. @param {string} pointer */
export function pointerNames(pointer) {
  return pointer
    .split("/")
    .slice(1)
    .map((one) => one.replaceAll("~1", "/").replaceAll("~0", "~"));
}

/** Escape a name for a pointer. @param {string} name */
export function escapeName(name) {
  return name.replaceAll("~", "~0").replaceAll("/", "~1");
}

/** Return the value at a path, or undefined. @param {object} root @param {string[]} path */
export function readPointer(root, path) {
  return path.reduce(
    (inner, name) => (isContainer(inner) ? inner[name] : undefined),
    /** @type {Json | undefined} */ (/** @type {unknown} */ (root)),
  );
}

/**
 * Write a value at a path, and create missing objects on the way; undefined deletes the value.
 * @param {object} root changed in place
 * @param {string[]} path
 * @param {Json | undefined} value
 */
export function writePointer(root, path, value) {
  let inner = /** @type {Record<string, Json | undefined>} */ (root);
  for (const name of path.slice(0, -1)) {
    const next = inner[name];
    if (isContainer(next)) inner = next;
    else if (value === undefined) return;
    else inner = inner[name] = {};
  }
  const name = path[path.length - 1];
  if (value !== undefined) inner[name] = value;
  else if (Array.isArray(inner)) inner.splice(Number(name), 1);
  else delete inner[name];
}

/**
 * Return true if a value is an object or a list.
 * @param {Json | undefined} value
 * @returns {value is Record<string, Json | undefined>}
 */
export function isContainer(value) {
  return typeof value === "object" && value !== null;
}
