/**
 * Create a form from the JSON schema of a problem.
 *
 * A field that is left empty is left out of the problem, so that the service's default holds. Each control carries its
 * JSON pointer as `data-path`, by which errors find it.
 */

import {
  createChoice,
  createChoices,
  createJsonBox,
  createNumberBox,
  parseNumber,
  createPointsBox,
  createStockBox,
  createTextBox,
} from "./controls.js";
import { createElement, toWords } from "../core/dom.js";
import { firstParagraph, t } from "../core/messages.js";
import { escapeName, isContainer as structured } from "../core/pointer.js";
import {
  findDiscriminator,
  initialValue,
  classifyField,
  findOption,
  propertiesOf,
  resolveReference,
  findShape,
  listTags,
} from "../core/schema.js";
import { STATEMENT_POINTER, FormState } from "./form_state.js";
import { createTable } from "./object_table.js";
import { fieldUnit } from "../core/units.js";

/** @import { Json } from "../types/values.js" */

/** @typedef {import("../core/schema.js").Schema} Schema */

/** Fields of every problem that few people touch; they come last. */
const LAST_FIELDS = ["length_unit", "rank_by", "max_designs", "include_failed", "seed"];

/** Minimum number of empty optional fields that are folded away. */
const MIN_FOLDED = 3;

let ids = 0;

/**
 * Fill `form` with the controls of what a store states.
 * @param {HTMLElement} form @param {import("../core/store.js").Store} store
 */
export function fillForm(form, store) {
  const sheet = new FormState(store);
  const { root } = sheet;
  const names = Object.keys(propertiesOf(root));
  const must = names.filter((name) => root.required?.includes(name));
  const may = names.filter((name) => !must.includes(name) && !LAST_FIELDS.includes(name));
  const order = [...must, ...may, ...LAST_FIELDS.filter((name) => names.includes(name))];
  const opened = [...form.querySelectorAll("details[open]")].map((one) => one.getAttribute("data-path"));
  const focused = form.contains(document.activeElement) ? document.activeElement?.getAttribute("data-path") : null;
  form.replaceChildren(...foldControls(sheet, root, STATEMENT_POINTER, order));
  for (const path of opened) form.querySelector(`details[data-path="${path}"]`)?.setAttribute("open", "");
  /** @type {HTMLElement | null} */ (focused && form.querySelector(`[data-path="${focused}"]`))?.focus();
}

/** @param {FormState} sheet @param {Schema} schema @param {string} path @param {string[]} [order] */
function createControls(sheet, schema, path, order = Object.keys(propertiesOf(schema))) {
  return order.map((name) => {
    const required = schema.required?.includes(name) ?? false;
    return createField(sheet, propertiesOf(schema)[name], name, `${path}/${name}`, required);
  });
}

/**
 * Show given and required fields; the others are one click away.
 * @param {FormState} sheet @param {Schema} schema @param {string} path @param {string[]} [order]
 * @returns {Node[]}
 */
function foldControls(sheet, schema, path, order = Object.keys(propertiesOf(schema))) {
  const used = (/** @type {string} */ name) => {
    const value = sheet.readValue(`${path}/${name}`);
    return schema.required?.includes(name) || (value !== undefined && value !== null && !isEmpty(value));
  };
  const made = (/** @type {string[]} */ names) =>
    /** @type {Node[]} */ (createControls(sheet, schema, path, names).filter((one) => one !== null));
  const [first, rest] = [made(order.filter(used)), made(order.filter((name) => !used(name)))];
  if (rest.length < MIN_FOLDED) return [...first, ...rest];
  const more = createElement(
    "details",
    { class: "more", "data-path": `${path}/*`, onreveal: () => (more.open = true) },
    createElement("summary", {}, `${path === STATEMENT_POINTER ? t`More` : t`More limits`} (${rest.length})`),
    createElement("div", { class: "fields" }, ...rest),
  );
  return [...first, more];
}

/**
 * The control of one property of an object.
 * @param {FormState} sheet @param {Schema} schema @param {string} name @param {string} path
 * @param {boolean} required
 * @returns {Node | null}
 */
