"""Which types of mechanism may carry the body, and what the client fixes of the chain that sixbars are made of."""

from __future__ import annotations

import cmath
from collections.abc import Iterator
from typing import Annotated, Any, Literal, get_args

from pydantic import Field

from synthesis.kinds.motion.stated_dyads import whole_point
from synthesis.kinds.motion.stated_positions import MOST_HELD, MOST_OF_SIXBARS
from synthesis.model.stated_types import UNCLASSED, Auto, beside_sixbars, named_among, no_class, refused
from synthesis.model.statement import Contradiction, PartialPoint, PositiveLength, Statement

Sixbar = Literal["watt_1", "stephenson_1", "stephenson_2", "stephenson_3"]
"""Sixbars that carry a body by a link that a fourbar alone does not move."""

SIXBARS: tuple[Sixbar, ...] = get_args(Sixbar)

Mechanisms = Auto | Annotated[list[Literal["fourbar", "slider_crank"] | Sixbar], Field(min_length=1, max_length=6)]
"""Types by their names, or the simplest that does."""


class Chain(Statement):
    """The chain G–H₁–H₂ that carries the body at H₂; what is left out is drawn by the search."""

    links: tuple[PositiveLength | None, PositiveLength | None] | None = Field(
        default=None, description="Lengths G–H₁ and H₁–H₂; one may be left open."
    )
    fixed_pivot: PartialPoint | None = Field(default=None, description="G; a coordinate may be left open.")
    moving_pivot: PartialPoint | None = Field(
        default=None, description="H₂ in the first position; a coordinate may be left open."
    )
    elbow: Literal["any", "left", "right"] = Field(
        default="any", description="On which side of the way from G to H₂ the joint H₁ lies in all positions."
    )

    def size_from(self, point: complex) -> float:
        """The longest stated length, or the way from a point to a stated pivot if that is longer; 0 without either.

        An open coordinate of a pivot counts as that of the point.
        """
        ways = [length or 0.0 for length in self.links or ()]
        for pivot in (self.fixed_pivot, self.moving_pivot):
            x, y = pivot or (None, None)
            ways.append(abs(complex(0.0 if x is None else x - point.real, 0.0 if y is None else y - point.imag)))
        return max(ways)


def of_sixbars(problem: Any) -> list[Contradiction]:
    """What cannot be demanded of the types that are looked for."""
    listed: list[Contradiction] = []
    stated = problem.mechanisms
    if problem.chain is not None and not (isinstance(stated, list) and set(stated) <= set(SIXBARS)):
        detail = "belongs to sixbars; name types of sixbars alone in mechanisms"
        listed.append(Contradiction("/chain", detail))
    elif problem.chain is not None and (len(problem.positions) > MOST_HELD or problem.fitted):
        detail = (
            f"is constrained for up to {MOST_HELD} positions that are met exactly or within tolerances; leave it out"
        )
        listed.append(Contradiction("/chain", detail))
    if not (isinstance(stated, list) and named_among(stated, SIXBARS)):
        return [*listed, *_of_types(problem)]
    listed += refused(stated, SIXBARS, lacking(problem))
    if named_among(stated, SIXBARS) == (UNCLASSED,):
        listed += beyond_unclassed(problem)
    return [*listed, *_faults_of_chain(problem)]


def lacking(problem: Any) -> Iterator[Contradiction]:
    """What is stated that sixbars cannot keep."""
    if not problem.few_enough:
        detail = f"sixbars are sought for up to {MOST_OF_SIXBARS} positions; take fourbars for more"
        yield Contradiction("/mechanisms", detail)
    for name, of_fourbars in (
        ("input_side", problem.input_side != type(problem.input_side)()),
        ("output_side", problem.output_side != type(problem.output_side)()),
        ("ground_line", problem.ground_line is not None),
        ("driver_dyad", problem.driver is not None),
    ):
        if of_fourbars:
            detail = "is of fourbars; leave it out, or take the sixbars out of mechanisms"
            yield Contradiction(f"/{name}", detail)
    yield from beside_sixbars(problem)


def beyond_unclassed(problem: Any) -> Iterator[Contradiction]:
    """What is stated that a Stephenson II sixbar cannot keep, or is not looked for with."""
    yield from no_class(problem.constraints)
    if problem.constraints.full_rotation:
        yield Contradiction(
            "/constraints/full_rotation", "is not looked for in Stephenson II sixbars; drop the demand, or name others"
        )
    if problem.chain is not None:
        detail = "is constrained to Watt I and Stephenson I and III sixbars; name one of these, or leave it out"
        yield Contradiction("/chain", detail)


def _of_types(problem: Any) -> list[Contradiction]:
    """Types beside choices that exclude them."""
    stated = problem.mechanisms
    if stated is None or isinstance(stated, str):
        return []
    slider = problem.slider is not None
    if slider and "slider_crank" not in stated:
        return [Contradiction("/mechanisms", "a side has a slider; take slider_crank into mechanisms")]
    if problem.slider == "RP":
        detail = "a line of the body slides, which makes an inverted slider-crank: no list names that; leave it out"
        return [Contradiction("/mechanisms", detail)]
    if "fourbar" not in stated and not slider and problem.output_side.dyad == "RR":
        return [Contradiction("/mechanisms", "both sides have pins; take fourbar into mechanisms")]
    return []


def _faults_of_chain(problem: Any) -> list[Contradiction]:
    """A chain that does not reach, as far as all of it is stated."""
    chain = problem.chain
    if chain is None or chain.links is None or None in chain.links or problem.positions[0].tolerance is not None:
        return []  # H₂ is stated in the first position as it is met
    pivot, pin = whole_point(chain.fixed_pivot), whole_point(chain.moving_pivot)
    if pivot is None or pin is None:
        return []
    first, second = (length or 0.0 for length in chain.links)
    start = problem.positions[0].point
    for k, (position, turn) in enumerate(zip(problem.positions, problem.turns, strict=True)):
        reach = abs(position.point + cmath.exp(1j * turn) * (pin - start) - pivot)
        if position.tolerance is None and not abs(first - second) < reach < first + second:
            detail = f"G and H₂ are {reach:.6g} {problem.length_unit} apart in position {k}, which these do not reach"
            return [Contradiction("/chain/links", detail)]
    return []
