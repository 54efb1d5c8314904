"""How a gear must be turned so that its teeth stand in the spaces of its mate."""

from __future__ import annotations

import math

from kinematics.gear.teeth import Gear


def facing(one: Gear, tooth_at: float, other: Gear, ahead: float) -> float:
    """Angle of a tooth of ``other`` so that a space of it faces the tooth of ``one`` nearest to their contact.

    That tooth of ``one`` is some way past the contact on the pitch circle; the space of ``other`` is as far past it:
    the other way round for external gears. ``ahead`` is the direction from the centre of ``one`` to the contact; with
    internal teeth both see it the same way.
    """
    past = math.remainder(tooth_at - ahead, 2.0 * math.pi / one.teeth) * one.pitch_radius / other.pitch_radius
    if one.internal or other.internal:
        return ahead + past + math.pi / other.teeth
    return ahead + math.pi - past + math.pi / other.teeth
