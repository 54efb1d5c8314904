"""How a linkage is driven: equal steps of its input, one position, or a run in time."""

from __future__ import annotations

import math
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import Discriminator, Field, Tag

from synthesis.model.motions import FULL_TURN, MAX_POSITIONS, RAD_PER_S, Driving, Sweep
from synthesis.model.statement import Number, Sizable, Statement

__all__ = ["FULL_TURN", "MAX_POSITIONS", "RAD_PER_S", "OnePosition", "Run", "StatedMotion", "Sweep", "TimeSpan"]

ROUNDING = 1e-12
"""Share of a number of steps by which it may fall short of a whole one: 0.3/0.1 is three steps."""

Real = NDArray[np.float64]


class OnePosition(Driving):
    """One position of the input."""

    at: Number = Field(description="Input angle, degrees.")

    def inputs(self, *, slide: bool = False) -> tuple[Real, Real, Real | None]:
        """Input, speed and no time."""
        return np.array([self.at]), np.array([self.rate]), None


class TimeSpan(Statement):
    """Start, end and step of a motion in time, seconds."""

    start: Number = 0.0
    end: Number
    step: Annotated[float, Field(strict=True, gt=0.0, le=1e9), Sizable]


class Run(Driving):
    """Motion in time with constant input acceleration, from an angle at time 0."""

    time: TimeSpan
    at: Number = Field(default=0.0, description="Input angle at time 0, degrees.")

    def faults(self) -> list[tuple[str, str]]:
        """A run backwards, or of too many positions, beside what every motion may have."""
        faults, span = super().faults(), self.time
        if span.end < span.start:
            faults.append(("/motion/time/end", "the end must not lie before the start"))
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
