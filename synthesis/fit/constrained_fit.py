"""Fits with all constraints enforced, including those of a workspace."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from kinematics.arrays import Real
from synthesis.fit.workspace import AIM_SHARE
from synthesis.numerics.augmented_lagrangian import VIOLATION_TOLERANCE, descend_constrained
from synthesis.numerics.status import Status

WORKSPACE_TOLERANCE = 0.5 * AIM_SHARE
"""Violation of a workspace, in task sizes, that counts as none, because fits aim beyond the checked limits."""


def fit_constrained(
    rows: Any,
    x: Real,
    points: Real,
    setting: Real,
    state: Real,
    *,
    most: int,
    in_workspace: int,
    limits: int,
    equations: int,
    weight: float,
    rounds: int,
    steps: int,
) -> tuple[Status, float]:
    """Descend in place to a minimum at which all constraints hold; return the status and the cost there.

    Parameters
    ----------
    rows, x, points, setting, state, most, limits, equations, weight, rounds, steps
        As for :func:`synthesis.numerics.augmented_lagrangian.descend_constrained`.
    in_workspace : int
        Number of the limits, the first ones, that are margins of a workspace.
    """
    ended = np.empty(1)
    status = Status(
        descend_constrained(rows, x, points, setting, state, most, limits, equations, weight, rounds, steps, ended)
    )
    if in_workspace and status is Status.INFEASIBLE:
        # A minimum distance has kinks, at which multipliers do not converge. Accept a point that is close enough.
        margins = state[len(state) - limits :]
        room, demands = margins[:in_workspace], margins[in_workspace:]
        # Equations that are not requested are infinite and do not count.
        zero = np.abs(demands[-equations:])
        off = max(-float(demands[:-equations].min()), float(zero[np.isfinite(zero)].max(initial=0.0)))
        # Ten times the usual tolerance: the later verification decides, and this only keeps promising fits.
        if off <= 10.0 * VIOLATION_TOLERANCE and -float(room.min()) <= WORKSPACE_TOLERANCE and math.isfinite(ended[0]):
            status = Status.STEP_LIMIT
    return status, float(ended[0])
