"""The gears that tie two links of a linkage: teeth that have the ratio exactly, and how they mesh.

Both gears turn about fixed pivots, whose distance is their centre distance: the module follows from it and from the sum
of the teeth, and is rarely one of those that are sold. Links that turn the same way have an idler between their gears,
as large as the smaller one. Each gear is keyed to the shaft of its link. In the reference configuration a tooth of the
first gear lies on the line of the pivots, so that how a link stands to its teeth is all there is of the phase.
"""

from __future__ import annotations

import cmath
import math
from fractions import Fraction
from typing import NamedTuple

from kinematics.gear.teeth import Gear
from kinematics.linkage.layout import gear_discs
from kinematics.linkage.planar.mechanism import GearPair, Mechanism
from service.parts.sizes import NotMade

FEWEST, MOST = 18, 300
"""Teeth of a gear: with fewer the rack would cut away the feet of standard teeth."""

EXACT = 1e-12
"""Share of a ratio within which teeth have it; the phase would drift otherwise."""


class PairWheel(NamedTuple):
    """A gear at its place.

    Attributes
    ----------
    name : str
        As :mod:`kinematics.linkage.layout` names its plate.
    link : str
        What it is keyed to; the ground for an idler.
    joint : str or None
        Of its shaft; None of an idler, which has one of its own.
    gear : Gear
    centre : complex
    tooth_at : float
        Angle of a tooth's middle, radians, in the reference configuration.
    speed : float
        Over that of the pair's first link.
    """

    name: str
    link: str
    joint: str | None
    gear: Gear
    centre: complex
    tooth_at: float
    speed: float


def teeth_for(ratio: float) -> tuple[int, int]:
    """Teeth of the first and of the second gear, as few as have the ratio second/first of the turns exactly.

    Raises
    ------
    NotMade
        Where none up to :data:`MOST` do.

    Examples
    --------
    >>> teeth_for(-2.0), teeth_for(1.5)
    ((36, 18), (27, 18))
    """
    size = abs(ratio)
    share = Fraction(size).limit_denominator(MOST)
    if share == 0 or abs(float(share) - size) > EXACT * size or max(share.numerator, share.denominator) > MOST:
        raise NotMade(
            f"No gears with up to {MOST} teeth have the ratio {ratio:.12g} exactly, and with any other the phase of "
            "the links would drift."
        )
    times = math.ceil(FEWEST / min(share.numerator, share.denominator))
    teeth = times * share.numerator, times * share.denominator
    if max(teeth) > MOST:
        raise NotMade(
            f"Gears of the ratio {ratio:.12g} need {teeth[0]} and {teeth[1]} teeth, where the smaller is to have "
            f"{FEWEST} at least; they are made with up to {MOST}."
        )
    return teeth


def pair_wheels(mechanism: Mechanism, pair: GearPair) -> list[PairWheel]:
    """The gears of a pair: the first, the second, and an idler where both turn the same way.

    Raises
    ------
    TopologyError
        Where the pair has no place, as :func:`~kinematics.linkage.layout.gear_discs` says.
    NotMade
        Where no teeth have the ratio.
    """
    first, second, *idler = gear_discs(mechanism, pair)
    teeth = dict(zip((first.name, second.name), teeth_for(pair.ratio), strict=True))
    module = 2.0 * first.radius / teeth[first.name]
    along = cmath.phase(second.centre - first.centre)
    pitch = 2.0 * math.pi / teeth[second.name]
    # A tooth of the second lies in a space of the first, half a pitch from the line of the pivots.
    meeting = along + math.pi + 0.5 * pitch
    wheels = [PairWheel(first.name, first.link, first.joint, Gear(teeth[first.name], module), first.centre, along, 1.0)]
    for disc in idler:
        between = min(teeth.values())
        at = along + math.pi + math.pi / between
        if between % 2 == 0:
            # With an even number of teeth it shows a space on either side.
            meeting -= 0.5 * pitch
        speed = -teeth[first.name] / between
        wheels.append(PairWheel(disc.name, disc.link, None, Gear(between, module), disc.centre, at, speed))
    wheels.insert(
        1,
        PairWheel(
            second.name, second.link, second.joint, Gear(teeth[second.name], module), second.centre, meeting, pair.ratio
        ),
    )
    return wheels
