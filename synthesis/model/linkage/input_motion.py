"""Models of the requested motion of an input in equal steps."""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np
from pydantic import ConfigDict, Field

from kinematics.arrays import Real
from kinematics.message import compose
from synthesis.model.dimension import ROTATIONAL_SPEED
from synthesis.model.problem import Count, Number, Statement

MAX_POSITIONS = 10_000
"""Maximum number of positions of one analysis. A finer motion must be requested in parts."""

FULL_TURN = 360.0

RAD_PER_S = math.pi / 30.0
"""One revolution per minute in rad/s."""


class DriveSpeed(Statement):
    """Speed and acceleration of an input."""

    speed: Number | None = Field(default=None, description="Input speed, rad/s (length unit/s for a driven slider).")
    speed_rpm: Annotated[Number, ROTATIONAL_SPEED] | None = Field(
        default=None, description="Input speed, revolutions per minute."
    )
    acceleration: Number = Field(default=0.0, description="Input acceleration, rad/s².")

    @property
    def rate(self) -> float:
        """Input speed, rad/s; 1 by default, so that velocities are per radian of the input."""
        if self.speed is not None:
            return self.speed
        return 1.0 if self.speed_rpm is None else self.speed_rpm * RAD_PER_S

    def drive_geared(self, ratio: float, angle: Real, speed: Real) -> dict[str, list[float]]:
        """Return angle (degrees), speed and acceleration of a shaft that turns ``ratio`` times as fast as the input."""
        return {
            "angle": (ratio * angle).tolist(),
            "omega": (ratio * speed).tolist(),
            "alpha": [ratio * self.acceleration] * len(angle),
        }

    def find_errors(self) -> list[tuple[str, str]]:
        """Return errors that the validation of single fields cannot find, as pairs (JSON pointer, detail)."""
        if self.speed is not None and self.speed_rpm is not None:
            return [("/motion/speed_rpm", compose("model-speed-twice"))]
        return []


class Sweep(DriveSpeed):
    """Equal steps of the input from one angle to another, both included; a full turn by default."""

    model_config = ConfigDict(populate_by_name=True, serialize_by_alias=True)

    start: Number | None = Field(
        default=None,
        alias="from",
        description="First input angle, degrees; by default 0, or the first toggle of a slider.",
    )
    end: Number | None = Field(
        default=None,
        alias="to",
        description="Last input angle, degrees; by default 360, or the last toggle of a slider.",
    )
    steps: Annotated[Count, Field(ge=1, le=MAX_POSITIONS - 1)] = 360

    def list_inputs(self, *, slide: bool = False) -> tuple[Real, Real, Real | None]:
        """Return inputs and their speeds, each of shape (steps + 1,), and None, because the times are unknown."""
        start, end = self.start or 0.0, FULL_TURN if self.end is None else self.end
        at = np.asarray(np.linspace(start, end, self.steps + 1), np.float64)
        return at, np.full(len(at), self.rate), None
