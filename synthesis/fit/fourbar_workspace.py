"""Workspace margins of a fourbar in its chart, and their rows in a fit.

Joints at equal steps of the crank from one angle to another go to :mod:`synthesis.fit.workspace_margins`. With f = O4 →
B, which keeps its length, the coupler turns by dθ₃ = −Re(f̄ df)/Re(f̄ i b e^{iθ₃}) for any other change of f (as in
:mod:`synthesis.fit.coupler_curve`), and all joints follow:

    A = O2 + a e^{iθ},   B = A + b e^{iθ₃},   P = A + p e^{iθ₃},   O4 = O2 + d e^{iγ}.

The crank's angles from the ground line depend on the unknowns, too; the derivatives of those between the ends are
interpolated.

A linkage that carries a body has one more unknown, the direction ψ of A → B on the body as drawn: the body is rotated
by θ₃ − ψ.
"""

from __future__ import annotations

import math

import numpy as np
from numba import types

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from synthesis.fit.chart import LENGTHS, OPTIONS, POINT
from synthesis.fit.coupler_curve import close_two_bars, compute_unit_vector, find_crank_range
from synthesis.fit.fourbar_forces import compute_force_margins, compute_force_slopes
from synthesis.fit.workspace import (
    CYCLE_INDEX,
    FORCE_COUNT_INDEX,
    FORCES_START_INDEX,
    GROUP_COUNT_INDEX,
    HAS_BOX_INDEX,
    O2,
    O4,
    PLACES,
    TURN,
    A,
    B,
    P,
)
from synthesis.fit.workspace_margins import (
    ROW_SIZE,
    add_derivative,
    compute_margins,
    compute_parabola_weights,
    count_margins,
    count_steps,
)
from synthesis.numerics.augmented_lagrangian import compute_load

_VECTOR, _MATRIX = types.float64[::1], types.float64[:, ::1]

LINKAGE = 9
"""Number of unknowns of a fourbar's chart; the unknowns of a fit after these change only the crank's angles."""

NO_BODY = -1
"""Substitute for the index of ψ if the linkage carries no body."""

TOGGLE_DISTANCE = 1e-3
"""Distance of a cycle's ends from a toggle, radians: at the toggle itself joints have no derivative."""


@njit(**OPTIONS)
def find_crank_interval(lengths: Real, ends: Real, whole: bool, room: Real) -> tuple[float, float, bool, bool]:
    """Return the crank angles between which a workspace applies, whether they are a full turn, and whether they move.

    The angles are from the ground line; they move if they depend on the ends of the used range. ``whole`` means that
    the crank rotates fully. With a workspace over the cycle, the interval is as wide as the crank can turn.
    """
    if not whole and room[CYCLE_INDEX] == 0.0:
        return ends[0], ends[1], False, True
    low, high = find_crank_range(lengths[0], lengths[1], lengths[2], lengths[3])
    if whole or (low == 0.0 and high == math.pi):
        return ends[0], ends[0] + 2.0 * math.pi, True, True
    # Otherwise the interval is the range between toggles that contains the first end. The derivatives neglect that the
    # toggles move with the lengths. Reduce the angle to −π..π, because the ranges are given around 0 and π.
    at = ends[0] - 2.0 * math.pi * math.floor((ends[0] + math.pi) / (2.0 * math.pi))
    if low == 0.0:
        return TOGGLE_DISTANCE - high, high - TOGGLE_DISTANCE, False, False
    if high == math.pi:
        return low + TOGGLE_DISTANCE, 2.0 * math.pi - low - TOGGLE_DISTANCE, False, False
    if at > 0.0:
        return low + TOGGLE_DISTANCE, high - TOGGLE_DISTANCE, False, False
    return TOGGLE_DISTANCE - high, -low - TOGGLE_DISTANCE, False, False


@njit(**OPTIONS)
def _locate_joints(x: Real, lengths: Real, sign: float, angle: float, body: int, places: Complex) -> bool:
    """Write the joints with the crank at an angle from the ground line; return False if the linkage does not close."""
    ground = compute_unit_vector(x[2])
    pin = lengths[1] * compute_unit_vector(x[2] + angle)
    closes, along = close_two_bars(lengths[0] * ground - pin, lengths[2], lengths[3], sign)
    places[O2] = complex(x[0], x[1])
    places[A] = places[O2] + pin
    places[B] = places[A] + lengths[2] * along
    places[O4] = places[O2] + lengths[0] * ground
    places[P] = places[A] + complex(x[POINT], x[POINT + 1]) * along
    if body >= 0:
        # The body's rotation is the coupler's direction minus its direction on the drawn body.
        places[TURN] = along * compute_unit_vector(-x[body])
    return bool(closes)


