"""Which way the input of a fourbar turns through the targets, and how far."""

from __future__ import annotations

import math

import numpy as np

from synthesis.kinds.motion.task import Complex, MotionTask, Real


def turned_way(task: MotionTask, o2: Complex, a: Complex) -> Real:
    """What inputs turn from the first target to the last, radians, by the shorter way that has all in their order.

    Parameters
    ----------
    task : MotionTask
        Its positions.
    o2, a : complex, shape (n,)
        Fixed pivots, and moving pivots at the first target, in the problem's coordinates.
    """
    pins = task.origin + task.size * task.images((a - task.origin) / task.size)
    turned = np.angle((pins - o2[:, None]) / (pins[:, :1] - o2[:, None]))
    turned[:, 0] = 0.0  # and not by rounding a little less, which would be a whole turn
    onward, backward = np.mod(turned, math.tau), -np.mod(-turned, math.tau)
    rises, falls = (np.diff(onward) > 0.0).all(axis=1), (np.diff(backward) < 0.0).all(axis=1)
    forward = rises & ~(falls & (-backward[:, -1] < onward[:, -1]))
    return np.where(forward, onward[:, -1], backward[:, -1])
