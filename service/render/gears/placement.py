"""A gear at its place in a drawing, rotated so that its teeth mesh with its mate."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from kinematics.arrays import Complex
from kinematics.errors import DimensionError
from kinematics.gear.profile import draw_outline
from kinematics.gear.teeth import Gear
from service.render.page.svg import Box


@dataclass(frozen=True)
class PlacedGear:
    """A gear in a drawing; ``tooth_at`` is the angle of one tooth's middle; angles in radians."""

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
        """Radius of the drawn gear."""
        return self.gear.tip_radius

    def get_corners(self) -> Complex:
        """Return two corners of a box around the gear."""
        return np.array([self.centre + side * self.reach for side in (-1 - 1j, 1 + 1j)])

    def get_teeth(self) -> Complex | None:
        """Return the outline of all teeth about the centre; None if the cutter would come to a point."""
        try:
            return np.asarray(draw_outline(self.gear, self.tooth_at, self.helix_angle))
        except DimensionError:
            return None


def enclose_gears(gears: Iterable[PlacedGear]) -> Box:
    """Return the box around all drawn gears."""
    return Box.enclose(np.concatenate([gear.get_corners() for gear in gears]))


def align_mate(gear: Gear, tooth_at: float, mate: Gear, ahead: float) -> float:
    """Return the angle of a tooth of ``mate`` with which it meshes with ``gear``.

    A space of ``mate`` must face the tooth of ``gear`` nearest to the contact. That tooth lies at some arc length past
    the contact on the pitch circle. The space of ``mate`` lies at the same arc length past it, in the opposite
    direction for external gears.

    Parameters
    ----------
    gear : Gear
        The gear whose position is given.
    tooth_at : float
        Angle of the middle of one of its teeth, radians.
    mate : Gear
        The gear that is rotated into mesh.
    ahead : float
        Direction from the centre of ``gear`` to the contact, radians. With internal teeth it is the same for ``mate``.
    """
    # Arc length of the nearest tooth past the contact, as an angle of the mate.
    past = math.remainder(tooth_at - ahead, 2.0 * math.pi / gear.teeth) * gear.pitch_radius / mate.pitch_radius
    # Gears in internal mesh turn in the same direction.
    if gear.internal or mate.internal:
        return ahead + past + math.pi / mate.teeth
    return ahead + math.pi - past + math.pi / mate.teeth
