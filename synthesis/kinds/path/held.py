"""Fits of points brought to where all demands hold, those of a room included."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from synthesis.fit import held as fit
from synthesis.fit.demands import EQUATIONS
from synthesis.fit.room_margins import margins_of
from synthesis.kinds.path.limits import LIMIT_WEIGHT, SETTING, limits_of
from synthesis.kinds.path.point_rows import path_rows
from synthesis.numerics.augmented_lagrangian import MAX_ROUNDS, MAX_STEPS
from synthesis.numerics.status import Status

Real = NDArray[np.float64]

ROUNDS, STEPS = 8, 80
"""Descents in a room, and steps of each, at most: its margins take thirty times as long as all other demands."""


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
    rounds, steps = (ROUNDS, STEPS) if roomy else (MAX_ROUNDS, MAX_STEPS)
    most = 2 * len(rows) + limits
    return fit.held(
        path_rows, x, rows, setting, state,
        most=most, roomy=roomy, limits=limits, equations=EQUATIONS, weight=LIMIT_WEIGHT, rounds=rounds,
        steps=steps,
    )  # fmt: skip
