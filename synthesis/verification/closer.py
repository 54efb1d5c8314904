"""Extremes of what a driven mechanism does: a grid's, looked at ever closer."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from kinematics.linkage.drive import MechanismMotion, drive
from kinematics.linkage.mechanism import Mechanism

Real = NDArray[np.float64]

Quantity = Callable[[MechanismMotion], Real]

GRID = 1441
"""Inputs at which transmission angles are looked at first."""

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


def least_angles(at: Callable[[Real], MechanismMotion], low: float, high: float) -> dict[str, float]:
    """The least transmission angle at each closure between two inputs, radians; 0 where nothing closes.

    ``at`` drives the mechanism to inputs (n,). Rounding may leave no position at the ends of the motion.
    """
    grid = np.linspace(low, high, GRID)
    found = {}
    for link, sines in at(grid).sines.items():
        values = np.abs(sines)
        if not np.isfinite(values).any():
            found[link] = 0.0
            continue
        place, step, least = grid[int(np.nanargmin(values))], (high - low) / (GRID - 1), float(np.nanmin(values))
        for _ in range(LOOKS):
            near = np.clip(np.linspace(place - step, place + step, CLOSER), low, high)
            closer = np.abs(at(near).sines[link])
            if not np.isfinite(closer).any():
                break
            place, least = near[int(np.nanargmin(closer))], min(least, float(np.nanmin(closer)))
            step *= 2.0 / (CLOSER - 1)
        found[link] = math.asin(min(least, 1.0))
    return found


def sine_at(link: str) -> Quantity:
    """Magnitude of the sine of the transmission angle at a closure."""
    return lambda found: np.abs(found.sines[link])
