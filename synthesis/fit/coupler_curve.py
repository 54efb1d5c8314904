"""Coupler curves of driven linkages, point by point, with their slopes in every dimension.

The crank of a linkage (:mod:`synthesis.fit.chart`) stands at θ, absolute, and the geared output at λθ + Φ. Two bars b
and c close the loop over the base w from A to the pin at which c ends: with h = (|w|² + b² − c²)/2 the coupler is

    b e^{iθ₃} = w (h ± i √(b²|w|² − h²)) / |w|²,        + if the bars' common pin is left of w.

With F the vector of the last link of the loop (O4 → B, B → C), which has a fixed length, Re(F̄ dF) = |F| d|F| gives the
coupler's turn dθ₃ for any change of dimensions, and z = O2 + a e^{iθ} + P e^{iθ₃} the slopes of the curve (Norton,
Sec. 4.5 and 4.8, 4.16).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from synthesis.fit.chart import FOURBAR, GEARED_FIVEBAR, OPTIONS, compute_lengths

TOGGLE_TOLERANCE = 1e-9
"""|sin(θ₃ − θ₄)| below which a configuration is a toggle, where derivatives do not exist."""


@njit(**OPTIONS)
def compute_unit_vector(angle: float) -> complex:
    """Return e^{iθ}."""
    return complex(math.cos(angle), math.sin(angle))


@njit(**OPTIONS)
def scale_complex(z: complex, factor: float) -> complex:
    """Return z times a real factor.

    A complex product would also multiply by the zero imaginary part, which a compiler bound to IEEE 754 cannot omit.
    """
    return complex(factor * z.real, factor * z.imag)


@njit(**OPTIONS)
def rotate_left(z: complex) -> complex:
    """Return z rotated by a right angle anticlockwise, iz."""
    return complex(-z.imag, z.real)


@njit(**OPTIONS)
def compute_second_angle(family: int, x: Real, ratio: float, theta: float) -> float:
    """Return the second angle of the loop next to the crank's: of the ground line, the slide, or the geared output."""
    angle: float = ratio * theta + x[8] if family == GEARED_FIVEBAR else x[2]
    return angle


@njit(**OPTIONS)
def close_two_bars(base: complex, b: float, c: float, sign: float) -> tuple[bool, complex]:
    """Return whether two bars close the loop over a base, away from a toggle, and the first bar's unit vector."""
    square = base.real * base.real + base.imag * base.imag
    # (b − c)(b + c) keeps the digits that b² − c² loses for similar bars.
    half = 0.5 * (square + (b - c) * (b + c))
    under = b * b * square - half * half
    # b² |w|² − h² is (|w| b sin)², proportional to the sine of the angle between the bars; the negation catches NaN.
    if not under > TOGGLE_TOLERANCE * TOGGLE_TOLERANCE * b * b * c * c:
        return False, 1.0 + 0j
    return True, scale_complex(base * complex(half, sign * math.sqrt(under)), 1.0 / (square * b))


@njit(**OPTIONS)
def _solve_coupler(
    family: int, x: Real, lengths: Real, sign: float, crank: complex, second: complex
) -> tuple[bool, complex, complex]:
    """Return whether the loop closes, P, and the coupler's unit vector.

    ``crank`` and ``second`` are the unit vectors of the crank and of the second angle.
    """
    o2 = complex(x[0], x[1])
    if family <= FOURBAR:
        pin = scale_complex(crank, lengths[1])
        closes, along = close_two_bars(scale_complex(second, lengths[0]) - pin, lengths[2], lengths[3], sign)
        return closes, o2 + pin + complex(x[7], x[8]) * along, along
    pin = scale_complex(crank, lengths[0])
    if family == GEARED_FIVEBAR:
        base = complex(x[2] - x[0], x[3] - x[1]) + scale_complex(second, lengths[3]) - pin
        closes, along = close_two_bars(base, lengths[1], lengths[2], sign)
        return closes, o2 + pin + complex(x[9], x[10]) * along, along
    # Sine of the coupler's angle to the slide: the coupler spans the pin's distance from the slider's line.
    across = (lengths[2] - (pin * second.conjugate()).imag) / lengths[1]
    under = 1.0 - across * across
    if not under > 0.0:
        return False, 0j, 1.0 + 0j
    along = second * complex(sign * math.sqrt(under), across)
    return True, o2 + pin + complex(x[6], x[7]) * along, along


