"""Designs as a shop makes them: what the block ``manufacture`` of a statement adds to an answer, and demands of it."""

from __future__ import annotations

import math
from typing import Any, TypeVar

from synthesis.model.answer import Check, Result, Verification
from synthesis.model.linkage_statement import LinkageProblem
from synthesis.model.statement import StatedProblem

Design = TypeVar("Design", bound=Any)

YIELD = "yield"
"""The check of the yield; of a design for which none could be sampled it has no value."""


def held_to_yield(problem: StatedProblem, design: Design) -> Design:
    """A design that passed every other check, with that of its yield, where the problem demands one."""
    if not isinstance(problem, LinkageProblem) or problem.manufacture is None:
        return design
    if problem.manufacture.demanded_yield is None or not design.verification.passed:
        return design
    return made(problem, design)


def all_made(problem: LinkageProblem, result: Result[Any]) -> Result[Any]:
    """An answer with all of its designs as they are made, the nearest miss among them."""
    miss = result.nearest_miss
    if miss is not None:
        miss = miss.model_copy(update={"design": made(problem, miss.design)})
    designs = [made(problem, design) for design in result.designs]
    return result.model_copy(update={"designs": designs, "nearest_miss": miss})


def made(problem: LinkageProblem, design: Design) -> Design:
    """A design of linkages as it is made, with the check of its yield where one is demanded.

    Parameters
    ----------
    problem : LinkageProblem
        Whose block ``manufacture`` is stated.
    design : a design of linkages
        As verified; one that has been looked at stays as it is.
    """
    stated = problem.manufacture
    if stated is None or design.manufacture is not None:
        return design
    # Only who states the block waits for the import.
    from synthesis.manufacture.report import reported

    used = design.metrics.used_range
    if used is not None and problem.constraints.same_branch:
        used = math.radians(used[0]), math.radians(used[1])
    else:
        used = None
    told = reported(design.mechanism, problem.held_to(design), stated, problem.seed, used)
    metrics = design.metrics.model_copy(update={"yield_": told.yield_})
    update: dict[str, Any] = {"manufacture": told.manufactured, "metrics": metrics}
    if stated.demanded_yield is not None:
        low = None if told.yield_ is None else told.yield_.low
        kept = low is not None and low >= stated.demanded_yield
        check = Check(name=YIELD, passed=kept, value=low, limit=stated.demanded_yield)
        update["verification"] = Verification.of([*design.verification.checks, check])
    changed: Design = design.model_copy(update=update)
    return changed
