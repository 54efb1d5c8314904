"""How a linkage is driven: equal steps of its input, one position, or a run in time."""

from __future__ import annotations

import math
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import ConfigDict, Discriminator, Field, Tag

from synthesis.model.statement import Count, Number, Sizable, Statement

MAX_POSITIONS = 10_000
"""Positions of one analysis at most; a finer run is asked for in parts."""

ROUNDING = 1e-12
"""Share of a number of steps by which it may fall short of a whole one: 0.3/0.1 is three steps."""

FULL_TURN = 360.0

RAD_PER_S = math.pi / 30.0
"""One revolution a minute in rad/s."""

Real = NDArray[np.float64]


class _Motion(Statement):
    speed: Number | None = Field(default=None, description="Input speed, rad/s (length unit/s for a driven slider).")
    speed_rpm: Number | None = Field(default=None, description="Input speed, revolutions a minute.")
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


class Sweep(_Motion):
    """Equal steps of the input from one angle to another, both included; a full turn where neither is stated."""

    model_config = ConfigDict(populate_by_name=True)

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


class OnePosition(_Motion):
    """One position of the input."""

    at: Number = Field(description="Input angle, degrees.")

    def inputs(self, *, slide: bool = False) -> tuple[Real, Real, Real | None]:
        """Input, speed and no time."""
        return np.array([self.at]), np.array([self.rate]), None


class TimeSpan(Statement):
    """Start, end and step of a run, seconds."""

    start: Number = 0.0
    end: Number
    step: Annotated[float, Field(strict=True, gt=0.0, le=1e9), Sizable]


class Run(_Motion):
    """A run in time with constant input acceleration, from an angle at time 0."""

    time: TimeSpan
    at: Number = Field(default=0.0, description="Input angle at time 0, degrees.")

    def faults(self) -> list[tuple[str, str]]:
        """A run backwards, or of too many positions, beside what every motion may have."""
        faults, span = super().faults(), self.time
        if span.end < span.start:
            faults.append(("/motion/time/end", "the end lies before the start"))
        elif (span.end - span.start) / span.step > MAX_POSITIONS - 1:
            faults.append(("/motion/time/step", f"more than {MAX_POSITIONS} positions; take larger steps"))
        return faults

    def inputs(self, *, slide: bool = False) -> tuple[Real, Real, Real | None]:
        """Inputs (degrees, or lengths along the input ``slide``), speeds and times."""
        count = math.floor((self.time.end - self.time.start) / self.time.step * (1.0 + ROUNDING)) + 1
        t = np.asarray(self.time.start + self.time.step * np.arange(max(count, 1)), np.float64)
        turned = self.rate * t + 0.5 * self.acceleration * t * t
        moved = turned if slide else np.degrees(turned)
        return np.asarray(self.at + moved), np.asarray(self.rate + self.acceleration * t), t


def _motion_tag(statement: Any) -> str:
    stated = statement if isinstance(statement, dict) else getattr(type(statement), "model_fields", {})
    if "time" in stated:
        return "<run>"
    return "<position>" if "at" in stated else "<sweep>"


StatedMotion = Annotated[
    Annotated[Sweep, Tag("<sweep>")] | Annotated[OnePosition, Tag("<position>")] | Annotated[Run, Tag("<run>")],
    Discriminator(_motion_tag),
]
