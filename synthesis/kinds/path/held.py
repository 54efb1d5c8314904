"""Fits of points brought to where all demands hold, those of a room included."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from synthesis.fit.demands import EQUATIONS
from synthesis.fit.room import AIM
from synthesis.fit.room_margins import margins_of
from synthesis.kinds.path.limits import LIMIT_WEIGHT, SETTING, limits_of
from synthesis.kinds.path.point_rows import path_rows
from synthesis.numerics.augmented_lagrangian import MAX_ROUNDS, MAX_STEPS, VIOLATION_TOLERANCE, hold
from synthesis.numerics.status import Status

Real = NDArray[np.float64]

ROUNDS, STEPS = 8, 80
"""Descents in a room, and steps of each, at most: its margins take thirty times as long as all other demands."""

NEARLY = 0.5 * AIM
"""Violation of a room, in task sizes, that is none: it is aimed at more narrowly than it is checked."""


def held(x: Real, rows: Real, setting: Real, state: Real) -> tuple[Status, float]:
    """Descend in place to a minimum at which all demands of a setting hold; returns the status, and the cost there.

    Parameters
    ----------
    x : float64, shape (unknowns,)
        A fit; changed.
    rows : float64, shape (points, 4)
        Of :func:`synthesis.kinds.path.point_rows.path_rows`.
    setting : float64
        Of :func:`synthesis.kinds.path.limits.setting_of`.
    state : float64, shape (3 points + limits,)
        With the crank angles first; changed.
    """
    limits, roomy = limits_of(setting), int(margins_of(setting[SETTING:]))
    most, ended = 2 * len(rows) + limits, np.empty(1)
    rounds, steps = (ROUNDS, STEPS) if roomy else (MAX_ROUNDS, MAX_STEPS)
    status = Status(
        hold(path_rows, x, rows, setting, state, most, limits, EQUATIONS, LIMIT_WEIGHT, rounds, steps, ended)
    )
    if roomy and status is Status.INFEASIBLE:
        # A least distance has kinks, at which multipliers do not come to rest.
        margins = state[len(state) - limits :]
        room, demands = margins[:roomy], margins[roomy:]
        equations = np.abs(demands[-EQUATIONS:])
        off = max(-float(demands[:-EQUATIONS].min()), float(equations[np.isfinite(equations)].max(initial=0.0)))
        if off <= 10.0 * VIOLATION_TOLERANCE and -float(room.min()) <= NEARLY and math.isfinite(ended[0]):
            status = Status.STEP_LIMIT
    return status, float(ended[0])
