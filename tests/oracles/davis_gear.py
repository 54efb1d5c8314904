"""The wheels of Davis's gear as the travel of its bar turns them."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from kinematics.arrays import Real


def davis_angles(height: ArrayLike, arm_angle: ArrayLike, travel: ArrayLike) -> tuple[Real, Real]:
    """Angles of inner and outer wheel when the bar of Davis's gear has moved, radians.

    Parameters
    ----------
    height : float
        From the line of the kingpins to the bar.
    arm_angle : float
        Of the arms in the straight position, radians.
    travel : float
        Of the bar from there; positive for the turn in which this is the order of the wheels.
    """
    h, a, x = (np.asarray(value, np.float64) for value in (height, arm_angle, travel))
    lean = h * np.tan(a)
    return np.asarray(a - np.arctan2(lean - x, h)), np.asarray(np.arctan2(lean + x, h) - a)
