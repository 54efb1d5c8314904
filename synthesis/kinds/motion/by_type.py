"""Selection of the linkage type: the simplest feasible type, or sixbars if no simpler one is good enough.

A fourbar or slider-crank that satisfies all constraints is sufficient if its minimum transmission angle reaches the
client's limit or, without a limit, :data:`~synthesis.outcome.simplest.SOUND` degrees. Otherwise sixbars are searched,
and those with a larger transmission angle are listed after it.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.nearness import error_of, order_of
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.sixbar_search import solve_sixbars
from synthesis.kinds.motion.stated_mechanisms import SIXBARS, beyond_unclassed, lacking
from synthesis.kinds.motion.stated_positions import MOST_HELD
from synthesis.model.kind import Progress
from synthesis.model.linkage_answer import LinkageDesign
from synthesis.model.stated_types import looked_for, not_looked_for, told_of_unclassed
from synthesis.outcome.simplest import HALF, as_one, offered_beside, passing, simplest_first, told_of_offered, transmits

Solve = Callable[[MotionProblem, Progress], MotionResult]

NEAR = 1e-3
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
    part = problem.of_two_dyads
    answer: MotionResult = simplest_first(
        None if part is None else partial(two_dyads, part),
        partial(_sixbars, problem) if problem.sixbars else None,
        partial(_stands_alone, problem),
        partial(_nearer if problem.fitted else joined, problem),
        progress,
        not_looked_for(lacking(problem)) if problem.mechanisms == "auto" else _told_of_unclassed(problem),
    )
    return answer


def _sixbars(problem: MotionProblem, progress: Progress) -> MotionResult:
    """Solve for the sixbars that support the given constraints; report the types that do not."""
    found = solve_sixbars(problem, problem.sixbars, progress)
    told = _told_of_unclassed(problem)
    return found.model_copy(update={"summary": f"{found.summary} {told}"}) if told else found


def _told_of_unclassed(problem: MotionProblem) -> str:
    return told_of_unclassed(looked_for(problem.mechanisms, SIXBARS, lacking(problem)), beyond_unclassed(problem))


def _stands_alone(problem: MotionProblem, design: LinkageDesign) -> bool:
    """Return whether a linkage transmits well enough and, if positions are fitted, is accurate enough."""
    return transmits(problem, design) and (not problem.fitted or error_of(design) <= NEAR)


def _nearer(problem: MotionProblem, simple: MotionResult, found: MotionResult) -> MotionResult:
    """Merge both results if positions are fitted: keep sixbars with half the error, or if only they transmit well."""
    plain, better = passing(simple.designs), passing(found.designs)
    sound = [design for design in plain if transmits(problem, design)]
    alone = [design for design in better if transmits(problem, design)]
    if not plain:
        told = (
            "No fourbar or slider-crank found satisfies all constraints; "
            f"{'sixbars do' if better else 'neither does a sixbar'}."
        )
    elif not sound and alone:
        better, told = alone, "No fourbar or slider-crank found transmits well enough; sixbars do"
    else:
        least = min(map(error_of, sound or plain))
        better = [design for design in better if error_of(design) <= HALF * least]
        told = f"The best fourbar or slider-crank has a root-mean-square residual of {100.0 * least:.3g} %"
        told += "; sixbars have at most half of that" if better else ", and no sixbar found has half of that."
    kept = (sound or plain) if better else plain
    offered = offered_beside(problem.max_designs, kept, better, order_of(problem))
    sixbars = [design for design in offered if any(design is one for one in better)]
    if plain and better:
        told += told_of_offered(problem, len(offered), len(sixbars))
    return as_one(problem.max_designs, (simple, found), offered, len(sixbars), told, order_of(problem))


def joined(problem: MotionProblem, simple: MotionResult, found: MotionResult) -> MotionResult:
    """Merge the result for fourbars and slider-cranks that transmit badly, if any, with that for sixbars.

    Sixbars are added only if their transmission angle exceeds that of the best simpler linkage. Designs that passed but
    are not returned count as outranked.
    """
    plain, better = passing(simple.designs), passing(found.designs)
    best = max((design.metrics.min_transmission_angle for design in plain), default=0.0)
    if plain:
        better = [design for design in better if design.metrics.min_transmission_angle > best]

    order = order_of(problem)
    offered = offered_beside(problem.max_designs, plain, better, order)
    sixbars = [design for design in offered if any(design is one for one in better)]
    if not plain:
        told = _without_simple(problem, simple, better)
    else:
        told = f"The best fourbar or slider-crank has a minimum transmission angle of {best:.1f}°"
        if not better:
            told += ", and no sixbar found exceeds it."
        else:
            told += f"; sixbars exceed it{told_of_offered(problem, len(offered), len(sixbars))}"
    return as_one(problem.max_designs, (simple, found), offered, len(sixbars), told, order)


def _without_simple(problem: MotionProblem, simple: MotionResult, sixbars: list[LinkageDesign]) -> str:
    """Describe a result without a fourbar or slider-crank; claim that none exists only if that is proved."""
    every = problem.mechanisms == "auto"  # no list has inverted slider-cranks
    # Five exact positions leave a few dyads, including sliders, all enumerated. With fewer, sliders are only sampled.
    exact = len(problem.positions) == MOST_HELD and all(limits == (0.0, 0.0, 0.0) for limits in problem.limits)
    if every and exact and simple.search.complete:
        return f"No fourbar or slider-crank solves this{'; sixbars do' if sixbars else ', and no sixbar was found'}."
    if problem.mechanisms == "auto":
        none = "No fourbar, slider-crank or sixbar was found."
        return "No fourbar or slider-crank was found, only sixbars." if sixbars else none
    return f"No linkage of the requested types was found{' except sixbars' if sixbars else ''}."
