"""Margins of a workspace along a motion, and their derivatives by the unknowns that move the joints.

A motion is given by its joints at equal steps: shape (n, 6), in the order O2, A, B, O4, P and, for a linkage that
carries a body, the rotation e^{iα} of the body from its drawn pose. Between the steps joints, and corners of the body,
lie on parabolas through three of their places. Each margin has a *row*: the step k next to its nearest place, the share
t of a step between the two (−1 to 1), and weights w with which

    d(margin) = Σ_s L_s(t) Re Σ_j w̄_j dz_{s,j}        over the steps s = k − 1, k, k + 1,

where L_s are Lagrange's weights of the parabola, and dz of the rotation is i e^{iα} dα. :func:`differentiate_margin`
computes the sum. Margins of zones have k = −1: they concern the first position, which is given separately.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Complex, Integers, Real
from kinematics.compiling import njit
from synthesis.fit.chart import OPTIONS
from synthesis.fit.separation import compute_separation, measure_depth
from synthesis.fit.workspace import (
    BODY_START_INDEX,
    CLEARANCE_INDEX,
    COUNT_INDEX,
    EASED_INDEX,
    FIRST_X_INDEX,
    FIRST_Y_INDEX,
    GROUP_COUNT_INDEX,
    HALF_WIDTH_INDEX,
    HAS_BOX_INDEX,
    LEFT_INDEX,
    PART_COUNT_INDEX,
    PARTS_START_INDEX,
    PIECE_COUNT_INDEX,
    PIECES_START_INDEX,
    PLACES,
    STEP_COUNT,
    TURN,
    WINDOW_COUNT,
    ZONES_START_INDEX,
    P,
)

STEP_COLUMN, SHARE_COLUMN, WEIGHTS_COLUMN = 0, 1, 2
"""Indices in a row: k, t, and the weights as pairs of numbers."""

ROW_SIZE = WEIGHTS_COLUMN + 2 * PLACES
"""Length of a row."""

FAR_GAP = 0.25
"""Maximum distance of the margins, in task sizes: larger ones are cut off."""

CONVERGENCE_TOLERANCE = 0.1
"""Margin, in task sizes, above which only a lower bound is computed, without a row: no limit bears a load there."""

MAX_NARROWINGS, DUPLICATE_TOLERANCE = 4, 1e-3
"""Search for the nearest place between steps: maximum number of places evaluated, and the distance between two of them,
as a share of a step, below which the search has converged."""


@njit(**OPTIONS)
def count_margins(room: Real) -> int:
    """Return the number of margins of a workspace."""
    return int(room[COUNT_INDEX]) if len(room) else 0


@njit(**OPTIONS)
def count_steps(ring: bool) -> int:
    """Return the number of steps of a motion; a full turn has one less, because its end is its beginning."""
    return WINDOW_COUNT * STEP_COUNT + (0 if ring else 1)


@njit(**OPTIONS)
def compute_margins(room: Real, places: Complex, ring: bool, home: Complex, values: Real, rows: Real) -> None:
    """Compute the margins of a motion, and their rows.

    Parameters
    ----------
    room : float, shape (r,)
        Packed workspace, see :func:`synthesis.fit.workspace.pack_workspace`; not empty.
    places : complex, shape (n, 6)
        Joints, and the body's rotation, at ``n = count_steps(ring)`` equal steps of the motion, in task coordinates.
        Entries that the linkage lacks are ignored.
    ring : bool
        Whether the end of the motion continues at its beginning.
    home : complex, shape (6,)
        Joints, and the body's rotation, in the first position.
    values, rows : float, shapes (count_margins(room),) and (count_margins(room), ROW_SIZE)
        Output: the margins and their rows.
    """
    rows[:] = 0.0
    first = _write_zone_margins(room, home, values, rows)
    if room[HAS_BOX_INDEX] > 0.0:
        first = _write_box_margins(room, places, ring, values, rows, first)
    if room[GROUP_COUNT_INDEX] > 0.0:
        _write_obstacle_margins(room, places, ring, values, rows, first)


@njit(**OPTIONS)
def differentiate_margin(row: Real, ring: bool, slopes: Complex, home: Complex, out: Real) -> None:
    """Compute the derivatives of a margin by m unknowns, given those of the joints.

    Parameters
    ----------
    row : float, shape (ROW_SIZE,)
        Row of the margin.
    ring : bool
        As for :func:`compute_margins`.
    slopes : complex, shape (n, 6, m)
        Derivatives of the places at the steps. Only the steps of :func:`compute_parabola_weights` are used.
    home : complex, shape (6, m)
        Derivatives of the places in the first position.
    out : float, shape (m,)
        Output: the derivatives of the margin.
    """
    out[:] = 0.0
    if row[STEP_COLUMN] < 0.0:
        add_derivative(row, 1.0, home, out)
        return
    at, shares = compute_parabola_weights(int(row[STEP_COLUMN]), row[SHARE_COLUMN], ring, len(slopes))
    for s in range(3):
        if shares[s] != 0.0:
            add_derivative(row, shares[s], slopes[at[s]], out)


@njit(**OPTIONS)
def add_derivative(row: Real, share: float, slopes: Complex, out: Real) -> None:
    """Add the contribution of the places of one step to ``out``; ``slopes`` (6, m) are their derivatives."""
    for j in range(PLACES):
        x, y = share * row[WEIGHTS_COLUMN + 2 * j], share * row[WEIGHTS_COLUMN + 2 * j + 1]
        if x != 0.0 or y != 0.0:
            for i in range(len(out)):
                out[i] += x * slopes[j, i].real + y * slopes[j, i].imag


@njit(**OPTIONS)
def compute_parabola_weights(
    step: int, share: float, ring: bool, n: int
) -> tuple[tuple[int, int, int], tuple[float, float, float]]:
    """Return three steps and the weights of their places, which give the place at a share of a step from ``step``."""
    # At the ends of an open range the parabola is that of the nearest inner step.
    k = step if ring else min(max(step, 1), n - 2)
    t = share + (step - k)
    return ((k - 1) % n, k, (k + 1) % n), (0.5 * t * (t - 1.0), 1.0 - t * t, 0.5 * t * (t + 1.0))


@njit(**OPTIONS)
def _interpolate_places(places: Complex, step: int, share: float, ring: bool, out: Complex) -> None:
    at, shares = compute_parabola_weights(step, share, ring, len(places))
    for j in range(PLACES):
        out[j] = shares[0] * places[at[0], j] + shares[1] * places[at[1], j] + shares[2] * places[at[2], j]


@njit(**OPTIONS)
def _add_weight(row: Real, joint: int, weight: complex) -> None:
    row[WEIGHTS_COLUMN + 2 * joint] += weight.real
    row[WEIGHTS_COLUMN + 2 * joint + 1] += weight.imag


@njit(**OPTIONS)
def _write_zone_margins(room: Real, home: Complex, values: Real, rows: Real) -> int:
    """Write the depth of each pivot in the nearest of its zones; return the number of these margins."""
    at, m, pivot = int(room[ZONES_START_INDEX]), -1, -1
    drawn = complex(room[FIRST_X_INDEX], room[FIRST_Y_INDEX])
    while room[at] >= 0.0:
        joint, on_body, radius, aim = int(room[at]), room[at + 1] > 0.0, room[at + 2], room[at + 3]
        corners = room[at + 5 : at + 5 + 2 * int(room[at + 4])].view(np.complex128)
        at += 5 + 2 * len(corners)
        # Zones of one pivot are adjacent and share a margin: the best of them counts.
        if joint != pivot:
            pivot, m = joint, m + 1
            values[m] = -math.inf
        z = home[joint]
        # A zone on the body is drawn for the requested first position: map the pivot back to it.
        if on_body:
            z = drawn + (home[joint] - home[P]) * home[TURN].conjugate()
        if len(corners) == 1:
            offset = z - corners[0]
            depth, toward = radius - abs(offset), 1.0 + 0j
            if abs(offset) > 0.0:
                toward = -offset / abs(offset)
        else:
            depth, toward = measure_depth(z, corners)
        if depth - aim > values[m]:
            values[m] = depth - aim
            rows[m, :] = 0.0
            rows[m, STEP_COLUMN] = -1.0
            if on_body:
                _add_weight(rows[m], joint, toward * home[TURN])
                _add_weight(rows[m], P, -toward * home[TURN])
                _add_weight(rows[m], TURN, toward.conjugate() * (home[joint] - home[P]))
            else:
                _add_weight(rows[m], joint, toward)
    return m + 1


@njit(**OPTIONS)
def _find_parabola_minimum(before: float, here: float, after: float) -> float:
    """Return the share of a step, −1 to 1, at which the parabola through three margins is minimal; 0 if it is not
    convex."""
    bend = before - 2.0 * here + after
    if not bend > 0.0 or before < here or after < here:
        return 0.0
    return 0.5 * (before - after) / bend


@njit(**OPTIONS)
def _find_window_steps(room: Real, window: int, ring: bool, n: int) -> tuple[int, int]:
    """Return the steps of a window, as a half-open range; the last window includes the end of the motion."""
    # A whole turn ends one step before its start; an open range has one more step, which the last window takes.
    last = n if not ring and window == WINDOW_COUNT - 1 else (window + 1) * STEP_COUNT
    return window * STEP_COUNT, last


@njit(**OPTIONS)
def _get_easing(room: Real, window: int) -> float:
    """Return the easing of the body's limits in a window."""
    return float(room[EASED_INDEX]) if window == 0 or window == WINDOW_COUNT - 1 else 0.0


