"""Parts by their outlines, and the distance of two of them: segments and simple polygons, widened.

Outlines of many edges are looked at through bars about stretches of them: two stretches whose bars are farther apart
than edges that are known already are passed over, so that the distance is the same and takes but some dozens of bars.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.compiling import njit

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
    least = _of_edges(first, second, 0, _edges(len(first)), 0, _edges(len(second)))
    if least < 0.0 or _reaches_into(first, second) or _reaches_into(second, first):
        return -math.inf
    return float(least)


PLAIN = 64
"""Pairs of edges that are all looked at: bars would take as long."""

FEW = 4
"""Edges of the shortest stretches, which have no parts."""

CLOSE = 1e-9
"""Share of the greatest coordinate: of outlines that are farther apart none crosses the other, whatever rounding does,
and one point tells whether it lies inside."""

FAINT = 1e-14
"""Share of the greatest coordinate by which rounding may have bars farther apart than they are."""

DEEPEST = 160
"""Pairs of stretches that wait for their turn at most: one for each halving, of outlines of as many edges as there are
numbers of 64 bits."""


class Stretches(NamedTuple):
    """Bars about stretches of outlines, a tree for each part of which the root is its whole outline.

    Attributes
    ----------
    rows : int, shape (s, 4)
        First edge, the one after the last, and the stretches of its two halves; these are −1 for the shortest.
    ends : complex, shape (s, 2)
        Of the axes of the bars, in the reference.
    radii : float, shape (s,)
        Nothing of a stretch is farther from the axis.
    roots : int, shape (parts,)
    """

    rows: Indices
    ends: Complex
    radii: Real
    roots: Indices


@njit(**OPTIONS)
def stretches_of(vertices: Complex, starts: Indices) -> Stretches:
    """The stretches of parts whose vertices stand one after the other, each part's from one start to the next."""
    rows = np.full((2 * len(vertices) + len(starts), 4), -1, np.int64)
    ends, radii = np.empty((len(rows), 2), np.complex128), np.empty(len(rows))
    roots = np.empty(len(starts) - 1, np.int64)
    count = 0
    for part in range(len(roots)):
        points = vertices[starts[part] : starts[part + 1]]
        roots[part] = at = count
        rows[count, 0], rows[count, 1] = 0, _edges(len(points))
        count += 1
        while at < count:
            first, end = rows[at, 0], rows[at, 1]
            radii[at] = _barred(points, first, end, ends[at])
            if end - first > FEW:
                half = (first + end) // 2
                rows[at, 2], rows[at, 3] = count, count + 1
                rows[count, 0], rows[count, 1] = first, half
                rows[count + 1, 0], rows[count + 1, 1] = half, end
                count += 2
            at += 1
    return Stretches(rows[:count], ends[:count], radii[:count], roots)


@njit(**OPTIONS)
def _barred(points: Complex, first: int, end: int, axis: Complex) -> float:
    """The ends of the bar about the edges from ``first`` to ``end``, along the longest way across, and its radius."""
    far, other = points[first], points[first]
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
    middle = 0.5 * (low.imag + high.imag)
    axis[0], axis[1] = other + complex(low.real, middle) * along, other + complex(high.real, middle) * along
    radius = 0.0
    for n in range(first, end + 1):
        radius = max(radius, _to_segment(points[n % len(points)], axis[0], axis[1]))
    return radius


@njit(**OPTIONS)
def _by_stretches(first: Complex, second: Complex, one: int, other: int, tree: Stretches, moved: Complex) -> float:
    """:func:`distance` of two parts as they stand; ``moved`` has turn and shift of either, as rows."""
    rows, ends, radii, _ = tree
    waiting, apart = np.empty((DEEPEST, 2), np.int64), np.empty(DEEPEST)
    waiting[0, 0], waiting[0, 1], apart[0] = one, other, -math.inf
    count, least, far = 1, math.inf, 0.0
    for side, root in ((0, one), (1, other)):
        far = max(far, abs(ends[root, 0]) + abs(ends[root, 1]) + radii[root] + abs(moved[side, 1]))
    while count:
        count -= 1
        a, b = waiting[count, 0], waiting[count, 1]
        if apart[count] > least + FAINT * far:
            continue
        halved_a, halved_b = rows[a, 2] >= 0, rows[b, 2] >= 0
        if not halved_a and not halved_b:
            least = min(least, _of_edges(first, second, rows[a, 0], rows[a, 1], rows[b, 0], rows[b, 1]))
            if least < 0.0:
                return float(least)
            continue
        of_a = halved_a and (not halved_b or radii[a] >= radii[b])
        for half in range(2):
            waiting[count + half, 0] = rows[a, 2 + half] if of_a else a
            waiting[count + half, 1] = b if of_a else rows[b, 2 + half]
            pair = waiting[count + half]
            apart[count + half] = _between(first, second, pair[0], pair[1], tree, moved)
        # The nearer half is looked at first, for the other may then be passed over.
        if apart[count + 1] > apart[count]:
            apart[count], apart[count + 1] = apart[count + 1], apart[count]
            side = 0 if of_a else 1
            waiting[count, side], waiting[count + 1, side] = waiting[count + 1, side], waiting[count, side]
        count += 2
    if least <= CLOSE * far:
        meet = _reaches_into(first, second) or _reaches_into(second, first)
    else:
        # The outlines do not meet: one lies inside the other with all of its points or with none.
        meet = _holds(second, first[0], other, tree, moved[1]) or _holds(first, second[0], one, tree, moved[0])
    return -math.inf if meet else least


