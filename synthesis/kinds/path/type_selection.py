"""Selection of the linkage type that guides the point: the simplest sound and near one, followed by better ones.

Simpler types are searched first: fourbars, slider-cranks, geared fivebars, all sixbars together, then eightbars. With
``auto`` eightbars are searched only if all simpler linkages are farther off than :data:`MAX_SIMPLER_ERROR`. A linkage
that satisfies all constraints is the only answer if it transmits force well enough
(:func:`~synthesis.results.simplest_type.has_good_transmission`) and is near: its error is at most
:data:`MAX_NEAR_ERROR` of the task's size, or within the given tolerances. Otherwise the next types are searched. They
are listed next to it if their error is at most :data:`ERROR_RATIO` of its minimum error, or if only they are sound.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Literal

from kinematics.message import compose, join_messages
from synthesis.kinds.path.design import PathDesign, PathResult
from synthesis.kinds.path.multiloop.solver import describe_best_linkages, solve_eightbars, solve_sixbars
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.results import join_sentences
from synthesis.kinds.path.statement.mechanism_types import (
    MULTILOOP_TYPES,
    TYPE_NAMES,
    Simple,
    find_unsupported,
    find_unsupported_unclassed,
    list_simple_types,
)
from synthesis.kinds.path.task.ranking import build_ordering, compute_error, find_min_error, is_exact
from synthesis.model.kind import Progress, scale_progress
from synthesis.model.linkage.type_choice import describe_skipped_sixbars, describe_unclassed, select_searched_types
from synthesis.results.simplest_type import (
    ERROR_RATIO,
    describe_alternatives,
    has_good_transmission,
    merge_alternatives,
    merge_results,
    select_passing,
)

Solve = Callable[[PathProblem, Progress], PathResult]

MAX_NEAR_ERROR = 1e-3
"""Error, as a share of the task's size, below which no more complex type is searched."""

MAX_SIMPLER_ERROR = 0.03
"""Error of the best simpler linkage, as a share of the task's size, below which ``auto`` searches no eightbars: two
more links must pay for themselves, and a client can ask for them."""


def solve_types(problem: PathProblem, of_one: Solve, progress: Progress) -> PathResult:
    """Solve a problem for each of the types that it names, simplest first, and combine the results.

    Parameters
    ----------
    problem : PathProblem
        With :attr:`PathProblem.mechanisms`.
    of_one : callable
        Solver for a single type with one closure, as requested without that field.
    progress : callable
        Receives the share of the work done.
    """
    stages: list[Simple | Literal["sixbar", "eightbar"]] = [*list_simple_types(problem.mechanisms)]
    if problem.sixbars:
        stages.append("sixbar")
    if problem.has_eightbars:
        stages.append("eightbar")
    result: PathResult | None = None
    before: list[str] = []
    for n, name in enumerate(stages):
        part = scale_progress(progress, n / len(stages), (n + 1) / len(stages))
        if name == "eightbar":
            if result is not None and problem.mechanisms == "auto" and not _is_far(problem, result):
                break
            found = solve_eightbars(problem, part)
        else:
            found = solve_sixbars(problem, part) if name == "sixbar" else of_one(problem.select_type(name), part)
        result = found if result is None else combine_results(problem, result, found, before, name)
        before.append(name)
        # A sound and accurate simple linkage ends the search: designers prefer fewer links.
        if any(_is_sufficient(problem, design) for design in select_passing(result.designs)):
            break
    assert result is not None
    # The types that were not needed leave their shares of the progress.
    progress(1.0, compose("path-verified"))
    sentences = [result.summary]
    if not problem.is_listed_later:
        sentences.append(describe_best_linkages(problem, result.designs))
    if problem.mechanisms == "auto" and not problem.sixbars:
        sentences.append(describe_skipped_sixbars(find_unsupported(problem)))
    elif problem.mechanisms != "auto":
        named = select_searched_types(problem.mechanisms, MULTILOOP_TYPES, find_unsupported(problem))
        sentences.append(describe_unclassed(named, find_unsupported_unclassed(problem)))
    return result.model_copy(update={"summary": join_sentences(sentences)})


def _is_sufficient(problem: PathProblem, design: PathDesign) -> bool:
    """Return whether a linkage that satisfies all constraints is sound and near enough to end the search."""
    near = problem.tolerances is not None or compute_error(design, problem) <= MAX_NEAR_ERROR * problem.task_size
    return near and has_good_transmission(problem, design)


def _is_far(problem: PathProblem, result: PathResult) -> bool:
    """Return whether no linkage that satisfies all constraints is near the target."""
    errors = [compute_error(design, problem) for design in select_passing(result.designs)]
    return min(errors, default=math.inf) > MAX_SIMPLER_ERROR * problem.task_size


def combine_results(
    problem: PathProblem, simple: PathResult, found: PathResult, before: list[str], name: str
) -> PathResult:
    """Combine the results of simpler linkages and of another type.

    Designs that passed but are not listed count as outranked.

    Parameters
    ----------
    problem : PathProblem
        The problem as requested.
    simple, found : PathResult
        The answers.
    before, name : list of str and str
        The types of the first, and that of the second.
    """
    plain, better = select_passing(simple.designs), select_passing(found.designs)
    sound = [design for design in plain if has_good_transmission(problem, design)]
    first, other = _list_types(before), compose(TYPE_NAMES[name])
    if not plain:
        text = compose("path-only-other-passed" if better else "path-neither-passed", simple=first, other=other)
    elif not sound and (alone := [design for design in better if has_good_transmission(problem, design)]):
        # Only the complex type has sound designs: list these alone.
        better = alone
        text = compose("path-only-other-sound", simple=first, other=other)
    elif not sound and all(map(is_exact, plain)):
        # Exact designs have no error to halve, so that a more complex type without force transmission gains nothing.
        better = []
        text = compose("path-neither-sound", simple=first, other=other)
    else:
        least = find_min_error(sound or plain, problem)
        # More links must pay off by at least half the error.
        better = [design for design in better if compute_error(design, problem) <= ERROR_RATIO * least]
        text = compose(
            "path-other-halves-error" if better else "path-no-other-halves-error",
            simple=first,
            other=other,
            error=f"{least:.3g}",
            unit=problem.length_unit,
        )
    order = build_ordering(problem)
    offered = merge_alternatives(problem.max_designs, (sound or plain) if better else plain, better, order)
    of_second = [design for design in offered if any(design is one for one in better)]
    if plain and better:
        text = join_messages([text, describe_alternatives(problem, len(offered), len(of_second))], "")
    return merge_results(problem.max_designs, (simple, found), offered, len(of_second), text, order)


def _list_types(names: list[str]) -> str:
    """Return the names of types in words, joined by "or"."""
    text = compose(TYPE_NAMES[names[0]])
    for name in names[1:]:
        text = compose("path-type-or-type", first=text, last=compose(TYPE_NAMES[name]))
    return text
