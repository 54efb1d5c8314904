"""Motion generation: find dyads for both sides, screen all pairs, verify the best distinct ones.

If the positions and the client's choices determine both dyads, there are one or a few linkages, and each is verified.
If freedom remains, all pairs (:mod:`synthesis.kinds.motion.pairs`) are screened, and the best distinct pairs are
verified until enough have passed.

If both sides have the same choices they have the same dyads (always so for five positions), and two of these make one
fourbar that can be driven from either side. It counts as one candidate; each input side that passes gives a design.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial

import numpy as np

from synthesis.kinds.motion.burmester import Window, branches, burmester_curve
from synthesis.kinds.motion.by_type import solve_types
from synthesis.kinds.motion.choices import Cloud
from synthesis.kinds.motion.demanded import demanded
from synthesis.kinds.motion.design import BurmesterBranch, MotionResult
from synthesis.kinds.motion.drawn_poses import solve_drawn
from synthesis.kinds.motion.driver_dyad import undriven, with_driver_dyads
from synthesis.kinds.motion.dyads import DyadConditions
from synthesis.kinds.motion.in_room import solve_in_room
from synthesis.kinds.motion.least_squares import solve_least_squares
from synthesis.kinds.motion.pairs import Pairs, pairs_of_dyads
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.screening import LIMITS
from synthesis.kinds.motion.slider_search import beside_sliders, solve_sliders, with_sliders
from synthesis.kinds.motion.steered import solve_steered, steered_on
from synthesis.kinds.motion.task import MotionTask
from synthesis.model.answer import Search
from synthesis.model.counting import agreeing, counted, grouped
from synthesis.model.kind import Progress, part_of
from synthesis.model.linkage_answer import LinkageDesign
from synthesis.model.linkage_statement import Constraints
from synthesis.model.linkages import to_point
from synthesis.outcome.ranking import ranked
from synthesis.outcome.sifting import DEFECTS, LENGTHS, NUMERICAL, OUTRANKED, Sifting

USABLE_TRANSMISSION_ANGLES = 30.0, 20.0, 10.0, 0.0
"""Transmission angles, degrees, tried in turn as the lower limit if the client sets none: linkages below one of these
are returned only if no candidate reaches it. Practice requires at least 30 to 40 (Norton, Sec. 4.10)."""

CURVES_REACH = 4.0
"""Minimum half-width of the window of Burmester's curves, in task sizes; 1.5 times the reach of the designs if that
is larger."""

CURVES_SAMPLES = 400
"""Number of returned samples of Burmester's curves, over all branches together."""

UNDECIDED = "This does not prove that none exists."
"""Remark for an empty result if some dyad, or its rejection, is numerically uncertain."""

_EITHER_WAY = {"degenerate", "residual", "cannot_be_driven", "circuit_defect"}
"""Rejection reasons that do not depend on which side is the input."""


def solve_motion(problem: MotionProblem, progress: Progress) -> MotionResult:
    """Solve a motion-generation problem by the method that its statement selects."""
    if problem.mechanisms is not None:
        return solve_types(problem, _of_two_dyads, progress)
    return _of_two_dyads(problem, progress)


def _of_two_dyads(problem: MotionProblem, progress: Progress) -> MotionResult:
    """Solve for fourbars, slider-cranks, and fourbars with a driver dyad."""
    if problem.driver is not None:
        # A driver dyad is added to finished fourbars, so these are solved first, without it.
        bare = _of_two_dyads(undriven(problem), part_of(progress, 0.0, 0.8))
        return with_driver_dyads(problem, bare, progress)
    if problem.steered_in_room:
        return _in_room(problem, progress)
    if problem.approximate:
        return solve_least_squares(problem, progress)
    if problem.steered:
        # Designs that meet all positions exactly also satisfy any tolerance: they are cheap, so find them first.
        exact = _exact(problem, part_of(progress, 0.0, 0.3))
        return solve_steered(problem, exact, part_of(progress, 0.3, 1.0))
    if problem.few_tolerated:
        return solve_drawn(problem, _exact, progress)
    return _exact(problem, progress)


def continued(
    problem: MotionProblem, designs: Sequence[LinkageDesign], progress: Progress
) -> list[LinkageDesign] | None:
    """Continue designs of a looser problem to this one; return None if the problem needs no constrained fit."""
    bare = problem if problem.driver is None else undriven(problem)
    if not bare.steered:
        return None
    found = steered_on(bare, designs)
    if problem.driver is None:
        return found
    search = Sifting[LinkageDesign](bare).search("tolerance_search")
    result = MotionResult(designs=found, curves=[], search=search, summary="")
    return list(with_driver_dyads(problem, result, progress).designs)


