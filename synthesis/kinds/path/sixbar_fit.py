"""Descend from sixbars to a curve on all of their dimensions: with soft constraints first, then with enforced ones.

The rows are those of :mod:`synthesis.kinds.path.sixbar_rows`, or of :mod:`synthesis.kinds.path.inverted_rows`; the
methods are Levenberg and Marquardt's (:mod:`synthesis.numerics.levenberg`) and multipliers
(:mod:`synthesis.numerics.augmented_lagrangian`).
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.fit.demands import BOXES, CHANGE_POINT, COSINE, DEMANDS, FAMILY, RATIO, SIGN, WHOLE
from synthesis.fit.sixbar_curve import INPUT
from synthesis.kinds.path.curve_limits import curve_setting
from synthesis.kinds.path.inverted_rows import inverted_rows
from synthesis.kinds.path.limits import MIN_GRASHOF
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.sixbar_rows import (
    BACK,
    CARRIER,
    HOLDER,
    ROOM,
    SETTING,
    SIDE,
    STEPS,
    margins_of,
    rows_of,
    sixbar_rows,
)
from synthesis.kinds.path.sixbar_shapes import Form
from synthesis.kinds.path.stance_rows import MARGINS, STANCE, sixbar_stance_rows
from synthesis.numerics.augmented_lagrangian import hold
from synthesis.numerics.levenberg import descend_each
from synthesis.numerics.portions import in_portions
from synthesis.numerics.status import Status

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

ROOM_MARGIN = 1e-4
"""Share of the task's size by which a box is shrunk: a joint may leave it between the steps of the crank."""

SOFT_WEIGHT, SOFT_TOLERANCE = 10.0, 1e-4
"""Weight of soft constraints, in the target's unit, and the tolerance of such descents."""

PORTION = 4
"""Number of soft descents that a thread takes at a time."""

ROUNDS, HELD_STEPS = 8, 60
"""Maximum number of descents under enforced constraints, with a multiplier update after each, and of steps of each."""


class Fits(NamedTuple):
    """Sixbars of one form: unknowns (n, 15), signs (n, 2), crank angles (n, points), and half their sums of squares."""

    form: Form
    x: Real
    signs: Real
    theta: Real
    cost: Real

    def chosen(self, rows: NDArray[np.int64]) -> Fits:
        """Return the fits of some rows."""
        return Fits(self.form, self.x[rows], self.signs[rows], self.theta[rows], self.cost[rows])


def sixbar_setting(problem: PathProblem, centre: complex, size: float, degrees: float, ratio: float) -> Real:
    """Pack a problem's constraints on sixbars of any form, in the target's unit about its centre.

    The transmission angle at both dyads must be at least ``degrees``, and the link ratio at most ``ratio``.
    """
    out = np.zeros(SETTING)
    out[:DEMANDS] = curve_setting(problem, centre, size)[:DEMANDS]
    out[WHOLE], out[CHANGE_POINT] = 1.0, MIN_GRASHOF
    out[COSINE] = min(out[COSINE], math.cos(math.radians(degrees)))
    out[RATIO] = min(out[RATIO], ratio)
    out[ROOM : ROOM + 4] = -math.inf, math.inf, -math.inf, math.inf
    # Only the box is constrained in fits; obstacles are checked on the driven sixbar.
    room = None if problem.space is None else problem.space.box_of_joints(ROOM_MARGIN * size)
    if room is not None:
        within = (np.array(room) - np.repeat([centre.real, centre.imag], 2)) / size
        out[ROOM : ROOM + 4] = within
        for pivot in range(2):
            at = slice(BOXES + 4 * pivot, BOXES + 4 * pivot + 4)
            out[at] = np.where(np.arange(4) % 2, np.minimum(out[at], within), np.maximum(out[at], within))
    return out


