/**
 * A form made from the JSON schema of a problem.
 *
 * The form changes the problem in place. A field that is left empty is left out of the problem, so that the service's
 * default holds. Each control carries its JSON pointer as `data-path`, by which errors find it.
 */

import { choice, choices, jsonBox, numberBox, plain, pointsBox, stockBox, textBox } from "./controls.js";
import { el, words } from "./dom.js";
import { prose, t } from "./messages.js";
import { discriminator, initial, kinded, optionOf, resolved, shapeOf, tagsOf } from "./schema.js";
import { table } from "./table.js";
import { unitOf } from "./units.js";

/** @import { Problem } from "./types/values.js" */

/** @typedef {import("./schema.js").Schema} Schema */

/**
 * What the controls of one form share.
 * @typedef {object} Sheet
 * @property {Schema} root
 * @property {Problem} problem
 * @property {(schema: Schema, owner: any, path: string, names: string[]) => (Node | null)[]} controls of some
 *   properties of an object
 * @property {() => void} changed a value was changed
 * @property {() => void} rebuild the form has other controls now
 */

/** Fields of every problem that few people touch; they come last. */
const LAST = ["length_unit", "rank_by", "max_designs", "include_failed", "seed"];

/** Fewer fields than these that nobody has stated need not be folded away. */
const FOLDED = 3;

let ids = 0;

/**
 * Fill `form` with the controls of a problem.
 * @param {HTMLElement} form @param {Schema} root @param {Problem} problem @param {(rebuilt: boolean) => void} changed
 */
export function fill(form, root, problem, changed) {
  /** @type {Sheet} */
  const sheet = {
    root,
    problem,
    changed: () => changed(false),
    rebuild: () => changed(true),
    controls: (schema, owner, path, names) => controls(sheet, schema, owner, path, names),
  };
  const names = Object.keys(root.properties);
  const must = names.filter((name) => root.required?.includes(name));
  const may = names.filter((name) => !must.includes(name) && !LAST.includes(name));
  const order = [...must, ...may, ...LAST.filter((name) => names.includes(name))];
  const opened = [...form.querySelectorAll("details[open]")].map((one) => one.getAttribute("data-path"));
  const focused = form.contains(document.activeElement) ? document.activeElement?.getAttribute("data-path") : null;
  form.replaceChildren(...folded(sheet, root, problem, "/problem", order));
  for (const path of opened) form.querySelector(`details[data-path="${path}"]`)?.setAttribute("open", "");
  /** @type {HTMLElement | null} */ (focused && form.querySelector(`[data-path="${focused}"]`))?.focus();
}

/** @param {Sheet} sheet @param {Schema} schema @param {any} value @param {string} path @param {string[]} [order] */
function controls(sheet, schema, value, path, order = Object.keys(schema.properties)) {
  return order.map((name) => {
    const required = schema.required?.includes(name) ?? false;
    return field(sheet, schema.properties[name], name, value, `${path}/${name}`, required);
  });
}

/**
 * What is stated, and what must be; the rest is one click away.
 * @param {Sheet} sheet @param {Schema} schema @param {any} value @param {string} path @param {string[]} [order]
 * @returns {Node[]}
 */
function folded(sheet, schema, value, path, order = Object.keys(schema.properties)) {
  const used = (/** @type {string} */ name) =>
    schema.required?.includes(name) || (value[name] !== undefined && value[name] !== null && !empty(value[name]));
  const made = (/** @type {string[]} */ names) =>
    /** @type {Node[]} */ (controls(sheet, schema, value, path, names).filter((one) => one !== null));
  const [first, rest] = [made(order.filter(used)), made(order.filter((name) => !used(name)))];
  if (rest.length < FOLDED) return [...first, ...rest];
  const more = el(
    "details",
    { class: "more", "data-path": `${path}/*`, onreveal: () => (more.open = true) },
    el("summary", {}, `${path === "/problem" ? t`More` : t`More limits`} (${rest.length})`),
    el("div", { class: "fields" }, ...rest),
  );
  return [...first, more];
}

/**
 * The control of one property of `owner`.
 * @param {Sheet} sheet @param {Schema} schema @param {string} name @param {any} owner @param {string} path
 * @param {boolean} required
 * @returns {Node | null}
 */
