"""Analysis of a piston engine: positions, velocities and accelerations of its pistons."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from pydantic import ConfigDict, Field

from kinematics.engine.pistons import compute_piston_motion
from kinematics.message import compose
from synthesis.analyses.base import DrivenAnalysis, DrivenRequest, Family
from synthesis.model.answer import Answer
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import Degrees, PositiveLength, Statement


class GivenCylinder(Statement):
    """A cylinder: direction of its axis, and lag of its throw behind the crank's angle, degrees."""

    axis: Degrees = 0.0
    phase: Degrees = 0.0
    number: object = None
    throw: object = None
    place: object = None


class GivenEngine(Statement):
    """A crankshaft with its cylinders; the other fields of a design are optional."""

    type: Literal["engine"]
    crank: PositiveLength = Field(description="Radius of the crank throws.")
    rod: PositiveLength
    cylinders: Annotated[list[GivenCylinder], Field(min_length=1, max_length=24)]
    layout: object = None
    throws: object = None


class PistonMotion(Answer):
    """A piston over the positions: its distance from the shaft, with velocity and acceleration."""

    number: int
    place: list[float]
    velocity: list[float]
    acceleration: list[float]


class EngineAnalysis(DrivenAnalysis):
    """Analysis of an engine in motion."""

    valid: list[bool]
    cylinders: list[PistonMotion]


class EngineAnalysisRequest(DrivenRequest[GivenEngine]):
    """A piston engine and how its crank turns."""

    model_config = ConfigDict(
        title="Piston engine: motion of its pistons",
        json_schema_extra={
            "examples": [
                {
                    "mechanism": {
                        "type": "engine",
                        "crank": 36.0,
                        "rod": 130.0,
                        "cylinders": [{"phase": 0.0}, {"phase": 180.0}, {"phase": 180.0}, {"phase": 0.0}],
                    },
                    "motion": {"at": 30.0, "speed_rpm": 3000.0},
                }
            ]
        },
    )

    def find_errors(self) -> list[tuple[str, str]]:
        """Return errors that the validation of single fields cannot find."""
        faults = super().find_errors()
        if self.mechanism.rod <= self.mechanism.crank:
            faults.append(("/mechanism/rod", compose("analyses-rod-too-short")))
        return faults

    def build_answer(self) -> JsonObject:
        """Build the answer for the engine, in the form of :class:`EngineAnalysis`."""
        at, speed, time = self.motion.list_inputs()
        cylinders = []
        for number, cylinder in enumerate(self.mechanism.cylinders, 1):
            moved = compute_piston_motion(
                np.radians(at - cylinder.phase - cylinder.axis), self.mechanism.crank, self.mechanism.rod
            )
            cylinders.append(
                {
                    "number": number,
                    "place": moved.place.tolist(),
                    "velocity": (moved.slope * speed).tolist(),
                    "acceleration": (moved.bend * speed**2 + moved.slope * self.motion.acceleration).tolist(),
                }
            )
        return {
            "input_angle": at.tolist(),
            "time": None if time is None else time.tolist(),
            "valid": [True] * len(at),
            "cylinders": cylinders,
        }


FAMILY = Family(EngineAnalysisRequest, EngineAnalysis)
