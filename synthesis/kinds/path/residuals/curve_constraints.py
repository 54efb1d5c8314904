"""Least squares of a traced curve under a problem's constraints: each point is fitted at its own crank angle.

A curve's points are fitted like any others (:mod:`synthesis.kinds.path.residuals.points`), unordered and weighted, each
at the nearest place on the curve, so that multipliers enforce the constraints of :mod:`synthesis.fit.constraints` as
they do in fits of points. The start is the fit without constraints.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from synthesis.fit.chart import FOURBAR, compute_lengths
from synthesis.fit.constraints import (
    BOXES,
    CHANGE_POINT,
    COSINE,
    EQUATION_COUNT,
    FAMILY_INDEX,
    FULL_TURN_INDEX,
    GIVEN_PIVOTS,
    LIMIT_COUNT,
    LINKS,
    MOVING,
    POINT_BOX,
    RATIO,
    SIGN_INDEX,
    compute_margins,
)
from synthesis.fit.fourbar_workspace import NO_BODY, compute_workspace_margins
from synthesis.fit.workspace_margins import ROW_SIZE, count_margins
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.residuals.constrained_fit import fit_constrained
from synthesis.kinds.path.residuals.constraint_vector import (
    LIMIT_MARGIN,
    MIN_GRASHOF,
    ORDER_INDEX,
    PATH_SETTING_SIZE,
    TIMING_INDEX,
    count_setting_margins,
    pack_setting,
)
from synthesis.kinds.path.residuals.curve_descent import Descent
from synthesis.kinds.path.residuals.points import compute_path_rows
from synthesis.numerics.levenberg import descend_each
from synthesis.numerics.portions import run_in_portions
from synthesis.numerics.status import Status

LENGTH_TOLERANCE = 1e-9
"""Maximum relative excess of a length that counts as rounding; cognates repeat a curve to a few rounding errors."""

SOFT_WEIGHT, SOFT_TOLERANCE = 10.0, 1e-4
"""Weight of constraints, in the target's unit, in descents from the shape library, and the tolerance of these
descents."""

PORTION_SIZE = 4
"""Number of such descents that a thread takes at a time."""


def pack_curve_setting(problem: PathProblem, centre: complex, size: float) -> Real:
    """Return a problem's constraints on curves, in the target's unit about its centre, for any family and assembly.

    The margins that keep fits of points away from very short links and change points are left out: they are no
    constraints.
    """
    setting = pack_setting(problem, centre, size, sign=1.0, family=FOURBAR)
    lengths = problem.constraints.link_length
    shortest = 0.0 if lengths is None else lengths.min / size * (1.0 + LIMIT_MARGIN)
    setting[LINKS] = shortest, problem.longest_link / size * (1.0 - LIMIT_MARGIN)
    # A curve has no timing, and its nearest places follow in order by themselves.
    setting[CHANGE_POINT] = setting[TIMING_INDEX] = setting[ORDER_INDEX] = 0.0
    setting[FULL_TURN_INDEX] = problem.closed or problem.constraints.full_rotation
    return setting


def compute_pivot_limits(problem: PathProblem, centre: complex, size: float) -> Real:
    """Return the minimum and maximum x and y of O2, then of the other fixed pivot, shape (4, 2), in the task's unit.

    A given coordinate has equal bounds.
    """
    setting = pack_setting(problem, centre, size, sign=1.0, family=FOURBAR)
    within = setting[BOXES].reshape(4, 2)
    given = setting[GIVEN_PIVOTS, None]
    return np.where(np.isnan(given), within, given)


def tighten_to_usable(setting: Real, degrees: float, ratio: float) -> Real:
    """Return a copy of the setting with a minimum transmission angle (degrees) and a maximum link ratio."""
    tightened = setting.copy()
    tightened[COSINE] = math.cos(math.radians(degrees))
    tightened[RATIO] = min(tightened[RATIO], ratio)
    return tightened


def is_place_constrained(setting: Real) -> bool:
    """Return whether the constraints depend on the position and size of a linkage, apart from its longest link."""
    boxes = np.concatenate([setting[BOXES], setting[MOVING], setting[POINT_BOX]])
    return bool(np.isfinite(boxes).any() or setting[LINKS][0] > 0.0 or len(setting) > PATH_SETTING_SIZE)


def check_lengths(setting: Real, links: tuple[float, float, float, float]) -> bool:
    """Return whether lengths, in the target's unit, are within their limits."""
    # Both bounds may be off by a rounding, hence twice the tolerance.
    slack = 1.0 + 2.0 * LENGTH_TOLERANCE
    short, long = min(links), max(links)
    (least, most), ratio = setting[LINKS], setting[RATIO]
    return bool(long <= most * slack and short * slack >= least and long <= ratio * short * slack)


