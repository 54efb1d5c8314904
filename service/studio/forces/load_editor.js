/** Edit the loads of a linkage: material, masses, loads, gravity and speed, on the drawing or in lists. */

import { Refusal } from "../core/api.js";
import { createChoice, createNumberBox } from "../form/controls.js";
import { createElement, toWords } from "../core/dom.js";
import * as faults from "../form/field_errors.js";
import { t, term } from "../core/messages.js";
import { readPointer, writePointer } from "../core/pointer.js";
import { unitSymbol } from "../core/units.js";

/** @import { Json, Problem, Schemas, Skeleton } from "../types/values.js" */

/** How near to a pin a click means it, pixels of the picture. */
const PIN_REACH = 22;

/** Fields that are edited here; the others of a given block are kept. */
const EDITED_FIELDS = ["units", "gravity", "speed_rpm", "speed", "links", "point_masses", "loads"];

/** @typedef {import("../motion/linkage_motion.js").LinkageMotion} Mover */
/** @typedef {Schemas["DesignForcesBlock"]} Block */
/** A mass that is being entered: its number may still be missing. @typedef {Partial<Schemas["PointMass"]>} Mass */
/** @typedef {Schemas["LoadSpec"]} Load */
/** @typedef {{select: HTMLSelectElement, button: HTMLElement}} PlacedRow */

let ids = 0;

export class LoadEditor {
  /**
   * @param {Skeleton} skeleton @param {Problem} problem @param {boolean} sliding whether a slide drives
   * @param {(block: Block) => Promise<void>} show asks for the forces by a block, and shows them
   */
  constructor(skeleton, problem, sliding, show) {
    this.skeleton = skeleton;
    this.sliding = sliding;
    this.ask = show;
    /** What a linkage's problem has of the sort is such a block. */
    this.block = /** @type {Block} */ (
      /** @type {unknown} */ (structuredClone(problem.dynamics ?? { gravity: { magnitude: 9.80665, angle: 270 } }))
    );
    this.problem = {
      kind: problem.kind,
      length_unit: problem.length_unit,
      dynamics: { units: this.block.units ?? "si" },
    };
    /** @type {Mover | null} */
    this.mover = null;
    /** The row whose joint the next click on the drawing chooses. @type {PlacedRow | null} */
    this.placing = null;
    /** Whether forces are shown. */
    this.answered = Boolean(problem.dynamics);
    this.rows = createElement("div", { class: "fields loads" });
    this.hint = createElement("p", { class: "note", role: "status" });
    this.faults = createElement("div", { role: "alert" });
    this.button = createElement("button", { type: "submit", class: "main" }, t`Show the forces`);
    const kept = Object.entries(this.block)
      .filter(([name, value]) => !EDITED_FIELDS.includes(name) && Object.keys(value ?? {}).length)
      .map(([name]) => name);
    this.form = createElement(
      "form",
      {
        novalidate: true,
        "aria-label": t`Masses and loads`,
        onsubmit: (/** @type {Event} */ event) => {
          event.preventDefault();
          this.submit();
        },
        onkeydown: (/** @type {KeyboardEvent} */ event) => {
          if (event.key === "Escape") this.startPlacing(null);
        },
      },
      createElement(
        "div",
        { class: "fields" },
        this.createSpeedField(),
        ...this.createGravityFields(),
        this.createMaterialFields(),
      ),
      this.rows,
      createElement(
        "div",
        { class: "row" },
        ...[
          ["point mass", () => this.masses.push({ joint: this.joints[0] })],
          ["force", () => this.loads.push({ joint: this.joints[0], force: { constant: [0, 0] } })],
          ["torque", () => this.loads.push({ link: this.links[0], torque: { constant: 0 } })],
        ].map(([name, add]) =>
          createElement(
            "button",
            {
              type: "button",
              class: "small",
              onclick: () => this.createAddButton(/** @type {() => void} */ (add), String(name)),
            },
            t`Add a ${term(String(name))}`,
          ),
        ),
      ),
      this.hint,
      kept.length > 0 && createElement("p", { class: "note" }, t`Kept from the problem: ${kept.map(term).join(", ")}.`),
      this.faults,
      createElement("div", { class: "row" }, this.button),
    );
    this.node = createElement(
      "details",
      { class: "load-editor", open: !problem.dynamics, ontoggle: () => this.node.open || this.startPlacing(null) },
      createElement("summary", {}, t`Add masses and loads`),
      this.form,
    );
    this.click = (/** @type {PointerEvent} */ event) => this.chooseJoint(event);
    this.createLists();
  }

  get joints() {
    return Object.keys(this.skeleton.joints);
  }

  /** @returns {string[]} */
  get links() {
    return this.skeleton.links.map((link) => link.name).filter((/** @type {string} */ name) => name !== "ground");
  }

  /** @returns {Mass[]} */
  get masses() {
    return (this.block.point_masses ??= []);
  }

  /** @returns {Load[]} */
  get loads() {
    return (this.block.loads ??= []);
  }

