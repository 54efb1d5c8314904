/** The studio: edit a problem, follow its job, inspect the answers. It uses the public API only. */

import { UnreadableAddress, holdsStatement, decodeFragment } from "./core/address_fragment.js";
import * as api from "./core/api.js";
import * as answers from "./answers/answers.js";
import { Backdrop } from "./canvas/backdrop.js";
import { CurveImport } from "./canvas/curve_import.js";
import { Workbench } from "./design/workbench.js";
import { byId, createElement } from "./core/dom.js";
import { readDraft, forgetDraft, keepDraft, readLastKind, readLastSteps } from "./core/drafts.js";
import { Gallery, listExamples } from "./task/gallery.js";
import { GuideRunner } from "./task/guide.js";
import { JobHistory } from "./task/job_history.js";
import { listBindings } from "./page/keymap.js";
import { Keyboard } from "./page/keyboard.js";
import { CopyLink } from "./page/copy_link.js";
import { switchLanguage, language, languages, t, translatePage, translate } from "./core/messages.js";
import { OpeningExample } from "./task/opening_example.js";
import * as running from "./task/job_progress.js";
import { SharedLinkage } from "./task/shared_linkage.js";
import { Store } from "./core/store.js";
import { TaskPane } from "./task/task.js";

/** @import { Linked, Problem } from "./types/values.js" */

/** @type {JobHistory} */
let jobHistory;
/** @type {CurveImport | undefined} */
let curveImport;
/** @type {Gallery | undefined} */
let gallery;
/** Whether the gallery was requested before it was loaded. */
let galleryWanted = false;

translatePage();

const workbench = new Workbench();
const opening = new OpeningExample(workbench, "Hatch lid");
/** The view that is shown until a problem is entered. @type {{leave: () => void}} */
let openingView = opening;

const jobLabel = byId("label", HTMLInputElement);
const store = new Store();
const backdrop = new Backdrop(() => task.draw());
/** @type {TaskPane} */
const task = new TaskPane(store, backdrop, {
  solve: solveStatement,
  state: beginStatement,
  resume: (kind) => {
    clearGuest();
    resume(kind);
    workbench.stage.showMode("state");
  },
  picture: (name) => gallery?.findPicture(name),
});
store.listen(({ edited }) => {
  const { stale } = store;
  byId("stale").hidden = !stale;
  byId("answers").classList.toggle("stale", stale);
  byId("undo", HTMLButtonElement).disabled = !store.past.steps.past.length;
  byId("redo", HTMLButtonElement).disabled = !store.past.steps.future.length;
  if (!edited) return;
  saveDraft();
  clearGuest();
  if (store.answered === null) workbench.stage.showMode("state");
});

/** @param {unknown} error */
function showError(error) {
  byId("status").textContent = error instanceof Error ? error.message : String(error ?? "");
}

/** Clear the view for the current problem. The browser's Back returns to the linkage from the address. */
function clearGuest() {
  openingView.leave();
  if (holdsStatement(location.hash)) window.history.pushState(null, "", location.pathname);
}

/** The job in the address; empty where there is none. */
function addressedJob() {
  return /^#job=([0-9A-Z]{26})$/.exec(location.hash)?.[1] ?? "";
}

/** Keep the statement as it is now, unless the service has it as an example. */
function saveDraft() {
  const { problem } = store;
  if (store.example >= 0) forgetDraft(problem.kind);
  else keepDraft(problem, jobLabel.value, store.past.steps, store.answered === null ? "" : addressedJob());
}

/**
 * Go on with the statement that was left, or begin with the example.
 * @param {string} kind
 * @param {import("./core/undo.js").Steps} [steps] that led to it
 */
function resume(kind, steps) {
  const draft = readDraft(kind);
  // The draft may be from another version of the service.
  if (!draft || !store.matchesSchema(draft.problem)) {
    store.begin((store.kinds.find((one) => one.kind === kind) ?? store.kinds[0]).example);
    return;
  }
  store.begin(draft.problem, steps);
  jobLabel.value = draft.label;
  byId("draft").hidden = false;
}

/** Start with another problem. @param {Problem} statement @param {boolean} [solved] at once */
function beginStatement(statement, solved = false) {
  clearGuest();
  store.begin(statement);
  workbench.stage.showMode("state");
  if (solved) solveStatement();
}

