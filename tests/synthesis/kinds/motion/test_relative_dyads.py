"""Dyads between two moving bodies: as many as are proved of one pair, and each a link that keeps its length."""

from __future__ import annotations

import numpy as np
import pytest

from synthesis.kinds.motion.dyads.equations import DyadConditions
from synthesis.kinds.motion.dyads.finite_sets import find_section
from synthesis.kinds.motion.sixbar.relative_dyads import compute_relative_poses, solve_relative_dyads
from synthesis.kinds.motion.task.positions import MotionTask

NONE = complex(np.nan, np.nan)


def poses(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    turns = np.exp(1j * rng.uniform(-2.0, 2.0, 5))
    return rng.normal(size=5) + 1j * rng.normal(size=5), turns / turns[0]


def seen(one, other) -> tuple[np.ndarray, np.ndarray]:
    shift, turn = np.empty(5, np.complex128), np.empty(5, np.complex128)
    compute_relative_poses(*one, *other, shift, turn)
    return shift, turn


def found(shift, turn, fixed=NONE, moving=NONE) -> list[tuple[complex, complex]]:
    pins = np.empty((2, 4), np.complex128)
    count = solve_relative_dyads(shift, turn, fixed, moving, pins[0], pins[1])
    return list(zip(pins[0, :count].tolist(), pins[1, :count].tolist(), strict=True))


@pytest.mark.parametrize("seed", range(40))
def test_they_are_the_dyads_that_are_proved_to_be_all(seed):
    rng = np.random.default_rng(seed)
    still = np.zeros(5, np.complex128), np.ones(5, np.complex128)
    places, turns = poses(rng)
    places = places - places[0]
    proved = find_section(MotionTask(places, turns, 0j, 1.0), DyadConditions(rotations=(None,) * 4))
    assert proved.proved
    near = [(o, a) for o, a in zip(proved.dyads.fixed, proved.dyads.moving, strict=True) if max(abs(o), abs(a)) < 50.0]
    own = found(*seen(still, (places, turns)))
    for o, a in near:
        assert min(abs(o - x) + abs(a - y) for x, y in own) < 1e-8 * (1.0 + abs(o) + abs(a))
    assert sum(max(abs(x), abs(y)) < 50.0 for x, y in own) == len(near)


@pytest.mark.parametrize("seed", range(20))
def test_between_two_moving_bodies_each_link_keeps_its_length(seed):
    rng = np.random.default_rng(100 + seed)
    one, other = poses(rng), poses(rng)
    for fixed, moving in found(*seen(one, other)):
        ends = [z + u * (pin - z[0]) for (z, u), pin in ((one, fixed), (other, moving))]
        lengths = np.abs(ends[1] - ends[0])
        assert np.ptp(lengths) < 1e-9 * lengths.max()


def test_a_dyad_that_is_known_is_left_out_and_another_is_real():
    for seed in range(20):
        rng = np.random.default_rng(seed)
        crank = np.exp(1j * rng.uniform(-1.5, 1.5, 5))
        turns = np.exp(1j * rng.uniform(-1.5, 1.5, 5))
        pivot, pin = 0.7 - 0.4j, 1.3 + 0.8j
        places = pivot + crank / crank[0] * (pin - pivot)
        body = places, turns / turns[0]
        still = np.zeros(5, np.complex128), np.ones(5, np.complex128)
        every = found(*seen(still, body))
        assert any(abs(o - pivot) + abs(a - pin) < 1e-8 for o, a in every)
        rest = found(*seen(still, body), pivot, pin)
        assert len(rest) == len(every) - 1


def test_bodies_that_do_not_move_to_one_another_have_a_family_and_none_is_named():
    still = np.zeros(5, np.complex128), np.ones(5, np.complex128)
    assert found(*seen(still, still)) == []
