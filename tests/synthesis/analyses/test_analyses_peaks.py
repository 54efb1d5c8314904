"""Peaks along a motion, against functions whose greatest values are known."""

from __future__ import annotations

import numpy as np
import pytest

from synthesis.analyses.linkages.peaks import find_peaks


@pytest.mark.parametrize(("begin", "end"), [(0.0, 1.0), (1.0, 0.0), (0.0, 4.0), (-2.0, 5.0)])
def test_a_peak_at_an_end_is_that_of_the_end_and_one_between_is_that_of_the_function(begin, end):
    at = np.linspace(begin, end, 41)

    def measure(inputs, _speeds):
        return {"sine": np.sin(inputs), "fall": np.exp(-inputs)}

    found = find_peaks(at, np.ones_like(at), measure(at, at), measure, closed=False)
    low, high = min(begin, end), max(begin, end)
    assert (found["fall"].at, found["fall"].value) == (low, np.exp(-low))
    if high < 0.5 * np.pi:
        assert (found["sine"].at, found["sine"].value) == (high, np.sin(high))
    else:
        assert found["sine"] == pytest.approx((1.0, 0.5 * np.pi), rel=1e-6)
    assert all(low <= peak.at <= high for peak in found.values())


@pytest.mark.parametrize("place", [3.3, 3.337, 3.35])
def test_a_narrow_peak_between_positions_is_found_beside_a_broad_one_of_higher_positions(place):
    """The broad one has the highest position; the narrow one, a step wide, is a third higher between two."""
    at = np.linspace(0.0, 2.0 * np.pi, 73)

    def measure(inputs, _speeds):
        return {"both": 0.9 * np.cos(inputs - 0.7) ** 4 + 1.2 / (1.0 + ((inputs - place) / 0.05) ** 2)}

    found = find_peaks(at, np.ones_like(at), measure(at, at), measure, closed=True)["both"]
    dense = np.linspace(0.0, 2.0 * np.pi, 2_000_001)
    assert found.value == pytest.approx(measure(dense, dense)["both"].max(), rel=1e-7)


def test_of_many_doubtful_places_those_that_may_be_highest_are_looked_at():
    """A quantity that bends everywhere and rises to its peak at the end of the turn."""
    at = np.linspace(0.0, 2.0 * np.pi, 8001)

    def measure(inputs, _speeds):
        ripple = 0.3 * np.cos(3000.0 * inputs + 1.0)
        return {"rippled": 1.0 + ripple + 0.3 / (1.0 + ((inputs - 6.2) / 0.001) ** 2)}

    found = find_peaks(at, np.ones_like(at), measure(at, at), measure, closed=True)["rippled"]
    dense = np.linspace(6.19, 6.21, 2_000_001)
    assert found.value == pytest.approx(measure(dense, dense)["rippled"].max(), rel=1e-4)


def test_a_peak_at_the_end_of_a_motion_that_closes_is_beyond_it():
    at = np.linspace(0.0, 2.0 * np.pi, 73)

    def measure(inputs, _speeds):
        return {"cosine": np.cos(inputs + 1e-5)}

    found = find_peaks(at, np.ones_like(at), measure(at, at), measure, closed=True)["cosine"]
    assert found.value == pytest.approx(1.0, abs=1e-12)


def test_positions_without_values_hide_no_peak_beside_them():
    at = np.linspace(0.0, 4.0, 41)

    def measure(inputs, _speeds):
        return {"sine": np.where(inputs > 2.0, np.nan, np.sin(inputs))}

    found = find_peaks(at, np.ones_like(at), measure(at, at), measure, closed=False)["sine"]
    assert found == pytest.approx((1.0, 0.5 * np.pi), rel=1e-6)
