"""Reported properties of a manufactured design (docs/mechanisms/manufacture.md)."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from synthesis.model.answer import Answer, Point, optional_field
from synthesis.model.dimension import ANGLE_PER_LENGTH, LENGTH, Angle, Length


def _is_empty(listed: object) -> bool:
    return listed == []


class Yield(Answer):
    """Sampled share of manufactured linkages that are good, with the play of their pins if these have a clearance."""

    value: float
    low: float = Field(description="Lower end of the interval that contains the yield with 99 % confidence.")
    high: float = Field(description="Upper end of that interval.")
    samples: int


class WorstCase(Answer):
    """Maximum errors over all linkages whose dimensions are each at one end of their tolerance."""

    assembles: bool = Field(
        description="Whether all of these linkages can be assembled at the targets and stay on the branch."
    )
    max_error: Length | None = optional_field("Maximum distance from a target; left out if some cannot be assembled.")
    max_angle_error: Angle | None = optional_field(
        "Maximum difference of an angle, degrees; left out if some cannot be assembled."
    )


class Sensitivity(Answer):
    """Derivatives of the measured quantities at the targets by one dimension; the input is readjusted if it is free."""

    dimension: str = Field(description="Field of the mechanism; P has one dimension along A → B and one across.")
    tolerance: Length
    x: list[float] | None = optional_field("Derivative of P's x at each target.")
    y: list[float] | None = optional_field("Derivative of P's y at each target.")
    travel: list[float] | None = optional_field("Derivative of the slider's position at each target.")
    angle: Annotated[list[float], ANGLE_PER_LENGTH] | None = optional_field(
        "Derivative of the body's or the output's angle at each target."
    )
    transmission: Annotated[float, ANGLE_PER_LENGTH] | None = optional_field(
        "Derivative of the minimum transmission angle over the used range."
    )
    share: float = Field(
        description="Contribution of its tolerance to the sum of squares of all errors, to first order and in the "
        "units of the quality, as a share of the contribution of all tolerances."
    )


class Allocation(Answer):
    """Tolerances with which a linkage has the required yield, as wide as their proportion permits."""

    model_config = ConfigDict(extra="forbid", frozen=True, populate_by_name=True, serialize_by_alias=True)

    by: Literal["dimension", "sort", "scale"] = Field(
        description="dimension: each dimension has its own tolerance; sort: one for all lengths and one for all "
        "pivots; scale: the given tolerances, all multiplied by one factor."
    )
    tolerances: Annotated[dict[str, float], LENGTH] = Field(
        description="Tolerance by dimension, named as in `sensitivities`."
    )
    cost: float = Field(
        description="Relative cost: mean ratio of given to allocated tolerance, as the cost of a tolerance is "
        "inversely proportional to it."
    )
    yield_: Yield = Field(alias="yield", description="Yield with these tolerances, from the same samples.")


class Play(Answer):
    """Upper bound of the motion that the pins' clearances permit at a target with the input fixed."""

    index: int
    max_error: Length | None = optional_field("Maximum displacement of P or of the slider from its nominal position.")
    max_angle_error: Angle | None = optional_field(
        "Maximum rotation of the body or of the output in either direction, degrees."
    )
    outline: list[Point] | None = optional_field("Corners of a convex area that contains every possible position of P.")


class RoundingCost(Answer):
    """Increase of each quantity by rounding, relative to the exact design; negative for a decrease."""

    rms_residual: float
    max_error: Length | None = optional_field("Increase of the maximum distance from a target.")
    max_angle_error: Angle | None = optional_field("Increase of the maximum difference of an angle, degrees.")
    min_transmission_angle: Angle = Field(
        description="Increase of the minimum transmission angle; here an increase is an improvement."
    )


class ManufactureReport(Answer):
    """Properties of a design as manufactured."""

    dimensions: Annotated[dict[str, float], LENGTH] | None = optional_field(
        "Manufactured dimensions, on the grid or from the stock, by field of the mechanism; P has one dimension along "
        "A → B and one across."
    )
    cost: RoundingCost | None = optional_field("Cost of rounding, relative to `exact`.")
    seed: int | None = optional_field("Seed of the samples of the yield.")
    play: list[Play] = Field(default=[], exclude_if=_is_empty, description="Play of the pins at each target.")
    worst_case: WorstCase | None = optional_field("Worst case with every dimension at an end of its tolerance.")
    matter: list[str] = Field(
        default=[],
        description="Dimensions whose tolerances cause four fifths of the errors, the most important first.",
    )
    widest: list[Allocation] = Field(
        default=[], exclude_if=_is_empty, description="Widest tolerances, the cheapest first, if requested."
    )
    sensitivities: list[Sensitivity] = Field(
        default=[], description="Sensitivity to each dimension, in decreasing order of their shares."
    )
    remark: str | None = optional_field("Reason why some results are missing.")


MANUFACTURE_FIELD = optional_field("Properties as manufactured; left out if the problem has no `manufacture`.")
"""Field that all designs share."""
