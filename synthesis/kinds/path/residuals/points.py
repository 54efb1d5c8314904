"""Residuals of a fourbar that guides its coupler point past given points, with prescribed or free timing.

With prescribed timing each point has its crank angle, and the residuals are the coordinates of P − z.

With free timing the crank angles are eliminated: for each linkage they are those at which P is nearest to the points in
their order. Newton's method finds each angle by itself, and angles that come out of order are pooled (isotonic
regression: a quadratic program with a diagonal matrix). At these angles the derivative of the distances by the angles
vanishes, so that the Jacobian by the other unknowns is that at fixed angles minus its part along the curve (variable
projection; Golub & Pereyra 1973, doi:10.1137/0710036, in Kaufman's form). Points that share an angle are projected
together.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from synthesis.fit.chart import FOURBAR, LENGTHS, compute_lengths
from synthesis.fit.constraints import (
    EQUATION_COUNT,
    FAMILY_INDEX,
    FULL_TURN_INDEX,
    LIMIT_COUNT,
    SIGN_INDEX,
    compute_margins,
)
from synthesis.fit.coupler_curve import compute_fourbar_velocity, compute_unit_vector, place_with_slopes
from synthesis.fit.fourbar_workspace import NO_BODY, append_workspace_rows
from synthesis.fit.workspace_margins import count_margins
from synthesis.kinds.path.residuals.constraint_vector import (
    ORDER_INDEX,
    PATH_SETTING_SIZE,
    PHASE_ABSOLUTE,
    PHASE_REFERENCE_INDEX,
    TIMING_INDEX,
)
from synthesis.kinds.path.residuals.point_assignment import fit_isotonic
from synthesis.numerics.augmented_lagrangian import append_limit_rows
from synthesis.numerics.levenberg import ROWS

PHASE_UNKNOWN = 9
"""Index of the crank's phase among the unknowns, behind those of the chart; only if the phase is free."""

MAX_ABS_LOG = 40.0
"""Maximum absolute logarithm of a length; beyond it the shorter lengths are lost in the rounding of the longer ones."""

DIFFERENCE_STEP = 1e-5
"""Angle, radians, over which the curvature of P's path is differenced."""

MAX_NEWTON_STEPS = 4
"""Number of Newton steps of the eliminated angles at each linkage; they start from the angles of the last accepted
one."""

MAX_TURN_STEP = 0.2
"""Maximum size of a Newton step, radians."""

TURN_TOLERANCE = 1e-7
"""Newton step, radians, after which the angles have converged; the next step would be below rounding."""

MIN_SPEED = 1e-9
"""Speed of P, task sizes per radian, below which its path has no direction."""

MIN_DIRECTION = 1e-24
"""Squared length of a direction, task sizes squared, below which nothing is projected along it."""

MIN_CURVATURE, MIN_CURVATURE_SHARE = 1e-12, 0.25
"""Minimum second derivative of half the squared distance, absolute (task sizes squared) and as a share of the squared
speed: the Newton step remains a descent where the curve bends towards the point."""


@njit(cache=True, nogil=True)
def _project(jacobian: Real, first: int, last: int, direction: Real) -> None:
    """Remove from the rows ``first`` to ``last`` of the Jacobian their component along a direction, in place."""
    square = 0.0
    for k in range(last - first):
        square += direction[k] * direction[k]
    if not square > MIN_DIRECTION:
        return
    for i in range(9):
        along = 0.0
        for k in range(first, last):
            along += jacobian[k, i] * direction[k - first]
        along /= square
        for k in range(first, last):
            jacobian[k, i] -= along * direction[k - first]


