"""A planar mechanism by its skeleton: positions of its joints in a reference configuration, and their connections.

Links are rigid and named; two links that list the same joint are pinned together there. A *slide* keeps a joint on a
line fixed in a link. A *gear pair* makes one link turn a multiple of another. The input is a link that is pinned to the
ground (its rotation drives), or the joint of a slide on the ground (its displacement drives).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinematics.arrays import Complex, Real, Scalar
from kinematics.errors import MechanismError
from kinematics.linkage.fourbar.closed_form import broadcast_shape, require
from kinematics.linkage.planar.constraints import Constraints

GROUND = "ground"
"""Name of the link that does not move; every mechanism has it."""


SLIDE_TOLERANCE = 1e-6
"""Maximum distance of a joint from its slide in the reference, as a share of the size: input data may be rounded."""


MIN_LENGTH = 1e-13
"""Length, as a share of the mechanism's size, below which two joints coincide: rounding is of that order."""


class TopologyError(MechanismError, ValueError):
    """Links, slides or gears that do not form one mechanism with a mobility of one."""


class Slide(NamedTuple):
    """``joint`` stays on a line fixed in ``link``: through ``point`` at ``angle`` (radians) in the reference."""

    joint: str
    link: str
    point: Complex
    angle: Real


class GearPair(NamedTuple):
    """Rotation of ``second`` = ``ratio`` × rotation of ``first``, both relative to ground."""

    first: str
    second: str
    ratio: float