function createField(sheet, schema, name, path, required) {
  const what = classifyField(schema, sheet.root);
  // The units of other fields depend on the length unit and on the requested mechanism.
  const set = (/** @type {Json | undefined} */ value) =>
    sheet.writeValue(path, value, name === "length_unit" || (name === "mechanism" && typeof value === "string"));
  const value = sheet.readValue(path);
  const unit = fieldUnit(schema, sheet.problem);
  const about =
    schema.description ?? (what.options.length === 1 ? resolveReference(what.options[0], sheet.root).description : "");
  const note = firstParagraph(about);
  const fallback = schema.default ?? null;
  switch (what.control) {
    case "fixed":
      return null;
    case "choice":
      return createLabel(
        name,
        "",
        note,
        path,
        required,
        createChoice(what.choices ?? [], value ?? fallback, what.nullable, set),
      );
    case "choices":
      return createChoices(name, note, path, what.choices ?? [], formatStrings(value ?? fallback), set);
    case "flag":
      return createFlag(name, note, path, value ?? fallback, set);
    case "number":
      if (what.nullable && fallback !== null) return createShapes(sheet, what, schema, name, note, path, required);
      return createLabel(name, unit, note, path, required, createNumberBox(value, fallback, set));
    case "text":
      return createLabel(name, unit, note, path, required, createTextBox(value, fallback, set, parseNumber));
    case "numbers":
      return createLabel(
        name,
        unit,
        note,
        path,
        required,
        createTextBox(value, fallback, set, (text) => parseNumbers(text, what.options)),
      );
    case "points":
      return createLabel(
        name,
        unit,
        note ? t`${note} One point per line, such as 120, 35.` : t`One point per line, such as 120, 35.`,
        path,
        required,
        createPointsBox(value, set),
      );
    case "stock":
      return createLabel(
        name,
        unit,
        t`${note} For example 20, 24 × 3, 30.`,
        path,
        required,
        createStockBox(value, set),
      );
    case "table":
      return createGroup(sheet, schema, name, note, path, required || !what.nullable, () => [
        createTable(sheet.preview(path, []), what.item ?? {}, path, createControls, what.count),
      ]);
    case "object":
      return createGroup(sheet, schema, name, note, path, required || !what.nullable, () =>
        foldControls(sheet, what.options[0], path),
      );
    case "union":
      return createGroup(sheet, schema, name, note, path, required || !what.nullable, () =>
        createUnion(sheet.preview(path, initialValue(what.options[0], sheet.root)), what.options, path),
      );
    case "map":
      return createGroup(sheet, schema, name, note, path, required || !what.nullable, () =>
        createMembers(sheet, what.item ?? {}, path),
      );
    case "shapes":
      return createShapes(sheet, what, schema, name, note, path, required);
    default:
      if (what.options.every((one) => one.type === "array" && one.items?.type === "string"))
        return createLabel(
          name,
          "",
          t`${note} For example input, output.`,
          path,
          required,
          createTextBox(value, fallback, set, parseNames),
        );
      // A mechanism as an analysis has it, or the corners of a shape, each in one of several ways.
      return createLabel(
        name,
        unit,
        note ? t`${note} As JSON.` : t`As JSON.`,
        path,
        required,
        createJsonBox(value, set),
      );
  }
}

/** The words for what a value can be. @param {Schema} option */
function shapeName(option) {
  if (option.const !== undefined) return String(option.const);
  const names = Object.keys(propertiesOf(option));
  if (option.type === "object")
    return names.length === 2 && names.every((one) => ["min", "max"].includes(one)) ? t`a range` : t`in detail`;
  return (
    { boolean: t`yes or no`, array: t`a list`, string: t`a word`, null: t`not given` }[
      /** @type {string} */ (option.type)
    ] ?? t`a number`
  );
}

/**
 * A value with several forms, such as a number or a range: the form is chosen first.
 *
 * A word that stands for itself, and null where leaving the field out means something else, have nothing below them.
 * @param {FormState} sheet
 * @param {import("../core/schema.js").ClassifiedField} what
 * @param {Schema} schema
 * @param {string} name
 * @param {string} note
 * @param {string} path @param {boolean} required
 * @returns {HTMLElement}
 */
