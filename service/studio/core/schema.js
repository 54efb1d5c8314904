/** Interpret the JSON schema of a field for the form. */

import { isContainer } from "./pointer.js";

/** @import { Json, Problem } from "../types/values.js" */

/**
 * The used part of a JSON schema.
 * @typedef {object} Schema
 * @property {string} [$ref]
 * @property {Record<string, Schema>} [$defs]
 * @property {Schema[]} [anyOf]
 * @property {Schema[]} [oneOf]
 * @property {string} [type]
 * @property {string} [description]
 * @property {Json} [default]
 * @property {Json} [const]
 * @property {string[]} [enum]
 * @property {number} [minimum]
 * @property {number} [exclusiveMinimum]
 * @property {Schema} [items]
 * @property {Schema[]} [prefixItems]
 * @property {Record<string, Schema>} [properties]
 * @property {Schema | boolean} [additionalProperties]
 * @property {string[]} [required]
 * @property {Problem[]} [examples] of a kind of problem
 * @property {string} [x-dimension] what a number measures
 */

/**
 * A field with the control that edits it.
 * @typedef {object} ClassifiedField
 * @property {"choice" | "choices" | "flag" | "number" | "numbers" | "points" | "text" | "stock" | "object" | "union" |
 *   "table" | "map" | "shapes" | "json" | "fixed"} control
 * @property {Schema[]} options what the value may be, null apart
 * @property {boolean} nullable
 * @property {string[]} [choices]
 * @property {Schema} [item] schema of the rows of a table, or of the members of a map
 * @property {number} [count] fixed number of rows of a table
 */

/** Return the fields of an object by name. @param {Schema} schema */
export function propertiesOf(schema) {
  return schema.properties ?? {};
}

/** @typedef {{name: string, schema: Schema, kinded: ClassifiedField, required: boolean}} Column of a table */

/** Resolve a reference. @param {Schema} schema @param {Schema} root @returns {Schema} */
export function resolveReference(schema, root) {
  if (!schema.$ref) return schema;
  const { $ref, ...more } = schema;
  const target = root.$defs?.[$ref.slice($ref.lastIndexOf("/") + 1)] ?? {};
  return { ...resolveReference(target, root), ...more };
}

/**
 * List the alternatives of a schema, with references resolved.
 * @param {Schema} schema
 * @param {Schema} root
 * @returns {Schema[]}
 */
export function alternatives(schema, root) {
  const open = resolveReference(schema, root);
  const several = open.anyOf ?? open.oneOf;
  return several ? several.flatMap((/** @type {Schema} */ one) => alternatives(one, root)) : [open];
}

/** @param {Schema} schema */
function isNumeric(schema) {
  return schema.type === "number" || schema.type === "integer";
}

/** A thing and how many there are of it. @param {Schema} schema */
function isCounted(schema) {
  return (
    schema.type === "object" &&
    Object.keys(propertiesOf(schema)).length === 2 &&
    propertiesOf(schema).count !== undefined
  );
}

/** A list or tuple of numbers, some of which may be left open. @param {Schema} schema @param {Schema} root */
function isListOfNumbers(schema, root) {
  if (schema.type !== "array") return false;
  const parts = schema.prefixItems ?? (schema.items ? [schema.items] : []);
  return (
    parts.length > 0 &&
    parts.every((/** @type {Schema} */ part) =>
      alternatives(part, root).every((one) => isNumeric(one) || one.type === "null"),
    )
  );
}

/** Return the name of the property that distinguishes alternatives. @param {Schema[]} options */
export function findDiscriminator(options) {
  const names = Object.keys(options[0] ? propertiesOf(options[0]) : {});
  const constant = (/** @type {Schema} */ one, /** @type {string} */ name) =>
    one.properties?.[name]?.const !== undefined || one.properties?.[name]?.enum !== undefined;
  const stated = (/** @type {Schema} */ one, /** @type {string} */ name) =>
    one.required?.includes(name) || propertiesOf(one)[name].default !== undefined;
  return names.find(
    (name) => options.every((one) => constant(one, name)) && options.filter((one) => !stated(one, name)).length === 0,
  );
}

/** The option that a discriminated value belongs to. @param {Schema[]} options @param {Json | undefined} value */
export function findOption(options, value) {
  const name = findDiscriminator(options);
  if (!name || !isContainer(value)) return options[0];
  return options.find((one) => listTags(one, name).includes(String(value[name]))) ?? options[0];
}

/**
 * The values of the discriminating property of an option.
 * @param {Schema} option
 * @param {string} name
 * @returns {string[]}
 */
