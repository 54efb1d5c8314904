"""Orders of files, as the service hands them to the processes that make solids."""

from __future__ import annotations

from typing import Any

from service.parts.orders import Order
from service.stated import written


def order(problem: Any, result: Any, query: dict[str, Any]) -> dict[str, Any]:
    """An order of the first design of a result."""
    return Order(
        kind=problem.kind,
        problem=written(problem),
        label=None,
        result=result.model_dump_json(),
        number=0,
        query=query,
    ).model_dump()
