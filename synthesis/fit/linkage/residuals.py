"""Residuals of a linkage at targets, and along the curve of its traced point, in the form of a descent's rows.

A target is a row (kind, i, j, a, b, root, slot, free, s, t):

========= =================================================================================================
kind      residuals
========= =================================================================================================
PLACE     node i minus (a, b), two rows
TURN      rotation of the direction from node i to node j since the reference position, minus a, one row
DIRECTION angle of the direction from node i to node j, minus a, one row
ARM       ln((e^(ia) (X_i − X_j) + X_j − X_k) / |Z_i − Z_k|) − ib with k = j + 1, two rows
========= =================================================================================================

An ARM target belongs to a linkage that is seen from its input link, as a Stephenson II. The input link, with node i
on it, is turned by a about its pivot j. Then node i must be at its distance in the reference position from the other
pivot k, in the direction b from there: they are joined by the output. The weight of the distance has the root ``free``.

They are multiplied by ``root``, the root of a weight. A residual within ±s of 0 (the second row of a PLACE: ±t) is 0; a
larger one counts from there: s and t are tolerances. Targets of one slot are consecutive and share an input. A free
input is eliminated: for each linkage it is moved to the position with the least squares of its slot, by Gauss–Newton
steps from that of the last accepted linkage, and the Jacobian is that at a fixed input minus its part along the slot's
derivative by the input (variable projection). Other inputs are constants.

The *way back* are the distances of the traced point, at equal steps of the input, from the polyline through the points,
weighted by the arc length that each step stands for.

The *robust* form sums w(√(d² + δ²) − δ) instead of squares, which is nearly the mean distance, and takes the place of
the curve that is nearest to each point, in any order. With f = √(d² + δ²) a distance has
the row √(w/f) d, whose gradient is exact; one more row without derivatives, √Σ w(f − δ)²/f, completes the sum.

*Ordered* inputs are not eliminated, because the input that suits a slot best may be out of order. The last unknowns are
the logarithms of the steps from each input to the next; the first input is 0, and all steps have one direction, which
a descent keeps.

A linkage moves over a full turn of its input, or in a range whose ends are the last two unknowns (robust form) or the
outermost inputs of the targets and of the reference position (squares). One that does not close throughout is refused.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Integers, Real
from kinematics.compiling import njit
from synthesis.fit.chart import OPTIONS
from synthesis.fit.linkage.closure import (
    CONSTANT_COUNT,
    close_linkage,
    compute_constants,
    differentiate_input,
    differentiate_nodes,
)
from synthesis.fit.linkage.curve import X as X
from synthesis.fit.linkage.curve import Y as Y
from synthesis.fit.linkage.curve import find_nearest_side, find_nearest_step, measure_arcs
from synthesis.fit.linkage.margins import (
    EQUATION_COUNT,
    count_margins,
    count_step_margins,
    is_loaded,
    spread_slopes,
    write_order_margin,
    write_static_margins,
    write_step_gradients,
    write_step_values,
)
from synthesis.fit.linkage.setting import BACK, FULL_TURN, ORDER, POINT_NODE, STEPS, WIDTH, unpack_table
from synthesis.numerics.augmented_lagrangian import append_limit_rows
from synthesis.numerics.levenberg import ROWS

PLACE, TURN, DIRECTION, ARM = range(4)
"""Kinds of targets."""

KIND, FIRST_NODE, SECOND_NODE = range(X)
ROOT, SLOT, FREE, TOLERANCE, SECOND_TOLERANCE = range(Y + 1, Y + 6)
"""Columns of targets, without those of the place."""

TARGET_SIZE = 10
"""Number of columns of targets."""

MAX_SETTLING_STEPS, MAX_INPUT_STEP, INPUT_TOLERANCE = 2, 0.25, 1e-7
"""Maximum number of steps that settle an input at each linkage; the maximum step, and the step after which it is
settled, radians."""

MIN_SPEED = 1e-9
"""Derivative of a slot's residuals by its input, task sizes per radian, below which the input changes nothing."""

