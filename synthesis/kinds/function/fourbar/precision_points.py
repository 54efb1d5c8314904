"""Linkages that meet pairs exactly: points of the closure's cubic that satisfy the equations of the pairs.

Pairs and given zeros are r linear equations in P⁶. They leave a point, a line, or a larger space; on a line the cubic
has three roots, real or complex. In a larger space, random lines intersect the cubic in random members of the family.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from synthesis.kinds.function.fourbar.closure import UNKNOWN_COUNT, Closure
from synthesis.kinds.function.fourbar.structural_error import PARAMETER_COUNT, Generators

REAL_ROOT_TOLERANCE = 1e-6
"""Maximum relative imaginary part of a root that counts as real before it is refined: a double root of data with 16
digits is accurate to eight."""

INDEPENDENCE_TOLERANCE = 1e-11
"""Minimum singular value of the equations, relative to the largest, for them to count as independent."""

MIN_ROOT_SEPARATION = 1e-6
"""Minimum separation of roots of the cubic, as angles of points on their line, to distinguish them with certainty."""

MAX_NEWTON_STEPS, MAX_CHANGE = 6, 0.5
"""Newton's method on the structural errors, which meets the pairs to full precision: maximum number of steps, and
maximum change per step."""


class ExactLinkages(NamedTuple):
    """All solutions of a problem with finitely many.

    Attributes
    ----------
    dimensions : float, shape (k, 5)
        Real linkages; see :class:`synthesis.kinds.function.fourbar.closure.Closure`.
    degenerate : int
        Number of real points of the cubic with a link of zero or infinite length.
    proved : bool
        Whether the set is proved complete: the equations are independent and the roots are simple.
    """

    dimensions: Real
    degenerate: int
    proved: bool


def build_equations(closure: Closure, inputs: Real, outputs: Real, zeros: tuple[float | None, float | None]) -> Real:
    """Return unit rows of the given zeros and of the pairs, shape (..., r, 7)."""
    rows = closure.rows(inputs, outputs)
    given = closure.zero_rows(zeros)
    given = np.broadcast_to(given, (*rows.shape[:-2], *given.shape))
    rows = np.concatenate([given, rows], axis=-2)
    return np.asarray(rows / np.linalg.norm(rows, axis=-1, keepdims=True))


def find_null_space(rows: Real) -> tuple[Real, Real]:
    """Return a basis of the null space of the equations, shape (..., 7 − r, 7), and a measure of their independence."""
    _, s, vh = np.linalg.svd(rows)
    # The ratio of the smallest to the largest singular value measures the independence of the equations.
    return vh[..., rows.shape[-2] :, :], np.asarray(s[..., -1] / s[..., 0])


def _find_common_null_space(rows: Real) -> Real:
    """Return bases of the null spaces of many sets of equations, all of the smallest dimension that occurs."""
    _, s, vh = np.linalg.svd(rows)
    rank = int((s > INDEPENDENCE_TOLERANCE * s[..., :1]).sum(axis=-1).max())
    # At least one vector must remain, even where the equations have full rank by rounding.
    return np.asarray(vh[..., min(rank, UNKNOWN_COUNT - 1) :, :])


def intersect_lines(closure: Closure, one: Real, other: Real) -> tuple[Real, NDArray[np.bool_]]:
    """Intersect the cubic with lines, each through two orthogonal unit vectors.

    Returns
    -------
    points : float, shape (..., 3, 7)
        NaN for complex points.
    simple : bool, shape (...,)
        Whether the three points are distinct.
    """
    # Rotate the basis by the one of four angles that maximises the leading coefficient, to avoid a lower degree.
    turns = np.arange(4.0) * (np.pi / 4.0)
    turned = np.cos(turns)[:, None] * one[..., None, :] + np.sin(turns)[:, None] * other[..., None, :]
    best = np.abs(closure.cubic(turned)).argmax(axis=-1)
    cos, sin = np.cos(turns[best])[..., None], np.sin(turns[best])[..., None]
    one, other = cos * one + sin * other, cos * other - sin * one
    first, last = closure.cubic(one), closure.cubic(other)
    plus, minus = closure.cubic(one + other), closure.cubic(one - other)
    # Values at the sum and the difference of the vectors give the two mixed coefficients of the cubic.
    second, third = 0.5 * (plus - minus) - last, 0.5 * (plus + minus) - first
    companion = np.zeros((*first.shape, 3, 3))
    companion[..., 1, 0] = companion[..., 2, 1] = 1.0
    with np.errstate(divide="ignore", invalid="ignore"):
        for k, coefficient in enumerate((last, third, second)):
            companion[..., k, 2] = -coefficient / first
    sound = np.asarray(np.isfinite(companion).all(axis=(-1, -2)))
    roots = np.linalg.eigvals(np.where(sound[..., None, None], companion, 0.0)).astype(np.complex128)
    # Roots count as directions on the line, so measure their gaps as chords of the circle, also for large ones.
    spread = np.sqrt(1.0 + np.abs(roots) ** 2)
    real = np.asarray((np.abs(roots.imag) <= REAL_ROOT_TOLERANCE * spread) & sound[..., None])
    gaps = np.abs(roots[..., [0, 1, 2]] - roots[..., [1, 2, 0]]) / (spread[..., [0, 1, 2]] * spread[..., [1, 2, 0]])
    x = np.where(real, roots.real, np.nan)[..., None]
    points = x * one[..., None, :] + other[..., None, :]
    return points / np.linalg.norm(points, axis=-1, keepdims=True), np.asarray(
        sound & (gaps > MIN_ROOT_SEPARATION).all(axis=-1)
    )


def solve_exact(
    closure: Closure, inputs: Real, outputs: Real, zeros: tuple[float | None, float | None]
) -> ExactLinkages:
    """Find all linkages through as many pairs as there are freedoms: 3, and one more for each open zero.

    Parameters
    ----------
    closure : Closure
        The type of linkage.
    inputs, outputs : float, shape (n,)
        Pairs, radians and radians or units of the slider's range.
    zeros : pair of float or None
        Positions of the links at the value 0; None for an open zero.
    """
    basis, independent = find_null_space(build_equations(closure, inputs, outputs, zeros))
    linear = None not in zeros
    if linear:
        points, simple = basis, True
    else:
        points, apart = intersect_lines(closure, basis[0], basis[1])
        points, simple = points[np.isfinite(points[:, 0])], bool(apart)
    found = closure.dimensions(points)
    sound = np.isfinite(found[:, 0])
    proved = simple and bool(independent > INDEPENDENCE_TOLERANCE)
    return ExactLinkages(found[sound], int(np.count_nonzero(~sound)), proved)


def solve_many_exact(closure: Closure, inputs: Real, outputs: Real, zeros: tuple[float | None, float | None]) -> Real:
    """Find all real linkages through many sets of pairs, shape (m, n), with the index of their set.

    Returns
    -------
    found : float, shape (k, 6)
        Dimensions, and the index of the set.
    """
    found = closure.dimensions(find_exact_points(closure, inputs, outputs, zeros))
    index = np.broadcast_to(np.arange(len(found), dtype=np.float64)[:, None, None], (*found.shape[:2], 1))
    found = np.concatenate([found, index], axis=-1).reshape(-1, 6)
    return np.asarray(found[np.isfinite(found).all(axis=1)])


def find_exact_points(closure: Closure, inputs: Real, outputs: Real, zeros: tuple[float | None, float | None]) -> Real:
    """Find the cubic's points for many sets of pairs, shape (m, n): shape (m, 3 or 1, 7), NaN if complex."""
    basis, _ = find_null_space(build_equations(closure, inputs, outputs, zeros))
    return basis[:, :1] if None not in zeros else intersect_lines(closure, basis[:, 0], basis[:, 1])[0]


