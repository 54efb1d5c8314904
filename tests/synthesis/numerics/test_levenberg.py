"""Levenberg and Marquardt's method on Rosenbrock's valley: where it ends, what it says of it, and limits that hold."""

import numpy as np
import pytest

from kinematics.compiling import njit
from synthesis.numerics.augmented_lagrangian import MAX_ROUNDS, MAX_STEPS, append_limit_rows, descend_constrained
from synthesis.numerics.cholesky import solve_positive
from synthesis.numerics.levenberg import ROWS, descend
from synthesis.numerics.status import Status

TOLERANCE = 1e-14


@njit(ROWS, cache=True)
def valley(x, points, setting, multipliers, state, residuals, jacobian):
    """Rosenbrock's residuals and a third, setting[0], that no unknown moves; impossible for x₀ > 100.

    Limits: x₀ ≤ setting[1] and x₀ ≥ setting[2]; equation: x₁ = setting[3], where it is a number.
    """
    if x[0] > 100.0:
        return -1
    residuals[0], residuals[1], residuals[2] = 10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0], setting[0]
    jacobian[:3] = 0.0
    jacobian[0, 0], jacobian[0, 1], jacobian[1, 0] = -20.0 * x[0], 10.0, -1.0
    margins, gradients = state[state.size - 3 :], np.zeros((3, 2))
    margins[0], margins[1], margins[2] = setting[1] - x[0], x[0] - setting[2], np.inf
    gradients[0, 0], gradients[1, 0], gradients[2, 1] = -1.0, 1.0, 1.0
    if setting[3] == setting[3]:
        margins[2] = x[1] - setting[3]
    return append_limit_rows(margins, gradients, 1, multipliers, residuals, jacobian, 3)


def setting(rest=0.0, most=np.inf, least=-np.inf, second=np.nan):
    return np.array([rest, most, least, second])


def descended(start, stated, steps=200):
    x = np.array(start)
    unweighted = np.array([0.0, 0.0, 0.0, 1e-300])
    cost, status = descend(valley, x, np.zeros((1, 1)), stated, unweighted, np.zeros(3), 6, steps, TOLERANCE)
    return x, cost, Status(status)


def held(start, stated):
    x, ended = np.array(start), np.empty(1)
    status = descend_constrained(
        valley, x, np.zeros((1, 1)), stated, np.zeros(3), 6, 3, 1, 1.0, MAX_ROUNDS, MAX_STEPS, ended
    )
    return x, float(ended[0]), Status(status)


@pytest.mark.parametrize("start", [[-1.2, 1.0], [5.0, -3.0], [0.0, 0.0]])
def test_the_minimum_is_reached_and_said_to_be(start):
    x, cost, status = descended(start, setting())
    assert status is Status.ZERO
    assert cost < 1e-30
    assert np.allclose(x, 1.0, atol=1e-14)


def test_a_minimum_that_is_not_zero_is_one_too():
    x, cost, status = descended([-1.2, 1.0], setting(rest=1.0))
    assert status.is_converged
    assert cost == pytest.approx(0.5, rel=1e-15)
    assert np.allclose(x, 1.0, atol=1e-6)


def test_a_descent_that_is_cut_short_has_not_converged():
    start = [-1.2, 1.0]
    _, cost, status = descended(start, setting(), steps=3)
    assert status is Status.STEP_LIMIT
    assert not status.is_converged
    assert 1e-3 < cost < 0.5 * (4.4**2 + 2.2**2)


def test_an_impossible_start_stays_where_it_is():
    x, cost, status = descended([101.0, 0.0], setting())
    assert status is Status.IMPOSSIBLE
    assert cost == np.inf
    assert x.tolist() == [101.0, 0.0]


def test_a_limit_holds_at_the_end_and_bears_the_gradient():
    x, cost, status = held([-1.2, 1.0], setting(most=0.5))
    assert status.is_converged
    assert 0.5 - 1e-8 < x[0] <= 0.5 + 1e-11
    # On the limit the best second number is the square, and what is left of the cost is (1 − x₀)²/2.
    assert x[1] == pytest.approx(0.25, abs=1e-8)
    assert cost == pytest.approx(0.125, rel=1e-7)


def test_a_limit_that_bears_nothing_changes_nothing():
    x, cost, status = held([-1.2, 1.0], setting(most=2.0, least=-5.0))
    assert status.is_converged
    assert np.allclose(x, 1.0, atol=1e-12)
    assert cost < 1e-20


def test_an_equation_holds_from_either_side():
    for start in ([0.0, 0.0], [0.0, 9.0]):
        x, _, status = held(start, setting(second=4.0))
        assert status.is_converged
        assert x[1] == pytest.approx(4.0, abs=1e-11)
        slope = 2.0 * 100.0 * (4.0 - x[0] ** 2) * -2.0 * x[0] - 2.0 * (1.0 - x[0])
        assert abs(slope) < 1e-5, "stationary along the equation"


def test_limits_that_contradict_one_another_are_said_to_be_infeasible():
    _, _, status = held([0.0, 0.0], setting(most=0.0, least=1.0))
    assert status is Status.INFEASIBLE


@pytest.mark.parametrize("n", [1, 2, 5, 12])
def test_cholesky_solves_what_numpy_solves(n):
    rng = np.random.default_rng(n)
    root, right = rng.normal(size=(n, n)), rng.normal(size=n)
    matrix = root @ root.T + 0.1 * np.eye(n)
    solution = right.copy()
    assert solve_positive(np.tril(matrix), solution)
    assert np.allclose(solution, np.linalg.solve(matrix, right), rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("matrix", [[[0.0]], [[1.0, 0.0], [2.0, 1.0]], [[-1.0, 0.0], [0.0, 1.0]], [[np.nan]]])
def test_cholesky_refuses_what_is_not_definite(matrix):
    assert not solve_positive(np.array(matrix), np.ones(len(matrix)))
