"""Coupler curves of driven linkages, point by point, with their slopes in every dimension.

A linkage is a row of unknowns x, scaled to the task; its crank stands at θ, absolute. The first unknowns are O2, the
last P's coordinates in the coupler's frame (origin at A, real axis towards the coupler's other pin). Lengths are
written so that what the family promises holds for all x, without bounds or penalties:

=============== ======================================= ============================================================
family          unknowns                                 lengths
=============== ======================================= ============================================================
crank-rocker    O2, γ, u₁…u₄, P                          a = e^{u₁}, sₖ = e^{uₖ₊₁}; d = a + (s₂ + s₃)/2,
                                                         b = a + (s₁ + s₂)/2, c = a + (s₁ + s₃)/2: Grashof, a shortest
double-crank    the same                                 the same with a and d exchanged: the ground is shortest
fourbar         the same                                 d, a, b, c = e^{uₖ}: any
slider-crank    O2, σ, u₁…u₃, P                          a = e^{u₁}, b = a + e^{u₂}, offset c = e^{u₂} tanh u₃:
                                                         a + \\|c\\| < b, the crank turns through
slider-rocker   the same                                 a = e^{u₁}, b = e^{u₂}, c = u₃: any
geared fivebar  O2, O5, u₁…u₄, Φ, P                      input, coupler 1, coupler 2, output = e^{uₖ}
=============== ======================================= ============================================================

γ is the direction of the ground line, σ of the slide, and the geared output stands at λθ + Φ. With F the vector of the
last link of the loop (O4 → B, B → C), which has a fixed length, Re(F̄ dF) = |F| d|F| gives the coupler's turn dθ₃ for
any change of dimensions, and z = O2 + a e^{iθ} + P e^{iθ₃} the slopes of the curve (Norton, Sec. 4.5 and 4.8, 4.16).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

OPTIONS: Any = {"cache": True, "nogil": True, "error_model": "numpy"}
"""How the kernels of curves are compiled: a division by zero is no exception, as the result is looked at."""

CRANK_ROCKER, DOUBLE_CRANK, FOURBAR, SLIDER_CRANK, SLIDER_ROCKER, GEARED_FIVEBAR = range(6)
"""Families of linkages."""

UNKNOWNS = {CRANK_ROCKER: 9, DOUBLE_CRANK: 9, FOURBAR: 9, SLIDER_CRANK: 8, SLIDER_ROCKER: 8, GEARED_FIVEBAR: 11}
"""How many numbers a linkage of each family has."""

SMALLEST_LOG, LARGEST_LOG = -16.0, 16.0
"""Logarithms of lengths, in task sizes, are kept between these: far outside any linkage, inside what rounding bears."""


@njit(**OPTIONS)
def natural(family: int, x: Real, lengths: Real, slopes: Real) -> None:
    """The linkage's lengths, and their slopes in the unknowns u as a square matrix.

    Fourbars: d, a, b, c. Slider-cranks: a, b, offset. Geared fivebars: input, coupler 1, coupler 2, output.
    """
    slopes[:] = 0.0
    if family in (CRANK_ROCKER, DOUBLE_CRANK):
        shortest = math.exp(x[3])
        s1, s2, s3 = math.exp(x[4]), math.exp(x[5]), math.exp(x[6])
        d, a = (0, 1) if family == CRANK_ROCKER else (1, 0)
        lengths[d], lengths[a] = shortest + 0.5 * (s2 + s3), shortest
        lengths[2], lengths[3] = shortest + 0.5 * (s1 + s2), shortest + 0.5 * (s1 + s3)
        slopes[:, 0] = shortest
        slopes[2, 1] = slopes[3, 1] = 0.5 * s1
        slopes[d, 2] = slopes[2, 2] = 0.5 * s2
        slopes[d, 3] = slopes[3, 3] = 0.5 * s3
    elif family == FOURBAR:
        for k in range(4):
            lengths[k] = slopes[k, k] = math.exp(x[3 + k])
    elif family == SLIDER_CRANK:
        crank, rest, t = math.exp(x[3]), math.exp(x[4]), math.tanh(x[5])
        lengths[0], lengths[1], lengths[2] = crank, crank + rest, rest * t
        slopes[0, 0] = slopes[1, 0] = crank
        slopes[1, 1] = rest
        slopes[2, 1] = rest * t
        slopes[2, 2] = rest * (1.0 - t * t)
    elif family == SLIDER_ROCKER:
        lengths[0] = slopes[0, 0] = math.exp(x[3])
        lengths[1] = slopes[1, 1] = math.exp(x[4])
        lengths[2] = x[5]
        slopes[2, 2] = 1.0
    else:
        for k in range(4):
            lengths[k] = slopes[k, k] = math.exp(x[4 + k])


@njit(**OPTIONS)
def _unit(angle: float) -> complex:
    return complex(math.cos(angle), math.sin(angle))


@njit(**OPTIONS)
def second_angle(family: int, x: Real, ratio: float, theta: float) -> float:
    """The angle that stands beside the crank's in the loop: of the ground line, the slide, or the geared output."""
    angle: float = ratio * theta + x[8] if family == GEARED_FIVEBAR else x[2]
    return angle