def _in_room(problem: MotionProblem, progress: Progress) -> MotionResult:
    """Solve for positions with tolerances in a workspace; fall back to a fit that ignores it if no design passes."""
    exact = None if problem.approximate else _exact(problem, part_of(progress, 0.0, 0.3))
    found = solve_in_room(problem, exact, part_of(progress, 0.3, 0.8))
    if any(design.verification.passed for design in found.designs) or not problem.approximate:
        return found
    return solve_least_squares(problem, part_of(progress, 0.8, 1.0))


def _exact(problem: MotionProblem, progress: Progress) -> MotionResult:
    """Solve for two to five positions that are met exactly."""
    if problem.slider is not None:
        return solve_sliders(problem, problem.slider, progress)
    progress(0.0, "finding dyads")
    pairs = pairs_of_dyads(problem)
    if pairs.lacking is not None:
        result = _without_dyads(pairs, *pairs.lacking)
    elif pairs.sampled:
        result = _searched(pairs, progress)
    else:
        result = _determined(pairs, progress)
        noun = "fourbar"
        if pairs.sliders:
            result = beside_sliders(problem, result, pairs.sliders, progress)
            noun = "linkage"
        if not any(design.verification.passed for design in result.designs):
            # Only an enumeration without doubtful roots or residuals proves that no linkage exists.
            end = f"All are enumerated, so no {noun} exists." if result.search.complete else UNDECIDED
            result = result.model_copy(update={"summary": f"{result.summary} {end}"})
    return result if result.designs else with_sliders(problem, result, progress)


def _without_dyads(pairs: Pairs, side: str, cloud: Cloud) -> MotionResult:
    """Build the result for a problem in which one side has no dyad at all, with the reason."""
    method = "dyad_search" if pairs.sampled else "exact"
    search = Sifting[LinkageDesign](pairs.problem).search(method, complete=cloud.complete)
    return _result(pairs, [], search, cloud.reason.replace("the side", f"the {side} side"))


def _determined(pairs: Pairs, progress: Progress) -> MotionResult:
    """Verify every pair of a few determined dyads, with either side as the input if both sides have the same dyads."""
    sifting = Sifting[LinkageDesign](pairs.problem, DEFECTS | LENGTHS)
    target = demanded(pairs.problem)
    for i in range(len(pairs.inputs.fixed)):
        for j in range(i + 1 if pairs.alike else 0, len(pairs.outputs.fixed)):
            reasons = [sifting.keep(pairs.verified(target, (i, j)))]
            # Driving from the other side can only help if the first rejection depends on the input side.
            if pairs.alike and reasons[0] not in _EITHER_WAY:
                reasons.append(sifting.keep(pairs.verified(target, (j, i))))
            sifting.count("" if "" in reasons else reasons[0])
    progress(1.0, "verified")
    complete = all(cloud.complete for cloud in pairs.clouds) and not NUMERICAL & sifting.rejected.keys()
    designs = sifting.designs(partial(ranked, rank_by=pairs.problem.rank_by))
    search = sifting.search("exact", complete=complete)
    return _result(pairs, designs, search, _summary_of_determined(pairs, sifting))


def _searched(pairs: Pairs, progress: Progress) -> MotionResult:
    """Screen all pairs and verify the best distinct ones."""
    problem, target = pairs.problem, demanded(pairs.problem)
    count = len(pairs.inputs.fixed) * len(pairs.outputs.fixed)
    progress(0.1, f"screening {count} pairs of dyads")
    limit = problem.constraints.min_transmission_angle
    # Lower the threshold only if the transmission angle is what rejects pairs: other constraints stay violated.
    for least in USABLE_TRANSMISSION_ANGLES if limit is None else (limit,):
        screening = pairs.screened(problem.constraints, least)
        if screening.score.any() or "transmission_angle" not in screening.rejected():
            break
    sound = int(np.count_nonzero(screening.score))
    progress(0.8, f"verifying the best of {sound} pairs that passed the screening")
    sifting = Sifting[LinkageDesign](problem, DEFECTS | LENGTHS)
    sifting.rejected.update(screening.rejected())
    driven = sifting.sift(pairs.best(screening), partial(pairs.verified, target), enough=problem.max_designs)
    sifting.reject(OUTRANKED, sound - driven)
    if problem.include_failed and len(sifting.passed) < problem.max_designs:
        # Show the best linkages that move correctly but violate a limit; those that violate none are found already.
        stated = problem.constraints
        motion_alone = Constraints(same_branch=stated.same_branch, in_order=stated.in_order)
        passed = list(sifting.passed)
        if LIMITS & screening.rejected().keys():
            screening = pairs.screened(motion_alone, 0.0)
        for pair in pairs.best(screening)[: problem.max_designs]:
            sifting.keep(pairs.verified(target, pair))
        # This second screening is only for failed designs; it must not change the list of passed ones.
        sifting.passed = passed
    progress(1.0, "verified")
    designs = sifting.designs(partial(ranked, rank_by=problem.rank_by))
    return _result(pairs, designs, sifting.search("dyad_search"), _summary_of_search(sifting, sound))


