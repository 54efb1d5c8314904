"""The lightest disc or rim of a given moment of inertia within its limits.

A ring of density ρ, thickness t, radii R and r has I = π ρ t (R⁴ − r⁴)/2 and m = π ρ t (R² − r²) = 2 I/(R² + r²): for
given inertia, larger radii make it lighter. With c = 2 I/(π ρ) its thickness is c/(R⁴ − r⁴), so that the limits are

* t ≥ t₁ or t ≥ R/q:  R⁴ − r⁴ ≤ c/t;
* t ≤ t₂:  r ≤ (R⁴ − c/t₂)^¼;  for a wall w:  r ≤ R − w.

Both bounds of r rise with R, and so does the denominator R² + r² of the mass. With r at the lower of both bounds,
R⁴ − r⁴ rises with R, too. The lightest wheel therefore has the largest R that its own limits and the minimum thickness
permit, and the largest r for this R. A disc has r = 0.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

BISECTION_COUNT = 200
"""Number of bisections of a range of radii, after which its ends are neighbouring floating-point numbers."""


class Bounds(NamedTuple):
    """Limits in the unit of the inertia; None without a limit.

    ``radius`` is the smaller of the radius limit and the one from the rim speed.
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


def find_lightest(inertia: float, density: float, bounds: Bounds, *, rim: bool) -> Wheel | None:
    """Find the lightest wheel of a moment of inertia; None if the limits permit none.

    Parameters
    ----------
    inertia, density : float
        Positive.
    bounds : Bounds
        At least one limit must bound the radius. For a rim, the minimum thickness only does so together with a wall,
        and another limit must bound the inner radius.
    """
    c = 2.0 * inertia / (math.pi * density)

    def find_inner_radius(radius: float) -> float:
        """Return the maximum inner radius; negative if the wheel would be too thick."""
        if not rim:
            # The slack keeps a disc exactly at the thickness limit feasible.
            return 0.0 if bounds.thickest is None or radius**4 * bounds.thickest >= c * (1.0 - 1e-12) else -1.0
        # The inner radius that the minimum wall leaves.
        widest = radius - (bounds.wall or 0.0)
        if bounds.thickest is None:
            return widest
        left = radius**4 - c / bounds.thickest
        return min(widest, left**0.25) if left >= 0.0 else -1.0

    def is_too_thin(radius: float) -> bool:
        open_ = find_inner_radius(radius)
        # The minimum thickness follows from its own limit or from the ratio of radius to thickness.
        least = max(bounds.thinnest or 0.0, radius / bounds.flattest if bounds.flattest is not None else 0.0)
        return open_ >= 0.0 and (radius**4 - open_**4) * least > c

    radius = _find_largest_radius(is_too_thin, bounds.radius, c)
    if radius is None:
        return None
    open_ = find_inner_radius(radius)
    if open_ < 0.0:
        return None
    ring = radius**4 - open_**4
    return Wheel(radius, open_, c / ring) if ring > 0.0 and math.isfinite(ring) else None


def _find_largest_radius(too_thin: Callable[[float], bool], limit: float | None, c: float) -> float | None:
    """Return the largest radius, up to its limit, at which the wheel is not too thin; None if it is unbounded."""
    if limit is not None and not too_thin(limit):
        return limit
    # c**0.2 has the dimension of a length and is about the radius of a compact wheel.
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
    for _ in range(BISECTION_COUNT):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if too_thin(middle) else (middle, high)
    return low
