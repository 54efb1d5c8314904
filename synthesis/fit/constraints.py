"""Constraints on a fourbar as margins over its chart, with their derivatives.

A constraint is a smooth function g ≥ 0, or h = 0, of the unknowns (:mod:`synthesis.fit.chart`). Each is defined once,
here, and guides every fit that appends the rows of :func:`compute_margins` to its residuals
(:mod:`synthesis.numerics.augmented_lagrangian`). A constraint that is not requested has an infinite margin and no cost.

=================== ==== ==========================================================
constraint          g, h margin
=================== ==== ==========================================================
link lengths        g    ln(l / minimum), ln(maximum / l), so that short and long weigh alike
link ratio          g    ln(ratio · lᵢ / lₖ)
pivot regions       g    distance from each side of a box
moving pivots       g    the same for A and B, with the crank at the first end of the used range
coupler point       g    distance from each side of a box in the coupler's frame
transmission angle  g    cos γ_min ∓ cos γ, cos γ = (b² + c² − d² − a² + 2 a d cos φ) / 2bc
Grashof             g    ln(sₖ / minimum share of all links): away from change points
given pivots        h    distance along each axis
=================== ==== ==========================================================

Between two passages of the crank over the ground line cos γ is monotonic. It is therefore limited only at the ends of
the used range, and at φ = 0 and φ = π if the range contains them.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Real
from kinematics.compiling import njit
from synthesis.fit.chart import FOURBAR, LENGTHS, OPTIONS, POINT
from synthesis.fit.coupler_curve import place_with_slopes
from synthesis.numerics.array_layout import ArrayLayout

SETTING = ArrayLayout(
    family=1,
    sign=1,
    full_turn=1,
    links=2,
    ratio=1,
    input_box=4,
    output_box=4,
    point_box=4,
    cosine=1,
    change_point=1,
    given_pivots=4,
    moving_box=4,
)
"""Layout of a fit's setting: a linkage's type and its constraints. An absent constraint is infinite, an absent minimum
length or share is 0."""

FAMILY_INDEX, SIGN_INDEX = SETTING.index("family"), SETTING.index("sign")
"""The chart's family, and the assembly sign."""

FULL_TURN_INDEX = SETTING.index("full_turn")
"""Whether the crank rotates fully."""

LINKS, RATIO = SETTING.slice("links"), SETTING.index("ratio")
"""Minimum and maximum length of a link, and maximum link ratio."""

INPUT_BOX, OUTPUT_BOX = SETTING.slice("input_box"), SETTING.slice("output_box")
"""Boxes of O2 and of O4, each as minimum x, maximum x, minimum y, maximum y."""

BOXES = SETTING.slice("input_box", "output_box")
"""Both of these boxes."""

POINT_BOX = SETTING.slice("point_box")
"""Box of P on the coupler."""

COSINE = SETTING.index("cosine")
"""Cosine of the minimum transmission angle."""

CHANGE_POINT = SETTING.index("change_point")
"""Minimum of s₁, s₂, s₃ as a share of all links together."""

GIVEN_PIVOTS = SETTING.slice("given_pivots")
"""Given coordinates of O2 and O4; NaN if free."""

MOVING = SETTING.slice("moving_box")
"""Box of both A and B."""

SETTING_SIZE = SETTING.size
"""Number of entries of a setting that are constraints; a fit's own entries follow them."""

EQUATION_COUNT = 4
"""Number of margins, the last ones, that must be zero: coordinates of given pivots."""

PIVOT_MARGIN = 8 + 12
"""Number of the first margin of the fixed pivots' boxes: after 4 × 2 lengths and 12 ordered pairs of links."""

LIMIT_COUNT = PIVOT_MARGIN + 8 + 4 + 8 + 8 + 3 + EQUATION_COUNT
"""Number of margins: lengths, ordered pairs of links, sides of the boxes of the fixed pivots, of P and of the moving
pivots, transmission, Grashof, given pivots."""


