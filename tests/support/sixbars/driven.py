"""What the loops of a design say of its transmission angles."""

from __future__ import annotations

from typing import Any

from tests.oracles.loops import Followed, Loops

CLOSE = 0.1
"""Degrees by which an angle between the places that were looked at may be less than is told."""


def transmits(design: Any, loops: Loops, met: Followed, at: dict[str, str]) -> bool:
    """Whether a design transmits as it says: at the pins ``at`` where a link is driven by a dyad, and at the legs of a
    triad by the forces at all pins."""
    told = design.metrics.transmission_angles
    seen = loops.transmission(met, at)
    return told.keys() == seen.keys() and all(seen[link] >= angle - CLOSE for link, angle in told.items())


def find_dyad_pins(kind: str, loops: Loops) -> dict[str, str]:
    """The pins of the dyads of a sixbar or eightbar with P, by the links that they drive."""
    if kind != "eightbar":
        return {"coupler": "B", "link_5": "D" if kind == "stephenson_3" else "E"}
    # Every dyad of an eightbar counts, also where its links have the form of a triad.
    loops.triad = []
    # The second pin of a dyad's first link is that of the dyad.
    return {link: loops.links[link][1] for link in ("coupler", "link_5", "link_7")}