MAX_COORDINATE = 1e4
"""Coordinate, in task sizes, beyond which a linkage is refused: its links would be nearly parallel."""


@njit(**OPTIONS)
def count_rows(targets: int, setting: Real) -> int:
    """Return the maximum number of rows for a number of targets."""
    most: int = 2 * targets + int(setting[STEPS]) + count_margins(setting) + 1
    return most


@njit(**OPTIONS)
def _turn(vector: complex, angle: float) -> complex:
    """Return a vector rotated by an angle."""
    return vector * complex(math.cos(angle), math.sin(angle))


@njit(**OPTIONS)
def _carry_arm(target: Real, z: Real, places: Real) -> tuple[complex, float]:
    """Return the arm of the output of an ARM target, as the ground sees it, and its length in the reference
    position."""
    i, j = int(target[FIRST_NODE]), int(target[SECOND_NODE])
    k = j + 1
    pin = complex(places[i, 0] - places[j, 0], places[i, 1] - places[j, 1])
    ground = complex(z[2 * k] - z[2 * j], z[2 * k + 1] - z[2 * j + 1])
    return _turn(pin, target[X]) - ground, math.hypot(z[2 * i] - z[2 * k], z[2 * i + 1] - z[2 * k + 1])


@njit(**OPTIONS)
def _write_carried_slopes(target: Real, z: Real, places: Real, slopes: Real, rows: Real) -> None:
    """Write the derivatives of an ARM target's two rows by the unknowns, at a fixed input."""
    i, j = int(target[FIRST_NODE]), int(target[SECOND_NODE])
    k, root, root_of_length = j + 1, target[ROOT], target[FREE]
    arm, length = _carry_arm(target, z, places)
    rows[:2] = 0.0
    for c in range(slopes.shape[2] - 1):
        pivot = complex(slopes[j, 0, 1 + c], slopes[j, 1, 1 + c])
        moved = _turn(complex(slopes[i, 0, 1 + c], slopes[i, 1, 1 + c]) - pivot, target[X])
        moved = (moved + pivot - complex(slopes[k, 0, 1 + c], slopes[k, 1, 1 + c])) / arm
        rows[0, c], rows[1, c] = root_of_length * moved.real, root * moved.imag
    for axis in range(2):
        change = root_of_length * (z[2 * i + axis] - z[2 * k + axis]) / (length * length)
        rows[0, 2 * i + axis] -= change
        rows[0, 2 * k + axis] += change


@njit(**OPTIONS)
def _carry_ground(target: Real, places: Real) -> None:
    """Turn the ground of an ARM target back by the rotation of the input link, which sees it there."""
    j = int(target[SECOND_NODE])
    ground = _turn(complex(places[j + 1, 0] - places[j, 0], places[j + 1, 1] - places[j, 1]), -target[X])
    places[j + 1, 0], places[j + 1, 1] = places[j, 0] + ground.real, places[j, 1] + ground.imag


@njit(**OPTIONS)
def _carry_slopes(target: Real, turn: Real, slopes: Real) -> None:
    """Turn the derivatives of the ground as :func:`_carry_ground`, and add those of the input, ``turn``, to all."""
    j = int(target[SECOND_NODE])
    for c in range(len(turn)):
        moved = complex(
            slopes[j + 1, 0, 1 + c] - slopes[j, 0, 1 + c], slopes[j + 1, 1, 1 + c] - slopes[j, 1, 1 + c]
        )  # fmt: skip
        moved = _turn(moved, -target[X])
        slopes[j + 1, 0, 1 + c] = slopes[j, 0, 1 + c] + moved.real
        slopes[j + 1, 1, 1 + c] = slopes[j, 1, 1 + c] + moved.imag
        for k in range(len(slopes)):
            for axis in range(2):
                slopes[k, axis, 1 + c] += turn[c] * slopes[k, axis, 0]


@njit(**OPTIONS)
def _exceed_tolerance(residual: float, tolerance: float) -> float:
    """Return the part of a residual beyond a tolerance, with its sign."""
    return math.copysign(max(abs(residual) - tolerance, 0.0), residual)


