"""Results of dwell problems."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from synthesis.model.answer import Answer, Point, Verification, optional_field
from synthesis.model.dimension import Angle, Length, Output, OutputPerRadian, OutputPerRadianSquared
from synthesis.model.dynamics.peak_forces import DesignForces
from synthesis.model.linkage.answer import (
    LAYOUT_FIELD,
    PEAKS_FIELD,
    CouplerPoint,
    Layout,
    LinkageResult,
    MotionMetrics,
    Skeleton,
)

MechanismType = Literal[
    "dwell_rocker", "dwell_slider", "dwell_slot", "dwell_watt_rocker", "dwell_watt_slider", "dwell_stephenson_2"
]


class DwellMechanism(Answer):
    """A sixbar with a dwell, whose crank turns through.

    All types but the last are a fourbar O2 A B O4 with an output that P leaves at rest.

    ``dwell_rocker``: link 5 from P to D, the output O6–D. ``dwell_slider``: link 5 from P to D on a slide.
    ``dwell_slot``: P in a slot of the output, which turns about O6; C marks the slot's end. In these P is on the
    coupler. ``dwell_watt_rocker`` and ``dwell_watt_slider`` are the first two with P on the rocker O4–B.

    ``dwell_stephenson_2``: a crank O2 A C, the links 3 (A–B) and 5 (C–D) from it to link 4 (B D E), and the output
    O4–E, which rests while link 4 turns about E.
    """

    type: MechanismType
    fixed_pivots: dict[str, Point] = Field(
        description="By the names of the joints: O2, O4 and, except for a slider and a Stephenson II, O6."
    )
    links: dict[str, Length] = Field(
        description="ground (O2–O4), input, coupler, rocker; link_5 and output, if present, the output of a slot up to "
        "its end. To the third pin of a link from its first, and from its second: coupler_arm (A–P) and "
        "coupler_side (B–P), or rocker_arm (O4–P) and rocker_side (B–P); except for a slider, ground_arm (O2–O6) and "
        "ground_side (O4–O6). Of a Stephenson II ground (O2–O4), input (O2–A), link_3, link_4 (B–D), link_5 and output "
        "(O4–E); input_arm (O2–C), input_side (A–C), link_4_arm (B–E), link_4_side (D–E)."
    )
    coupler_point: CouplerPoint | None = optional_field(
        "P on the coupler; left out if P is on the rocker, and for a Stephenson II."
    )
    reference_input_angle: Angle = Field(description="Crank angle at which the first dwell begins, absolute, degrees.")
    skeleton: Skeleton


class Rest(Answer):
    """A dwell as measured."""

    index: int
    input_angle: Angle = Field(description="Crank angle at which it begins, absolute, degrees; the crank turns ccw.")
    level: Output = Field(
        description="Output in the middle of its extremes during the dwell: degrees, or place along the slide."
    )
    jitter: Output = Field(description="Maximum minus minimum output during the required crank rotation.")
    width: Angle = Field(description="Crank rotation, degrees, during which the output stays within the tolerance.")
    off_end: float = Field(
        description="Distance of the mean output from the nearer end of its range, as a share of the range."
    )


class PlacedDwell(Answer):
    """A dwell that was requested by its place, in the order of the problem, as found."""

    angle: Angle = Field(description="Required rotation of the crank, degrees.")
    at: float = Field(description="Mean output during the dwell, as a share of its range from the minimum.")
    error: Output = Field(description="Maximum minus minimum output during the dwell.")


class DwellMetrics(MotionMetrics):
    """Measured properties of a dwell sixbar, over a full turn of the crank.

    The output is in degrees, or in length units of a slider. For the quality, the task's size is the stroke, or twice
    the crank.
    """

    way: Output = Field(description="Swing or stroke over a full turn.")
    jitter: Output = Field(description="The largest of all dwells.")
    peak_velocity: OutputPerRadian = Field(
        description="Peak velocity of the output at a crank speed of 1 rad/s: rad/s, or length units/s."
    )
    peak_acceleration: OutputPerRadianSquared = Field(
        description="Peak acceleration of the output at a crank speed of 1 rad/s: rad/s², or length units/s²."
    )
    same_branch: bool


class DwellDesign(Answer):
    """A dwell sixbar with its verification."""

    mechanism: DwellMechanism
    targets: list[Rest]
    dwells: list[PlacedDwell] | None = optional_field("For a problem with `dwells`: each of them, in its order.")
    verification: Verification
    metrics: DwellMetrics
    layout: Layout | None = LAYOUT_FIELD
    forces: DesignForces | None = PEAKS_FIELD


class DwellResult(LinkageResult[DwellDesign]):
    """Dwell sixbars, best first."""
