/**
 * A form made from the JSON schema of a problem.
 *
 * A field that is left empty is left out of the problem, so that the service's default holds. Each control carries its
 * JSON pointer as `data-path`, by which errors find it.
 */

import { choice, choices, jsonBox, numberBox, plain, pointsBox, stockBox, textBox } from "./controls.js";
import { el, words } from "../core/dom.js";
import { prose, t } from "../core/messages.js";
import { escaped, group as structured } from "../core/pointer.js";
import { discriminator, initial, kinded, optionOf, propertiesOf, resolved, shapeOf, tagsOf } from "../core/schema.js";
import { ROOT, Sheet } from "./form_state.js";
import { table } from "./object_table.js";
import { unitOf } from "../core/units.js";

/** @import { Json } from "../types/values.js" */

/** @typedef {import("../core/schema.js").Schema} Schema */

/** Fields of every problem that few people touch; they come last. */
const LAST = ["length_unit", "rank_by", "max_designs", "include_failed", "seed"];

/** Fewer fields than these that nobody has stated need not be folded away. */
const FOLDED = 3;

let ids = 0;

/**
 * Fill `form` with the controls of what a store states.
 * @param {HTMLElement} form @param {import("../core/store.js").Store} store
 */
export function fill(form, store) {
  const sheet = new Sheet(store);
  const { root } = sheet;
  const names = Object.keys(propertiesOf(root));
  const must = names.filter((name) => root.required?.includes(name));
  const may = names.filter((name) => !must.includes(name) && !LAST.includes(name));
  const order = [...must, ...may, ...LAST.filter((name) => names.includes(name))];
  const opened = [...form.querySelectorAll("details[open]")].map((one) => one.getAttribute("data-path"));
  const focused = form.contains(document.activeElement) ? document.activeElement?.getAttribute("data-path") : null;
  form.replaceChildren(...folded(sheet, root, ROOT, order));
  for (const path of opened) form.querySelector(`details[data-path="${path}"]`)?.setAttribute("open", "");
  /** @type {HTMLElement | null} */ (focused && form.querySelector(`[data-path="${focused}"]`))?.focus();
}

/** @param {Sheet} sheet @param {Schema} schema @param {string} path @param {string[]} [order] */
function controls(sheet, schema, path, order = Object.keys(propertiesOf(schema))) {
  return order.map((name) => {
    const required = schema.required?.includes(name) ?? false;
    return field(sheet, propertiesOf(schema)[name], name, `${path}/${name}`, required);
  });
}

/**
 * What is stated, and what must be; the rest is one click away.
 * @param {Sheet} sheet @param {Schema} schema @param {string} path @param {string[]} [order]
 * @returns {Node[]}
 */
function folded(sheet, schema, path, order = Object.keys(propertiesOf(schema))) {
  const used = (/** @type {string} */ name) => {
    const value = sheet.at(`${path}/${name}`);
    return schema.required?.includes(name) || (value !== undefined && value !== null && !empty(value));
  };
  const made = (/** @type {string[]} */ names) =>
    /** @type {Node[]} */ (controls(sheet, schema, path, names).filter((one) => one !== null));
  const [first, rest] = [made(order.filter(used)), made(order.filter((name) => !used(name)))];
  if (rest.length < FOLDED) return [...first, ...rest];
  const more = el(
    "details",
    { class: "more", "data-path": `${path}/*`, onreveal: () => (more.open = true) },
    el("summary", {}, `${path === ROOT ? t`More` : t`More limits`} (${rest.length})`),
    el("div", { class: "fields" }, ...rest),
  );
  return [...first, more];
}

/**
 * The control of one property of an object.
 * @param {Sheet} sheet @param {Schema} schema @param {string} name @param {string} path
 * @param {boolean} required
 * @returns {Node | null}
 */
