"""Motion generation: find dyads for both sides, screen all pairs, verify the best distinct ones.

If the positions and the client's choices determine both dyads, there are one or a few linkages, and each is verified.
If freedom remains, all pairs (:mod:`synthesis.kinds.motion.exact.dyad_pairs`) are screened, and the best distinct pairs
are verified until enough have passed.

If both sides have the same choices they have the same dyads (always so for five positions), and two of these make one
fourbar that can be driven from either side. It counts as one candidate; each input side that passes gives a design.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial

import numpy as np

from kinematics.message import compose, join_messages
from synthesis.kinds.motion.constrained.in_workspace import solve_in_workspace
from synthesis.kinds.motion.constrained.sampled_poses import solve_sampled_poses
from synthesis.kinds.motion.constrained.solver import continue_constrained, solve_with_tolerances
from synthesis.kinds.motion.design import BurmesterBranch, MotionResult
from synthesis.kinds.motion.driver.solver import add_driver_dyads, remove_driver
from synthesis.kinds.motion.dyads.burmester import Window, find_burmester_curve, sample_branches
from synthesis.kinds.motion.dyads.candidates import Cloud
from synthesis.kinds.motion.dyads.equations import DyadConditions
from synthesis.kinds.motion.exact.dyad_pairs import DyadPairs, make_pairs
from synthesis.kinds.motion.exact.screening import LIMIT_REASONS
from synthesis.kinds.motion.exact.slider_cranks import merge_sliders, solve_sliders, try_sliders
from synthesis.kinds.motion.least_squares.solver import solve_least_squares
from synthesis.kinds.motion.plain_guide import add_plain_guide
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.task.positions import MotionTask
from synthesis.kinds.motion.type_selection import solve_types
from synthesis.model.answer import Search
from synthesis.model.kind import Progress, return_true, scale_progress
from synthesis.model.linkage.answer import LinkageDesign
from synthesis.model.linkage.conversion import to_point
from synthesis.model.linkage.problem import Constraints
from synthesis.model.method_table import Method, solve_by_first
from synthesis.results.candidate_log import (
    DEFECT_REASONS,
    LENGTH_REASONS,
    NUMERICAL_REASONS,
    OUTRANKED_REASON,
    CandidateLog,
)
from synthesis.results.ranking import rank_designs

USABLE_TRANSMISSION_ANGLES = 30.0, 20.0, 10.0, 0.0
"""Transmission angles, degrees, tried in turn as the lower limit if the client sets none: linkages below one of these
are returned only if no candidate reaches it. Practice requires at least 30 to 40 (Norton, Sec. 4.10)."""

MIN_CURVE_WINDOW = 4.0
"""Minimum half-width of the window of Burmester's curves, in task sizes; 1.5 times the reach of the designs if that
is larger."""

CURVE_SAMPLE_COUNT = 400
"""Number of returned samples of Burmester's curves, over all branches together."""

_INPUT_INDEPENDENT_REASONS = {"degenerate", "residual", "cannot_be_driven", "circuit_defect"}
"""Rejection reasons that do not depend on which side is the input."""


def solve_motion(problem: MotionProblem, progress: Progress) -> MotionResult:
    """Solve a motion-generation problem by the method that its statement selects."""
    if problem.mechanisms is not None:
        result = solve_types(problem, _solve_two_dyads, progress)
    else:
        result = _solve_two_dyads(problem, progress)
    return add_plain_guide(problem, result)


def continue_from_designs(
    problem: MotionProblem, designs: Sequence[LinkageDesign], progress: Progress
) -> list[LinkageDesign] | None:
    """Continue designs of a looser problem to this one; return None if the problem needs no constrained fit."""
    bare = problem if problem.driver is None else remove_driver(problem)
    if not bare.is_constrained_fit:
        return None
    found = continue_constrained(bare, designs)
    if problem.driver is None:
        return found
    # Driver dyads need a result as input; the counts do not matter here.
    search = CandidateLog[LinkageDesign](bare).build_search("tolerance_search")
    result = MotionResult(designs=found, curves=[], search=search, summary="")
    return list(add_driver_dyads(problem, result, progress).designs)


