/** The studio: state a problem, follow its job, look at the answers. A client of the public API only. */

import * as api from "./api.js";
import * as answers from "./answers.js";
import { Backdrop } from "./backdrop.js";
import { CurveImport } from "./curve_import.js";
import { byId, el } from "./dom.js";
import * as faults from "./faults.js";
import { fill } from "./form.js";
import { History } from "./history.js";
import * as running from "./run.js";
import { canvas } from "./targets.js";

/** @type {api.Kind[]} */
let kinds = [];
/** @type {any} */
let problem = {};
/** @type {History} */
let history;
/** The statement that was posted last. @type {{id: string, problem: any}} */
let posted = { id: "", problem: null };
/** The statement whose answers are shown; null while there are none. @type {any} */
let answered = null;
/** @type {CurveImport | undefined} */
let imported;

const fields = byId("fields");
const text = byId("json-text");

const backdrop = new Backdrop(() => {
  if (kinds.length) show({ form: false, json: false });
});

/** @param {any} error */
function tell(error) {
  byId("status").textContent = error instanceof Error ? error.message : String(error ?? "");
}

/** The kind of the problem that is being stated. */
function kind() {
  return kinds.find((one) => one.kind === problem.kind) ?? kinds[0];
}

/** Whether the problem may state the room. */
function roomy() {
  return "space" in kind().schema.properties;
}

/**
 * Show the problem in the form, on the canvas and as JSON; where it was changed stays as it is.
 * @param {{form?: boolean, sketch?: boolean, json?: boolean}} [parts]
 */
function show({ form = true, sketch = true, json = true } = {}) {
  if (form) fill(fields, kind().schema, problem, (rebuilt) => edited({ form: rebuilt }));
  if (sketch) canvas(byId("sketch"), problem, roomy(), (rebuilt) => edited({ form: rebuilt, sketch: rebuilt }), backdrop);
  if (json) {
    text.value = JSON.stringify(problem, null, 2);
    text.removeAttribute("aria-invalid");
    byId("json-error").replaceChildren();
  }
  compare();
}

/** Say so where the answers that are shown are not those to the statement as it is now. */
function compare() {
  byId("stale").hidden = answered === null || spelt(answered) === spelt(problem);
}

/** A statement in one spelling: fields in order, without the empty groups in which the form has room for fields. @param {any} statement */
function spelt(statement) {
  const group = (/** @type {any} */ value) => typeof value === "object" && value !== null && !Array.isArray(value);
  return JSON.stringify(statement, (_, value) => group(value)
    ? Object.fromEntries(Object.entries(value).filter(([, inner]) => !group(inner) || Object.keys(inner).length).sort()) : value);
}

/** Show what has been edited. @param {{form?: boolean, sketch?: boolean, json?: boolean}} parts */
function edited(parts) {
  byId("example").value = "";
  show(parts);
}

/** Begin with another statement. @param {any} statement */
function state(statement) {
  problem = structuredClone(statement);
  introduce();
  faults.clear(fields, byId("faults"));
  fields.replaceChildren();
  show();
}

/** The kind, its examples, and what it is about. */
function introduce() {
  byId("kind").value = problem.kind;
  const examples = kind().schema.examples ?? [kind().example];
  byId("example").replaceChildren(el("option", { value: "" }, "as edited"),
    ...examples.map((/** @type {any} */ _, /** @type {number} */ n) => el("option", { value: n }, `Example ${n + 1}`)));
  byId("about").textContent = kind().description.split("\n\n")[0].replaceAll("\n", " ");
}

function choices() {
  const pick = el("select", { id: "kind", onchange: () => {
    const chosen = kinds.find((one) => one.kind === pick.value) ?? kinds[0];
    state(chosen.example);
    byId("example").value = "0";
  } }, ...kinds.map((one) => el("option", { value: one.kind }, one.title)));
  const example = el("select", { id: "example", onchange: () => {
    if (example.value === "") return;
    const chosen = example.value;
    state((kind().schema.examples ?? [kind().example])[Number(chosen)]);
    example.value = chosen;
  } });
  byId("choices").replaceChildren(
    el("div", { class: "row" }, el("label", { for: "kind" }, "Kind"), pick, el("label", { for: "example" }, "Example"), example),
    el("p", { class: "note", id: "about" }));
}

async function solve() {
  const button = byId("solve");
  button.disabled = true;
  tell("");
  faults.clear(fields, byId("faults"));
  try {
    const statement = structuredClone(problem);
    const job = await api.solve(statement, byId("label").value || null);
    posted = { id: job.id, problem: statement };
    location.hash = `job=${job.id}`;
  } catch (error) {
    if (error instanceof api.Refused) faults.tell(fields, byId("faults"), error);
    else tell(error);
  } finally {
    button.disabled = false;
  }
}

/** Show the job that the address names: its problem, its progress, its answer. */
async function restore() {
  const id = /^#job=([0-9A-Z]{26})$/.exec(location.hash)?.[1];
  if (!id) return;
  tell("");
  running.leave(byId("progress"));
  answers.leave(byId("result"));
  try {
    let job = await api.job(id);
    if (posted.id !== id) state(job.problem);
    answered = posted.id === id ? posted.problem : structuredClone(problem);
    compare();
    byId("label").value = job.label ?? "";
    if (["queued", "running"].includes(job.status)) {
      history.load().catch(tell);
      const ended = await running.run(byId("progress"), id);
      if (!ended) return;
      job = ended;
    }
    answers.answer(byId("result"), job, state);
    history.load().catch(tell);
  } catch (error) {
    tell(error);
  }
}

async function begin() {
  try {
    kinds = await api.kinds();
  } catch (error) {
    if (error instanceof api.Refused && error.status === 401) byId("key").open = true;
    return tell(error);
  }
  tell("");
  choices();
  imported ??= new CurveImport(byId("import"), backdrop, () => ({ problem, roomy: roomy() }), () => edited({}));
  history = new History(byId("jobs"), kinds);
  state(kinds[0].example);
  byId("example").value = "0";
  history.load().catch(tell);
  await restore();
}

fields.addEventListener("submit", (/** @type {Event} */ event) => {
  event.preventDefault();
  solve();
});
text.addEventListener("input", () => {
  try {
    const stated = JSON.parse(text.value);
    if (!kinds.some((one) => one.kind === stated?.kind)) throw new SyntaxError("“kind” must name a kind of problem.");
    const other = stated.kind !== problem.kind;
    problem = stated;
    text.removeAttribute("aria-invalid");
    byId("json-error").replaceChildren();
    if (other) introduce();
    edited({ json: false });
  } catch (error) {
    text.setAttribute("aria-invalid", "true");
    byId("json-error").textContent = /** @type {Error} */ (error).message;
  }
});
byId("key").querySelector("form").addEventListener("submit", (/** @type {Event} */ event) => {
  event.preventDefault();
  api.useKey(byId("key-value").value.trim());
  byId("key-value").value = "";
  byId("key").open = false;
  begin();
});
window.addEventListener("hashchange", restore);
begin();
