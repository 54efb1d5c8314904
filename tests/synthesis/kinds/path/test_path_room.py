"""Paths that are steered into a room: margins of a fourbar against differences, and planted tasks held by shapely."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from kinematics.arrays import Real
from synthesis.dispatch import solve
from synthesis.fit.chart import FOURBAR, compute_lengths
from synthesis.fit.fourbar_workspace import (
    NO_BODY,
    append_workspace_rows,
    compute_workspace_margins,
    find_crank_interval,
)
from synthesis.fit.workspace import pack_workspace
from synthesis.fit.workspace_margins import ROW_SIZE, count_margins
from synthesis.model.linkage.workspace import Space
from synthesis.registry import parse_problem
from tests.campaign import further
from tests.support.fit.path import GROUPS, statement
from tests.support.fit.task import generator
from tests.support.fit.verdict import violations

SPACE: dict[str, Any] = {
    "fixed_pivots": {"input": {"circle": {"center": [0, 0], "radius": 0.2}}},
    "moving_pivots": {"output": {"polygon": [[0, 0.5], [1, 0.5], [1, 1.5], [0, 1.5]]}},
    "box": [[-0.6, -0.5], [1.2, 1.0]],
    "obstacles": [{"circle": {"center": [0.3, 0.8], "radius": 0.3}}, {"polygon": [[1, -1], [2, 0], [1, 0.3]]}],
    "clearance": 0.02,
    "link_width": 0.05,
}


def rows_of(x: Real, ends: Real, turns: Real, room: Real) -> tuple[Real, Real, Real]:
    """Margins of a fourbar, and the rows of those that bear a load, with their residuals."""
    lengths, slopes, count = np.empty(4), np.empty((4, 4)), count_margins(room)
    compute_lengths(FOURBAR, x, lengths, slopes)
    multipliers, values = np.zeros(count + 1), np.empty(count)
    multipliers[count] = 1.0
    residuals, jacobian = np.zeros(count), np.zeros((count, len(x)))
    m = append_workspace_rows(
        x, lengths, slopes, 1.0, ends, turns, False, NO_BODY, room, multipliers, values, residuals, jacobian, 0
    )  # fmt: skip
    assert m >= 0
    return values, residuals[:m], jacobian[:m]


@pytest.mark.parametrize("over", ["used", "cycle"])
def test_rows_of_a_room_have_the_slopes_of_differences(over: str) -> None:
    room = pack_workspace(Space.model_validate({**SPACE, "over": over}), 0j, 1.0)
    rng = np.random.default_rng(2)
    agreed = looked_at = 0
    for _ in range(4):
        # A tenth unknown turns the crank at the last point alone.
        x = np.array([0, 0, 0.1, 0, math.log(0.4), 0, 0, 0.5, 0.4, 0]) + 0.05 * rng.normal(size=10)

        def ends(x: Real) -> Real:
            return np.array([0.4 + 0.2 * x[7], 1.6 + x[9]])

        turns = np.zeros((2, 10))
        turns[0, 7] = 0.2
        turns[1, 9] = 1.0
        values, residuals, jacobian = rows_of(x, ends(x), turns, room)
        loaded = np.flatnonzero(values < 0.0)
        differences = np.empty((len(loaded), 10))
        for i in range(10):
            step = np.zeros(10)
            step[i] = 1e-6
            after, _, _ = rows_of(x + step, ends(x + step), turns, room)
            before, _, _ = rows_of(x - step, ends(x - step), turns, room)
            differences[:, i] = (after[loaded] - before[loaded]) / 2e-6
        assert residuals == pytest.approx(-values[loaded])
        apart = np.abs(jacobian + differences).max(axis=1)
        agreed += int((apart < 1e-4).sum())
        looked_at += len(loaded)
    # Where the nearest place is at a kink a difference is the slope of neither side.
    assert looked_at > 30
    assert agreed > 0.8 * looked_at


@pytest.mark.parametrize(
    "lengths",
    [(1.0, 0.4, 1.0, 1.0), (0.4, 1.0, 1.0, 0.9), (1.0, 1.0, 0.4, 0.9), (1.0, 0.9, 0.5, 0.4), (0.6, 0.5, 1.2, 0.3)],
)
def test_a_cycle_is_held_as_far_as_the_crank_turns(lengths: tuple[float, ...]) -> None:
    room = pack_workspace(Space.model_validate({**SPACE, "over": "cycle"}), 0j, 1.0)
    every = np.array(lengths)
    d, a, b, c = lengths
    turns = np.linspace(-math.pi, math.pi, 3601)
    reach = np.abs(d - a * np.exp(1j * turns))
    closes = (reach <= b + c) & (reach >= abs(b - c))
    for first in turns[closes][::400]:
        begin, end, ring, _ = find_crank_interval(every, np.array([first, first + 0.1]), False, room)
        swept = np.linspace(begin, end, 1001)
        inside = np.abs(d - a * np.exp(1j * swept))
        assert np.all((inside <= b + c) & (inside >= abs(b - c)))
        assert ring == bool(closes.all())
        if not ring:
            assert np.abs(np.exp(1j * swept) - np.exp(1j * first)).min() < 0.01
            beyond = np.abs(d - a * np.exp(1j * np.array([begin - 0.002, end + 0.002])))
            assert np.all((beyond > b + c) | (beyond < abs(b - c)))


def test_zones_are_of_the_first_point() -> None:
    room = pack_workspace(Space.model_validate({"fixed_pivots": SPACE["fixed_pivots"]}), 0j, 1.0)
    lengths = np.array([1.0, 0.4, 1.0, 1.0])
    x = np.array([0.1, 0.0, 0.3, *np.log(lengths), 0.5, 0.4])
    values, rows = np.empty(1), np.empty((1, ROW_SIZE))
    assert compute_workspace_margins(x, lengths, 1.0, np.array([0.4, 1.0]), False, NO_BODY, room, values, rows)
    assert values[0] == pytest.approx(0.1, abs=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("number", further([0, 4, 6, 7, 8], [0]))
def test_a_planted_path_is_answered_in_its_room(number: int) -> None:
    stated = {**statement(generator(1, number), GROUPS[number]), "max_designs": 2}
    result = solve(parse_problem(stated))
    passed = [design for design in result.designs if design.verification.passed]
    assert passed
    for design in passed:
        assert violations(stated, design) == []


@pytest.mark.slow
@pytest.mark.parametrize("number", [5, 6])
def test_an_empty_room_changes_nothing(number: int) -> None:
    stated = {**statement(generator(1, number), GROUPS[number]), "max_designs": 2}
    del stated["space"]
    bare, empty = (solve(parse_problem({**stated, **more})) for more in ({}, {"space": {}}))
    assert bare.designs
    assert bare == empty
