"""Signed distance of two convex cores, and the corners that determine its derivative.

The signed distance is the distance of cores that do not overlap. For overlapping cores it is minus the shortest
displacement that separates them, which is along a normal of one of their sides: the maximum of the separations along
all normals (separating axes; Ericson, *Real-Time Collision Detection*, sec. 5.2.1). So it has a derivative on both
sides of 0.

With n the unit normal from the second core to the first, at the nearest points q₁ = Σ λ_k z_k and q₂,

    d(distance) = Re(n̄ Σ λ_k dz_k)        with the second core at rest.
"""

from __future__ import annotations

import math

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from synthesis.fit.chart import OPTIONS

MIN_SIDE = 1e-12
"""Length of a side, in task sizes, below which it has no direction."""


@njit(**OPTIONS)
def compute_separation(first: Complex, second: Complex, weights: Real) -> tuple[float, complex]:
    """Compute the signed distance of two convex cores, and the unit normal from the second to the first.

    Parameters
    ----------
    first, second : complex, shapes (k,) and (m,)
        Corners: a point, a bar, or a convex polygon. The second is a point or an anticlockwise polygon; the first may
        be a triangle of either orientation, or flat.
    weights : float, shape (k,)
        Output: λ.
    """
    apart, normal, corner, after, share = _separate_along_sides(first, second)
    # A positive separation along a side may be less than the distance between two corners, so compute that exactly.
    if apart > 0.0 or corner < 0:
        apart, normal, corner, after, share = _compute_distance(first, second)
    weights[:] = 0.0
    weights[corner] = 1.0 - share
    weights[after] += share
    return apart, normal


@njit(**OPTIONS)
def _separate_along_sides(first: Complex, second: Complex) -> tuple[float, complex, int, int, float]:
    """Find the maximum separation along normals of sides.

    Return the separation, the normal, and the contact on the first core: two corners and the share of the second. The
    first corner is −1 if neither core has an interior.
    """
    best, normal, on, after, share = -math.inf, 0j, -1, -1, 0.0
    k, m = len(first), len(second)
    # Two bars or points have no interior to overlap.
    if m < 3 and k < 3:
        return best, normal, on, after, share
    for n in range(m if m > 2 else 0):
        start = second[n]
        side = second[n + 1 if n + 1 < m else 0] - start
        least, corner = math.inf, 0
        for j in range(k):
            height = side.imag * (first[j].real - start.real) - side.real * (first[j].imag - start.imag)
            if height < least:
                least, corner = height, j
        length = math.sqrt(side.real * side.real + side.imag * side.imag)
        # Sides of rounding length have no direction. Compare products to avoid a division per side.
        if length > MIN_SIDE and least > best * length:
            best, normal = least / length, complex(side.imag, -side.real) / length
            on, after = corner, corner
    # The orientation of the first core decides on which side its outward normals point.
    turn = -1.0 if k > 2 and _compute_area(first) < 0.0 else 1.0
    for n in range(k if k > 1 else 0):
        start, end = first[n], n + 1 if n + 1 < k else 0
        side = first[end] - start
        least, corner = math.inf, 0
        for j in range(m):
            height = turn * (side.imag * (second[j].real - start.real) - side.real * (second[j].imag - start.imag))
            if height < least:
                least, corner = height, j
        length = math.sqrt(side.real * side.real + side.imag * side.imag)
        if length > MIN_SIDE and least > best * length:
            best, normal = least / length, turn * complex(-side.imag, side.real) / length
            on, after, share = n, end, _multiply_scalar(side, second[corner] - start) / (length * length)
    return best, normal, on, after, share


@njit(**OPTIONS)
def _compute_distance(first: Complex, second: Complex) -> tuple[float, complex, int, int, float]:
    """Compute the distance of cores that do not overlap: the minimum distance of a corner from a side of the other.

    The return values are those of :func:`_separate_along_sides`.
    """
    k, m = len(first), len(second)
    least, offset, on, after, share = math.inf, 0j, 0, 0, 0.0
    for j in range(k):
        # A polygon closes from its last corner to the first; a bar has one side only.
        for n in range(m if m > 2 else 1):
            off = first[j] - second[n]
            if m > 1:
                side = second[n + 1 if n + 1 < m else 0] - second[n]
                off -= _project_on_side(off, side) * side
            square = off.real * off.real + off.imag * off.imag
            if square < least:
                least, offset, on, after = square, off, j, j
    for n in range(0 if k < 2 else k if k > 2 else 1):
        end = n + 1 if n + 1 < k else 0
        side = first[end] - first[n]
        for j in range(m):
            off = second[j] - first[n]
            along = _project_on_side(off, side)
            off = along * side - off
            square = off.real * off.real + off.imag * off.imag
            if square < least:
                least, offset, on, after, share = square, off, n, end, along
    # Square root only once, at the end: the comparisons use squares.
    apart = math.sqrt(least)
    # Touching cores have no normal; any unit vector will do.
    return apart, offset / apart if apart > 0.0 else 1.0 + 0j, on, after, share


@njit(**OPTIONS)
def measure_depth(z: complex, corners: Complex) -> tuple[float, complex]:
    """Return the depth of a point in a simple anticlockwise polygon, negative outside, and the direction in which the
    depth increases."""
    m = len(corners)
    least, toward, on_edge, within = math.inf, 1.0 + 0j, 0j, False
    for n in range(m):
        a, b = corners[n], corners[(n + 1) % m]
        offset = z - a - _project_on_side(z - a, b - a) * (b - a)
        if abs(offset) < least:
            least = abs(offset)
            toward = offset / least if least > 0.0 else 0j
            if not least > 0.0:
                on_edge = 1j * (b - a) / abs(b - a)
        # Even–odd rule: count the crossings of the ray to the right.
        if (a.imag > z.imag) != (b.imag > z.imag):
            crossing = a.real + (z.imag - a.imag) / (b.imag - a.imag) * (b.real - a.real)
            if z.real < crossing:
                within = not within
    # Exactly on an edge the offset has no direction: use the inward normal of that edge.
    if not least > 0.0:
        return 0.0, on_edge
    return (least, toward) if within else (-least, -toward)


@njit(**OPTIONS)
def _project_on_side(offset: complex, side: complex) -> float:
    """Return the position along a side, 0 to 1, nearest to a point that is ``offset`` from the side's start."""
    square = side.real * side.real + side.imag * side.imag
    return min(max(_multiply_scalar(side, offset) / square, 0.0), 1.0) if square > 0.0 else 0.0


@njit(**OPTIONS)
def _multiply_scalar(a: complex, b: complex) -> float:
    return a.real * b.real + a.imag * b.imag


@njit(**OPTIONS)
def _compute_area(corners: Complex) -> float:
    """Return twice the enclosed area, positive if anticlockwise."""
    area = 0.0
    for n in range(len(corners)):
        one, next_one = corners[n], corners[(n + 1) % len(corners)]
        area += one.real * next_one.imag - one.imag * next_one.real
    return area
