"""The model of an assembly: parts as stacks of bodies, their carriers, and the motion of these."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from functools import cached_property, reduce
from operator import add
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, Protocol

import numpy as np

from kinematics.arrays import Complex, Real
from service.parts.geometry.meshes import DISPLAY_SAG
from service.parts.geometry.regions import Region, measure_area, measure_extent
from service.parts.geometry.solids import Body

if TYPE_CHECKING:
    from manifold3d import Manifold

Sort = Literal["base", "link", "block", "gear", "cam", "wheel", "pin", "ring", "washer", "spacer", "key"]
"""Kind of a part; shafts are pins."""

SHEET_SORTS: tuple[Sort, ...] = ("base", "link", "block", "gear", "cam", "wheel")
"""Kinds cut from a sheet, if they are prisms; all others are turned or bought."""

InputField = Literal["input_angle", "input_place"]
"""Request field that sets the position in which an assembly is shown."""


class Development(NamedTuple):
    """The unrolled surface of a round part, seen from outside: x around it, y along its axis, millimetres.

    Attributes
    ----------
    width, height : float
        Circumference, and length along the axis.
    lines : tuple of (str, tuple of complex)
        Layer and points of each open line on the surface.
    """

    width: float
    height: float
    lines: tuple[tuple[str, tuple[complex, ...]], ...]


class Carrier(NamedTuple):
    """The body that a part moves with: it rotates with a link and translates with a joint; the base is at rest.

    A motion without joints, such as that of a train, names its bodies as links, and no joint.
    """

    link: str
    joint: str | None


class Frame(NamedTuple):
    """A plane in space in which parts are drawn and move; heights are measured along its normal.

    Attributes
    ----------
    origin : Real
        Shape (3,), or (n, 3) if it moves.
    axes : Real
        Shape (3, 3) or (n, 3, 3): x, y and the normal as columns, a rotation.
    """

    origin: Real
    axes: Real


class Placement(NamedTuple):
    """Displacement of parts at n inputs: z ↦ ``turn`` · z + ``shift``, shapes (n,).

    It is in the plane of the assembly, or in that of ``frame`` if the axis is not parallel to all others.
    """

    turn: Complex
    shift: Complex
    frame: Frame | None = None


def compute_poses(placed: Placement, count: int) -> tuple[Real, Real]:
    """Return the rotations and positions in space of a placement, shapes (count, 3, 3) and (count, 3)."""
    turn, shift = (np.broadcast_to(values, count) for values in (placed.turn, placed.shift))
    rotation, place = np.tile(np.eye(3), (count, 1, 1)), np.zeros((count, 3))
    rotation[:, 0, 0] = rotation[:, 1, 1] = turn.real
    rotation[:, 1, 0], rotation[:, 0, 1] = turn.imag, -turn.imag
    place[:, 0], place[:, 1] = shift.real, shift.imag
    if placed.frame is None:
        return rotation, place
    axes = placed.frame.axes
    return axes @ rotation, placed.frame.origin + (axes @ place[:, :, None])[:, :, 0]


class Motion(Protocol):
    """Motion of the carriers, in millimetres and radians, over the range of inputs for which the parts were made."""

    @property
    def low(self) -> float:
        """Minimum input."""

    @property
    def high(self) -> float:
        """Maximum input."""

    @property
    def closed(self) -> bool:
        """Whether the range is one full cycle."""

    @property
    def reference(self) -> float:
        """Input of the reference configuration, in which the parts are drawn."""

    @property
    def size(self) -> float:
        """Size of the mechanism."""

    @property
    def input_field(self) -> InputField:
        """Request field that sets the input."""

    def sample_inputs(self, count: int) -> Real:
        """Return inputs over the range, shape (count,), for interference checks."""

    def convert_input(self, value: float, scale: float) -> float:
        """Convert an input from a request: degrees, or lengths of a design built at ``scale``.

        Raises
        ------
        NotMade
            If the input is outside the range.
        """

    def compute_state(self, inputs: Real) -> Any:
        """Compute the state at inputs, shape (n,), for use with :meth:`compute_placement`."""

    def compute_placement(self, carrier: Carrier, state: Any) -> Placement:
        """Return the displacement of a carrier from the reference configuration."""


@dataclass(frozen=True)
class Part:
    """A part at its place in the reference configuration, lengths in millimetres.

    Attributes
    ----------
    name : str
        Unique in its assembly, of lower-case letters, digits and underscores.
    described : str
        Description in words.
    bodies : tuple of Body
        Bodies on top of one another, or side by side without touching.
    along : complex
        Unit direction in which its length is measured.
    planes : pair of int
        The lowest and the highest plane that it occupies.
    standard : str
        Designation of a bought part; empty if it is made.
    round : bool
        Whether it is a stack of rings about its joint.
    like : str
        Key shared by identical parts if their bodies do not show it; or empty.
    unrolled : Development, optional
        Drawing of the surface of a part that is cut into a round bar.
    mass : float, optional
        Mass in the answer's unit, if the answer contains the density.
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
        """Height of the lowest face."""
        return min(body.low for body in self.bodies)

    @property
    def high(self) -> float:
        """Height of the highest face."""
        return max(body.high for body in self.bodies)

    @property
    def has_lower_head(self) -> bool:
        """Whether it is a pin with a head at its lower end, so that it is inserted from below."""
        # Compare the lowest body with the thinnest one.
        first, *_ = areas = [measure_area(body.region.outer) for body in sorted(self.bodies, key=lambda body: body.low)]
        return self.sort == "pin" and first > 1.2 * min(areas)

    @property
    def region(self) -> Region:
        """Region cut from the sheet: that of the widest prism."""
        # The widest prism is the plate itself; bosses are smaller.
        return max((body.region for body in self.bodies), key=lambda region: measure_area(region.outer))

    @cached_property
    def length_and_width(self) -> tuple[float, float]:
        """Extents along its length and across."""
        outer = self.region.outer
        (low, high), (left, right) = measure_extent(outer, self.along), measure_extent(outer, 1j * self.along)
        return high - low, right - left

    @cached_property
    def volume(self) -> float:
        """Volume, cubic millimetres."""
        return math.fsum(body.volume for body in self.bodies)

    @cached_property
    def mesh(self) -> Manifold:
        """Closed mesh of all bodies in the reference configuration, for files and pictures."""
        first, *others = (body.make_mesh(DISPLAY_SAG) for body in self.bodies)
        return reduce(add, others, first)


