"""How a gear must be turned so that its teeth stand in the spaces of its mate."""

from __future__ import annotations

import math

from kinematics.gear.teeth import Gear


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
