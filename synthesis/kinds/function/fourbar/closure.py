"""Loop closure of function generators as a cubic in projective space.

Fourbar, ground 1, input a at φ₀ + φ and output c at ψ₀ + ψ from the ground line, coupler b (Freudenstein 1955,
doi:10.1115/1.4014485):

    K₁ cos(ψ₀ + ψ) − K₂ cos(φ₀ + φ) + K₃ = cos(φ₀ − ψ₀ + φ − ψ),   K₁ = 1/a, K₂ = 1/c, K₃ = (1 + a² + c² − b²)/2ac.

With expanded angle sums, a pair (φ, ψ) is one linear equation in seven numbers v = (p, q, r, m), where p, q and m
represent two real ones each,

    (cos ψ, sin ψ, cos φ, sin φ, 1, cos(φ − ψ), sin(φ − ψ)) · v = 0,
    p = K₁ e^{−iψ₀},  q = −K₂ e^{−iφ₀},  r = K₃,  m = −e^{−i(φ₀ − ψ₀)},

up to a common factor. Seven such numbers represent a linkage if m and q p̄ are parallel, Im(m q̄ p) = 0; they then
determine it. Fourbars are the points of a cubic hypersurface of P⁶: five pairs intersect it in three points, four in a
cubic curve, and so on. A given zero adds one linear equation, Im(p e^{iψ₀}) = 0 or Im(q e^{iφ₀}) = 0; both together
turn the cubic into the linear equation Im(m e^{i(φ₀ − ψ₀)}) = 0.

Slider-crank, crank a at θ₀ + φ from the slide's direction, coupler b, the slide at distance e to the left of the pivot,
B at s₀ + σ along it:  b² = (s − a cos θ)² + (e − a sin θ)² becomes, in the same way,

    (σ cos φ, σ sin φ, cos φ, sin φ, 1, σ, σ²) · (u, w, r, t, z) = 0,
    u = 2a e^{−iθ₀},  w = 2a e^{−iθ₀} (s₀ + i e),  r = b² − a² − e² − s₀²,  t = −2 s₀,  z = −1,

on the cubic 2 z Re(w ū) = t |u|².
"""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real

UNKNOWN_COUNT = 7

MIN_LENGTH = 1e-9
"""Minimum norm of a part of a cubic point, relative to the whole; below it a link has zero or infinite length."""


class Closure(Protocol):
    """Interface of a type of linkage."""

    def rows(self, inputs: Real, outputs: Real) -> Real:
        """Return the equations of pairs, radians and radians or stroke units: shape (..., n) gives (..., n, 7)."""

    def zero_rows(self, zeros: tuple[float | None, float | None]) -> Real:
        """Return the equations of the given zeros: one each, and a third, replacing the cubic, if both are given."""

    def cubic(self, v: Real) -> Real:
        """Return the cubic form at points of shape (..., 7)."""

    def dimensions(self, v: Real) -> Real:
        """Return the five dimensions of points on the cubic, shape (..., 5); NaN if a length is zero or infinite.

        Fourbar: a, b, c, φ₀, ψ₀ with ground 1. Slider-crank: a, b, e, θ₀, s₀.
        """


def _to_complex(v: Real, first: int) -> NDArray[np.complex128]:
    return np.asarray(v[..., first] + 1j * v[..., first + 1])


