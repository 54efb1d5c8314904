"""The motion of an input in equal steps, as a client states it."""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import ConfigDict, Field

from synthesis.model.dimension import ROTATIONAL_SPEED
from synthesis.model.statement import Count, Number, Statement

MAX_POSITIONS = 10_000
"""Positions of one analysis at most; a finer run is asked for in parts."""

FULL_TURN = 360.0

RAD_PER_S = math.pi / 30.0
"""One revolution a minute in rad/s."""

Real = NDArray[np.float64]


class Driving(Statement):
    """The speed of an input and its acceleration."""

    speed: Number | None = Field(default=None, description="Input speed, rad/s (length unit/s for a driven slider).")
    speed_rpm: Annotated[Number, ROTATIONAL_SPEED] | None = Field(
        default=None, description="Input speed, revolutions a minute."
    )
    acceleration: Number = Field(default=0.0, description="Input acceleration, rad/s².")

    @property
    def rate(self) -> float:
        """Input speed, rad/s; 1 where none is stated, so that rates are by the radian."""
        if self.speed is not None:
            return self.speed
        return 1.0 if self.speed_rpm is None else self.speed_rpm * RAD_PER_S

    def geared(self, ratio: float, angle: Real, speed: Real) -> dict[str, list[float]]:
        """Angles (degrees), speeds and accelerations of what turns at ``ratio`` times the input's."""
        return {
            "angle": (ratio * angle).tolist(),
            "omega": (ratio * speed).tolist(),
            "alpha": [ratio * self.acceleration] * len(angle),
        }

    def faults(self) -> list[tuple[str, str]]:
        """What no single field shows: (JSON pointer in the request, detail)."""
        if self.speed is not None and self.speed_rpm is not None:
            return [("/motion/speed_rpm", "give the speed in rad/s or in revolutions a minute, not both")]
        return []


class Sweep(Driving):
    """Equal steps of the input from one angle to another, both included; a full turn where neither is stated."""

    model_config = ConfigDict(populate_by_name=True, serialize_by_alias=True)

    start: Number | None = Field(
        default=None,
        alias="from",
        description="First input angle, degrees; by default 0, of a slider its first toggle.",
    )
    end: Number | None = Field(
        default=None, alias="to", description="Last input angle, degrees; by default 360, of a slider its last toggle."
    )
    steps: Annotated[Count, Field(ge=1, le=MAX_POSITIONS - 1)] = 360

    def inputs(self, *, slide: bool = False) -> tuple[Real, Real, Real | None]:
        """Inputs, speeds and no times."""
        start, end = self.start or 0.0, FULL_TURN if self.end is None else self.end
        at = np.asarray(np.linspace(start, end, self.steps + 1), np.float64)
        return at, np.full(len(at), self.rate), None
