"""Rounding of designs to the grid of a shop, or to links in stock.

A search finds exact designs. The linkages on the grid near each of them are driven and fully verified, the most
accurate one first, until one satisfies every constraint. Targets that should be met exactly are then met approximately,
within the quality if one is given.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.message import compose
from synthesis.model.answer import AnyNearestMiss, AnyResult, Check, Gap, Reachable, Verification
from synthesis.model.dimension import ANGLE, LENGTH
from synthesis.model.linkage.answer import ExactDesign, FourbarMechanism, SliderCrankMechanism
from synthesis.model.linkage.problem import LinkageProblem
from synthesis.model.manufacture.request import RequiredTargets
from synthesis.model.protocols import ManufacturableDesign
from synthesis.results.manufacture import describe_exact_design, find_branch_range
from synthesis.results.measurement import check_shared_constraints
from synthesis.results.ranking import select_best
from synthesis.results.remarks import append_remark
from synthesis.verification.checks import check_maximum

Nearly = Callable[[Any, Any, Any], Any]
"""Type of :attr:`synthesis.model.kind.Kind.nearly`, for any kind."""

ON_GRID = "on_grid"
"""Reason of rejection if no linkage on the grid near a design can be driven."""

MAX_DRIVEN, MAX_VERIFIED = 100, 40
"""Maximum number of linkages near a design that are driven, and of those that are checked for all other constraints."""

LARGE_ERROR = 0.05
"""Permitted error at a target if no quality is given: a share of the task's size, and radians."""

MAX_ERROR_GROWTH = 2.0
"""Permitted error after rounding, as a multiple of the exact design's error, if this exceeds :data:`LARGE_ERROR`."""


class _RoundedDesign(NamedTuple):
    """Best linkage on the grid near a design, and its reason of rejection, which is empty if it passed."""

    design: ManufacturableDesign | None
    reason: str


def round_designs(problem: LinkageProblem, result: AnyResult, verify_with_tolerance: Nearly | None) -> AnyResult:
    """Return an answer with its designs rounded to the requested grid; each contains its exact design.

    Parameters
    ----------
    problem : LinkageProblem
        The problem with the requested number of designs.
    result : Result
        Exact designs; those that fail a check are kept unchanged, after the others.
    verify_with_tolerance : callable or None
        The kind's :attr:`synthesis.model.kind.Kind.nearly`.
    """
    stated = problem.manufacture
    if stated is None or not stated.is_gridded or verify_with_tolerance is None:
        return result
    passed = [design for design in result.designs if design.verification.passed]
    failed = [design for design in result.designs if not design.verification.passed]
    if not passed:
        return result
    found: list[ManufacturableDesign] = []
    missed: list[_RoundedDesign] = []
    for design in passed:
        # Designs are rounded in order, so the first ones found are the best.
        if len(found) >= problem.max_designs:
            break
        rounded = _round_design(problem, design, verify_with_tolerance)
        if rounded.design is None or rounded.reason:
            missed.append(rounded)
        else:
            found.append(rounded.design)
    # Count designs without a good neighbour as rejected instead of accepted, so that the counts still add up.
    lost = Counter(rounded.reason for rounded in missed)
    search = result.search
    account = {
        # Rounding looks only near the designs, so the search is no longer exhaustive.
        "complete": False,
        "accepted": search.accepted - len(missed),
        "rejected": dict(Counter(search.rejected) + lost),
    }
    remark = compose("results-rounded", kept=len(found), count=len(found) + len(missed))
    if problem.include_failed:
        failed = [rounded.design for rounded in missed if rounded.design is not None] + failed
    return result.model_copy(
        update={
            "designs": [*found, *(failed if problem.include_failed else [])][: problem.max_designs],
            "search": search.model_copy(update=account),
            "summary": append_remark(result.summary, remark),
            # A nearest miss is needed only if no design could be rounded.
            "nearest_miss": result.nearest_miss if found else _find_nearest_miss(missed),
        }
    )


