"""Compiled kernels for sixbar function generators: output angle, transmission angles, and their derivatives.

A sixbar has a row of :data:`ROW_SIZE` numbers, of which the first seven are those of a fourbar O2 A B O4 with ground 1,
as in :mod:`synthesis.kinds.function.fourbar.structural_error`: a, b, c, φ₀, ψ₀, k and l. The input angle is φ₀ + k u,
and the target of the output angle ψ₀ + l v. The other numbers depend on the type:

* Watt II: a₂, b₂, c₂ and α. The rocker O4 B C drives a second fourbar, O4 C D O6 with ground 1 in its own frame; its
  crank angle is the rocker's angle + α. The size and direction of the second fourbar relative to the first are free.
* Stephenson III: x, y of C from A, along A → B and across; x, y of O6; lengths of the links C D and O6 D.
* Stephenson II: x, y of C from O2 with A on +x; lengths of B D and C D; x, y of E from B, along B → D and across. b is
  the length of A B, and c that of the output O4 E. The angle τ of A B relative to the input is solved for.

All types except Stephenson II are closed by dyads. For a pin Q and a pivot O, with d = |Q D|, e = |O D|, r = |Q O|,
D − O = e e^{iψ} and v the unit vector from Q to D,

    cos μ = (d² + e² − r²) / 2de,        δψ = (δd + (δQ − δO − δe e^{iψ}) · v) / (i e e^{iψ} · v),

where the divisor is e times the sine of the transmission angle μ. In a Stephenson II, τ determines E in the frame of
the input, and |E − O4| = c determines τ; its transmission angle is the minimum at the three legs of link 4
(:mod:`synthesis.fit.triad_slant`).

Assemblies are numbered: bit 0 belongs to the first dyad, bit 1 to the second; it is set if D is to the left of the line
from Q to O. The only dyad of Stephenson II, C D B, uses bit 0.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from synthesis.fit.triad_slant import compute_leg_slant, find_min_slant

WATT_2, STEPHENSON_3, STEPHENSON_2 = 0, 1, 2
"""Type numbers."""

ROW_SIZE = 14
"""Length of a row; unused numbers of a type are 0, and the last is Stephenson II's τ at the first input."""

A, B, C, START, ZERO, K, L = range(7)
"""Indices of the fourbar's numbers."""

IS_LOGARITHMIC = np.array(
    [
        [1, 1, 1, 0, 0, 1, 1, 1, 1, 1, 0, 0, 0, 0],
        [1, 1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0],
        [1, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 0],
    ],
    np.bool_,
)
"""Mask of the numbers of each type whose steps are of logarithms."""

IS_USED = np.array(
    [
        [1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0],
        [1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0],
        [1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0],
    ],
    np.bool_,
)
"""Mask of the numbers that each type uses."""

MAX_NEWTON_STEPS, STEP_TOLERANCE = 12, 1e-13
"""Newton's method for τ: maximum number of steps, and convergence tolerance of the last step, radians."""

LOOSE_STEP_TOLERANCE = 1e-9
"""Last step, radians, up to which τ is accepted if rounding prevents a smaller one."""

DIFFERENCE_STEP = 1e-6
"""Finite-difference step for the derivatives of Stephenson II's transmission angle."""

MAX_TAU_STEP = 0.5
"""Maximum change of τ in one Newton step, radians."""


@njit(cache=True, nogil=True, error_model="numpy")
def _wrap_angle(angle: float) -> float:
    return angle - 2.0 * math.pi * round(angle / (2.0 * math.pi))


