"""Selection of the linkage type: the simplest type that is accurate enough, or sixbars if no simpler one is.

A fourbar that satisfies all constraints is sufficient if its minimum transmission angle reaches the client's limit (or
:data:`~synthesis.results.simplest_type.SOUND_TRANSMISSION_ANGLE` degrees without one) and its structural error is at
most :data:`MAX_SUFFICIENT_ERROR` of the output's range. Otherwise sixbars are searched; they are listed after it if
they have at most half its error, or replace it if it transmits badly.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from kinematics.message import compose, join_messages
from synthesis.kinds.function.design import FunctionDesign, FunctionResult
from synthesis.kinds.function.fourbar.task import make_function_task
from synthesis.kinds.function.problem import FunctionProblem
from synthesis.kinds.function.ranking import get_error, rank_by_error
from synthesis.kinds.function.sixbar.mechanism import build_function_sixbar
from synthesis.kinds.function.sixbar.solver import SixbarSearch
from synthesis.kinds.function.statement.mechanism_types import SIXBARS, list_unsupported
from synthesis.kinds.function.verification.verify import verify_function
from synthesis.kinds.function.watt_2_nine_pairs import solve_nine_pairs
from synthesis.model.kind import Progress, scale_progress
from synthesis.model.linkage.type_choice import (
    describe_skipped_sixbars,
    describe_unclassed,
    refuse_class,
    select_searched_types,
)
from synthesis.results.candidate_log import DEFECT_REASONS, LENGTH_REASONS, OUTRANKED_REASON, CandidateLog
from synthesis.results.ranking import select_best
from synthesis.results.simplest_type import (
    ERROR_RATIO,
    describe_alternatives,
    has_good_transmission,
    merge_alternatives,
    merge_results,
    prefer_simplest,
    select_passing,
)

Solve = Callable[[FunctionProblem, Progress], FunctionResult]

MAX_SUFFICIENT_ERROR = 2e-4
"""Maximum error of a fourbar, as a share of the output's range, for which sixbars are not searched: 0.01° of 50°."""

ATTEMPTS_PER_DESIGN = 6
"""Maximum number of verified sixbars per requested design."""

REASONS = DEFECT_REASONS | LENGTH_REASONS | {"covers_range": "branch_defect", "dials": "reversed_link"}
"""Rejection reason by failed check; other checks use their own name."""


def solve_types(problem: FunctionProblem, simple: Solve, progress: Progress) -> FunctionResult:
    """Solve for the types of linkage that a problem requests.

    Parameters
    ----------
    problem : FunctionProblem
        A problem with :attr:`FunctionProblem.mechanisms`.
    simple : callable
        Solver for fourbars and slider-cranks of a problem without that field.
    progress : callable
        Progress callback.
    """
    part = problem.simple_problem
    answer: FunctionResult = prefer_simplest(
        None if part is None else partial(simple, part),
        partial(_solve_sixbars, problem) if problem.sixbars else None,
        lambda design: part is not None and has_good_transmission(problem, design) and _is_accurate(part, design),
        partial(merge_type_results, problem if part is None else part),
        progress,
        _describe_dropped(problem)
        or (describe_skipped_sixbars(list_unsupported(problem)) if problem.mechanisms == "auto" else ""),
    )
    return answer


def _solve_sixbars(problem: FunctionProblem, progress: Progress) -> FunctionResult:
    """Solve for the sixbars that support the given constraints; report the types that do not."""
    found, remark = solve_sixbars(problem.sixbar_problem, progress), _describe_dropped(problem)
    return found.model_copy(update={"summary": join_messages([found.summary, remark])})


def _describe_dropped(problem: FunctionProblem) -> str:
    return describe_unclassed(
        select_searched_types(problem.mechanisms, SIXBARS, list_unsupported(problem)),
        refuse_class(problem.constraints),
    )


def _is_accurate(problem: FunctionProblem, design: FunctionDesign) -> bool:
    """Return whether a linkage is accurate enough that sixbars are not searched."""
    # Precision points are met exactly, so accuracy is no criterion.
    if problem.aim == "precision":
        return True
    error = design.structural_error.rms if problem.aim == "least_squares" else design.structural_error.max
    return bool(error <= MAX_SUFFICIENT_ERROR * abs(design.metrics.output_range))


