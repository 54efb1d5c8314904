/** Burmester's curves of four positions: a pivot is drawn along them, and the linkage on it is solved anew. */

import * as api from "../core/api.js";
import { createElement, formatNumber, createSvg } from "../core/dom.js";
import { Grip, dragWithPointer } from "./grip.js";
import { t, term } from "../core/messages.js";
import { boardSize, createScene } from "./stage.js";
import { View } from "../core/view.js";
import { Zoom } from "./zoom.js";

/** @import { Design, Skeleton, Solved } from "../types/values.js" */

/** Height of what stands above and below the curves, pixels. */
const SURROUNDINGS_HEIGHT = 84;

/** So long a pivot must stand before its linkage is solved, ms. */
const REST_MS = 150;

/** @typedef {[number, number]} Point */
/** @typedef {{circle_points: Point[], centre_points: Point[], closed: boolean}} Branch */
/** A dyad: where on which branch. @typedef {{branch: number, at: number}} Dyad */

const SIDES = /** @type {const} */ ([
  { side: "input_side", moving: "A", fixed: "O2" },
  { side: "output_side", moving: "B", fixed: "O4" },
]);

export class BurmesterCurves {
  /**
   * @param {HTMLElement} place @param {Solved} job of four positions @param {Design} design whose dyads stand first
   * @param {(job: Solved) => void} show called with the job of the new linkage
   */
  constructor(place, job, design, show) {
    const [width, height] = boardSize(place, SURROUNDINGS_HEIGHT);
    this.problem = job.problem;
    /** @type {Branch[]} */
    this.branches = job.result.curves ?? [];
    this.showSolved = show;
    this.gone = new AbortController();
    this.asking = new AbortController();
    this.timer = 0;
    /** The job of the linkage that is shown; it goes when the next comes, unless it is kept. */
    this.trial = "";
    const { joints } = /** @type {Skeleton} */ (design.mechanism.skeleton);
    const positions = job.problem.positions ?? [];
    const around = Object.values(joints).concat(positions.map((one) => [one.x, one.y]));
    this.view = new View(/** @type {Point[]} */ (around), width, height, Math.min(90, 0.2 * Math.min(width, height)));
    this.dyads = SIDES.map(({ moving }) => this.findNearest("circle_points", joints[moving]));
    this.lines = SIDES.map((_, k) => createSvg("line", { class: k ? "arm" : "arm input" }));
    this.picture = createScene(
      this.view,
      t`Burmester curves with draggable pivots`,
      [
        ...this.branches.flatMap((branch) => [
          createSvg("path", {
            class: "centre-points",
            d: this.view.pathData(branch.centre_points) + (branch.closed ? "Z" : ""),
          }),
          createSvg("path", {
            class: "circle-points",
            d: this.view.pathData(branch.circle_points) + (branch.closed ? "Z" : ""),
          }),
        ]),
        ...positions.map((one, k) => this.drawPosition(one, k)),
        ...this.lines,
      ],
      { held: true },
    );
    this.handles = SIDES.flatMap((names, k) => [
      this.createHandle(k, "circle_points", names.moving),
      this.createHandle(k, "centre_points", names.fixed),
    ]);
    this.picture.append(...this.handles.map(({ grip }) => grip.node));
    this.told = createElement(
      "p",
      { class: "note", role: "status" },
      t`Drag a pivot along its curve, or move it with the arrow keys; the linkage on these pivots is then solved.`,
    );
    this.keep = createElement(
      "button",
      {
        type: "button",
        class: "small",
        hidden: true,
        onclick: () => {
          const kept = this.trial;
          this.trial = "";
          location.hash = `job=${kept}`;
        },
      },
      t`Keep this linkage as a job`,
    );
    place.replaceChildren(
      createElement(
        "p",
        { class: "note" },
        createElement("span", { class: "key circle-key" }, t`Circle points`),
        ": ",
        t`possible moving pivots in the first position`,
        "; ",
        createElement("span", { class: "key centre-key" }, t`centre points`),
        ": ",
        t`their fixed pivots`,
        ".",
      ),
      createElement("div", { class: "stage" }, this.picture, new Zoom(this.picture).buttons),
      createElement("div", { class: "row" }, this.told, this.keep),
    );
    this.draw();
  }

  /** @param {{x: number, y: number, angle?: number}} one @param {number} k */
  drawPosition(one, k) {
    const [u, v] = this.view.toPicture(one.x, one.y);
    const angle = ((one.angle ?? 0) * Math.PI) / 180;
    return createSvg(
      "g",
      { class: "goal" },
      createSvg("circle", { cx: u, cy: v, r: 4 }),
      createSvg("line", { x1: u, y1: v, x2: u + 22 * Math.cos(angle), y2: v - 22 * Math.sin(angle) }),
      createSvg("text", { x: u, y: v, dx: 7, dy: 14 }, k + 1),
    );
  }

