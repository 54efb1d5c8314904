"""Statements: what is refused, where the fault is reported, and that examples run."""

from __future__ import annotations

from typing import Any

import pytest
from pydantic import ValidationError

from synthesis.dispatch import solve
from synthesis.model.problem import ContradictionError
from synthesis.registry import KINDS, get_first_example, parse_problem

POSITIONS = [
    {"x": 0.0, "y": 0.0, "angle": 0.0},
    {"x": 1.0, "y": 0.0, "angle": 10.0},
    {"x": 2.0, "y": 1.0, "angle": 30.0},
]
FOUR = [*POSITIONS, {"x": 3.0, "y": 0.5, "angle": 40.0}]
FIFTH = {"x": 3.0, "y": 0.0, "angle": 55.0}


def statement(**changes: Any) -> dict[str, Any]:
    return {"kind": "motion", "positions": POSITIONS, **changes}


@pytest.mark.parametrize(
    ("changes", "where"),
    [
        ({"positions": POSITIONS[:1]}, ("positions",)),
        ({"positions": []}, ("positions",)),
        ({"positions": POSITIONS * 70}, ("positions",)),
        ({"positions": [*POSITIONS[:2], {"x": float("nan"), "y": 0, "angle": 0}]}, ("positions", 2, "x")),
        ({"positions": [*POSITIONS[:2], {"x": 0, "y": float("inf"), "angle": 0}]}, ("positions", 2, "y")),
        ({"positions": [*POSITIONS[:2], {"x": 0, "y": 1e12, "angle": 0}]}, ("positions", 2, "y")),
        ({"positions": [*POSITIONS[:2], {"x": "1", "y": 0, "angle": 0}]}, ("positions", 2, "x")),
        ({"positions": [*POSITIONS[:2], {"x": True, "y": 0, "angle": 0}]}, ("positions", 2, "x")),
        ({"positions": [*POSITIONS[:2], {"x": 10**400, "y": 0, "angle": 0}]}, ("positions", 2, "x")),
        ({"positions": [*POSITIONS[:2], {"x": 0, "y": 0}]}, ("positions", 2, "angle")),
        ({"positions": [*POSITIONS[:2], {"x": 0, "y": 0, "angle": 0, "z": 0}]}, ("positions", 2, "z")),
        ({"typo": 1}, ("typo",)),
        ({"max_designs": 0}, ("max_designs",)),
        ({"max_designs": 2.0}, ("max_designs",)),
        ({"seed": -1}, ("seed",)),
        ({"length_unit": "mile"}, ("length_unit",)),
        ({"constraints": {"min_transmission_angle": 90.0}}, ("constraints", "min_transmission_angle")),
        ({"constraints": {"link_length": {"min": 2.0, "max": 1.0}}}, ("constraints", "link_length")),
        (
            {"constraints": {"fixed_pivot_region": {"x": [1, 0], "y": [0, 1]}}},
            ("constraints", "fixed_pivot_region", "x"),
        ),
        ({"constraints": {"full_rotation": "yes"}}, ("constraints", "full_rotation")),
        ({"input_side": {"fixed_pivot": [0.0]}}, ("input_side", "fixed_pivot", 1)),
        ({"input_side": {"fixed_pivot": [None, None]}}, ("input_side", "fixed_pivot")),
        ({"ground_line": {"point": [0.0, None], "angle": 0.0}}, ("ground_line", "point", 1)),
        ({"ground_line": {"point": [0.0, 1.0]}}, ("ground_line", "angle")),
        ({"input_side": {"coupler_vector": {"length": 0.0}}}, ("input_side", "coupler_vector", "length")),
    ],
)
def test_ill_formed_statements_name_the_field(changes: dict[str, Any], where: tuple[Any, ...]) -> None:
    with pytest.raises(ValidationError) as caught:
        parse_problem(statement(**changes))
    assert ("<motion>", *where) in [error["loc"] for error in caught.value.errors()]


