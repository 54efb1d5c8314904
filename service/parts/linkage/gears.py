"""Gears that couple two links of a linkage: teeth with the exact ratio, and their mesh.

Both gears turn about fixed pivots, so their centre distance is given. The module follows from it and from the sum of
teeth, and is rarely a standard one. Links that turn in the same direction have an idler between their gears, as large
as the smaller one. Each gear is keyed to the shaft of its link. In the reference configuration a tooth of the first
gear lies on the line of the pivots, so that the phase is determined by the angle between link and teeth alone.
"""

from __future__ import annotations

import cmath
import math
from fractions import Fraction
from typing import NamedTuple

from kinematics.gear.teeth import Gear
from kinematics.linkage.layout import list_gear_discs
from kinematics.linkage.planar.mechanism import GearPair, Mechanism
from kinematics.message import compose
from service.parts.assembly.sizes import NotMade

MIN_TEETH, MAX_TEETH = 18, 300
"""Minimum and maximum teeth of a gear; with fewer teeth a rack undercuts standard teeth."""

RATIO_TOLERANCE = 1e-12
"""Relative error of the ratio up to which teeth match it; a larger error would let the phase drift."""


class PairWheel(NamedTuple):
    """A gear at its place.

    Attributes
    ----------
    name : str
        Name of its plate in :mod:`kinematics.linkage.layout`.
    link : str
        The link that it is keyed to; the ground for an idler.
    joint : str or None
        Joint of its shaft; None for an idler, which has its own pin.
    gear : Gear
    centre : complex
    tooth_at : float
        Angle of a tooth's middle, radians, in the reference configuration.
    speed : float
        Speed relative to the pair's first link.
    """

    name: str
    link: str
    joint: str | None
    gear: Gear
    centre: complex
    tooth_at: float
    speed: float


def find_teeth(ratio: float) -> tuple[int, int]:
    """Return the smallest teeth of the first and second gear that have the ratio second/first of the speeds exactly.

    Raises
    ------
    NotMade
        If no teeth up to :data:`MAX_TEETH` have the ratio.

    Examples
    --------
    >>> find_teeth(-2.0), find_teeth(1.5)
    ((36, 18), (27, 18))
    """
    size = abs(ratio)
    # Best rational approximation with permitted teeth.
    share = Fraction(size).limit_denominator(MAX_TEETH)
    if (
        share == 0
        or abs(float(share) - size) > RATIO_TOLERANCE * size
        or max(share.numerator, share.denominator) > MAX_TEETH
    ):
        raise NotMade(compose("parts-ratio-not-exact", largest=MAX_TEETH, ratio=f"{ratio:.12g}"))
    # Smallest multiple that avoids undercut on the smaller gear.
    times = math.ceil(MIN_TEETH / min(share.numerator, share.denominator))
    teeth = times * share.numerator, times * share.denominator
    if max(teeth) > MAX_TEETH:
        raise NotMade(
            compose(
                "parts-ratio-needs-too-many-teeth",
                ratio=f"{ratio:.12g}",
                first=teeth[0],
                second=teeth[1],
                smallest=MIN_TEETH,
                largest=MAX_TEETH,
            )
        )
    return teeth


def make_pair_wheels(mechanism: Mechanism, pair: GearPair) -> list[PairWheel]:
    """Return the gears of a pair: the first, the second, and an idler if both turn in the same direction.

    Raises
    ------
    TopologyError
        If the pair cannot be placed, see :func:`~kinematics.linkage.layout.list_gear_discs`.
    NotMade
        If no teeth have the ratio.
    """
    first, second, *idler = list_gear_discs(mechanism, pair)
    teeth = dict(zip((first.name, second.name), find_teeth(pair.ratio), strict=True))
    # The pitch radii are fixed by the distance of the pivots.
    module = 2.0 * first.radius / teeth[first.name]
    along = cmath.phase(second.centre - first.centre)
    pitch = 2.0 * math.pi / teeth[second.name]
    # A tooth of the second gear meshes with a space of the first, half a pitch from the line of the pivots.
    meeting = along + math.pi + 0.5 * pitch
    wheels = [PairWheel(first.name, first.link, first.joint, Gear(teeth[first.name], module), first.centre, along, 1.0)]
    for disc in idler:
        between = min(teeth.values())
        at = along + math.pi + math.pi / between
        if between % 2 == 0:
            # With an even number of teeth the idler has spaces on both sides of the line.
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
