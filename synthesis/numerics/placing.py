"""A linkage whose place, direction and size are free, put where its joints lie in boxes: exact, by half-planes.

A similarity z → o + w z moves joints p_j, with w the size and the direction as one complex number. Joint j lies in the
box [l_j, r_j] × [d_j, u_j] where

    l_j ≤ Re o + Re(w p_j) ≤ r_j,        d_j ≤ Im o + Im(w p_j) ≤ u_j.

There is such an o if and only if no two joints are farther apart than their boxes allow (Helly's theorem on a line),

    Re(w (p_j − p_k)) ≤ r_j − l_k,       Im(w (p_j − p_k)) ≤ u_j − d_k        for all j and k,

which are half-planes of w. What they leave is a convex polygon. It is connected, so that its members have all sizes
|w| between that of its nearest point and that of its farthest corner: with limits of the size the linkage fits if and
only if these ranges overlap. At a size the directions that fit are arcs of a circle, cut by the same half-planes.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

ROUNDING = 1e-12
"""Share of the boxes' and the linkage's size by which a half-plane may be overstepped: rounding of its corners."""

FROM_END = 0.1
"""Where the preferred size does not fit, how far from the nearer end one is taken: share of the logarithms' range."""

LEAST_SHARE = 0.8
"""Share of the greatest size that fits above which such a size is looked for: a linkage needs not be smaller."""

WIDENED = 1e-6
"""Share of itself to which the least widening of the boxes is known."""


class Placing(NamedTuple):
    """A similarity z → origin + along · z; ``fits`` where all joints then lie in their boxes, at a size allowed."""

    origin: complex
    along: complex
    fits: bool


class Boxes(NamedTuple):
    """Left, right, lower and upper limits of joints, each of shape (n,); infinite where there is none."""

    left: Real
    right: Real
    low: Real
    high: Real

    def widened(self, margin: float) -> Boxes:
        """All of them with a margin on all sides."""
        return Boxes(self.left - margin, self.right + margin, self.low - margin, self.high + margin)


class _Directions(NamedTuple):
    """Half-planes normal · w ≤ limit, with unit normals as angles (radians) and limits over them: shape (m,)."""

    normals: Real
    limits: Real


def placed(
    points: Complex, boxes: Boxes, least: float, most: float, preferred: complex, *, turned: bool = True
) -> Placing:
    """Where a linkage is put: within its boxes if it fits, else where it is least outside of them.

    Parameters
    ----------
    points : complex, shape (n,)
        Joints in the linkage's own frame.
    boxes : Boxes
        Where each is to lie.
    least, most : float
        Limits of the size |w|.
    preferred : complex
        Size and direction that are taken where they fit.
    turned : bool
        Whether another direction than the preferred one is allowed.

    Returns
    -------
    Placing
        In the middle of the places that there are. Where ``least`` is above ``most`` no size fits, and the linkage has
        the one between them.
    """
    if least > most:
        between = math.sqrt(least * most) if most > 0.0 else least
        return placed(points, boxes, between, between, preferred, turned=turned)._replace(fits=False)
    found = _along(points, boxes, least, most, preferred, turned)
    if found is not None:
        return Placing(_origin(points, boxes, found), found, True)
    inner, outer = 0.0, max(abs(points).max() * least, _extent(boxes), abs(preferred))
    found = _along(points, boxes.widened(outer), least, most, preferred, turned)
    while found is None:
        inner, outer = outer, 2.0 * outer
        found = _along(points, boxes.widened(outer), least, most, preferred, turned)
    while outer - inner > WIDENED * outer:
        middle = 0.5 * (inner + outer)
        nearer = _along(points, boxes.widened(middle), least, most, preferred, turned)
        if nearer is None:
            inner = middle
        else:
            outer, found = middle, nearer
    return Placing(_origin(points, boxes.widened(outer), found), found, False)


def _extent(boxes: Boxes) -> float:
    """The greatest side of a box, or distance between two."""
    x, y = np.concatenate([boxes.left, boxes.right]), np.concatenate([boxes.low, boxes.high])
    x, y = x[np.isfinite(x)], y[np.isfinite(y)]
    return float(max(np.ptp(x), np.ptp(y))) if x.size else 0.0


