"""In-place Cholesky solver for the small positive definite systems of a descent, of which there are thousands."""

from __future__ import annotations

import math

from kinematics.arrays import Real
from kinematics.compiling import njit


@njit(cache=True, nogil=True, error_model="numpy")
def solve_positive(matrix: Real, right: Real) -> bool:
    """Solve A x = r with A = L Lᵀ; the solution is left in ``right``, L in the lower triangle of ``matrix``.

    Parameters
    ----------
    matrix : float64, shape (n, n)
        Matrix A; only its lower triangle is read.
    right : float64, shape (n,)
        Right side r; replaced by the solution.

    Returns
    -------
    bool
        False if A is not positive definite; both arrays are then invalid.
    """
    n = right.size
    for j in range(n):
        pivot = matrix[j, j]
        for k in range(j):
            pivot -= matrix[j, k] * matrix[j, k]
        # Written so that NaN, too, counts as not positive.
        if not pivot > 0.0:
            return False
        pivot = math.sqrt(pivot)
        matrix[j, j] = pivot
        for i in range(j + 1, n):
            value = matrix[i, j]
            for k in range(j):
                value -= matrix[i, k] * matrix[j, k]
            matrix[i, j] = value / pivot
    # Forward substitution with L, then backward with its transpose.
    for i in range(n):
        for k in range(i):
            right[i] -= matrix[i, k] * right[k]
        right[i] /= matrix[i, i]
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            right[i] -= matrix[k, i] * right[k]
        right[i] /= matrix[i, i]
    return True