@dataclass(frozen=True, eq=False)
class Assembly:
    """The parts of a design, in millimetres; compared by identity.

    Attributes
    ----------
    planes : int
        Number of planes with moving links. The base is plane 0; a second base is above them all, or between them.
    sides : 1 or 2
        Number of bases that hold the shafts.
    unit : float
        Millimetres per length unit of the design, at the built size.
    scale : float
        Ratio of the built size to that of the design.
    notes : tuple of str
        Notes for assembly.
    touching : frozenset of frozenset of str
        Pairs of parts, by name, that slide or roll on each other, such as a cam and its roller.
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
        """Size of the mechanism."""
        return self.motion.size

    @cached_property
    def frames(self) -> dict[str, Frame]:
        """Planes of those parts that do not lie in the plane of the assembly, by name."""
        state = self.motion.compute_state(np.array([self.motion.reference]))
        placed = {part.name: self.motion.compute_placement(part.carrier, state).frame for part in self.parts}
        return {
            name: Frame(frame.origin.reshape(-1, 3)[0], frame.axes.reshape(-1, 3, 3)[0])
            for name, frame in placed.items()
            if frame is not None
        }

    def name_plane(self, plane: int) -> str:
        """Return the name of a plane: a base, or its number."""
        if plane == 0:
            return "base"
        based = any(part.sort == "base" and part.planes[0] == plane for part in self.parts)
        return "second base" if based else f"plane {plane}"

    @property
    def parallel(self) -> bool:
        """Whether all axes are parallel."""
        return not self.frames


def simplify_name(name: str) -> str:
    """Return a name in the form that files and CAD programs accept."""
    return re.sub(r"[^a-z0-9]+", "_", name.lower()).strip("_") or "part"
