"""Which mechanism does what is asked: solvers, verification and ranking.

The door is :func:`parse_problem`, which makes a problem of a JSON-like statement, and :func:`solve`; docs/python.md
shows them at work. Both are imported when they are first asked for, so that ``import synthesis`` costs nothing. The
kinds of problems are folders of :mod:`synthesis.kinds`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from synthesis.dispatch import solve
    from synthesis.registry import parse_problem

__all__ = ["parse_problem", "solve"]


def __getattr__(name: str) -> Any:
    if name == "parse_problem":
        from synthesis.registry import parse_problem

        return parse_problem
    if name == "solve":
        from synthesis.dispatch import solve

        return solve
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
