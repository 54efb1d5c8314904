"""Piecewise polynomials: values, derivatives and exact extremes.

On each piece the polynomial is stored in powers of the piece's own x = (t − t_k)/h_k, 0 ≤ x ≤ 1. Its Bernstein
coefficients bound it there, because a polynomial lies in their convex hull. An extreme is therefore only searched in
the few pieces with a hull that exceeds the best value found. The mean of a convex function over the coefficients is an
upper bound of its integral (Farin, *Curves and Surfaces for CAGD*, ch. 5).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from kinematics.arrays import Real

IMAGINARY_TOLERANCE = 1e-7
"""Maximum imaginary part of a root that counts as real: a double root splits by the square root of rounding."""


ROUNDING_TOLERANCE = 1e-13
"""Minimum excess of a hull over the best value, as a share, for a search of its piece. Without it, every piece of a
plateau would be searched."""


@dataclass(frozen=True)
class Piecewise:
    """A piecewise polynomial on [breaks[0], breaks[-1]].

    Parameters
    ----------
    breaks : float64, shape (n + 1,)
        Increasing.
    coefficients : float64, shape (n, degree + 1)
        Coefficients of 1, x, x², ... on each piece.
    """

    breaks: Real
    coefficients: Real

    @property
    def steps(self) -> Real:
        """Lengths of the pieces, shape (n,)."""
        return np.diff(self.breaks)

    def __call__(self, t: Real | float) -> Real:
        """Return the value at t; at an inner break, that of the piece that begins there."""
        at = np.asarray(t, np.float64)
        piece = np.clip(np.searchsorted(self.breaks, at, side="right") - 1, 0, len(self.coefficients) - 1)
        x = (at - self.breaks[piece]) / self.steps[piece]
        value = np.zeros_like(at)
        # Horner's rule in the piece's own variable.
        for k in range(self.coefficients.shape[1] - 1, -1, -1):
            value = value * x + self.coefficients[piece, k]
        return value

    def derivative(self) -> Piecewise:
        """Return the derivative with respect to t, piece by piece."""
        degree = self.coefficients.shape[1] - 1
        if degree == 0:
            return Piecewise(self.breaks, np.zeros_like(self.coefficients))
        powers = np.arange(1, degree + 1)
        return Piecewise(self.breaks, self.coefficients[:, 1:] * powers / self.steps[:, None])

    def bernstein(self) -> Real:
        """Return the Bernstein coefficients of each piece, shape (n, degree + 1)."""
        degree = self.coefficients.shape[1] - 1
        # The matrix C(j, k)/C(n, k) converts powers of x to Bernstein coefficients.
        change = np.array(
            [
                [math.comb(j, k) / math.comb(degree, k) if k <= j else 0.0 for k in range(degree + 1)]
                for j in range(degree + 1)
            ]
        )
        return np.asarray(self.coefficients @ change.T)

    def maximum(self) -> tuple[float, float]:
        """Return the maximum value and its place (the one-sided limit if the polynomial jumps there)."""
        at_start = self.coefficients[:, 0]
        at_end = self.coefficients.sum(axis=1)
        k = int(np.argmax(at_start))
        best, where = float(at_start[k]), float(self.breaks[k])
        k = int(np.argmax(at_end))
        if at_end[k] > best:
            best, where = float(at_end[k]), float(self.breaks[k + 1])
        hull = self.bernstein().max(axis=1)
        slope = self.coefficients[:, 1:] * np.arange(1, self.coefficients.shape[1])
        # Highest hull first: as soon as one does not exceed the best value, none of the rest can.
        for k in np.argsort(-hull):
            if hull[k] <= best + ROUNDING_TOLERANCE * abs(best):
                break
            for root in np.roots(np.trim_zeros(slope[k], "b")[::-1]):
                if abs(root.imag) <= IMAGINARY_TOLERANCE and 0.0 < root.real < 1.0:
                    value = float(np.polynomial.polynomial.polyval(root.real, self.coefficients[k]))
                    if value > best:
                        best, where = value, float(self.breaks[k] + root.real * self.steps[k])
        return best, where

    def minimum(self) -> tuple[float, float]:
        """Return the minimum value and its place."""
        value, where = Piecewise(self.breaks, -self.coefficients).maximum()
        return -value, where

    def peak(self) -> float:
        """Return the maximum magnitude."""
        return max(self.maximum()[0], -self.minimum()[0])

    def rms(self) -> float:
        """Return the exact root mean square."""
        n = self.coefficients.shape[1]
        # The Gram (Hilbert) matrix holds ∫ xⁱ xʲ dx over a piece.
        gram = 1.0 / (np.arange(n)[:, None] + np.arange(n)[None, :] + 1.0)
        squares = np.einsum("pi,ij,pj->p", self.coefficients, gram, self.coefficients)
        return math.sqrt(max(float(squares @ self.steps), 0.0) / float(self.breaks[-1] - self.breaks[0]))

    def convex_integral(self, function: Callable[[Real], Real]) -> float:
        """Return an upper bound of ∫ f(p(t)) dt for a convex f; exact if f is linear on every piece's range."""
        return float(function(self.bernstein()).mean(axis=1) @ self.steps)
