"""What an answer says of a design as it is made (docs/manufacture.md)."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from synthesis.model.answer import Answer, Point, optional
from synthesis.model.dimension import ANGLE_PER_LENGTH, LENGTH, Angle, Length


def _none(listed: object) -> bool:
    return listed == []


class Yield(Answer):
    """Share of the linkages made that are good, by sampling."""

    value: float
    low: float = Field(description="Lower end of the interval that holds the yield with 99 % confidence.")
    high: float = Field(description="Its upper end.")
    samples: int


class WorstCase(Answer):
    """The greatest errors of the linkages of which every dimension is at one end of its tolerance."""

    assembles: bool = Field(description="Whether all of them can be assembled at the targets, and stay on the branch.")
    max_error: Length | None = optional("Greatest distance from a target; left out where some cannot be assembled.")
    max_angle_error: Angle | None = optional("Greatest difference of an angle, degrees; left out likewise.")


class Sensitivity(Answer):
    """How what is measured at the targets follows one dimension: derivatives, where the input follows as it is set."""

    dimension: str = Field(description="By its field of the mechanism; P's place is along A → B and across.")
    tolerance: Length
    x: list[float] | None = optional("Of P's x at each target.")
    y: list[float] | None = optional("Of P's y at each target.")
    travel: list[float] | None = optional("Of the slider's place at each target.")
    angle: Annotated[list[float], ANGLE_PER_LENGTH] | None = optional(
        "Of the body's angle, or the output's, at each target."
    )
    transmission: Annotated[float, ANGLE_PER_LENGTH] | None = optional(
        "Of the least transmission angle over the used range."
    )
    share: float = Field(
        description="What its tolerance adds to the sum of the squares of all errors, in the first order and in the "
        "units of the quality, as a share of what all tolerances do."
    )


class Allocation(Answer):
    """Tolerances with which a linkage has the yield that is demanded, as wide as they can be in their proportion."""

    model_config = ConfigDict(extra="forbid", frozen=True, populate_by_name=True, serialize_by_alias=True)

    by: Literal["dimension", "sort", "scale"] = Field(
        description="dimension: each dimension has its own; sort: one for all lengths and one for all pivots; scale: "
        "as they are stated, all widened or narrowed alike."
    )
    tolerances: Annotated[dict[str, float], LENGTH] = Field(description="By dimension, as of `sensitivities`.")
    cost: float = Field(
        description="The mean of stated over allocated tolerance: what it costs against what is stated, where the cost "
        "of a tolerance is as its inverse."
    )
    yield_: Yield = Field(alias="yield", description="With these tolerances, by the same samples.")


class Play(Answer):
    """What the clearances of the pins let the linkage do at a target, with its input held: no more than this."""

    index: int
    max_error: Length | None = optional("Greatest distance of P, or of the slider, from where it stands as drawn.")
    max_angle_error: Angle | None = optional("What the body, or the output, may turn either way, degrees.")
    outline: list[Point] | None = optional("Corners of a convex area that holds every place that P can take.")


class RoundingCost(Answer):
    """What a linkage on the grid has more of than the exact design that it stands for; less is below 0."""

    rms_residual: float
    max_error: Length | None = optional("Greatest distance from a target.")
    max_angle_error: Angle | None = optional("Greatest difference of an angle, degrees.")
    min_transmission_angle: Angle = Field(description="Here more is better.")


class Manufactured(Answer):
    """A design as a shop makes it."""

    dimensions: Annotated[dict[str, float], LENGTH] | None = optional(
        "What is made, on the grid or of the stock, by the field of the mechanism; P's place along A → B and across."
    )
    cost: RoundingCost | None = optional("What rounding cost, against `exact`.")
    seed: int | None = optional("Of the samples of the yield.")
    play: list[Play] = Field(default=[], exclude_if=_none, description="Of the pins, at each target.")
    worst_case: WorstCase | None = optional("With every dimension at an end of its tolerance.")
    matter: list[str] = Field(
        default=[], description="The dimensions whose tolerances matter, the first most: four fifths of the errors."
    )
    widest: list[Allocation] = Field(
        default=[], exclude_if=_none, description="The cheapest first, where the block asks for it."
    )
    sensitivities: list[Sensitivity] = Field(default=[], description="Of each dimension, in the order of the shares.")
    remark: str | None = optional("Why there is less.")


MANUFACTURE = optional("The design as it is made; left out where the problem states no `manufacture`.")
"""The same field of every design."""
