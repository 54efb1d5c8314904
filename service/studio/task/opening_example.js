/** What moves when the page opens: an example with its answer, made of the service's own by `tools/studio`. */

import { byId, el } from "../core/dom.js";
import { checks, figures, table } from "../design/design_metrics.js";
import { foreign, t, term, translated } from "../core/messages.js";
import { Mover } from "../motion/linkage_motion.js";

export class Opening {
  /** @param {import("../design/workbench.js").Desk} desk @param {string} name of the example */
  constructor(desk, name) {
    this.desk = desk;
    this.name = name;
    /** @type {Mover | null} */
    this.moving = null;
    this.gone = new AbortController();
    /** @type {(() => void) | null} */
    this.tabulate = null;
  }

  /** Show it, unless something else is shown by then. */
  async show() {
    const { desk, gone } = this;
    const answer = await fetch(/** @type {HTMLLinkElement} */ (byId("opening")).href, { signal: gone.signal }).then(
      (one) => (one.ok ? one.json() : null),
      () => null,
    );
    if (!answer || gone.signal.aborted) return;
    const { problem, design, motion, circuits, found, summary } = answer;
    desk.stage.offer(true, t`Example: ${translated(this.name)}`);
    desk.stage.show("watch");
    desk.shown = design;
    this.moving = new Mover(desk.frame, design, motion, problem, circuits);
    desk.title.replaceChildren(t`Example: ${`${translated(this.name)}, ${term(design.mechanism.type)}`}`);
    this.tabulate = () =>
      desk.numbers.replaceChildren(
        el(
          "p",
          { class: "note" },
          t`The best of ${found}.`,
          " ",
          el("span", { lang: foreign(summary) }, translated(summary)),
        ),
        el("p", { class: "note" }, t`Solve it to have all of them, with drawings and files; or state something else.`),
        el("div", { class: "columns" }, checks(design, problem), table(t`Quantities`, figures(design), problem)),
      );
    this.tabulate();
  }

  /** The service has told what numbers measure: their units stand beside them now. */
  measured() {
    if (!this.gone.signal.aborted) this.tabulate?.();
  }

  /** Make room for something else. */
  leave() {
    if (this.gone.signal.aborted) return;
    this.gone.abort();
    this.moving?.stop();
    this.moving = null;
    this.desk.clear();
    this.desk.stage.offer(false);
  }
}
