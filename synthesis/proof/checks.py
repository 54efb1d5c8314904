"""Checks of one measured value: against what a client states, and against what rounding leaves."""

from __future__ import annotations

from synthesis.model.answer import Check
from synthesis.model.dimension import Dimension

TARGET_REACHED = 1e-9
"""Largest residual (share of the task's size; radians) with which a target counts as reached: far below any
manufacturing tolerance, far above the rounding of double precision for a linkage of sensible size."""

CHOICE_KEPT = 1e-8
"""Largest deviation from what the client fixed of a side; angles of short links lose a digit against positions."""

LIMIT_SLACK = 1e-9
"""Relative slack when a measured value is compared with a client's limit, so that a value that is exactly at the limit
does not fail by rounding."""


REACHES_TARGETS = "reaches_targets"
"""The check of the targets that are met exactly."""


def reaches_targets(residual: float) -> Check:
    """The check of the largest residual at targets that are met exactly: share of the task's size, or radians."""
    return tolerated(REACHES_TARGETS, residual, TARGET_REACHED)


def tolerated(name: str, error: float, tolerance: float, dimension: Dimension | None = None) -> Check:
    """A check of an error that has to vanish, but for a tolerance of the analysis itself."""
    return Check(name=name, passed=error <= tolerance, value=error, limit=tolerance, dimension=dimension)


def at_least(
    name: str, value: float, limit: float, dimension: Dimension | None = None, slack: float = LIMIT_SLACK
) -> Check:
    """A check of a value against a lower limit; ``slack`` is relative."""
    return Check(name=name, passed=value >= limit * (1.0 - slack), value=value, limit=limit, dimension=dimension)


def at_most(
    name: str, value: float, limit: float, dimension: Dimension | None = None, slack: float = LIMIT_SLACK
) -> Check:
    """A check of a value against an upper limit; ``slack`` is relative."""
    return Check(name=name, passed=value <= limit * (1.0 + slack), value=value, limit=limit, dimension=dimension)
