"""Least squares of a traced curve under a problem's demands: the fit of points, each at its own crank angle.

A curve's points are fitted like any others (:mod:`synthesis.kinds.path.point_rows`), unordered and weighted, each at
the nearest place on the curve, so that the demands of :mod:`synthesis.fit.demands` steer them by multipliers as they
steer fits of points. The start is the fit without demands.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from synthesis.fit.chart import FOURBAR, natural
from synthesis.fit.demands import (
    BOXES,
    CHANGE_POINT,
    COSINE,
    EQUATIONS,
    FAMILY,
    GIVEN,
    LIMITS,
    LINKS,
    RATIO,
    SIGN,
    WHOLE,
    margins,
)
from synthesis.kinds.path.curve_descent import Descent
from synthesis.kinds.path.limits import LIMIT_MARGIN, LIMIT_WEIGHT, MIN_GRASHOF, ORDERED, TIMED, setting_of
from synthesis.kinds.path.point_rows import path_rows
from synthesis.kinds.path.problem import PathProblem
from synthesis.numerics.augmented_lagrangian import hold
from synthesis.numerics.status import Status

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

LENGTH_TOLERANCE = 1e-9
"""Relative excess of a length that is rounding: cognates repeat a curve to some roundings."""

REGION_MARGIN = 1e-7
"""Regions are aimed at with this margin, a share of the task's size, so that a pivot on their edge is in them."""

USABLE_TRANSMISSION = 25.0
"""Transmission angle, degrees, with which designs are offered beside the nearest where none is demanded: fits tend to
change points, where it vanishes."""


def curve_setting(problem: PathProblem, centre: complex, size: float) -> Real:
    """A problem's demands on curves, in the target's unit about its centre, for any family and assembly.

    What keeps fits of points away from very short links and from change points is left out: it is no demand.
    """
    setting = setting_of(problem, centre, size, sign=1.0, family=FOURBAR)
    lengths = problem.constraints.link_length
    setting[LINKS] = 0.0 if lengths is None else lengths.min / size * (1.0 + LIMIT_MARGIN)
    setting[LINKS + 1] = problem.longest_link / size * (1.0 - LIMIT_MARGIN)
    setting[CHANGE_POINT] = setting[TIMED] = setting[ORDERED] = 0.0
    setting[WHOLE] = problem.closed or problem.constraints.full_rotation
    return setting


def pivot_limits(problem: PathProblem, centre: complex, size: float) -> Real:
    """Least and greatest x and y of O2, then of the other fixed pivot, shape (4, 2), in the task's unit.

    Regions are drawn in by :data:`REGION_MARGIN`; where a coordinate is given both are it.
    """
    setting = setting_of(problem, centre, size, sign=1.0, family=FOURBAR)
    within = setting[BOXES : BOXES + 8].reshape(4, 2)
    margin = np.minimum(REGION_MARGIN, 0.25 * (within[:, 1] - within[:, 0]))
    given = setting[GIVEN : GIVEN + 4, None]
    return np.where(np.isnan(given), within + np.stack([margin, -margin], axis=1), given)


def usable(setting: Real) -> Real | None:
    """The same with a transmission angle that practice asks for; None where one is stated."""
    if math.isfinite(setting[COSINE]):
        return None
    stated = setting.copy()
    stated[COSINE] = math.cos(math.radians(USABLE_TRANSMISSION))
    return stated


def lengths_kept(setting: Real, links: tuple[float, float, float, float]) -> bool:
    """Whether lengths, in the target's unit, are within their limits."""
    slack = 1.0 + 2.0 * LENGTH_TOLERANCE
    short, long = min(links), max(links)
    least, most, ratio = setting[LINKS], setting[LINKS + 1], setting[RATIO]
    return bool(long <= most * slack and short * slack >= least and long <= ratio * short * slack)


def descend_within(
    family: int, free: Descent, sign: float, points: Complex, weights: Real, setting: Real
) -> Descent | None:
    """The fit nearest to a free one that keeps all demands, itself where it does; None where none was reached.

    Parameters
    ----------
    family : int
        A family of fourbars.
    free : Descent
        One fit, shapes (m,), (points,), ().
    sign : float
        Assembly.
    points, weights : complex and float, shape (points,)
        What is fitted, in the target's unit.
    setting : float
        See :func:`curve_setting`.
    """
    demanded = setting.copy()
    demanded[FAMILY], demanded[SIGN] = family, sign
    n, x = len(points), np.array(free.x)
    state = np.zeros(3 * n + LIMITS)
    state[:n] = free.theta - x[2]
    if _kept(x, state[[0, n - 1]], demanded):
        return free
    # Under demands fits run to change points, where the crank would no longer turn through.
    demanded[CHANGE_POINT] = MIN_GRASHOF
    rows = np.stack([points.real, points.imag, np.zeros(n), np.sqrt(weights)], axis=1)
    ended = np.empty(1)
    status = hold(path_rows, x, rows, demanded, state, 2 * n + LIMITS, LIMITS, EQUATIONS, LIMIT_WEIGHT, ended)
    if status in (Status.IMPOSSIBLE, Status.INFEASIBLE):
        return None
    return Descent(x, state[:n] + x[2], 2.0 * ended[0])


def _kept(x: Real, ends: Real, setting: Real) -> bool:
    """Whether all demands hold without a descent."""
    lengths, slopes = np.empty(4), np.empty((4, 4))
    values, gradients = np.empty(LIMITS), np.empty((LIMITS, len(x)))
    natural(int(setting[FAMILY]), x, lengths, slopes)
    margins(x, lengths, slopes, ends, setting, values, gradients)
    return bool(values.min() >= -LIMIT_MARGIN)
