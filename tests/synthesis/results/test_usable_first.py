"""Without limits of the client's the first answer is one that somebody would build, or the summary says why not."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from synthesis import parse_problem, solve
from synthesis.kinds.straight_line.design import StraightLineMetrics
from synthesis.results.pareto import measure_error
from synthesis.results.practicality import ERROR_BAND, is_usable, sort_usable_first
from tests.campaign import sampled
from tests.support.demands import ordinary

# Fits whose nearest linkages transmit force badly: the first of the list was such a one.
CLOSED = {
    "kind": "path",
    "closed": True,
    "points": [
        {"x": 60.0 * math.cos(turn), "y": 30.0 * math.sin(turn) * (1.0 + 0.2 * math.cos(turn))}
        for turn in np.linspace(0.0, math.tau, 40, endpoint=False)
    ],
}


@pytest.mark.campaign
def test_a_usable_fit_stands_before_a_nearer_one_that_nobody_would_build() -> None:
    result = solve(parse_problem(CLOSED))
    near = [
        design
        for design in result.designs
        if measure_error(design) <= ERROR_BAND * min(map(measure_error, result.designs))
    ]
    if any(map(is_usable, near)):
        assert is_usable(result.designs[0])
    else:
        assert "30°" in result.summary
        assert "link ratio" in result.summary


@pytest.mark.campaign
@pytest.mark.parametrize("limit", [{"min_transmission_angle": 1.0}, {"max_link_ratio": 50.0}])
def test_with_a_limit_the_order_is_the_kinds_own(limit: dict[str, float]) -> None:
    result = solve(parse_problem({**CLOSED, "constraints": limit}))
    assert "are listed first" not in result.summary
    errors = [measure_error(design) for design in result.designs]
    assert errors[0] <= 1.0001 * min(errors)


def made(transmission: float, ratio: float, reach: float | None, error: float = 1.0) -> Any:
    """A design that passed, by its measures alone."""
    return SimpleNamespace(
        verification=SimpleNamespace(passed=True),
        metrics=StraightLineMetrics.model_construct(
            min_transmission_angle=transmission, link_ratio=ratio, reach=reach, straightness_error=error
        ),
    )


def test_a_link_far_longer_than_the_task_gives_way_or_is_told() -> None:
    problem = parse_problem(CLOSED)
    long, short, flat = made(40.0, 3.0, 8.0), made(35.0, 4.0, 3.0), made(20.0, 4.0, 2.0)
    found = sort_usable_first(problem, [long, flat, short])
    assert found.designs == [short, long, flat]
    assert "no link longer than 5 times the task's size" in found.remark
    # Where every one is too long, or weak, angle and ratio count before reach, and the summary says what is relaxed.
    found = sort_usable_first(problem, [flat, long])
    assert found.designs == [long, flat]
    assert "No design found" in found.remark
    assert "no link longer than 5 times" in found.remark
    # Where the first is only too long the order stays.
    found = sort_usable_first(problem, [long, flat, made(40.0, 3.0, 6.0)])
    assert found.designs[1] is flat
    assert "no link longer than 5 times" in found.remark
    assert sort_usable_first(problem, [made(40.0, 3.0, None), long]).remark == ""


def test_what_the_first_design_lacks_is_told_where_it_is_not_among_the_nearest() -> None:
    first, nearest = made(40.0, 4.5, 5.9, error=5.0), made(29.0, 6.5, 7.6)
    found = sort_usable_first(parse_problem(CLOSED), [first, nearest])
    assert found.designs == [first, nearest]
    assert found.remark == (
        "No design within 2 times the smallest error has a transmission angle of 30° or more and a link ratio of 10 "
        "or less"
        " and no link longer than 5 times the task's size."
    )


def test_reach_is_the_longest_side_of_a_link_in_sizes_of_the_task() -> None:
    result = solve(parse_problem({"kind": "quick_return", "time_ratio": 1.3, "stroke": 80.0, "mechanism": "whitworth"}))
    for design in result.designs:
        sides = design.mechanism.links
        assert design.metrics.reach == pytest.approx(max(sides.ground, sides.crank, sides.rocker, sides.coupler) / 80.0)


@pytest.mark.campaign
@pytest.mark.parametrize("seed", range(sampled(10)))
def test_ordinary_tasks_begin_with_what_one_would_build(seed: int) -> None:
    for task in ordinary.tasks(len(ordinary.KINDS), seed):
        assert task.answered(solve(parse_problem(task.statement))), task.name