@pytest.mark.parametrize("changes", [{"kind": "emotion"}, {"kind": ["motion"]}, {"kind": None}])
def test_an_unknown_kind_is_said(changes: dict[str, Any]) -> None:
    with pytest.raises(ValidationError, match="kind must be given and be one of: motion"):
        parse_problem(statement(**changes))


@pytest.mark.parametrize(
    ("changes", "path"),
    [
        ({"positions": [POSITIONS[0], POSITIONS[1], POSITIONS[0]]}, "/positions/2"),
        ({"positions": [POSITIONS[0], {"x": 0.0, "y": 0.0, "angle": 360.0}]}, "/positions/1"),
        ({"input_side": {"rotations": [10.0]}}, "/input_side/rotations"),
        ({"output_side": {"fixed_pivot": [0, 0], "link_angle": 1.0}}, "/output_side"),
        ({"output_side": {"moving_pivot": [0, 0], "coupler_vector": {}}}, "/output_side/coupler_vector"),
        (
            {
                "output_side": {"fixed_pivot": [0.0, 5.0]},
                "constraints": {"fixed_pivot_region": {"x": [0, 1], "y": [0, 1]}},
            },
            "/output_side/fixed_pivot",
        ),
        ({"constraints": {"full_rotation": True, "grashof": "non_grashof"}}, "/constraints/full_rotation"),
        ({"positions": [POSITIONS[0], {"x": 1e-15, "y": 0.0, "angle": 9.0}]}, "/positions"),
        (
            {"input_side": {"fixed_pivot": [1.0, 2.0]}, "output_side": {"fixed_pivot": [1.0, 2.0]}},
            "/output_side/fixed_pivot",
        ),
        ({"input_side": {"fixed_pivot": [None, 2.0], "link_angle": 3.0, "rotations": [1.0, None]}}, "/input_side"),
        ({"positions": FOUR, "input_side": {"link_angle": 3.0, "rotations": [1.0, None, None]}}, "/input_side"),
        ({"positions": FOUR, "output_side": {"fixed_pivot": [0.0, 1.0], "link_angle": 3.0}}, "/output_side"),
        ({"positions": [*FOUR, FIFTH], "output_side": {"link_angle": 3.0}}, "/output_side"),
        (
            {
                "positions": FOUR,
                "ground_line": {"point": [0.0, 0.0], "angle": 0.0},
                "input_side": {"link_angle": 3.0},
            },
            "/ground_line",
        ),
        (
            {"ground_line": {"point": [0.0, 0.0], "angle": 0.0}, "input_side": {"fixed_pivot": [1.0, 2.0]}},
            "/input_side/fixed_pivot",
        ),
        (
            {"ground_line": {"point": [0.0, 0.0], "angle": 90.0}, "output_side": {"fixed_pivot": [1.0, None]}},
            "/output_side/fixed_pivot",
        ),
        (
            {
                "output_side": {"moving_pivot": [None, 5.0]},
                "constraints": {"moving_pivot_region": {"x": [0, 1], "y": [0, 1]}},
            },
            "/output_side/moving_pivot",
        ),
    ],
)
def test_contradictions_name_the_field(changes: dict[str, Any], path: str) -> None:
    problem = parse_problem(statement(**changes))
    assert [found.path for found in problem.find_contradictions()] == [path]
    with pytest.raises(ContradictionError, match=path):
        solve(problem, lambda fraction, message: None)


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_examples_are_solved(kind: str) -> None:
    problem = parse_problem(get_first_example(kind))
    assert problem.find_contradictions() == []
    progress: list[float] = []
    result = solve(problem, lambda fraction, message: progress.append(fraction))
    assert result.designs
    assert progress == sorted(progress)
    assert progress[-1] == 1.0


def test_a_stored_problem_comes_back_equal() -> None:
    problem = parse_problem(statement(constraints={"grashof": "crank_rocker"}, seed=3))
    assert type(problem).model_validate_json(problem.model_dump_json()) == problem
