"""Which types of linkages may generate the function, and what cannot be demanded of sixbars among them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, Literal, get_args

from pydantic import Field

from synthesis.model.stated_types import UNCLASSED, Auto, beside_sixbars, no_class, refused
from synthesis.model.statement import Contradiction

Sixbar = Literal["watt_2", "stephenson_2", "stephenson_3"]
"""Sixbars whose output is no fourbar's: in Watt I and Stephenson I sixbars, a fourbar drives it."""

SIXBARS: tuple[Sixbar, ...] = get_args(Sixbar)

Mechanisms = Auto | Annotated[list[Literal["fourbar", "slider_crank"] | Sixbar], Field(min_length=1, max_length=5)]
"""Types by their names, or the simplest that does."""


def lacking(problem: Any) -> Iterator[Contradiction]:
    """What is stated that sixbars cannot keep."""
    if problem.slides:
        yield Contradiction("/mechanism", "the output of sixbars turns; take them out of mechanisms")
    if problem.stated_zeros_alone:
        yield Contradiction("/zeros", "are counted from the ground line of a fourbar; leave them open for sixbars")
    yield from beside_sixbars(problem)


def of_types(problem: Any) -> list[Contradiction]:
    """What cannot be demanded of the types that are looked for."""
    stated = problem.mechanisms
    if stated is None or isinstance(stated, str):
        return []
    if ("slider_crank" in stated) != problem.slides or (problem.slides and set(stated) != {"slider_crank"}):
        detail = (
            "the output of a slider_crank is a length, that of all others an angle: name it alone, in mechanism too"
        )
        return [Contradiction("/mechanisms", detail)]
    unclassed = no_class(problem.constraints) if set(stated) == {UNCLASSED} else []
    return [*unclassed, *refused(stated, problem.sixbars, lacking(problem))]
