/** A list of objects as a table; rows can be pasted from a spreadsheet. */

import { choice, numberBox, plain, textBox } from "./controls.js";
import { el, words } from "../core/dom.js";
import { prose, t, term } from "../core/messages.js";
import { at, group } from "../core/pointer.js";
import {
  alternatives,
  beyond,
  columns,
  discriminator,
  initial,
  kinded,
  optionOf,
  propertiesOf,
} from "../core/schema.js";
import { within } from "./form_state.js";
import { unitOf } from "../core/units.js";

/** @import { Json, Problem } from "../types/values.js" */
/** @import { Column, Schema } from "../core/schema.js" */
/** @import { Sheet } from "./form_state.js" */

/** @typedef {Record<string, Json | undefined>} Row */
/** @typedef {(sheet: Sheet, schema: Schema, path: string, names: string[]) => (Node | null)[]} Controls */

/** Columns that stay at least where others are folded away. */
const FEWEST = 2;

/** Columns that rows have in one line, where nothing of them is chosen. */
const ONE_LINE = 3;

/** Tables of which all columns have been asked for. @type {Set<string>} */
const wide = new Set();

/** Whether nobody has stated a value. @param {unknown} value */
function empty(value) {
  return value === undefined || value === null || value === false;
}

/**
 * @param {Sheet} sheet that looks at an empty list where none is stated @param {Schema} item schema of a row
 * @param {string} path JSON pointer of the list
 * @param {Controls} controls of what a cell cannot state
 * @param {number} [count] where there are always so many rows
 */
export function table(sheet, item, path, controls, count) {
  const rows = rowsAt(sheet.problem, path);
  const heads = columns(item, sheet.root);
  const seldom = heads.filter((head) => !head.required && rows.every((row) => empty(row[head.name])));
  // One column alone says too little of a row.
  const folded = heads.length - seldom.length >= FEWEST ? seldom : [];
  const chosen = (/** @type {{kinded: {control: string}}} */ head) => head.kinded.control === "choice";
  const kept = (/** @type {(typeof heads)[number]} */ head) =>
    [folded.some((one) => one.name === head.name) && "seldom", chosen(head) && "choice-of"].filter(Boolean).join(" ");
  const line = (/** @type {Row} */ row, /** @type {number} */ k) => [
    el(
      "tr",
      {},
      el("th", { scope: "row" }, k + 1),
      ...heads.map((head) => el("td", { class: kept(head) }, cell(sheet, head, row, path, k, item))),
      el(
        "td",
        { class: "acts" },
        ...inDetail(sheet, item, row, `${path}/${k}`, k),
        count === undefined &&
          el(
            "button",
            {
              type: "button",
              class: "small",
              "aria-label": t`Remove row ${k + 1}`,
              onclick: () => sheet.put(`${path}/${k}`, undefined, true),
            },
            "×",
          ),
      ),
    ),
    ...more(sheet, item, row, `${path}/${k}`, controls, heads.length + 2, k),
  ];
  const onpaste = (/** @type {ClipboardEvent} */ event) => {
    const text = event.clipboardData?.getData("text/plain") ?? "";
    // Lines that are pasted into a field of many lines are lines of its own.
    if (!/[\t\n]/.test(text.trim()) || event.target instanceof HTMLTextAreaElement) return;
    event.preventDefault();
    const place = /** @type {HTMLElement} */ (event.target).dataset.path ?? `${path}/${rows.length}/${heads[0].name}`;
    const [first, column] = place.slice(path.length + 1).split("/");
    const from = Math.max(
      0,
      heads.findIndex((head) => head.name === column),
    );
    const pasted = paste(text, rowsAt(sheet.problem, path), Number(first), heads.slice(from), blank(item, sheet.root));
    sheet.put(path, pasted, true);
  };
  const columned = `${sheet.problem.kind}${path}`;
  const lined = (/** @type {number} */ seen) => heads.some(chosen) || seen > ONE_LINE;
  const view = el(
    "div",
    {
      class: [
        "table",
        folded.length && !wide.has(columned) && "brief",
        lined(heads.length - (wide.has(columned) ? 0 : folded.length)) && "lined",
      ]
        .filter(Boolean)
        .join(" "),
      onpaste,
    },
    el(
      "table",
      {},
      el(
        "thead",
        {},
        el(
          "tr",
          {},
          el("th", { scope: "col" }, "#"),
          ...heads.map((head) =>
            el(
              "th",
              { scope: "col", class: kept(head), title: prose(head.schema.description) },
              words(head.name),
              unitOf(head.schema, sheet.problem) &&
                el("span", { class: "unit" }, ` (${unitOf(head.schema, sheet.problem)})`),
            ),
          ),
          el("td"),
        ),
      ),
      el("tbody", {}, ...rows.flatMap(line)),
    ),
    el(
      "div",
      { class: "row" },
      count === undefined &&
        el(
          "button",
          {
            type: "button",
            class: "small",
            onclick: () => {
              const last = rowsAt(sheet.problem, path).at(-1);
              sheet.put(`${path}/${rows.length}`, last ?? blank(item, sheet.root), true);
            },
          },
          t`Add a row`,
        ),
      folded.length > 0 &&
        el(
          "button",
          {
            type: "button",
            class: "small more-columns",
            onclick: () => {
              wide.add(columned);
              view.classList.remove("brief");
              view.classList.toggle("lined", lined(heads.length));
              const first = `${path}/0/${folded[0].name}`;
              /** @type {HTMLElement | null} */ (view.querySelector(`[data-path="${CSS.escape(first)}"]`))?.focus();
            },
          },
          t`With ${folded.map((head) => term(head.name)).join(", ")}`,
        ),
      el("span", { class: "note" }, t`Paste rows from a spreadsheet into any cell.`),
    ),
  );
  return view;
}

