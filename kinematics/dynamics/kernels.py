"""Compiled assembly and solution of the equations of the reactions, position by position.

Elimination with partial pivoting, and the condition number in the 1-norm by Hager's estimate of the norm of the inverse
(N. J. Higham, *Accuracy and Stability of Numerical Algorithms*, Sec. 15.2): a handful of further solutions instead of
the inverse itself. Lengths are shares of the mechanism's size, so that forces and torques have the same unit.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Integers, Real
from kinematics.compiling import KernelOptions, njit

FORCE, DIRECTED_FORCE, TORQUE = range(3)
"""Kinds of terms: a force at a joint (two columns, its components); a force along a given direction; a couple."""

MAX_ESTIMATE_STEPS = 5
"""Maximum number of steps of Hager's estimate; it usually ends after two or three."""

OPTIONS: KernelOptions = {"cache": True, "nogil": True, "error_model": "numpy"}
"""Options of the kernels."""


@njit(**OPTIONS)
def solve_positions(
    terms: Integers,
    coefficients: Real,
    bases: Integers,
    joints: Complex,
    directions: Complex,
    known: Real,
    smooth: NDArray[np.bool_],
    solutions: Real,
    conditions: Real,
) -> None:
    """Solve at all positions.

    Parameters
    ----------
    terms, coefficients, bases
        The system of equations (:mod:`system`).
    joints : complex, shape (joints, M)
        Positions of the joints, divided by the mechanism's size.
    directions : complex, shape (directions, M)
        Unit vectors along which terms act.
    known : float, shape (M, n)
        Right-hand sides.
    smooth : bool, shape (M,)
        Positions to solve.
    solutions : float, shape (M, n)
        Filled; NaN elsewhere, and where the equations are singular.
    conditions : float, shape (M,)
        Filled: condition numbers, infinite for singular equations.
    """
    count, n = known.shape
    matrix = np.empty((n, n))
    order = np.empty(n, np.int64)
    work = np.empty((3, n))
    for at in range(count):
        solutions[at] = np.nan
        conditions[at] = np.inf
        if not smooth[at]:
            continue
        matrix[:] = 0.0
        fill_terms(terms, coefficients, bases, joints, directions, at, matrix)
        # Before the elimination overwrites the matrix.
        norm = compute_norm(matrix)
        if not factorise(matrix, order):
            continue
        conditions[at] = norm * estimate_inverse_norm(matrix, order, work)
        for row in range(n):
            solutions[at, row] = known[at, row]
        solve_factors(matrix, order, solutions[at])


@njit(**OPTIONS)
def fill_matrices(
    terms: Integers, coefficients: Real, bases: Integers, joints: Complex, directions: Complex, filled: Real
) -> None:
    """Add the equations of all positions to an array of shape (M, rows, columns)."""
    for at in range(len(filled)):
        fill_terms(terms, coefficients, bases, joints, directions, at, filled[at])


@njit(**OPTIONS)
def fill_terms(
    terms: Integers, coefficients: Real, bases: Integers, joints: Complex, directions: Complex, at: int, matrix: Real
) -> None:
    """Add the terms of one position to a matrix."""
    for t in range(len(terms)):
        kind, column, link, joint, direction = terms[t]
        factor_of_term = coefficients[t]
        row = 3 * link
        if kind == TORQUE:
            matrix[row + 2, column] += factor_of_term
            continue
        arm = joints[joint, at] - joints[bases[link], at]
        if kind == FORCE:
            matrix[row, column] += factor_of_term
            matrix[row + 1, column + 1] += factor_of_term
            matrix[row + 2, column] -= factor_of_term * arm.imag
            matrix[row + 2, column + 1] += factor_of_term * arm.real
        else:
            d = directions[direction, at]
            matrix[row, column] += factor_of_term * d.real
            matrix[row + 1, column] += factor_of_term * d.imag
            matrix[row + 2, column] += factor_of_term * (arm.real * d.imag - arm.imag * d.real)


