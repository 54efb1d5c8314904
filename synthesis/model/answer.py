"""What every answer is made of, whatever the kind of its problem."""

from __future__ import annotations

from typing import Annotated, Any, Generic, Self, TypeVar

from pydantic import ConfigDict, Field

from synthesis.model.dimension import ANGLE, LENGTH, Dimension, Measured

Point = Annotated[tuple[float, float], LENGTH]


class Answer(Measured):
    """Base of every model that the service writes."""

    model_config = ConfigDict(extra="forbid", frozen=True)


def _blank(value: object) -> bool:
    return value is None


def optional(description: str | None = None, alias: str | None = None) -> Any:
    """A field of an answer that is left out where it has no value; ``alias`` is its name where Python has none such."""
    return Field(default=None, exclude_if=_blank, description=description, alias=alias)


class Check(Answer):
    """One measured property. ``value`` and ``limit`` are left out where the property has none."""

    name: str
    passed: bool
    value: float | None = optional()
    limit: float | None = optional()
    dimension: Dimension | None = optional("What value and limit measure; left out for a pure number.")


class Verification(Answer):
    """What the analysis core found when it drove the mechanism; ``passed`` means that every check passed."""

    passed: bool
    checks: list[Check]

    @classmethod
    def of(cls, checks: list[Check]) -> Self:
        """The verification that checks make."""
        return cls(passed=all(check.passed for check in checks), checks=checks)


class Search(Answer):
    """How the answer was found and how complete it is.

    ``complete`` is a promise: every solution of the stated problem was found, so that an empty list of designs is a
    proof that none exists. ``candidates`` = ``accepted`` + all ``rejected``; ``accepted`` were driven and passed every
    check. In a search ``outranked`` counts pairs of dyads that passed the screening but were not driven, because better
    ones that differ from them were.
    """

    method: str
    complete: bool
    candidates: int
    accepted: int
    rejected: dict[str, int]
    seed: int


Design = TypeVar("Design", bound=Answer)


class Gap(Answer):
    """By how much a check is broken; of a demand without a measure, such as a class of linkage, there is the name."""

    check: str
    value: float | None = optional()
    limit: float | None = optional()
    dimension: Dimension | None = optional("What value and limit measure; left out for a pure number.")


class Reachable(Answer):
    """The best values of demands that were met where all others hold; those that are no trouble are left out."""

    min_transmission_angle: Annotated[float, ANGLE] | None = optional("Degrees.")
    max_link_ratio: float | None = optional()
    tolerance: float | None = optional("Of a gear ratio: the least relative error.")
    dwell_angle: Annotated[float, ANGLE] | None = optional("Degrees of the crank: the longest dwell that was found.")
    dwell_angles: list[Annotated[float, ANGLE]] | None = optional(
        "The same of several dwells, each of its own length: the longest of which all were found, by one share of each."
    )


class NearestMiss(Answer, Generic[Design]):
    """Where no design satisfies all demands: the one that was found to break them least."""

    design: Design
    gaps: list[Gap] = Field(description="The checks that it breaks.")
    reachable: Reachable


class Result(Answer, Generic[Design]):
    """The answer to a problem: designs, best first, and how they were found."""

    designs: list[Design]
    search: Search
    summary: str
    nearest_miss: NearestMiss[Design] | None = Field(
        default=None, description="Where no design passed: what comes nearest. Null where one passed."
    )
