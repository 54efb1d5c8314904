"""Outlines of parts, and the distance of two of them: widened segments and simple polygons.

Outlines with many edges are covered by a tree of bars around stretches of edges. Two stretches whose bars are separated
by more than the distance found so far are skipped: the result is exact and usually needs only some dozens of bars.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Integers, Real
from kinematics.compiling import KernelOptions, njit

OPTIONS: KernelOptions = {"cache": True, "nogil": True, "error_model": "numpy"}


class Part(NamedTuple):
    """A rigid part of a link.

    Attributes
    ----------
    link : str
        The link that it moves with; ``ground`` for fixed parts.
    points : complex, shape (k,)
        Vertices in the mechanism's reference configuration: one makes a disc, two a bar with round ends, three or more
        a simple polygon, which need not be convex, in either sense.
    radius : float
        Amount by which the polygon is widened: half the width of a bar.
    """

    link: str
    points: Complex
    radius: float


OVERLAP_DEPTH = 1e-6
"""Overlap, as a share of the size and in addition to the radii, assigned to intersecting cores: a sweep only has to
know that they intersect. :mod:`synthesis.verification.penetration` measures the depth."""


@njit(**OPTIONS)
def measure_distance(first: Complex, second: Complex) -> float:
    """Measure the distance of two cores, shapes (k,) and (m,): points, segments or polygons with their interior.

    The result is the minimum over all pairs of edges; 0 if they only touch, −∞ if they intersect: edges cross, or a
    corner or the middle of an edge lies inside the other.
    """
    least = _measure_edges(first, second, 0, _count_edges(len(first)), 0, _count_edges(len(second)))
    # Without crossing edges the cores still intersect if one contains the other.
    if least < 0.0 or _is_reaching_into(first, second) or _is_reaching_into(second, first):
        return -math.inf
    return float(least)


MAX_PLAIN_PAIRS = 64
"""Number of pairs of edges up to which all pairs are compared: bars would not be faster."""

MIN_STRETCH_EDGES = 4
"""Maximum number of edges of a stretch that is not divided."""

SEPARATION_TOLERANCE = 1e-9
"""Distance, as a share of the largest coordinate, above which outlines do not cross, regardless of rounding: a single
point then decides whether one lies inside the other."""

ROUNDING_ERROR = 1e-14
"""Amount, as a share of the largest coordinate, by which rounding may overestimate the distance of bars."""

MAX_STACK_DEPTH = 160
"""Maximum size of the stack of pairs of stretches: one per halving, enough for outlines of 2⁶⁴ edges."""


class Stretches(NamedTuple):
    """Bars around stretches of outlines: one tree per part, whose root is the whole outline.

    Attributes
    ----------
    rows : int, shape (s, 4)
        First edge, one past the last edge, and the stretches of its two halves (−1 for undivided ones).
    ends : complex, shape (s, 2)
        Ends of the axes of the bars, in the reference.
    radii : float, shape (s,)
        Maximum distance of the stretch from the axis.
    roots : int, shape (parts,)
    """

    rows: Integers
    ends: Complex
    radii: Real
    roots: Integers


@njit(**OPTIONS)
def build_stretches(vertices: Complex, starts: Integers) -> Stretches:
    """Build the stretches of parts whose vertices are concatenated, each part from one start to the next."""
    rows = np.full((2 * len(vertices) + len(starts), 4), -1, np.int64)
    ends, radii = np.empty((len(rows), 2), np.complex128), np.empty(len(rows))
    roots = np.empty(len(starts) - 1, np.int64)
    count = 0
    for part in range(len(roots)):
        points = vertices[starts[part] : starts[part + 1]]
        roots[part] = at = count
        rows[count, 0], rows[count, 1] = 0, _count_edges(len(points))
        count += 1
        while at < count:
            first, end = rows[at, 0], rows[at, 1]
            radii[at] = _build_bar(points, first, end, ends[at])
            if end - first > MIN_STRETCH_EDGES:
                half = (first + end) // 2
                rows[at, 2], rows[at, 3] = count, count + 1
                rows[count, 0], rows[count, 1] = first, half
                rows[count + 1, 0], rows[count + 1, 1] = half, end
                count += 2
            at += 1
    return Stretches(rows[:count], ends[:count], radii[:count], roots)


@njit(**OPTIONS)
def _build_bar(points: Complex, first: int, end: int, axis: Complex) -> float:
    """Build the bar around the edges from ``first`` to ``end`` along their longest extent; return its radius."""
    far, other = points[first], points[first]
    # Two sweeps find a nearly largest diameter; any axis gives a valid bar.
    for n in range(first, end + 1):
        far = points[n % len(points)] if abs(points[n % len(points)] - other) > abs(far - other) else far
    for n in range(first, end + 1):
        other = points[n % len(points)] if abs(points[n % len(points)] - far) > abs(other - far) else other
    length = abs(far - other)
    along = (far - other) / length if length > 0.0 else 1.0 + 0.0j
    low, high = complex(math.inf, math.inf), complex(-math.inf, -math.inf)
    for n in range(first, end + 1):
        z = (points[n % len(points)] - other) * along.conjugate()
        low = complex(min(low.real, z.real), min(low.imag, z.imag))
        high = complex(max(high.real, z.real), max(high.imag, z.imag))
    # Center the bar across its axis.
    middle = 0.5 * (low.imag + high.imag)
    axis[0], axis[1] = other + complex(low.real, middle) * along, other + complex(high.real, middle) * along
    radius = 0.0
    for n in range(first, end + 1):
        radius = max(radius, _measure_to_segment(points[n % len(points)], axis[0], axis[1]))
    return radius


@njit(**OPTIONS)
def _measure_by_stretches(
    first: Complex, second: Complex, one: int, other: int, tree: Stretches, moved: Complex
) -> float:
    """Measure :func:`measure_distance` of two placed parts; ``moved`` has rotation and shift of each, as rows."""
    rows, ends, radii, _ = tree
    # An explicit stack, since compiled code should not recurse.
    waiting, apart = np.empty((MAX_STACK_DEPTH, 2), np.int64), np.empty(MAX_STACK_DEPTH)
    waiting[0, 0], waiting[0, 1], apart[0] = one, other, -math.inf
    count, least, far = 1, math.inf, 0.0
    for side, root in ((0, one), (1, other)):
        far = max(far, abs(ends[root, 0]) + abs(ends[root, 1]) + radii[root] + abs(moved[side, 1]))
    while count:
        count -= 1
        a, b = waiting[count, 0], waiting[count, 1]
        # Skip pairs that cannot improve the minimum.
        if apart[count] > least + ROUNDING_ERROR * far:
            continue
        halved_a, halved_b = rows[a, 2] >= 0, rows[b, 2] >= 0
        if not halved_a and not halved_b:
            least = min(least, _measure_edges(first, second, rows[a, 0], rows[a, 1], rows[b, 0], rows[b, 1]))
            if least < 0.0:
                return float(least)
            continue
        # Divide the thicker bar, whose bound is the looser one.
        of_a = halved_a and (not halved_b or radii[a] >= radii[b])
        for half in range(2):
            waiting[count + half, 0] = rows[a, 2 + half] if of_a else a
            waiting[count + half, 1] = b if of_a else rows[b, 2 + half]
            pair = waiting[count + half]
            apart[count + half] = _bound_distance(first, second, pair[0], pair[1], tree, moved)
        # Process the nearer half first (last in the stack), since the other may then be skipped.
        if apart[count + 1] > apart[count]:
            apart[count], apart[count + 1] = apart[count + 1], apart[count]
            side = 0 if of_a else 1
            waiting[count, side], waiting[count + 1, side] = waiting[count + 1, side], waiting[count, side]
        count += 2
    if least <= SEPARATION_TOLERANCE * far:
        meet = _is_reaching_into(first, second) or _is_reaching_into(second, first)
    else:
        # The outlines do not cross: one lies inside the other with all of its points or with none.
        meet = _is_point_inside(second, first[0], other, tree, moved[1]) or _is_point_inside(
            first, second[0], one, tree, moved[0]
        )
    return -math.inf if meet else least


@njit(**OPTIONS)
def _bound_distance(first: Complex, second: Complex, a: int, b: int, tree: Stretches, moved: Complex) -> float:
    """Bound the distance of two stretches from below, by their bars, or one bar and the edges of a short one."""
    rows, ends, radii, _ = tree
    one = moved[0, 0] * ends[a, 0] + moved[0, 1], moved[0, 0] * ends[a, 1] + moved[0, 1]
    other = moved[1, 0] * ends[b, 0] + moved[1, 1], moved[1, 0] * ends[b, 1] + moved[1, 1]
    short_a, short_b = rows[a, 2] < 0, rows[b, 2] < 0
    if short_a and (not short_b or radii[a] >= radii[b]):
        return float(_measure_to_edges(other[0], other[1], first, rows[a, 0], rows[a, 1]) - radii[b])
    if short_b:
        return float(_measure_to_edges(one[0], one[1], second, rows[b, 0], rows[b, 1]) - radii[a])
    return float(_measure_segments(one[0], one[1], other[0], other[1]) - radii[a] - radii[b])


@njit(**OPTIONS)
def _measure_to_edges(a: complex, b: complex, points: Complex, begin: int, end: int) -> float:
    """Measure the distance of a segment from the nearest of some edges."""
    least = math.inf
    for n in range(begin, end):
        least = min(least, _measure_segments(a, b, points[n], points[(n + 1) % len(points)]))
    return least


@njit(**OPTIONS)
def _measure_segments(a: complex, b: complex, c: complex, d: complex) -> float:
    """Measure the distance of two segments, 0 if they cross."""
    return 0.0 if _cross_over(a, b, c, d) else _measure_uncrossed(a, b, c, d)


@njit(**OPTIONS)
def _cross_over(a: complex, b: complex, c: complex, d: complex) -> bool:
    """Return whether two segments cross, not merely touch."""
    across = _cross(b - a, c - a) * _cross(b - a, d - a) < 0.0
    return bool(across and _cross(d - c, a - c) * _cross(d - c, b - c) < 0.0)


@njit(**OPTIONS)
def _measure_edges(first: Complex, second: Complex, begin: int, end: int, start: int, stop: int) -> float:
    """Measure the minimum distance between two runs of edges; −∞ if any edges cross."""
    least = math.inf
    for n in range(begin, end):
        a, b = first[n], first[(n + 1) % len(first)]
        for m in range(start, stop):
            c, d = second[m], second[(m + 1) % len(second)]
            if _cross_over(a, b, c, d):
                return -math.inf
            least = min(least, _measure_uncrossed(a, b, c, d))
    return least


@njit(**OPTIONS)
def _is_point_inside(polygon: Complex, z: complex, root: int, tree: Stretches, moved: Complex) -> bool:
    """Return whether a point that is not on the outline lies inside it."""
    a, b = moved[0] * tree.ends[root] + moved[1]
    # A point outside the bar of the whole outline cannot lie inside it.
    near = _measure_to_segment(z, a, b) <= tree.radii[root] * (1.0 + SEPARATION_TOLERANCE)
    return near and len(polygon) > 2 and _is_inside(z, polygon)


@njit(**OPTIONS)
def _is_reaching_into(core: Complex, polygon: Complex) -> bool:
    """Return whether a corner or the middle of an edge of a core lies inside a polygon."""
    if len(polygon) < 3:
        return False
    inside = False
    for n in range(len(core)):
        inside = inside or _is_inside(core[n], polygon) or _is_inside(0.5 * (core[n] + core[n - 1]), polygon)
    return inside


@njit(**OPTIONS)
def _count_edges(points: int) -> int:
    return points if points > 2 else 1


@njit(**OPTIONS)
def _measure_uncrossed(a: complex, b: complex, c: complex, d: complex) -> float:
    """Measure the distance of the segments a–b and c–d, which do not cross; either may be a point."""
    first, second = (
        min(_measure_to_segment(a, c, d), _measure_to_segment(b, c, d)),
        min(_measure_to_segment(c, a, b), _measure_to_segment(d, a, b)),
    )
    return float(min(first, second))


@njit(**OPTIONS)
def _measure_to_segment(z: complex, a: complex, b: complex) -> float:
    """Measure the distance of a point from the segment a–b."""
    along, offset = b - a, z - a
    square = along.real * along.real + along.imag * along.imag
    share = 0.0
    if square > 0.0:
        # Foot of the perpendicular, clipped to the segment.
        share = min(max((along.real * offset.real + along.imag * offset.imag) / square, 0.0), 1.0)
    left = offset - share * along
    return math.sqrt(left.real * left.real + left.imag * left.imag)


@njit(**OPTIONS)
def _cross(a: complex, b: complex) -> float:
    return a.real * b.imag - a.imag * b.real


@njit(**OPTIONS)
def _is_inside(z: complex, polygon: Complex) -> bool:
    """Return whether a ray from z crosses the polygon's edges an odd number of times; False if z lies on an edge."""
    inside = False
    for n in range(len(polygon)):
        a, b = polygon[n] - z, polygon[n - 1] - z
        turn = _cross(a, b)
        if turn == 0.0 and a.real * b.real + a.imag * b.imag <= 0.0:
            return False
        # The half-open test counts a vertex on the ray exactly once.
        if (a.imag > 0.0) != (b.imag > 0.0) and (turn > 0.0) == (b.imag > a.imag):
            inside = not inside
    return inside


