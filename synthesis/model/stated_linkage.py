"""What a client states of a linkage that there is: pivots, lines, lengths, and the skeleton. Data alone.

What the analysis core makes of it is in :mod:`synthesis.mechanisms`, which brings the core with it.
"""

from __future__ import annotations

import cmath
import math
from typing import Annotated, Literal

from pydantic import Field

from synthesis.model.dimension import LENGTH
from synthesis.model.statement import Degrees, NonNegative, Number, Point, PositiveLength, Statement

AGREES = 1e-6
"""A dimension that others determine already (ground, offset) may differ from them by this share: printed digits."""

ROUNDING = 1e-12
"""Distances may differ by this share of the largest coordinate too: joints that coincide are not quite at one place."""

BODY = "Angle of the body that a design guides in the reference, degrees; not looked at."
"""What a field of designs means that an analysis has no use for."""

Assembly = Literal["open", "crossed"]


class StatedPivots(Statement):
    """Fixed pivots of input and output."""

    input: Point
    output: Point


class StatedCouplerPoint(Statement):
    """P: distance from A, and angle from the coupler's line (A towards its other pin) to the line A → P, degrees."""

    distance: Annotated[NonNegative, LENGTH]
    angle: Degrees = 0.0

    @property
    def vector(self) -> complex:
        """P in the coupler's frame."""
        return cmath.rect(self.distance, math.radians(self.angle))


class StatedLine(Statement):
    """A slide on the ground: a point of its line and the line's angle, degrees."""

    point: Point
    angle: Degrees


class FourbarLengths(Statement):
    """Link lengths; ``ground`` follows from the fixed pivots and may be left out."""

    ground: PositiveLength | None = None
    input: PositiveLength
    coupler: PositiveLength
    output: PositiveLength


class StatedSlide(StatedLine):
    """A slide by its joint and its link, in the reference configuration."""

    joint: str = Field(min_length=1, max_length=50)
    link: str = Field(min_length=1, max_length=50)


class StatedLink(Statement):
    """A rigid link and the joints on it."""

    name: str = Field(min_length=1, max_length=50)
    joints: list[Annotated[str, Field(min_length=1, max_length=50)]] = Field(min_length=1, max_length=20)


class StatedGear(Statement):
    """Rotation of the second link = ratio × rotation of the first, both relative to ground."""

    links: tuple[str, str]
    ratio: Number


class StatedSkeleton(Statement):
    """Joints in a reference configuration, and what joins them; the input is a link's name, or a slide's joint."""

    joints: dict[Annotated[str, Field(min_length=1, max_length=50)], Point] = Field(min_length=2, max_length=40)
    links: list[StatedLink] = Field(min_length=2, max_length=20)
    slides: list[StatedSlide] = Field(default=[], max_length=10)
    gears: list[StatedGear] = Field(default=[], max_length=10)
    input_link: str
