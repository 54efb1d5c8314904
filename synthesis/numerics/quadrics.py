"""Common points of m − 1 quadrics in projective space of m coordinates: all 2^(m−1), with a proof of completeness.

Multiplied by all monomials of degree m − 2, the quadrics are linear equations for the monomials of degree m (Macaulay).
If the quadrics meet in points only, the solutions have dimension 2^(m−1) (Bézout) and are spanned by the monomials at
the common points. Multiplication by two linear forms, l₁ · monomial and l₂ · monomial for those of degree m − 1, is
then an eigenvalue problem whose eigenvectors are the common points (Cox, Little & O'Shea, Using Algebraic Geometry,
2.4). No coordinate is singled out, so that points at infinity need no special case.

Newton's method refines each point, and the Newton–Kantorovich theorem decides whether it is a simple root in a ball
that contains no other. If 2^(m−1) such balls are disjoint, they contain all roots.
"""

from __future__ import annotations

import math
from functools import cache
from itertools import combinations_with_replacement
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Numbers, Real

DEGENERACY_TOLERANCE = 1e-11
"""Relative singular value of the monomial equations below which the quadrics have a whole curve in common."""

MAX_NEWTON_STEPS = 6
"""Maximum number of Newton steps; eigenvectors of simple roots already have ten digits or more."""

IMAGINARY_TOLERANCE = 1e-4
"""Imaginary part of a unit vector below which a real root is searched nearby. From data of 16 digits a double root
keeps half of the digits, a triple root a third."""

CLUSTER_TOLERANCE = 1e-5
"""Assumed radius of a cluster of roots that cannot be proved individually."""

ROUNDING_ERROR = 4e-15
"""Error of a computed residual: a few tens of rounding errors of numbers of size 1."""

RESIDUAL_TOLERANCE = 1e-13
"""Residual up to which a real point counts as common to all quadrics without proof. Such a point is a double root,
which exists or disappears if the data change by a few rounding errors."""

MIN_NORM = 1e-150
"""Substitute for a singular value that may be zero; its square does not underflow."""

DIRECTION_TOLERANCE = 1e-14
"""Maximum 1 − |cos| between two unit vectors that are the same point, found twice: a few rounding errors."""


class CommonPoints(NamedTuple):
    """Common points of quadrics.

    Attributes
    ----------
    real : float64, shape (k, m)
        Real common points as unit vectors, each once.
    double : bool, shape (k,)
        Whether a point is not proved to be simple: to rounding two or more common points coincide there.
    finite : bool
        Whether the quadrics meet in points only. Otherwise ``real`` is empty.
    unproved : complex128, shape (j, m)
        Unit vectors near those of the 2^(m−1) common points, complex ones included, that could not be proved to be
        simple and separate from the others. If it is empty, ``real`` is complete.
    """

    real: Real
    double: NDArray[np.bool_]
    finite: bool
    unproved: Complex


def find_common_points(forms: Real, error: float = 0.0) -> CommonPoints:
    """Compute the real common points of quadrics xᵀ Q x = 0.

    Parameters
    ----------
    forms : float64, shape (m − 1, m, m)
        Symmetric matrices Q of unit norm, 2 ≤ m ≤ 4.
    error : float
        Norm of the matrices' error beyond rounding. The proofs hold for all quadrics within this distance.
    """
    m = forms.shape[-1]
    frame = _build_frame(m)
    equations = np.zeros((len(frame.shift) * (m - 1), frame.monomials))
    for j, q in enumerate(forms):
        coefficients = q[frame.rows, frame.columns] * frame.twice
        for i, places in enumerate(frame.shift):
            equations[j * len(frame.shift) + i, places] = coefficients
    _, s, vh = np.linalg.svd(equations)
    roots = 2 ** (m - 1)
    # A null space larger than the number of roots means that the quadrics share a curve.
    if s[frame.monomials - roots - 1] <= DEGENERACY_TOLERANCE * s[0]:
        return CommonPoints(np.empty((0, m)), np.empty(0, np.bool_), False, np.empty((0, m), np.complex128))
    # Basis of the null space: combinations of the monomials' values at the common points.
    basis = vh[frame.monomials - roots :].T
    above = np.tensordot(frame.first, basis[frame.lift], (0, 1))
    below = np.tensordot(frame.second, basis[frame.lift], (0, 1))
    # The eigenvectors of multiplication by one linear form relative to another are the common points.
    _, vectors = np.linalg.eig(np.linalg.lstsq(below, above, rcond=None)[0])
    monomials = basis @ vectors
    # Read each point from the monomials x_i^(m−1) x_j of its largest coordinate i, which cannot be 0.
    largest = np.abs(monomials[frame.powers]).argmax(axis=0)
    points = monomials[frame.lines[largest], np.arange(roots)[:, None]]
    return _refine_points(forms, points, error)


