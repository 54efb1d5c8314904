"""Laws of cam motion: unit lift over unit angle, s(0) = 0 and s(1) = 1, exact in every derivative.

Most of the classical laws have an acceleration that rises as a quarter sine over p1, stays over p2, falls as a quarter
cosine over p3 and is zero up to the middle, with a mirrored second half (Norton, *Design of Machinery*, §8.3, the SCCA
family, widened by a stretch of constant velocity):

    =========================  =====  =====  =====
    law                        p1     p2     p3
    =========================  =====  =====  =====
    constant acceleration      0      1/2    0
    simple harmonic            0      0      1/2
    cycloidal                  1/4    0      1/4
    modified trapezoid         1/8    1/4    1/8
    modified sine              1/8    0      3/8
    modified constant velocity 1/16   0      3/16
    =========================  =====  =====  =====

With A the maximum acceleration, V = A (2 (p1 + p3)/π + p2) is the velocity in the middle, and A follows from
s(1/2) = 1/2. Half laws join a dwell to a constant velocity (Kloomok & Muffley; Rao, *Kinematics of Machinery*, §5.2).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType

import numpy as np

from kinematics.cam.motion.extremes import Extremes, find_extremes
from kinematics.cam.motion.pieces import Motion, Pieces, build_harmonic_piece, build_polynomial_pieces, join_pieces
from kinematics.errors import DimensionError

HALF_PI = 0.5 * math.pi


@dataclass(frozen=True, eq=False)
class Law:
    """A law of motion.

    Parameters
    ----------
    name : str
        Name of the law in requests.
    pieces : Pieces
        The motion from 0 to 1, with s(0) = 0 and s(1) = 1.
    """

    name: str
    pieces: Pieces

    def motion(self, at: float | list[float] | np.ndarray) -> Motion:
        """Return s, v, a, j at shares of the angle; at an inner jump the values after it."""
        return self.pieces.motion(at)

    @cached_property
    def factors(self) -> tuple[Extremes, Extremes, Extremes]:
        """Exact extremes of v, a, j within the law, excluding jumps at its ends.

        >>> [round(factor.largest, 6) for factor in LAWS["polynomial_345"].factors]
        [1.875, 5.773503, 60.0]

        The jerk is infinite where the acceleration jumps within the law, as in the middle of constant acceleration.
        """
        v, a = self.pieces.derivative(), self.pieces.derivative().derivative()
        jerk = a.derivative()
        extremes = [_find_extremes(f, self.pieces.start) for f in (v, a, jerk)]
        inner = self.pieces.start[1:-1]
        # A jump of the acceleration means infinite jerk, with the sign of the jump.
        jump = self.pieces.motion(inner).a - self.pieces.motion(inner, before=True).a
        if np.any(np.abs(jump) > MIN_JUMP * extremes[1].largest):
            down, up = float(inner[jump.argmin()]), float(inner[jump.argmax()])
            least = (-math.inf, down) if jump.min() < 0.0 else (extremes[2].least, extremes[2].at_least)
            greatest = (math.inf, up) if jump.max() > 0.0 else (extremes[2].greatest, extremes[2].at_greatest)
            extremes[2] = Extremes(least[0], greatest[0], least[1], greatest[1])
        return extremes[0], extremes[1], extremes[2]

    def reversed(self, name: str) -> Law:
        """Return 1 − s(1 − u): the law whose fall is the mirror image of this one's rise."""
        mirrored = self.pieces.reversed()
        return Law(name, mirrored.scale_to(1.0, -1.0, 1.0))


MIN_JUMP = 1e-9
"""Share of the maximum acceleration above which a step of the acceleration inside a law is a jump and not rounding."""


def _find_extremes(function: Pieces, breaks: np.ndarray) -> Extremes:
    """Find the extremes of the values of a function in pieces."""
    return find_extremes(lambda u: function.motion(u).s, breaks)


def build_sine_constant_cosine(name: str, p1: float, p2: float, p3: float) -> Law:
    """Build the law with a quarter sine over p1, constant acceleration over p2, a quarter cosine over p3 in each half.

    ``p1 + p2 + p3`` is at most 1/2; the remainder runs at constant velocity in the middle.
    """
    # The tolerance 1e-12 absorbs the rounding of fractions such as 1/16 + 3/16.
    rest = 0.5 - (p1 + p2 + p3)
    if min(p1, p2, p3) < 0.0 or rest < -1e-12 or p1 + p2 + p3 <= 0.0:
        raise DimensionError("kinematics-law-parts", "kinematics-shares-of-half", (p1, p2, p3))
    parts: list[tuple[float, list[float], tuple[float, float, float]]] = []
    # Integrate unit acceleration piece by piece; the lift is scaled to 1 at the end.
    s, v = 0.0, 0.0
    if p1 > 0.0:
        # A quarter sine over p1 has the frequency 1/k.
        k = p1 / HALF_PI
        parts.append((p1, [0.0, k], (-k * k, 1.0 / k, 0.0)))
        s, v = k * (p1 - k), k
    if p2 > 0.0:
        parts.append((p2, [s, v, 0.5], (0.0, 0.0, 0.0)))
        s, v = s + v * p2 + 0.5 * p2 * p2, v + p2
    if p3 > 0.0:
        k = p3 / HALF_PI
        parts.append((p3, [s + k * k, v], (-k * k, 1.0 / k, HALF_PI)))
        s, v = s + v * p3 + k * k, v + k
    if rest > 1e-12:
        parts.append((rest, [s, v], (0.0, 0.0, 0.0)))
        s += v * rest
    half = join_pieces([build_harmonic_piece(*part) for part in parts])
    # Scale the half to a rise of 1/2; the second half is its point reflection.
    first = half.scale_to(0.5, 0.5 / s)
    return Law(name, join_pieces([first, first.reversed().scale_to(0.5, -1.0, 1.0)]))