def descended(
    fits: Fits,
    points: Complex,
    weights: Real,
    setting: Real,
    *,
    steps: int,
    back: int = 0,
    turns: int = 36,
    tolerance: float = SOFT_TOLERANCE,
) -> Fits:
    """Descend a limited number of steps with constraints as penalties, which may remain violated a little.

    Parameters
    ----------
    fits : Fits
    points, weights : complex and float, shape (points,)
        The points to fit, and the weights of the squared distances.
    setting : float
        Constraints from :func:`sixbar_setting`.
    steps : int
        Maximum number of steps.
    back, turns : int
        Number of crank steps at which the curve's distance from the points counts too (0 for none), and number of
        those at which the transmission angle is constrained.
    """
    rows, stated = _posed(fits.form, points, weights, setting, back, turns)
    limits = margins_of(stated)
    x, theta, cost = fits.x.copy(), fits.theta.copy(), np.empty(len(fits.x))
    statuses = np.empty(len(x), np.int64)
    states = np.concatenate([theta, np.zeros((len(x), limits))], axis=1)
    multipliers = np.zeros(limits + 1)
    multipliers[limits] = SOFT_WEIGHT
    kernel = _rows_of(fits.form)

    def work(some: slice) -> None:
        for k in range(*some.indices(len(x))):
            one = stated.copy()
            one[SIGN], one[SIDE] = fits.signs[k]
            row = slice(k, k + 1)
            descend_each(
                kernel, x[row], rows, one, multipliers, states[row], rows_of(len(points), one), steps,
                tolerance, cost[row], statuses[row],
            )  # fmt: skip

    in_portions(work, len(x), PORTION)
    return Fits(fits.form, x, fits.signs, states[:, : len(points)], cost)


def held(
    fits: Fits, points: Complex, weights: Real, setting: Real, *, back: int, turns: int, rounds: int = ROUNDS,
    steps: int = HELD_STEPS, stance: Real | None = None,
) -> Fits:  # fmt: skip
    """Lead fits to satisfy all constraints; an infinite cost marks the fits that fail.

    ``stance`` describes a stance by the points' rows, see :func:`synthesis.kinds.path.stance_fit.stance_spec`.
    """
    rows, stated = _posed(fits.form, points, weights, setting, back, turns)
    kernel, first, more = (_rows_of(fits.form), 0, 0) if stance is None else (sixbar_stance_rows, STANCE, MARGINS)
    limits, most = margins_of(stated) + more, rows_of(len(points), stated) + more
    stated = stated if stance is None else np.concatenate([stance, stated])
    x, cost = fits.x.copy(), np.full(len(fits.x), math.inf)
    states = np.concatenate([fits.theta, np.zeros((len(x), limits))], axis=1)

    def work(some: slice) -> None:
        for k in range(*some.indices(len(x))):
            one, ended = stated.copy(), np.empty(1)
            # The assembly is part of the setting, and differs from fit to fit.
            one[first + SIGN], one[first + SIDE] = fits.signs[k]
            status = hold(
                kernel, x[k], rows, one, states[k], most, limits, 4, HELD_WEIGHT, rounds, steps, ended
            )  # fmt: skip
            # The verification of the driven sixbar decides about small violations.
            if status != Status.IMPOSSIBLE and states[k, len(points) :].min() > -HELD_WITHIN:
                cost[k] = ended[0]

    in_portions(work, len(x), 1)
    return Fits(fits.form, x, fits.signs, states[:, : len(points)], cost)


HELD_WEIGHT, HELD_WITHIN = 100.0, 1e-3
"""Weight of enforced constraints in the first descent, and their maximum violation at the end, in their own units."""


def _rows_of(form: Form) -> Any:
    """Return the residual kernel of a form."""
    return inverted_rows if form.holder == INPUT else sixbar_rows


def _posed(form: Form, points: Complex, weights: Real, setting: Real, back: int, turns: int) -> tuple[Real, Real]:
    """Return the rows of the points, and the setting of a form."""
    stated = setting.copy()
    stated[FAMILY], stated[CARRIER], stated[HOLDER] = form
    stated[STEPS] = max(back, turns)
    # Both directions count equally: the steps of the curve share the total weight of the points.
    stated[BACK] = math.sqrt(float(weights.sum()) / back) if back else 0.0
    return np.stack([points.real, points.imag, np.zeros(len(points)), np.sqrt(weights)], axis=1), stated
