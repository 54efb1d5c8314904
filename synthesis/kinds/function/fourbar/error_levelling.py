"""Error levelling: move the precision points until the extremes of the error between them are equal.

In the space of dimensions, linkages that follow a function well lie in narrow curved valleys, in which descents
converge slowly. The precision points, at which the error vanishes, are better unknowns: through n of them there are few
linkages, all known in closed form (:mod:`synthesis.kinds.function.fourbar.precision_points`), and each extreme of the
error depends mainly on the two adjacent precision points. With h_i the maximum errors in the n + 1 parts of the range,
the n equations ln h_i = ln h_{i+1} are solved by Newton's method in the precision points, for many linkages at once.
The error of the best linkage alternates, and is therefore level, if no limit is active.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from synthesis.kinds.function.fourbar.precision_points import find_exact_points
from synthesis.kinds.function.fourbar.structural_error import Generators
from synthesis.kinds.function.fourbar.task import FunctionTask

MAX_ROUNDS = 10
"""Maximum number of Newton steps."""

DIFFERENCE_STEP = 1e-3
"""Finite-difference step of a precision point's angle t, where u = (1 − cos t)/2."""

MAX_MOVE_SHARE = 0.3
"""Maximum move of a precision point per step, as a share of the distance to its neighbours."""

LEVEL_TOLERANCE = 1e-4
"""Tolerance for level extremes: maximum difference of their logarithms."""

GRID_SIZE = 241
"""Number of inputs over the range at which errors are evaluated."""

SCALE_SPREADS, COPY_COUNT, FAMILY_COUNT = (0.3, 0.1, 0.03, 0.01), 15, 4
"""Variation of open scales: successive spreads in their logarithm, number of values each, and number of linkages."""