@njit(**OPTIONS)
def _measure_slot(
    targets: Real, first: int, last: int, z: Real, places: Real, rates: Real, residuals: Real, tangent: Real
) -> int:
    """Write the residuals of a slot's targets and their derivatives by the input; return their number."""
    m = 0
    for t in range(first, last):
        i, root = int(targets[t, FIRST_NODE]), targets[t, ROOT]
        if targets[t, KIND] == PLACE:
            for axis in range(2):
                off = _exceed_tolerance(places[i, axis] - targets[t, X + axis], targets[t, TOLERANCE + axis])
                residuals[m] = root * off
                # Within its tolerance a coordinate does not depend on anything.
                tangent[m] = 0.0 if off == 0.0 and targets[t, TOLERANCE + axis] > 0.0 else root * rates[i, axis]
                m += 1
        elif targets[t, KIND] == ARM:
            arm, length = _carry_arm(targets[t], z, places)
            residuals[m] = targets[t, FREE] * math.log(abs(arm) / length)
            off = math.atan2(arm.imag, arm.real) - targets[t, Y]
            residuals[m + 1] = root * (off - 2.0 * math.pi * round(off / (2.0 * math.pi)))
            moved = _turn(complex(rates[i, 0], rates[i, 1]), targets[t, X]) / arm
            tangent[m], tangent[m + 1] = targets[t, FREE] * moved.real, root * moved.imag
            m += 2
        else:
            j, hx, hy = int(targets[t, SECOND_NODE]), 1.0, 0.0
            gx, gy = places[j, 0] - places[i, 0], places[j, 1] - places[i, 1]
            if targets[t, KIND] == TURN:
                hx, hy = z[2 * j] - z[2 * i], z[2 * j + 1] - z[2 * i + 1]
            off = math.atan2(hx * gy - hy * gx, hx * gx + hy * gy) - targets[t, X]
            # Rotations are compared modulo full turns.
            off = _exceed_tolerance(off - 2.0 * math.pi * round(off / (2.0 * math.pi)), targets[t, TOLERANCE])
            residuals[m] = root * off
            turn = gx * (rates[j, 1] - rates[i, 1]) - gy * (rates[j, 0] - rates[i, 0])
            tangent[m] = root * turn / (gx * gx + gy * gy)
            if off == 0.0 and targets[t, TOLERANCE] > 0.0:
                tangent[m] = 0.0
            m += 1
    return m


@njit(**OPTIONS)
def _settle_input(
    targets: Real, first: int, last: int, nodes: Integers, z: Real, constants: Real, theta: float, low: float,
    high: float, places: Real, rates: Real, cosines: Real, residuals: Real, tangent: Real,
) -> float:  # fmt: skip
    """Move an input towards the least squares of its slot, within [low, high]; NaN where the linkage does not close."""
    for _ in range(MAX_SETTLING_STEPS):
        if not close_linkage(nodes, z, constants, theta, places, cosines):
            return math.nan
        differentiate_input(nodes, z, constants, places, rates)
        m = _measure_slot(targets, first, last, z, places, rates, residuals, tangent)
        square, along = 0.0, 0.0
        for k in range(m):
            square += tangent[k] * tangent[k]
            along += tangent[k] * residuals[k]
        if square < MIN_SPEED * MIN_SPEED:
            return theta
        # Gauss–Newton: the curvature of the path is neglected, so that long steps are not to be trusted.
        step = min(max(-along / square, -MAX_INPUT_STEP), MAX_INPUT_STEP)
        moved = min(max(theta + step, low), high)
        settled = abs(moved - theta) < INPUT_TOLERANCE
        theta = moved
        if settled:
            break
    return theta


