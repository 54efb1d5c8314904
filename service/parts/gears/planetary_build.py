"""How a planetary train can be built between two plates: what lies over what, and how each member is got at.

From below lie: the lower plate; a carrier's plate or a ring's web; the planes of the gears; a web or a carrier's plate;
the upper plate. A shaft stands in the lower plate and one in the upper, on the axis of the train, and a member is keyed
to one of them, or runs freely on what passes through it. A held ring stands on the posts between the plates, the pins
of a held carrier in the lower plate, and a held sun on a shaft that is keyed to its plate. All ways are gone through;
the best leaves no driven or driving member without a shaft.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import product
from typing import Literal, NamedTuple

from kinematics.gear.arrangements import Arrangement

Access = Literal["low", "high", "loose", "held"]
"""On the lower or the upper shaft, free on one of them, or held by the housing itself."""

CARRIER_FIRST: tuple[Literal["below", "above"], ...] = ("above", "below")


class Build(NamedTuple):
    """A way to build a train with one carrier.

    Attributes
    ----------
    planes : mapping of int to int
        The level of each plane of the arrangement.
    webs : mapping of str to int
        The levels of the webs of rings that turn, by body.
    carrier : int or None
        The level of the carrier's plate; None where the lower plate is the carrier.
    access : mapping of str to Access
        How each member is got at.
    low, high : int or None
        The highest level that the lower shaft reaches, and the lowest that the upper one does.
    highest : int
        The highest level between the plates.
    """

    planes: Mapping[int, int]
    webs: Mapping[str, int]
    carrier: int | None
    access: Mapping[str, Access]
    low: int | None
    high: int | None
    highest: int


def build_of(arrangement: Arrangement, roles: tuple[str, str, str]) -> Build | None:
    """The best way to build an arrangement; None where there is none.

    Parameters
    ----------
    roles : tuple of str
        The members that drive, are driven and are held.
    """
    ways = list(_ways(arrangement, roles))
    return min(ways, key=lambda way: sum(way.access[body] == "loose" for body in roles[:2])) if ways else None


def _ways(arrangement: Arrangement, roles: tuple[str, str, str]) -> Iterator[Build]:
    """All ways, those in the order of the arrangement first."""
    held = roles[2]
    (carrier,) = set(arrangement.carriers.values())
    central = [gear for gear in arrangement.gears if gear.body not in arrangement.carriers]
    rings = [gear for gear in central if gear.internal]
    turning = [ring.body for ring in rings if ring.body != held]
    planes = sorted({plane for gear in arrangement.gears for plane in gear.planes})
    for order in (planes, planes[::-1]):
        for plate in (None,) if carrier == held else CARRIER_FIRST:
            for sides in product(("above", "below"), repeat=len(turning)):
                below = [body for body, side in zip(turning, sides, strict=True) if side == "below"]
                above = [body for body, side in zip(turning, sides, strict=True) if side == "above"]
                ends = {ring.body: ring.planes[0] for ring in rings}
                # A web lies next to its ring, and nothing passes through it but the shaft.
                if len(below) > 1 or len(above) > 1:
                    continue
                if below and (ends[below[0]] != order[0] or plate in ("below", None)):
                    continue
                if above and (ends[above[0]] != order[-1] or plate == "above"):
                    continue
                first = 1 + (plate == "below") + len(below)
                levels = {plane: first + k for k, plane in enumerate(order)}
                last = first + len(order) - 1
                webs = dict.fromkeys(below, first - 1) | dict.fromkeys(above, last + 1)
                at = {"below": 1, "above": last + 1}.get(plate or "")
                highest = last + len(above) + (plate == "above")
                hubs = {gear.body: webs.get(gear.body, levels[gear.planes[0]]) for gear in central}
                if at is not None:
                    hubs[carrier] = at
                if held in {ring.body for ring in rings}:
                    del hubs[held]
                yield from _got_at(hubs, roles, levels, webs, at, highest, [*arrangement.members])


def _got_at(
    hubs: Mapping[str, int],
    roles: tuple[str, str, str],
    levels: Mapping[int, int],
    webs: Mapping[str, int],
    carrier: int | None,
    highest: int,
    members: list[str],
) -> Iterator[Build]:
    """All ways to bring hubs on two shafts that do not meet."""
    bodies = list(hubs)
    choices: list[tuple[Access, ...]] = [
        ("low", "high") if body == roles[2] else ("low", "high", "loose") for body in bodies
    ]
    for chosen in product(*choices):
        low = [hubs[body] for body, access in zip(bodies, chosen, strict=True) if access == "low"]
        high = [hubs[body] for body, access in zip(bodies, chosen, strict=True) if access == "high"]
        if len(low) > 1 or len(high) > 1:
            continue
        top, bottom = max(low, default=None), min(high, default=None)
        for body, access in sorted(zip(bodies, chosen, strict=True), key=lambda pair: hubs[pair[0]]):
            level = hubs[body]
            if access != "loose" or (top is not None and level <= top) or (bottom is not None and level >= bottom):
                continue
            if top is not None:
                top = level
            elif bottom is not None:
                bottom = level
            else:
                break
        else:
            if top is not None and bottom is not None and top >= bottom:
                continue
            access_of: dict[str, Access] = dict.fromkeys(members, "held")
            access_of |= dict(zip(bodies, chosen, strict=True))
            yield Build(levels, webs, carrier, access_of, top, bottom, highest)
