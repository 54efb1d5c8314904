"""Slider-cranks and their inversions, given by their dimensions."""

from __future__ import annotations

import cmath
import math
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from kinematics.linkage.planar import catalogue
from kinematics.linkage.planar.catalogue import ASSEMBLY_SIGNS
from kinematics.linkage.planar.mechanism import Mechanism, Slide
from kinematics.message import compose
from synthesis.mechanisms.base import (
    MechanismError,
    assemble_at_reference,
    find_middle_sine,
    find_reaching_angles,
    require_agreement,
)
from synthesis.mechanisms.skeleton import GivenByDimensions
from synthesis.model.dimension import LENGTH
from synthesis.model.linkage.given_linkage import Assembly, CouplerPointSpec, FixedPivotsSpec, LineSpec
from synthesis.model.problem import Coordinate, Degrees, NonNegative, Point, PositiveLength, Statement


class SliderCrankLengths(Statement):
    """Link lengths."""

    crank: PositiveLength
    coupler: PositiveLength


class GivenSliderCrank(GivenByDimensions):
    """A slider-crank; ``offset``, the distance of the pivot from the slide's line, follows from the slide."""

    type: Literal["slider_crank"]
    fixed_pivot: Point
    links: SliderCrankLengths
    slide: LineSpec
    offset: Coordinate | None = None
    assembly: Assembly = "open"
    coupler_point: CouplerPointSpec = CouplerPointSpec(distance=0.0)
    driven_by: Literal["crank", "slider"] = "crank"

    def assemble(self) -> Mechanism:
        """Assemble the mechanism at its reference crank angle, or at one at which this is possible."""
        pivot, angle = complex(*self.fixed_pivot), math.radians(self.slide.angle)
        line = complex(*self.slide.point)
        # Textbooks differ in the sign of the offset, so compare its magnitude; the slide determines the side.
        offset = None if self.offset is None else abs(self.offset)
        measured = abs(((pivot - line) * cmath.exp(-1j * angle)).imag)
        require_agreement("/offset", offset, measured, "mechanisms-slide-gives-other-offset")
        return assemble_at_reference(
            lambda at: catalogue.make_slider_crank(
                pivot,
                line,
                angle,
                self.links.crank,
                self.links.coupler,
                at,
                ASSEMBLY_SIGNS[self.assembly],
                self.coupler_point.vector,
                self.driven_by,
            ),
            self.reference_input_angle,
            self._find_reaching_angles(((pivot - line) * cmath.exp(-1j * angle)).imag, angle),
        )

    def _find_reaching_angles(self, offset: float, angle: float) -> list[float]:
        """Find crank angles, radians, with the pin in the middle of the range from which the coupler reaches the slide.

        ``offset`` is the distance of the pivot from the slide's line, and ``angle`` the line's angle, radians.
        """
        sine = find_middle_sine(offset, self.links.crank, self.links.coupler)
        return [] if sine is None else [angle + math.asin(sine), angle + math.pi - math.asin(sine)]


class InvertedLengths(Statement):
    """Link lengths; ``ground`` may be left out. ``output`` is the distance from O4 to B on the sliding line, or 0."""

    ground: PositiveLength | None = None
    input: PositiveLength
    output: Annotated[NonNegative, LENGTH]


class OutputSlide(Statement):
    """The line in the output link on which the crank pin slides: through B, at an angle from the line O4 → B."""

    link: Literal["output"] = "output"
    angle: Degrees