@njit(**OPTIONS)
def place_linkage(
    family: int, x: Real, lengths: Real, sign: float, ratio: float, theta: float
) -> tuple[bool, complex, complex]:
    """Return whether the linkage closes with the crank at θ, P, and the coupler's unit vector (from A)."""
    second = compute_unit_vector(compute_second_angle(family, x, ratio, theta))
    pose: tuple[bool, complex, complex] = _solve_coupler(family, x, lengths, sign, compute_unit_vector(theta), second)
    return pose


@njit(**OPTIONS)
def trace_points(
    family: int, x: Real, lengths: Real, sign: float, ratio: float, theta: Real, places: Complex, along: Complex
) -> bool:
    """Write P and the coupler's unit vector at several crank angles; return False if one of them is beyond a toggle."""
    closes = True
    for k in range(len(theta)):
        here, places[k], along[k] = place_linkage(family, x, lengths, sign, ratio, theta[k])
        closes = closes and here
    return closes


@njit(**OPTIONS)
def _compute_turn_rate(f: complex, change: complex, per_turn: float) -> float:
    """Return the coupler's rotation that keeps |F| while F changes by ``change``."""
    return -(f.real * change.real + f.imag * change.imag) / per_turn


@njit(**OPTIONS)
def compute_fourbar_velocity(
    x: Real, lengths: Real, sign: float, ground: complex, theta: float
) -> tuple[bool, complex, complex]:
    """Return whether a fourbar closes, P, and P's derivative by θ; ``ground`` is the unit vector of the ground line."""
    crank = compute_unit_vector(theta)
    closes, z, along = _solve_coupler(FOURBAR, x, lengths, sign, crank, ground)
    arm, bar = scale_complex(crank, lengths[1]), scale_complex(along, lengths[2])
    f = arm + bar - scale_complex(ground, lengths[0])
    g, moved = rotate_left(bar), rotate_left(arm)
    swing = rotate_left(complex(x[7], x[8]) * along)
    return closes, z, moved + scale_complex(swing, _compute_turn_rate(f, moved, f.real * g.real + f.imag * g.imag))


@njit(**OPTIONS)
def _write_fourbar_slopes(
    lengths: Real, chart: Real, crank: complex, second: complex, along: complex, swing: complex, slopes: Complex
) -> None:
    """Write P's derivatives by the direction of the ground line and the lengths, and by θ.

    ``swing`` is P's velocity for a unit rotation of the coupler about A.
    """
    c = lengths[3]
    side, arm, bar = (
        scale_complex(second, lengths[0]),
        scale_complex(crank, lengths[1]),
        scale_complex(along, lengths[2]),
    )
    f, g, moved = arm + bar - side, rotate_left(bar), rotate_left(arm)
    per = f.real * g.real + f.imag * g.imag
    # Turning the ground line moves O4 but, at a fixed absolute θ, not the crank.
    slopes[2] = scale_complex(swing, _compute_turn_rate(f, -rotate_left(side), per))
    raw_d = scale_complex(swing, _compute_turn_rate(f, -second, per))
    raw_a = crank + scale_complex(swing, _compute_turn_rate(f, crank, per))
    raw_b = scale_complex(swing, _compute_turn_rate(f, along, per))
    # For the last link |F| itself changes: Re(F̄ dF) = c dc.
    raw_c = scale_complex(swing, c / per)
    # Chain rule: from derivatives by lengths to derivatives by the chart's numbers.
    for k in range(4):
        slopes[3 + k] = (
            scale_complex(raw_d, chart[0, k]) + scale_complex(raw_a, chart[1, k])
            + scale_complex(raw_b, chart[2, k]) + scale_complex(raw_c, chart[3, k])
        )  # fmt: skip
    slopes[len(slopes) - 1] = moved + scale_complex(swing, _compute_turn_rate(f, moved, per))


