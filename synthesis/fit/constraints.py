"""Demands on a fourbar as margins over its chart: what must not be negative, or must be zero, with its derivatives.

A demand is a smooth function g ≥ 0, or h = 0, of the unknowns (:mod:`synthesis.fit.chart`). Each is written once, here.
It steers every fit that appends the rows of :func:`compute_margins` to its residuals
(:mod:`synthesis.numerics.augmented_lagrangian`). A demand that is not stated has an infinite margin and costs nothing.

=================== ==== ==========================================================
demand              g, h margin
=================== ==== ==========================================================
link lengths        g    ln(l / least), ln(most / l), so that short and long weigh alike
link ratio          g    ln(ratio · lᵢ / lₖ)
pivot regions       g    distance from each side of a box
moving pivots       g    the same of A and B, where the crank stands at the first end of the used range
coupler point       g    distance from each side of a box in the coupler's frame
transmission angle  g    cos γ_least ∓ cos γ, cos γ = (b² + c² − d² − a² + 2 a d cos φ) / 2bc
Grashof             g    ln(sₖ / least share of all links): away from change points
given pivots        h    distance along each axis
=================== ==== ==========================================================

Between two passages of the crank over the ground line cos γ is monotonic: it is held at the ends of the used range, and
at φ = 0 and φ = π where they are used.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Real
from kinematics.compiling import njit
from synthesis.fit.chart import FOURBAR, LENGTHS, OPTIONS, POINT
from synthesis.fit.coupler_curve import place_with_slopes

FAMILY_INDEX, SIGN_INDEX, FULL_TURN_INDEX = range(3)
"""Indices in a setting: the chart's family, the assembly sign, and whether the crank rotates fully."""

LINKS, RATIO, BOXES, POINT_BOX, COSINE, CHANGE_POINT, GIVEN_PIVOTS, MOVING = 3, 5, 6, 14, 18, 19, 20, 24
"""Places of demands in a setting: least and most length, link ratio, boxes (x from, to, y from, to) of O2 and O4, of P
on the coupler, cosine of the least transmission angle, least of s₁, s₂, s₃ as a share of all links together, given
coordinates (O2, O4; NaN where open), box of both A and B. Infinite where nothing is demanded; 0 for a least length or
share."""

SETTING_SIZE = 28
"""Number of entries of a setting that are constraints; a fit's own entries follow them."""

EQUATION_COUNT = 4
"""Number of margins, the last ones, that must be zero: coordinates of given pivots."""

PIVOT_MARGIN = 8 + 12
"""The first margin of the fixed pivots' boxes."""

LIMIT_COUNT = PIVOT_MARGIN + 8 + 4 + 8 + 8 + 3 + EQUATION_COUNT
"""Margins: lengths, pairs of them, sides of the fixed pivots' boxes, of P's and of the moving pivots', transmission,
Grashof, given pivots."""


@njit(**OPTIONS)
def compute_margins(
    x: Real, lengths: Real, slopes: Real, ends: Real, turn: Real, setting: Real, values: Real, gradients: Real
) -> None:
    """Compute the margins of a fourbar's constraints, and their derivatives by the unknowns.

    Parameters
    ----------
    x : float64, shape (n,)
        Unknowns of the chart, 9, and others of the fit behind them.
    lengths, slopes : float64, shapes (4,) and (4, 4)
        Of :func:`synthesis.fit.chart.compute_lengths`.
    ends : float64, shape (2,)
        Crank angles from the ground line at the ends of the used range. Transmission angles take them for fixed.
    turn : float64, shape (n,)
        Derivatives of the first of them by the unknowns.
    setting : float64, shape (DEMANDS or more,)
        See :data:`LINKS`.
    values, gradients : float64, shapes (LIMITS,) and (LIMITS, n)
        Written; gradients only where the value is finite.
    """
    values[:] = np.inf
    first = _write_length_margins(lengths, slopes, setting, values, gradients, 0)
    first = _write_ratio_margins(lengths, slopes, setting, values, gradients, first)
    first = _write_pivot_margins(x, lengths, slopes, setting, values, gradients, first)
    first = _write_coupler_point_margins(x, setting, values, gradients, first)
    first = _write_moving_pivot_margins(x, lengths, slopes, ends[0], turn, setting, values, gradients, first)
    first = _write_transmission_margins(lengths, slopes, ends, setting, values, gradients, first)
    if setting[FAMILY_INDEX] < FOURBAR and setting[CHANGE_POINT] > 0.0:
        around = lengths.sum()
        for k in range(3):
            values[first + k] = x[LENGTHS + 1 + k] - math.log(setting[CHANGE_POINT] * around)
            row = gradients[first + k]
            row[:] = 0.0
            for j in range(4):
                row[LENGTHS + j] = (1.0 if j == k + 1 else 0.0) - slopes[:, j].sum() / around


