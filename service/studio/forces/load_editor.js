/**
 * Stating what a linkage design weighs and carries: material, masses, loads, gravity and speed, placed on the drawing
 * or by lists.
 */

import { Refused } from "../core/api.js";
import { choice, numberBox } from "../form/controls.js";
import { el, words } from "../core/dom.js";
import * as faults from "../form/field_errors.js";
import { t, term } from "../core/messages.js";
import { at, put } from "../core/pointer.js";
import { symbolOf } from "../core/units.js";

/** @import { Json, Problem, Schemas, Skeleton } from "../types/values.js" */

/** How near to a pin a click means it, pixels of the picture. */
const NEAR = 22;

/** What is edited here; all else of a stated block is kept. */
const EDITED = ["units", "gravity", "speed_rpm", "speed", "links", "point_masses", "loads"];

/** @typedef {import("../motion/linkage_motion.js").Mover} Mover */
/** @typedef {Schemas["DesignForcesBlock"]} Block */
/** A mass that is being stated: its number may be missing yet. @typedef {Partial<Schemas["PointMass"]>} Mass */
/** @typedef {Schemas["StatedLoad"]} Load */
/** @typedef {{select: HTMLSelectElement, button: HTMLElement}} Placed */

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
    /** The row whose joint the next click on the drawing chooses. @type {Placed | null} */
    this.placing = null;
    /** Whether forces are shown. */
    this.answered = Boolean(problem.dynamics);
    this.rows = el("div", { class: "fields loads" });
    this.hint = el("p", { class: "note", role: "status" });
    this.faults = el("div", { role: "alert" });
    this.button = el("button", { type: "submit", class: "main" }, t`Show the forces`);
    const kept = Object.entries(this.block)
      .filter(([name, value]) => !EDITED.includes(name) && Object.keys(value ?? {}).length)
      .map(([name]) => name);
    this.form = el(
      "form",
      {
        novalidate: true,
        "aria-label": t`Masses and loads`,
        onsubmit: (/** @type {Event} */ event) => {
          event.preventDefault();
          this.submit();
        },
        onkeydown: (/** @type {KeyboardEvent} */ event) => {
          if (event.key === "Escape") this.place(null);
        },
      },
      el("div", { class: "fields" }, this.speed(), ...this.gravity(), this.material()),
      this.rows,
      el(
        "div",
        { class: "row" },
        ...[
          ["point mass", () => this.masses.push({ joint: this.joints[0] })],
          ["force", () => this.loads.push({ joint: this.joints[0], force: { constant: [0, 0] } })],
          ["torque", () => this.loads.push({ link: this.links[0], torque: { constant: 0 } })],
        ].map(([name, add]) =>
          el(
            "button",
            { type: "button", class: "small", onclick: () => this.add(/** @type {() => void} */ (add), String(name)) },
            t`Add a ${term(String(name))}`,
          ),
        ),
      ),
      this.hint,
      kept.length > 0 && el("p", { class: "note" }, t`Kept as the problem states it: ${kept.map(term).join(", ")}.`),
      this.faults,
      el("div", { class: "row" }, this.button),
    );
    this.node = el(
      "details",
      { class: "load-editor", open: !problem.dynamics, ontoggle: () => this.node.open || this.place(null) },
      el("summary", {}, t`State masses and loads`),
      this.form,
    );
    this.click = (/** @type {PointerEvent} */ event) => this.choose(event);
    this.list();
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
  number(path, name, unit, value, set, note) {
    const box = numberBox(value, undefined, set);
    box.id = `load${++ids}`;
    box.setAttribute("data-path", path);
    return el(
      "div",
      { class: "field" },
      el("label", { for: box.id }, name, unit && el("span", { class: "unit" }, ` (${unit})`)),
      box,
      el("p", { class: "error" }),
      note && el("p", { class: "note" }, note),
    );
  }

  /** @param {string} dimension */
  unit(dimension) {
    return symbolOf(dimension, this.problem);
  }

  speed() {
    const name = this.sliding ? "speed" : "speed_rpm";
    const unit = this.sliding ? `${this.unit("length")}/s` : this.unit("rotational speed");
    return this.number(
      `/dynamics/${name}`,
      t`Speed of the input`,
      unit,
      this.block[name],
      (value) => put(this.block, [name], value),
      t`0 is statics.`,
    );
  }

  gravity() {
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
      this.number(
        "/dynamics/gravity/magnitude",
        t`Gravity`,
        this.unit("gravity"),
        pull.magnitude,
        set("magnitude"),
        t`Empty: none.`,
      ),
      this.number("/dynamics/gravity/angle", t`Gravity pulls towards`, "°", pull.angle, set("angle")),
    ];
  }

  material() {
    const { block } = this;
    const field = (/** @type {string} */ name, /** @type {string} */ dimension) =>
      this.number(`/dynamics/links/${name}`, words(name), this.unit(dimension), at(block, ["links", name]), (value) => {
        put(block, ["links", name], value);
        if (!Object.keys(block.links ?? {}).length) delete block.links;
      });
    return el(
      "fieldset",
      { class: "field member", "data-path": "/dynamics/links", tabindex: -1 },
      el("legend", {}, t`Material of all links`),
      el(
        "div",
        { class: "fields" },
        field("density", "density"),
        field("thickness", "length"),
        field("width", "length"),
      ),
      el("p", { class: "error" }),
    );
  }

  /** @param {() => void} make @param {string} name */
  add(make, name) {
    make();
    this.list();
    const rows = [...this.rows.querySelectorAll("fieldset")].filter((one) => one.dataset.sort === name);
    const row = rows[rows.length - 1];
    row?.querySelector("select")?.focus();
    /** @type {HTMLElement | null | undefined} */ (row?.querySelector("[aria-pressed]"))?.click();
  }

  /** All masses and loads, each with its place and its strength. */
  list() {
    this.place(null);
    this.rows.replaceChildren(
      ...this.masses.map((mass, k) =>
        this.row(
          this.masses,
          k,
          `/dynamics/point_masses/${k}`,
          "point mass",
          this.on(mass, `/dynamics/point_masses/${k}/joint`),
          this.number(`/dynamics/point_masses/${k}/mass`, t`Mass`, this.unit("mass"), mass.mass, (value) =>
            put(mass, ["mass"], value),
          ),
        ),
      ),
      ...this.loads.map((load, k) => {
        const path = `/dynamics/loads/${k}`;
        if (load.joint !== undefined && load.force?.constant) {
          const axis = (/** @type {number} */ n) =>
            this.number(
              `${path}/force/constant/${n}`,
              t`Force ${"xy"[n]}`,
              this.unit("force"),
              at(load, ["force", "constant", String(n)]),
              (value) => put(load, ["force", "constant", String(n)], value ?? null),
            );
          return this.row(this.loads, k, path, "force", this.on(load, `${path}/joint`), axis(0), axis(1));
        }
        if (load.link !== undefined && load.torque && "constant" in load.torque) {
          return this.row(
            this.loads,
            k,
            path,
            "torque",
            this.named(this.links, load, "link", `${path}/link`),
            this.number(`${path}/torque/constant`, t`Torque`, this.unit("torque"), load.torque.constant, (value) =>
              put(load, ["torque", "constant"], value ?? null),
            ),
          );
        }
        return this.row(
          this.loads,
          k,
          path,
          "load",
          el("p", { class: "note" }, t`On ${load.joint ?? load.link}, kept as it is stated.`),
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
  row(all, k, path, sort, ...controls) {
    return el(
      "fieldset",
      { class: "field member", "data-path": path, "data-sort": sort, tabindex: -1 },
      el("legend", {}, words(sort)),
      el("div", { class: "fields" }, ...controls),
      el("p", { class: "error" }),
      el(
        "button",
        {
          type: "button",
          class: "small",
          "aria-label": t`Remove ${`${term(sort)} ${k + 1}`}`,
          onclick: () => {
            all.splice(k, 1);
            this.list();
          },
        },
        t`Remove`,
      ),
    );
  }

  /** @param {string[]} names @param {Mass | Load} row @param {string} key @param {string} path */
  named(names, row, key, path) {
    const box = choice(names, at(row, [key]), false, (value) => put(row, [key], value));
    box.id = `load${++ids}`;
    box.setAttribute("data-path", path);
    return el("div", { class: "field" }, el("label", { for: box.id }, words(key)), box, el("p", { class: "error" }));
  }

  /**
   * The joint of a mass or force: from the list, or by a click on the drawing.
   * @param {Mass | Load} row
   * @param {string} path
   */
  on(row, path) {
    const field = this.named(this.joints, row, "joint", path);
    const select = /** @type {HTMLSelectElement} */ (field.querySelector("select"));
    const button = el(
      "button",
      {
        type: "button",
        class: "small",
        "aria-pressed": "false",
        onclick: () => this.place(this.placing?.button === button ? null : { select, button }),
      },
      t`Choose on the drawing`,
    );
    field.append(button);
    return field;
  }

  /** @param {Placed | null} placed */
  place(placed) {
    this.placing?.button.setAttribute("aria-pressed", "false");
    this.placing = placed;
    placed?.button.setAttribute("aria-pressed", "true");
    this.mover?.picture.classList.toggle("placing", Boolean(placed));
    if (placed) this.mover?.pause();
    this.hint.textContent = placed
      ? t`Click a joint in the drawing above, or choose it from the list. Escape leaves the drawing.`
      : "";
  }

  /** @param {PointerEvent} event */
  choose(event) {
    const { mover, placing } = this;
    if (!mover || !placing) return;
    const [x, y] = mover.view.under(mover.picture, event);
    const now = mover.now();
    const away = mover.linkage.pins.map(({ name }) => {
      const at = now[name];
      return [name, at ? mover.view.scale * Math.hypot(at[0] - x, at[1] - y) : Infinity];
    });
    const [name, distance] = away.sort(([, one], [, other]) => Number(one) - Number(other))[0];
    if (!(Number(distance) < NEAR)) return;
    placing.select.value = String(name);
    placing.select.dispatchEvent(new Event("change"));
    this.place(null);
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
    this.place(null);
    this.button.disabled = true;
    faults.clear(this.form, this.faults);
    try {
      await this.ask(this.block);
      this.answered = true;
    } catch (error) {
      this.tell(error);
    } finally {
      this.button.disabled = false;
    }
  }

  /** @param {unknown} error */
  tell(error) {
    if (error instanceof Refused && error.errors.length) {
      // That a speed is missing is said of the block as a whole.
      const speed = `/dynamics/${this.sliding ? "speed" : "speed_rpm"}`;
      faults.tell(this.form, this.faults, {
        message: error.message,
        errors: error.errors.map(({ path, detail }) => ({ path: path === "/dynamics" ? speed : path, detail })),
      });
    } else if (error instanceof Error && error.name !== "AbortError")
      this.faults.replaceChildren(el("p", { class: "error" }, error.message));
    if (this.answered)
      this.faults.append(el("p", { class: "note" }, t`The forces below are those of what was stated before.`));
  }
}
