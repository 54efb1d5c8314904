"""Analysis of a ratchet: lift of its pawls while the wheel turns."""

from __future__ import annotations

import math
from typing import Annotated, Literal

import numpy as np
from pydantic import ConfigDict, Field

from kinematics.indexing.ratchet import Ratchet
from kinematics.message import compose
from synthesis.analyses.base import DrivenAnalysis, DrivenRequest, Family
from synthesis.model.answer import Answer
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import Count, Degrees, PositiveLength, Statement


class GivenPawl(Statement):
    """A pawl: angle of the wheel beyond its first stop at which this pawl first holds it, degrees."""

    stop: Degrees = 0.0
    pivot: object = None
    nose: object = None


class GivenRatchet(Statement):
    """A ratchet wheel with its pawls; the other fields of a design are optional."""

    type: Literal["ratchet"]
    teeth: Annotated[Count, Field(ge=4, le=1000)]
    wheel_radius: PositiveLength = Field(description="Radius at the tips.")
    tooth_height: PositiveLength
    face_angle: Annotated[float, Field(strict=True, ge=0.0, le=60.0, allow_inf_nan=False)] = 0.0
    pawl_length: PositiveLength = Field(description="Distance from the middle of the held face to the pawl's pivot.")
    pawls: list[GivenPawl] = Field(default_factory=lambda: [GivenPawl()], min_length=1, max_length=64)
    stations: object = None
    overlap: object = None
    bore: object = None
    profile: object = None


class PawlMotion(Answer):
    """A pawl over the positions."""

    lift: list[float] = Field(description="Angle from the position in which the pawl holds the wheel, degrees.")


class RatchetAnalysis(DrivenAnalysis):
    """Analysis of a ratchet in motion."""

    valid: list[bool]
    pawls: list[PawlMotion]


class RatchetAnalysisRequest(DrivenRequest[GivenRatchet]):
    """A ratchet and how its wheel turns, from the position at which the first pawl holds it."""

    model_config = ConfigDict(
        title="Ratchet: motion of its pawls",
        json_schema_extra={
            "examples": [
                {
                    "mechanism": {
                        "type": "ratchet",
                        "teeth": 24,
                        "wheel_radius": 50.0,
                        "tooth_height": 4.0,
                        "face_angle": 15.0,
                        "pawl_length": 40.0,
                    },
                    "motion": {"from": 0.0, "to": 30.0, "steps": 30},
                }
            ]
        },
    )

    def find_errors(self) -> list[tuple[str, str]]:
        """Return errors that the validation of single fields cannot find."""
        faults, given = super().find_errors(), self.mechanism
        if given.tooth_height >= 0.9 * given.wheel_radius:
            faults.append(("/mechanism/tooth_height", compose("analyses-tooth-too-high")))
        elif not self._build_ratchet().reach < given.pawl_length:
            faults.append(("/mechanism/pawl_length", compose("analyses-pawl-too-short")))
        return faults

    def build_answer(self) -> JsonObject:
        """Build the answer for the ratchet, in the form of :class:`RatchetAnalysis`."""
        at, _, time = self.motion.list_inputs()
        ratchet = self._build_ratchet()
        lifts = [np.degrees(ratchet.pawl_lift(np.radians(at - pawl.stop))) for pawl in self.mechanism.pawls]
        return {
            "input_angle": at.tolist(),
            "time": None if time is None else time.tolist(),
            "valid": [True] * len(at),
            "pawls": [{"lift": lift.tolist()} for lift in lifts],
        }

    def _build_ratchet(self) -> Ratchet:
        given = self.mechanism
        face = math.radians(given.face_angle)
        return Ratchet(given.teeth, given.wheel_radius, given.tooth_height, face, given.pawl_length)


FAMILY = Family(RatchetAnalysisRequest, RatchetAnalysis)
