"""Dyads fitted to many poses at once by linear algebra.

The condition that a body point α keeps its distance from a fixed point O is linear in eight products of the dyad's
numbers. For a pose p = x + iy, φ, and with q = conj(p) e^{iφ},

    a|p|² + Re(u q) + Re(conj(v) p) + Re(c e^{iφ}) + k = 0,    u = 2aα,  v = −2aO,  c = −2a conj(O) α,

so that 2ac = conj(v) u. Sliders are included: a = 0 and u = 0 is a PR dyad, a = 0 and v = 0 an RP dyad. In planar
quaternions these are the quadrics of a dyad's constraint manifold (Ge, Purwar, Zhao & Deshpande, J. Comput. Inf. Sci.
Eng. 16 (2016) 041004, doi:10.1115/1.4033252). Each pose gives one row of a matrix. Five poses leave a three-dimensional
null space; for more poses the three smallest singular vectors replace it. The two real quadrics 2ac = conj(v) u
intersect in that projective plane in at most four points: the dyads.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real

REAL_ROOT_TOLERANCE = 1e-6
"""Maximum imaginary part, relative to 1 + |root|, of a real root of the quartic; wide, because starts may be rough."""

MIN_CURVATURE = 1e-9
"""Minimum |a| of a dyad with unit coefficients; below it a pivot is so far away that the dyad is a slider."""


def fit_dyads(points: Complex, angles: Real) -> tuple[Complex, Complex]:
    """Find dyads (O, α) through sets of five poses, or near larger sets.

    Parameters
    ----------
    points, angles : complex and float, shape (sets, m), m ≥ 5
        Poses of each set.

    Returns
    -------
    fixed, moving : complex, shape (found,)
        Fixed pivots, and moving pivots in the pose (0, 0), of all sets together, at most four per set. Dyads with a
        pivot at infinity are left out.
    """
    q = np.conj(points) * np.exp(1j * angles)
    rows = np.stack(
        [
            np.abs(points) ** 2,
            q.real,
            q.imag,
            points.real,
            points.imag,
            np.cos(angles),
            np.sin(angles),
            np.ones_like(angles),
        ],
        axis=-1,
    )
    # Five rows of eight coefficients: the last three right singular vectors span the (approximate) null space.
    basis = np.linalg.svd(rows)[2][:, -3:, :]
    # Rotate the basis by a fixed generic rotation, so that a dyad has last coordinate zero only by chance.
    basis = np.einsum("ij,sjk->sik", _BASIS_ROTATION, basis)
    a, c = basis[..., 0].astype(np.complex128), basis[..., 5] - 1j * basis[..., 6]
    u, v = basis[..., 1] - 1j * basis[..., 2], basis[..., 3] + 1j * basis[..., 4]
    form = 2.0 * a[:, :, None] * c[:, None, :] - np.conj(v)[:, :, None] * u[:, None, :]
    # Only the symmetric part of a quadratic form has a meaning.
    form = 0.5 * (form + np.swapaxes(form, 1, 2))
    x, y, which = _intersect_conics(form.real, form.imag)
    k = np.einsum("nd,ndk->nk", np.stack([x, y, np.ones_like(x)], axis=1), basis[which])
    # Unit coefficients make the limit of the curvature independent of the scale of x and y.
    k /= np.linalg.norm(k, axis=1, keepdims=True)
    finite = np.abs(k[:, 0]) > MIN_CURVATURE
    k = k[finite]
    twice = 2.0 * k[:, 0]
    return -(k[:, 3] + 1j * k[:, 4]) / twice, (k[:, 1] - 1j * k[:, 2]) / twice


_BASIS_ROTATION = np.linalg.qr(np.array([[1.0, 0.7, -0.4], [-0.3, 1.0, 0.9], [0.6, -0.8, 1.0]]))[0]


def _intersect_conics(first: Real, second: Real) -> tuple[Real, Real, NDArray[np.int64]]:
    """Intersect conics in the plane z = 1: return x, y and the set of each point; symmetric forms (sets, 3, 3)."""
    # Each form is A y² + (B x + D) y + (C x² + E x + F); the resultant in y is a quartic in x.
    (a1, b1, c1), (a2, b2, c2) = _split_powers(first), _split_powers(second)
    ac = _subtract(_multiply(a1, c2), _multiply(a2, c1))
    ab = _subtract(_multiply(a1, b2), _multiply(a2, b1))
    bc = _subtract(_multiply(b1, c2), _multiply(b2, c1))
    # The resultant of two quadratics in y is (ac)² − (ab)(bc) with these two-by-two determinants.
    quartic = _subtract(_multiply(ac, ac), _multiply(ab, bc))
    # The roots are the eigenvalues of the companion matrix; a vanishing leading coefficient would make it infinite.
    leading = quartic[:, 0]
    # Below the root of the smallest number, the quotients could overflow.
    sound = np.abs(leading) > np.finfo(float).tiny ** 0.5
    which = np.flatnonzero(sound)
    companion = np.zeros((len(which), 4, 4))
    companion[:, 0, :] = -quartic[which, 1:] / leading[which, None]
    companion[:, [1, 2, 3], [0, 1, 2]] = 1.0
    roots = np.linalg.eigvals(companion)
    x = roots.real
    real = np.abs(roots.imag) <= REAL_ROOT_TOLERANCE * (1.0 + np.abs(x))
    s, n = np.nonzero(real)
    x, which = x[s, n], which[s]
    numerator = np.array([np.polyval(ac[k], at) for k, at in zip(which, x, strict=True)])
    denominator = np.array([np.polyval(ab[k], at) for k, at in zip(which, x, strict=True)])
    # y follows from eliminating y²; where the denominator vanishes the two points share x and are given up.
    with np.errstate(divide="ignore", invalid="ignore"):
        y = -numerator / denominator
    good = np.isfinite(y)
    return x[good], y[good], which[good]


def _split_powers(form: Real) -> tuple[Real, Real, Real]:
    """Return the coefficients of y², y, 1 as polynomials in x, highest power first: (sets, 1), (sets, 2), (sets, 3)."""
    return (
        form[:, 1:2, 1],
        2.0 * np.stack([form[:, 0, 1], form[:, 1, 2]], axis=1),
        np.stack([form[:, 0, 0], 2.0 * form[:, 0, 2], form[:, 2, 2]], axis=1),
    )


def _multiply(first: Real, second: Real) -> Real:
    """Multiply polynomials in x, highest power first."""
    product = np.zeros((len(first), first.shape[1] + second.shape[1] - 1))
    for k in range(first.shape[1]):
        product[:, k : k + second.shape[1]] += first[:, k : k + 1] * second
    return product


def _subtract(first: Real, second: Real) -> Real:
    """Subtract polynomials in x of the same degree."""
    assert first.shape == second.shape
    return np.asarray(first - second)