@njit(**OPTIONS)
def _write_slot_slopes(
    targets: Real, first: int, last: int, z: Real, places: Real, slopes: Real, residuals: Real, rows: Real
) -> None:
    """Write the derivatives of a slot's residuals by the unknowns, at a fixed input."""
    count, m = slopes.shape[2] - 1, 0
    for t in range(first, last):
        i, root = int(targets[t, FIRST_NODE]), targets[t, ROOT]
        if targets[t, KIND] == PLACE:
            for axis in range(2):
                rows[m] = 0.0
                if not (residuals[m] == 0.0 and targets[t, TOLERANCE + axis] > 0.0):
                    for c in range(count):
                        rows[m, c] = root * slopes[i, axis, 1 + c]
                m += 1
        elif targets[t, KIND] == ARM:
            _write_carried_slopes(targets[t], z, places, slopes, rows[m:])
            m += 2
        else:
            j = int(targets[t, SECOND_NODE])
            gx, gy = places[j, 0] - places[i, 0], places[j, 1] - places[i, 1]
            per = root / (gx * gx + gy * gy)
            rows[m] = 0.0
            for c in range(count):
                dx, dy = slopes[j, 0, 1 + c] - slopes[i, 0, 1 + c], slopes[j, 1, 1 + c] - slopes[i, 1, 1 + c]
                rows[m, c] = per * (gx * dy - gy * dx)
            if targets[t, KIND] == TURN:
                # The reference direction rotates with the unknowns, too.
                hx, hy = z[2 * j] - z[2 * i], z[2 * j + 1] - z[2 * i + 1]
                by_reference = root / (hx * hx + hy * hy)
                rows[m, 2 * j] += by_reference * hy
                rows[m, 2 * j + 1] -= by_reference * hx
                rows[m, 2 * i] -= by_reference * hy
                rows[m, 2 * i + 1] += by_reference * hx
            if residuals[m] == 0.0 and targets[t, TOLERANCE] > 0.0:
                rows[m] = 0.0
            m += 1


@njit(**OPTIONS)
def _eliminate_input(tangent: Real, m: int, rows: Real, turn: Real) -> None:
    """Subtract the part along the input from the first m rows; ``turn`` receives the input's derivatives."""
    square = 0.0
    turn[:] = 0.0
    for k in range(m):
        square += tangent[k] * tangent[k]
    if square < MIN_SPEED * MIN_SPEED:
        return
    for k in range(m):
        for c in range(len(turn)):
            turn[c] -= tangent[k] * rows[k, c] / square
    for k in range(m):
        for c in range(len(turn)):
            rows[k, c] += tangent[k] * turn[c]


@njit(**OPTIONS)
def _weight_robustly(width: float, m: int, first: int, residuals: Real, jacobian: Real, root: float) -> float:
    """Weight the rows from ``first`` to m of one distance for the robust sum; return the part that they leave out."""
    square = 0.0
    for k in range(first, m):
        square += residuals[k] * residuals[k]
    # Rows are multiplied by the root of the weight; the distance itself decides the rest.
    far = math.sqrt(square / (root * root) + width * width)
    for k in range(first, m):
        residuals[k] /= math.sqrt(far)
        jacobian[k] /= math.sqrt(far)
    return root * root * (far - width) * (far - width) / far


@njit(**OPTIONS)
def _write_ordered_inputs(logs: Real, inputs: Real, by_last: Real) -> None:
    """Write ordered inputs from the logarithms of their steps, and the derivatives of the last one by these."""
    # The direction is that of the last accepted linkage, or of the start.
    way = math.copysign(1.0, inputs[len(inputs) - 1])
    if len(by_last) > 0:
        inputs[0] = 0.0
    for k in range(len(by_last)):
        by_last[k] = way * math.exp(logs[k])
        inputs[k + 1] = inputs[k] + by_last[k]


@njit(**OPTIONS)
def _trace_steps(
    nodes: Integers, z: Real, constants: Real, low: float, per: float, point: int, places: Real, cosines: Real,
    curve: Real,
) -> bool:  # fmt: skip
    """Write the traced point at equal steps of the input; return whether the linkage closes at all of them."""
    for k in range(len(curve)):
        if not close_linkage(nodes, z, constants, low + per * k, places, cosines):
            return False
        curve[k, 0], curve[k, 1] = places[point, 0], places[point, 1]
    return True