@njit(**OPTIONS)
def measure_distances(
    vertices: Complex,
    starts: Integers,
    links: Integers,
    pairs: Integers,
    items: Integers,
    turn: Complex,
    shift: Complex,
    tree: Stretches,
) -> Real:
    """Measure the distances of placed cores.

    Parameters
    ----------
    vertices : complex, shape (v,)
        Vertices of all parts, concatenated, in the reference.
    starts : int, shape (parts + 1,)
        Start of the vertices of each part.
    links : int, shape (parts,)
    pairs : int, shape (p, 2)
        Parts.
    items : int, shape (m, 2)
        Pair and position of each item.
    turn, shift : complex, shape (links, n)
        Motion of the links from the reference, z ↦ turn · z + shift, at each position.
    tree : Stretches
        Stretches of the parts.

    Returns
    -------
    float, shape (m,)
        Distances: −:data:`OVERLAP_DEPTH` if the cores intersect; NaN without a position.
    """
    out = np.empty(len(items))
    most = 0
    for part in range(len(links)):
        most = max(most, starts[part + 1] - starts[part])
    scratch, moved = np.empty((2, most), np.complex128), np.empty((2, 2), np.complex128)
    for m in range(len(items)):
        pair, at = items[m]
        one, other = pairs[pair]
        moved[0] = turn[links[one], at], shift[links[one], at]
        moved[1] = turn[links[other], at], shift[links[other], at]
        if not np.isfinite(moved).all():
            out[m] = np.nan
            continue
        first = _place_points(vertices[starts[one] : starts[one + 1]], moved[0], scratch[0])
        second = _place_points(vertices[starts[other] : starts[other + 1]], moved[1], scratch[1])
        if len(first) * len(second) <= MAX_PLAIN_PAIRS:
            apart = measure_distance(first, second)
        else:
            apart = _measure_by_stretches(first, second, tree.roots[one], tree.roots[other], tree, moved)
        out[m] = max(apart, -OVERLAP_DEPTH)
    return out


@njit(**OPTIONS)
def _place_points(points: Complex, moved: Complex, scratch: Complex) -> Complex:
    """Rotate and shift points; fixed points are returned as they are."""
    # Parts on the ground need no copy.
    if moved[0] == 1.0 and moved[1] == 0.0:
        return points
    for n in range(len(points)):
        scratch[n] = moved[0] * points[n] + moved[1]
    return scratch[: len(points)]
