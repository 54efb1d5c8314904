"""Steering: two stub axles whose wheels roll about one centre while the vehicle turns."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from synthesis.model.dimension import ANGLE
from synthesis.model.linkage_statement import LinkageProblem
from synthesis.model.statement import Contradiction, PositiveLength, Range, Sizable

ARM = (0.1, 0.25)
"""Least and greatest length of the steering arms where none is stated, in distances of the kingpins."""


class ArmLimits(Range):
    """Least and greatest length of the steering arms; equal to fix it."""

    min: PositiveLength
    max: PositiveLength


class SteeringProblem(LinkageProblem):
    """Steering: a linkage between two stub axles that turns the outer wheel as much as it must for the inner one.

    The wheels roll without slip where cot φ − cot θ = pivot distance/wheelbase for the angles φ of the outer and θ of
    the inner wheel. Ackermann's linkage, a symmetrical fourbar, comes near to that: its greatest steering error up to
    the lock is made as small as it can be. Davis's gear does it exactly, with slides.
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
    wheelbase: PositiveLength = Field(description="From the rear axle to the front axle.")
    pivot_distance: PositiveLength = Field(description="Between the kingpins.")
    track: PositiveLength | None = Field(
        default=None, description="Between the front wheels; for the turning circle. The pivot distance if left out."
    )
    lock: Annotated[float, ANGLE, Field(strict=True, gt=0.0, lt=90.0), Sizable] = Field(
        description="Greatest angle of the inner wheel, degrees."
    )
    mechanism: Literal["ackermann", "davis", "auto"] = "auto"
    tie_rod: Literal["behind", "ahead", "any"] = Field(
        default="any", description="Where the tie rod is, seen from the kingpins."
    )
    arm_length: ArmLimits | None = Field(
        default=None, description="Of the steering arms; 0.1 to 0.25 of the pivot distance if left out."
    )
    max_steering_error: Annotated[float, ANGLE, Field(strict=True, gt=0.0, lt=90.0), Sizable] | None = Field(
        default=None, description="Greatest error of the outer wheel's angle that is allowed, degrees."
    )

    @property
    def arms(self) -> tuple[float, float]:
        """Least and greatest length of the steering arms, in pivot distances."""
        if self.arm_length is None:
            return ARM
        return self.arm_length.min / self.pivot_distance, self.arm_length.max / self.pivot_distance

    @property
    def sides(self) -> tuple[Literal["behind", "ahead"], ...]:
        """Where the tie rod may be."""
        return ("behind", "ahead") if self.tie_rod == "any" else (self.tie_rod,)

    @property
    def input_slides(self) -> bool:
        """A bar that slides drives Davis's gear."""
        return self.mechanism == "davis"

    def contradictions(self) -> list[Contradiction]:
        """Wheels between their kingpins, and arms that would meet."""
        found = []
        if self.track is not None and self.track < self.pivot_distance:
            found.append(Contradiction("/track", "the wheels stand between their kingpins; the track is the larger"))
        if self.arms[1] >= 0.5:
            detail = "arms of half the pivot distance could meet; shorter ones are needed"
            found.append(Contradiction("/arm_length/max", detail))
        if self.constraints.full_rotation:
            detail = "a steering mechanism goes from lock to lock and does not turn through; drop the demand"
            found.append(Contradiction("/constraints/full_rotation", detail))
        if not self.constraints.same_branch:
            detail = "a steering mechanism that passes a toggle between its locks does not steer; drop the demand"
            found.append(Contradiction("/constraints/same_branch", detail))
        if self.mechanism == "davis":
            found += self.constraints.of_another_class((), "Davis's gear has slides and no class of fourbars")
        else:
            # The arms are equal and the tie rod differs from the ground: S + L > P + Q always.
            reason = "Ackermann's linkage, with two equal arms, is never Grashof"
            found += self.constraints.of_another_class(("non_grashof",), reason)
        return [*found, *self.contradicting_demands()]