function field(sheet, schema, name, owner, path, required) {
  const what = kinded(schema, sheet.root);
  const set = (/** @type {unknown} */ value) => {
    if (value === undefined) delete owner[name];
    else owner[name] = value;
    // The units beside the other fields are those of the length unit, or of the mechanism that is asked for.
    if (name === "length_unit" || (name === "mechanism" && typeof value === "string")) sheet.rebuild();
    else sheet.changed();
  };
  const value = owner[name];
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
      return choices(name, note, path, what.choices ?? [], value ?? fallback ?? [], set);
    case "flag":
      return flag(name, note, path, value ?? fallback, set);
    case "number":
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
      return group(sheet, schema, name, note, path, required || !what.nullable, owner, set, () => {
        // A list that is only looked at is not stated: it becomes part of the problem with its first row.
        const rows = Array.isArray(owner[name]) ? owner[name] : [];
        const rebuild = () => {
          if (rows.length) owner[name] = rows;
          sheet.rebuild();
        };
        return [table({ ...sheet, rebuild }, what.item ?? {}, rows, path, what.count)];
      });
    case "object":
      return group(sheet, schema, name, note, path, required || !what.nullable, owner, set, () => {
        owner[name] ??= {};
        return folded(sheet, what.options[0], owner[name], path);
      });
    case "union":
      return group(sheet, schema, name, note, path, required || !what.nullable, owner, set, () =>
        union(sheet, what.options, owner, name, path),
      );
    case "map":
      return group(sheet, schema, name, note, path, required || !what.nullable, owner, set, () =>
        members(sheet, what.item ?? {}, owner, name, path),
      );
    case "shapes":
      return shapes(sheet, what, schema, name, note, path, required, owner, set);
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
  const names = Object.keys(option.properties ?? {});
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
 * @param {import("./schema.js").Kinded} what
 * @param {Schema} schema
 * @param {string} name
 * @param {string} note
 * @param {string} path @param {boolean} required @param {any} owner @param {(value: any) => void} set
 * @returns {HTMLElement}
 */
function shapes(sheet, what, schema, name, note, path, required, owner, set) {
  const options =
    what.nullable && (schema.default ?? null) !== null ? [...what.options, { type: "null" }] : what.options;
  const value = owner[name] === undefined ? schema.default : owner[name];
  const now = shapeOf(options, value) ?? options[0];
  const dimension = schema["x-dimension"];
  const ways = options.map(shapeName);
  const way = choice(ways, shapeName(now), false, (chosen) => {
    const option = options[ways.indexOf(String(chosen))];
    owner[name] = option.type === "null" ? null : initial(option, sheet.root);
    sheet.rebuild();
  });
  if (now.const !== undefined || now.type === "null") return labelled(name, "", note, path, required, way);
  way.setAttribute("aria-label", t`${words(name)}: how it is stated`);
  const one = { ...now, ...(dimension ? { "x-dimension": dimension } : {}) };
  // What is not stated yet stays unstated while it is only looked at.
  const inside =
    now.type === "object" || kinded(now, sheet.root).control === "table"
      ? group(sheet, { ...one, default: schema.default }, name, note, path, true, owner, set, () => {
          if (shapeOf([now], owner[name]) === undefined)
            owner[name] = shapeOf([now], schema.default) ? structuredClone(schema.default) : initial(now, sheet.root);
          return now.type === "array"
            ? [table(sheet, now.items, owner[name], path)]
            : controls(sheet, now, owner[name], path);
        })
      : field(sheet, { ...one, default: schema.default, description: note }, name, owner, path, required);
  if (inside instanceof HTMLDetailsElement) {
    inside.querySelector("summary")?.after(way);
    if (shapeOf([now], owner[name])) inside.dispatchEvent(new Event("reveal"));
  } else /** @type {HTMLElement} */ (inside)?.querySelector(":scope > .error")?.before(way);
  return /** @type {HTMLElement} */ (inside);
}

/**
 * Objects by names that are given to them.
 * @param {Sheet} sheet
 * @param {Schema} item
 * @param {any} owner
 * @param {string} field
 * @param {string} path
 */
function members(sheet, item, owner, field, path) {
  /** @type {Record<string, any>} */
  const found = owner[field] ?? {};
  const name = el("input", { type: "text", "aria-label": t`Name of another one`, spellcheck: "false" });
  const add = el(
    "button",
    {
      type: "button",
      class: "small",
      onclick: () => {
        const stated = name.value.trim();
        if (!stated) return name.focus();
        // What is only looked at is not stated.
        owner[field] = { ...found, [stated]: found[stated] ?? initial(item, sheet.root) };
        sheet.rebuild();
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
            onclick: () => {
              delete found[key];
              sheet.rebuild();
            },
          },
          "×",
        ),
      ),
      ...controls(
        sheet,
        resolved(item, sheet.root),
        found[key],
        `${path}/${key.replaceAll("~", "~0").replaceAll("/", "~1")}`,
      ),
    ]),
    el("div", { class: "row member" }, name, add),
  ];
}

/** @param {Sheet} sheet @param {Schema[]} options @param {any} owner @param {string} name @param {string} path */
function union(sheet, options, owner, name, path) {
  const tag = discriminator(options) ?? "";
  owner[name] ??= initial(options[0], sheet.root);
  const option = optionOf(options, owner[name]);
  const pick = choice(
    options.flatMap((one) => tagsOf(one, tag)),
    owner[name][tag] ?? option.properties[tag].default,
    false,
    (value) => {
      const next = initial(options.find((one) => tagsOf(one, tag).includes(String(value))) ?? options[0], sheet.root);
      owner[name] = { ...next, [tag]: value };
      sheet.rebuild();
    },
  );
  const others = Object.keys(option.properties).filter((one) => one !== tag);
  return [labelled(tag, "", "", `${path}/${tag}`, true, pick), ...controls(sheet, option, owner[name], path, others)];
}

/**
 * A group of fields that opens; what may be absent is stated by a flag.
 * @param {Sheet} sheet @param {Schema} schema @param {string} name @param {string} note @param {string} path
 * @param {boolean} always @param {any} owner @param {(value: any) => void} set @param {() => (Node | null)[]} inside
 */
function group(sheet, schema, name, note, path, always, owner, set, inside) {
  const stated = owner[name] !== undefined && owner[name] !== null;
  const required = sheet.root.required?.includes(name) && path.split("/").length === 3;
  const body = el("div", { class: "fields" });
  const fillBody = () => {
    if (!body.childElementCount) body.append(...inside().filter((one) => one !== null));
  };
  const open = stated && (required || Object.keys(owner[name]).length > 0);
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
        // What is only looked at is not stated: an empty group leaves the problem again when it is closed.
        if (details.open && (always || stated)) fillBody();
        else if (!details.open && empty(owner[name]) && !required) set(undefined);
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
      onchange: () => {
        if (box.checked) {
          owner[name] = initial(schema, sheet.root);
        } else {
          delete owner[name];
        }
        sheet.rebuild();
      },
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
 * @param {any} value
 * @param {(value: any) => void} set
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
