/** Edit a list of objects as a table; rows can be pasted from a spreadsheet. */

import { createChoice, createNumberBox, parseNumber, createTextBox } from "./controls.js";
import { createElement, toWords } from "../core/dom.js";
import { firstParagraph, t, term } from "../core/messages.js";
import { readPointer, isContainer } from "../core/pointer.js";
import {
  alternatives,
  listOtherFields,
  listColumns,
  findDiscriminator,
  initialValue,
  classifyField,
  findOption,
  propertiesOf,
} from "../core/schema.js";
import { statementPointer } from "./form_state.js";
import { fieldUnit } from "../core/units.js";

/** @import { Json, Problem } from "../types/values.js" */
/** @import { Column, Schema } from "../core/schema.js" */
/** @import { FormState } from "./form_state.js" */

/** @typedef {Record<string, Json | undefined>} Row */
/** @typedef {(sheet: FormState, schema: Schema, path: string, names: string[]) => (Node | null)[]} Controls */

/** Columns that stay at least where others are folded away. */
const MIN_COLUMNS = 2;

/** Maximum number of columns of rows in one line, if none of them is a choice. */
const MAX_ONE_LINE_COLUMNS = 3;

/** Tables that show all columns. @type {Set<string>} */
const unfoldedTables = new Set();

/** Return whether a value is empty. @param {unknown} value */
function isEmpty(value) {
  return value === undefined || value === null || value === false;
}

/**
 * @param {FormState} sheet that shows an empty list if none is given @param {Schema} item schema of a row
 * @param {string} path JSON pointer of the list
 * @param {Controls} controls of what a cell cannot state
 * @param {number} [count] fixed number of rows, if there is one
 */
export function createTable(sheet, item, path, controls, count) {
  const rows = readRows(sheet.problem, path);
  const heads = listColumns(item, sheet.root);
  const seldom = heads.filter((head) => !head.required && rows.every((row) => isEmpty(row[head.name])));
  // One column alone says too little of a row.
  const folded = heads.length - seldom.length >= MIN_COLUMNS ? seldom : [];
  const chosen = (/** @type {{kinded: {control: string}}} */ head) => head.kinded.control === "choice";
  const kept = (/** @type {(typeof heads)[number]} */ head) =>
    [folded.some((one) => one.name === head.name) && "seldom", chosen(head) && "choice-of"].filter(Boolean).join(" ");
  const line = (/** @type {Row} */ row, /** @type {number} */ k) => [
    createElement(
      "tr",
      {},
      createElement("th", { scope: "row" }, k + 1),
      ...heads.map((head) => createElement("td", { class: kept(head) }, createCell(sheet, head, row, path, k, item))),
      createElement(
        "td",
        { class: "acts" },
        ...createDetailButtons(sheet, item, row, `${path}/${k}`, k),
        count === undefined &&
          createElement(
            "button",
            {
              type: "button",
              class: "small",
              "aria-label": t`Remove row ${k + 1}`,
              onclick: () => sheet.writeValue(`${path}/${k}`, undefined, true),
            },
            "×",
          ),
      ),
    ),
    ...createRowDetails(sheet, item, row, `${path}/${k}`, controls, heads.length + 2, k),
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
    const pasted = pasteCells(
      text,
      readRows(sheet.problem, path),
      Number(first),
      heads.slice(from),
      createBlankRow(item, sheet.root),
    );
    sheet.writeValue(path, pasted, true);
  };
  const columned = `${sheet.problem.kind}${path}`;
  const lined = (/** @type {number} */ seen) => heads.some(chosen) || seen > MAX_ONE_LINE_COLUMNS;
  const view = createElement(
    "div",
    {
      class: [
        "table",
        folded.length && !unfoldedTables.has(columned) && "brief",
        lined(heads.length - (unfoldedTables.has(columned) ? 0 : folded.length)) && "lined",
      ]
        .filter(Boolean)
        .join(" "),
      onpaste,
    },
    createElement(
      "table",
      {},
      createElement(
        "thead",
        {},
        createElement(
          "tr",
          {},
          createElement("th", { scope: "col" }, "#"),
          ...heads.map((head) =>
            createElement(
              "th",
              { scope: "col", class: kept(head), title: firstParagraph(head.schema.description) },
              toWords(head.name),
              fieldUnit(head.schema, sheet.problem) &&
                createElement("span", { class: "unit" }, ` (${fieldUnit(head.schema, sheet.problem)})`),
            ),
          ),
          createElement("td"),
        ),
      ),
      createElement("tbody", {}, ...rows.flatMap(line)),
    ),
    createElement(
      "div",
      { class: "row" },
      count === undefined &&
        createElement(
          "button",
          {
            type: "button",
            class: "small",
            onclick: () => {
              const last = readRows(sheet.problem, path).at(-1);
              sheet.writeValue(`${path}/${rows.length}`, last ?? createBlankRow(item, sheet.root), true);
            },
          },
          t`Add a row`,
        ),
      folded.length > 0 &&
        createElement(
          "button",
          {
            type: "button",
            class: "small more-columns",
            onclick: () => {
              unfoldedTables.add(columned);
              view.classList.remove("brief");
              view.classList.toggle("lined", lined(heads.length));
              const first = `${path}/0/${folded[0].name}`;
              /** @type {HTMLElement | null} */ (view.querySelector(`[data-path="${CSS.escape(first)}"]`))?.focus();
            },
          },
          t`Add ${folded.map((head) => term(head.name)).join(", ")}`,
        ),
      createElement("span", { class: "note" }, t`Paste rows from a spreadsheet into any cell.`),
    ),
  );
  return view;
}

