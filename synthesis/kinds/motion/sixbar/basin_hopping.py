"""Compiled basin-hopping search for sixbars that carry a body on one branch.

A random linkage that closes over a random rotation of its input is fitted to the positions by a descent
(:mod:`synthesis.kinds.motion.sixbar.residuals`), which preserves its branch and order. Most descents end in a minimum
that misses the positions. The best of these form a pool for basin hopping: a member is perturbed at random, descended
again, and replaced if the new minimum is lower (Wales & Doye, J. Phys. Chem. A 101 (1997) 5111, doi:10.1021/jp970984n).
Linkages that meet the positions are moved along their remaining freedoms to improve their quality.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from synthesis.kinds.motion.sixbar.dyad_assembly import O4, Q1, Q2, STEPHENSON_2, A, B, J, compute_signed_sine
from synthesis.kinds.motion.sixbar.quality import Poses, evaluate_sixbar
from synthesis.kinds.motion.sixbar.residuals import (
    COSINE,
    FIRST_SIDE,
    FIRST_X,
    FIRST_Y,
    INPUT_DIRECTION,
    JOINT_COORDINATE_COUNT,
    POSE_ANGLE,
    POSE_X,
    POSE_Y,
    RATIO,
    REACH,
    SECOND_SIDE,
    TOPOLOGY,
    count_max_rows,
    evaluate_residuals,
)
from synthesis.numerics.cholesky import solve_positive

POOL_SIZE = 30
"""Number of linkages in the pool."""

FRESH_SHARE = 0.2
"""Share of descents that start from new random linkages."""

PICK_COUNT, MAX_TRIES = 3, 2000
"""Number of random linkages that close, of which the one with the lowest cost is descended; and the maximum number of
samples for it."""

MIN_SPREAD, MAX_SPREAD = 0.35, 1.35
"""Range of the standard deviation of random joints around the positions, task sizes."""

MIN_START_TURN, MAX_START_TURN = math.radians(30.0), math.radians(300.0)
"""Range of the input's rotation in random linkages, radians."""

MIN_HOP, MAX_HOP = 0.03, 0.6
"""Range of the standard deviation of a hop: task sizes, and natural logarithms of input rotations."""

MAX_STEPS, BLOCK_SIZE, MAX_COST_RATIO = 60, 10, 0.5
"""Descents of the search: maximum number of steps, block length, and the share of the cost below which each block of
steps must bring it for the descent to continue."""

INITIAL_DAMPING, MIN_DAMPING, MAX_DAMPING = 0.03, 1e-10, 1e4
"""Levenberg damping: initial and minimum value, and the value above which a descent has stalled."""

FULL_STEP_FACTOR, CUT_STEP_FACTOR, REJECTION_FACTOR, MAX_CHANGE = 0.15, 0.6, 5.0, 0.6
"""Factors of the damping after a full step, after one that was cut to the maximum change of an unknown, and after a
rejected step; last that maximum change."""

CONVERGED_COST = 1e-22
"""Sum of squares below which a linkage meets its positions."""

MAX_FAILED_HOPS = 8
"""Maximum number of hops that do not close before another member of the pool is chosen."""

IMPROVEMENT_COUNT, IMPROVEMENT_HOP, IMPROVEMENT_SHARE = 14, 0.12, 0.85
"""Improvement of a converged linkage: number of attempts, initial standard deviation of the hops, and target share of
its size and link ratio."""


class Pool(NamedTuple):
    """Linkages that miss the positions, in ascending order of cost.

    Attributes
    ----------
    x : float, shape (POOL_SIZE, unknowns)
    costs : float, shape (POOL_SIZE,)
        Sums of squares; infinite for an empty place.
    settings : float, shape (POOL_SIZE, SETTING.size)
    starts : int, shape (POOL_SIZE,)
        Index of each linkage's first pose.
    """

    x: Real
    costs: Real
    settings: Real
    starts: NDArray[np.int64]


