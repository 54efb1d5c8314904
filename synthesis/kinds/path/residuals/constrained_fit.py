"""Fits to points under all constraints, including those of a workspace."""

from __future__ import annotations

from kinematics.arrays import Real
from synthesis.fit import constrained_fit as fit
from synthesis.fit.constraints import EQUATION_COUNT
from synthesis.fit.workspace_margins import count_margins
from synthesis.kinds.path.residuals.constraint_vector import LIMIT_WEIGHT, PATH_SETTING_SIZE, count_setting_margins
from synthesis.kinds.path.residuals.points import compute_path_rows
from synthesis.numerics.augmented_lagrangian import MAX_ROUNDS, MAX_STEPS
from synthesis.numerics.status import Status

MAX_WORKSPACE_ROUNDS, MAX_WORKSPACE_STEPS = 8, 80
"""Maximum number of descents in a workspace, and of steps of each; its margins take thirty times as long as all other
constraints."""


def fit_constrained(x: Real, rows: Real, setting: Real, state: Real) -> tuple[Status, float]:
    """Descend in place to a minimum that satisfies all constraints of a setting; return the status, and the cost there.

    Parameters
    ----------
    x : float64, shape (unknowns,)
        A fit; changed in place.
    rows : float64, shape (points, 4)
        Points as for :func:`synthesis.kinds.path.residuals.points.compute_path_rows`.
    setting : float64
        Constraints from :func:`synthesis.kinds.path.residuals.constraint_vector.pack_setting`.
    state : float64, shape (3 points + limits,)
        Crank angles first; changed in place.
    """
    limits, roomy = count_setting_margins(setting), int(count_margins(setting[PATH_SETTING_SIZE:]))
    counts = fit.RowCounts(2 * len(rows) + limits, limits, EQUATION_COUNT, roomy)
    rounds, steps = (MAX_WORKSPACE_ROUNDS, MAX_WORKSPACE_STEPS) if roomy else (MAX_ROUNDS, MAX_STEPS)
    schedule = fit.Schedule(LIMIT_WEIGHT, rounds, steps)
    return fit.fit_constrained(compute_path_rows, x, rows, setting, state, counts, schedule)
