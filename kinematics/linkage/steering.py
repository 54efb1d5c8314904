"""Correct steering: the angles at which all wheels of a vehicle roll about one centre on the line of its rear axle.

With the wheelbase L and the kingpins w apart the inner wheel stands at θ and the outer one at φ where

    cot φ − cot θ = w/L

(Rao, eq. 4.15); Davis's gear keeps that exactly where its arms lean by α with 2 tan α = w/L (Rao, eq. 4.17).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Real = NDArray[np.float64]


def outer_angle(inner: ArrayLike, ratio: ArrayLike) -> Real:
    """Angle of the outer wheel for that of the inner one, radians; ``ratio`` is w/L. 0 for 0, smooth there."""
    theta = np.asarray(inner, np.float64)
    return np.asarray(np.arctan2(np.sin(theta), np.cos(theta) + np.asarray(ratio) * np.sin(theta)))


def davis_arm_angle(ratio: ArrayLike) -> Real:
    """Angle of the arms of Davis's gear from the vehicle's axis in the straight position; radians."""
    return np.asarray(np.arctan(0.5 * np.asarray(ratio, np.float64)))


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
