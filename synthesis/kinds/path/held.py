"""Lead fits of points to satisfy all constraints, those of a workspace included."""

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
"""Maximum number of descents in a workspace, and of steps of each: its margins take thirty times as long as all other
constraints."""


def held(x: Real, rows: Real, setting: Real, state: Real) -> tuple[Status, float]:
    """Descend in place to a minimum that satisfies all constraints of a setting; return the status, and the cost there.

    Parameters
    ----------
    x : float64, shape (unknowns,)
        A fit; changed in place.
    rows : float64, shape (points, 4)
        Points as for :func:`synthesis.kinds.path.point_rows.path_rows`.
    setting : float64
        Constraints from :func:`synthesis.kinds.path.limits.setting_of`.
    state : float64, shape (3 points + limits,)
        Crank angles first; changed in place.
    """
    limits, roomy = limits_of(setting), int(margins_of(setting[SETTING:]))
    rounds, steps = (ROUNDS, STEPS) if roomy else (MAX_ROUNDS, MAX_STEPS)
    most = 2 * len(rows) + limits
    return fit.held(
        path_rows, x, rows, setting, state,
        most=most, roomy=roomy, limits=limits, equations=EQUATIONS, weight=LIMIT_WEIGHT, rounds=rounds,
        steps=steps,
    )  # fmt: skip