def _solve_with_driver(problem: MotionProblem, progress: Progress) -> MotionResult:
    """Solve without the driver dyad, which is then added to the finished fourbars."""
    bare = _solve_two_dyads(remove_driver(problem), scale_progress(progress, 0.0, 0.8))
    return add_driver_dyads(problem, bare, progress)


def _solve_toleranced(problem: MotionProblem, progress: Progress) -> MotionResult:
    """Solve for positions with tolerances by constrained fits, next to exact designs."""
    # Designs that meet all positions exactly also satisfy any tolerance: they are cheap, so find them first.
    exact = _solve_exact(problem, scale_progress(progress, 0.0, 0.3))
    return solve_with_tolerances(problem, exact, scale_progress(progress, 0.3, 1.0))


def _solve_in_workspace(problem: MotionProblem, progress: Progress) -> MotionResult:
    """Solve for positions with tolerances in a workspace; fall back to a fit that ignores it if no design passes."""
    # Many positions have no exact solution to start from.
    exact = None if problem.approximate else _solve_exact(problem, scale_progress(progress, 0.0, 0.3))
    found = solve_in_workspace(problem, exact, scale_progress(progress, 0.3, 0.8))
    # With few positions the exact designs already belong to the result, so it is final.
    if any(design.verification.passed for design in found.designs) or not problem.approximate:
        return found
    return solve_least_squares(problem, scale_progress(progress, 0.8, 1.0))


def _solve_some_toleranced(problem: MotionProblem, progress: Progress) -> MotionResult:
    """Solve for few positions with tolerances: exactly, for sampled poses within them."""
    return solve_sampled_poses(problem, _solve_exact, progress)


def _solve_exact(problem: MotionProblem, progress: Progress) -> MotionResult:
    """Solve for two to five positions that are met exactly."""
    if problem.slider is not None:
        return solve_sliders(problem, problem.slider, progress)
    progress(0.0, compose("motion-finding-dyads"))
    pairs = make_pairs(problem)
    if pairs.missing_side is not None:
        result = _report_missing_dyads(pairs, *pairs.missing_side)
    elif pairs.is_sampled:
        result = _search_pairs(pairs, progress)
    else:
        result = _verify_all_pairs(pairs, progress)
        none_exists = "motion-no-fourbar-exists"
        if pairs.sliders:
            result = merge_sliders(problem, result, pairs.sliders, progress)
            none_exists = "motion-no-linkage-exists"
        if not any(design.verification.passed for design in result.designs):
            # Only an enumeration without doubtful roots or residuals proves that no linkage exists.
            end = compose(none_exists if result.search.complete else "motion-unproven")
            result = result.model_copy(update={"summary": join_messages([result.summary, end])})
    # Sliders are the last resort: fourbars are preferred in practice.
    return result if result.designs else try_sliders(problem, result, progress)


_METHODS: tuple[Method[MotionProblem, MotionResult], ...] = (
    Method(lambda problem: problem.driver is not None, _solve_with_driver),
    Method(lambda problem: problem.is_workspace_fit, _solve_in_workspace),
    Method(lambda problem: problem.approximate, solve_least_squares),
    Method(lambda problem: problem.is_constrained_fit, _solve_toleranced),
    Method(lambda problem: problem.has_few_tolerances, _solve_some_toleranced),
    Method(return_true, _solve_exact),
)
"""Methods for fourbars, slider-cranks, and fourbars with a driver dyad."""


def _solve_two_dyads(problem: MotionProblem, progress: Progress) -> MotionResult:
    """Solve for fourbars, slider-cranks, and fourbars with a driver dyad."""
    return solve_by_first(_METHODS, problem, progress)


