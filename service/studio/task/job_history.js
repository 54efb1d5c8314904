/** The jobs of this service, newest first, each with a link that restores it. */

import * as api from "../core/api.js";
import { el } from "../core/dom.js";
import { language, t, term, translated } from "../core/messages.js";

const TIME = new Intl.DateTimeFormat(language, { dateStyle: "short", timeStyle: "short" });

export class History {
  /** @param {HTMLElement} place @param {api.Kind[]} kinds */
  constructor(place, kinds) {
    this.kinds = kinds;
    this.list = el("ul", { class: "jobs" });
    this.kind = el(
      "select",
      { id: "job-kind", onchange: () => this.load() },
      el("option", { value: "" }, t`All kinds`),
      ...kinds.map((kind) => el("option", { value: kind.kind }, translated(kind.title))),
    );
    this.words = el("input", {
      id: "job-words",
      type: "search",
      placeholder: t`label or state`,
      oninput: () => this.filter(),
    });
    this.more = el("button", { type: "button", class: "small", onclick: () => this.page() }, t`Older jobs`);
    /** @type {string | null} */
    this.cursor = null;
    place.replaceChildren(
      el(
        "div",
        { class: "row" },
        el("label", { for: "job-kind" }, t`Kind`),
        this.kind,
        el("label", { for: "job-words" }, t`Search`),
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
    await this.page();
  }

  async page() {
    const first = this.cursor === null;
    const { jobs, next_cursor } = await api.jobs(this.kind.value, this.cursor);
    if (first) this.list.replaceChildren();
    this.cursor = next_cursor;
    this.more.hidden = next_cursor === null;
    this.list.append(...jobs.map((job) => this.line(job)));
    if (!this.list.childElementCount) this.list.append(el("li", { class: "note" }, t`No jobs yet.`));
    this.filter();
  }

  /** @param {api.JobItem} job */
  line(job) {
    const title = translated(this.kinds.find((kind) => kind.kind === job.kind)?.title ?? job.kind);
    const state = term(job.status);
    const name = job.label || title;
    const item = el(
      "li",
      {},
      el("a", { href: `#job=${job.id}` }, name),
      el("span", { class: `state ${job.status}` }, state),
      el("span", { class: "note" }, `${job.label ? `${title}, ` : ""}${TIME.format(new Date(job.created_at))}`),
      el(
        "button",
        {
          type: "button",
          class: "small",
          "aria-label": ["queued", "running"].includes(job.status) ? t`Cancel ${name}` : t`Remove ${name}`,
          onclick: async () => {
            await api.remove(job.id).catch(() => undefined);
            await this.load();
          },
        },
        "×",
      ),
    );
    item.dataset.words = `${name} ${title} ${job.kind} ${state} ${job.id}`.toLowerCase();
    return item;
  }

  /** Show the lines that have all the words looked for. */
  filter() {
    const sought = this.words.value.toLowerCase().split(/\s+/);
    for (const line of this.list.querySelectorAll("li"))
      line.hidden = !sought.every((/** @type {string} */ word) => (line.dataset.words ?? "").includes(word));
  }
}
