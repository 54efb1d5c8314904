"""Checks of one measured value, against a client's limit or against a numerical tolerance."""

from __future__ import annotations

from synthesis.model.answer import Check
from synthesis.model.dimension import Dimension

TARGET_TOLERANCE = 1e-9
"""Maximum residual (share of the task's size; radians) at which a target counts as reached: far below any
manufacturing tolerance, far above the rounding of double precision for a linkage of sensible size."""

CHOICE_TOLERANCE = 1e-8
"""Maximum deviation from a side that the client fixed; angles of short links lose a digit compared with positions."""

LIMIT_SLACK = 1e-9
"""Relative slack when a measured value is compared with a client's limit, so that a value that is exactly at the limit
does not fail by rounding."""


REACHES_TARGETS = "reaches_targets"
"""Name of the check of targets that must be met exactly."""


def check_targets_reached(residual: float) -> Check:
    """Check the largest residual at exact targets: a share of the task's size, or radians."""
    return check_error(REACHES_TARGETS, residual, TARGET_TOLERANCE)


def check_error(name: str, error: float, tolerance: float, dimension: Dimension | None = None) -> Check:
    """Check an error that has to vanish within a numerical tolerance."""
    return Check(name=name, passed=error <= tolerance, value=error, limit=tolerance, dimension=dimension)


def check_minimum(
    name: str, value: float, limit: float, dimension: Dimension | None = None, slack: float = LIMIT_SLACK
) -> Check:
    """Check a value against a minimum; ``slack`` is relative."""
    # Relative, because limits range from fractions to thousands; the slack of a limit 0 is 0.
    return Check(name=name, passed=value >= limit * (1.0 - slack), value=value, limit=limit, dimension=dimension)


def check_maximum(
    name: str, value: float, limit: float, dimension: Dimension | None = None, slack: float = LIMIT_SLACK
) -> Check:
    """Check a value against a maximum; ``slack`` is relative."""
    return Check(name=name, passed=value <= limit * (1.0 + slack), value=value, limit=limit, dimension=dimension)
