"""Types of mechanism that may guide the point, and requests that some of them do not support."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, Literal, get_args

from pydantic import Field

from synthesis.model.stated_types import UNCLASSED, Auto, beside_sixbars, named_among, no_class, refused
from synthesis.model.statement import Contradiction

Simple = Literal["fourbar", "slider_crank", "geared_fivebar"]
"""Linkages with one closure."""

SIMPLE: tuple[Simple, ...] = get_args(Simple)

Sixbar = Literal["watt_1", "stephenson_1", "stephenson_2", "stephenson_3"]
"""Sixbars with a point on a link that is neither joined to the ground nor moved by a fourbar alone."""

SIXBARS: tuple[Sixbar, ...] = get_args(Sixbar)

Mechanisms = Auto | Annotated[list[Simple | Sixbar], Field(min_length=1, max_length=7)]
"""Types by their names, or ``auto`` for the simplest suitable one."""

NAMES = {"fourbar": "fourbar", "slider_crank": "slider-crank", "geared_fivebar": "geared fivebar", "sixbar": "sixbar"}
"""Names of the types in messages; sixbars share one."""

TURNING = ("any", "crank_rocker", "double_crank")
"""Classes of fourbars within sixbars: their crank turns through."""


def simple_of(stated: Any) -> tuple[Simple, ...]:
    """Return the requested types with one closure, the simplest first; under ``auto`` fourbars alone."""
    return ("fourbar",) if stated == "auto" else named_among(stated, SIMPLE)


def of_types(problem: Any) -> list[Contradiction]:
    """Return requests that contradict ``mechanisms``, or the types that it names."""
    stated, listed = problem.mechanisms, []
    if stated is None:
        return []
    if problem.mechanism != "fourbar":
        listed.append(Contradiction("/mechanism", "mechanisms already names all types; leave this out"))
    if problem.gear_ratio is not None and "geared_fivebar" not in simple_of(stated):
        listed.append(Contradiction("/gear_ratio", "none of the requested mechanisms has gears"))
    listed += refused(stated, SIXBARS, lacking(problem))
    return listed + (list(beyond_unclassed(problem)) if named_among(stated, SIXBARS) == (UNCLASSED,) else [])


def lacking(problem: Any) -> Iterator[Contradiction]:
    """Yield requests that sixbars do not support: those for fourbars alone, and others not implemented for them."""
    limits = problem.constraints
    for path, of_fourbars in (
        ("/timing", problem.prescribed),
        ("/placement_free", bool(problem.placement_free)),
        ("/constraints/coupler_point", limits.coupler_point is not None),
    ):
        if of_fourbars:
            yield Contradiction(path, "is not for sixbars; leave it out, or take the sixbars out of mechanisms")
    yield from limits.of_another_class(TURNING, "only sixbars whose crank turns through are searched")
    yield from beside_sixbars(problem)


def beyond_unclassed(problem: Any) -> Iterator[Contradiction]:
    """Yield requests that a Stephenson II sixbar cannot satisfy, or that its search does not support."""
    yield from no_class(problem.constraints)
    if problem.stance is not None:
        yield Contradiction("/stance", "is not supported for Stephenson II sixbars; name others, or leave it out")
