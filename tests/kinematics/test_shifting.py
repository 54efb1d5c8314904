"""Sums of profile shifts and their splits: against dense grids, where the method takes few maxima for granted."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numba import njit
from numpy.typing import NDArray

from kinematics.gear import shift_sums, shifting
from kinematics.gear.flanks import Contact, compute_rack_form
from kinematics.gear.shifting import PairConstraints
from kinematics.gear.teeth import Gear, Mesh, compute_straight_depth


def demands(angle: float, least: float, most: float, ratio: float, tip: float) -> PairConstraints:
    phi = math.radians(angle)
    return PairConstraints(phi, compute_straight_depth(phi, 1.25), least, most, ratio, tip)


ASKED = [
    demands(20.0, -0.5, 1.0, 1.2, 0.25),
    demands(20.0, -0.3, 0.6, 1.5, 0.4),
    demands(25.0, -0.5, 1.0, 1.1, 0.2),
    demands(14.5, -1.0, 1.5, 1.6, 0.3),
]


@njit
def on_a_grid(
    teeth: int, mate: int, low: float, high: float, sums: int, splits: int, asked: PairConstraints
) -> NDArray[np.bool_]:
    """Which sums between two have a split on a grid that keeps all demands."""
    kept = np.zeros(sums + 1, np.bool_)
    for i in range(sums + 1):
        working = shifting.from_sum(teeth, mate, low + (high - low) * i / sums, asked)
        if not working.distance > 0.0:
            continue
        for j in range(splits + 1):
            shift = asked.least_shift + (asked.most_shift - asked.least_shift) * j / splits
            other = working.total - shift
            if asked.least_shift <= other <= asked.most_shift:
                kept[i] |= shifting.compute_margin(teeth, mate, working, shift, asked) >= 0.0
    return kept


def grids_agree(asked: PairConstraints, numbers: range, sums: int, splits: int) -> int:
    """Compare every pair of the numbers with a grid; how many suit."""
    suited = 0
    low, high = 2.0 * asked.least_shift, 2.0 * asked.most_shift
    for teeth in numbers:
        for mate in numbers[numbers.index(teeth) :]:
            kept = np.flatnonzero(on_a_grid(teeth, mate, low, high, sums, splits, asked))
            if not len(kept):
                continue
            suited += 1
            parts = shift_sums.find_suitable_sums(teeth, mate, low, high, asked)
            assert math.isfinite(shift_sums.find_suitable_sum(teeth, mate, low, high, asked)), (teeth, mate)
            for total in low + (high - low) * kept / sums:
                assert any(near - 1e-9 <= total <= far + 1e-9 for near, far in parts), (teeth, mate, total)
            for near, far in parts:
                assert all(sum_suits(teeth, mate, total, asked) for total in np.linspace(near, far, 7)), (teeth, mate)
                assert near == low or not sum_suits(teeth, mate, near - 1e-6, asked)
                assert far == high or not sum_suits(teeth, mate, far + 1e-6, asked)
    return suited


def sum_suits(teeth: int, mate: int, total: float, asked: PairConstraints) -> bool:
    working = shifting.from_sum(teeth, mate, total, asked)
    return bool(working.distance > 0.0 and shift_sums.is_suitable(teeth, mate, working, asked))


@pytest.mark.parametrize("asked", ASKED)
def test_all_sums_that_suit_are_found(asked: PairConstraints) -> None:
    assert grids_agree(asked, range(11, 60, 12), 120, 60) > 2


@pytest.mark.campaign
@pytest.mark.timeout(900)
@pytest.mark.parametrize("asked", ASKED)
def test_all_sums_of_all_pairs_are_found(asked: PairConstraints) -> None:
    assert grids_agree(asked, range(8, 101), 150, 80) > 100


def test_sums_that_suit_may_be_two_intervals() -> None:
    """12:33 keeps a tip of 0.45 modules and a contact ratio of 1.22 with less shift and with more, not between."""
    asked = demands(25.0, -0.35, 0.72, 1.22, 0.45)
    parts = shift_sums.find_suitable_sums(12, 33, -0.7, 1.44, asked)
    assert parts == pytest.approx(np.array([[-0.3552, -0.2077], [0.2223, 0.9171]]), abs=1e-3)
    grid = np.flatnonzero(on_a_grid(12, 33, -0.7, 1.44, 1000, 400, asked))
    assert np.count_nonzero(np.diff(grid) > 100) == 1
    for total in -0.7 + 2.14 * grid / 1000:
        assert any(near <= total <= far for near, far in parts)


@pytest.mark.parametrize(
    ("pair", "asked"),
    [
        ((20, 59), demands(20.0, -0.1, 1.0, 1.2, 0.7339)),
        ((16, 23), demands(20.0, -0.5, 0.72, 1.1, 0.6609)),
        ((29, 50), demands(14.5, -0.35, 0.3, 1.6, 0.9105)),
    ],
)
def test_sums_between_those_of_the_grid_are_found(pair: tuple[int, int], asked: PairConstraints) -> None:
    """Where sums suit over some 1e-3, the search goes by the true margins of those that do not."""
    sound = shift_sums.find_suitable_sum(*pair, 2.0 * asked.least_shift, 2.0 * asked.most_shift, asked)
    assert sum_suits(*pair, sound, asked)


@pytest.mark.parametrize("asked", ASKED)
@pytest.mark.parametrize("pair", [(23, 23), (18, 55), (25, 30), (40, 90)])
def test_the_split_is_the_nearest_to_balanced_sliding(pair: tuple[int, int], asked: PairConstraints) -> None:
    """Of 2000 splits none that keeps the demands has less difference of specific sliding."""
    sound = shift_sums.find_suitable_sum(*pair, 2.0 * asked.least_shift, 2.0 * asked.most_shift, asked)
    if not math.isfinite(sound):
        pytest.fail("a pair of this table suits")
    working = shifting.from_sum(*pair, sound, asked)
    chosen = shifting.find_balanced_split(*pair, working, asked)

    def unbalanced(shift: float) -> float:
        gears = [
            Gear(z, 1.0, asked.pressure_angle, 1.0 - working.shortening, shift=x)
            for z, x in zip(pair, (shift, working.total - shift), strict=True)
        ]
        forms = compute_rack_form(gears[0], asked.depth), compute_rack_form(gears[1], asked.depth)
        one, two = Contact(Mesh(gears[0], gears[1]), forms).specific_sliding
        return abs(one - two)

    others = np.linspace(asked.least_shift, asked.most_shift, 2001)
    kept = [
        float(x)
        for x in others
        if asked.least_shift <= working.total - x <= asked.most_shift
        and shifting.compute_margin(*pair, working, float(x), asked) >= 0.0
    ]
    assert shifting.compute_margin(*pair, working, chosen, asked) >= -shifting.MARGIN_TOLERANCE
    assert unbalanced(chosen) <= min((unbalanced(x) for x in kept), default=math.inf) + 1e-6