def _result(pairs: Pairs, designs: list[LinkageDesign], search: Search, summary: str) -> MotionResult:
    return MotionResult(
        designs=designs,
        curves=_curves(pairs.task, designs),
        search=search,
        summary=" ".join([summary, *_remarks(pairs)]),
    )


def _summary_of_determined(pairs: Pairs, sifting: Sifting[LinkageDesign]) -> str:
    count, accepted = sifting.candidates, sifting.accepted
    verb = agreeing(accepted, "carries", "carry")
    linkages = counted(count, "linkage")
    if pairs.alike:
        dyads = len(pairs.inputs.fixed)
        text = f"{counted(dyads, 'dyad')} with two pins {agreeing(dyads, 'gives', 'give')} {linkages}"
        text += f"; {accepted} of them {verb} the body through all positions." if count else "."
        if accepted and len(sifting.passed) > accepted:
            text += f" Of these, {len(sifting.passed) - accepted} can be driven from either side."
    else:
        text = f"{accepted} of {linkages} with the given choices {verb} the body through all positions."
    return text + sifting.reasons()


def _summary_of_search(sifting: Sifting[LinkageDesign], sound: int) -> str:
    if not sifting.passed:
        return (
            f"No design found: each of the {grouped(sifting.candidates)} dyad pairs tried violates a constraint "
            f"(rejected: {sifting.listed(OUTRANKED)}). The search is not exhaustive, so a solution may still exist."
        )
    best = max(design.metrics.min_transmission_angle for design in sifting.passed)
    text = (
        f"{counted(len(sifting.passed), 'design', 'designs')} verified, chosen from {grouped(sound)} feasible dyad "
        f"pairs ({grouped(sifting.candidates)} tried). Best minimum transmission angle: {best:.1f}°."
    )
    if best < USABLE_TRANSMISSION_ANGLES[0]:
        text += f" No design found reaches {USABLE_TRANSMISSION_ANGLES[0]:.0f}°."
    return text


def _remarks(pairs: Pairs) -> list[str]:
    """List remarks on the dyads that the linkages do not show, such as sliders (pivots at infinity)."""
    remarks = []
    names = ("side",) if pairs.alike else ("input side", "output side")
    for name, cloud in zip(names, pairs.clouds, strict=False):
        if cloud.remark:
            remarks.append(cloud.remark.replace("the side", f"the {name}").strip())
        if cloud.sliders:
            count = len(cloud.sliders)
            kinds = " and ".join(sorted({slider.kind for slider in cloud.sliders}))
            remarks.append(
                f"{counted(count, 'more dyad')} of the {name} {agreeing(count, 'has', 'have')} a pivot at infinity, "
                f"that is, a slider ({kinds})."
            )
    return list(dict.fromkeys(remarks))


def _curves(task: MotionTask, designs: list[LinkageDesign]) -> list[BurmesterBranch]:
    """Sample Burmester's curves of four positions for drawing, in a window that contains all designs."""
    if len(task.points) != 4:
        return []
    curve = burmester_curve(task, DyadConditions(rotations=(None,) * 3))
    if curve is None:
        return []
    pivots = [joint for design in designs for joint in design.mechanism.skeleton.joints.values()]
    reach = max((abs(task.to_task(complex(*pivot))) for pivot in pivots), default=0.0)
    centres = complex(task.points.mean()), complex(task.points[0])
    window = Window(centres, max(CURVES_REACH, 1.5 * reach), math.inf)
    return [
        BurmesterBranch(
            centre_points=[to_point(task.to_problem(complex(z))) for z in branch.dyads.fixed],
            circle_points=[to_point(task.to_problem(complex(z))) for z in branch.dyads.moving],
            closed=branch.closed,
        )
        for branch in branches(curve, window, CURVES_SAMPLES)
    ]
