"""Planar linkages given by their skeleton: joints in one configuration, and links, slides and gears between them."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from itertools import combinations
from typing import Literal

import numpy as np
from pydantic import Field

from kinematics.linkage.planar.mechanism import GROUND, GearPair, Mechanism, Slide
from kinematics.message import compose, join_messages
from synthesis.mechanisms.base import MechanismError
from synthesis.model.json_object import JsonObject
from synthesis.model.linkage.given_linkage import (
    AGREEMENT_TOLERANCE,
    BODY_DESCRIPTION,
    ROUNDING_TOLERANCE,
    CouplerPointSpec,
    SkeletonSpec,
)
from synthesis.model.problem import Degrees, Point, PositiveLength, Statement

MAX_SHOWN = 6
"""Maximum number of distances shown in an error message."""


def assemble_skeleton(spec: SkeletonSpec, degrees: float | None = None) -> Mechanism:
    """Build the mechanism in its reference configuration; ``degrees`` is the input angle there.

    The angle matters only for gears, whose position depends on the number of turns.
    """
    assembled = _build_mechanism(spec, 0)
    # Without gears the input angle modulo a full turn determines the configuration.
    if degrees is None or not assembled.gears or assembled.has_slide_input:
        return assembled
    # With gears, the other links depend on the number of turns of the input: add whole turns to reach the given angle.
    return _build_mechanism(spec, round((math.radians(degrees) - float(assembled.reference_input)) / (2.0 * math.pi)))


def _build_mechanism(spec: SkeletonSpec, turns: int) -> Mechanism:
    names = [link.name for link in spec.links]
    if len(set(names)) != len(names):
        raise MechanismError("/skeleton/links", compose("mechanisms-link-names-equal"))
    try:
        return Mechanism(
            {name: complex(*point) for name, point in spec.joints.items()},
            {link.name: tuple(link.joints) for link in spec.links},
            spec.input_link,
            tuple(
                Slide(s.joint, s.link, np.asarray(complex(*s.point)), np.asarray(math.radians(s.angle)))
                for s in spec.slides
            ),
            tuple(GearPair(*gear.links, gear.ratio) for gear in spec.gears),
            turns,
        )
    except ValueError as error:
        raise MechanismError("/skeleton", str(error)) from None


def describe_skeleton(mechanism: Mechanism) -> JsonObject:
    """Describe the skeleton of a mechanism in its reference configuration, in JSON form."""

    def convert_to_pair(z: complex) -> tuple[float, float]:
        return z.real, z.imag

    return {
        "joints": {name: convert_to_pair(complex(z)) for name, z in mechanism.joints.items()},
        "links": [{"name": name, "joints": list(listed)} for name, listed in mechanism.links.items()],
        "slides": [
            {
                "joint": s.joint,
                "link": s.link,
                "point": convert_to_pair(complex(s.point)),
                "angle": math.degrees(float(s.angle)),
            }
            for s in mechanism.slides
        ],
        "gears": [{"links": (gear.first, gear.second), "ratio": gear.ratio} for gear in mechanism.gears],
        "input_link": mechanism.input,
    }


class GivenSkeleton(Statement):
    """Any planar linkage by its skeleton, with which ``links`` and ``fixed_pivots`` must agree."""

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
        "eightbar",
        "drag_link_rocker",
        "drag_link_slider",
        "davis",
        "dwell_rocker",
        "dwell_slider",
        "dwell_slot",
        "dwell_watt_rocker",
        "dwell_watt_slider",
        "dwell_stephenson_2",
        "peaucellier",
        "hart",
        "scott_russell",
        "pantograph",
    ] = "skeleton"
    skeleton: SkeletonSpec
    links: dict[str, PositiveLength] = Field(
        default={},
        max_length=20,
        description="Lengths by name: each is the distance between two joints of the skeleton's link of that name, or "
        "of any link if none has that name.",
    )
    fixed_pivots: dict[str, Point] = Field(
        default={},
        max_length=20,
        description="Fixed pivots by any name; each must be a joint of the skeleton's ground.",
    )
    coupler_point: CouplerPointSpec | None = Field(
        default=None, description="P of a coupler with the pins A and B; it must agree with the skeleton."
    )
    reference_input_angle: Degrees | None = Field(
        default=None, description="Absolute angle of the input link, degrees; it must agree with the skeleton."
    )
    reference_body_angle: Degrees | None = Field(default=None, description=BODY_DESCRIPTION)

    def build_mechanism(self) -> Mechanism:
        """Build the mechanism in its reference configuration.

        Raises
        ------
        MechanismError
            For an invalid skeleton, or dimensions that contradict it.
        """
        assembled = assemble_skeleton(self.skeleton, self.reference_input_angle)
        # A name without a link of its own may stand for the distance of two joints of any link.
        for name, stated in self.links.items():
            listed = [assembled.links[name]] if name in assembled.links else list(assembled.links.values())
            distances = [distance for joints in listed for distance in _measure_distances(assembled, joints)]
            if not any(abs(stated - distance) <= AGREEMENT_TOLERANCE * max(stated, distance) for distance in distances):
                shown = join_messages((f"{distance:.9g}" for distance in distances[:MAX_SHOWN]), ", ")
                raise MechanismError(
                    f"/links/{name}",
                    compose("mechanisms-skeleton-link-has-other-lengths", link=repr(name), lengths=shown)
                    if name in assembled.links
                    else compose("mechanisms-skeleton-has-other-lengths", lengths=shown),
                )
        # Coordinates are compared relative to the extent of the skeleton.
        size = max((abs(complex(z)) for z in assembled.joints.values()), default=1.0)
        for name, pivot in self.fixed_pivots.items():
            ground = [complex(assembled.joints[joint]) for joint in assembled.links[GROUND]]
            if not any(abs(complex(*pivot) - z) <= AGREEMENT_TOLERANCE * size for z in ground):
                raise MechanismError(f"/fixed_pivots/{name}", compose("mechanisms-ground-without-joint"))
        self._require_agreement(assembled)
        return assembled

    def _require_agreement(self, assembled: Mechanism) -> None:
        """Raise MechanismError if the coupler point or the input angle differs from that of the skeleton."""
        if self.coupler_point is not None:
            missing = [name for name in ("A", "B", "P") if name not in assembled.joints]
            if missing:
                raise MechanismError("/coupler_point", compose("mechanisms-skeleton-lacks-joint", joint=missing[0]))
            a, b, p = (complex(assembled.joints[name]) for name in ("A", "B", "P"))
            point = a + self.coupler_point.vector * (b - a) / abs(b - a)
            if abs(point - p) > AGREEMENT_TOLERANCE * max(abs(p - a), abs(b - a)):
                raise MechanismError("/coupler_point", compose("mechanisms-skeleton-has-other-point"))
        if self.reference_input_angle is not None:
            if assembled.has_slide_input:
                raise MechanismError("/reference_input_angle", compose("mechanisms-angle-with-driving-slide"))
            # Angles are equal modulo a full turn.
            off = math.remainder(math.degrees(float(assembled.reference_input)) - self.reference_input_angle, 360.0)
            if abs(off) > AGREEMENT_TOLERANCE * 360.0:
                raise MechanismError(
                    "/reference_input_angle",
                    compose("mechanisms-skeleton-has-other-angle"),
                )


class GivenByDimensions(Statement, ABC):
    """A type with complete dimensions. If a skeleton is also given, it must have the same links, and it is driven."""

    type: str
    reference_input_angle: Degrees | None = Field(
        default=None, description="Input angle of the reference configuration, absolute, degrees."
    )
    reference_body_angle: Degrees | None = Field(default=None, description=BODY_DESCRIPTION)
    skeleton: SkeletonSpec | None = None

    @abstractmethod
    def assemble(self) -> Mechanism:
        """Assemble the mechanism at its reference input angle, or at one at which this is possible."""

    def build_mechanism(self) -> Mechanism:
        """Build the mechanism in its reference configuration.

        Raises
        ------
        MechanismError
            For dimensions from which no mechanism can be assembled, or a skeleton that contradicts them.
        """
        own = self.assemble()
        if self.skeleton is None:
            return own
        assembled = assemble_skeleton(self.skeleton, self.reference_input_angle)
        # The slack is absolute, because distances between joints far from the origin carry the rounding of coordinates.
        slack = ROUNDING_TOLERANCE * max(abs(complex(z)) for m in (own, assembled) for z in m.joints.values())
        for joints in own.links.values():
            # Compare only joints that both have, because the skeleton may have more.
            for one, other in combinations([joint for joint in joints if joint in assembled.joints], 2):
                stated, apart = (abs(complex(m.joints[one] - m.joints[other])) for m in (own, assembled))
                if abs(stated - apart) > AGREEMENT_TOLERANCE * max(stated, apart) + slack:
                    raise MechanismError(
                        "/skeleton/joints",
                        compose(
                            "mechanisms-skeleton-contradicts-dimensions",
                            first=one,
                            second=other,
                            distance=f"{apart:.9g}",
                            expected=f"{stated:.9g}",
                        ),
                    )
        # Return the skeleton, because it has joints that the dimensions lack.
        return assembled


def _measure_distances(mechanism: Mechanism, joints: tuple[str, ...]) -> list[float]:
    places = [complex(mechanism.joints[joint]) for joint in joints]
    return [abs(one - other) for one, other in combinations(places, 2)]