@njit(cache=True, nogil=True, error_model="numpy")
def _close_dyad(
    q: complex,
    by_q: Complex,
    o: complex,
    by_o: Complex,
    lengths: tuple[float, float],
    columns: tuple[int, int],
    left: bool,
    by_psi: Real,
    by_cosine: Real,
) -> tuple[float, float]:
    """Close a dyad: return ψ of the link at the pivot and cos μ, and write their derivatives; ψ is NaN if it fails.

    ``columns``: columns of the logarithms of both lengths.
    """  # fmt: skip
    d, e = lengths
    across = q - o
    r2 = across.real * across.real + across.imag * across.imag
    cosine = (d * d + e * e - r2) / (2.0 * d * e)
    r = math.sqrt(r2)
    # Foot of the perpendicular from D on the line from the pivot to the pin.
    along = (e * e + r2 - d * d) / (2.0 * r)
    height2 = e * e - along * along
    # The dyad does not close; also false for NaN.
    if not height2 > 0.0:
        return math.nan, cosine
    height = math.sqrt(height2)
    unit = across / r
    # Left of Q → O means right of O → Q, hence the sign.
    arm = unit * complex(along, -height if left else height)
    v = (o + arm - q) / d
    turned = 1j * arm
    # e times the sine of the transmission angle: 0 at a toggle.
    divisor = turned.real * v.real + turned.imag * v.imag
    for n in range(by_psi.size):
        moved = by_q[n] - by_o[n]
        by_psi[n] = (moved.real * v.real + moved.imag * v.imag) / divisor
        by_cosine[n] = -(moved.real * across.real + moved.imag * across.imag) / (d * e)
    # Lengths enter as logarithms, so their derivatives are multiplied by the lengths themselves.
    one, other = columns
    by_psi[one] += d / divisor
    by_psi[other] -= (arm.real * v.real + arm.imag * v.imag) / divisor
    by_cosine[one] += d / e - cosine
    by_cosine[other] += e / d - cosine
    return math.atan2(arm.imag, arm.real), cosine


@njit(cache=True, nogil=True, error_model="numpy")
def _compute_relative_point(
    at: Real, left: bool, tau: float, by: Complex
) -> tuple[complex, complex, complex, complex, bool]:
    """Compute B, D and E of a Stephenson II from O2 in the input's frame (A on +x), E's derivative by τ, and success.

    ``by`` (ROW_SIZE,) receives the derivatives of E by the numbers, the last by τ.
    """
    a, b = at[A], at[B]
    c = complex(at[7], at[8])
    bd, cd = at[9], at[10]
    link = b * complex(math.cos(tau), math.sin(tau))
    pin = a + link
    by_pin, by_c = np.zeros(ROW_SIZE, np.complex128), np.zeros(ROW_SIZE, np.complex128)
    by_pin[A], by_pin[B], by_pin[ROW_SIZE - 1] = a, link, 1j * link
    by_c[7], by_c[8] = 1.0, 1j
    turned, unused = np.zeros(ROW_SIZE), np.zeros(ROW_SIZE)
    # Close the dyad C–D–B, whose link B D turns about B.
    angle, _ = _close_dyad(c, by_c, pin, by_pin, (cd, bd), (10, 9), left, turned, unused)
    if not math.isfinite(angle):
        return 0j, 0j, 0j, 0j, False
    unit = complex(math.cos(angle), math.sin(angle))
    arm = complex(at[11], at[12]) * unit
    for n in range(ROW_SIZE):
        by[n] = by_pin[n] + 1j * arm * turned[n]
    by[11] += unit
    by[12] += 1j * unit
    return pin, pin + bd * unit, pin + arm, by[ROW_SIZE - 1], True


@njit(cache=True, nogil=True, error_model="numpy")
def _solve_tau(at: Real, left: bool, turn: complex, tau: float, by: Complex) -> float:
    """Solve for the angle τ with which a Stephenson II closes, by Newton's method from a nearby one; NaN on failure."""
    step = math.inf
    for _ in range(MAX_NEWTON_STEPS):
        _, _, point, moves, found = _compute_relative_point(at, left, tau, by)
        # The output's pivot O4 is at 1, in the frame of the ground.
        arm, rate = turn * point - 1.0, turn * moves
        slope = 2.0 * (arm.real * rate.real + arm.imag * rate.imag)
        step = (arm.real * arm.real + arm.imag * arm.imag - at[C] * at[C]) / slope
        if not found or not math.isfinite(step):
            return math.nan
        # A long Newton step could end in another configuration.
        step = min(max(step, -MAX_TAU_STEP), MAX_TAU_STEP)
        tau -= step
        if abs(step) < STEP_TOLERANCE:
            break
    # Near a toggle rounding prevents the full accuracy; such a τ is still usable.
    return tau if abs(step) < LOOSE_STEP_TOLERANCE else math.nan


