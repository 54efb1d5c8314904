"""Statements of a given mechanism: its dimensions as its users know them, or its skeleton; degrees and lengths.

Each model gives the analysis core's :class:`kinematics.linkage.mechanism.Mechanism`. Dimensions say it all for the
types that have them; every other type is stated by its skeleton.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Discriminator, Field, Tag

from kinematics.errors import DimensionError
from kinematics.linkage import catalogue
from kinematics.linkage.catalogue import ASSEMBLY
from kinematics.linkage.fourbar import Fourbar
from kinematics.linkage.mechanism import GearPair, Mechanism, Slide
from synthesis.problems import Number, Point, PositiveNumber, Statement

AGREES = 1e-6
"""A dimension that others determine already (ground, offset) may differ from them by this share: printed digits."""

FIRST_TRIED = 30
"""Degree from which a configuration is looked for: along the ground line many linkages have a change point."""

Assembly = Literal["open", "crossed"]


class MechanismError(ValueError):
    """A stated mechanism that does not exist; carries the field's path below the mechanism."""

    def __init__(self, path: str, detail: str) -> None:
        self.path = path
        self.detail = detail
        super().__init__(f"{path}: {detail}")


class StatedPivots(Statement):
    """Fixed pivots of input and output."""

    input: Point
    output: Point


class StatedCouplerPoint(Statement):
    """P: distance from A, and angle from the coupler's line (A towards its other pin) to the line A → P, degrees."""

    distance: Annotated[Number, Field(ge=0.0)]
    angle: Number = 0.0

    @property
    def vector(self) -> complex:
        """P in the coupler's frame."""
        return cmath.rect(self.distance, math.radians(self.angle))


class StatedLine(Statement):
    """A slide on the ground: a point of its line and the line's angle, degrees."""

    point: Point
    angle: Number


class StatedSlide(StatedLine):
    """A slide by its joint and its link, in the reference configuration."""

    joint: str = Field(min_length=1, max_length=50)
    link: str = Field(min_length=1, max_length=50)


class StatedLink(Statement):
    """A rigid link and the joints on it."""

    name: str = Field(min_length=1, max_length=50)
    joints: list[Annotated[str, Field(min_length=1, max_length=50)]] = Field(min_length=1, max_length=20)


class StatedGear(Statement):
    """Rotation of the second link = ratio × rotation of the first, both relative to ground."""

    links: tuple[str, str]
    ratio: Number


class StatedSkeleton(Statement):
    """Joints in a reference configuration, and what joins them; the input is a link's name, or a slide's joint."""

    joints: dict[Annotated[str, Field(min_length=1, max_length=50)], Point] = Field(min_length=2, max_length=40)
    links: list[StatedLink] = Field(min_length=2, max_length=20)
    slides: list[StatedSlide] = Field(default=[], max_length=10)
    gears: list[StatedGear] = Field(default=[], max_length=10)
    input_link: str

    def mechanism(self) -> Mechanism:
        """The mechanism in the reference configuration."""
        names = [link.name for link in self.links]
        if len(set(names)) != len(names):
            raise MechanismError("/skeleton/links", "each link needs a name of its own")
        try:
            return Mechanism(
                {name: complex(*point) for name, point in self.joints.items()},
                {link.name: tuple(link.joints) for link in self.links},
                self.input_link,
                tuple(
                    Slide(s.joint, s.link, np.asarray(complex(*s.point)), np.asarray(math.radians(s.angle)))
                    for s in self.slides
                ),
                tuple(GearPair(*gear.links, gear.ratio) for gear in self.gears),
            )
        except ValueError as error:
            raise MechanismError("/skeleton", str(error)) from None


class FourbarLengths(Statement):
    """Link lengths; ``ground`` follows from the fixed pivots and may be left out."""

    ground: PositiveNumber | None = None
    input: PositiveNumber
    coupler: PositiveNumber
    output: PositiveNumber


class GivenFourbar(Statement):
    """A pin-jointed fourbar."""

    type: Literal["fourbar"]
    fixed_pivots: StatedPivots
    links: FourbarLengths
    coupler_point: StatedCouplerPoint = StatedCouplerPoint(distance=0.0)
    assembly: Assembly = "open"
    reference_input_angle: Number | None = None
    skeleton: StatedSkeleton | None = None

    def mechanism(self) -> Mechanism:
        """The mechanism at its reference input angle, or at one where it can be assembled."""
        o2, o4 = complex(*self.fixed_pivots.input), complex(*self.fixed_pivots.output)
        _agree("/links/ground", self.links.ground, abs(o4 - o2))
        try:
            linkage = Fourbar(
                o2, o4, self.links.input, self.links.coupler, self.links.output, self.coupler_point.vector
            )
        except DimensionError as error:
            raise MechanismError("/fixed_pivots", str(error)) from None
        return _assembled(
            lambda angle: catalogue.fourbar(linkage, angle, ASSEMBLY[self.assembly]), self.reference_input_angle
        )


