"""Residuals of a Stephenson II that guides a point along a curve, in both directions, and its constraints as margins.

The unknowns and the motion are those of :mod:`synthesis.fit.inverted_curve`; the rows of points, the way back, and the
margins of lengths, their ratios and the box are those of other sixbars (:mod:`synthesis.kinds.path.residuals.sixbar`),
in the same places. Instead of the cosines of two dyads, the cosine of the triad at the leg with the minimum
transmission angle is bounded from above and from below. Linkages that turn over within the cycle are refused: their
input would turn back.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from synthesis.fit.chart import OPTIONS, compute_lengths
from synthesis.fit.constraints import (
    BOXES,
    COSINE,
    EQUATION_COUNT,
    FAMILY_INDEX,
    GIVEN_PIVOTS,
    LIMIT_COUNT,
    MOVING,
    PIVOT_MARGIN,
    SIGN_INDEX,
    compute_margins,
)
from synthesis.fit.inverted_curve import (
    GROUND_JOINT_COUNT,
    PIVOT,
    POINT,
    compute_inverted_joints,
    compute_inverted_slopes,
    compute_inverted_velocity,
    differentiate_slant,
    transform_to_ground,
)
from synthesis.fit.sixbar_curve import COUPLER, DYAD, GROUND, UNKNOWNS
from synthesis.kinds.path.residuals.sixbar import (
    BACK,
    CARRIER,
    HOLDER,
    MARGINS_PER_STEP,
    MAX_SETTLING_STEPS,
    ROOM,
    SIDE,
    STEPS,
    TURN_TOLERANCE,
    compute_own_margins,
    compute_settling_step,
    count_sixbar_margins,
    find_nearest_side,
    write_back_row,
    write_point_rows,
)
from synthesis.numerics.augmented_lagrangian import append_limit_rows
from synthesis.numerics.levenberg import ROWS


@njit(**OPTIONS)
def _settle_angle(x: Real, lengths: Real, setting: Real, z: complex, angle: float) -> float:
    """Move the angle of link 3 towards the place where P is nearest to z; NaN beyond a toggle."""
    sign, side, carrier = setting[SIGN_INDEX], setting[SIDE], int(setting[CARRIER])
    for _ in range(MAX_SETTLING_STEPS):
        closes, p, moved = compute_inverted_velocity(x, lengths, sign, carrier, side, angle)
        if not closes:
            return math.nan
        step = compute_settling_step(p - z, moved)
        angle += step
        if abs(step) < TURN_TOLERANCE:
            break
    return angle


@njit(**OPTIONS)
def _compute_link_margins(
    x: Real, lengths: Real, chart: Real, setting: Real, multipliers: Real, values: Real, rows: Real
) -> int:
    """Compute the margins of lengths and ratios, which are those of a Stephenson III on the input link.

    Returns the index of the next margin.
    """
    here, neutral = x.copy(), setting.copy()
    # The input is the ground of the inverted chain, so that place and direction, and all boxes of the frame, are
    # neutralized.
    here[:3] = 0.0
    neutral[CARRIER], neutral[HOLDER], neutral[COSINE] = COUPLER, GROUND, np.inf
    boxes, moving = neutral[BOXES], neutral[MOVING]
    for edge in range(len(boxes)):
        boxes[edge] = -np.inf if edge % 2 == 0 else np.inf
    for edge in range(len(moving)):
        moving[edge] = -np.inf if edge % 2 == 0 else np.inf
    neutral[GIVEN_PIVOTS] = np.nan
    number: int = compute_own_margins(here, lengths, chart, neutral, multipliers, values, rows)
    first, still = len(values) - LIMIT_COUNT, np.zeros(UNKNOWNS)
    compute_margins(here, lengths, chart, np.zeros(2), still, neutral, values[first:], rows[first:])
    for k in range(len(values)):
        if k < number or k >= first:
            rows[k, :3] = 0.0
    return number


@njit(**OPTIONS)
def _compute_pivot_margins(x: Real, setting: Real, values: Real, rows: Real) -> None:
    """Compute margins of the boxes and the given coordinates of O2 and O4, into a fourbar's places."""
    first = len(values) - LIMIT_COUNT
    ground, cosine, sine = math.exp(x[DYAD + 1]), math.cos(x[2]), math.sin(x[2])
    by = np.zeros(UNKNOWNS)
    for pivot in range(2):
        for axis in range(2):
            by[:] = 0.0
            by[axis] = 1.0
            place = x[axis]
            if pivot == 1:
                along, across = (cosine, -sine) if axis == 0 else (sine, cosine)
                place += ground * along
                by[2], by[DYAD + 1] = ground * across, ground * along
            for side in range(2):
                limit, toward = setting[BOXES][4 * pivot + 2 * axis + side], 1.0 if side == 0 else -1.0
                if abs(limit) < np.inf:
                    number = first + PIVOT_MARGIN + 4 * pivot + 2 * axis + side
                    values[number] = toward * (place - limit)
                    rows[number] = toward * by
            given = setting[GIVEN_PIVOTS][2 * pivot + axis]
            if not math.isnan(given):
                number = len(values) - EQUATION_COUNT + 2 * pivot + axis
                values[number] = place - given
                rows[number] = by


