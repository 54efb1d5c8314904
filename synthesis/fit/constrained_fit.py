"""Fits brought to where all demands hold, those of a room included."""

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
    roomy : int
        How many of the limits, the first, are margins of a room.
    """
    ended = np.empty(1)
    status = Status(
        descend_constrained(rows, x, points, setting, state, most, limits, equations, weight, rounds, steps, ended)
    )
    if in_workspace and status is Status.INFEASIBLE:
        # A least distance has kinks, at which multipliers do not come to rest.
        margins = state[len(state) - limits :]
        room, demands = margins[:in_workspace], margins[in_workspace:]
        zero = np.abs(demands[-equations:])
        off = max(-float(demands[:-equations].min()), float(zero[np.isfinite(zero)].max(initial=0.0)))
        if off <= 10.0 * VIOLATION_TOLERANCE and -float(room.min()) <= WORKSPACE_TOLERANCE and math.isfinite(ended[0]):
            status = Status.STEP_LIMIT
    return status, float(ended[0])
