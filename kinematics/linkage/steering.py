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
