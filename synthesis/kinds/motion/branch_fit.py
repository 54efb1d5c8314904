"""Sixbars that come nearest to more positions than they can meet, from the pool of descents that hold their branch.

A sixbar has as many numbers as eight positions state. Where more are fitted, or fewer under demands that leave none,
the linkages that miss least (:class:`branch_walk.Pool`) are descended to the end of their least squares, with the
first pose among the unknowns. Positions that are to be met exactly weigh more there, and are then met by the shortest
steps on to them.
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
"""Weights of a pose beside limits, so that these are kept: one that is fitted, and how much more one that is held."""

WORTH, TIMES, MOST_STEPS = 0.99, 4, 500
"""Share of a cost that ten steps have to leave at most; descents at most, one after another; steps of one at most."""

NEARLY_ARRIVED = 1e-14
"""Sum of squares at which a fit counts as one that meets all positions."""

NO_MATTER = 1e6
"""A tolerance of what is not looked at."""

BY_MISS = 100.0
"""How fast a fit loses value by its error: of two that differ by a hundredth of the task's size at about 1 to 2."""


@njit(cache=True, nogil=True, error_model="numpy")
def value_of_fit(error: float) -> float:
    """The value of a sound fit: from 2 for one that meets all positions towards 1."""
    return 1.0 + 1.0 / (1.0 + BY_MISS * error)


@njit(cache=True, nogil=True, error_model="numpy")
def _error(x: Real, points: Real, setting: Real, free: int) -> float:
    """The root mean square over the positions of P's distance, in task sizes, and the body's angle together."""
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
    """Takes a linkage on to the positions that are held, whatever its limits; whether that goes."""
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
    """Descends to the end of the least squares, in place; the sum of squares there."""
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
    """Goes on, in place, to positions that only the aims hold off, where they are met within the limits themselves."""
    if setting[COSINE] > bare[COSINE]:
        return  # These aims are wider than the limits.
    further, limits, joints = x.copy(), setting.copy(), np.empty(7, np.complex128)
    for k in range(COSINE, FIRST_X):
        limits[k] = bare[k]
    met = _ended(further, points, limits, room) < NEARLY_ARRIVED
    if met and value_of(further, points, limits, poses, joints) >= 1.0:
        for k in range(len(x)):
            x[k] = further[k]


@njit(cache=True, nogil=True, error_model="numpy")
def fitted(poses: Poses, held: NDArray[np.bool_], pool: Pool, bare: Real, found: Found) -> int:
    """Descends from all of a pool to the end.

    Parameters
    ----------
    poses : Poses
        What is demanded.
    held : bool, shape (n,)
        Which positions are to be met exactly.
    pool : Pool
        Starts.
    bare : float, shape (SETTINGS,)
        The limits, which the aims of the starts keep aside of.
    found : Found
        Filled.

    Returns
    -------
    int
        How many there are.
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
