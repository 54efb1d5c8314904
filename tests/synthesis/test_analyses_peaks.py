"""Peaks along a motion, against functions whose greatest values are known."""

from __future__ import annotations

import numpy as np
import pytest

from synthesis.analyses.peaks import peaks


@pytest.mark.parametrize(("begin", "end"), [(0.0, 1.0), (1.0, 0.0), (0.0, 4.0), (-2.0, 5.0)])
def test_a_peak_at_an_end_is_that_of_the_end_and_one_between_is_that_of_the_function(begin, end):
    at = np.linspace(begin, end, 41)

    def measure(inputs, _speeds):
        return {"sine": np.sin(inputs), "fall": np.exp(-inputs)}

    found = peaks(at, np.ones_like(at), measure(at, at), measure, closed=False)
    low, high = min(begin, end), max(begin, end)
    assert (found["fall"].at, found["fall"].value) == (low, np.exp(-low))
    if high < 0.5 * np.pi:
        assert (found["sine"].at, found["sine"].value) == (high, np.sin(high))
    else:
        assert found["sine"] == pytest.approx((1.0, 0.5 * np.pi), rel=1e-6)
    assert all(low <= peak.at <= high for peak in found.values())
