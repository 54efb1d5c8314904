"""Manufacturing results of designs and their check, for the block ``manufacture`` of a statement."""

from __future__ import annotations

import math

from synthesis.model.answer import Check, Verification
from synthesis.model.linkage.answer import ExactDesign
from synthesis.model.linkage.problem import LinkageProblem
from synthesis.model.manufacture.answer import ManufactureReport, RoundingCost
from synthesis.model.protocols import DrivenDesign, ManufacturableDesign

YIELD = "yield"
"""Name of the check of the yield; it has no value for a design whose yield could not be sampled."""


def add_manufacture(problem: LinkageProblem, design: DrivenDesign) -> ManufacturableDesign:
    """Return a design with all its manufacturing results, and with the check of its yield if one is required."""
    return _add_results(problem, design, allocate=True)


def check_yield(problem: LinkageProblem, design: DrivenDesign) -> ManufacturableDesign:
    """Return a design with the check of its yield and its manufacturing results, except the widest tolerances."""
    return _add_results(problem, design, allocate=False)


def _add_results(problem: LinkageProblem, design: DrivenDesign, *, allocate: bool) -> ManufacturableDesign:
    """Return a design with its manufacturing results; unchanged if it already has them.

    With ``allocate`` the widest tolerances are found, too, if they are requested. This takes many times as long.
    """
    # Only kinds with such designs accept the block.
    assert isinstance(design, ManufacturableDesign)
    stated = problem.manufacture
    if stated is None:
        return design
    if not allocate:
        # The yield counts for the rounded design, which does not exist yet.
        if stated.is_gridded and design.exact is None:
            return design
        # The check of the yield does not depend on the widest tolerances, which only the final designs need.
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
        rounded = {"dimensions": dict(named), "cost": _compare_with_exact(problem, design, design.exact)}
        told = told._replace(manufactured=told.manufactured.model_copy(update=rounded))
    metrics = design.metrics.model_copy(update={"yield_": told.yield_})
    update: dict[str, object] = {"manufacture": told.manufactured, "metrics": metrics}
    if stated.required_yield is not None:
        low = None if told.yield_ is None else told.yield_.low
        # The estimate alone proves nothing: the lower end of the confidence interval must reach the required yield.
        kept = low is not None and low >= stated.required_yield
        others = [check for check in design.verification.checks if check.name != YIELD]
        check = Check(name=YIELD, passed=kept, value=low, limit=stated.required_yield)
        update["verification"] = Verification.from_checks([*others, check])
    return design.model_copy(update=update)


def find_branch_range(problem: LinkageProblem, design: DrivenDesign) -> tuple[float, float] | None:
    """Return the range of the input, radians, on which a manufactured design must stay on its branch.

    Return None if it need not stay on its branch, or if no motion passes through the targets.
    """
    used = design.metrics.used_range
    # Without this constraint a linkage may change its branch between targets.
    if used is None or not problem.constraints.same_branch:
        return None
    return math.radians(used[0]), math.radians(used[1])


def describe_exact_design(problem: LinkageProblem, design: ManufacturableDesign) -> ExactDesign:
    """Describe a design by the measures that are compared before and after rounding."""
    error, angle = problem.measure_target_errors(design)
    return ExactDesign(
        mechanism=design.mechanism,
        rms_residual=design.metrics.rms_residual,
        max_error=error,
        max_angle_error=angle,
        min_transmission_angle=design.metrics.min_transmission_angle,
    )


def _compare_with_exact(problem: LinkageProblem, design: ManufacturableDesign, before: ExactDesign) -> RoundingCost:
    after = describe_exact_design(problem, design)
    names = RoundingCost.model_fields
    pairs = {name: (getattr(after, name), getattr(before, name)) for name in names}
    return RoundingCost(**{name: None if one is None else one - other for name, (one, other) in pairs.items()})