def _report_missing_dyads(pairs: DyadPairs, side: str, cloud: Cloud) -> MotionResult:
    """Build the result for a problem in which one side has no dyad at all, with the reason; ``side`` is its name."""
    assert cloud.reason is not None
    method = "dyad_search" if pairs.is_sampled else "exact"
    search = CandidateLog[LinkageDesign](pairs.problem).build_search(method, complete=cloud.complete)
    return _build_result(pairs, [], search, cloud.reason.write(side))


def _verify_all_pairs(pairs: DyadPairs, progress: Progress) -> MotionResult:
    """Verify every pair of a few determined dyads, with either side as the input if both sides have the same dyads."""
    sifting = CandidateLog[LinkageDesign](pairs.problem, DEFECT_REASONS | LENGTH_REASONS)
    # Each pair of equal dyads once; the other order swaps input and output.
    for i in range(len(pairs.inputs.fixed)):
        for j in range(i + 1 if pairs.same_dyads else 0, len(pairs.outputs.fixed)):
            reasons = [sifting.insert_design(pairs.verify_pair((i, j)))]
            # Driving from the other side can only help if the first rejection depends on the input side.
            if pairs.same_dyads and reasons[0] not in _INPUT_INDEPENDENT_REASONS:
                reasons.append(sifting.insert_design(pairs.verify_pair((j, i))))
            sifting.count("" if "" in reasons else reasons[0])
    progress(1.0, compose("motion-verified"))
    complete = all(cloud.complete for cloud in pairs.clouds) and not NUMERICAL_REASONS & sifting.rejected.keys()
    designs = sifting.select_designs(partial(rank_designs, rank_by=pairs.problem.rank_by))
    search = sifting.build_search("exact", complete=complete)
    return _build_result(pairs, designs, search, _describe_determined(pairs, sifting))


def _search_pairs(pairs: DyadPairs, progress: Progress) -> MotionResult:
    """Screen all pairs and verify the best distinct ones."""
    problem = pairs.problem
    count = len(pairs.inputs.fixed) * len(pairs.outputs.fixed)
    progress(0.1, compose("motion-screening-dyad-pairs", count=count))
    limit = problem.constraints.min_transmission_angle
    # Lower the threshold only if the transmission angle is what rejects pairs: other constraints stay violated.
    for least in USABLE_TRANSMISSION_ANGLES if limit is None else (limit,):
        screening = pairs.screen_pairs(problem.constraints, least)
        # Any candidate at this angle, or a different obstacle, ends the search.
        if screening.score.any() or "transmission_angle" not in screening.count_rejections():
            break
    sound = int(np.count_nonzero(screening.score))
    progress(0.8, compose("motion-verifying-best-pairs", count=sound))
    sifting = CandidateLog[LinkageDesign](problem, DEFECT_REASONS | LENGTH_REASONS)
    sifting.rejected.update(screening.count_rejections())
    driven = sifting.verify_candidates(pairs.select_best(screening), pairs.verify_pair, enough=problem.max_designs)
    sifting.reject(OUTRANKED_REASON, sound - driven)
    if problem.include_failed and len(sifting.passed) < problem.max_designs:
        # Show the best linkages that move correctly but violate a limit; those that violate none are found already.
        stated = problem.constraints
        # Only the constraints of a sound motion remain.
        motion_alone = Constraints(same_branch=stated.same_branch, in_order=stated.in_order)
        passed = list(sifting.passed)
        if LIMIT_REASONS & screening.count_rejections().keys():
            screening = pairs.screen_pairs(motion_alone, 0.0)
        for pair in pairs.select_best(screening)[: problem.max_designs]:
            sifting.insert_design(pairs.verify_pair(pair))
        # This second screening is only for failed designs; it must not change the list of passed ones.
        sifting.passed = passed
    progress(1.0, compose("motion-verified"))
    designs = sifting.select_designs(partial(rank_designs, rank_by=problem.rank_by))
    return _build_result(pairs, designs, sifting.build_search("dyad_search"), _describe_search(sifting, sound))


