"""What the loops of a design say of its transmission angles."""

from __future__ import annotations

from typing import Any

from tests.oracles.loops import Followed, Loops

CLOSE = 0.1
"""Degrees by which an angle between the places that were looked at may be less than is told."""


def transmits(design: Any, loops: Loops, met: Followed, at: dict[str, str]) -> bool:
    """Whether a design transmits as it says: at the pins ``at`` where a link is driven by a dyad, and at an output that
    is not by the forces at all pins."""
    for link, angle in design.metrics.transmission_angles.items():
        if link == "output":
            seen = min(loops.pushed(places, link) for places in met.places)
        else:
            seen = min(value for (joint, *on), value in met.angles.items() if joint == at[link] and link in on)
        if seen < angle - CLOSE:
            return False
    return True