class SliderCrankLengths(Statement):
    """Link lengths."""

    crank: PositiveNumber
    coupler: PositiveNumber


class GivenSliderCrank(Statement):
    """A slider-crank; ``offset``, the distance of the pivot from the slide's line, follows from the slide."""

    type: Literal["slider_crank"]
    fixed_pivot: Point
    links: SliderCrankLengths
    slide: StatedLine
    offset: Number | None = None
    assembly: Assembly = "open"
    coupler_point: StatedCouplerPoint = StatedCouplerPoint(distance=0.0)
    driven_by: Literal["crank", "slider"] = "crank"
    reference_input_angle: Number | None = Field(default=None, description="Crank angle of the reference, degrees.")
    skeleton: StatedSkeleton | None = None

    def mechanism(self) -> Mechanism:
        """The mechanism at its reference crank angle, or at one where it can be assembled."""
        pivot, angle = complex(*self.fixed_pivot), math.radians(self.slide.angle)
        line = complex(*self.slide.point)
        # Books differ in the sign of an offset; the slide says on which side of the pivot it passes.
        offset = None if self.offset is None else abs(self.offset)
        _agree("/offset", offset, abs(((pivot - line) * cmath.exp(-1j * angle)).imag), "the slide and the pivot")
        return _assembled(
            lambda at: catalogue.slider_crank(
                pivot,
                line,
                angle,
                self.links.crank,
                self.links.coupler,
                at,
                ASSEMBLY[self.assembly],
                self.coupler_point.vector,
                self.driven_by,
            ),
            self.reference_input_angle,
        )


class InvertedLengths(Statement):
    """Link lengths; ``ground`` may be left out. ``output`` is the distance from O4 to B on the sliding line, or 0."""

    ground: PositiveNumber | None = None
    input: PositiveNumber
    output: Annotated[Number, Field(ge=0.0)]


class OutputSlide(Statement):
    """The line in the output link on which the crank pin slides: through B, at an angle from the line O4 → B."""

    link: Literal["output"] = "output"
    angle: Number


class GivenInvertedSliderCrank(Statement):
    """An inverted slider-crank (Norton, Sec. 4.7): the crank pin slides in the output link."""

    type: Literal["inverted_slider_crank"]
    fixed_pivots: StatedPivots
    links: InvertedLengths
    slide: OutputSlide
    assembly: Assembly = "open"
    reference_input_angle: Number | None = None
    skeleton: StatedSkeleton | None = None

    def mechanism(self) -> Mechanism:
        """The mechanism at its reference input angle, or at one where it can be assembled."""
        o2, o4 = complex(*self.fixed_pivots.input), complex(*self.fixed_pivots.output)
        _agree("/links/ground", self.links.ground, abs(o4 - o2))
        return _assembled(
            lambda angle: catalogue.inverted_slider_crank(
                o2,
                o4,
                self.links.input,
                self.links.output,
                math.radians(self.slide.angle),
                angle,
                ASSEMBLY[self.assembly],
            ),
            self.reference_input_angle,
        )


class QuickReturnLengths(Statement):
    """Link lengths; ``ground`` may be left out. ``rocker`` is the distance from O4 to C."""

    ground: PositiveNumber | None = None
    crank: PositiveNumber
    rocker: PositiveNumber
    coupler: PositiveNumber


class GivenQuickReturn(Statement):
    """A crank-shaper or Whitworth mechanism: the crank pin slides in the rocker, whose end drives a ram."""

    type: Literal["crank_shaper", "whitworth"]
    fixed_pivots: StatedPivots
    links: QuickReturnLengths
    slide: StatedLine = Field(description="The ram's line on the ground.")
    assembly: Assembly = "open"
    reference_input_angle: Number | None = None
    skeleton: StatedSkeleton | None = None

    def mechanism(self) -> Mechanism:
        """The mechanism at its reference input angle, or at one where it can be assembled."""
        o2, o4 = complex(*self.fixed_pivots.input), complex(*self.fixed_pivots.output)
        _agree("/links/ground", self.links.ground, abs(o4 - o2))
        if (self.links.crank > abs(o4 - o2)) != (self.type == "whitworth"):
            raise MechanismError(
                "/links/crank", "a crank-shaper's crank is shorter than the ground, a Whitworth's is longer"
            )
        return _assembled(
            lambda angle: catalogue.quick_return(
                o2,
                o4,
                self.links.crank,
                self.links.rocker,
                self.links.coupler,
                complex(*self.slide.point),
                math.radians(self.slide.angle),
                angle,
                ASSEMBLY[self.assembly],
            ),
            self.reference_input_angle,
        )


