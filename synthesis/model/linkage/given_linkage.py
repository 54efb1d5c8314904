"""Models that describe a given linkage: pivots, lines, lengths, and the skeleton.

:mod:`synthesis.mechanisms` converts them to mechanisms of the analysis core, which is not imported here.
"""

from __future__ import annotations

import cmath
import math
from typing import Annotated, Literal

from pydantic import Field

from synthesis.model.dimension import LENGTH
from synthesis.model.problem import Degrees, NonNegative, Number, Point, PositiveLength, Statement

# Users copy dimensions from drawings with six or seven digits.
AGREEMENT_TOLERANCE = 1e-6
"""Relative tolerance of redundant dimensions (ground, offset), for the rounding of printed digits."""

ROUNDING_TOLERANCE = 1e-12
"""Additional tolerance of distances, as a share of the largest coordinate, for the rounding of coordinates."""

BODY_DESCRIPTION = "Angle of the guided body in the reference configuration, degrees; ignored."
"""Description of a field that designs have and that an analysis ignores."""

Assembly = Literal["open", "crossed"]


class FixedPivotsSpec(Statement):
    """Fixed pivots of input and output."""

    input: Point
    output: Point


class CouplerPointSpec(Statement):
    """P: distance from A, and angle from the coupler's line (A towards its other pin) to the line A → P, degrees."""

    distance: Annotated[NonNegative, LENGTH]
    angle: Degrees = 0.0

    @property
    def vector(self) -> complex:
        """P in the coupler's frame, complex, length units."""
        return cmath.rect(self.distance, math.radians(self.angle))


class LineSpec(Statement):
    """A slide on the ground: a point of its line and the line's angle, degrees."""

    point: Point
    angle: Degrees


class FourbarLengths(Statement):
    """Link lengths; ``ground`` follows from the fixed pivots and may be left out."""

    ground: PositiveLength | None = None
    input: PositiveLength
    coupler: PositiveLength
    output: PositiveLength


class SlideSpec(LineSpec):
    """A slide by its joint and its link, in the reference configuration."""

    joint: str = Field(min_length=1, max_length=50)
    link: str = Field(min_length=1, max_length=50)


class LinkSpec(Statement):
    """A rigid link and the joints on it."""

    name: str = Field(min_length=1, max_length=50)
    joints: list[Annotated[str, Field(min_length=1, max_length=50)]] = Field(min_length=1, max_length=20)


class GearSpec(Statement):
    """Rotation of the second link = ratio × rotation of the first, both relative to ground."""

    links: tuple[str, str]
    ratio: Number


class SkeletonSpec(Statement):
    """Joints in a reference configuration, and the links, slides and gears that connect them.

    The input is the name of a link, or the joint of a slide.
    """

    joints: dict[Annotated[str, Field(min_length=1, max_length=50)], Point] = Field(min_length=2, max_length=40)
    links: list[LinkSpec] = Field(min_length=2, max_length=20)
    slides: list[SlideSpec] = Field(default=[], max_length=10)
    gears: list[GearSpec] = Field(default=[], max_length=10)
    input_link: str
