"""Contours of cams as outlines: the curve of the analysis, in millimetres, through as few points as a tolerance allows.

The analysis lays curves of the fifth degree through the points of the answer's profile (:mod:`kinematics.cam.contact`).
An outline is a cubic spline through points of those curves. It is measured against them at each of their points and
half-way between, and has more points until it is no farther off than :data:`TOLERANCE`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kinematics.cam.contact import Contour
from service.parts.curves import Curve
from service.parts.sizes import NotMade

Complex = NDArray[np.complex128]
Real = NDArray[np.float64]

TOLERANCE = 1e-3
"""Greatest distance of an outline from the contour of the analysis, millimetres: less than a cam is ground to."""

SHARE = 1e-5
"""The same as a share of the contour's greatest radius, where that is more."""

FIRST_STRIDE = 16
"""Points of the contour of which one is taken at first; half as many until the outline is near enough."""

PARTS = 4
"""Into how many a chord of the contour is divided at most."""

NEWTON = 4
"""Steps to the foot of the perpendicular from a point to the outline, from where the points' chords put it."""

EDGE = 0.2
"""Turn between neighbouring chords, radians, from which a contour has an edge, which no spline has."""


def outline(contour: Contour, factor: float, offset: float = 0.0) -> Curve:
    """The contour, or a curve beside it, as an outline.

    Parameters
    ----------
    contour : Contour
        In the unit of the design.
    factor : float
        Millimetres to that unit, as large as it is built.
    offset : float
        Along the outward normals, millimetres.

    Raises
    ------
    NotMade
        Where the contour has an edge, which happens where the follower's velocity jumps, or no outline is near enough.
    """
    share = np.arange(2 * PARTS) / (2 * PARTS)
    found = contour.along(np.arange(len(contour.points))[:, None], share)
    places = np.asarray((factor * found.point + offset * found.normal).ravel())
    if contour.sharpest_turn > EDGE:
        raise NotMade("The cam has an edge, where the follower's velocity jumps; such a contour is not cut.")
    if not contour.turns_ccw:
        places = np.roll(places[::-1], 1)
    # Half-way between two points that an outline may have there is always another one, to measure it at.
    allowed = max(TOLERANCE, SHARE * float(np.abs(places).max()))
    stride = 2 * PARTS * FIRST_STRIDE
    while stride > 1:
        kept = np.arange(0, len(places), stride)
        curve = Curve(tuple(places[kept].tolist()))
        if deviation(curve, places, kept) <= allowed:
            return curve
        stride //= 2
    raise NotMade(f"The cam has a bend that no curve comes nearer to than {allowed:.2g} mm.")


def deviation(curve: Curve, places: Complex, kept: NDArray[np.int64]) -> float:
    """The greatest distance of points from a curve that runs through some of them."""
    closed = np.append(places, places[0])
    along = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(closed)))])
    # Between two points of the curve its parameter goes as the way along the points does.
    knots = curve.spline.t[3:-3]
    at = np.interp(along[:-1], np.append(along[kept], along[-1]), knots)
    for _ in range(NEWTON):
        off = _value(curve, at, 0) - places
        slope = _value(curve, at, 1)
        at = at - (off * slope.conj()).real / np.abs(slope) ** 2
    return float(np.abs(_value(curve, at, 0) - places).max())


def _value(curve: Curve, at: Real, order: int) -> Complex:
    return np.asarray(curve.spline(at, order) @ (1.0, 1j))
