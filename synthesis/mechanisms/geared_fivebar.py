"""Geared fivebars given by their dimensions."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from kinematics.arrays import Real
from kinematics.linkage.planar import catalogue
from kinematics.linkage.planar.branches import count_turns_until_repeat
from kinematics.linkage.planar.catalogue import ASSEMBLY_SIGNS
from kinematics.linkage.planar.mechanism import Mechanism
from kinematics.message import compose
from synthesis.mechanisms.base import MechanismError, assemble_at_reference, require_agreement
from synthesis.mechanisms.skeleton import GivenByDimensions
from synthesis.model.linkage.given_linkage import Assembly, CouplerPointSpec, FixedPivotsSpec
from synthesis.model.problem import Degrees, Number, PositiveLength, Statement

SAMPLE_COUNT, MAX_SAMPLES = 720, 200_000
"""Number of input angles per turn of the faster crank, and maximum number in total, at which an assembly is tried."""

ANGLE_RESOLUTION = 1e-15
"""Step, radians, at which the search for the best angle ends: about the rounding of an angle."""

MAX_REFINED = 16
"""Maximum number of the best input angles that are refined."""


class FivebarLengths(Statement):
    """Link lengths; ``ground`` may be left out."""

    ground: PositiveLength | None = None
    input: PositiveLength
    coupler_1: PositiveLength
    coupler_2: PositiveLength
    output: PositiveLength


class GivenGearedFivebar(GivenByDimensions):
    """A geared fivebar; ``phase`` is the output's angle from the ground line when the input lies along it."""

    type: Literal["geared_fivebar"]
    fixed_pivots: FixedPivotsSpec
    links: FivebarLengths
    gear_ratio: Number = Field(description="Output rotation over input rotation.")
    phase: Degrees
    coupler_point: CouplerPointSpec = CouplerPointSpec(distance=0.0)
    assembly: Assembly = "open"

    def assemble(self) -> Mechanism:
        """Assemble the mechanism at its reference input angle, or at one at which this is possible."""
        o2, o5 = complex(*self.fixed_pivots.input), complex(*self.fixed_pivots.output)
        require_agreement("/links/ground", self.links.ground, abs(o5 - o2))
        if o2 == o5:
            raise MechanismError("/fixed_pivots/output", compose("mechanisms-fixed-pivots-coincide"))
        return assemble_at_reference(
            lambda angle: catalogue.make_geared_fivebar(
                o2,
                o5,
                self.links.input,
                self.links.coupler_1,
                self.links.coupler_2,
                self.links.output,
                self.gear_ratio,
                math.radians(self.phase),
                angle,
                ASSEMBLY_SIGNS[self.assembly],
                self.coupler_point.vector,
            ),
            self.reference_input_angle,
            self._find_reaching_angles(o2, o5),
        )

    def _find_reaching_angles(self, o2: complex, o5: complex) -> Iterator[float]:
        """Yield input angles at which the distance of the pins A and B is well inside the range of the couplers.

        The angles may lie in any turn until the gears repeat. The distance oscillates a few times in each turn of
        either crank. Sampling finds the local maxima of the margin; shrinking steps then refine them, about as fast as
        a golden section search.
        """
        ground, radius = cmath.phase(o5 - o2), max(self.links.input, self.links.output)
        low, high = abs(self.links.coupler_1 - self.links.coupler_2), self.links.coupler_1 + self.links.coupler_2

        def measure_margin(turn: NDArray[np.floating]) -> Real:
            pins = (
                o5
                - o2
                + self.links.output * np.exp(1j * (ground + self.gear_ratio * turn + math.radians(self.phase)))
                - self.links.input * np.exp(1j * (ground + turn))
            )
            # The margin is positive for permitted distances, and relative to the longer crank.
            return np.asarray(np.minimum(high - np.abs(pins), np.abs(pins) - low) / radius)

        turns = count_turns_until_repeat(self.gear_ratio)
        # The samples are spaced by the faster crank, since the distance depends on both.
        samples = min(round(SAMPLE_COUNT * max(1.0, abs(self.gear_ratio)) * turns), MAX_SAMPLES)
        step = 2.0 * math.pi * turns / samples
        at = np.arange(samples) * step
        margin = measure_margin(at)
        # Refine local maxima only, best first, because neighbours of a maximum would converge to the same angle.
        best = at[
            np.argsort(-np.where((margin >= np.roll(margin, 1)) & (margin >= np.roll(margin, -1)), margin, -np.inf))[
                :MAX_REFINED
            ]
        ]
        # Shrink the step by 0.7, not by 0.5, because the maximum may lie outside a halved interval.
        while step > ANGLE_RESOLUTION:
            tried = best[:, None] + step * np.array([-0.5, 0.0, 0.5])
            best = tried[np.arange(len(best)), np.argmax(measure_margin(tried), axis=1)]
            step *= 0.7
        for turn in best:
            yield ground + float(turn)