class ConvergedSixbars(NamedTuple):
    """Output arrays for linkages that meet the positions.

    Attributes
    ----------
    joints, makes, values, starts
        Joints in the first position, topology numbers, values
        (:func:`~synthesis.kinds.motion.sixbar.quality.evaluate_sixbar`) and indices of the first poses: shapes
        (most, 7), (most,), (most,), (most,).
    counts : int, shape (3,)
        Number of linkages; of descents; of steps in descents.
    """

    joints: Complex
    makes: NDArray[np.int64]
    values: Real
    starts: NDArray[np.int64]
    counts: NDArray[np.int64]


@njit(cache=True, nogil=True, error_model="numpy")
def copy_row(from_row: Real, row: Real) -> None:
    """Copy a row element by element; a slice assignment would take the compiler seconds."""
    for k in range(row.size):
        row[k] = from_row[k]


@njit(cache=True, nogil=True, error_model="numpy")
def _note_sides(x: Real, setting: Real) -> None:
    """Store the current assemblies of both dyads in the setting."""
    z = np.empty(7, np.complex128)
    for j in range(7):
        z[j] = complex(x[2 * j], x[2 * j + 1])
    setting[FIRST_SIDE] = math.copysign(1.0, compute_signed_sine(z[A], z[O4], z[B]))
    setting[SECOND_SIDE] = math.copysign(1.0, compute_signed_sine(z[Q1], z[Q2], z[J]))


class DescentBuffers(NamedTuple):
    """Work arrays of a descent: residuals, those of a trial, Jacobian, and the linear system of a step."""

    residuals: Real
    trial: Real
    jacobian: Real
    matrix: Real
    right: Real


@njit(cache=True, nogil=True, error_model="numpy")
def _evaluate_cost(x: Real, points: Real, setting: Real, room: DescentBuffers) -> float:
    """Return the sum of squared residuals; infinite if the linkage does not close."""
    # No rows of the Jacobian: only the residuals are computed.
    m = evaluate_residuals(x, points, setting, room.trial, room.jacobian[:0])
    cost = 0.0
    for k in range(m):
        cost += room.trial[k] ** 2
    # A negative row count means that the linkage does not close somewhere.
    return cost if m >= 0 else np.inf


@njit(cache=True, nogil=True, error_model="numpy")
def _solve_normal_step(m: int, damping: float, room: DescentBuffers, step: Real) -> bool:
    """Compute the damped step −(JᵀJ + μ)⁻¹ Jᵀr for more rows than unknowns; return False if it is singular."""
    n, jacobian = step.size, room.jacobian
    matrix = room.matrix[:n, :n]
    for i in range(n):
        step[i] = 0.0
        for j in range(i + 1):
            matrix[i, j] = damping if i == j else 0.0
    for row in range(m):
        for i in range(n):
            at = jacobian[row, i]
            # Most entries of a row are 0, so skipping them saves most products.
            if at != 0.0:
                step[i] -= at * room.residuals[row]
                for j in range(i + 1):
                    matrix[i, j] += at * jacobian[row, j]
    return bool(solve_positive(matrix, step))


@njit(cache=True, nogil=True, error_model="numpy")
def _solve_step(m: int, damping: float, room: DescentBuffers, step: Real) -> bool:
    """Compute the damped minimum-norm step −Jᵀ(JJᵀ + μ)⁻¹ r of m rows; return False if it is singular."""
    matrix, right, jacobian = room.matrix[:m, :m], room.right[:m], room.jacobian
    # Solve the smaller of the two equivalent systems.
    # With more rows than unknowns JJᵀ is singular without damping; otherwise it is the smaller system.
    if m > step.size:
        return _solve_normal_step(m, damping, room, step)
    for i in range(m):
        right[i] = room.residuals[i]
        for j in range(i + 1):
            total = damping if i == j else 0.0
            for k in range(step.size):
                total += jacobian[i, k] * jacobian[j, k]
            matrix[i, j] = total
    if not solve_positive(matrix, right):
        return False
    for k in range(step.size):
        step[k] = 0.0
    for i in range(m):
        for k in range(step.size):
            step[k] -= right[i] * jacobian[i, k]
    return True


