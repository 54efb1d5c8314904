"""What an assembly is: parts as stacks of prisms, and what each of them moves with."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.linkage.planar.drive import MechanismMotion, drive
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from service.parts.shapes import Region, area, extent

Complex = NDArray[np.complex128]
Real = NDArray[np.float64]

Sort = Literal["base", "link", "block", "pin", "ring", "washer", "spacer"]
"""What a part is."""

FLAT: tuple[Sort, ...] = ("base", "link", "block")
"""Parts that are cut from a sheet; all others are turned or bought."""


class Carrier(NamedTuple):
    """What a part moves with: it turns as a link does, and goes where a joint goes; the base goes nowhere."""

    link: str
    joint: str | None


class Prism(NamedTuple):
    """A region from one height to another."""

    region: Region
    low: float
    high: float


@dataclass(frozen=True)
class Part:
    """A part at its place in the reference configuration, lengths in millimetres.

    Attributes
    ----------
    name : str
        Unique in its assembly, of lower-case letters, digits and underscores.
    described : str
        What it is, in words.
    along : complex
        The direction in which its length is measured, of length 1.
    planes : pair of int
        The lowest and the highest plane in which it is.
    standard : str
        What it is bought as; empty where it is made.
    round : bool
        Whether it is a body of revolution about its joint.
    """

    name: str
    described: str
    sort: Sort
    carrier: Carrier
    prisms: tuple[Prism, ...]
    along: complex
    planes: tuple[int, int]
    material: str
    colour: str
    standard: str = ""
    round: bool = False

    @property
    def low(self) -> float:
        """Height of its lowest face."""
        return min(prism.low for prism in self.prisms)

    @property
    def high(self) -> float:
        """Height of its uppermost face."""
        return max(prism.high for prism in self.prisms)

    @property
    def region(self) -> Region:
        """What is cut from the sheet: its widest prism."""
        return max((prism.region for prism in self.prisms), key=lambda region: area(region.outer))

    @property
    def length_and_width(self) -> tuple[float, float]:
        """Extents along its length and across."""
        outer = self.region.outer
        (low, high), (left, right) = extent(outer, self.along), extent(outer, 1j * self.along)
        return high - low, right - left

    @cached_property
    def volume(self) -> float:
        """Cubic millimetres, of prisms that stand on one another."""
        return math.fsum(
            (area(region.outer) - math.fsum(area(hole) for hole in region.holes)) * (high - low)
            for region, low, high in self.prisms
        )


class Placed(NamedTuple):
    """Where parts are at n inputs: z ↦ ``turn`` · z + ``shift``, shapes (n,)."""

    turn: Complex
    shift: Complex


@dataclass(frozen=True)
class Motion:
    """A mechanism in millimetres, the range of inputs that its parts were made for, and where it then is.

    Attributes
    ----------
    low, high : float
        Radians, or millimetres along the input slide.
    closed : bool
        Whether the range is one whole cycle.
    """

    mechanism: Mechanism
    low: float
    high: float
    closed: bool

    def inputs(self, count: int) -> Real:
        """So many inputs, spread evenly over a whole cycle, or between the ends of the range and short of them."""
        if self.closed:
            return np.linspace(self.low, self.high, count, endpoint=False)
        return np.linspace(self.low, self.high, count + 2)[1:-1]

    def at(self, inputs: Real) -> MechanismMotion:
        """The mechanism at inputs."""
        return drive(self.mechanism, inputs, order=0)

    def placed(self, carrier: Carrier, driven: MechanismMotion) -> Placed:
        """How what a carrier carries has moved from the reference configuration."""
        turn = self._turn(carrier.link, driven)
        if carrier.joint is None:
            return Placed(turn, np.zeros_like(turn))
        shift = driven.joints[carrier.joint][0] - turn * complex(self.mechanism.joints[carrier.joint])
        return Placed(turn, shift)

    def _turn(self, link: str, driven: MechanismMotion) -> Complex:
        if link == GROUND:
            return np.ones(driven.valid.shape, np.complex128)
        joints = self.mechanism.links[link]
        first = joints[0]
        far = max(joints, key=lambda name: abs(complex(self.mechanism.joints[name] - self.mechanism.joints[first])))
        turn = (driven.joints[far][0] - driven.joints[first][0]) / complex(
            self.mechanism.joints[far] - self.mechanism.joints[first]
        )
        return np.asarray(turn / np.abs(turn))


@dataclass(frozen=True)
class Assembly:
    """The parts of a design, in millimetres.

    Attributes
    ----------
    planes : int
        Of moving links; the base is plane 0, and a second one is above them all.
    sides : 1 or 2
        Bases that hold the shafts.
    unit : float
        Millimetres to a length unit of the design, as large as it is built.
    scale : float
        How much larger than the design that is.
    """

    parts: tuple[Part, ...]
    motion: Motion
    planes: int
    sides: int
    unit: float
    scale: float

    @property
    def size(self) -> float:
        """The greatest distance of two joints."""
        places = np.array([complex(z) for z in self.motion.mechanism.joints.values()])
        return float(np.abs(places[:, None] - places).max())
