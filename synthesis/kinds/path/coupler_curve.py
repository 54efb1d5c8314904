"""The fourbar as least squares sees it: nine numbers, the coupler point at a crank angle, and all derivatives.

    P = O2 + e^{iθ} (a e^{iφ} + (u + iv) e^{iφ3}),      a e^{iφ} + b e^{iφ3} = d + c e^{iφ4}

with θ the angle of the ground line, φ the crank angle from it and u + iv the coupler point. From the loop, multiplied
by e^{−iφ4} and with its imaginary parts left out,

    b sin(φ3 − φ4) dφ3 = da cos(φ − φ4) + db cos(φ3 − φ4) − dd cos φ4 − dc − a sin(φ − φ4) dφ.

The unknowns x are O2, θ, four numbers for the lengths, u, v, and the crank's phase. The numbers for lengths are
logarithms: of the lengths themselves, or, where one link is to be the shortest of a Grashof linkage, of that link S and
of s₁, s₂, s₃ in

    S,   S + (s₂ + s₃)/2,   S + (s₁ + s₂)/2,   S + (s₁ + s₃)/2        (the other links in the order d, a, b, c),

which are Grashof for all positive s: P + Q − L − S is one of them. No descent can leave its class, therefore.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

Real = NDArray[np.float64]

UNKNOWNS = 10
"""O2 (2), θ, lengths (4), u, v, phase."""

LENGTHS, POINT, PHASE = 3, 7, 9
"""Where they stand in x."""

ANY = -1
"""Instead of the number of the shortest link: any lengths."""

FLAT = 1e-9
"""|sin(φ3 − φ4)| below which a configuration is a toggle, where derivatives do not exist."""


@njit(cache=True, nogil=True)
def lengths_of(x: Real, shortest: int, lengths: Real, slopes: Real) -> None:
    """Lengths d, a, b, c, and their derivatives (4, 4) by the four numbers in x."""
    for i in range(4):
        for j in range(4):
            slopes[i, j] = 0.0
    if shortest < 0:
        for i in range(4):
            lengths[i] = math.exp(x[LENGTHS + i])
            slopes[i, i] = lengths[i]
        return
    least = math.exp(x[LENGTHS])
    s1, s2, s3 = math.exp(x[LENGTHS + 1]), math.exp(x[LENGTHS + 2]), math.exp(x[LENGTHS + 3])
    place = 0
    for i in range(4):
        lengths[i] = least
        slopes[i, 0] = least
        if i == shortest:
            continue
        one = 0.0 if place == 0 else 0.5 * s1
        two = 0.0 if place == 2 else 0.5 * s2
        three = 0.0 if place == 1 else 0.5 * s3
        lengths[i] += one + two + three
        slopes[i, 1], slopes[i, 2], slopes[i, 3] = one, two, three
        place += 1


@njit(cache=True, nogil=True)
def numbers_of(lengths: Real, shortest: int, x: Real) -> bool:
    """The four numbers in x of given lengths; False where the linkage is not of the class."""
    if shortest < 0:
        for i in range(4):
            x[LENGTHS + i] = math.log(lengths[i])
        return True
    least = lengths[shortest]
    rest = np.empty(3)
    place = 0
    for i in range(4):
        if i != shortest:
            rest[place] = lengths[i] - least
            place += 1
    s1, s2, s3 = rest[1] + rest[2] - rest[0], rest[0] + rest[1] - rest[2], rest[0] + rest[2] - rest[1]
    if not (s1 > 0.0 and s2 > 0.0 and s3 > 0.0):
        return False
    x[LENGTHS], x[LENGTHS + 1], x[LENGTHS + 2], x[LENGTHS + 3] = (
        math.log(least),
        math.log(s1),
        math.log(s2),
        math.log(s3),
    )
    return True


@njit(cache=True, nogil=True)
def closure(
    d: float, a: float, b: float, c: float, sign: float, cosine: float, sine: float
) -> tuple[bool, float, float, float, float]:
    """Whether the loop closes away from a toggle, and e^{iφ3}, e^{iφ4}; ``sign`` +1 with B left of A → O4."""
    dx, dy = d - a * cosine, -a * sine
    square = dx * dx + dy * dy
    along = square + (b - c) * (b + c)
    height = 4.0 * b * b * square - along * along
    if not height > 4.0 * FLAT * FLAT * b * b * c * c:
        return False, 1.0, 0.0, 1.0, 0.0
    half = 0.5 / square
    h = sign * math.sqrt(height)
    ux, uy = (dx * along - dy * h) * half, (dy * along + dx * h) * half
    return True, ux / b, uy / b, (ux - dx) / c, (uy - dy) / c


@njit(cache=True, nogil=True)
def speed(a: float, b: float, cosine: float, sine: float, x3: float, y3: float, x4: float, y4: float) -> float:
    """dφ3/dφ."""
    return -a * (sine * x4 - cosine * y4) / (b * (y3 * x4 - x3 * y4))


@njit(cache=True, nogil=True)
def point_and_slopes(
    x: Real, lengths: Real, slopes: Real, sign: float, phi: float, by: Real
) -> tuple[bool, float, float, float, float]:
    """P (x, y) and its derivative by φ at a crank angle; derivatives by the first nine unknowns into ``by`` (2, 9)."""
    d, a, b, c = lengths[0], lengths[1], lengths[2], lengths[3]
    cosine, sine = math.cos(phi), math.sin(phi)
    good, x3, y3, x4, y4 = closure(d, a, b, c, sign, cosine, sine)
    if not good:
        return False, 0.0, 0.0, 0.0, 0.0
    ct, st = math.cos(x[2]), math.sin(x[2])
    u, v = x[POINT], x[POINT + 1]
    # In the ground's frame: the coupler point from A, and what turning the coupler does to it.
    px, py = u * x3 - v * y3, u * y3 + v * x3
    fx, fy = a * cosine + px, a * sine + py
    inverse = 1.0 / (b * (y3 * x4 - x3 * y4))
    turn = np.empty(4)
    turn[0] = -x4 * inverse
    turn[1] = (cosine * x4 + sine * y4) * inverse
    turn[2] = (x3 * x4 + y3 * y4) * inverse
    turn[3] = -inverse
    by_phi = -a * (sine * x4 - cosine * y4) * inverse
    tx, ty = -a * sine - py * by_phi, a * cosine + px * by_phi
    by[0, 0], by[1, 0] = 1.0, 0.0
    by[0, 1], by[1, 1] = 0.0, 1.0
    rx, ry = ct * fx - st * fy, st * fx + ct * fy
    by[0, 2], by[1, 2] = -ry, rx
    for j in range(4):
        gx = gy = 0.0
        for i in range(4):
            if slopes[i, j] != 0.0:
                gx += slopes[i, j] * (-py * turn[i] + (cosine if i == 1 else 0.0))
                gy += slopes[i, j] * (px * turn[i] + (sine if i == 1 else 0.0))
        by[0, LENGTHS + j], by[1, LENGTHS + j] = ct * gx - st * gy, st * gx + ct * gy
    by[0, POINT], by[1, POINT] = ct * x3 - st * y3, st * x3 + ct * y3
    by[0, POINT + 1], by[1, POINT + 1] = -by[1, POINT], by[0, POINT]
    return True, x[0] + rx, x[1] + ry, ct * tx - st * ty, st * tx + ct * ty


@njit(cache=True, nogil=True)
def point_at(x: Real, lengths: Real, sign: float, phi: float) -> tuple[bool, float, float, float, float]:
    """P (x, y) and its derivative by φ alone."""
    d, a, b, c = lengths[0], lengths[1], lengths[2], lengths[3]
    cosine, sine = math.cos(phi), math.sin(phi)
    good, x3, y3, x4, y4 = closure(d, a, b, c, sign, cosine, sine)
    if not good:
        return False, 0.0, 0.0, 0.0, 0.0
    ct, st = math.cos(x[2]), math.sin(x[2])
    u, v = x[POINT], x[POINT + 1]
    px, py = u * x3 - v * y3, u * y3 + v * x3
    fx, fy = a * cosine + px, a * sine + py
    by_phi = speed(a, b, cosine, sine, x3, y3, x4, y4)
    tx, ty = -a * sine - py * by_phi, a * cosine + px * by_phi
    return True, x[0] + ct * fx - st * fy, x[1] + st * fx + ct * fy, ct * tx - st * ty, st * tx + ct * ty


@njit(cache=True, nogil=True)
def crank_range(d: float, a: float, b: float, c: float) -> tuple[float, float]:
    """Least and greatest |φ| at which the loop closes: 0 and π for a crank; the greatest below the least for none."""
    low, high = 0.0, math.pi
    near, far = abs(b - c), b + c
    if abs(d - a) < near:
        if d + a <= near:
            return 1.0, 0.0
        low = 2.0 * math.atan(math.sqrt((near * near - (d - a) ** 2) / ((d + a) ** 2 - near * near)))
    if d + a > far:
        if abs(d - a) >= far:
            return 1.0, 0.0
        high = 2.0 * math.atan(math.sqrt((far * far - (d - a) ** 2) / ((d + a) ** 2 - far * far)))
    return low, high