@njit(**OPTIONS)
def compute_margins(
    x: Real, lengths: Real, slopes: Real, ends: Real, turn: Real, setting: Real, values: Real, gradients: Real
) -> None:
    """Compute the margins of a fourbar's constraints, and their derivatives by the unknowns.

    Parameters
    ----------
    x : float64, shape (n,)
        The 9 unknowns of the chart, followed by other unknowns of the fit.
    lengths, slopes : float64, shapes (4,) and (4, 4)
        Lengths and their derivatives by :func:`synthesis.fit.chart.compute_lengths`.
    ends : float64, shape (2,)
        Crank angles from the ground line at the ends of the used range. Transmission margins treat them as fixed.
    turn : float64, shape (n,)
        Derivatives of the first of these angles by the unknowns.
    setting : float64, shape (SETTING_SIZE or more,)
        See :data:`SETTING`.
    values, gradients : float64, shapes (LIMIT_COUNT,) and (LIMIT_COUNT, n)
        Output; gradients are written only where the value is finite.
    """
    # Infinite means "not requested": such a margin never bears a load, so its gradient is not written.
    values[:] = np.inf
    first = _write_length_margins(lengths, slopes, setting, values, gradients, 0)
    first = _write_ratio_margins(lengths, slopes, setting, values, gradients, first)
    first = _write_pivot_margins(x, lengths, slopes, setting, values, gradients, first)
    first = _write_coupler_point_margins(x, setting, values, gradients, first)
    first = _write_moving_pivot_margins(x, lengths, slopes, ends[0], turn, setting, values, gradients, first)
    first = _write_transmission_margins(lengths, slopes, ends, setting, values, gradients, first)
    # Only for Grashof classes: their chart itself keeps s > 0, and this margin keeps s away from 0, the change point.
    if setting[FAMILY_INDEX] < FOURBAR and setting[CHANGE_POINT] > 0.0:
        around = lengths.sum()
        for k in range(3):
            # The chart holds ln s, so the margin is linear in it, apart from the sum of all lengths.
            values[first + k] = x[LENGTHS + 1 + k] - math.log(setting[CHANGE_POINT] * around)
            row = gradients[first + k]
            row[:] = 0.0
            for j in range(4):
                row[LENGTHS + j] = (1.0 if j == k + 1 else 0.0) - slopes[:, j].sum() / around


@njit(**OPTIONS)
def _write_length_margins(
    lengths: Real, slopes: Real, setting: Real, values: Real, gradients: Real, number: int
) -> int:
    """Write the logarithmic margins of all links from both length limits, from margin ``number`` on.

    Return the number of the next margin.
    """
    for i in range(4):
        for side in range(2):
            limit = setting[LINKS][side]
            # A limit of 0 or ∞ is no constraint and would make the logarithm infinite.
            if 0.0 < limit < np.inf:
                toward = 1.0 if side == 0 else -1.0
                values[number] = toward * math.log(lengths[i] / limit)
                row = gradients[number]
                row[:] = 0.0
                for j in range(4):
                    row[LENGTHS + j] = toward * slopes[i, j] / lengths[i]
            # Count the margin even if it is unused: each constraint has a fixed place, to which its multiplier
            # belongs.
            number += 1
    return number


@njit(**OPTIONS)
def _write_ratio_margins(lengths: Real, slopes: Real, setting: Real, values: Real, gradients: Real, number: int) -> int:
    """Write the margins of all ordered pairs of links from the maximum ratio; return the next number."""
    if setting[RATIO] == np.inf:
        return number + 12
    # All pairs, because longest over shortest has kinks where two links change places.
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
    """Write the distances of O2 and O4 from the sides of their boxes and, as the last margins of all, from their given
    coordinates; return the number of the next margin."""
    for pivot in range(2):
        for axis in range(2):
            for side in range(2):
                limit = setting[BOXES][4 * pivot + 2 * axis + side]
                if abs(limit) < np.inf:
                    toward = 1.0 if side == 0 else -1.0
                    place = _compute_coordinate(x, lengths, slopes, pivot, axis, toward, gradients[number])
                    values[number] = toward * (place - limit)
                number += 1
            given = setting[GIVEN_PIVOTS][2 * pivot + axis]
            if not math.isnan(given):
                # Equations come after all inequalities, where the augmented Lagrangian expects them.
                at = LIMIT_COUNT - EQUATION_COUNT + 2 * pivot + axis
                values[at] = _compute_coordinate(x, lengths, slopes, pivot, axis, 1.0, gradients[at]) - given
    return number


