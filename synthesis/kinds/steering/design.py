"""Results of steering problems."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Discriminator, Field

from synthesis.model.answer import Answer, Point, Verification, optional_field
from synthesis.model.dimension import Angle, Length
from synthesis.model.dynamics.peak_forces import DesignForces
from synthesis.model.linkage.answer import (
    LAYOUT_FIELD,
    PEAKS_FIELD,
    BuildMetrics,
    FourbarMechanism,
    Layout,
    LinkageResult,
    Skeleton,
    TargetInput,
)


class DavisMechanism(Answer):
    """Davis's steering gear: a bar that slides along the axle, with pins in the slots of both arms."""

    type: Literal["davis"] = "davis"
    fixed_pivots: dict[str, Point] = Field(description="The kingpins: O2 left, O4 right.")
    links: dict[str, Length] = Field(description="ground between the kingpins, and bar between its pins.")
    skeleton: Skeleton


SteeringMechanisms = Annotated[FourbarMechanism | DavisMechanism, Discriminator("type")]
"""Any steering mechanism; the field ``type`` selects it."""


class SteeringPosition(TargetInput):
    """The steering turned to the left, as measured on the driven mechanism, whose input is the left arm or the bar."""

    inner: Angle
    outer: Angle
    required: Angle = Field(description="Required angle of the outer wheel.")
    error: Angle = Field(description="outer − required.")


class SteeringMetrics(BuildMetrics):
    """Measured properties of a steering mechanism."""

    steering_error: Angle = Field(description="Maximum magnitude of the error up to the lock, to both sides, degrees.")
    correct_at: list[Angle] = Field(description="Inner angles between which the error changes sign, degrees.")
    outer_lock: Angle = Field(description="Angle of the outer wheel at the lock, degrees.")
    arm_length: Length = Field(description="Length of a steering arm; for Davis's gear, in the straight position.")
    arm_angle: Angle = Field(description="Angle of the arms from the vehicle's axis in the straight position, degrees.")
    tie_rod: Literal["behind", "ahead"]
    turning_radius: Length = Field(
        description="Radius of the outer front wheel's path at the lock, if its angle were the required one."
    )
    min_transmission_angle: Angle = Field(description="Over the whole range, degrees.")
    link_ratio: float = Field(description="Longest link over shortest.")
    size: Length = Field(description="Diagonal of the box around all joints in the straight position.")
    tie_rod_clearance: Length | None = optional_field(
        "Distance of the tie rod's pins from the inner faces of the wheels, across the vehicle; negative if they reach "
        "into the wheels. Without `wheel_width` the wheels are 0.12 of the track wide; without a track they begin at "
        "the kingpins. Only for Ackermann's linkages."
    )
    bar_travel: Length | None = optional_field("Travel of Davis's bar, to each side.")


class SteeringDesign(Answer):
    """A steering mechanism with its verification."""

    mechanism: SteeringMechanisms
    targets: list[SteeringPosition]
    verification: Verification
    metrics: SteeringMetrics
    layout: Layout | None = LAYOUT_FIELD
    forces: DesignForces | None = PEAKS_FIELD


class SteeringResult(LinkageResult[SteeringDesign]):
    """Steering mechanisms, the smallest steering error first."""
