"""What statements about gears are made of: exact ratios, tooth numbers and their ranges, pitches."""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator, Field

from synthesis.model.dimension import ANGLE, LENGTH
from synthesis.model.ratio_target import LONGEST, parse_target
from synthesis.model.statement import Contradiction, Count, Number, PositiveLength, Range, Statement

FEWEST_TEETH = 3
"""Full-depth gears with fewer have no root circle."""

MOST_TEETH = 2000
"""More teeth are a typing error; the fourth power of it is exact in every number that the searches use."""

MOST_TOOTH_SUM = 400
"""Teeth of the two gears of a pair of a gearbox together, at most."""


def _parsed(stated: float | str) -> float | str:
    parse_target(stated)
    return stated


ExactRatio = Annotated[
    Annotated[Number, Field(strict=True)] | Annotated[str, Field(strict=True, min_length=1, max_length=LONGEST)],
    AfterValidator(_parsed),
]
"""A number or a text of the grammar of :mod:`synthesis.model.ratio_target`."""

Pitch = Annotated[float, Field(strict=True, ge=1e-6, le=1e6)]
"""A module or diametral pitch; beyond, lengths of trains would leave the numbers there are. Finer is a typing error."""

Module = Annotated[Pitch, LENGTH]

ToothNumber = Annotated[Count, Field(ge=FEWEST_TEETH, le=MOST_TEETH)]

RangedTeeth = Annotated[Count, Field(ge=4, le=1000)]
"""A tooth number, or the tooth sum of a pair, of planetary trains and gearboxes."""

PressureAngle = Annotated[float, ANGLE, Field(strict=True, ge=10.0, le=30.0)]
"""Degrees."""

CommonPressureAngle = Annotated[float, ANGLE, Field(strict=True, ge=14.0, le=30.0)]
"""Degrees; of planetary trains and gearboxes, whose bounds on tooth numbers hold from 14° on."""


ShiftCoefficient = Annotated[float, Field(strict=True, ge=-2.0, le=2.0)]
"""A profile shift in modules, positive outwards, on rings too."""

ContactRatio = Annotated[float, Field(strict=True, ge=1.0, le=2.5)]
"""The least mean number of pairs of teeth in contact."""

TipThickness = Annotated[float, Field(strict=True, ge=0.0, le=1.5)]
"""Least thickness of a tooth at its tip, in modules."""


Addendum = Annotated[float, Field(strict=True, ge=0.3, le=1.25)]
"""Height of a tooth beyond its pitch circle, in modules."""


class ShiftRange(Range):
    """Least and greatest profile shift of a gear, in modules; equal to fix it."""

    min: ShiftCoefficient
    max: ShiftCoefficient


class DistanceRange(Range):
    """Least and greatest centre distance."""

    min: PositiveLength
    max: PositiveLength


class ToothRange(Statement):
    """Fewest and most teeth of one gear; equal to fix it."""

    min: RangedTeeth
    max: RangedTeeth


def tooth_faults(teeth: ToothRange, tooth_sum: ToothRange) -> list[Contradiction]:
    """Limits the wrong way round, of the gears of a gearbox and of its pairs."""
    return [
        Contradiction(f"/{name}/max", "must not be below min")
        for name, limits in (("teeth", teeth), ("tooth_sum", tooth_sum))
        if limits.min > limits.max
    ]
