"""Without limits of the client's the first answer is one that somebody would build, or the summary says why not."""

from __future__ import annotations

import math

import numpy as np
import pytest

from benchmarks.demands import ordinary
from synthesis import parse_problem, solve
from synthesis.outcome.front import error_of
from synthesis.outcome.usable import BAND, usable
from tests.campaign import sampled

# Fits whose nearest linkages transmit force badly: the first of the list was such a one.
CLOSED = {
    "kind": "path",
    "closed": True,
    "points": [
        {"x": 60.0 * math.cos(turn), "y": 30.0 * math.sin(turn) * (1.0 + 0.2 * math.cos(turn))}
        for turn in np.linspace(0.0, math.tau, 40, endpoint=False)
    ],
}


def test_a_usable_fit_stands_before_a_nearer_one_that_nobody_would_build() -> None:
    result = solve(parse_problem(CLOSED))
    near = [design for design in result.designs if error_of(design) <= BAND * min(map(error_of, result.designs))]
    if any(map(usable, near)):
        assert usable(result.designs[0])
    else:
        assert "30°" in result.summary
        assert "link ratio" in result.summary


@pytest.mark.parametrize("limit", [{"min_transmission_angle": 1.0}, {"max_link_ratio": 50.0}])
def test_with_a_limit_the_order_is_the_kinds_own(limit: dict[str, float]) -> None:
    result = solve(parse_problem({**CLOSED, "constraints": limit}))
    assert "First stand" not in result.summary
    errors = [error_of(design) for design in result.designs]
    assert errors[0] <= 1.0001 * min(errors)


@pytest.mark.campaign
@pytest.mark.parametrize("seed", range(sampled(10)))
def test_ordinary_tasks_begin_with_what_one_would_build(seed: int) -> None:
    for task in ordinary.tasks(len(ordinary.KINDS), seed):
        assert task.answered(solve(parse_problem(task.statement))), task.name
