"""Rounds of descents for one problem, which find sixbars and stay on their branch.

The descents are those of :mod:`synthesis.kinds.motion.sixbar.basin_hopping`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.sixbar import basin_hopping as walk
from synthesis.kinds.motion.sixbar import candidate_value
from synthesis.kinds.motion.sixbar import least_squares as fit
from synthesis.kinds.motion.sixbar import residuals as rows
from synthesis.kinds.motion.sixbar.chain_kernels import POSITION_COUNT
from synthesis.kinds.motion.sixbar.dyad_assembly import STEPHENSON_2
from synthesis.kinds.motion.sixbar.quality import Poses
from synthesis.kinds.motion.sixbar.random_chains import compute_needed_motion
from synthesis.kinds.motion.sixbar.relative_dyads import MAX_DYADS, compute_relative_poses, solve_relative_dyads
from synthesis.kinds.motion.sixbar.topologies import SixbarCandidates
from synthesis.kinds.motion.statement.positions import MAX_EXACT_POSITIONS
from synthesis.kinds.motion.task.positions import MotionTask
from synthesis.kinds.motion.task.target_poses import TargetPoses

DESCENTS_PER_ROUND = 1500
"""Number of descents per round for up to five positions, about a third of a second; with more positions the number is
reduced in proportion."""

MAX_KEPT = 400
"""Maximum number of linkages kept per round."""

SAMPLING_WEIGHTS = 4, 4, 3, 1, 1, 1, 1, 2
"""Sampling weight of each topology: largest for those that carry a body through most positions."""

FIRST_POSE_COUNT = 64
"""Number of sampled first poses if the first position has a tolerance; every other one is the target itself."""

REPETITION_TOLERANCE = 1e-9
"""Smallest singular value of the conditions on a crank, relative to the largest, below which they are dependent."""

TOLERANCE_SHARE = 0.98
"""Share of a tolerance that is used; the rest covers rounding and the steps of the drive."""


class LimitMargins(NamedTuple):
    """Margins of a descent from its limits, so that these also hold between the steps of its drive.

    Attributes
    ----------
    angle : float
        Radians added to the minimum transmission angle.
    size : float
        Share of the size limits that is used.
    shortest : float
        Factor of the minimum link length of any sixbar.
    """

    angle: float
    size: float
    shortest: float


AIM_MARGINS, BARE_MARGINS = LimitMargins(math.radians(2.0), 0.96, 1.5), LimitMargins(math.radians(0.02), 0.9999, 1.0)
"""Margins that descents aim at, and minimal ones: the limits themselves, apart from the motion between samples."""

RELAXED_ANGLE, RELAXED_SIZE_FACTOR = math.radians(7.0), 3.0
"""Relaxed defaults: the transmission angle, radians, and the factor of the size limits, if the client gives none."""


class BranchSearch:
    """Rounds of descents for one problem.

    Attributes
    ----------
    descents : int
        Number of descents so far.
    """

    def __init__(
        self, problem: MotionProblem, task: MotionTask, target: TargetPoses, requested: NDArray[np.bool_], limits: Real
    ) -> None:
        exactly = len(target.exact_mask) == POSITION_COUNT and bool(target.exact_mask.all())
        # A family of cranks does not exclude a Stephenson II, and cannot be listed.
        exactly = exactly and not _has_many_cranks(task)
        self.cranks = _find_cranks(task) if exactly else np.empty((0, 2), np.complex128)
        # Only requested topologies are sampled.
        drawn = np.where(requested, SAMPLING_WEIGHTS, 0)
        # A Stephenson II contains a crank between body and ground: without a crank through five poses none exists.
        if exactly and not len(self.cranks):
            drawn[STEPHENSON_2] = 0
        self.makes = np.repeat(np.arange(len(requested)), drawn)
        self.first, self.later = _sample_poses(problem, task, target, np.random.default_rng(problem.seed))
        self.exact_mask: NDArray[np.bool_] = np.all(target.exact_mask, axis=1)
        self.each = math.ceil(DESCENTS_PER_ROUND * min(1.0, MAX_EXACT_POSITIONS / len(self.exact_mask)))
        self.needed, self.limits = compute_needed_motion(task), limits
        # Two pools: with the limits, and without the default ones; a round uses one of them.
        self.settings = (
            _make_aims(problem, limits, AIM_MARGINS, relaxed=False),
            _make_aims(problem, limits, AIM_MARGINS, relaxed=True),
        )
        self.bare = _make_aims(problem, limits, BARE_MARGINS, relaxed=False)
        self.pools = _make_empty_pool(len(self.later)), _make_empty_pool(len(self.later))
        self.descents = 0

    def round(self, rng: np.random.Generator, *, relaxed: bool) -> SixbarCandidates:
        """Run another round on the current pool; ``relaxed`` drops the default limits."""
        if not len(self.makes):
            return SixbarCandidates.make_empty()
        joints, makes = np.empty((MAX_KEPT, 7), np.complex128), np.empty(MAX_KEPT, np.int64)
        starts, counts = np.empty(MAX_KEPT, np.int64), np.zeros(3, np.int64)
        arrived = walk.ConvergedSixbars(joints, makes, np.empty(MAX_KEPT), starts, counts)
        poses = Poses(self.first, self.later, self.needed, self.limits, self.cranks)
        walk.run_descents(rng, self.each, self.makes, self.settings[relaxed], poses, self.pools[relaxed], arrived)
        self.descents += int(counts[1])
        n = int(counts[0])
        own = starts[:n]
        places = self.first[own, 0] + 1j * self.first[own, 1]
        return SixbarCandidates(makes[:n], joints[:n], places, self.first[own, 2], arrived.values[:n])

    @property
    def min_cost(self) -> float:
        """The minimum sum of squares in both pools, with and without the default limits."""
        return min(float(pool.costs[0]) for pool in self.pools)

    def fit_pools(self) -> SixbarCandidates:
        """Fit the linkages of the pools by least squares until convergence, then empty the pools."""
        found = SixbarCandidates.make_empty()
        poses = Poses(self.first, self.later, self.needed, self.limits, self.cranks)
        for pool in self.pools:
            ends = SixbarCandidates.allocate(len(pool.costs))
            n = int(fit.fit_pool(poses, self.exact_mask, pool, self.bare, ends))
            found = found.merge(ends.select_rows(np.arange(n)))
            # The pool's members have been used; the next descents refill it.
            pool.costs[:] = np.inf
        return found


def _has_many_cranks(task: MotionTask) -> bool:
    """Return whether the conditions on a crank are dependent, as for a body that turns about one point.

    There is a family of cranks then, which :func:`solve_relative_dyads` does not return. With O on the ground and A on
    the body in the first position, |r A + c − O|² = |A − O|² is linear in A, O and A Ō.
    """
    r = task.turns[1:]
    c = task.points[1:] - r * task.points[0]
    on_a = 2.0 * c.conj() * r
    rows = np.stack([on_a.real, -on_a.imag, -2 * c.real, -2 * c.imag, -2 * (r - 1).real, 2 * r.imag, abs(c) ** 2])
    return bool(np.linalg.matrix_rank(rows, tol=REPETITION_TOLERANCE * np.linalg.norm(rows, 2)) < len(r))


def _find_cranks(task: MotionTask) -> NDArray[np.complex128]:
    """Find the cranks between body and ground: pins on the body and on the ground, shape (n, 2).

    A Stephenson II contains one of them.
    """
    still, upright = np.zeros(POSITION_COUNT, np.complex128), np.ones(POSITION_COUNT, np.complex128)
    shift, spin = np.empty_like(still), np.empty_like(still)
    fixed, moving = np.empty(MAX_DYADS, np.complex128), np.empty(MAX_DYADS, np.complex128)
    compute_relative_poses(still, upright, task.points, task.turns, shift, spin)
    none = complex(math.nan, math.nan)
    n = int(solve_relative_dyads(shift, spin, none, none, fixed, moving))
    return np.stack([moving[:n], fixed[:n]], axis=1)


def _sample_poses(
    problem: MotionProblem, task: MotionTask, target: TargetPoses, rng: np.random.Generator
) -> tuple[Real, Real]:
    """Sample first poses and pack later poses in the form of :class:`~synthesis.kinds.motion.sixbar.quality.Poses`."""
    unit = np.array([target.size, target.size, 1.0])
    first = (
        rng.uniform(-1.0, 1.0, (FIRST_POSE_COUNT, 3))
        * TOLERANCE_SHARE
        * np.where(np.isfinite(target.limits[0]), target.limits[0], 0)
    )
    # Every other first pose is the target itself, which is always permitted.
    first[::2] = 0.0
    places = np.stack([task.points.real, task.points.imag, np.angle(task.turns)], axis=1)
    # Infinite tolerances mark fitted coordinates, which aim at the target.
    off = np.where(np.isfinite(target.limits), TOLERANCE_SHARE * target.limits / unit, 0.0)
    weights = np.ones((len(places), 1)) * (1.0, rows.ANGLE_WEIGHT)
    if problem.is_least_squares:
        # Exact positions weigh more in a fit, so that they are nearly met before the final projection.
        weights[np.all(target.exact_mask, axis=1)] *= fit.EXACT_WEIGHT
    poses = np.empty((len(places), rows.POSE.size))
    poses[:, rows.POSE.slice("x", "angle")] = places
    poses[:, rows.POSE_TOLERANCES] = off
    poses[:, rows.POSE.slice("point_weight", "angle_weight")] = weights
    return first / unit, poses[1:]


def _make_aims(problem: MotionProblem, limits: Real, aside: LimitMargins, *, relaxed: bool) -> Real:
    """Pack the limits that descents aim at into a setting (:mod:`synthesis.kinds.motion.sixbar.residuals`)."""
    aims = np.zeros(rows.SETTING.size)
    angle = math.asin(limits[candidate_value.MIN_SINE]) + aside.angle
    reach, ratio = limits[[candidate_value.MAX_REACH, candidate_value.MAX_RATIO]]
    if relaxed:
        # Only defaults are relaxed; limits of the client stay.
        angle = RELAXED_ANGLE if problem.constraints.min_transmission_angle is None else angle
        ratio *= RELAXED_SIZE_FACTOR if problem.constraints.max_link_ratio is None else 1.0
        reach *= RELAXED_SIZE_FACTOR
    aims[rows.COSINE], aims[rows.REACH], aims[rows.RATIO] = math.cos(angle), aside.size * reach, aside.size * ratio
    aims[rows.SHORTEST] = max(
        aside.shortest * candidate_value.MIN_LINK_LENGTH, limits[candidate_value.MIN_LENGTH] / aside.size
    )
    aims[rows.LONGEST] = aside.size * limits[candidate_value.MAX_LENGTH]
    # The boxes have the same order in both arrays.
    aims[rows.BOXES] = limits[candidate_value.BOXES]
    return aims


def _make_empty_pool(later: int) -> walk.Pool:
    unknowns = rows.JOINT_COORDINATE_COUNT + later
    settings = np.zeros((walk.POOL_SIZE, rows.SETTING.size))
    return walk.Pool(
        np.zeros((walk.POOL_SIZE, unknowns)),
        np.full(walk.POOL_SIZE, np.inf),
        settings,
        np.zeros(walk.POOL_SIZE, np.int64),
    )
