"""Fits brought to where all demands hold, those of a room included."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from synthesis.fit.room import AIM
from synthesis.numerics.augmented_lagrangian import VIOLATION_TOLERANCE, hold
from synthesis.numerics.status import Status

Real = NDArray[np.float64]

NEARLY = 0.5 * AIM
"""Violation of a workspace, in task sizes, that counts as none, because fits aim beyond the checked limits."""


def held(
    rows: Any,
    x: Real,
    points: Real,
    setting: Real,
    state: Real,
    *,
    most: int,
    roomy: int,
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
        As for :func:`synthesis.numerics.augmented_lagrangian.hold`.
    roomy : int
        How many of the limits, the first, are margins of a room.
    """
    ended = np.empty(1)
    status = Status(hold(rows, x, points, setting, state, most, limits, equations, weight, rounds, steps, ended))
    if roomy and status is Status.INFEASIBLE:
        # A least distance has kinks, at which multipliers do not come to rest.
        margins = state[len(state) - limits :]
        room, demands = margins[:roomy], margins[roomy:]
        zero = np.abs(demands[-equations:])
        off = max(-float(demands[:-equations].min()), float(zero[np.isfinite(zero)].max(initial=0.0)))
        if off <= 10.0 * VIOLATION_TOLERANCE and -float(room.min()) <= NEARLY and math.isfinite(ended[0]):
            status = Status.STEP_LIMIT
    return status, float(ended[0])
