"""The extremes are those among all stationary points, wherever in the pieces they stand, and none is passed over."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from kinematics.cam.motion.extremes import find_extremes, find_stationary_points


@pytest.mark.parametrize("waves", [0.0, 1.0, 40.0])
@pytest.mark.parametrize("seed", range(6))
def test_extremes_are_the_greatest_of_all_stationary_points(seed: int, waves: float) -> None:
    rng = np.random.default_rng(seed)
    breaks = np.sort(np.concatenate([[0.0, 2.0], rng.uniform(0.0, 2.0, 30)]))
    jumps, slopes = rng.normal(size=31), rng.normal(size=31)

    def function(x: np.ndarray) -> np.ndarray:
        piece = np.clip(np.searchsorted(breaks, x) - 1, 0, 30)
        return np.asarray(jumps[piece] + slopes[piece] * np.sin(waves * x + piece))

    found = find_extremes(function, breaks)
    points, values = find_stationary_points(function, breaks)
    assert (found.least, found.greatest) == (values.min(), values.max())
    assert (found.at_least, found.at_greatest) == (points[values.argmin()], points[values.argmax()])
    fine = np.concatenate([np.linspace(a, b, 400)[1:-1] for a, b in pairwise(breaks)])
    sampled = function(fine)
    assert found.least <= sampled.min() + 1e-12
    assert found.greatest >= sampled.max() - 1e-12
    assert found.greatest <= sampled.max() + 1e-2
