"""Which type of linkage generates the function: the simplest that does it well, sixbars where none of those does.

A fourbar that meets all demands stands alone where it transmits as is demanded, or with
:data:`~synthesis.outcome.simplest.SOUND` degrees where nothing is, and where its structural error is at most
:data:`WELL` of the output's range. Otherwise sixbars are looked for; they are offered beside it where they have at most
half of its error, and in its place where it is not sound.
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
"""Share of the output's range that the error of a fourbar may be for no sixbars to be looked for: a hundredth of a
degree of 50."""

ATTEMPTS = 6
"""Sixbars that are verified at most, for each design wanted."""

REASONS = DEFECTS | LENGTHS | {"covers_range": "branch_defect", "dials": "reversed_link"}
"""Why a design was rejected, by the check that it failed; other checks go by their own name."""


def solve_types(problem: FunctionProblem, simple: Solve, progress: Progress) -> FunctionResult:
    """The answer of the types that a problem states.

    Parameters
    ----------
    problem : FunctionProblem
        With :attr:`FunctionProblem.mechanisms`.
    simple : callable
        Solves for fourbars and slider-cranks, as without that field.
    progress : callable
        Told how far the work is.
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
    """The answer of the sixbars that can have what is demanded; which cannot is told."""
    found, told = solve_sixbars(problem.of_sixbars, progress), _told_of_dropped(problem)
    return found.model_copy(update={"summary": f"{found.summary} {told}"}) if told else found


def _told_of_dropped(problem: FunctionProblem) -> str:
    return told_of_unclassed(looked_for(problem.mechanisms, SIXBARS, lacking(problem)), no_class(problem.constraints))


def _well(problem: FunctionProblem, design: FunctionDesign) -> bool:
    """Whether the error of a linkage is so small that no sixbar needs to be looked for."""
    if problem.aim == "precision":
        return True
    error = design.structural_error.rms if problem.aim == "least_squares" else design.structural_error.max
    return bool(error <= WELL * abs(design.metrics.output_range))


def solve_sixbars(problem: FunctionProblem, progress: Progress) -> FunctionResult:
    """Sixbars of the types that are listed, the best by the criterion first."""
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
            return None  # it stands on a toggle, where no place is a number

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
    """The answer of fourbars and that of sixbars as one."""
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
    """What the types have to do with one another, in a sentence; open where there are linkages of both sorts."""
    if not plain:
        return "No fourbar was found; sixbars were." if better else "Neither a fourbar nor a sixbar was found."
    if not better:
        what = "error" if sound else "transmission angle"
        return f"No sixbar that was found is clearly better than the best fourbar in its {what}."
    if not sound:
        angle = max(design.metrics.min_transmission_angle for design in plain)
        return f"The best fourbar transmits with {angle:.1f}° only; sixbars transmit better"
    share = min(error_of(problem, one) for one in better) / min(error_of(problem, one) for one in sound)
    return f"Sixbars have down to {100.0 * share:.2g} % of the best fourbar's error"


def _summary(problem: FunctionProblem, sifting: Sifting[FunctionDesign]) -> str:
    weighed = f"{counted(sifting.candidates, 'sixbar was', 'sixbars were')} drawn and composed"
    if not sifting.passed:
        return (
            f"{weighed}, and none was found that satisfies all demands.{sifting.reasons()} "
            "That does not prove that none exists."
        )
    best = min(sifting.passed, key=lambda design: error_of(problem, design))
    error = best.structural_error
    if problem.aim == "precision":
        count = len(sifting.passed)
        return f"{weighed}; {counted(count, 'meets', 'that differ meet')} all pairs."
    if problem.aim == "least_squares":
        text = f"the least root mean square structural error found is {error.rms:.4g}° (at most {error.max:.4g}°)"
    else:
        text = f"the least greatest structural error found is {error.max:.4g}°"
    return f"{weighed}; {text}, by a {IN_WORDS[best.mechanism.type]}; no proof that none is better."
