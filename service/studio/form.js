/**
 * A form made from the JSON schema of a problem.
 *
 * The form changes the problem in place. A field that is left empty is left out of the problem, so that the service's
 * default holds. Each control carries its JSON pointer as `data-path`, by which errors find it.
 */

import { choice, numberBox } from "./controls.js";
import { el, words } from "./dom.js";
import { discriminator, initial, kinded, optionOf, resolved, tagsOf } from "./schema.js";
import { table } from "./table.js";

/** @typedef {import("./schema.js").Schema} Schema */

/**
 * What the controls of one form share.
 * @typedef {object} Sheet
 * @property {Schema} root
 * @property {() => void} changed a value was changed
 * @property {() => void} rebuild the form has other controls now
 */

/** Fields of every problem that few people touch; they come last. */
const LAST = ["length_unit", "rank_by", "max_designs", "include_failed", "seed"];

let ids = 0;

/**
 * Fill `form` with the controls of a problem.
 * @param {HTMLElement} form @param {Schema} root @param {any} problem @param {(rebuilt: boolean) => void} changed
 */
export function fill(form, root, problem, changed) {
  /** @type {Sheet} */
  const sheet = { root, changed: () => changed(false), rebuild: () => changed(true) };
  const names = Object.keys(root.properties);
  const must = names.filter((name) => root.required?.includes(name));
  const may = names.filter((name) => !must.includes(name) && !LAST.includes(name));
  const order = [...must, ...may, ...LAST.filter((name) => names.includes(name))];
  const opened = [...form.querySelectorAll("details[open]")].map((one) => one.getAttribute("data-path"));
  const focused = form.contains(document.activeElement) ? document.activeElement?.getAttribute("data-path") : null;
  form.replaceChildren(...controls(sheet, root, problem, "/problem", order).filter((one) => one !== null));
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
 * The control of one property of `owner`.
 * @param {Sheet} sheet @param {Schema} schema @param {string} name @param {any} owner @param {string} path
 * @param {boolean} required
 * @returns {Node | null}
 */
function field(sheet, schema, name, owner, path, required) {
  const what = kinded(schema, sheet.root);
  const set = (/** @type {any} */ value) => {
    if (value === undefined) delete owner[name];
    else owner[name] = value;
    sheet.changed();
  };
  const value = owner[name];
  const about = schema.description ?? (what.options.length === 1 ? resolved(what.options[0], sheet.root).description : "");
  const note = (about ?? "").split("\n\n")[0].replace(/[`\n]+/g, (/** @type {string} */ one) => (one.includes("`") ? "" : " "));
  const fallback = schema.default ?? null;
  // A list or one object: what is stated, or stands in for it, tells which of the two has the controls.
  const single = what.options.find((one) => one.type === "object" && one.properties);
  const control = what.control === "table" && single && !Array.isArray(value ?? fallback) ? "object" : what.control;
  switch (control) {
    case "fixed":
      return null;
    case "choice":
      return labelled(name, note, path, required, choice(what.choices ?? [], value ?? fallback, what.nullable, set));
    case "flag":
      return flag(name, note, path, value ?? fallback, set);
    case "number":
      return typeof value === "object" && value !== null
        ? elsewhere(name, path)
        : labelled(name, note, path, required, numberBox(value, fallback, set));
    case "text":
      return labelled(name, note, path, required, textBox(value, fallback, set, plain));
    case "numbers":
      return labelled(name, note, path, required, textBox(value, fallback, set, (text) => numbers(text, what.options)));
    case "table":
      return group(sheet, schema, name, note, path, required || !what.nullable, owner, set, () => {
        if (!Array.isArray(owner[name])) owner[name] = [];
        return [table(sheet, what.item ?? {}, owner[name], path)];
      });
    case "object":
      return group(sheet, schema, name, note, path, required || !what.nullable, owner, set, () => {
        owner[name] ??= {};
        return controls(sheet, single ?? what.options[0], owner[name], path);
      });
    case "union":
      return group(sheet, schema, name, note, path, required || !what.nullable, owner, set, () =>
        union(sheet, what.options, owner, name, path));
    default:
      return elsewhere(name, path);
  }
}

/** @param {Sheet} sheet @param {Schema[]} options @param {any} owner @param {string} name @param {string} path */
function union(sheet, options, owner, name, path) {
  const tag = discriminator(options) ?? "";
  owner[name] ??= initial(options[0], sheet.root);
  const option = optionOf(options, owner[name]);
  const pick = choice(options.flatMap((one) => tagsOf(one, tag)), owner[name][tag], false, (value) => {
    const next = initial(options.find((one) => tagsOf(one, tag).includes(value)) ?? options[0], sheet.root);
    owner[name] = { ...next, [tag]: value };
    sheet.rebuild();
  });
  const others = Object.keys(option.properties).filter((one) => one !== tag);
  return [labelled(tag, "", `${path}/${tag}`, true, pick), ...controls(sheet, option, owner[name], path, others)];
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
  const details = el("details", { class: "field group", "data-path": path, open, ontoggle: () => {
    // What is only looked at is not stated: an empty group leaves the problem again when it is closed.
    if (details.open && (always || stated)) fillBody();
    else if (!details.open && empty(owner[name]) && !required) set(undefined);
  } }, el("summary", {}, words(name)), el("p", { class: "error" }));
  if (note) details.append(el("p", { class: "note" }, note));
  if (!always) {
    const box = el("input", { type: "checkbox", id: `f${++ids}`, onchange: () => {
      if (box.checked) {
        owner[name] = initial(schema, sheet.root);
      } else {
        delete owner[name];
      }
      sheet.rebuild();
    } });
    box.checked = stated;
    details.append(el("label", { class: "flag", for: box.id }, box, "State it"));
  }
  details.append(body);
  if (open) fillBody();
  return details;
}

/** @param {any} value */
function empty(value) {
  return value !== undefined && value !== null && typeof value === "object" && Object.keys(value).length === 0;
}

/** @param {string} name @param {string} note @param {string} path @param {boolean} required @param {HTMLElement} control */
function labelled(name, note, path, required, control) {
  const id = `f${++ids}`;
  control.id = id;
  control.setAttribute("data-path", path);
  control.setAttribute("aria-describedby", `${id}e${note ? ` ${id}n` : ""}`);
  if (required) control.setAttribute("aria-required", "true");
  return el("div", { class: "field" },
    el("label", { for: id }, words(name), required && el("span", { class: "required", title: "required" }, " *")),
    control,
    el("p", { class: "error", id: `${id}e` }),
    note && el("p", { class: "note", id: `${id}n` }, note));
}

/** @param {string} name @param {string} note @param {string} path @param {any} value @param {(value: any) => void} set */
function flag(name, note, path, value, set) {
  if (typeof value === "object" && value !== null) return elsewhere(name, path);
  const id = `f${++ids}`;
  const box = el("input", { type: "checkbox", id, "data-path": path, "aria-describedby": `${id}e ${id}n`, onchange: () => set(box.checked) });
  box.checked = Boolean(value);
  return el("div", { class: "field" }, el("label", { class: "flag", for: id }, box, words(name)),
    el("p", { class: "error", id: `${id}e` }), el("p", { class: "note", id: `${id}n` }, note));
}

/** @param {string} name @param {string} path */
function elsewhere(name, path) {
  return el("div", { class: "field", "data-path": path }, el("span", { class: "label" }, words(name)),
    el("p", { class: "error" }), el("p", { class: "note" }, "Stated in the JSON below."));
}

/** @param {any} value @param {any} fallback @param {(value: any) => void} set @param {(text: string) => any} read */
function textBox(value, fallback, set, read) {
  const written = (/** @type {any} */ one) => Array.isArray(one) ? one.map((part) => part ?? "open").join(", ") : String(one ?? "");
  const box = el("input", { type: "text", spellcheck: "false", placeholder: written(fallback),
    oninput: () => set(box.value.trim() === "" ? undefined : read(box.value.trim())) });
  if (value !== undefined && value !== null) box.value = written(value);
  return box;
}

/** A number where the text is one. @param {string} text */
function plain(text) {
  const value = Number(text);
  return Number.isFinite(value) ? value : text;
}

/** `0, open` or `90`; what is no number stays as it is written, and the service says so. @param {string} text @param {Schema[]} options */
function numbers(text, options) {
  const parts = text.split(/[,;\s]+/).filter((part) => part !== "")
    .map((part) => (["open", "null", "-", "–"].includes(part) ? null : plain(part)));
  return parts.length === 1 && options.some((one) => one.type !== "array") ? parts[0] : parts;
}
