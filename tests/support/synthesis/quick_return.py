"""Code that several tests share: quick return."""

from __future__ import annotations

from typing import Any

from synthesis.dispatch import solve
from synthesis.kinds.quick_return.design import QuickReturnResult
from synthesis.registry import parse_problem


def answer(**stated: Any) -> QuickReturnResult:
    result = solve(parse_problem({"kind": "quick_return", **stated}), lambda fraction, message: None)
    assert isinstance(result, QuickReturnResult)
    return result


def crank_rocker(**stated: Any) -> QuickReturnResult:
    return answer(mechanism="fourbar", **stated)
