"""Path generation: a linkage whose coupler point goes through points."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from synthesis.problems.base import Contradiction, Count, Number, Statement
from synthesis.problems.linkage import LinkageProblem

EQUAL_POINTS = 1e-9
"""Points closer than this share of the coordinates' size count as equal."""


class PathPoint(Statement):
    """A point of the path, in length units."""

    x: Number
    y: Number

    @property
    def point(self) -> complex:
        """The point as a complex number."""
        return complex(self.x, self.y)


class PathProblem(LinkageProblem):
    """Path generation: a fourbar whose coupler point goes exactly through three to nine points.

    Nine points are as many as a fourbar can meet. For nine every fourbar is computed: all 1442 cognate triples, real
    and complex, from which the real ones are verified with both cognates and either fixed pivot as the input's. Fewer
    points leave freedom: points on a smooth curve between them, drawn anew in each round, make them nine.
    """

    model_config = ConfigDict(
        title="Path generation",
        json_schema_extra={
            "examples": [
                {
                    "kind": "path",
                    "points": [
                        {"x": 40.0, "y": 30.0},
                        {"x": 32.0, "y": 42.0},
                        {"x": 20.0, "y": 45.0},
                        {"x": 8.0, "y": 40.0},
                        {"x": 2.0, "y": 30.0},
                    ],
                    "rounds": 1,
                    "max_designs": 5,
                }
            ]
        },
    )

    kind: Literal["path"]
    points: list[PathPoint] = Field(min_length=3, max_length=9, description="In the order in which they are visited.")
    timing: Literal["free"] = Field(default="free", description="At which input angles the points are met is free.")
    method: Literal["auto", "exact"] = Field(default="auto", description="How the points are met: exactly.")
    mechanism: Literal["fourbar"] = "fourbar"
    rounds: Annotated[Count, Field(ge=1, le=20)] = Field(
        default=3, description="For fewer than nine points: how often points are drawn between them."
    )

    @property
    def task_size(self) -> float:
        """The greatest distance between two points, by which tolerances are measured, in length units."""
        points = [point.point for point in self.points]
        return max(abs(p - q) for p in points for q in points) or 1.0

    def contradictions(self) -> list[Contradiction]:
        """Equal points, and demands that exclude one another."""
        size = max(max(abs(p.x), abs(p.y)) for p in self.points)
        found = []
        for k, later in enumerate(self.points):
            for j, earlier in enumerate(self.points[:k]):
                if abs(later.point - earlier.point) <= EQUAL_POINTS * size:
                    found.append(Contradiction(f"/points/{k}", f"equal to point {j}; points must differ"))
        return [*found, *self.constraints.contradictions()]