@njit(**OPTIONS)
def trace_joints(
    x: Real,
    lengths: Real,
    sign: float,
    begin: float,
    end: float,
    ring: bool,
    first: float,
    body: int,
    places: Complex,
    home: Complex,
) -> bool:
    """Write the joints over a motion, shape (n, 6), and at the first point, shape (6,).

    n is 0 if no motion is required. Return whether the linkage closes everywhere.

    Parameters
    ----------
    x, lengths : float64, shapes (9 or more,) and (4,)
        Unknowns of the chart, and lengths.
    sign : float
        Assembly.
    begin, end, first : float
        Crank angles from the ground line: of the motion, and of the first position.
    ring : bool
        Whether the end coincides with the beginning.
    body : int
        Index of ψ among the unknowns, or :data:`NO_BODY`.
    places, home : complex
        Output: the joints.
    """
    n = len(places)
    parts = n if ring else n - 1
    for k in range(n):
        if not _locate_joints(x, lengths, sign, begin + (end - begin) * k / parts, body, places[k]):
            return False
    return bool(_locate_joints(x, lengths, sign, first, body, home))


@njit(**OPTIONS)
def compute_workspace_margins(
    x: Real, lengths: Real, sign: float, ends: Real, whole: bool, body: int, room: Real, values: Real, rows: Real
) -> bool:
    """Write the margins of a fourbar's workspace and their rows; return False if its motion does not close.

    ``ends``, shape (2,), are crank angles from the ground line at the first and the last point; ``body`` is as for
    :func:`trace_joints`.
    """
    begin, end, ring, _ = find_crank_interval(lengths, ends, whole, room)
    # Pivot zones concern the first position alone: without box and obstacles no motion is traced.
    moving = room[HAS_BOX_INDEX] > 0.0 or room[GROUP_COUNT_INDEX] > 0.0
    places, home = (
        np.zeros((count_steps(ring) if moving else 0, PLACES), np.complex128),
        np.zeros(PLACES, np.complex128),
    )
    if not trace_joints(x, lengths, sign, begin, end, ring, ends[0], body, places, home):
        return False
    compute_margins(room, places, ring, home, values, rows)
    forced = int(room[FORCE_COUNT_INDEX])
    if forced == 0:
        return True
    return bool(
        compute_force_margins(
            x, lengths, sign, ends, room[int(room[FORCES_START_INDEX]) :], values[len(values) - forced :]
        )
    )


@njit(
    types.int64(
        _VECTOR, _VECTOR, _MATRIX, types.float64, _VECTOR, _MATRIX, types.boolean, types.int64, _VECTOR, _VECTOR,
        _VECTOR, _VECTOR, _MATRIX, types.int64
    ),
    **OPTIONS,
)  # fmt: skip
def append_workspace_rows(
    x: Real, lengths: Real, slopes: Real, sign: float, ends: Real, turns: Real, whole: bool, body: int, room: Real,
    multipliers: Real, values: Real, residuals: Real, jacobian: Real, m: int,
) -> int:  # fmt: skip
    """Append the rows of those workspace margins that bear a load (:mod:`synthesis.numerics.augmented_lagrangian`).

    Parameters
    ----------
    x, lengths, slopes : float64
        Unknowns, lengths and their derivatives, of the chart. In ``x`` other unknowns of the fit may follow the nine.
    sign : float
        Assembly.
    ends, turns : float64, shapes (2,) and (2, unknowns)
        Crank angles from the ground line at the first and the last point, and their derivatives.
    whole : bool
        Whether the crank rotates fully.
    body : int
        As for :func:`trace_joints`.
    room : float64, shape (r,)
        Packed workspace, see :func:`synthesis.fit.workspace.pack_workspace`.
    multipliers : float64, shape (margins + 1 or more,)
        Multipliers, beginning with those of the margins; the last entry is the penalty weight.
    values : float64, shape (margins,)
        Output: the margins.
    residuals, jacobian, m
        As for :func:`synthesis.numerics.augmented_lagrangian.append_limit_rows`.

    Returns
    -------
    int
        The new number of rows; −1 if the motion does not close.
    """
    count, unknowns = count_margins(room), len(x)
    rows = np.empty((count, ROW_SIZE))
    if not compute_workspace_margins(x, lengths, sign, ends, whole, body, room, values, rows):
        return -1
    begin, end, ring, moves = find_crank_interval(lengths, ends, whole, room)
    n = count_steps(ring)
    parts = n if ring else n - 1
    weight, forced = multipliers[len(multipliers) - 1], int(room[FORCE_COUNT_INDEX])
    root, forces = math.sqrt(weight), room[int(room[FORCES_START_INDEX]) :]
    # Derivatives of a step are computed only if a loaded margin refers to it; index n is the first position.
    known = np.zeros(n + 1, np.bool_)
    by = np.empty((n + 1, PLACES, unknowns), np.complex128)
    weighed, by_forces = False, np.empty((forced, unknowns))
    for k in range(count):
        load = compute_load(values[k], multipliers[k], weight, False)
        # Inactive constraints contribute neither residual nor row.
        if load <= 0.0:
            continue
        residuals[m] = root * load
        if k >= count - forced:
            # Force derivatives cost a dozen evaluations, so compute them once and only if a limit bears a load.
            if not weighed:
                compute_force_slopes(x, lengths, slopes, sign, ends, turns, forces, by_forces)
                weighed = True
            # Minus: the residual grows while the margin falls.
            jacobian[m] = -root * by_forces[k - count + forced]
            m += 1
            continue
        row, out = rows[k], jacobian[m]
        out[:] = 0.0
        at, shares = (n, n, n), (1.0, 0.0, 0.0)
        # Zone margins (step −1) refer to the first position alone; the others to three steps of a parabola.
        if row[0] >= 0.0:
            at, shares = compute_parabola_weights(int(row[0]), row[1], ring, n)
        for s in range(3):
            step = at[s]
            if shares[s] == 0.0:
                continue
            if not known[step]:
                known[step] = True
                share = 0.0 if step == n else step / parts
                angle = ends[0] if step == n else begin + (end - begin) * share
                _compute_joint_slopes(
                    x, lengths, slopes, sign, angle, turns, share, ring, moves or step == n, body, by[step]
                )
            add_derivative(row, -root * shares[s], by[step], out)
        m += 1
    return m


