"""The stance of a leg: a part of the path on which its foot moves straight, optionally at constant speed."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
from pydantic import Field

from kinematics.message import compose
from synthesis.model.problem import Contradiction, Count, PositiveLength, PositiveNumber, Statement

if TYPE_CHECKING:
    from synthesis.kinds.path.problem import PathProblem

SPEED_TOLERANCE = 0.1
"""Default share by which a constant speed may differ from its mean."""

PLACE_TOLERANCE = 1e-9
"""Points nearer than this share of the coordinates' size are one place."""

Index = Annotated[Count, Field(ge=0)]


class Stance(Statement):
    """A part of the path on which P moves along a straight line, from one of the points to another.

    The stance line goes from the first of the two points to the last. P is measured between the inputs at which it
    passes them: the height of all its places across this line, and its speed along it per angle of the input.
    """

    points: tuple[Index, Index] = Field(
        description="First and last point of the stance, counted from 0; on a closed path it may continue past the "
        "last."
    )
    flatness: PositiveLength | None = Field(
        default=None, description="Maximum height, across the stance line, of the band in which P stays."
    )
    speed: Literal["any", "constant"] = Field(
        default="any", description="constant: equal rotations of the input move P by equal distances along the line."
    )
    speed_tolerance: PositiveNumber | None = Field(
        default=None,
        description="Maximum deviation of a constant speed from its mean, as a share; default 0.1.",
    )

    @property
    def off_mean(self) -> float | None:
        """Maximum deviation of the speed from its mean, as a share of it; None if not constrained."""
        if self.speed == "any":
            return None
        return SPEED_TOLERANCE if self.speed_tolerance is None else self.speed_tolerance

    @property
    def wraps_around(self) -> bool:
        """Whether it continues past the last of the points with the first."""
        return self.points[0] > self.points[1]


def find_stance_errors(problem: PathProblem) -> Iterator[Contradiction]:
    """Yield errors in a stance, and requests that contradict it."""
    stance: Stance | None = problem.stance
    if stance is None:
        return
    first, last = stance.points
    count = len(problem.points)
    for end, index in enumerate(stance.points):
        if index >= count:
            yield Contradiction(f"/stance/points/{end}", compose("path-stance-point-unknown", count=count))
    if first == last:
        yield Contradiction("/stance/points", compose("path-stance-of-one-point"))
    # Only a closed path has a first point behind the last.
    elif stance.wraps_around and not problem.closed:
        yield Contradiction("/stance/points", compose("path-stance-wraps-around"))
    elif max(first, last) < count and _is_degenerate(problem, first, last):
        yield Contradiction("/stance/points", compose("path-stance-points-coincide"))
    if stance.flatness is None and stance.speed == "any":
        yield Contradiction("/stance", compose("path-stance-without-limits"))
    if stance.speed == "any" and stance.speed_tolerance is not None:
        yield Contradiction("/stance/speed_tolerance", compose("path-stance-speed-is-free"))
    for path, excluded, message in (
        ("/method", problem.method == "exact", "path-stance-on-exact-points"),
        ("/timing", problem.prescribed, "path-stance-with-timing"),
        ("/placement_free", bool(problem.placement_free), "path-stance-with-free-place"),
        ("/constraints/in_order", not problem.constraints.in_order, "path-stance-out-of-order"),
    ):
        if excluded:
            yield Contradiction(path, compose(message))


def _is_degenerate(problem: PathProblem, first: int, last: int) -> bool:
    points = np.array([point.point for point in problem.points])
    size = float(np.abs(np.concatenate([points.real, points.imag])).max())
    return bool(abs(points[last] - points[first]) <= PLACE_TOLERANCE * size)