class ConstrainedFit(NamedTuple):
    """A fit that satisfies all constraints: unknowns (m,), crank angles (points,), and its weighted sum of squares."""

    x: Real
    theta: Real
    cost: float


def descend_constrained(
    family: int, x: Real, theta: Real, sign: float, points: Complex, weights: Real, setting: Real
) -> ConstrainedFit | None:
    """Find the fit nearest to a given one that satisfies all constraints; return None if the descent fails.

    Parameters
    ----------
    family : int
        A family of fourbars.
    x, theta : float, shapes (m,), (points,)
        The fit to start from, and its crank angles at the points, radians.
    sign : float
        Assembly.
    points, weights : complex and float, shape (points,)
        The points to fit, in the target's unit, and their weights.
    setting : float
        See :func:`pack_curve_setting`.
    """
    demanded = _build_setting(family, sign, setting)
    n, x = len(points), np.array(x)
    state = np.zeros(3 * n + count_setting_margins(demanded))
    # The residuals measure crank angles from the ground line, which x[2] turns.
    state[:n] = theta - x[2]
    status, cost = fit_constrained(x, _build_rows(points, weights), demanded, state)
    if status in (Status.IMPOSSIBLE, Status.INFEASIBLE):
        return None
    return ConstrainedFit(x, state[:n] + x[2], 2.0 * cost)


def descend_softly(
    family: int, x: Real, theta: Real, sign: Real, points: Complex, setting: Real, steps: int
) -> Descent:
    """Descend a few steps from every start, with constraints as weighted residuals.

    Returns the ends of the descents, shapes (n, m), (n, points) and (n,).
    """
    n, limits = len(points), count_setting_margins(setting)
    starts, states = np.array(x), np.zeros((len(x), 3 * n + limits))
    states[:, :n] = theta - starts[:, 2, None]
    multipliers = np.zeros(limits + 1)
    # All multipliers stay 0: the constraints act only through their penalty weight, the last entry.
    multipliers[limits] = SOFT_WEIGHT
    costs, statuses = np.full(len(x), math.inf), np.zeros(len(x), np.int64)
    rows, most = _build_rows(points, np.ones(n)), 2 * n + limits

    def process_portion(some: slice) -> None:
        for k in range(*some.indices(len(starts))):
            one = slice(k, k + 1)
            demanded = _build_setting(family, float(sign[k]), setting)
            descend_each(
                compute_path_rows, starts[one], rows, demanded, multipliers, states[one], most, steps, SOFT_TOLERANCE,
                costs[one], statuses[one],
            )  # fmt: skip

    run_in_portions(process_portion, len(starts), PORTION_SIZE)
    return Descent(starts, states[:, :n] + starts[:, 2, None], costs)


def measure_violation(family: int, x: Real, theta: Real, sign: float, setting: Real) -> float:
    """Return the largest violation of any constraint by a fit, in the units of margins; 0 if it satisfies all.

    The order of points is one of the constraints: its violation is the maximum backward step of the crank, or its
    excess over a full turn.
    """
    worst = float(measure_violations(family, x[None], theta[None], np.array([sign]), setting)[0])
    if setting[ORDER_INDEX] > 0.0 and len(theta) > 1:
        steps = np.diff(theta) * math.copysign(1.0, theta[-1] - theta[0])
        worst = max(worst, -float(steps.min()), abs(float(theta[-1] - theta[0])) - 2.0 * math.pi)
    # Limits were tightened by this margin, so that a smaller violation still satisfies the client's limits.
    return worst if worst > LIMIT_MARGIN else 0.0