@njit(**OPTIONS)
def _write_target_rows(
    x: Real, targets: Real, setting: Real, nodes: Integers, constants: Real, curve: Real, begin: float, per: float,
    low: float, high: float, inputs: Real, by_last: Real, turns: Real, first_places: Real, first_slopes: Real,
    residuals: Real, jacobian: Real,
) -> tuple[int, float]:  # fmt: skip
    """Write the rows of all targets; return their number and the part of the robust sum that they leave out.

    The number is −1 if the linkage does not close at an input. ``inputs`` (slots,) settle in place within [low, high].
    ``curve`` (steps, 2) is the traced curve from the input ``begin`` in steps of ``per``, for the robust form.
    ``by_last`` are the derivatives of the last of ordered inputs by its unknowns, else it is empty.
    ``turns`` (slots or 0, unknowns) receive the derivatives of the inputs.
    ``first_places`` and ``first_slopes`` receive the nodes at the first target and their derivatives.
    """
    n, count, unknowns, point = len(nodes), len(targets), len(x), int(setting[POINT_NODE])
    robust, width = setting[WIDTH] > 0.0, setting[WIDTH]
    places, rates, cosines = np.empty((n, 2)), np.empty((n, 2)), np.zeros(n)
    slopes, tangent, turn = np.zeros((n, 2, 1 + 2 * n)), np.empty(2 * count), np.zeros(unknowns)
    left_out, m, first = 0.0, 0, 0
    while first < count:
        slot, free = int(targets[first, SLOT]), targets[first, FREE] > 0.0 and setting[ORDER] == 0.0
        last = first + 1
        while last < count and int(targets[last, SLOT]) == slot:
            last += 1
        theta = inputs[slot]
        if robust:
            near = np.inf
            if low <= theta <= high and close_linkage(nodes, x, constants, theta, places, cosines):
                near = (places[point, 0] - targets[first, X]) ** 2 + (places[point, 1] - targets[first, Y]) ** 2
            theta = find_nearest_step(targets[first], curve, theta, begin, per, near)
        if free:
            theta = _settle_input(
                targets, first, last, nodes, x, constants, theta, low, high, places, rates, cosines, residuals[m:],
                tangent,
            )  # fmt: skip
        # Negated: NaN means that the linkage does not close.
        if not abs(theta) < np.inf or not close_linkage(nodes, x, constants, theta, places, cosines):
            return -1, 0.0
        inputs[slot] = theta
        differentiate_nodes(nodes, x, constants, theta, places, slopes)
        for k in range(n):
            rates[k, 0], rates[k, 1] = slopes[k, 0, 0], slopes[k, 1, 0]
        added = _measure_slot(targets, first, last, x, places, rates, residuals[m:], tangent)
        _write_slot_slopes(targets, first, last, x, places, slopes, residuals[m:], jacobian[m:])
        turn[:] = 0.0
        if setting[ORDER] != 0.0:
            for c in range(slot):
                for k in range(added):
                    jacobian[m + k, 2 * n + c] += tangent[k] * by_last[c]
        elif free and low < theta < high:
            _eliminate_input(tangent, added, jacobian[m:], turn)
        elif free:
            # At an end of the range the input moves with it.
            end = unknowns - 2 if theta <= low else unknowns - 1
            turn[end] = 1.0
            for k in range(added):
                jacobian[m + k, end] += tangent[k]
        if slot < len(turns):
            turns[slot] = turn
        if first == 0:
            first_places[:] = places
            for k in range(n):
                for axis in range(2):
                    first_slopes[k, axis] = slopes[k, axis, 0] * turn
                    for c in range(2 * n):
                        first_slopes[k, axis, c] += slopes[k, axis, 1 + c]
        if robust:
            left_out += _weight_robustly(width, m + added, m, residuals, jacobian, targets[first, ROOT])
        m, first = m + added, last
    return m, left_out