@dataclass(frozen=True, eq=False)
class Mechanism:
    """Designs of one topology.

    Parameters
    ----------
    joints : mapping of str to complex
        Joints in the reference configuration; arrays that broadcast to the shape S of the designs.
    links : mapping of str to tuple of str
        Joints on each link. The angle of a link is that of the line from its first joint to its second.
    slides, gears : tuples
        See :class:`Slide` and :class:`GearPair`.
    input : str
        Name of a link that is pinned to the ground, or of the joint of a slide on the ground.
    turns : int
        Full turns of the input link in the reference, added to the angle in −π to π that its joints give. With gears of
        a non-integer ratio, the same input angle is another configuration after a turn.

    Attributes
    ----------
    shape : tuple of int
        S.
    redundant : int
        Number of redundant constraints.

    Raises
    ------
    TopologyError
        For unknown names, a link without joints, or a mobility other than one. The count may give less if special
        dimensions make constraints redundant, so that the links still move.
    DimensionError
        For coordinates or gear ratios that are not finite, a joint that is not on its slide, or a moving link whose
        first two joints coincide: it has no angle, and a crank without length cannot drive. Fixed pivots may coincide;
        the mechanism then turns about them as one body.
    ShapeError
        For coordinates that do not broadcast.
    """

    joints: dict[str, Complex]
    links: dict[str, tuple[str, ...]]
    input: str
    slides: tuple[Slide, ...] = ()
    gears: tuple[GearPair, ...] = ()
    turns: int = 0
    shape: tuple[int, ...] = field(init=False)
    redundant: int = field(init=False)

    def __init__(
        self,
        joints: dict[str, ArrayLike],
        links: dict[str, tuple[str, ...]],
        input: str,
        slides: tuple[Slide, ...] = (),
        gears: tuple[GearPair, ...] = (),
        turns: int = 0,
    ) -> None:
        points = {name: np.asarray(z, np.complex128) for name, z in joints.items()}
        lines = tuple(
            s._replace(point=np.asarray(s.point, np.complex128), angle=np.asarray(s.angle, np.float64)) for s in slides
        )
        for name, point in points.items():
            require("kinematics-joint-position", "kinematics-finite", point, np.isfinite(point), joint=name)
        for line in lines:
            require("kinematics-slide", "kinematics-finite", line.point, np.isfinite(line.point), joint=line.joint)
            require(
                "kinematics-slide-angle", "kinematics-finite", line.angle, np.isfinite(line.angle), joint=line.joint
            )
        for gear in gears:
            require("kinematics-gear-ratio", "kinematics-finite", np.asarray(gear.ratio), np.isfinite(gear.ratio))
        shapes = {name: point.shape for name, point in points.items()}
        for n, line in enumerate(lines):
            shapes |= {f"slide {n}": line.point.shape, f"slide angle {n}": line.angle.shape}
        shape = broadcast_shape(**shapes)
        own = {name: np.broadcast_to(point, shape) for name, point in points.items()}
        for name, value in (
            ("joints", own),
            ("links", {name: tuple(listed) for name, listed in links.items()}),
            ("input", input),
            ("slides", lines),
            ("gears", tuple(gears)),
            ("turns", turns),
            ("shape", shape),
        ):
            object.__setattr__(self, name, value)
        self._check_names()
        self._check_slides()
        self._check_lengths()
        self._check_mobility()

    @property
    def mobility(self) -> int:
        """Degrees of freedom: always one, that of the input; see :attr:`gruebler_mobility` for the count."""
        return 1

    @cached_property
    def gruebler_mobility(self) -> int:
        """Degrees of freedom by counting: 3 per moving link, minus 2 per pin, 1 per slide and gear pair (Norton 2.1).

        A joint on k links counts as k − 1 pins. Parallel cranks, closed trains of gears and other overconstrained
        mechanisms move although their count is less than one.
        """
        pins = sum(map(len, self.links.values())) - len(self.joints)
        return 3 * (len(self.links) - 1) - 2 * pins - len(self.slides) - len(self.gears)

    @property
    def frame(self) -> tuple[Complex, Real]:
        """Origin and size of unit coordinates, shape S: the first ground joint, and the largest distance from it."""
        ground = self.links[GROUND]
        origin = self.joints[ground[0]] if ground else next(iter(self.joints.values()))
        size = np.stack([np.abs(z - origin) for z in self.joints.values()]).max(axis=0)
        return np.asarray(origin), np.asarray(np.where(size > 0.0, size, 1.0))

    def constraints(self, designs: NDArray[np.int64] | None = None) -> Constraints:
        """Return the constraints of the designs with the given numbers, by default of all, in unit coordinates."""
        origin, size = self.frame

        def take_designs(values: NDArray[Scalar]) -> NDArray[Scalar]:
            each = np.broadcast_to(values, self.shape).ravel()
            return each if designs is None else each[designs]

        def scale_to_unit(z: Complex) -> Complex:
            return take_designs((z - origin) / size)

        return Constraints(
            {name: scale_to_unit(z) for name, z in self.joints.items()},
            self.links,
            [(s.joint, s.link, scale_to_unit(s.point), take_designs(s.angle)) for s in self.slides],
            self.gears,
            self.input,
            GROUND,
        )

    def _check_mobility(self) -> None:
        """Check that the mobility is one: by counting or, with redundant constraints, by rank and a trial move."""
        counted = self.gruebler_mobility
        object.__setattr__(self, "redundant", 1 - counted)
        if counted > 1:
            raise TopologyError("kinematics-mobility-above-one", mobility=counted)
        if counted == 1:
            return
        constraints = self.constraints()
        found = constraints.mobility(constraints.reference)
        if found.size and int(found.min()) < 1:
            raise TopologyError("kinematics-mobility-below-one", mobility=str(counted))
        if found.size and int(found.max()) > 1:
            raise TopologyError("kinematics-mobility-at-dead-centre", mobility=int(found.max()))
        if not constraints.moves():
            raise TopologyError("kinematics-mobility-in-one-position")

    def _list_links_at(self, joint: str) -> int:
        return sum(joint in listed for listed in self.links.values())

    def _check_names(self) -> None:
        """Check that links, slides, gears and the input refer to existing joints and links."""
        if GROUND not in self.links:
            raise TopologyError("kinematics-ground-missing", link=repr(GROUND))
        for name, listed in self.links.items():
            unknown = [joint for joint in listed if joint not in self.joints]
            if unknown:
                raise TopologyError("kinematics-joint-without-position", link=repr(name), joint=repr(unknown[0]))
            if len(set(listed)) != len(listed):
                raise TopologyError("kinematics-joint-listed-twice", link=repr(name))
            if name != GROUND and len(listed) < 2:
                raise TopologyError("kinematics-link-needs-two-joints", link=repr(name))
        loose = [joint for joint in self.joints if not self._list_links_at(joint)]
        if loose:
            raise TopologyError("kinematics-joint-on-no-link", joint=repr(loose[0]))
        for slide in self.slides:
            if slide.joint not in self.joints or slide.link not in self.links:
                raise TopologyError("kinematics-slide-with-unknown-end", joint=repr(slide.joint), link=repr(slide.link))
        for gear in self.gears:
            if gear.first not in self.links or gear.second not in self.links:
                raise TopologyError(
                    "kinematics-gear-pair-with-unknown-link", first=repr(gear.first), second=repr(gear.second)
                )
        drives = [slide.joint for slide in self.slides if slide.link == GROUND]
        pinned = [
            name for name, listed in self.links.items() if set(listed) & set(self.links[GROUND]) and name != GROUND
        ]
        if self.input not in (*drives, *pinned):
            raise TopologyError("kinematics-input-cannot-drive", input=repr(self.input))

    def _check_slides(self) -> None:
        """Check that each joint lies on its slide."""
        for slide in self.slides:
            offset = self.joints[slide.joint] - slide.point
            across = np.abs((offset * np.exp(-1j * slide.angle)).imag)
            spread = np.max([np.abs(z - self.joints[slide.joint]) for z in self.joints.values()], axis=0)
            reach = np.maximum(spread, np.abs(offset))
            near = across <= SLIDE_TOLERANCE * reach
            require("kinematics-distance-from-slide", "kinematics-zero", across, near, joint=slide.joint)

    def _check_lengths(self) -> None:
        """Check that the first two joints of each moving link are distinct."""
        anywhere = next(iter(self.joints.values()))
        size = np.max([np.abs(z - anywhere) for z in self.joints.values()], axis=0)
        for link, listed in self.links.items():
            if link != GROUND:
                first, second = listed[:2]
                length = np.abs(self.joints[second] - self.joints[first])
                require(
                    "kinematics-link-length", "kinematics-positive", length, length > MIN_LENGTH * size,
                    link=link, first=first, second=second,
                )  # fmt: skip

    @property
    def slide_names(self) -> tuple[str, ...]:
        """Name of each slide: its joint, with the slide's number if the joint has several."""
        joints = [slide.joint for slide in self.slides]
        return tuple(f"{name}_{k}" if joints.count(name) > 1 else name for k, name in enumerate(joints))

    @property
    def has_slide_input(self) -> bool:
        """Whether the input is the displacement of a slide."""
        return self.input not in self.links

    @property
    def input_pivot(self) -> str:
        """Ground joint about which the input link turns."""
        return next(joint for joint in self.links[self.input] if joint in self.links[GROUND])

    @property
    def reference_input(self) -> Real:
        """Input in the reference: angle of the input link, radians, or position along the slide; shape S."""
        if self.has_slide_input:
            slide = next(s for s in self.slides if s.joint == self.input and s.link == GROUND)
            offset = self.joints[self.input] - slide.point
            return np.asarray((offset * np.exp(-1j * slide.angle)).real)
        return np.asarray(self.link_angle(self.input) + 2.0 * np.pi * self.turns)

    def link_line(self, link: str) -> tuple[str, str]:
        """Return the joints that define the angle of a link: the first two, for the input starting at its pivot."""
        first, second = self.links[link][:2]
        return (second, first) if link == self.input and second == self.input_pivot else (first, second)

    def link_angle(self, link: str) -> Real:
        """Return the angle of a link in the reference; radians, shape S."""
        first, second = self.link_line(link)
        return np.asarray(np.angle(self.joints[second] - self.joints[first]))