/** The rows of a list in a statement. @param {Problem} statement @param {string} path @returns {Row[]} */
function rowsAt(statement, path) {
  const found = at(statement, within(path));
  return Array.isArray(found) ? found.map((one) => (group(one) ? one : {})) : [];
}

/** A row that is begun. @param {Schema} item @param {Schema} root @returns {Row} */
function blank(item, root) {
  const first = initial(item, root);
  return group(first) ? first : {};
}

/**
 * @param {Sheet} sheet
 * @param {Column} head
 * @param {Row} row
 * @param {string} list its pointer
 * @param {number} k
 * @param {Schema} item
 */
function cell(sheet, head, row, list, k, item) {
  const options = alternatives(item, sheet.root);
  const option = options.length > 1 ? optionOf(options, row) : options[0];
  const { name } = head;
  const path = `${list}/${k}`;
  if (!propertiesOf(option)[name]) return "";
  const tells = options.length > 1 && name === discriminator(options);
  const set = (/** @type {Json | undefined} */ value) => {
    if (!tells) return sheet.put(`${path}/${name}`, value);
    // Another alternative has other fields: what it does not know goes.
    const before = { ...rowsAt(sheet.problem, list)[k], [name]: value };
    const now = optionOf(options, before);
    const known = Object.entries(before).filter(([one]) => propertiesOf(now)[one]);
    const must = (now.required ?? []).filter((one) => (before[one] ?? null) === null);
    const begun = must.map((one) => [one, initial(propertiesOf(now)[one], sheet.root)]);
    sheet.put(path, Object.fromEntries([...known, ...begun]), true);
  };
  const value = row[name];
  let control;
  if (head.kinded.control === "choice") {
    control = choice(head.kinded.choices ?? [], value ?? head.schema.default, head.kinded.nullable, set);
  } else if (head.kinded.control === "flag") {
    const box = el("input", { type: "checkbox", onchange: () => set(box.checked) });
    box.checked = Boolean(value ?? head.schema.default);
    control = box;
  } else if (head.kinded.control === "text") {
    control = textBox(value, head.schema.default, set, plain);
  } else if (typeof value === "object" && value !== null) return t`below`;
  else control = numberBox(value, head.schema.default, set);
  control.setAttribute("data-path", `${path}/${name}`);
  control.setAttribute("aria-label", t`${words(name)}, row ${k + 1}`);
  return control;
}

