"""Builds of a planetary train between two plates: the order of its levels, and the connection of each member.

From below follow: the lower plate; a carrier's plate or a ring's web; the planes of the gears; a web or a carrier's
plate; the upper plate. One shaft is held by the lower plate and one by the upper, on the axis of the train. A member is
keyed to one of them, or runs freely on the shaft that passes through it. A fixed ring is held by the posts between the
plates, the pins of a fixed carrier by the lower plate, and a fixed sun by a shaft that is keyed to its plate. All
builds are enumerated; the best one leaves no driving or driven member without a shaft.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import product
from typing import Literal, NamedTuple

from kinematics.gear.arrangements import Arrangement

Access = Literal["low", "high", "loose", "held"]
"""Connection of a member: to the lower or the upper shaft, free on one of them, or fixed by the housing itself."""

PLATE_SIDES: tuple[Literal["below", "above"], ...] = ("above", "below")


class Build(NamedTuple):
    """A build of a train with one carrier.

    Attributes
    ----------
    planes : mapping of int to int
        Level of each plane of the arrangement.
    webs : mapping of str to int
        Levels of the webs of rotating rings, by body.
    carrier : int or None
        Level of the carrier's plate; None if the lower plate is the carrier.
    access : mapping of str to Access
        Connection of each member.
    low, high : int or None
        Highest level that the lower shaft reaches, and lowest level that the upper one reaches.
    highest : int
        Highest level between the plates.
    """

    planes: Mapping[int, int]
    webs: Mapping[str, int]
    carrier: int | None
    access: Mapping[str, Access]
    low: int | None
    high: int | None
    highest: int


def choose_build(arrangement: Arrangement, roles: tuple[str, str, str]) -> Build | None:
    """Return the best build of an arrangement, or None.

    Parameters
    ----------
    roles : tuple of str
        The driving, the driven and the fixed member.
    """
    ways = list(_enumerate_builds(arrangement, roles))
    return min(ways, key=lambda way: sum(way.access[body] == "loose" for body in roles[:2])) if ways else None


def _enumerate_builds(arrangement: Arrangement, roles: tuple[str, str, str]) -> Iterator[Build]:
    """Yield all builds, those in the order of the arrangement first."""
    fixed = roles[2]
    (carrier,) = set(arrangement.carriers.values())
    central = [gear for gear in arrangement.gears if gear.body not in arrangement.carriers]
    rings = [gear for gear in central if gear.internal]
    turning = [ring.body for ring in rings if ring.body != fixed]
    planes = sorted({plane for gear in arrangement.gears for plane in gear.planes})
    # The stack of planes may be built upside down.
    for order in (planes, planes[::-1]):
        for plate in (None,) if carrier == fixed else PLATE_SIDES:
            for sides in product(("above", "below"), repeat=len(turning)):
                below = [body for body, side in zip(turning, sides, strict=True) if side == "below"]
                above = [body for body, side in zip(turning, sides, strict=True) if side == "above"]
                ends = {ring.body: ring.planes[0] for ring in rings}
                # A web is next to its ring, and only the shaft passes through it.
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
                # Level at which each member connects to a shaft.
                hubs = {gear.body: webs.get(gear.body, levels[gear.planes[0]]) for gear in central}
                if at is not None:
                    hubs[carrier] = at
                if fixed in {ring.body for ring in rings}:
                    del hubs[fixed]
                yield from _enumerate_connections(hubs, roles, levels, webs, at, highest, [*arrangement.members])


def _enumerate_connections(
    hubs: Mapping[str, int],
    roles: tuple[str, str, str],
    levels: Mapping[int, int],
    webs: Mapping[str, int],
    carrier: int | None,
    highest: int,
    members: list[str],
) -> Iterator[Build]:
    """Yield all assignments of hubs to two shafts that do not overlap."""
    bodies = list(hubs)
    choices: list[tuple[Access, ...]] = [
        ("low", "high") if body == roles[2] else ("low", "high", "loose") for body in bodies
    ]
    for chosen in product(*choices):
        low = [hubs[body] for body, access in zip(bodies, chosen, strict=True) if access == "low"]
        high = [hubs[body] for body, access in zip(bodies, chosen, strict=True) if access == "high"]
        # Each shaft carries at most one keyed member.
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
                # No shaft passes through this free member.
                break
        else:
            # The two shafts would overlap.
            if top is not None and bottom is not None and top >= bottom:
                continue
            access_of: dict[str, Access] = dict.fromkeys(members, "held")
            access_of |= dict(zip(bodies, chosen, strict=True))
            yield Build(levels, webs, carrier, access_of, top, bottom, highest)