@njit(**OPTIONS)
def _write_back_row(
    places: Real, slopes: Real, by_ends: Real, targets: Real, setting: Real, arc: float, m: int, residuals: Real,
    jacobian: Real,
) -> float:  # fmt: skip
    """Write the row m of the way back at one step; return the part of the robust sum that it leaves out."""
    point, nodes, unknowns = int(setting[POINT_NODE]), len(places), jacobian.shape[1]
    off_x, off_y, side_x, side_y = find_nearest_side(
        places[point, 0], places[point, 1], targets, setting[FULL_TURN] > 0.0
    )  # fmt: skip
    root = math.sqrt(setting[BACK] * arc)
    residuals[m] = root * (off_x * side_x + off_y * side_y)
    spread_slopes(slopes[point, 0], by_ends, root * side_x, jacobian[m])
    for c in range(2 * nodes):
        jacobian[m, c] += root * side_y * slopes[point, 1, 1 + c]
    for c in range(2 * nodes, unknowns):
        jacobian[m, c] += root * side_y * by_ends[c - 2 * nodes] * slopes[point, 1, 0]
    if setting[WIDTH] > 0.0 and root > 0.0:
        left: float = _weight_robustly(setting[WIDTH], m + 1, m, residuals, jacobian, root)
        return left
    return 0.0


@njit(**OPTIONS)
def _write_step_rows(
    x: Real, targets: Real, setting: Real, multipliers: Real, nodes: Integers, transmitting: Integers, pins: Integers,
    constants: Real, curve: Real, begin: float, per: float, by_last: Real, carried: bool, inputs: Real, turns: Real,
    number: int, values: Real, gradients: Real, m: int, residuals: Real, jacobian: Real,
) -> tuple[int, float]:  # fmt: skip
    """Write the margins of all steps of the input, from ``number`` on, and the rows of the way back, from m on.

    Returns the number of rows and the part of the robust sum that they leave out; the number is −1 if the linkage does
    not close at a step or turns over.
    """
    n, steps, full, back = len(nodes), len(curve), setting[FULL_TURN] > 0.0, setting[BACK] > 0.0
    places, cosines, slopes = np.empty((n, 2)), np.zeros(n), np.zeros((n, 2, 1 + 2 * n))
    arcs, by_ends = np.empty(steps), np.zeros(max(2, len(by_last)))
    step_count, hand, left_out = count_step_margins(transmitting, setting), 0.0, 0.0
    if back:
        if setting[WIDTH] <= 0.0 and not _trace_steps(
            nodes, x, constants, begin, per, int(setting[POINT_NODE]), places, cosines, curve
        ):
            return -1, 0.0
        measure_arcs(curve, full, arcs)
    for k in range(steps):
        theta = inputs[k] if carried else begin + per * k
        if not close_linkage(nodes, x, constants, theta, places, cosines):
            return -1, 0.0
        if carried:
            _carry_ground(targets[k], places)
        sine = write_step_values(transmitting, pins, places, cosines, setting, number, values)
        # A sign change between two steps means that a triad has passed a toggle, where the input turns back.
        if hand * sine < 0.0:
            return -1, 0.0
        hand = sine
        loaded = is_loaded(number, step_count, multipliers, values)
        if loaded or back:
            if carried:
                slopes[:] = 0.0
            differentiate_nodes(nodes, x, constants, theta, places, slopes)
            if carried:
                _carry_slopes(targets[k], turns[k], slopes)
            if not full and setting[WIDTH] > 0.0:
                by_ends[1] = k / max(steps - 1.0, 1.0)
                by_ends[0] = 1.0 - by_ends[1]
            elif not full:
                # The steps go from the lower end to the upper one, of which one is 0 and the other the last input.
                share = k / max(steps - 1.0, 1.0)
                for c in range(len(by_last)):
                    by_ends[c] = (share if by_last[c] > 0.0 else 1.0 - share) * by_last[c]
        if loaded:
            write_step_gradients(
                nodes, x, constants, transmitting, pins, places, slopes, by_ends, cosines, setting, number, values,
                gradients,
            )  # fmt: skip
        if back:
            left_out += _write_back_row(places, slopes, by_ends, targets, setting, arcs[k], m, residuals, jacobian)
            m += 1
        number += step_count
    return m, left_out


