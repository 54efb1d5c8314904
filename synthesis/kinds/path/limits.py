"""A client's limits on a fourbar that guides a point, as numbers for compiled code, in task coordinates.

A limit is a smooth function g ≥ 0 (or h = 0 for a coordinate of a pivot that is given) of the nine numbers of the
linkage. What is not limited is infinite, and costs nothing.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from synthesis.kinds.path.coupler_curve import LENGTHS, POINT
from synthesis.kinds.path.problem import PathProblem
from synthesis.model.linkage_statement import Region

Real = NDArray[np.float64]

SIGN, SHORTEST, TIMED, PHASED, CLOSED, ORDERED = range(6)
"""Places in a setting: assembly sign, the shortest link's number, whether timing is prescribed, what crank angles are
measured from, whether the curve is closed, whether points are met in order."""

LINKS, RATIO, O2_BOX, O4_BOX, POINT_BOX, COSINE, GIVEN = 6, 8, 9, 13, 17, 21, 22
"""Places of limits in a setting: shortest and longest link, link ratio, boxes (x from, to, y from, to) of O2 and O4,
of P on the coupler, cosine of the least transmission angle, given coordinates (O2, O4; NaN where open)."""

SETTING = 26
"""Numbers of a setting."""

LIMITS = 8 + 12 + 8 + 4 + 8 + 3 + 4
"""Limits that there can be, each with a multiplier: lengths, pairs of them, pivots, P, transmission, Grashof, given."""

FREE, ABSOLUTE, GROUND_LINE = range(3)
"""What crank angles are measured from."""

LONGEST = 50.0
"""Links of more task sizes are looked for only where the client allows them: fits run off to sliders otherwise."""

SHORTEST_SHARE = 1e-4
"""No link is shorter than this share of the task's size; it could not be drawn, let alone be built."""

GRASHOF = 1e-6
"""Least of s₁, s₂, s₃ as a share of all links together: nearer to a change point a linkage counts as one."""

INSIDE = 1e-10
"""Limits are drawn in by this share, so that what rounding leaves lies on their right side."""


class Usable(NamedTuple):
    """What makes a linkage usable where a client does not say: least transmission angle (degrees), link ratio, and the
    longest link in task sizes."""

    transmission: float
    ratio: float
    longest: float


def setting_of(
    problem: PathProblem, origin: complex, size: float, *, sign: float, shortest: int, usable: Usable | None = None
) -> Real:
    """A problem's limits for one class of fourbars and one assembly, with ``origin`` at 0 and ``size`` at 1."""
    limits = problem.constraints
    out = np.full(SETTING, math.inf)
    out[SIGN], out[SHORTEST] = sign, shortest
    out[TIMED], out[CLOSED] = problem.prescribed, problem.closed
    out[PHASED] = ("free", "absolute", "ground_line").index(problem.crank_phase)
    out[ORDERED] = limits.in_order
    least, most = SHORTEST_SHARE, LONGEST
    if limits.link_length is not None:
        least = max(limits.link_length.min / size, SHORTEST_SHARE)
        most = LONGEST if limits.link_length.max is None else limits.link_length.max / size
    if usable is not None:
        most = min(most, max(usable.longest, 2.0 * least))
        out[RATIO] = usable.ratio
        out[COSINE] = math.cos(math.radians(usable.transmission))
    out[LINKS], out[LINKS + 1] = least * (1.0 + INSIDE), most * (1.0 - INSIDE)
    if limits.max_link_ratio is not None:
        out[RATIO] = min(out[RATIO], limits.max_link_ratio * (1.0 - INSIDE))
    out[O2_BOX : O2_BOX + 4] = _box([limits.fixed_pivot_region, limits.input_pivot_region], origin, size)
    out[O4_BOX : O4_BOX + 4] = _box([limits.fixed_pivot_region], origin, size)
    out[POINT_BOX : POINT_BOX + 4] = -math.inf, math.inf, -math.inf, math.inf
    if limits.coupler_point is not None:
        for k, interval in enumerate((limits.coupler_point.along, limits.coupler_point.across)):
            if interval is not None:
                out[POINT_BOX + 2 * k : POINT_BOX + 2 * k + 2] = interval[0] / size, interval[1] / size
    if limits.min_transmission_angle is not None:
        out[COSINE] = min(out[COSINE], math.cos(math.radians(limits.min_transmission_angle)) * (1.0 - INSIDE))
    out[GIVEN:] = math.nan
    for k, pivot in enumerate((problem.fixed_pivots.input, problem.fixed_pivots.output)):
        x, y = pivot or (None, None)
        if x is not None:
            out[GIVEN + 2 * k] = (x - origin.real) / size
        if y is not None:
            out[GIVEN + 2 * k + 1] = (y - origin.imag) / size
    return out


