"""Least-squares fit of sixbars to more positions than they can meet, from the pool of branch-preserving descents.

Eight positions determine a sixbar. If more are fitted, or if the constraints exclude exact solutions, the linkages with
the lowest cost (:class:`~synthesis.kinds.motion.sixbar.basin_hopping.Pool`) are descended until their least squares
converge, with the first pose among the unknowns. Exact positions have a larger weight there and are finally met by
minimum-norm steps.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from kinematics.compiling import njit
from synthesis.kinds.motion.sixbar.basin_hopping import (
    CONVERGED_COST,
    DescentBuffers,
    Pool,
    copy_row,
    descend,
    select_first_pose,
)
from synthesis.kinds.motion.sixbar.quality import Poses, evaluate_sixbar
from synthesis.kinds.motion.sixbar.residuals import (
    ANGLE_WEIGHT_INDEX,
    BOXES,
    COSINE,
    FIRST_X,
    FIRST_Y,
    FREE_POSE_SIZE,
    INPUT_DIRECTION,
    JOINT_COORDINATE_COUNT,
    LONGEST,
    POINT_WEIGHT_INDEX,
    POSE_ANGLE,
    POSE_TOLERANCES,
    POSE_X,
    POSE_Y,
    RATIO,
    REACH,
    SCALAR_LIMITS,
    SHORTEST,
    TARGET_X,
    TARGET_Y,
    TOPOLOGY,
    compute_dimensions,
    count_max_rows,
    drive_linkage,
)
from synthesis.kinds.motion.sixbar.topologies import SixbarCandidates

FIT_WEIGHT, EXACT_WEIGHT = 0.1, 10.0
"""Weights relative to the limits, small so that these take precedence: of a fitted pose, and the additional factor of
an exact pose."""

MAX_COST_RATIO, MAX_DESCENTS, MAX_STEPS = 0.99, 4, 500
"""Maximum share of the cost left after ten steps; maximum number of consecutive descents; maximum number of steps of
each."""

EXACT_FIT_COST = 1e-14
"""Sum of squares below which a fit counts as meeting all positions."""

IGNORED_TOLERANCE = 1e6
"""Tolerance that disables a coordinate."""

ERROR_PENALTY = 100.0
"""Penalty of the error in a fit's value: an error of a hundredth of the task's size halves the bonus for accuracy."""


@njit(cache=True, nogil=True, error_model="numpy")
def compute_fit_value(error: float) -> float:
    """Return the value of a feasible fit: 2 if it meets all positions, decreasing towards 1 with the error."""
    return 1.0 + 1.0 / (1.0 + ERROR_PENALTY * error)


@njit(cache=True, nogil=True, error_model="numpy")
def _compute_rms_error(x: Real, points: Real, setting: Real, free: int) -> float:
    """Return the RMS over the positions of P's distance, in task sizes, and the body's angle, radians, together."""
    z, at, turns = np.empty(7, np.complex128), np.empty(6, np.complex128), np.empty(4, np.complex128)
    lengths, inverses = np.empty(4), np.empty(4, np.complex128)
    for j in range(7):
        z[j] = complex(x[2 * j], x[2 * j + 1])
    compute_dimensions(z, lengths, inverses)
    # If the first pose is fitted, it adds its own error, and rotations are relative to it.
    stands = x[free + 2] if free > 0 else 0.0
    total = (setting[FIRST_X] - setting[TARGET_X]) ** 2 + (setting[FIRST_Y] - setting[TARGET_Y]) ** 2 + stands**2
    angle = 0.0
    for k in range(len(points)):
        angle += math.exp(x[JOINT_COORDINATE_COUNT + k])
        drive_linkage(z, lengths, inverses, setting, setting[INPUT_DIRECTION] * angle, at, turns)
        back = turns[3] * complex(math.cos(points[k, POSE_ANGLE]), -math.sin(points[k, POSE_ANGLE]))
        total += (at[5].real - points[k, POSE_X]) ** 2 + (at[5].imag - points[k, POSE_Y]) ** 2
        total += (math.atan2(back.imag, back.real) + stands) ** 2
    return math.sqrt(total / (len(points) + 1))


@njit(cache=True, nogil=True, error_model="numpy")
def _project_on_exact(
    x: Real, points: Real, setting: Real, exact_mask: NDArray[np.bool_], room: DescentBuffers
) -> bool:
    """Move a linkage onto the exact positions, ignoring its limits; return whether that succeeds."""
    only, free = points.copy(), setting.copy()
    for k in range(len(points)):
        # Full weight on exact positions; the others get a tolerance that disables them.
        only[k, POINT_WEIGHT_INDEX], only[k, ANGLE_WEIGHT_INDEX] = 1.0, 1.0
        if not exact_mask[k + 1]:
            only[k, POSE_TOLERANCES] = IGNORED_TOLERANCE
    # Without limits, because the projection is a tiny step; the evaluation checks them again.
    free[COSINE], free[REACH], free[RATIO], free[SHORTEST], free[LONGEST] = 1.0, np.inf, np.inf, 0.0, np.inf
    sides = free[BOXES]
    for n in range(sides.size):
        sides[n] = np.inf if n % 2 else -np.inf
    counts = np.zeros(3, np.int64)
    return bool(descend(x, only, free, room, counts, MAX_COST_RATIO) < CONVERGED_COST)


@njit(cache=True, nogil=True, error_model="numpy")
def _minimize_cost(x: Real, points: Real, setting: Real, room: DescentBuffers) -> float:
    """Minimize the least squares in place until convergence; return the sum of squares."""
    counts, before = np.zeros(3, np.int64), np.inf
    cost = before
    for _ in range(MAX_DESCENTS):
        cost = descend(x, points, setting, room, counts, MAX_COST_RATIO, MAX_STEPS)
        # A descent stops when it slows down; start it again with fresh damping until nothing is gained.
        if not cost < MAX_COST_RATIO * before:
            break
        before = cost
    return cost


@njit(cache=True, nogil=True, error_model="numpy")
def _retry_at_bare_limits(x: Real, points: Real, setting: Real, bare: Real, poses: Poses, room: DescentBuffers) -> None:
    """Retry, in place, without the margins, in case the positions can be met within the limits themselves."""
    if setting[COSINE] > bare[COSINE]:
        return  # a relaxed start has wider aims than the limits already
    further, limits, joints = x.copy(), setting.copy(), np.empty(7, np.complex128)
    copy_row(bare[SCALAR_LIMITS], limits[SCALAR_LIMITS])
    met = _minimize_cost(further, points, limits, room) < EXACT_FIT_COST
    # Accept only feasible linkages: the retry had no margins for the motion between samples.
    if met and evaluate_sixbar(further, points, limits, poses, joints) >= 1.0:
        for k in range(len(x)):
            x[k] = further[k]


@njit(cache=True, nogil=True, error_model="numpy")
def fit_pool(poses: Poses, exact_mask: NDArray[np.bool_], pool: Pool, bare: Real, found: SixbarCandidates) -> int:
    """Fit all linkages of a pool until convergence.

    Parameters
    ----------
    poses : Poses
        Target poses.
    exact_mask : bool, shape (n,)
        Mask of the exact positions.
    pool : Pool
        Starting points.
    bare : float, shape (SETTING.size,)
        The limits without the margins of the starts' aims.
    found : SixbarCandidates
        Output.

    Returns
    -------
    int
        Number of linkages written.
    """
    later = len(poses.later)
    # A fitted first pose adds three unknowns.
    unknowns = JOINT_COORDINATE_COUNT + later + (0 if exact_mask[0] else FREE_POSE_SIZE)
    free = -1 if exact_mask[0] else JOINT_COORDINATE_COUNT + later
    x, setting, points = np.empty(unknowns), np.empty(bare.size), np.empty(poses.later.shape)
    most = count_max_rows(later + 1)
    room = DescentBuffers(
        np.empty(most), np.empty(most), np.empty((most, unknowns)), np.empty((most, most)), np.empty(most)
    )
    joints = np.empty(7, np.complex128)
    n = 0
    for row in range(len(pool.costs)):
        # An empty place of the pool.
        if not pool.costs[row] < np.inf:
            continue
        copy_row(pool.settings[row], setting)
        select_first_pose(poses, pool.starts[row], setting, points)
        setting[TARGET_X], setting[TARGET_Y] = setting[FIRST_X], setting[FIRST_Y]
        for k in range(later):
            weight = FIT_WEIGHT * (EXACT_WEIGHT if exact_mask[k + 1] else 1.0)
            points[k, POINT_WEIGHT_INDEX] = points[k, ANGLE_WEIGHT_INDEX] = weight
        for k in range(JOINT_COORDINATE_COUNT + later):
            x[k] = pool.x[row, k]
        if free > 0:
            x[free], x[free + 1], x[free + 2] = setting[FIRST_X], setting[FIRST_Y], 0.0
        if _minimize_cost(x, points, setting, room) > EXACT_FIT_COST:
            _retry_at_bare_limits(x, points, setting, bare, poses, room)
        # A weight alone leaves a small error at exact positions; these steps remove it.
        if exact_mask.any() and not _project_on_exact(x, points, setting, exact_mask, room):
            continue
        if free > 0:
            setting[FIRST_X], setting[FIRST_Y] = x[free], x[free + 1]
        value = evaluate_sixbar(x, points, setting, poses, joints)
        error = _compute_rms_error(x, points, setting, free)
        found.makes[n] = int(setting[TOPOLOGY])
        for k in range(7):
            found.joints[n, k] = joints[k]
        found.bodies[n] = complex(setting[FIRST_X], setting[FIRST_Y])
        found.stands[n] = x[free + 2] if free > 0 else 0.0
        # Fits without tolerance are ranked by their error, not by quality.
        found.values[n] = compute_fit_value(error) if value >= 1.0 else value
        n += 1
    return n
