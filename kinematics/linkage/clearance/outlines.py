"""Parts by their outlines, and the distance of two of them: segments and simple polygons, widened."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

Complex = NDArray[np.complex128]
Real = NDArray[np.float64]
Indices = NDArray[np.int64]

OPTIONS: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy"}


class Part(NamedTuple):
    """A rigid part of a link.

    Attributes
    ----------
    link : str
        The link that it moves with; ``ground`` for what stands still.
    points : complex, shape (k,)
        Vertices in the mechanism's reference configuration: one makes a disc, two a bar with round ends, three or more
        a simple polygon, which need not be convex, in either sense.
    radius : float
        By which the vertices and what is between them is widened: half the width of a bar.
    """

    link: str
    points: Complex
    radius: float


MEETING = 1e-6
"""Share of the size that cores which meet count as overlapping by, beside their radii: how deep is not measured."""


@njit(**OPTIONS)
def distance(first: Complex, second: Complex) -> float:
    """Distance of two cores, shapes (k,) and (m,): points, segments or polygons with what they enclose.

    The least over all pairs of edges; 0 where they only touch, and −∞ where they meet in more than that: where edges
    cross, or a corner or the middle of an edge lies inside the other.
    """
    least = math.inf
    for n in range(_edges(len(first))):
        a, b = first[n], first[(n + 1) % len(first)]
        for m in range(_edges(len(second))):
            c, d = second[m], second[(m + 1) % len(second)]
            if _cross(b - a, c - a) * _cross(b - a, d - a) < 0.0 and _cross(d - c, a - c) * _cross(d - c, b - c) < 0.0:
                return -math.inf
            least = min(least, _of_segments(a, b, c, d))
    if _reaches_into(first, second) or _reaches_into(second, first):
        return -math.inf
    return least


@njit(**OPTIONS)
def _reaches_into(core: Complex, polygon: Complex) -> bool:
    """Whether a corner or the middle of an edge of a core lies inside a polygon."""
    if len(polygon) < 3:
        return False
    inside = False
    for n in range(len(core)):
        inside = inside or _inside(core[n], polygon) or _inside(0.5 * (core[n] + core[n - 1]), polygon)
    return inside


@njit(**OPTIONS)
def _edges(points: int) -> int:
    return points if points > 2 else 1


@njit(**OPTIONS)
def _of_segments(a: complex, b: complex, c: complex, d: complex) -> float:
    """Distance of the segments from a to b and from c to d that do not cross; either may be a point."""
    first, second = min(_to_segment(a, c, d), _to_segment(b, c, d)), min(_to_segment(c, a, b), _to_segment(d, a, b))
    return float(min(first, second))


@njit(**OPTIONS)
def _to_segment(z: complex, a: complex, b: complex) -> float:
    along, offset = b - a, z - a
    square = along.real * along.real + along.imag * along.imag
    share = 0.0
    if square > 0.0:
        share = min(max((along.real * offset.real + along.imag * offset.imag) / square, 0.0), 1.0)
    left = offset - share * along
    return math.sqrt(left.real * left.real + left.imag * left.imag)


@njit(**OPTIONS)
def _cross(a: complex, b: complex) -> float:
    return a.real * b.imag - a.imag * b.real


@njit(**OPTIONS)
def _inside(z: complex, polygon: Complex) -> bool:
    """Whether a ray from z crosses the polygon's edges an odd number of times; not where z lies on one of them."""
    inside = False
    for n in range(len(polygon)):
        a, b = polygon[n] - z, polygon[n - 1] - z
        turn = _cross(a, b)
        if turn == 0.0 and a.real * b.real + a.imag * b.imag <= 0.0:
            return False
        if (a.imag > 0.0) != (b.imag > 0.0) and (turn > 0.0) == (b.imag > a.imag):
            inside = not inside
    return inside


@njit(**OPTIONS)
def distances(
    vertices: Complex,
    starts: Indices,
    links: Indices,
    pairs: Indices,
    items: Indices,
    turn: Complex,
    shift: Complex,
) -> Real:
    """Distances of cores as they stand.

    Parameters
    ----------
    vertices : complex, shape (v,)
        Of all parts, one after the other, in the reference.
    starts : int, shape (parts + 1,)
        Where the vertices of each part begin.
    links : int, shape (parts,)
    pairs : int, shape (p, 2)
        Parts.
    items : int, shape (m, 2)
        Which pair at which position.
    turn, shift : complex, shape (links, n)
        At each position z ↦ turn · z + shift moves what a link carries there from the reference.

    Returns
    -------
    float, shape (m,)
        −:data:`MEETING` where they meet.
    """
    out = np.empty(len(items))
    most = 0
    for part in range(len(links)):
        most = max(most, starts[part + 1] - starts[part])
    first, second = np.empty(most, np.complex128), np.empty(most, np.complex128)
    for m in range(len(items)):
        pair, at = items[m]
        counts = np.zeros(2, np.int64)
        for side in range(2):
            part = pairs[pair, side]
            link = links[part]
            moved = first if side == 0 else second
            counts[side] = starts[part + 1] - starts[part]
            for n in range(counts[side]):
                moved[n] = turn[link, at] * vertices[starts[part] + n] + shift[link, at]
        out[m] = max(distance(first[: counts[0]], second[: counts[1]]), -MEETING)
    return out
