"""Straight lines: a linkage with a point that follows one over a part of its input's motion."""

from __future__ import annotations

from typing import Annotated, Literal, get_args

from pydantic import ConfigDict, Field

from synthesis.model.dimension import ANGLE, PERCENT
from synthesis.model.linkage_statement import LinkageProblem
from synthesis.model.statement import ROUNDED_OFF, Contradiction, Degrees, Point, PositiveLength, PositiveNumber

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
"""Rotation of the input, degrees, where none is stated: what the type is commonly used over."""

LEAST_RANGE = 1e-3
"""Least rotation of the input, degrees: for less the linkage is 10⁵ times as long as the line."""

MOST_RANGE: dict[LineMechanism, float] = {"scott_russell": 180.0}
"""Ranges that a type stays below; all others stay below a full turn."""


class StraightLineProblem(LinkageProblem):
    """Straight line: a linkage whose point P runs along a line of given length, place and direction.

    The input turns by `crank_range` while P goes from `start` along `direction`. Approximate lines are the narrowest in
    their family (`optimize: straightness`), or the most even in velocity while they stay as straight as demanded
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
    length: PositiveLength = Field(description="Of the line, in length units.")
    crank_range: Annotated[float, ANGLE, Field(strict=True, ge=LEAST_RANGE, lt=360.0)] | None = Field(
        default=None,
        description="Rotation of the input while P runs along the line, degrees. By default what the type is commonly "
        f"used over: {', '.join(f'{name} {value:g}' for name, value in DEFAULT_RANGE.items())}.",
    )
    optimize: Literal["straightness", "velocity"] = Field(
        default="straightness", description="What is made as good as it can be: the line, or the velocity along it."
    )
    mechanism: LineMechanism | Literal["auto"] = Field(
        default="auto", description="Type of mechanism; `auto` compares all that can turn by the range."
    )
    start: Point = Field(default=(0.0, 0.0), description="Where P begins the line.")
    direction: Degrees = Field(default=0.0, description="In which P runs, degrees.")
    rotation: Literal["any", "ccw", "cw"] = Field(
        default="any",
        description="Which way the input turns meanwhile. It decides on which side of the line the linkage lies: the "
        "two are mirror images. `any` takes counter-clockwise unless only the other one meets the constraints.",
    )
    max_deviation: PositiveLength | None = Field(
        default=None,
        description="Greatest distance of P from the line, in length units. With `optimize: velocity` it says how "
        "straight the line must be; where it is left out that is as straight as Norton's family is at its most even.",
    )
    max_velocity_variation: Annotated[PositiveNumber, PERCENT] | None = Field(
        default=None,
        description="Greatest less least velocity along the line at constant input speed, in percent of the mean.",
    )

    @property
    def types(self) -> tuple[LineMechanism, ...]:
        """The types that are to be tried."""
        if self.mechanism != "auto":
            return (self.mechanism,)
        return tuple(name for name in LINE_MECHANISMS if self.range_of(name) < MOST_RANGE.get(name, 360.0))

    def range_of(self, mechanism: LineMechanism) -> float:
        """Rotation of the input for a type, degrees."""
        return DEFAULT_RANGE[mechanism] if self.crank_range is None else self.crank_range

    @property
    def error_measure(self) -> str | None:
        """What is optimized."""
        return "velocity_variation" if self.optimize == "velocity" else None

    def contradictions(self) -> list[Contradiction]:
        """Ranges that a type cannot have, and demands that exclude one another."""
        contradictions = list(self.contradicting_demands())
        for name, most in MOST_RANGE.items():
            if self.mechanism == name and self.range_of(name) >= most:
                detail = f"the crank of {name} turns by less than {most:g}°; state less or another mechanism"
                contradictions.append(Contradiction("/crank_range", detail))
        if self.length < ROUNDED_OFF * max(map(abs, self.start)):
            contradictions.append(
                Contradiction("/length", "too short beside the coordinates of the start; move the origin nearer")
            )
        if self.mechanism in EXACT_LINES:
            reason = f"classifies fourbars; a {self.mechanism} mechanism has no class"
            contradictions += self.constraints.of_another_class((), reason)
        return contradictions
