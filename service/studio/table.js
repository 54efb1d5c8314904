/** A list of objects as a table; rows can be pasted from a spreadsheet. */

import { choice, numberBox, plain, textBox } from "./controls.js";
import { el, words } from "./dom.js";
import { prose, t, term } from "./messages.js";
import { alternatives, beyond, columns, discriminator, initial, kinded, optionOf } from "./schema.js";
import { unitOf } from "./units.js";

/** @typedef {import("./schema.js").Schema} Schema */

/** Columns that stay at least where others are folded away. */
const FEWEST = 2;

/** Tables of which all columns have been asked for. @type {Set<string>} */
const wide = new Set();

/** Whether nobody has stated a value. @param {unknown} value */
function empty(value) {
  return value === undefined || value === null || value === false;
}

/**
 * @param {import("./form.js").Sheet} sheet @param {Schema} item schema of a row @param {any[]} rows changed in place
 * @param {string} path JSON pointer of the list
 * @param {number} [count] where there are always so many rows
 */
export function table(sheet, item, rows, path, count) {
  const heads = columns(item, sheet.root);
  const seldom = heads.filter((head) => !head.required && rows.every((row) => empty(row[head.name])));
  // One column alone says too little of a row.
  const folded = heads.length - seldom.length >= FEWEST ? seldom : [];
  const kept = (/** @type {{name: string}} */ head) => (folded.some((one) => one.name === head.name) ? "seldom" : null);
  const line = (/** @type {Record<string, unknown>} */ row, /** @type {number} */ k) => [
    el(
      "tr",
      {},
      el("th", { scope: "row" }, k + 1),
      ...heads.map((head) =>
        el("td", { class: kept(head) }, cell(sheet, head, row, `${path}/${k}/${head.name}`, k, item)),
      ),
      el(
        "td",
        { class: "acts" },
        ...inDetail(sheet, item, row, k),
        count === undefined &&
          el(
            "button",
            {
              type: "button",
              class: "small",
              "aria-label": t`Remove row ${k + 1}`,
              onclick: () => {
                rows.splice(k, 1);
                sheet.rebuild();
              },
            },
            "×",
          ),
      ),
    ),
    ...more(sheet, item, row, `${path}/${k}`, heads.length + 2, k),
  ];
  const onpaste = (/** @type {ClipboardEvent} */ event) => {
    const text = event.clipboardData?.getData("text/plain") ?? "";
    // Lines that are pasted into a field of many lines are lines of its own.
    if (!/[\t\n]/.test(text.trim()) || event.target instanceof HTMLTextAreaElement) return;
    event.preventDefault();
    const at = /** @type {HTMLElement} */ (event.target).dataset.path ?? `${path}/${rows.length}/${heads[0].name}`;
    const [first, column] = at.slice(path.length + 1).split("/");
    paste(
      text,
      rows,
      Number(first),
      heads.slice(
        Math.max(
          0,
          heads.findIndex((head) => head.name === column),
        ),
      ),
      () => initial(item, sheet.root),
    );
    sheet.rebuild();
  };
  const columned = `${sheet.problem.kind}${path}`;
  const view = el(
    "div",
    { class: folded.length && !wide.has(columned) ? "table brief" : "table", onpaste },
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
              rows.push(rows.length ? structuredClone(rows[rows.length - 1]) : initial(item, sheet.root));
              sheet.rebuild();
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

/**
 * @param {import("./form.js").Sheet} sheet
 * @param {any} head
 * @param {any} row
 * @param {string} path
 * @param {number} k
 * @param {Schema} item
 */
function cell(sheet, head, row, path, k, item) {
  const options = alternatives(item, sheet.root);
  const option = options.length > 1 ? optionOf(options, row) : options[0];
  if (!option.properties[head.name]) return "";
  const set = (/** @type {unknown} */ value) => {
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
  } else if (head.kinded.control === "text") {
    control = textBox(value, head.schema.default, set, plain);
  } else if (typeof value === "object" && value !== null) return t`below`;
  else control = numberBox(value, head.schema.default, set);
  control.setAttribute("data-path", path);
  control.setAttribute("aria-label", t`${words(head.name)}, row ${k + 1}`);
  return control;
}

/** @param {import("./form.js").Sheet} sheet @param {Schema} item @param {any} row */
function optionAt(sheet, item, row) {
  const options = alternatives(item, sheet.root);
  return options.length > 1 ? optionOf(options, row) : options[0];
}

/** @param {unknown} value */
function structured(value) {
  return typeof value === "object" && value !== null;
}

/**
 * What of a row is more than a cell can state, in a row below it that opens.
 * @param {import("./form.js").Sheet} sheet
 * @param {Schema} item
 * @param {any} row
 * @param {string} path
 * @param {number} width columns
 * @param {number} k
 */
function more(sheet, item, row, path, width, k) {
  const option = optionAt(sheet, item, row);
  // What a cell can state as a number stands here only where it is stated in detail.
  const names = beyond(option, sheet.root).filter(
    (name) => kinded(option.properties[name], sheet.root).control !== "shapes" || structured(row[name]),
  );
  if (!names.length) return [];
  const stated = names.some((name) => structured(row[name]) && (!Array.isArray(row[name]) || row[name].length));
  const inside = el("div", { class: "fields" });
  const fill = () => {
    if (!inside.childElementCount)
      inside.append(...sheet.controls(option, row, path, names).filter((one) => one !== null));
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
 * @param {import("./form.js").Sheet} sheet
 * @param {Schema} item
 * @param {any} row
 * @param {number} k
 */
function inDetail(sheet, item, row, k) {
  const option = optionAt(sheet, item, row);
  return beyond(option, sheet.root).flatMap((name) => {
    const what = kinded(option.properties[name], sheet.root);
    if (what.control !== "shapes" || structured(row[name])) return [];
    const title = t`${words(name)} of row ${k + 1} in detail`;
    return [
      el(
        "button",
        {
          type: "button",
          class: "small",
          title,
          "aria-label": title,
          onclick: () => {
            row[name] = initial(what.options.find((one) => one.type === "object") ?? {}, sheet.root);
            sheet.rebuild();
          },
        },
        "⋯",
      ),
    ];
  });
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
