/** Draw the other circuits of a linkage faintly. */

import { createElement, createSvg } from "../core/dom.js";
import { LinkageDrawing, drawnJoints, groundedJoints } from "../canvas/linkage_drawing.js";
import { t } from "../core/messages.js";

/** @import { LinkageAnalysis, Skeleton } from "../types/values.js" */

/** @typedef {[number, number]} Point */
/**
 * @typedef {{from: number, to: number, full: boolean, reference: boolean, circuit: number, joints: Record<string, {x:
 *   (number | null)[], y: (number | null)[]}>}} Branch
 */

/**
 * Branches other than the one that moves, as far as their joints are known.
 * @param {LinkageAnalysis | null} [motion] with `branches` included
 * @returns {Branch[]}
 */
export function otherBranches(motion) {
  return (motion?.circuits ?? []).flatMap((circuit, n) =>
    circuit.branches.flatMap(({ joints, ...branch }) =>
      !branch.reference && joints ? [{ ...branch, joints, circuit: n }] : [],
    ),
  );
}

/** Return the joint whose path describes the motion best: P, or the last pin that moves. @param {Skeleton} skeleton */
export function findTracedJoint(skeleton) {
  const still = groundedJoints(skeleton);
  const names = drawnJoints(skeleton).filter((name) => !still.includes(name));
  return names.includes("P") ? "P" : (names.at(-1) ?? "");
}

/** @param {Branch} branch @param {string} name @returns {Point[]} */
export function branchTrack(branch, name) {
  const { x, y } = branch.joints[name] ?? { x: [], y: [] };
  return x.map((one, k) => (one === null ? [NaN, NaN] : [one, Number(y[k])]));
}

export class OtherCircuits {
  /**
   * @param {import("../core/view.js").View} view
   * @param {Skeleton} skeleton
   * @param {LinkageAnalysis | null} [motion] with `branches` included
   */
  constructor(view, skeleton, motion) {
    const circuits = motion?.circuits ?? [];
    this.branches = otherBranches(motion);
    const name = findTracedJoint(skeleton);
    const own = circuits.findIndex((one) => one.branches.some((branch) => branch.reference));
    this.ghosts = this.branches.map((branch) => ({
      branch,
      linkage: new LinkageDrawing(view, skeleton, { names: false, faint: true }),
    }));
    this.node = createSvg(
      "g",
      { class: "others" },
      ...this.branches.map((branch) =>
        createSvg("path", { class: "curve other", d: view.pathData(branchTrack(branch, name)) }),
      ),
      ...this.ghosts.map((ghost) => ghost.linkage.node),
    );
    const box = createElement("input", {
      type: "checkbox",
      id: "circuits",
      onchange: () => this.node.toggleAttribute("hidden", !box.checked),
    });
    // Of a linkage with many branches, as Peaucellier's, a drawing of all shows nothing any more.
    box.checked = this.branches.length <= 3;
    this.node.toggleAttribute("hidden", !box.checked);
    const branches = circuits.reduce((/** @type {number} */ sum, one) => sum + one.branches.length, 0);
    const text =
      circuits.length === 1
        ? branches === 2
          ? t`The other branch of its only circuit is faint`
          : t`The other branches of its only circuit are faint`
        : [
            circuits.length > 2 ? t`Other circuits (faint)` : t`Other circuit (faint)`,
            [
              own >= 0 && t`it moves on circuit ${own + 1} of ${circuits.length}`,
              branches > circuits.length && t`with ${branches} branches in total`,
            ]
              .filter(Boolean)
              .join(", "),
          ]
            .filter(Boolean)
            .join(": ");
    this.control = this.branches.length
      ? createElement("label", { class: "flag", for: "circuits" }, box, text)
      : circuits.length === 1 && createElement("span", { class: "note" }, t`It has a single circuit without toggles.`);
  }

  /**
   * Where the other circuits are at the same input.
   * @param {number | null} input degrees, or a length along the slide
   * @param {number} period
   */
  show(input, period = 360) {
    if (this.node.hasAttribute("hidden")) return;
    for (const { branch, linkage } of this.ghosts) {
      const { from, to } = branch;
      const on = input === null ? NaN : input - period * Math.floor((input - from) / period);
      let share = (on - from) / (to - from);
      linkage.node.toggleAttribute("hidden", !(share >= 0 && share <= 1));
      if (!(share >= 0 && share <= 1)) continue;
      // Between toggles the places lie closer together at the ends.
      if (!branch.full) share = Math.acos(1 - 2 * share) / Math.PI;
      linkage.moveTo(
        Object.fromEntries(
          Object.entries(branch.joints).map(([name, { x, y }]) => {
            const at = share * (x.length - 1);
            const k = Math.min(x.length - 2, Math.floor(at));
            const [one, next] = [x[k], x[k + 1]];
            return [
              name,
              one === null || next === null
                ? null
                : [one + (at - k) * (next - one), Number(y[k]) + (at - k) * (Number(y[k + 1]) - Number(y[k]))],
            ];
          }),
        ),
      );
    }
  }
}
