/** The tabs next to the stage. On a phone they form a sheet, together with task and answers. */

import { createElement } from "../core/dom.js";

/** Where the tabs are a sheet below the stage, and where they lie over it and are shut. */
const PHONE_LAYOUT = matchMedia("(max-width: 860px)");
const OVERLAY_LAYOUT = matchMedia("(min-width: 861px) and (max-width: 1279px)");

/** @typedef {{opened?: () => void, closed?: () => void}} Reaction */
/**
 * `sheet`: on a phone only.
 * @typedef {{name: string, text: string, pane: HTMLElement, sheet: boolean, tab: HTMLElement}} Tab
 */

export class Drawer {
  /** @param {HTMLElement} place with its panes @param {HTMLElement} list of the tabs */
  constructor(place, list) {
    this.place = place;
    /** @type {Tab[]} */
    this.tabs = [];
    this.list = list;
    /** @type {Record<string, Reaction>} */
    this.reactions = {};
    /** The pane of the drawer that is shown, and what a phone's sheet shows. */
    this.pane = "";
    this.sheet = "task";
    for (const query of [PHONE_LAYOUT, OVERLAY_LAYOUT]) query.addEventListener("change", () => this.showSelection());
    list.addEventListener("keydown", (event) => this.handleKey(event));
    document.addEventListener("keydown", (event) => {
      if (event.key === "Escape") this.close();
    });
  }

  /**
   * @param {string} name
   * @param {string} text
   * @param {HTMLElement} pane
   * @param {boolean} [sheet] whether it is a phone's only
   */
  add(name, text, pane, sheet = false) {
    const tab = createElement(
      "button",
      {
        type: "button",
        role: "tab",
        id: `tab-${name}`,
        class: sheet ? "tab sheet" : "tab",
        "aria-controls": pane.id,
        onclick: () => this.pressTab(name),
      },
      text,
    );
    if (!sheet) {
      pane.setAttribute("role", "tabpanel");
      pane.setAttribute("aria-labelledby", tab.id);
      // What only scrolls can be reached by keys.
      pane.tabIndex = 0;
    }
    this.tabs.push({ name, text, pane, sheet, tab });
    this.list.append(tab);
    if (!this.pane && !sheet) this.pane = name;
    this.showSelection();
  }

  /**
   * What happens when a tab opens and closes.
   * @param {string} name
   * @param {Reaction | null} reaction null where it has nothing to show
   */
  setReaction(name, reaction) {
    const before = this.reactions[name];
    if (this.pane === name && before !== reaction) before?.closed?.();
    if (reaction) this.reactions[name] = reaction;
    else delete this.reactions[name];
    if (this.pane === name) reaction?.opened?.();
  }

  /** Whether a tab is there at all. @param {string} name @param {boolean} is */
  setAvailable(name, is) {
    this.findTab(name).tab.hidden = !is;
    if (!is && this.pane === name) this.selectTab("numbers");
  }

  /** @param {string} name */
  findTab(name) {
    return /** @type {Tab} */ (this.tabs.find((one) => one.name === name));
  }

  /** A tab is pressed: where the drawer lies over the stage, the one that is open shuts it. @param {string} name */
  pressTab(name) {
    if (OVERLAY_LAYOUT.matches && this.place.classList.contains("open") && this.pane === name) return this.close();
    this.selectTab(name);
    this.place.classList.add("open");
  }

  close() {
    this.place.classList.remove("open");
  }

  /** @param {string} name */
  selectTab(name) {
    const { sheet } = this.findTab(name);
    this.sheet = sheet ? name : "drawer";
    if (!sheet && name !== this.pane) {
      const before = this.pane;
      this.pane = name;
      this.reactions[before]?.closed?.();
      this.reactions[name]?.opened?.();
    }
    this.showSelection();
  }

  /** Update the tabs to the selection. */
  showSelection() {
    document.body.dataset.sheet = this.sheet;
    const chosen = PHONE_LAYOUT.matches && this.sheet !== "drawer" ? this.sheet : this.pane;
    for (const { name, pane, sheet, tab } of this.tabs) {
      tab.setAttribute("aria-selected", String(name === chosen));
      tab.tabIndex = name === chosen ? 0 : -1;
      if (!sheet) pane.hidden = name !== this.pane;
    }
    if (PHONE_LAYOUT.matches) this.findTab(chosen)?.tab.scrollIntoView({ block: "nearest", inline: "nearest" });
  }

  /** Arrow keys, Home and End go from tab to tab. @param {KeyboardEvent} event */
  handleKey(event) {
    const shown = this.tabs.filter(({ tab }) => !tab.hidden && tab.offsetParent);
    const at = shown.findIndex(({ tab }) => tab === document.activeElement);
    const to = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: shown.length - 1 }[event.key];
    if (at < 0 || to === undefined) return;
    event.preventDefault();
    const next = shown[(to + shown.length) % shown.length];
    this.selectTab(next.name);
    next.tab.focus();
  }
}
