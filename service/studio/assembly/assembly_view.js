/**
 * The assembly pane: the parts in three dimensions, moving with the drawing; they can be separated, hidden and
 * downloaded.
 */

import * as api from "../core/api.js";
import { createElement, formatNumber } from "../core/dom.js";
import { saveFile } from "../design/design_files.js";
import { t, term } from "../core/messages.js";
import { interpolate } from "../core/player.js";
import { unitSymbol } from "../core/units.js";

/** @import { Schemas, Solved } from "../types/values.js" */

/**
 * @typedef {{name: string, described: string, sort: string, material: string, colour: string, standard: string, lift:
 *   number, carrier: number, shapes: import("./solids.js").Shape[], item: string, files: string[]}} Part
 */
/**
 * @typedef {{length_unit: string, unit: number, scale: number, low: number, high: number, notes: string[], input:
 *   import("./assembly_motion.js").Inputs, carriers: import("./assembly_motion.js").Carrier[], parts: Part[]}} Assembly
 */
/**
 * The motion in the drawing.
 * @typedef {{player: import("../core/player.js").Player, motion: {input_angle: (number | null)[], engaged?: number[]}}}
 *   LeadingMotion
 */

/**
 * @typedef {{all: HTMLInputElement, names: string[], each: Map<string, HTMLInputElement>}} VisibilityBox `each` by
 *   `names`
 */

/** Number of requested inputs. */
const POSITION_COUNT = 144;

/** Extracts the feasible scale from an error message. */
const SCALE_PATTERN = /fit at scale ([\d.e+]+) or more|; use at most scale ([\d.e+-]*\d)/;

const PROCESSES = { laser: t`cut by laser`, print: t`printed`, mill: t`milled` };

export class AssemblyView {
  /**
   * @param {HTMLElement} place of the list of parts @param {Solved} job @param {number} n
   * @param {() => Partial<LeadingMotion> | null} moving what moves in the drawing now, if anything does
   * @param {HTMLElement} board of the picture
   */
  constructor(place, job, n, moving, board) {
    this.board = board;
    this.job = job;
    this.n = n;
    this.moving = moving;
    this.gone = new AbortController();
    /** @type {AbortController | null} */
    this.asked = null;
    /** @type {Assembly | null} */
    this.assembly = null;
    /** @type {import("./assembly_scene.js").AssemblyScene | null} */
    this.scene = null;
    /** The scene, if the browser can draw it. @type {typeof import("./assembly_scene.js") | null} */
    this.drawing = null;
    /** Names of parts. @type {Set<string>} */
    this.hidden = new Set();
    /** @type {string | null} */
    this.chosen = null;
    this.explosion = 0;
    this.frame = 0;
    /** The gear of a gearbox for which the parts were made, from 1. @type {number | null} */
    this.engaged = null;
    /** Index of the displayed motion. @type {number} */
    this.seen = NaN;
    this.list = createElement("div");
    this.fileFault = createElement("p", { class: "error", role: "alert" });
    this.beyond = createElement("p", { class: "note", hidden: true });
    /** Checkboxes of each kind of part: one for all, and one for each part. @type {VisibilityBox[]} */
    this.shows = [];
    this.words = createElement("p", { class: "note", role: "status" });
    this.fault = createElement("div", { class: "fault", role: "alert" });
    this.body = createElement("div", { class: "assembly", hidden: true });
    this.form = this.createSizeFields();
    loadStyles();
    place.replaceChildren(this.form, this.fault, this.words, this.body);
    this.load();
    const step = () => {
      this.frame = requestAnimationFrame(step);
      this.follow();
    };
    this.frame = requestAnimationFrame(step);
  }

