"""What problems of linkages share: constraints, the order of the answers, and the shapes that regions have."""

from __future__ import annotations

import math
from collections.abc import Collection
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from synthesis.model.dimension import ANGLE, LENGTH
from synthesis.model.statement import (
    ABSURD,
    Contradiction,
    Flag,
    Interval,
    PositiveLength,
    Sizable,
    StatedProblem,
    Statement,
)

ON_EDGE = 1e-9
"""Points this share of a region's size outside it count as inside: they were meant to lie on its edge."""


class Region(Statement):
    """A rectangle with sides along the axes, in length units."""

    x: Annotated[Interval, LENGTH]
    y: Annotated[Interval, LENGTH]

    def contains(self, point: complex) -> bool:
        """Whether a point lies in the region, its edges (to rounding) included."""
        (left, right), (low, high) = self.x, self.y
        slack = ON_EDGE * max(abs(left), abs(right), abs(low), abs(high))
        across = left - slack <= point.real <= right + slack
        return across and low - slack <= point.imag <= high + slack

    def widened(self, margin: float) -> Self:
        """The region with a margin on all sides, in length units."""
        (left, right), (low, high) = self.x, self.y
        return self.model_copy(update={"x": (left - margin, right + margin), "y": (low - margin, high + margin)})

    def distance(self, point: complex) -> float:
        """How far a point lies outside the region; 0 within."""
        (left, right), (low, high) = self.x, self.y
        across = max(left - point.real, 0.0, point.real - right)
        return 0.0 if self.contains(point) else math.hypot(across, max(low - point.imag, 0.0, point.imag - high))


class LengthLimits(Statement):
    """Shortest and longest link allowed, in length units."""

    min: Annotated[float, LENGTH, Field(strict=True, ge=0.0, le=ABSURD, allow_inf_nan=False), Sizable] = 0.0
    max: PositiveLength | None = None

    @model_validator(mode="after")
    def _min_below_max(self) -> Self:
        if self.max is not None and self.min >= self.max:
            raise ValueError("min must be below max")
        return self


class Constraints(Statement):
    """What a usable linkage must satisfy; everything has a default that demands nothing beyond a sound motion."""

    min_transmission_angle: Annotated[float, ANGLE, Field(strict=True, ge=0.0, lt=90.0)] | None = Field(
        default=None, description="Least transmission angle over the used range of the input, degrees."
    )
    grashof: Literal["any", "crank_rocker", "double_crank", "double_rocker", "non_grashof"] = "any"
    full_rotation: Flag = Field(default=False, description="The input link must be able to turn through.")
    same_branch: Flag = Field(default=True, description="No toggle position between the targets.")
    in_order: Flag = Field(default=True, description="The input, turning one way, visits the targets in order.")
    link_length: LengthLimits | None = None
    max_link_ratio: Annotated[float, Field(strict=True, ge=1.0, le=ABSURD)] | None = Field(
        default=None, description="Longest link over shortest link, at most."
    )
    fixed_pivot_region: Region | None = None
    moving_pivot_region: Region | None = Field(default=None, description="For the moving pivots in the first position.")

    def contradictions(self) -> list[Contradiction]:
        """Demands that exclude one another, with paths below the problem."""
        if self.full_rotation and self.grashof in ("double_rocker", "non_grashof"):
            detail = f"the input of a {self.grashof} linkage does not turn through; drop one of the demands"
            return [Contradiction("/constraints/full_rotation", detail)]
        return []

    def of_another_class(self, classes: Collection[str], reason: str) -> list[Contradiction]:
        """The refusal of a class that no linkage of a problem can have: all of them are of ``classes``."""
        if self.grashof == "any" or self.grashof in classes:
            return []
        return [Contradiction("/constraints/grashof", f"{reason}; drop the demand")]


class LinkageProblem(StatedProblem):
    """Fields that all linkage problems share."""

    constraints: Constraints = Constraints()
    rank_by: Literal["quality", "accuracy", "size", "transmission_angle"] = "quality"

    @property
    def error_measure(self) -> str | None:
        """The field of the metrics that tells how near a design is to this task, where the task chooses it."""
        return None