@njit(cache=True, nogil=True, error_model="numpy")
def descend(
    x: Real, points: Real, setting: Real, room: DescentBuffers, counts: NDArray[np.int64], worth: float,
    steps: int = MAX_STEPS,
) -> float:  # fmt: skip
    """Descend in place by at most ``steps`` steps, while each block of ten lowers the cost below ``worth`` times it.

    Returns
    -------
    float
        The final sum of squares.
    """
    step, trial = np.empty(x.size), np.empty(x.size)
    cost = _evaluate_cost(x, points, setting, room)
    m = evaluate_residuals(x, points, setting, room.residuals, room.jacobian)
    before, damping = cost, INITIAL_DAMPING
    for n in range(steps):
        # Written so that NaN ends the descent, too.
        if not CONVERGED_COST < cost < np.inf or damping > MAX_DAMPING:
            break
        # A slow descent is left to basin hopping, which finds better minima in the same time.
        if n % BLOCK_SIZE == BLOCK_SIZE - 1:
            if cost > worth * before:
                break
            before = cost
        counts[2] += 1
        lower = np.inf
        if _solve_step(m, damping, room, step):
            longest = 0.0
            for k in range(x.size):
                longest = max(longest, abs(step[k]))
            # Cut long steps: beyond the maximum change the linearisation of the closures is not valid.
            share = min(1.0, MAX_CHANGE / longest)
            for k in range(x.size):
                trial[k] = x[k] + share * step[k]
            lower = _evaluate_cost(trial, points, setting, room)
        if lower < cost:
            copy_row(trial, x)
            cost = lower
            # A cut step says less about the model, so the damping falls more slowly.
            damping = max(damping * (FULL_STEP_FACTOR if share == 1.0 else CUT_STEP_FACTOR), MIN_DAMPING)
            m = evaluate_residuals(x, points, setting, room.residuals, room.jacobian)
        else:
            # Reject the step and shorten the next one.
            damping *= REJECTION_FACTOR
    return cost


@njit(cache=True, nogil=True, error_model="numpy")
def select_first_pose(poses: Poses, start: int, setting: Real, points: Real) -> None:
    """Select a first pose, and write the later positions with their angles relative to it."""
    setting[FIRST_X], setting[FIRST_Y] = poses.first[start, POSE_X], poses.first[start, POSE_Y]
    for k in range(len(poses.later)):
        copy_row(poses.later[k], points[k])
        # Angles relative to the first pose, which each linkage chooses for itself.
        points[k, POSE_ANGLE] -= poses.first[start, POSE_ANGLE]


@njit(cache=True, nogil=True, error_model="numpy")
def _sample_linkage(
    rng: np.random.Generator, x: Real, points: Real, setting: Real, cranks: Complex, room: DescentBuffers
) -> float:
    """Sample a few random linkages that close and keep the one with the lowest cost; return that cost."""
    trial, best, found = np.empty(x.size), np.inf, 0
    centre = complex(setting[FIRST_X], setting[FIRST_Y])
    intervals = x.size - JOINT_COORDINATE_COUNT
    for k in range(intervals):
        centre += complex(points[k, POSE_X], points[k, POSE_Y])
    centre /= intervals + 1
    side = np.empty(setting.size)
    # Most random linkages do not close over the whole rotation, hence the many tries.
    for _ in range(MAX_TRIES):
        copy_row(setting, side)
        # Logarithmically uniform: small and large linkages are sampled alike.
        spread = MIN_SPREAD * (MAX_SPREAD / MIN_SPREAD) ** rng.random()
        for j in range(JOINT_COORDINATE_COUNT):
            trial[j] = (centre.imag if j % 2 else centre.real) + spread * rng.normal()
        if int(setting[TOPOLOGY]) == STEPHENSON_2 and len(cranks) > 0:
            # Exact positions admit only a few cranks between body and ground: start from one of them.
            row = int(rng.random() * len(cranks))
            trial[2 * Q1], trial[2 * Q1 + 1] = cranks[row, 0].real, cranks[row, 0].imag
            trial[2 * J], trial[2 * J + 1] = cranks[row, 1].real, cranks[row, 1].imag
        turn = MIN_START_TURN + (MAX_START_TURN - MIN_START_TURN) * rng.random()
        total = 0.0
        for k in range(JOINT_COORDINATE_COUNT, x.size):
            # Random shares of the rotation between the positions; none is nearly 0.
            trial[k] = 0.2 + 0.8 * rng.random()
            total += trial[k]
        for k in range(JOINT_COORDINATE_COUNT, x.size):
            trial[k] = math.log(turn * trial[k] / total)
        # Whatever assemblies the sample has are its branch.
        _note_sides(trial, side)
        cost = _evaluate_cost(trial, points, side, room)
        if cost < np.inf:
            found += 1
            if cost < best:
                best = cost
                copy_row(trial, x)
                setting[FIRST_SIDE], setting[SECOND_SIDE] = side[FIRST_SIDE], side[SECOND_SIDE]
            if found == PICK_COUNT:
                break
    return float(best)


