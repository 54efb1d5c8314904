"""The lightest disc or rim of a given moment of inertia within its limits.

A ring of density ρ, thickness t, radii R and r has I = π ρ t (R⁴ − r⁴)/2 and m = π ρ t (R² − r²) = 2 I/(R² + r²): of
given inertia it is the lighter the larger its radii. With c = 2 I/(π ρ) its thickness is c/(R⁴ − r⁴), so that limits
are

* t ≥ t₁ or t ≥ R/q:  R⁴ − r⁴ ≤ c/t;
* t ≤ t₂:  r ≤ (R⁴ − c/t₂)^¼;  of a wall w:  r ≤ R − w.

Both bounds of r rise with R, and so does the mass's denominator; with r at the lower of the two, R⁴ − r⁴ rises with R
too. So R is as large as its own limits and the least thickness allow, r as large as it may be then, and no wheel within
the limits is lighter. A disc is r = 0.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

HALVINGS = 200
"""Times that a range of radii is halved: until its ends are neighbours among the numbers."""


class Bounds(NamedTuple):
    """Limits in the unit of the inertia; None where there is none.

    ``radius`` is the greatest by a limit of its own or of the rim's speed.
    """

    radius: float | None
    thinnest: float | None
    thickest: float | None
    wall: float | None
    flattest: float | None


class Wheel(NamedTuple):
    """Dimensions in the unit of the inertia."""

    radius: float
    inner: float
    thickness: float


def lightest(inertia: float, density: float, bounds: Bounds, *, rim: bool) -> Wheel | None:
    """The lightest wheel of a moment of inertia; None where the limits allow none.

    Parameters
    ----------
    inertia, density : float
        Positive.
    bounds : Bounds
        At least one of them bounds the radius (of a rim the least thickness does with a wall only), and of a rim one
        its inner radius.
    """
    c = 2.0 * inertia / (math.pi * density)

    def inner(radius: float) -> float:
        """The greatest inner radius; negative where the wheel would be too thick."""
        if not rim:
            return 0.0 if bounds.thickest is None or radius**4 * bounds.thickest >= c * (1.0 - 1e-12) else -1.0
        widest = radius - (bounds.wall or 0.0)
        if bounds.thickest is None:
            return widest
        left = radius**4 - c / bounds.thickest
        return min(widest, left**0.25) if left >= 0.0 else -1.0

    def too_thin(radius: float) -> bool:
        open_ = inner(radius)
        least = max(bounds.thinnest or 0.0, radius / bounds.flattest if bounds.flattest is not None else 0.0)
        return open_ >= 0.0 and (radius**4 - open_**4) * least > c

    radius = _largest(too_thin, bounds.radius, c)
    if radius is None:
        return None
    open_ = inner(radius)
    if open_ < 0.0:
        return None
    ring = radius**4 - open_**4
    return Wheel(radius, open_, c / ring) if ring > 0.0 and math.isfinite(ring) else None


def _largest(too_thin: Callable[[float], bool], limit: float | None, c: float) -> float | None:
    """The largest radius at which the wheel is not too thin, up to its limit; None where there is no end to it."""
    if limit is not None and not too_thin(limit):
        return limit
    high = limit if limit is not None else c**0.2
    while limit is None and not too_thin(high):
        high *= 2.0
        if not high < 1e70:
            return None
    low = high
    while too_thin(low):
        low *= 0.5
        if low == 0.0:
            return None
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if too_thin(middle) else (middle, high)
    return low
