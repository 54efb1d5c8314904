"""Parts of statements about gears: exact ratios, tooth numbers and their ranges, pitches."""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator, Field

from kinematics.message import compose
from synthesis.model.dimension import ANGLE, LENGTH
from synthesis.model.gears.ratio_target import MAX_TEXT_LENGTH, parse_target
from synthesis.model.problem import Contradiction, Count, Number, PositiveLength, Range, Statement

MIN_TEETH = 3
"""Minimum number of teeth: full-depth gears with fewer have no root circle."""

MAX_TEETH = 2000
"""Maximum number of teeth; larger numbers are typing errors. Its fourth power is exact in every number type of the
searches."""

MAX_TOOTH_SUM = 400
"""Maximum sum of teeth of a pair of gears in a gearbox."""


def _parse_ratio(text: float | str) -> float | str:
    parse_target(text)
    return text


ExactRatio = Annotated[
    Annotated[Number, Field(strict=True)]
    | Annotated[str, Field(strict=True, min_length=1, max_length=MAX_TEXT_LENGTH)],
    AfterValidator(_parse_ratio),
]
"""A number, or a text in the grammar of :mod:`synthesis.model.gears.ratio_target`."""

Pitch = Annotated[float, Field(strict=True, ge=1e-6, le=1e6)]
"""Module or diametral pitch. Larger values would lead to lengths outside the permitted range; smaller ones are typing
errors.
"""

Module = Annotated[Pitch, LENGTH]

ToothNumber = Annotated[Count, Field(ge=MIN_TEETH, le=MAX_TEETH)]

RangedTeeth = Annotated[Count, Field(ge=4, le=1000)]
"""Tooth number, or tooth sum of a pair, in planetary trains and gearboxes."""

PressureAngle = Annotated[float, ANGLE, Field(strict=True, ge=10.0, le=30.0)]
"""Degrees."""

CommonPressureAngle = Annotated[float, ANGLE, Field(strict=True, ge=14.0, le=30.0)]
"""Pressure angle of planetary trains and gearboxes, degrees. Their bounds on tooth numbers are valid from 14° on."""


ShiftCoefficient = Annotated[float, Field(strict=True, ge=-2.0, le=2.0)]
"""Profile shift in modules, positive outwards, also for rings."""

ContactRatio = Annotated[float, Field(strict=True, ge=1.0, le=2.5)]
"""Minimum mean number of pairs of teeth in contact."""

TipThickness = Annotated[float, Field(strict=True, ge=0.0, le=1.5)]
"""Minimum thickness of a tooth at its tip, in modules."""


Addendum = Annotated[float, Field(strict=True, ge=0.3, le=1.25)]
"""Height of a tooth above its pitch circle, in modules."""


class ShiftRange(Range):
    """Minimum and maximum profile shift of a gear, in modules; equal values fix it."""

    min: ShiftCoefficient
    max: ShiftCoefficient


class DistanceRange(Range):
    """Minimum and maximum centre distance."""

    min: PositiveLength
    max: PositiveLength


class ToothRange(Statement):
    """Minimum and maximum number of teeth of one gear; equal values fix it."""

    min: RangedTeeth
    max: RangedTeeth


def find_tooth_errors(teeth: ToothRange, tooth_sum: ToothRange) -> list[Contradiction]:
    """Return a contradiction for each pair of limits on the teeth of a gearbox whose minimum exceeds the maximum."""
    return [
        Contradiction(f"/{name}/max", compose("model-max-below-min"))
        for name, limits in (("teeth", teeth), ("tooth_sum", tooth_sum))
        if limits.min > limits.max
    ]
