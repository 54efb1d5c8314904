/** Show a linkage from an address, as simulated by this service. */

import * as api from "../core/api.js";
import { fetchCycle, inputAngle } from "../motion/cycle.js";
import { createElement } from "../core/dom.js";
import { createFacts } from "../motion/linkage_facts.js";
import { Explorer } from "../explorer/explorer.js";
import { t, term } from "../core/messages.js";
import { LinkageMotion, listTargets } from "../motion/linkage_motion.js";

/** @import { Problem } from "../types/values.js" */

/** Samples of its cycle. */
const STEP_COUNT = 240;

export class SharedLinkage {
  /**
   * @param {import("../design/workbench.js").Workbench} desk
   * @param {import("../core/address_fragment.js").SharedContent} sent
   * @param {(problem: Problem, solved?: boolean) => void} state begins another statement
   */
  constructor(desk, sent, state) {
    this.desk = desk;
    this.sent = sent;
    this.state = state;
    this.gone = new AbortController();
    /** @type {LinkageMotion | null} */
    this.moving = null;
    /** @type {Explorer | null} */
    this.explorer = null;
  }

  /** Drive it and show it; the service's refusal is the caller's. */
  async show() {
    const { desk, gone, sent } = this;
    const { mechanism } = sent;
    if (!mechanism) return;
    const { motion, circuits } = await fetchCycle(mechanism, STEP_COUNT, gone.signal);
    // The motion that is shown ends where a toggle ends it; whether the input turns through a whole turn says.
    const from = inputAngle(mechanism.skeleton);
    const turn =
      from === null
        ? motion
        : await api.analyse({ mechanism, motion: { from, to: from + 360, steps: STEP_COUNT } }, gone.signal);
    if (gone.signal.aborted) return;
    const named = t`From the address: ${term(mechanism.type)}`;
    const problem = sent.placed ? { ...sent.problem, positions: [], points: [] } : sent.problem;
    desk.stage.offerMotion(true, named);
    desk.stage.showMode("watch");
    desk.shown = { mechanism, placement: sent.placed };
    desk.title.replaceChildren(named);
    this.moving = new LinkageMotion(desk.frame, { mechanism }, motion, problem, circuits);
    const { facts } = createFacts(turn, mechanism.skeleton, listTargets(problem, null), problem.length_unit ?? "mm");
    desk.numbers.replaceChildren(
      createElement(
        "p",
        { class: "note" },
        t`This linkage came in the address. This service has simulated it; press Solve to check it against the problem.`,
      ),
      createElement(
        "dl",
        { class: "facts" },
        ...Object.entries(facts).flatMap(([name, value]) => [
          createElement("dt", {}, name),
          createElement("dd", {}, value),
        ]),
      ),
    );
    desk.offerExploring(true);
    desk.drawer.setReaction("explore", {
      opened: () => {
        this.moving?.pause();
        desk.stage.showMode("explore");
        this.explorer = desk.explorer = new Explorer(
          desk.exploring,
          desk.explore,
          mechanism,
          problem,
          listTargets(problem, null),
          this.state,
        );
      },
      closed: () => {
        this.explorer?.stop();
        this.explorer = desk.explorer = null;
        desk.exploring.replaceChildren();
        if (desk.stage.mode === "explore") desk.stage.showMode("watch");
      },
    });
  }

  /** Make room for something else. */
  leave() {
    if (this.gone.signal.aborted) return;
    this.gone.abort();
    if (!this.moving) return;
    this.desk.drawer.setReaction("explore", null);
    this.desk.explorer = null;
    this.moving.stop();
    this.desk.clear();
    this.desk.stage.offerMotion(false);
  }
}