  /** Create the fields for material and sizes. */
  createSizeFields() {
    const unit = unitSymbol("length", this.job.problem);
    const field = (/** @type {string} */ name, /** @type {string} */ title, /** @type {HTMLElement} */ box) => {
      box.id = `assembly-${name}`;
      box.setAttribute("name", name);
      box.setAttribute("aria-describedby", "assembly-fault");
      return createElement("span", { class: "field" }, createElement("label", { for: box.id }, title), box);
    };
    const number = (/** @type {string} */ hint) =>
      createElement("input", { type: "number", min: 0, step: "any", inputmode: "decimal", placeholder: hint });
    const form = createElement(
      "form",
      {
        class: "row sizes",
        "aria-label": t`What the parts are made of`,
        novalidate: true,
        onsubmit: (/** @type {Event} */ event) => {
          event.preventDefault();
          this.load();
        },
      },
      field(
        "process",
        t`Made`,
        createElement(
          "select",
          { onchange: () => this.load() },
          ...Object.entries(PROCESSES).map(([value, title]) => createElement("option", { value }, title)),
        ),
      ),
      field("pin", t`Pin (${unit})`, number(t`what fits`)),
      field("width", t`Width (${unit})`, number(t`2.5 pins`)),
      field("scale", t`Scale`, number("1")),
      createElement("button", { type: "submit", class: "small" }, t`Apply`),
    );
    this.fault.id = "assembly-fault";
    return form;
  }

  /** Return the engaged gear of a gearbox, from 1. @returns {number | null} */
  engagedSpeed() {
    const { mechanism, metrics } = this.job.result.designs[this.n];
    if (mechanism.type !== "gearbox") return null;
    const speeds = /** @type {Schemas["SpindleSpeed"][]} */ (metrics.speeds);
    const engaged = String(this.moving()?.motion?.engaged);
    return (
      1 +
      Math.max(
        0,
        speeds.findIndex((one) => String(one.engaged) === engaged),
      )
    );
  }

  /** Read the fields that are filled in. @returns {Record<string, string>} */
  readSizes() {
    const boxes = /** @type {HTMLInputElement[]} */ ([...this.form.querySelectorAll("[name]")]);
    const filled = boxes.filter(({ value }) => value.trim() !== "").map(({ name, value }) => [name, value.trim()]);
    return Object.fromEntries(this.engaged === null ? filled : [...filled, ["speed", String(this.engaged)]]);
  }

  async load() {
    this.asked?.abort();
    const asked = (this.asked = new AbortController());
    this.engaged = this.engagedSpeed();
    this.words.textContent = t`Making the parts …`;
    this.body.setAttribute("aria-busy", "true");
    this.clearErrors();
    if (!this.scene) this.showNote(t`Making the parts …`);
    try {
      const query = this.readSizes();
      const [assembly, drawing] = await Promise.all([
        api.fetchAssembly(this.job.id, this.n, { ...query, positions: String(POSITION_COUNT) }, asked.signal),
        import("./assembly_scene.js"),
      ]);
      if (asked.signal.aborted || this.gone.signal.aborted) return;
      this.drawing = drawing.canDraw() ? drawing : null;
      this.present(assembly, query);
    } catch (error) {
      if (asked.signal.aborted || this.gone.signal.aborted) return;
      this.words.replaceChildren();
      this.body.hidden = true;
      this.showNote(t`These parts cannot be made.`);
      this.scene?.stop();
      this.scene = null;
      this.showRefusal(error);
    }
    this.body.removeAttribute("aria-busy");
  }

  /** Show a note in place of the picture. @param {string} what */
  showNote(what) {
    this.board.replaceChildren(createElement("div", { class: "said" }, createElement("p", { class: "note" }, what)));
  }

  /** Clear all errors. */
  clearErrors() {
    this.fault.replaceChildren();
    for (const box of this.form.querySelectorAll("[aria-invalid]")) box.removeAttribute("aria-invalid");
  }

  /** Show why the parts cannot be made, and offer sizes that work. @param {unknown} error */
  showRefusal(error) {
    const faults = error instanceof api.Refusal ? error.errors : [];
    const reason =
      faults.map((one) => one.detail).join(" ") || (error instanceof Error ? error.message : String(error));
    this.fault.replaceChildren(createElement("p", { class: "error" }, reason));
    for (const { path } of faults)
      this.form.querySelector(`[name="${path.replace("/query/", "")}"]`)?.setAttribute("aria-invalid", "true");
    const [, least, greatest] = SCALE_PATTERN.exec(reason) ?? [];
    const scale = least ?? greatest;
    if (scale === undefined) return;
    this.fault.append(
      createElement(
        "button",
        {
          type: "button",
          class: "small",
          onclick: () => {
            /** @type {HTMLInputElement} */ (this.form.elements.namedItem("scale")).value = String(Number(scale));
            this.load();
          },
        },
        t`Build it at scale ${Number(scale)}`,
      ),
    );
  }

