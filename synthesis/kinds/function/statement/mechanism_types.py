"""Requested types of linkage, and contradictions between sixbars and other fields."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Literal, get_args

from pydantic import Field

from kinematics.message import compose
from synthesis.model.linkage.type_choice import (
    UNCLASSED_SIXBAR,
    Auto,
    find_type_contradictions,
    find_unsupported_by_sixbars,
    refuse_class,
)
from synthesis.model.problem import Contradiction

if TYPE_CHECKING:
    from synthesis.kinds.function.problem import FunctionProblem

Sixbar = Literal["watt_2", "stephenson_2", "stephenson_3"]
"""Sixbar types whose output differs from a fourbar's: in Watt I and Stephenson I sixbars, a fourbar drives the output.
"""

SIXBARS: tuple[Sixbar, ...] = get_args(Sixbar)

Multiloop = Sixbar | Literal["eightbar"]
"""Linkages of several loops; an eightbar has any of ten topologies."""

MULTILOOP_TYPES: tuple[Multiloop, ...] = (*SIXBARS, "eightbar")

Mechanisms = Auto | Annotated[list[Literal["fourbar", "slider_crank"] | Multiloop], Field(min_length=1, max_length=6)]
"""A list of types by name, or ``auto`` for the simplest type that is good enough."""


def list_unsupported(problem: FunctionProblem) -> Iterator[Contradiction]:
    """Yield the given fields that sixbars and eightbars do not support."""
    if problem.slides:
        yield Contradiction("/mechanism", compose("function-sixbar-output-rotates"))
    if problem.has_given_zeros:
        yield Contradiction("/zeros", compose("function-zeros-need-fourbar"))
    yield from find_unsupported_by_sixbars(problem)


def check_types(problem: FunctionProblem) -> list[Contradiction]:
    """Return contradictions between the requested types and the other fields."""
    stated = problem.mechanisms
    if stated is None or isinstance(stated, str):
        return []
    if ("slider_crank" in stated) != problem.slides or (problem.slides and set(stated) != {"slider_crank"}):
        return [Contradiction("/mechanisms", compose("function-slider-crank-not-alone"))]
    unclassed = refuse_class(problem.constraints) if set(stated) == {UNCLASSED_SIXBAR} else []
    return [*unclassed, *find_type_contradictions(stated, MULTILOOP_TYPES, list_unsupported(problem))]
