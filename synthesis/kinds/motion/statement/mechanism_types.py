"""Requested types of mechanism, and given dimensions of the three-link chain in a sixbar."""

from __future__ import annotations

import cmath
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Literal, get_args

from pydantic import Field

from kinematics.message import compose
from synthesis.kinds.motion.statement.dyad_choices import to_complete_point
from synthesis.kinds.motion.statement.positions import MAX_EXACT_POSITIONS, MAX_SIXBAR_POSITIONS
from synthesis.model.linkage.type_choice import (
    UNCLASSED_SIXBAR,
    Auto,
    find_type_contradictions,
    find_unsupported_by_sixbars,
    refuse_class,
    select_requested_types,
)
from synthesis.model.problem import Contradiction, PartialPoint, PositiveLength, Statement

if TYPE_CHECKING:
    from synthesis.kinds.motion.problem import MotionProblem

Sixbar = Literal["watt_1", "stephenson_1", "stephenson_2", "stephenson_3"]
"""Sixbar types in which the body's link is no link of a fourbar within the sixbar."""

SIXBARS: tuple[Sixbar, ...] = get_args(Sixbar)

Multiloop = Sixbar | Literal["eightbar"]
"""Linkages of several loops; an eightbar has any of 88 topologies."""

MULTILOOP_TYPES: tuple[Multiloop, ...] = (*SIXBARS, "eightbar")

Mechanisms = Auto | Annotated[list[Literal["fourbar", "slider_crank"] | Multiloop], Field(min_length=1, max_length=7)]
"""A list of types by name, or ``auto`` for the simplest type that is feasible."""


class Chain(Statement):
    """The chain G–H₁–H₂ that carries the body at H₂; values that are left out are sampled by the search."""

    links: tuple[PositiveLength | None, PositiveLength | None] | None = Field(
        default=None, description="Lengths G–H₁ and H₁–H₂; one may be left open."
    )
    fixed_pivot: PartialPoint | None = Field(default=None, description="G; a coordinate may be left open.")
    moving_pivot: PartialPoint | None = Field(
        default=None, description="H₂ in the first position; a coordinate may be left open."
    )
    elbow: Literal["any", "left", "right"] = Field(
        default="any", description="Side of the line from G to H₂ on which joint H₁ lies in all positions."
    )

    def size_from(self, point: complex) -> float:
        """Return the longest of the given lengths and of the distances from a point to given pivots; 0 without either.

        An open coordinate of a pivot counts as that of the point.
        """
        ways = [length or 0.0 for length in self.links or ()]
        for pivot in (self.fixed_pivot, self.moving_pivot):
            x, y = pivot or (None, None)
            ways.append(abs(complex(0.0 if x is None else x - point.real, 0.0 if y is None else y - point.imag)))
        return max(ways)


def find_motion_sixbar_contradictions(problem: MotionProblem) -> list[Contradiction]:
    """Return contradictions between the requested types and the other fields."""
    listed: list[Contradiction] = []
    stated = problem.mechanisms
    if problem.chain is not None and not (isinstance(stated, list) and set(stated) <= set(SIXBARS)):
        detail = compose("motion-chain-without-sixbars")
        listed.append(Contradiction("/chain", detail))
    elif problem.chain is not None and (len(problem.positions) > MAX_EXACT_POSITIONS or problem.is_least_squares):
        detail = compose("motion-chain-too-many-positions", maximum=MAX_EXACT_POSITIONS)
        listed.append(Contradiction("/chain", detail))
    if not (isinstance(stated, list) and select_requested_types(stated, MULTILOOP_TYPES)):
        return [*listed, *_check_types(problem)]
    listed += find_type_contradictions(stated, MULTILOOP_TYPES, list_unsupported(problem))
    if select_requested_types(stated, MULTILOOP_TYPES) == (UNCLASSED_SIXBAR,):
        listed += list_unsupported_stephenson_2(problem)
    return [*listed, *_check_chain_reach(problem)]


def list_unsupported(problem: MotionProblem) -> Iterator[Contradiction]:
    """Yield the given fields that sixbars and eightbars do not support."""
    if not problem.sixbars_possible:
        detail = compose("motion-sixbar-too-many-positions", maximum=MAX_SIXBAR_POSITIONS)
        yield Contradiction("/mechanisms", detail)
    for name, of_fourbars in (
        ("input_side", problem.input_side != type(problem.input_side)()),
        ("output_side", problem.output_side != type(problem.output_side)()),
        ("ground_line", problem.ground_line is not None),
        ("driver_dyad", problem.driver is not None),
    ):
        if of_fourbars:
            detail = compose("motion-not-for-sixbars")
            yield Contradiction(f"/{name}", detail)
    yield from find_unsupported_by_sixbars(problem)


def list_unsupported_stephenson_2(problem: MotionProblem) -> Iterator[Contradiction]:
    """Yield the given fields that Stephenson II sixbars, or their search, do not support."""
    yield from refuse_class(problem.constraints)
    if problem.constraints.full_rotation:
        yield Contradiction("/constraints/full_rotation", compose("motion-not-for-stephenson-2"))
    if problem.chain is not None:
        detail = compose("motion-chain-type-unsupported")
        yield Contradiction("/chain", detail)


def _check_types(problem: MotionProblem) -> list[Contradiction]:
    """Return contradictions between the listed types and the dyads of the sides."""
    stated = problem.mechanisms
    if stated is None or isinstance(stated, str):
        return []
    slider = problem.slider is not None
    if slider and "slider_crank" not in stated:
        return [Contradiction("/mechanisms", compose("motion-slider-not-listed"))]
    if problem.slider == "RP":
        detail = compose("motion-inverted-slider-not-listable")
        return [Contradiction("/mechanisms", detail)]
    if "fourbar" not in stated and not slider and problem.output_side.dyad == "RR":
        return [Contradiction("/mechanisms", compose("motion-fourbar-not-listed"))]
    return []


def _check_chain_reach(problem: MotionProblem) -> list[Contradiction]:
    """Return the contradiction of a fully given chain that cannot reach one of the positions."""
    chain = problem.chain
    if chain is None or chain.links is None or None in chain.links or problem.positions[0].tolerance is not None:
        return []  # H₂ is given at the first position as the mechanism meets it, which a tolerance leaves open
    pivot, pin = to_complete_point(chain.fixed_pivot), to_complete_point(chain.moving_pivot)
    if pivot is None or pin is None:
        return []
    first, second = (length or 0.0 for length in chain.links)
    start = problem.positions[0].point
    for k, (position, turn) in enumerate(zip(problem.positions, problem.turns, strict=True)):
        # H₂ moves with the body; the chain must span its distance from G in every exact position.
        reach = abs(position.point + cmath.exp(1j * turn) * (pin - start) - pivot)
        if position.tolerance is None and not abs(first - second) < reach < first + second:
            detail = compose("motion-chain-too-short", position=k, distance=f"{reach:.6g}", unit=problem.length_unit)
            return [Contradiction("/chain/links", detail)]
    return []
