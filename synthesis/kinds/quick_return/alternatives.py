"""Offer designs with shorter links next to the one with the best transmission angle.

The members of a family of crank-rockers or of offset slider-cranks differ in one number, coupler over crank. The best
transmission angle often belongs to a large one; members with smaller link ratios transmit worse, down to a practical
limit.
"""

from __future__ import annotations

import math
from collections.abc import Callable

MAX_LINK_RATIO = 20.0
"""Maximum link ratio of a practical design. It is exceeded only as far as the best transmission angle, or the required
one, makes necessary."""

LINK_RATIOS = (20.0, 15.0, 10.0, 7.0, 5.0, 4.0, 3.0, 2.5, 2.0)
"""Link ratios at which designs with shorter links than the best one's are offered too."""

MIN_TRANSMISSION_ANGLE = math.radians(10.0)
"""Minimum transmission angle of such designs, radians."""

RANGE_END_TOLERANCE = 1e-9
"""Distance from the end of the range of families, radians, below which all members are change points up to rounding."""

LIMIT_TOLERANCE = 1e-9
"""Relative margin from the limit of a length or a link ratio, so that rounding does not violate the limit."""


def list_shorter_members(
    best: float, at_link_ratio: Callable[[float], float], transmission: Callable[[float], float]
) -> list[float]:
    """Return members of a family with smaller link ratios than the best member, longest first.

    Each member is represented by its ratio of coupler to crank.

    Parameters
    ----------
    best : float
        Coupler over crank of the best member, above 1.
    at_link_ratio : callable
        Coupler over crank of the member with a link ratio; 1 or less if there is none.
    transmission : callable
        Minimum transmission angle of a member, radians.
    """
    members: list[float] = []
    for ratio in LINK_RATIOS:
        member = at_link_ratio(ratio)
        # Skip members that are no shorter than those already listed.
        if 1.0 < member < min([best, *members]) and transmission(member) >= MIN_TRANSMISSION_ANGLE:
            members.append(member)
    return members
