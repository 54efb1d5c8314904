"""Exact placement of a linkage with free position, direction and size so that its joints lie in boxes.

A similarity z → o + w z moves joints p_j; the complex number w holds the size and the direction. Joint j lies in the
box [l_j, r_j] × [d_j, u_j] if

    l_j ≤ Re o + Re(w p_j) ≤ r_j,        d_j ≤ Im o + Im(w p_j) ≤ u_j.

By Helly's theorem on a line such an o exists if and only if no two joints are farther from each other than their boxes
permit,

    Re(w (p_j − p_k)) ≤ r_j − l_k,       Im(w (p_j − p_k)) ≤ u_j − d_k        for all j and k.

These are half-planes of w, and their intersection is a convex polygon. It is connected, so that it contains all sizes
|w| between the size of its nearest point and that of its farthest corner. A linkage with limited size fits if and only
if that range overlaps the limits. For a given size the fitting directions are arcs of a circle, cut by the half-planes.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real

ROUNDING_TOLERANCE = 1e-12
"""Tolerance of a half-plane for the rounding of its corners, as a share of the size of boxes and linkage."""

END_DISTANCE_SHARE = 0.1
"""Distance of the chosen size from the nearer end of the fitting range, as a share of the range of logarithms, if the
preferred size does not fit."""

MIN_SIZE_SHARE = 0.8
"""Minimum size to choose, as a share of the maximum fitting size: there is no reason to make a linkage smaller."""

WIDENING_SHARE = 1e-6
"""Relative accuracy of the smallest widening of the boxes with which the linkage fits."""


class Placement(NamedTuple):
    """Similarity z → origin + along · z; ``fits`` if it brings all joints into their boxes at a permitted size."""

    origin: complex
    along: complex
    fits: bool


class Boxes(NamedTuple):
    """Left, right, lower and upper limits of n joints, each of shape (n,); infinite for an open side."""

    left: Real
    right: Real
    low: Real
    high: Real

    def widen(self, margin: float) -> Boxes:
        """Return the boxes with a margin added on all sides."""
        return Boxes(self.left - margin, self.right + margin, self.low - margin, self.high + margin)


class _Directions(NamedTuple):
    """Half-planes normal · w ≤ limit: angles of the unit normals (radians) and limits, both of shape (m,)."""

    normals: Real
    limits: Real


def place_in_boxes(
    points: Complex, boxes: Boxes, least: float, most: float, preferred: complex, *, turned: bool = True
) -> Placement:
    """Place a linkage within its boxes if it fits, otherwise where it extends beyond them by the smallest amount.

    Parameters
    ----------
    points : complex, shape (n,)
        Joints in the linkage's own frame.
    boxes : Boxes
        Box of each joint.
    least, most : float
        Limits of the size |w|.
    preferred : complex
        Size and direction to use if they fit.
    turned : bool
        Whether other directions than the preferred one are permitted.

    Returns
    -------
    Placement
        The middle of the fitting positions. If ``least`` exceeds ``most``, no size fits, and the linkage gets the
        geometric mean of both as its size.
    """
    # No size is permitted: report a placement with a size between the contradictory limits.
    if least > most:
        between = math.sqrt(least * most) if most > 0.0 else least
        return place_in_boxes(points, boxes, between, between, preferred, turned=turned)._replace(fits=False)
    found = _find_scale_and_direction(points, boxes, least, most, preferred, turned)
    if found is not None:
        return Placement(_choose_origin(points, boxes, found), found, True)
    # Nothing fits: widen all boxes equally, first by doubling until the linkage fits, then by bisection.
    inner, outer = 0.0, max(abs(points).max() * least, _measure_extent(boxes), abs(preferred))
    found = _find_scale_and_direction(points, boxes.widen(outer), least, most, preferred, turned)
    while found is None:
        inner, outer = outer, 2.0 * outer
        found = _find_scale_and_direction(points, boxes.widen(outer), least, most, preferred, turned)
    while outer - inner > WIDENING_SHARE * outer:
        middle = 0.5 * (inner + outer)
        nearer = _find_scale_and_direction(points, boxes.widen(middle), least, most, preferred, turned)
        if nearer is None:
            inner = middle
        else:
            outer, found = middle, nearer
    return Placement(_choose_origin(points, boxes.widen(outer), found), found, False)


def _measure_extent(boxes: Boxes) -> float:
    """Return the larger side of the rectangle around all boxes; 0 if no side is bounded."""
    x, y = np.concatenate([boxes.left, boxes.right]), np.concatenate([boxes.low, boxes.high])
    x, y = x[np.isfinite(x)], y[np.isfinite(y)]
    return float(max(np.ptp(x), np.ptp(y))) if x.size else 0.0


def _find_scale_and_direction(
    points: Complex, boxes: Boxes, least: float, most: float, preferred: complex, turned: bool
) -> complex | None:
    """Return a size and direction (as one complex number) that fit, or None."""
    apart = (points[:, None] - points).ravel()
    across = (boxes.right[:, None] - boxes.left).ravel()
    upward = (boxes.high[:, None] - boxes.low).ravel()
    # Re(w d) is the product of w with the conjugate of d as vectors, Im(w d) that with i times it.
    normals = np.concatenate([apart.conj(), 1j * apart.conj()])
    limits = np.concatenate([across, upward])
    if not turned:
        # Confine w to the preferred ray: no component across it, none backward.
        ahead = preferred / abs(preferred)
        normals = np.concatenate([normals, [1j * ahead, -1j * ahead, -ahead]])
        limits = np.concatenate([limits, np.zeros(3)])
    # The slack scales with the numbers from which the limits are computed.
    slack = ROUNDING_TOLERANCE * (_measure_extent(boxes) + float(abs(points).max()) * least)
    bounded = np.isfinite(limits)
    normals, limits = normals[bounded], limits[bounded] + slack
    lengths = np.abs(normals)
    # Two coinciding joints bound nothing, but their boxes must overlap.
    still = lengths <= ROUNDING_TOLERANCE * float(lengths.max(initial=0.0))
    if (limits[still] < 0.0).any():
        return None
    normals, limits, lengths = normals[~still], limits[~still], lengths[~still]
    planes = _Directions(np.angle(normals), limits / lengths)
    sizes = _bound_sizes(planes)
    if sizes is None:
        return None
    low, high = max(least, sizes[0]), min(most, sizes[1])
    if low > high:
        return None
    size = _choose_size(low, high, abs(preferred))
    direction = _choose_direction(planes, size, float(np.angle(preferred)), slack / size)
    return None if direction is None else complex(size * np.exp(1j * direction))


def _mark_feasible(planes: _Directions, w: Complex, slack: float) -> NDArray[np.bool_]:
    """Return a mask of the w that lie in all half-planes."""
    reach = (w[:, None] * np.exp(-1j * planes.normals)).real
    return np.asarray((reach <= planes.limits + slack).all(axis=1))


def _bound_sizes(planes: _Directions) -> tuple[float, float] | None:
    """Return the minimum and maximum |w| of the polygon, or None if it is empty."""
    # Without half-planes every size fits.
    if not len(planes.normals):
        return 0.0, math.inf
    first, second = np.triu_indices(len(planes.normals), 1)
    turn = np.sin(planes.normals[second] - planes.normals[first])
    # Nearly parallel lines meet too far away for a meaningful corner.
    met = np.abs(turn) > ROUNDING_TOLERANCE
    first, second, turn = first[met], second[met], turn[met]
    # The corner of two lines: w · n = h for both.
    corners = (
        1j
        * (
            planes.limits[second] * np.exp(1j * planes.normals[first])
            - planes.limits[first] * np.exp(1j * planes.normals[second])
        )
        / turn
    )
    # The nearest point of the polygon is the origin, a corner, or the foot of the perpendicular to a side.
    feet = planes.limits * np.exp(1j * planes.normals)
    # Corners lie on their own two lines only up to rounding.
    slack = ROUNDING_TOLERANCE * float(np.abs(planes.limits).max())
    corners = corners[_mark_feasible(planes, corners, slack)]
    if not corners.size:
        return None
    feet = feet[_mark_feasible(planes, feet, slack)]
    # The origin itself lies in the polygon if no limit is negative.
    nearest = 0.0 if (planes.limits >= 0.0).all() else float(np.abs(np.concatenate([corners, feet])).min())
    return nearest, float(np.abs(corners).max())


def _choose_size(low: float, high: float, preferred: float) -> float:
    """Return the preferred size if it fits, otherwise a size near the closer end of the range."""
    if low <= preferred <= high:
        return preferred
    if preferred > high:
        # Keep away from the end itself, where only a single placement fits.
        low = max(low, MIN_SIZE_SHARE * high)
        return high * math.exp(END_DISTANCE_SHARE * math.log(low / high))
    high = min(high, low / MIN_SIZE_SHARE)
    return low * math.exp(END_DISTANCE_SHARE * math.log(high / low))


def _choose_direction(planes: _Directions, size: float, preferred: float, slack: float) -> float | None:
    """Return the preferred direction (radians) if it fits at this size, else the middle of the widest fitting arc."""
    # Each half-plane that cuts the circle of this size ends an arc; between two ends all directions fit or none.
    share = planes.limits / size
    cut = np.abs(share) < 1.0
    half = np.arccos(share[cut])
    ends = np.concatenate([planes.normals[cut] - half, planes.normals[cut] + half])
    ends = np.sort(np.mod(ends, math.tau))
    # Arcs are cyclic: the last one continues at the first end, one turn later.
    onward = np.append(ends[1:], ends[:1] + math.tau)
    tried = np.concatenate([[preferred], 0.5 * (ends + onward), ends])
    # The preferred direction wins if it fits; ends fit only if an arc has no width.
    widths = np.concatenate([[math.inf], onward - ends, np.zeros(len(ends))])
    there = np.asarray(size * np.exp(1j * tried), np.complex128)
    fits = _mark_feasible(planes, there, (ROUNDING_TOLERANCE + slack) * size)
    return None if not fits.any() else float(tried[np.where(fits, widths, -1.0).argmax()])


def _choose_origin(points: Complex, boxes: Boxes, along: complex) -> complex:
    """Return the middle of the fitting origins; 0 along an axis without any box."""
    moved = along * points
    ranges = (
        (boxes.left - moved.real, boxes.right - moved.real),
        (boxes.low - moved.imag, boxes.high - moved.imag),
    )
    x, y = (0.5 * float(low.max() + high.min()) if np.isfinite(low).any() else 0.0 for low, high in ranges)
    return complex(x, y)
