"""Orders of files, as the service hands them to the processes that make solids."""

from __future__ import annotations

from typing import Any

from service.parts.export.requests import PartsRequest
from service.requests import dump_problem


def order(problem: Any, result: Any, query: dict[str, Any]) -> dict[str, Any]:
    """An order of the first design of a result."""
    return PartsRequest(
        kind=problem.kind,
        problem=dump_problem(problem),
        label=None,
        result=result.model_dump_json(),
        number=0,
        query=query,
    ).model_dump()