class FivebarLengths(Statement):
    """Link lengths; ``ground`` may be left out."""

    ground: PositiveNumber | None = None
    input: PositiveNumber
    coupler_1: PositiveNumber
    coupler_2: PositiveNumber
    output: PositiveNumber


class GivenGearedFivebar(Statement):
    """A geared fivebar; ``phase`` is the output's angle from the ground line when the input lies along it."""

    type: Literal["geared_fivebar"]
    fixed_pivots: StatedPivots
    links: FivebarLengths
    gear_ratio: Number = Field(description="Output rotation over input rotation.")
    phase: Number
    coupler_point: StatedCouplerPoint = StatedCouplerPoint(distance=0.0)
    assembly: Assembly = "open"
    reference_input_angle: Number | None = None
    skeleton: StatedSkeleton | None = None

    def mechanism(self) -> Mechanism:
        """The mechanism at its reference input angle, or at one where it can be assembled."""
        o2, o5 = complex(*self.fixed_pivots.input), complex(*self.fixed_pivots.output)
        _agree("/links/ground", self.links.ground, abs(o5 - o2))
        if o2 == o5:
            raise MechanismError("/fixed_pivots/output", "equal to the input's pivot; no ground link is left")
        return _assembled(
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


class GivenSkeleton(Statement):
    """Any planar linkage by its skeleton; ``links`` and ``fixed_pivots`` may stand beside it and are not looked at."""

    type: Literal[
        "skeleton",
        "fourbar",
        "slider_crank",
        "inverted_slider_crank",
        "crank_shaper",
        "whitworth",
        "geared_fivebar",
        "watt_1",
        "watt_2",
        "stephenson_1",
        "stephenson_2",
        "stephenson_3",
        "drag_link_rocker",
        "drag_link_slider",
        "dwell_rocker",
        "dwell_slider",
        "peaucellier",
    ] = "skeleton"
    skeleton: StatedSkeleton
    links: dict[str, Number] | None = None
    fixed_pivots: dict[str, Point] | None = None

    def mechanism(self) -> Mechanism:
        """The mechanism in its reference configuration."""
        return self.skeleton.mechanism()


_BY_TYPE: dict[str, str] = {
    "fourbar": "<fourbar>",
    "slider_crank": "<slider_crank>",
    "inverted_slider_crank": "<inverted_slider_crank>",
    "crank_shaper": "<quick_return>",
    "whitworth": "<quick_return>",
    "geared_fivebar": "<geared_fivebar>",
}


def _tag(statement: Any) -> str:
    """Which model reads a statement: dimensions where the type has them and they are given, else the skeleton."""
    if not isinstance(statement, dict):
        return "<skeleton>"
    kind = statement.get("type")
    if "skeleton" in statement and not {"fixed_pivots", "fixed_pivot"} & statement.keys():
        return "<skeleton>"
    return _BY_TYPE.get(kind, "<skeleton>") if isinstance(kind, str) else "<skeleton>"


GivenMechanism = Annotated[
    Annotated[GivenFourbar, Tag("<fourbar>")]
    | Annotated[GivenSliderCrank, Tag("<slider_crank>")]
    | Annotated[GivenInvertedSliderCrank, Tag("<inverted_slider_crank>")]
    | Annotated[GivenQuickReturn, Tag("<quick_return>")]
    | Annotated[GivenGearedFivebar, Tag("<geared_fivebar>")]
    | Annotated[GivenSkeleton, Tag("<skeleton>")],
    Discriminator(_tag),
]
"""Any stated mechanism; the field ``type`` tells which."""


def _agree(path: str, stated: float | None, found: float, what: str = "the fixed pivots") -> None:
    """Refuse a redundant dimension that contradicts the others."""
    if stated is not None and abs(stated - found) > AGREES * max(abs(found), abs(stated)):
        raise MechanismError(path, f"{what} give {found:.9g}; leave the field out or correct it")


def _assembled(make: Callable[[float], Mechanism], degrees: float | None) -> Mechanism:
    """The mechanism at its reference angle; where none is stated, at the first degree that will do, from 30° on."""
    if degrees is not None:
        try:
            return make(math.radians(degrees))
        except DimensionError:
            raise MechanismError(
                "/reference_input_angle", "the mechanism cannot be assembled at this input angle"
            ) from None
    for step in range(360):
        try:
            return make(math.radians((FIRST_TRIED + step) % 360))
        except DimensionError:
            continue
    raise MechanismError("/links", "the mechanism cannot be assembled with these lengths at any input angle")
