"""Problems of steering: two stub axles whose wheels roll about one centre while the vehicle turns."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Field

from kinematics.message import compose
from synthesis.model.dimension import ANGLE
from synthesis.model.linkage.problem import LinkageProblem
from synthesis.model.problem import Contradiction, PositiveLength, Range, Sizable

DEFAULT_ARM_LIMITS = (0.1, 0.25)
"""Default minimum and maximum length of the steering arms, in distances of the kingpins."""


DEFAULT_WHEEL_WIDTH = 0.12
"""Width of usual wheels, as a share of the track: 175 mm for a track of 1.45 m."""


class ArmLimits(Range):
    """Minimum and maximum length of the steering arms; equal to fix it."""

    min: PositiveLength
    max: PositiveLength


class SteeringProblem(LinkageProblem):
    """Steering: a linkage between two stub axles that gives the outer wheel the angle that matches the inner one's.

    The wheels roll without slip if cot φ − cot θ = pivot distance/wheelbase for the angles φ of the outer and θ of the
    inner wheel. Ackermann's linkage, a symmetrical fourbar, approximates that: its maximum steering error up to the
    lock is minimized. Davis's gear is exact, with slides.
    """

    model_config = ConfigDict(
        title="Steering",
        json_schema_extra={
            "examples": [
                {"kind": "steering", "wheelbase": 2745.0, "pivot_distance": 1220.0, "lock": 40.0, "track": 1475.0}
            ]
        },
    )

    kind: Literal["steering"]
    wheelbase: PositiveLength = Field(description="Distance from the rear axle to the front axle.")
    pivot_distance: PositiveLength = Field(description="Distance between the kingpins.")
    track: PositiveLength | None = Field(
        default=None,
        description="Distance between the front wheels; for the turning circle. By default the pivot distance.",
    )
    wheel_width: PositiveLength | None = Field(
        default=None,
        description="Width of the front wheels, with clearance on both sides. The pins of a tie rod must then keep "
        "inside the wheels; otherwise linkages that do so for a usual width come first.",
    )
    lock: Annotated[float, ANGLE, Field(strict=True, gt=0.0, lt=90.0), Sizable] = Field(
        description="Maximum angle of the inner wheel, degrees."
    )
    mechanism: Literal["ackermann", "davis", "auto"] = "auto"
    tie_rod: Literal["behind", "ahead", "any"] = Field(
        default="any", description="Place of the tie rod, seen from the kingpins."
    )
    arm_length: ArmLimits | None = Field(
        default=None, description="Length of the steering arms; by default 0.1 to 0.25 of the pivot distance."
    )
    max_steering_error: Annotated[float, ANGLE, Field(strict=True, gt=0.0, lt=90.0), Sizable] | None = Field(
        default=None, description="Maximum error of the outer wheel's angle, degrees."
    )

    @property
    def arms(self) -> tuple[float, float]:
        """Minimum and maximum length of the steering arms, in pivot distances."""
        if self.arm_length is None:
            return DEFAULT_ARM_LIMITS
        return self.arm_length.min / self.pivot_distance, self.arm_length.max / self.pivot_distance

    @property
    def sides(self) -> tuple[Literal["behind", "ahead"], ...]:
        """Allowed sides of the tie rod."""
        return ("behind", "ahead") if self.tie_rod == "any" else (self.tie_rod,)

    def measure_error(self, design: Any) -> float:
        """Return the maximum steering error, radians."""
        return math.radians(design.metrics.steering_error)

    @property
    def error_unit(self) -> tuple[float, str]:
        """Errors are written in degrees."""
        return math.degrees(1.0), "°"

    def classify_design(self, design: Any) -> int:
        """Return 0 for a linkage with its tie rod inside the wheels, 1 for other linkages, 2 for a gear with slides."""
        if design.mechanism.skeleton.slides:
            return 2
        return int(design.metrics.tie_rod_clearance < 0.0)

    @property
    def wheel_face(self) -> float:
        """Distance of the inner face of a wheel from its kingpin, length units; negative inside the kingpins.

        Without a track the wheels may begin at the kingpins.
        """
        if self.track is None and self.wheel_width is None:
            return 0.0
        track = self.track or self.pivot_distance
        width = DEFAULT_WHEEL_WIDTH * track if self.wheel_width is None else self.wheel_width
        return 0.5 * (track - self.pivot_distance - width)

    @property
    def input_slides(self) -> bool:
        """Whether a sliding bar drives the mechanism, as in Davis's gear."""
        return self.mechanism == "davis"

    def find_contradictions(self) -> list[Contradiction]:
        """Return contradictory requests: wheels between their kingpins, arms that would meet, and others."""
        found = []
        if self.track is not None and self.track < self.pivot_distance:
            found.append(Contradiction("/track", compose("steering-track-too-small")))
        # Arms that point at each other would collide.
        if self.arms[1] >= 0.5:
            detail = compose("steering-arms-too-long")
            found.append(Contradiction("/arm_length/max", detail))
        if self.constraints.full_rotation:
            detail = compose("steering-full-rotation")
            found.append(Contradiction("/constraints/full_rotation", detail))
        if not self.constraints.same_branch:
            detail = compose("steering-toggle-between-locks")
            found.append(Contradiction("/constraints/same_branch", detail))
        if self.mechanism == "davis":
            found += self.constraints.find_class_contradictions((), compose("steering-class-of-davis"))
        else:
            # The arms are equal and the tie rod differs from the ground: S + L > P + Q always.
            reason = compose("steering-class-of-ackermann")
            found += self.constraints.find_class_contradictions(("non_grashof",), reason)
        return [*found, *self.find_contradicting_constraints()]