@njit(cache=True, nogil=True, error_model="numpy")
def _perturb_linkage(rng: np.random.Generator, x: Real, spread: float, setting: Real, poses: Poses, to: Real) -> None:
    """Perturb a linkage at random, except for a Stephenson II's crank between body and ground, which is isolated."""
    for k in range(x.size):
        to[k] = x[k] + spread * rng.normal()
    # A step would leave the isolated cranks, which are exact solutions of their own conditions.
    if int(setting[TOPOLOGY]) == STEPHENSON_2 and len(poses.cranks) > 0:
        for j in (Q1, J):
            to[2 * j], to[2 * j + 1] = x[2 * j], x[2 * j + 1]


@njit(cache=True, nogil=True, error_model="numpy")
def _optimize_value(
    rng: np.random.Generator,
    x: Real,
    points: Real,
    setting: Real,
    poses: Poses,
    joints: Complex,
    value: float,
    room: DescentBuffers,
    counts: NDArray[np.int64],
) -> float:
    """Improve a linkage's value by hops that return to the positions; return the new value."""
    trial, other, aims = np.empty(x.size), np.empty(7, np.complex128), np.empty(setting.size)
    spread = IMPROVEMENT_HOP
    angle = math.acos(setting[COSINE])
    reach, ratio = setting[REACH], setting[RATIO]
    for n in range(IMPROVEMENT_COUNT):
        copy_row(setting, aims)
        # Every third attempt keeps the aims, so that the input's rotation and the body's path may improve instead.
        if n % 3:
            aims[COSINE] = math.cos(min(angle + 0.1, 1.4))
            aims[REACH], aims[RATIO] = IMPROVEMENT_SHARE * reach, IMPROVEMENT_SHARE * ratio
        _perturb_linkage(rng, x, spread, setting, poses, trial)
        _note_sides(trial, aims)
        if descend(trial, points, aims, room, counts, MAX_COST_RATIO) < CONVERGED_COST:
            better = evaluate_sixbar(trial, points, aims, poses, other)
            if better > value:
                value = better
                copy_row(trial, x)
                for k in range(len(other)):
                    joints[k] = other[k]
                setting[FIRST_SIDE], setting[SECOND_SIDE] = aims[FIRST_SIDE], aims[SECOND_SIDE]
                # Tighten the aims to what was reached; other attempts left them unchanged.
                if n % 3:
                    angle, reach, ratio = math.acos(aims[COSINE]), aims[REACH], aims[RATIO]
                continue
        # Failure: the next attempt stays nearer.
        spread *= 0.8
    return value


@njit(cache=True, nogil=True, error_model="numpy")
def _insert_in_pool(pool: Pool, n: int, x: Real, cost: float, setting: Real, start: int) -> None:
    """Replace the n-th linkage of the pool and move the new one up to its rank by cost."""
    # Insertion sort from the end: the pool is small and nearly sorted.
    while n > 0 and pool.costs[n - 1] > cost:
        copy_row(pool.x[n - 1], pool.x[n])
        copy_row(pool.settings[n - 1], pool.settings[n])
        pool.costs[n], pool.starts[n] = pool.costs[n - 1], pool.starts[n - 1]
        n -= 1
    copy_row(x, pool.x[n])
    copy_row(setting, pool.settings[n])
    pool.costs[n], pool.starts[n] = cost, start


