"""Ranking by quantities that are too expensive to measure on every candidate: planes, yield, and forces.

The search uses the default order of its kind and finds more designs than requested. These are then measured and sorted.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import TypeVar

from kinematics.message import compose
from synthesis.model.answer import AnyResult, Verification
from synthesis.model.linkage.answer import LinkageMetrics
from synthesis.model.linkage.problem import FORCE_NAMES, LinkageProblem
from synthesis.model.problem import ProblemBase
from synthesis.model.protocols import DrivenDesign
from synthesis.results.forces import add_force_checks, get_peak
from synthesis.results.ranking import sort_designs
from synthesis.results.remarks import append_remark, write_name

Problem = TypeVar("Problem", bound=ProblemBase)
Design = TypeVar("Design", bound=DrivenDesign)

Measure = Callable[[DrivenDesign], float | None]
"""Callable that returns the measured quantity of a design; None if it is unknown."""

MAX_SEARCHES, LIMIT_FACTOR, MAX_SEARCH_TIME_S = 4, 0.8, 4.0
"""Further searches for orders by a force: maximum number, limit of each as a share of the smallest force found so far,
and processor time (seconds) after which no further search is started."""

MAX_EXAMINED: Mapping[str, int] = {"planes": 40, "yield": 40} | dict.fromkeys(FORCE_NAMES, 100)
"""Number of designs to measure for each such order, unless more are requested: the first ones in the default order."""


MAX_ROUNDED = 12
"""Number of designs to search, unless more are requested, if they are then rounded to a grid: some have no neighbour
on it."""


def widen_search(problem: Problem) -> Problem:
    """Return the statement for the search: with the default order of its kind, and enough designs to be measured.

    The number of designs is at least that of :data:`MAX_EXAMINED`. If the order needs no measurement, it is kept; the
    number of designs is then at least :data:`MAX_ROUNDED` if they are rounded to a grid, and otherwise unchanged.
    """
    if not isinstance(problem, LinkageProblem):
        return problem
    if problem.rank_by not in MAX_EXAMINED:
        gridded = problem.manufacture is not None and problem.manufacture.is_gridded
        # Other orders need no measurement and search as requested.
        return problem.list_later(problem.rank_by, MAX_ROUNDED) if gridded else problem
    return problem.list_later(type(problem).model_fields["rank_by"].default, MAX_EXAMINED[problem.rank_by])


def search_below_limits(
    problem: LinkageProblem, result: AnyResult, solve: Callable[[LinkageProblem], AnyResult]
) -> AnyResult:
    """Search further for designs with smaller forces, for an answer that is ordered by a force.

    Each search limits the force to a share of the smallest one found so far, because a limit guides a search and an
    order does not. The searches end if one finds nothing, after :data:`MAX_SEARCHES` searches, or when the time is up.

    Parameters
    ----------
    problem : LinkageProblem
        The original problem.
    result : Result
        Answer to :func:`widen_search`, with forces.
    solve : callable
        Solves another statement and returns designs with their forces.
    """
    if problem.rank_by not in FORCE_NAMES:
        return result
    limit, found = f"max_{problem.rank_by}", result
    begun = time.process_time()
    for _ in range(MAX_SEARCHES):
        known = [get_peak(design, problem.rank_by) for design in found.designs if design.verification.passed]
        least = min((value for value in known if value is not None), default=0.0)
        # No force is smaller than 0. The negation also ends the search for NaN.
        if not least > 0.0 or time.process_time() - begun > MAX_SEARCH_TIME_S:
            break
        narrowed = problem.constraints.model_copy(update={limit: LIMIT_FACTOR * least})
        asked = widen_search(problem).model_copy(update={"constraints": narrowed, "include_failed": False})
        # The limit applies to the search only, so check the designs against the original limits.
        further = [_restore_checks(problem, design) for design in solve(asked).designs]
        if not further:
            break
        found = found.model_copy(update={"designs": [*further, *found.designs]})
    return found


def _restore_checks(problem: LinkageProblem, design: Design) -> Design:
    """Replace the force checks of a design by those of the original limits."""
    # Checks of the narrower limit would mark good designs as failed.
    checks = [check for check in design.verification.checks if check.name not in FORCE_NAMES]
    bare = design.model_copy(update={"verification": Verification.from_checks(checks)})
    return add_force_checks(problem.constraints, bare)


def rank_by_measure(problem: LinkageProblem, result: AnyResult) -> AnyResult:
    """Sort the measured designs of an answer to :func:`widen_search`, and keep the requested number.

    Designs are sorted by increasing value, or by decreasing yield; equal ones keep their order. Designs without a value
    follow, and designs that fail a check come last.
    """
    designs = sort_by_measure(problem, result.designs)[: problem.max_designs]
    # No remark without designs, because there is nothing to rank.
    told = _describe_order(problem.rank_by, result.designs, _select_measure(problem)) if result.designs else ""
    return result.model_copy(update={"designs": designs, "summary": append_remark(result.summary, told)})


def sort_by_measure(problem: LinkageProblem, designs: Sequence[Design]) -> list[Design]:
    """Return measured designs in the order of :func:`rank_by_measure`."""
    measure = _select_measure(problem)
    sense = -1.0 if problem.rank_by == "yield" else 1.0

    def get_sort_key(design: Design) -> float:
        measured = measure(design)
        # Designs without a value follow all others that passed.
        return math.inf if measured is None else sense * measured

    return sort_designs(designs, get_sort_key)


def _select_measure(problem: LinkageProblem) -> Measure:
    return _MEASURES.get(problem.rank_by) or partial(get_peak, name=problem.rank_by)


def _get_planes(design: DrivenDesign) -> float | None:
    return float(design.layout.count) if design.layout is not None and design.layout.buildable else None


def _get_yield(design: DrivenDesign) -> float | None:
    metrics = design.metrics
    return metrics.yield_.value if isinstance(metrics, LinkageMetrics) and metrics.yield_ is not None else None


_MEASURES: Mapping[str, Measure] = {"planes": _get_planes, "yield": _get_yield}
"""Measures of the orders that are not forces."""


def _describe_order(order: str, designs: Sequence[DrivenDesign], measure: Measure) -> str:
    """Describe the order and the range of its values in a sentence."""
    known = sorted({value for design in designs if (value := measure(design)) is not None})
    count = len(designs)
    if order == "planes":
        match known:
            case []:
                return compose("results-ranked-by-planes-none-buildable", count=count)
            case [only]:
                return compose("results-ranked-by-planes-equal", count=count, planes=round(only))
            case _:
                return compose(
                    "results-ranked-by-planes", count=count, minimum=round(known[0]), maximum=round(known[-1])
                )
    name = write_name(order)
    match known:
        case []:
            return compose("results-ranked-by-unknown-measure", name=name, count=count)
        case [only]:
            return compose("results-ranked-by-equal-measure", name=name, count=count, value=f"{only:.4g}")
        case _:
            return compose(
                "results-ranked-by-measure",
                name=name,
                count=count,
                minimum=f"{known[0]:.4g}",
                maximum=f"{known[-1]:.4g}",
            )