async function solveStatement() {
  const button = byId("solve", HTMLButtonElement);
  button.disabled = true;
  markBusy(true);
  showError("");
  task.clearErrors();
  try {
    const statement = store.problem;
    const job = await api.submitJob(statement, jobLabel.value || null);
    store.recordSubmission(job.id, statement);
    workbench.drawer.selectTab("answers");
    const note = createElement("p", { class: "note" }, t`Designs appear here as soon as they are found.`);
    if (store.answered === null) byId("result").replaceChildren(note);
    location.hash = `job=${job.id}`;
  } catch (error) {
    markBusy(false);
    workbench.drawer.selectTab("task");
    if (error instanceof api.Refusal) task.showRefusal(error);
    else showError(error);
  } finally {
    button.disabled = false;
  }
}

/** Mark that an answer is awaited: the previous one is shown faintly. @param {boolean} is */
function markBusy(is) {
  for (const place of [byId("answers"), byId("watch"), byId("numbers"), byId("beside")]) {
    if (is) place.setAttribute("aria-busy", "true");
    else place.removeAttribute("aria-busy");
  }
}

/** Show what the address holds: its statement, and its linkage as this service drives it. */
async function openFragment() {
  const fragment = location.hash;
  try {
    const sent = await decodeFragment(fragment, store.kinds);
    if (location.hash !== fragment) return;
    openingView.leave();
    running.stopFollowing(byId("progress"));
    answers.clearAnswers(byId("result"), workbench);
    markBusy(false);
    store.forgetAnswer();
    store.begin(sent.problem);
    jobLabel.value = sent.label;
    byId("result").replaceChildren(
      createElement("p", { class: "note" }, t`This problem came in the address. Press Solve to find designs.`),
    );
    workbench.stage.showMode("state");
    const linkage = new SharedLinkage(workbench, sent, beginStatement);
    openingView = linkage;
    await linkage.show().catch((error) => {
      throw new UnreadableAddress(
        t`The linkage in the address is not shown: ${error.errors?.[0]?.detail ?? error.message}`,
      );
    });
  } catch (error) {
    showError(error);
  }
}

/**
 * What had been edited of the statement of a job, beside its answers, is as it was left.
 * @param {string} job
 */
function restoreDraft(job) {
  const draft = readDraft(store.problem.kind);
  if (
    draft?.job === job &&
    store.matchesSchema(draft.problem) &&
    store.canonicalText(draft.problem) !== store.canonicalText(store.problem)
  )
    store.begin(draft.problem);
}

/**
 * Show what the address names: a job with its problem, its progress and its answer, or what has been sent.
 * @param {boolean} [reloaded] whether the page has just been opened
 */
async function openAddress(reloaded = false) {
  if (holdsStatement(location.hash)) {
    showError("");
    return openFragment();
  }
  const id = addressedJob();
  if (!id) return;
  showError("");
  running.stopFollowing(byId("progress"));
  markBusy(true);
  try {
    let job = await api.fetchJob(id);
    if (store.posted.id !== id) beginStatement(store.removeDefaults(job.problem));
    store.recordAnswer(id);
    if (reloaded) restoreDraft(id);
    jobLabel.value = job.label ?? "";
    if (["queued", "running"].includes(job.status)) {
      jobHistory.load().catch(showError);
      const ended = await running.showJob(byId("progress"), id);
      if (location.hash !== `#job=${id}`) return;
      if (!ended) return markBusy(false);
      job = ended;
    }
    markBusy(false);
    openingView.leave();
    answers.showAnswer(byId("result"), workbench, job, beginStatement, (statement) => {
      store.begin(statement);
      solveStatement();
    });
    // Where what had the focus is hidden now, the keys go on at the answers.
    if (store.posted.id === id && document.activeElement === document.body)
      byId("answers").focus({ preventScroll: true });
    jobHistory.load().catch(showError);
  } catch (error) {
    markBusy(false);
    showError(error);
  }
}