@njit(**OPTIONS)
def _write_length_margins(
    lengths: Real, slopes: Real, setting: Real, values: Real, gradients: Real, number: int
) -> int:
    """Logarithmic margins of all links from the least and the greatest length, from margin ``number`` on; the next."""
    for i in range(4):
        for side in range(2):
            limit = setting[LINKS + side]
            if 0.0 < limit < np.inf:
                toward = 1.0 if side == 0 else -1.0
                values[number] = toward * math.log(lengths[i] / limit)
                row = gradients[number]
                row[:] = 0.0
                for j in range(4):
                    row[LENGTHS + j] = toward * slopes[i, j] / lengths[i]
            number += 1
    return number


@njit(**OPTIONS)
def _write_ratio_margins(lengths: Real, slopes: Real, setting: Real, values: Real, gradients: Real, number: int) -> int:
    """Margins of every ordered pair of links from the greatest ratio: smooth, unlike that of longest to shortest."""
    if setting[RATIO] == np.inf:
        return number + 12
    for i in range(4):
        for k in range(4):
            if i == k:
                continue
            values[number] = math.log(setting[RATIO] * lengths[i] / lengths[k])
            row = gradients[number]
            row[:] = 0.0
            for j in range(4):
                row[LENGTHS + j] = slopes[i, j] / lengths[i] - slopes[k, j] / lengths[k]
            number += 1
    return number


@njit(**OPTIONS)
def _write_pivot_margins(
    x: Real, lengths: Real, slopes: Real, setting: Real, values: Real, gradients: Real, number: int
) -> int:
    """Sides of the boxes of O2 and O4, and, as the last margins of all, their given coordinates."""
    for pivot in range(2):
        for axis in range(2):
            for side in range(2):
                limit = setting[BOXES + 4 * pivot + 2 * axis + side]
                if abs(limit) < np.inf:
                    toward = 1.0 if side == 0 else -1.0
                    place = _compute_coordinate(x, lengths, slopes, pivot, axis, toward, gradients[number])
                    values[number] = toward * (place - limit)
                number += 1
            given = setting[GIVEN_PIVOTS + 2 * pivot + axis]
            if not math.isnan(given):
                at = LIMIT_COUNT - EQUATION_COUNT + 2 * pivot + axis
                values[at] = _compute_coordinate(x, lengths, slopes, pivot, axis, 1.0, gradients[at]) - given
    return number


@njit(**OPTIONS)
def _compute_coordinate(x: Real, lengths: Real, slopes: Real, pivot: int, axis: int, toward: float, row: Real) -> float:
    """A coordinate of O2 (pivot 0) or O4 (1); ``row`` gets its derivatives, with the sign ``toward``."""
    row[:] = 0.0
    row[axis] = toward
    place: float = x[axis]
    if pivot == 1:
        cosine, sine = math.cos(x[2]), math.sin(x[2])
        direction, turned = (cosine, -sine) if axis == 0 else (sine, cosine)
        place += lengths[0] * direction
        row[2] = toward * lengths[0] * turned
        for j in range(4):
            row[LENGTHS + j] = toward * slopes[0, j] * direction
    return place


