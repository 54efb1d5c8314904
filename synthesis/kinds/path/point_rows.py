"""Residuals of a fourbar that guides a point past points, with prescribed and with free timing.

With prescribed timing each point has its crank angle, and the residuals are the coordinates of P − z.

With free timing the crank angles are eliminated: for each linkage they are put where P is nearest to the points, none
before the one before it. That is done by Newton's method for each and by pooling those that come out of order (a
quadratic programme whose matrix is diagonal). Where angles are at their best the derivative of the distance by them
vanishes, hence the residuals move as if they stood still, less what lies along the curve (variable projection; Golub &
Pereyra 1973, doi:10.1137/0710036, in Kaufman's form). Points that share an angle are projected together.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import njit, types
from numpy.typing import NDArray

from synthesis.kinds.path.assignment import pool
from synthesis.kinds.path.coupler_curve import (
    LENGTHS,
    PHASE,
    lengths_of,
    point_and_slopes,
    point_at,
)
from synthesis.kinds.path.limits import (
    ABSOLUTE,
    LIMITS,
    ORDERED,
    PHASED,
    SHORTEST,
    SIGN,
    TIMED,
    limit_rows,
    renew,
)
from synthesis.numerics.levenberg import ROWS, descend

Real = NDArray[np.float64]

NEWTON_STEPS = 4
"""Steps of the eliminated angles at each linkage; the last linkage's are the start."""

LONGEST_TURN = 0.2
"""Longest such step, radians."""

HELD = 1e-11
"""Violation of a limit (task sizes; shares of a length) that is rounding."""

ROUNDS = 20
"""Descents in which limits are brought to hold, at most."""

STEPS, TOLERANCE = 300, 1e-14
"""Steps of each at most, and the relative decrease at which it ends."""

SETTLED = 1e-7
"""Radians; where a step of Newton's is shorter, the next would be shorter than rounding."""

STILL = 1e-9
"""Speed of P below which its path has no direction."""


@njit(cache=True, nogil=True)
def _project(jacobian: Real, first: int, last: int, direction: Real) -> None:
    """Take out of some rows what lies along a direction."""
    square = 0.0
    for k in range(last - first):
        square += direction[k] * direction[k]
    if not square > 1e-24:
        return
    for i in range(9):
        along = 0.0
        for k in range(first, last):
            along += jacobian[k, i] * direction[k - first]
        along /= square
        for k in range(first, last):
            jacobian[k, i] -= along * direction[k - first]


@njit(cache=True, nogil=True)
def settle(x: Real, lengths: Real, setting: Real, points: Real, angles: Real, blocks: NDArray[np.int64]) -> bool:
    """Bring crank angles to where P is nearest to the points, in order, from where they are; False beyond a toggle.

    The direction of order is that of the angles as they come: from the first to the last.
    """
    n, sign = len(points), setting[SIGN]
    way = 1.0 if angles[n - 1] >= angles[0] else -1.0
    values, weights = np.empty(n), np.empty(n)
    for _ in range(NEWTON_STEPS):
        for k in range(n):
            good, px, py, tx, ty = point_at(x, lengths, sign, angles[k])
            if not good:
                return False
            square = tx * tx + ty * ty
            # The second derivative of half the squared distance, its part from the curvature by a difference.
            good, _, _, sx, sy = point_at(x, lengths, sign, angles[k] + 1e-5)
            gx, gy = px - points[k, 0], py - points[k, 1]
            curved = square
            if good:
                curved += ((sx - tx) * gx + (sy - ty) * gy) * 1e5
            curved = max(curved, 0.25 * square, 1e-12)
            step = -(tx * gx + ty * gy) / curved
            values[k] = way * (angles[k] + min(max(step, -LONGEST_TURN), LONGEST_TURN))
            weights[k] = curved
        if setting[ORDERED] == 0.0:
            blocks[:] = np.arange(n)
        else:
            pool(values, weights, blocks)
        if setting[ORDERED] > 0.0 and values[n - 1] - values[0] > 2.0 * math.pi:
            # Over a full turn the first and the last would pass each other: they share what is too much.
            over = 0.5 * (values[n - 1] - values[0] - 2.0 * math.pi)
            low, high = values[0] + over, values[n - 1] - over
            for k in range(n):
                values[k] = min(max(values[k], low), high)
        moved = 0.0
        for k in range(n):
            moved = max(moved, abs(way * values[k] - angles[k]))
            angles[k] = way * values[k]
        if moved < SETTLED:
            break
    return True


