"""Analysis of several cams on one shaft: total torque, its mean, and the flywheel that limits the speed fluctuation."""

from __future__ import annotations

import math
from typing import Annotated, Literal

import numpy as np
from pydantic import BeforeValidator, ConfigDict, Field
from pydantic_core import PydanticCustomError

from kinematics.cam.dynamics import Camshaft, RunningCam
from kinematics.cam.finished.motion_program import measure_program
from kinematics.message import compose
from synthesis.analyses.base import DrivenRequest, Family
from synthesis.analyses.cams.cam import EXAMPLE, Load
from synthesis.mechanisms import MechanismError
from synthesis.mechanisms.cam import GivenCam
from synthesis.model.answer import Answer
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import Number, Statement

PROGRAM_SAMPLE_COUNT = 360
"""Number of cam angles at which each cam's program is measured."""

Share = Annotated[float, Field(strict=True, gt=0.0, le=1.0)]


def _require_plate_cam(cam: object) -> object:
    if isinstance(cam, dict) and cam.get("type", "cam") != "cam":
        raise PydanticCustomError("no_plate_cam", compose("analyses-camshaft-needs-plate-cams"))
    return cam


class ShaftCam(Statement):
    """A cam on the shaft."""

    cam: Annotated[GivenCam, BeforeValidator(_require_plate_cam)]
    load: Load
    phase: Number = Field(default=0.0, description="Shaft angle at which the cam's angle is 0, degrees.")


class GivenCamshaft(Statement):
    """Cams that turn together."""

    type: Literal["camshaft"]
    cams: Annotated[list[ShaftCam], Field(min_length=1, max_length=24)]
    fluctuation: Share | None = Field(
        default=None, description="Maximum (ω_max − ω_min)/ω with a flywheel; null: no flywheel is sized."
    )


class CamshaftAnalysisRequest(DrivenRequest[GivenCamshaft]):
    """Several cams and the speed of their shaft."""

    model_config = ConfigDict(
        title="Camshaft",
        json_schema_extra={
            "examples": [
                {
                    "mechanism": {
                        "type": "camshaft",
                        "cams": [
                            {
                                "cam": EXAMPLE,
                                "load": {"mass": 0.5, "spring_rate": 4.0, "preload": 30.0},
                                "phase": phase,
                            }
                            for phase in (0.0, 90.0)
                        ],
                        "fluctuation": 0.05,
                    },
                    "motion": {"from": 0.0, "to": 360.0, "steps": 72, "speed_rpm": 60.0},
                }
            ]
        },
    )

    def find_errors(self) -> list[tuple[str, str]]:
        """Return errors that the validation of single fields cannot find."""
        faults = super().find_errors()
        if self.motion.rate <= 0.0:
            faults.append(("/motion/speed", compose("analyses-camshaft-needs-speed")))
        if self.motion.acceleration != 0.0:
            faults.append(("/motion/acceleration", compose("analyses-camshaft-turns-steadily")))
        return faults

    def build_answer(self) -> JsonObject:
        """Build the answer with the shaft's torque over the motion, in the form of :class:`CamshaftAnalysis`."""
        at, _, _ = self.motion.list_inputs()
        cams = []
        for n, stated in enumerate(self.mechanism.cams):
            cam = stated.cam
            try:
                program = measure_program(cam.build_contour(), cam.build_follower(), cam.rotation, PROGRAM_SAMPLE_COUNT)
            except MechanismError as error:
                raise MechanismError(f"/cams/{n}/cam{error.path}", error.detail) from None
            cams.append(RunningCam(program, stated.load.build_core(), self.motion.rate, math.radians(stated.phase)))
        shaft = Camshaft(cams)
        peaks, fluctuation = shaft.torque_extremes, self.mechanism.fluctuation
        return {
            "input_angle": at.tolist(),
            "torque": shaft.torque(np.radians(at)).tolist(),
            "torques": [cam.torque(np.radians(at) - cam.phase).tolist() for cam in cams],
            "mean_torque": shaft.mean_torque,
            "min_torque": peaks.least,
            "max_torque": peaks.greatest,
            "min_contact_forces": [cam.force_extremes.least for cam in cams],
            "jump_speeds": [_replace_non_finite(cam.find_jump_speed()) for cam in cams],
            "least_preloads": [cam.compute_min_preload() for cam in cams],
            "energy_fluctuation": shaft.energy_fluctuation,
            "flywheel_inertia": None if fluctuation is None else shaft.compute_flywheel_inertia(fluctuation),
        }


def _replace_non_finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


class CamshaftAnalysis(Answer):
    """Torque of several cams on their shaft at a constant speed."""

    input_angle: list[float]
    torque: list[float]
    torques: list[list[float]] = Field(description="Results for each cam alone.")
    mean_torque: float
    min_torque: float
    max_torque: float
    min_contact_forces: list[float] = Field(
        description="Minimum contact force of each cam; its follower jumps if this is not positive."
    )
    jump_speeds: list[float | None] = Field(description="Speed at which each follower first leaves its cam, rad/s.")
    least_preloads: list[float] = Field(description="Minimum preload that keeps each follower on its cam.")
    energy_fluctuation: float
    flywheel_inertia: float | None


FAMILY = Family(CamshaftAnalysisRequest, CamshaftAnalysis)
