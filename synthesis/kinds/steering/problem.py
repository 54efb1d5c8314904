"""Problems of steering: two stub axles whose wheels roll about one centre while the vehicle turns."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from kinematics.message import compose
from synthesis.model.dimension import ANGLE
from synthesis.model.linkage.problem import LinkageProblem
from synthesis.model.problem import Contradiction, PositiveLength, Range, Sizable

DEFAULT_ARM_LIMITS = (0.1, 0.25)
"""Default minimum and maximum length of the steering arms, in distances of the kingpins."""


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