@njit(**OPTIONS)
def _closed(
    family: int, x: Real, lengths: Real, sign: float, crank: complex, second: complex
) -> tuple[bool, complex, complex]:
    """Whether the loop closes, P, and the coupler's unit vector, from those of the crank and of the second angle."""
    o2 = complex(x[0], x[1])
    if family <= FOURBAR:
        b, c = lengths[2], lengths[3]
        pin = lengths[1] * crank
        base = lengths[0] * second - pin
        p = complex(x[7], x[8])
    elif family == GEARED_FIVEBAR:
        b, c = lengths[1], lengths[2]
        pin = lengths[0] * crank
        base = complex(x[2] - x[0], x[3] - x[1]) + lengths[3] * second - pin
        p = complex(x[9], x[10])
    else:
        pin = lengths[0] * crank
        across = (lengths[2] - (pin * second.conjugate()).imag) / lengths[1]
        under = 1.0 - across * across
        if not under > 0.0:
            return False, 0j, 0j
        unit = second * complex(sign * math.sqrt(under), across)
        return True, o2 + pin + complex(x[6], x[7]) * unit, unit
    square = base.real * base.real + base.imag * base.imag
    half = 0.5 * (square + (b - c) * (b + c))
    under = b * b * square - half * half
    if not under > 0.0:
        return False, 0j, 0j
    unit = base * complex(half, sign * math.sqrt(under)) * (1.0 / (square * b))
    return True, o2 + pin + p * unit, unit


@njit(**OPTIONS)
def place(
    family: int, x: Real, lengths: Real, sign: float, ratio: float, theta: float
) -> tuple[bool, complex, complex]:
    """Whether the linkage closes with the crank at θ, P, and the coupler's unit vector (from A)."""
    second = _unit(second_angle(family, x, ratio, theta))
    found: tuple[bool, complex, complex] = _closed(family, x, lengths, sign, _unit(theta), second)
    return found


