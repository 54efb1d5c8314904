"""Laws of cam motion, written out as the textbooks print them (Norton, §8.3 and Table 8-3; Rao, §5.2).

s, s′, s″, s‴ of unit lift over unit angle. Where a law is made of parts, ``part`` says in which of them a place is
meant, because derivatives step from one to the next.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real

Motion = tuple[Real, Real, Real, Real]

POLYNOMIALS: dict[str, tuple[float, ...]] = {
    "constant_velocity": (0, 1),
    "polynomial_23": (0, 0, 3, -2),
    "polynomial_345": (0, 0, 0, 10, -15, 6),
    "polynomial_4567": (0, 0, 0, 0, 35, -84, 70, -20),
    "polynomial_456789": (0, 0, 0, 0, 0, 126, -420, 540, -315, 70),
    "eighth_power": (0, 0, 0, 6.09755, 0, -20.78040, 26.73155, -13.60965, 2.56095),
}
"""Coefficients, constant first."""

FAMILY = {
    "constant_acceleration": (0.0, 0.0),
    "modified_trapezoid": (0.25, 0.25),
    "modified_sine": (0.25, 0.75),
}
"""b and d of the sine-constant-cosine family (Norton, Table 8-2): shares of the sine and of the cosine."""

MIRRORED = {"eighth_power_reversed": "eighth_power", "double_harmonic_reversed": "double_harmonic"}
"""Laws that are others seen from their end: 1 − s(1 − u)."""

AT_REST = (
    "cycloidal",
    "modified_sine",
    "polynomial_345",
    "polynomial_4567",
    "polynomial_456789",
    "trapezoidal",
    "modified_trapezoid",
    "modified_constant_velocity",
)
"""Laws that begin and end without velocity and acceleration."""


def law(name: str, u: Real, part: Real | None = None) -> Motion:
    """s, s′, s″, s‴ at shares u of the angle; ``part`` are places within the parts that are meant, u if left out."""
    part = u if part is None else part
    if name in MIRRORED:
        s, v, a, j = law(MIRRORED[name], 1.0 - u, 1.0 - part)
        return 1.0 - s, v, -a, j
    if name in POLYNOMIALS:
        curve = np.polynomial.Polynomial(POLYNOMIALS[name])
        return curve(u), curve.deriv()(u), curve.deriv(2)(u), curve.deriv(3)(u)
    if name in FAMILY:
        return _family(*FAMILY[name], u, part)
    if name == "trapezoidal":
        return _trapezoidal(u, part)
    if name == "modified_constant_velocity":
        return _modified_constant_velocity(u, part)
    pi = math.pi
    if name == "simple_harmonic":
        return _sum(u, 0.5, 0.0, (-0.5, pi, 0.5 * pi))
    if name == "cycloidal":
        return _sum(u, 0.0, 1.0, (-0.5 / pi, 2.0 * pi, 0.0))
    if name == "double_harmonic":
        return _sum(u, 0.375, 0.0, (-0.5, pi, 0.5 * pi), (0.125, 2.0 * pi, 0.5 * pi))
    if name == "half_harmonic_start":
        return _sum(u, 1.0, 0.0, (-1.0, 0.5 * pi, 0.5 * pi))
    if name == "half_harmonic_end":
        return _sum(u, 0.0, 0.0, (1.0, 0.5 * pi, 0.0))
    if name == "half_cycloidal_start":
        return _sum(u, 0.0, 1.0, (-1.0 / pi, pi, 0.0))
    if name == "half_cycloidal_end":
        return _sum(u, 0.0, 1.0, (1.0 / pi, pi, 0.0))
    raise KeyError(name)


def _sum(u: Real, constant: float, linear: float, *waves: tuple[float, float, float]) -> Motion:
    """A straight line and sines, each of amplitude, frequency and phase."""
    s, v, a, j = constant + linear * u, np.full_like(u, linear), np.zeros_like(u), np.zeros_like(u)
    for size, rate, phase in waves:
        turn = rate * u + phase
        s, v = s + size * np.sin(turn), v + size * rate * np.cos(turn)
        a, j = a - size * rate**2 * np.sin(turn), j - size * rate**3 * np.cos(turn)
    return s, v, a, j


def _family(b: float, d: float, x: Real, part: Real) -> Motion:
    """Norton, eq. 8.15 to 8.19: sine over b/2, constant, cosine over d, constant, sine."""
    pi = math.pi
    c = 1.0 - b - d
    zones = [part <= b / 2, part <= (1 - d) / 2, part <= (1 + d) / 2, part <= 1 - b / 2]
    rise, top = pi / max(b, 1e-300), pi / max(d, 1e-300)
    t, e = top * (x - (1 - d) / 2), rise * (x - 1)
    none, one = np.zeros_like(x), np.ones_like(x)
    s = [
        b / pi * x - (b / pi) ** 2 * np.sin(rise * x),
        x**2 / 2 + b * (1 / pi - 1 / 2) * x + b**2 * (1 / 8 - 1 / pi**2),
        (b / pi + c / 2) * x
        + (d / pi) ** 2
        + b**2 * (1 / 8 - 1 / pi**2)
        - (1 - d) ** 2 / 8
        - (d / pi) ** 2 * np.cos(t),
        -(x**2) / 2 + (b / pi + 1 - b / 2) * x + (2 * d**2 - b**2) * (1 / pi**2 - 1 / 8) - 1 / 4,
        b / pi * x + 2 * (d**2 - b**2) / pi**2 + ((1 - b) ** 2 - d**2) / 4 - (b / pi) ** 2 * np.sin(e),
    ]
    v = [
        b / pi * (1 - np.cos(rise * x)),
        x + b * (1 / pi - 1 / 2),
        b / pi + c / 2 + d / pi * np.sin(t),
        -x + b / pi + 1 - b / 2,
        b / pi * (1 - np.cos(e)),
    ]
    a = [np.sin(rise * x), one, np.cos(t), -one, np.sin(e)]
    j = [rise * np.cos(rise * x), none, -top * np.sin(t), none, rise * np.cos(e)]
    size = 4 * pi**2 / ((pi**2 - 8) * (b**2 - d**2) - 2 * pi * (pi - 2) * b + pi**2)
    found = [size * np.select(zones, parts[:-1], parts[-1]) for parts in (s, v, a, j)]
    return found[0], found[1], found[2], found[3]


def _mirrored(half: Motion, second: NDArray[np.bool_]) -> Motion:
    """A law whose second half is the first one seen from the end."""
    s, v, a, j = half
    return np.where(second, 1.0 - s, s), v, np.where(second, -a, a), j


def _trapezoidal(u: Real, part: Real) -> Motion:
    """Acceleration 16/3 between ramps of 1/8 (Norton, Figure 8-14)."""
    second = part > 0.5
    x, part = np.where(second, 1.0 - u, u), np.where(second, 1.0 - part, part)
    zones = [part <= 1 / 8, part <= 3 / 8]
    peak, t = 16 / 3, x - 3 / 8
    s = [peak * 8 * x**3 / 6, peak * (x**2 / 2 - x / 16 + 1 / 384)]
    v = [peak * 4 * x**2, peak * (x - 1 / 16)]
    s3, v3 = peak * ((3 / 8) ** 2 / 2 - 3 / 128 + 1 / 384), peak * (3 / 8 - 1 / 16)
    last = s3 + v3 * t + peak * (t**2 / 2 - 8 * t**3 / 6), v3 + peak * (t - 4 * t**2), peak * (1 - 8 * t)
    a = [peak * 8 * x, np.full_like(x, peak)]
    j = [np.full_like(x, peak * 8), np.zeros_like(x)]
    half = (
        np.select(zones, s, last[0]),
        np.select(zones, v, last[1]),
        np.select(zones, a, last[2]),
        np.select(zones, j, np.full_like(x, -peak * 8)),
    )
    return _mirrored(half, second)


def _modified_constant_velocity(u: Real, part: Real) -> Motion:
    """A quarter sine over 1/16, a quarter cosine over 3/16, and constant velocity over the middle half."""
    second = part > 0.5
    x, part = np.where(second, 1.0 - u, u), np.where(second, 1.0 - part, part)
    zones = [part <= 1 / 16, part <= 1 / 4]
    pi = math.pi
    first, t = 8 * pi * x, 8 * pi / 3 * (x - 1 / 16)
    s1 = (1 / 16 - 1 / (8 * pi)) / (8 * pi)
    s2 = s1 + 3 / (128 * pi) + 9 / (64 * pi**2)
    peak = 0.5 / (s2 + 1 / (8 * pi))
    s = [
        (x - np.sin(first) / (8 * pi)) / (8 * pi),
        s1 + (x - 1 / 16) / (8 * pi) + 9 / (64 * pi**2) * (1 - np.cos(t)),
    ]
    v = [(1 - np.cos(first)) / (8 * pi), 1 / (8 * pi) + 3 / (8 * pi) * np.sin(t)]
    none = np.zeros_like(x)
    half = (
        peak * np.select(zones, s, s2 + (x - 1 / 4) / (2 * pi)),
        peak * np.select(zones, v, np.full_like(x, 1 / (2 * pi))),
        peak * np.select(zones, [np.sin(first), np.cos(t)], none),
        peak * np.select(zones, [8 * pi * np.cos(first), -8 * pi / 3 * np.sin(t)], none),
    )
    return _mirrored(half, second)