@njit(cache=True, nogil=True)
def measure_violations(family: int, x: Real, theta: Real, sign: Real, setting: Real) -> Real:
    """Return the largest constraint violation of each of many linkages, shape (n, m), except for the order of points.

    ``theta``, shape (n, points), contains the crank angles at the points. A linkage that does not close there has no
    violation by its moving pivots. The workspace violation of a linkage that does not close over its range is infinite.
    """
    lengths, slopes, still = np.empty(4), np.empty((4, 4)), np.zeros(x.shape[1])
    values, gradients = np.empty(LIMIT_COUNT), np.empty((LIMIT_COUNT, x.shape[1]))
    own_setting, worst = setting.copy(), np.zeros(len(x))
    own_setting[FAMILY_INDEX] = family
    room = setting[PATH_SETTING_SIZE:]
    roomy = count_margins(room)
    kept, rows = np.empty(roomy), np.empty((roomy, ROW_SIZE))
    for i in range(len(x)):
        own_setting[SIGN_INDEX] = sign[i]
        compute_lengths(family, x[i], lengths, slopes)
        ends = np.array([theta[i, 0] - x[i, 2], theta[i, -1] - x[i, 2]])
        compute_margins(x[i], lengths, slopes, ends, still, own_setting, values, gradients)
        for k in range(LIMIT_COUNT):
            if values[k] < np.inf:
                # The last margins are equations, violated on both sides; the others only where they are negative.
                worst[i] = max(worst[i], abs(values[k]) if k >= LIMIT_COUNT - EQUATION_COUNT else -values[k])
        if roomy > 0:
            turns_through = setting[FULL_TURN_INDEX] > 0.0
            closes = compute_workspace_margins(x[i], lengths, sign[i], ends, turns_through, NO_BODY, room, kept, rows)
            worst[i] = max(worst[i], -kept.min()) if closes else np.inf
    return worst


def check_shapes(family: int, x: Real, setting: Real) -> NDArray[np.bool_]:
    """Return which of many linkages (n, m), of any size and place, satisfy the constraints that depend on shape alone.

    These are the link ratio and, if the crank turns through, the transmission angle.
    """
    shape = np.full(PATH_SETTING_SIZE, math.inf)
    # Infinite limits switch off everything that depends on size and place.
    shape[FAMILY_INDEX], shape[SIGN_INDEX], shape[FULL_TURN_INDEX] = family, 1.0, setting[FULL_TURN_INDEX]
    shape[LINKS] = 0.0, math.inf
    shape[CHANGE_POINT], shape[GIVEN_PIVOTS] = 0.0, math.nan
    shape[RATIO] = setting[RATIO]
    if setting[FULL_TURN_INDEX] > 0.0:
        shape[COSINE] = setting[COSINE]
    return _check_all(family, x, shape)


@njit(cache=True, nogil=True)
def _check_all(family: int, x: Real, setting: Real) -> NDArray[np.bool_]:
    """Return the mask (n,) of linkages whose margins are all non-negative."""
    lengths, slopes = np.empty(4), np.empty((4, 4))
    values, gradients = np.empty(LIMIT_COUNT), np.empty((LIMIT_COUNT, x.shape[1]))
    kept, still = np.empty(len(x), np.bool_), np.zeros(x.shape[1])
    for i in range(len(x)):
        compute_lengths(family, x[i], lengths, slopes)
        compute_margins(x[i], lengths, slopes, np.zeros(2), still, setting, values, gradients)
        kept[i] = values.min() >= 0.0
    return kept


def _build_setting(family: int, sign: float, setting: Real) -> Real:
    """Return the constraints of one family and assembly, with a minimum distance from change points.

    Without this distance constrained fits tend to change points, at which no crank can turn through.
    """
    demanded = setting.copy()
    demanded[FAMILY_INDEX], demanded[SIGN_INDEX], demanded[CHANGE_POINT] = family, sign, MIN_GRASHOF
    return demanded


def _build_rows(points: Complex, weights: Real) -> Real:
    return np.stack([points.real, points.imag, np.zeros(len(points)), np.sqrt(weights)], axis=1)
