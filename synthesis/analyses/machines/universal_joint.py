"""Analysis of universal joints: a single joint, or several joints in series."""

from __future__ import annotations

import math
from typing import Annotated, Literal

import numpy as np
from pydantic import ConfigDict, Field

from kinematics.linkage.universal_joint import (
    Joint,
    compute_joint_angle,
    compute_max_joint_angle,
    compute_shaft_motion,
    find_shaft_extremes,
)
from kinematics.message import compose
from synthesis.analyses.base import DrivenAnalysis, DrivenRequest, Family
from synthesis.analyses.input_motion import StatedMotion, Sweep
from synthesis.model.answer import Answer
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import MAX_MAGNITUDE, NonNegative, Number, Statement

SPEED_TOLERANCE = 1e-12
"""Coefficient of fluctuation up to which the output speed counts as constant, for rounding."""


class JointSpec(Statement):
    """One universal joint."""

    angle: Annotated[float, Field(strict=True, ge=0.0, lt=90.0)] = Field(
        description="Angle between the shafts that the joint connects, degrees."
    )
    offset: Number = Field(
        default=0.0,
        description="Only for joints after the first, degrees: the angle between the forks on the shaft before the "
        "joint, minus the angle between the planes of the shafts at the two joints. With two equal joint angles, an "
        "offset of 0 makes the output speed uniform.",
    )


class SpeedLimits(Statement):
    """Limits on the unevenness of the output: its fluctuation, or limits of the speed ratio."""

    fluctuation: NonNegative | None = Field(
        default=None, description="Maximum coefficient of fluctuation, (ω_max − ω_min)/ω_mean."
    )
    least_ratio: Annotated[float, Field(strict=True, ge=0.0, le=1.0)] = 0.0
    greatest_ratio: Annotated[float, Field(strict=True, ge=1.0, le=MAX_MAGNITUDE, allow_inf_nan=False)] | None = None


class GivenUniversalJoint(Statement):
    """Universal joints in series, starting at the input shaft, and the load of the output shaft."""

    type: Literal["universal_joint"]
    joints: Annotated[list[JointSpec], Field(min_length=1, max_length=8)]
    inertia: NonNegative | None = Field(
        default=None, description="Moment of inertia that rotates with the output shaft, e.g. kg·m²."
    )
    torque: Number = Field(default=0.0, description="Constant load on the output shaft, e.g. N·m.")

    def build_core(self) -> list[Joint]:
        """Build the joints of the analysis core."""
        return [Joint(math.radians(joint.angle), math.radians(joint.offset)) for joint in self.joints]


