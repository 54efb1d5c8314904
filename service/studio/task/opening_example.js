/** Show an example with its answer when the page opens; `tools/studio` creates it. */

import { byId, createElement } from "../core/dom.js";
import { createChecks, listFigures, createTable } from "../design/design_metrics.js";
import { foreignLanguage, t, term, translate } from "../core/messages.js";
import { LinkageMotion } from "../motion/linkage_motion.js";

export class OpeningExample {
  /** @param {import("../design/workbench.js").Workbench} desk @param {string} name of the example */
  constructor(desk, name) {
    this.desk = desk;
    this.name = name;
    /** @type {LinkageMotion | null} */
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
    desk.stage.offerMotion(true, t`Example: ${translate(this.name)}`);
    desk.stage.showMode("watch");
    desk.shown = design;
    this.moving = new LinkageMotion(desk.frame, design, motion, problem, circuits);
    desk.title.replaceChildren(t`Example: ${`${translate(this.name)}, ${term(design.mechanism.type)}`}`);
    this.tabulate = () =>
      desk.numbers.replaceChildren(
        createElement(
          "p",
          { class: "note" },
          t`The best of ${found}.`,
          " ",
          createElement("span", { lang: foreignLanguage(summary) }, translate(summary)),
        ),
        createElement(
          "p",
          { class: "note" },
          t`Solve it to see all designs with drawings and files, or enter another problem.`,
        ),
        createElement(
          "div",
          { class: "columns" },
          createChecks(design, problem),
          createTable(t`Quantities`, listFigures(design), problem),
        ),
      );
    this.tabulate();
  }

  /** The service has returned the dimensions of the numbers: show their units. */
  addUnits() {
    if (!this.gone.signal.aborted) this.tabulate?.();
  }

  /** Make room for something else. */
  leave() {
    if (this.gone.signal.aborted) return;
    this.gone.abort();
    this.moving?.stop();
    this.moving = null;
    this.desk.clear();
    this.desk.stage.offerMotion(false);
  }
}
