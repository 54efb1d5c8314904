"""What a problem demands of the body at its targets, as numbers: poses, and how exactly each is to be met."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.kinds.motion.problem import MotionProblem

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

HELD_WEIGHT = 1e3
"""Weight of a held coordinate beside the others where a target's input is looked for at first: what must be met comes
before what may be missed."""


class Demanded(NamedTuple):
    """The demanded poses of the body.

    Attributes
    ----------
    points : complex, shape (n,)
        P, in the problem's coordinates.
    turns : float, shape (n,)
        Rotation of the body from the first demanded position, radians.
    limits : float, shape (n, 3)
        How far x, y (length units) and the angle (radians) may be off: 0 where a coordinate is held, infinite where it
        is fitted without a limit.
    size : float
        The task's size.
    """

    points: Complex
    turns: Real
    limits: Real
    size: float

    @property
    def held(self) -> NDArray[np.bool_]:
        """Which coordinates are held, shape (n, 3)."""
        return np.equal(self.limits, 0.0)

    @property
    def units(self) -> Real:
        """What a deviation of each coordinate is measured by: its limit, or the task's size and one radian."""
        plain = np.array([self.size, self.size, 1.0])
        return np.asarray(np.where(np.isfinite(self.limits) & ~self.held, self.limits, plain))

    def offsets(self, points: Complex, turns: Real) -> Real:
        """Deviations (x, y, angle) of poses of shape (n, ...) from the demanded ones; shape (n, ..., 3)."""
        axes = (slice(None), *([None] * (points.ndim - 1)))
        gap = points - self.points[axes]
        turned = turns - self.turns[axes]
        return np.stack([gap.real, gap.imag, turned - 2.0 * np.pi * np.round(turned / (2.0 * np.pi))], axis=-1)

    def residuals(self, offsets: Real) -> Real:
        """The larger of P's distance as a share of the task's size and the angle in radians, shape (n,)."""
        return np.maximum(np.hypot(offsets[:, 0], offsets[:, 1]) / self.size, np.abs(offsets[:, 2]))

    def rms(self, offsets: Real) -> float:
        """Root mean square over the targets of distance (share of the task's size) and angle (radians) together."""
        squares = (np.hypot(offsets[:, 0], offsets[:, 1]) / self.size) ** 2 + offsets[:, 2] ** 2
        return math.sqrt(float(squares.mean()))


def demanded(problem: MotionProblem) -> Demanded:
    """The demands of a problem."""
    limits = np.array(problem.limits)
    limits[:, 2] = np.radians(limits[:, 2])
    return Demanded(np.array([p.point for p in problem.positions]), np.array(problem.turns), limits, problem.task_size)
