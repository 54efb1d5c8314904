"""Contours of cams as outlines: the curve of the analysis in millimetres, through the fewest points within a tolerance.

The analysis fits curves of degree five through the points of the answer's profile
(:mod:`kinematics.cam.finished.contact`). An outline is a cubic spline through points of those curves. It is compared
with them at each of their points and half-way between, and gets more points until it is within
:data:`CONTOUR_TOLERANCE`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from kinematics.cam.finished.contact import Contour
from kinematics.message import compose
from service.parts.assembly.sizes import NotMade
from service.parts.geometry.splines import Curve

CONTOUR_TOLERANCE = 1e-3
"""Maximum distance of an outline from the contour of the analysis, millimetres; finer than cam grinding."""

CONTOUR_TOLERANCE_SHARE = 1e-5
"""The same as a share of the contour's maximum radius; the larger of both applies."""

FIRST_STRIDE = 16
"""Initial number of contour points per outline point; it is halved until the outline is accurate."""

MAX_CHORD_PARTS = 4
"""Maximum number of parts into which a chord of the contour is divided."""

NEWTON_STEPS = 4
"""Number of Newton steps to the foot of the perpendicular from a point to the outline, starting from chord lengths."""

MIN_EDGE_ANGLE = 0.2
"""Angle between neighbouring chords, radians, beyond which a contour has an edge, which a spline cannot have."""


def fit_outline(contour: Contour, factor: float, offset: float = 0.0) -> Curve:
    """Return the contour, or a parallel curve, as an outline.

    Parameters
    ----------
    contour : Contour
        Contour in the unit of the design.
    factor : float
        Millimetres per that unit, at the built size.
    offset : float
        Offset along the outward normals, millimetres.

    Raises
    ------
    NotMade
        If the contour has an edge, caused by a velocity jump of the follower, or no outline is accurate enough.
    """
    share = np.arange(2 * MAX_CHORD_PARTS) / (2 * MAX_CHORD_PARTS)
    found = contour.evaluate_at(np.arange(len(contour.points))[:, None], share)
    places = np.asarray((factor * found.point + offset * found.normal).ravel())
    if contour.sharpest_turn > MIN_EDGE_ANGLE:
        raise NotMade(compose("parts-cam-with-edge"))
    # Outlines are counter-clockwise by convention.
    if not contour.turns_ccw:
        places = np.roll(places[::-1], 1)
    # Strides are even, so that between two outline points there is always a contour point to measure the deviation.
    allowed = max(CONTOUR_TOLERANCE, CONTOUR_TOLERANCE_SHARE * float(np.abs(places).max()))
    stride = 2 * MAX_CHORD_PARTS * FIRST_STRIDE
    while stride > 1:
        kept = np.arange(0, len(places), stride)
        curve = Curve(tuple(places[kept].tolist()))
        if measure_deviation(curve, places, kept) <= allowed:
            return curve
        # Too inaccurate: double the number of points.
        stride //= 2
    raise NotMade(compose("parts-cam-bend-too-sharp", deviation=f"{allowed:.2g}"))


def measure_deviation(curve: Curve, places: Complex, kept: NDArray[np.int64]) -> float:
    """Return the maximum distance of points from a curve that runs through some of them."""
    closed = np.append(places, places[0])
    along = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(closed)))])
    # Start value: between two points of the curve its parameter is proportional to the chord length.
    knots = curve.spline.t[3:-3]
    at = np.interp(along[:-1], np.append(along[kept], along[-1]), knots)
    for _ in range(NEWTON_STEPS):
        off = _evaluate(curve, at, 0) - places
        slope = _evaluate(curve, at, 1)
        # Newton step: remove the tangential component of the offset.
        at = at - (off * slope.conj()).real / np.abs(slope) ** 2
    return float(np.abs(_evaluate(curve, at, 0) - places).max())


def _evaluate(curve: Curve, at: Real, order: int) -> Complex:
    return np.asarray(curve.spline(at, order) @ (1.0, 1j))
