"""Shafts with crossing axes, each in two bearing plates whose tabs fit in slots of one base.

Each shaft has its own plane (:class:`~service.parts.assembly.model.Frame`): heights are along the shaft, the imaginary
axis is upwards, normal to the base. It contains, by height, the shaft's bearing plates and its wheel, with spacers
between; both ends have the same fasteners as pins (:mod:`service.parts.assembly.fasteners`).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from kinematics.arrays import Real
from kinematics.linkage.planar.mechanism import GROUND
from kinematics.message import compose
from service.parts.assembly.colours import BASE_COLOUR
from service.parts.assembly.descriptions import name_material
from service.parts.assembly.fasteners import MATERIALS, PinShape, make_fillers, make_pin
from service.parts.assembly.model import Carrier, Frame, Part, simplify_name
from service.parts.assembly.sizes import Sizes
from service.parts.gears.housing import STUB_LENGTH, Level, make_seat
from service.parts.gears.motion import BodyRotation
from service.parts.geometry.regions import Disc, Loop, Outline, Region
from service.parts.geometry.solids import Prism

FLOOR_CLEARANCE = 0.5
"""Space between the lowest part and the base, in shaft diameters."""

TAB_SHARE = 0.5
"""Width of the tab of a bearing plate, as a share of the plate's."""

FOOT_SHARE = 0.3
"""Half the width of a bearing plate at its foot, as a share of its height."""

BASE_PLANE, BEARING_PLANE, FIRST_SHAFT_PLANE = 0, 1, 2
"""Plane numbers: the base, the bearing plates, and the first of one plane per shaft with its wheel."""

UP_DIRECTION = np.array([0.0, 0.0, 1.0])


def make_frame(axis: Real, origin: Real) -> Frame:
    """Return the plane normal to a horizontal axis, its imaginary axis upwards."""
    return Frame(origin, np.column_stack([np.cross(UP_DIRECTION, axis), UP_DIRECTION, axis]))


@dataclass(frozen=True)
class Axle:
    """A shaft with a wheel, in its own plane.

    Attributes
    ----------
    name : str
    number : int
        Index, from 0.
    frame : Frame
    levels : tuple of Level
        Levels of the plates and of the wheel, by height.
    wheel : int
        Index of the wheel's level.
    speed : float
        Speed relative to the input's.
    stub_below : bool
        Whether its lower end protrudes.
    sizes : Sizes, optional
        Sizes of the shaft and the parts on it, if it differs from the others.
    """

    name: str
    number: int
    frame: Frame
    levels: tuple[Level, ...]
    wheel: int
    speed: float
    stub_below: bool
    sizes: Sizes | None = None

    @property
    def carrier(self) -> Carrier:
        """Carrier of the parts that rotate with it."""
        return Carrier(f"shaft_{self.number + 1}", None)

    @property
    def stand(self) -> Carrier:
        """Carrier of the fixed parts in its plane."""
        return Carrier(f"stand_{self.number + 1}", None)

    @property
    def plane(self) -> int:
        """Plane number of the shaft."""
        return FIRST_SHAFT_PLANE + self.number

    @property
    def plates(self) -> tuple[Level, ...]:
        """Levels of its bearing plates."""
        return tuple(level for number, level in enumerate(self.levels) if number != self.wheel)

    @property
    def bodies(self) -> dict[str, BodyRotation]:
        """Rotation of its parts; the plates are at rest."""
        return {
            self.carrier.link: BodyRotation(0j, self.speed, frame=self.frame),
            self.stand.link: BodyRotation(0j, 0.0, frame=self.frame),
        }

    def project_point(self, aside: float, height: float) -> complex:
        """Return a point of its plane seen from above: at a distance sideways, and at a height along the shaft."""
        along, beside = self.frame.axes[:, 2], self.frame.axes[:, 0]
        x, y, _ = self.frame.origin + aside * beside + height * along
        return complex(x, y)


