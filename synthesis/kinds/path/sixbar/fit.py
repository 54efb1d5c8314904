"""Fits of all dimensions of sixbars to a curve: first with soft constraints, then with enforced ones.

The rows are those of :mod:`synthesis.kinds.path.residuals.sixbar`, or of
:mod:`synthesis.kinds.path.residuals.stephenson_2`; the methods are Levenberg and Marquardt's
(:mod:`synthesis.numerics.levenberg`) and multipliers (:mod:`synthesis.numerics.augmented_lagrangian`).
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from synthesis.fit.constraints import (
    CHANGE_POINT,
    COSINE,
    FAMILY_INDEX,
    FULL_TURN_INDEX,
    INPUT_BOX,
    OUTPUT_BOX,
    RATIO,
    SETTING_SIZE,
    SIGN_INDEX,
)
from synthesis.fit.sixbar_curve import INPUT
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.residuals.constraint_vector import MIN_GRASHOF
from synthesis.kinds.path.residuals.curve_constraints import pack_curve_setting
from synthesis.kinds.path.residuals.sixbar import (
    BACK,
    CARRIER,
    HOLDER,
    ROOM,
    SIDE,
    SIXBAR_SETTING_SIZE,
    STEPS,
    compute_sixbar_rows,
    count_sixbar_margins,
    count_sixbar_rows,
)
from synthesis.kinds.path.residuals.stance import MARGIN_COUNT, STANCE_SIZE, compute_sixbar_stance_rows
from synthesis.kinds.path.residuals.stephenson_2 import compute_inverted_rows
from synthesis.kinds.path.sixbar.shape_matching import Form
from synthesis.numerics.augmented_lagrangian import descend_constrained
from synthesis.numerics.levenberg import descend_each
from synthesis.numerics.portions import run_in_portions
from synthesis.numerics.status import Status

WORKSPACE_MARGIN = 1e-4
"""Share of the task's size by which a box is shrunk: a joint may leave it between the steps of the crank."""

SOFT_WEIGHT, SOFT_TOLERANCE = 10.0, 1e-4
"""Weight of soft constraints, in the target's unit, and the tolerance of such descents."""

PORTION_SIZE = 4
"""Number of soft descents that a thread takes at a time."""

MAX_ROUNDS, MAX_CONSTRAINED_STEPS = 8, 60
"""Maximum number of descents under enforced constraints, with a multiplier update after each, and of steps of each."""


class CrankSteps(NamedTuple):
    """Numbers of equal crank steps.

    The first is that of steps at which the curve's distance from the points counts (0 for none), the second that of
    steps at which the transmission angle is constrained.
    """

    back: int
    margins: int


DEFAULT_CRANK_STEPS = CrankSteps(0, 36)


class SixbarFits(NamedTuple):
    """Sixbars of one form: unknowns (n, 15), signs (n, 2), crank angles (n, points), and half their sums of squares."""

    form: Form
    x: Real
    signs: Real
    theta: Real
    cost: Real

    def select_rows(self, rows: NDArray[np.int64]) -> SixbarFits:
        """Return the fits of some rows."""
        return SixbarFits(self.form, self.x[rows], self.signs[rows], self.theta[rows], self.cost[rows])


def pack_sixbar_setting(problem: PathProblem, centre: complex, size: float, degrees: float, ratio: float) -> Real:
    """Pack a problem's constraints on sixbars of any form, in the target's unit about its centre.

    The transmission angle at both dyads must be at least ``degrees``, and the link ratio at most ``ratio``.
    """
    out = np.zeros(SIXBAR_SETTING_SIZE)
    out[:SETTING_SIZE] = pack_curve_setting(problem, centre, size)[:SETTING_SIZE]
    out[FULL_TURN_INDEX], out[CHANGE_POINT] = 1.0, MIN_GRASHOF
    out[COSINE] = min(out[COSINE], math.cos(math.radians(degrees)))
    out[RATIO] = min(out[RATIO], ratio)
    out[ROOM] = -math.inf, math.inf, -math.inf, math.inf
    # Only the box is constrained in fits; obstacles are checked on the driven sixbar.
    room = None if problem.space is None else problem.space.shrink_box_for_joints(WORKSPACE_MARGIN * size)
    if room is not None:
        within = (np.array(room) - np.repeat([centre.real, centre.imag], 2)) / size
        out[ROOM] = within
        for at in (INPUT_BOX, OUTPUT_BOX):
            out[at] = np.where(np.arange(4) % 2, np.minimum(out[at], within), np.maximum(out[at], within))
    return out