def _round_design(
    problem: LinkageProblem, design: ManufacturableDesign, verify_with_tolerance: Nearly
) -> _RoundedDesign:
    """Find the best linkage on the grid near a design."""
    # A local import: only problems with this block need the module.
    from synthesis.manufacture.grid import build_mechanism, find_nearest_on_grid, replace_dimensions
    from synthesis.manufacture.linkage import extract_linkage

    linkage = extract_linkage(design.mechanism)
    if linkage is None or problem.manufacture is None:
        return _RoundedDesign(None, ON_GRID)
    exact, held = describe_exact_design(problem, design), problem.build_required_targets(design)
    limits = _set_error_limits(problem, held, exact)
    near = find_nearest_on_grid(linkage, held, problem.manufacture, find_branch_range(problem, design), limits)
    if isinstance(near, str):
        return _RoundedDesign(None, ON_GRID)
    first, judged = _RoundedDesign(None, ON_GRID), 0
    # The linkages are sorted by error, so the first that passes is the most accurate one.
    for n in range(min(len(near.rows), MAX_DRIVEN)):
        mechanism = build_mechanism(linkage, near, n)
        driven: ManufacturableDesign | None = (
            None if mechanism is None else verify_with_tolerance(problem, design, mechanism)
        )
        if driven is None:
            continue
        # Only these types have a grid.
        assert isinstance(driven.mechanism, FourbarMechanism | SliderCrankMechanism)
        checks = [*_check_quality(problem, driven, exact), *driven.verification.checks]
        rounded = driven.model_copy(
            update={
                # The mechanism was built from computed joints, but its dimensions must be exactly the grid values.
                "mechanism": replace_dimensions(driven.mechanism, near.rows[n]),
                "exact": exact,
                "verification": Verification.from_checks(checks),
            }
        )
        if rounded.verification.passed:
            judged += 1
            verified = check_shared_constraints(problem, rounded)
            if verified is None:
                # The linkage was driven, but no mechanism can be rebuilt from its rounded dimensions.
                continue
            rounded = verified
        broken = rounded.verification.failures
        if not broken:
            return _RoundedDesign(rounded, "")
        # Keep the most accurate failure for the nearest miss.
        if first.design is None:
            first = _RoundedDesign(rounded, broken[0].name)
        # The shared constraints are expensive, so limit the number of linkages that are checked for them.
        if judged >= MAX_VERIFIED:
            break
    return first


def _check_quality(problem: LinkageProblem, design: ManufacturableDesign, exact: ExactDesign) -> list[Check]:
    """Check the errors at targets that have no tolerance of their own."""
    held = problem.build_required_targets(design)
    own = _mark_own_tolerances(held)
    # Targets with their own tolerances have checks of their own.
    error, angle = problem.measure_target_errors(design, None if own is None else ~own)
    distance, turn = _set_error_limits(problem, held, exact)
    checks = []
    if error is not None:
        checks.append(check_maximum("max_error", error, distance, LENGTH))
    if angle is not None:
        checks.append(check_maximum("max_angle_error", angle, math.degrees(turn), ANGLE))
    return checks


def _set_error_limits(problem: LinkageProblem, held: RequiredTargets, exact: ExactDesign) -> tuple[float, float]:
    """Return the permitted distance and angle (radians) at targets: the quality if given, otherwise the defaults."""
    quality = None if problem.manufacture is None else problem.manufacture.quality
    # A design that is a fit to many targets is itself inaccurate; rounding may then double its error.
    distance = max(LARGE_ERROR * held.size, MAX_ERROR_GROWTH * (exact.max_error or 0.0))
    angle = max(LARGE_ERROR, MAX_ERROR_GROWTH * math.radians(exact.max_angle_error or 0.0))
    if quality is not None and quality.max_error is not None:
        distance = quality.max_error
    if quality is not None and quality.max_angle_error is not None:
        angle = math.radians(quality.max_angle_error)
    return distance, angle


def _mark_own_tolerances(held: RequiredTargets) -> NDArray[np.bool_] | None:
    """Return a mask of the targets with tolerances of their own, given by the task; None if there are none."""
    limits = held.limits
    if limits is None:
        return None
    own = np.asarray(((limits > 0.0) & np.isfinite(limits)).any(axis=1))
    return own if own.any() else None


def _find_nearest_miss(missed: list[_RoundedDesign]) -> AnyNearestMiss | None:
    """Return the linkage on the grid that fails the fewest checks, and among equals the one with the smallest error."""
    known = [rounded.design for rounded in missed if rounded.design is not None]
    if not known:
        return None
    # A linkage that fails fewer checks is closer, even if its error is larger.
    best = select_best(
        known, lambda design: len(design.verification.failures), lambda design: design.metrics.rms_residual
    )
    gaps = [Gap.from_check(check) for check in best.verification.failures]
    return AnyNearestMiss(design=best, gaps=gaps, reachable=Reachable())
