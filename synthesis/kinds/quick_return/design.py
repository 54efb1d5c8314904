"""Results of quick return problems."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Discriminator, Field

from synthesis.model.answer import Answer, Point, Verification, optional_field
from synthesis.model.dimension import Angle, Length, Output
from synthesis.model.dynamics.peak_forces import DesignForces
from synthesis.model.linkage.answer import (
    LAYOUT_FIELD,
    PEAKS_FIELD,
    FixedPivots,
    FourbarMechanism,
    Layout,
    Line,
    LinkageResult,
    MotionMetrics,
    Skeleton,
    SliderCrankMechanism,
)


class QuickReturnLinks(Answer):
    """Link lengths; ``rocker`` is the distance from O4 to C."""

    ground: Length
    crank: Length
    rocker: Length
    coupler: Length


class QuickReturnMechanism(Answer):
    """Crank-shaper or Whitworth: the crank pin A slides in a link about O4, whose end C drives the ram D.

    ``open``: of the two places that the coupler reaches, the ram is at the one farther along the slide's direction.
    """

    type: Literal["crank_shaper", "whitworth"]
    fixed_pivots: FixedPivots
    links: QuickReturnLinks
    slide: Line = Field(description="The ram's line on the ground.")
    assembly: Literal["open", "crossed"]
    reference_input_angle: Angle = Field(description="Crank angle at the first target, absolute, degrees.")
    skeleton: Skeleton


class DragLinkMechanism(Answer):
    """A drag-link sixbar: two cranks O2–A and O4–B with a coupler, and a dyad from B to a rocker or a slider.

    ``links`` are lengths by name; the skeleton defines the mechanism completely.
    """

    type: Literal["drag_link_rocker", "drag_link_slider"]
    fixed_pivots: dict[str, Point] = Field(description="By the names of the joints: O2, O4 and, for a rocker, O6.")
    links: dict[str, Length] = Field(
        description="ground, input, coupler and driven_crank of the drag link; link_5, from B to the output; "
        "output, O6 to C, and output_ground, O4 to O6, of a rocker."
    )
    skeleton: Skeleton


QuickReturnMechanisms = Annotated[
    FourbarMechanism | SliderCrankMechanism | QuickReturnMechanism | DragLinkMechanism, Discriminator("type")
]
"""Any mechanism of quick return; the field ``type`` selects it."""


class LimitPosition(Answer):
    """A limit position of the output, as measured on the driven mechanism; the slow stroke goes from 0 to 1."""

    index: int
    input_angle: Angle = Field(description="Absolute crank angle, degrees; the crank turns counter-clockwise.")
    output: Output = Field(description="Angle of the output link, degrees, or position along the slide from its point.")


class QuickReturnMetrics(MotionMetrics):
    """Measured properties of a quick-return mechanism, over a full turn of the crank."""

    time_ratio: float = Field(description="Slow stroke over fast one, from the measured limit positions.")
    slow_rotation: Angle = Field(description="Crank rotation of the slow stroke, degrees.")
    fast_rotation: Angle = Field(description="Crank rotation of the fast stroke, degrees.")
    swing: Angle | None = optional_field("Swing of a swinging output, degrees.")
    stroke: Length | None = optional_field("Stroke of a sliding output, length units.")


class QuickReturnDesign(Answer):
    """A quick-return mechanism with its verification."""

    mechanism: QuickReturnMechanisms
    targets: list[LimitPosition]
    verification: Verification
    metrics: QuickReturnMetrics
    layout: Layout | None = LAYOUT_FIELD
    forces: DesignForces | None = PEAKS_FIELD


class RatioRange(Answer):
    """Time ratios that a type can reach with the given output, both ends excluded unless noted."""

    type: str
    least: float
    least_included: bool = Field(description="Whether the least ratio itself can be reached.")
    greatest: float | None = Field(description="Upper limit, never reached itself; null if there is none.")
    reaches: bool = Field(description="Whether the required ratio is within the range.")
    reason: str = Field(description="Reason for the limit of the type.")


class QuickReturnResult(LinkageResult[QuickReturnDesign]):
    """Quick-return mechanisms, and the range of each type."""

    reachable: list[RatioRange]
