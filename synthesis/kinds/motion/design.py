"""Answers to problems of motion generation."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Discriminator, Field

from synthesis.model.answer import Answer, Point, optional_field
from synthesis.model.dimension import Angle, Length
from synthesis.model.linkage.answer import LinkageDesign, LinkageResult


class BurmesterBranch(Answer):
    """A connected branch of Burmester's curves, sampled at equal steps of the arc length of both curves together.

    A moving pivot at ``circle_points[k]`` in the first position has its fixed pivot at ``centre_points[k]``. ``closed``
    branches return to their start; the others leave the sampled region, with or without an asymptote.
    """

    circle_points: list[Point]
    centre_points: list[Point]
    closed: bool


class GuideBase(Answer):
    """What all plain guides have in common: the body in its first position, and by how much it misses the others."""

    point: Point = Field(description="P in the first position, carried by the guide.")
    body_angle: Angle = Field(description="Angle of the body's line in the first position, absolute, degrees.")
    max_distance: Length = Field(description="Maximum distance by which P misses a position, length units.")
    max_angle_error: Angle = Field(description="Maximum angle by which the body misses a position, degrees.")


class Hinge(GuideBase):
    """A single pin joint between body and ground. P and every other point of the body turn about its pivot."""

    type: Literal["hinge"] = "hinge"
    pivot: Point
    rotations: list[Angle] = Field(
        description="Rotation of the body from the first position to each, degrees, counter-clockwise."
    )


class StraightGuide(GuideBase):
    """A slide: the body moves along a straight line and does not turn. Any parallel line may guide it."""

    type: Literal["slide"] = "slide"
    direction: Angle = Field(
        description="Direction of the slide, absolute, degrees; P moves on a line through `point`."
    )
    travels: list[Length] = Field(
        description="Travel from the first position to each, in that direction, length units."
    )


class Parallelogram(GuideBase):
    """Two equal parallel cranks: the body moves on a circle and does not turn.

    Any two points of the body may be its moving pivots. Design 1 of the answer is one such linkage.
    """

    type: Literal["parallelogram"] = "parallelogram"
    link_length: Length = Field(description="Length of both cranks, length units.")
    pivot_offset: Point = Field(
        description="From each moving pivot in the first position to its fixed pivot, length units."
    )
    rotations: list[Angle] = Field(
        description="Rotation of the cranks from the first position to each, degrees, counter-clockwise."
    )


Guide = Annotated[Hinge | StraightGuide | Parallelogram, Discriminator("type")]
"""A plain guide, identified by its field ``type``."""


class MotionResult(LinkageResult[LinkageDesign]):
    """Linkages that carry the body through the positions."""

    guide: Guide | None = optional_field(
        "A hinge, slide or parallelogram that carries the body through all positions by itself; left out if none does, "
        "or if the problem chooses dyads, types or a driver."
    )
    curves: list[BurmesterBranch] = Field(
        default=[], description="For four positions: all dyads that carry the body through them, as Burmester's curves."
    )
