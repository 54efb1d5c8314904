/** List the jobs of this service, newest first, each with a link that restores it. */

import * as api from "../core/api.js";
import { createElement } from "../core/dom.js";
import { language, t, term, translate } from "../core/messages.js";

const TIME_FORMAT = new Intl.DateTimeFormat(language, { dateStyle: "short", timeStyle: "short" });

export class JobHistory {
  /** @param {HTMLElement} place @param {api.Kind[]} kinds */
  constructor(place, kinds) {
    this.kinds = kinds;
    this.list = createElement("ul", { class: "jobs" });
    this.kind = createElement(
      "select",
      { id: "job-kind", onchange: () => this.load() },
      createElement("option", { value: "" }, t`All kinds`),
      ...kinds.map((kind) => createElement("option", { value: kind.kind }, translate(kind.title))),
    );
    this.words = createElement("input", {
      id: "job-words",
      type: "search",
      placeholder: t`label or state`,
      oninput: () => this.filter(),
    });
    this.more = createElement(
      "button",
      { type: "button", class: "small", onclick: () => this.loadPage() },
      t`Older jobs`,
    );
    /** @type {string | null} */
    this.cursor = null;
    place.replaceChildren(
      createElement(
        "div",
        { class: "row" },
        createElement("label", { for: "job-kind" }, t`Kind`),
        this.kind,
        createElement("label", { for: "job-words" }, t`Search`),
        this.words,
      ),
      this.list,
      this.more,
    );
  }

  /** Read the newest jobs. */
  async load() {
    this.cursor = null;
    this.list.replaceChildren();
    await this.loadPage();
  }

  async loadPage() {
    const first = this.cursor === null;
    const { jobs, next_cursor } = await api.listJobs(this.kind.value, this.cursor);
    if (first) this.list.replaceChildren();
    this.cursor = next_cursor;
    this.more.hidden = next_cursor === null;
    this.list.append(...jobs.map((job) => this.createLine(job)));
    if (!this.list.childElementCount) this.list.append(createElement("li", { class: "note" }, t`No jobs yet.`));
    this.filter();
  }

  /** @param {api.JobItem} job */
  createLine(job) {
    const title = translate(this.kinds.find((kind) => kind.kind === job.kind)?.title ?? job.kind);
    const state = term(job.status);
    const name = job.label || title;
    const item = createElement(
      "li",
      {},
      createElement("a", { href: `#job=${job.id}` }, name),
      createElement("span", { class: `state ${job.status}` }, state),
      createElement(
        "span",
        { class: "note" },
        `${job.label ? `${title}, ` : ""}${TIME_FORMAT.format(new Date(job.created_at))}`,
      ),
      createElement(
        "button",
        {
          type: "button",
          class: "small",
          "aria-label": ["queued", "running"].includes(job.status) ? t`Cancel ${name}` : t`Remove ${name}`,
          onclick: async () => {
            await api.removeJob(job.id).catch(() => undefined);
            await this.load();
          },
        },
        "×",
      ),
    );
    item.dataset.words = `${name} ${title} ${job.kind} ${state} ${job.id}`.toLowerCase();
    return item;
  }

  /** Show the lines that contain all words of the search. */
  filter() {
    const sought = this.words.value.toLowerCase().split(/\s+/);
    for (const line of this.list.querySelectorAll("li"))
      line.hidden = !sought.every((/** @type {string} */ word) => (line.dataset.words ?? "").includes(word));
  }
}
