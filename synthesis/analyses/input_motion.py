"""Input motion of a linkage: equal steps of its input, one position, or a run in time."""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np
from pydantic import Discriminator, Field, Tag

from kinematics.arrays import Real
from kinematics.message import compose
from synthesis.model.linkage.input_motion import FULL_TURN, MAX_POSITIONS, RAD_PER_S, DriveSpeed, Sweep
from synthesis.model.problem import Number, Sizable, Statement

__all__ = ["FULL_TURN", "MAX_POSITIONS", "RAD_PER_S", "OnePosition", "StatedMotion", "Sweep", "TimeSpan", "TimedRun"]

ROUNDING = 1e-12
"""Share by which a number of steps may fall short of an integer: by rounding 0.3/0.1 is slightly below 3."""


class OnePosition(DriveSpeed):
    """One position of the input."""

    at: Number = Field(description="Input angle, degrees.")

    def list_inputs(self, *, slide: bool = False) -> tuple[Real, Real, Real | None]:
        """Return the input and its speed, each of shape (1,), and None, because the time is unknown."""
        return np.array([self.at]), np.array([self.rate]), None


class TimeSpan(Statement):
    """Start, end and step of a motion in time, seconds."""

    start: Number = 0.0
    end: Number
    step: Annotated[float, Field(strict=True, gt=0.0, le=1e9), Sizable]


class TimedRun(DriveSpeed):
    """Motion in time with constant input acceleration, from an angle at time 0."""

    time: TimeSpan
    at: Number = Field(default=0.0, description="Input angle at time 0, degrees.")

    def find_errors(self) -> list[tuple[str, str]]:
        """List errors of the run, backwards or with too many positions, in addition to those of every motion."""
        faults, span = super().find_errors(), self.time
        # A run backwards has no positions, so their number is not checked.
        if span.end < span.start:
            faults.append(("/motion/time/end", compose("analyses-end-before-start")))
        elif (span.end - span.start) / span.step > MAX_POSITIONS - 1:
            faults.append(("/motion/time/step", compose("analyses-step-too-small", most=MAX_POSITIONS)))
        return faults

    def list_inputs(self, *, slide: bool = False) -> tuple[Real, Real, Real | None]:
        """Return inputs (degrees, or lengths along the input ``slide``), speeds and times."""
        count = math.floor((self.time.end - self.time.start) / self.time.step * (1.0 + ROUNDING)) + 1
        # At least the start, even if rounding makes the number of steps negative.
        t = np.asarray(self.time.start + self.time.step * np.arange(max(count, 1)), np.float64)
        turned = self.rate * t + 0.5 * self.acceleration * t * t
        # Speeds are in radians, but input angles are in degrees.
        moved = turned if slide else np.degrees(turned)
        return np.asarray(self.at + moved), np.asarray(self.rate + self.acceleration * t), t


def _tag_motion(statement: object) -> str:
    # The discriminator sees raw JSON or a validated model; their fields distinguish them.
    stated = statement if isinstance(statement, dict) else getattr(type(statement), "model_fields", {})
    if "time" in stated:
        return "<run>"
    return "<position>" if "at" in stated else "<sweep>"


StatedMotion = Annotated[
    Annotated[Sweep, Tag("<sweep>")] | Annotated[OnePosition, Tag("<position>")] | Annotated[TimedRun, Tag("<run>")],
    Discriminator(_tag_motion),
]