def sample_family(
    closure: Closure,
    inputs: Real,
    outputs: Real,
    zeros: tuple[float | None, float | None],
    rng: np.random.Generator,
) -> Real:
    """Sample random linkages through sets of fewer pairs, shape (m, n); results as for :func:`solve_many_exact`."""
    basis = _find_common_null_space(build_equations(closure, inputs, outputs, zeros))
    count, left = basis.shape[:2]
    # With both zeros the cubic is linear, so every point of the null space is a linkage.
    if None not in zeros:
        points = (rng.normal(size=(count, 1, left)) @ basis).reshape(count, 1, UNKNOWN_COUNT)
        points = points / np.linalg.norm(points, axis=-1, keepdims=True)
    else:
        frames, _ = np.linalg.qr(rng.normal(size=(count, left, 2)))
        one, other = (np.einsum("mk,mkj->mj", frames[:, :, j], basis) for j in (0, 1))
        points, _ = intersect_lines(closure, one, other)
    found = closure.dimensions(points)
    index = np.broadcast_to(np.arange(count, dtype=np.float64)[:, None, None], (*found.shape[:2], 1))
    found = np.concatenate([found, index], axis=-1).reshape(-1, 6)
    return np.asarray(found[np.isfinite(found).all(axis=1)])


def refine_generator(generators: Generators, dimensions: Real, free: NDArray[np.bool_]) -> Real:
    """Refine a generator by Newton's method with minimum-norm steps until it meets its pairs to full precision.

    Parameters
    ----------
    generators : Generators
        The pairs.
    dimensions : float, shape (7,)
        A generator that meets them approximately; it keeps its assembly at each pair.
    free : bool, shape (7,)
        Mask of the parameters that may change.
    """
    signs = generators.signs(dimensions[None])
    least, best = np.inf, dimensions
    for _ in range(MAX_NEWTON_STEPS):
        errors = generators.errors(dimensions[None], signs)[0]
        size = float(np.abs(errors).max()) if np.isfinite(errors).all() else np.inf
        if not size < least:
            break  # rounding: the previous iterate was the best
        least, best = size, dimensions
        jacobian = generators.derivatives(dimensions, errors)[:, free]
        if not np.isfinite(jacobian).all():
            break
        step = np.zeros(PARAMETER_COUNT)
        # Limit each component, because Newton's method starts outside its region of convergence now and then.
        step[free] = np.clip(-np.linalg.lstsq(jacobian, errors, rcond=None)[0], -MAX_CHANGE, MAX_CHANGE)
        dimensions = generators.apply_step(dimensions, step)
    return best
