"""Residuals of a sixbar that guides a point along a curve, in both directions, and its constraints as margins.

The points' crank angles are eliminated as in :mod:`synthesis.kinds.path.residuals.points`: for each sixbar they are
moved to the positions at which P is nearest to the points, and the Jacobian is that at fixed angles minus its part
along the curve. The opposite direction, the *way back*, is the distance of P at equal steps of the crank from the
nearest side of the polyline through the points.

The constraints are those of the fourbar O2 A B O4 (:mod:`synthesis.fit.constraints`), and in addition

* the cosine of the angle at E, from above and from below, at equal steps of the crank;
* the distances of C and D from the other pins of their links and the lengths C E and E D, from the minimum and the
  maximum length, and their ratios to one another and to the fourbar's links;
* the sides of the box of O6, if D is fixed;
* at equal steps of the crank, from each side of a box, the distance of the joint that is nearest to it or beyond it.

Derivatives of a margin are computed only if it is active, that is, if its multiplier bears a load.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from synthesis.fit.chart import OPTIONS, compute_lengths
from synthesis.fit.constraints import (
    COSINE,
    EQUATION_COUNT,
    FAMILY_INDEX,
    LIMIT_COUNT,
    LINKS,
    OUTPUT_BOX,
    RATIO,
    SETTING_SIZE,
    SIGN_INDEX,
    compute_margins,
)
from synthesis.fit.sixbar_curve import (
    COUPLER,
    CRANK,
    DYAD,
    GROUND,
    UNKNOWNS,
    C,
    D,
    P,
    compute_cosine,
    compute_velocity,
    differentiate_cosine,
    differentiate_pins,
    differentiate_point,
    locate_joints,
)
from synthesis.numerics.array_layout import ArrayLayout
from synthesis.numerics.augmented_lagrangian import append_limit_rows
from synthesis.numerics.levenberg import ROWS

SIXBAR_SETTING = ArrayLayout(SETTING_SIZE, carrier=1, holder=1, side=1, steps=1, back=1, room=4)
"""Setting of a fit of sixbars, behind the constraints."""

CARRIER, HOLDER, SIDE = SIXBAR_SETTING.index("carrier"), SIXBAR_SETTING.index("holder"), SIXBAR_SETTING.index("side")
"""Links that carry and hold the dyad, and its assembly."""

STEPS = SIXBAR_SETTING.index("steps")
"""Number of equal steps of the crank."""

BACK = SIXBAR_SETTING.index("back")
"""Weight of the way back per step, a square root; 0 if it does not count."""

ROOM = SIXBAR_SETTING.slice("room")
"""Box of all joints (x min, x max, y min, y max); infinite if there is none."""

SIXBAR_SETTING_SIZE = SIXBAR_SETTING.size
"""Number of values of a setting."""

EXTRA_LENGTH_COUNT = 6
"""Number of lengths of a sixbar in addition to the fourbar's four."""

OWN_MARGIN_COUNT = 2 * EXTRA_LENGTH_COUNT + EXTRA_LENGTH_COUNT * (EXTRA_LENGTH_COUNT - 1) + 8 * EXTRA_LENGTH_COUNT + 4
"""Number of margins of a sixbar in addition to the fourbar's and those of the steps: lengths, ratios, O6."""

MARGINS_PER_STEP = 6
"""Number of margins of a step: the angle at E from above and from below, and the sides of the box."""

MAX_SETTLING_STEPS, MAX_TURN_STEP, TURN_TOLERANCE = 2, 0.25, 1e-7
"""Maximum number of steps that settle crank angles at each sixbar, from those of the last accepted one; the maximum
step, and the step after which they are settled, radians."""

MIN_SPEED = 1e-9
"""Speed of P, task sizes per radian, below which its path has no direction."""


@njit(**OPTIONS)
def count_sixbar_margins(setting: Real) -> int:
    """Return the number of margins of a setting."""
    return LIMIT_COUNT + OWN_MARGIN_COUNT + MARGINS_PER_STEP * int(setting[STEPS])


@njit(**OPTIONS)
def count_sixbar_rows(points: int, setting: Real) -> int:
    """Return the maximum number of rows."""
    most: int = 2 * points + int(setting[STEPS]) + count_sixbar_margins(setting)
    return most