  /** @param {Assembly} assembly @param {Record<string, string>} query of the request */
  present(assembly, query) {
    this.scene?.stop();
    this.scene = null;
    this.assembly = assembly;
    const kinds = new Set(assembly.parts.map(({ item }) => item));
    const names = new Set(assembly.parts.map(({ name }) => name));
    this.hidden = new Set([...this.hidden].filter((name) => names.has(name)));
    this.chosen = null;
    this.words.textContent =
      [
        t`${assembly.parts.length} parts of ${kinds.size} kinds`,
        assembly.scale !== 1 && t`${formatNumber(assembly.scale)} times the size of the design`,
      ]
        .filter(Boolean)
        .join(", ") + ".";
    this.list = this.listParts(assembly, query);
    this.body.hidden = false;
    if (!this.drawing) {
      const reason = t`This browser cannot draw in three dimensions (WebGL 2 is missing or switched off). The parts are listed with their files.`;
      this.showNote(reason);
      this.body.replaceChildren(this.list);
      return;
    }
    const canvas = createElement("canvas", {
      class: "canvas solid",
      tabindex: 0,
      role: "application",
      "aria-describedby": "assembly-keys",
      "aria-label": t`The assembly in three dimensions, ${assembly.parts.length} parts`,
      onkeydown: (/** @type {KeyboardEvent} */ event) => {
        if (!event.ctrlKey && !event.metaKey && !event.altKey && this.scene?.handleKey(event)) event.preventDefault();
      },
    });
    this.body.replaceChildren(this.list);
    this.board.replaceChildren(
      createElement(
        "figure",
        { class: "solids" },
        this.createTools(),
        canvas,
        this.createSliders(),
        createElement(
          "p",
          { class: "note", id: "assembly-keys" },
          t`Drag to turn; drag with the right button or two fingers to move; use the wheel or + and − to zoom. Arrow keys turn, with Shift they move; Home shows everything.`,
        ),
        this.beyond,
        ...assembly.notes.map((note) => createElement("p", { class: "note" }, note)),
      ),
    );
    this.scene = new this.drawing.AssemblyScene(canvas, assembly, {
      hover: (item) => this.hover(item),
      choose: (item) => this.choose(item),
    });
    for (const name of this.hidden) this.scene.hide(name, false);
    this.scene.explode(this.explosion);
    this.scene.fit(false);
    this.seen = NaN;
    this.follow();
  }

  /** Create the buttons for views and for saving the picture. */
  createTools() {
    const button = (/** @type {string} */ title, /** @type {() => void} */ does) =>
      createElement("button", { type: "button", class: "small", onclick: does }, title);
    return createElement(
      "div",
      { class: "row", role: "toolbar", "aria-label": t`View of the assembly` },
      ...Object.keys(this.drawing?.VIEWS ?? {}).map((name) => button(name, () => this.scene?.lookFrom(name))),
      button(t`Fit`, () => this.scene?.fit()),
      button(
        t`Save picture`,
        async () =>
          this.scene &&
          saveFile(URL.createObjectURL(await this.scene.takePicture()), `${this.job.kind}-${this.n + 1}-assembly.png`),
      ),
    );
  }

  /** Create the slider that separates the planes, next to the player of the drawing. */
  createSliders() {
    const apart = createElement("input", {
      type: "range",
      id: "explode",
      min: 0,
      max: 1,
      step: 0.01,
      value: this.explosion,
      oninput: () => {
        this.explosion = apart.valueAsNumber;
        apart.setAttribute("aria-valuetext", `${Math.round(100 * this.explosion)} %`);
        this.scene?.explode(this.explosion);
      },
    });
    apart.setAttribute("aria-valuetext", `${Math.round(100 * this.explosion)} %`);
    return createElement(
      "div",
      { class: "row" },
      createElement("label", { for: "explode" }, t`Apart`),
      apart,
      createElement(
        "button",
        {
          type: "button",
          class: "small",
          onclick: () => {
            apart.value = this.explosion > 0 ? "0" : "1";
            apart.dispatchEvent(new Event("input"));
          },
        },
        t`Together / apart`,
      ),
    );
  }