  /**
   * A number with its name, unit and place for what is wrong with it.
   * @param {string} path
   * @param {string} name
   * @param {string} unit
   * @param {unknown} value
   * @param {(value: Json | undefined) => void} set
   * @param {string} [note]
   */
  createNumberField(path, name, unit, value, set, note) {
    const box = createNumberBox(value, undefined, set);
    box.id = `load${++ids}`;
    box.setAttribute("data-path", path);
    return createElement(
      "div",
      { class: "field" },
      createElement("label", { for: box.id }, name, unit && createElement("span", { class: "unit" }, ` (${unit})`)),
      box,
      createElement("p", { class: "error" }),
      note && createElement("p", { class: "note" }, note),
    );
  }

  /** @param {string} dimension */
  formatUnit(dimension) {
    return unitSymbol(dimension, this.problem);
  }

  createSpeedField() {
    const name = this.sliding ? "speed" : "speed_rpm";
    const unit = this.sliding ? `${this.formatUnit("length")}/s` : this.formatUnit("rotational speed");
    return this.createNumberField(
      `/dynamics/${name}`,
      t`Speed of the input`,
      unit,
      this.block[name],
      (value) => writePointer(this.block, [name], value),
      t`0 means statics.`,
    );
  }

  createGravityFields() {
    const pull = {
      magnitude: undefined,
      angle: undefined,
      ...(this.block.gravity && { magnitude: 9.80665, angle: 270, ...this.block.gravity }),
    };
    const set = (/** @type {"magnitude" | "angle"} */ name) => (/** @type {Json | undefined} */ value) => {
      pull[name] = typeof value === "number" ? value : undefined;
      if (pull.magnitude === undefined) delete this.block.gravity;
      else this.block.gravity = pull.angle === undefined ? { magnitude: pull.magnitude } : { ...pull };
    };
    return [
      this.createNumberField(
        "/dynamics/gravity/magnitude",
        t`Gravity`,
        this.formatUnit("gravity"),
        pull.magnitude,
        set("magnitude"),
        t`Empty: none.`,
      ),
      this.createNumberField("/dynamics/gravity/angle", t`Gravity pulls towards`, "°", pull.angle, set("angle")),
    ];
  }

  createMaterialFields() {
    const { block } = this;
    const field = (/** @type {string} */ name, /** @type {string} */ dimension) =>
      this.createNumberField(
        `/dynamics/links/${name}`,
        toWords(name),
        this.formatUnit(dimension),
        readPointer(block, ["links", name]),
        (value) => {
          writePointer(block, ["links", name], value);
          if (!Object.keys(block.links ?? {}).length) delete block.links;
        },
      );
    return createElement(
      "fieldset",
      { class: "field member", "data-path": "/dynamics/links", tabindex: -1 },
      createElement("legend", {}, t`Material of all links`),
      createElement(
        "div",
        { class: "fields" },
        field("density", "density"),
        field("thickness", "length"),
        field("width", "length"),
      ),
      createElement("p", { class: "error" }),
    );
  }

  /** @param {() => void} make @param {string} name */
  createAddButton(make, name) {
    make();
    this.createLists();
    const rows = [...this.rows.querySelectorAll("fieldset")].filter((one) => one.dataset.sort === name);
    const row = rows[rows.length - 1];
    row?.querySelector("select")?.focus();
    /** @type {HTMLElement | null | undefined} */ (row?.querySelector("[aria-pressed]"))?.click();
  }

  /** All masses and loads, each with its place and its strength. */
  createLists() {
    this.startPlacing(null);
    this.rows.replaceChildren(
      ...this.masses.map((mass, k) =>
        this.createRow(
          this.masses,
          k,
          `/dynamics/point_masses/${k}`,
          "point mass",
          this.createJointField(mass, `/dynamics/point_masses/${k}/joint`),
          this.createNumberField(
            `/dynamics/point_masses/${k}/mass`,
            t`Mass`,
            this.formatUnit("mass"),
            mass.mass,
            (value) => writePointer(mass, ["mass"], value),
          ),
        ),
      ),
      ...this.loads.map((load, k) => {
        const path = `/dynamics/loads/${k}`;
        if (load.joint !== undefined && load.force?.constant) {
          const axis = (/** @type {number} */ n) =>
            this.createNumberField(
              `${path}/force/constant/${n}`,
              t`Force ${"xy"[n]}`,
              this.formatUnit("force"),
              readPointer(load, ["force", "constant", String(n)]),
              (value) => writePointer(load, ["force", "constant", String(n)], value ?? null),
            );
          return this.createRow(
            this.loads,
            k,
            path,
            "force",
            this.createJointField(load, `${path}/joint`),
            axis(0),
            axis(1),
          );
        }
        if (load.link !== undefined && load.torque && "constant" in load.torque) {
          return this.createRow(
            this.loads,
            k,
            path,
            "torque",
            this.createNameField(this.links, load, "link", `${path}/link`),
            this.createNumberField(
              `${path}/torque/constant`,
              t`Torque`,
              this.formatUnit("torque"),
              load.torque.constant,
              (value) => writePointer(load, ["torque", "constant"], value ?? null),
            ),
          );
        }
        return this.createRow(
          this.loads,
          k,
          path,
          "load",
          createElement("p", { class: "note" }, t`On ${load.joint ?? load.link}, kept unchanged.`),
        );
      }),
    );
  }

