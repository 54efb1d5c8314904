"""Fields beside sixbars, through HTTP: with another value the mechanisms that are answered are others."""

from __future__ import annotations

import itertools
import math
from typing import Any

import pytest

from tests.service.stated.row import Row, changed
from tests.service.stated.sixbars import TABLES, TOGETHER, TOLD
from tests.support.service.answers import finished

ROWS = [
    pytest.param(kind, name, marks=pytest.mark.campaign, id=f"{kind}: {name}")
    for kind, (_, rows) in TABLES.items()
    for name in rows
]

ROUNDING = 1e-6


@pytest.fixture(scope="module")
def known() -> list[tuple[dict[str, Any], list[dict[str, Any]]]]:
    """What was answered to each problem: many rows begin from one."""
    return []


def designs(client, known, problem) -> list[dict[str, Any]]:
    for stated, answer in known:
        if stated == problem:
            return answer
    job = finished(client, problem)
    assert job["status"] == "succeeded", job
    known.append((problem, job["result"]["designs"]))
    return known[-1][1]


def made(answer: list[dict[str, Any]]) -> list[dict[str, Any]]:
    return [design["mechanism"] for design in answer if design["verification"]["passed"]]


def keeps(stated: dict[str, Any], design: dict[str, Any]) -> None:
    """What a design tells of its dimensions is within what is stated, looked at without the checks that it tells of."""
    limits, metrics, mechanism = stated.get("constraints", {}), design["metrics"], design["mechanism"]
    joints = mechanism["skeleton"]["joints"]
    pivots = set(next(link["joints"] for link in mechanism["skeleton"]["links"] if link["name"] == "ground"))
    lengths = [
        math.dist(joints[one], joints[other])
        for link in mechanism["skeleton"]["links"]
        for one, other in itertools.combinations([name for name in link["joints"] if name != "P"], 2)
    ]
    length = limits.get("link_length", {})
    assert length.get("min", 0.0) <= min(lengths) * (1.0 + ROUNDING)
    assert max(lengths) <= length.get("max", math.inf) * (1.0 + ROUNDING)
    assert max(lengths) <= limits.get("max_link_ratio", math.inf) * min(lengths) * (1.0 + ROUNDING)
    assert metrics["min_transmission_angle"] >= limits.get("min_transmission_angle", 0.0) - ROUNDING
    assert limits.get("grashof", "any") in ("any", metrics["grashof"])
    for name, place in joints.items():
        region = (
            limits.get("fixed_pivot_region" if name in pivots else "moving_pivot_region", {}) if name != "P" else {}
        )
        for value, (low, high) in zip(place, (region.get(axis, (-math.inf, math.inf)) for axis in "xy"), strict=True):
            assert low - ROUNDING * abs(low) <= value <= high + ROUNDING * abs(high), name


@pytest.mark.timeout(300)
@pytest.mark.parametrize(("kind", "name"), ROWS)
def test_a_field_makes_other_sixbars(client, known, kind, name):
    problem, rows = TABLES[kind]
    row = rows[name] if isinstance(rows[name], Row) else Row(rows[name])
    base = changed(problem, row.base)
    other = changed(base, {row.at or name: row.value})
    before, after = (designs(client, known, stated) for stated in (base, other))
    for design in after:
        if design["verification"]["passed"]:
            keeps(other, design)
    if name in TOLD:
        assert before != after, "the field is ignored"
        return
    assert made(before), "nothing to be changed"
    assert made(before) != made(after), "the field is ignored"


@pytest.mark.campaign
@pytest.mark.timeout(300)
@pytest.mark.parametrize("kind", TOGETHER)
def test_demands_are_kept_together(client, known, kind):
    """What is demanded narrows what is found, and all of it is kept by what is offered."""
    stated = TOGETHER[kind]
    answer = designs(client, known, stated)
    assert made(answer)
    for design in answer:
        if design["verification"]["passed"]:
            keeps(stated, design)
            assert ("forces" in design) == ("dynamics" in stated)
            assert ("layout" in design) == ("layout" in stated)
    free = {name: value for name, value in stated.items() if name not in ("constraints", "space")}
    assert made(answer) != made(designs(client, known, free))