class _MonomialFrame(NamedTuple):
    """Indices that describe the linear equations of the monomials, for quadrics in m coordinates.

    ``rows``, ``columns`` and ``twice`` list the products of two coordinates and their factors in a quadratic form,
    ``shift`` is the index of each such product times a multiplier of degree m − 2, and ``lift`` that of a coordinate
    times a monomial of degree m − 1. ``powers`` and ``lines`` are the indices of x_i^m and x_i^(m−1) x_j, ``first`` and
    ``second`` two linear forms in general position.
    """

    monomials: int
    rows: NDArray[np.intp]
    columns: NDArray[np.intp]
    twice: Real
    shift: NDArray[np.intp]
    lift: NDArray[np.intp]
    powers: NDArray[np.intp]
    lines: NDArray[np.intp]
    first: Real
    second: Real


@cache
def _build_frame(m: int) -> _MonomialFrame:
    """Build the indices for m coordinates; see :class:`_MonomialFrame`."""
    place = {mono: k for k, mono in enumerate(combinations_with_replacement(range(m), m))}
    squares = list(combinations_with_replacement(range(m), 2))
    multipliers = list(combinations_with_replacement(range(m), m - 2))
    lower = list(combinations_with_replacement(range(m), m - 1))

    def index_product(*factors: tuple[int, ...]) -> int:
        return place[tuple(sorted(sum(factors, ())))]

    angles = 1.0 + 2.0 * np.arange(m)  # linear forms in general position
    return _MonomialFrame(
        monomials=len(place),
        rows=np.array([i for i, _ in squares]),
        columns=np.array([j for _, j in squares]),
        twice=np.array([1.0 if i == j else 2.0 for i, j in squares]),
        shift=np.array([[index_product(mono, square) for square in squares] for mono in multipliers]),
        lift=np.array([[index_product(mono, (i,)) for mono in lower] for i in range(m)]).T,
        powers=np.array([place[(i,) * m] for i in range(m)]),
        lines=np.array([[index_product((i,) * (m - 1), (j,)) for j in range(m)] for i in range(m)]),
        first=np.cos(angles),
        second=np.sin(angles * math.sqrt(2.0)),
    )


def _refine_points(forms: Real, points: Numbers, error: float) -> CommonPoints:
    """Refine each point by Newton's method, nearly real ones in real arithmetic, and prove which roots are simple."""
    m = forms.shape[-1]
    points = _iterate_newton(forms, points / np.linalg.norm(points, axis=1)[:, None])
    # Rotate the phase so that the largest coordinate is real: a real point then has no imaginary part.
    pivot = np.take_along_axis(points, np.abs(points).argmax(axis=1)[:, None], axis=1)
    points = points * (np.conj(pivot) / np.abs(pivot))
    nearly = np.abs(points.imag).max(axis=1) <= IMAGINARY_TOLERANCE
    reals = points[nearly].real
    reals = _iterate_newton(forms, reals / np.linalg.norm(reals, axis=1)[:, None])
    real_radius, real_alone, residual = _certify_roots(forms, reals, error)
    radius, alone, _ = _certify_roots(forms, points[~nearly], error)
    imaginary = np.abs(points[~nearly].imag).max(axis=1)
    everywhere = np.concatenate([reals, points[~nearly]])
    apart = _mark_separated(everywhere, np.concatenate([real_radius, radius]))
    # A complex root is proved complex if its imaginary part exceeds the radius of its ball.
    proved = apart & np.concatenate([real_alone, alone & (imaginary > radius)])
    kept: list[int] = []
    for k in np.flatnonzero(real_alone | (residual <= RESIDUAL_TOLERANCE)):
        # ±x are the same projective point, so take the absolute value.
        gaps = [1.0 - abs(float(reals[k] @ reals[j])) for j in kept]
        if min(gaps, default=1.0) > DIRECTION_TOLERANCE:
            kept.append(int(k))
    double = ~proved[: len(reals)][kept]
    real = reals[kept].reshape(-1, m).astype(np.float64)
    return CommonPoints(real, double, True, everywhere[~proved].astype(np.complex128))


