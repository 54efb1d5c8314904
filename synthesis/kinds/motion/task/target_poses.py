"""Target poses of the body and their tolerances, as arrays."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from synthesis.kinds.motion.problem import MotionProblem

EXACT_WEIGHT = 1e3
"""Weight of an exact coordinate relative to the others in the first search for a target's input: exact coordinates take
precedence over those with a tolerance."""


class TargetPoses(NamedTuple):
    """The target poses of the body.

    Attributes
    ----------
    points : complex, shape (n,)
        P, in the problem's coordinates.
    turns : float, shape (n,)
        Rotation of the body from the first target position, radians.
    limits : float, shape (n, 3)
        Tolerances of x, y (length units) and the angle (radians): 0 for a coordinate that is met exactly, infinite for
        one that is fitted without a limit.
    size : float
        The task's size.
    """

    points: Complex
    turns: Real
    limits: Real
    size: float

    @property
    def exact_mask(self) -> NDArray[np.bool_]:
        """Mask of the coordinates that are met exactly, shape (n, 3)."""
        return np.equal(self.limits, 0.0)

    @property
    def units(self) -> Real:
        """Scale of each coordinate's deviation: its tolerance, else the task's size or one radian; shape (n, 3)."""
        plain = np.array([self.size, self.size, 1.0])
        return np.asarray(np.where(np.isfinite(self.limits) & ~self.exact_mask, self.limits, plain))

    def offsets(self, points: Complex, turns: Real) -> Real:
        """Return the deviations (x, y, angle) of poses of shape (n, ...) from the targets; shape (n, ..., 3)."""
        axes = (slice(None), *([None] * (points.ndim - 1)))
        gap = points - self.points[axes]
        # The angle's deviation is reduced to [-π, π]: targets are known modulo whole turns only.
        turned = turns - self.turns[axes]
        return np.stack([gap.real, gap.imag, turned - 2.0 * np.pi * np.round(turned / (2.0 * np.pi))], axis=-1)

    def residuals(self, offsets: Real) -> Real:
        """Return the larger of P's distance as a share of the task's size and the angle in radians, shape (n,)."""
        return np.maximum(np.hypot(offsets[:, 0], offsets[:, 1]) / self.size, np.abs(offsets[:, 2]))

    def rms(self, offsets: Real) -> float:
        """Return the RMS over the targets of distance (share of the task's size) and angle (radians) together."""
        squares = (np.hypot(offsets[:, 0], offsets[:, 1]) / self.size) ** 2 + offsets[:, 2] ** 2
        return math.sqrt(float(squares.mean()))


def make_target_poses(problem: MotionProblem) -> TargetPoses:
    """Return the target poses of a problem, with angles in radians."""
    limits = np.array(problem.limits)
    limits[:, 2] = np.radians(limits[:, 2])
    return TargetPoses(
        np.array([p.point for p in problem.positions]), np.array(problem.turns), limits, problem.task_size
    )