@njit(**OPTIONS)
def _write_fivebar_slopes(
    x: Real, lengths: Real, chart: Real, ratio: float, crank: complex, second: complex, along: complex, swing: complex,
    slopes: Complex,
) -> None:  # fmt: skip
    """Write P's derivatives by the ground pivots, the lengths and the phase of the gears, and by θ.

    ``swing`` is P's velocity for a unit rotation of the coupler about A.
    """
    c = lengths[2]
    arm, bar, end = (
        scale_complex(crank, lengths[0]),
        scale_complex(along, lengths[1]),
        scale_complex(second, lengths[3]),
    )
    f, g = arm + bar - complex(x[2] - x[0], x[3] - x[1]) - end, rotate_left(bar)
    per = f.real * g.real + f.imag * g.imag
    # O5 moves the far end, O2 the near one.
    for k in range(2):
        one = 1.0 + 0j if k == 0 else 1j
        slopes[k] = one + scale_complex(swing, _compute_turn_rate(f, one, per))
        slopes[2 + k] = scale_complex(swing, _compute_turn_rate(f, -one, per))
    raw_a = crank + scale_complex(swing, _compute_turn_rate(f, crank, per))
    raw_b = scale_complex(swing, _compute_turn_rate(f, along, per))
    raw_c = scale_complex(swing, c / per)
    raw_e = scale_complex(swing, _compute_turn_rate(f, -second, per))
    for k in range(4):
        slopes[4 + k] = (
            scale_complex(raw_a, chart[0, k]) + scale_complex(raw_b, chart[1, k])
            + scale_complex(raw_c, chart[2, k]) + scale_complex(raw_e, chart[3, k])
        )  # fmt: skip
    slopes[8] = scale_complex(swing, _compute_turn_rate(f, -rotate_left(end), per))
    moved = rotate_left(arm)
    # The geared output turns by λ dθ, which moves the far end of the loop.
    slopes[len(slopes) - 1] = moved + scale_complex(
        swing, _compute_turn_rate(f, moved - scale_complex(rotate_left(end), ratio), per)
    )


@njit(**OPTIONS)
def _write_slider_slopes(
    lengths: Real, chart: Real, crank: complex, second: complex, along: complex, swing: complex, slopes: Complex
) -> None:
    """Write P's derivatives by the direction of the slide and the lengths, and by θ.

    ``swing`` is P's velocity for a unit rotation of the coupler about A.
    """
    # Slider: work in the slide's frame, in which the pin of the coupler keeps its distance c from the line.
    a, b = lengths[0], lengths[1]
    local, bent = crank * second.conjugate(), along * second.conjugate()
    # Rate of that distance per rotation of the coupler.
    reach = b * bent.real
    raw_a = crank + scale_complex(swing, -local.imag / reach)
    raw_b = scale_complex(swing, -bent.imag / reach)
    raw_c = scale_complex(swing, 1.0 / reach)
    slopes[2] = scale_complex(swing, 1.0 + a * local.real / reach)
    for k in range(3):
        slopes[3 + k] = (
            scale_complex(raw_a, chart[0, k]) + scale_complex(raw_b, chart[1, k]) + scale_complex(raw_c, chart[2, k])
        )
    slopes[len(slopes) - 1] = rotate_left(scale_complex(crank, a)) + scale_complex(swing, -a * local.real / reach)


