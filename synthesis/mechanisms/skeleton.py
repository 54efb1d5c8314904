"""Any planar linkage by its skeleton: joints in one configuration, and what joins them."""

from __future__ import annotations

import math
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from kinematics.linkage.mechanism import GearPair, Mechanism, Slide
from synthesis.mechanisms.base import BODY, MechanismError, StatedLine
from synthesis.problems import Number, Point, Statement


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
    reference_body_angle: Number | None = Field(default=None, description=BODY)

    def mechanism(self) -> Mechanism:
        """The mechanism in its reference configuration."""
        return self.skeleton.mechanism()
