"""The best choice among places: against all choices listed, whatever is branched on."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest

from synthesis.kinds.balancing.rotor import discrete_places as searched
from synthesis.kinds.balancing.rotor.discrete_places import find_best_choices


def listed(target: complex, places: list[Any], most: int) -> dict[int, float]:
    """The least distance by the number of places used, over all choices."""
    least: dict[int, float] = {}
    for picks in itertools.product(*(range(-1, len(place)) for place in places)):
        used = sum(pick >= 0 for pick in picks)
        if used <= most:
            reached = sum(place[pick] for place, pick in zip(places, picks, strict=True) if pick >= 0)
            least[used] = min(least.get(used, np.inf), abs(target - reached))
    return least


@pytest.mark.parametrize("most", [1, 2, 5])
@pytest.mark.parametrize("group", [searched.MAX_GROUP_SUMS, 8])
def test_it_is_the_best_of_all(monkeypatch: pytest.MonkeyPatch, most: int, group: int) -> None:
    monkeypatch.setattr(searched, "MAX_GROUP_SUMS", group)
    rng = np.random.default_rng(3)
    for _ in range(20):
        places = [rng.normal(size=3) + 1j * rng.normal(size=3) for _ in range(5)]
        target = complex(*rng.normal(size=2)) * 2.0
        found = find_best_choices(target, places, most)
        least = listed(target, places, most)
        assert found.proved
        assert found.bound == pytest.approx(min(least.values()), rel=1e-12)
        for choice in found.choices:
            reached = sum(complex(places[n][pick]) for n, pick in choice.picks.items())
            assert abs(choice.residual - (target - reached)) < 1e-12
            assert abs(choice.residual) == pytest.approx(least[len(choice.picks)], rel=1e-12)
        distances = [abs(choice.residual) for choice in found.choices]
        assert distances == sorted(distances, reverse=True)
        assert distances[-1] == pytest.approx(min(least.values()), rel=1e-12)


def test_what_is_not_looked_through_is_not_proved(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(searched, "MAX_GROUP_SUMS", 8)
    monkeypatch.setattr(searched, "MAX_QUERIES", 20)
    rng = np.random.default_rng(4)
    places = [rng.normal(size=3) + 1j * rng.normal(size=3) for _ in range(6)]
    found = find_best_choices(0.3 + 0.2j, places, 6)
    least = min(listed(0.3 + 0.2j, places, 6).values())
    assert not found.proved
    assert found.bound <= least + 1e-12 <= abs(found.choices[-1].residual) + 2e-12


def test_the_bound_is_the_distance_to_what_can_be_summed_up() -> None:
    square = [np.array([1.0 + 0j]), np.array([1j])]
    assert searched._bound_distance(3.0 + 0.5j, square) == pytest.approx(2.0, rel=1e-12)
    assert searched._bound_distance(0.4 + 0.9j, square) == 0.0


@pytest.mark.parametrize("most", [3, 72])
def test_places_that_lie_across_end_soon(monkeypatch: pytest.MonkeyPatch, most: int) -> None:
    """Nothing that the places to be branched on add is of use, and there are 201^68 branches of that."""
    monkeypatch.setattr(searched, "MAX_QUERIES", 200_000)
    angles = np.radians([*(0.001 * k for k in range(4)), *(90.0 + 0.001 * k for k in range(68))])
    places = [np.exp(1j * angle) * np.arange(1.0, 201.0) for angle in angles]
    found = find_best_choices(100.0 + 0j, places, most)
    assert not found.proved
    assert abs(found.choices[-1].residual) < 1e-12


def test_what_makes_no_difference_is_not_looked_for() -> None:
    places = [1e-25 * np.exp(1j * (0.5 * n + np.arange(16))) for n in range(12)]
    found = find_best_choices(100.0 + 0j, places, 12)
    assert [choice.picks for choice in found.choices] == [{}]
    assert found.bound <= abs(found.choices[0].residual) == 100.0
