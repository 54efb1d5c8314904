"""Points of a curve: dense in bends, with corners kept."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex
from kinematics.message import compose
from service.imports.limits import MAX_POINTS
from service.imports.thinning import add_farthest, limit_points, measure_deviation, reduce_points
from service.outlines.curves import STRAIGHTNESS_TOLERANCE, count_chords, flatten_pieces, make_line
from service.outlines.faults import Obstacle, UnsuitableDrawing
from service.outlines.limits import DEFAULT_TOLERANCE

DUPLICATE_TOLERANCE = 1e-12
"""Distance up to which two points are identical, as a share of the maximum coordinate: they differ by rounding only."""

DENSE_CHORD_SHARE = 0.125
"""Share of the tolerance for the chords between the dense points; the rest is for thinning them out."""

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)


@dataclass(frozen=True)
class PointRequest:
    """Request for the points of a curve.

    If ``tolerance`` is None, the tolerance is a share of the curve's extent, and corners are kept.
    """

    tolerance: float | None
    max_points: int


class Points(NamedTuple):
    """Points selected on a curve.

    ``points`` are x + iy, shape (n,); the first point of a closed curve is not repeated. ``tolerance`` is the maximum
    deviation of the curve from the chords. ``looked`` is the number of dense points from which they were selected.
    """

    points: Complex
    tolerance: float
    looked: int


def select_piece_points(pieces: Complex, closed: bool, request: PointRequest) -> Points:
    """Select points of a curve given by consecutive cubics, shape (n, 4).

    Corners, where a straight piece begins or ends, are kept unless a tolerance is requested.

    Raises
    ------
    ValueError
        If the curve has no length.
    UnsuitableDrawing
        If the dense points exceed the limit.
    """
    pieces = pieces[np.ptp(pieces.real, axis=1) + np.ptp(pieces.imag, axis=1) > 0.0]
    if not len(pieces):
        raise Obstacle("imports-length-zero")
    if closed and pieces[-1, 3] != pieces[0, 0]:
        pieces = np.concatenate([pieces, make_line(pieces[-1, 3], pieces[0, 0])])
    extent = _measure_extent(pieces.ravel())
    tolerance = DEFAULT_TOLERANCE * extent if request.tolerance is None else request.tolerance
    chords = DENSE_CHORD_SHARE * tolerance
    counts = count_chords(pieces, chords)
    if counts.sum() > MAX_POINTS:
        raise UnsuitableDrawing(compose("imports-curve-too-long", limit=MAX_POINTS, tolerance=f"{tolerance:.4g}"))
    dense = flatten_pieces(pieces, chords)
    lines = find_straight(pieces)
    kept = np.zeros(len(dense), bool)
    ends = np.concatenate([[0], np.cumsum(counts)])
    kept[ends[:-1]] |= lines
    kept[ends[1:]] |= lines
    return _select_points(dense, kept, closed, tolerance - chords, request, 0.0 if lines.all() else chords)


def select_polyline_points(points: Complex, closed: bool, request: PointRequest, tolerance: float = 0.0) -> Points:
    """Select points of a curve given by points, shape (n,): all of them, or those needed within a tolerance.

    ``tolerance`` is the default if none is requested; 0 keeps all points.
    """
    whole = np.append(points, points[0]) if closed else points
    within = request.tolerance if request.tolerance is not None else tolerance
    return _select_points(whole, np.full(len(whole), within == 0.0), closed, within, request)


def _select_points(
    dense: Complex,
    kept: NDArray[np.bool_],
    closed: bool,
    tolerance: float,
    request: PointRequest,
    chords: float = 0.0,
) -> Points:
    """Select among dense points; ``tolerance`` applies to the selected chords, ``chords`` to the dense ones."""
    same = DUPLICATE_TOLERANCE * float(np.abs(dense).max())
    new = np.append(True, np.abs(np.diff(dense)) > same)
    dense, kept = dense[new], kept[new]
    if closed:
        # The curve may return to its first point exactly, within rounding, or not at all.
        if len(dense) > 1 and abs(dense[-1] - dense[0]) <= same:
            dense, kept = dense[:-1], kept[:-1]
        dense, kept = np.append(dense, dense[0]), np.append(kept, True)
    if len(dense) < 2:
        raise Obstacle("imports-length-zero")
    if closed and len(dense) < 4:
        raise Obstacle("imports-no-area")
    if request.tolerance is not None:
        kept = np.zeros(len(dense), bool)
    chosen = reduce_points(dense, tolerance, kept) if tolerance > 0.0 else np.arange(len(dense))
    if len(chosen) - closed > request.max_points:
        chosen = limit_points(dense, request.max_points + closed, tolerance)
    while closed and len(chosen) < 4:
        # A closed curve needs three points to enclose an area, even with a large tolerance.
        chosen = add_farthest(dense, chosen)
    away = measure_deviation(dense, chosen)
    found = dense[chosen[:-1] if closed else chosen]
    return Points(found, away + chords, len(dense))


def measure_length(pieces: Complex) -> float:
    """Return the length of a curve of cubics, by Gauss-Legendre integration of the speed over both halves of each."""
    total = 0.0
    edges = np.diff(pieces, axis=1)
    for start in (0.0, 0.5):
        t = start + 0.25 * (_NODES + 1.0)
        s = 1.0 - t
        basis = 3.0 * np.stack([s**2, 2.0 * s * t, t**2])
        total += float((np.abs(edges @ basis) @ _WEIGHTS).sum()) * 0.25
    return total


def measure_polyline(points: Complex, closed: bool) -> float:
    """Return the total length of the chords between points."""
    way = np.append(points, points[0]) if closed else points
    return float(np.abs(np.diff(way)).sum())


def find_straight(pieces: Complex) -> NDArray[np.bool_]:
    """Return which cubics are straight lines of constant speed."""
    bends = np.abs(pieces[:, :-2] - 2.0 * pieces[:, 1:-1] + pieces[:, 2:]).max(axis=1)
    return np.asarray(bends <= STRAIGHTNESS_TOLERANCE * np.abs(np.diff(pieces, axis=1)).sum(axis=1))


def _measure_extent(points: Complex) -> float:
    return float(max(np.ptp(points.real), np.ptp(points.imag)))