def _along(
    points: Complex, boxes: Boxes, least: float, most: float, preferred: complex, turned: bool
) -> complex | None:
    """Size and direction with which there is a place; None where there is none."""
    apart = (points[:, None] - points).ravel()
    across = (boxes.right[:, None] - boxes.left).ravel()
    upward = (boxes.high[:, None] - boxes.low).ravel()
    # Re(w d) is the product of w with the conjugate of d as vectors, Im(w d) that with i times it.
    normals = np.concatenate([apart.conj(), 1j * apart.conj()])
    limits = np.concatenate([across, upward])
    if not turned:
        # Nothing square to the preferred direction, and nothing against it.
        ahead = preferred / abs(preferred)
        normals = np.concatenate([normals, [1j * ahead, -1j * ahead, -ahead]])
        limits = np.concatenate([limits, np.zeros(3)])
    slack = ROUNDING * (_extent(boxes) + float(abs(points).max()) * least)
    bounded = np.isfinite(limits)
    normals, limits = normals[bounded], limits[bounded] + slack
    lengths = np.abs(normals)
    still = lengths <= ROUNDING * float(lengths.max(initial=0.0))
    if (limits[still] < 0.0).any():
        return None
    normals, limits, lengths = normals[~still], limits[~still], lengths[~still]
    planes = _Directions(np.angle(normals), limits / lengths)
    sizes = _sizes(planes)
    if sizes is None:
        return None
    low, high = max(least, sizes[0]), min(most, sizes[1])
    if low > high:
        return None
    size = _chosen(low, high, abs(preferred))
    direction = _direction(planes, size, float(np.angle(preferred)), slack / size)
    return None if direction is None else complex(size * np.exp(1j * direction))


def _within(planes: _Directions, w: Complex, slack: float) -> NDArray[np.bool_]:
    """Which of many w lie in all half-planes."""
    reach = (w[:, None] * np.exp(-1j * planes.normals)).real
    return np.asarray((reach <= planes.limits + slack).all(axis=1))


def _sizes(planes: _Directions) -> tuple[float, float] | None:
    """Least and greatest |w| of the polygon; None where it is empty."""
    if not len(planes.normals):
        return 0.0, math.inf
    first, second = np.triu_indices(len(planes.normals), 1)
    turn = np.sin(planes.normals[second] - planes.normals[first])
    met = np.abs(turn) > ROUNDING
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
    feet = planes.limits * np.exp(1j * planes.normals)
    slack = ROUNDING * float(np.abs(planes.limits).max())
    corners = corners[_within(planes, corners, slack)]
    if not corners.size:
        return None
    feet = feet[_within(planes, feet, slack)]
    nearest = 0.0 if (planes.limits >= 0.0).all() else float(np.abs(np.concatenate([corners, feet])).min())
    return nearest, float(np.abs(corners).max())


def _chosen(low: float, high: float, preferred: float) -> float:
    """The preferred size if it fits, else one near the end that is nearer to it."""
    if low <= preferred <= high:
        return preferred
    if preferred > high:
        low = max(low, LEAST_SHARE * high)
        return high * math.exp(FROM_END * math.log(low / high))
    high = min(high, low / LEAST_SHARE)
    return low * math.exp(FROM_END * math.log(high / low))


def _direction(planes: _Directions, size: float, preferred: float, slack: float) -> float | None:
    """The preferred direction, radians, if it fits at a size, else the middle of the widest arc of those that do."""
    share = planes.limits / size
    cut = np.abs(share) < 1.0
    half = np.arccos(share[cut])
    ends = np.concatenate([planes.normals[cut] - half, planes.normals[cut] + half])
    ends = np.sort(np.mod(ends, math.tau))
    onward = np.append(ends[1:], ends[:1] + math.tau)
    tried = np.concatenate([[preferred], 0.5 * (ends + onward), ends])
    widths = np.concatenate([[math.inf], onward - ends, np.zeros(len(ends))])
    there = np.asarray(size * np.exp(1j * tried), np.complex128)
    fits = _within(planes, there, (ROUNDING + slack) * size)
    return None if not fits.any() else float(tried[np.where(fits, widths, -1.0).argmax()])


def _origin(points: Complex, boxes: Boxes, along: complex) -> complex:
    """The middle of the places that fit; 0 where nothing is boxed."""
    moved = along * points
    ranges = (
        (boxes.left - moved.real, boxes.right - moved.real),
        (boxes.low - moved.imag, boxes.high - moved.imag),
    )
    x, y = (0.5 * float(low.max() + high.min()) if np.isfinite(low).any() else 0.0 for low, high in ranges)
    return complex(x, y)
