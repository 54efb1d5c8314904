"""Verification of a linkage that draws a whole curve: it is driven over it, and distances are measured both ways.

From the target to the curve: the input is looked for at which P comes nearest to each point, in order. From the curve
to the target: P's distance from the polygon through the points, over all of the curve that is used.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.linkage.fourbar import positions
from synthesis.kinds.path.design import PathDesign
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.verification import verify_path
from synthesis.model.linkage_answer import FourbarMechanism
from synthesis.model.linkages import driven_fourbar
from synthesis.proof.closer import least_near

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

CURVE_STEPS = 1440
"""Inputs at which the curve is compared with the target: a quarter of a degree of a full turn."""

BULGE = 0.25
"""A curve may bulge between two points by this share of their distance, as an arc of a hundred degrees does; what goes
beyond is an excursion that the points do not show."""

STEP, HALVINGS = 0.01, 40
"""Inputs are put between two whose places are farther apart than this share of the curve's size, so many times at most:
near a change point a linkage runs over much of its curve in next to no time."""

ROWS = 256
"""Places that are compared with all sides of the polygon at a time: some megabytes."""


def verify_curve(problem: PathProblem, mechanism: FourbarMechanism) -> PathDesign | None:
    """Drive a fourbar over a curve and measure it; as :func:`~synthesis.kinds.path.verification.verify_path`."""
    design = verify_path(problem, mechanism)
    if design is None:
        return None
    points = np.array([point.point for point in problem.points])
    fourbar = driven_fourbar(mechanism)
    inputs = np.radians([target.at for target in design.targets])
    low, high = float(inputs.min()), float(inputs.max())
    if problem.closed and design.metrics.full_rotation:
        low, high = float(inputs[0]), float(inputs[0]) + 2.0 * np.pi

    def place(at: Real) -> Complex:
        return np.asarray(positions(fourbar.linkage, at, fourbar.assembly).p)

    gone = astray(place, (low, high), points, problem.closed, design.metrics.max_distance)
    return design.model_copy(update={"metrics": design.metrics.model_copy(update=gone._asdict())})


class Astray(NamedTuple):
    """How far a traced curve goes from what it is to draw: at most, and beyond what the points allow."""

    curve_distance: float
    excursion: float


def astray(
    place: Callable[[Real], Complex], used: tuple[float, float], points: Complex, closed: bool, missed: float
) -> Astray:
    """The farthest that a point goes from the polygon through the points, between two inputs.

    Parameters
    ----------
    place : callable
        Where the point is at inputs (n,), shape (n,); NaN where there is no position.
    used : tuple of float
        The first and the last input that is used.
    points : ndarray, shape (n,)
        The points to be drawn, in order.
    closed : bool
        Whether the last point is joined to the first.
    missed : float
        By how much the points are missed at most, which is all that is known where nothing else can be reached.

    Returns
    -------
    Astray
        Both in the unit of the points.
    """
    inputs, places = followed(place, *used)
    off, beyond = distances(places, points, closed, missed)
    if np.isnan(off).all():
        return Astray(missed, 0.0)

    def near(which: int, values: Real) -> tuple[float, float]:
        at, least = least_near(lambda closer: -distances(place(closer), points, closed, missed)[which], inputs, -values)
        return at, -least

    at, farthest = near(0, off)
    _, excursion = near(1, beyond)
    _, there = distances(place(np.array([at])), points, closed, missed)
    return Astray(farthest, max(excursion, float(there[0])))


def followed(place: Callable[[Real], Complex], low: float, high: float) -> tuple[Real, Complex]:
    """Inputs, rising, and the places there, none farther from the next than :data:`STEP` where there is a way between.

    NaN where there is no position.
    """
    inputs = np.linspace(low, high, CURVE_STEPS + 1)
    places = place(inputs)
    known = places[~np.isnan(places)]
    longest = STEP * math.hypot(np.ptp(known.real), np.ptp(known.imag)) if len(known) else 0.0
    for _ in range(HALVINGS):
        wide = np.flatnonzero(np.abs(np.diff(places)) > longest)
        between = 0.5 * (inputs[wide] + inputs[wide + 1])
        new = (inputs[wide] < between) & (between < inputs[wide + 1])  # not next to one another already
        if not new.any():
            break
        wide, between = wide[new], between[new]
        inputs, places = np.insert(inputs, wide + 1, between), np.insert(places, wide + 1, place(between))
    return inputs, places


def distances(places: Complex, points: Complex, closed: bool, missed: float) -> tuple[Real, Real]:
    """Distances of places from the polygon (closed) or chain of straight lines through points; NaN for no place.

    The second is what a distance is beyond ``missed``, by which the points themselves are missed, and :data:`BULGE` of
    the length of the side that is nearest; at least 0.
    """
    ends = np.roll(points, -1) if closed else points[1:]
    starts = points if closed else points[:-1]
    sides = ends - starts
    squares = np.maximum(sides.real**2 + sides.imag**2, np.finfo(float).tiny)
    allowed = missed + BULGE * np.abs(sides)
    nearest, beyond = np.empty(len(places)), np.empty(len(places))
    for first in range(0, len(places), ROWS):
        rows = slice(first, min(first + ROWS, len(places)))
        gaps = places[rows, None] - starts
        share = np.clip((gaps.real * sides.real + gaps.imag * sides.imag) / squares, 0.0, 1.0)
        off = np.abs(gaps - share * sides)
        nearest[rows] = off.min(axis=1)
        beyond[rows] = np.maximum(off - allowed, 0.0).min(axis=1)
    return nearest, beyond