export function listTags(option, name) {
  const property = propertiesOf(option)[name];
  return property.enum ?? [String(property.const)];
}

/** Choose the control of a field. @param {Schema} schema @param {Schema} root @returns {ClassifiedField} */
export function classifyField(schema, root) {
  const all = alternatives(schema, root);
  const options = all.filter((one) => one.type !== "null");
  const nullable = options.length < all.length;
  /** @param {ClassifiedField["control"]} control @param {Partial<ClassifiedField>} [more] */
  const is = (control, more = {}) => ({ control, options, nullable, ...more });
  if (options.length === 1 && options[0].const !== undefined) return is("fixed");
  if (options.every((one) => one.enum || one.const !== undefined)) {
    return is("choice", { choices: options.flatMap((one) => one.enum ?? [String(one.const)]) });
  }
  const shapes = new Set(options.map((one) => (isNumeric(one) ? "number" : one.type)));
  if (shapes.size > 1 && shapes.has("object")) return is("shapes");
  if (options.some((one) => one.type === "boolean")) return is("flag");
  const lists = options.filter((one) => isListOfNumbers(one, root));
  if (lists.length && options.every((one) => isNumeric(one) || isListOfNumbers(one, root))) return is("numbers");
  if (options.every(isNumeric)) return is("number");
  if (options.every((one) => isNumeric(one) || one.type === "string")) return is("text");
  const array = options.find((one) => one.type === "array");
  if (array) {
    const rows = array.prefixItems ?? (array.items ? [array.items] : []);
    const members = rows.flatMap((/** @type {Schema} */ one) => alternatives(one, root));
    if (members.length && members.every((/** @type {Schema} */ one) => one.type === "object")) {
      return is("table", { item: rows[0], count: array.prefixItems?.length });
    }
    if (members.length && members.every((/** @type {Schema} */ one) => isListOfNumbers(one, root))) return is("points");
    if (members.length && members.every((/** @type {Schema} */ one) => one.enum))
      return is("choices", { choices: members[0].enum });
    if (members.some(isCounted)) return is("stock");
  }
  const objects = options.filter((one) => one.type === "object" && one.properties);
  if (objects.length === 1 && options.length === 1) return is("object");
  if (objects.length === options.length && findDiscriminator(objects)) return is("union");
  if (options.length === 1 && typeof options[0].additionalProperties === "object")
    return is("map", { item: options[0].additionalProperties });
  return is("json");
}

/** Return an initial value for a required field. @param {Schema} schema @param {Schema} root @returns {Json} */
export function initialValue(schema, root) {
  if (schema.default !== undefined && schema.default !== null) return structuredClone(schema.default);
  const [option] = alternatives(schema, root).filter((one) => one.type !== "null");
  if (option.default !== undefined && option.default !== null) return structuredClone(option.default);
  if (option.const !== undefined) return option.const;
  if (option.enum) return option.enum[0];
  if (isNumeric(option)) return Math.max(option.minimum ?? 0, option.exclusiveMinimum === undefined ? 0 : 1);
  if (option.type === "array") {
    if (option.prefixItems) return option.prefixItems.map((/** @type {Schema} */ one) => initialValue(one, root));
    return [];
  }
  if (option.type === "object") {
    return Object.fromEntries(
      (option.required ?? []).map((/** @type {string} */ name) => [
        name,
        initialValue(propertiesOf(option)[name], root),
      ]),
    );
  }
  return option.type === "string" ? "" : false;
}

/** The option that a value is an instance of. @param {Schema[]} options @param {unknown} value */
export function findShape(options, value) {
  const type = Array.isArray(value) ? "array" : value === null ? "null" : typeof value;
  return options.find((one) => (isNumeric(one) ? "number" : one.type) === type);
}

/** A field that is a number, or something else: a word, or something more. @param {ClassifiedField} what */
function mayBeNumber(what) {
  return what.control === "number" || (["shapes", "text"].includes(what.control) && what.options.some(isNumeric));
}

/**
 * Columns of a table: the plain properties of its rows, of all alternatives.
 * @param {Schema} item @param {Schema} root
 * @returns {Column[]}
 */
export function listColumns(item, root) {
  const options = alternatives(item, root);
  const tag = options.length > 1 ? findDiscriminator(options) : undefined;
  /** @type {Map<string, Column>} */
  const found = new Map();
  for (const option of options) {
    for (const [name, schema] of Object.entries(propertiesOf(option))) {
      const here = classifyField(schema, root);
      const required = options.every((one) => one.required?.includes(name));
      if (name === tag) {
        const choices = options.flatMap((one) => listTags(one, name));
        found.set(name, { name, schema, required, kinded: { ...here, control: "choice", choices } });
      } else if ((["flag", "choice"].includes(here.control) || mayBeNumber(here)) && !found.has(name)) {
        found.set(name, { name, schema, required, kinded: here });
      }
    }
  }
  return [...found.values()];
}