def _build_result(pairs: DyadPairs, designs: list[LinkageDesign], search: Search, summary: str) -> MotionResult:
    return MotionResult(
        designs=designs,
        curves=_sample_curves(pairs.task, designs),
        search=search,
        summary=join_messages([summary, *_list_remarks(pairs)]),
    )


def _describe_determined(pairs: DyadPairs, sifting: CandidateLog[LinkageDesign]) -> str:
    count, accepted = sifting.candidates, sifting.accepted
    if not pairs.same_dyads:
        found = [compose("motion-linkages-with-choices", accepted=accepted, linkages=count)]
    elif count:
        dyads = len(pairs.inputs.fixed)
        found = [compose("motion-dyads-give-linkages", dyads=dyads, linkages=count, accepted=accepted)]
        if accepted and len(sifting.passed) > accepted:
            found.append(compose("motion-driven-from-either-side", count=len(sifting.passed) - accepted))
    else:
        # Two dyads would make a pair.
        found = [compose("motion-single-dyad")]
    return join_messages([*found, sifting.describe_reasons().strip()])


def _describe_search(sifting: CandidateLog[LinkageDesign], sound: int) -> str:
    if not sifting.passed:
        reasons = sifting.format_reasons(OUTRANKED_REASON)
        return compose("motion-no-pair-feasible", candidates=sifting.candidates, reasons=reasons)
    best = max(design.metrics.min_transmission_angle for design in sifting.passed)
    found = [
        compose(
            "motion-designs-from-pairs", designs=len(sifting.passed), feasible=sound, candidates=sifting.candidates
        ),
        compose("motion-best-transmission-angle", angle=f"{best:.1f}"),
    ]
    if best < USABLE_TRANSMISSION_ANGLES[0]:
        found.append(compose("motion-angle-not-reached", angle=f"{USABLE_TRANSMISSION_ANGLES[0]:.0f}"))
    return join_messages(found)


def _list_remarks(pairs: DyadPairs) -> list[str]:
    """List remarks on the dyads that the linkages do not show, such as sliders (pivots at infinity)."""
    remarks = []
    sides = ("motion-side",) if pairs.same_dyads else ("motion-input-side", "motion-output-side")
    for side, cloud in zip(sides, pairs.clouds, strict=False):
        remarks += [remark.write(side) for remark in cloud.remarks]
        if cloud.sliders:
            first, *others = sorted({slider.kind for slider in cloud.sliders})
            # There are two kinds of sliders, PR and RP.
            kinds = compose("motion-two-slider-kinds", first=first, second=others[0]) if others else first
            remarks.append(
                compose("motion-dyads-are-sliders", count=len(cloud.sliders), side=compose(side), kinds=kinds)
            )
    return list(dict.fromkeys(remarks))


def _sample_curves(task: MotionTask, designs: list[LinkageDesign]) -> list[BurmesterBranch]:
    """Sample Burmester's curves of four positions for drawing, in a window that contains all designs."""
    if len(task.points) != 4:
        return []
    curve = find_burmester_curve(task, DyadConditions(rotations=(None,) * 3))
    if curve is None:
        return []
    pivots = [joint for design in designs for joint in design.mechanism.skeleton.joints.values()]
    reach = max((abs(task.to_task(complex(*pivot))) for pivot in pivots), default=0.0)
    centres = complex(task.points.mean()), complex(task.points[0])
    # Clip infinite branches: the window covers the designs and the surroundings of the task.
    window = Window(centres, max(MIN_CURVE_WINDOW, 1.5 * reach), math.inf)
    return [
        BurmesterBranch(
            centre_points=[to_point(task.to_problem(complex(z))) for z in branch.dyads.fixed],
            circle_points=[to_point(task.to_problem(complex(z))) for z in branch.dyads.moving],
            closed=branch.closed,
        )
        for branch in sample_branches(curve, window, CURVE_SAMPLE_COUNT)
    ]
