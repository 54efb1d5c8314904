"""What an exhaustive search offers: the first within the tolerance, and the Pareto set of error against size.

Errors are exact fractions and a tolerance is the decimal that was written, so that a candidate exactly at the tolerance
is within it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from fractions import Fraction
from typing import Any, Protocol, TypeVar

from synthesis.model.ratio_target import decimal


class Erring(Protocol):
    """A candidate with its relative error."""

    @property
    def error(self) -> Fraction:
        """Relative error, exact."""


Inexact = TypeVar("Inexact", bound=Erring)
Candidate = TypeVar("Candidate")


def within_tolerance(error: Fraction, tolerance: float | None) -> bool:
    """Whether an error is at most the tolerance; without one every error is."""
    return tolerance is None or error <= decimal(tolerance)


def first_within(ranked: Iterable[Inexact], tolerance: float | None, count: int) -> list[Inexact]:
    """The first ``count`` of the candidates whose error is within the tolerance."""
    return [candidate for candidate in ranked if within_tolerance(candidate.error, tolerance)][:count]


def pareto(by_size: Iterable[Candidate], error: Callable[[Candidate], Any]) -> list[Candidate]:
    """Of candidates by rising size those that have a smaller error than all before them."""
    front: list[Candidate] = []
    for candidate in by_size:
        if not front or error(candidate) < error(front[-1]):
            front.append(candidate)
    return front