@njit(ROWS, cache=True, nogil=True)
def path_rows(
    x: Real, points: Real, setting: Real, multipliers: Real, state: Real, residuals: Real, jacobian: Real
) -> int:
    """Residuals and Jacobian of all points, and of the limits; see :data:`synthesis.numerics.levenberg.ROWS`.

    ``points`` are rows (x, y, crank angle); with free timing the third number is not looked at, and ``state`` has the
    crank angles from the ground line; with prescribed timing it is overwritten by them. Its last entry + 1 turns by
    the direction in which angles rise.
    """
    n = len(points)
    lengths, slopes, by = np.empty(4), np.empty((4, 4)), np.empty((2, 9))
    for i in range(LENGTHS, LENGTHS + 4):
        if not -40.0 < x[i] < 40.0:
            return -1
    shortest = int(setting[SHORTEST])
    lengths_of(x, shortest, lengths, slopes)
    sign = setting[SIGN]
    timed = setting[TIMED] > 0.0
    absolute = setting[PHASED] == ABSOLUTE
    unknowns = x.size
    blocks = np.empty(n, np.int64)
    if timed:
        for k in range(n):
            state[k] = points[k, 2] + (-x[2] if absolute else x[PHASE] if unknowns > PHASE else 0.0)
    elif not settle(x, lengths, setting, points, state, blocks):
        return -1
    m = 0
    first = 0
    for k in range(n):
        good, px, py, tx, ty = point_and_slopes(x, lengths, slopes, sign, state[k], by)
        if not good:
            return -1
        gx, gy = px - points[k, 0], py - points[k, 1]
        if not timed and (k + 1 == n or blocks[k + 1] != blocks[k]) and (k == 0 or blocks[k - 1] != blocks[k]):
            # Alone at its angle: what lies across the curve is all that is left.
            fast = math.sqrt(tx * tx + ty * ty)
            if fast > STILL:
                nx, ny = -ty / fast, tx / fast
                residuals[m] = nx * gx + ny * gy
                for i in range(9):
                    jacobian[m, i] = nx * by[0, i] + ny * by[1, i]
                m += 1
                continue
        one, two = jacobian[m], jacobian[m + 1]
        residuals[m], residuals[m + 1] = gx, gy
        for i in range(9):
            one[i], two[i] = by[0, i], by[1, i]
        if timed:
            if absolute:
                one[2] -= tx
                two[2] -= ty
            elif unknowns > PHASE:
                one[PHASE], two[PHASE] = tx, ty
        else:
            if k == 0 or blocks[k - 1] != blocks[k]:
                first = m
            state[n + m - first], state[n + m - first + 1] = tx, ty
            if k + 1 == n or blocks[k + 1] != blocks[k]:
                _project(jacobian, first, m + 2, state[n : n + m + 2 - first])
        m += 2
    values = np.empty(LIMITS)
    ends = np.array([state[0], state[n - 1]])
    return limit_rows(x, lengths, slopes, ends, setting, multipliers, residuals, jacobian, m, values)


_VECTOR, _MATRIX = types.Array(types.float64, 1, "C"), types.Array(types.float64, 2, "C")


@njit(
    types.void(
        types.FunctionType(ROWS), _MATRIX, _MATRIX, _MATRIX, _VECTOR, _VECTOR, types.int64, types.float64, _VECTOR
    ),
    cache=True,
    nogil=True,
)
def descend_each(
    rows: Any,
    starts: Real,
    states: Real,
    points: Real,
    setting: Real,
    multipliers: Real,
    steps: int,
    tolerance: float,
    costs: Real,
) -> None:  # fmt: skip
    """Descend from each start in place; its cost becomes that of where it has come to."""
    most = 2 * len(points) + LIMITS
    for k in range(len(starts)):
        costs[k] = descend(rows, starts[k], points, setting, multipliers, states[k], most, steps, tolerance)


@njit(
    types.void(types.FunctionType(ROWS), _VECTOR, _VECTOR, _MATRIX, _VECTOR, types.float64, _VECTOR),
    cache=True,
    nogil=True,
)
def hold(rows: Any, x: Real, state: Real, points: Real, setting: Real, weight: float, ended: Real) -> None:
    """Descend to a minimum at which all limits are met; ``ended`` gets half the sum of squares and the violation.

    Both are infinite where there is none.
    """
    most = 2 * len(points) + LIMITS
    multipliers = np.zeros(LIMITS + 1)
    multipliers[LIMITS] = weight
    lengths, slopes, values = np.empty(4), np.empty((4, 4)), np.empty(LIMITS)
    residuals, jacobian = np.empty(most), np.zeros((most, x.size))
    before = worst = np.inf
    ended[:] = np.inf
    for _ in range(ROUNDS):
        if not descend(rows, x, points, setting, multipliers, state, most, STEPS, TOLERANCE) < np.inf:
            return
        lengths_of(x, int(setting[SHORTEST]), lengths, slopes)
        ends = np.array([state[0], state[len(points) - 1]])
        limit_rows(x, lengths, slopes, ends, setting, multipliers, residuals, jacobian, 2 * len(points), values)
        worst = renew(multipliers, values, setting, x, lengths)
        if worst <= HELD:
            break
        if worst > 0.25 * before:
            # Multipliers stay what they are: their unit does not hang on the weight.
            multipliers[LIMITS] *= 10.0
        before = worst
    found = rows(x, points, setting, multipliers, state, residuals, jacobian)
    if found < 0:
        return
    spare, unused = np.empty(LIMITS), np.zeros((LIMITS, x.size))
    limited = limit_rows(x, lengths, slopes, ends, setting, multipliers, spare, unused, 0, values)
    cost = 0.0
    for k in range(found - limited):
        cost += 0.5 * residuals[k] * residuals[k]
    ended[0], ended[1] = cost, worst