  /**
   * List the parts by kind, with checkboxes and files.
   * @param {Assembly} assembly
   * @param {Record<string, string>} query
   */
  listParts(assembly, query) {
    /** @type {Map<string, Part[]>} */
    const kinds = new Map();
    for (const part of assembly.parts) kinds.set(part.item, [...(kinds.get(part.item) ?? []), part]);
    this.fileFault.replaceChildren();
    this.shows = [];
    const every = assembly.parts.map(({ name }) => name);
    const all = createElement(
      "div",
      { class: "row" },
      createElement("button", { type: "button", class: "small", onclick: () => this.show(every, true) }, t`Show all`),
      createElement("button", { type: "button", class: "small", onclick: () => this.show(every, false) }, t`Hide all`),
      this.createFileButton(t`All files`, t`All files as a zip`, `${this.job.kind}-${this.n + 1}-parts.zip`, () =>
        api.downloadParts(this.job.id, this.n, query),
      ),
    );
    const rows = [...kinds].map(([item, equals]) => {
      const [part, ...others] = equals;
      const called = others.length ? term(item) : part.described;
      const names = equals.map(({ name }) => name);
      const box = this.createCheckbox(`show-${item}`, called, names);
      const each = this.listPlaces(equals);
      this.shows.push({ all: box, names, each: each.boxes });
      const swatch = createElement("span", { class: "swatch", "aria-hidden": "true" });
      swatch.style.backgroundColor = part.colour;
      return createElement(
        "li",
        {
          "data-item": item,
          onpointerenter: () => this.scene?.setHovered(item),
          onpointerleave: () => this.scene?.setHovered(null),
        },
        box,
        swatch,
        createElement(
          "button",
          {
            type: "button",
            class: "called",
            "aria-pressed": "false",
            onclick: () => this.choose(this.chosen === item ? null : item),
          },
          called,
          others.length > 0 && ` × ${others.length + 1}`,
        ),
        createElement("span", { class: "note" }, part.standard || part.material),
        createElement(
          "span",
          { class: "files" },
          ...part.files.map((form) =>
            this.createFileButton(form.toUpperCase(), t`${called} as ${form.toUpperCase()}`, `${item}.${form}`, () =>
              api.downloadPart(this.job.id, this.n, item, form, query),
            ),
          ),
        ),
        each.node,
      );
    });
    this.updateList();
    return createElement(
      "div",
      { class: "parts" },
      createElement("h3", { id: "assembly-parts", class: "minor" }, t`Parts`),
      all,
      this.fileFault,
      createElement("ul", { "aria-labelledby": "assembly-parts" }, ...rows),
      !api.makesSolids() &&
        createElement(
          "p",
          { class: "note" },
          t`Outlines of the plates are available. For solids, the service needs its extra cad.`,
        ),
    );
  }

  /** @param {string} title @param {string} described @param {string} name @param {() => Promise<string>} make */
  createFileButton(title, described, name, make) {
    const button = createElement(
      "button",
      {
        type: "button",
        class: "small",
        "aria-label": described,
        title: described,
        onclick: async () => {
          button.disabled = true;
          this.fileFault.replaceChildren();
          try {
            saveFile(await make(), name);
          } catch (error) {
            const reasons = error instanceof api.Refusal ? error.errors.map((one) => one.detail) : [];
            this.fileFault.replaceChildren(reasons.join(" ") || /** @type {Error} */ (error).message);
          }
          button.disabled = false;
        },
      },
      title,
    );
    return button;
  }

  /** Create a checkbox that shows or hides parts. @param {string} id @param {string} called @param {string[]} names */
  createCheckbox(id, called, names) {
    const box = createElement("input", {
      type: "checkbox",
      id,
      "aria-label": t`Show ${called}`,
      onchange: () => this.show(names, box.checked),
    });
    return box;
  }