@njit(**OPTIONS)
def _compute_coordinate(x: Real, lengths: Real, slopes: Real, pivot: int, axis: int, toward: float, row: Real) -> float:
    """Return a coordinate of O2 (pivot 0) or O4 (1), and write its derivatives times the sign ``toward`` to ``row``."""
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
    """Write the distances of P from the sides of its box in the coupler's frame; return the next number."""
    for axis in range(2):
        for side in range(2):
            limit = setting[POINT_BOX][2 * axis + side]
            if abs(limit) < np.inf:
                # The sign makes both sides positive inside the box.
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
    """Write the distances of A and B from the sides of their box, with the crank at ``angle`` from the ground line.

    A moving pivot is a point of the coupler with the coordinates (0, 0) or (b, 0), and moves as P does.
    """
    box = setting[MOVING]
    if not (np.abs(box) < np.inf).any():
        return number + 8
    # Reuse the derivatives of P: A and B are coupler points with known local coordinates.
    by, pin = np.empty(10, np.complex128), x[: POINT + 2].copy()
    for pivot in range(2):
        pin[POINT], pin[POINT + 1] = pivot * lengths[2], 0.0
        closes, place = place_with_slopes(FOURBAR, pin, lengths, slopes, setting[SIGN_INDEX], 0.0, x[2] + angle, by)
        # An open linkage has no B; its margins stay infinite, because the fit's residuals reject it anyway.
        if not closes:
            return number + 8 - 4 * pivot
        # The crank angle is measured from the ground line, so turning that line turns the crank as well.
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
                        # B's local coordinate is b itself, which changes with the lengths.
                        if pivot == 1 and LENGTHS <= j < POINT:
                            moved += by[POINT] * slopes[2, j - LENGTHS]
                        row[j] = toward * (moved.real if axis == 0 else moved.imag)
                number += 1
    return number


@njit(**OPTIONS)
def _write_transmission_margins(
    lengths: Real, slopes: Real, ends: Real, setting: Real, values: Real, gradients: Real, number: int
) -> int:
    """Write the margins of cos γ at φ = 0, φ = π and both ends of the range, from above and below.

    Return the number of the next margin.
    """
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
            # A full turn contains both passages, wherever it starts.
            used = setting[FULL_TURN_INDEX] > 0.0 or first <= high
            cosine = 1.0 - 2.0 * k
        else:
            cosine = math.cos(ends[k - 2])
        # Law of cosines in both triangles on the diagonal from O4 to A.
        ratio = (b * b + c * c - d * d - a * a + 2.0 * a * d * cosine) / (2.0 * b * c)
        by[0], by[1] = (a * cosine - d) / (b * c), (d * cosine - a) / (b * c)
        by[2], by[3] = 1.0 / c - ratio / b, 1.0 / b - ratio / c
        for side in range(2):
            if used:
                toward = 1.0 if side == 0 else -1.0
                # γ and 180° − γ transmit equally well, so |cos γ| is limited; two margins avoid the kink of the
                # absolute value.
                values[number] = setting[COSINE] - toward * ratio
                row = gradients[number]
                row[:] = 0.0
                for j in range(4):
                    for i in range(4):
                        row[LENGTHS + j] -= toward * by[i] * slopes[i, j]
            number += 1
    return number
