"""Statements of functions that are refused at a field, and those that are hard and answered."""

import json

import pytest

from synthesis.kinds.function.problem import FunctionProblem
from tests.support.synthesis.function_tasks import pairs_of, solved

REFUSED = [
    ({}, "/pairs"),
    ({"pairs": [(0, 0), (0, 5), (9, 9)]}, "/pairs/1/input"),
    ({"pairs": [(0, 0), (20, 5), (10, 9)]}, "/pairs/2/input"),
    ({"pairs": [(0, 5), (20, 5), (30, 5)]}, "/pairs"),
    ({"pairs": [(0, 0), (200, 5), (400, 9)]}, "/pairs"),
    ({"pairs": [(float(k), float(k * k)) for k in range(9)], "criterion": "precision"}, "/pairs"),
    ({"pairs": [(0, 0), (10, 5), (20, 9)], "input_range": 60.0}, "/input_range"),
    ({"pairs": [(0, 0), (10, 5)], "mechanism": "slider_crank", "scales": {"input": 1.0}}, "/scales/output"),
    ({"function": {"name": "logarithm", "x": [0.0, 2.0]}}, "/function/x"),
    ({"function": {"name": "tangent", "x": [0.0, 90.0]}}, "/function/x"),
    ({"function": {"name": "reciprocal", "x": [-1.0, 2.0]}}, "/function/x"),
    ({"function": {"name": "power", "exponent": 0.5, "x": [-1.0, 2.0]}}, "/function/x"),
    ({"function": {"name": "power", "exponent": -1.0, "x": [-1.0, 2.0]}}, "/function/x"),
    ({"function": {"name": "power", "x": [1.0, 2.0]}}, "/function/exponent"),
    ({"function": {"name": "sine"}}, "/function/x"),
    ({"function": {"name": "exponential", "x": [-1e5, 1e5]}}, "/function/x"),
    ({"function": {"name": "exponential", "base": 1.0, "x": [0.0, 1.0]}}, "/function/base"),
    ({"function": {"name": "sine", "exponent": 2.0, "x": [0.0, 1.0]}}, "/function/exponent"),
    ({"function": {"name": "linear", "x": [1e9 - 1e-7, 1e9]}}, "/function/x"),
    ({"function": {"name": "table", "points": [(1, 1), (3, 1), (2, 3)]}}, "/function/points/2/x"),
    ({"function": {"name": "table"}}, "/function/points"),
    ({"function": {"name": "table", "x": [1.0, 3.0]}}, "/function/points"),
    ({"function": {"name": "table", "points": [(1, 1), (2, 1), (3, 1)]}}, "/function/x"),
    ({"function": {"name": "table", "points": [(1, 1), (2, 2), (3, 1)], "x": [0.0, 2.0]}}, "/function/x"),
    ({"function": {"name": "linear", "x": [0.0, 1.0]}, "input_range": 360.0}, "/input_range"),
    ({"function": {"name": "linear", "x": [0.0, 1.0]}, "output_range": 0.0}, "/output_range"),
    ({"function": {"name": "linear", "x": [0.0, 1.0]}, "mechanism": "slider_crank"}, "/output_range"),
    (
        {"function": {"name": "sine", "x": [0.0, 9.0]}, "criterion": "minimax", "precision_points": 3},
        "/precision_points",
    ),
    (
        {"function": {"name": "sine", "x": [0.0, 9.0]}, "input_range": 9.0, "output_range": 9.0, "precision_points": 6},
        "/precision_points",
    ),
    ({"function": {"name": "sine", "x": [0.0, 9.0]}, "scales": {"input": 1.0}}, "/scales"),
    ({"function": {"name": "sine", "x": [0.0, 9.0]}, "range_limits": [-5.0, 20.0]}, "/range_limits"),
    ({"pairs": [(0, 0), (10, 5)], "fixed_pivots": {"input": [1.0, 1.0], "output": [1.0, 1.0]}}, "/fixed_pivots/output"),
]


@pytest.mark.parametrize(("fields", "path"), REFUSED, ids=lambda value: value if isinstance(value, str) else "")
def test_what_cannot_be_meant_is_refused_at_its_field(fields, path):
    stated = json.loads(json.dumps(fields))
    if "pairs" in stated:
        stated["pairs"] = [{"input": float(x), "output": float(y)} for x, y in stated["pairs"]]
    if "points" in stated.get("function", {}):
        stated["function"]["points"] = [{"x": float(x), "y": float(y)} for x, y in stated["function"]["points"]]
    problem = FunctionProblem(kind="function", **stated)
    assert path in [fault.path for fault in problem.find_contradictions()]


@pytest.mark.campaign
@pytest.mark.parametrize(
    "fields",
    [
        {"function": {"name": "linear", "x": [0.0, 1.0]}, "input_range": 90.0, "output_range": 90.0},
        {
            "function": {"name": "linear", "x": [0.0, 1.0]},
            "input_range": 90.0,
            "output_range": 90.0,
            "precision_points": 5,
        },
        {"pairs": [(0.0, 0.0), (1e-3, 1e-3), (2e-3, 4e-3)]},
        {"pairs": [(0.0, 0.0), (90.0, 0.0), (180.0, 1.0)]},
        {"function": {"name": "sine", "x": [0.0, 360.0]}, "input_range": 90.0, "output_range": 90.0},
        {"function": {"name": "power", "exponent": 50.0, "x": [0.0, 1.0]}, "input_range": 90.0, "output_range": 90.0},
        {"function": {"name": "logarithm", "x": [1.0, 2.0]}, "input_range": 0.02, "output_range": 0.02},
        {"function": {"name": "logarithm", "x": [1.0, 2.0]}, "input_range": 350.0, "output_range": 350.0},
        # An interval at the edge of rounding, where places at which the error vanishes come together.
        {
            "mechanism": "slider_crank",
            "function": {"name": "linear", "x": [0.9869167335353609, 0.9869167345353609]},
            "input_range": 60.0,
            "output_range": 50.0,
            "zeros": {"input": -107.8, "output": None},
            "constraints": {"max_link_ratio": 2.0},
        },
    ],
)
def test_what_is_hard_is_answered_and_verified(fields):
    if "pairs" in fields:
        fields = {"pairs": pairs_of(*zip(*fields["pairs"], strict=True))}
    result = solved(**fields)
    assert all(design.verification.passed for design in result.designs)
    assert result.summary
