"""Functions in pieces: on each piece a polynomial and up to two harmonics of the distance x from its start,

    s(x) = Σ c_k x^k + Σ A_m sin(w_m x + φ_m).

Every law of cam motion is of this form, and so is each of its derivatives: all of them are evaluated by one kernel,
scaled, concatenated and searched for stationary points without regard to the law's name.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from kinematics.arrays import Real
from kinematics.compiling import njit
from kinematics.errors import DimensionError

MAX_HARMONICS = 2
"""Maximum number of sine terms of a piece; the double harmonic needs two."""

MOTION_VALUE_COUNT = 4
"""Number of values that the kernel returns at each point: s, v, a, j."""


class Motion(NamedTuple):
    """Displacement and its first three derivatives, arrays of one shape."""

    s: Real
    v: Real
    a: Real
    j: Real


@dataclass(frozen=True, eq=False)
class Pieces:
    """A function in n pieces.

    Parameters
    ----------
    start : float, shape (n + 1,)
        Start of each piece, ascending, and end of the last one.
    polynomial : float, shape (n, degree + 1)
        Coefficients c_k, constant first, of the distance from the piece's start.
    amplitude, frequency, phase : float, shape (n, 2)
        A_m, w_m, φ_m of the sine terms; unused terms have amplitude zero.
    """

    start: Real
    polynomial: Real
    amplitude: Real
    frequency: Real
    phase: Real

    @property
    def count(self) -> int:
        """Number of pieces."""
        return len(self.start) - 1

    @property
    def length(self) -> float:
        """Distance from the first start to the last end."""
        return float(self.start[-1] - self.start[0])

    def motion(self, at: ArrayLike, *, before: bool = False) -> Motion:
        """Return the values and the first three derivatives.

        Parameters
        ----------
        at : array_like
            Points of any shape. Outside the pieces the first or the last one is continued.
        before : bool
            At a joint, use the piece that ends there instead of the one that begins.
        """
        points = np.asarray(at, dtype=np.float64)
        values = np.empty((MOTION_VALUE_COUNT, points.size))
        flat = np.ascontiguousarray(points.reshape(-1))
        _evaluate(self.start, self.polynomial, self.amplitude, self.frequency, self.phase, flat, before, values)
        return Motion(*values.reshape(MOTION_VALUE_COUNT, *points.shape))

    def derivative(self) -> Pieces:
        """Return the derivative, again in pieces."""
        degree = self.polynomial.shape[1] - 1
        polynomial = self.polynomial[:, 1:] * np.arange(1, degree + 1) if degree else np.zeros((self.count, 1))
        # (A sin u)' = A w sin(u + π/2): the form of the pieces is preserved.
        amplitude = self.amplitude * self.frequency
        return Pieces(self.start, polynomial, amplitude, self.frequency, self.phase + 0.5 * math.pi)

    def scale_to(self, length: float, factor: float, constant: float = 0.0) -> Pieces:
        """Return constant + factor·s, stretched to a length and shifted to begin at zero."""
        stretch = length / self.length
        polynomial = factor * self.polynomial / stretch ** np.arange(self.polynomial.shape[1])
        polynomial[:, 0] += constant
        start = (self.start - self.start[0]) * stretch
        # Exact end: the product above may be off by rounding.
        start[-1] = length
        return Pieces(start, polynomial, factor * self.amplitude, self.frequency / stretch, self.phase)

    def reversed(self) -> Pieces:
        """Return s(start + end − t): the same function traversed from its end."""
        spans = np.diff(self.start)[::-1]
        start = self.start[0] + self.start[-1] - self.start[::-1]
        polynomial = _mirror_polynomial(self.polynomial[::-1], spans)
        amplitude, frequency, phase = self.amplitude[::-1], self.frequency[::-1], self.phase[::-1]
        # sin(w (L − y) + φ) = −sin(w y − φ − w L).
        return Pieces(start, polynomial, -amplitude, frequency, -(phase + frequency * spans[:, None]))


def build_polynomial_pieces(start: ArrayLike, coefficients: ArrayLike) -> Pieces:
    """Build a piecewise polynomial from breaks, shape (n + 1,), and local coefficients, shape (n, degree + 1)."""
    breaks, polynomial = np.array(start, dtype=np.float64), np.array(coefficients, dtype=np.float64)
    if polynomial.ndim != 2 or breaks.shape != (len(polynomial) + 1,) or not len(polynomial):
        raise DimensionError("breaks", "kinematics-one-more-than-rows", breaks.shape)
    if not (np.isfinite(breaks).all() and np.isfinite(polynomial).all() and (np.diff(breaks) > 0.0).all()):
        raise DimensionError("kinematics-breaks-and-coefficients", "kinematics-breaks-ascend", start)
    none = np.zeros((len(polynomial), MAX_HARMONICS))
    return Pieces(breaks, polynomial, none, none, none)


def build_harmonic_piece(length: float, polynomial: Sequence[float], *harmonics: tuple[float, float, float]) -> Pieces:
    """Build one piece from 0 to a length: polynomial coefficients and up to two (amplitude, frequency, phase)."""
    terms = np.zeros((MAX_HARMONICS, 3))
    terms[: len(harmonics)] = np.reshape(harmonics, (-1, 3))
    amplitude, frequency, phase = terms.T[:, None, :]
    return Pieces(np.array([0.0, length]), np.array([polynomial], dtype=np.float64), amplitude, frequency, phase)


def join_pieces(parts: Sequence[Pieces]) -> Pieces:
    """Concatenate functions, each shifted to begin at the end of its predecessor; the first begins at zero."""
    # Pad lower degrees with zeros, so that all pieces share one array.
    degree = max(part.polynomial.shape[1] for part in parts)
    ends = np.cumsum([0.0, *(part.length for part in parts)])
    starts = [part.start[:-1] - part.start[0] + end for part, end in zip(parts, ends, strict=False)]
    polynomial = [np.pad(part.polynomial, ((0, 0), (0, degree - part.polynomial.shape[1]))) for part in parts]
    return Pieces(
        np.concatenate([*starts, ends[-1:]]),
        np.concatenate(polynomial),
        np.concatenate([part.amplitude for part in parts]),
        np.concatenate([part.frequency for part in parts]),
        np.concatenate([part.phase for part in parts]),
    )


def _mirror_polynomial(polynomial: Real, spans: Real) -> Real:
    """Return the coefficients of p(L − y) from those of p(x), each row with its own L, by Horner's scheme."""
    mirrored = np.zeros_like(polynomial)
    for k in range(polynomial.shape[1] - 1, -1, -1):
        shifted = mirrored * spans[:, None]
        shifted[:, 1:] -= mirrored[:, :-1]
        shifted[:, 0] += polynomial[:, k]
        mirrored = shifted
    return mirrored