def descend_softly(
    fits: SixbarFits,
    points: Complex,
    weights: Real,
    setting: Real,
    *,
    steps: int,
    crank_steps: CrankSteps = DEFAULT_CRANK_STEPS,
    tolerance: float = SOFT_TOLERANCE,
) -> SixbarFits:
    """Descend a limited number of steps with constraints as penalties, which may remain violated a little.

    Parameters
    ----------
    fits : SixbarFits
    points, weights : complex and float, shape (points,)
        The points to fit, and the weights of the squared distances.
    setting : float
        Constraints from :func:`pack_sixbar_setting`.
    steps : int
        Maximum number of steps.
    crank_steps : CrankSteps
        Crank steps at which the curve is constrained.
    """
    rows, form_setting = _build_rows(fits.form, points, weights, setting, crank_steps)
    limits = count_sixbar_margins(form_setting)
    x, theta, cost = fits.x.copy(), fits.theta.copy(), np.empty(len(fits.x))
    statuses = np.empty(len(x), np.int64)
    states = np.concatenate([theta, np.zeros((len(x), limits))], axis=1)
    multipliers = np.zeros(limits + 1)
    multipliers[limits] = SOFT_WEIGHT
    kernel = _select_kernel(fits.form)

    def process_portion(some: slice) -> None:
        for k in range(*some.indices(len(x))):
            one = form_setting.copy()
            one[SIGN_INDEX], one[SIDE] = fits.signs[k]
            row = slice(k, k + 1)
            descend_each(
                kernel, x[row], rows, one, multipliers, states[row], count_sixbar_rows(len(points), one), steps,
                tolerance, cost[row], statuses[row],
            )  # fmt: skip

    run_in_portions(process_portion, len(x), PORTION_SIZE)
    return SixbarFits(fits.form, x, fits.signs, states[:, : len(points)], cost)


def fit_constrained(
    fits: SixbarFits,
    points: Complex,
    weights: Real,
    setting: Real,
    crank_steps: CrankSteps,
    *,
    rounds: int = MAX_ROUNDS,
    steps: int = MAX_CONSTRAINED_STEPS,
    stance: Real | None = None,
) -> SixbarFits:
    """Refit sixbars under all constraints; an infinite cost marks the fits that fail.

    ``stance`` describes a stance by the points' rows, see :func:`synthesis.kinds.path.curve.stance_fit.pack_stance`.
    """
    rows, form_setting = _build_rows(fits.form, points, weights, setting, crank_steps)
    kernel, first, more = (
        (_select_kernel(fits.form), 0, 0) if stance is None else (compute_sixbar_stance_rows, STANCE_SIZE, MARGIN_COUNT)
    )
    limits, most = count_sixbar_margins(form_setting) + more, count_sixbar_rows(len(points), form_setting) + more
    form_setting = form_setting if stance is None else np.concatenate([stance, form_setting])
    x, cost = fits.x.copy(), np.full(len(fits.x), math.inf)
    states = np.concatenate([fits.theta, np.zeros((len(x), limits))], axis=1)

    def process_portion(some: slice) -> None:
        for k in range(*some.indices(len(x))):
            one, ended = form_setting.copy(), np.empty(1)
            # The assembly is part of the setting, and differs from fit to fit.
            one[first + SIGN_INDEX], one[first + SIDE] = fits.signs[k]
            status = descend_constrained(
                kernel, x[k], rows, one, states[k], most, limits, 4, INITIAL_WEIGHT, rounds, steps, ended
            )  # fmt: skip
            # The verification of the driven sixbar decides about small violations.
            if status != Status.IMPOSSIBLE and states[k, len(points) :].min() > -MAX_VIOLATION:
                cost[k] = ended[0]

    run_in_portions(process_portion, len(x), 1)
    return SixbarFits(fits.form, x, fits.signs, states[:, : len(points)], cost)


INITIAL_WEIGHT, MAX_VIOLATION = 100.0, 1e-3
"""Weight of enforced constraints in the first descent, and their maximum violation at the end, in their own units."""


def _select_kernel(form: Form) -> Any:
    """Return the residual kernel of a form."""
    return compute_inverted_rows if form.holder == INPUT else compute_sixbar_rows


def _build_rows(
    form: Form, points: Complex, weights: Real, setting: Real, crank_steps: CrankSteps
) -> tuple[Real, Real]:
    """Return the rows of the points, and the setting of a form."""
    form_setting = setting.copy()
    form_setting[FAMILY_INDEX], form_setting[CARRIER], form_setting[HOLDER] = form
    back = crank_steps.back
    form_setting[STEPS] = max(back, crank_steps.margins)
    # Both directions count equally: the steps of the curve share the total weight of the points.
    form_setting[BACK] = math.sqrt(float(weights.sum()) / back) if back else 0.0
    return np.stack([points.real, points.imag, np.zeros(len(points)), np.sqrt(weights)], axis=1), form_setting
