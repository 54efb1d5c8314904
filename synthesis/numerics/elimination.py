"""Gaussian elimination for small dense complex systems in compiled kernels; `factor` and `solve` also take real ones.

A call of LAPACK costs more than the arithmetic of a system of ten unknowns, and it allocates memory.
"""

from __future__ import annotations

from kinematics.arrays import Complex, Integers, Numbers
from kinematics.compiling import njit


@njit(cache=True, nogil=True)
def factor(matrix: Numbers, pivots: Integers) -> bool:
    """Decompose a matrix into L and U in place, with partial pivoting, and return whether the matrix is regular.

    Afterwards ``matrix``, shape (n, n), holds L below the diagonal, U above it, and the reciprocals of U's diagonal on
    the diagonal. ``pivots``, shape (n,), holds the row exchanged with each row.
    """
    n = matrix.shape[0]
    for k in range(n):
        # |Re| + |Im| orders pivots well enough and needs no square root.
        best, row = -1.0, k
        for i in range(k, n):
            size = abs(matrix[i, k].real) + abs(matrix[i, k].imag)
            if size > best:
                best, row = size, i
        pivots[k] = row
        # Negated, so that NaN counts as singular.
        if not best > 0.0:
            return False
        if row != k:
            for c in range(n):
                matrix[k, c], matrix[row, c] = matrix[row, c], matrix[k, c]
        inverse = 1.0 / matrix[k, k]
        # Store the reciprocal: substitution then multiplies instead of dividing.
        matrix[k, k] = inverse
        for i in range(k + 1, n):
            share = matrix[i, k] * inverse
            matrix[i, k] = share
            for c in range(k + 1, n):
                matrix[i, c] -= share * matrix[k, c]
    return True


@njit(cache=True, nogil=True)
def solve(factors: Numbers, pivots: Integers, b: Numbers) -> None:
    """Replace ``b``, shape (n,), by the solution of the system decomposed by :func:`factor`."""
    n = factors.shape[0]
    for k in range(n):
        row = pivots[k]
        if row != k:
            b[k], b[row] = b[row], b[k]
    for i in range(1, n):
        total = b[i]
        for c in range(i):
            total -= factors[i, c] * b[c]
        b[i] = total
    for i in range(n - 1, -1, -1):
        total = b[i]
        for c in range(i + 1, n):
            total -= factors[i, c] * b[c]
        b[i] = total * factors[i, i]


@njit(cache=True, nogil=True, error_model="numpy")
def reduce(matrix: Complex) -> bool:
    """Solve a system for several right sides in place, and return whether the matrix is regular.

    ``matrix`` has shape (n, n + right sides). The right sides are its last columns and are replaced by the solutions;
    the first n columns are overwritten and have no meaning afterwards.
    """
    n, width = matrix.shape
    for k in range(n):
        best, row = -1.0, k
        for i in range(k, n):
            size = abs(matrix[i, k].real) + abs(matrix[i, k].imag)
            if size > best:
                best, row = size, i
        if not best > 0.0:
            return False
        if row != k:
            # Columns before k are not used again.
            for c in range(k, width):
                matrix[k, c], matrix[row, c] = matrix[row, c], matrix[k, c]
        pivot = matrix[k, k]
        # Compute the reciprocal explicitly: a complex division guards against overflow and is several times slower.
        size = 1.0 / (pivot.real * pivot.real + pivot.imag * pivot.imag)
        inverse = complex(pivot.real * size, -pivot.imag * size)
        matrix[k, k] = inverse
        for i in range(k + 1, n):
            share = matrix[i, k] * inverse
            for c in range(k + 1, width):
                matrix[i, c] -= share * matrix[k, c]
    for i in range(n - 1, -1, -1):
        for c in range(n, width):
            total = matrix[i, c]
            for k in range(i + 1, n):
                total -= matrix[i, k] * matrix[k, c]
            matrix[i, c] = total * matrix[i, i]
    return True