@njit(**OPTIONS)
def _compute_pin_distance(frame: int, at: int, x: Real, lengths: Real, chart: Real, which: int, row: Real) -> float:
    """Compute ln of a pin's distance from the first (0) or second (1) other pin of its link, and its derivatives."""
    row[:] = 0.0
    if frame == GROUND:
        along, across, far = math.cos(x[2]), math.sin(x[2]), lengths[0] * which
        gap = complex(x[at] - x[0] - far * along, x[at + 1] - x[1] - far * across)
        square = gap.real * gap.real + gap.imag * gap.imag
        row[at], row[at + 1] = gap.real / square, gap.imag / square
        row[0], row[1] = -row[at], -row[at + 1]
        if which == 1:
            row[2] = lengths[0] * (across * row[at] - along * row[at + 1])
            for k in range(4):
                row[3 + k] = -chart[0, k] * (along * row[at] + across * row[at + 1])
        return 0.5 * math.log(square)
    link = 1 if frame == CRANK else 2 if frame == COUPLER else 3
    gap = complex(x[at] - lengths[link] * which, x[at + 1])
    square = gap.real * gap.real + gap.imag * gap.imag
    row[at], row[at + 1] = gap.real / square, gap.imag / square
    if which == 1:
        for k in range(4):
            row[3 + k] = -chart[link, k] * row[at]
    return 0.5 * math.log(square)


@njit(**OPTIONS)
def _compute_lengths(x: Real, lengths: Real, chart: Real, setting: Real, logs: Real, slopes: Real) -> None:
    """Compute ln of all ten lengths (10,), the fourbar's first, and their derivatives (10, 15)."""
    for k in range(4):
        logs[k] = math.log(lengths[k])
        slopes[k] = 0.0
        for j in range(4):
            slopes[k, 3 + j] = chart[k, j] / lengths[k]
    for which in range(2):
        logs[4 + which] = _compute_pin_distance(int(setting[CARRIER]), C, x, lengths, chart, which, slopes[4 + which])
        logs[6 + which] = _compute_pin_distance(int(setting[HOLDER]), D, x, lengths, chart, which, slopes[6 + which])
        logs[8 + which] = x[DYAD + which]
        slopes[8 + which] = 0.0
        slopes[8 + which, DYAD + which] = 1.0