@njit(ROWS, **OPTIONS)
def compute_linkage_rows(
    x: Real, targets: Real, setting: Real, multipliers: Real, state: Real, residuals: Real, jacobian: Real
) -> int:
    """Compute rows for the descent of :mod:`synthesis.numerics.levenberg`; −1 if the linkage does not close.

    Parameters
    ----------
    x : float, shape (2n,), (2n + 2,) or (2n + slots − 1,)
        Coordinates of the nodes; then the ends of the range of inputs (robust form without a full turn), or the
        logarithms of the steps of ordered inputs.
    targets : float, shape (targets, 10)
        See the module's docstring.
    setting : float
        From :func:`synthesis.fit.linkage.setting.pack_topology`.
    multipliers, residuals, jacobian
        See :data:`synthesis.numerics.levenberg.ROWS`.
    state : float, shape (slots + margins,)
        Inputs of the slots, radians from the reference position, then the margins.
    """
    if not np.abs(x).max() < MAX_COORDINATE:
        return -1
    nodes, transmitting, pairs, pivots, pins, arms = unpack_table(setting)
    n, unknowns, steps = len(nodes), len(x), int(setting[STEPS])
    full, robust, limits = setting[FULL_TURN] > 0.0, setting[WIDTH] > 0.0, count_margins(setting)
    slots = len(state) - limits
    constants, curve = np.empty((n, CONSTANT_COUNT)), np.empty((steps, 2))
    compute_constants(nodes, x, constants)
    # A full turn has no ends: its last step would repeat the first.
    low, high, begin, per = -np.inf, np.inf, 0.0, 2.0 * math.pi / max(steps, 1)
    if not full and robust:
        low, high = x[unknowns - 2], x[unknowns - 1]
        if not low < high:
            return -1
        begin, per = low, (high - low) / max(steps - 1, 1)
    places, cosines = np.empty((n, 2)), np.zeros(n)
    if robust and not _trace_steps(
        nodes, x, constants, begin, per, int(setting[POINT_NODE]), places, cosines, curve
    ):  # fmt: skip
        return -1
    first_slopes = np.empty((n, 2, unknowns))
    # The steps of a linkage that carries its ground are its targets.
    carried = targets[0, KIND] == ARM
    turns = np.empty((steps if carried else 0, unknowns))
    by_last = np.empty(slots - 1 if setting[ORDER] != 0.0 else 0)
    _write_ordered_inputs(x[2 * n :], state[:slots], by_last)
    m, left_out = _write_target_rows(
        x, targets, setting, nodes, constants, curve, begin, per, low, high, state[:slots], by_last, turns, places,
        first_slopes, residuals, jacobian,
    )  # fmt: skip
    if m < 0:
        return -1
    if not full and not robust:
        # The range follows the targets. Its ends are constants of the descent, except for ordered inputs.
        begin, high = min(0.0, state[:slots].min()), max(0.0, state[:slots].max())
        per = (high - begin) / max(steps - 1, 1)
    values, gradients = state[slots:], np.empty((limits, unknowns))
    values[:] = np.inf
    number = write_static_margins(
        x, pairs, pivots, pins, arms, places, first_slopes, setting, multipliers, values, gradients
    )  # fmt: skip
    number = write_order_margin(state[slots - 1], by_last, setting, number, values, gradients)
    m, more = _write_step_rows(
        x, targets, setting, multipliers, nodes, transmitting, pins, constants, curve, begin, per, by_last, carried,
        state[:slots], turns, number, values, gradients, m, residuals, jacobian,
    )  # fmt: skip
    if m < 0:
        return -1
    if robust:
        residuals[m] = math.sqrt(left_out + more)
        jacobian[m] = 0.0
        m += 1
    return append_limit_rows(values, gradients, EQUATION_COUNT, multipliers, residuals, jacobian, m)