@njit(cache=True, nogil=True)
def _evaluate(
    start: Real, polynomial: Real, amplitude: Real, frequency: Real, phase: Real, at: Real, before: bool, values: Real
) -> None:
    """Fill s, v, a, j at each point: Taylor coefficients by repeated Horner, plus the sines."""
    last = start.size - 2
    terms = polynomial.shape[1]
    for i in range(at.size):
        low, high = 0, last
        while low < high:
            middle = (low + high + 1) // 2
            # Binary search; a point outside stays on the first or last piece, which is extrapolated.
            if start[middle] < at[i] or (not before and start[middle] == at[i]):
                low = middle
            else:
                high = middle - 1
        x = at[i] - start[low]
        s, v, a, j = 0.0, 0.0, 0.0, 0.0
        for k in range(terms - 1, -1, -1):
            j = j * x + a
            a = a * x + v
            v = v * x + s
            s = s * x + polynomial[low, k]
        # Horner yields Taylor coefficients s″/2 and s‴/6.
        a, j = 2.0 * a, 6.0 * j
        for m in range(amplitude.shape[1]):
            size = amplitude[low, m]
            # Unused harmonics have amplitude 0; skip their sine and cosine.
            if size != 0.0:
                w = frequency[low, m]
                turn = w * x + phase[low, m]
                sine, cosine = math.sin(turn), math.cos(turn)
                s += size * sine
                v += size * w * cosine
                a -= size * w * w * sine
                j -= size * w * w * w * cosine
        values[0, i], values[1, i], values[2, i], values[3, i] = s, v, a, j
