/** The studio: state a problem, follow its job, look at the answers. A client of the public API only. */

import { Unreadable, holds, sentIn } from "./core/address_fragment.js";
import * as api from "./core/api.js";
import * as answers from "./answers/answers.js";
import { Backdrop } from "./canvas/backdrop.js";
import { CurveImport } from "./canvas/curve_import.js";
import { Desk } from "./design/workbench.js";
import { byId, el } from "./core/dom.js";
import { draftOf, forgetDraft, keepDraft, lastKind, lastSteps } from "./core/drafts.js";
import { Gallery, listed } from "./task/gallery.js";
import { Leader } from "./task/guide.js";
import { History } from "./task/job_history.js";
import { keymap } from "./page/keymap.js";
import { Keys } from "./page/keyboard.js";
import { Link } from "./page/copy_link.js";
import { choose, language, languages, t, translatePage, translated } from "./core/messages.js";
import { Opening } from "./task/opening_example.js";
import * as running from "./task/job_progress.js";
import { SentLinkage } from "./task/shared_linkage.js";
import { Store } from "./core/store.js";
import { Task } from "./task/task.js";

/** @import { Linked, Problem } from "./types/values.js" */

/** @type {History} */
let history;
/** @type {CurveImport | undefined} */
let imported;
/** @type {Gallery | undefined} */
let gallery;
/** Whether the gallery has been asked for before it was there. */
let wanted = false;

translatePage();

const desk = new Desk();
const opening = new Opening(desk, "Hatch lid");
/** What is shown until somebody states something. @type {{leave: () => void}} */
let guest = opening;

const label = byId("label", HTMLInputElement);
const store = new Store();
const backdrop = new Backdrop(() => task.draw());
/** @type {Task} */
const task = new Task(store, backdrop, {
  solve,
  state,
  resume: (kind) => {
    vacate();
    resume(kind);
    desk.stage.show("state");
  },
  picture: (name) => gallery?.picture(name),
});
store.listen(({ edited }) => {
  const { stale } = store;
  byId("stale").hidden = !stale;
  byId("answers").classList.toggle("stale", stale);
  byId("undo", HTMLButtonElement).disabled = !store.past.steps.past.length;
  byId("redo", HTMLButtonElement).disabled = !store.past.steps.future.length;
  if (!edited) return;
  drafted();
  vacate();
  if (store.answered === null) desk.stage.show("state");
});

/** @param {unknown} error */
function tell(error) {
  byId("status").textContent = error instanceof Error ? error.message : String(error ?? "");
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
  const { problem } = store;
  if (store.example >= 0) forgetDraft(problem.kind);
  else keepDraft(problem, label.value, store.past.steps, store.answered === null ? "" : asked());
}

/**
 * Go on with the statement that was left, or begin with the example.
 * @param {string} kind
 * @param {import("./core/undo.js").Steps} [steps] that led to it
 */
function resume(kind, steps) {
  const draft = draftOf(kind);
  // It may have been stated on another version of the service.
  if (!draft || !store.fits(draft.problem)) {
    store.begin((store.kinds.find((one) => one.kind === kind) ?? store.kinds[0]).example);
    return;
  }
  store.begin(draft.problem, steps);
  label.value = draft.label;
  byId("draft").hidden = false;
}

/** Begin with another statement. @param {Problem} statement @param {boolean} [solved] at once */
function state(statement, solved = false) {
  vacate();
  store.begin(statement);
  desk.stage.show("state");
  if (solved) solve();
}

async function solve() {
  const button = byId("solve", HTMLButtonElement);
  button.disabled = true;
  busy(true);
  tell("");
  task.clear();
  try {
    const statement = store.problem;
    const job = await api.solve(statement, label.value || null);
    store.post(job.id, statement);
    desk.drawer.select("answers");
    const note = el("p", { class: "note" }, t`Designs stand here as soon as they are found.`);
    if (store.answered === null) byId("result").replaceChildren(note);
    location.hash = `job=${job.id}`;
  } catch (error) {
    busy(false);
    desk.drawer.select("task");
    if (error instanceof api.Refused) task.refused(error);
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
    const sent = await sentIn(fragment, store.kinds);
    if (location.hash !== fragment) return;
    guest.leave();
    running.leave(byId("progress"));
    answers.leave(byId("result"), desk);
    busy(false);
    store.forget();
    store.begin(sent.problem);
    label.value = sent.label;
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
  const draft = draftOf(store.problem.kind);
  if (draft?.job === job && store.fits(draft.problem) && store.spelt(draft.problem) !== store.spelt(store.problem))
    store.begin(draft.problem);
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
    if (store.posted.id !== id) state(store.plain(job.problem));
    store.answer(id);
    if (reloaded) editedBeside(id);
    label.value = job.label ?? "";
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
      store.begin(statement);
      solve();
    });
    // Where what had the focus is hidden now, the keys go on at the answers.
    if (store.posted.id === id && document.activeElement === document.body)
      byId("answers").focus({ preventScroll: true });
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
  store.forget();
  answers.leave(byId("result"), desk);
  desk.stage.offer(false);
  byId("result").replaceChildren(el("p", { class: "note" }, t`State a problem, or take an example, and solve it.`));
  window.history.replaceState(null, "", location.pathname);
}