def equalize_errors(task: FunctionTask, generators: Real, signs: Real) -> tuple[Real, Real]:
    """Level the errors of linkages whose error vanishes at as many points as can be met.

    Parameters
    ----------
    task : FunctionTask
        A task with a function.
    generators, signs : float, shapes (k, 7) and (k,)
        Starting points.

    Returns
    -------
    generators, signs : float, shapes (m, 7) and (m,)
        The best iterate of each successful start; m ≤ k without open scales.
    """
    function = task.problem.function
    # Three dimensions can always be chosen to meet points, and each open zero adds one freedom.
    count = 3 + sum(zero is None for zero in task.zeros)
    if function is None or not len(generators):
        return generators[:0], signs[:0]
    # Equal steps of this angle place the inputs more densely at the ends, where errors oscillate most.
    angles = np.linspace(0.0, math.pi, GRID_SIZE)
    shares = 0.5 - 0.5 * np.cos(angles)
    grid = Generators(task.problem.slides, shares, function.share_along(shares))
    places, begun = _find_zeros(grid.errors(generators, signs), angles, count)
    generators, signs = generators[begun], signs[begun]
    reached, theirs, places, least = _equalize_extremes(task, grid, angles, generators, signs, places)
    columns = np.flatnonzero(task.free[5:]) + 5
    for spread in SCALE_SPREADS if len(columns) and len(reached) else ():
        # Restart from the best linkages with varied scales, at their current precision points.
        # With an open output scale compare errors relative to it, because a small scale makes any error small.
        chosen = np.argsort(least / np.abs(reached[:, 6]) if task.free[6] else least)[:FAMILY_COUNT]
        copies, again = np.repeat(reached[chosen], COPY_COUNT, axis=0), np.repeat(places[chosen], COPY_COUNT, axis=0)
        factors = np.exp(spread * np.linspace(-1.0, 1.0, COPY_COUNT))
        for n, column in enumerate(columns):
            # Permute the factors of a second open scale, so that the two scales vary independently.
            order = np.roll(factors[::-1], n * (COPY_COUNT // 3)) if n else factors
            copies[:, column] = _clip_scales(task, int(column) - 5, copies[:, column] * np.tile(order, len(chosen)))
        more = _equalize_extremes(task, grid, angles, copies, np.repeat(theirs[chosen], COPY_COUNT), again)
        reached, theirs = np.concatenate([reached, more[0]]), np.concatenate([theirs, more[1]])
        places, least = np.concatenate([places, more[2]]), np.concatenate([least, more[3]])
    return reached, theirs


def _clip_scales(task: FunctionTask, side: int, scales: Real) -> Real:
    """Clip scales to their limits, separately for each sign."""
    for low, high in task.scales[side]:
        # The intervals of a scale have one sign each, and a scale must not change its sign.
        same = scales * low > 0.0
        scales = np.where(same, np.clip(scales, low, high), scales)
    return scales


def _equalize_extremes(
    task: FunctionTask, grid: Generators, angles: Real, generators: Real, signs: Real, places: Real
) -> tuple[Real, Real, Real, Real]:
    """Level the extremes from precision points (k, count); return generators, signs, points and maximum errors."""
    function = task.problem.function
    assert function is not None
    count = places.shape[1]
    met = places.copy()
    best, least = generators.copy(), np.full(len(generators), np.inf)
    for _ in range(MAX_ROUNDS):
        if not len(generators):
            break
        # The first set is unmoved; each further set moves one point, for the finite differences.
        moved = np.concatenate([places[:, None], places[:, None] + DIFFERENCE_STEP * np.eye(count)], axis=1)
        sets = moved.reshape(-1, count)
        u = 0.5 - 0.5 * np.cos(sets)
        y = function.share_along(u)
        around = np.repeat(generators, count + 1, axis=0)
        found = _find_nearest(task, around, around[:, 5:6] * u, around[:, 6:7] * y)
        # All sets keep the assembly of their linkage.
        errors = np.abs(grid.errors(found, np.repeat(signs, count + 1)))
        heights = _measure_extremes(errors, angles, sets).reshape(len(generators), count + 1, count + 1)
        found = found.reshape(len(generators), count + 1, 7)
        greatest = heights[:, 0].max(axis=1)
        # Newton's method can overshoot, so keep the best iterate.
        better = np.isfinite(greatest) & (greatest < least)
        best[better], least[better], met[better] = found[better, 0], greatest[better], places[better]
        with np.errstate(divide="ignore", invalid="ignore"):
            # Logarithms make the extremes comparable over many orders of magnitude.
            unlevel = np.diff(np.log(heights), axis=2)
        on = np.isfinite(unlevel).all(axis=(1, 2)) & (np.abs(unlevel[:, 0]).max(axis=1) > LEVEL_TOLERANCE)
        if not on.any():
            break
        slopes = np.swapaxes(unlevel[:, 1:] - unlevel[:, :1], 1, 2) / DIFFERENCE_STEP
        step = np.zeros_like(places)
        # The pseudoinverse tolerates directions in which the extremes do not change.
        step[on] = -np.einsum("kij,kj->ki", np.linalg.pinv(slopes[on]), unlevel[on, 0])
        # Mirror the outermost points at the ends of the range, so that a point can approach an end but not pass it.
        ends = np.concatenate([-places[:, :1], places, 2.0 * math.pi - places[:, -1:]], axis=1)
        room = MAX_MOVE_SHARE * np.minimum(np.diff(ends)[:, :-1], np.diff(ends)[:, 1:])
        with np.errstate(divide="ignore"):
            # Coinciding points leave no space to move; points at rest need none (hence 0 for a zero step).
            too_far = np.divide(np.abs(step), room, out=np.zeros_like(step), where=step != 0.0).max(axis=1)
        # Shorten the whole step and not single components, to keep its direction.
        places = places + step / np.maximum(too_far, 1.0)[:, None]
        # Linkages that are level or undefined stay unchanged while the others continue.
        generators = np.where(on[:, None], found[:, 0], generators)
    reached = np.isfinite(least)
    return best[reached], signs[reached], met[reached], least[reached]


def _find_zeros(errors: Real, angles: Real, count: int) -> tuple[Real, NDArray[np.int64]]:
    """Find the zeros of errors, as angles (m, count), of generators with at least ``count`` zeros, and their indices.

    A generator with more zeros appears twice: with its first and with its last ones.
    """
    finite = np.asarray(np.isfinite(errors).all(axis=1))
    # Without the mask NaN would count as crossings of zero.
    crossed = np.asarray(np.diff(np.sign(np.where(finite[:, None], errors, 1.0)), axis=1) != 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = errors[:, :-1] / (errors[:, :-1] - errors[:, 1:])
    # Linear interpolation suffices: these are starting points only.
    at = np.where(crossed, angles[:-1] + (angles[1] - angles[0]) * shares, np.inf)
    first = np.sort(at, axis=1)[:, :count]
    last = np.sort(np.where(crossed, at, -np.inf), axis=1)[:, -count:]
    total = crossed.sum(axis=1)
    begun = np.concatenate([np.flatnonzero(total >= count), np.flatnonzero(total > count)])
    return np.concatenate([first[total >= count], last[total > count]]), begun


def _find_nearest(task: FunctionTask, around: Real, inputs: Real, outputs: Real) -> Real:
    """Find the linkage through each set of points that is nearest to a given generator; NaN if there is none."""
    found = task.closure.dimensions(find_exact_points(task.closure, inputs, outputs, task.zeros))
    apart = found - around[:, None, :5]
    angles = [3] if task.problem.slides else [3, 4]
    # Angles are compared by the shortest way.
    apart[..., angles] -= math.tau * np.round(apart[..., angles] / math.tau)
    # Lengths are positive and compared by ratio; the offset can vanish, so it has a floor.
    apart[..., :2] /= around[:, None, :2]
    apart[..., 2] /= np.abs(around[:, None, 2]) + 0.1
    distance = np.abs(apart).max(axis=2)
    distance = np.where(np.isfinite(distance), distance, np.inf)
    chosen = found[np.arange(len(found)), distance.argmin(axis=1)]
    return np.concatenate([chosen, around[:, 5:]], axis=1)


def _measure_extremes(errors: Real, angles: Real, places: Real) -> Real:
    """Measure the maximum errors between the points, shape (k, points + 1); NaN if undefined."""
    # An undefined error must not lose in the maximum.
    errors = np.where(np.isfinite(errors), errors, np.inf)
    part = (angles[None, :, None] > places[:, None, :]).sum(axis=2)
    heights = np.stack([np.where(part == j, errors, 0.0).max(axis=1) for j in range(places.shape[1] + 1)], axis=1)
    return np.where(np.isfinite(heights) & (heights > 0.0), heights, np.nan)