  /**
   * @param {unknown[]} all
   * @param {number} k
   * @param {string} path
   * @param {string} sort
   * @param {...HTMLElement} controls
   */
  createRow(all, k, path, sort, ...controls) {
    return createElement(
      "fieldset",
      { class: "field member", "data-path": path, "data-sort": sort, tabindex: -1 },
      createElement("legend", {}, toWords(sort)),
      createElement("div", { class: "fields" }, ...controls),
      createElement("p", { class: "error" }),
      createElement(
        "button",
        {
          type: "button",
          class: "small",
          "aria-label": t`Remove ${`${term(sort)} ${k + 1}`}`,
          onclick: () => {
            all.splice(k, 1);
            this.createLists();
          },
        },
        t`Remove`,
      ),
    );
  }

  /** @param {string[]} names @param {Mass | Load} row @param {string} key @param {string} path */
  createNameField(names, row, key, path) {
    const box = createChoice(names, readPointer(row, [key]), false, (value) => writePointer(row, [key], value));
    box.id = `load${++ids}`;
    box.setAttribute("data-path", path);
    return createElement(
      "div",
      { class: "field" },
      createElement("label", { for: box.id }, toWords(key)),
      box,
      createElement("p", { class: "error" }),
    );
  }

  /**
   * The joint of a mass or force: from the list, or by a click on the drawing.
   * @param {Mass | Load} row
   * @param {string} path
   */
  createJointField(row, path) {
    const field = this.createNameField(this.joints, row, "joint", path);
    const select = /** @type {HTMLSelectElement} */ (field.querySelector("select"));
    const button = createElement(
      "button",
      {
        type: "button",
        class: "small",
        "aria-pressed": "false",
        onclick: () => this.startPlacing(this.placing?.button === button ? null : { select, button }),
      },
      t`Pick on the drawing`,
    );
    field.append(button);
    return field;
  }

  /** @param {PlacedRow | null} placed */
  startPlacing(placed) {
    this.placing?.button.setAttribute("aria-pressed", "false");
    this.placing = placed;
    placed?.button.setAttribute("aria-pressed", "true");
    this.mover?.picture.classList.toggle("placing", Boolean(placed));
    if (placed) this.mover?.pause();
    this.hint.textContent = placed
      ? t`Click a joint in the drawing above, or choose it from the list. Escape cancels.`
      : "";
  }

  /** @param {PointerEvent} event */
  chooseJoint(event) {
    const { mover, placing } = this;
    if (!mover || !placing) return;
    const [x, y] = mover.view.toPlaneFromPointer(mover.picture, event);
    const now = mover.currentJoints();
    const away = mover.linkage.pins.map(({ name }) => {
      const at = now[name];
      return [name, at ? mover.view.scale * Math.hypot(at[0] - x, at[1] - y) : Infinity];
    });
    const [name, distance] = away.sort(([, one], [, other]) => Number(one) - Number(other))[0];
    if (!(Number(distance) < PIN_REACH)) return;
    placing.select.value = String(name);
    placing.select.dispatchEvent(new Event("change"));
    this.startPlacing(null);
  }

  /** @param {Mover | null} mover */
  attach(mover) {
    this.mover?.picture.removeEventListener("click", this.click);
    this.mover?.picture.classList.remove("placing");
    this.mover = mover;
    mover?.picture.addEventListener("click", this.click);
    mover?.picture.classList.toggle("placing", Boolean(this.placing));
  }

  async submit() {
    this.startPlacing(null);
    this.button.disabled = true;
    faults.clearErrors(this.form, this.faults);
    try {
      await this.ask(this.block);
      this.answered = true;
    } catch (error) {
      this.showError(error);
    } finally {
      this.button.disabled = false;
    }
  }

  /** @param {unknown} error */
  showError(error) {
    if (error instanceof Refusal && error.errors.length) {
      // That a speed is missing is said of the block as a whole.
      const speed = `/dynamics/${this.sliding ? "speed" : "speed_rpm"}`;
      faults.showErrors(this.form, this.faults, {
        message: error.message,
        errors: error.errors.map(({ path, detail }) => ({ path: path === "/dynamics" ? speed : path, detail })),
      });
    } else if (error instanceof Error && error.name !== "AbortError")
      this.faults.replaceChildren(createElement("p", { class: "error" }, error.message));
    if (this.answered)
      this.faults.append(
        createElement("p", { class: "note" }, t`The forces below belong to the earlier masses and loads.`),
      );
  }
}