/**
 * The properties of a row that are more than a cell can state.
 * @param {Schema} option
 * @param {Schema} root
 * @returns {string[]}
 */
export function listOtherFields(option, root) {
  return Object.entries(propertiesOf(option))
    .filter(([, schema]) =>
      ["shapes", "table", "object", "union", "map", "points", "json"].includes(classifyField(schema, root).control),
    )
    .map(([name]) => name);
}

/**
 * Return the path of the first value that does not match the schema, or null. Only the service checks numbers and
 * words.
 * @param {unknown} value @param {Schema} schema @param {Schema} root @param {string} [path] @returns {string | null}
 */
export function findMismatch(value, schema, root, path = "") {
  const found = alternatives(schema, root).map((one) => findMismatchInObject(value, one, root, path));
  // Of what might have been meant that which goes along with it farthest.
  return found.includes(null)
    ? null
    : found.reduce((one, other) => (Number(other?.length) > Number(one?.length) ? other : one), path);
}

/**
 * @param {unknown} value
 * @param {Schema} schema without alternatives
 * @param {Schema} root
 * @param {string} path
 * @returns {string | null}
 */
function findMismatchInObject(value, schema, root, path) {
  const form = valueType(value);
  const wanted = schema.type ?? valueType(schema.const ?? schema.enum?.[0] ?? value);
  if (form !== (wanted === "integer" ? "number" : wanted)) return path;
  if (typeof value !== "object" || value === null) return null;
  for (const [name, inner] of Object.entries(value)) {
    const at = `${path}/${name}`;
    const of =
      form === "array"
        ? (schema.prefixItems?.[Number(name)] ?? schema.items)
        : (schema.properties?.[name] ?? schema.additionalProperties);
    // `true` takes anything.
    const wrong = of === true ? null : of ? findMismatch(inner, of, root, at) : at;
    if (wrong !== null) return wrong;
  }
  return null;
}

/**
 * A value without what states but its default, which the service writes out.
 * @param {Json | undefined} value @param {Schema} schema @param {Schema} root @returns {Json | undefined}
 */
function withoutDefaults(value, schema, root) {
  const options = alternatives(schema, root).filter((one) => one.type === valueType(value));
  if (!options.length) return value;
  if (Array.isArray(value))
    return value.map((one, k) => {
      const inside = options[0].prefixItems?.[k] ?? options[0].items;
      return inside ? (withoutDefaults(one, inside, root) ?? null) : one;
    });
  if (!isContainer(value)) return value;
  const { properties = {}, additionalProperties } =
    options.length > 1 && options.every((one) => one.properties) ? findOption(options, value) : options[0];
  return Object.fromEntries(
    Object.entries(value).flatMap(([name, inner]) => {
      const of = properties[name] ?? additionalProperties;
      if (typeof of !== "object") return [[name, inner]];
      const open = resolveReference(of, root);
      // The property that distinguishes alternatives is required.
      return (open.const === undefined || options.length === 1) &&
        JSON.stringify(open.default) === JSON.stringify(inner)
        ? []
        : [[name, withoutDefaults(inner, of, root)]];
    }),
  );
}

/** Return the JSON type of a value. @param {unknown} value */
function valueType(value) {
  return value === null ? "null" : Array.isArray(value) ? "array" : typeof value;
}

/**
 * Return a problem without its default values.
 * @param {Problem} statement
 * @param {Schema | undefined} schema
 * @returns {Problem}
 */
export function removeDefaults(statement, schema) {
  if (!schema) return statement;
  // Leave out only values that equal the service's defaults.
  const plain = /** @type {unknown} */ (
    withoutDefaults(/** @type {Json} */ (/** @type {unknown} */ (statement)), schema, schema)
  );
  return /** @type {Problem} */ (plain);
}

/**
 * A statement in one spelling: fields in order, without defaults, which the service writes out, and without the empty
 * groups in which the form has room for fields.
 * @param {Problem} statement @param {Schema | undefined} schema
 */
export function canonicalText(statement, schema) {
  const named = (/** @type {unknown} */ value) => typeof value === "object" && value !== null && !Array.isArray(value);
  return JSON.stringify(removeDefaults(statement, schema), (_, value) =>
    named(value)
      ? Object.fromEntries(
          Object.entries(value)
            .filter(([, inner]) => !named(inner) || Object.keys(inner).length)
            .sort(),
        )
      : value,
  );
}
