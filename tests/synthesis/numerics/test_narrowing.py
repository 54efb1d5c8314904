"""Minimax by linear programs against Chebyshev's polynomials, for which the answer is known."""

import numpy as np
import pytest

from synthesis.numerics.narrowing import ShapeValues, find_narrowest_band

NODES = -np.cos(np.pi * np.arange(401) / 400)


def polynomials(highest, limited=None):
    """Values of t^n + Σ x_k t^k over [−1, 1]; the k have the parity of n."""
    powers = range(highest - 2, 0, -2)

    def values(x):
        banded = NODES**highest + sum(x[:, k, None] * NODES**p for k, p in enumerate(powers))
        empty = np.empty((len(x), 0))
        return ShapeValues(banded, empty if limited is None else limited(x), empty)

    return values, len(powers)


@pytest.mark.parametrize("highest", [3, 4, 5, 6, 7])
def test_chebyshevs_polynomials_are_the_flattest(highest):
    values, n = polynomials(highest)
    found = find_narrowest_band(values, np.full(n, 0.3), np.full(n, -5.0), np.full(n, 5.0))
    assert np.isclose(found.half_width, 2.0 ** (1 - highest), rtol=2e-4)
    band = values(found.shape[None]).banded[0]
    middle = 0.5 * (band.max() + band.min())
    at_edge = np.sign((band - middle)[np.abs(band - middle) > 0.9999 * found.half_width])
    assert np.count_nonzero(np.diff(at_edge)) == highest


def test_a_band_that_limits_is_kept_and_used():
    """With |x| t ≤ 0.5 as the second band the best coefficient −0.75 of t³ − 0.75 t is out of reach: −0.5 is taken."""
    values, _ = polynomials(3, limited=lambda x: x[:, :1] * NODES)
    found = find_narrowest_band(values, np.array([0.3]), np.array([-5.0]), np.array([5.0]), half_limit=0.5)
    assert np.isclose(found.shape[0], -0.5, atol=1e-6)
    assert found.violation < 1e-9
    free = find_narrowest_band(values, np.array([0.3]), np.array([-5.0]), np.array([5.0]))
    assert np.isclose(free.shape[0], -0.75, atol=1e-5)


def test_bounds_are_kept():
    values, n = polynomials(4)
    found = find_narrowest_band(values, np.full(n, 3.0), np.full(n, -0.8), np.full(n, 5.0))
    assert found.shape[0] == -0.8


def test_a_start_that_is_nothing_is_told():
    assert (
        find_narrowest_band(lambda x: ShapeValues(np.full((len(x), 3), np.nan), x[:, :0], x[:, :0]), np.zeros(1), -1, 1)
        is None
    )
