"""Starting points of the chain search: sampled chains, and sampled poses of the body between the target positions."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from synthesis.kinds.motion.sixbar.chain_kernels import POSITION_COUNT
from synthesis.kinds.motion.statement.mechanism_types import Chain
from synthesis.kinds.motion.task.positions import MotionTask
from synthesis.kinds.motion.task.target_poses import TargetPoses
from synthesis.model.linkage.problem import Region
from synthesis.model.problem import PartialPoint

BODY_SPREADS = np.array([0.3, 0.6, 1.2])
"""Standard deviations of H₂ around P, in task sizes; one is chosen at random."""

PIVOT_SPREAD = 1.0
"""Standard deviation of G around the positions, in task sizes."""

MEAN_EXCESS = 0.5
"""Mean excess of the links' total length over the maximum reach, relative to it; the excess is at least 2 %."""

MAX_LENGTH_DIFFERENCE = 0.98
"""Maximum difference of the links' lengths, relative to the minimum reach."""

PIVOT_TRIES, MIN_LENGTH = 24, 0.05
"""Number of ground pivots tried if a length is given, and minimum of an open length, in task sizes."""

POSE_SPREAD = 0.15
"""Standard deviation of a sampled pose from the straight path between two targets, in task sizes and radians."""


class PoseSample(NamedTuple):
    """Five poses of the body for each of n chains, task coordinates: target poses and sampled ones.

    ``points``, ``turns`` (n, 5), complex, with rotations from the first of these poses; ``demanded`` (5,), mask of the
    targets; ``stands`` (n,), rotation of the first pose from its target, radians.
    """

    points: Complex
    turns: Complex
    demanded: NDArray[np.bool_]
    stands: Real


def sample_poses(task: MotionTask, target: TargetPoses, rng: np.random.Generator, count: int) -> PoseSample:
    """Sample poses within the tolerances (every other set exactly), and add poses between them up to five."""
    n = len(task.points)
    # Infinite tolerances mark fitted coordinates; they get no deviation here.
    deviations = rng.uniform(-1.0, 1.0, (count, n, 3)) * np.where(np.isfinite(target.limits), target.limits, 0.0)
    # Every other set meets the targets exactly, so that tolerances never make a solvable problem harder.
    deviations[::2] = 0.0
    points = task.points + (deviations[..., 0] + 1j * deviations[..., 1]) / target.size
    angles = np.angle(task.turns) + deviations[..., 2]
    demanded = np.ones(POSITION_COUNT, np.bool_)
    if n < POSITION_COUNT:
        # Distribute the additional poses among the intervals at random.
        between = np.sort(rng.integers(0, n - 1, POSITION_COUNT - n))
        places = np.sort(np.concatenate([np.arange(n), between + 0.5]), kind="stable")
        demanded = places == np.floor(places)
        before = np.floor(places).astype(np.int64)
        after = np.minimum(before + 1, n - 1)
        share = np.where(demanded, 0.0, np.sort(rng.uniform(0.15, 0.85, (count, POSITION_COUNT)), axis=1))
        off = np.where(demanded, 0.0, POSE_SPREAD) * rng.normal(size=(3, count, POSITION_COUNT))
        # The shorter rotation between the two targets.
        step = np.angle(np.exp(1j * (angles[:, after] - angles[:, before])))
        points = points[:, before] + share * (points[:, after] - points[:, before]) + off[0] + 1j * off[1]
        angles = angles[:, before] + share * step + off[2]
    # All rotations are measured from the sampled first pose.
    return PoseSample(points, np.exp(1j * (angles - angles[:, :1])), demanded, angles[:, 0])


def sample_chains(
    task: MotionTask, poses: PoseSample, requested: Chain, region: Region | None, rng: np.random.Generator
) -> tuple[Real, Real]:
    """Sample chains that reach all poses, as rows (n, 7) of
    :func:`synthesis.kinds.motion.sixbar.chain_kernels.search_chains`.

    The second value has shape (6,): 1 for coordinates and lengths that may vary, 0 for given ones.
    """
    count = len(poses.points)
    free = np.ones(6)
    one, two = (None if length is None else length / task.size for length in requested.links or (None, None))
    pin = poses.points[:, 0] + rng.choice(BODY_SPREADS, count) * _sample_spread(rng, count)
    pin = _apply_given(task, requested.moving_pivot, pin, free[2:4])
    end = poses.points + poses.turns * (pin - poses.points[:, 0])[:, None]
    # Sample several pivots per chain, and take the first from which links of given lengths reach all poses.
    tries = 1 if one is None and two is None else PIVOT_TRIES
    pivots = poses.points.mean() + PIVOT_SPREAD * _sample_spread(rng, tries * count)
    if region is not None:
        pivots = np.array([task.to_task(complex(z)) for z in region.sample_points(rng, tries * count)])
    pivots = _apply_given(task, requested.fixed_pivot, pivots, free[:2]).reshape(tries, count)
    reach = np.abs(end - pivots[..., None])
    near, far = reach.min(axis=2), reach.max(axis=2)
    # argmax gives the first pivot that fits, or the first of all if none does.
    chosen = _check_reach(near, far, one, two).argmax(axis=0), np.arange(count)
    pivot, near, far = pivots[chosen], near[chosen], far[chosen]
    # Both links together must exceed the farthest position by at least 2 %, or the elbow is straight there.
    total = far * (1.02 + rng.exponential(MEAN_EXCESS, count))
    # Their difference must stay below the nearest position.
    first = 0.5 * (total + MAX_LENGTH_DIFFERENCE * near * rng.uniform(-1.0, 1.0, count))
    second = total - first
    share = rng.uniform(0.0, 1.0, count)
    if one is not None:
        # The other link must reach from the nearest to the farthest position.
        first, free[4] = np.full(count, one), 0.0
        second = np.maximum(far - one, MIN_LENGTH) + share * (one + near - np.maximum(far - one, MIN_LENGTH))
    if two is not None:
        second, free[5] = np.full(count, two), 0.0
        if one is None:
            first = np.maximum(far - two, MIN_LENGTH) + share * (two + near - np.maximum(far - two, MIN_LENGTH))
    elbow = np.where(rng.random(count) < 0.5, 1.0, -1.0)
    if requested.elbow != "any":
        elbow[:] = 1.0 if requested.elbow == "left" else -1.0
    return np.stack([pivot.real, pivot.imag, pin.real, pin.imag, first, second, elbow], axis=1), free


def _check_reach(near: Real, far: Real, one: float | None, two: float | None) -> NDArray[np.bool_]:
    """Return whether links of given lengths reach all distances between the minimum and the maximum."""
    if one is None and two is None:
        return np.ones(near.shape, np.bool_)
    if one is None or two is None:
        return np.asarray(far - near < 2.0 * (one or two or 0.0))
    return np.asarray((abs(one - two) < near) & (far < one + two))


def _sample_spread(rng: np.random.Generator, count: int) -> Complex:
    return np.asarray(rng.normal(size=count) + 1j * rng.normal(size=count))


def _apply_given(task: MotionTask, requested: PartialPoint | None, drawn: Complex, free: Real) -> Complex:
    """Replace coordinates of sampled points by given ones, for which ``free`` is set to 0."""
    if requested is None:
        return drawn
    x, y = (
        None if at is None else (at - o) / task.size for at, o in zip(requested, _to_pair(task.origin), strict=True)
    )
    free[:] = x is None, y is None
    return np.asarray((drawn.real if x is None else x) + 1j * (drawn.imag if y is None else y) + np.zeros(len(drawn)))


def _to_pair(z: complex) -> tuple[float, float]:
    return z.real, z.imag
