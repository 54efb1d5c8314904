"""Orders by what takes too long to be measured of every candidate: planes, yield, and forces.

The search is in the usual order of its kind, for more designs than are wanted; they are measured, and then ordered.
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
"""Further searches at most where forces order, the share of the least force that each may have, and the processor time
after which none is begun."""

LOOKED_AT: Mapping[str, int] = {"planes": 40, "yield": 40} | dict.fromkeys(FORCES, 100)
"""Designs at least that are measured, the first of the usual order, for each such order."""


GRIDDED = 12
"""Designs at least that are looked for where those near them on a grid are answered: some have none."""


def searched_for(problem: Problem) -> Problem:
    """The statement that is searched for: with the order of its kind, and :data:`LOOKED_AT` designs.

    The same order with :data:`GRIDDED` designs where these are put on a grid.
    """
    if not isinstance(problem, LinkageProblem):
        return problem
    if problem.rank_by not in LOOKED_AT:
        gridded = problem.manufacture is not None and problem.manufacture.gridded
        return problem.listing_later(problem.rank_by, GRIDDED) if gridded else problem
    return problem.listing_later(type(problem).model_fields["rank_by"].default, LOOKED_AT[problem.rank_by])


def searched_on(problem: LinkageProblem, result: Result[Any], solve: Callable[[Any], Result[Any]]) -> Result[Any]:
    """An answer that is ordered by a force, with designs of less of it from further searches.

    Each is for designs with no more than a share of the least so far: limits steer a search, an order does not. They
    end where one finds nothing, after :data:`SEARCHES`, or where the time is up.

    Parameters
    ----------
    problem : LinkageProblem
        As stated.
    result : Result
        Of :func:`searched_for`, with forces.
    solve : callable
        Designs with their forces for another statement.
    """
    if problem.rank_by not in FORCES:
        return result
    limit, found = f"max_{problem.rank_by}", result
    begun = time.process_time()
    for _ in range(SEARCHES):
        known = [value_of(design, problem.rank_by) for design in found.designs if design.verification.passed]
        least = min((value for value in known if value is not None), default=0.0)
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
    """A design of a narrower search with the checks of the limits that were stated, and no others."""
    checks = [check for check in design.verification.checks if check.name not in FORCES]
    bare = design.model_copy(update={"verification": Verification.of(checks)})
    return with_force_checks(problem.constraints, bare)


def least_first(problem: LinkageProblem, result: Result[Any]) -> Result[Any]:
    """As many designs as are wanted of an answer to :func:`searched_for`, measured, those with the least first.

    Of yields the greatest is first. Those with as much stay in their order. What could not be measured comes after what
    could, and designs that break a check last.
    """
    designs = in_order(problem, result.designs)[: problem.max_designs]
    told = _told(problem.rank_by, result.designs, _measure_of(problem)) if result.designs else ""
    return result.model_copy(update={"designs": designs, "summary": result.summary + told})


def in_order(problem: LinkageProblem, designs: Sequence[Any]) -> list[Any]:
    """Designs, measured, in the order that :func:`least_first` gives them."""
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
"""What is no force."""


def _told(order: str, designs: list[Any], measure: Callable[[Any], float | None]) -> str:
    """What the order was made of, as a sentence."""
    known = sorted({value for design in designs if (value := measure(design)) is not None})
    what = order.replace("_", " ")
    if order == "planes":
        missing, done = "none of them can be built", "laid out"
    else:
        missing, done = f"none of them has a known {what}", "measured"
    match known:
        case []:
            found = missing
        case [only]:
            found = f"every one that can be built takes {only:.0f}" if order == "planes" else f"it is {only:.4g}"
        case _:
            found = "they take" if order == "planes" else "it is"
            found += f" {known[0]:.4g} to {known[-1]:.4g}"
    count = len(designs)
    return f" Ordered by {what}, of {counted(count, 'design')} {done}; {found}."
