"""The compiled kernels of drag links against plain numpy: pins by circles, the slowest half turn on a grid."""

import numpy as np
import pytest

from synthesis.kinds.quick_return.drag_link import (
    _compute_input_angle,
    _compute_max_ratio,
    _compute_slow_rotation,
    _find_slowest_direction,
)


def input_angle(a, c, direction):
    """Direction of A, on the circle of radius a about O2 and of radius b about B; the ground from 0 to 1."""
    pin = 1.0 + c * np.exp(1j * direction)
    b = np.sqrt(a * a + 1.0 - c * c)
    f = np.abs(pin)
    along = 0.5 * (f + (a * a - b * b) / f)
    return np.angle(pin / f * (along + 1j * np.sqrt(np.maximum(a * a - along * along, 0.0))))


def slow(a, c, start):
    return np.mod(input_angle(a, c, start + np.pi) - input_angle(a, c, start), 2.0 * np.pi)


def drag_links(count):
    """Inputs of 1.02 to 8 grounds, second cranks between 1 and the longest of the family."""
    rng = np.random.default_rng(17)
    a = np.exp(rng.uniform(np.log(1.02), np.log(8.0), count))
    longest = np.sqrt(0.5 * (a * a + 1.0))
    return a, 1.0 + rng.uniform(0.01, 0.99, count) * (longest - 1.0)


@pytest.mark.parametrize(("a", "c"), list(zip(*drag_links(20), strict=True)))
def test_kernels_agree_with_their_twins(a, c):
    directions = np.linspace(-np.pi, np.pi, 73)
    angles = np.array([_compute_input_angle(a, c, direction) for direction in directions])
    assert np.allclose(np.exp(1j * angles), np.exp(1j * input_angle(a, c, directions)), rtol=0.0, atol=1e-9)
    strokes = np.array([_compute_slow_rotation(a, c, direction) for direction in directions])
    assert np.allclose(strokes, slow(a, c, directions), rtol=0.0, atol=1e-9)
    dense = slow(a, c, np.linspace(0.0, 2.0 * np.pi, 20001))
    assert _compute_slow_rotation(a, c, _find_slowest_direction(a, c)) == pytest.approx(dense.max(), abs=1e-6)
    assert _compute_slow_rotation(a, c, _find_slowest_direction(a, c)) >= dense.max() - 1e-12
    assert _compute_max_ratio(a, c) == pytest.approx(dense.max() / (2.0 * np.pi - dense.max()), abs=1e-5)
