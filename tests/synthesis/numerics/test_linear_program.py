"""Linear programs against ``scipy.optimize.linprog`` and against the conditions of their optima."""

import numpy as np
import pytest
from scipy.optimize import linprog

from synthesis.numerics.linear_program import solve_linear_program


@pytest.mark.parametrize("seed", range(40))
def test_values_are_those_of_another_door_to_a_solver(seed):
    """Random programs: feasible or not, bounded or not."""
    rng = np.random.default_rng(seed)
    n, m = int(rng.integers(1, 9)), int(rng.integers(1, 120))
    rows, limits, cost = rng.normal(size=(m, n)), rng.normal(size=m) + rng.choice([0.0, 3.0]), rng.normal(size=n)
    low = np.where(rng.random(n) < 0.4, -np.inf, -rng.random(n))
    high = np.where(rng.random(n) < 0.4, np.inf, rng.random(n))
    found = solve_linear_program(cost, rows, limits, low, high)
    known = linprog(cost, rows, limits, bounds=np.stack([low, high], axis=1), method="highs-ipm")
    assert (found is not None) == (known.status == 0)
    if found is not None:
        assert np.isclose(found.value, known.fun, rtol=1e-6, atol=1e-6)
        assert np.isclose(cost @ found.at, found.value, rtol=1e-9, atol=1e-9)
        assert (rows @ found.at <= limits + 1e-6).all()
        assert (found.at >= low - 1e-9).all()
        assert (found.at <= high + 1e-9).all()


def test_no_rows_leave_the_bounds():
    found = solve_linear_program(
        np.array([1.0, -1.0]), np.empty((0, 2)), np.empty(0), np.array([-1.0, 0.0]), np.array([1.0, 2.0])
    )
    assert found is not None
    assert np.array_equal(found.at, [-1.0, 2.0])


@pytest.mark.parametrize("spoilt", ["cost", "rows", "limits"])
def test_what_is_not_finite_has_no_answer(spoilt):
    given = {"cost": np.ones(2), "rows": np.ones((3, 2)), "limits": np.ones(3)}
    given[spoilt] = np.full_like(given[spoilt], np.nan)
    assert solve_linear_program(given["cost"], given["rows"], given["limits"], np.zeros(2), np.ones(2)) is None
