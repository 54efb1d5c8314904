"""Code that several tests share: typed trains."""

from __future__ import annotations

from typing import Any

from synthesis.dispatch import solve
from synthesis.kinds.gear_train.design import GearTrainResult
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.registry import parse_problem

Statement = dict[str, Any]

HELICAL: Statement = {"type": "helical", "helix_angle": 20.0}
INTERNAL: Statement = {"type": "internal"}
BEVEL: Statement = {"type": "bevel", "driver": 20, "driven": 30}


def stated(*stages: Statement, **fields: Any) -> GearTrainProblem:
    problem = parse_problem({"kind": "gear_train", "ratio": "6", "stages": list(stages), **fields})
    assert isinstance(problem, GearTrainProblem)
    return problem


def solved(*stages: Statement, **fields: Any) -> GearTrainResult:
    problem = stated(*stages, **fields)
    assert problem.find_contradictions() == []
    result = solve(problem, lambda fraction, message: None)
    assert isinstance(result, GearTrainResult)
    assert all(design.verification.passed for design in result.designs)
    return result


def faults(*stages: Statement, **fields: Any) -> list[str]:
    return [fault.path for fault in stated(*stages, **fields).find_contradictions()]
