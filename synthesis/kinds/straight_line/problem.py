"""Problems of straight lines: a linkage with a point that follows a straight line over part of the input's motion."""

from __future__ import annotations

from typing import Annotated, Any, Literal, get_args

from pydantic import ConfigDict, Field

from kinematics.message import compose
from synthesis.model.dimension import ANGLE, PERCENT
from synthesis.model.linkage.problem import LinkageProblem
from synthesis.model.problem import (
    CANCELLATION_TOLERANCE,
    Contradiction,
    Degrees,
    Point,
    PositiveLength,
    PositiveNumber,
)

LineMechanism = Literal["hoeken", "chebyshev", "watt", "roberts", "evans", "peaucellier", "hart", "scott_russell"]
"""Types of straight-line mechanism."""

LINE_MECHANISMS: tuple[LineMechanism, ...] = get_args(LineMechanism)

EXACT_LINES: tuple[LineMechanism, ...] = ("peaucellier", "hart", "scott_russell")
"""Types with slides or more than four links, whose line is exact."""

DEFAULT_RANGE: dict[LineMechanism, float] = {
    "hoeken": 120.0,
    "chebyshev": 50.0,
    "watt": 36.0,
    "roberts": 40.0,
    "evans": 60.0,
    "peaucellier": 90.0,
    "hart": 90.0,
    "scott_russell": 90.0,
}
"""Default rotation of the input, degrees: the usual range of each type."""

MIN_RANGE = 1e-3
"""Minimum rotation of the input, degrees; at this rotation the linkage is 10⁵ times as long as the line."""

MAX_RANGE: dict[LineMechanism, float] = {"scott_russell": 180.0}
"""Exclusive upper limits of the range of some types; all others stay below a full turn."""


class StraightLineProblem(LinkageProblem):
    """Straight line: a linkage whose point P runs along a line of given length, place and direction.

    The input turns by `crank_range` while P goes from `start` along `direction`. Approximate lines are the narrowest in
    their family (`optimize: straightness`), or the most even in velocity while they stay as straight as required
    (`optimize: velocity`). Deviation and velocity are measured on the finished mechanism.
    """

    model_config = ConfigDict(
        title="Straight line",
        json_schema_extra={
            "examples": [
                {
                    "kind": "straight_line",
                    "length": 100.0,
                    "crank_range": 120.0,
                    "optimize": "straightness",
                    "mechanism": "hoeken",
                    "start": [0.0, 0.0],
                    "direction": 0.0,
                },
                {"kind": "straight_line", "length": 60.0, "crank_range": 90.0, "mechanism": "peaucellier"},
            ]
        },
    )

    kind: Literal["straight_line"]
    length: PositiveLength = Field(description="Length of the line, in length units.")
    crank_range: Annotated[float, ANGLE, Field(strict=True, ge=MIN_RANGE, lt=360.0)] | None = Field(
        default=None,
        description="Rotation of the input while P runs along the line, degrees. By default the usual range of the "
        f"type: {', '.join(f'{name} {value:g}' for name, value in DEFAULT_RANGE.items())}.",
    )
    optimize: Literal["straightness", "velocity"] = Field(
        default="straightness", description="Objective: straightness of the line, or even velocity along it."
    )
    mechanism: LineMechanism | Literal["auto"] = Field(
        default="auto", description="Type of mechanism; `auto` compares all types that can turn through the range."
    )
    start: Point = Field(default=(0.0, 0.0), description="Start of the line.")
    direction: Degrees = Field(default=0.0, description="Direction in which P runs, degrees.")
    rotation: Literal["any", "ccw", "cw"] = Field(
        default="any",
        description="Direction in which the input turns meanwhile. It decides on which side of the line the linkage "
        "lies: the two are mirror images. `any` takes counter-clockwise unless only the other one satisfies the "
        "constraints.",
    )
    max_deviation: PositiveLength | None = Field(
        default=None,
        description="Maximum distance of P from the line, in length units. With `optimize: velocity` the line must be "
        "this straight; by default as straight as Norton's family at its most even velocity.",
    )
    max_velocity_variation: Annotated[PositiveNumber, PERCENT] | None = Field(
        default=None,
        description="Maximum minus minimum velocity along the line at constant input speed, in percent of the mean.",
    )

    @property
    def types(self) -> tuple[LineMechanism, ...]:
        """The types to be tried."""
        if self.mechanism != "auto":
            return (self.mechanism,)
        return tuple(name for name in LINE_MECHANISMS if self.get_range(name) < MAX_RANGE.get(name, 360.0))

    def get_range(self, mechanism: LineMechanism) -> float:
        """Return the rotation of the input for a type, degrees."""
        return DEFAULT_RANGE[mechanism] if self.crank_range is None else self.crank_range

    def measure_error(self, design: Any) -> float:
        """Return the optimized measure: the strip's width as a share of the length, or the variation of velocity."""
        metrics = design.metrics
        return float(0.01 * (metrics.velocity_variation if self.optimize == "velocity" else metrics.straightness_error))

    def classify_design(self, design: Any) -> int:
        """Return 1 for a linkage that itself needs a straight guide, otherwise 0."""
        return int(design.metrics.runs_on_slide)

    def find_contradictions(self) -> list[Contradiction]:
        """Return ranges that a type cannot have, and requests that exclude one another."""
        contradictions = list(self.find_contradicting_constraints())
        # Scott-Russell's line is traced back beyond half a turn.
        for name, most in MAX_RANGE.items():
            if self.mechanism == name and self.get_range(name) >= most:
                detail = compose("straight_line-crank-range-too-large", mechanism=name, limit=f"{most:g}")
                contradictions.append(Contradiction("/crank_range", detail))
        if self.length < CANCELLATION_TOLERANCE * max(map(abs, self.start)):
            contradictions.append(Contradiction("/length", compose("straight_line-length-too-short")))
        if self.mechanism in EXACT_LINES:
            reason = compose("straight_line-class-of-exact-mechanism", mechanism=self.mechanism)
            contradictions += self.constraints.find_class_contradictions((), reason)
        return contradictions
