"""Deviation of a traced curve from the course of the points that it must draw, over the whole used range.

A linkage that passes all points may stray far between two of them. Over the used range (a full turn for a closed curve,
from the first point to the last for an open one) every place on the traced curve is compared with the course:

* with the straight lines through the points, which gives the distance;
* with these lines, widened by the bulge that a curve may have between points (:data:`BULGE_RATIO` of their lengths) and
  by the error at the points themselves, which gives the excursion: the part that the points do not justify;
* if points have tolerances, with the lines, each widened by the bulge of the smooth curve through the points.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from kinematics.linkage.refined_extremes import find_minimum_near

CURVE_STEP_COUNT = 1440
"""Number of input steps at which the curve is compared with the target: a quarter of a degree for a full turn."""

BULGE_RATIO = 0.25
"""Maximum bulge of a curve between two points, as a share of their distance: that of an arc of a hundred degrees. A
deviation beyond it is an excursion that the points do not show."""

MAX_STEP_RATIO, MAX_BISECTIONS = 0.01, 40
"""Longest step between neighbouring places, as a share of the curve's size, and the maximum number of bisections of an
input step to reach it: near a change point a linkage runs over much of its curve in a tiny range of its input."""

SMOOTH_SAMPLE_COUNT, SMOOTH_PASS_COUNT = 33, 5
"""Number of places between two points at which the smooth curve's distance from the straight line is evaluated, and
number of passes, each sixteen times finer, around the maximum."""


class CurveDeviation(NamedTuple):
    """Deviation of a traced curve from the lines through the points: maximum distance, and maximum excursion."""

    curve_distance: float
    excursion: float


class Course(NamedTuple):
    """Straight lines from point to point: start, vector, and allowed deviation of each, shapes (n,)."""

    starts: Complex
    sides: Complex
    allowed: Real


def build_course(points: Complex, closed: bool, missed: float) -> Course:
    """Return the lines through points, closed or as an open chain, with their permitted deviations.

    A deviation consists of the bulge (:data:`BULGE_RATIO`) and of ``missed``, the distance by which the points are
    missed.
    """
    starts = points if closed else points[:-1]
    sides = (np.roll(points, -1) if closed else points[1:]) - starts
    return Course(starts, sides, missed + BULGE_RATIO * np.abs(sides))


def build_tolerated_course(points: Complex, closed: bool, tolerances: Real) -> tuple[Course, Real]:
    """Return the lines through points, with the bulge of the smooth curve through them, and the lines' tolerances.

    The smooth curve is the cubic spline over the chords; no bulge exceeds :data:`BULGE_RATIO`. A line has the larger of
    the tolerances at its two ends.
    """
    # Tolerances already allow for the miss at the points themselves.
    lines = build_course(points, closed, 0.0)
    whole = np.append(points, points[0]) if closed else points
    # Repeated points would give the spline equal knots.
    knots, first = np.unique(np.concatenate([[0.0], np.cumsum(np.abs(np.diff(whole)))]), return_index=True)
    corners = whole[first]
    if closed:
        # A periodic spline requires bitwise equal ends.
        corners[-1] = corners[0]
    spline = CubicSpline(knots, corners, bc_type="periodic" if closed else "not-a-knot")
    lengths = np.abs(lines.sides)
    begin = np.concatenate([[0.0], np.cumsum(lengths)[:-1]])
    bulges = _measure_bulges(spline, begin, lengths, lines)
    ends = np.append(tolerances, tolerances[0]) if closed else tolerances
    return lines._replace(allowed=np.minimum(bulges, lines.allowed)), np.maximum(ends[1:], ends[:-1])


def measure_excursion(
    place: Callable[[Real], Complex], used: tuple[float, float], points: Complex, closed: bool, missed: float
) -> CurveDeviation:
    """Return the maximum distance of a moving point from the lines through given points, and its excursion.

    Parameters
    ----------
    place : callable
        Position of the moving point at inputs (n,), shape (n,); NaN where there is none.
    used : tuple of float
        The first and the last input that is used.
    points : ndarray, shape (n,)
        The points to be drawn, in order.
    closed : bool
        Whether the last point is joined to the first.
    missed : float
        Maximum distance by which the points are missed; the only measure left if the linkage has no position at all.

    Returns
    -------
    CurveDeviation
        Both in the unit of the points.
    """
    inputs, places = sample_curve(place, *used)
    course = build_course(points, closed, missed)
    off, beyond = measure_distances(places, course)
    if np.isnan(off).all():
        return CurveDeviation(missed, 0.0)

    def refine_maximum(which: int, values: Real) -> tuple[float, float]:
        at, least = find_minimum_near(lambda closer: -measure_distances(place(closer), course)[which], inputs, -values)
        return at, -least

    at, farthest = refine_maximum(0, off)
    _, excursion = refine_maximum(1, beyond)
    # The maximum distance often occurs at the maximum excursion, so that this input is evaluated for both.
    _, there = measure_distances(place(np.array([at])), course)
    return CurveDeviation(farthest, max(excursion, float(there[0])))


def compute_two_way_rms(
    place: Callable[[Real], Complex], used: tuple[float, float], points: Complex, closed: bool, misses: Real
) -> float:
    """Return the RMS distance between points and a curve, in both directions.

    It combines the points' distances from the curve, ``misses``, and the curve's distances from the lines through the
    points. The curve is weighted by its length, and both directions count equally. The other parameters are those of
    :func:`measure_excursion`.
    """
    _, places = sample_curve(place, *used)
    off, _ = measure_distances(places, build_course(points, closed, 0.0))
    steps = np.abs(np.diff(places))
    known = np.isfinite(steps)
    # Trapezoidal rule over the arc length of the curve.
    squares = 0.5 * (off[1:] ** 2 + off[:-1] ** 2)
    # The smallest positive number keeps a curve of no length from dividing by zero.
    back = float((squares[known] * steps[known]).sum() / max(float(steps[known].sum()), math.ulp(0.0)))
    return math.sqrt(0.5 * (float(np.mean(misses**2)) + back))


def compute_tolerance_used(
    place: Callable[[Real], Complex], used: tuple[float, float], points: Complex, closed: bool, tolerances: Real
) -> float:
    """Return the maximum share of its tolerance that a traced curve uses anywhere; see :func:`build_tolerated_course`.

    Parameters are those of :func:`measure_excursion`, and the tolerances of the points, shape (n,).
    """
    lines, widths = build_tolerated_course(points, closed, tolerances)
    inputs, places = sample_curve(place, *used)

    def evaluate_shares(at: Complex) -> Real:
        return -_compute_tolerance_shares(at, lines.starts, lines.sides, lines.allowed, widths)

    _, least = find_minimum_near(lambda closer: evaluate_shares(place(closer)), inputs, evaluate_shares(places))
    return 0.0 if math.isnan(least) else -least


def sample_curve(place: Callable[[Real], Complex], low: float, high: float) -> tuple[Real, Complex]:
    """Return increasing inputs and the positions at them, NaN where the linkage has none.

    Inputs are added until no step exceeds :data:`MAX_STEP_RATIO` of the curve's size.
    """
    inputs = np.linspace(low, high, CURVE_STEP_COUNT + 1)
    places = place(inputs)
    known = places[~np.isnan(places)]
    # The diagonal of the traced curve measures its size; without any position nothing is refined.
    longest = MAX_STEP_RATIO * math.hypot(np.ptp(known.real), np.ptp(known.imag)) if len(known) else 0.0
    for _ in range(MAX_BISECTIONS):
        wide = np.flatnonzero(np.abs(np.diff(places)) > longest)
        between = 0.5 * (inputs[wide] + inputs[wide + 1])
        new = (inputs[wide] < between) & (between < inputs[wide + 1])  # not next to one another already
        if not new.any():
            break
        wide, between = wide[new], between[new]
        inputs, places = np.insert(inputs, wide + 1, between), np.insert(places, wide + 1, place(between))
    return inputs, places


def measure_distances(places: Complex, course: Course) -> tuple[Real, Real]:
    """Return the distances of places from the lines of a course, and their excess over the allowance, at least 0.

    The excess is the minimum over all lines. Both are NaN where a place is NaN.
    """
    unit = np.ones(len(course.starts))
    off = _compute_tolerance_shares(places, course.starts, course.sides, np.zeros(len(course.starts)), unit)
    return off, _compute_tolerance_shares(places, course.starts, course.sides, course.allowed, unit)


@njit(cache=True, nogil=True)
def _measure_distance(place: complex, start: complex, side: complex) -> float:
    """Return the distance of a place from a line segment."""
    gap = place - start
    square = side.real * side.real + side.imag * side.imag
    along = gap.real * side.real + gap.imag * side.imag
    share = min(max(along / square, 0.0), 1.0) if square > 0.0 else 0.0
    x, y = gap.real - share * side.real, gap.imag - share * side.imag
    return math.sqrt(x * x + y * y)


def _measure_bulges(smooth: CubicSpline, begin: Real, lengths: Real, lines: Course) -> Real:
    """Return the maximum distance of the smooth curve from each line that it spans.

    ``begin`` contains the curve's parameter at the start of each line.
    """
    low, high = np.zeros(len(begin)), np.ones(len(begin))
    found = np.zeros(len(begin))
    for _ in range(SMOOTH_PASS_COUNT):
        shares = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, SMOOTH_SAMPLE_COUNT)
        off = _measure_segment_distances(smooth(begin[:, None] + lengths[:, None] * shares), lines.starts, lines.sides)
        best, step = (
            np.take_along_axis(shares, off.argmax(axis=1)[:, None], 1)[:, 0],
            (high - low) / (SMOOTH_SAMPLE_COUNT - 1),
        )
        found = np.maximum(found, off.max(axis=1))
        # Zoom in on the two steps around the maximum.
        low, high = np.maximum(best - step, 0.0), np.minimum(best + step, 1.0)
    return found


@njit(cache=True, nogil=True)
def _measure_segment_distances(places: Complex, starts: Complex, sides: Complex) -> Real:
    """Return the distances of places from their lines, shape (lines, places)."""
    out = np.empty(places.shape)
    for k in range(len(starts)):
        for n in range(places.shape[1]):
            out[k, n] = _measure_distance(places[k, n], starts[k], sides[k])
    return out


@njit(cache=True, nogil=True)
def _compute_tolerance_shares(places: Complex, starts: Complex, sides: Complex, allowed: Real, widths: Real) -> Real:
    """Return for each place the minimum over all lines of its distance beyond the allowance, over the line's width."""
    out = np.empty(len(places))
    for i in range(len(places)):
        if math.isnan(places[i].real) or math.isnan(places[i].imag):
            out[i] = math.nan
            continue
        least = math.inf
        for k in range(len(starts)):
            least = min(least, (_measure_distance(places[i], starts[k], sides[k]) - allowed[k]) / widths[k])
        out[i] = max(least, 0.0)
    return out