function field(sheet, schema, name, path, required) {
  const what = kinded(schema, sheet.root);
  // The units beside the other fields are those of the length unit, or of the mechanism that is asked for.
  const set = (/** @type {Json | undefined} */ value) =>
    sheet.put(path, value, name === "length_unit" || (name === "mechanism" && typeof value === "string"));
  const value = sheet.at(path);
  const unit = unitOf(schema, sheet.problem);
  const about =
    schema.description ?? (what.options.length === 1 ? resolved(what.options[0], sheet.root).description : "");
  const note = prose(about);
  const fallback = schema.default ?? null;
  switch (what.control) {
    case "fixed":
      return null;
    case "choice":
      return labelled(
        name,
        "",
        note,
        path,
        required,
        choice(what.choices ?? [], value ?? fallback, what.nullable, set),
      );
    case "choices":
      return choices(name, note, path, what.choices ?? [], strings(value ?? fallback), set);
    case "flag":
      return flag(name, note, path, value ?? fallback, set);
    case "number":
      if (what.nullable && fallback !== null) return shapes(sheet, what, schema, name, note, path, required);
      return labelled(name, unit, note, path, required, numberBox(value, fallback, set));
    case "text":
      return labelled(name, unit, note, path, required, textBox(value, fallback, set, plain));
    case "numbers":
      return labelled(
        name,
        unit,
        note,
        path,
        required,
        textBox(value, fallback, set, (text) => numbers(text, what.options)),
      );
    case "points":
      return labelled(
        name,
        unit,
        note ? t`${note} One point to a line, as in 120, 35.` : t`One point to a line, as in 120, 35.`,
        path,
        required,
        pointsBox(value, set),
      );
    case "stock":
      return labelled(name, unit, t`${note} As in 20, 24 × 3, 30.`, path, required, stockBox(value, set));
    case "table":
      return group(sheet, schema, name, note, path, required || !what.nullable, () => [
        table(sheet.looking(path, []), what.item ?? {}, path, controls, what.count),
      ]);
    case "object":
      return group(sheet, schema, name, note, path, required || !what.nullable, () =>
        folded(sheet, what.options[0], path),
      );
    case "union":
      return group(sheet, schema, name, note, path, required || !what.nullable, () =>
        union(sheet.looking(path, initial(what.options[0], sheet.root)), what.options, path),
      );
    case "map":
      return group(sheet, schema, name, note, path, required || !what.nullable, () =>
        members(sheet, what.item ?? {}, path),
      );
    case "shapes":
      return shapes(sheet, what, schema, name, note, path, required);
    default:
      if (what.options.every((one) => one.type === "array" && one.items?.type === "string"))
        return labelled(
          name,
          "",
          t`${note} As in input, output.`,
          path,
          required,
          textBox(value, fallback, set, named),
        );
      // A mechanism as an analysis has it, or the corners of a shape, each in one of several ways.
      return labelled(name, unit, note ? t`${note} As JSON.` : t`As JSON.`, path, required, jsonBox(value, set));
  }
}

/** The words for what a value can be. @param {Schema} option */
function shapeName(option) {
  if (option.const !== undefined) return String(option.const);
  const names = Object.keys(propertiesOf(option));
  if (option.type === "object")
    return names.length === 2 && names.every((one) => ["min", "max"].includes(one)) ? t`a range` : t`in detail`;
  return (
    { boolean: t`yes or no`, array: t`a list`, string: t`a word`, null: t`left open` }[
      /** @type {string} */ (option.type)
    ] ?? t`a number`
  );
}

/**
 * A value that is stated in one of several ways, as a number or a range: the way is chosen first.
 *
 * A word that stands for itself, and null where leaving the field out means something else, have nothing below them.
 * @param {Sheet} sheet
 * @param {import("../core/schema.js").Kinded} what
 * @param {Schema} schema
 * @param {string} name
 * @param {string} note
 * @param {string} path @param {boolean} required
 * @returns {HTMLElement}
 */
function shapes(sheet, what, schema, name, note, path, required) {
  const options =
    what.nullable && (schema.default ?? null) !== null ? [...what.options, { type: "null" }] : what.options;
  const stated = sheet.at(path);
  const value = stated === undefined ? schema.default : stated;
  const now = shapeOf(options, value) ?? options[0];
  const dimension = schema["x-dimension"];
  const ways = options.map(shapeName);
  const way = choice(ways, shapeName(now), false, (chosen) => {
    const option = options[ways.indexOf(String(chosen))];
    sheet.put(path, option.type === "null" ? null : initial(option, sheet.root), true);
  });
  if (now.const !== undefined || now.type === "null") return labelled(name, "", note, path, required, way);
  way.setAttribute("aria-label", t`${words(name)}: how it is stated`);
  const one = { ...now, ...(dimension ? { "x-dimension": dimension } : {}) };
  const inside =
    now.type === "object" || kinded(now, sheet.root).control === "table"
      ? group(sheet, { ...one, default: schema.default }, name, note, path, true, () => {
          const first =
            schema.default !== undefined && shapeOf([now], schema.default) ? schema.default : initial(now, sheet.root);
          const here = sheet.looking(path, first);
          return now.type === "array" ? [table(here, now.items ?? {}, path, controls)] : controls(here, now, path);
        })
      : field(sheet, { ...one, default: schema.default, description: note }, name, path, required);
  if (inside instanceof HTMLDetailsElement) {
    inside.querySelector("summary")?.after(way);
    if (shapeOf([now], stated)) inside.dispatchEvent(new Event("reveal"));
  } else /** @type {HTMLElement} */ (inside)?.querySelector(":scope > .error")?.before(way);
  return /** @type {HTMLElement} */ (inside);
}

/**
 * Objects by names that are given to them.
 * @param {Sheet} sheet
 * @param {Schema} item
 * @param {string} path
 */
function members(sheet, item, path) {
  const found = sheet.at(path) ?? {};
  const name = el("input", { type: "text", "aria-label": t`Name of another one`, spellcheck: "false" });
  const add = el(
    "button",
    {
      type: "button",
      class: "small",
      onclick: () => {
        const stated = name.value.trim();
        if (!stated) return name.focus();
        const one = `${path}/${escaped(stated)}`;
        sheet.put(one, sheet.at(one) ?? initial(item, sheet.root), true);
      },
    },
    t`Add`,
  );
  return [
    ...Object.keys(found).flatMap((key) => [
      el(
        "div",
        { class: "row member" },
        el("strong", {}, key),
        el(
          "button",
          {
            type: "button",
            class: "small",
            "aria-label": t`Remove ${key}`,
            onclick: () => sheet.put(`${path}/${escaped(key)}`, undefined, true),
          },
          "×",
        ),
      ),
      ...controls(sheet, resolved(item, sheet.root), `${path}/${escaped(key)}`),
    ]),
    el("div", { class: "row member" }, name, add),
  ];
}

