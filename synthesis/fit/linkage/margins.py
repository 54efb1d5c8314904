"""Constraints on linkages of any topology as margins over their unknowns, with their derivatives.

A margin g ≥ 0, or h = 0 for given pivots, is a limit of :mod:`synthesis.numerics.augmented_lagrangian`.

=================== ==== ==========================================================================
constraint          g, h margin
=================== ==== ==========================================================================
link lengths        g    ln(l / minimum), ln(maximum / l) for each pair of pins of a link
link ratio          g    ln(ratio · lᵢ / lₖ) for each ordered pair of these
reach               g    ln(reach / l) for the distance of the traced point from each pin of its link
Grashof class       g    ln(l / l_s) for the links of the first fourbar; l_s must be the shortest
Grashof condition   g    1 − 2(l_s + l)/(sum of the four) for the same links, or the opposite for the extreme ones
pivot regions       g    distance from each side of a box
moving pivots       g    the same at the first point, with its input
rotation            g    a turn − |θ| of the last of ordered inputs
given pivots        h    distance along each axis
transmission angle  g    cos γ_min ∓ cos γ at each step of the input, for each dyad or the triad
workspace           g    at each step, distance from each side of a box of the joint nearest to it
=================== ==== ==========================================================================

Every margin has a fixed number, to which its multiplier belongs. Derivatives are written only if a margin bears a load.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Integers, Real
from kinematics.compiling import njit
from synthesis.fit.chart import OPTIONS
from synthesis.fit.linkage.closure import differentiate_cosine
from synthesis.fit.linkage.setting import (
    ARM_COUNT,
    COSINE,
    FAMILY,
    FIRST_FOURBAR,
    GIVEN_PIVOTS,
    GRASHOF,
    INPUT_BOX,
    LINKS,
    MOVING_BOX,
    ORDER,
    PAIR_COUNT,
    PIN_COUNT,
    PIVOT_BOX,
    PIVOT_COUNT,
    POINT_NODE,
    RATIO,
    REACH,
    STEPS,
    TRIAD,
    WORKSPACE_BOX,
    unpack_table,
)
from synthesis.fit.triad_slant import differentiate_leg_slant, find_min_slant

EQUATION_COUNT = 4
"""Number of margins, the last ones, that must be zero: coordinates of given pivots."""

FAMILY_MARGIN_COUNT = 4
"""Number of margins of the Grashof class, and of the Grashof condition; those of the shortest link stay infinite."""

MAX_ROTATION = 2.0 * math.pi - 1e-3
"""Greatest rotation of ordered inputs, radians."""

BOX_SIDE_COUNT = 4
"""Number of sides of a box: minimum x, maximum x, minimum y, maximum y."""


@njit(**OPTIONS)
def count_static_margins(setting: Real) -> int:
    """Return the number of margins that do not depend on the motion, without the equations."""
    pairs = int(setting[PAIR_COUNT])
    boxes = int(setting[PIVOT_COUNT]) + int(setting[PIN_COUNT])
    return pairs * (pairs + 1) + 2 * FAMILY_MARGIN_COUNT + BOX_SIDE_COUNT * boxes + int(setting[ARM_COUNT])


@njit(**OPTIONS)
def count_step_margins(transmitting: Integers, setting: Real) -> int:
    """Return the number of margins of one step of the input."""
    angles = 1 if setting[TRIAD][0] >= 0.0 else int(transmitting.sum())
    return 2 * angles + BOX_SIDE_COUNT


@njit(**OPTIONS)
def count_margins(setting: Real) -> int:
    """Return the number of all margins of a setting."""
    transmitting = unpack_table(setting)[1]
    total: int = count_static_margins(setting) + int(setting[STEPS]) * count_step_margins(transmitting, setting)
    return total + count_order_margins(setting) + EQUATION_COUNT


@njit(**OPTIONS)
def count_order_margins(setting: Real) -> int:
    """Return the number of margins of ordered inputs."""
    return 1 if setting[ORDER] != 0.0 else 0


@njit(**OPTIONS)
def _write_length_margins(
    z: Real, pairs: Integers, setting: Real, multipliers: Real, values: Real, gradients: Real
) -> int:
    """Write the margins of lengths, their ratios and the Grashof class; return the number of the next margin."""
    count, weight, number = len(pairs), multipliers[-1], 0
    logs, slopes = np.empty(count), np.empty((count, 2))
    for k in range(count):
        a, b = pairs[k]
        dx, dy = z[2 * a] - z[2 * b], z[2 * a + 1] - z[2 * b + 1]
        square = dx * dx + dy * dy
        logs[k], slopes[k, 0], slopes[k, 1] = 0.5 * math.log(square), dx / square, dy / square
    shortest, longest = setting[LINKS]
    for k in range(count):
        for side in range(2):
            limit, toward = (shortest, 1.0) if side == 0 else (longest, -1.0)
            # A limit of 0 or ∞ is none and would make the logarithm infinite.
            if 0.0 < limit < np.inf:
                values[number] = toward * (logs[k] - math.log(limit))
                gradients[number] = 0.0
                _add_length(pairs, slopes, k, toward, gradients[number])
            number += 1
    # All ordered pairs, because the ratio of the longest to the shortest has kinks where links change places.
    for k in range(count):
        for j in range(count):
            if j == k:
                continue
            if setting[RATIO] < np.inf:
                values[number] = math.log(setting[RATIO]) + logs[j] - logs[k]
                if values[number] < multipliers[number] / weight:
                    gradients[number] = 0.0
                    _add_length(pairs, slopes, j, 1.0, gradients[number])
                    _add_length(pairs, slopes, k, -1.0, gradients[number])
            number += 1
    if setting[FAMILY] >= 0.0:
        family = int(setting[FAMILY])
        least = int(setting[FIRST_FOURBAR][family])
        for k in range(FAMILY_MARGIN_COUNT):
            if k != family:
                link = int(setting[FIRST_FOURBAR][k])
                values[number + k] = logs[link] - logs[least]
                gradients[number + k] = 0.0
                _add_length(pairs, slopes, link, 1.0, gradients[number + k])
                _add_length(pairs, slopes, least, -1.0, gradients[number + k])
    number += FAMILY_MARGIN_COUNT
    if setting[GRASHOF] != 0.0:
        _write_grashof_margins(pairs, logs, slopes, setting, number, values, gradients)
    return number + FAMILY_MARGIN_COUNT


@njit(**OPTIONS)
def _write_grashof_margins(
    pairs: Integers, logs: Real, slopes: Real, setting: Real, number: int, values: Real, gradients: Real
) -> None:
    """Write the margins of the Grashof condition, or that of a fourbar without it, from ``number`` on."""
    links, lengths = np.empty(FAMILY_MARGIN_COUNT, np.int64), np.empty(FAMILY_MARGIN_COUNT)
    for k in range(FAMILY_MARGIN_COUNT):
        links[k] = int(setting[FIRST_FOURBAR][k])
        lengths[k] = math.exp(logs[links[k]])
    total = lengths.sum()
    keeps = setting[GRASHOF] > 0.0
    least = int(setting[FAMILY]) if keeps else int(lengths.argmin())
    for k in range(FAMILY_MARGIN_COUNT):
        # Only the longest link breaks the condition; all links must keep it, because any may be the longest.
        if k == least or not (keeps or k == int(lengths.argmax())):
            continue
        sign, share = 1.0 if keeps else -1.0, 2.0 * (lengths[least] + lengths[k]) / total
        values[number + k] = sign * (1.0 - share)
        gradients[number + k] = 0.0
        for j in range(FAMILY_MARGIN_COUNT):
            own = 2.0 if j in (least, k) else 0.0
            factor = -sign * (own - share) * lengths[j] / total
            _add_length(pairs, slopes, links[j], factor, gradients[number + k])


@njit(**OPTIONS)
def _add_length(pairs: Integers, slopes: Real, k: int, factor: float, row: Real) -> None:
    """Add the derivatives of ln of the k-th distance, times a factor, to a row."""
    a, b = pairs[k]
    for axis in range(2):
        row[2 * a + axis] += factor * slopes[k, axis]
        row[2 * b + axis] -= factor * slopes[k, axis]


@njit(**OPTIONS)
def write_static_margins(
    z: Real, pairs: Integers, pivots: Integers, pins: Integers, arms: Integers, first_places: Real, first_slopes: Real,
    setting: Real, multipliers: Real, values: Real, gradients: Real,
) -> int:  # fmt: skip
    """Write all margins that do not depend on the motion, and return the number of the next one.

    Parameters
    ----------
    z : float, shape (u,)
        Unknowns.
    pairs, pivots, pins, arms
        The topology's table, see :func:`synthesis.fit.linkage.setting.unpack_table`.
    first_places, first_slopes : float, shapes (n, 2) and (n, 2, u)
        Nodes at the first point, and their derivatives, with those of the input there.
    setting, multipliers
        See :mod:`synthesis.fit.linkage.setting` and :mod:`synthesis.numerics.augmented_lagrangian`.
    values, gradients : float, shapes (margins,) and (margins, u)
        Output. The equations are the last margins.
    """
    number: int = _write_length_margins(z, pairs, setting, multipliers, values, gradients)
    for k in range(len(pivots)):
        box = setting[INPUT_BOX] if k == 0 else setting[PIVOT_BOX]
        for side in range(BOX_SIDE_COUNT):
            at, toward = 2 * pivots[k] + side // 2, 1.0 if side % 2 == 0 else -1.0
            if abs(box[side]) < np.inf:
                values[number] = toward * (z[at] - box[side])
                gradients[number] = 0.0
                gradients[number, at] = toward
            number += 1
    for k in range(len(pins)):
        for side in range(BOX_SIDE_COUNT):
            limit, toward = setting[MOVING_BOX][side], 1.0 if side % 2 == 0 else -1.0
            if abs(limit) < np.inf:
                values[number] = toward * (first_places[pins[k], side // 2] - limit)
                gradients[number] = toward * first_slopes[pins[k], side // 2]
            number += 1
    for k in range(len(arms)):
        if setting[REACH] < np.inf:
            a, b = arms[k]
            dx, dy = z[2 * a] - z[2 * b], z[2 * a + 1] - z[2 * b + 1]
            square = dx * dx + dy * dy
            values[number] = math.log(setting[REACH]) - 0.5 * math.log(square)
            gradients[number] = 0.0
            gradients[number, 2 * a], gradients[number, 2 * a + 1] = -dx / square, -dy / square
            gradients[number, 2 * b], gradients[number, 2 * b + 1] = dx / square, dy / square
        number += 1
    for k in range(EQUATION_COUNT):
        given = setting[GIVEN_PIVOTS][k]
        if not math.isnan(given):
            at, last = 2 * pivots[k // 2] + k % 2, len(values) - EQUATION_COUNT + k
            values[last] = z[at] - given
            gradients[last] = 0.0
            gradients[last, at] = 1.0
    return number


@njit(**OPTIONS)
def write_order_margin(
    theta: float, by_last: Real, setting: Real, number: int, values: Real, gradients: Real
) -> int:  # fmt: skip
    """Write the margin of the whole rotation of ordered inputs as ``number``; return the number of the next margin.

    ``by_last`` are the derivatives of the last input θ by the last unknowns.
    """
    if setting[ORDER] == 0.0:
        return number
    # Another turn would repeat the positions.
    values[number] = MAX_ROTATION - abs(theta)
    gradients[number] = 0.0
    first = gradients.shape[1] - len(by_last)
    for k in range(len(by_last)):
        gradients[number, first + k] = -by_last[k] if theta > 0.0 else by_last[k]
    return number + 1


@njit(**OPTIONS)
def write_step_values(
    transmitting: Integers, pins: Integers, places: Real, cosines: Real, setting: Real, number: int, values: Real
) -> float:
    """Write the margins of one step of the input from ``number`` on.

    Returns the sine of the triad's transmission angle, which changes its sign where the linkage turns over; 0 if dyads
    transmit the force.
    """
    hand, limit = 0.0, setting[COSINE]
    if setting[TRIAD][0] >= 0.0:
        cosine, hand, _ = find_min_slant(*get_triad_pins(setting, places))
        # |cos γ| is limited by two margins, which are smooth.
        values[number], values[number + 1] = limit - cosine, limit + cosine
        number += 2
    else:
        for k in range(len(transmitting)):
            if transmitting[k]:
                values[number], values[number + 1] = limit - cosines[k], limit + cosines[k]
                number += 2
    for side in range(BOX_SIDE_COUNT):
        limit, toward = setting[WORKSPACE_BOX][side], 1.0 if side % 2 == 0 else -1.0
        values[number + side] = np.inf
        if abs(limit) < np.inf:
            for k in range(len(pins) + 1):
                node = pins[k] if k < len(pins) else int(setting[POINT_NODE])
                values[number + side] = min(values[number + side], toward * (places[node, side // 2] - limit))
    return hand


@njit(**OPTIONS)
def is_loaded(number: int, count: int, multipliers: Real, values: Real) -> bool:
    """Return whether one of ``count`` margins from ``number`` on bears a load."""
    loaded = False
    for k in range(number, number + count):
        loaded |= values[k] < multipliers[k] / multipliers[-1]
    return loaded


@njit(**OPTIONS)
def write_step_gradients(
    nodes: Integers, z: Real, constants: Real, transmitting: Integers, pins: Integers, places: Real, slopes: Real,
    by_ends: Real, cosines: Real, setting: Real, number: int, values: Real, gradients: Real,
) -> None:  # fmt: skip
    """Write the derivatives of the margins of :func:`write_step_values`.

    ``by_ends`` are the derivatives of this step's input by the unknowns after the coordinates: the ends of the range,
    or the logarithms of ordered steps; 0 for an input that turns through.
    """
    row = np.empty(slopes.shape[2])
    if setting[TRIAD][0] >= 0.0:
        _differentiate_triad(setting, places, slopes, row)
        _write_both_sides(row, by_ends, number, gradients)
        number += 2
    else:
        for k in range(len(transmitting)):
            if transmitting[k]:
                differentiate_cosine(nodes, z, constants, k, places, slopes, cosines[k], row)
                _write_both_sides(row, by_ends, number, gradients)
                number += 2
    for side in range(BOX_SIDE_COUNT):
        limit, toward = setting[WORKSPACE_BOX][side], 1.0 if side % 2 == 0 else -1.0
        if not abs(limit) < np.inf:
            continue
        for k in range(len(pins) + 1):
            node = pins[k] if k < len(pins) else int(setting[POINT_NODE])
            # Only the joint that is nearest to the side determines the margin.
            if toward * (places[node, side // 2] - limit) <= values[number + side]:
                spread_slopes(slopes[node, side // 2], by_ends, toward, gradients[number + side])
                break


@njit(**OPTIONS)
def spread_slopes(slopes: Real, by_ends: Real, factor: float, row: Real) -> None:
    """Write derivatives (1 + 2n,), the first by the input, times a factor into a row of derivatives by the unknowns."""
    count = len(slopes) - 1
    for c in range(count):
        row[c] = factor * slopes[1 + c]
    for end in range(len(row) - count):
        row[count + end] = factor * by_ends[end] * slopes[0]


@njit(**OPTIONS)
def _write_both_sides(row: Real, by_ends: Real, number: int, gradients: Real) -> None:
    """Write the derivatives of the two margins of a cosine."""
    spread_slopes(row, by_ends, -1.0, gradients[number])
    spread_slopes(row, by_ends, 1.0, gradients[number + 1])


@njit(**OPTIONS)
def get_triad_pins(setting: Real, places: Real) -> tuple[complex, complex, complex, complex, complex, complex]:
    """Return the six pins of the triad."""
    q, j, o2, a, o4, b = setting[TRIAD]
    return (
        complex(places[int(q), 0], places[int(q), 1]),
        complex(places[int(j), 0], places[int(j), 1]),
        complex(places[int(o2), 0], places[int(o2), 1]),
        complex(places[int(a), 0], places[int(a), 1]),
        complex(places[int(o4), 0], places[int(o4), 1]),
        complex(places[int(b), 0], places[int(b), 1]),
    )


@njit(**OPTIONS)
def _differentiate_triad(setting: Real, places: Real, slopes: Real, row: Real) -> None:
    """Write the derivatives of the cosine of the triad's least transmission angle, the first by the input."""
    pins = get_triad_pins(setting, places)
    _, _, leg = find_min_slant(*pins)
    for c in range(len(row)):
        row[c] = differentiate_leg_slant(leg, pins, get_triad_pins(setting, slopes[:, :, c]))
