"""The fourbar that a fit begins from, and what it cannot be stated beside."""

from __future__ import annotations

from typing import Any

from pydantic import Field

from synthesis.model.linkages import FourbarConfiguration, to_complex
from synthesis.model.statement import Contradiction, Point, Statement

MIN_SHARE = 1e-6
"""A link shorter than this share of the longest is none."""


class StartFourbar(Statement):
    """A fourbar by its joints in one of its positions, as the skeleton of an answer has them, in length units."""

    O2: Point = Field(description="Fixed pivot of the input.")
    A: Point = Field(description="Pin of input and coupler.")
    B: Point = Field(description="Pin of coupler and output.")
    O4: Point = Field(description="Fixed pivot of the output.")
    P: Point = Field(description="The point of the coupler that is guided.")

    @property
    def configuration(self) -> FourbarConfiguration:
        """The joints as complex numbers."""
        return FourbarConfiguration(*(to_complex(joint) for joint in (self.O2, self.A, self.B, self.O4, self.P)))


def faults_of_start(problem: Any) -> list[Contradiction]:
    """What a start cannot be stated beside, and a start that is no linkage."""
    start = problem.start
    if start is None:
        return []
    for path, excluded, detail in (
        ("/method", problem.method != "least_squares", "a start is where least_squares begins; state that method"),
        ("/timing", problem.prescribed, "a start is for points of free timing"),
        ("/mechanism", problem.mechanism != "fourbar" or problem.mechanisms is not None, "a start is a fourbar's"),
        ("/stance", problem.stance is not None, "a start is for fits of points alone; leave one of the two out"),
    ):
        if excluded:
            return [Contradiction(path, detail)]
    if not start.configuration.has_no_link_below(MIN_SHARE):
        return [Contradiction("/start", "a link has no length; its two joints must differ")]
    return []
