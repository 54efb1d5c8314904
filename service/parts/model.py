"""What an assembly is: parts as stacks of bodies, what each of them moves with, and how that moves."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from service.parts.bodies import Body
from service.parts.shapes import Region, area, extent

Complex = NDArray[np.complex128]
Real = NDArray[np.float64]

Sort = Literal["base", "link", "block", "gear", "cam", "wheel", "pin", "ring", "washer", "spacer", "key"]
"""What a part is; shafts are pins."""

FLAT: tuple[Sort, ...] = ("base", "link", "block", "gear", "cam", "wheel")
"""Parts that are cut from a sheet, where they are prisms; all others are turned or bought."""

InputField = Literal["input_angle", "input_place"]
"""By which field a request says where an assembly is shown."""


class Development(NamedTuple):
    """The surface of a round part unrolled, seen from outside: x around it, y along its axis, millimetres.

    Attributes
    ----------
    width, height : float
        The circumference, and the length along the axis.
    lines : tuple of (str, tuple of complex)
        Layer and points of each open line on it.
    """

    width: float
    height: float
    lines: tuple[tuple[str, tuple[complex, ...]], ...]


class Carrier(NamedTuple):
    """What a part moves with: it turns as a link does, and goes where a joint goes; the base goes nowhere.

    A motion that has no joints, such as that of a train, names its bodies as links, and no joint.
    """

    link: str
    joint: str | None


class Frame(NamedTuple):
    """A plane in space in which parts are drawn and move, and its normal, along which their heights are.

    Attributes
    ----------
    origin : Real
        Shape (3,), or (n, 3) where it moves.
    axes : Real
        Shape (3, 3) or (n, 3, 3): x, y and the normal as columns, a rotation.
    """

    origin: Real
    axes: Real


class Placed(NamedTuple):
    """Where parts are at n inputs: z ↦ ``turn`` · z + ``shift``, shapes (n,).

    That is in the plane of the assembly, or in that of ``frame`` where the axis is not parallel to all others.
    """

    turn: Complex
    shift: Complex
    frame: Frame | None = None


class Motion(Protocol):
    """How what carries parts moves, in millimetres and radians, over the range of inputs that they were made for."""

    @property
    def low(self) -> float:
        """The lowest input."""

    @property
    def high(self) -> float:
        """The highest input."""

    @property
    def closed(self) -> bool:
        """Whether the range is one whole cycle."""

    @property
    def reference(self) -> float:
        """The input of the reference configuration, in which the parts are drawn."""

    @property
    def size(self) -> float:
        """How large the mechanism is."""

    @property
    def input_field(self) -> InputField:
        """By which field of a request its input is stated."""

    def inputs(self, count: int) -> Real:
        """So many inputs over the range, shape (count,), at which parts are looked at."""

    def stated(self, value: float, scale: float) -> float:
        """The input that a request states, in degrees, or in lengths of a design that is built so much larger.

        Raises
        ------
        NotMade
            Where it is not in the range.
        """

    def at(self, inputs: Real) -> Any:
        """The state at inputs, shape (n,), for :meth:`placed` alone."""

    def placed(self, carrier: Carrier, state: Any) -> Placed:
        """How what a carrier carries has moved from the reference configuration."""


@dataclass(frozen=True)
class Part:
    """A part at its place in the reference configuration, lengths in millimetres.

    Attributes
    ----------
    name : str
        Unique in its assembly, of lower-case letters, digits and underscores.
    described : str
        What it is, in words.
    bodies : tuple of Body
        That stand on one another, or beside one another without meeting.
    along : complex
        The direction in which its length is measured, of length 1.
    planes : pair of int
        The lowest and the highest plane in which it is.
    standard : str
        What it is bought as; empty where it is made.
    round : bool
        Whether it is a stack of rings about its joint.
    like : str
        What parts that are made alike have in common, where that is not to be seen from their bodies; or empty.
    unrolled : Development, optional
        What is drawn of one that is cut into a round bar.
    mass : float, optional
        Where the answer states the density, in the answer's unit of mass.
    """

    name: str
    described: str
    sort: Sort
    carrier: Carrier
    bodies: tuple[Body, ...]
    along: complex
    planes: tuple[int, int]
    material: str
    colour: str
    standard: str = ""
    round: bool = False
    like: str = ""
    unrolled: Development | None = None
    mass: float | None = None

    @property
    def low(self) -> float:
        """Height of its lowest face."""
        return min(body.low for body in self.bodies)

    @property
    def high(self) -> float:
        """Height of its uppermost face."""
        return max(body.high for body in self.bodies)

    @property
    def headed(self) -> bool:
        """Whether it is a pin whose lowest end is wider than its shank: it is put in from below."""
        first, *_ = areas = [area(body.region.outer) for body in sorted(self.bodies, key=lambda body: body.low)]
        return self.sort == "pin" and first > 1.2 * min(areas)

    @property
    def region(self) -> Region:
        """What is cut from the sheet: its widest prism."""
        return max((body.region for body in self.bodies), key=lambda region: area(region.outer))

    @cached_property
    def length_and_width(self) -> tuple[float, float]:
        """Extents along its length and across."""
        outer = self.region.outer
        (low, high), (left, right) = extent(outer, self.along), extent(outer, 1j * self.along)
        return high - low, right - left

    @cached_property
    def volume(self) -> float:
        """Cubic millimetres."""
        return math.fsum(body.volume for body in self.bodies)


@dataclass(frozen=True, eq=False)
class Assembly:
    """The parts of a design, in millimetres; one is equal to itself alone.

    Attributes
    ----------
    planes : int
        How many have moving links; the base is plane 0, and a second one is above them all, or amid them.
    sides : 1 or 2
        Bases that hold the shafts.
    unit : float
        Millimetres to a length unit of the design, as large as it is built.
    scale : float
        How much larger than the design that is.
    notes : tuple of str
        What else its maker has to say to who puts it together.
    touching : frozenset of frozenset of str
        Pairs of parts, by name, that slide or roll on each other: a cam and its roller.
    """

    parts: tuple[Part, ...]
    motion: Motion
    planes: int
    sides: int
    unit: float
    scale: float
    notes: tuple[str, ...] = ()
    touching: frozenset[frozenset[str]] = frozenset()

    @property
    def size(self) -> float:
        """How large the mechanism is."""
        return self.motion.size

    @cached_property
    def frames(self) -> dict[str, Frame]:
        """The planes of parts by their names, of those that do not lie in that of the assembly."""
        state = self.motion.at(np.array([self.motion.reference]))
        placed = {part.name: self.motion.placed(part.carrier, state).frame for part in self.parts}
        return {
            name: Frame(frame.origin.reshape(-1, 3)[0], frame.axes.reshape(-1, 3, 3)[0])
            for name, frame in placed.items()
            if frame is not None
        }

    def plane_name(self, plane: int) -> str:
        """What a plane is called: a base, or by its number."""
        if plane == 0:
            return "base"
        based = any(part.sort == "base" and part.planes[0] == plane for part in self.parts)
        return "second base" if based else f"plane {plane}"

    @property
    def parallel(self) -> bool:
        """Whether all axes are parallel."""
        return not self.frames


def plain(name: str) -> str:
    """A name as files and CAD programs take it."""
    return re.sub(r"[^a-z0-9]+", "_", name.lower()).strip("_") or "part"