@njit(**OPTIONS)
def _turn(f: complex, change: complex, per_turn: float) -> float:
    """The coupler's turn that keeps |F| while F changes otherwise."""
    return -(f.real * change.real + f.imag * change.imag) / per_turn


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
    """Whether it closes, P, and into ``slopes`` (m + 1) P's derivatives in the unknowns and, last, in θ."""
    closes, z, unit = place(family, x, lengths, sign, ratio, theta)
    if not closes:
        return False, z
    m = len(slopes) - 1
    crank = complex(math.cos(theta), math.sin(theta))
    p = complex(x[m - 2], x[m - 1])
    swing = 1j * p * unit
    slopes[0], slopes[1] = 1.0 + 0j, 1j
    slopes[m - 2], slopes[m - 1] = unit, 1j * unit
    if family <= FOURBAR:
        d, a, b, c = lengths[0], lengths[1], lengths[2], lengths[3]
        ground = complex(math.cos(x[2]), math.sin(x[2]))
        f = a * crank + b * unit - d * ground
        g = 1j * b * unit
        per = f.real * g.real + f.imag * g.imag
        slopes[2] = swing * _turn(f, -1j * d * ground, per)
        raw_d = swing * _turn(f, -ground, per)
        raw_a = crank + swing * _turn(f, crank, per)
        raw_b = swing * _turn(f, unit, per)
        raw_c = swing * (c / per)
        for k in range(4):
            slopes[3 + k] = raw_d * chart[0, k] + raw_a * chart[1, k] + raw_b * chart[2, k] + raw_c * chart[3, k]
        slopes[m] = 1j * a * crank + swing * _turn(f, 1j * a * crank, per)
        return True, z
    if family == GEARED_FIVEBAR:
        a, b, c, e = lengths[0], lengths[1], lengths[2], lengths[3]
        turned = ratio * theta + x[8]
        output = complex(math.cos(turned), math.sin(turned))
        f = a * crank + b * unit - complex(x[2] - x[0], x[3] - x[1]) - e * output
        g = 1j * b * unit
        per = f.real * g.real + f.imag * g.imag
        # O5 moves the far end, O2 the near one.
        for k in range(2):
            one = 1.0 + 0j if k == 0 else 1j
            slopes[k] = one + swing * _turn(f, one, per)
            slopes[2 + k] = swing * _turn(f, -one, per)
        raw_a = crank + swing * _turn(f, crank, per)
        raw_b = swing * _turn(f, unit, per)
        raw_c = swing * (c / per)
        raw_e = swing * _turn(f, -output, per)
        for k in range(4):
            slopes[4 + k] = raw_a * chart[0, k] + raw_b * chart[1, k] + raw_c * chart[2, k] + raw_e * chart[3, k]
        slopes[8] = swing * _turn(f, -1j * e * output, per)
        moved = 1j * a * crank
        slopes[m] = moved + swing * _turn(f, moved - ratio * 1j * e * output, per)
        return True, z
    a, b = lengths[0], lengths[1]
    along = complex(math.cos(x[2]), math.sin(x[2]))
    local, bent = crank * along.conjugate(), unit * along.conjugate()
    reach = b * bent.real
    raw_a = crank + swing * (-local.imag / reach)
    raw_b = swing * (-bent.imag / reach)
    raw_c = swing / reach
    slopes[2] = swing * (1.0 + a * local.real / reach)
    for k in range(3):
        slopes[3 + k] = raw_a * chart[0, k] + raw_b * chart[1, k] + raw_c * chart[2, k]
    slopes[m] = 1j * a * crank + swing * (-a * local.real / reach)
    return True, z


@njit(**OPTIONS)
def sweep(
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
    """P and θ over equal steps of the crank, shape (n, steps), from begin to end; not good where the linkage jams.

    Where the range is a ring its end is its beginning and is left out.
    """
    n, steps = curves.shape
    lengths, chart = np.empty(4), np.empty((4, 4))
    for i in range(n):
        natural(family, x[i], lengths, chart)
        good[i] = True
        step = (end[i] - begin[i]) / (steps if ring[i] else steps - 1)
        crank, onward = _unit(begin[i]), _unit(step)
        second = _unit(second_angle(family, x[i], ratio, begin[i]))
        turning = _unit(ratio * step) if family == GEARED_FIVEBAR else 1.0 + 0j
        for k in range(steps):
            theta[i, k] = begin[i] + step * k
            closes, curves[i, k], _ = _closed(family, x[i], lengths, sign[i], crank, second)
            if not closes:
                good[i] = False
                break
            crank *= onward
            second *= turning
