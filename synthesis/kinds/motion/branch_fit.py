"""Least-squares fit of sixbars to more positions than they can meet, from the pool of branch-preserving descents.

Eight positions determine a sixbar. If more are fitted, or if the constraints exclude exact solutions, the linkages with
the lowest cost (:class:`branch_walk.Pool`) are descended until their least squares converge, with the first pose among
the unknowns. Exact positions have a larger weight there and are finally met by minimum-norm steps.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from kinematics.compiling import njit
from synthesis.kinds.motion.branch_rows import (
    COSINE,
    FIRST_X,
    FIRST_Y,
    FIXED_BOX,
    FREE,
    JOINTS,
    LONGEST,
    OF_POSE,
    RATIO,
    REACH,
    SETTINGS,
    SHORTEST,
    WANTED_X,
    WANTED_Y,
    WAY,
    dimensions,
    driven,
    most_rows,
)
from synthesis.kinds.motion.branch_values import Poses, value_of
from synthesis.kinds.motion.branch_walk import ARRIVED, Pool, Room, descended, of_first
from synthesis.kinds.motion.sixbar_makes import Found

Real = NDArray[np.float64]

OF_FIT, OF_HELD = 0.1, 10.0
"""Weights relative to the limits, small so that these take precedence: of a fitted pose, and the additional factor of
an exact pose."""

WORTH, TIMES, MOST_STEPS = 0.99, 4, 500
"""Maximum share of the cost left after ten steps; maximum number of consecutive descents; maximum number of steps of
each."""

NEARLY_ARRIVED = 1e-14
"""Sum of squares below which a fit counts as meeting all positions."""

NO_MATTER = 1e6
"""Tolerance that disables a coordinate."""

BY_MISS = 100.0
"""Penalty of the error in a fit's value: an error of a hundredth of the task's size halves the bonus for accuracy."""


@njit(cache=True, nogil=True, error_model="numpy")
def value_of_fit(error: float) -> float:
    """Return the value of a feasible fit: 2 if it meets all positions, decreasing towards 1 with the error."""
    return 1.0 + 1.0 / (1.0 + BY_MISS * error)


@njit(cache=True, nogil=True, error_model="numpy")
def _error(x: Real, points: Real, setting: Real, free: int) -> float:
    """Return the RMS over the positions of P's distance, in task sizes, and the body's angle, radians, together."""
    z, at, turns = np.empty(7, np.complex128), np.empty(6, np.complex128), np.empty(4, np.complex128)
    lengths, inverses = np.empty(4), np.empty(4, np.complex128)
    for j in range(7):
        z[j] = complex(x[2 * j], x[2 * j + 1])
    dimensions(z, lengths, inverses)
    stands = x[free + 2] if free > 0 else 0.0
    total = (setting[FIRST_X] - setting[WANTED_X]) ** 2 + (setting[FIRST_Y] - setting[WANTED_Y]) ** 2 + stands**2
    angle = 0.0
    for k in range(len(points)):
        angle += math.exp(x[JOINTS + k])
        driven(z, lengths, inverses, setting, setting[WAY] * angle, at, turns)
        back = turns[3] * complex(math.cos(points[k, 2]), -math.sin(points[k, 2]))
        total += (at[5].real - points[k, 0]) ** 2 + (at[5].imag - points[k, 1]) ** 2
        total += (math.atan2(back.imag, back.real) + stands) ** 2
    return math.sqrt(total / (len(points) + 1))


@njit(cache=True, nogil=True, error_model="numpy")
def _met(x: Real, points: Real, setting: Real, held: NDArray[np.bool_], room: Room) -> bool:
    """Move a linkage onto the exact positions, ignoring its limits; return whether that succeeds."""
    only, free = points.copy(), setting.copy()
    for k in range(len(points)):
        only[k, 6], only[k, 7] = 1.0, 1.0
        if not held[k + 1]:
            only[k, 3:6] = NO_MATTER
    free[COSINE], free[REACH], free[RATIO], free[SHORTEST], free[LONGEST] = 1.0, np.inf, np.inf, 0.0, np.inf
    for n in range(FIXED_BOX, WANTED_X):
        free[n] = np.inf if (n - FIXED_BOX) % 2 else -np.inf
    counts = np.zeros(3, np.int64)
    return bool(descended(x, only, free, room, counts, WORTH) < ARRIVED)


@njit(cache=True, nogil=True, error_model="numpy")
def _ended(x: Real, points: Real, setting: Real, room: Room) -> float:
    """Minimize the least squares in place until convergence; return the sum of squares."""
    counts, before = np.zeros(3, np.int64), np.inf
    cost = before
    for _ in range(TIMES):
        cost = descended(x, points, setting, room, counts, WORTH, MOST_STEPS)
        if not cost < WORTH * before:
            break
        before = cost
    return cost


@njit(cache=True, nogil=True, error_model="numpy")
def _at_bare_limits(x: Real, points: Real, setting: Real, bare: Real, poses: Poses, room: Room) -> None:
    """Retry, in place, without the margins, in case the positions can be met within the limits themselves."""
    if setting[COSINE] > bare[COSINE]:
        return  # a relaxed start has wider aims than the limits already
    further, limits, joints = x.copy(), setting.copy(), np.empty(7, np.complex128)
    for k in range(COSINE, FIRST_X):
        limits[k] = bare[k]
    met = _ended(further, points, limits, room) < NEARLY_ARRIVED
    if met and value_of(further, points, limits, poses, joints) >= 1.0:
        for k in range(len(x)):
            x[k] = further[k]


@njit(cache=True, nogil=True, error_model="numpy")
def fitted(poses: Poses, held: NDArray[np.bool_], pool: Pool, bare: Real, found: Found) -> int:
    """Fit all linkages of a pool until convergence.

    Parameters
    ----------
    poses : Poses
        Target poses.
    held : bool, shape (n,)
        Mask of the exact positions.
    pool : Pool
        Starting points.
    bare : float, shape (SETTINGS,)
        The limits without the margins of the starts' aims.
    found : Found
        Output.

    Returns
    -------
    int
        Number of linkages written.
    """
    later = len(poses.later)
    unknowns = JOINTS + later + (0 if held[0] else FREE)
    free = -1 if held[0] else JOINTS + later
    x, setting, points = np.empty(unknowns), np.empty(SETTINGS), np.empty((later, OF_POSE))
    most = most_rows(later + 1)
    room = Room(np.empty(most), np.empty(most), np.empty((most, unknowns)), np.empty((most, most)), np.empty(most))
    joints = np.empty(7, np.complex128)
    n = 0
    for row in range(len(pool.costs)):
        if not pool.costs[row] < np.inf:
            continue
        for k in range(SETTINGS):
            setting[k] = pool.settings[row, k]
        of_first(poses, pool.starts[row], setting, points)
        setting[WANTED_X], setting[WANTED_Y] = setting[FIRST_X], setting[FIRST_Y]
        for k in range(later):
            points[k, 6] = points[k, 7] = OF_FIT * (OF_HELD if held[k + 1] else 1.0)
        for k in range(JOINTS + later):
            x[k] = pool.x[row, k]
        if free > 0:
            x[free], x[free + 1], x[free + 2] = setting[FIRST_X], setting[FIRST_Y], 0.0
        if _ended(x, points, setting, room) > NEARLY_ARRIVED:
            _at_bare_limits(x, points, setting, bare, poses, room)
        # A weight alone leaves a small error at exact positions; these steps remove it.
        if held.any() and not _met(x, points, setting, held, room):
            continue
        if free > 0:
            setting[FIRST_X], setting[FIRST_Y] = x[free], x[free + 1]
        value = value_of(x, points, setting, poses, joints)
        error = _error(x, points, setting, free)
        found.makes[n] = int(setting[0])
        for k in range(7):
            found.joints[n, k] = joints[k]
        found.bodies[n] = complex(setting[FIRST_X], setting[FIRST_Y])
        found.stands[n] = x[free + 2] if free > 0 else 0.0
        found.values[n] = value_of_fit(error) if value >= 1.0 else value
        n += 1
    return n