@njit(**OPTIONS)
def _between(first: Complex, second: Complex, a: int, b: int, tree: Stretches, moved: Complex) -> float:
    """What two stretches are apart at least: by their bars, or the bar of one and the edges of a short one."""
    rows, ends, radii, _ = tree
    one = moved[0, 0] * ends[a, 0] + moved[0, 1], moved[0, 0] * ends[a, 1] + moved[0, 1]
    other = moved[1, 0] * ends[b, 0] + moved[1, 1], moved[1, 0] * ends[b, 1] + moved[1, 1]
    short_a, short_b = rows[a, 2] < 0, rows[b, 2] < 0
    if short_a and (not short_b or radii[a] >= radii[b]):
        return float(_to_edges(other[0], other[1], first, rows[a, 0], rows[a, 1]) - radii[b])
    if short_b:
        return float(_to_edges(one[0], one[1], second, rows[b, 0], rows[b, 1]) - radii[a])
    return float(_apart(one[0], one[1], other[0], other[1]) - radii[a] - radii[b])


@njit(**OPTIONS)
def _to_edges(a: complex, b: complex, points: Complex, begin: int, end: int) -> float:
    """Distance of a segment from the nearest of some edges."""
    least = math.inf
    for n in range(begin, end):
        least = min(least, _apart(a, b, points[n], points[(n + 1) % len(points)]))
    return least


@njit(**OPTIONS)
def _apart(a: complex, b: complex, c: complex, d: complex) -> float:
    """Distance of two segments, 0 where they cross."""
    return 0.0 if _cross_over(a, b, c, d) else _of_segments(a, b, c, d)


@njit(**OPTIONS)
def _cross_over(a: complex, b: complex, c: complex, d: complex) -> bool:
    """Whether two segments cross, not only touch."""
    across = _cross(b - a, c - a) * _cross(b - a, d - a) < 0.0
    return bool(across and _cross(d - c, a - c) * _cross(d - c, b - c) < 0.0)


@njit(**OPTIONS)
def _of_edges(first: Complex, second: Complex, begin: int, end: int, start: int, stop: int) -> float:
    """The least distance of a run of edges, from ``begin`` to ``end``, from one of another; −∞ where some cross."""
    least = math.inf
    for n in range(begin, end):
        a, b = first[n], first[(n + 1) % len(first)]
        for m in range(start, stop):
            c, d = second[m], second[(m + 1) % len(second)]
            if _cross_over(a, b, c, d):
                return -math.inf
            least = min(least, _of_segments(a, b, c, d))
    return least


@njit(**OPTIONS)
def _holds(polygon: Complex, z: complex, root: int, tree: Stretches, moved: Complex) -> bool:
    """Whether a point that is not on the outline lies inside of it."""
    a, b = moved[0] * tree.ends[root] + moved[1]
    near = _to_segment(z, a, b) <= tree.radii[root] * (1.0 + CLOSE)
    return near and len(polygon) > 2 and _inside(z, polygon)


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
    tree: Stretches,
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
    tree : Stretches
        Of the parts.

    Returns
    -------
    float, shape (m,)
        −:data:`MEETING` where they meet; NaN where there is no position.
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
        first = _placed(vertices[starts[one] : starts[one + 1]], moved[0], scratch[0])
        second = _placed(vertices[starts[other] : starts[other + 1]], moved[1], scratch[1])
        if len(first) * len(second) <= PLAIN:
            apart = distance(first, second)
        else:
            apart = _by_stretches(first, second, tree.roots[one], tree.roots[other], tree, moved)
        out[m] = max(apart, -MEETING)
    return out


@njit(**OPTIONS)
def _placed(points: Complex, moved: Complex, scratch: Complex) -> Complex:
    """Points turned and shifted; those that stand still are given back as they are."""
    if moved[0] == 1.0 and moved[1] == 0.0:
        return points
    for n in range(len(points)):
        scratch[n] = moved[0] * points[n] + moved[1]
    return scratch[: len(points)]
