"""Results of parallel motion problems."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from synthesis.model.answer import Answer, Point, Verification
from synthesis.model.dimension import Angle, Length
from synthesis.model.dynamics.peak_forces import DesignForces
from synthesis.model.linkage.answer import (
    LAYOUT_FIELD,
    PEAKS_FIELD,
    CouplerPoint,
    Layout,
    LinkageMetrics,
    LinkageResult,
    Skeleton,
    Target,
)


class ParallelMotionMechanism(Answer):
    """The Watt I sixbar that carries the link P–Q without turning it.

    A fourbar O2 A B O4 with the coupler point P, a pin C on its input, the guide C–Q and the body P–Q.
    """

    type: Literal["watt_1"] = "watt_1"
    fixed_pivots: dict[str, Point] = Field(description="By the names of the joints: O2 and O4.")
    links: dict[str, Length] = Field(
        description="ground, input (O2–A), coupler (A–B), output (O4–B), input_arm (O2–C), guide (C–Q), body (P–Q)."
    )
    coupler_point: CouplerPoint
    reference_input_angle: Angle = Field(description="Input angle of the skeleton, absolute, degrees.")
    skeleton: Skeleton


class ParallelMotionMetrics(LinkageMetrics):
    """Measured properties of a parallel motion, in addition to those of any linkage.

    Lengths of the links include the input arm, the guide and the body; residuals are those of the path's points.
    """

    base: Literal["source", "left_cognate", "right_cognate", "path"] = Field(
        description="The fourbar from which the sixbar is built."
    )
    input_side: Literal["input", "output"] = Field(description="The side of the fourbar whose pivot carries the input.")
    rotation: Angle = Field(description="Maximum rotation of the body, degrees: rounding.")
    translation: Point = Field(description="Vector from P to Q, constant.")
    curve_distance: Length | None = Field(description="Maximum distance of P from the given curve; null for a path.")
    input_range: tuple[Angle, Angle] = Field(description="Input angles between which it was driven, degrees.")


class ParallelMotionDesign(Answer):
    """A sixbar for parallel motion with its verification."""

    mechanism: ParallelMotionMechanism
    targets: list[Target] = Field(description="The points of the path; empty if a linkage was given.")
    verification: Verification
    metrics: ParallelMotionMetrics
    layout: Layout | None = LAYOUT_FIELD
    forces: DesignForces | None = PEAKS_FIELD


class ParallelMotionResult(LinkageResult[ParallelMotionDesign]):
    """Sixbars for parallel motion, best first."""
