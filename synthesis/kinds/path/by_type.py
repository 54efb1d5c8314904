"""Choose the type of linkage that guides the point: the simplest one that is sound and near, and better ones after it.

Simpler types are searched first: fourbars, slider-cranks, geared fivebars, then all sixbars together. A linkage that
satisfies all constraints is the only answer if it transmits force well enough
(:func:`~synthesis.outcome.simplest.transmits`) and is near: its error is at most :data:`NEAR` of the task's size, or
within the given tolerances. Otherwise the next types are searched. They are listed next to it if their error is at most
:data:`HALF` of its minimum error, or if only they are sound.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

from synthesis.kinds.path.design import PathDesign, PathResult
from synthesis.kinds.path.nearness import error_of, least_error, meets_the_points, order_of
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.sixbar_search import best_sixbar, solve_sixbars
from synthesis.kinds.path.stated_mechanisms import NAMES, SIXBARS, Simple, beyond_unclassed, lacking, simple_of
from synthesis.model.kind import Progress, part_of
from synthesis.model.stated_types import looked_for, not_looked_for, told_of_unclassed
from synthesis.outcome.simplest import HALF, as_one, offered_beside, passing, told_of_offered, transmits

Solve = Callable[[PathProblem, Progress], PathResult]

NEAR = 1e-3
"""Error, as a share of the task's size, below which no more complex type is searched."""


def solve_types(problem: PathProblem, of_one: Solve, progress: Progress) -> PathResult:
    """Solve a problem for each of the types that it names, simplest first, and combine the results.

    Parameters
    ----------
    problem : PathProblem
        With :attr:`PathProblem.mechanisms`.
    of_one : callable
        Solves for one of the types with one closure, as without that field.
    progress : callable
        Receives the share of the work done.
    """
    stages: list[Simple | Literal["sixbar"]] = [*simple_of(problem.mechanisms)]
    if problem.sixbars:
        stages.append("sixbar")
    result: PathResult | None = None
    before: list[str] = []
    for n, name in enumerate(stages):
        part = part_of(progress, n / len(stages), (n + 1) / len(stages))
        found = solve_sixbars(problem, part) if name == "sixbar" else of_one(problem.of_type(name), part)
        result = found if result is None else joined(problem, result, found, before, name)
        before.append(name)
        # A sound and accurate simple linkage ends the search: designers prefer fewer links.
        if any(_stands_alone(problem, design) for design in passing(result.designs)):
            break
    assert result is not None
    text = "" if problem.listed_later else best_sixbar(problem, result.designs)
    if problem.mechanisms == "auto" and not problem.sixbars:
        text = f" {not_looked_for(lacking(problem))}"
    elif problem.mechanisms != "auto":
        named = looked_for(problem.mechanisms, SIXBARS, lacking(problem))
        text += f" {told_of_unclassed(named, beyond_unclassed(problem))}".rstrip()
    return result.model_copy(update={"summary": f"{result.summary}{text}"})


def _stands_alone(problem: PathProblem, design: PathDesign) -> bool:
    """Return whether a linkage that satisfies all constraints is sound and near enough to end the search."""
    near = problem.tolerances is not None or error_of(design, problem) <= NEAR * problem.task_size
    return near and transmits(problem, design)


def joined(problem: PathProblem, simple: PathResult, found: PathResult, before: list[str], name: str) -> PathResult:
    """Combine the results of simpler linkages and of another type; passed designs that are not listed count as
    outranked.

    Parameters
    ----------
    problem : PathProblem
        The problem as requested.
    simple, found : PathResult
        The answers.
    before, name : list of str and str
        The types of the first, and that of the second.
    """
    plain, better = passing(simple.designs), passing(found.designs)
    sound = [design for design in plain if transmits(problem, design)]
    first, other = " or ".join(NAMES[one] for one in before), NAMES[name]
    if not plain:
        text = f"No {first} was found that satisfies all constraints; "
        text += f"{other}s do." if better else f"nor was a {other}."
    elif not sound and (alone := [design for design in better if transmits(problem, design)]):
        # Only the complex type has sound designs: list these alone.
        better = alone
        text = f"No {first} that was found is sound; sound {other}s were found"
    elif not sound and all(map(meets_the_points, plain)):
        # Exact designs have no error to halve, so that a more complex type without force transmission gains nothing.
        better = []
        text = f"No {first} that was found is sound, and no {other} is."
    else:
        least = least_error(sound or plain, problem)
        # More links must pay off by at least half the error.
        better = [design for design in better if error_of(design, problem) <= HALF * least]
        text = f"The error of the best {first} is {least:.3g} {problem.length_unit}"
        text += f"; {other}s have at most half of it" if better else f", and no {other} that was found has half of it."
    order = order_of(problem)
    offered = offered_beside(problem.max_designs, (sound or plain) if better else plain, better, order)
    of_second = [design for design in offered if any(design is one for one in better)]
    if plain and better:
        text += told_of_offered(problem, len(offered), len(of_second))
    return as_one(problem.max_designs, (simple, found), offered, len(of_second), text, order)
