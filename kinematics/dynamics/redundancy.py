"""Reactions where constraints are redundant: which forces the equations determine, and the least that meet them.

The matrix of the equations, links × unknowns, is the transpose of the constraints' Jacobian. With more constraints than
needed it has more columns than rows: any *self-stress*, a vector that it maps to zero, may be added to a solution.
No self-stress has a part in the drive, since the input alone moves the links, nor does it act on the frame as a whole.
A force that no self-stress has a part in is unique.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kinematics.dynamics import kernels

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

OPEN = 1e-9
"""Part in a self-stress of unit length from which on a force is not unique; below it is rounding."""

FEWEST = 1e-14
"""Singular value, as a share of the largest, from which on it is not rounding alone."""


def solve(
    terms: NDArray[np.int64],
    coefficients: Real,
    bases: NDArray[np.int64],
    joints: Complex,
    directions: Complex,
    known: Real,
    posed: NDArray[np.bool_],
    solutions: Real,
    conditions: Real,
) -> list[Real]:
    """Fill in the solutions of the least sum of squares, as :func:`kernels.solve` does its own.

    Returns
    -------
    list of float arrays, shape (M, columns)
        Self-stresses of unit length, square to one another; NaN where nothing is solved.
    """
    count, rows = known.shape
    columns = solutions.shape[1]
    solutions[:], conditions[:] = np.nan, np.inf
    stresses = [np.full((count, columns), np.nan) for _ in range(columns - rows)]
    at = np.flatnonzero(posed)
    matrices = np.zeros((len(at), rows, columns))
    kernels.matrices(
        terms,
        coefficients,
        bases,
        np.ascontiguousarray(joints[:, at]),
        np.ascontiguousarray(directions[:, at]),
        matrices,
    )
    left, values, right = np.linalg.svd(matrices, full_matrices=True)
    sound = values[:, -1] > FEWEST * values[:, 0]
    at, left, values, right = at[sound], left[sound], values[sound], right[sound]
    conditions[at] = values[:, 0] / values[:, -1]
    parts = np.einsum("mji,mj->mi", left, known[at]) / values
    solutions[at] = np.einsum("mij,mi->mj", right[:, :rows], parts)
    for n, stress in enumerate(stresses):
        stress[at] = right[:, rows + n]
    return stresses


def unique(force: NDArray[np.inexact], stresses: list[NDArray[np.inexact]]) -> NDArray[np.bool_]:
    """Where no self-stress has a part in a force."""
    parts = np.array([np.abs(stress) for stress in stresses])
    return np.asarray(np.isnan(np.abs(force)) | (parts < OPEN).all(axis=0))
