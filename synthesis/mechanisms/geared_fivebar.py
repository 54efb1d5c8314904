"""The geared fivebar by its dimensions."""

from __future__ import annotations

import math
from typing import Literal

from pydantic import Field

from kinematics.linkage import catalogue
from kinematics.linkage.catalogue import ASSEMBLY
from kinematics.linkage.mechanism import Mechanism
from synthesis.mechanisms.base import Assembly, MechanismError, StatedCouplerPoint, StatedPivots, agree, assembled
from synthesis.mechanisms.skeleton import GivenByDimensions
from synthesis.problems import Number, PositiveNumber, Statement


class FivebarLengths(Statement):
    """Link lengths; ``ground`` may be left out."""

    ground: PositiveNumber | None = None
    input: PositiveNumber
    coupler_1: PositiveNumber
    coupler_2: PositiveNumber
    output: PositiveNumber


class GivenGearedFivebar(GivenByDimensions):
    """A geared fivebar; ``phase`` is the output's angle from the ground line when the input lies along it."""

    type: Literal["geared_fivebar"]
    fixed_pivots: StatedPivots
    links: FivebarLengths
    gear_ratio: Number = Field(description="Output rotation over input rotation.")
    phase: Number
    coupler_point: StatedCouplerPoint = StatedCouplerPoint(distance=0.0)
    assembly: Assembly = "open"

    def assembled(self) -> Mechanism:
        """The mechanism at its reference input angle, or at one where it can be assembled."""
        o2, o5 = complex(*self.fixed_pivots.input), complex(*self.fixed_pivots.output)
        agree("/links/ground", self.links.ground, abs(o5 - o2))
        if o2 == o5:
            raise MechanismError("/fixed_pivots/output", "equal to the input's pivot; no ground link is left")
        return assembled(
            lambda angle: catalogue.geared_fivebar(
                o2,
                o5,
                self.links.input,
                self.links.coupler_1,
                self.links.coupler_2,
                self.links.output,
                self.gear_ratio,
                math.radians(self.phase),
                angle,
                ASSEMBLY[self.assembly],
                self.coupler_point.vector,
            ),
            self.reference_input_angle,
        )