@njit(**OPTIONS)
def compute_own_margins(
    x: Real, lengths: Real, chart: Real, setting: Real, multipliers: Real, values: Real, gradients: Real
) -> int:
    """Compute the margins of the lengths, their ratios, and of O6, from the first place on; return their number."""
    values[:OWN_MARGIN_COUNT] = np.inf
    logs, slopes = np.empty(4 + EXTRA_LENGTH_COUNT), np.empty((4 + EXTRA_LENGTH_COUNT, UNKNOWNS))
    _compute_lengths(x, lengths, chart, setting, logs, slopes)
    weight = multipliers[-1]
    number = 0
    for k in range(4, 4 + EXTRA_LENGTH_COUNT):
        for end in range(2):
            limit, toward = setting[LINKS][end], 1.0 if end == 0 else -1.0
            if 0.0 < limit < np.inf:
                values[number] = toward * (logs[k] - math.log(limit))
                gradients[number] = toward * slopes[k]
            number += 1
    if setting[RATIO] < np.inf:
        most = math.log(setting[RATIO])
        for k in range(4, 4 + EXTRA_LENGTH_COUNT):
            for j in range(k):
                for toward in (1.0, -1.0):
                    values[number] = most - toward * (logs[k] - logs[j])
                    # Inactive margins need no derivatives.
                    if values[number] < multipliers[number] / weight:
                        gradients[number] = toward * (slopes[j] - slopes[k])
                    number += 1
    else:
        number += EXTRA_LENGTH_COUNT * (EXTRA_LENGTH_COUNT - 1) + 8 * EXTRA_LENGTH_COUNT
    if setting[HOLDER] == GROUND:
        for k in range(4):
            limit, toward = setting[OUTPUT_BOX][k], 1.0 if k % 2 == 0 else -1.0
            if abs(limit) < np.inf:
                values[number + k] = toward * (x[D + k // 2] - limit)
                gradients[number + k] = 0.0
                gradients[number + k, D + k // 2] = toward
    return number + 4


@njit(**OPTIONS)
def _compute_joint_slopes(
    joint: int, x: Real, lengths: Real, chart: Real, setting: Real, theta: float, turns: Real, by_c: Complex,
    by_d: Complex, slopes: Complex,
) -> None:  # fmt: skip
    """Compute the derivatives of one of the joints A, B, C, D, E and P (0 to 5) by the unknowns, into ``slopes``.

    A and B are points of the coupler, and E is a point of the link C E; their coordinates change with the lengths.
    """
    sign, carrier, holder = setting[SIGN_INDEX], int(setting[CARRIER]), int(setting[HOLDER])
    pinned = x.copy()
    if joint < 2:
        pinned[C], pinned[C + 1] = joint * lengths[2], 0.0
        differentiate_pins(pinned, lengths, chart, sign, COUPLER, holder, theta, turns, slopes, by_d)
        along = slopes[C]
        slopes[C] = slopes[C + 1] = 0.0
        for k in range(4):
            slopes[3 + k] += joint * chart[2, k] * along
        return
    _, c, d = differentiate_pins(x, lengths, chart, sign, carrier, holder, theta, turns, by_c, by_d)
    if joint < 4:
        slopes[:] = by_c if joint == 2 else by_d
        return
    first = math.exp(x[DYAD])
    if joint == 4:
        pinned[P], pinned[P + 1] = first, 0.0
    differentiate_point(pinned, setting[SIDE], c, d, by_c, by_d, slopes)
    if joint == 4:
        slopes[DYAD] += first * slopes[P]
        slopes[P] = slopes[P + 1] = 0.0


@njit(**OPTIONS)
def compute_settling_step(gap: complex, moved: complex) -> float:
    """Return the step of the angle towards the place where P is nearest to a point missed by ``gap``; 0 if P rests."""
    # Gauss-Newton step of the squared distance; the curvature of the path is neglected.
    square = moved.real * moved.real + moved.imag * moved.imag
    if square < MIN_SPEED * MIN_SPEED:
        return 0.0
    step = -(moved.real * gap.real + moved.imag * gap.imag) / square
    return min(max(step, -MAX_TURN_STEP), MAX_TURN_STEP)


@njit(**OPTIONS)
def _settle_angle(x: Real, lengths: Real, setting: Real, z: complex, angle: float) -> float:
    """Move the crank angle towards the place where P is nearest to z; NaN beyond a toggle."""
    sign, side = setting[SIGN_INDEX], setting[SIDE]
    carrier, holder = int(setting[CARRIER]), int(setting[HOLDER])
    for _ in range(MAX_SETTLING_STEPS):
        closes, p, moved = compute_velocity(x, lengths, sign, carrier, holder, side, angle)
        if not closes:
            return math.nan
        step = compute_settling_step(p - z, moved)
        angle += step
        if abs(step) < TURN_TOLERANCE:
            break
    return angle


@njit(**OPTIONS)
def find_nearest_side(p: complex, points: Real) -> complex:
    """Return the vector from the nearest place of the closed polyline through points (n, 2 or more) to p."""
    n, least, best = len(points), np.inf, 0j
    for k in range(n):
        after = points[k + 1] if k + 1 < n else points[0]
        start = complex(points[k, 0], points[k, 1])
        along, gap = complex(after[0], after[1]) - start, p - start
        square = along.real * along.real + along.imag * along.imag
        share = (gap.real * along.real + gap.imag * along.imag) / square if square > 0.0 else 0.0
        # Beyond an end of the side its corner is nearest.
        share = min(max(share, 0.0), 1.0)
        off = complex(gap.real - share * along.real, gap.imag - share * along.imag)
        far = off.real * off.real + off.imag * off.imag
        if far < least:
            least, best = far, off
    return best


@njit(**OPTIONS)
def write_point_rows(gap: complex, slopes: Complex, root: float, m: int, residuals: Real, jacobian: Real) -> None:
    """Write the rows m and m + 1 of a point that P misses by ``gap``: along P's path, and across it.

    ``slopes`` are P's, by the unknowns and last by the driving angle; ``root`` is the square root of the weight.
    """
    along = slopes[UNKNOWNS]
    speed = abs(along)
    if speed < MIN_SPEED:
        # P rests: no component can be removed along its path, so both coordinates count.
        along, across = 1.0 + 0j, 1j
        for j in range(UNKNOWNS):
            jacobian[m, j] = root * slopes[j].real
    else:
        along = along / speed
        across = complex(-along.imag, along.real)
        jacobian[m] = 0.0
    residuals[m] = root * (gap.real * along.real + gap.imag * along.imag)
    residuals[m + 1] = root * (gap.real * across.real + gap.imag * across.imag)
    for j in range(UNKNOWNS):
        jacobian[m + 1, j] = root * (slopes[j].real * across.real + slopes[j].imag * across.imag)


@njit(**OPTIONS)
def write_back_row(off: complex, slopes: Complex, weight: float, m: int, residuals: Real, jacobian: Real) -> None:
    """Write the row m of a place of the curve that is off the polyline by a vector."""
    far = abs(off)
    residuals[m] = weight * far
    jacobian[m] = 0.0
    if far > 0.0:
        for j in range(UNKNOWNS):
            jacobian[m, j] = weight / far * (off.real * slopes[j].real + off.imag * slopes[j].imag)


@njit(**OPTIONS)
def _write_edge_margins(
    x: Real, lengths: Real, chart: Real, setting: Real, multipliers: Real, weight: float, angle: float, places: Complex,
    number: int, values: Real, gradients: Real, turns: Real, by_c: Complex, by_d: Complex, slopes: Complex,
) -> None:  # fmt: skip
    """Write the margins of the joints from the four edges of the box at one crank angle, from ``number`` on.

    Derivatives are written only for margins that bear a load. The last four arrays are scratch.
    """
    for edge in range(4):
        limit, toward = setting[ROOM][edge], 1.0 if edge % 2 == 0 else -1.0
        least, nearest = np.inf, 0
        for joint in range(6):
            at = places[joint].real if edge < 2 else places[joint].imag
            # The margin is that of the most critical joint.
            if toward * (at - limit) < least:
                least, nearest = toward * (at - limit), joint
        values[number + edge] = least
        if least < multipliers[number + edge] / weight:
            _compute_joint_slopes(nearest, x, lengths, chart, setting, angle, turns, by_c, by_d, slopes)
            for j in range(UNKNOWNS):
                by = slopes[j].real if edge < 2 else slopes[j].imag
                gradients[number + edge, j] = toward * by


@njit(ROWS, **OPTIONS)
def compute_sixbar_rows(
    x: Real, points: Real, setting: Real, multipliers: Real, state: Real, residuals: Real, jacobian: Real
) -> int:
    """Compute rows for the descent of :mod:`synthesis.numerics.levenberg`; −1 if the sixbar does not close.

    ``points`` (n, 4): x and y, unused, and the square root of the weight. ``state``: crank angles at the points, then
    margins.
    """
    n = len(points)
    lengths, chart = np.empty(4), np.zeros((4, 4))
    compute_lengths(int(setting[FAMILY_INDEX]), x, lengths, chart)
    sign, side = setting[SIGN_INDEX], setting[SIDE]
    carrier, holder = int(setting[CARRIER]), int(setting[HOLDER])
    # Logarithms of lengths beyond this overflow in their products.
    if not (np.abs(x[3:7]).max() < 30.0 and max(abs(x[DYAD]), abs(x[DYAD + 1])) < 30.0):
        return -1
    turns, slopes, m = np.zeros((2, UNKNOWNS + 1)), np.empty(UNKNOWNS + 1, np.complex128), 0
    by_c, by_d = np.empty(UNKNOWNS + 1, np.complex128), np.empty(UNKNOWNS + 1, np.complex128)
    for i in range(n):
        z, root = complex(points[i, 0], points[i, 1]), points[i, 3]
        angle = _settle_angle(x, lengths, setting, z, state[i])
        if math.isnan(angle):
            return -1
        state[i] = angle
        closes, c, d = differentiate_pins(x, lengths, chart, sign, carrier, holder, angle, turns, by_c, by_d)
        if not closes:
            return -1
        closes, p = differentiate_point(x, side, c, d, by_c, by_d, slopes)
        if not closes:
            return -1
        write_point_rows(p - z, slopes, root, m, residuals, jacobian)
        m += 2
    steps, limits = int(setting[STEPS]), count_sixbar_margins(setting)
    values, gradients = state[n:], np.empty((limits, UNKNOWNS))
    first = compute_own_margins(x, lengths, chart, setting, multipliers, values, gradients)
    compute_margins(
        x, lengths, chart, np.zeros(2), np.zeros(UNKNOWNS), setting, values[limits - LIMIT_COUNT :],
        gradients[limits - LIMIT_COUNT :],
    )  # fmt: skip
    weight, places = multipliers[limits], np.empty(6, np.complex128)
    for k in range(steps):
        angle, back = 2.0 * math.pi * k / steps, setting[BACK] > 0.0
        number = first + MARGINS_PER_STEP * k
        if not locate_joints(x, lengths, sign, carrier, holder, side, angle, places):
            return -1
        at_e = compute_cosine(x, places[2], places[3])
        # |cos| is bounded by two one-sided margins, which are smooth.
        values[number], values[number + 1] = setting[COSINE] - at_e, setting[COSINE] + at_e
        _write_edge_margins(
            x, lengths, chart, setting, multipliers, weight, angle, places, number + 2, values, gradients, turns, by_c,
            by_d, slopes,
        )  # fmt: skip
        loaded = values[number] < multipliers[number] / weight or values[number + 1] < multipliers[number + 1] / weight
        if not (loaded or back):
            continue
        _, c, d = differentiate_pins(x, lengths, chart, sign, carrier, holder, angle, turns, by_c, by_d)
        if loaded:
            differentiate_cosine(x, c, d, by_c, by_d, gradients[number + 1])
            gradients[number] = -gradients[number + 1]
        if back:
            differentiate_point(x, side, c, d, by_c, by_d, slopes)
            write_back_row(find_nearest_side(places[5], points), slopes, setting[BACK], m, residuals, jacobian)
            m += 1
    return append_limit_rows(values, gradients, EQUATION_COUNT, multipliers, residuals, jacobian, m)
