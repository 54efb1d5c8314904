"""Selection of the linkage type: the simplest that is accurate enough, sixbars or eightbars if no simpler one is.

A fourbar that satisfies all constraints is sufficient if its minimum transmission angle reaches the client's limit (or
:data:`~synthesis.results.simplest_type.SOUND_TRANSMISSION_ANGLE` degrees without one) and its structural error is at
most :data:`MAX_SUFFICIENT_ERROR` of the output's range. Otherwise sixbars are searched; they are listed after it if
they have at most half its error, or replace it if it transmits badly. Eightbars follow in the same way if the client
names them, or for ``auto`` if all other linkages miss the function by more than :data:`MAX_SIMPLER_ERROR`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

from kinematics.message import compose, join_messages
from synthesis.kinds.function.design import FunctionDesign, FunctionResult
from synthesis.kinds.function.fourbar.task import make_function_task
from synthesis.kinds.function.problem import FunctionProblem
from synthesis.kinds.function.ranking import get_error, rank_by_error
from synthesis.kinds.function.sixbar.fits import list_ratios
from synthesis.kinds.function.sixbar.mechanism import build_function_linkage
from synthesis.kinds.function.sixbar.solver import SixbarSearch
from synthesis.kinds.function.statement.mechanism_types import SIXBARS, Multiloop, list_unsupported
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


class _Remarks(NamedTuple):
    """Messages that compare linkages with those of fewer links, by the outcome."""

    only_found: str
    none_found: str
    no_smaller_error: str
    no_better_transmission: str
    transmit_better: str
    reduce_error: str


_SIXBAR_REMARKS = _Remarks(
    "function-only-sixbars-found",
    "function-no-linkage-found",
    "function-no-smaller-error",
    "function-no-better-transmission",
    "function-sixbars-transmit-better",
    "function-sixbars-reduce-error",
)

_EIGHTBAR_REMARKS = _Remarks(
    "function-only-eightbars-found",
    "function-no-eightbar-found",
    "function-no-eightbar-with-smaller-error",
    "function-no-eightbar-transmits-better",
    "function-eightbars-transmit-better",
    "function-eightbars-reduce-error",
)

MAX_SUFFICIENT_ERROR = 2e-4
"""Maximum error of a fourbar, as a share of the output's range, for which sixbars are not searched: 0.01° of 50°."""

MAX_SIMPLER_ERROR = 0.01
"""Error of the best simpler linkage, as a share of the output's range, below which ``auto`` searches no eightbars: two
more links must pay for themselves, and a client can ask for them."""

ATTEMPTS_PER_DESIGN = 6
"""Maximum number of verified linkages per requested design."""

PLACED_ATTEMPTS = 40
"""Minimum of that number if the place is limited, where many linkages do not fit."""

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
    if not problem.has_eightbars:
        return _prefer_simple(problem, simple, progress)
    fewer = None if problem.mechanisms == ["eightbar"] else partial(_prefer_simple, problem, simple)
    # Without a criterion the number of pairs and the types decide, so that the restricted problem names it.
    judged = problem.simple_problem or problem.restrict_to(("eightbar",))
    error = MAX_SIMPLER_ERROR if problem.mechanisms == "auto" else MAX_SUFFICIENT_ERROR
    answer: FunctionResult = prefer_simplest(
        fewer,
        lambda part: solve_linkages(problem.restrict_to(("eightbar",)), ("eightbar",), part),
        lambda design: has_good_transmission(problem, design) and _is_accurate(judged, design, error),
        partial(merge_type_results, judged, remarks=_EIGHTBAR_REMARKS),
        progress,
    )
    return answer


def _prefer_simple(problem: FunctionProblem, simple: Solve, progress: Progress) -> FunctionResult:
    """Solve for fourbars or slider-cranks, and for sixbars if none of these is good enough."""
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
    found = solve_linkages(problem.restrict_to(problem.sixbars), problem.sixbars, progress)
    remark = _describe_dropped(problem)
    return found.model_copy(update={"summary": join_messages([found.summary, remark])})


def _describe_dropped(problem: FunctionProblem) -> str:
    return describe_unclassed(
        select_searched_types(problem.mechanisms, SIXBARS, list_unsupported(problem)),
        refuse_class(problem.constraints),
    )


def _is_accurate(problem: FunctionProblem, design: FunctionDesign, share: float = MAX_SUFFICIENT_ERROR) -> bool:
    """Return whether the error of a linkage is at most a share of the output's range."""
    # Precision points are met exactly, so accuracy is no criterion.
    if problem.aim == "precision":
        return True
    error = design.structural_error.rms if problem.aim == "least_squares" else design.structural_error.max
    # The output of a function that returns, like a sine, is where it began at the end of the range.
    outputs = [target.output for target in design.targets]
    return bool(error <= share * abs(design.dials.output.scale) * (max(outputs) - min(outputs)))


def solve_linkages(problem: FunctionProblem, types: Sequence[Multiloop], progress: Progress) -> FunctionResult:
    """Solve for sixbars or eightbars of some types, best by the criterion first."""
    if problem.determines_watts:
        return solve_nine_pairs(problem, REASONS, progress)
    ratios = list_ratios(problem)
    for n, ratio in enumerate(ratios):
        part = scale_progress(progress, n / len(ratios), (n + 1) / len(ratios))
        result = _solve_within(problem, types, ratio, part)
        if select_passing(result.designs):
            break
    return result


