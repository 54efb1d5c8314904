"""Selection of the linkage type: the simplest type that is accurate enough, or sixbars if no simpler one is.

A fourbar that satisfies all constraints is sufficient if its minimum transmission angle reaches the client's limit (or
:data:`~synthesis.outcome.simplest.SOUND` degrees without one) and its structural error is at most :data:`WELL` of the
output's range. Otherwise sixbars are searched; they are listed after it if they have at most half its error, or replace
it if it transmits badly.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from synthesis.kinds.function.design import FunctionDesign, FunctionResult
from synthesis.kinds.function.nine_pair_search import solve_nine_pairs
from synthesis.kinds.function.order import error_of, ordered
from synthesis.kinds.function.problem import FunctionProblem
from synthesis.kinds.function.sixbar_build import built
from synthesis.kinds.function.sixbar_search import SixbarSearch
from synthesis.kinds.function.stated_mechanisms import SIXBARS, lacking
from synthesis.kinds.function.task import function_task
from synthesis.kinds.function.verification import verify_function
from synthesis.model.counting import counted
from synthesis.model.kind import Progress, part_of
from synthesis.model.sixbars import IN_WORDS
from synthesis.model.stated_types import looked_for, no_class, not_looked_for, told_of_unclassed
from synthesis.outcome.sifting import DEFECTS, LENGTHS, OUTRANKED, Sifting
from synthesis.outcome.simplest import (
    HALF,
    as_one,
    offered_beside,
    passing,
    simplest_first,
    told_of_offered,
    transmits,
)

Solve = Callable[[FunctionProblem, Progress], FunctionResult]

WELL = 2e-4
"""Maximum error of a fourbar, as a share of the output's range, for which sixbars are not searched: 0.01° of 50°."""

ATTEMPTS = 6
"""Maximum number of verified sixbars per requested design."""

REASONS = DEFECTS | LENGTHS | {"covers_range": "branch_defect", "dials": "reversed_link"}
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
    part = problem.of_simple
    answer: FunctionResult = simplest_first(
        None if part is None else partial(simple, part),
        partial(_sixbars, problem) if problem.sixbars else None,
        lambda design: part is not None and transmits(problem, design) and _well(part, design),
        partial(joined, problem if part is None else part),
        progress,
        _told_of_dropped(problem) or (not_looked_for(lacking(problem)) if problem.mechanisms == "auto" else ""),
    )
    return answer


def _sixbars(problem: FunctionProblem, progress: Progress) -> FunctionResult:
    """Solve for the sixbars that support the given constraints; report the types that do not."""
    found, told = solve_sixbars(problem.of_sixbars, progress), _told_of_dropped(problem)
    return found.model_copy(update={"summary": f"{found.summary} {told}"}) if told else found


def _told_of_dropped(problem: FunctionProblem) -> str:
    return told_of_unclassed(looked_for(problem.mechanisms, SIXBARS, lacking(problem)), no_class(problem.constraints))


def _well(problem: FunctionProblem, design: FunctionDesign) -> bool:
    """Return whether a linkage is accurate enough that sixbars are not searched."""
    if problem.aim == "precision":
        return True
    error = design.structural_error.rms if problem.aim == "least_squares" else design.structural_error.max
    return bool(error <= WELL * abs(design.metrics.output_range))


def solve_sixbars(problem: FunctionProblem, progress: Progress) -> FunctionResult:
    """Solve for sixbars of the requested types, best by the criterion first."""
    if problem.determines_watts:
        return solve_nine_pairs(problem, REASONS, progress)
    task = function_task(problem)
    search = SixbarSearch(task)
    sifting = Sifting[FunctionDesign](problem, REASONS)
    types = problem.sixbars
    found = []
    for n, name in enumerate(types):
        rng = np.random.default_rng([problem.seed, n])
        found += search.of_type(name, rng, part_of(progress, 0.9 * n / len(types), 0.9 * (n + 1) / len(types)))
    found.sort(key=lambda one: one.error)
    progress(0.9, f"verifying the best of {search.weighed} sixbars")

    def verified(n: int) -> FunctionDesign | None:
        try:
            return verify_function(problem, *built(task, found[n]))
        except (ValueError, ZeroDivisionError, OverflowError):
            return None  # at a toggle no position can be computed

    rows = range(min(len(found), ATTEMPTS * problem.max_designs))
    tried = sifting.sift(rows, verified, enough=problem.max_designs)
    sifting.reject(OUTRANKED, search.weighed - tried)
    progress(1.0, "verified")
    return FunctionResult(
        designs=sifting.designs(partial(ordered, problem)),
        search=sifting.search("sixbar_search"),
        summary=_summary(problem, sifting) + search.told,
    )


def joined(problem: FunctionProblem, simple: FunctionResult, found: FunctionResult) -> FunctionResult:
    """Merge the results for fourbars and for sixbars."""
    order = partial(ordered, problem)
    plain, better = passing(simple.designs), passing(found.designs)
    sound = [design for design in plain if transmits(problem, design)]
    least = min((error_of(problem, design) for design in sound or plain), default=np.inf)
    if sound:
        better = [design for design in better if error_of(problem, design) <= HALF * least]
    elif plain:
        angle = max(design.metrics.min_transmission_angle for design in plain)
        better = [design for design in better if design.metrics.min_transmission_angle > angle]
    offered = offered_beside(problem.max_designs, plain, better, order)
    sixbars = [design for design in offered if any(design is one for one in better)]
    told = _told(problem, sound, plain, sixbars or better) + (
        told_of_offered(problem, len(offered), len(sixbars)) if plain and better else ""
    )
    return as_one(problem.max_designs, (simple, found), offered, len(sixbars), told, order)


def _told(
    problem: FunctionProblem, sound: list[FunctionDesign], plain: list[FunctionDesign], better: list[FunctionDesign]
) -> str:
    """Describe how the types compare; the sentence is continued by the caller if there are designs of both kinds."""
    if not plain:
        return "No fourbar was found, only sixbars." if better else "Neither a fourbar nor a sixbar was found."
    if not better:
        what = "error" if sound else "transmission angle"
        return f"No sixbar found clearly improves on the best fourbar's {what}."
    if not sound:
        angle = max(design.metrics.min_transmission_angle for design in plain)
        return f"The best fourbar has a minimum transmission angle of only {angle:.1f}°; sixbars exceed it"
    share = min(error_of(problem, one) for one in better) / min(error_of(problem, one) for one in sound)
    return f"Sixbars reduce the error to {100.0 * share:.2g} % of the best fourbar's"


def _summary(problem: FunctionProblem, sifting: Sifting[FunctionDesign]) -> str:
    weighed = f"{counted(sifting.candidates, 'sixbar was', 'sixbars were')} sampled"
    if not sifting.passed:
        return (
            f"{weighed}; no design found satisfies all constraints.{sifting.reasons()} "
            "This does not prove that none exists."
        )
    best = min(sifting.passed, key=lambda design: error_of(problem, design))
    error = best.structural_error
    if problem.aim == "precision":
        count = len(sifting.passed)
        return f"{weighed}; {counted(count, 'design meets', 'distinct designs meet')} all pairs."
    if problem.aim == "least_squares":
        text = f"Smallest root-mean-square structural error found: {error.rms:.4g}° (maximum {error.max:.4g}°)"
    else:
        text = f"Smallest maximum structural error found: {error.max:.4g}°"
    return f"{weighed}. {text}, by a {IN_WORDS[best.mechanism.type]}. A better linkage may exist."
