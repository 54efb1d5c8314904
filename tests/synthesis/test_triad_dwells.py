"""Stephenson II dwell sixbars as the search has them, held against the analysis core, and their exact way."""

from __future__ import annotations

import math
from itertools import combinations

import numpy as np
import pytest

from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.mechanism import Mechanism
from synthesis.kinds.dwell import triads
from synthesis.kinds.dwell.candidates import Start
from synthesis.kinds.dwell.outputs import CYCLE, RESTING, Task
from synthesis.kinds.dwell.shaped import TRIAD, Sixbar, way_of, with_way
from synthesis.kinds.dwell.triad_starts import EASED, triad_starts
from synthesis.kinds.dwell.triad_turn import BEGIN, LEAST

DWELLS, PLACES, WAY, ANGLE, RATIO = (1.2, 0.7), (0.0, 0.6), 0.9, 0.4, 8.0


@pytest.fixture(scope="module")
def begun() -> list[Start]:
    found = triad_starts(DWELLS, PLACES, WAY, ANGLE, RATIO, np.random.default_rng(3), 12)
    assert len(found) == 12
    return found


def built(shape: np.ndarray) -> Mechanism:
    return Mechanism(triads.joints(shape), dict(TRIAD), "input")


def test_starts_move_as_the_core_drives_them(begun: list[Start]) -> None:
    for start in begun:
        shape = start.shape
        further = shape[BEGIN] + np.array([[0.3, 2.0, 5.9]])
        driven = triads.over_a_turn(shape[None], further, CYCLE)
        inputs = shape[BEGIN] + np.arange(CYCLE + 1) * math.tau / CYCLE
        motion = drive(built(shape), inputs, order=0)
        assert motion.smooth.all()
        output = motion.angles["output"][0]
        assert np.allclose(np.unwrap(output)[:-1] - output[0], driven.turn[0], atol=1e-9)
        told = np.abs(np.stack([motion.sines[name] for name in ("output", "link_3", "link_5")], axis=-1))
        assert np.allclose(told[:-1], driven.sines[0], atol=1e-9)
        assert driven.sines.min() > EASED
        elsewhere = drive(built(shape), np.concatenate([inputs[:1], further[0]]), order=0).joints
        for k, joint in enumerate("BDE"):
            assert np.allclose(elsewhere[joint][0][1:], driven.pins[0, :, k], atol=1e-9)


def test_distances_are_those_of_all_pins(begun: list[Start]) -> None:
    for start in begun:
        joints = triads.joints(start.shape)
        pins = [abs(joints[a] - joints[b]) for link in TRIAD.values() for a, b in combinations(link, 2)]
        assert sorted(triads.pin_distances(start.shape[None])[0]) == pytest.approx(sorted(pins))


def test_a_start_rests_where_it_says(begun: list[Start]) -> None:
    """The stretch of the turn is the stillest near its place, by plain windows over the output."""
    for start in begun:
        task = Task("triad", 1, DWELLS, start.places, WAY, math.sin(ANGLE), RATIO)
        values = triads.judged(task, np.linspace(0.0, 1.0, RESTING), start.shape[None])
        turn = triads.over_a_turn(start.shape[None], np.empty((1, 0)), CYCLE).turn[0]
        around = np.concatenate([turn, turn])
        for k, (dwell, place) in enumerate(zip(DWELLS, start.places, strict=True)):
            steps = round(dwell / math.tau * CYCLE) + 1
            windows = np.stack([around[m : m + steps] for m in range(CYCLE)])
            share = (windows.mean(axis=1) - turn.min()) / np.ptp(turn)
            worth = (np.ptp(windows, axis=1) / np.ptp(turn) + 0.5 * np.abs(share - place)).min()
            moved = np.ptp(values.banded[0, k * RESTING : (k + 1) * RESTING])
            assert moved <= worth + 0.05


def test_the_pivot_moves_along_the_line_of_the_resting_pin(begun: list[Start]) -> None:
    for start in begun:
        sixbar = Sixbar("triad", 1, start.shape, "coupler", len(DWELLS))
        made = with_way(sixbar, way_of(sixbar) * 1.02)
        if made is None:
            continue
        assert way_of(made) == pytest.approx(1.02 * way_of(sixbar), rel=1e-9)
        one, other = triads.joints(start.shape), triads.joints(made.shape)
        turned = (other["E"] - other["O2"]) / (one["E"] - one["O2"])
        assert abs(turned) == pytest.approx(1.0)
        for pin in "ABCD":
            assert other[pin] == pytest.approx(one[pin] * turned)
        line = (other["O4"] - other["E"]) / ((one["O4"] - one["E"]) * turned)
        assert line.imag == pytest.approx(0.0, abs=1e-9)
        return
    pytest.fail("no way could be changed")


def test_what_does_not_go_through_its_turn_is_no_shape(begun: list[Start]) -> None:
    shape = begun[0].shape.copy()
    joints = triads.joints(shape)
    e = joints["O4"] + 0.02 * (joints["E"] - joints["O4"])
    shape[7:9] = e.real, e.imag
    values = triads.judged(
        Task("triad", 1, DWELLS, PLACES, WAY, math.sin(ANGLE), RATIO), np.linspace(0.0, 1.0, 5), shape[None]
    )
    assert np.isnan(values.banded).any()


def test_links_are_as_even_as_is_asked(begun: list[Start]) -> None:
    """Room of the ratio is there where all distances are between the least one and so many times that."""
    shape = begun[0].shape.copy()
    lengths = triads.pin_distances(shape[None])[0]
    for ratio in (0.99, 1.01):
        shape[LEAST] = lengths.min() * 0.9999
        task = Task("triad", 1, DWELLS, PLACES, WAY, 0.0, ratio * lengths.max() / shape[LEAST])
        even = triads.judged(task, np.linspace(0.0, 1.0, 5), shape[None]).positive[0, -2 * len(lengths) :]
        assert (even > 0.0).all() == (ratio > 1.0)