class GivenInvertedSliderCrank(GivenByDimensions):
    """An inverted slider-crank (Norton, Sec. 4.7): the crank pin slides in the output link."""

    type: Literal["inverted_slider_crank"]
    fixed_pivots: FixedPivotsSpec
    links: InvertedLengths
    slide: OutputSlide
    coupler_point: CouplerPointSpec | None = Field(
        default=None,
        description="P on the body that slides: its distance from A, and the angle from the line A → O4 to the line A "
        "→ P in the reference configuration, for which `reference_input_angle` must then be given.",
    )
    assembly: Assembly = "open"

    def assemble(self) -> Mechanism:
        """Assemble the mechanism at its reference input angle, or at one at which this is possible."""
        o2, o4 = complex(*self.fixed_pivots.input), complex(*self.fixed_pivots.output)
        require_agreement("/links/ground", self.links.ground, abs(o4 - o2))
        if self.coupler_point is not None:
            # The point's direction is relative to the line A → O4, which depends on the input angle.
            if self.reference_input_angle is None:
                raise MechanismError("/reference_input_angle", compose("mechanisms-coupler-point-undirected"))
            return self._add_body(
                assemble_at_reference(self._assemble_at, self.reference_input_angle, ()), self.coupler_point.vector
            )
        # The sliding line has a constant distance from O4, so the pin cannot be nearer than that.
        nearest = abs(self.links.output * math.sin(math.radians(self.slide.angle)))
        between = find_reaching_angles(self.links.input, o2, o4, nearest, math.inf)
        return assemble_at_reference(self._assemble_at, self.reference_input_angle, between)

    def _add_body(self, bare: Mechanism, local: complex) -> Mechanism:
        """Add the link that carries P and slides on the output; ``local`` is P relative to the line A → O4."""
        o2, o4, a = (complex(bare.joints[joint]) for joint in ("O2", "O4", "A"))
        if a == o4:
            raise MechanismError("/reference_input_angle", compose("mechanisms-coupler-point-on-pivot"))
        p = a + local * (o4 - a) / abs(o4 - a)
        return Mechanism(
            {"O2": o2, "O4": o4, "A": a, "P": p},
            {"ground": ("O2", "O4"), "input": ("O2", "A"), "coupler": ("A", "P")},
            "input",
            # The sliding link does not rotate relative to the output. So a line of the sliding link that is parallel to
            # the slide and passes through O4 always does: O4 slides on this line.
            (Slide("O4", "coupler", np.asarray(o4), bare.slides[0].angle),),
        )

    def _assemble_at(self, angle: float) -> Mechanism:
        return catalogue.make_inverted_slider_crank(
            complex(*self.fixed_pivots.input),
            complex(*self.fixed_pivots.output),
            self.links.input,
            self.links.output,
            math.radians(self.slide.angle),
            angle,
            ASSEMBLY_SIGNS[self.assembly],
        )


class QuickReturnLengths(Statement):
    """Link lengths; ``ground`` may be left out. ``rocker`` is the distance from O4 to C."""

    ground: PositiveLength | None = None
    crank: PositiveLength
    rocker: PositiveLength
    coupler: PositiveLength


class GivenQuickReturn(GivenByDimensions):
    """A crank-shaper or Whitworth mechanism: the crank pin slides in the rocker, whose end drives a ram."""

    type: Literal["crank_shaper", "whitworth"]
    fixed_pivots: FixedPivotsSpec
    links: QuickReturnLengths
    slide: LineSpec = Field(description="The ram's line on the ground.")
    assembly: Assembly = "open"

    def assemble(self) -> Mechanism:
        """Assemble the mechanism at its reference input angle, or at one at which this is possible."""
        o2, o4 = complex(*self.fixed_pivots.input), complex(*self.fixed_pivots.output)
        require_agreement("/links/ground", self.links.ground, abs(o4 - o2))
        if (self.links.crank > abs(o4 - o2)) != (self.type == "whitworth"):
            raise MechanismError(
                "/links/crank",
                compose("mechanisms-quick-return-crank-length"),
            )
        return assemble_at_reference(
            lambda angle: catalogue.make_quick_return(
                o2,
                o4,
                self.links.crank,
                self.links.rocker,
                self.links.coupler,
                complex(*self.slide.point),
                math.radians(self.slide.angle),
                angle,
                ASSEMBLY_SIGNS[self.assembly],
            ),
            self.reference_input_angle,
            self._find_reaching_angles(o2, o4),
        )

    def _find_reaching_angles(self, o2: complex, o4: complex) -> list[float]:
        """Find crank angles, radians, with C in the middle of the range from which the coupler reaches the slide."""
        slide, ground = math.radians(self.slide.angle), o2 - o4
        height = ((o4 - complex(*self.slide.point)) * cmath.exp(-1j * slide)).imag
        # Half of the rocker's swing; the rocker of a Whitworth mechanism turns fully.
        lean = math.pi if self.links.crank > abs(ground) else math.asin(self.links.crank / abs(ground))
        towards = cmath.phase(ground) - slide
        ends = [towards - lean, towards + lean]
        # The sine has an extreme inside the swing only if the rocker passes the perpendicular to the slide.
        ends += [
            end for end in (0.5 * math.pi, -0.5 * math.pi) if abs(math.remainder(end - towards, 2 * math.pi)) < lean
        ]
        sines = [math.sin(end) for end in ends]
        sine = find_middle_sine(height, self.links.rocker, self.links.coupler, min(sines), max(sines))
        if sine is None:
            return []
        angles = []
        # Two rocker angles have this sine, and each may have two crank positions.
        for turn in (math.asin(sine), math.pi - math.asin(sine)):
            rocker = cmath.rect(1.0, slide + turn)
            # A lies on the ray of the rocker from O4, at the crank's length from O2: intersect the ray and the circle.
            pivot = ground / rocker
            square = self.links.crank**2 - pivot.imag**2
            for root in (math.sqrt(square), -math.sqrt(square)) if square >= 0.0 else ():
                # The crank pin must be on the ray itself, not on its extension behind O4.
                if pivot.real + root > 0.0:
                    angles.append(cmath.phase((root - 1j * pivot.imag) * rocker))
        return angles
