"""Random linkages that problems are planted with, their coupler curves, and the constraints that they just keep."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.linkage.fourbar import OPEN_ASSEMBLY, Fourbar, find_transmission_extremes, positions

SIZE = 100.0
"""Length of the crank, times a random factor of 0.2 to 1."""

LOOSER = 0.05
"""Share by which a limit is looser than what the planted linkage has; of a region's size for regions."""

TURNING = ("crank_rocker", "double_crank")
"""Grashof's classes of fourbars whose input turns through."""


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
    return math.degrees(float(find_transmission_extremes(linkage, 0.0, math.tau)[0]))


def pivots(linkage: Fourbar, angle: float) -> tuple[list[complex], list[complex]]:
    """Fixed pivots, and moving pivots at an input angle, radians, in the open assembly."""
    stands = positions(linkage, angle, OPEN_ASSEMBLY)
    return [complex(linkage.input_pivot), complex(linkage.output_pivot)], [complex(stands.a), complex(stands.b)]


def lengths(linkage: Fourbar) -> list[float]:
    """Of the ground and the three links."""
    ground = abs(complex(linkage.output_pivot) - complex(linkage.input_pivot))
    return [ground, float(linkage.input), float(linkage.coupler), float(linkage.output)]


def looser(
    links: list[float], fixed: list[complex], moving: list[complex], *, transmission: float, grashof: str
) -> dict[str, Any]:
    """The constraints that fourbars have in every task, each looser by :data:`LOOSER` than a linkage keeps it.

    Parameters
    ----------
    links : list of float
        Their lengths.
    fixed, moving : list of complex
        Input and output pivot, and moving pivots in the first position.
    transmission : float
        Its least transmission angle, degrees.
    grashof : str
        Its class, as it is demanded.
    """
    return {
        "min_transmission_angle": (1.0 - LOOSER) * transmission,
        "grashof": grashof,
        "full_rotation": grashof in TURNING,
        "same_branch": True,
        "in_order": True,
        "link_length": {"min": (1.0 - LOOSER) * min(links), "max": (1.0 + LOOSER) * max(links)},
        "max_link_ratio": (1.0 + LOOSER) * max(links) / min(links),
        "fixed_pivot_region": around_pivots(fixed, LOOSER),
        "moving_pivot_region": around_pivots(moving, LOOSER),
    }


def around_pivots(pivots: list[complex], margin: float) -> dict[str, list[float]]:
    """The box around two pivots as a region, wider on each side by a share of the distance between them."""
    first, second = pivots
    return box(pivots, margin * abs(second - first))


def curve(linkage: Fourbar, inputs: Real) -> Complex:
    """The places of P at input angles, radians."""
    return np.asarray(positions(linkage, inputs, OPEN_ASSEMBLY).p)


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
