/** The studio: state a problem, follow its job, look at the answers. A client of the public API only. */

import { Unreadable, holds, sentIn } from "./address.js";
import * as api from "./api.js";
import * as answers from "./answers.js";
import { Backdrop } from "./backdrop.js";
import { CurveImport } from "./curve_import.js";
import { Desk } from "./desk.js";
import { byId, el } from "./dom.js";
import { draftOf, forgetDraft, keepDraft, lastKind, lastSteps } from "./drafts.js";
import * as faults from "./faults.js";
import { fill } from "./form.js";
import { Gallery, listed } from "./gallery.js";
import { Leader } from "./guide.js";
import { History } from "./history.js";
import { keymap } from "./keymap.js";
import { Keys } from "./keys.js";
import { Link } from "./link.js";
import { choose, language, languages, prose, t, translatePage, translated } from "./messages.js";
import { Opening } from "./opening.js";
import * as running from "./run.js";
import { misfit, plainly, spelling } from "./schema.js";
import { SentLinkage } from "./sent.js";
import { canvas } from "./targets.js";
import { Undo } from "./undo.js";

/** @import { Linked, Problem } from "./types/values.js" */

/** So long after the last change of the window's size the canvas is drawn anew. */
const RESIZED_MS = 150;

/** @type {api.Kind[]} */
let kinds = [];
/** @type {any} */
let problem = {};
/** @type {History} */
let history;
/** The statement that was posted last. @type {{id: string, problem: Problem | null}} */
let posted = { id: "", problem: null };
/** The statement whose answers are shown; null while there are none. @type {Problem | null} */
let answered = null;
/** @type {CurveImport | undefined} */
let imported;
/** @type {Gallery | undefined} */
let gallery;
/** Whether the gallery has been asked for before it was there. */
let wanted = false;

translatePage();

const fields = byId("fields");
const text = byId("json-text");
const desk = new Desk();
const opening = new Opening(desk, "Hatch lid");
/** What is shown until somebody states something. @type {{leave: () => void}} */
let guest = opening;
const undo = new Undo(
  (statement) => {
    vacate();
    if (statement.kind === problem.kind) {
      problem = statement;
      byId("example").value = "";
      show();
    } else begun(statement);
    drafted();
    if (answered === null) desk.stage.show("state");
  },
  byId("undo"),
  byId("redo"),
);

const backdrop = new Backdrop(() => fitted());

/** @param {unknown} error */
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
  if (sketch)
    canvas(byId("sketch"), problem, roomy(), (rebuilt) => edited({ form: rebuilt, sketch: rebuilt }), backdrop);
  if (sketch && !byId("sketch").childElementCount) outlined();
  if (json) {
    text.value = JSON.stringify(problem, null, 2);
    text.removeAttribute("aria-invalid");
    byId("json-error").replaceChildren();
  }
  compare();
}

/** What is not placed in the plane is shown as its example looks, so that the stage is not empty. */
async function outlined() {
  const { kind: of } = problem;
  const place = el(
    "div",
    { class: "said" },
    el(
      "p",
      { class: "note" },
      t`Nothing of this is placed in the plane: it is stated beside the stage. Solve shows it in motion.`,
    ),
  );
  byId("sketch").replaceChildren(place);
  // The example is chosen when its statement has been shown.
  await Promise.resolve();
  const picture = await gallery?.picture(`${of}-${byId("example").value || 0}`);
  if (picture && problem.kind === of && place.isConnected) place.prepend(picture);
}

/** Say so where the answers that are shown are not those to the statement as it is now. */
function compare() {
  const stale = answered !== null && spelt(answered) !== spelt(problem);
  byId("stale").hidden = !stale;
  byId("answers").classList.toggle("stale", stale);
}

/** A statement as it is compared with others. @param {Problem} statement */
function spelt(statement) {
  return spelling(statement, kinds.find((one) => one.kind === statement.kind)?.schema);
}

