"""Designs as manufactured, for the block ``manufacture`` of a statement: results and checks."""

from __future__ import annotations

import math
from typing import Any, TypeVar

from synthesis.model.answer import Check, Result, Verification
from synthesis.model.linkage.answer import ExactDesign
from synthesis.model.linkage.problem import LinkageProblem
from synthesis.model.manufacture.answer import ManufactureReport, RoundingCost
from synthesis.model.problem import ProblemBase

Design = TypeVar("Design", bound=Any)

YIELD = "yield"
"""Name of the check of the yield; it has no value for a design whose yield could not be sampled."""


def verify_yield(problem: ProblemBase, design: Design) -> Design:
    """Return a design with the check of its yield, if it passed all other checks and the problem requires a yield."""
    if not isinstance(problem, LinkageProblem) or problem.manufacture is None:
        return design
    if problem.manufacture.required_yield is None or not design.verification.passed:
        return design
    # The yield counts for the rounded design, which does not exist yet.
    if problem.manufacture.is_gridded and design.exact is None:
        return design
    return analyze_manufacture(problem, design, allocate=False)


def analyze_all_manufacture(problem: LinkageProblem, result: Result[Any]) -> Result[Any]:
    """Return an answer with the manufacturing results of all its designs and of the nearest miss."""
    miss = result.nearest_miss
    if miss is not None:
        miss = miss.model_copy(update={"design": analyze_manufacture(problem, miss.design)})
    designs = [analyze_manufacture(problem, design) for design in result.designs]
    return result.model_copy(update={"designs": designs, "nearest_miss": miss})


def analyze_manufacture(problem: LinkageProblem, design: Design, *, allocate: bool = True) -> Design:
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
        # The widest tolerances need the final designs only; the check of the yield does not depend on them.
        stated = stated.model_copy(update={"widest": False})
    # Results exist already, unless only the tolerances are missing.
    if design.manufacture is not None and (design.manufacture.widest or not stated.widest):
        return design
    # A local import: only problems with this block need the module.
    from synthesis.manufacture.linkage import extract_linkage
    from synthesis.manufacture.report import ManufactureResult, report_manufacture

    used = find_branch_range(problem, design)
    told = ManufactureResult(ManufactureReport(), None)
    if stated.tolerances is not None:
        told = report_manufacture(design.mechanism, problem.build_required_targets(design), stated, problem.seed, used)
    if design.exact is not None:
        linkage = extract_linkage(design.mechanism)
        assert linkage is not None
        # P is given by distance and angle, from which its grid coordinates follow only with rounding errors.
        digits = [float(f"{value:.12g}") for value in linkage.row]
        named = zip(linkage.list_names(guides=problem.guides_a_point), digits, strict=False)
        rounded = {"dimensions": dict(named), "cost": _compare_with_exact(problem, design)}
        told = told._replace(manufactured=told.manufactured.model_copy(update=rounded))
    metrics = design.metrics.model_copy(update={"yield_": told.yield_})
    update: dict[str, Any] = {"manufacture": told.manufactured, "metrics": metrics}
    if stated.required_yield is not None:
        low = None if told.yield_ is None else told.yield_.low
        # The lower end of the confidence interval must reach the required yield.
        kept = low is not None and low >= stated.required_yield
        others = [check for check in design.verification.checks if check.name != YIELD]
        check = Check(name=YIELD, passed=kept, value=low, limit=stated.required_yield)
        update["verification"] = Verification.from_checks([*others, check])
    changed: Design = design.model_copy(update=update)
    return changed


def find_branch_range(problem: LinkageProblem, design: Any) -> tuple[float, float] | None:
    """Return the range of the input (radians) on which a manufactured design must stay on its branch, or None."""
    used = design.metrics.used_range
    # Without this constraint a linkage may change its branch between targets.
    if used is None or not problem.constraints.same_branch:
        return None
    return math.radians(used[0]), math.radians(used[1])


def measure_target_errors(problem: LinkageProblem, design: Any) -> tuple[float | None, float | None]:
    """Return the maximum distance and angle (degrees) by which a design misses its targets; None if not applicable."""
    greatest = getattr(design.metrics, "max_structural_error", None)
    # Function generators measure one maximum error, in the unit of the output.
    if greatest is not None:
        return (greatest, None) if problem.slides else (None, greatest)
    angles = [target.angle_residual for target in design.targets if target.angle_residual is not None]
    return max(target.point_residual for target in design.targets), max(angles, default=None)


def describe_exact_design(problem: LinkageProblem, design: Any) -> ExactDesign:
    """Describe the exact design of which a design on the grid is the rounded version."""
    error, angle = measure_target_errors(problem, design)
    return ExactDesign(
        mechanism=design.mechanism,
        rms_residual=design.metrics.rms_residual,
        max_error=error,
        max_angle_error=angle,
        min_transmission_angle=design.metrics.min_transmission_angle,
    )


def _compare_with_exact(problem: LinkageProblem, design: Any) -> RoundingCost:
    before, after = design.exact, describe_exact_design(problem, design)
    names = RoundingCost.model_fields
    pairs = {name: (getattr(after, name), getattr(before, name)) for name in names}
    return RoundingCost(**{name: None if one is None else one - other for name, (one, other) in pairs.items()})
