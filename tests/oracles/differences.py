"""Derivatives by central differences of eighth order, the third of sixth (Fornberg, Math. Comp. 51 (1988) 699)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

STENCILS = {
    1: ((4 / 5, -1 / 5, 4 / 105, -1 / 280), 0.0, -1.0),
    2: ((8 / 5, -1 / 5, 8 / 315, -1 / 560), -205 / 72, 1.0),
    3: ((-488 / 240, 338 / 240, -72 / 240, 7 / 240), 0.0, -1.0),
}
"""Order of the derivative: weights of f(x + h) to f(x + 4h), of f(x), and the sign of the weights of f(x − kh)."""


def derivative(f: Callable[[float], NDArray], order: int, step: float) -> NDArray:
    """The derivative of the given order at 0 of an array-valued function of one number."""
    weights, centre, mirror = STENCILS[order]
    total = centre * f(0.0)
    for k, weight in enumerate(weights, start=1):
        total = total + weight * (f(k * step) + mirror * f(-k * step))
    return np.asarray(total / step**order)
