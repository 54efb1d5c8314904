"""A gear in its place in a drawing, turned so that its teeth stand in the spaces of its mate."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from kinematics.errors import DimensionError
from kinematics.gear.profile import outline
from kinematics.gear.teeth import Gear
from service.render.page.svg import Box, Points


@dataclass(frozen=True)
class PlacedGear:
    """A gear in a drawing; ``tooth_at`` is the angle of one tooth's middle, the helix angle is in radians."""

    gear: Gear
    centre: complex
    tooth_at: float
    helix_angle: float = field(default=0.0, kw_only=True)

    @property
    def pitch_radius(self) -> float:
        """Radius of the pitch circle."""
        return self.gear.pitch_radius

    @property
    def reach(self) -> float:
        """Radius of all that a drawing has to hold of it."""
        return self.gear.tip_radius

    def corners(self) -> Points:
        """Corners of a box around the gear."""
        return np.array([self.centre + side * self.reach for side in (-1 - 1j, 1 + 1j)])

    def teeth(self) -> Points | None:
        """Outline of all teeth about the centre; None for teeth whose cutter would come to a point, which have none."""
        try:
            return np.asarray(outline(self.gear, self.tooth_at, self.helix_angle))
        except DimensionError:
            return None


def box_around(gears: Iterable[PlacedGear]) -> Box:
    """The box around all tip circles, or what else a drawing shows of them."""
    return Box.around(np.concatenate([gear.corners() for gear in gears]))


def facing(gear: Gear, tooth_at: float, mate: Gear, ahead: float) -> float:
    """Angle of a tooth of ``mate`` so that a space of it faces the tooth of ``gear`` nearest to their contact.

    That tooth of ``gear`` is some way past the contact on the pitch circle; the space of ``mate`` is as far past it:
    the other way round for external gears. ``ahead`` is the direction from the centre of ``gear`` to the contact; with
    internal teeth both see it the same way.
    """
    past = math.remainder(tooth_at - ahead, 2.0 * math.pi / gear.teeth) * gear.pitch_radius / mate.pitch_radius
    if gear.internal or mate.internal:
        return ahead + past + math.pi / mate.teeth
    return ahead + math.pi - past + math.pi / mate.teeth
