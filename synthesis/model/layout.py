"""The block ``layout`` of a statement: what links are made of, and the planes that they are put in (docs/layout.md)."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import Field, ValidationInfo, field_validator

from synthesis.model.dimension import LENGTH
from synthesis.model.statement import Count, NonNegative, PositiveLength, Statement

MOST_PLANES = 20
"""Planes that may be stated; no linkage has as many links."""


class LayoutSizes(Statement):
    """What the links are made of, and how they are put in planes (docs/layout.md)."""

    link_width: PositiveLength = Field(description="A link is the hull of its joints widened by half of this.")
    pin_diameter: PositiveLength = Field(description="Of pins and shafts; not wider than the links.")
    thickness: PositiveLength = Field(description="Of a plane.")
    gap: Annotated[NonNegative, LENGTH] = Field(
        default=0.0, description="What two parts in one plane keep apart, and one plane from the next."
    )
    shafts: Literal["one_side", "both_sides"] = Field(
        default="one_side",
        description="Whether shafts at fixed pivots stand on a base below all links, or pass all planes to a second "
        "base above them.",
    )
    over: Literal["used", "cycle"] = Field(
        default="used",
        description="The motion that is looked at: the used range of the input, or all of its cycle: a whole turn, or "
        "from toggle to toggle.",
    )

    @field_validator("pin_diameter")
    @classmethod
    def _within_links(cls, diameter: float, stated: ValidationInfo) -> float:
        if diameter > stated.data.get("link_width", math.inf):
            raise ValueError("a pin is not wider than the links that it joins")
        return diameter


class StatedLayout(LayoutSizes):
    """The same of designs, which may be held to a number of planes."""

    max_planes: Annotated[Count, Field(ge=1, le=MOST_PLANES)] | None = Field(
        default=None, description="Planes of moving links and gears, at most; designs that need more are rejected."
    )
