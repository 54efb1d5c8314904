"""Shafts whose axes cross, each in two bearing plates that stand by tabs in slots of one base.

Each shaft has a plane of its own (:class:`~service.parts.model.Frame`): heights along the shaft, the imaginary axis
upwards, at right angles to the base. In it lie, by their heights, the shaft's bearing plates and its wheel, with
spacers between; both ends are held as pins are (:mod:`service.parts.fasteners`).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from kinematics.linkage.planar.mechanism import GROUND
from service.parts.bodies import Prism
from service.parts.colours import BASE_COLOUR
from service.parts.fasteners import MATERIALS, fillers, held_pin
from service.parts.gears.housing import STUB, Level, seat
from service.parts.gears.motion import Turning
from service.parts.model import Carrier, Frame, Part, Real, plain
from service.parts.shapes import Disc, Loop, Outline, Region
from service.parts.sizes import Sizes

FREE = 0.5
"""What is left between the lowest part and the base, in diameters of the shafts."""

TAB = 0.5
"""Width of the tab of a bearing plate, as a share of the plate's."""

SPREAD = 0.3
"""Half the width of a bearing plate at its foot, as a share of its height."""

BASE, BEARINGS, FIRST = 0, 1, 2
"""What stands for planes: the base, the bearing plates, and one for each shaft with its wheel."""

UP = np.array([0.0, 0.0, 1.0])


def frame_along(axis: Real, origin: Real) -> Frame:
    """The plane at right angles to a level axis, its imaginary axis upwards."""
    return Frame(origin, np.column_stack([np.cross(UP, axis), UP, axis]))


@dataclass(frozen=True)
class Axle:
    """A shaft with a wheel, in its own plane.

    Attributes
    ----------
    name : str
    number : int
        Counted from 0.
    frame : Frame
    levels : tuple of Level
        Of the plates and of the wheel, by height.
    wheel : int
        Which of them is the wheel's.
    speed : float
        Over the input's.
    stub_below : bool
        Whether its lower end is that which stands out.
    sizes : Sizes, optional
        Of the shaft and what stands on it, where it is not as thick as all others.
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
        """What turns with it."""
        return Carrier(f"shaft_{self.number + 1}", None)

    @property
    def stand(self) -> Carrier:
        """What stands on the base in its plane."""
        return Carrier(f"stand_{self.number + 1}", None)

    @property
    def plane(self) -> int:
        """What stands for a plane."""
        return FIRST + self.number

    @property
    def plates(self) -> tuple[Level, ...]:
        """The levels of its bearing plates."""
        return tuple(level for number, level in enumerate(self.levels) if number != self.wheel)

    @property
    def bodies(self) -> dict[str, Turning]:
        """How it turns, and that its plates do not."""
        return {
            self.carrier.link: Turning(0j, self.speed, frame=self.frame),
            self.stand.link: Turning(0j, 0.0, frame=self.frame),
        }

    def at(self, aside: float, height: float) -> complex:
        """Where a place of its plane is, seen from above: so far aside, and so far along the shaft."""
        along, beside = self.frame.axes[:, 2], self.frame.axes[:, 0]
        x, y, _ = self.frame.origin + aside * beside + height * along
        return complex(x, y)


@dataclass(frozen=True)
class Upright:
    """Shafts over one base.

    Attributes
    ----------
    sizes : Sizes
    axles : tuple of Axle
    below : float
        Height of the base's upper face, negative.
    """

    sizes: Sizes
    axles: tuple[Axle, ...]
    below: float

    def parts(self) -> list[Part]:
        """The base, the bearing plates, and all that is on the shafts but their wheels."""
        found = [self._base()]
        for axle in self.axles:
            found += [self._bearing(axle, number, level) for number, level in enumerate(axle.plates, 1)]
            found += self._on(axle)
        return found

    def _of(self, axle: Axle) -> Sizes:
        return axle.sizes or self.sizes

    def _bearing(self, axle: Axle, number: int, level: Level) -> Part:
        sizes = self._of(axle)
        half, wide = 0.5 * sizes.width, self._foot(axle)
        tab = TAB * wide
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
            described=f"bearing plate of the {axle.name}",
            sort="base",
            carrier=axle.stand,
            bodies=(Prism(Region(outer, (Disc(0j, 0.5 * sizes.hole),)), level.low, level.high),),
            along=1j,
            planes=(BEARINGS, BEARINGS),
            material=MATERIALS[sizes.process][0],
            colour=BASE_COLOUR,
            like=f"bearing_{axle.number + 1}",
        )

    def _foot(self, axle: Axle) -> float:
        """Half the width of a bearing plate where it stands: more than at its shaft, where that is high above."""
        return max(0.5 * self._of(axle).width, SPREAD * (float(axle.frame.origin[2]) - self.below))

    def _base(self) -> Part:
        sizes = self.sizes
        room = sizes.width
        feet = [
            axle.at(aside, height)
            for axle in self.axles
            for level in axle.plates
            for height in (level.low, level.high)
            for aside in (-self._foot(axle), self._foot(axle))
        ]
        left, right = min(z.real for z in feet) - room, max(z.real for z in feet) + room
        low, high = min(z.imag for z in feet) - room, max(z.imag for z in feet) + room
        corners = (complex(left, low), complex(right, low), complex(right, high), complex(left, high))
        inset = 0.5 * sizes.width * (1.0 + 1.0j)
        signs = (1.0 + 1.0j, -1.0 + 1.0j, -1.0 - 1.0j, 1.0 - 1.0j)
        holes: list[Outline] = [
            Disc(corner + complex(sign.real * inset.real, sign.imag * inset.imag), 0.5 * sizes.hole)
            for corner, sign in zip(corners, signs, strict=True)
        ]
        holes += [self._slot(axle, level) for axle in self.axles for level in axle.plates]
        return Part(
            name="base",
            described="base",
            sort="base",
            carrier=Carrier(GROUND, None),
            bodies=(Prism(Region(Loop(corners, (0.0,) * 4), tuple(holes)), self.below - sizes.thickness, self.below),),
            along=1.0 + 0.0j,
            planes=(BASE, BASE),
            material=MATERIALS[sizes.process][0],
            colour=BASE_COLOUR,
        )

    def _slot(self, axle: Axle, level: Level) -> Loop:
        """The slot of a tab, wider by the clearance on each side."""
        play = self.sizes.clearance
        tab = TAB * self._foot(axle) + play
        low, high = level.low - play, level.high + play
        around = (axle.at(-tab, low), axle.at(tab, low), axle.at(tab, high), axle.at(-tab, high))
        turns = ((around[1] - around[0]).conjugate() * (around[2] - around[1])).imag
        return Loop(around if turns > 0.0 else around[::-1], (0.0,) * 4)

    def _on(self, axle: Axle) -> list[Part]:
        name, sizes, planes = plain(axle.name), self._of(axle), (axle.plane, axle.plane)
        keyed, key = seat(axle.name, "1", axle.carrier, 0j, axle.levels[axle.wheel], axle.plane, sizes)
        parts = held_pin(
            name, axle.name, axle.carrier, 0j, (axle.levels[0].low, axle.levels[-1].high), planes, sizes,
            seats=[keyed], stub=STUB * sizes.pin, upside_down=axle.stub_below,
        )  # fmt: skip
        parts.append(key)
        for number, (lower, upper) in enumerate(pairwise(axle.levels), 1):
            gap = lower.high, upper.low
            parts += fillers(f"{name}_{number}", axle.carrier, 0j, gap, planes, sizes, washers=False)
        return parts