  /**
   * List equal parts one by one under a summary; a single part has only its row.
   * @param {Part[]} equals
   * @returns {{node: HTMLElement | null, boxes: Map<string, HTMLInputElement>}}
   */
  listPlaces(equals) {
    if (equals.length === 1) return { node: null, boxes: new Map() };
    /** @type {Map<string, number>} */
    const met = new Map();
    const rows = equals.map(({ name, described }) => {
      const nth = (met.get(described) ?? 0) + 1;
      met.set(described, nth);
      const alike = equals.filter((one) => one.described === described).length > 1;
      const called = `${described}${alike ? ` (${nth})` : ""}`;
      const box = this.createCheckbox(`show-place-${name}`, called, [name]);
      const node = createElement(
        "label",
        {
          for: box.id,
          onpointerenter: () => this.scene?.setHovered(name),
          onpointerleave: () => this.scene?.setHovered(null),
        },
        box,
        called,
      );
      return { name, box, node };
    });
    return {
      node: createElement(
        "details",
        { class: "places" },
        createElement("summary", {}, t`One by one`),
        ...rows.map(({ node }) => node),
      ),
      boxes: new Map(rows.map(({ name, box }) => [name, box])),
    };
  }

  /** @param {string[]} names @param {boolean} visible */
  show(names, visible) {
    for (const name of names) {
      if (visible) this.hidden.delete(name);
      else this.hidden.add(name);
      this.scene?.hide(name, visible);
    }
    this.updateList();
  }

  /** Update the list: of each kind all, some or none are shown. */
  updateList() {
    for (const { all, names, each } of this.shows) {
      for (const [name, box] of each) box.checked = !this.hidden.has(name);
      const shown = names.filter((name) => !this.hidden.has(name)).length;
      all.checked = shown === names.length;
      all.indeterminate = shown > 0 && shown < names.length;
    }
  }

  /** @param {string | null} item */
  hover(item) {
    this.scene?.setHovered(item);
    for (const row of this.list.querySelectorAll("li")) row.classList.toggle("hovered", row.dataset.item === item);
  }

  /** @param {string | null} item */
  choose(item) {
    this.chosen = item;
    this.scene?.highlight(item);
    for (const row of this.list.querySelectorAll("li")) {
      const chosen = row.dataset.item === item;
      row.querySelector(".called")?.setAttribute("aria-pressed", String(chosen));
      if (chosen) row.scrollIntoView({ block: "nearest" });
    }
  }

  /** Return the motion in the drawing, if it has a player. @returns {LeadingMotion | null} */
  leadingMotion() {
    const moving = this.moving();
    const { player, motion } = moving ?? {};
    return player && motion && (motion.input_angle?.length ?? 0) > 1 ? { player, motion } : null;
  }

  /** Follow the drawing. */
  follow() {
    const led = this.leadingMotion();
    if (led && this.engagedSpeed() !== this.engaged) this.load();
    if (!led || !this.scene || !this.assembly) return;
    const { player, motion } = led;
    if (player.at === this.seen) return;
    this.seen = player.at;
    const turns = Math.floor(player.at / player.last);
    const rest = player.at - turns * player.last;
    const [begin, end] = [Number(motion.input_angle[0]), Number(motion.input_angle[player.last])];
    const input = Number(interpolate(motion.input_angle, rest)) + turns * (end - begin);
    const { at, within } = this.scene.motion.findIndex(input);
    this.scene.show(at);
    const { low, high, quantity } = this.assembly.input;
    const unit = quantity === "angle" ? "°" : ` ${unitSymbol("length", this.job.problem)}`;
    this.beyond.hidden = within;
    const [from, to] = [low, high].map((end) => formatNumber(Number(end.toFixed(2))) + unit);
    this.beyond.textContent = t`The parts are shown for inputs from ${from} to ${to}. The drawing is outside this range, so they wait at its end.`;
  }

  stop() {
    this.gone.abort();
    this.asked?.abort();
    cancelAnimationFrame(this.frame);
    this.scene?.stop();
    this.scene = null;
  }
}

/** Load the style sheet with the first view. */
function loadStyles() {
  if (document.querySelector('link[href="/studio/assembly.css"]')) return;
  document.head.append(createElement("link", { rel: "stylesheet", href: "/studio/assembly.css" }));
}