class FourbarClosure:
    """Freudenstein's equation."""

    def rows(self, inputs: Real, outputs: Real) -> Real:
        """See :class:`Closure`."""
        apart = inputs - outputs
        columns = [np.cos(outputs), np.sin(outputs), np.cos(inputs), np.sin(inputs), np.ones_like(apart)]
        return np.stack([*columns, np.cos(apart), np.sin(apart)], axis=-1)

    def zero_rows(self, zeros: tuple[float | None, float | None]) -> Real:
        """Return the rows of :class:`Closure`, with Im(z e^{iα}) = y cos α + x sin α."""
        phi, psi = zeros
        found = []
        if psi is not None:
            found.append([math.sin(psi), math.cos(psi), 0.0, 0.0, 0.0, 0.0, 0.0])
        if phi is not None:
            found.append([0.0, 0.0, math.sin(phi), math.cos(phi), 0.0, 0.0, 0.0])
        if phi is not None and psi is not None:
            found.append([0.0, 0.0, 0.0, 0.0, 0.0, math.sin(phi - psi), math.cos(phi - psi)])
        return np.array(found).reshape(-1, UNKNOWN_COUNT)

    def cubic(self, v: Real) -> Real:
        """See :class:`Closure`."""
        return np.asarray((_to_complex(v, 5) * _to_complex(v, 2).conj() * _to_complex(v, 0)).imag)

    def dimensions(self, v: Real) -> Real:
        """See :class:`Closure`."""
        p, q, m = _to_complex(v, 0), _to_complex(v, 2), _to_complex(v, 5)
        # A projective point has no sign: choose the one for which m = −e^{…}.
        sign = np.where((m * (q * p.conj()).conj()).real >= 0.0, 1.0, -1.0)
        size = np.linalg.norm(v, axis=-1)
        # p, q and m belong to links: if one vanishes, a length is zero or infinite.
        sound = np.minimum(np.minimum(np.abs(p), np.abs(q)), np.abs(m)) > MIN_LENGTH * size
        with np.errstate(divide="ignore", invalid="ignore"):
            a, c = np.abs(m) / np.abs(p), np.abs(m) / np.abs(q)
            psi, phi = -np.angle(sign * p), -np.angle(-sign * q)
            b = np.sqrt(1.0 + a * a + c * c - 2.0 * a * c * sign * v[..., 4] / np.abs(m))
        found = np.stack([a, b, c, phi, psi], axis=-1)
        # Rounding can leave a vanishing coupler slightly positive.
        return np.where((sound & (b > MIN_LENGTH * np.maximum(a, c)))[..., None], found, np.nan)


class SliderClosure:
    """The slider-crank's equation."""

    def rows(self, inputs: Real, outputs: Real) -> Real:
        """See :class:`Closure`."""
        cos, sin = np.cos(inputs), np.sin(inputs)
        columns = [outputs * cos, outputs * sin, cos, sin, np.ones_like(cos), outputs, outputs**2]
        return np.stack(columns, axis=-1)

    def zero_rows(self, zeros: tuple[float | None, float | None]) -> Real:
        """Return the rows of :class:`Closure`; both zeros also give Re(w e^{iθ₀}) = s₀ Re(u e^{iθ₀})."""
        theta, s = zeros
        found = []
        if theta is not None:
            found.append([math.sin(theta), math.cos(theta), 0.0, 0.0, 0.0, 0.0, 0.0])
        if s is not None:
            found.append([0.0, 0.0, 0.0, 0.0, 0.0, 1.0, -2.0 * s])
        if theta is not None and s is not None:
            cos, sin = math.cos(theta), math.sin(theta)
            found.append([-s * cos, s * sin, cos, -sin, 0.0, 0.0, 0.0])
        return np.array(found).reshape(-1, UNKNOWN_COUNT)

    def cubic(self, v: Real) -> Real:
        """See :class:`Closure`."""
        u, w = _to_complex(v, 0), _to_complex(v, 2)
        return np.asarray(2.0 * v[..., 6] * (w * u.conj()).real - v[..., 5] * np.abs(u) ** 2)

    def dimensions(self, v: Real) -> Real:
        """See :class:`Closure`."""
        sound = np.minimum(np.hypot(v[..., 0], v[..., 1]), np.abs(v[..., 6])) > MIN_LENGTH * np.linalg.norm(v, axis=-1)
        with np.errstate(divide="ignore", invalid="ignore"):
            # Scale the projective point so that z = −1, as in the definition of the seven numbers.
            v = v / -v[..., 6:]
            u, w = _to_complex(v, 0), _to_complex(v, 2)
            a, theta, s = 0.5 * np.abs(u), -np.angle(u), -0.5 * v[..., 5]
            # w/u = s₀ + i e.
            e = (w / u).imag
            b = np.sqrt(v[..., 4] + a * a + e * e + s * s)
        found = np.stack([a, b, e, theta, s], axis=-1)
        return np.where((sound & (b > MIN_LENGTH * a))[..., None], found, np.nan)


FOURBAR, SLIDER = FourbarClosure(), SliderClosure()


def select_closure(slides: bool) -> Closure:
    """Return the closure of a fourbar or a slider-crank."""
    return SLIDER if slides else FOURBAR