  /**
   * The dyad whose pivot is nearest to a place.
   * @param {"circle_points" | "centre_points"} which
   * @param {Point} place
   * @returns {Dyad}
   */
  findNearest(which, [x, y]) {
    let least = Infinity;
    let found = { branch: 0, at: 0 };
    this.branches.forEach((branch, n) =>
      branch[which].forEach(([px, py], k) => {
        const away = Math.hypot(px - x, py - y);
        if (away < least) [least, found] = [away, { branch: n, at: k }];
      }),
    );
    return found;
  }

  /** @param {number} k side @param {"circle_points" | "centre_points"} which @param {string} name */
  createHandle(k, which, name) {
    const grip = new Grip({ name, dot: which === "circle_points" ? "dot circle" : "dot centre", role: "slider" });
    grip.node.setAttribute("aria-valuemin", "0");
    dragWithPointer(grip.node, this.picture, this.view, { led: (at) => this.setDyad(k, this.findNearest(which, at)) });
    grip.node.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => {
      const by = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageUp: 10, PageDown: -10 }[event.key];
      if (!by) return;
      event.preventDefault();
      const { branch, at } = this.dyads[k];
      const { circle_points: points, closed } = this.branches[branch];
      const next = closed
        ? (at + by + points.length) % points.length
        : Math.min(points.length - 1, Math.max(0, at + by));
      this.setDyad(k, { branch, at: next });
    });
    return { k, which, name, grip };
  }

  /** @param {number} k @param {Dyad} dyad */
  setDyad(k, dyad) {
    if (dyad.branch === this.dyads[k].branch && dyad.at === this.dyads[k].at) return;
    this.dyads[k] = dyad;
    this.draw();
    clearTimeout(this.timer);
    this.asking.abort();
    this.timer = window.setTimeout(() => this.solve(), REST_MS);
  }

  draw() {
    for (const { k, which, name, grip } of this.handles) {
      const { branch, at } = this.dyads[k];
      const [x, y] = this.branches[branch][which][at];
      grip.moveTo(this.view.toPicture(x, y));
      grip.setLabel(
        which === "circle_points"
          ? t`${name} on the circle points, branch ${branch + 1}`
          : t`${name} on the centre points, branch ${branch + 1}`,
      );
      grip.node.setAttribute("aria-valuemax", String(this.branches[branch][which].length - 1));
      grip.node.setAttribute("aria-valuenow", String(at));
      grip.node.setAttribute("aria-valuetext", `x ${formatNumber(x)}, y ${formatNumber(y)}`);
    }
    this.lines.forEach((line, k) => {
      const { branch, at } = this.dyads[k];
      const [[x1, y1], [x2, y2]] = [
        this.branches[branch].centre_points[at],
        this.branches[branch].circle_points[at],
      ].map((one) => this.view.toPicture(...one));
      for (const [name, value] of Object.entries({ x1, y1, x2, y2 })) line.setAttribute(name, String(value));
    });
  }

  /** The problem with both moving pivots chosen: one linkage, or the reason why there is none. */
  async solve() {
    const asking = (this.asking = new AbortController());
    const chosen = Object.fromEntries(
      SIDES.map(({ side }, k) => [
        side,
        { moving_pivot: this.branches[this.dyads[k].branch].circle_points[this.dyads[k].at] },
      ]),
    );
    this.told.replaceChildren(t`Solving the linkage on these pivots …`);
    try {
      const job = await api.solveNow(
        { ...this.problem, ...chosen, include_failed: true, max_designs: 1 },
        t`Pivots on the Burmester curves`,
        asking.signal,
      );
      if (asking.signal.aborted || this.gone.signal.aborted) {
        await api.removeJob(job.id).catch(() => undefined);
        return;
      }
      const before = this.trial;
      this.trial = job.id;
      this.keep.hidden = false;
      if (!job.result) this.told.replaceChildren(t`The job is ${term(job.status)}; open it to see its progress.`);
      else {
        const found = job.result.designs.length;
        this.told.replaceChildren(
          found
            ? job.result.designs[0].verification.passed
              ? t`Solved: it passes all checks.`
              : t`Solved: it fails a check, listed below.`
            : job.result.summary,
        );
        if (found) this.showSolved(/** @type {Solved} */ (job));
      }
      // Remove the previous job only now, when nothing more is requested of it.
      if (before) api.removeJob(before).catch(() => undefined);
    } catch (error) {
      if (asking.signal.aborted || this.gone.signal.aborted) return;
      const refused = /** @type {api.Refusal} */ (error);
      this.told.replaceChildren(
        createElement("span", { class: "error" }, refused.errors?.[0]?.detail ?? refused.message),
      );
    }
  }

  /** The job of the linkage before is not needed any more. */
  drop() {
    if (this.trial) api.removeJob(this.trial).catch(() => undefined);
    this.trial = "";
  }

  stop() {
    clearTimeout(this.timer);
    this.gone.abort();
    this.asking.abort();
    this.drop();
  }
}
