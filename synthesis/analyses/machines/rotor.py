"""Analysis of a rotor: forces of its unbalances on the frame and on the bearings as it turns."""

from __future__ import annotations

import cmath
import math
from typing import Annotated, Literal

import numpy as np
from pydantic import ConfigDict, Field

from kinematics.arrays import Complex
from kinematics.dynamics.rotor import compute_bearing_moments
from kinematics.message import compose
from synthesis.analyses.base import DrivenAnalysis, DrivenRequest, Family
from synthesis.model.answer import Answer
from synthesis.model.dimension import UNBALANCE
from synthesis.model.dynamics.request import METRES_PER_UNIT, LengthUnit
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import Coordinate, Degrees, Flag, NonNegative, Statement

GRAM_MILLIMETRES = 1e-6
"""One g·mm in kg·m."""


class GivenUnbalance(Statement):
    """A mass off the axis, by its moment."""

    unbalance: Annotated[NonNegative, UNBALANCE] = Field(description="Mass times radius: g·mm, or consistent units.")
    angle: Degrees = 0.0
    z: Coordinate = Field(default=0.0, description="Position along the axis.")


class GivenCorrection(GivenUnbalance):
    """A mass that is added, or taken away, to balance the rotor."""

    removed: Flag = False
    plane: object = None
    mass: object = None
    radius: object = None


class GivenRotor(Statement):
    """A rotor, described by its unbalances; the other fields of a design are optional."""

    type: Literal["rotor"]
    unbalances: list[GivenUnbalance] = Field(min_length=1, max_length=500)
    corrections: list[GivenCorrection] = Field(default=[], max_length=500)
    bearings: tuple[Coordinate, Coordinate] | None = Field(
        default=None, description="Positions of the bearings along the axis."
    )
    planes: object = None


class RotorRequest(DrivenRequest[GivenRotor]):
    """A rotor and its motion."""

    model_config = ConfigDict(
        title="Rotor",
        json_schema_extra={
            "examples": [
                {
                    "mechanism": {
                        "type": "rotor",
                        "unbalances": [{"unbalance": 500.0, "angle": 30.0, "z": 120.0}],
                        "corrections": [
                            {"unbalance": 300.0, "angle": 30.0, "z": 0.0, "removed": True},
                            {"unbalance": 200.0, "angle": 210.0, "z": 300.0},
                        ],
                        "bearings": [0.0, 300.0],
                    },
                    "motion": {"from": 0.0, "to": 360.0, "steps": 72, "speed_rpm": 3000.0},
                }
            ]
        },
    )

    length_unit: LengthUnit = Field(default="mm", description="Unit of positions along the axis.")
    units: Literal["si", "consistent"] = Field(
        default="si", description="`si`: g·mm, N and N·m. `consistent`: nothing is converted."
    )

    def find_errors(self) -> list[tuple[str, str]]:
        """Return errors that the validation of single fields cannot find."""
        bearings = self.mechanism.bearings
        alike = bearings is not None and bearings[0] == bearings[1]
        same = [("/mechanism/bearings", compose("analyses-bearings-coincide"))] if alike else []
        return [*super().find_errors(), *same]

    def build_answer(self) -> JsonObject:
        """Build the answer over the motion, in the form of :class:`RotorAnalysis`."""
        at, speed, time = self.motion.list_inputs()
        given, si = self.mechanism, self.units == "si"
        moment_unit, length = (GRAM_MILLIMETRES, METRES_PER_UNIT[self.length_unit]) if si else (1.0, 1.0)
        signed = [(1.0, entry) for entry in given.unbalances]
        signed += [(-1.0 if entry.removed else 1.0, entry) for entry in given.corrections]
        moments = np.array(
            [moment_unit * sign * cmath.rect(entry.unbalance, math.radians(entry.angle)) for sign, entry in signed],
            np.complex128,
        )
        z = np.array([entry.z for _, entry in signed], np.float64)
        about = 0.0 if given.bearings is None else given.bearings[0]
        # The force of the rotor on the frame is −m a, with the acceleration a of a point that moves on a circle.
        turning = np.exp(1j * np.radians(at)) * (speed**2 - 1j * self.motion.acceleration)
        carried = (
            [] if given.bearings is None else compute_bearing_moments(moments, z, np.array(given.bearings)).tolist()
        )
        couple = length * complex((moments * (z - about)).sum())
        return {
            "input_angle": at.tolist(),
            "time": None if time is None else time.tolist(),
            "force": _list_series(complex(moments.sum()) * turning),
            "moment": _list_series(couple * turning),
            "moment_about": about,
            "bearings": [
                {
                    "z": place,
                    "force": _list_series(moment * turning),
                    "peak": abs(moment) * float(np.abs(turning).max()),
                }
                for place, moment in zip(given.bearings or (), carried, strict=True)
            ],
            "unbalance": abs(complex(moments.sum())) / moment_unit,
            "unbalance_angle": math.degrees(float(np.angle(moments.sum()))),
        }


def _list_series(values: Complex) -> dict[str, list[float]]:
    return {"x": values.real.tolist(), "y": values.imag.tolist()}


class TurningVector(Answer):
    """Components over the positions, in the frame that stands still."""

    x: list[float]
    y: list[float]


class BearingLoad(Answer):
    """The force of the rotor on a bearing."""

    z: float
    force: TurningVector
    peak: float


class RotorAnalysis(DrivenAnalysis):
    """Forces and moments of a rotor; N and N·m, or the consistent units."""

    force: TurningVector = Field(description="Force of all unbalances and corrections on the frame.")
    moment: TurningVector = Field(description="Moment Σ z F; its plane rotates with the rotor.")
    moment_about: float = Field(
        description="Position along the axis about which the moment is taken: the first bearing, or 0."
    )
    bearings: list[BearingLoad] = Field(description="Forces on the bearings; empty if no bearings are given.")
    unbalance: float = Field(description="The sum of all moments, g·mm or in the consistent units.")
    unbalance_angle: float = Field(description="Angle in the rotor, degrees.")


FAMILY = Family(RotorRequest, RotorAnalysis)
