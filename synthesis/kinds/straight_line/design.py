"""Results of straight line problems."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Discriminator, Field

from synthesis.kinds.straight_line.problem import LineMechanism
from synthesis.model.answer import Answer, Point, Verification, optional_field
from synthesis.model.dimension import Angle, Length, LengthPerRadian, Percent
from synthesis.model.dynamics.peak_forces import DesignForces
from synthesis.model.linkage.answer import (
    LAYOUT_FIELD,
    PEAKS_FIELD,
    FourbarMechanism,
    Layout,
    LinkageResult,
    MotionMetrics,
    Skeleton,
)


class ExactLineMechanism(Answer):
    """Peaucellier's eightbar, Hart's sixbar or Scott-Russell's slider-crank; the skeleton defines it completely.

    Peaucellier: crank O2–A, arms O4–B and O4–C, rhombus A B P C. Hart: crank O2–A, crossed parallelogram B C E D with
    O4 on B–C, A on B–D and P on E–C. Scott-Russell: crank O2–A to the middle of the coupler P–B, B on a slide through
    O2.
    """

    type: Literal["peaucellier", "hart", "scott_russell"]
    fixed_pivots: dict[str, Point] = Field(description="By the names of the joints: O2, and O4 of an inversor.")
    links: dict[str, Length] = Field(description="Lengths by the names of the skeleton's links.")
    skeleton: Skeleton


LineMechanisms = Annotated[FourbarMechanism | ExactLineMechanism, Discriminator("type")]
"""Any straight-line mechanism; the field ``type`` selects it."""


class LinePoint(Answer):
    """P at an end of the line, as measured."""

    index: int
    input_angle: Angle = Field(description="Absolute input angle, degrees, continuous from the first.")
    x: Length
    y: Length
    deviation: Length = Field(description="Distance from the required line, length units.")


class StraightLineMetrics(MotionMetrics):
    """Measured properties of a straight-line mechanism, while P is on the line."""

    family: LineMechanism
    proportions: Literal["optimal", "classical", "exact"] = Field(
        description="Whether the proportions are the best of the family, those of the literature, or give an exact "
        "line; free proportions of an exact mechanism are those of best quality."
    )
    deviation: Length = Field(description="Maximum distance of P from the required line, length units.")
    straightness_error: Percent = Field(
        description="Width of the strip along the line's direction that contains P's path, percent of the length."
    )
    velocity_variation: Percent = Field(
        description="Maximum minus minimum velocity along the line at constant input speed, percent of the mean."
    )
    mean_velocity: LengthPerRadian = Field(
        description="Mean velocity along the line, length units per radian of the input."
    )
    middle_velocity: LengthPerRadian = Field(description="The same in the middle of the input's range.")
    input_rotation: Angle = Field(
        description="Rotation of the input from the line's start to its end, degrees, with its sign."
    )
    moving_links: int
    runs_on_slide: bool = Field(
        description="Whether the mechanism itself runs on a straight slide, as Scott-Russell's does."
    )
    cycle_transmission_angle: Angle | None = optional_field(
        "Minimum transmission angle over the full turn of an input that turns through, degrees."
    )
    same_branch: bool
    visits_in_order: bool = Field(description="Whether P runs along the line without turning back.")


class StraightLineDesign(Answer):
    """A straight-line mechanism with its verification."""

    mechanism: LineMechanisms
    targets: list[LinePoint]
    verification: Verification
    metrics: StraightLineMetrics
    layout: Layout | None = LAYOUT_FIELD
    forces: DesignForces | None = PEAKS_FIELD


class StraightLineResult(LinkageResult[StraightLineDesign]):
    """Straight-line mechanisms, best first in the requested measure."""
