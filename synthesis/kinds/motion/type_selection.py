"""Selection of the linkage type: the simplest feasible type, or sixbars if no simpler one is good enough.

A fourbar or slider-crank that satisfies all constraints is sufficient if its minimum transmission angle reaches the
client's limit or, without a limit, :data:`~synthesis.results.simplest_type.SOUND_TRANSMISSION_ANGLE` degrees. Otherwise
sixbars are searched, and those with a larger transmission angle are listed after it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

from kinematics.message import compose, join_messages
from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.sixbar.solver import solve_sixbars
from synthesis.kinds.motion.statement.mechanism_types import SIXBARS, list_unsupported, list_unsupported_stephenson_2
from synthesis.kinds.motion.statement.positions import MAX_EXACT_POSITIONS
from synthesis.kinds.motion.task.ranking import get_rms_error, make_ranking
from synthesis.model.kind import Progress
from synthesis.model.linkage.answer import LinkageDesign
from synthesis.model.linkage.type_choice import describe_skipped_sixbars, describe_unclassed, select_searched_types
from synthesis.results.simplest_type import (
    ERROR_RATIO,
    describe_alternatives,
    has_good_transmission,
    merge_alternatives,
    merge_results,
    prefer_simplest,
    select_passing,
)

Solve = Callable[[MotionProblem, Progress], MotionResult]

MAX_SUFFICIENT_ERROR = 1e-3
"""Error of a fit, as a share of the task's size, below which sixbars are not searched."""


def solve_types(problem: MotionProblem, two_dyads: Solve, progress: Progress) -> MotionResult:
    """Solve for the types of linkage that a problem requests.

    Parameters
    ----------
    problem : MotionProblem
        A problem with :attr:`MotionProblem.mechanisms`.
    two_dyads : callable
        Solver for fourbars and slider-cranks of a problem without that field.
    progress : callable
        Progress callback.
    """
    part = problem.two_dyad_problem
    answer: MotionResult = prefer_simplest(
        None if part is None else partial(two_dyads, part),
        partial(_solve_sixbars, problem) if problem.sixbars else None,
        partial(_is_sufficient, problem),
        partial(_merge_by_error if problem.is_least_squares else merge_type_results, problem),
        progress,
        # A list of types was the client's choice, so only types with unsupported constraints are explained.
        describe_skipped_sixbars(list_unsupported(problem))
        if problem.mechanisms == "auto"
        else _describe_unclassed(problem),
    )
    return answer


def _solve_sixbars(problem: MotionProblem, progress: Progress) -> MotionResult:
    """Solve for the sixbars that support the given constraints; report the types that do not."""
    found = solve_sixbars(problem, problem.sixbars, progress)
    remark = _describe_unclassed(problem)
    return found.model_copy(update={"summary": join_messages([found.summary, remark])}) if remark else found


def _describe_unclassed(problem: MotionProblem) -> str:
    return describe_unclassed(
        select_searched_types(problem.mechanisms, SIXBARS, list_unsupported(problem)),
        list_unsupported_stephenson_2(problem),
    )


def _is_sufficient(problem: MotionProblem, design: LinkageDesign) -> bool:
    """Return whether a linkage transmits well enough and, if positions are fitted, is accurate enough."""
    return has_good_transmission(problem, design) and (
        not problem.is_least_squares or get_rms_error(design) <= MAX_SUFFICIENT_ERROR
    )


def _merge_by_error(problem: MotionProblem, simple: MotionResult, found: MotionResult) -> MotionResult:
    """Merge both results if positions are fitted: keep sixbars with half the error, or if only they transmit well."""
    plain, better = select_passing(simple.designs), select_passing(found.designs)
    sound = [design for design in plain if has_good_transmission(problem, design)]
    alone = [design for design in better if has_good_transmission(problem, design)]
    only_sixbars_transmit = not sound and bool(alone)
    least = min(map(get_rms_error, sound or plain), default=math.inf)
    if plain and only_sixbars_transmit:
        better = alone
    elif plain:
        # Compare with simpler linkages that could be used; if none can, with all of them.
        better = [design for design in better if get_rms_error(design) <= ERROR_RATIO * least]
    # Drop simpler linkages that transmit badly if sixbars can replace them.
    kept = (sound or plain) if better else plain
    offered = merge_alternatives(problem.max_designs, kept, better, make_ranking(problem))
    sixbars = [design for design in offered if any(design is one for one in better)]
    listing = describe_alternatives(problem, len(offered), len(sixbars))
    if not plain:
        remark = compose("motion-only-sixbars-feasible" if better else "motion-no-type-feasible")
    elif not better:
        remark = compose("motion-no-sixbar-closer", error=f"{100.0 * least:.3g}")
    elif only_sixbars_transmit:
        remark = compose("motion-only-sixbars-transmit", listing=listing)
    else:
        remark = compose("motion-sixbars-closer", error=f"{100.0 * least:.3g}", listing=listing)
    return merge_results(problem.max_designs, (simple, found), offered, len(sixbars), remark, make_ranking(problem))


def merge_type_results(problem: MotionProblem, simple: MotionResult, found: MotionResult) -> MotionResult:
    """Merge the result for fourbars and slider-cranks that transmit badly, if any, with that for sixbars.

    Sixbars are added only if their transmission angle exceeds that of the best simpler linkage. Designs that passed but
    are not returned count as outranked.
    """
    plain, better = select_passing(simple.designs), select_passing(found.designs)
    best = max((design.metrics.min_transmission_angle for design in plain), default=0.0)
    if plain:
        # Without a simpler linkage every sixbar is an improvement.
        better = [design for design in better if design.metrics.min_transmission_angle > best]

    order = make_ranking(problem)
    offered = merge_alternatives(problem.max_designs, plain, better, order)
    sixbars = [design for design in offered if any(design is one for one in better)]
    if not plain:
        remark = _describe_without_simple(problem, simple, better)
    elif not better:
        remark = compose("motion-no-sixbar-transmits-better", angle=f"{best:.1f}")
    else:
        listing = describe_alternatives(problem, len(offered), len(sixbars))
        remark = compose("motion-sixbars-transmit-better", angle=f"{best:.1f}", listing=listing)
    return merge_results(problem.max_designs, (simple, found), offered, len(sixbars), remark, order)


def _describe_without_simple(problem: MotionProblem, simple: MotionResult, sixbars: list[LinkageDesign]) -> str:
    """Describe a result without a fourbar or slider-crank; claim that none exists only if that is proved."""
    every = problem.mechanisms == "auto"  # no list has inverted slider-cranks
    # Five exact positions leave a few dyads, including sliders, all enumerated. With fewer, sliders are only sampled.
    exact = len(problem.positions) == MAX_EXACT_POSITIONS and all(
        limits == (0.0, 0.0, 0.0) for limits in problem.limits
    )
    if every and exact and simple.search.complete:
        return compose("motion-only-sixbars-exist" if sixbars else "motion-simple-types-impossible")
    if problem.mechanisms == "auto":
        return compose("motion-only-sixbars-found" if sixbars else "motion-no-type-found")
    return compose("motion-only-sixbars-of-requested-types" if sixbars else "motion-no-requested-type-found")
