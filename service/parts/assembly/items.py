"""Items of an assembly: identical parts are made once, and each item lists the parts that it represents."""

from __future__ import annotations

from collections.abc import Hashable
from typing import NamedTuple

from service.parts.assembly.model import SHEET_SORTS, Assembly, Part, simplify_name
from service.parts.geometry.regions import Disc

MATCH_DECIMALS = 6
"""Decimals of a millimetre to which identical parts agree."""


class Item(NamedTuple):
    """An item to be made or bought, with the identical parts that it represents; its files have its ``name``."""

    name: str
    parts: tuple[Part, ...]

    @property
    def part(self) -> Part:
        """A representative part."""
        return self.parts[0]

    @property
    def planes(self) -> str:
        """Planes of the parts, or the spans of planes that they occupy."""
        spans = sorted({part.planes for part in self.parts})
        return "; ".join(f"{low}" if low == high else f"{low}-{high}" for low, high in spans)


def list_items(assembly: Assembly) -> list[Item]:
    """Return the items of an assembly: plates first, then pins and the parts on them."""
    alike: dict[Hashable, list[Part]] = {}
    for part in assembly.parts:
        alike.setdefault(_make_key(part), []).append(part)
    kinds = [_name_kind(parts[0]) for parts in alike.values()]
    numbers = dict.fromkeys(kinds, 0)
    found = []
    for kind, parts in zip(kinds, alike.values(), strict=True):
        numbers[kind] += 1
        # Number the items only if several share a kind.
        name = kind if kinds.count(kind) == 1 and len(parts) > 1 else f"{kind}_{numbers[kind]}"
        found.append(Item(parts[0].name if len(parts) == 1 else name, tuple(parts)))
    order = ("base", "link", "block", "gear", "cam", "wheel", "pin", "key", "ring", "washer", "spacer")
    return sorted(found, key=lambda item: order.index(item.part.sort))


def _name_kind(part: Part) -> str:
    return f"{part.sort}_{simplify_name(part.like)}" if part.like else part.name.split("_")[0]


def _make_key(part: Part) -> Hashable:
    """Return a key that is equal for identical parts only."""
    if part.like:
        return part.sort, part.like
    if part.sort == "key":
        return (
            part.sort,
            part.standard,
            tuple(round(x, MATCH_DECIMALS) for x in (*part.length_and_width, part.high - part.low)),
        )
    # Plates are never merged by shape: each has its own name.
    if part.sort in SHEET_SORTS or not part.round:
        return part.name
    stack = []
    for body in part.bodies:
        region, low, high = body.region, body.low, body.high
        assert isinstance(region.outer, Disc)
        radii = [region.outer.radius, *(hole.radius for hole in region.holes if isinstance(hole, Disc))]
        stack.append(tuple(round(x, MATCH_DECIMALS) for x in (*radii, low - part.low, high - part.low)))
    return part.sort, part.standard, tuple(stack)