@njit(**OPTIONS)
def _compute_change(
    number: int, d: float, a: float, ground: complex, crank: complex, along: complex
) -> tuple[complex, complex, complex]:
    """Return the changes of A, of the bar A → B and of the ground vector by one of γ, d, a, b, c and θ."""
    pin, bar, base = 0j, 0j, 0j
    if number == 0:
        # The crank keeps its angle to the ground line, so everything turns about O2.
        pin, base = 1j * a * crank, 1j * d * ground
    elif number == 1:
        base = ground
    elif number == 2:
        pin = crank
    elif number == 3:
        bar = along
    elif number == 5:
        pin = 1j * a * crank
    return pin, bar, base


@njit(**OPTIONS)
def _compute_joint_slopes(
    x: Real,
    lengths: Real,
    slopes: Real,
    sign: float,
    angle: float,
    turns: Real,
    share: float,
    ring: bool,
    moves: bool,
    body: int,
    by: Complex,
) -> None:
    """Write the derivatives of the joints by the unknowns, shape (6, unknowns).

    They apply at a share of the motion, with the crank at ``angle`` from the ground line; the angle depends on the ends
    if it ``moves``.
    """
    unknowns = len(x)
    ground, crank = compute_unit_vector(x[2]), compute_unit_vector(x[2] + angle)
    d, a, b, c = lengths[0], lengths[1], lengths[2], lengths[3]
    _, along = close_two_bars(d * ground - a * crank, b, c, sign)
    f = a * crank + b * along - d * ground
    # Rate of |f|²/2 per rotation of the coupler; not 0 away from toggles.
    per = (f.conjugate() * 1j * b * along).real
    p = complex(x[POINT], x[POINT + 1])
    spin = 1j * along * compute_unit_vector(-x[body]) if body >= 0 else 0j
    by[:] = 0.0
    # All joints move with O2; the rotation of the body does not.
    for j in range(5):
        by[j, 0], by[j, 1] = 1.0, 1j
    # Changes of A, of the bar A → B, of the ground vector and of the coupler's turn by γ, d, a, b, c and θ.
    for number in range(6):
        pin, bar, base = _compute_change(number, d, a, ground, crank, along)
        # The output's length c enters through |f| alone; every other change through f.
        turn = c / per if number == 4 else -(f.conjugate() * (pin + bar - base)).real / per
        at_b, at_p = pin + bar + 1j * b * along * turn, pin + 1j * p * along * turn
        if number == 0:
            by[A, 2], by[B, 2], by[P, 2], by[O4, 2] = pin, at_b, at_p, base
            by[TURN, 2] = spin * turn
        elif number < 5:
            for i in range(4):
                much = slopes[number - 1, i]
                by[A, LENGTHS + i] += pin * much
                by[B, LENGTHS + i] += at_b * much
                by[P, LENGTHS + i] += at_p * much
                by[O4, LENGTHS + i] += base * much
                by[TURN, LENGTHS + i] += spin * turn * much
        elif moves:
            for i in range(unknowns):
                # In a full turn both ends move alike; otherwise interpolate between the ends.
                much = turns[0, i] if ring else (1.0 - share) * turns[0, i] + share * turns[1, i]
                by[A, i] += pin * much
                by[B, i] += at_b * much
                by[P, i] += at_p * much
                by[TURN, i] += spin * turn * much
    by[P, POINT] += along
    by[P, POINT + 1] += 1j * along
    # ψ is subtracted from the coupler's direction.
    if body >= 0:
        by[TURN, body] -= spin
