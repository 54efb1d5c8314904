/** A list of objects as a table; rows can be pasted from a spreadsheet. */

import { choice, numberBox } from "./controls.js";
import { el, words } from "./dom.js";
import { alternatives, columns, discriminator, initial, optionOf } from "./schema.js";

/** @typedef {import("./schema.js").Schema} Schema */

/**
 * @param {import("./form.js").Sheet} sheet @param {Schema} item schema of a row @param {any[]} rows changed in place
 * @param {string} path JSON pointer of the list
 */
export function table(sheet, item, rows, path) {
  const heads = columns(item, sheet.root);
  const line = (/** @type {any} */ row, /** @type {number} */ k) => el("tr", {},
    el("th", { scope: "row" }, k + 1),
    ...heads.map((head) => el("td", {}, cell(sheet, head, row, `${path}/${k}/${head.name}`, k, item))),
    el("td", {}, el("button", { type: "button", class: "small", "aria-label": `Remove row ${k + 1}`, onclick: () => {
      rows.splice(k, 1);
      sheet.rebuild();
    } }, "×")));
  const onpaste = (/** @type {ClipboardEvent} */ event) => {
    const text = event.clipboardData?.getData("text/plain") ?? "";
    if (!/[\t\n]/.test(text.trim())) return;
    event.preventDefault();
    const at = /** @type {HTMLElement} */ (event.target).dataset.path ?? `${path}/${rows.length}/${heads[0].name}`;
    const [first, column] = at.slice(path.length + 1).split("/");
    paste(text, rows, Number(first), heads.slice(Math.max(0, heads.findIndex((head) => head.name === column))), () => initial(item, sheet.root));
    sheet.rebuild();
  };
  const view = el("div", { class: "table", onpaste },
    el("table", {},
      el("thead", {}, el("tr", {}, el("th", { scope: "col" }, "#"),
        ...heads.map((head) => el("th", { scope: "col", title: head.schema.description }, words(head.name))), el("td"))),
      el("tbody", {}, ...rows.map(line))),
    el("div", { class: "row" },
      el("button", { type: "button", class: "small", onclick: () => {
        rows.push(rows.length ? structuredClone(rows[rows.length - 1]) : initial(item, sheet.root));
        sheet.rebuild();
      } }, "Add a row"),
      el("span", { class: "note" }, "Paste rows from a spreadsheet into any cell.")));
  return view;
}

/** @param {import("./form.js").Sheet} sheet @param {any} head @param {any} row @param {string} path @param {number} k @param {Schema} item */
function cell(sheet, head, row, path, k, item) {
  const options = alternatives(item, sheet.root);
  const option = options.length > 1 ? optionOf(options, row) : options[0];
  if (!option.properties[head.name]) return "";
  const set = (/** @type {any} */ value) => {
    if (value === undefined) delete row[head.name];
    else row[head.name] = value;
    // Another alternative has other fields: what it does not know goes.
    if (options.length > 1 && head.name === discriminator(options)) {
      const now = optionOf(options, row);
      for (const name of Object.keys(row)) if (!now.properties[name]) delete row[name];
      for (const name of now.required ?? []) row[name] ??= initial(now.properties[name], sheet.root);
      sheet.rebuild();
    } else sheet.changed();
  };
  const value = row[head.name];
  let control;
  if (head.kinded.control === "choice") {
    control = choice(head.kinded.choices, value ?? head.schema.default, head.kinded.nullable, set);
  } else if (head.kinded.control === "flag") {
    const box = el("input", { type: "checkbox", onchange: () => set(box.checked) });
    box.checked = Boolean(value ?? head.schema.default);
    control = box;
  } else if (typeof value === "object" && value !== null) return "JSON";
  else control = numberBox(value, head.schema.default, set);
  control.setAttribute("data-path", path);
  control.setAttribute("aria-label", `${words(head.name)}, row ${k + 1}`);
  return control;
}

/**
 * Put the cells of a spreadsheet into the rows from `first` on.
 * @param {string} text lines of cells, parted by tabs, semicolons or (with decimal points) commas
 * @param {any[]} rows @param {number} first @param {{name: string, kinded: any}[]} heads @param {() => any} blank
 */
export function paste(text, rows, first, heads, blank) {
  const lines = text.trim().split(/\r?\n/);
  lines.forEach((line, k) => {
    const cells = line.includes("\t") ? line.split("\t") : line.split(/[;,]/);
    const row = (rows[first + k] ??= blank());
    heads.forEach((head, column) => {
      const cell = cells[column]?.trim();
      if (cell === undefined || cell === "") return;
      // A spreadsheet of many countries writes 12,5 for twelve and a half.
      const value = Number(/^-?\d+,\d+$/.test(cell) ? cell.replace(",", ".") : cell.replace("−", "-"));
      row[head.name] = Number.isFinite(value) ? value : cell;
    });
  });
}
