"""Compiled kinematic inversion of Stephenson II sixbars: motion relative to the input link, transformed to the ground.

The four links between input and ground of a Stephenson II form a triad, which cannot be closed by two circles. Relative
to its input link it is a Stephenson III: links 3, 4 and 5 form a fourbar on the input link, and the ground is the
second link of a dyad on its coupler. So it is driven by link 3, which turns relative to the input, and closed by dyads;
then everything is rotated so that the ground is at rest. The kernel's joints are

    O₂ A B O₄    pin of link 3 on the input, and on link 4; pin of link 5 on link 4, and on the input
    Q₁ J Q₂      pin of the output on link 4, and on the ground; pin of the input on the ground

The transmission angle follows from the directions in which the three legs push link 4
(:mod:`synthesis.fit.triad_slant`).
"""

from __future__ import annotations

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from synthesis.fit.triad_slant import differentiate_leg_slant, find_min_slant
from synthesis.kinds.motion.sixbar.dyad_assembly import O2, O4, Q1, Q2, A, B, J

FLIPPED_COSINE = 2.0
"""Cosine returned if the sine's sign differs from that in the first position: the linkage has passed a toggle."""


@njit(cache=True, nogil=True, error_model="numpy")
def transform_to_ground(z: Complex, start: complex, at: Complex, turns: Complex) -> float:
    """Transform a configuration relative to the input link to the ground frame.

    Parameters
    ----------
    z : complex, shape (7,)
        Joints in the first position.
    start : complex
        P there.
    at : complex, shape (6,)
        Input: A, B, Q₁, Q₂, J and any value, relative to the input link. Output: A, B, Q₁, O₂, O₄ and P in the ground
        frame.
    turns : complex, shape (4,)
        Input: the second is the coupler's rotation relative to the input link. Output: the first is the input's
        rotation, the last the body's.

    Returns
    -------
    float
        The cosine of the minimum transmission angle; above 1 if the linkage has passed a toggle.
    """
    _, first, _ = find_min_slant(z[Q1], z[J], z[O2], z[A], z[O4], z[B])
    cosine, sine, _ = find_min_slant(at[2], at[4], z[O2], at[0], z[O4], at[1])
    # Rotation that turns the line Q₂–J back to its first direction; the factor removes rounding of its length.
    back = ((z[J] - z[Q2]) / (at[4] - at[3])) * (abs(at[4] - at[3]) / abs(z[J] - z[Q2]))
    p = at[0] + turns[1] * (start - z[A])
    at[0], at[1], at[2] = z[Q2] + back * (at[0] - z[Q2]), z[Q2] + back * (at[1] - z[Q2]), z[Q2] + back * (at[2] - z[Q2])
    at[3], at[4], at[5] = z[Q2] + back * (z[O2] - z[Q2]), z[Q2] + back * (z[O4] - z[Q2]), z[Q2] + back * (p - z[Q2])
    turns[0], turns[3] = back, back * turns[1]
    # The sign changes only at a toggle.
    return cosine if first * sine > 0.0 else FLIPPED_COSINE


@njit(cache=True, nogil=True, error_model="numpy")
def transform_rates(
    z: Complex,
    units: Complex,
    start: complex,
    at: Complex,
    turns: Complex,
    through: Real,
    moving: Complex,
    turning: Real,
    bending: Real,
) -> None:
    """Transform rates to the ground frame, and compute the rate of the cosine; see :func:`transform_to_ground`.

    Parameters
    ----------
    z, start, at, turns
        As for :func:`transform_to_ground`, before that transformation.
    units : complex, shape (m, 7)
        Rates of the joints in the first position, by each unknown.
    through : float, shape (m,)
        Rates of the coupler's angle.
    moving : complex, shape (6, m)
        Rates of ``at``, except that of P.
    turning, bending : float, shape (m,)
        Output: rates of the body's angle and of the cosine.
    """
    base = z[J] - z[Q2]
    turned = (at[4] - at[3]) / base
    back = turned.conjugate()
    pins = at[2], at[4], z[O2], at[0], z[O4], at[1]
    # The derivative is that of the leg with the smallest angle, as in the value.
    _, _, leg = find_min_slant(*pins)
    p = at[0] + turns[1] * (start - z[A])
    for m in range(len(units)):
        unit = units[m]
        a, b, q, j = moving[0, m], moving[1, m], moving[2, m], moving[4, m]
        bending[m] = differentiate_leg_slant(leg, pins, (q, j, unit[O2], a, unit[O4], b))
        moved = (j - unit[Q2] - turned * (unit[J] - unit[Q2])) / base
        # Angular rate of the ground relative to the input link.
        spin = (moved * back).imag
        body = a + 1j * through[m] * turns[1] * (start - z[A]) - turns[1] * unit[A]
        moving[3, m] = _transform_rate(z[O2], unit[O2], z[Q2], unit[Q2], back, spin)
        moving[4, m] = _transform_rate(z[O4], unit[O4], z[Q2], unit[Q2], back, spin)
        moving[0, m] = _transform_rate(at[0], a, z[Q2], unit[Q2], back, spin)
        moving[1, m] = _transform_rate(at[1], b, z[Q2], unit[Q2], back, spin)
        moving[2, m] = _transform_rate(at[2], q, z[Q2], unit[Q2], back, spin)
        moving[5, m] = _transform_rate(p, body, z[Q2], unit[Q2], back, spin)
        turning[m] = through[m] - spin


@njit(cache=True, nogil=True, error_model="numpy")
def _transform_rate(
    point: complex, rate: complex, pin: complex, pin_rate: complex, back: complex, spin: float
) -> complex:
    """Transform the rate of a point to the ground frame, which turns at ``spin`` relative to the input link."""
    # Subtract the rotation of the ground frame, then turn into it.
    return pin_rate + back * (rate - pin_rate - 1j * spin * (point - pin))