/** Make room for what is stated now. What came in the address is there again when one goes back. */
function vacate() {
  guest.leave();
  if (holds(location.hash)) window.history.pushState(null, "", location.pathname);
}

/** The job in the address; empty where there is none. */
function asked() {
  return /^#job=([0-9A-Z]{26})$/.exec(location.hash)?.[1] ?? "";
}

/** Keep the statement as it is now, unless the service has it as an example. */
function drafted() {
  const now = spelt(problem);
  if (examples().some((one) => spelt(one) === now)) forgetDraft(problem.kind);
  else keepDraft(problem, byId("label").value, undo.steps, answered === null ? "" : asked());
}

/** Go on with the statement that was left, or begin with the example. @param {string} of */
function resume(of) {
  const draft = draftOf(of);
  const chosen = kinds.find((one) => one.kind === of) ?? kinds[0];
  // It may have been stated on another version of the service.
  if (!draft || misfit(draft.problem, chosen.schema, chosen.schema) !== null) {
    begun(chosen.example);
    byId("example").value = "0";
    return;
  }
  begun(draft.problem);
  byId("label").value = draft.label;
  byId("draft").hidden = false;
}

/** The examples of the kind. @returns {Problem[]} */
function examples() {
  return kind().schema.examples ?? [kind().example];
}

/** Show what has been edited. @param {{form?: boolean, sketch?: boolean, json?: boolean}} parts */
function edited(parts) {
  byId("example").value = "";
  show(parts);
  undo.note(problem);
  drafted();
  vacate();
  if (answered === null) desk.stage.show("state");
}

/** Begin with another statement. @param {Problem} statement @param {boolean} [solved] at once */
function state(statement, solved = false) {
  vacate();
  begun(statement);
  desk.stage.show("state");
  if (solved) solve();
}

/** Have another statement in the form and on the canvas. @param {Problem} statement */
function begun(statement) {
  problem = structuredClone(statement);
  undo.note(problem, true);
  byId("draft").hidden = true;
  introduce();
  faults.clear(fields, byId("faults"));
  fields.replaceChildren();
  show();
}

/** The kind, its examples, and what it is about. */
function introduce() {
  byId("kind").value = problem.kind;
  byId("example").replaceChildren(
    el("option", { value: "" }, t`as edited`),
    ...examples().map((_, /** @type {number} */ n) => el("option", { value: n }, translated(kind().examples[n].name))),
  );
  const now = spelt(problem);
  const n = examples().findIndex((one) => spelt(one) === now);
  byId("example").value = n < 0 ? "" : String(n);
  byId("about").textContent = prose(kind().description);
}

function choices() {
  const pick = el(
    "select",
    {
      id: "kind",
      onchange: () => {
        vacate();
        resume(pick.value);
        desk.stage.show("state");
      },
    },
    ...kinds.map((one) => el("option", { value: one.kind }, translated(one.title))),
  );
  const example = el("select", {
    id: "example",
    onchange: () => {
      if (example.value === "") return;
      const chosen = example.value;
      state(examples()[Number(chosen)]);
      example.value = chosen;
    },
  });
  byId("choices").replaceChildren(
    el(
      "div",
      { class: "choices" },
      el("label", { for: "kind" }, t`Kind`),
      pick,
      el("label", { for: "example" }, t`Example`),
      example,
    ),
    el(
      "p",
      { class: "note", id: "draft", hidden: true },
      t`Your draft, as you left it.`,
      " ",
      el(
        "button",
        {
          type: "button",
          class: "small",
          onclick: () => {
            forgetDraft(problem.kind);
            state(kind().example);
            example.value = "0";
          },
        },
        t`Back to the example`,
      ),
    ),
    el("p", { class: "note", id: "about" }),
  );
}

