"""One cylinder: the piston's motion, exact and by two terms, its harmonics, and the two-mass model of its rod.

With the crank r at θ from top dead centre and the rod l, λ = r/l, the piston stands at x = r cos θ + √(l² − r² sin² θ)
(Norton, *Design of Machinery*, eq. 13.1d). Two terms keep a = −r ω² (cos θ + λ cos 2θ) (13.3). Exactly,

    −a/(r ω²) = cos θ + Σ A₂ₘ cos 2mθ,    A₂ₘ = (2m)² (−1)ᵐ Σ_{j ≥ m} b_j λ^(2j−1) 2^(1−2j) C(2j, j−m),

with b_j = (−1)^j C(½, j), from the binomial series of the root (13.2f) and the Fourier series of sin^(2j) θ.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics.arrays import Real

SERIES_TOLERANCE = 1e-18
"""Terms of the series below this share of the first are neglected."""

MAX_TERMS = 20_000
"""Maximum number of terms of the series: enough for a rod 0.1 % longer than the crank."""


def compute_binomial_terms(ratio: float, count: int) -> list[float]:
    """Compute the sizes of the terms of √(1 − λ² sin² θ) in (sin θ)^2, ^4, ...: |b_j| λ^(2j) (Norton, eq. 13.2f)."""
    terms, b = [], 1.0
    for j in range(1, count + 1):
        b *= (j - 1.5) / j
        terms.append(abs(b) * ratio ** (2 * j))
    return terms


def compute_acceleration_harmonics(ratio: float, order: int, *, two_term: bool = False) -> dict[int, float]:
    """Compute A_k of −a/(r ω²) = Σ A_k cos kθ for k = 1 and the even orders up to ``order``.

    Parameters
    ----------
    ratio : float
        r/l, below 1.
    two_term : bool
        Use only cos θ + λ cos 2θ, the usual approximation.

    Examples
    --------
    >>> round(compute_acceleration_harmonics(1.0 / 3.5, 4)[2], 10)
    0.2917795398
    """
    found = {1: 1.0}
    for k in range(2, order + 1, 2):
        if two_term:
            found[k] = ratio if k == 2 else 0.0
            continue
        m = k // 2
        # The first term, j = m: b_m λ^(2m−1) 2^(1−2m); C(2m, 0) = 1.
        b = 1.0
        for j in range(1, m + 1):
            b *= (j - 1.5) / j
        term = b * ratio ** (2 * m - 1) * 2.0 ** (1 - 2 * m)
        total, first = 0.0, abs(term)
        for j in range(m, m + MAX_TERMS):
            total += term
            if abs(term) <= SERIES_TOLERANCE * first:
                break
            # From j to j + 1: b gains (j − ½)/(j + 1), the binomial (2j+2)(2j+1)/((j+1−m)(j+1+m)).
            term *= (j - 0.5) / (j + 1) * ratio**2 / 4.0
            term *= (2 * j + 2) * (2 * j + 1) / ((j + 1 - m) * (j + 1 + m))
        found[k] = k**2 * (-1.0) ** m * total
    return found


class Motion(NamedTuple):
    """Motion of a piston.

    ``place`` is its distance from the crankshaft, ``slope`` and ``bend`` are the first and second derivatives by the
    crank angle, and ``lean`` is tan φ of the rod.
    """

    place: Real
    slope: Real
    bend: Real
    lean: Real


def compute_piston_motion(angle: Real, crank: float, rod: float, *, two_term: bool = False) -> Motion:
    """Compute the motion of a piston at crank angles after top dead centre, radians.

    ``two_term`` selects the approximations of Norton's eq. 13.3 and, for tan φ, eq. 13.7d.
    """
    # λ = r/l governs how far the rod's obliquity matters.
    sine, cosine, ratio = np.sin(angle), np.cos(angle), crank / rod
    if two_term:
        place = rod - crank * ratio / 4.0 + crank * (cosine + ratio / 4.0 * np.cos(2.0 * angle))
        slope = -crank * (sine + ratio / 2.0 * np.sin(2.0 * angle))
        bend = -crank * (cosine + ratio * np.cos(2.0 * angle))
        return Motion(place, slope, bend, ratio * sine * (1.0 + 0.5 * ratio**2 * sine**2))
    # Projection of the rod on the cylinder's axis.
    root = np.sqrt(rod**2 - (crank * sine) ** 2)
    lean = crank * sine / root
    slope = -crank * sine - lean * crank * cosine
    leaning = crank * cosine * rod**2 / root**3
    bend = -crank * cosine - leaning * crank * cosine + lean * crank * sine
    return Motion(crank * cosine + root, slope, bend, lean)


class Rod(NamedTuple):
    """A connecting rod as two masses at its pins, and the missing moment of inertia (Norton, eq. 13.10)."""

    crank_pin: float
    wrist_pin: float
    excess: float


def build_two_mass_rod(length: float, mass: float, cg: float, inertia: float | None) -> Rod:
    """Build the two-mass model of a rod whose centre of gravity is ``cg`` from the crank pin.

    ``excess`` is I − m l_a l_b, usually negative: the inertia of the exact rod beyond its two masses; 0 if I is None.
    """
    # Two masses with the rod's mass and centre of gravity have this moment of inertia.
    own = mass * cg * (length - cg)
    return Rod(mass * (length - cg) / length, mass * cg / length, 0.0 if inertia is None else inertia - own)