@dataclass(frozen=True)
class UprightHousing:
    """Shafts over one base.

    Attributes
    ----------
    sizes : Sizes
    axles : tuple of Axle
    below : float
        Height of the base's upper face (negative).
    """

    sizes: Sizes
    axles: tuple[Axle, ...]
    below: float

    def make_parts(self) -> list[Part]:
        """Make the base, the bearing plates, and all parts on the shafts except their wheels."""
        found = [self._make_base()]
        for axle in self.axles:
            found += [self._make_bearing(axle, number, level) for number, level in enumerate(axle.plates, 1)]
            found += self._make_shaft(axle)
        return found

    def _get_sizes(self, axle: Axle) -> Sizes:
        return axle.sizes or self.sizes

    def _make_bearing(self, axle: Axle, number: int, level: Level) -> Part:
        sizes = self._get_sizes(axle)
        half, wide = 0.5 * sizes.width, self._measure_foot(axle)
        tab = TAB_SHARE * wide
        foot = 1j * (self.below - axle.frame.origin[2])
        tip = foot - 1j * sizes.thickness
        corners = (
            foot - wide,
            foot - tab,
            tip - tab,
            tip + tab,
            foot + tab,
            foot + wide,
            complex(half),
            complex(-half),
        )
        outer = Loop(corners, (0.0,) * 6 + (1.0, 0.0))
        name = f"bearing_{axle.number + 1}_{number}"
        return Part(
            name=name,
            described=compose("parts-bearing-plate", shaft=axle.name),
            sort="base",
            carrier=axle.stand,
            bodies=(Prism(Region(outer, (Disc(0j, 0.5 * sizes.hole),)), level.low, level.high),),
            along=1j,
            planes=(BEARING_PLANE, BEARING_PLANE),
            material=name_material(MATERIALS[sizes.process][0]),
            colour=BASE_COLOUR,
            like=f"bearing_{axle.number + 1}",
        )

    def _measure_foot(self, axle: Axle) -> float:
        """Return half the foot width of a bearing plate: larger than at its shaft if that is high above the base."""
        # High bearings need a wider foot.
        return max(0.5 * self._get_sizes(axle).width, FOOT_SHARE * (float(axle.frame.origin[2]) - self.below))

    def _make_base(self) -> Part:
        sizes = self.sizes
        room = sizes.width
        feet = [
            axle.project_point(aside, height)
            for axle in self.axles
            for level in axle.plates
            for height in (level.low, level.high)
            for aside in (-self._measure_foot(axle), self._measure_foot(axle))
        ]
        left, right = min(z.real for z in feet) - room, max(z.real for z in feet) + room
        low, high = min(z.imag for z in feet) - room, max(z.imag for z in feet) + room
        corners = (complex(left, low), complex(right, low), complex(right, high), complex(left, high))
        # Screw holes in the corners of the base.
        inset = 0.5 * sizes.width * (1.0 + 1.0j)
        signs = (1.0 + 1.0j, -1.0 + 1.0j, -1.0 - 1.0j, 1.0 - 1.0j)
        holes: list[Outline] = [
            Disc(corner + complex(sign.real * inset.real, sign.imag * inset.imag), 0.5 * sizes.hole)
            for corner, sign in zip(corners, signs, strict=True)
        ]
        holes += [self._make_slot(axle, level) for axle in self.axles for level in axle.plates]
        return Part(
            name="base",
            described=compose("parts-base"),
            sort="base",
            carrier=Carrier(GROUND, None),
            bodies=(Prism(Region(Loop(corners, (0.0,) * 4), tuple(holes)), self.below - sizes.thickness, self.below),),
            along=1.0 + 0.0j,
            planes=(BASE_PLANE, BASE_PLANE),
            material=name_material(MATERIALS[sizes.process][0]),
            colour=BASE_COLOUR,
        )

    def _make_slot(self, axle: Axle, level: Level) -> Loop:
        """Return the slot of a tab, wider by the clearance on each side."""
        play = self.sizes.clearance
        tab = TAB_SHARE * self._measure_foot(axle) + play
        low, high = level.low - play, level.high + play
        around = (
            axle.project_point(-tab, low),
            axle.project_point(tab, low),
            axle.project_point(tab, high),
            axle.project_point(-tab, high),
        )
        # Orientation depends on the direction of the axle.
        turns = ((around[1] - around[0]).conjugate() * (around[2] - around[1])).imag
        return Loop(around if turns > 0.0 else around[::-1], (0.0,) * 4)

    def _make_shaft(self, axle: Axle) -> list[Part]:
        name, sizes, planes = simplify_name(axle.name), self._get_sizes(axle), (axle.plane, axle.plane)
        keyed, key = make_seat(axle.name, "1", axle.carrier, 0j, axle.levels[axle.wheel], (axle.plane,), sizes)
        parts = make_pin(
            name, axle.name, axle.carrier, 0j, (axle.levels[0].low, axle.levels[-1].high), planes, sizes,
            PinShape([keyed], STUB_LENGTH * sizes.pin, axle.stub_below),
        )  # fmt: skip
        parts.append(key)
        for number, (lower, upper) in enumerate(pairwise(axle.levels), 1):
            gap = lower.high, upper.low
            parts += make_fillers(f"{name}_{number}", axle.carrier, 0j, gap, planes, sizes, washers=False)
        return parts
