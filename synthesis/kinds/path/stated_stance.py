"""The stance of a leg: a part of the path on which its foot is to go straight, at a constant speed if wanted."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field

from synthesis.model.statement import Contradiction, Count, PositiveLength, PositiveNumber, Statement

SPEED_TOLERANCE = 0.1
"""Share by which a constant speed may differ from its mean, where nothing is stated."""

SAME_PLACE = 1e-9
"""Points nearer than this share of the coordinates' size are one place."""

Index = Annotated[Count, Field(ge=0)]


class Stance(Statement):
    """A part of the path on which P goes straight, from one of the points to another.

    The stance line goes from the first of the two points to the last. What is measured is P between the inputs at which
    it passes them: the height of all its places across this line, and its speed along it by the angle of the input.
    """

    points: tuple[Index, Index] = Field(
        description="First and last point of the stance, counted from 0; on a closed path it may go on past the last."
    )
    flatness: PositiveLength | None = Field(
        default=None, description="Greatest height of the band across the stance line in which P stays."
    )
    speed: Literal["any", "constant"] = Field(
        default="any", description="constant: P goes along the stance line by equal ways for equal turns of the input."
    )
    speed_tolerance: PositiveNumber | None = Field(
        default=None,
        description="Share by which a constant speed may differ from its mean at most; left out: 0.1.",
    )

    @property
    def off_mean(self) -> float | None:
        """Share by which the speed may differ from its mean; None where any will do."""
        if self.speed == "any":
            return None
        return SPEED_TOLERANCE if self.speed_tolerance is None else self.speed_tolerance

    @property
    def around(self) -> bool:
        """Whether it goes on past the last of the points with the first."""
        return self.points[0] > self.points[1]


def faults_of_stance(problem: Any) -> Iterator[Contradiction]:
    """What a stance cannot be, and what cannot be stated beside it."""
    stance: Stance | None = problem.stance
    if stance is None:
        return
    first, last = stance.points
    count = len(problem.points)
    for end, index in enumerate(stance.points):
        if index >= count:
            yield Contradiction(f"/stance/points/{end}", f"there are {count} points, counted from 0")
    if first == last:
        yield Contradiction("/stance/points", "a stance goes from one point to another")
    elif stance.around and not problem.closed:
        yield Contradiction("/stance/points", "an open path does not go on past its last point; exchange them")
    elif max(first, last) < count and _is_no_way(problem, first, last):
        yield Contradiction("/stance/points", "the two points are one place, through which goes no line")
    if stance.flatness is None and stance.speed == "any":
        yield Contradiction("/stance", "demands nothing; state its flatness, or a constant speed")
    if stance.speed == "any" and stance.speed_tolerance is not None:
        yield Contradiction("/stance/speed_tolerance", "is of a constant speed; state that too")
    for path, excluded, detail in (
        ("/method", problem.method == "exact", "points that are met exactly leave a stance to luck; fit them"),
        ("/timing", problem.prescribed, "a stance has free timing; it says by itself how P moves with the input"),
        ("/placement_free", bool(problem.placement_free), "a stance lies where it is drawn; leave this out"),
        ("/constraints/in_order", not problem.constraints.in_order, "a stance is gone through in order"),
    ):
        if excluded:
            yield Contradiction(path, detail)


def _is_no_way(problem: Any, first: int, last: int) -> bool:
    points = np.array([point.point for point in problem.points])
    size = float(np.abs(np.concatenate([points.real, points.imag])).max())
    return bool(abs(points[last] - points[first]) <= SAME_PLACE * size)
