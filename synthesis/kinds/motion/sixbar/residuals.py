"""Residuals of a sixbar that carries a body through poses on one branch, in order.

The unknowns x are the seven joints in the first position (:mod:`synthesis.kinds.motion.sixbar.dyad_assembly`) and, from
each position to the next, the logarithm of the input's rotation, so that the input never reverses. Three optional
unknowns are the body's first pose, which is then fitted like the later ones. The linkage is driven by closing its
dyads, each in its initial assembly. A linkage that does not close at one of :data:`SAMPLE_COUNT` inputs in between is
rejected, so a descent never leaves the branch. The residuals, each 0 if satisfied, are:

* P's distance and the body's angle from each later position, or their excess over the tolerance;
* the excess of |cos μ| over that of the minimum transmission angle, for both dyads, or for the triad, at the samples;
* distances of two joints of a link above the reach and the maximum length, and below the minimum; the link ratio;
* distances of joints from their boxes: pivots in the first position, all joints along the motion.

With five positions there are twelve residuals of the first kind and eighteen unknowns: six freedoms to satisfy the
others. Derivatives are exact, from the differentiated closures |j − p| = const, |j − q| = const (a column for each
unknown coordinate, and one for the input).

A Stephenson II is driven by a link that turns relative to its input, and is then transformed to the ground frame
(:mod:`synthesis.kinds.motion.sixbar.inversion`): here "the input" is that link.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from synthesis.kinds.motion.sixbar.dyad_assembly import (
    COUPLER,
    GROUND,
    INPUT,
    LINK_PINS,
    O2,
    O4,
    OUTPUT,
    Q1,
    Q2,
    STEPHENSON_2,
    TOPOLOGY_LINKS,
    A,
    B,
    J,
    close_dyad,
    compute_signed_sine,
    place_on_link,
)
from synthesis.kinds.motion.sixbar.inversion import transform_rates, transform_to_ground
from synthesis.numerics.array_layout import ArrayLayout

JOINT_COORDINATE_COUNT = 14
"""Number of unknowns that are coordinates of joints."""

SAMPLE_COUNT = 24
"""Number of drive steps from the first position to the last, in addition to the positions themselves."""

SETTING = ArrayLayout(
    topology=1,
    input_direction=1,
    first_side=1,
    second_side=1,
    cosine=1,
    reach=1,
    shortest=1,
    longest=1,
    ratio=1,
    first_x=1,
    first_y=1,
    fixed_box=4,
    moving_box=4,
    joint_box=4,
    target_x=1,
    target_y=1,
)
"""Setting of a sixbar and its limits, in task coordinates."""

TOPOLOGY = SETTING.index("topology")
"""Topology number."""

INPUT_DIRECTION = SETTING.index("input_direction")
"""Direction of the input, ±1."""

FIRST_SIDE, SECOND_SIDE = SETTING.index("first_side"), SETTING.index("second_side")
"""Assemblies of both dyads, ±1."""

COSINE = SETTING.index("cosine")
"""Cosine of the minimum transmission angle."""

REACH, RATIO = SETTING.index("reach"), SETTING.index("ratio")
"""Maximum distance of two joints of a link, and maximum link ratio."""

SHORTEST, LONGEST = SETTING.index("shortest"), SETTING.index("longest")
"""Minimum and maximum link length."""

SCALAR_LIMITS = SETTING.slice("cosine", "ratio")
"""All limits other than boxes."""

FIRST_X, FIRST_Y = SETTING.index("first_x"), SETTING.index("first_y")
"""P in the first position."""

FIXED_BOX, MOVING_BOX = SETTING.slice("fixed_box"), SETTING.slice("moving_box")
"""Boxes (x min, x max, y min, y max) of the fixed pivots, and of the moving ones in the first position."""

JOINT_BOX = SETTING.slice("joint_box")
"""Box of all joints during the motion."""

BOXES = SETTING.slice("fixed_box", "joint_box")
"""All boxes."""

TARGET_X, TARGET_Y = SETTING.index("target_x"), SETTING.index("target_y")
"""Target of P in the first position, if that is fitted."""

POSE = ArrayLayout(x=1, y=1, angle=1, tolerances=3, point_weight=1, angle_weight=1)
"""Row of ``points``, one later position: P, the body's rotation from the first position, the tolerances of these three,
and the weights of P's distance and of the angle."""

