"""Which type of linkage carries the body: the simplest that is sound, sixbars where none of those is.

A fourbar or slider-crank that meets all demands stands alone where its least transmission angle is what the client
demands or, where nothing is demanded, :data:`~synthesis.outcome.simplest.SOUND` degrees. Otherwise sixbars are
looked for, and those that transmit better are offered beside it.
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
"""Error of a fit, as a share of the task's size, at which no better linkage is looked for."""


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
    """The answer of the sixbars that can have what is demanded; which cannot is told."""
    found = solve_sixbars(problem, problem.sixbars, progress)
    told = _told_of_unclassed(problem)
    return found.model_copy(update={"summary": f"{found.summary} {told}"}) if told else found


def _told_of_unclassed(problem: MotionProblem) -> str:
    return told_of_unclassed(looked_for(problem.mechanisms, SIXBARS, lacking(problem)), beyond_unclassed(problem))


def _stands_alone(problem: MotionProblem, design: LinkageDesign) -> bool:
    """Whether a linkage that keeps all demands is sound, and near enough where positions are fitted."""
    return transmits(problem, design) and (not problem.fitted or error_of(design) <= NEAR)


def _nearer(problem: MotionProblem, simple: MotionResult, found: MotionResult) -> MotionResult:
    """Both answers as one where positions are fitted: sixbars have half of the error, or are sound alone."""
    plain, better = passing(simple.designs), passing(found.designs)
    sound = [design for design in plain if transmits(problem, design)]
    alone = [design for design in better if transmits(problem, design)]
    if not plain:
        told = (
            f"No linkage of two dyads was found that keeps all demands; {'sixbars do' if better else 'nor a sixbar'}."
        )
    elif not sound and alone:
        better, told = alone, "No linkage of two dyads that was found is sound; sixbars are"
    else:
        least = min(map(error_of, sound or plain))
        better = [design for design in better if error_of(design) <= HALF * least]
        told = f"The best linkage of two dyads has a root-mean-square residual of {100.0 * least:.3g} %"
        told += "; sixbars have at most half of it" if better else ", and no sixbar that was found has half of it."
    kept = (sound or plain) if better else plain
    offered = offered_beside(problem.max_designs, kept, better, order_of(problem))
    sixbars = [design for design in offered if any(design is one for one in better)]
    if plain and better:
        told += told_of_offered(problem, len(offered), len(sixbars))
    return as_one(problem.max_designs, (simple, found), offered, len(sixbars), told, order_of(problem))


def joined(problem: MotionProblem, simple: MotionResult, found: MotionResult) -> MotionResult:
    """The answer of linkages of two dyads that are not sound, if there are any, and that of sixbars, as one.

    Sixbars stand beside those linkages only where they transmit better than the best of them. What passed and is not
    offered counts as outranked.
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
        told = f"The best linkage of two dyads has a least transmission angle of {best:.1f}°"
        if not better:
            told += ", and no sixbar that was found has more."
        else:
            told += f"; sixbars have more{told_of_offered(problem, len(offered), len(sixbars))}"
    return as_one(problem.max_designs, (simple, found), offered, len(sixbars), told, order)


def _without_simple(problem: MotionProblem, simple: MotionResult, sixbars: list[LinkageDesign]) -> str:
    """What is said where no linkage of two dyads passed: that none exists, only where that is proven of all of them."""
    every = problem.mechanisms == "auto"  # no list has inverted slider-cranks
    # Five positions that are met exactly leave a few dyads, sliders among them. With fewer, sliders are drawn.
    exact = len(problem.positions) == MOST_HELD and all(limits == (0.0, 0.0, 0.0) for limits in problem.limits)
    if every and exact and simple.search.complete:
        return f"No linkage of two dyads does it{'; sixbars do' if sixbars else ', and no sixbar was found'}."
    if problem.mechanisms == "auto":
        none = "Neither a linkage of two dyads nor a sixbar was found."
        return "No linkage of two dyads was found; sixbars were." if sixbars else none
    return f"None of the types named was found{' but sixbars' if sixbars else ''}."
