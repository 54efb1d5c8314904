"""Reactions with redundant constraints: the uniquely determined forces, and the solution of minimum norm.

The matrix of the equations, links × unknowns, is the transpose of the constraints' Jacobian. With more constraints than
necessary it has more columns than rows: any *self-stress*, a vector that it maps to zero, may be added to a solution.
No self-stress contributes to the drive, since the input alone moves the links, nor does it act on the frame as a whole.
A force to which no self-stress contributes is unique.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from kinematics.dynamics import kernels
from kinematics.dynamics.system import System

MIN_STRESS_PART = 1e-9
"""Component in a self-stress of unit length above which a force is not unique; smaller ones are rounding."""

MIN_SINGULAR_VALUE = 1e-14
"""Singular value, as a share of the largest, above which it is not rounding alone."""


def solve_minimum_norm(
    system: System,
    joints: Complex,
    directions: Complex,
    known: Real,
    posed: NDArray[np.bool_],
    solutions: Real,
    conditions: Real,
) -> list[Real]:
    """Fill in the solutions of minimum norm; the parameters are those of :func:`kernels.solve_positions`.

    Returns
    -------
    list of float arrays, shape (M, columns)
        Orthonormal self-stresses; NaN at positions without a solution.
    """
    count, rows = known.shape
    columns = solutions.shape[1]
    solutions[:], conditions[:] = np.nan, np.inf
    stresses = [np.full((count, columns), np.nan) for _ in range(columns - rows)]
    # The SVD is done only at positions that can be solved.
    at = np.flatnonzero(posed)
    matrices = np.zeros((len(at), rows, columns))
    kernels.fill_matrices(
        system.terms,
        system.coefficients,
        system.bases,
        np.ascontiguousarray(joints[:, at]),
        np.ascontiguousarray(directions[:, at]),
        matrices,
    )
    left, values, right = np.linalg.svd(matrices, full_matrices=True)
    # A vanishing singular value is a dead centre: nothing is determined.
    sound = values[:, -1] > MIN_SINGULAR_VALUE * values[:, 0]
    at, left, values, right = at[sound], left[sound], values[sound], right[sound]
    conditions[at] = values[:, 0] / values[:, -1]
    # The pseudoinverse by the SVD gives the solution without self-stress, which is that of minimum norm.
    parts = np.einsum("mji,mj->mi", left, known[at]) / values
    solutions[at] = np.einsum("mij,mi->mj", right[:, :rows], parts)
    for n, stress in enumerate(stresses):
        stress[at] = right[:, rows + n]
    return stresses


def is_unique(force: NDArray[np.generic], stresses: Sequence[NDArray[np.generic]]) -> NDArray[np.bool_]:
    """Return where no self-stress contributes to a force."""
    parts = np.array([np.abs(stress) for stress in stresses])
    return np.asarray(np.isnan(np.abs(force)) | (parts < MIN_STRESS_PART).all(axis=0))
