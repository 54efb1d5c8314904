"""Laws and branches of random mechanisms: what other tests show of a few, of up to 10 000 of each type."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from tests.campaign import sampled
from tests.kinematics import mechanism_sampling as sampling
from tests.kinematics.mechanism_sampling import EVERY, RATIOS, take
from tests.support.kinematics.branches import ELIMINATED, TYPES, check, degenerate, same_branches
from tests.support.kinematics.circuits_from_other_links import TURNED, same_circuits
from tests.support.kinematics.mechanism_laws import closes, orders

pytestmark = [pytest.mark.campaign, pytest.mark.timeout(600)]

MANY = sampled(10_000)
"""Designs of each type whose closure, and whose derivatives, are measured."""

ELIMINATIONS = sampled(100)
"""Designs of each type with two dyads or more whose branches are compared; of those with one, five times as many."""

FROM_ANOTHER_LINK = sampled(200)
"""Designs of each type that no dyads close from its input, whose circuits are compared."""

CONTINUATIONS = sampled(8)
"""Designs of each of these types that are followed too; each costs some seconds."""


def until_many(measure: Callable[[int], int]) -> int:
    """Measure batches of designs, by their number, until so many have been that existed at the input drawn."""
    done = rounds = 0
    while done < MANY:
        done += measure(rounds)
        rounds += 1
        assert rounds <= 10, "too few of them exist"
    return done


@pytest.mark.parametrize("name", EVERY)
def test_constraints_hold(name: str) -> None:
    assert until_many(lambda k: closes(name, 610 + k, MANY, 1)) >= MANY


@pytest.mark.parametrize("name", EVERY)
def test_each_order_is_the_rate_of_the_one_below(name: str) -> None:
    assert until_many(lambda k: orders(name, 620 + k, MANY)) >= MANY


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


@pytest.mark.parametrize("name", TURNED)
def test_circuits_are_those_by_elimination_from_another_link(name: str) -> None:
    mechanism = EVERY[name](np.random.default_rng([67, TURNED.index(name)]), FROM_ANOTHER_LINK)
    for k in range(FROM_ANOTHER_LINK):
        same_circuits(name, take(mechanism, k))


@pytest.mark.parametrize("name", TURNED)
def test_branches_are_those_by_continuation(name: str) -> None:
    rng = np.random.default_rng([65, TYPES.index(name)])
    mechanism = EVERY[name](rng, CONTINUATIONS)
    for k in range(CONTINUATIONS):
        check(take(mechanism, k), rng, 1)


@pytest.mark.parametrize("name", EVERY)
def test_degenerate_designs_are_answered_right_or_refused(name: str) -> None:
    assert degenerate(name, 66, 60) > 15
