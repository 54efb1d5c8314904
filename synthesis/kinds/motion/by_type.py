"""Which type of linkage carries the body: the simplest that is sound, sixbars where none of those is.

A fourbar or slider-crank that meets all demands stands alone where its least transmission angle is what the client
demands or, where nothing is demanded, :data:`~synthesis.kinds.motion.chain_search.SOUND` degrees. Otherwise sixbars are
looked for, and those that are offered beside it are sound.
"""

from __future__ import annotations

from collections.abc import Callable

from synthesis.kinds.motion.chain_search import SOUND, solve_sixbars
from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.model.answer import Search
from synthesis.model.kind import Progress, part_of
from synthesis.model.linkage_answer import LinkageDesign
from synthesis.outcome.ranking import ranked

Solve = Callable[[MotionProblem, Progress], MotionResult]

MANY = "Sixbars meet up to five positions; they were not looked for."
"""What is said of more."""


def solve_types(problem: MotionProblem, two_dyads: Solve, progress: Progress) -> MotionResult:
    """The answer of the types that a problem states.

    Parameters
    ----------
    problem : MotionProblem
        With :attr:`MotionProblem.mechanisms`.
    two_dyads : callable
        Solves for fourbars and slider-cranks, as without that field.
    progress : callable
        Told how far the work is.
    """
    sixbars = problem.sixbars
    parts = _simple(problem)
    results: list[MotionResult] = []
    for n, part in enumerate(parts):
        share = 0.4 if sixbars else 1.0
        span = part_of(progress, share * n / len(parts), share * (n + 1) / len(parts))
        results.append(two_dyads(part, span))
        if any(design.verification.passed for design in results[-1].designs):
            break
    if not sixbars:
        told = f" {MANY}" if problem.mechanisms == "auto" and not problem.few_enough else ""
        return results[-1].model_copy(update={"summary": results[-1].summary + told})
    simple = [design for result in results for design in result.designs if design.verification.passed]
    if any(_sound(problem, design) for design in simple):
        return results[-1]
    found = solve_sixbars(problem, sixbars, part_of(progress, 0.4 if parts else 0.0, 1.0))
    return _joined(problem, results, simple, found) if results else found


def _simple(problem: MotionProblem) -> list[MotionProblem]:
    """The problems of two dyads to be solved one after the other until one has an answer, the simpler first."""
    if problem.mechanisms == "auto" or problem.slider is not None:
        return [problem]
    stated = set(problem.mechanisms or ())
    # What is looked for where only some types are may fail: that is no reason to look for other sliders.
    parts = []
    if {"fourbar", "slider_crank"} <= stated:
        return [problem]
    if "fourbar" in stated:
        pins = {
            name: getattr(problem, name).model_copy(update={"dyad": "RR"}) for name in ("input_side", "output_side")
        }
        parts.append(problem.model_copy(update=pins))
    if "slider_crank" in stated:
        slide = problem.output_side.model_copy(update={"dyad": "PR"})
        parts.append(problem.model_copy(update={"output_side": slide}))
    return parts


def _sound(problem: MotionProblem, design: LinkageDesign) -> bool:
    """Whether a linkage that meets all demands transmits force well enough to stand alone."""
    demanded = problem.constraints.min_transmission_angle
    return demanded is not None or design.metrics.min_transmission_angle >= SOUND


def _joined(
    problem: MotionProblem, results: list[MotionResult], simple: list[LinkageDesign], found: MotionResult
) -> MotionResult:
    """The answers of simple linkages and of sixbars as one: sixbars beside others where they alone are sound."""
    better = [design for design in found.designs if design.verification.passed]
    if simple:
        better = [design for design in better if _sound(problem, design)]
        best = max(design.metrics.min_transmission_angle for design in simple)
        told = f"The best linkage of two dyads has a least transmission angle of {best:.1f}°"
        more = (
            "; sixbars that have more are offered beside it." if better else ", and no sixbar that was found has more."
        )
        told += more
    elif better:
        told = "No linkage of two dyads does it; sixbars do."
    else:
        told = "Neither a linkage of two dyads nor a sixbar was found."
    failed = [design for result in (*results, found) for design in result.designs if not design.verification.passed]
    designs = ranked([*simple, *better], problem.rank_by)
    return results[-1].model_copy(
        update={
            "designs": [*designs, *ranked(failed, problem.rank_by)][: problem.max_designs],
            "search": _account([result.search for result in (*results, found)]),
            "summary": " ".join([told, results[-1].summary, found.summary]),
        }
    )


def _account(searches: list[Search]) -> Search:
    """The account of several searches as one."""
    rejected: dict[str, int] = {}
    for search in searches:
        for reason, count in search.rejected.items():
            rejected[reason] = rejected.get(reason, 0) + count
    return searches[-1].model_copy(
        update={
            "method": ", ".join(search.method for search in searches),
            "complete": False,
            "candidates": sum(search.candidates for search in searches),
            "accepted": sum(search.accepted for search in searches),
            "rejected": rejected,
        }
    )
