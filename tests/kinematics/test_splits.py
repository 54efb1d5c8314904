"""Splits of sums of shifts: slopes decide as golden sections do, over the whole range and at its limits."""

from __future__ import annotations

import math
from random import Random

import pytest

from kinematics.gear import shift_sums, shifting, splits
from kinematics.gear.shifting import MARGIN_RESOLUTION, MARGIN_TOLERANCE, PairConstraints
from kinematics.gear.teeth import compute_straight_depth, invert_involute_tangent


def drawn(rng: Random) -> tuple[int, int, PairConstraints]:
    """A pair and what it has to keep, every third one of helical gears."""
    phi = math.radians(rng.choice([14.5, 17.5, 20.0, 22.5, 25.0, 28.0]))
    shrunk = rng.choice([1.0, 1.0, math.cos(math.radians(20.0))])
    least = rng.uniform(-1.0, 0.1)
    demands = PairConstraints(
        math.atan(math.tan(phi) / shrunk),
        shrunk * compute_straight_depth(phi, 1.25),
        shrunk * least,
        shrunk * (least + rng.uniform(0.1, 2.0)),
        rng.uniform(1.05, 1.6),
        shrunk * rng.uniform(0.1, 0.8),
        shrunk,
    )
    return rng.randint(6, 60), rng.randint(8, 120), demands


def test_slopes_decide_as_golden_sections_do() -> None:
    """Some of the sums are within 1e-9 modules of where the last sound split is lost."""
    rng = Random(5)
    verdicts: list[bool] = []
    for number in range(2500):
        teeth, mate, demands = drawn(rng)
        low, high = 2.0 * demands.least_shift, 2.0 * demands.most_shift
        total = rng.uniform(low, high)
        if number % 3 == 0:
            ends = shift_sums.find_suitable_sums(teeth, mate, low, high, demands)
            if len(ends):
                total = rng.choice(ends.ravel().tolist()) + rng.uniform(-1e-9, 1e-9)
        working, rack = shifting.from_sum(teeth, mate, total, demands), shifting.build_rack(demands)
        if not working.distance > 0.0:
            continue
        sound = shifting.find_best_split(teeth, mate, working, demands, -MARGIN_TOLERANCE)[1] >= -MARGIN_TOLERANCE
        guess = rng.choice([math.nan, rng.uniform(low, high)])
        split = splits.find_sound_split(teeth, mate, working, demands, rack, guess)
        assert math.isinf(split) or sound != math.isnan(split)
        if math.isfinite(split):
            assert shifting.compute_margin(teeth, mate, working, split, demands) >= -MARGIN_TOLERANCE
        assert shift_sums.is_suitable(teeth, mate, working, demands) == sound
        verdicts.append(sound)
        greatest = shifting.find_best_split(teeth, mate, working, demands, math.inf)[1]
        margin = splits.bound_greatest_margin(teeth, mate, working, demands, rack, guess)
        if math.isfinite(margin.split):
            assert margin.most - MARGIN_RESOLUTION <= margin.least
            assert (margin.least >= -MARGIN_TOLERANCE) == sound
            assert shifting.compute_margin(teeth, mate, working, margin.split, demands) == margin.least
        assert margin.least - MARGIN_RESOLUTION <= greatest <= margin.most + 1e-12 or greatest == margin.most
    assert 300 < sum(verdicts) < len(verdicts) - 300


def test_a_pair_nearby_is_the_pair_of_the_sum() -> None:
    """Few of Newton's steps, from the pair of another sum on, and all of them, from afar."""
    rng = Random(6)
    for _ in range(500):
        teeth, mate, demands = drawn(rng)
        rack = shifting.build_rack(demands)
        totals = [rng.uniform(2.0 * demands.least_shift, 2.0 * demands.most_shift) for _ in range(2)]
        _, near = shifting.from_sum_near(teeth, mate, totals[0], rack, 0.0, shifting.FULL_PRECISION)
        told, tangent = shifting.from_sum_near(teeth, mate, totals[1], rack, near, shift_sums.NEWTON_TOLERANCE)
        exact = shifting.from_sum(teeth, mate, totals[1], demands)
        if exact.distance > 0.0:
            assert told == pytest.approx(exact, rel=1e-12, abs=1e-12)
            assert tangent == pytest.approx(told.line / (0.5 * (teeth + mate) * rack.cosine), rel=1e-14)
        else:
            assert math.isnan(told.distance)


def test_newton_goes_to_and_fro_without_a_difference() -> None:
    """The last digits are those of sixty of Newton's steps, whether or not they are all taken."""
    rng = Random(7)
    fro = 0
    for _ in range(3000):
        value = rng.uniform(0.002, 0.08)
        t = min(value + 0.5 * math.pi, 1.2 * (3.0 * value) ** (1.0 / 3.0) + value)
        for _ in range(60):
            step = (t - math.atan(t) - value) * (1.0 + t * t) / (t * t)
            t -= step
            if abs(step) <= 4e-16 * t:
                break
        else:
            fro += 1
        assert invert_involute_tangent(value) == t
    assert fro > 100
