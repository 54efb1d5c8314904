"""Peaks of the forces in many fourbars at constant speed: kinematics and reactions in closed form, compiled.

Used to select candidates; reported values come from :mod:`reactions`. With the unit vectors u₃ along A → B
and u₄ along O4 → B, and s = u₄ × u₃, the sine of the transmission angle, the rates are

    ω₄ = ω₂ (a × u₃)/(c s),                         ω₃ = ω₂ (a × u₄)/(b s),
    α₄ = (A″·u₃ − ω₃² b + ω₄² c (u₄·u₃))/(c s),     α₃ = (A″·u₄ + ω₄² c − ω₃² b (u₃·u₄))/(b s).

Each link requires the resultant R = m (a_G − g) − Σ F of its pins' forces, and their moment M about its first joint
(Norton, *Design of Machinery*, eq. 11.1). Moments of the output about O4 and of the coupler about A have the
force of pin B on the output, x u₃ + y u₄, as the only unknown:

    x = M₄/(c s),        y = (M₃ − b u₃ × f)/(b s),

where f is the force on the pin itself. The other pins follow from the sums of forces, and the drive last.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from kinematics.dynamics.kernels import OPTIONS

DRIVE, JOINT, SHAKING_FORCE, SHAKING_MOMENT, POWER = range(5)
"""Columns of the peaks."""

INPUT, COUPLER, OUTPUT, PIN_A, PIN_B, PIN_P = range(6)
"""Codes for the target of a load. Loads at ground pins are omitted, since they act on no moving link."""

MIN_SINE = 1e-6
"""Sine of the transmission angle below which the forces of a position count as infinite."""


class Fourbars(NamedTuple):
    """Fourbars of shape (n,), in the unit of the forces' lengths.

    ``point`` is P from A over the direction A → B; ``sign`` is 1 where B lies to the left of A → O4. The input turns
    from ``start`` by ``span``, radians.
    """

    o2: Complex
    o4: Complex
    a: Real
    b: Real
    c: Real
    point: Complex
    sign: Real
    start: Real
    span: Real


class Weights(NamedTuple):
    """Masses and loads of the fourbars.

    ``mass``, ``cg``, ``inertia`` have shape (n, 3), for input, coupler and output; a centre of gravity is relative to
    the link's first joint (O2, A, O4), divided by the link's direction (O2 → A, A → B, O4 → B). ``pins`` has the masses
    at A, B and P, shape (n, 3). Load k acts on ``on[k]`` with ``force[:, k]`` (divided by the link's direction if
    ``turning[k]``) at ``arm[:, k]``, given like a centre of gravity. ``couples`` act on the three links.
    """

    mass: Real
    cg: Complex
    inertia: Real
    pins: Real
    gravity: complex
    on: NDArray[np.int64]
    arm: Complex
    force: Complex
    turning: NDArray[np.bool_]
    couples: Real
    about: Complex


def compute_peaks(linkages: Fourbars, weights: Weights, speed: float, positions: int) -> Real:
    """Compute the maximum magnitudes of drive, pin force, shaking force, shaking moment and power over the positions.

    Parameters
    ----------
    linkages, weights
        Data of n linkages.
    speed : float
        Input speed, rad/s.
    positions : int
        Number of equally spaced positions of each range, both ends included; peaks are taken over these.

    Returns
    -------
    float, shape (n, 5)
        Columns in the order of :data:`DRIVE` and following; infinite if a position cannot be assembled or is a toggle.
    """
    out = np.empty((len(linkages.a), 1, 5))
    arguments = (*linkages, *weights, speed, positions, out)
    fill_peaks(*arguments)
    return out[:, 0]


@njit(**OPTIONS)
def _cross(u: complex, v: complex) -> float:
    return u.real * v.imag - u.imag * v.real


@njit(**OPTIONS)
def _dot(u: complex, v: complex) -> float:
    return u.real * v.real + u.imag * v.imag


@njit(**OPTIONS)
def _square_magnitude(z: complex) -> float:
    return z.real * z.real + z.imag * z.imag


@njit(**OPTIONS)
def fill_peaks(
    o2s: Complex,
    o4s: Complex,
    a_lengths: Real,
    b_lengths: Real,
    c_lengths: Real,
    points: Complex,
    signs: Real,
    starts: Real,
    spans: Real,
    mass: Real,
    cg: Complex,
    inertia: Real,
    pins: Real,
    gravity: complex,
    on: NDArray[np.int64],
    arms: Complex,
    forces: Complex,
    turning: NDArray[np.bool_],
    couples: Real,
    abouts: Complex,
    speed: float,
    positions: int,
    out: Real,
) -> None:
    """Fill the peaks of :func:`compute_peaks` by windows of equal numbers of positions into ``out`` (n, windows, 5).

    One long loop, since function calls here would cost as much as the work inside them.
    """
    windows = out.shape[1]
    for n in range(len(o2s)):
        o2, o4, about = o2s[n], o4s[n], abouts[n]
        a, b, c, point, sign = a_lengths[n], b_lengths[n], c_lengths[n], points[n], signs[n]
        m2, m3, m4 = mass[n, 0], mass[n, 1], mass[n, 2]
        g2, g3, g4 = cg[n, 0], cg[n, 1], cg[n, 2]
        i3, i4 = inertia[n, 1], inertia[n, 2]
        mass_a, mass_b, mass_p = pins[n, 0], pins[n, 1], pins[n, 2]
        step = spans[n] / (positions - 1)
        u2 = complex(math.cos(starts[n]), math.sin(starts[n]))
        turn = complex(math.cos(step), math.sin(step))
        drive = pin = shaking = moment = 0.0
        whole = True
        window, last = 0, positions // windows
        for k in range(positions):
            # The window is complete: store its peaks and start the next one.
            if k == last and window + 1 < windows:
                _write_peaks(out[n, window], drive, pin, shaking, moment, speed)
                drive = pin = shaking = moment = 0.0
                window += 1
                last = (window + 1) * positions // windows
            crank = a * u2
            joint_a = o2 + crank
            diagonal = o4 - joint_a
            squared = _square_magnitude(diagonal)
            # Projection of the coupler on the diagonal A → O4, times the diagonal's length.
            along = 0.5 * (squared + b * b - c * c)
            height = b * b * squared - along * along
            # "not >" also rejects NaN.
            if not height > 0.0:
                whole = False
                break
            u3 = diagonal * complex(along, sign * math.sqrt(height)) / (squared * b)
            joint_b = joint_a + b * u3
            u4 = (joint_b - o4) / c
            s = _cross(u4, u3)
            # At a toggle the forces are unbounded: the whole design is rejected.
            if not abs(s) > MIN_SINE:
                whole = False
                break
            w3, w4 = speed * _cross(crank, u4) / (b * s), speed * _cross(crank, u3) / (c * s)
            pull = -speed * speed * crank
            cosine = _dot(u3, u4)
            alpha4 = (_dot(pull, u3) - w3 * w3 * b + w4 * w4 * c * cosine) / (c * s)
            alpha3 = (_dot(pull, u4) + w4 * w4 * c - w3 * w3 * b * cosine) / (b * s)
            rate3, rate4 = complex(-w3 * w3, alpha3), complex(-w4 * w4, alpha4)

            arm2, arm3, arm4 = g2 * u2, g3 * u3, g4 * u4
            arm_p = point * u3
            need2 = m2 * (-speed * speed * arm2 - gravity)
            need3 = m3 * (pull + rate3 * arm3 - gravity)
            need4 = m4 * (rate4 * arm4 - gravity)
            # A mass at P is hung on the coupler there, with its own inertia.
            payload = mass_p * (gravity - pull - rate3 * arm_p)
            turned2 = _cross(arm2, need2) - couples[0]
            turned3 = i3 * alpha3 + _cross(arm3, need3) - _cross(arm_p, payload) - couples[1]
            turned4 = i4 * alpha4 + _cross(arm4, need4) - couples[2]
            need3 -= payload
            on_a = mass_a * (gravity - pull)
            on_b = mass_b * (gravity - rate4 * c * u4)
            for i in range(len(on)):
                force = forces[n, i]
                if on[i] == INPUT:
                    force = force * u2 if turning[i] else force
                    need2 -= force
                    turned2 -= _cross(arms[n, i] * u2, force)
                elif on[i] == COUPLER:
                    force = force * u3 if turning[i] else force
                    need3 -= force
                    turned3 -= _cross(arms[n, i] * u3, force)
                elif on[i] == OUTPUT:
                    force = force * u4 if turning[i] else force
                    need4 -= force
                    turned4 -= _cross(arms[n, i] * u4, force)
                elif on[i] == PIN_A:
                    on_a += force
                elif on[i] == PIN_B:
                    on_b += force
                else:
                    need3 -= force
                    turned3 -= _cross(arm_p, force)
                    payload += force

            b_on_output = turned4 / (c * s) * u3 + (turned3 - b * _cross(u3, on_b)) / (b * s) * u4
            b_on_coupler = on_b - b_on_output
            o4_on_output = need4 - b_on_output
            a_on_coupler = need3 - b_on_coupler
            a_on_input = on_a - a_on_coupler
            o2_on_input = need2 - a_on_input
            torque = turned2 - _cross(crank, a_on_input)
            at_ground = -(o2_on_input + o4_on_output)
            about_point = -_cross(o2 - about, o2_on_input) - _cross(o4 - about, o4_on_output) - torque
            drive, moment = max(drive, abs(torque)), max(moment, abs(about_point))
            shaking = max(shaking, _square_magnitude(at_ground))
            # Squares avoid a root per force and position.
            pin = max(
                pin,
                _square_magnitude(o2_on_input),
                _square_magnitude(o4_on_output),
                _square_magnitude(a_on_input),
                _square_magnitude(a_on_coupler),
            )
            pin = max(pin, _square_magnitude(b_on_output), _square_magnitude(b_on_coupler), _square_magnitude(payload))
            # A complex product instead of sine and cosine per position; the error grows by 1e-16 per step.
            u2 *= turn
        if whole:
            _write_peaks(out[n, window], drive, pin, shaking, moment, speed)
        else:
            out[n] = np.inf


@njit(**OPTIONS)
def _write_peaks(out: Real, drive: float, pin: float, shaking: float, moment: float, speed: float) -> None:
    """Write the peaks; those of the pin force and the shaking force are passed as squares."""
    out[DRIVE], out[JOINT], out[SHAKING_FORCE] = drive, math.sqrt(pin), math.sqrt(shaking)
    out[SHAKING_MOMENT], out[POWER] = moment, drive * abs(speed)
