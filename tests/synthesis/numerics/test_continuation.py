"""The path tracker on systems whose number of solutions is known, with the dense solver."""

import numpy as np
import pytest
from numba import njit

from synthesis.numerics.continuation import END_REACHED, SYSTEM, CompiledSystem, ParameterPath, follow, refine
from synthesis.numerics.double_double import add, compute_reciprocal, multiply
from synthesis.numerics.elimination import factor, reduce, solve


@njit(SYSTEM, cache=True, nogil=True)
def three_quadrics(y, low, p, p_low, dp, newton, tangent, work):
    """Three general quadrics: 8 solutions (Bézout). Parameters: ten coefficients of each."""
    jacobian = work[:9].reshape((3, 3))
    pivots = np.empty(3, np.int64)
    for row in range(3):
        c, d = p[10 * row : 10 * row + 10], dp[10 * row : 10 * row + 10]
        f, ft, k = c[9], d[9], 0
        for i in range(3):
            jacobian[row, i] = c[6 + i]
            f += c[6 + i] * y[i]
            ft += d[6 + i] * y[i]
        for i in range(3):
            for j in range(i, 3):
                f += c[k] * y[i] * y[j]
                ft += d[k] * y[i] * y[j]
                jacobian[row, i] += c[k] * y[j]
                jacobian[row, j] += c[k] * y[i]
                k += 1
        newton[row], tangent[row] = -f, -ft
    if not factor(jacobian, pivots):
        return 0
    solve(jacobian, pivots, newton)
    solve(jacobian, pivots, tangent)
    return 1


QUADRICS = CompiledSystem(three_quadrics, np.zeros(3, np.int64), 9)


def value(y, p):
    i, j = np.triu_indices(3)
    c = p.reshape(3, 10)
    return (y[:, i] * y[:, j]) @ c[:, :6].T + y @ c[:, 6:9].T + c[:, 9]


@pytest.fixture
def spheres():
    """x² = y² = z² = 1 and its eight solutions."""
    p = np.zeros((3, 10), np.complex128)
    p[0, 0] = p[1, 3] = p[2, 5] = 1.0
    p[:, 9] = -1.0
    corners = np.array([[x, y, z] for x in (1, -1) for y in (1, -1) for z in (1, -1)], np.complex128)
    return corners, p.ravel()


@pytest.mark.parametrize("threads", [1, 2])
def test_all_solutions_of_three_quadrics_are_reached(spheres, threads):
    rng = np.random.default_rng(1)
    start, p = spheres
    for _ in range(20):
        target, bend = rng.normal(size=(2, 30)) + 1j * rng.normal(size=(2, 30))
        ends = follow(QUADRICS, start, ParameterPath(p, target, bend), threads=threads)
        assert (ends.status == END_REACHED).all()
        assert np.abs(value(ends.y, target)).max() < 1e-9 * np.abs(ends.y).max() ** 2
        gaps = np.abs(ends.y[:, None] - ends.y[None]).max(axis=-1) + np.eye(8)
        assert gaps.min() > 1e-6


def test_a_path_to_infinity_is_not_reached(spheres):
    start, p = spheres
    target = p.copy().reshape(3, 10)
    target[2, 5], target[2, 8] = 0.0, 1.0  # the third equation becomes linear: four solutions, four at infinity
    bend = np.random.default_rng(2).normal(size=(30, 2)) @ [0.1, 0.1j]
    bend.reshape(3, 10)[2, :] = 0.0
    ends = follow(QUADRICS, start, ParameterPath(p, target.ravel(), bend))
    finite = (ends.status == END_REACHED) & (np.abs(ends.y).max(axis=-1) < 1e6)
    assert finite.sum() == 4


def test_refining_from_nearby_gives_the_solution_to_its_last_digit(spheres):
    start, p = spheres
    y, _, moved = refine(QUADRICS, start + 1e-3, np.zeros_like(start), p)
    assert np.abs(y - start).max() < 1e-15
    assert moved.max() < 1e-13


def test_double_doubles_have_thirty_digits():
    from fractions import Fraction

    rng = np.random.default_rng(3)

    def exact(high, low):
        return [Fraction(high.real) + Fraction(low.real), Fraction(high.imag) + Fraction(low.imag)]

    def times(a, b):
        return [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]

    def size(a):
        return float(abs(a[0]) + abs(a[1]))

    for _ in range(200):
        a, b = rng.normal(size=2) + 1j * rng.normal(size=2)
        a_low, b_low = 1e-17 * (rng.normal(size=2) + 1j * rng.normal(size=2))
        one, other = exact(a, a_low), exact(b, b_low)
        total = exact(*add(a, a_low, b, b_low))
        assert size([s - (x + y) for s, x, y in zip(total, one, other, strict=True)]) < 1e-31
        product = times(one, other)
        found = exact(*multiply(a, a_low, b, b_low))
        assert size([s - x for s, x in zip(found, product, strict=True)]) < 1e-30 * (1.0 + size(product))
        unit = times(one, exact(*compute_reciprocal(a, a_low)))
        assert size([unit[0] - 1, unit[1]]) < 1e-29


def test_systems_with_right_sides_are_solved():
    rng = np.random.default_rng(4)
    for n in (1, 2, 8):
        matrix = rng.normal(size=(n, n + 2)) + 1j * rng.normal(size=(n, n + 2))
        # a zero where the first pivot would be
        matrix[0, 0] *= n == 1
        solved = matrix.copy()
        assert reduce(solved)
        assert np.abs(solved[:, n:] - np.linalg.solve(matrix[:, :n], matrix[:, n:])).max() < 1e-12
    assert not reduce(np.zeros((3, 5), complex))
