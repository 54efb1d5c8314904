"""Answers to problems of dwells."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from synthesis.model.answer import Answer, Point, Verification, optional
from synthesis.model.dimension import Angle, Length, Output, OutputPerRadian, OutputPerRadianSquared
from synthesis.model.forces_answer import DesignForces
from synthesis.model.linkage_answer import LAYOUT, PEAKS, CouplerPoint, Layout, LinkageResult, MotionMetrics, Skeleton

MechanismType = Literal[
    "dwell_rocker", "dwell_slider", "dwell_slot", "dwell_watt_rocker", "dwell_watt_slider", "dwell_stephenson_2"
]


class DwellMechanism(Answer):
    """A sixbar with a dwell, whose crank turns through.

    All but the last type are a fourbar O2 A B O4 with an output that P leaves at rest.

    ``dwell_rocker``: link 5 from P to D, the output O6–D. ``dwell_slider``: link 5 from P to D on a slide.
    ``dwell_slot``: P in a slot of the output, which turns about O6; C marks the slot's end. In these P is on the
    coupler. ``dwell_watt_rocker`` and ``dwell_watt_slider`` are the first two with P on the rocker O4–B.

    ``dwell_stephenson_2``: a crank O2 A C, the links 3 (A–B) and 5 (C–D) from it to link 4 (B D E), and the output
    O4–E, which rests while link 4 turns about E.
    """

    type: MechanismType
    fixed_pivots: dict[str, Point] = Field(
        description="By the names of the joints: O2, O4 and, but for a slider and a Stephenson II, O6."
    )
    links: dict[str, Length] = Field(
        description="ground (O2–O4), input, coupler, rocker; link_5 and output, where there are such, the latter of a "
        "slot to its end. To the third pin of a link from its first, and from its second: coupler_arm (A–P) and "
        "coupler_side (B–P), or rocker_arm (O4–P) and rocker_side (B–P); but for a slider, ground_arm (O2–O6) and "
        "ground_side (O4–O6). Of a Stephenson II ground (O2–O4), input (O2–A), link_3, link_4 (B–D), link_5 and output "
        "(O4–E); input_arm (O2–C), input_side (A–C), link_4_arm (B–E), link_4_side (D–E)."
    )
    coupler_point: CouplerPoint | None = optional(
        "P on the coupler; left out where P is on the rocker, and of a Stephenson II."
    )
    reference_input_angle: Angle = Field(description="Crank angle where the first dwell begins, absolute, degrees.")
    skeleton: Skeleton


class Rest(Answer):
    """A dwell as it was measured."""

    index: int
    input_angle: Angle = Field(description="Crank angle where it begins, absolute, degrees; the crank turns ccw.")
    level: Output = Field(
        description="Of the output, in the middle of its extremes: degrees, or place along the slide."
    )
    jitter: Output = Field(description="Greatest less least output during the demanded crank rotation.")
    width: Angle = Field(description="Crank rotation, degrees, during which the output stays within the tolerance.")
    off_end: float = Field(description="Distance of the mean from the nearer end of the way, as a share of the way.")


class PlacedDwell(Answer):
    """A dwell that was asked for by its place, in the order of the statement: what was found where."""

    angle: Angle = Field(description="Rotation of the crank that is demanded, degrees.")
    at: float = Field(description="Where the output's mean lies, as a share of the way from its least to its greatest.")
    error: Output = Field(description="Greatest less least output meanwhile.")


class DwellMetrics(MotionMetrics):
    """Measured properties of a dwell sixbar, over a full turn of the crank.

    The output is in degrees, or in length units of a slider. For the quality the task's size is the stroke, or twice
    the crank.
    """

    way: Output = Field(description="Swing or stroke over a whole turn.")
    jitter: Output = Field(description="The largest of all dwells.")
    peak_velocity: OutputPerRadian = Field(
        description="Of the output at a crank speed of 1 rad/s: rad/s, or length units/s."
    )
    peak_acceleration: OutputPerRadianSquared = Field(description="The same: rad/s², or length units/s².")
    same_branch: bool


class DwellDesign(Answer):
    """A dwell sixbar with the proof of what it does."""

    mechanism: DwellMechanism
    targets: list[Rest]
    dwells: list[PlacedDwell] | None = optional("Of a statement with `dwells`: each of them, in its order.")
    verification: Verification
    metrics: DwellMetrics
    layout: Layout | None = LAYOUT
    forces: DesignForces | None = PEAKS


class DwellResult(LinkageResult[DwellDesign]):
    """Dwell sixbars, best first."""