@njit(**OPTIONS)
def _write_coupler_point_margins(x: Real, setting: Real, values: Real, gradients: Real, number: int) -> int:
    """Distances of P from the sides of its box in the coupler's frame."""
    for axis in range(2):
        for side in range(2):
            limit = setting[POINT_BOX + 2 * axis + side]
            if abs(limit) < np.inf:
                toward = 1.0 if side == 0 else -1.0
                values[number] = toward * (x[POINT + axis] - limit)
                gradients[number] = 0.0
                gradients[number, POINT + axis] = toward
            number += 1
    return number


@njit(**OPTIONS)
def _write_moving_pivot_margins(
    x: Real,
    lengths: Real,
    slopes: Real,
    angle: float,
    turn: Real,
    setting: Real,
    values: Real,
    gradients: Real,
    number: int,
) -> int:
    """Distances of A and B from the sides of their box, with the crank at ``angle`` from the ground line.

    A moving pivot is a point of the coupler with the coordinates (0, 0) or (b, 0), and moves as P does.
    """
    box = setting[MOVING : MOVING + 4]
    if not (np.abs(box) < np.inf).any():
        return number + 8
    by, pin = np.empty(10, np.complex128), x[: POINT + 2].copy()
    for pivot in range(2):
        pin[POINT], pin[POINT + 1] = pivot * lengths[2], 0.0
        closes, place = place_with_slopes(FOURBAR, pin, lengths, slopes, setting[SIGN_INDEX], 0.0, x[2] + angle, by)
        if not closes:
            return number + 8 - 4 * pivot
        by[2] += by[9]
        for axis in range(2):
            for side in range(2):
                limit = box[2 * axis + side]
                if abs(limit) < np.inf:
                    toward = 1.0 if side == 0 else -1.0
                    values[number] = toward * ((place.real if axis == 0 else place.imag) - limit)
                    row = gradients[number]
                    for j in range(len(row)):
                        moved = by[9] * turn[j]
                        if j < POINT:
                            moved += by[j]
                        if pivot == 1 and LENGTHS <= j < POINT:
                            moved += by[POINT] * slopes[2, j - LENGTHS]
                        row[j] = toward * (moved.real if axis == 0 else moved.imag)
                number += 1
    return number


@njit(**OPTIONS)
def _write_transmission_margins(
    lengths: Real, slopes: Real, ends: Real, setting: Real, values: Real, gradients: Real, number: int
) -> int:
    """Margins of cos γ at φ = 0, φ = π and both ends of the range, each from above and from below."""
    if setting[COSINE] == np.inf:
        return number + 8
    d, a, b, c = lengths[0], lengths[1], lengths[2], lengths[3]
    by = np.empty(4)
    low, high = min(ends[0], ends[1]), max(ends[0], ends[1])
    for k in range(4):
        used = True
        if k < 2:
            # The multiple of a half turn, even or odd, that lies in the range.
            first = 2.0 * math.pi * math.ceil((low - k * math.pi) / (2.0 * math.pi)) + k * math.pi
            used = setting[FULL_TURN_INDEX] > 0.0 or first <= high
            cosine = 1.0 - 2.0 * k
        else:
            cosine = math.cos(ends[k - 2])
        ratio = (b * b + c * c - d * d - a * a + 2.0 * a * d * cosine) / (2.0 * b * c)
        by[0], by[1] = (a * cosine - d) / (b * c), (d * cosine - a) / (b * c)
        by[2], by[3] = 1.0 / c - ratio / b, 1.0 / b - ratio / c
        for side in range(2):
            if used:
                toward = 1.0 if side == 0 else -1.0
                values[number] = setting[COSINE] - toward * ratio
                row = gradients[number]
                row[:] = 0.0
                for j in range(4):
                    for i in range(4):
                        row[LENGTHS + j] -= toward * by[i] * slopes[i, j]
            number += 1
    return number