/**
 * @param {Sheet} sheet that looks at the first of them where none is stated
 * @param {Schema[]} options @param {string} path
 */
function union(sheet, options, path) {
  const tag = discriminator(options) ?? "";
  const option = optionOf(options, sheet.at(path));
  const pick = choice(
    options.flatMap((one) => tagsOf(one, tag)),
    sheet.at(`${path}/${tag}`) ?? propertiesOf(option)[tag].default,
    false,
    (value) => {
      const next = initial(options.find((one) => tagsOf(one, tag).includes(String(value))) ?? options[0], sheet.root);
      sheet.put(path, { ...(structured(next) ? next : {}), [tag]: value }, true);
    },
  );
  const others = Object.keys(propertiesOf(option)).filter((one) => one !== tag);
  return [labelled(tag, "", "", `${path}/${tag}`, true, pick), ...controls(sheet, option, path, others)];
}

/**
 * A group of fields that opens; what may be absent is stated by a flag.
 * @param {Sheet} sheet @param {Schema} schema @param {string} name @param {string} note @param {string} path
 * @param {boolean} always @param {() => (Node | null)[]} inside
 */
function group(sheet, schema, name, note, path, always, inside) {
  const value = sheet.at(path);
  const stated = value !== undefined && value !== null;
  const required = sheet.root.required?.includes(name) && path.split("/").length === 3;
  const body = el("div", { class: "fields" });
  const fillBody = () => {
    if (!body.childElementCount) body.append(...inside().filter((one) => one !== null));
  };
  const open = stated && (required || Object.keys(value).length > 0);
  const details = el(
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
        else if (!details.open && empty(sheet.at(path)) && !required) sheet.put(path, undefined);
      },
    },
    el("summary", {}, words(name)),
    el("p", { class: "error" }),
  );
  if (note) details.append(el("p", { class: "note" }, note));
  if (!always) {
    const box = el("input", {
      type: "checkbox",
      id: `f${++ids}`,
      onchange: () => sheet.put(path, box.checked ? initial(schema, sheet.root) : undefined, true),
    });
    box.checked = stated;
    details.append(el("label", { class: "flag", for: box.id }, box, t`State it`));
  }
  details.append(body);
  if (open) fillBody();
  return details;
}

/** @param {unknown} value */
function empty(value) {
  return value !== undefined && value !== null && typeof value === "object" && Object.keys(value).length === 0;
}

/**
 * @param {string} name @param {string} unit @param {string} note @param {string} path @param {boolean} required
 * @param {HTMLElement} control
 */
function labelled(name, unit, note, path, required, control) {
  const id = `f${++ids}`;
  control.id = id;
  control.setAttribute("data-path", path);
  control.setAttribute("aria-describedby", `${id}e${note ? ` ${id}n` : ""}`);
  if (required) control.setAttribute("aria-required", "true");
  return el(
    "div",
    { class: "field" },
    el(
      "label",
      { for: id },
      words(name),
      unit && el("span", { class: "unit" }, ` (${unit})`),
      required && el("span", { class: "required", title: t`required` }, " *"),
    ),
    control,
    el("p", { class: "error", id: `${id}e` }),
    note && el("p", { class: "note", id: `${id}n` }, note),
  );
}

/**
 * @param {string} name
 * @param {string} note
 * @param {string} path
 * @param {Json} value
 * @param {(value: Json | undefined) => void} set
 */
function flag(name, note, path, value, set) {
  const id = `f${++ids}`;
  const box = el("input", {
    type: "checkbox",
    id,
    "data-path": path,
    "aria-describedby": `${id}e ${id}n`,
    onchange: () => set(box.checked),
  });
  box.checked = Boolean(value);
  return el(
    "div",
    { class: "field" },
    el("label", { class: "flag", for: id }, box, words(name)),
    el("p", { class: "error", id: `${id}e` }),
    el("p", { class: "note", id: `${id}n` }, note),
  );
}

/** Words of a list. @param {Json} value */
function strings(value) {
  return Array.isArray(value) ? value.map(String) : [];
}

/** Names between commas. @param {string} text */
function named(text) {
  return text
    .split(",")
    .map((one) => one.trim())
    .filter(Boolean);
}

/**
 * `0, open` or `90`; what is no number stays as it is written, and the service says so.
 * @param {string} text
 * @param {Schema[]} options
 */
function numbers(text, options) {
  const parts = text
    .split(/[,;\s]+/)
    .filter((part) => part !== "")
    .map((part) => (["open", "null", "-", "–"].includes(part) ? null : plain(part)));
  return parts.length === 1 && options.some((one) => one.type !== "array") ? parts[0] : parts;
}