def _box(regions: list[Region | None], origin: complex, size: float) -> tuple[float, float, float, float]:
    """What regions have in common; everything where there is none."""
    x, y = (-math.inf, math.inf), (-math.inf, math.inf)
    for region in regions:
        if region is not None:
            x = max(x[0], (region.x[0] - origin.real) / size), min(x[1], (region.x[1] - origin.real) / size)
            y = max(y[0], (region.y[0] - origin.imag) / size), min(y[1], (region.y[1] - origin.imag) / size)
    return *x, *y


@njit(cache=True, nogil=True)
def _row(
    number: int, value: float, slope: Real, multipliers: Real, residuals: Real, jacobian: Any, m: int, equal: bool
) -> int:
    """Add the residual of a limit, where it bears a load; a multiplier below 0 stands for an equation's either sign."""
    weight = multipliers[LIMITS]
    load = multipliers[number] / weight - value
    if not equal and load <= 0.0:
        return m
    root = math.sqrt(weight)
    residuals[m] = root * load
    for i in range(slope.size):
        jacobian[m, i] = -root * slope[i]
    return m + 1


@njit(cache=True, nogil=True)
def limit_rows(
    x: Real, lengths: Real, slopes: Real, ends: Real, setting: Real, multipliers: Real, residuals: Real, jacobian: Any,
    m: int, values: Real,
) -> int:  # fmt: skip
    """Add the limits' residuals from row m on; returns the number of rows.

    ``ends`` are the crank angles at the first and last point. The limits' values go into ``values``: of those that are
    equations, the negative magnitude.
    """
    slope = np.zeros(x.size)
    number = 0
    for i in range(4):
        for side in range(2):
            limit = setting[LINKS + side]
            toward = 1.0 if side == 0 else -1.0
            values[number] = np.inf
            if limit < np.inf:
                # Logarithms, so that short and long links weigh alike.
                value = toward * math.log(lengths[i] / limit)
                values[number] = value
                for j in range(4):
                    slope[LENGTHS + j] = toward * slopes[i, j] / lengths[i]
                m = _row(number, value, slope, multipliers, residuals, jacobian, m, False)
            number += 1
    for i in range(4):
        for k in range(4):
            if i == k:
                continue
            values[number] = np.inf
            if setting[RATIO] < np.inf:
                value = math.log(setting[RATIO] * lengths[i] / lengths[k])
                values[number] = value
                for j in range(4):
                    slope[LENGTHS + j] = slopes[i, j] / lengths[i] - slopes[k, j] / lengths[k]
                m = _row(number, value, slope, multipliers, residuals, jacobian, m, False)
            number += 1
    for j in range(4):
        slope[LENGTHS + j] = 0.0
    ct, st = math.cos(x[2]), math.sin(x[2])
    for pivot in range(2):
        for axis in range(2):
            place = x[axis]
            direction = ct if axis == 0 else st
            if pivot == 1:
                place += lengths[0] * direction
            slope[axis] = 1.0
            if pivot == 1:
                slope[2] = -lengths[0] * st if axis == 0 else lengths[0] * ct
                for j in range(4):
                    slope[LENGTHS + j] = slopes[0, j] * direction
            for side in range(2):
                limit = setting[(O2_BOX if pivot == 0 else O4_BOX) + 2 * axis + side]
                values[number] = np.inf
                if abs(limit) < np.inf:
                    if side == 1:
                        slope[:] = -slope
                    value = place - limit if side == 0 else limit - place
                    values[number] = value
                    m = _row(number, value, slope, multipliers, residuals, jacobian, m, False)
                    if side == 1:
                        slope[:] = -slope
                number += 1
            given = setting[GIVEN + 2 * pivot + axis]
            at = LIMITS - 4 + 2 * pivot + axis
            values[at] = np.inf
            if not math.isnan(given):
                values[at] = -abs(place - given)
                m = _row(at, place - given, slope, multipliers, residuals, jacobian, m, True)
            slope[:] = 0.0
    for axis in range(2):
        for side in range(2):
            limit = setting[POINT_BOX + 2 * axis + side]
            values[number] = np.inf
            if abs(limit) < np.inf:
                toward = 1.0 if side == 0 else -1.0
                values[number] = toward * (x[POINT + axis] - limit)
                slope[POINT + axis] = toward
                m = _row(number, values[number], slope, multipliers, residuals, jacobian, m, False)
                slope[POINT + axis] = 0.0
            number += 1
    m = _transmission(x, lengths, slopes, ends, setting, multipliers, residuals, jacobian, m, values, number)
    number += 8
    around = lengths.sum()
    for k in range(1, 4):
        values[number] = np.inf
        if setting[SHORTEST] >= 0.0:
            values[number] = x[LENGTHS + k] - math.log(GRASHOF * around)
            for j in range(4):
                slope[LENGTHS + j] = (1.0 if j == k else 0.0) - slopes[:, j].sum() / around
            m = _row(number, values[number], slope, multipliers, residuals, jacobian, m, False)
        number += 1
    return m