/** Leave the shown job: the next problem has no answers yet. */
function leaveJob() {
  running.stopFollowing(byId("progress"));
  markBusy(false);
  store.forgetAnswer();
  answers.clearAnswers(byId("result"), workbench);
  workbench.stage.offerMotion(false);
  byId("result").replaceChildren(
    createElement("p", { class: "note" }, t`Enter a problem or choose an example, then solve it.`),
  );
  window.history.replaceState(null, "", location.pathname);
}

/** Begin with an example, by the name that it has in the gallery. @param {{problem: Problem, name: string}} example */
function openExample({ problem, name }) {
  beginStatement(problem);
  jobLabel.value = translate(name);
}

async function start() {
  try {
    store.kinds = await api.fetchKinds();
  } catch (error) {
    if (error instanceof api.Refusal && error.status === 401) byId("key", HTMLDetailsElement).open = true;
    return showError(error);
  }
  showError("");
  task.createChoices();
  curveImport ??= new CurveImport(byId("import"), backdrop, store);
  jobHistory = new JobHistory(byId("jobs"), store.kinds);
  gallery = new Gallery(store.kinds, (example) => {
    openExample(example);
    solveStatement();
  });
  const leader = new GuideRunner({
    desk: workbench,
    problem: () => store.problem,
    answered: () => store.answered !== null && !store.stale && !byId("answers").hasAttribute("aria-busy"),
    state: (kind, name) => {
      const example = listExamples(store.kinds).find((one) => one.kind === kind && one.name === name);
      if (!example) return;
      leaveJob();
      openExample(example);
    },
  });
  byId("guides").replaceChildren(
    createElement("p", { class: "note" }, t`Guided tasks of one minute`),
    ...leader.createButtons(() => gallery?.dialog.close()),
  );
  if (galleryWanted) gallery.open();
  opening.addUnits();
  const last = location.hash ? "" : readLastKind();
  resume(last || store.kinds[0].kind, last ? readLastSteps() : undefined);
  jobHistory.load().catch(showError);
  await openAddress(true);
}

/** Open the gallery, as soon as the service has said what it has. */
function openGallery() {
  galleryWanted = !gallery;
  gallery?.open();
}

/** What a link to this page as it is now holds. @returns {import("./core/address_fragment.js").SharedContent} */
function collectShared() {
  // What answers an earlier statement is no part of this one.
  const design = store.stale ? null : workbench.shown;
  const { type, skeleton, driven_by } = design?.mechanism ?? {};
  return {
    problem: store.problem,
    label: jobLabel.value,
    placed: Boolean(design?.placement),
    mechanism: skeleton ? /** @type {Linked} */ ({ type, skeleton, ...(driven_by && { driven_by }) }) : null,
  };
}

const link = new CopyLink(byId("link"), byId("link-told"), collectShared);

/** @type {Keyboard} */
const keys = new Keyboard(
  listBindings({
    answers,
    desk: workbench,
    store,
    solve: solveStatement,
    browse: openGallery,
    link,
    sheet: () => keys.open(),
  }),
);
byId("undo", HTMLButtonElement).addEventListener("click", () => store.undo());
byId("redo", HTMLButtonElement).addEventListener("click", () => store.redo());
byId("stale-solve").addEventListener("click", () => solveStatement());
byId("stale-back").addEventListener("click", () => {
  if (!store.answered) return;
  store.begin(store.answered);
  saveDraft();
});
byId("gallery-open").addEventListener("click", () => openGallery());
byId("keys-open").addEventListener("click", () => keys.open());
byId("key-form").addEventListener("submit", (event) => {
  event.preventDefault();
  api.writeKey(byId("key-value", HTMLInputElement).value.trim());
  byId("key-value", HTMLInputElement).value = "";
  byId("key", HTMLDetailsElement).open = false;
  start();
});
byId("language", HTMLSelectElement).replaceChildren(
  ...Object.entries(languages).map(([code, { name }]) =>
    createElement(
      "option",
      { value: code, lang: code, selected: code === language },
      `${code.toUpperCase()} · ${name}`,
    ),
  ),
);
byId("language", HTMLSelectElement).addEventListener("change", () =>
  switchLanguage(byId("language", HTMLSelectElement).value),
);
window.addEventListener("hashchange", () => openAddress());
jobLabel.addEventListener("input", () => {
  if (readDraft(store.problem.kind)) saveDraft();
});
if (!location.hash && !readLastKind()) opening.show();
start();
