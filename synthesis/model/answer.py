"""Parts of every answer, for all kinds of problems."""

from __future__ import annotations

from typing import Annotated, Any, Generic, Self, TypeVar

from pydantic import ConfigDict, Field

from synthesis.model.dimension import ANGLE, LENGTH, Dimension, DimensionedModel
from synthesis.model.text_messages import TextMessage

Point = Annotated[tuple[float, float], LENGTH]


class Answer(DimensionedModel):
    """Base of every model that the service writes."""

    model_config = ConfigDict(extra="forbid", frozen=True)


def _is_blank(value: object) -> bool:
    return value is None


def optional_field(description: str | None = None, alias: str | None = None) -> Any:
    """Return a field of an answer that is left out if it has no value.

    ``alias`` is its name in JSON, for names that are not Python identifiers.
    """
    return Field(default=None, exclude_if=_is_blank, description=description, alias=alias)


class Check(Answer):
    """One verified property. ``value`` and ``limit`` are left out if the property has none."""

    name: str
    passed: bool
    value: float | None = optional_field()
    limit: float | None = optional_field()
    dimension: Dimension | None = optional_field("Dimension of value and limit; left out for a pure number.")
    detail: str | None = optional_field("What the check leaves out, if it covers less than its name says.")


class Verification(Answer):
    """Result of driving the finished mechanism with the analysis core; ``passed`` means that every check passed."""

    passed: bool
    checks: list[Check]

    @property
    def failures(self) -> list[Check]:
        """The failed checks."""
        return [check for check in self.checks if not check.passed]

    @classmethod
    def from_checks(cls, checks: list[Check]) -> Self:
        """Return the verification with these checks; it passed if all of them passed."""
        return cls(passed=all(check.passed for check in checks), checks=checks)


class Search(Answer):
    """How the answer was found and whether the search was complete.

    ``complete`` is a guarantee: every solution of the problem was found, so that an empty list of designs proves that
    none exists. ``candidates`` = ``accepted`` + all ``rejected``; accepted candidates were driven and passed every
    check. ``outranked`` counts candidates that passed the screening but were not driven because enough better and
    different ones were.
    """

    method: str
    complete: bool
    candidates: int
    accepted: int
    rejected: dict[str, int]
    seed: int


Design = TypeVar("Design", bound=Answer)


class Gap(Answer):
    """A failed check with its value and its limit; a requirement without a measure, such as a class, has neither."""

    check: str
    value: float | None = optional_field()
    limit: float | None = optional_field()
    dimension: Dimension | None = optional_field("Dimension of value and limit; left out for a pure number.")

    @classmethod
    def from_check(cls, check: Check) -> Self:
        """Return the gap of a failed check."""
        return cls(check=check.name, value=check.value, limit=check.limit, dimension=check.dimension)


class Reachable(Answer):
    """Best values found while all other constraints hold; constraints that can be satisfied are left out."""

    min_transmission_angle: Annotated[float, ANGLE] | None = optional_field("Degrees.")
    max_link_ratio: float | None = optional_field()
    tolerance: float | None = optional_field("Smallest relative error of a gear ratio.")
    dwell_angle: Annotated[float, ANGLE] | None = optional_field("Longest dwell found, degrees of the crank.")
    dwell_angles: list[Annotated[float, ANGLE]] | None = optional_field(
        "Longest dwells found if several are requested, degrees of the crank; all are shortened by the same share."
    )


class NearestMiss(Answer, Generic[Design]):
    """The design that violates the constraints least; given if no design satisfies all of them."""

    design: Design
    gaps: list[Gap] = Field(description="The checks that the design fails.")
    reachable: Reachable


AnyNearestMiss = NearestMiss[Any]
"""Nearest miss of a problem of any kind; named here, because only what a module names can be pickled."""


class Result(Answer, Generic[Design]):
    """The answer to a problem: designs, best first, and how they were found."""

    designs: list[Design]
    search: Search
    summary: str
    nearest_miss: NearestMiss[Design] | None = Field(
        default=None, description="The nearest miss if no design passed; null otherwise."
    )
    messages: list[TextMessage] = Field(
        default=[],
        description="Ids and values of the texts in this answer, which clients may compare or translate.",
    )


AnyResult = Result[Any]
"""Answer to a problem of any kind."""