def _iterate_newton(forms: Real, points: Numbers) -> Numbers:
    """Run Newton's method on the unit sphere, with steps perpendicular to the point; return the best iterates."""
    best, least = points, np.full(len(points), np.inf)
    for step in range(MAX_NEWTON_STEPS + 1):
        images = np.einsum("qij,kj->kqi", forms, points)
        values = np.einsum("kqi,ki->kq", images, points)
        size = np.abs(values).max(axis=1, initial=0.0)
        better = size < least
        best = np.where(better[:, None], points, best)
        least = np.where(better, size, least)
        if step == MAX_NEWTON_STEPS or not len(points) or least.max() <= ROUNDING_ERROR / 8.0:
            break
        jacobian = np.concatenate([2.0 * images, np.conj(points)[:, None, :]], axis=1)
        right = np.concatenate([values, np.zeros((len(points), 1))], axis=1)
        u, s, vh = np.linalg.svd(jacobian)
        # Pseudoinverse: at a multiple root the Jacobian is singular, and its small singular values carry only noise.
        inverse = np.where(s > ROUNDING_ERROR, 1.0 / np.maximum(s, ROUNDING_ERROR), 0.0)
        move = np.einsum("kji,kj->ki", vh.conj(), inverse * np.einsum("kij,ki->kj", u.conj(), right))
        points = points - move
        points = points / np.linalg.norm(points, axis=1)[:, None]
    return best


def _certify_roots(forms: Real, points: Numbers, error: float) -> tuple[Real, NDArray[np.bool_], Real]:
    """Apply the Newton–Kantorovich theorem at unit vectors: return a radius that contains a root, whether it is proved,
    and the residual.

    With K a Lipschitz constant of the Jacobian J and η = |J⁻¹f|, a root lies within 2η where K|J⁻¹|η ≤ 1/2
    (Kantorovich; Ortega & Rheinboldt, 12.6.2).
    """
    # The last row of the Jacobian keeps the point on the sphere.
    images = np.einsum("qij,kj->kqi", forms, points)
    values = np.einsum("kqi,ki->kq", images, points)
    jacobian = np.concatenate([2.0 * images, np.conj(points)[:, None, :]], axis=1)
    least = np.linalg.svd(jacobian, compute_uv=False)[:, -1] if len(points) else np.empty(0)
    error *= math.sqrt(len(forms))
    # Subtract the possible error of the Jacobian, so that the proof holds for all quadrics within the error.
    least = np.maximum(least - 2.0 * error, MIN_NORM)
    residual = np.linalg.norm(values, axis=1)
    step = (residual + ROUNDING_ERROR + error) / least
    lipschitz = 2.0 * math.sqrt(len(forms))
    alone = lipschitz * step / least <= 0.5
    return np.where(alone, 2.0 * step, CLUSTER_TOLERANCE), alone, np.abs(values).max(axis=1, initial=0.0)


def _mark_separated(points: Complex, radius: Real) -> NDArray[np.bool_]:
    """Return a mask of the points whose projective distance from every other exceeds the sum of both radii."""
    closeness = np.minimum(np.abs(points.conj() @ points.T), 1.0)
    distance = np.sqrt(2.0 * (1.0 - closeness))
    np.fill_diagonal(distance, np.inf)
    # The cosine of two unit vectors gives their distance only to the square root of a rounding error.
    needed = np.maximum(radius[:, None] + radius[None, :], 3e-8)
    return np.asarray((distance > needed).all(axis=1), np.bool_)
