"""Table of the methods of a kind, of which the first that applies to a statement solves it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

from synthesis.model.kind import Progress

P = TypeVar("P")
R = TypeVar("R")


@dataclass(frozen=True)
class Method(Generic[P, R]):
    """One row of a table of methods.

    Attributes
    ----------
    applies : callable
        Whether the method applies to a statement to which no earlier row applies.
    solve : callable
        Solves such a statement.
    """

    applies: Callable[[P], bool]
    solve: Callable[[P, Progress], R]


def solve_by_first(methods: Sequence[Method[P, R]], problem: P, progress: Progress) -> R:
    """Solve a statement by the first method that applies; the last row of a table must apply to all that are left."""
    return next(method for method in methods if method.applies(problem)).solve(problem, progress)