async function solve() {
  const button = byId("solve");
  button.disabled = true;
  busy(true);
  tell("");
  faults.clear(fields, byId("faults"));
  try {
    const statement = structuredClone(problem);
    const job = await api.solve(statement, byId("label").value || null);
    posted = { id: job.id, problem: statement };
    desk.drawer.select("answers");
    const note = el("p", { class: "note" }, t`Designs stand here as soon as they are found.`);
    if (answered === null) byId("result").replaceChildren(note);
    location.hash = `job=${job.id}`;
  } catch (error) {
    busy(false);
    desk.drawer.select("task");
    if (folded()) unfold(true);
    if (error instanceof api.Refused) faults.tell(fields, byId("faults"), error);
    else tell(error);
  } finally {
    button.disabled = false;
  }
}

/** An answer is awaited: what is shown of the one before is faint. @param {boolean} is */
function busy(is) {
  for (const place of [byId("answers"), byId("watch"), byId("numbers"), byId("beside")]) {
    if (is) place.setAttribute("aria-busy", "true");
    else place.removeAttribute("aria-busy");
  }
}

/** Show what the address holds: its statement, and its linkage as this service drives it. */
async function unpack() {
  const fragment = location.hash;
  try {
    const sent = await sentIn(fragment, kinds);
    if (location.hash !== fragment) return;
    guest.leave();
    running.leave(byId("progress"));
    answers.leave(byId("result"), desk);
    busy(false);
    answered = null;
    posted = { id: "", problem: null };
    begun(sent.problem);
    byId("label").value = sent.label;
    byId("result").replaceChildren(
      el("p", { class: "note" }, t`This statement came in the address. Solve finds its answers.`),
    );
    desk.stage.show("state");
    const linkage = new SentLinkage(desk, sent, state);
    guest = linkage;
    await linkage.show().catch((error) => {
      throw new Unreadable(t`The linkage in the address is not shown: ${error.errors?.[0]?.detail ?? error.message}`);
    });
  } catch (error) {
    tell(error);
  }
}

/**
 * What had been edited of the statement of a job, beside its answers, is as it was left.
 * @param {string} job
 */
function editedBeside(job) {
  const draft = draftOf(problem.kind);
  const { schema } = kind();
  if (draft?.job === job && misfit(draft.problem, schema, schema) === null && spelt(draft.problem) !== spelt(problem))
    begun(draft.problem);
}

/**
 * Show what the address names: a job with its problem, its progress and its answer, or what has been sent.
 * @param {boolean} [reloaded] whether the page has just been opened
 */
async function restore(reloaded = false) {
  if (holds(location.hash)) {
    tell("");
    return unpack();
  }
  const id = asked();
  if (!id) return;
  tell("");
  running.leave(byId("progress"));
  busy(true);
  try {
    let job = await api.job(id);
    if (posted.id !== id) {
      state(plainly(job.problem, kinds.find((one) => one.kind === job.problem.kind)?.schema));
    }
    answered = posted.id === id ? posted.problem : structuredClone(problem);
    if (reloaded) editedBeside(id);
    compare();
    byId("label").value = job.label ?? "";
    if (["queued", "running"].includes(job.status)) {
      history.load().catch(tell);
      const ended = await running.run(byId("progress"), id);
      if (location.hash !== `#job=${id}`) return;
      if (!ended) return busy(false);
      job = ended;
    }
    busy(false);
    guest.leave();
    answers.answer(byId("result"), desk, job, state, (statement) => {
      begun(statement);
      solve();
    });
    // Where what had the focus is hidden now, the keys go on at the answers.
    if (posted.id === id && document.activeElement === document.body) byId("answers").focus({ preventScroll: true });
    history.load().catch(tell);
  } catch (error) {
    busy(false);
    tell(error);
  }
}

