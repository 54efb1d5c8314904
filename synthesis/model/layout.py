"""Block ``layout`` of a problem: sizes of links and pins, arrangement in planes (docs/mechanisms/layout.md)."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import Field, ValidationInfo, field_validator

from kinematics.message import compose
from synthesis.model.dimension import LENGTH
from synthesis.model.problem import Count, NonNegative, PositiveLength, Statement

MAX_PLANES = 20
"""Maximum number of planes that may be requested; no linkage has that many links."""


class LayoutSizes(Statement):
    """Sizes of links and pins, and their arrangement in planes (docs/mechanisms/layout.md)."""

    link_width: PositiveLength = Field(
        description="Width of the links: a link is the hull of its joints, widened by half of this."
    )
    pin_diameter: PositiveLength = Field(description="Diameter of pins and shafts; at most the width of the links.")
    thickness: PositiveLength = Field(description="Thickness of a plane.")
    gap: Annotated[NonNegative, LENGTH] = Field(
        default=0.0, description="Minimum distance between two parts in one plane, and distance between planes."
    )
    shafts: Literal["one_side", "both_sides"] = Field(
        default="one_side",
        description="Support of the shafts at fixed pivots: one_side: on a base below all links; both_sides: through "
        "all planes to a second base above them.",
    )
    over: Literal["used", "cycle"] = Field(
        default="used",
        description="Motion that is checked: used: the used range of the input; cycle: a whole turn of the input, or "
        "its range from toggle to toggle.",
    )

    @field_validator("pin_diameter")
    @classmethod
    def _validate_diameter(cls, diameter: float, info: ValidationInfo) -> float:
        # Infinite if the width itself failed validation: one error is enough.
        if diameter > info.data.get("link_width", math.inf):
            raise ValueError(compose("model-pin-wider-than-link"))
        return diameter


class LayoutSpec(LayoutSizes):
    """Sizes of links and pins of each design, their arrangement in planes, and the maximum number of planes."""

    max_planes: Annotated[Count, Field(ge=1, le=MAX_PLANES)] | None = Field(
        default=None,
        description="Maximum number of planes for moving links and gears; designs that need more are rejected.",
    )