/** Begin with an example, by the name that it has in the gallery. @param {{problem: Problem, name: string}} example */
function exemplify({ problem, name }) {
  state(problem);
  label.value = translated(name);
}

async function begin() {
  try {
    store.kinds = await api.kinds();
  } catch (error) {
    if (error instanceof api.Refused && error.status === 401) byId("key", HTMLDetailsElement).open = true;
    return tell(error);
  }
  tell("");
  task.choices();
  imported ??= new CurveImport(byId("import"), backdrop, store);
  history = new History(byId("jobs"), store.kinds);
  gallery = new Gallery(store.kinds, (example) => {
    exemplify(example);
    solve();
  });
  const leader = new Leader({
    desk,
    problem: () => store.problem,
    answered: () => store.answered !== null && !store.stale && !byId("answers").hasAttribute("aria-busy"),
    state: (kind, name) => {
      const example = listed(store.kinds).find((one) => one.kind === kind && one.name === name);
      if (!example) return;
      left();
      exemplify(example);
    },
  });
  byId("guides").replaceChildren(
    el("p", { class: "note" }, t`Guided, a minute each`),
    ...leader.list(() => gallery?.dialog.close()),
  );
  if (wanted) gallery.open();
  opening.measured();
  const last = location.hash ? "" : lastKind();
  resume(last || store.kinds[0].kind, last ? lastSteps() : undefined);
  history.load().catch(tell);
  await restore(true);
}

/** Open the gallery, as soon as the service has said what it has. */
function browse() {
  wanted = !gallery;
  gallery?.open();
}

/** What a link to this page as it is now holds. @returns {import("./core/address_fragment.js").Sent} */
function sending() {
  // What answers an earlier statement is no part of this one.
  const design = store.stale ? null : desk.shown;
  const { type, skeleton, driven_by } = design?.mechanism ?? {};
  return {
    problem: store.problem,
    label: label.value,
    placed: Boolean(design?.placement),
    mechanism: skeleton ? /** @type {Linked} */ ({ type, skeleton, ...(driven_by && { driven_by }) }) : null,
  };
}

const link = new Link(byId("link"), byId("link-told"), sending);

/** @type {Keys} */
const keys = new Keys(keymap({ answers, desk, store, solve, browse, link, sheet: () => keys.open() }));
byId("undo", HTMLButtonElement).addEventListener("click", () => store.undo());
byId("redo", HTMLButtonElement).addEventListener("click", () => store.redo());
byId("stale-solve").addEventListener("click", () => solve());
byId("stale-back").addEventListener("click", () => {
  if (!store.answered) return;
  store.begin(store.answered);
  drafted();
});
byId("gallery-open").addEventListener("click", () => browse());
byId("keys-open").addEventListener("click", () => keys.open());
byId("key-form").addEventListener("submit", (event) => {
  event.preventDefault();
  api.useKey(byId("key-value", HTMLInputElement).value.trim());
  byId("key-value", HTMLInputElement).value = "";
  byId("key", HTMLDetailsElement).open = false;
  begin();
});
byId("language", HTMLSelectElement).replaceChildren(
  ...Object.entries(languages).map(([code, { name }]) =>
    el("option", { value: code, lang: code, selected: code === language }, `${code.toUpperCase()} · ${name}`),
  ),
);
byId("language", HTMLSelectElement).addEventListener("change", () => choose(byId("language", HTMLSelectElement).value));
window.addEventListener("hashchange", () => restore());
label.addEventListener("input", () => {
  if (draftOf(store.problem.kind)) drafted();
});
if (!location.hash && !lastKind()) opening.show();
begin();