@njit(cache=True, nogil=True)
def settle_angles(x: Real, lengths: Real, setting: Real, points: Real, angles: Real, blocks: NDArray[np.int64]) -> bool:
    """Move crank angles to the positions at which P is nearest to the points, in order; return False beyond a toggle.

    The direction of the order is that of the given angles: from the first to the last.
    """
    n, sign = len(points), setting[SIGN_INDEX]
    # Negating the angles turns a decreasing order into an increasing one.
    way = 1.0 if angles[n - 1] >= angles[0] else -1.0
    ground = compute_unit_vector(x[2])
    values, weights = np.empty(n), np.empty(n)
    for _ in range(MAX_NEWTON_STEPS):
        for k in range(n):
            good, p, t = compute_fourbar_velocity(x, lengths, sign, ground, x[2] + angles[k])
            if not good:
                return False
            square = t.real * t.real + t.imag * t.imag
            # Second derivative of half the squared distance; the curvature's part is a finite difference.
            good, _, ahead = compute_fourbar_velocity(x, lengths, sign, ground, x[2] + angles[k] + DIFFERENCE_STEP)
            gx, gy = p.real - points[k, 0], p.imag - points[k, 1]
            curved = square
            if good:
                curved += ((ahead.real - t.real) * gx + (ahead.imag - t.imag) * gy) / DIFFERENCE_STEP
            curved = max(curved, MIN_CURVATURE_SHARE * square, MIN_CURVATURE)
            step = -(t.real * gx + t.imag * gy) / curved
            values[k] = way * (angles[k] + min(max(step, -MAX_TURN_STEP), MAX_TURN_STEP))
            # Pooling minimizes the quadratic model of the weighted squared distances.
            weights[k] = points[k, 3] * points[k, 3] * curved
        if setting[ORDER_INDEX] == 0.0:
            blocks[:] = np.arange(n)
        else:
            fit_isotonic(values, weights, blocks)
        if setting[ORDER_INDEX] > 0.0 and values[n - 1] - values[0] > 2.0 * math.pi:
            # More than a full turn would let the last point overtake the first: both ends share the excess.
            over = 0.5 * (values[n - 1] - values[0] - 2.0 * math.pi)
            low, high = values[0] + over, values[n - 1] - over
            for k in range(n):
                values[k] = min(max(values[k], low), high)
        moved = 0.0
        for k in range(n):
            moved = max(moved, abs(way * values[k] - angles[k]))
            angles[k] = way * values[k]
        if moved < TURN_TOLERANCE:
            break
    return True


@njit(cache=True, nogil=True)
def _compute_end_turn(by: Complex, timed: bool, absolute: bool, turn: Real) -> None:
    """Compute the derivatives of the crank angle at the first or last point, from the ground line, by the unknowns.

    With free timing P stays at its nearest place: the part of its displacement along its path is undone by the angle.
    """
    if timed:
        if absolute:
            turn[2] = -1.0
        elif len(turn) > PHASE_UNKNOWN:
            turn[PHASE_UNKNOWN] = 1.0
        return
    square = by[9].real * by[9].real + by[9].imag * by[9].imag
    if square > MIN_DIRECTION:
        for i in range(9):
            turn[i] = -(by[9].real * by[i].real + by[9].imag * by[i].imag) / square


@njit(cache=True, nogil=True)
def _write_normal_row(
    root: float, gap: complex, speed: complex, by: Complex, m: int, residuals: Real, jacobian: Real
) -> bool:
    """Write the row of a point's gap across the curve; return False where the curve has no direction.

    ``gap`` and ``speed`` contain the root of the weight.
    """
    fast = math.sqrt(speed.real * speed.real + speed.imag * speed.imag)
    if not fast > MIN_SPEED:
        return False
    # Unit normal of the path.
    nx, ny = -speed.imag / fast, speed.real / fast
    residuals[m] = nx * gap.real + ny * gap.imag
    for i in range(9):
        jacobian[m, i] = root * (nx * by[i].real + ny * by[i].imag)
    return True


@njit(cache=True, nogil=True)
def _append_margin_rows(
    x: Real, lengths: Real, slopes: Real, sign: float, ends: Real, turns: Real, setting: Real, multipliers: Real,
    state: Real, residuals: Real, jacobian: Real, m: int,
) -> int:  # fmt: skip
    """Append the rows of the workspace and of the constraints.

    Returns the number of rows, or −1 if the motion does not close.
    """
    values, gradients = state[state.size - LIMIT_COUNT :], np.empty((LIMIT_COUNT, x.size))
    compute_margins(x, lengths, slopes, ends, turns[0], setting, values, gradients)
    room = setting[PATH_SETTING_SIZE:]
    roomy = count_margins(room)
    if roomy > 0:
        kept = state[state.size - LIMIT_COUNT - roomy : state.size - LIMIT_COUNT]
        whole = setting[FULL_TURN_INDEX] > 0.0
        m = append_workspace_rows(
            x, lengths, slopes, sign, ends, turns, whole, NO_BODY, room, multipliers, kept, residuals, jacobian, m
        )  # fmt: skip
        if m < 0:
            return -1
    rows: int = append_limit_rows(values, gradients, EQUATION_COUNT, multipliers[roomy:], residuals, jacobian, m)
    return rows


