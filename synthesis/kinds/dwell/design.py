"""Answers to problems of dwells."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from synthesis.model.answer import Answer, Point, Verification
from synthesis.model.dimension import Angle, Length, Output, OutputPerRadian, OutputPerRadianSquared
from synthesis.model.forces_answer import DesignForces
from synthesis.model.linkage_answer import LAYOUT, PEAKS, CouplerPoint, Layout, LinkageResult, MotionMetrics, Skeleton


class DwellMechanism(Answer):
    """A sixbar with a dwell: a crank-rocker O2 A B O4, and an output that its coupler point P leaves at rest.

    ``dwell_rocker``: link 5 from P to D, the output O6–D. ``dwell_slider``: link 5 from P to D on a slide.
    ``dwell_slot``: P in a slot of the output, which turns about O6; C marks the slot's end.
    """

    type: Literal["dwell_rocker", "dwell_slider", "dwell_slot"]
    fixed_pivots: dict[str, Point] = Field(description="By the names of the joints: O2, O4 and, but for a slider, O6.")
    links: dict[str, Length] = Field(
        description="ground (O2–O4), input, coupler, rocker; link_5 and output, where there are such, the latter of a "
        "slot to its end."
    )
    coupler_point: CouplerPoint
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
    verification: Verification
    metrics: DwellMetrics
    layout: Layout | None = LAYOUT
    forces: DesignForces | None = PEAKS


class DwellResult(LinkageResult[DwellDesign]):
    """Dwell sixbars, best first."""