@njit(cache=True, nogil=True, error_model="numpy")
def _store_sixbar(joints: Complex, make: int, value: float, start: int, arrived: ConvergedSixbars) -> None:
    """Append a sixbar to the output."""
    n = int(arrived.counts[0])
    for k in range(len(joints)):
        arrived.joints[n, k] = joints[k]
    arrived.makes[n], arrived.values[n], arrived.starts[n] = make, value, start
    arrived.counts[0] = n + 1


@njit(cache=True, nogil=True, error_model="numpy")
def run_descents(
    rng: np.random.Generator,
    descents: int,
    makes: NDArray[np.int64],
    plain: Real,
    poses: Poses,
    pool: Pool,
    arrived: ConvergedSixbars,
) -> None:
    """Run descents from new random linkages and from hops of the pool.

    Parameters
    ----------
    rng : Generator
    descents : int
        Number of descents.
    makes : int, shape (n,)
        Topology numbers to sample from, repeated by weight.
    plain : float, shape (SETTING.size,)
        The limits; entries that belong to a linkage are filled in.
    poses, pool, arrived
        Target poses; pool, updated in place; output.
    """
    unknowns = JOINT_COORDINATE_COUNT + len(poses.later)
    x, setting, points = np.empty(unknowns), np.empty(plain.size), np.empty(poses.later.shape)
    most = count_max_rows(len(poses.later) + 1)
    room = DescentBuffers(
        np.empty(most), np.empty(most), np.empty((most, unknowns)), np.empty((most, most)), np.empty(most)
    )
    joints = np.empty(7, np.complex128)
    for _ in range(descents):
        # The output arrays are full.
        if arrived.counts[0] == len(arrived.makes):
            return
        parent, start, cost = POOL_SIZE, 0, np.inf
        # The pool must be full before hops may start from it.
        if rng.random() < FRESH_SHARE or not pool.costs[POOL_SIZE - 1] < np.inf:
            start = int(rng.random() * len(poses.first))
            copy_row(plain, setting)
            setting[TOPOLOGY] = makes[int(rng.random() * len(makes))]
            setting[INPUT_DIRECTION] = 1.0 if rng.random() < 0.5 else -1.0
            select_first_pose(poses, start, setting, points)
            cost = _sample_linkage(rng, x, points, setting, poses.cranks, room)
        else:
            # Squaring the random number prefers the better members.
            parent = int(POOL_SIZE * rng.random() ** 2)
            start = int(pool.starts[parent])
            copy_row(pool.settings[parent], setting)
            select_first_pose(poses, start, setting, points)
            spread = MIN_HOP * (MAX_HOP / MIN_HOP) ** rng.random()
            # A hop may open the linkage; another random step often closes it.
            for _hop in range(MAX_FAILED_HOPS):
                _perturb_linkage(rng, pool.x[parent], spread, setting, poses, x)
                _note_sides(x, setting)
                cost = _evaluate_cost(x, points, setting, room)
                if cost < np.inf:
                    break
        # Neither start closed; the descent counts only linkages that do.
        if not cost < np.inf:
            continue
        arrived.counts[1] += 1
        cost = descend(x, points, setting, room, arrived.counts, MAX_COST_RATIO)
        if cost < CONVERGED_COST:
            # Negative values are infeasible beyond repair by small hops.
            value = evaluate_sixbar(x, points, setting, poses, joints)
            if value >= 0.0:
                value = _optimize_value(rng, x, points, setting, poses, joints, value, room, arrived.counts)
            _store_sixbar(joints, int(setting[TOPOLOGY]), value, start, arrived)
        # A fresh linkage replaces the worst of the pool, a hop only its own parent, which keeps the pool diverse.
        elif parent == POOL_SIZE:
            if cost < pool.costs[POOL_SIZE - 1]:
                _insert_in_pool(pool, POOL_SIZE - 1, x, cost, setting, start)
        elif cost < pool.costs[parent]:
            _insert_in_pool(pool, parent, x, cost, setting, start)
