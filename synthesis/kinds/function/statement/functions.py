"""Named functions over an interval of x. Clients choose from a fixed list; no expression is ever evaluated."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from kinematics.arrays import Real
from kinematics.message import compose
from synthesis.model.problem import Contradiction, Interval, Number, PositiveNumber, Statement

CONSTANT_TOLERANCE = 1e-9
"""Relative variation of its values below which a function counts as constant."""

POLE_TOLERANCE = 1e-9
"""Distance from a pole, as a share of a period (or of the interval's size), below which an interval reaches it."""

SCAN_COUNT = 4001
"""Number of samples for the minimum and maximum of a function."""


class TablePoint(Statement):
    """A row of a table."""

    x: Number
    y: Number


class FunctionStatement(Statement):
    """A named function over an interval of x.

    ``linear`` y = x, ``power`` y = x^exponent, ``exponential`` y = base^x, ``logarithm`` y = log x (its base changes
    only the scale of y), ``sine``, ``cosine`` and ``tangent`` with x in degrees, ``reciprocal`` y = 1/x, ``table`` a
    smooth, shape-preserving curve through given points (no additional extremes).
    """

    name: Literal[
        "linear", "power", "exponential", "logarithm", "sine", "cosine", "tangent", "reciprocal", "table"
    ]  # fmt: skip
    x: Interval | None = Field(
        default=None, description="First and last value of x. Omitted for a table: its whole range."
    )
    exponent: Number | None = Field(default=None, description="Exponent of `power`.")
    base: PositiveNumber | None = Field(default=None, description="Base of `exponential`; omitted: e.")
    points: Annotated[list[TablePoint], Field(min_length=3, max_length=500)] | None = Field(
        default=None, description="Points of `table`, with increasing x."
    )

    @property
    def interval(self) -> tuple[float, float]:
        """The interval of x; for a table without one, its whole range."""
        if self.x is not None:
            return self.x
        assert self.points is not None
        return self.points[0].x, self.points[-1].x

    def values(self, x: Real) -> Real:
        """Return y at x; NaN or infinite where it is undefined."""
        with np.errstate(all="ignore"):
            if self.name == "linear":
                return np.array(x, np.float64)
            if self.name == "power":
                return np.asarray(np.power(x, self.exponent or 0.0), np.float64)
            if self.name == "exponential":
                return np.exp(math.log(self.base or math.e) * x)
            if self.name == "logarithm":
                return np.log10(x)
            if self.name in ("sine", "cosine", "tangent"):
                return {"sine": np.sin, "cosine": np.cos, "tangent": np.tan}[self.name](np.radians(x))
            if self.name == "reciprocal":
                return np.asarray(1.0 / x)
            return self._interpolate_table(x)

    def _interpolate_table(self, x: Real) -> Real:
        # Import lazily: only problems with a table need SciPy here.
        from scipy.interpolate import PchipInterpolator

        assert self.points is not None
        table = PchipInterpolator([point.x for point in self.points], [point.y for point in self.points])
        return np.asarray(table(x), np.float64)

    def find_extent(self) -> tuple[float, float]:
        """Return the minimum and maximum over the interval."""
        x = np.linspace(*self.interval, SCAN_COUNT)
        if self.points is not None:
            low, high = self.interval
            x = np.concatenate([x, [point.x for point in self.points if low <= point.x <= high]])
        # Add the exact extremes to the samples: table points, crests of waves, the vertex of even powers.
        elif self.name in ("sine", "cosine"):
            turns = 90.0 * np.arange(math.ceil(self.interval[0] / 90.0), math.floor(self.interval[1] / 90.0) + 1)
            x = np.concatenate([x, turns[:SCAN_COUNT]])
        elif self.name == "power" and self.interval[0] < 0.0 < self.interval[1]:
            x = np.append(x, 0.0)
        y = self.values(x)
        return float(y.min()), float(y.max())

    def share(self, x: Real) -> Real:
        """Share the range of y: return the output's travel at x, 0 at the first x, initially increasing.

        It ends at 1 for a monotonic function; otherwise the range is from the minimum to the maximum.
        """
        low, high = self.find_extent()
        first = float(self.values(np.array([self.interval[0]]))[0])
        return (self.values(x) - first) / (self.direction * (high - low))

    def share_along(self, shares: Real) -> Real:
        """Share the range of y at positions given as shares of the interval of x; see :meth:`share`."""
        low, high = self.interval
        return self.share(low + (high - low) * shares)

    @property
    def direction(self) -> float:
        """1 if y initially rises, −1 if it initially falls."""
        y = self.values(np.linspace(*self.interval, SCAN_COUNT))
        moved = y - y[0]
        away = np.flatnonzero(np.abs(moved) > CONSTANT_TOLERANCE * np.abs(moved).max())
        return float(np.sign(moved[away[0]])) if len(away) else 1.0

    def find_errors(self) -> Iterator[Contradiction]:
        """Yield errors that prevent a valid function over the interval, with paths relative to it."""
        yield from self._check_fields()
        if self.name == "table":
            if self.points is None:
                return
            for k, (one, other) in enumerate(zip(self.points, self.points[1:], strict=False), start=1):
                if not other.x > one.x:
                    yield Contradiction(f"/points/{k}/x", compose("function-table-not-rising"))
                    return
            low, high = self.interval
            if low < self.points[0].x or high > self.points[-1].x:
                yield Contradiction("/x", compose("function-table-too-short"))
                return
        elif self.x is None:
            yield Contradiction("/x", compose("function-interval-missing"))
            return
        poles = list(self._find_poles())
        if poles or (self.name == "power" and self.exponent is None):
            yield from poles
            return
        low, high = self.interval
        if high - low <= 1e-12 * max(abs(low), abs(high)):
            yield Contradiction("/x", compose("function-interval-too-short"))
            return
        with np.errstate(all="ignore"):
            least, greatest = self.find_extent()
        if not (math.isfinite(least) and math.isfinite(greatest)):
            yield Contradiction("/x", compose("function-values-infinite", function=self.name))
        elif greatest - least <= CONSTANT_TOLERANCE * max(abs(least), abs(greatest)):
            yield Contradiction("/x", compose("function-values-constant", function=self.name))

    def _check_fields(self) -> Iterator[Contradiction]:
        for field, name in (("exponent", "power"), ("points", "table")):
            given = getattr(self, field) is not None
            if given != (self.name == name):
                fault = "function-field-unused" if given else "function-field-required"
                yield Contradiction(f"/{field}", compose(fault, function=name))
        if self.base is not None and self.name not in ("exponential", "logarithm"):
            yield Contradiction("/base", compose("function-base-unused"))
        if self.base == 1.0:
            yield Contradiction("/base", compose("function-base-one"))
        if self.name == "power" and self.exponent == 0.0:
            yield Contradiction("/exponent", compose("function-exponent-zero"))

    def _find_poles(self) -> Iterator[Contradiction]:
        """Yield errors for points of the interval where the function is undefined or unbounded."""
        low, high = self.interval
        near = POLE_TOLERANCE * max(abs(low), abs(high))
        touches_zero = low <= near and high >= -near
        if self.name == "logarithm" and low <= near:
            yield Contradiction("/x", compose("function-logarithm-of-zero"))
        elif self.name == "reciprocal" and touches_zero:
            yield Contradiction("/x", compose("function-reciprocal-of-zero"))
        elif self.name == "tangent":
            first = math.ceil((low - 90.0) / 180.0 - POLE_TOLERANCE)
            if 90.0 + 180.0 * first <= high + 180.0 * POLE_TOLERANCE:
                yield Contradiction("/x", compose("function-tangent-undefined", angle=f"{90 + 180 * first}"))
        elif self.name == "power" and self.exponent is not None:
            if self.exponent < 0.0 and touches_zero:
                yield Contradiction("/x", compose("function-negative-power-of-zero"))
            elif low < 0.0 and self.exponent != round(self.exponent):
                yield Contradiction("/x", compose("function-power-of-negative"))
