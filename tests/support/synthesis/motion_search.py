"""Code that several tests share: motion search."""

from __future__ import annotations

import math
from itertools import product
from typing import Any

from synthesis.dispatch import solve
from synthesis.kinds.motion.design import MotionResult
from synthesis.model.linkage.answer import LinkageDesign
from synthesis.registry import parse_problem
from tests.oracles.continuation import drive

ORDINARY = [
    {"x": 0.0, "y": 0.0, "angle": 0.0},
    {"x": 40.0, "y": 15.0, "angle": -25.0},
    {"x": 75.0, "y": 5.0, "angle": -60.0},
]


def run(**statement: Any) -> MotionResult:
    result = solve(parse_problem({"kind": "motion", **statement}), lambda fraction, message: None)
    assert isinstance(result, MotionResult)
    return result


NEAR_CHANGE_POINT = 1e-5
"""Margin to a change point below which stepwise continuation, with its steps of 1e-9, cannot tell circuits apart."""


def change_point_margin(design: LinkageDesign) -> float:
    """How far the links are from lying in one line, as a share of their sum."""
    links = design.mechanism.links
    a, b, c, d = links.input, links.coupler, links.output, links.ground
    return min(abs(d + i * a + j * b + k * c) for i, j, k in product((1, -1), repeat=3)) / (a + b + c + d)


def confirm(result: MotionResult, positions: list[dict[str, float]], least: float) -> None:
    """Every returned design, followed step by step from its dimensions, does what its verification says."""
    assert all(design.verification.passed for design in result.designs)
    designs = [design for design in result.designs if change_point_margin(design) > NEAR_CHANGE_POINT]
    if not designs:
        return
    for found in drive([design.mechanism.model_dump() for design in designs], positions):
        assert found.residual < 1e-9
        assert found.same_circuit
        assert found.same_branch
        assert found.in_order
        assert math.degrees(found.least_transmission) >= least - 1e-6