def _solve_within(
    problem: FunctionProblem, types: Sequence[Multiloop], ratio: float, progress: Progress
) -> FunctionResult:  # fmt: skip
    """Solve for sixbars or eightbars within a link ratio."""
    task = make_function_task(problem)
    search = SixbarSearch(task, ratio)
    sifting = CandidateLog[FunctionDesign](problem, REASONS)
    found = []
    for n, name in enumerate(types):
        # A generator for each type, so that the result does not depend on which other types are requested.
        rng = np.random.default_rng([problem.seed, n])
        found += search.find_sixbars(
            name, rng, scale_progress(progress, 0.9 * n / len(types), 0.9 * (n + 1) / len(types))
        )
    found.sort(key=lambda one: one.error)
    progress(0.9, compose("function-verifying-best-linkages", count=search.weighed))

    def verify_linkage(n: int) -> FunctionDesign | None:
        try:
            return verify_function(problem, *build_function_linkage(task, found[n]))
        except (ValueError, ZeroDivisionError, OverflowError):
            return None  # at a toggle no position can be computed

    # Several tries per design, because some fail verification.
    most = max(ATTEMPTS_PER_DESIGN * problem.max_designs, PLACED_ATTEMPTS if problem.limits_place else 0)
    rows = range(min(len(found), most))
    tried = sifting.verify_candidates(rows, verify_linkage, enough=problem.max_designs)
    sifting.reject(OUTRANKED_REASON, search.weighed - tried)
    progress(1.0, compose("function-verified"))
    return FunctionResult(
        designs=sifting.select_designs(partial(rank_by_error, problem)),
        search=sifting.build_search("eightbar_search" if "eightbar" in types else "sixbar_search"),
        summary=join_messages([_describe_result(problem, types, sifting), search.remark]),
    )


def merge_type_results(
    problem: FunctionProblem, simple: FunctionResult, found: FunctionResult, *, remarks: _Remarks = _SIXBAR_REMARKS
) -> FunctionResult:
    """Merge the results for simpler linkages and for those with more links."""
    order = partial(rank_by_error, problem)
    plain, better = select_passing(simple.designs), select_passing(found.designs)
    sound = [design for design in plain if has_good_transmission(problem, design)]
    # Compare errors with usable linkages, or with all if none is usable.
    least = min((get_error(problem, design) for design in sound or plain), default=np.inf)
    if sound:
        better = [design for design in better if get_error(problem, design) <= ERROR_RATIO * least]
    # No usable simpler linkage: the others need only transmit better.
    elif plain:
        angle = max(design.metrics.min_transmission_angle for design in plain)
        better = [design for design in better if design.metrics.min_transmission_angle > angle]
    offered = merge_alternatives(problem.max_designs, plain, better, order)
    others = [design for design in offered if any(design is one for one in better)]
    remark = join_messages(
        [
            _describe_comparison(problem, remarks, sound, plain, others or better),
            describe_alternatives(problem, len(offered), len(others)) if plain and better else "",
        ],
        "",
    )
    return merge_results(problem.max_designs, (simple, found), offered, len(others), remark, order)


def _describe_comparison(
    problem: FunctionProblem,
    remarks: _Remarks,
    sound: list[FunctionDesign],
    plain: list[FunctionDesign],
    better: list[FunctionDesign],
) -> str:
    """Describe how the types compare; the sentence is continued by the caller if there are designs of both kinds."""
    if not plain:
        return compose(remarks.only_found if better else remarks.none_found)
    if not better:
        return compose(remarks.no_smaller_error if sound else remarks.no_better_transmission)
    if not sound:
        angle = max(design.metrics.min_transmission_angle for design in plain)
        return compose(remarks.transmit_better, angle=f"{angle:.1f}")
    share = min(get_error(problem, one) for one in better) / min(get_error(problem, one) for one in sound)
    return compose(remarks.reduce_error, share=f"{100.0 * share:.2g}")


def _describe_result(
    problem: FunctionProblem, types: Sequence[Multiloop], sifting: CandidateLog[FunctionDesign]
) -> str:  # fmt: skip
    family = "eightbar" if "eightbar" in types else "sixbar"
    effort = compose("function-linkages-sampled", family=family, sampled=sifting.candidates)
    if not sifting.passed:
        return join_messages(
            [
                compose("function-no-linkage-passes", effort=effort),
                sifting.describe_reasons().strip(),
                compose("function-nothing-proved"),
            ]
        )
    if problem.aim == "precision":
        return compose("function-linkages-meet-pairs", effort=effort, count=len(sifting.passed))
    best = select_best(sifting.passed, partial(get_error, problem))
    error, kind = best.structural_error, compose("function-linkage-type", type=best.mechanism.type)
    if problem.aim == "least_squares":
        both = {"rms": f"{error.rms:.4g}", "maximum": f"{error.max:.4g}"}
        return compose("function-linkage-with-least-rms", effort=effort, type=kind, **both)
    return compose("function-linkage-with-least-maximum", effort=effort, maximum=f"{error.max:.4g}", type=kind)
