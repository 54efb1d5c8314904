"""Selection of the linkage type: the simplest feasible type, sixbars or eightbars if no simpler one is good enough.

A fourbar or slider-crank that satisfies all constraints is sufficient if its minimum transmission angle reaches the
client's limit or, without a limit, :data:`~synthesis.results.simplest_type.SOUND_TRANSMISSION_ANGLE` degrees. Otherwise
sixbars are searched, and those with a larger transmission angle are listed after it. Eightbars follow in the same way
if the client names them, or for ``auto`` if all other linkages miss fitted positions by more than
:data:`MAX_SIMPLER_ERROR`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import NamedTuple

from kinematics.message import compose, join_messages
from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.sixbar.solver import solve_eightbars, solve_sixbars
from synthesis.kinds.motion.statement.mechanism_types import (
    MULTILOOP_TYPES,
    list_unsupported,
    list_unsupported_stephenson_2,
)
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

MAX_SIMPLER_ERROR = 0.03
"""Error of a fit, as a share of the task's size, below which ``auto`` searches no eightbars: two more links must pay
for themselves, and a client can ask for them."""


class _Remarks(NamedTuple):
    """Messages that compare linkages with those of fewer links, by the outcome.

    Attributes
    ----------
    only_feasible, none_feasible : str
        No simpler linkage satisfies all constraints; those with more links do, or do not.
    only_transmit, closer, none_closer, transmit_better, none_transmits_better : str
        Whether those with more links are the only ones that transmit well, have half of the error, or transmit better.
    """

    only_feasible: str
    none_feasible: str
    only_transmit: str
    closer: str
    none_closer: str
    transmit_better: str
    none_transmits_better: str


_SIXBAR_REMARKS = _Remarks(
    "motion-only-sixbars-feasible",
    "motion-no-type-feasible",
    "motion-only-sixbars-transmit",
    "motion-sixbars-closer",
    "motion-no-sixbar-closer",
    "motion-sixbars-transmit-better",
    "motion-no-sixbar-transmits-better",
)

_EIGHTBAR_REMARKS = _Remarks(
    "motion-only-eightbars-feasible",
    "motion-no-eightbar-feasible",
    "motion-only-eightbars-transmit",
    "motion-eightbars-closer",
    "motion-no-eightbar-closer",
    "motion-eightbars-transmit-better",
    "motion-no-eightbar-transmits-better",
)


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
    simple = None if part is None else partial(two_dyads, part)
    if not problem.has_eightbars:
        return _prefer_simple(problem, simple, progress)
    fewer = partial(_prefer_simple, problem, simple) if simple or problem.sixbars else None
    merge = _merge_by_error if problem.is_least_squares else merge_type_results
    answer: MotionResult = prefer_simplest(
        fewer,
        partial(solve_eightbars, problem),
        partial(_is_near if problem.mechanisms == "auto" else _is_sufficient, problem),
        partial(merge, problem, remarks=_EIGHTBAR_REMARKS),
        progress,
    )
    return answer


def _prefer_simple(
    problem: MotionProblem, simple: Callable[[Progress], MotionResult] | None, progress: Progress
) -> MotionResult:
    """Solve for fourbars and slider-cranks, and for sixbars if none of these is good enough."""
    merge = _merge_by_error if problem.is_least_squares else merge_type_results
    answer: MotionResult = prefer_simplest(
        simple,
        partial(_solve_sixbars, problem) if problem.sixbars else None,
        partial(_is_sufficient, problem),
        partial(merge, problem, remarks=_SIXBAR_REMARKS),
        progress,
        # A list of types was the client's choice, so only types with unsupported constraints are explained.
        describe_skipped_sixbars(list_unsupported(problem))
        if problem.mechanisms == "auto"
        else _describe_unclassed(problem),
    )
    return answer


def _solve_sixbars(problem: MotionProblem, progress: Progress) -> MotionResult:
    """Solve for the sixbars that support the given constraints; report the types that do not."""
    found = solve_sixbars(problem, progress)
    remark = _describe_unclassed(problem)
    return found.model_copy(update={"summary": join_messages([found.summary, remark])}) if remark else found


def _describe_unclassed(problem: MotionProblem) -> str:
    return describe_unclassed(
        select_searched_types(problem.mechanisms, MULTILOOP_TYPES, list_unsupported(problem)),
        list_unsupported_stephenson_2(problem),
    )


def _is_sufficient(problem: MotionProblem, design: LinkageDesign) -> bool:
    """Return whether a linkage transmits well enough and, if positions are fitted, is accurate enough."""
    return has_good_transmission(problem, design) and (
        not problem.is_least_squares or get_rms_error(design) <= MAX_SUFFICIENT_ERROR
    )


def _is_near(problem: MotionProblem, design: LinkageDesign) -> bool:
    """Return whether a fit is so near that ``auto`` searches no eightbars."""
    return get_rms_error(design) <= MAX_SIMPLER_ERROR and has_good_transmission(problem, design)


def _merge_by_error(
    problem: MotionProblem, simple: MotionResult, found: MotionResult, *, remarks: _Remarks
) -> MotionResult:
    """Merge the results for fitted positions; keep more links only if they halve the error or alone transmit well."""
    plain, better = select_passing(simple.designs), select_passing(found.designs)
    sound = [design for design in plain if has_good_transmission(problem, design)]
    alone = [design for design in better if has_good_transmission(problem, design)]
    only_others_transmit = not sound and bool(alone)
    least = min(map(get_rms_error, sound or plain), default=math.inf)
    if plain and only_others_transmit:
        better = alone
    elif plain:
        # Compare with simpler linkages that could be used; if none can, with all of them.
        better = [design for design in better if get_rms_error(design) <= ERROR_RATIO * least]
    # Drop simpler linkages that transmit badly if others can replace them.
    kept = (sound or plain) if better else plain
    offered = merge_alternatives(problem.max_designs, kept, better, make_ranking(problem))
    others = [design for design in offered if any(design is one for one in better)]
    listing = describe_alternatives(problem, len(offered), len(others))
    if not plain:
        remark = compose(remarks.only_feasible if better else remarks.none_feasible)
    elif not better:
        remark = compose(remarks.none_closer, error=f"{100.0 * least:.3g}")
    elif only_others_transmit:
        remark = compose(remarks.only_transmit, listing=listing)
    else:
        remark = compose(remarks.closer, error=f"{100.0 * least:.3g}", listing=listing)
    return merge_results(problem.max_designs, (simple, found), offered, len(others), remark, make_ranking(problem))


def merge_type_results(
    problem: MotionProblem, simple: MotionResult, found: MotionResult, *, remarks: _Remarks = _SIXBAR_REMARKS
) -> MotionResult:
    """Merge the result for linkages that transmit badly, if any, with that for linkages with more links.

    The latter are added only if their transmission angle exceeds that of the best simpler linkage. Designs that passed
    but are not returned count as outranked.
    """
    plain, better = select_passing(simple.designs), select_passing(found.designs)
    best = max((design.metrics.min_transmission_angle for design in plain), default=0.0)
    if plain:
        # Without a simpler linkage every other one is an improvement.
        better = [design for design in better if design.metrics.min_transmission_angle > best]

    order = make_ranking(problem)
    offered = merge_alternatives(problem.max_designs, plain, better, order)
    others = [design for design in offered if any(design is one for one in better)]
    if not plain and remarks is _SIXBAR_REMARKS:
        remark = _describe_without_simple(problem, simple, better)
    elif not plain:
        remark = compose(remarks.only_feasible if better else remarks.none_feasible)
    elif not better:
        remark = compose(remarks.none_transmits_better, angle=f"{best:.1f}")
    else:
        listing = describe_alternatives(problem, len(offered), len(others))
        remark = compose(remarks.transmit_better, angle=f"{best:.1f}", listing=listing)
    return merge_results(problem.max_designs, (simple, found), offered, len(others), remark, order)


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
