"""Analysis of cams of specified contour: eccentric circles, and noses with circular or straight flanks."""

from __future__ import annotations

import numpy as np
from pydantic import ConfigDict, Field

from kinematics.cam.follower import TranslatingRoller
from kinematics.cam.motion.extremes import find_extremes
from synthesis.analyses.base import DrivenAnalysis, DrivenRequest, Family
from synthesis.mechanisms.cam import GivenContourCam
from synthesis.model.answer import Answer
from synthesis.model.json_object import JsonObject


class ContourCamAnalysisRequest(DrivenRequest[GivenContourCam]):
    """A contour with a translating follower and how it turns; a full turn in 360 steps by default."""

    model_config = ConfigDict(
        title="Cam of specified contour",
        json_schema_extra={
            "examples": [
                {
                    "mechanism": {
                        "type": "contour_cam",
                        "contour": {
                            "shape": "circular_arc",
                            "base_radius": 32.5,
                            "nose_radius": 15.0,
                            "nose_distance": 30.0,
                            "flank_radius": 62.5,
                        },
                        "roller_radius": 10.0,
                    },
                    "motion": {"from": 0.0, "to": 360.0, "steps": 360, "speed_rpm": 200.0},
                }
            ]
        },
    )

    def build_answer(self) -> JsonObject:
        """Build the answer over the motion, in the form of :class:`ContourCamAnalysis`."""
        contour, follower = self.mechanism.build_core()
        at, speed, time = self.motion.list_inputs()
        rotation, alpha = self.mechanism.rotation, self.motion.acceleration
        lift = contour.motion(follower, np.radians(at), rotation)
        breaks = contour.breaks(follower, rotation)
        worst = find_extremes(lambda angle: follower.pressure_angle(contour.motion(follower, angle, rotation)), breaks)

        def find_peak(order: int) -> float:
            return find_extremes(lambda angle: contour.motion(follower, angle, rotation)[order], breaks).largest

        peaks = [find_peak(order) for order in range(3)]
        return {
            "input_angle": at.tolist(),
            "time": None if time is None else time.tolist(),
            "follower": {
                "position": lift.s.tolist(),
                "velocity": (lift.v * speed).tolist(),
                "acceleration": (lift.a * speed**2 + lift.v * alpha).tolist(),
                "jerk": (lift.j * speed**3 + 3.0 * lift.a * speed * alpha).tolist(),
            },
            "pressure_angle": np.degrees(follower.pressure_angle(lift)).tolist(),
            "base_radius": contour.base_radius,
            "prime_radius": follower.prime_radius if isinstance(follower, TranslatingRoller) else None,
            "least_radius": contour.least_radius,
            "joints": np.degrees(breaks[1:-1]).tolist(),
            "max_pressure_angle": float(np.degrees(worst.largest)),
            "peaks": dict(zip(("s", "v", "a"), peaks, strict=True)),
        }


class ContourFollower(Answer):
    """The follower over the positions."""

    position: list[float]
    velocity: list[float]
    acceleration: list[float]
    jerk: list[float]


class Peaks(Answer):
    """Maximum displacement, velocity and acceleration over a turn, per radian of cam rotation."""

    s: float
    v: float
    a: float


class ContourCamAnalysis(DrivenAnalysis):
    """Motion of the follower of a cam of specified contour."""

    follower: ContourFollower
    pressure_angle: list[float] = Field(description="Pressure angle, degrees, positive while rising without offset.")
    base_radius: float
    prime_radius: float | None
    least_radius: float = Field(description="Minimum convex radius of curvature of the contour.")
    joints: list[float] = Field(description="Cam angles at which the follower passes from one part to the next.")
    max_pressure_angle: float
    peaks: Peaks


FAMILY = Family(ContourCamAnalysisRequest, ContourCamAnalysis)
