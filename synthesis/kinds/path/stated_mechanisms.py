"""Which types of mechanism may guide the point, and what cannot be demanded of some of them."""

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
"""Sixbars with a point on a link that is not joined to the ground, and not moved by a fourbar alone."""

SIXBARS: tuple[Sixbar, ...] = get_args(Sixbar)

Mechanisms = Auto | Annotated[list[Simple | Sixbar], Field(min_length=1, max_length=7)]
"""Types by their names, or the simplest that does."""

NAMES = {"fourbar": "fourbar", "slider_crank": "slider-crank", "geared_fivebar": "geared fivebar", "sixbar": "sixbar"}
"""What the types are called; sixbars together."""

TURNING = ("any", "crank_rocker", "double_crank")
"""Classes of fourbars within sixbars: their crank turns through."""


def simple_of(stated: Any) -> tuple[Simple, ...]:
    """The types with one closure that a statement wants, the simplest first; under ``auto`` fourbars alone."""
    return ("fourbar",) if stated == "auto" else named_among(stated, SIMPLE)


def of_types(problem: Any) -> list[Contradiction]:
    """What cannot be stated beside ``mechanisms``, or of the types that it names."""
    stated, listed = problem.mechanisms, []
    if stated is None:
        return []
    if problem.mechanism != "fourbar":
        listed.append(Contradiction("/mechanism", "names one type beside mechanisms, which names all; leave it out"))
    if problem.gear_ratio is not None and "geared_fivebar" not in simple_of(stated):
        listed.append(Contradiction("/gear_ratio", "no mechanism that is looked for has gears"))
    listed += refused(stated, SIXBARS, lacking(problem))
    return listed + (list(beyond_unclassed(problem)) if named_among(stated, SIXBARS) == (UNCLASSED,) else [])


def lacking(problem: Any) -> Iterator[Contradiction]:
    """What is stated that sixbars cannot keep: it is a fourbar's alone, or not built for them."""
    limits = problem.constraints
    for path, of_fourbars in (
        ("/timing", problem.prescribed),
        ("/placement_free", bool(problem.placement_free)),
        ("/constraints/coupler_point", limits.coupler_point is not None),
    ):
        if of_fourbars:
            yield Contradiction(path, "is not for sixbars; leave it out, or take the sixbars out of mechanisms")
    yield from limits.of_another_class(TURNING, "sixbars are looked for whose crank turns through")
    yield from beside_sixbars(problem)


def beyond_unclassed(problem: Any) -> Iterator[Contradiction]:
    """What is stated that a Stephenson II sixbar cannot keep, or is not looked for with."""
    yield from no_class(problem.constraints)
    if problem.stance is not None:
        yield Contradiction("/stance", "is not looked for in Stephenson II sixbars; name others, or leave it out")