function createShapes(sheet, what, schema, name, note, path, required) {
  const options =
    what.nullable && (schema.default ?? null) !== null ? [...what.options, { type: "null" }] : what.options;
  const stated = sheet.readValue(path);
  const value = stated === undefined ? schema.default : stated;
  const now = findShape(options, value) ?? options[0];
  const dimension = schema["x-dimension"];
  const ways = options.map(shapeName);
  const way = createChoice(ways, shapeName(now), false, (chosen) => {
    const option = options[ways.indexOf(String(chosen))];
    sheet.writeValue(path, option.type === "null" ? null : initialValue(option, sheet.root), true);
  });
  if (now.const !== undefined || now.type === "null") return createLabel(name, "", note, path, required, way);
  way.setAttribute("aria-label", t`${toWords(name)}: form of the value`);
  const one = { ...now, ...(dimension ? { "x-dimension": dimension } : {}) };
  const inside =
    now.type === "object" || classifyField(now, sheet.root).control === "table"
      ? createGroup(sheet, { ...one, default: schema.default }, name, note, path, true, () => {
          const first =
            schema.default !== undefined && findShape([now], schema.default)
              ? schema.default
              : initialValue(now, sheet.root);
          const here = sheet.preview(path, first);
          return now.type === "array"
            ? [createTable(here, now.items ?? {}, path, createControls)]
            : createControls(here, now, path);
        })
      : createField(sheet, { ...one, default: schema.default, description: note }, name, path, required);
  if (inside instanceof HTMLDetailsElement) {
    inside.querySelector("summary")?.after(way);
    if (findShape([now], stated)) inside.dispatchEvent(new Event("reveal"));
  } else /** @type {HTMLElement} */ (inside)?.querySelector(":scope > .error")?.before(way);
  return /** @type {HTMLElement} */ (inside);
}

/**
 * Objects by names that are given to them.
 * @param {FormState} sheet
 * @param {Schema} item
 * @param {string} path
 */
function createMembers(sheet, item, path) {
  const found = sheet.readValue(path) ?? {};
  const name = createElement("input", { type: "text", "aria-label": t`Name of a new entry`, spellcheck: "false" });
  const add = createElement(
    "button",
    {
      type: "button",
      class: "small",
      onclick: () => {
        const stated = name.value.trim();
        if (!stated) return name.focus();
        const one = `${path}/${escapeName(stated)}`;
        sheet.writeValue(one, sheet.readValue(one) ?? initialValue(item, sheet.root), true);
      },
    },
    t`Add`,
  );
  return [
    ...Object.keys(found).flatMap((key) => [
      createElement(
        "div",
        { class: "row member" },
        createElement("strong", {}, key),
        createElement(
          "button",
          {
            type: "button",
            class: "small",
            "aria-label": t`Remove ${key}`,
            onclick: () => sheet.writeValue(`${path}/${escapeName(key)}`, undefined, true),
          },
          "×",
        ),
      ),
      ...createControls(sheet, resolveReference(item, sheet.root), `${path}/${escapeName(key)}`),
    ]),
    createElement("div", { class: "row member" }, name, add),
  ];
}

/**
 * @param {FormState} sheet that shows the first of them if none is given
 * @param {Schema[]} options @param {string} path
 */
function createUnion(sheet, options, path) {
  const tag = findDiscriminator(options) ?? "";
  const option = findOption(options, sheet.readValue(path));
  const pick = createChoice(
    options.flatMap((one) => listTags(one, tag)),
    sheet.readValue(`${path}/${tag}`) ?? propertiesOf(option)[tag].default,
    false,
    (value) => {
      const next = initialValue(
        options.find((one) => listTags(one, tag).includes(String(value))) ?? options[0],
        sheet.root,
      );
      sheet.writeValue(path, { ...(structured(next) ? next : {}), [tag]: value }, true);
    },
  );
  const others = Object.keys(propertiesOf(option)).filter((one) => one !== tag);
  return [createLabel(tag, "", "", `${path}/${tag}`, true, pick), ...createControls(sheet, option, path, others)];
}