/** Leave the job that is shown: what is stated next has no answers yet. */
function left() {
  running.leave(byId("progress"));
  busy(false);
  answered = null;
  answers.leave(byId("result"), desk);
  desk.stage.offer(false);
  byId("result").replaceChildren(el("p", { class: "note" }, t`State a problem, or take an example, and solve it.`));
  window.history.replaceState(null, "", location.pathname);
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
  imported ??= new CurveImport(
    byId("import"),
    backdrop,
    () => ({ problem, roomy: roomy() }),
    () => edited({}),
  );
  history = new History(byId("jobs"), kinds);
  gallery = new Gallery(kinds, (example) => {
    state(example.problem);
    byId("example").value = String(example.n);
    byId("label").value = translated(example.name);
    solve();
  });
  const leader = new Leader({
    desk,
    problem: () => problem,
    answered: () => answered !== null && byId("stale").hidden && !byId("answers").hasAttribute("aria-busy"),
    state: (of, name) => {
      const example = listed(kinds).find((one) => one.kind === of && one.name === name);
      if (!example) return;
      left();
      state(example.problem);
      byId("example").value = String(example.n);
      byId("label").value = translated(name);
    },
  });
  byId("guides").replaceChildren(
    el("p", { class: "note" }, t`Guided, a minute each`),
    ...leader.list(() => gallery?.dialog.close()),
  );
  if (wanted) gallery.open();
  opening.measured();
  const last = location.hash ? "" : lastKind();
  resume(last || kinds[0].kind);
  if (last) undo.resume(lastSteps());
  history.load().catch(tell);
  await restore(true);
}

fields.addEventListener("submit", (/** @type {Event} */ event) => {
  event.preventDefault();
  solve();
});

/** Open the gallery, as soon as the service has said what it has. */
function browse() {
  wanted = !gallery;
  gallery?.open();
}

/** What a link to this page as it is now holds. @returns {import("./address.js").Sent} */
function sending() {
  // What answers an earlier statement is no part of this one.
  const design = byId("stale").hidden ? desk.shown : null;
  const { type, skeleton, driven_by } = design?.mechanism ?? {};
  return {
    problem,
    label: byId("label").value,
    placed: Boolean(design?.placement),
    mechanism: skeleton ? /** @type {Linked} */ ({ type, skeleton, ...(driven_by && { driven_by }) }) : null,
  };
}

const link = new Link(byId("link"), byId("link-told"), sending);

/** Whether the task is folded away. */
function folded() {
  return byId("fold").getAttribute("aria-expanded") === "false";
}

/** Fold the task away, or show it: in a narrow window it takes a third of the stage's room. @param {boolean} open */
function unfold(open) {
  byId("fold").setAttribute("aria-expanded", String(open));
  fitted();
}

/** Draw what is stated as large as there is room now. */
function fitted() {
  if (kinds.length) show({ form: false, json: false });
}

/** @type {Keys} */
const keys = new Keys(keymap({ answers, desk, undo, solve, browse, link, sheet: () => keys.open() }));
byId("stale-solve").addEventListener("click", () => solve());
byId("stale-back").addEventListener("click", () => {
  if (!answered) return;
  begun(answered);
  drafted();
});
byId("fold").addEventListener("click", () => unfold(folded()));
byId("gallery-open").addEventListener("click", () => browse());
byId("keys-open").addEventListener("click", () => keys.open());
text.addEventListener("input", () => {
  try {
    const stated = JSON.parse(text.value);
    if (!kinds.some((one) => one.kind === stated?.kind)) throw new SyntaxError(t`“kind” must name a kind of problem.`);
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
byId("key")
  .querySelector("form")
  .addEventListener("submit", (/** @type {Event} */ event) => {
    event.preventDefault();
    api.useKey(byId("key-value").value.trim());
    byId("key-value").value = "";
    byId("key").open = false;
    begin();
  });
byId("language").replaceChildren(
  ...Object.entries(languages).map(([code, { name }]) =>
    el("option", { value: code, lang: code, selected: code === language }, `${code.toUpperCase()} · ${name}`),
  ),
);
byId("language").addEventListener("change", () => choose(byId("language").value));
window.addEventListener("hashchange", () => restore());
let resizing = 0;
window.addEventListener("resize", () => {
  clearTimeout(resizing);
  resizing = setTimeout(fitted, RESIZED_MS);
});
byId("label").addEventListener("input", () => {
  if (draftOf(problem.kind)) drafted();
});
if (!location.hash && !lastKind()) opening.show();
begin();