class UniversalJointRequest(DrivenRequest[GivenUniversalJoint]):
    """Universal joints and the motion of the input shaft."""

    model_config = ConfigDict(
        title="Universal joints",
        json_schema_extra={
            "examples": [
                {
                    "mechanism": {"type": "universal_joint", "joints": [{"angle": 20.0}], "inertia": 0.9375},
                    "motion": {"from": 0.0, "to": 360.0, "steps": 72, "speed_rpm": 1000.0},
                }
            ]
        },
    )

    motion: StatedMotion = Field(
        default=Sweep(),
        description="Motion of the input; its angle is 0 with the driver's fork in the plane of the first two shafts.",
    )
    limits: SpeedLimits | None = Field(
        default=None, description="Limits for which to find the largest angle of one joint."
    )

    def find_errors(self) -> list[tuple[str, str]]:
        """Return errors that the validation of single fields cannot find."""
        faults, limits = super().find_errors(), self.limits
        if limits is not None and (limits.fluctuation, limits.greatest_ratio, limits.least_ratio) == (None, None, 0.0):
            faults.append(("/limits", compose("analyses-speed-limit-missing")))
        if self.mechanism.joints[0].offset != 0.0:
            faults.append(("/mechanism/joints/0/offset", compose("analyses-first-joint-offset")))
        return faults

    def build_answer(self) -> JsonObject:
        """Build the answer over the motion, in the form of :class:`UniversalJointAnalysis`."""
        at, speed, time = self.motion.list_inputs()
        joints = self.mechanism.build_core()
        moved, extremes = compute_shaft_motion(joints, np.radians(at)), find_shaft_extremes(joints)
        acceleration = moved.ratio_rate * speed * speed + moved.ratio * self.motion.acceleration
        inertia, load = self.mechanism.inertia, self.mechanism.torque
        steady = self.motion.rate
        peak = extremes.acceleration * steady * steady
        fastest = math.degrees(extremes.fastest_at)
        steepest = math.degrees(extremes.steepest_at)
        torque = None if inertia is None else load + inertia * acceleration
        return {
            "input_angle": at.tolist(),
            "time": None if time is None else time.tolist(),
            "output_angle": np.degrees(moved.angle).tolist(),
            "speed_ratio": moved.ratio.tolist(),
            "output_speed": (moved.ratio * speed).tolist(),
            "output_acceleration": acceleration.tolist(),
            "output_torque": None if torque is None else torque.tolist(),
            "input_torque": None if torque is None else (torque * moved.ratio).tolist(),
            "extremes": {
                "greatest_ratio": extremes.greatest,
                "least_ratio": extremes.least,
                "greatest_ratio_at": [fastest % 180.0, fastest % 180.0 + 180.0],
                "least_ratio_at": [(fastest + 90.0) % 180.0, (fastest + 90.0) % 180.0 + 180.0],
                "fluctuation": extremes.fluctuation,
                "greatest_speed": extremes.greatest * steady,
                "least_speed": extremes.least * steady,
                "greatest_acceleration": peak,
                "greatest_acceleration_at": sorted(
                    (fastest + turn + sign * steepest) % 360.0 for turn in (0.0, 180.0) for sign in (-1.0, 1.0)
                ),
                "torques": None if inertia is None else [load - inertia * peak, load + inertia * peak],
            },
            "equivalent_angle": math.degrees(extremes.equivalent_angle),
            "constant_velocity": extremes.fluctuation <= SPEED_TOLERANCE,
            "largest_angle": self._find_largest_angle(),
        }

    def _find_largest_angle(self) -> float | None:
        """Find the maximum joint angle, degrees, within the given limits; None if no limits are given."""
        limits = self.limits
        if limits is None:
            return None
        greatest = math.inf if limits.greatest_ratio is None else limits.greatest_ratio
        largest = compute_max_joint_angle(limits.least_ratio, greatest)
        if limits.fluctuation is not None:
            largest = min(largest, compute_joint_angle(limits.fluctuation))
        return math.degrees(largest)


class JointExtremes(Answer):
    """Extremes over a turn of an input at the given speed, without acceleration."""

    greatest_ratio: float
    least_ratio: float
    greatest_ratio_at: list[float] = Field(description="Input angles, degrees.")
    least_ratio_at: list[float] = Field(description="Input angles, degrees.")
    fluctuation: float = Field(description="Maximum coefficient of fluctuation, (ω_max − ω_min)/ω_mean.")
    greatest_speed: float
    least_speed: float
    greatest_acceleration: float = Field(description="Magnitude, rad/s².")
    greatest_acceleration_at: list[float] = Field(description="Input angles, degrees.")
    torques: list[float] | None = Field(
        description="Minimum and maximum torque of the output shaft; null without inertia."
    )


class UniversalJointAnalysis(DrivenAnalysis):
    """Analysis of universal joints; degrees, rad/s, and the units of the given inertia and torque."""

    output_angle: list[float] = Field(description="Rotation of the output from its position at input angle 0, degrees.")
    speed_ratio: list[float] = Field(description="Output speed over input speed.")
    output_speed: list[float]
    output_acceleration: list[float]
    output_torque: list[float] | None = Field(description="Torque of load and inertia; null without inertia.")
    input_torque: list[float] | None = Field(description="Torque of the input without losses; null without inertia.")
    extremes: JointExtremes
    equivalent_angle: float = Field(description="Angle of the single joint with the same motion, degrees.")
    constant_velocity: bool = Field(description="Whether output and input always have the same speed.")
    largest_angle: float | None = Field(
        description="Largest angle of one joint within `limits`, degrees; null without limits."
    )


FAMILY = Family(UniversalJointRequest, UniversalJointAnalysis)