POSE_X, POSE_Y, POSE_ANGLE = POSE.index("x"), POSE.index("y"), POSE.index("angle")
POSE_TOLERANCES = POSE.slice("tolerances")
POINT_WEIGHT_INDEX, ANGLE_WEIGHT_INDEX = POSE.index("point_weight"), POSE.index("angle_weight")

FREE_POSE_SIZE = 3
"""Number of unknowns of a fitted first pose: P, and the body's rotation from its target angle."""

BINARY_LINK_COUNT, P_INDEX = 6, 7
"""Number of binary links at the start of a list of pairs, and the index that denotes P in such a list."""

ANGLE_WEIGHT, COSINE_WEIGHT, SIZE_WEIGHT, BOX_WEIGHT = 0.7, 0.5, 0.3, 1.0
"""Weights of residuals relative to distances of P in task sizes: radians (unless the pose has its own weight), cosines,
lengths, distances from boxes."""

BARRIER_COSINE = math.cos(math.radians(3.0))
"""Cosine of the transmission angle above which a dyad counts as not closing."""

MAX_TURN = 6.2
"""Maximum rotation of the input, radians: just under a full turn."""

UNIT_RATES = np.array(
    [[(1.0, 1j)[m % 2] if m // 2 == j else 0.0 for j in range(7)] for m in range(JOINT_COORDINATE_COUNT)] + [[0.0j] * 7]
)
"""Derivatives of the joints by each unknown coordinate, one row each, and a last row of zeros for the input."""


def _list_pairs() -> NDArray[np.int64]:
    """List the pairs of joints on one link by topology, (makes, 16, 2), padded with −1; pairs with P come last."""
    listed = np.full((len(TOPOLOGY_LINKS), 16, 2), -1)
    for make, (first, second) in enumerate(TOPOLOGY_LINKS):
        pairs = [(O2, A), (A, B), (O4, B), (O2, O4), (Q1, J), (Q2, J)]
        pairs += [(Q1, int(pin)) for pin in LINK_PINS[first]] + [(Q2, int(pin)) for pin in LINK_PINS[second]]
        pairs += [(Q1, P_INDEX), (A if make == STEPHENSON_2 else J, P_INDEX)]
        listed[make, : len(pairs)] = pairs
    return listed


JOINT_PAIRS = _list_pairs()


@njit(cache=True, nogil=True, error_model="numpy")
def count_max_rows(positions: int) -> int:
    """Return the maximum number of residuals."""
    # Poses; cosines and boxes at each input; pairs; ratio; pivots; a fitted first pose.
    return 3 * positions + (2 + 12) * (SAMPLE_COUNT + positions) + 16 + 1 + 14 + FREE_POSE_SIZE


@njit(cache=True, nogil=True, error_model="numpy")
def _dot(u: complex, v: complex) -> float:
    return u.real * v.real + u.imag * v.imag


@njit(cache=True, nogil=True, error_model="numpy")
def _compute_joint_rate(
    u: complex, v: complex, p_rate: complex, q_rate: complex, first: float, second: float
) -> complex:
    """Return the rate of the joint of links u and v from pins p and q, by half the rates of their squared lengths."""
    along, across = first + _dot(u, p_rate), second + _dot(v, q_rate)
    # The denominator is 0 at a toggle, which the barrier keeps away.
    scale = 1.0 / (u.real * v.imag - u.imag * v.real)
    return complex((along * v.imag - across * u.imag) * scale, (u.real * across - v.real * along) * scale)


@njit(cache=True, nogil=True, error_model="numpy")
def compute_dimensions(z: Complex, lengths: Real, inverses: Complex) -> None:
    """Write lengths (4,) and reciprocals (4,) of A–B, O₄–B, Q₁–J and Q₂–J in the first position."""
    inverses[0], inverses[1], inverses[2], inverses[3] = z[B] - z[A], z[B] - z[O4], z[J] - z[Q1], z[J] - z[Q2]
    for n in range(4):
        lengths[n] = abs(inverses[n])
        inverses[n] = inverses[n].conjugate() / (lengths[n] * lengths[n])


@njit(cache=True, nogil=True, error_model="numpy")
def assemble_linkage(
    z: Complex, lengths: Real, inverses: Complex, setting: Real, angle: float, at: Complex, turns: Complex
) -> tuple[float, float]:
    """Assemble the linkage with its input turned by ``angle`` from the first position.

    Parameters
    ----------
    z, lengths, inverses : complex, shape (7,); float and complex, shape (4,)
        Joints in the first position, and their :func:`compute_dimensions`.
    setting : float
        See :data:`SETTING`.
    angle : float
        Radians.
    at : complex, shape (6,)
        Output: A, B, Q₁, Q₂, J and P.
    turns : complex, shape (4,)
        Output: rotations e^{iα} of input, coupler, output and body.

    Returns
    -------
    tuple of float
        Cosines of the angles at both dyads; the outputs are invalid if either is outside ±1.
    """
    first, second = TOPOLOGY_LINKS[int(setting[TOPOLOGY]), 0], TOPOLOGY_LINKS[int(setting[TOPOLOGY]), 1]
    turns[0] = complex(math.cos(angle), math.sin(angle))
    at[0] = z[O2] + turns[0] * (z[A] - z[O2])
    at[1], cosine = close_dyad(at[0], z[O4], lengths[0], lengths[1], setting[FIRST_SIDE])
    # Without a closed first dyad the second one has no pins.
    if not abs(cosine) < 1.0:
        return cosine, 0.0
    turns[1], turns[2] = (at[1] - at[0]) * inverses[0], (at[1] - z[O4]) * inverses[1]
    at[2] = place_on_link(first, z[Q1], z, at[0], turns[0], turns[1], turns[2])
    at[3] = place_on_link(second, z[Q2], z, at[0], turns[0], turns[1], turns[2])
    at[4], other = close_dyad(at[2], at[3], lengths[2], lengths[3], setting[SECOND_SIDE])
    turns[3] = (at[4] - at[2]) * inverses[2]
    at[5] = at[2] + turns[3] * (complex(setting[FIRST_X], setting[FIRST_Y]) - z[Q1])
    return cosine, other


@njit(cache=True, nogil=True, error_model="numpy")
def drive_linkage(
    z: Complex, lengths: Real, inverses: Complex, setting: Real, angle: float, at: Complex, turns: Complex
) -> tuple[float, float]:
    """Assemble the linkage in the ground frame; return cosines of transmission angles (one and 0 for Stephenson II)."""
    cosine, other = assemble_linkage(z, lengths, inverses, setting, angle, at, turns)
    if int(setting[TOPOLOGY]) == STEPHENSON_2 and abs(cosine) < 1.0 and abs(other) < 1.0:
        return transform_to_ground(z, complex(setting[FIRST_X], setting[FIRST_Y]), at, turns), 0.0
    return cosine, other


@njit(cache=True, nogil=True, error_model="numpy")
def _compute_point_rate(
    link: int, point: complex, own: complex, z: Complex, unit: Complex, at: Complex, turns: Complex, rates: Complex
) -> complex:
    """Return the rate of a point on a link of the fourbar; ``rates`` are those of A and of the links' rotations."""
    rate = own
    if link == INPUT:
        rate = unit[O2] + turns[0] * (own - unit[O2]) + rates[1] * (point - z[O2])
    elif link == COUPLER:
        rate = rates[0] + turns[1] * (own - unit[A]) + rates[2] * (point - z[A])
    elif link == OUTPUT:
        rate = unit[O4] + turns[2] * (own - unit[O4]) + rates[3] * (point - z[O4])
    return rate


@njit(cache=True, nogil=True, error_model="numpy")
def _compute_rates(
    z: Complex,
    lengths: Real,
    inverses: Complex,
    setting: Real,
    at: Complex,
    turns: Complex,
    cosines: Real,
    moving: Complex,
    turning: Real,
    through: Real,
    bending: Real,
) -> None:
    """Write the derivatives by each of the 15 rows of :data:`UNIT_RATES`.

    ``moving`` (6, 15) receives those of ``at``, ``bending`` (2, 15) those of both cosines, ``turning`` and ``through``
    (15,) those of the angles of the body and of the coupler.
    """
    make = int(setting[TOPOLOGY])
    first, second = TOPOLOGY_LINKS[make, 0], TOPOLOGY_LINKS[make, 1]
    ab, db, u, v = z[B] - z[A], z[B] - z[O4], z[J] - z[Q1], z[J] - z[Q2]
    squares, products = lengths * lengths, (lengths[0] * lengths[1], lengths[2] * lengths[3])
    start = complex(setting[FIRST_X], setting[FIRST_Y])
    rates = np.empty(4, np.complex128)
    for m in range(JOINT_COORDINATE_COUNT + 1):
        unit = UNIT_RATES[m]
        # The last row is the input: it turns the crank, and no joint moves by itself.
        rates[1] = 1j * turns[0] if m == JOINT_COORDINATE_COUNT else 0j
        rates[0] = unit[O2] + turns[0] * (unit[A] - unit[O2]) + rates[1] * (z[A] - z[O2])
        # Half the rates of the squared lengths of both bars of the first dyad.
        one, two = _dot(ab, unit[B] - unit[A]), _dot(db, unit[B] - unit[O4])
        b = _compute_joint_rate(at[1] - at[0], at[1] - z[O4], rates[0], unit[O4], one, two)
        rates[2] = (b - rates[0] - turns[1] * (unit[B] - unit[A])) * inverses[0]
        rates[3] = (b - unit[O4] - turns[2] * (unit[B] - unit[O4])) * inverses[1]
        bending[0, m] = (one + two - _dot(z[O4] - at[0], unit[O4] - rates[0])) / products[0]
        # Quotient rule: the lengths in the denominator change as well.
        bending[0, m] -= cosines[0] * (one / squares[0] + two / squares[1])
        moving[0, m], moving[1, m] = rates[0], b
        moving[2, m] = _compute_point_rate(first, z[Q1], unit[Q1], z, unit, at, turns, rates)
        moving[3, m] = _compute_point_rate(second, z[Q2], unit[Q2], z, unit, at, turns, rates)
        one, two = _dot(u, unit[J] - unit[Q1]), _dot(v, unit[J] - unit[Q2])
        j = _compute_joint_rate(at[4] - at[2], at[4] - at[3], moving[2, m], moving[3, m], one, two)
        bending[1, m] = (one + two - _dot(at[3] - at[2], moving[3, m] - moving[2, m])) / products[1]
        bending[1, m] -= cosines[1] * (one / squares[2] + two / squares[3])
        body = (j - moving[2, m] - turns[3] * (unit[J] - unit[Q1])) * inverses[2]
        moving[4, m] = j
        moving[5, m] = moving[2, m] + body * (start - z[Q1]) - turns[3] * unit[Q1]
        turning[m] = (body * turns[3].conjugate()).imag
        through[m] = (rates[2] * turns[1].conjugate()).imag


@njit(cache=True, nogil=True, error_model="numpy")
def _subtract_tolerance(off: float, tolerance: float) -> float:
    """Return the excess of a deviation over its tolerance, with the deviation's sign."""
    # The sign matters: the row is a linearization of the deviation itself.
    return math.copysign(max(abs(off) - tolerance, 0.0), off)


@njit(cache=True, nogil=True, error_model="numpy")
def _measure_excess(at: float, low: float, high: float) -> float:
    """Return the distance of a coordinate from an interval: 0 inside, negative below it."""
    return at - high if at > high else min(at - low, 0.0)


@njit(cache=True, nogil=True, error_model="numpy")
def _append_size_rows(z: Complex, setting: Real, residuals: Real, jacobian: Real, m: int, free: int) -> int:
    """Append residuals of links and of pivots in the first position; return the row count, or −1 for a zero length."""
    make, derived = int(setting[TOPOLOGY]), len(jacobian) > 0
    start = complex(setting[FIRST_X], setting[FIRST_Y])
    least, most = np.inf, 0.0
    shortest = longest = 0
    # Distances between pins are lengths; those from P only count for the reach.
    for n in range(len(JOINT_PAIRS[make])):
        i, k = JOINT_PAIRS[make, n]
        if i < 0:
            break
        way = z[i] - (start if k == P_INDEX else z[k])
        length = abs(way)
        if not length > 0.0:
            return -1
        if k != P_INDEX and length < least:
            least, shortest = length, n
        if k != P_INDEX and length > most:
            most, longest = length, n
        high = setting[REACH] if k == P_INDEX else min(setting[REACH], setting[LONGEST])
        off = _measure_excess(length, 0.0 if k == P_INDEX else setting[SHORTEST], high)
        if off != 0.0:
            residuals[m] = SIZE_WEIGHT * off
            if derived:
                jacobian[m] = 0.0
                _add_gradient(i, k, free, SIZE_WEIGHT * way / length, jacobian[m])
            m += 1
    # Smooth except when two links exchange roles, which the descent tolerates.
    # The logarithm of the ratio involves only the longest and the shortest link.
    if most > setting[RATIO] * least:
        residuals[m] = SIZE_WEIGHT * math.log(most / (setting[RATIO] * least))
        if derived:
            jacobian[m] = 0.0
            for n, sense in ((longest, 1.0), (shortest, -1.0)):
                i, k = JOINT_PAIRS[make, n]
                way = z[i] - z[k]
                _add_gradient(i, k, free, sense * SIZE_WEIGHT * way / abs(way) ** 2, jacobian[m])
        m += 1
    for i in range(7):
        # In a Stephenson II the ground pins are Q₂ and J, as everything else is relative to the input link.
        fixed = (
            i in (Q2, J) if make == STEPHENSON_2 else i in (O2, O4) or (i == Q2 and TOPOLOGY_LINKS[make, 1] == GROUND)
        )
        box = setting[FIXED_BOX] if fixed else setting[MOVING_BOX]
        for axis in range(2):
            off = _measure_excess(z[i].imag if axis else z[i].real, box[2 * axis], box[2 * axis + 1])
            if off != 0.0:
                residuals[m] = BOX_WEIGHT * off
                if derived:
                    jacobian[m] = 0.0
                    jacobian[m, 2 * i + axis] = BOX_WEIGHT
                m += 1
    return m


@njit(cache=True, nogil=True, error_model="numpy")
def _add_gradient(i: int, k: int, free: int, way: complex, row: Real) -> None:
    """Add to a row the derivatives of a function of z_i − z_k with gradient ``way``; ``free`` is P's first column."""
    row[2 * i] += way.real
    row[2 * i + 1] += way.imag
    if k != P_INDEX:
        row[2 * k] -= way.real
        row[2 * k + 1] -= way.imag
    elif free > 0:
        row[free] -= way.real
        row[free + 1] -= way.imag


@njit(cache=True, nogil=True, error_model="numpy")
def _write_row(rates: Real, weight: float, by_turn: Real, row: Real) -> None:
    """Write a Jacobian row from derivatives by joints and input, and the input's derivatives by its unknowns."""
    for m in range(JOINT_COORDINATE_COUNT):
        row[m] = weight * rates[m]
    for m in range(by_turn.size):
        row[JOINT_COORDINATE_COUNT + m] = weight * rates[JOINT_COORDINATE_COUNT] * by_turn[m]
    for m in range(JOINT_COORDINATE_COUNT + by_turn.size, row.size):
        row[m] = 0.0


@njit(cache=True, nogil=True, error_model="numpy")
def _write_body_entries(turn: complex, axis: int, weight: float, row: Real) -> None:
    """Write the entries of P's position on the body into the row of a coordinate of P."""
    row[0] = weight * (turn.imag if axis else turn.real)
    row[1] = weight * (turn.real if axis else -turn.imag)


@njit(cache=True, nogil=True, error_model="numpy")
def _append_first_pose_rows(
    pose: Real, setting: Real, stands: float, free: int, residuals: Real, jacobian: Real
) -> int:
    """Write the rows of a fitted first pose, with weights as of ``pose``; return their number."""
    m, derived = 0, len(jacobian) > 0
    off = setting[FIRST_X] - setting[TARGET_X], setting[FIRST_Y] - setting[TARGET_Y], stands
    for axis in range(FREE_POSE_SIZE):
        weight = pose[ANGLE_WEIGHT_INDEX if axis == 2 else POINT_WEIGHT_INDEX]
        residuals[m] = weight * off[axis]
        if derived:
            jacobian[m] = 0.0
            jacobian[m, free + axis] = weight
        m += 1
    return m


@njit(cache=True, nogil=True, error_model="numpy")
def _compute_turn_slopes(parts: Real, share: float, target: int, direction: float, by_turn: Real) -> None:
    """Write the input's derivatives by the logarithms of the intervals, at a share of all or at a target."""
    for k in range(len(parts)):
        by_turn[k] = (
            direction
            * parts[k]
            # A sample depends on all intervals in proportion; a target only on those before it.
            * (share if target < 0 else (1.0 if k <= target else 0.0))
        )


@njit(cache=True, nogil=True, error_model="numpy")
def _append_bound_rows(
    at: Complex, turn: complex, cosines: Real, rates: Complex, bending: Real, by_turn: Real, setting: Real,
    everywhere: bool, free: int, residuals: Real, jacobian: Real, m: int,
) -> int:  # fmt: skip
    """Append the rows of violated transmission angles and boxes at one input; return the number of rows."""
    derived, room = len(jacobian) > 0, setting[JOINT_BOX]
    for dyad in range(2):
        over = abs(cosines[dyad]) - setting[COSINE]
        if over > 0.0:
            residuals[m] = COSINE_WEIGHT * over
            if derived:
                _write_row(bending[dyad], math.copysign(COSINE_WEIGHT, cosines[dyad]), by_turn, jacobian[m])
            m += 1
    for j in range(0 if everywhere else 6):
        for axis in range(2):
            off = _measure_excess(at[j].imag if axis else at[j].real, room[2 * axis], room[2 * axis + 1])
            if off != 0.0:
                residuals[m] = BOX_WEIGHT * off
                if derived:
                    _write_row(rates[j].imag if axis else rates[j].real, BOX_WEIGHT, by_turn, jacobian[m])
                    if free > 0 and j == 5:
                        _write_body_entries(turn, axis, BOX_WEIGHT, jacobian[m, free:])
                m += 1
    return m


@njit(cache=True, nogil=True, error_model="numpy")
def _append_pose_rows(
    pose: Real, place: complex, turn: complex, stands: float, rates: Complex, turning: Real, by_turn: Real, free: int,
    residuals: Real, jacobian: Real, m: int,
) -> int:  # fmt: skip
    """Append the rows of the deviations from a target pose; return the number of rows."""
    derived = len(jacobian) > 0
    back = turn * complex(math.cos(pose[POSE_ANGLE]), -math.sin(pose[POSE_ANGLE]))
    tolerances = pose[POSE_TOLERANCES]
    # x, y and the angle of the body.
    for axis in range(3):
        weight, at_axis = pose[POINT_WEIGHT_INDEX], rates.real
        off = place.real - pose[POSE_X]
        if axis == 1:
            off, at_axis = place.imag - pose[POSE_Y], rates.imag
        elif axis == 2:
            off, at_axis, weight = math.atan2(back.imag, back.real) + stands, turning, pose[ANGLE_WEIGHT_INDEX]
        # Within its tolerance a coordinate has no residual, so it leaves a freedom to the others.
        if tolerances[axis] == 0.0 or abs(off) > tolerances[axis]:
            residuals[m] = weight * _subtract_tolerance(off, tolerances[axis])
            if derived:
                _write_row(at_axis, weight, by_turn, jacobian[m])
                if free > 0 and axis < 2:
                    _write_body_entries(turn, axis, weight, jacobian[m, free:])
                elif free > 0:
                    jacobian[m, free + 2] = weight
            m += 1
    return m


@njit(cache=True, nogil=True, error_model="numpy")
def _compute_intervals(x: Real, parts: Real) -> float:
    """Write the rotations of the input between positions, from their logarithms; return their sum."""
    total = 0.0
    for k in range(len(parts)):
        parts[k] = math.exp(x[JOINT_COORDINATE_COUNT + k])
        total += parts[k]
    return total


@njit(cache=True, nogil=True, error_model="numpy")
def evaluate_residuals(x: Real, points: Real, setting: Real, residuals: Real, jacobian: Real) -> int:
    """Evaluate the residuals of a sixbar and their Jacobian.

    Parameters
    ----------
    x : float, shape (14 + positions − 1,) or three more
        The unknowns.
    points : float, shape (positions − 1, POSE.size)
        See :data:`POSE`.
    setting : float
        See :data:`SETTING`; P of a fitted first pose is written into it.
    residuals, jacobian : float, shape (most_rows, ), (most_rows, unknowns)
        Output; a Jacobian without rows is not computed.

    Returns
    -------
    int
        The number of rows; −1 if the linkage does not close.
    """
    intervals, derived = len(points), len(jacobian) > 0
    # Three extra unknowns mean that the first pose is fitted.
    free, stands = JOINT_COORDINATE_COUNT + intervals if x.size > JOINT_COORDINATE_COUNT + intervals else -1, 0.0
    if free > 0:
        setting[FIRST_X], setting[FIRST_Y], stands = x[free], x[free + 1], x[free + 2]
    z, at, turns = np.empty(7, np.complex128), np.empty(6, np.complex128), np.empty(4, np.complex128)
    lengths, inverses = np.empty(4), np.empty(4, np.complex128)
    parts, by_turn = np.empty(intervals), np.empty(intervals)
    for j in range(7):
        z[j] = complex(x[2 * j], x[2 * j + 1])
    total = _compute_intervals(x, parts)
    # A dyad that changed its assembly in the first position has left its branch.
    if not total < MAX_TURN or setting[FIRST_SIDE] * compute_signed_sine(z[A], z[O4], z[B]) <= 0.0:
        return -1
    if setting[SECOND_SIDE] * compute_signed_sine(z[Q1], z[Q2], z[J]) <= 0.0:
        return -1
    compute_dimensions(z, lengths, inverses)
    rates = np.empty((6, JOINT_COORDINATE_COUNT + 1), np.complex128)
    turning, through = np.empty(JOINT_COORDINATE_COUNT + 1), np.empty(JOINT_COORDINATE_COUNT + 1)
    bending, cosines = np.empty((2, JOINT_COORDINATE_COUNT + 1)), np.empty(2)
    room = setting[JOINT_BOX]
    # Without a box no sample needs rates unless a cosine is active; that saves most of the work.
    everywhere = math.isinf(room[1] - room[0]) and math.isinf(room[3] - room[2])
    m, angle, inverted = 0, 0.0, int(setting[TOPOLOGY]) == STEPHENSON_2
    if free > 0:
        m = _append_first_pose_rows(points[0], setting, stands, free, residuals, jacobian)
    # First SAMPLE_COUNT evenly spaced inputs between the end positions, then the later positions themselves.
    for n in range(SAMPLE_COUNT + intervals):
        target = n - SAMPLE_COUNT
        # Samples in equal shares of the whole rotation; targets at the end of each interval.
        angle = total * n / SAMPLE_COUNT if target < 0 else parts[target] + (angle if target > 0 else 0.0)
        rotation = setting[INPUT_DIRECTION] * angle
        cosines[0], cosines[1] = assemble_linkage(z, lengths, inverses, setting, rotation, at, turns)
        # A barrier: a trial step over a toggle is rejected, so the descent keeps its branch.
        if not (abs(cosines[0]) < BARRIER_COSINE and abs(cosines[1]) < BARRIER_COSINE):
            return -1
        plain = everywhere and not inverted and max(abs(cosines[0]), abs(cosines[1])) <= setting[COSINE]
        if target < 0 and plain:
            continue  # no residual is active at this sample, so its rates are not needed
        if derived:
            _compute_turn_slopes(parts, n / SAMPLE_COUNT, target, setting[INPUT_DIRECTION], by_turn)
            _compute_rates(z, lengths, inverses, setting, at, turns, cosines, rates, turning, through, bending)
        if inverted:
            start = complex(setting[FIRST_X], setting[FIRST_Y])
            if derived:
                transform_rates(z, UNIT_RATES, start, at, turns, through, rates, turning, bending[0])
            cosines[0], cosines[1] = transform_to_ground(z, start, at, turns), 0.0
            if not abs(cosines[0]) < BARRIER_COSINE:
                return -1
        m = _append_bound_rows(
            at, turns[3], cosines, rates, bending, by_turn, setting, everywhere, free, residuals, jacobian, m
        )
        if target < 0:
            continue
        m = _append_pose_rows(
            points[target], at[5], turns[3], stands, rates[5], turning, by_turn, free, residuals, jacobian, m
        )
    return int(_append_size_rows(z, setting, residuals, jacobian, m, free))
