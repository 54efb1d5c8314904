"""Synthesis of mechanisms: solvers, verification and ranking.

The entry points are :func:`parse_problem`, which parses a JSON-like statement into a problem, and :func:`solve`;
docs/reference/python.md has examples. Both are imported on first use, so that ``import synthesis`` costs nothing. The
kinds of problems are folders of :mod:`synthesis.kinds`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from synthesis.dispatch import solve
    from synthesis.registry import parse_problem

__all__ = ["parse_problem", "solve"]


def __getattr__(name: str) -> Any:
    # Imported here, because the solvers load NumPy, SciPy and compiled kernels.
    if name == "parse_problem":
        from synthesis.registry import parse_problem

        return parse_problem
    if name == "solve":
        from synthesis.dispatch import solve

        return solve
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
