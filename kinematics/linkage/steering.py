"""Correct steering: the angles at which all wheels of a vehicle roll about one centre on the line of its rear axle.

With the wheelbase L and the kingpin distance w the angles θ of the inner and φ of the outer wheel satisfy

    cot φ − cot θ = w/L

(Rao, eq. 4.15). Davis's gear satisfies this exactly if its arms are inclined by α with 2 tan α = w/L (Rao, eq. 4.17).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from kinematics.arrays import Real


def compute_outer_angle(inner: ArrayLike, ratio: ArrayLike) -> Real:
    """Compute the outer wheel's angle from that of the inner wheel, radians; ``ratio`` is w/L.

    The outer angle is 0 where the inner angle is 0, and smooth there.
    """
    theta = np.asarray(inner, np.float64)
    # Multiplied by sin θ, the cotangent relation has no singularity at θ = 0.
    return np.asarray(np.arctan2(np.sin(theta), np.cos(theta) + np.asarray(ratio) * np.sin(theta)))


def compute_davis_arm_angle(ratio: ArrayLike) -> Real:
    """Compute the angle of the arms of Davis's gear from the vehicle's axis, wheels straight ahead; radians."""
    return np.asarray(np.arctan(0.5 * np.asarray(ratio, np.float64)))
