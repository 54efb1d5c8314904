"""Checks of a measured value against a requested limit or a numerical tolerance."""

from __future__ import annotations

from synthesis.model.answer import Check
from synthesis.model.dimension import Dimension

TARGET_TOLERANCE = 1e-9
"""Maximum residual (share of the task's size, or radians) with which a target counts as reached. It is far below any
manufacturing tolerance, and far above the rounding of double precision for a linkage of sensible size."""

CHOICE_TOLERANCE = 1e-8
"""Maximum deviation from a given choice, such as a pivot, a line or a phase. Angles of short links are a digit less
accurate than positions."""

LIMIT_SLACK = 1e-9
"""Relative slack of a requested limit, so that a value exactly at the limit does not fail by rounding."""


REACHES_TARGETS = "reaches_targets"
"""Name of the check of targets that must be met exactly."""


def check_targets_reached(residual: float) -> Check:
    """Check the maximum residual at exact targets, a share of the task's size or radians."""
    return check_error(REACHES_TARGETS, residual, TARGET_TOLERANCE)


def check_error(name: str, error: float, tolerance: float, dimension: Dimension | None = None) -> Check:
    """Check an error that has to vanish within a numerical tolerance."""
    return Check(name=name, passed=error <= tolerance, value=error, limit=tolerance, dimension=dimension)


def check_minimum(
    name: str, value: float, limit: float, dimension: Dimension | None = None, slack: float = LIMIT_SLACK
) -> Check:
    """Check a value against a minimum; ``slack`` is relative."""
    # The slack is relative, because limits range from fractions to thousands. A limit of 0 has no slack.
    return Check(name=name, passed=value >= limit * (1.0 - slack), value=value, limit=limit, dimension=dimension)


def check_maximum(
    name: str, value: float, limit: float, dimension: Dimension | None = None, slack: float = LIMIT_SLACK
) -> Check:
    """Check a value against a maximum; ``slack`` is relative."""
    return Check(name=name, passed=value <= limit * (1.0 + slack), value=value, limit=limit, dimension=dimension)
