/** The parts of the window that show a design: the stage, the drawer, and their content. */

import { byId, createElement } from "../core/dom.js";
import { Drawer } from "../page/drawer.js";
import { t } from "../core/messages.js";
import { Stage } from "../canvas/stage.js";

/** @import { Mechanism } from "../types/values.js" */

export class Workbench {
  constructor() {
    /** The design that is shown, if one is. @type {{mechanism: Mechanism, placement?: unknown} | null} */
    this.shown = null;
    /** The linkage that is explored, if one is. @type {import("../explorer/explorer.js").Explorer | null} */
    this.explorer = null;
    this.stage = new Stage();
    this.drawer = new Drawer(byId("design"), byId("tabs"));
    this.title = byId("design-title");
    this.before = byId("before");
    this.numbers = byId("numbers");
    this.forced = byId("forced");
    this.files = byId("files");
    this.explore = byId("explore");
    this.exploring = byId("exploring");
    this.curves = byId("burmester");
    this.built = byId("built");
    this.other = byId("other");
    this.choosing = byId("choosing");
    this.assembly = byId("assembly");
    for (const [name, text] of [
      ["task", t`Task`],
      ["answers", t`Answers`],
    ]) {
      this.drawer.add(name, text, byId(name === "task" ? "statement" : "answers"), true);
    }
    const tabs = {
      numbers: t`Numbers`,
      plots: t`Plots`,
      explore: t`Explore`,
      compare: t`Compare`,
      curves: t`Curves`,
      assembly: t`Assembly`,
      files: t`Files`,
      jobs: t`Jobs`,
    };
    for (const [name, text] of Object.entries(tabs)) this.drawer.add(name, text, byId(`pane-${name}`));
    for (const name of ["compare", "curves", "assembly"]) this.drawer.setAvailable(name, false);
  }

  get frame() {
    return this.stage.frame;
  }

  /** Clear the shown design. */
  clear() {
    this.shown = null;
    this.title.replaceChildren();
    this.frame.showMessage();
    this.before.replaceChildren();
    this.forced.replaceChildren();
    for (const [place, text] of /** @type {[HTMLElement, string][]} */ ([
      [this.numbers, t`The numbers of a design appear here.`],
      [this.frame.plots, t`The plots of a design appear here.`],
      [this.files, t`The files of a design appear here.`],
    ])) {
      place.replaceChildren(createElement("p", { class: "note" }, text));
    }
    this.offerExploring(false);
  }

  /** Set whether a linkage can be explored. @param {boolean} is */
  offerExploring(is) {
    this.exploring.replaceChildren();
    const note = t`Only linkages can be explored by dragging their pins.`;
    this.explore.replaceChildren(...(is ? [] : [createElement("p", { class: "note" }, note)]));
  }
}