/**
 * A group of fields that opens; a flag switches an optional group on.
 * @param {FormState} sheet @param {Schema} schema @param {string} name @param {string} note @param {string} path
 * @param {boolean} always @param {() => (Node | null)[]} inside
 */
function createGroup(sheet, schema, name, note, path, always, inside) {
  const value = sheet.readValue(path);
  const stated = value !== undefined && value !== null;
  const required = sheet.root.required?.includes(name) && path.split("/").length === 3;
  const body = createElement("div", { class: "fields" });
  const fillBody = () => {
    if (!body.childElementCount) body.append(...inside().filter((one) => one !== null));
  };
  const open = stated && (required || Object.keys(value).length > 0);
  const details = createElement(
    "details",
    {
      class: "field group",
      "data-path": path,
      open,
      onreveal: () => {
        details.open = true;
        if (always || stated) fillBody();
      },
      ontoggle: () => {
        if (details.open && (always || stated)) fillBody();
        // A group whose fields are all left out says nothing.
        else if (!details.open && isEmpty(sheet.readValue(path)) && !required) sheet.writeValue(path, undefined);
      },
    },
    createElement("summary", {}, toWords(name)),
    createElement("p", { class: "error" }),
  );
  if (note) details.append(createElement("p", { class: "note" }, note));
  if (!always) {
    const box = createElement("input", {
      type: "checkbox",
      id: `f${++ids}`,
      onchange: () => sheet.writeValue(path, box.checked ? initialValue(schema, sheet.root) : undefined, true),
    });
    box.checked = stated;
    details.append(createElement("label", { class: "flag", for: box.id }, box, t`Set a value`));
  }
  details.append(body);
  if (open) fillBody();
  return details;
}

/** @param {unknown} value */
function isEmpty(value) {
  return value !== undefined && value !== null && typeof value === "object" && Object.keys(value).length === 0;
}

/**
 * @param {string} name @param {string} unit @param {string} note @param {string} path @param {boolean} required
 * @param {HTMLElement} control
 */
function createLabel(name, unit, note, path, required, control) {
  const id = `f${++ids}`;
  control.id = id;
  control.setAttribute("data-path", path);
  control.setAttribute("aria-describedby", `${id}e${note ? ` ${id}n` : ""}`);
  if (required) control.setAttribute("aria-required", "true");
  return createElement(
    "div",
    { class: "field" },
    createElement(
      "label",
      { for: id },
      toWords(name),
      unit && createElement("span", { class: "unit" }, ` (${unit})`),
      required && createElement("span", { class: "required", title: t`required` }, " *"),
    ),
    control,
    createElement("p", { class: "error", id: `${id}e` }),
    note && createElement("p", { class: "note", id: `${id}n` }, note),
  );
}

/**
 * @param {string} name
 * @param {string} note
 * @param {string} path
 * @param {Json} value
 * @param {(value: Json | undefined) => void} set
 */
function createFlag(name, note, path, value, set) {
  const id = `f${++ids}`;
  const box = createElement("input", {
    type: "checkbox",
    id,
    "data-path": path,
    "aria-describedby": `${id}e ${id}n`,
    onchange: () => set(box.checked),
  });
  box.checked = Boolean(value);
  return createElement(
    "div",
    { class: "field" },
    createElement("label", { class: "flag", for: id }, box, toWords(name)),
    createElement("p", { class: "error", id: `${id}e` }),
    createElement("p", { class: "note", id: `${id}n` }, note),
  );
}

/** Words of a list. @param {Json} value */
function formatStrings(value) {
  return Array.isArray(value) ? value.map(String) : [];
}

/** Names between commas. @param {string} text */
function parseNames(text) {
  return text
    .split(",")
    .map((one) => one.trim())
    .filter(Boolean);
}

/**
 * `0, open` or `90`; text that is not a number stays as typed, and the service reports it.
 * @param {string} text
 * @param {Schema[]} options
 */
function parseNumbers(text, options) {
  const parts = text
    .split(/[,;\s]+/)
    .filter((part) => part !== "")
    .map((part) => (["open", "null", "-", "–"].includes(part) ? null : parseNumber(part)));
  return parts.length === 1 && options.some((one) => one.type !== "array") ? parts[0] : parts;
}
