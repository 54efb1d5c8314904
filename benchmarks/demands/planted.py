"""Random linkages that problems are planted with, and their coupler curves."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from kinematics.linkage.fourbar import OPEN, Fourbar, positions, transmission_extremes

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

SIZE = 100.0
"""Length of the crank, times a random factor of 0.2 to 1."""


def crank_rocker(rng: np.random.Generator, transmission: float = 0.0) -> Fourbar:
    """A crank-rocker with a least transmission angle, degrees, anywhere and in any direction; its assembly is open."""
    while True:
        a = 1.0
        b, c, d = rng.uniform(1.2, 4.0, 3)
        if max(b, c, d) + a >= sum((b, c, d)) - max(b, c, d):
            continue
        size, o2 = SIZE * rng.uniform(0.2, 1.0), SIZE * complex(*rng.normal(size=2))
        o4 = o2 + size * d * np.exp(1j * rng.uniform(0.0, math.tau))
        p = size * b * complex(rng.uniform(-0.5, 1.5), rng.uniform(-1.0, 1.0))
        linkage = Fourbar(o2, complex(o4), size * a, size * b, size * c, p)
        if least_transmission(linkage) >= transmission:
            return linkage


def around(rng: np.random.Generator, number: int) -> Real:
    """Crank angles in a turn, radians, shape (number,): apart by gaps of which none is three times another."""
    gaps = rng.uniform(0.5, 1.5, number + 1)
    return np.asarray(rng.uniform(0.0, math.tau) + math.tau * np.cumsum(gaps)[:-1] / gaps.sum())


def least_transmission(linkage: Fourbar) -> float:
    """The least transmission angle over a whole turn, degrees."""
    return math.degrees(float(transmission_extremes(linkage, 0.0, math.tau)[0]))


def curve(linkage: Fourbar, inputs: Real) -> Complex:
    """The places of P at input angles, radians."""
    return np.asarray(positions(linkage, inputs, OPEN).p)


def extent(places: Complex) -> float:
    """Diagonal of the box around places."""
    return math.hypot(float(np.ptp(places.real)), float(np.ptp(places.imag)))


def listed(places: Complex) -> list[dict[str, float]]:
    """Places as points of a statement."""
    return [{"x": float(z.real), "y": float(z.imag)} for z in places]


def box(places: list[complex], margin: float) -> dict[str, list[float]]:
    """The box around places, wider by a margin on each side, as a region of a statement."""
    x, y = [complex(z).real for z in places], [complex(z).imag for z in places]
    return {"x": [min(x) - margin, max(x) + margin], "y": [min(y) - margin, max(y) + margin]}
