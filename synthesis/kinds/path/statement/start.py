"""The fourbar from which a fit starts, and requests that contradict it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pydantic import Field

from kinematics.message import compose
from synthesis.model.problem import Contradiction, Point, Statement

if TYPE_CHECKING:
    from synthesis.kinds.path.problem import PathProblem

MIN_LINK_SHARE = 1e-6
"""Minimum length of a link, as a share of the longest; a shorter link counts as having no length."""


class StartFourbar(Statement):
    """A fourbar by its joints in one of its positions, as in the skeleton of an answer, in length units."""

    O2: Point = Field(description="Fixed pivot of the input.")
    A: Point = Field(description="Pin of input and coupler.")
    B: Point = Field(description="Pin of coupler and output.")
    O4: Point = Field(description="Fixed pivot of the output.")
    P: Point = Field(description="The point of the coupler that is guided.")

    @property
    def joints(self) -> tuple[complex, complex, complex, complex, complex]:
        """O2, A, B, O4 and P as complex numbers."""
        o2, a, b, o4, p = (complex(*joint) for joint in (self.O2, self.A, self.B, self.O4, self.P))
        return o2, a, b, o4, p

    @property
    def is_linkage(self) -> bool:
        """Whether every link has a length."""
        o2, a, b, o4, _ = self.joints
        lengths = abs(a - o2), abs(b - a), abs(o4 - b), abs(o4 - o2)
        return min(lengths) > MIN_LINK_SHARE * max(lengths)


def find_start_errors(problem: PathProblem) -> list[Contradiction]:
    """Return requests that contradict a start, and a start that is no linkage."""
    start = problem.start
    if start is None:
        return []
    for path, excluded, message in (
        ("/method", problem.method != "least_squares", "path-start-for-least-squares-only"),
        ("/timing", problem.prescribed, "path-start-with-timing"),
        ("/mechanism", problem.mechanism != "fourbar" or problem.mechanisms is not None, "path-start-is-no-fourbar"),
        ("/stance", problem.stance is not None, "path-start-with-stance"),
    ):
        if excluded:
            return [Contradiction(path, compose(message))]
    if not start.is_linkage:
        return [Contradiction("/start", compose("path-start-link-without-length"))]
    return []