/** The rows of a list in a statement. @param {Problem} statement @param {string} path @returns {Row[]} */
function readRows(statement, path) {
  const found = readPointer(statement, statementPointer(path));
  return Array.isArray(found) ? found.map((one) => (isContainer(one) ? one : {})) : [];
}

/** A row that is begun. @param {Schema} item @param {Schema} root @returns {Row} */
function createBlankRow(item, root) {
  const first = initialValue(item, root);
  return isContainer(first) ? first : {};
}

/**
 * @param {FormState} sheet
 * @param {Column} head
 * @param {Row} row
 * @param {string} list its pointer
 * @param {number} k
 * @param {Schema} item
 */
function createCell(sheet, head, row, list, k, item) {
  const options = alternatives(item, sheet.root);
  const option = options.length > 1 ? findOption(options, row) : options[0];
  const { name } = head;
  const path = `${list}/${k}`;
  if (!propertiesOf(option)[name]) return "";
  const tells = options.length > 1 && name === findDiscriminator(options);
  const set = (/** @type {Json | undefined} */ value) => {
    if (!tells) return sheet.writeValue(`${path}/${name}`, value);
    // Another alternative has other fields: remove those that it lacks.
    const before = { ...readRows(sheet.problem, list)[k], [name]: value };
    const now = findOption(options, before);
    const known = Object.entries(before).filter(([one]) => propertiesOf(now)[one]);
    const must = (now.required ?? []).filter((one) => (before[one] ?? null) === null);
    const begun = must.map((one) => [one, initialValue(propertiesOf(now)[one], sheet.root)]);
    sheet.writeValue(path, Object.fromEntries([...known, ...begun]), true);
  };
  const value = row[name];
  let control;
  if (head.kinded.control === "choice") {
    control = createChoice(head.kinded.choices ?? [], value ?? head.schema.default, head.kinded.nullable, set);
  } else if (head.kinded.control === "flag") {
    const box = createElement("input", { type: "checkbox", onchange: () => set(box.checked) });
    box.checked = Boolean(value ?? head.schema.default);
    control = box;
  } else if (head.kinded.control === "text") {
    control = createTextBox(value, head.schema.default, set, parseNumber);
  } else if (typeof value === "object" && value !== null) return t`below`;
  else control = createNumberBox(value, head.schema.default, set);
  control.setAttribute("data-path", `${path}/${name}`);
  control.setAttribute("aria-label", t`${toWords(name)}, row ${k + 1}`);
  return control;
}

/** @param {FormState} sheet @param {Schema} item @param {Row} row */
function findRowOption(sheet, item, row) {
  const options = alternatives(item, sheet.root);
  return options.length > 1 ? findOption(options, row) : options[0];
}

/**
 * What of a row is more than a cell can state, in a row below it that opens.
 * @param {FormState} sheet
 * @param {Schema} item
 * @param {Row} row
 * @param {string} path
 * @param {Controls} controls
 * @param {number} width columns
 * @param {number} k
 */
function createRowDetails(sheet, item, row, path, controls, width, k) {
  const option = findRowOption(sheet, item, row);
  // A value that fits a cell as a number is shown here only if it is given in detail.
  const names = listOtherFields(option, sheet.root).filter(
    (name) => classifyField(propertiesOf(option)[name], sheet.root).control !== "shapes" || isContainer(row[name]),
  );
  if (!names.length) return [];
  const stated = names.some((name) => {
    const value = row[name];
    return Array.isArray(value) ? value.length > 0 : isContainer(value);
  });
  const inside = createElement("div", { class: "fields" });
  const fill = () => {
    if (!inside.childElementCount) inside.append(...controls(sheet, option, path, names).filter((one) => one !== null));
  };
  const details = createElement(
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
    createElement("summary", {}, t`Row ${k + 1}: ${names.map(term).join(", ")}`),
    inside,
  );
  if (stated) fill();
  return [createElement("tr", { class: "more" }, createElement("td", { colspan: width }, details))];
}

/**
 * Buttons that begin to state in detail what a cell states as a number.
 * @param {FormState} sheet
 * @param {Schema} item
 * @param {Row} row
 * @param {string} path
 * @param {number} k
 */
function createDetailButtons(sheet, item, row, path, k) {
  const option = findRowOption(sheet, item, row);
  return listOtherFields(option, sheet.root).flatMap((name) => {
    const what = classifyField(propertiesOf(option)[name], sheet.root);
    if (what.control !== "shapes" || isContainer(row[name])) return [];
    const title = t`${toWords(name)} of row ${k + 1} in detail`;
    return [
      createElement(
        "button",
        {
          type: "button",
          class: "small",
          title,
          "aria-label": title,
          onclick: () =>
            sheet.writeValue(
              `${path}/${name}`,
              initialValue(what.options.find((one) => one.type === "object") ?? {}, sheet.root),
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
function pasteCells(text, rows, first, heads, blank) {
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