@njit(**OPTIONS)
def place_with_slopes(
    family: int,
    x: Real,
    lengths: Real,
    chart: Real,
    sign: float,
    ratio: float,
    theta: float,
    slopes: Complex,
) -> tuple[bool, complex]:
    """Return whether the linkage closes, and P; write P's derivatives into ``slopes``, shape (m + 1,).

    They are by the m unknowns and, last, by θ.
    """
    crank, second = compute_unit_vector(theta), compute_unit_vector(compute_second_angle(family, x, ratio, theta))
    closes, z, along = _solve_coupler(family, x, lengths, sign, crank, second)
    if not closes:
        return False, z
    m = len(slopes) - 1
    # Velocity of P for a unit rotation of the coupler about A; every other derivative adds a multiple of it.
    swing = rotate_left(complex(x[m - 2], x[m - 1]) * along)
    slopes[0], slopes[1] = 1.0 + 0j, 1j
    slopes[m - 2], slopes[m - 1] = along, rotate_left(along)
    if family <= FOURBAR:
        _write_fourbar_slopes(lengths, chart, crank, second, along, swing, slopes)
    elif family == GEARED_FIVEBAR:
        _write_fivebar_slopes(x, lengths, chart, ratio, crank, second, along, swing, slopes)
    else:
        _write_slider_slopes(lengths, chart, crank, second, along, swing, slopes)
    return True, z


@njit(**OPTIONS)
def sweep_curves(
    family: int,
    x: Real,
    sign: Real,
    ratio: float,
    begin: Real,
    end: Real,
    ring: NDArray[np.bool_],
    curves: Complex,
    theta: Real,
    good: NDArray[np.bool_],
) -> None:
    """Compute P and θ over equal steps of the crank, shape (n, steps), from begin to end.

    ``good`` receives whether each linkage closes at all of them.

    If the range is a ring, its end coincides with its beginning and is left out.
    """
    n, steps = curves.shape
    lengths, chart = np.empty(4), np.empty((4, 4))
    for i in range(n):
        compute_lengths(family, x[i], lengths, chart)
        good[i] = True
        step = (end[i] - begin[i]) / (steps if ring[i] else steps - 1)
        # Rotate unit vectors step by step: one product replaces a sine and a cosine.
        crank, onward = compute_unit_vector(begin[i]), compute_unit_vector(step)
        second = compute_unit_vector(compute_second_angle(family, x[i], ratio, begin[i]))
        turning = compute_unit_vector(ratio * step) if family == GEARED_FIVEBAR else 1.0 + 0j
        for k in range(steps):
            theta[i, k] = begin[i] + step * k
            closes, curves[i, k], _ = _solve_coupler(family, x[i], lengths, sign[i], crank, second)
            if not closes:
                good[i] = False
                break
            crank *= onward
            second *= turning


@njit(**OPTIONS)
def find_crank_range(d: float, a: float, b: float, c: float) -> tuple[float, float]:
    """Return the minimum and maximum |φ| at which the loop closes: 0 and π for a crank; (1, 0) if it never closes."""
    # Coupler and output close the loop if the diagonal from O4 to A lies between |b − c| and b + c.
    low, high = 0.0, math.pi
    near, far = abs(b - c), b + c
    if abs(d - a) < near:
        # Even the opposite position of the crank is too near for the two bars.
        if d + a <= near:
            return 1.0, 0.0
        # The law of cosines in half-angle form, which keeps its digits near 0 and π.
        low = 2.0 * math.atan(math.sqrt((near * near - (d - a) ** 2) / ((d + a) ** 2 - near * near)))
    if d + a > far:
        if abs(d - a) >= far:
            return 1.0, 0.0
        high = 2.0 * math.atan(math.sqrt((far * far - (d - a) ** 2) / ((d + a) ** 2 - far * far)))
    return low, high


@njit(**OPTIONS)
def find_rocking_range(low: float, high: float) -> tuple[float, float]:
    """Return the beginning and width of a rocking crank's range, from its minimum and maximum |φ|.

    The range extends from toggle to toggle through φ = 0 or φ = π if it contains one of them; otherwise it is the upper
    of two mirrored ranges.
    """
    # Toggles at both limits: the two ranges are mirror images, and one represents both.
    if low > 0.0 and high < math.pi:
        return low, high - low
    if low > 0.0:
        return low, 2.0 * (math.pi - low)
    return -high, 2.0 * high