@njit(cache=True, nogil=True)
def _transmission(
    x: Real, lengths: Real, slopes: Real, ends: Real, setting: Real, multipliers: Real, residuals: Real, jacobian: Any,
    m: int, values: Real, number: int,
) -> int:  # fmt: skip
    """Least transmission angles: where the crank passes the ground line, and at the ends of the used range.

    cos γ = (b² + c² − f²) / 2bc with f² = d² + a² − 2 a d cos φ.
    """
    d, a, b, c = lengths[0], lengths[1], lengths[2], lengths[3]
    slope = np.zeros(x.size)
    by = np.empty(4)
    low, high = min(ends[0], ends[1]), max(ends[0], ends[1])
    for k in range(4):
        used = setting[COSINE] < np.inf
        if k < 2:
            # The multiple of a half turn, even or odd, that lies in the range.
            first = 2.0 * math.pi * math.ceil((low - k * math.pi) / (2.0 * math.pi)) + k * math.pi
            used = used and (setting[CLOSED] > 0.0 or first <= high)
            cosine = 1.0 - 2.0 * k
        else:
            cosine = math.cos(ends[k - 2])
        for side in range(2):
            values[number] = np.inf
            if used:
                ratio = (b * b + c * c - d * d - a * a + 2.0 * a * d * cosine) / (2.0 * b * c)
                by[0], by[1] = (a * cosine - d) / (b * c), (d * cosine - a) / (b * c)
                by[2], by[3] = 1.0 / c - ratio / b, 1.0 / b - ratio / c
                toward = 1.0 if side == 0 else -1.0
                values[number] = setting[COSINE] - toward * ratio
                for j in range(4):
                    slope[LENGTHS + j] = 0.0
                    for i in range(4):
                        slope[LENGTHS + j] -= toward * by[i] * slopes[i, j]
                m = _row(number, values[number], slope, multipliers, residuals, jacobian, m, False)
            number += 1
    return m


@njit(cache=True, nogil=True)
def renew(multipliers: Real, values: Real, setting: Real, x: Real, lengths: Real) -> float:
    """Multipliers for the next descent from the limits' values at the end of the last; the largest violation."""
    weight = multipliers[LIMITS]
    worst = 0.0
    for k in range(LIMITS - 4):
        if values[k] < np.inf:
            multipliers[k] = max(0.0, multipliers[k] - weight * values[k])
            worst = max(worst, -values[k])
    ct, st = math.cos(x[2]), math.sin(x[2])
    for k in range(4):
        given = setting[GIVEN + k]
        if not math.isnan(given):
            off = x[k % 2] - given
            if k >= 2:
                off += lengths[0] * (ct if k == 2 else st)
            multipliers[LIMITS - 4 + k] -= weight * off
            worst = max(worst, abs(off))
    return worst
