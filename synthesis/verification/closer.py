"""Extremes of what a driven mechanism does: a grid's, looked at ever closer."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from kinematics.linkage.drive import MechanismMotion, drive
from kinematics.linkage.mechanism import Mechanism

Real = NDArray[np.float64]

Quantity = Callable[[MechanismMotion], Real]

CLOSER, LOOKS = 17, 6
"""Inputs in each closer look, and the number of looks: 8⁶ times finer than the grid."""


def least_of(mechanism: Mechanism, inputs: Real, values: Real, of: Quantity) -> float:
    """The least of a quantity between the first input and the last, of which the values on a grid are known."""
    n = int(values.argmin())
    at, step, least = inputs[n], abs(inputs[1] - inputs[0]), float(values[n])
    low, high = sorted((inputs[0], inputs[-1]))
    for _ in range(LOOKS):
        closer = np.clip(np.linspace(at - step, at + step, CLOSER), low, high)
        found = of(drive(mechanism, closer, order=1))
        if not np.isfinite(found).all():
            return least
        at, least = closer[int(found.argmin())], min(least, float(found.min()))
        step *= 2.0 / (CLOSER - 1)
    return least


def extremes_of(mechanism: Mechanism, inputs: Real, values: Real, of: Quantity) -> tuple[float, float]:
    """The least and the greatest of a quantity."""
    least = least_of(mechanism, inputs, values, of)
    return least, -least_of(mechanism, inputs, -values, lambda found: -of(found))


def sine_at(link: str) -> Quantity:
    """Magnitude of the sine of the transmission angle at a closure."""
    return lambda found: np.abs(found.sines[link])
