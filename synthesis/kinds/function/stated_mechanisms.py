"""Requested types of linkage, and contradictions between sixbars and other fields."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, Literal, get_args

from pydantic import Field

from synthesis.model.stated_types import UNCLASSED, Auto, beside_sixbars, no_class, refused
from synthesis.model.statement import Contradiction

Sixbar = Literal["watt_2", "stephenson_2", "stephenson_3"]
"""Sixbar types whose output differs from a fourbar's: in Watt I and Stephenson I sixbars, a fourbar drives the output.
"""

SIXBARS: tuple[Sixbar, ...] = get_args(Sixbar)

Mechanisms = Auto | Annotated[list[Literal["fourbar", "slider_crank"] | Sixbar], Field(min_length=1, max_length=5)]
"""A list of types by name, or ``auto`` for the simplest type that is good enough."""


def lacking(problem: Any) -> Iterator[Contradiction]:
    """Yield the given fields that sixbars do not support."""
    if problem.slides:
        yield Contradiction("/mechanism", "the output of sixbars rotates; remove them from mechanisms")
    if problem.stated_zeros_alone:
        yield Contradiction("/zeros", "are measured from the ground line of a fourbar; leave them open for sixbars")
    yield from beside_sixbars(problem)


def of_types(problem: Any) -> list[Contradiction]:
    """Return contradictions between the requested types and the other fields."""
    stated = problem.mechanisms
    if stated is None or isinstance(stated, str):
        return []
    if ("slider_crank" in stated) != problem.slides or (problem.slides and set(stated) != {"slider_crank"}):
        detail = (
            "slider_crank has a length as output, all other types an angle: list it alone, and set mechanism to it too"
        )
        return [Contradiction("/mechanisms", detail)]
    unclassed = no_class(problem.constraints) if set(stated) == {UNCLASSED} else []
    return [*unclassed, *refused(stated, problem.sixbars, lacking(problem))]
