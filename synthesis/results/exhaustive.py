"""Selection from an exhaustive search: candidates within the tolerance, and the Pareto set of error against size.

Errors are exact fractions, and a tolerance is the decimal that was written, so that a candidate exactly at the
tolerance is accepted.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from fractions import Fraction
from typing import Any, Protocol, TypeVar

from synthesis.model.gears.ratio_target import parse_decimal


class ApproximateCandidate(Protocol):
    """A candidate with its relative error."""

    @property
    def error(self) -> Fraction:
        """Exact relative error."""


Inexact = TypeVar("Inexact", bound=ApproximateCandidate)
Candidate = TypeVar("Candidate")


def is_within_tolerance(error: Fraction, tolerance: float | None) -> bool:
    """Return whether an error is at most the tolerance; True without a tolerance."""
    # The decimal that the client wrote, not its binary approximation.
    return tolerance is None or error <= parse_decimal(tolerance)


def select_within_tolerance(ranked: Iterable[Inexact], tolerance: float | None, count: int) -> list[Inexact]:
    """Return the first ``count`` candidates whose error is within the tolerance."""
    return [candidate for candidate in ranked if is_within_tolerance(candidate.error, tolerance)][:count]


def select_pareto(by_size: Iterable[Candidate], error: Callable[[Candidate], Any]) -> list[Candidate]:
    """Return the Pareto set of error against size: the candidates with a smaller error than all before them.

    The candidates are given in order of increasing size.
    """
    front: list[Candidate] = []
    for candidate in by_size:
        # A candidate with an equal error and a larger size is dominated, too.
        if not front or error(candidate) < error(front[-1]):
            front.append(candidate)
    return front