@njit(**OPTIONS)
def _write_edge_margins(
    setting: Real, multipliers: Real, weight: float, places: Complex, number: int, values: Real
) -> bool:
    """Write the margins of the joints from the four edges of the box, from index ``number`` on.

    Returns whether one of them bears a load.
    """
    pressed = False
    for edge in range(4):
        limit, toward = setting[ROOM][edge], 1.0 if edge % 2 == 0 else -1.0
        values[number + edge] = np.inf
        for joint in range(GROUND_JOINT_COUNT):
            at = places[joint].real if edge < 2 else places[joint].imag
            values[number + edge] = min(values[number + edge], toward * (at - limit))
        pressed |= values[number + edge] < multipliers[number + edge] / weight
    return pressed


@njit(**OPTIONS)
def _differentiate_edge_margins(
    x: Real, setting: Real, multipliers: Real, weight: float, places: Complex, turns: Real, joints: Complex,
    by: Complex, slopes: Complex, number: int, values: Real, gradients: Real,
) -> None:  # fmt: skip
    """Write the derivatives of those margins of :func:`_write_edge_margins` that bear a load; ``slopes`` is scratch."""
    for edge in range(4):
        if not values[number + edge] < multipliers[number + edge] / weight:
            continue
        limit, toward = setting[ROOM][edge], 1.0 if edge % 2 == 0 else -1.0
        for joint in range(GROUND_JOINT_COUNT):
            at = places[joint].real if edge < 2 else places[joint].imag
            # Only the joint that is nearest to the edge determines the margin.
            if toward * (at - limit) > values[number + edge]:
                continue
            transform_to_ground(x, joint, turns, joints, by, slopes)
            for j in range(UNKNOWNS):
                gradients[number + edge, j] = toward * (slopes[j].real if edge < 2 else slopes[j].imag)


@njit(ROWS, **OPTIONS)
def compute_inverted_rows(
    x: Real, points: Real, setting: Real, multipliers: Real, state: Real, residuals: Real, jacobian: Real
) -> int:
    """Compute rows for the descent of :mod:`synthesis.numerics.levenberg`.

    Returns their number, or −1 if the linkage does not close or turns over.

    ``points`` (n, 4): x and y, unused, and the square root of the weight. ``state``: angles of link 3 at the points,
    then margins.
    """
    n = len(points)
    lengths, chart = np.empty(4), np.zeros((4, 4))
    compute_lengths(int(setting[FAMILY_INDEX]), x, lengths, chart)
    sign, side, carrier = setting[SIGN_INDEX], setting[SIDE], int(setting[CARRIER])
    # Logarithms of lengths beyond this overflow in their products.
    if not (np.abs(x[3:7]).max() < 30.0 and max(abs(x[DYAD]), abs(x[DYAD + 1])) < 30.0):
        return -1
    turns, slopes = np.zeros((3, UNKNOWNS + 1)), np.empty(UNKNOWNS + 1, np.complex128)
    joints, by = np.empty(PIVOT + 1, np.complex128), np.empty((PIVOT + 1, UNKNOWNS + 1), np.complex128)
    m = 0
    for i in range(n):
        z, root = complex(points[i, 0], points[i, 1]), points[i, 3]
        angle = _settle_angle(x, lengths, setting, z, state[i])
        if math.isnan(angle):
            return -1
        state[i] = angle
        if not compute_inverted_slopes(x, lengths, chart, sign, carrier, side, angle, turns, joints, by):
            return -1
        p = transform_to_ground(x, POINT, turns, joints, by, slopes)
        write_point_rows(p - z, slopes, root, m, residuals, jacobian)
        m += 2
    steps, limits = int(setting[STEPS]), count_sixbar_margins(setting)
    values, gradients = state[n:], np.empty((limits, UNKNOWNS))
    # Margins without a limit stay infinite and never become active.
    values[:] = np.inf
    first = _compute_link_margins(x, lengths, chart, setting, multipliers, values, gradients)
    _compute_pivot_margins(x, setting, values, gradients)
    weight, places, hand = multipliers[limits], np.empty(GROUND_JOINT_COUNT, np.complex128), 0.0
    for k in range(steps):
        angle, back = 2.0 * math.pi * k / steps, setting[BACK] > 0.0
        number = first + MARGINS_PER_STEP * k
        closes, cosine, sine = compute_inverted_joints(x, lengths, sign, carrier, side, angle, places)
        # A sign change of the sine between two steps means that the triad has passed a toggle.
        if not closes or hand * sine < 0.0:
            return -1
        hand = sine
        # |cos| is bounded by two one-sided margins, which are smooth.
        values[number], values[number + 1] = setting[COSINE] - cosine, setting[COSINE] + cosine
        loaded = values[number] < multipliers[number] / weight or values[number + 1] < multipliers[number + 1] / weight
        pressed = _write_edge_margins(setting, multipliers, weight, places, number + 2, values)
        # Derivatives are expensive, and needed only for margins that bear a load.
        if not (loaded or back or pressed):
            continue
        compute_inverted_slopes(x, lengths, chart, sign, carrier, side, angle, turns, joints, by)
        if loaded:
            differentiate_slant(joints, by, gradients[number + 1])
            gradients[number] = -gradients[number + 1]
        _differentiate_edge_margins(
            x, setting, multipliers, weight, places, turns, joints, by, slopes, number + 2, values, gradients
        )
        if back:
            transform_to_ground(x, POINT, turns, joints, by, slopes)
            write_back_row(find_nearest_side(places[POINT], points), slopes, setting[BACK], m, residuals, jacobian)
            m += 1
    return append_limit_rows(values, gradients, EQUATION_COUNT, multipliers, residuals, jacobian, m)
