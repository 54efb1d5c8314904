"""Analysis of a finished barrel cam, by contact of a roller with both walls of its groove.

Displacements and forces are along the axis of the barrel; the torque acts on the barrel.
"""

from __future__ import annotations

import math

import numpy as np
from pydantic import ConfigDict, Field

from kinematics.cam.finished.barrel_contact import UnrolledWall
from kinematics.errors import DimensionError
from kinematics.message import compose
from synthesis.analyses.base import DrivenAnalysis, DrivenRequest, Family
from synthesis.analyses.cams.cam import MAX_EFFORT, CamForceSeries, FollowerSeries, Load, compute_force_series
from synthesis.mechanisms.base import MechanismError
from synthesis.mechanisms.cam import GivenBarrelCam, GivenCurve
from synthesis.model.json_object import JsonObject


def _build_example_wall(mean: float, sign: float) -> JsonObject:
    """Build a wall of the groove of the example, which rises and falls once per turn.

    The roller has a radius of 8, the cylinder a radius of 40. ``mean`` is the mean position along the axis; ``sign`` is
    −1 for the lower wall and +1 for the upper wall.
    """
    theta = [math.radians(2.0 * k) for k in range(180)]
    slope = [0.25 * math.sin(t) for t in theta]
    return {
        "x": [round(40.0 * t - sign * 8.0 * v / math.hypot(1.0, v), 9) for t, v in zip(theta, slope, strict=True)],
        "y": [
            round(mean - 10.0 * math.cos(t) + sign * 8.0 / math.hypot(1.0, v), 9)
            for t, v in zip(theta, slope, strict=True)
        ],
    }


class BarrelCamAnalysisRequest(DrivenRequest[GivenBarrelCam]):
    """A barrel cam and how it turns; a full turn in 360 steps by default."""

    model_config = ConfigDict(
        title="Barrel cam: motion of its groove",
        json_schema_extra={
            "examples": [
                {
                    "mechanism": {
                        "type": "barrel_cam",
                        "follower": {"type": "barrel_roller", "roller_radius": 8.0},
                        "cylinder_radius": 40.0,
                        "lower_wall": _build_example_wall(10.0, -1.0),
                        "upper_wall": _build_example_wall(10.0, 1.0),
                    },
                    "motion": {"from": 0.0, "to": 360.0, "steps": 72, "speed_rpm": 60.0},
                    "load": {"mass": 0.5},
                }
            ]
        },
    )

    load: Load | None = None

    def build_answer(self) -> JsonObject:
        """Build the answer over the motion, in the form of :class:`BarrelCamAnalysis`."""
        at, speed, time = self.motion.list_inputs()
        given = self.mechanism
        radius, roller = given.cylinder_radius, given.follower.roller_radius
        if len(at) * len(given.lower_wall.x) > MAX_EFFORT:
            raise MechanismError("/lower_wall", compose("analyses-too-many-points-and-positions"))
        x = radius * np.radians(at)
        walls = self._build_wall("lower_wall", given.lower_wall), self._build_wall("upper_wall", given.upper_wall)
        try:
            lower, upper = walls[0].follow(x, roller, 1), walls[1].follow(x, roller, -1)
        except DimensionError as error:
            raise MechanismError("/follower/roller_radius", str(error)) from None
        pressure = np.angle(lower.tangent)
        v = radius * np.tan(pressure)
        # The pitch curve is offset from the wall by the radius of the roller, which changes its curvature.
        bend = lower.curvature / (1.0 - roller * lower.curvature)
        a = bend * np.hypot(radius, v) ** 3 / radius
        velocity, acceleration = v * speed, a * speed**2 + v * self.motion.acceleration
        forces = None
        if self.load is not None:
            forces = compute_force_series(self.load, lower.y, v, pressure, velocity, acceleration)
        return {
            "input_angle": at.tolist(),
            "time": None if time is None else time.tolist(),
            "valid": np.isfinite(lower.y + upper.y).tolist(),
            "follower": {
                "position": lower.y.tolist(),
                "velocity": velocity.tolist(),
                "acceleration": acceleration.tolist(),
            },
            "play": (upper.y - lower.y).tolist(),
            "pressure_angle": np.degrees(np.abs(pressure)).tolist(),
            "forces": forces,
        }

    def _build_wall(self, name: str, curve: GivenCurve) -> UnrolledWall:
        try:
            return UnrolledWall(curve.convert_points(f"/{name}"), math.tau * self.mechanism.cylinder_radius)
        except DimensionError:
            raise MechanismError(f"/{name}", compose("analyses-neighbouring-points-coincide")) from None


class BarrelCamAnalysis(DrivenAnalysis):
    """Analysis of a barrel cam over the motion; null where the roller touches no wall."""

    valid: list[bool]
    follower: FollowerSeries
    play: list[float | None] = Field(
        description="Play between the walls along the axis; negative if the roller does not fit."
    )
    pressure_angle: list[float | None] = Field(description="Magnitude, degrees.")
    forces: CamForceSeries | None


FAMILY = Family(BarrelCamAnalysisRequest, BarrelCamAnalysis)