@njit(cache=True, nogil=True, error_model="numpy")
def _close_triad(
    at: Real, left: bool, phi: float, tau: float, felt: float, by_psi: Real, by_cosine: Real
) -> tuple[float, float, float]:
    """Close a Stephenson II at an input: return ψ, τ, and the cosine of the minimum transmission angle; NaN on failure.

    The derivatives of the cosine are not computed if it is below ``felt``.
    """
    by, by_tau = np.zeros(ROW_SIZE, np.complex128), np.zeros(ROW_SIZE)
    turn = complex(math.cos(phi), math.sin(phi))
    tau = _solve_tau(at, left, turn, tau, by)
    if not math.isfinite(tau):
        return math.nan, tau, 0.0
    b, d, point, moves, _ = _compute_relative_point(at, left, tau, by)
    arm, rate = turn * point - 1.0, turn * moves
    along = arm.real * rate.real + arm.imag * rate.imag
    square = at[C] * at[C]
    for n in range(ROW_SIZE - 1):
        moved = turn * by[n]
        # Turning the input moves the whole triad about O2.
        if n == START:
            moved += 1j * turn * point
        # A step of ln c changes the required |E − O4|² instead of E.
        lack = arm.real * moved.real + arm.imag * moved.imag - (square if n == C else 0.0)
        by_tau[n] = -lack / along
        moved += rate * by_tau[n]
        by_psi[n] = (arm.real * moved.imag - arm.imag * moved.real) / square
    cosine, _, leg = find_min_slant(point, turn.conjugate(), complex(at[A], 0.0), b, complex(at[7], at[8]), d)
    # Derivatives of inactive cosines are not needed, and they are expensive here.
    if abs(cosine) < felt:
        return math.atan2(arm.imag, arm.real), tau, cosine
    # Finite differences along the constraint surface: τ moves with each number.
    other = at.copy()
    for n in range(ROW_SIZE - 1):
        turned = turn
        if n == START:
            turned *= complex(math.cos(DIFFERENCE_STEP), math.sin(DIFFERENCE_STEP))
        other[n] = at[n] * (1.0 + DIFFERENCE_STEP) if IS_LOGARITHMIC[STEPHENSON_2, n] else at[n] + DIFFERENCE_STEP
        b, d, point, _, found = _compute_relative_point(other, left, tau + DIFFERENCE_STEP * by_tau[n], by)
        o2, o4 = complex(other[A], 0.0), complex(other[7], other[8])
        other[n] = at[n]
        # At the same leg as the value, so that the difference is smooth.
        there, _ = compute_leg_slant(leg, point, turned.conjugate(), o2, b, o4, d)
        by_cosine[n] = (there - cosine) / DIFFERENCE_STEP if found else 0.0
    return math.atan2(arm.imag, arm.real), tau, cosine


@njit(cache=True, nogil=True, error_model="numpy")
def _compute_second_pin(
    kind: int, at: Real, angle: float, pin: complex, q: Complex, o: Complex, turned: Real
) -> tuple[complex, complex]:
    """Compute pin and pivot of the second dyad, from the first's output angle and pin A.

    On input ``q`` and ``o`` are the derivatives of A and O4, on output those of the second dyad's pin and pivot;
    ``turned`` are those of the angle.
    """
    if kind == WATT_2:
        crank = at[7] * complex(math.cos(angle + at[10]), math.sin(angle + at[10]))
        for n in range(ROW_SIZE):
            q[n] = 1j * crank * turned[n]
        q[7] += crank
        q[10] += 1j * crank
        return crank, complex(1.0, 0.0)
    arm = at[C] * complex(math.cos(angle), math.sin(angle))
    unit = (1.0 + arm - pin) / at[B]
    carried = complex(at[7], at[8])
    for n in range(ROW_SIZE):
        moved = 1j * arm * turned[n] - q[n]
        if n == C:
            moved += arm
        q[n] += carried * (moved / at[B] - (unit if n == B else 0.0))
    q[7] += unit
    q[8] += 1j * unit
    o[9], o[10] = 1.0, 1j
    return pin + carried * unit, complex(at[9], at[10])