@njit(ROWS, cache=True, nogil=True)
def compute_path_rows(
    x: Real, points: Real, setting: Real, multipliers: Real, state: Real, residuals: Real, jacobian: Real
) -> int:
    """Compute residuals and Jacobian of all points and limits; see :data:`synthesis.numerics.levenberg.ROWS`.

    ``points`` are rows (x, y, crank angle, root of the weight); with free timing the third number is not used, and
    ``state`` has the crank angles from the ground line first; with prescribed timing they are written there. Two
    scratch numbers per point follow, and the limits' margins are the last: those of a workspace, then the constraints'.
    """
    n = len(points)
    lengths, slopes, by = np.empty(4), np.empty((4, 4)), np.empty(10, np.complex128)
    turns = np.zeros((2, x.size))
    for i in range(LENGTHS, LENGTHS + 4):
        # Also rejects NaN.
        if not -MAX_ABS_LOG < x[i] < MAX_ABS_LOG:
            return -1
    compute_lengths(int(setting[FAMILY_INDEX]), x, lengths, slopes)
    sign, timed = setting[SIGN_INDEX], setting[TIMING_INDEX] > 0.0
    absolute = setting[PHASE_REFERENCE_INDEX] == PHASE_ABSOLUTE
    unknowns = x.size
    blocks = np.empty(n, np.int64)
    if timed:
        for k in range(n):
            state[k] = points[k, 2] + (-x[2] if absolute else x[PHASE_UNKNOWN] if unknowns > PHASE_UNKNOWN else 0.0)
    elif not settle_angles(x, lengths, setting, points, state, blocks):
        return -1
    m, first = 0, 0
    for k in range(n):
        good, p = place_with_slopes(FOURBAR, x, lengths, slopes, sign, 0.0, x[2] + state[k], by)
        if not good:
            return -1
        root = points[k, 3]
        gx, gy = root * (p.real - points[k, 0]), root * (p.imag - points[k, 1])
        tx, ty = root * by[9].real, root * by[9].imag
        # Unless crank angles are absolute, the crank's angle is fixed relative to the ground line, not to the plane.
        if not absolute:
            by[2] += by[9]
        if k == 0:
            _compute_end_turn(by, timed, absolute, turns[0])
        if k + 1 == n:
            _compute_end_turn(by, timed, absolute, turns[1])
        alone = not timed and (k + 1 == n or blocks[k + 1] != blocks[k]) and (k == 0 or blocks[k - 1] != blocks[k])
        # A point with an angle of its own: only the component across the curve remains.
        if alone and _write_normal_row(root, complex(gx, gy), complex(tx, ty), by, m, residuals, jacobian):
            m += 1
            continue
        one, two = jacobian[m], jacobian[m + 1]
        residuals[m], residuals[m + 1] = gx, gy
        for i in range(9):
            one[i], two[i] = root * by[i].real, root * by[i].imag
        if timed:
            if unknowns > PHASE_UNKNOWN:
                one[PHASE_UNKNOWN], two[PHASE_UNKNOWN] = tx, ty
        else:
            if k == 0 or blocks[k - 1] != blocks[k]:
                first = m
            # Collect the direction of a block's common angle, along which its rows are projected.
            state[n + m - first], state[n + m - first + 1] = tx, ty
            if k + 1 == n or blocks[k + 1] != blocks[k]:
                _project(jacobian, first, m + 2, state[n : n + m + 2 - first])
        m += 2
    ends = np.array([state[0], state[n - 1]])
    rows: int = _append_margin_rows(
        x, lengths, slopes, sign, ends, turns, setting, multipliers, state, residuals, jacobian, m
    )
    return rows
