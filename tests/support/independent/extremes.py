"""Extremes of a function over a range: a grid, and every peak of it that may be the highest looked at ever closer."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Real

Function = Callable[[Real], Real]

GRID = 1441
"""Places of the grid: a quarter of a degree of a whole turn."""

CLOSER, ROUNDS = 21, 7
"""Places of a closer look, and how many follow each other: each is ten times as close."""

NEAR = 0.02
"""Peaks that are lower than the highest by more than this share of all the rise and fall are not looked at."""


class Extreme(NamedTuple):
    """Where a function is greatest or least, and its value there."""

    at: float
    value: float


def greatest(function: Function, low: float, high: float, grid: int = GRID) -> Extreme:
    """The greatest value between two places; NaN if the function is not known on the whole grid."""
    places = np.linspace(low, high, grid)
    values = function(places)
    if not np.isfinite(values).all():
        return Extreme(np.nan, np.nan)
    padded = np.concatenate([[-np.inf], values, [-np.inf]])
    peaks = np.flatnonzero((values >= padded[:-2]) & (values >= padded[2:]))
    peaks = peaks[values[peaks] >= values.max() - NEAR * np.ptp(values)]
    best = Extreme(float(places[values.argmax()]), float(values.max()))
    for k in sorted(peaks, key=lambda k: -values[k])[:8]:
        at, step = float(places[k]), (high - low) / (grid - 1)
        for _ in range(ROUNDS):
            closer = np.clip(np.linspace(at - step, at + step, CLOSER), low, high)
            there = function(closer)
            if not np.isfinite(there).all():
                break
            at, value = float(closer[there.argmax()]), float(there.max())
            best = Extreme(at, value) if value > best.value else best
            step *= 2.0 / (CLOSER - 1)
    return best


def least(function: Function, low: float, high: float, grid: int = GRID) -> Extreme:
    """The least value between two places."""
    found = greatest(lambda places: -function(places), low, high, grid)
    return Extreme(found.at, -found.value)


def root(function: Function, low: float, high: float) -> float:
    """Where a function that changes its sign between two places is nothing, by ever finer grids."""
    sign = np.sign(function(np.array([low])))
    for _ in range(9):
        places = np.linspace(low, high, 41)
        beyond = np.flatnonzero(np.sign(function(places[1:-1])) != sign)
        k = int(beyond[0]) + 1 if len(beyond) else 40
        low, high = float(places[k - 1]), float(places[k])
    return 0.5 * (low + high)
