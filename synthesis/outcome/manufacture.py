"""Designs as manufactured, for the block ``manufacture`` of a statement: results and checks."""

from __future__ import annotations

import math
from typing import Any, TypeVar

from synthesis.model.answer import Check, Result, Verification
from synthesis.model.linkage_answer import ExactDesign
from synthesis.model.linkage_statement import LinkageProblem
from synthesis.model.manufacture_answer import Manufactured, RoundingCost
from synthesis.model.statement import StatedProblem

Design = TypeVar("Design", bound=Any)

YIELD = "yield"
"""Name of the check of the yield; it has no value for a design whose yield could not be sampled."""


def held_to_yield(problem: StatedProblem, design: Design) -> Design:
    """Return a design with the check of its yield, if it passed all other checks and the problem requires a yield."""
    if not isinstance(problem, LinkageProblem) or problem.manufacture is None:
        return design
    if problem.manufacture.demanded_yield is None or not design.verification.passed:
        return design
    if problem.manufacture.gridded and design.exact is None:
        return design
    return made(problem, design, allocate=False)


def all_made(problem: LinkageProblem, result: Result[Any]) -> Result[Any]:
    """Return an answer with the manufacturing results of all its designs and of the nearest miss."""
    miss = result.nearest_miss
    if miss is not None:
        miss = miss.model_copy(update={"design": made(problem, miss.design)})
    designs = [made(problem, design) for design in result.designs]
    return result.model_copy(update={"designs": designs, "nearest_miss": miss})


def made(problem: LinkageProblem, design: Design, *, allocate: bool = True) -> Design:
    """Return a linkage design with its manufacturing results, and with the check of its yield if one is required.

    Parameters
    ----------
    problem : LinkageProblem
        Problem with a block ``manufacture``.
    design : a design of linkages
        The verified design; it is returned unchanged if it already has these results.
    allocate : bool
        Whether to find the widest tolerances, if requested; this takes many times as long.
    """
    stated = problem.manufacture
    if stated is None:
        return design
    if not allocate:
        stated = stated.model_copy(update={"widest": False})
    if design.manufacture is not None and (design.manufacture.widest or not stated.widest):
        return design
    # A local import: only problems with this block need the module.
    from synthesis.manufacture.linkage import linkage_of
    from synthesis.manufacture.report import Reported, reported

    used = branch_range(problem, design)
    told = Reported(Manufactured(), None)
    if stated.tolerances is not None:
        told = reported(design.mechanism, problem.held_to(design), stated, problem.seed, used)
    if design.exact is not None:
        linkage = linkage_of(design.mechanism)
        assert linkage is not None
        # P is given by distance and angle, from which its grid coordinates follow only with rounding errors.
        digits = [float(f"{value:.12g}") for value in linkage.row]
        named = zip(linkage.names(guides=problem.guides_a_point), digits, strict=False)
        rounded = {"dimensions": dict(named), "cost": _cost(problem, design)}
        told = told._replace(manufactured=told.manufactured.model_copy(update=rounded))
    metrics = design.metrics.model_copy(update={"yield_": told.yield_})
    update: dict[str, Any] = {"manufacture": told.manufactured, "metrics": metrics}
    if stated.demanded_yield is not None:
        low = None if told.yield_ is None else told.yield_.low
        kept = low is not None and low >= stated.demanded_yield
        others = [check for check in design.verification.checks if check.name != YIELD]
        check = Check(name=YIELD, passed=kept, value=low, limit=stated.demanded_yield)
        update["verification"] = Verification.of([*others, check])
    changed: Design = design.model_copy(update=update)
    return changed


def branch_range(problem: LinkageProblem, design: Any) -> tuple[float, float] | None:
    """Return the range of the input (radians) on which a manufactured design must stay on its branch, or None."""
    used = design.metrics.used_range
    if used is None or not problem.constraints.same_branch:
        return None
    return math.radians(used[0]), math.radians(used[1])


def errors_of(problem: LinkageProblem, design: Any) -> tuple[float | None, float | None]:
    """Return the maximum distance and angle (degrees) by which a design misses its targets; None if not applicable."""
    greatest = getattr(design.metrics, "max_structural_error", None)
    if greatest is not None:
        return (greatest, None) if problem.slides else (None, greatest)
    angles = [target.angle_residual for target in design.targets if target.angle_residual is not None]
    return max(target.point_residual for target in design.targets), max(angles, default=None)


def exact_design(problem: LinkageProblem, design: Any) -> ExactDesign:
    """Describe the exact design of which a design on the grid is the rounded version."""
    error, angle = errors_of(problem, design)
    return ExactDesign(
        mechanism=design.mechanism,
        rms_residual=design.metrics.rms_residual,
        max_error=error,
        max_angle_error=angle,
        min_transmission_angle=design.metrics.min_transmission_angle,
    )


def _cost(problem: LinkageProblem, design: Any) -> RoundingCost:
    before, after = design.exact, exact_design(problem, design)
    names = RoundingCost.model_fields
    pairs = {name: (getattr(after, name), getattr(before, name)) for name in names}
    return RoundingCost(**{name: None if one is None else one - other for name, (one, other) in pairs.items()})