@njit(cache=True, nogil=True, error_model="numpy")
def _close_dyads(
    kind: int,
    at: Real,
    assembly: int,
    theta: float,
    turned_by_k: float,
    q: Complex,
    o: Complex,
    by_psi: Real,
    cosines: Real,
    by_cosine: Real,
) -> float:
    """Close a sixbar with two dyads: return ψ and write the outputs of :func:`follow` for one input; NaN on failure."""
    first, second = assembly & 1 == 1, assembly & 2 == 2
    pin = at[A] * complex(math.cos(theta), math.sin(theta))
    q[:] = 0.0
    o[:] = 0.0
    # Derivatives of A by its own numbers; the chain continues through both dyads.
    q[A], q[START], q[K] = pin, 1j * pin, 1j * pin * turned_by_k
    turned = by_psi.copy()
    angle, cosines[0] = _close_dyad(pin, q, complex(1.0, 0.0), o, (at[B], at[C]), (B, C), first, turned, by_cosine[0])
    if not math.isfinite(angle):
        return math.nan
    pin, pivot = _compute_second_pin(kind, at, angle, pin, q, o, turned)
    d, e = (8, 9) if kind == WATT_2 else (11, 12)
    place, cosines[1] = _close_dyad(pin, q, pivot, o, (at[d], at[e]), (d, e), second, by_psi, by_cosine[1])
    return place


@njit(cache=True, nogil=True, error_model="numpy")
def follow(
    kind: int,
    assembly: int,
    at: Real,
    inputs: Real,
    outputs: Real,
    felt: float,
    errors: Real,
    slopes: Real,
    cosines: Real,
    by_cosine: Real,
) -> float:
    """Follow a sixbar through inputs: compute structural errors, cosines of transmission angles, and derivatives.

    Parameters
    ----------
    kind, assembly : int
    at : float, shape (ROW_SIZE,)
    inputs, outputs : float, shape (m,)
        u and v, monotonic.
    felt : float
        Cosines of a Stephenson II below this have no derivatives.
    errors : float, shape (m,)
        Output: radians, wrapped; NaN from the first input on at which the sixbar cannot be assembled.
    slopes : float, shape (m, ROW_SIZE)
        Output: derivatives of the errors.
    cosines, by_cosine : float, shapes (m, 2) and (m, 2, ROW_SIZE)
        Output: values of both dyads; for Stephenson II the first are 0. Other entries are unchanged.

    Returns
    -------
    float
        Stephenson II's τ at the first input; NaN if the sixbar is not assembled at all inputs.
    """
    q, o = np.zeros(ROW_SIZE, np.complex128), np.zeros(ROW_SIZE, np.complex128)
    tau = begun = float(at[ROW_SIZE - 1])
    errors[:] = math.nan
    for j in range(inputs.size):
        # K is a factor of the input, so its step turns the crank in proportion.
        turned_by_k = at[K] * inputs[j]
        theta = at[START] + turned_by_k
        row = slopes[j]
        if kind == STEPHENSON_2:
            row[:] = 0.0
            cosines[j, 0] = 0.0
            place, tau, cosines[j, 1] = _close_triad(at, assembly & 1 == 1, theta, tau, felt, row, by_cosine[j, 1])
            row[K] = row[START] * turned_by_k
            by_cosine[j, 1, K] = by_cosine[j, 1, START] * turned_by_k
            # The next call starts from the first input again.
            if j == 0:
                begun = tau
        else:
            place = _close_dyads(kind, at, assembly, theta, turned_by_k, q, o, row, cosines[j], by_cosine[j])
        if not math.isfinite(place):
            return math.nan
        # Errors are angles: compare them modulo a full turn.
        errors[j] = _wrap_angle(place - at[ZERO] - at[L] * outputs[j])
        row[ZERO] -= 1.0
        row[L] -= at[L] * outputs[j]
    return begun
