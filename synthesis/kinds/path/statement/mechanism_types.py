"""Types of mechanism that may guide the point, and requests that some of them do not support."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Annotated, Literal, get_args

from pydantic import Field

from kinematics.message import compose
from synthesis.model.linkage.type_choice import (
    UNCLASSED_SIXBAR,
    Auto,
    find_type_contradictions,
    find_unsupported_by_sixbars,
    refuse_class,
    select_requested_types,
)
from synthesis.model.problem import Contradiction

if TYPE_CHECKING:
    from synthesis.kinds.path.problem import PathProblem

Simple = Literal["fourbar", "slider_crank", "geared_fivebar"]
"""Linkages with one closure."""

SIMPLE_TYPES: tuple[Simple, ...] = get_args(Simple)

Sixbar = Literal["watt_1", "stephenson_1", "stephenson_2", "stephenson_3"]
"""Sixbars with a point on a link that is neither joined to the ground nor moved by a fourbar alone."""

SIXBAR_TYPES: tuple[Sixbar, ...] = get_args(Sixbar)

Multiloop = Sixbar | Literal["eightbar"]
"""Linkages of several loops; an eightbar has any of 88 topologies."""

MULTILOOP_TYPES: tuple[Multiloop, ...] = (*SIXBAR_TYPES, "eightbar")

Mechanisms = Auto | Annotated[list[Simple | Multiloop], Field(min_length=1, max_length=8)]
"""Types by their names, or ``auto`` for the simplest suitable one."""

TYPE_NAMES = {
    "fourbar": "path-fourbar",
    "slider_crank": "path-slider-crank",
    "geared_fivebar": "path-geared-fivebar",
    "sixbar": "path-sixbar",
    "eightbar": "path-eightbar",
}
"""Messages with the names of the types; sixbars share one."""

TURNING_CLASSES = ("any", "crank_rocker", "double_crank")
"""Classes of fourbars within sixbars and eightbars: their crank turns through."""


def list_simple_types(requested: Auto | Sequence[Simple | Multiloop] | None) -> tuple[Simple, ...]:
    """Return the requested types with one closure, the simplest first; only fourbars for ``auto``."""
    return ("fourbar",) if requested == "auto" else select_requested_types(requested, SIMPLE_TYPES)


def find_mechanism_contradictions(problem: PathProblem) -> list[Contradiction]:
    """Return requests that contradict ``mechanisms``, or the types that it names."""
    stated, listed = problem.mechanisms, []
    if stated is None:
        return []
    if problem.mechanism != "fourbar":
        listed.append(Contradiction("/mechanism", compose("path-types-named-twice")))
    if problem.gear_ratio is not None and "geared_fivebar" not in list_simple_types(stated):
        listed.append(Contradiction("/gear_ratio", compose("path-types-without-gears")))
    listed += find_type_contradictions(stated, MULTILOOP_TYPES, find_unsupported(problem))
    return listed + (
        list(find_unsupported_unclassed(problem))
        if select_requested_types(stated, MULTILOOP_TYPES) == (UNCLASSED_SIXBAR,)
        else []
    )


def find_unsupported(problem: PathProblem) -> Iterator[Contradiction]:
    """Yield requests that sixbars and eightbars do not support: those for fourbars alone, and those not implemented."""
    limits = problem.constraints
    for path, of_fourbars in (
        ("/timing", problem.prescribed),
        ("/placement_free", bool(problem.placement_free)),
        ("/constraints/coupler_point", limits.coupler_point is not None),
    ):
        if of_fourbars:
            yield Contradiction(path, compose("path-not-for-sixbars"))
    yield from limits.find_class_contradictions(TURNING_CLASSES, compose("path-turning-sixbars-only"))
    yield from find_unsupported_by_sixbars(problem)


def find_unsupported_unclassed(problem: PathProblem) -> Iterator[Contradiction]:
    """Yield requests that a Stephenson II sixbar cannot satisfy, or that its search does not support."""
    yield from refuse_class(problem.constraints)
    if problem.stance is not None:
        yield Contradiction("/stance", compose("path-stance-not-for-stephenson"))
