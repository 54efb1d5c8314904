"""Answers to problems of motion generation."""

from __future__ import annotations

from pydantic import Field

from synthesis.model.answer import Answer, Point
from synthesis.model.linkage.answer import LinkageDesign, LinkageResult


class BurmesterBranch(Answer):
    """A connected branch of Burmester's curves, sampled at equal steps of the arc length of both curves together.

    A moving pivot at ``circle_points[k]`` in the first position has its fixed pivot at ``centre_points[k]``. ``closed``
    branches return to their start; the others leave the sampled region, with or without an asymptote.
    """

    circle_points: list[Point]
    centre_points: list[Point]
    closed: bool


class MotionResult(LinkageResult[LinkageDesign]):
    """Linkages that carry the body through the positions."""

    curves: list[BurmesterBranch] = Field(
        default=[], description="For four positions: all dyads that carry the body through them, as Burmester's curves."
    )