def build_polynomial_law(name: str, *coefficients: float) -> Law:
    """Build the law Σ c_k u^k, constant first."""
    return Law(name, build_polynomial_pieces([0.0, 1.0], [coefficients]))


RAMP_LENGTH = 1.0 / 8.0
"""Length of the linear ramps of the trapezoidal law, as a share of its angle."""


def _build_trapezoidal() -> Law:
    """Build constant acceleration with linear ramps at both ends of each half (Norton Fig. 8-14)."""
    flat = 0.5 - 2.0 * RAMP_LENGTH
    # The area of the acceleration trapezoid gives the velocity, and its integral the lift of 1/2.
    peak = 2.0 / (0.5 - RAMP_LENGTH)
    jerk = peak / RAMP_LENGTH
    v, s = 0.5 * peak * RAMP_LENGTH, peak * RAMP_LENGTH**2 / 6.0
    rows = [
        [0.0, 0.0, 0.0, jerk / 6.0],
        [s, v, 0.5 * peak, 0.0],
        [s + flat * (v + 0.5 * flat * peak), v + flat * peak, 0.5 * peak, -jerk / 6.0],
    ]
    first = build_polynomial_pieces(np.cumsum([0.0, RAMP_LENGTH, flat, RAMP_LENGTH]), rows)
    return Law("trapezoidal", join_pieces([first, first.reversed().scale_to(0.5, -1.0, 1.0)]))


def _build_laws() -> dict[str, Law]:
    pi = math.pi
    cosine = HALF_PI
    double = build_harmonic_piece(1.0, [0.375], (-0.5, pi, cosine), (0.125, 2.0 * pi, cosine))
    double_harmonic = Law("double_harmonic", double)
    # Kloomok and Muffley's P-1: the printed coefficients satisfy the end conditions exactly.
    eighth = build_polynomial_law("eighth_power", 0.0, 0.0, 0.0, 6.09755, 0.0, -20.78040, 26.73155, -13.60965, 2.56095)
    laws = [
        build_polynomial_law("constant_velocity", 0.0, 1.0),
        build_sine_constant_cosine("constant_acceleration", 0.0, 0.5, 0.0),
        Law("simple_harmonic", build_harmonic_piece(1.0, [0.5], (-0.5, pi, cosine))),
        Law("cycloidal", build_harmonic_piece(1.0, [0.0, 1.0], (-0.5 / pi, 2.0 * pi, 0.0))),
        _build_trapezoidal(),
        build_sine_constant_cosine("modified_trapezoid", 1.0 / 8.0, 1.0 / 4.0, 1.0 / 8.0),
        build_sine_constant_cosine("modified_sine", 1.0 / 8.0, 0.0, 3.0 / 8.0),
        build_sine_constant_cosine("modified_constant_velocity", 1.0 / 16.0, 0.0, 3.0 / 16.0),
        build_polynomial_law("polynomial_23", 0.0, 0.0, 3.0, -2.0),
        build_polynomial_law("polynomial_345", 0.0, 0.0, 0.0, 10.0, -15.0, 6.0),
        build_polynomial_law("polynomial_4567", 0.0, 0.0, 0.0, 0.0, 35.0, -84.0, 70.0, -20.0),
        build_polynomial_law("polynomial_456789", 0.0, 0.0, 0.0, 0.0, 0.0, 126.0, -420.0, 540.0, -315.0, 70.0),
        eighth,
        eighth.reversed("eighth_power_reversed"),
        double_harmonic,
        double_harmonic.reversed("double_harmonic_reversed"),
        Law("half_harmonic_start", build_harmonic_piece(1.0, [1.0], (-1.0, HALF_PI, cosine))),
        Law("half_harmonic_end", build_harmonic_piece(1.0, [0.0], (1.0, HALF_PI, 0.0))),
        Law("half_cycloidal_start", build_harmonic_piece(1.0, [0.0, 1.0], (-1.0 / pi, pi, 0.0))),
        Law("half_cycloidal_end", build_harmonic_piece(1.0, [0.0, 1.0], (1.0 / pi, pi, 0.0))),
    ]
    return {law.name: law for law in laws}


LAWS = MappingProxyType(_build_laws())
"""Every named law. ``*_start`` begins at rest and ends with a velocity, ``*_end`` the other way; a ``*_reversed`` law
gives the fall that mirrors the rise."""