@njit(**OPTIONS)
def _measure_side_distance(room: Real, here: Complex, side: int, eased: float) -> tuple[float, int, complex]:
    """Measure the distance of the parts from a side of the box, positive inside.

    Return the distance, the nearest joint, and the point of the body if one of its corners is nearest, otherwise 0.
    """
    axis, toward = side // 2, 1.0 if side % 2 == 0 else -1.0
    limit, half = room[LEFT_INDEX + side], room[HALF_WIDTH_INDEX]
    least, joint, corner = math.inf, -1, 0j
    at = int(room[PARTS_START_INDEX])
    while room[at] >= 0.0:
        for k in range(int(room[at])):
            j = int(room[at + 1 + k])
            place = here[j].real if axis == 0 else here[j].imag
            if toward * (place - limit) - half < least:
                least, joint = toward * (place - limit) - half, j
        at += 4
    at = int(room[BODY_START_INDEX])
    drawn = complex(room[FIRST_X_INDEX], room[FIRST_Y_INDEX])
    while room[at] >= 0.0:
        count = int(room[at + 5])
        for k in range(count):
            own = complex(room[at + 6 + 2 * k], room[at + 7 + 2 * k]) - drawn
            # The body's pieces are drawn at the requested first position: move them with P and the rotation.
            z = here[P] + here[TURN] * own
            place = z.real if axis == 0 else z.imag
            if toward * (place - limit) + eased < least:
                least, joint, corner = toward * (place - limit) + eased, P, own
        at += 6 + 2 * count
    return least, joint, corner


