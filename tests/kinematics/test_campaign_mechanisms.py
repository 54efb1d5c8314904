"""Laws and branches of random mechanisms by the thousand: what other tests show of a few, of 10 000 of each type."""

from __future__ import annotations

import numpy as np
import pytest

from tests.kinematics import mechanism_sampling as sampling
from tests.kinematics.mechanism_sampling import CLASS_THREE, EVERY, RATIOS, take
from tests.kinematics.test_branches import ELIMINATED, TYPES, check, degenerate, same_branches
from tests.kinematics.test_mechanism_laws import closes, orders

pytestmark = [pytest.mark.campaign, pytest.mark.timeout(600)]

MANY = 10_000
"""Designs of each type that are closed and differentiated."""

ELIMINATIONS = 25
"""Designs of each type with two dyads or more whose branches are compared; of those with one, five times as many."""

CONTINUATIONS = 2
"""Designs of each type that no dyads close from its input; each costs some seconds."""


@pytest.mark.parametrize("name", EVERY)
def test_constraints_hold(name: str) -> None:
    closes(name, 61, MANY, 1)


@pytest.mark.parametrize("name", EVERY)
def test_each_order_is_the_rate_of_the_one_below(name: str) -> None:
    assert orders(name, 62, MANY) > MANY // 8


@pytest.mark.parametrize("name", ELIMINATED)
def test_branches_are_those_by_elimination(name: str) -> None:
    count = ELIMINATIONS * (5 if name in ("fourbar", "slider-crank", "inverted slider-crank") else 1)
    mechanism = EVERY[name](np.random.default_rng([63, list(EVERY).index(name)]), count)
    for k in range(count):
        same_branches(take(mechanism, k))


@pytest.mark.parametrize("ratio", RATIOS)
def test_branches_of_geared_fivebars_are_those_by_elimination(ratio: float) -> None:
    turns = {0.5: 2, 2.0 / 3.0: 3}.get(ratio, 1)
    mechanism = sampling.geared_fivebar(np.random.default_rng([64, RATIOS.index(ratio)]), ELIMINATIONS, ratio)
    for k in range(ELIMINATIONS):
        same_branches(take(mechanism, k), turns)


@pytest.mark.parametrize("name", [*CLASS_THREE, "slider-crank driven by its slider"])
def test_branches_are_those_by_continuation(name: str) -> None:
    rng = np.random.default_rng([65, TYPES.index(name)])
    mechanism = EVERY[name](rng, CONTINUATIONS)
    for k in range(CONTINUATIONS):
        check(take(mechanism, k), rng, 1)


@pytest.mark.parametrize("name", EVERY)
def test_degenerate_designs_are_answered_right_or_refused(name: str) -> None:
    assert degenerate(name, 66, 60) > 15