@njit(**OPTIONS)
def compute_norm(matrix: Real) -> float:
    """Compute the 1-norm: the maximum column sum of magnitudes."""
    largest = 0.0
    n = len(matrix)
    for column in range(n):
        total = 0.0
        for row in range(n):
            total += abs(matrix[row, column])
        largest = max(largest, total)
    return largest


@njit(**OPTIONS)
def factorise(matrix: Real, order: Integers) -> bool:
    """Eliminate in place with partial pivoting; return False if a pivot vanishes."""
    n = len(matrix)
    for k in range(n):
        pivot = k
        for row in range(k + 1, n):
            if abs(matrix[row, k]) > abs(matrix[pivot, k]):
                pivot = row
        order[k] = pivot
        # "not >" also catches NaN.
        if not abs(matrix[pivot, k]) > 0.0:
            return False
        # Swap whole rows, multipliers included (LAPACK's convention).
        if pivot != k:
            for column in range(n):
                matrix[k, column], matrix[pivot, column] = matrix[pivot, column], matrix[k, column]
        inverse = 1.0 / matrix[k, k]
        for row in range(k + 1, n):
            share = matrix[row, k]
            # The matrices are sparse: most multipliers are zero.
            if share != 0.0:
                share *= inverse
                matrix[row, k] = share
                for column in range(k + 1, n):
                    matrix[row, column] -= share * matrix[k, column]
    return True


@njit(**OPTIONS)
def solve_factors(matrix: Real, order: Integers, x: Real) -> None:
    """Solve A x = b with the factors, in place."""
    n = len(matrix)
    for k in range(n):
        pivot = order[k]
        x[k], x[pivot] = x[pivot], x[k]
    for k in range(n):
        value = x[k]
        # Right-hand sides are sparse too.
        if value != 0.0:
            for row in range(k + 1, n):
                x[row] -= matrix[row, k] * value
    for k in range(n - 1, -1, -1):
        x[k] /= matrix[k, k]
        value = x[k]
        if value != 0.0:
            for row in range(k):
                x[row] -= matrix[row, k] * value


@njit(**OPTIONS)
def solve_transposed(matrix: Real, order: Integers, x: Real) -> None:
    """Solve Aᵀ x = b with the factors, in place."""
    n = len(matrix)
    for k in range(n):
        value = x[k]
        for row in range(k):
            value -= matrix[row, k] * x[row]
        x[k] = value / matrix[k, k]
    for k in range(n - 1, -1, -1):
        value = x[k]
        for row in range(k + 1, n):
            value -= matrix[row, k] * x[row]
        x[k] = value
    for k in range(n - 1, -1, -1):
        pivot = order[k]
        x[k], x[pivot] = x[pivot], x[k]


@njit(**OPTIONS)
def estimate_inverse_norm(matrix: Real, order: Integers, work: Real) -> float:
    """Estimate the 1-norm of the inverse from the factors (Hager): a lower bound, rarely less than a third of it."""
    n = len(matrix)
    x, z, signs = work[0], work[1], work[2]
    # Hager starts from the uniform vector, then moves to unit vectors that increase the norm.
    x[:] = 1.0 / n
    estimate = 0.0
    for step in range(MAX_ESTIMATE_STEPS):
        solve_factors(matrix, order, x)
        total = 0.0
        for k in range(n):
            total += abs(x[k])
            signs[k] = 1.0 if x[k] >= 0.0 else -1.0
        # The estimate only grows; a step without progress is a local maximum.
        if step > 0 and total <= estimate:
            break
        estimate = total
        z[:] = signs
        solve_transposed(matrix, order, z)
        largest = 0
        for k in range(n):
            if abs(z[k]) > abs(z[largest]):
                largest = k
        x[:] = 0.0
        x[largest] = 1.0
    return estimate
