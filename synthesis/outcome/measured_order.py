"""Orders by quantities that are too expensive to measure on every candidate: planes, yield, and forces.

The search uses the default order of its kind and finds more designs than requested; these are measured and sorted.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, TypeVar

from synthesis.model.answer import Result, Verification
from synthesis.model.counting import counted
from synthesis.model.linkage_statement import FORCES, LinkageProblem
from synthesis.model.statement import StatedProblem
from synthesis.outcome.forces import value_of, with_force_checks

Problem = TypeVar("Problem", bound=StatedProblem)

SEARCHES, NARROWER, PATIENCE_S = 4, 0.8, 4.0
"""For orders by a force: maximum number of further searches, limit of each as a share of the smallest force so far, and
processor time (seconds) after which none is started."""

LOOKED_AT: Mapping[str, int] = {"planes": 40, "yield": 40} | dict.fromkeys(FORCES, 100)
"""Minimum number of designs to measure for each such order: the first ones in the default order."""


GRIDDED = 12
"""Minimum number of designs to search if they are then rounded to a grid, as some have no neighbour on it."""


def searched_for(problem: Problem) -> Problem:
    """Return the statement to search: with the default order of its kind and :data:`LOOKED_AT` designs.

    If designs are rounded to a grid, the order is kept and the number of designs is at least :data:`GRIDDED`.
    """
    if not isinstance(problem, LinkageProblem):
        return problem
    if problem.rank_by not in LOOKED_AT:
        gridded = problem.manufacture is not None and problem.manufacture.gridded
        return problem.listing_later(problem.rank_by, GRIDDED) if gridded else problem
    return problem.listing_later(type(problem).model_fields["rank_by"].default, LOOKED_AT[problem.rank_by])


def searched_on(problem: LinkageProblem, result: Result[Any], solve: Callable[[Any], Result[Any]]) -> Result[Any]:
    """Add designs with smaller forces to an answer that is ordered by a force, by further searches.

    Each search limits the force to a share of the smallest one so far, because a limit guides a search and an order
    does not. The searches end if one finds nothing, after :data:`SEARCHES` searches, or when the time is up.

    Parameters
    ----------
    problem : LinkageProblem
        The original problem.
    result : Result
        Answer to :func:`searched_for`, with forces.
    solve : callable
        Solves another statement and returns designs with their forces.
    """
    if problem.rank_by not in FORCES:
        return result
    limit, found = f"max_{problem.rank_by}", result
    begun = time.process_time()
    for _ in range(SEARCHES):
        known = [value_of(design, problem.rank_by) for design in found.designs if design.verification.passed]
        least = min((value for value in known if value is not None), default=0.0)
        # Nothing can be smaller than 0, and NaN ends the search as well.
        if not least > 0.0 or time.process_time() - begun > PATIENCE_S:
            break
        narrowed = problem.constraints.model_copy(update={limit: NARROWER * least})
        asked = searched_for(problem).model_copy(update={"constraints": narrowed, "include_failed": False})
        further = [_as_stated(problem, design) for design in solve(asked).designs]
        if not further:
            break
        found = found.model_copy(update={"designs": [*further, *found.designs]})
    return found


def _as_stated(problem: LinkageProblem, design: Any) -> Any:
    """Replace the force checks of a design by those of the original limits."""
    checks = [check for check in design.verification.checks if check.name not in FORCES]
    bare = design.model_copy(update={"verification": Verification.of(checks)})
    return with_force_checks(problem.constraints, bare)


def least_first(problem: LinkageProblem, result: Result[Any]) -> Result[Any]:
    """Sort the measured designs of an answer to :func:`searched_for`, and keep the requested number.

    Designs are sorted by increasing value, but by decreasing yield; equal ones keep their order. Designs without a
    value follow, and designs that fail a check come last.
    """
    designs = in_order(problem, result.designs)[: problem.max_designs]
    told = _told(problem.rank_by, result.designs, _measure_of(problem)) if result.designs else ""
    return result.model_copy(update={"designs": designs, "summary": result.summary + told})


def in_order(problem: LinkageProblem, designs: Sequence[Any]) -> list[Any]:
    """Return measured designs in the order of :func:`least_first`."""
    measure = _measure_of(problem)
    sense = -1.0 if problem.rank_by == "yield" else 1.0

    def place(design: Any) -> tuple[bool, float]:
        measured = measure(design)
        return not design.verification.passed, math.inf if measured is None else sense * measured

    return sorted(designs, key=place)


def _measure_of(problem: LinkageProblem) -> Callable[[Any], float | None]:
    return _MEASURES.get(problem.rank_by) or partial(value_of, name=problem.rank_by)


def _planes(design: Any) -> float | None:
    return float(design.layout.count) if design.layout.buildable else None


def _yield(design: Any) -> float | None:
    return None if design.metrics.yield_ is None else float(design.metrics.yield_.value)


_MEASURES: Mapping[str, Callable[[Any], float | None]] = {"planes": _planes, "yield": _yield}
"""Measures of the orders that are not forces."""


def _told(order: str, designs: list[Any], measure: Callable[[Any], float | None]) -> str:
    """Describe the order and the range of its values in a sentence."""
    known = sorted({value for design in designs if (value := measure(design)) is not None})
    what = order.replace("_", " ")
    if order == "planes":
        missing, done = "none of them can be built", "arranged in planes"
    else:
        missing, done = f"none of them has a known {what}", "measured"
    match known:
        case []:
            found = missing
        case [only]:
            found = f"every buildable one needs {only:.0f}" if order == "planes" else f"{only:.4g}"
        case _:
            found = "they need" if order == "planes" else "from"
            found += f" {known[0]:.4g} to {known[-1]:.4g}"
    count = len(designs)
    return f" Ranked by {what} ({counted(count, 'design')} {done}): {found}."
