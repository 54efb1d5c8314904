"""Function generators that are put where they fit into a room: planted tasks held by shapely, and no false proof."""

from __future__ import annotations

import pytest

from synthesis.dispatch import solve
from synthesis.registry import parse_problem
from tests.campaign import further
from tests.support.fit.function import GROUPS, statement
from tests.support.fit.task import generator
from tests.support.fit.verdict import violations


@pytest.mark.parametrize("number", further(range(len(GROUPS)), [1, 2, 3]))
def test_a_planted_function_is_answered_in_its_room(number: int) -> None:
    stated = {**statement(generator(1, number), GROUPS[number]), "max_designs": 2}
    passed = [design for design in solve(parse_problem(stated)).designs if design.verification.passed]
    assert passed
    for design in passed:
        assert violations(stated, design) == []


@pytest.mark.slow
def test_that_no_place_is_found_is_no_proof() -> None:
    stated = statement(generator(1, 2), GROUPS[2])
    o2 = {"circle": {"center": [0.0, 0.0], "radius": 10.0}}
    o4 = {"circle": {"center": [100.0, 0.0], "radius": 10.0}}
    stated["space"] = {
        "fixed_pivots": {"input": o2, "output": o4},
        "obstacles": [{"polygon": [[-90.0, -80.0], [90.0, -80.0], [90.0, 80.0], [-90.0, 80.0]]}],
    }
    result = solve(parse_problem(stated))
    assert not any(design.verification.passed for design in result.designs)
    assert not result.search.complete
    del stated["space"]["obstacles"]
    assert any(design.verification.passed for design in solve(parse_problem(stated)).designs)