@njit(**OPTIONS)
def _write_box_margins(room: Real, places: Complex, ring: bool, values: Real, rows: Real, first: int) -> int:
    """Write the distance of the parts from each side of the box in each window; return the next margin's number."""
    n = len(places)
    depths = np.empty((4, n))
    for step in range(n):
        for side in range(4):
            depths[side, step], _, _ = _measure_side_distance(
                room, places[step], side, _get_easing(room, min(step // STEP_COUNT, WINDOW_COUNT - 1))
            )
    here = np.empty(PLACES, np.complex128)
    for window in range(WINDOW_COUNT):
        begin, end = _find_window_steps(room, window, ring, n)
        for side in range(4):
            step = begin + int(np.argmin(depths[side, begin:end]))
            # Refine the lowest step by a parabola, so that the margin is a smooth function of the unknowns.
            share = 0.0
            if ring or 0 < step < n - 1:
                share = _find_parabola_minimum(
                    depths[side, (step - 1) % n], depths[side, step], depths[side, (step + 1) % n]
                )
            _interpolate_places(places, step, share, ring, here)
            values[first], joint, corner = _measure_side_distance(room, here, side, _get_easing(room, window))
            row = rows[first]
            row[STEP_COLUMN], row[SHARE_COLUMN] = float(step), share
            weight = (1.0 if side % 2 == 0 else -1.0) * (1.0 + 0j if side < 2 else 1j)
            # The derivative of a side's distance is that of the nearest corner's coordinate, with the side's sign.
            _add_weight(row, joint, weight)
            _add_weight(row, TURN, weight * corner.conjugate())
            first += 1
    return first


@njit(**OPTIONS)
def _write_core(room: Real, part: int, record: int, here: Complex, core: Complex) -> int:
    """Write the corners of a part, and return their number.

    The part is the link ``part``, or the piece of the body at ``record`` if ``part`` is −1.
    """
    if part >= 0:
        at = int(room[PARTS_START_INDEX]) + 4 * part
        count = int(room[at])
        for k in range(count):
            core[k] = here[int(room[at + 1 + k])]
        return count
    count = int(room[record + 5])
    drawn = complex(room[FIRST_X_INDEX], room[FIRST_Y_INDEX])
    for k in range(count):
        core[k] = here[P] + here[TURN] * (complex(room[record + 6 + 2 * k], room[record + 7 + 2 * k]) - drawn)
    return count


@njit(**OPTIONS)
def _write_obstacle_margins(room: Real, places: Complex, ring: bool, values: Real, rows: Real, first: int) -> None:
    """Write the minimum distance of each part from each group of obstacles in each window, minus the required one."""
    links, groups = int(room[PART_COUNT_INDEX]), int(room[GROUP_COUNT_INDEX])
    record = int(room[BODY_START_INDEX])
    # Size the scratch for the largest piece; links have up to three corners.
    longest, end = 3, record
    while room[end] >= 0.0:
        longest = max(longest, int(room[end + 5]))
        end += 6 + 2 * int(room[end + 5])
    core, here, weights = np.empty(longest, np.complex128), np.empty(PLACES, np.complex128), np.empty(longest)
    pieces = np.empty(int(room[PIECE_COUNT_INDEX]), np.int64)
    at = int(room[PIECES_START_INDEX])
    for k in range(len(pieces)):
        pieces[k] = at
        at += 6 + 2 * int(room[at + 5])
    numbers = np.empty((groups, 4))
    for part in range(links):
        _write_part_margins(
            room, part, -1, pieces, places, ring, core, here, weights, numbers, True, values, rows, first
        )
        first += WINDOW_COUNT * groups
    # Pieces of the body in one group share margins; the first of a group resets them.
    group, fresh = -1.0, True
    while room[record] >= 0.0:
        if room[record] != group:
            if group >= 0.0:
                first += WINDOW_COUNT * groups
            group, fresh = room[record], True
        _write_part_margins(
            room, -1, record, pieces, places, ring, core, here, weights, numbers, fresh, values, rows, first
        )
        fresh = False
        record += 6 + 2 * int(room[record + 5])


@njit(**OPTIONS)
def _measure_gap(room: Real, core: Complex, radius: float, piece: int, weights: Real) -> tuple[float, complex]:
    """Return the signed distance of a part from a piece minus the required one, and its direction."""
    corners = room[piece + 6 : piece + 6 + 2 * int(room[piece + 5])].view(np.complex128)
    apart, normal = compute_separation(core, corners, weights)
    return apart - radius - room[piece + 1] - room[CLEARANCE_INDEX], normal


@njit(**OPTIONS)
def _bound_displacement(room: Real, part: int, record: int, one: Complex, other: Complex) -> float:
    """Bound the displacement of a part's corners."""
    if part < 0:
        middle = complex(room[record + 2], room[record + 3]) - complex(room[FIRST_X_INDEX], room[FIRST_Y_INDEX])
        # A rigid piece: the displacement of its middle, plus its reach times the chord of the rotation.
        about = abs(one[P] - other[P] + middle * (one[TURN] - other[TURN]))
        return float(about + room[record + 4] * abs(one[TURN] - other[TURN]))
    at, most = int(room[PARTS_START_INDEX]) + 4 * part, 0.0
    for k in range(int(room[at])):
        joint = int(room[at + 1 + k])
        # A convex hull moves no farther than the farthest of its corners.
        most = max(most, abs(one[joint] - other[joint]))
    return most


@njit(**OPTIONS)
def _examine_middle(
    room: Real, pieces: Integers, core: Complex, radius: float, farthest: float, middle: int, weights: Real,
    at_middle: Real, nearest: Real,
) -> None:  # fmt: skip
    """Write the gaps of a part from all pieces in the middle of a window, and the nearest piece of each group.

    ``farthest`` bounds the part's displacement in the window.
    """
    for k in range(len(pieces)):
        piece = pieces[k]
        group = int(room[piece])
        at_middle[k] = _bound_gap(room, core, radius, piece)
        # Compute the exact gap only if the bound cannot exclude a load in this window.
        if at_middle[k] - farthest < CONVERGENCE_TOLERANCE:
            at_middle[k], _ = _measure_gap(room, core, radius, piece, weights)
        if at_middle[k] - farthest >= CONVERGENCE_TOLERANCE:
            # Far in the whole window: keep the lower bound, which needs no row.
            nearest[group, 0] = min(nearest[group, 0], at_middle[k] - farthest)
        elif at_middle[k] < nearest[group, 0]:
            nearest[group, 0], nearest[group, 1], nearest[group, 2] = at_middle[k], float(middle), float(piece)


@njit(**OPTIONS)
def _write_part_margins(
    room: Real, part: int, record: int, pieces: Integers, places: Complex, ring: bool, core: Complex, here: Complex,
    weights: Real, nearest: Real, fresh: bool, values: Real, rows: Real, first: int,
) -> None:  # fmt: skip
    """Write the margins of one part from each group of pieces in each window, from number ``first`` on.

    If the part shares its margins with others, ``fresh`` is true for the first of them. ``nearest`` is scratch: for
    each group the minimum gap, its step and its piece. The middle of a window is examined first: from there no gap
    changes by more than the part moves.
    """
    n, groups = len(places), len(nearest)
    moves, at_middle = np.empty(STEP_COUNT + 1), np.empty(len(pieces))
    for window in range(WINDOW_COUNT):
        # The body's outline has no width of its own; a negative radius eases its limit.
        radius = room[HALF_WIDTH_INDEX] if part >= 0 else -_get_easing(room, window)
        begin, end = _find_window_steps(room, window, ring, n)
        middle = (begin + end) // 2
        # Step −1 marks a bound without a place.
        nearest[:, 0], nearest[:, 1] = FAR_GAP, -1.0
        farthest = 0.0
        for step in range(begin, end):
            moves[step - begin] = _bound_displacement(room, part, record, places[step], places[middle])
            farthest = max(farthest, moves[step - begin])
        count = _write_core(room, part, record, places[middle], core)
        _examine_middle(room, pieces, core[:count], radius, farthest, middle, weights[:count], at_middle, nearest)
        for step in range(begin, end):
            if step == middle:
                continue
            known = False
            for k in range(len(pieces)):
                piece = pieces[k]
                group = int(room[piece])
                # From the middle the part cannot come nearer than this, so the pair needs no exact gap at this step.
                if at_middle[k] - moves[step - begin] >= min(nearest[group, 0], CONVERGENCE_TOLERANCE):
                    continue
                if not known:
                    count, known = _write_core(room, part, record, places[step], core), True
                gap, _ = _measure_gap(room, core[:count], radius, piece, weights[:count])
                if gap < nearest[group, 0]:
                    nearest[group, 0], nearest[group, 1], nearest[group, 2] = gap, float(step), float(piece)
        for group in range(groups):
            number = first + window * groups + group
            if fresh:
                values[number] = FAR_GAP
            # Another piece of the same group is nearer.
            if nearest[group, 0] >= values[number]:
                continue
            values[number] = nearest[group, 0]
            rows[number] = 0.0
            # Beyond the tolerance no limit bears a load, so no derivative is needed.
            if nearest[group, 0] >= CONVERGENCE_TOLERANCE or nearest[group, 1] < 0.0:
                continue
            _write_nearest_row(
                room, part, record, int(nearest[group, 2]), places, int(nearest[group, 1]), ring, core, here, weights,
                radius, nearest[group, 0], values, rows, number,
            )  # fmt: skip


@njit(**OPTIONS)
def _bound_gap(room: Real, core: Complex, radius: float, piece: int) -> float:
    """Return a lower bound of the gap, by the circles around both."""
    middle, reach = core.mean(), 0.0
    for corner in core:
        reach = max(reach, abs(corner - middle))
    apart = abs(middle - complex(room[piece + 2], room[piece + 3])) - reach - room[piece + 4]
    return float(apart - radius - room[piece + 1] - room[CLEARANCE_INDEX])


@njit(**OPTIONS)
def _measure_gap_between(
    room: Real,
    part: int,
    record: int,
    piece: int,
    places: Complex,
    step: int,
    share: float,
    ring: bool,
    core: Complex,
    here: Complex,
    weights: Real,
    radius: float,
) -> tuple[float, complex]:
    """Return the gap and its direction at a share of a step from ``step``.

    ``here``, ``core`` and ``weights`` are overwritten.
    """
    _interpolate_places(places, step, share, ring, here)
    count = _write_core(room, part, record, here, core)
    gap: tuple[float, complex] = _measure_gap(room, core[:count], radius, piece, weights[:count])
    return gap


@njit(**OPTIONS)
def _write_nearest_row(
    room: Real, part: int, record: int, piece: int, places: Complex, step: int, ring: bool, core: Complex,
    here: Complex, weights: Real, radius: float, gap: float, values: Real, rows: Real, number: int,
) -> None:  # fmt: skip
    """Write a margin and its row, at the step with the minimum or between it and its neighbours."""
    n = len(places)
    # Bracket the minimum between the neighbouring steps; at the ends of an open range one side is missing.
    left, middle, right = -1.0, 0.0, 1.0
    if not ring:
        left, right = (0.0 if step == 0 else -1.0), (0.0 if step == n - 1 else 1.0)
    at_middle = gap
    at_left, _ = _measure_gap_between(room, part, record, piece, places, step, left, ring, core, here, weights, radius)
    at_right, _ = _measure_gap_between(
        room, part, record, piece, places, step, right, ring, core, here, weights, radius
    )
    for _ in range(MAX_NARROWINGS if left < 0.0 < right else 0):
        # Not a bracket: a neighbour in the next window is nearer, and that window has its own margin.
        if at_left < at_middle or at_right < at_middle:
            break
        share = _find_lowest(left, at_left, middle, at_middle, right, at_right)
        if abs(share - middle) < DUPLICATE_TOLERANCE:
            break
        value, _ = _measure_gap_between(
            room, part, record, piece, places, step, share, ring, core, here, weights, radius
        )
        if (share < middle) == (value < at_middle):
            # Keep the bracket around the lower of the two; the part beyond the other is dropped.
            right, at_right = (middle, at_middle) if value < at_middle else (share, value)
        else:
            left, at_left = (middle, at_middle) if value < at_middle else (share, value)
        if value < at_middle:
            middle, at_middle = share, value
    value, normal = _measure_gap_between(
        room, part, record, piece, places, step, middle, ring, core, here, weights, radius
    )
    values[number] = value
    row = rows[number]
    row[:] = 0.0
    row[STEP_COLUMN], row[SHARE_COLUMN] = float(step), middle
    if part >= 0:
        at = int(room[PARTS_START_INDEX]) + 4 * part
        for k in range(int(room[at])):
            _add_weight(row, int(room[at + 1 + k]), weights[k] * normal)
        return
    # A contact on the body moves with P and with the rotation about P.
    _add_weight(row, P, normal)
    drawn = complex(room[FIRST_X_INDEX], room[FIRST_Y_INDEX])
    for k in range(int(room[record + 5])):
        own = complex(room[record + 6 + 2 * k], room[record + 7 + 2 * k]) - drawn
        _add_weight(row, TURN, weights[k] * normal * own.conjugate())


@njit(**OPTIONS)
def _find_lowest(left: float, at_left: float, middle: float, at_middle: float, right: float, at_right: float) -> float:
    """Return the lowest point of the parabola through three places.

    If the three values lie on a line, return the middle of the longer half.
    """
    one, two = (middle - left) * (at_middle - at_right), (middle - right) * (at_middle - at_left)
    # The three values lie on a line, for example if they are equal: the parabola has no vertex, so bisect.
    if one == two:
        return 0.5 * (middle + (left if middle - left > right - middle else right))
    return float(middle - 0.5 * ((middle - left) * one - (middle - right) * two) / (one - two))
