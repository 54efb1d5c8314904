"""Rotation of a fourbar's input through the targets: direction and size."""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Complex, Real
from synthesis.kinds.motion.task.positions import MotionTask


def measure_input_rotation(task: MotionTask, o2: Complex, a: Complex) -> Real:
    """Return the input rotations from the first target to the last, radians, in the shorter direction that keeps order.

    Parameters
    ----------
    task : MotionTask
        n positions.
    o2, a : complex, shape (n,)
        Fixed pivots, and moving pivots at the first target, in the problem's coordinates.
    """
    pins = task.origin + task.size * task.images((a - task.origin) / task.size)
    turned = np.angle((pins - o2[:, None]) / (pins[:, :1] - o2[:, None]))
    turned[:, 0] = 0.0  # rounding could make it slightly negative, which would count as a full turn
    onward, backward = np.mod(turned, math.tau), -np.mod(-turned, math.tau)
    rises, falls = (np.diff(onward) > 0.0).all(axis=1), (np.diff(backward) < 0.0).all(axis=1)
    # With two targets both directions keep the order; the shorter rotation is used.
    forward = rises & ~(falls & (-backward[:, -1] < onward[:, -1]))
    return np.where(forward, onward[:, -1], backward[:, -1])