def solve_sixbars(problem: FunctionProblem, progress: Progress) -> FunctionResult:
    """Solve for sixbars of the requested types, best by the criterion first."""
    if problem.determines_watts:
        return solve_nine_pairs(problem, REASONS, progress)
    task = make_function_task(problem)
    search = SixbarSearch(task)
    sifting = CandidateLog[FunctionDesign](problem, REASONS)
    types = problem.sixbars
    found = []
    for n, name in enumerate(types):
        # A generator for each type, so that the result does not depend on which other types are requested.
        rng = np.random.default_rng([problem.seed, n])
        found += search.find_sixbars(
            name, rng, scale_progress(progress, 0.9 * n / len(types), 0.9 * (n + 1) / len(types))
        )
    found.sort(key=lambda one: one.error)
    progress(0.9, compose("function-verifying-best-sixbars", count=search.weighed))

    def verify_sixbar(n: int) -> FunctionDesign | None:
        try:
            return verify_function(problem, *build_function_sixbar(task, found[n]))
        except (ValueError, ZeroDivisionError, OverflowError):
            return None  # at a toggle no position can be computed

    # Several tries per design, because some fail verification.
    rows = range(min(len(found), ATTEMPTS_PER_DESIGN * problem.max_designs))
    tried = sifting.verify_candidates(rows, verify_sixbar, enough=problem.max_designs)
    sifting.reject(OUTRANKED_REASON, search.weighed - tried)
    progress(1.0, compose("function-verified"))
    return FunctionResult(
        designs=sifting.select_designs(partial(rank_by_error, problem)),
        search=sifting.build_search("sixbar_search"),
        summary=join_messages([_describe_result(problem, sifting), search.remark]),
    )


def merge_type_results(problem: FunctionProblem, simple: FunctionResult, found: FunctionResult) -> FunctionResult:
    """Merge the results for fourbars and for sixbars."""
    order = partial(rank_by_error, problem)
    plain, better = select_passing(simple.designs), select_passing(found.designs)
    sound = [design for design in plain if has_good_transmission(problem, design)]
    # Compare errors with usable linkages, or with all if none is usable.
    least = min((get_error(problem, design) for design in sound or plain), default=np.inf)
    if sound:
        better = [design for design in better if get_error(problem, design) <= ERROR_RATIO * least]
    # No usable fourbar: sixbars need only transmit better.
    elif plain:
        angle = max(design.metrics.min_transmission_angle for design in plain)
        better = [design for design in better if design.metrics.min_transmission_angle > angle]
    offered = merge_alternatives(problem.max_designs, plain, better, order)
    sixbars = [design for design in offered if any(design is one for one in better)]
    remark = join_messages(
        [
            _describe_comparison(problem, sound, plain, sixbars or better),
            describe_alternatives(problem, len(offered), len(sixbars)) if plain and better else "",
        ],
        "",
    )
    return merge_results(problem.max_designs, (simple, found), offered, len(sixbars), remark, order)


def _describe_comparison(
    problem: FunctionProblem, sound: list[FunctionDesign], plain: list[FunctionDesign], better: list[FunctionDesign]
) -> str:
    """Describe how the types compare; the sentence is continued by the caller if there are designs of both kinds."""
    if not plain:
        return compose("function-only-sixbars-found" if better else "function-no-linkage-found")
    if not better:
        return compose("function-no-smaller-error" if sound else "function-no-better-transmission")
    if not sound:
        angle = max(design.metrics.min_transmission_angle for design in plain)
        return compose("function-sixbars-transmit-better", angle=f"{angle:.1f}")
    share = min(get_error(problem, one) for one in better) / min(get_error(problem, one) for one in sound)
    return compose("function-sixbars-reduce-error", share=f"{100.0 * share:.2g}")


def _describe_result(problem: FunctionProblem, sifting: CandidateLog[FunctionDesign]) -> str:
    sampled = sifting.candidates
    if not sifting.passed:
        return join_messages(
            [
                compose("function-no-sixbar-passes", sampled=sampled),
                sifting.describe_reasons().strip(),
                compose("function-nothing-proved"),
            ]
        )
    best = select_best(sifting.passed, partial(get_error, problem))
    error = best.structural_error
    if problem.aim == "precision":
        return compose("function-sixbars-meet-pairs", sampled=sampled, count=len(sifting.passed))
    if problem.aim == "least_squares":
        return compose(
            "function-sixbar-with-least-rms",
            sampled=sampled,
            rms=f"{error.rms:.4g}",
            maximum=f"{error.max:.4g}",
            type=best.mechanism.type,
        )
    return compose(
        "function-sixbar-with-least-maximum", sampled=sampled, maximum=f"{error.max:.4g}", type=best.mechanism.type
    )
