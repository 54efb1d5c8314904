"""Checks of the requested constraints on linkages, common to all kinds of problems.

A constraint is either checked here on the measured properties, or refused in advance because no linkage of the kind can
satisfy it; each kind lists such contradictions (``find_contradictions``).
"""

from __future__ import annotations

from collections.abc import Sequence

from synthesis.model.answer import Check
from synthesis.model.dimension import ANGLE, LENGTH
from synthesis.model.linkage.problem import Constraints, Region
from synthesis.verification.checks import check_maximum, check_minimum
from synthesis.verification.measures import Measures


def check_constraints(
    constraints: Constraints,
    measures: Measures,
    fixed_pivots: Sequence[complex],
    moving_pivots: Sequence[complex],
) -> list[Check]:
    """Check each constraint that is given or required by default.

    Parameters
    ----------
    constraints : Constraints
        The requested constraints.
    measures : Measures
        Measured properties of the driven linkage.
    fixed_pivots, moving_pivots : sequence of complex
        Positions of the pivots at the first target, in length units.
    """
    checks = []
    if constraints.same_branch:
        checks.append(Check(name="same_branch", passed=measures.same_branch))
    if constraints.in_order:
        checks.append(Check(name="visits_in_order", passed=measures.visits_in_order))
    if constraints.min_transmission_angle is not None:
        checks.append(
            check_minimum(
                "transmission_angle", measures.min_transmission_angle, constraints.min_transmission_angle, ANGLE
            )
        )
    if constraints.grashof != "any":
        # The measured class of a non-Grashof linkage is named rocker_rocker.
        wanted = "rocker_rocker" if constraints.grashof == "non_grashof" else constraints.grashof
        checks.append(Check(name="grashof", passed=measures.grashof == wanted))
    if constraints.full_rotation:
        checks.append(Check(name="full_rotation", passed=measures.full_rotation))
    if constraints.link_length is not None:
        # A minimum of 0 is the default and constrains nothing.
        if constraints.link_length.min > 0.0:
            checks.append(check_minimum("shortest_link", min(measures.lengths), constraints.link_length.min, LENGTH))
        if constraints.link_length.max is not None:
            checks.append(check_maximum("longest_link", max(measures.lengths), constraints.link_length.max, LENGTH))
    if constraints.max_link_ratio is not None:
        checks.append(check_maximum("link_ratio", measures.link_ratio, constraints.max_link_ratio))
    # No slack is needed here, because the distance is exactly 0 for points that are on the border to rounding.
    for name, region, pivots in (
        ("fixed_pivot_region", constraints.fixed_pivot_region, fixed_pivots),
        ("moving_pivot_region", constraints.moving_pivot_region, moving_pivots),
    ):
        if region is not None:
            checks.append(check_zone(name, region, pivots))
    return checks


def check_zone(name: str, region: Region, pivots: Sequence[complex]) -> Check:
    """Check that pivots lie in a zone; the value is the maximum distance of a pivot from it, in length units."""
    outside = max(map(region.compute_distance, pivots))
    return Check(name=name, passed=outside == 0.0, value=outside, limit=0.0, dimension=LENGTH)