/** @param {Sheet} sheet @param {Schema} item @param {Row} row */
function optionAt(sheet, item, row) {
  const options = alternatives(item, sheet.root);
  return options.length > 1 ? optionOf(options, row) : options[0];
}

/**
 * What of a row is more than a cell can state, in a row below it that opens.
 * @param {Sheet} sheet
 * @param {Schema} item
 * @param {Row} row
 * @param {string} path
 * @param {Controls} controls
 * @param {number} width columns
 * @param {number} k
 */
function more(sheet, item, row, path, controls, width, k) {
  const option = optionAt(sheet, item, row);
  // What a cell can state as a number stands here only where it is stated in detail.
  const names = beyond(option, sheet.root).filter(
    (name) => kinded(propertiesOf(option)[name], sheet.root).control !== "shapes" || group(row[name]),
  );
  if (!names.length) return [];
  const stated = names.some((name) => {
    const value = row[name];
    return Array.isArray(value) ? value.length > 0 : group(value);
  });
  const inside = el("div", { class: "fields" });
  const fill = () => {
    if (!inside.childElementCount) inside.append(...controls(sheet, option, path, names).filter((one) => one !== null));
  };
  const details = el(
    "details",
    {
      "data-path": `${path}/`,
      open: stated,
      ontoggle: fill,
      onreveal: () => {
        details.open = true;
        fill();
      },
    },
    el("summary", {}, t`Row ${k + 1}: ${names.map(term).join(", ")}`),
    inside,
  );
  if (stated) fill();
  return [el("tr", { class: "more" }, el("td", { colspan: width }, details))];
}

/**
 * Buttons that begin to state in detail what a cell states as a number.
 * @param {Sheet} sheet
 * @param {Schema} item
 * @param {Row} row
 * @param {string} path
 * @param {number} k
 */
function inDetail(sheet, item, row, path, k) {
  const option = optionAt(sheet, item, row);
  return beyond(option, sheet.root).flatMap((name) => {
    const what = kinded(propertiesOf(option)[name], sheet.root);
    if (what.control !== "shapes" || group(row[name])) return [];
    const title = t`${words(name)} of row ${k + 1} in detail`;
    return [
      el(
        "button",
        {
          type: "button",
          class: "small",
          title,
          "aria-label": title,
          onclick: () =>
            sheet.put(
              `${path}/${name}`,
              initial(what.options.find((one) => one.type === "object") ?? {}, sheet.root),
              true,
            ),
        },
        "⋯",
      ),
    ];
  });
}

/**
 * The rows with the cells of a spreadsheet in those from `first` on.
 * @param {string} text lines of cells, parted by tabs, semicolons or (with decimal points) commas
 * @param {Row[]} rows @param {number} first @param {Column[]} heads @param {Row} blank a row that is begun
 * @returns {Row[]}
 */
function paste(text, rows, first, heads, blank) {
  const all = [...rows];
  const lines = text.trim().split(/\r?\n/);
  lines.forEach((line, k) => {
    const cells = line.includes("\t") ? line.split("\t") : line.split(/[;,]/);
    const row = (all[first + k] = { ...(all[first + k] ?? blank) });
    heads.forEach((head, column) => {
      const cell = cells[column]?.trim();
      if (cell === undefined || cell === "") return;
      // A spreadsheet of many countries writes 12,5 for twelve and a half.
      const value = Number(/^-?\d+,\d+$/.test(cell) ? cell.replace(",", ".") : cell.replace("−", "-"));
      row[head.name] = Number.isFinite(value) ? value : cell;
    });
  });
  return all;
}
