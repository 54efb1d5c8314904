"""Fits with all constraints enforced, including those of a workspace."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Real
from synthesis.fit.workspace import AIM_SHARE
from synthesis.numerics.augmented_lagrangian import VIOLATION_TOLERANCE, descend_constrained
from synthesis.numerics.levenberg import Rows
from synthesis.numerics.status import Status

WORKSPACE_TOLERANCE = 0.5 * AIM_SHARE
"""Violation of a workspace, in task sizes, that is tolerated, because fits aim beyond the checked limits."""


class RowCounts(NamedTuple):
    """Numbers of rows in the residuals of a fit.

    Attributes
    ----------
    most : int
        Maximum number of all rows.
    limits, equations : int
        Number of limits, and of equations among them, which come last.
    in_workspace : int
        Number of limits that are margins of a workspace, which come first.
    """

    most: int
    limits: int
    equations: int
    in_workspace: int


class Schedule(NamedTuple):
    """Initial weight of the limits, and maximum number of descents and of steps of each."""

    weight: float
    rounds: int
    steps: int


def fit_constrained(
    rows: Rows,
    x: Real,
    points: Real,
    setting: Real,
    state: Real,
    counts: RowCounts,
    schedule: Schedule,
) -> tuple[Status, float]:
    """Descend in place to a minimum at which all constraints hold; return the status and the cost there.

    Parameters
    ----------
    rows, x, points, setting, state
        As for :func:`synthesis.numerics.augmented_lagrangian.descend_constrained`.
    counts : RowCounts
        Numbers of rows.
    schedule : Schedule
        Effort of the descents.
    """
    ended = np.empty(1)
    status = Status(
        descend_constrained(
            rows, x, points, setting, state, counts.most, counts.limits, counts.equations, *schedule, ended
        )
    )
    if counts.in_workspace and status is Status.INFEASIBLE:
        # A minimum distance has kinks, at which multipliers do not converge. Accept a point that is close enough.
        margins = state[len(state) - counts.limits :]
        room, demands = margins[: counts.in_workspace], margins[counts.in_workspace :]
        # Equations that are not requested are infinite and do not count.
        zero = np.abs(demands[-counts.equations :])
        off = max(-float(demands[: -counts.equations].min()), float(zero[np.isfinite(zero)].max(initial=0.0)))
        # Ten times the usual tolerance: the later verification decides, and this only keeps promising fits.
        if off <= 10.0 * VIOLATION_TOLERANCE and -float(room.min()) <= WORKSPACE_TOLERANCE and math.isfinite(ended[0]):
            status = Status.STEP_LIMIT
    return status, float(ended[0])
