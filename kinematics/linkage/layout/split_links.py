"""A linkage on both sides of a base: one of its links consists of two plates on a shaft that turns in that base.

If a crank turns fully around the fixed pivot of a link whose coupler passes over both shafts, as in a Whitworth quick
return, every plane is blocked by some shaft. The link is then *divided*: one plate below a second base and one above
it, both keyed to a shaft through it. From below there are

* the base, plane 0;
* the planes *inside*, between the two bases: the lower plate, and the links joined to it;
* the second base, which bears the shaft;
* the planes above it: the upper plate, and the links joined to that.

The second base itself separates both sides. A shaft of an inside link stands on the first base or hangs from the
second, depending on which is better, and one above stands on the second; a slide on the ground is a slot in that base.
Each side is arranged in the minimum number of planes by :mod:`~kinematics.linkage.layout.planes`, for every choice of
bases.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, product
from typing import NamedTuple

from kinematics.linkage.clearance import sweep_pairs
from kinematics.linkage.layout.parts import Division, Parts, build_parts, group_joints, list_joints, name_halves
from kinematics.linkage.layout.planes import Spindle, find_reach, is_in_the_way, stack_plates
from kinematics.linkage.planar.mechanism import GROUND, Mechanism


class Meeting(NamedTuple):
    """Two parts that come too close, by their names, and an input at which they do."""

    parts: tuple[str, str]
    at: float


@dataclass(frozen=True)
class DividedLayout:
    """A linkage in planes on both sides of a base.

    Attributes
    ----------
    planes : dict of str to int
        Plane of each plate, from 1; the plates of the divided link are named by
        :func:`~kinematics.linkage.layout.parts.name_halves`.
    pins : dict of str to pair of int
        The lowest and the highest plane that each pin joins, by its joint.
    base : int
        The plane of the second base.
    clashes : list of Meeting
        Collisions that these planes do not prevent; empty if the linkage can be built.
    """

    planes: dict[str, int]
    pins: dict[str, tuple[int, int]]
    base: int
    clashes: list[Meeting]


def list_divisions(mechanism: Mechanism) -> list[Division]:
    """List the ways in which one link of a mechanism can be divided; none for a mechanism with gears.

    A link can be divided if no other link shares its fixed pivot and the links joined to it form several groups that
    are connected only through this link and the ground. Each group lies wholly on one side.
    """
    if mechanism.gears:
        return []
    taken, found = set(mechanism.links), []
    ground, pinned = list_joints(mechanism, GROUND), group_joints(mechanism)
    for link in mechanism.links:
        pivots = [place for place in pinned if place & ground and place & list_joints(mechanism, link)]
        # The names of the halves must not collide with other links.
        if link == GROUND or len(pivots) != 1 or taken & {*name_halves(link)}:
            continue
        others = [other for other in mechanism.links if other not in (GROUND, link)]
        own, (pivot,) = list_joints(mechanism, link), pivots
        if any(list_joints(mechanism, other) & pivot for other in others):
            continue
        groups = _group_links({other: _find_pinned_joints(mechanism, other, pinned) for other in others})
        joined = [
            frozenset().union(
                *(place & own for place in pinned if any(place & list_joints(mechanism, k) for k in group))
            )
            for group in groups
        ]
        if len(groups) < 2 or not all(joined):
            continue
        for inside in product((False, True), repeat=len(groups)):
            # Both sides of the base need at least one group.
            if not all(inside) and any(inside):
                lower = frozenset().union(*(joints for joints, below in zip(joined, inside, strict=True) if below))
                links = frozenset().union(*(group for group, below in zip(groups, inside, strict=True) if below))
                joint = next(name for name in mechanism.links[link] if name in pivot)
                held = pivot & own
                found.append(Division(link, joint, lower | held, (own - lower) | held, links))
    return found


def _find_pinned_joints(mechanism: Mechanism, link: str, pinned: Sequence[set[str]]) -> frozenset[str]:
    """Find all joints that share a pin with joints of a link."""
    return frozenset().union(*(place for place in pinned if place & list_joints(mechanism, link)))


def _group_links(held: dict[str, frozenset[str]]) -> list[frozenset[str]]:
    """Group links that pins connect, directly or through each other."""
    groups: list[frozenset[str]] = []
    for link in held:
        near = [group for group in groups if any(held[link] & held[other] for other in group)]
        groups = [group for group in groups if group not in near] + [frozenset({link}).union(*near)]
    return groups


def arrange_divided(
    mechanism: Mechanism,
    low: float,
    high: float,
    division: Division,
    *,
    link_width: float,
    pin_diameter: float,
    gap: float,
    slot_ends: float = 0.0,
) -> DividedLayout:
    """Lay a linkage out on both sides of a base.

    Parameters
    ----------
    mechanism : Mechanism
        A single design, of shape ().
    low, high : float
        Minimum and maximum input of the motion, radians or positions along the input slide; the mechanism can be
        assembled at all inputs between them.
    division : Division
        One of :func:`list_divisions`.
    link_width, pin_diameter, gap : float
        Length units; the pin is not wider than the link.
    slot_ends : float
        Length by which a link's slot extends beyond the travel of its joint at either end.

    Raises
    ------
    DimensionError
        For more plates on one side than can be arranged.
    """
    parts = build_parts(mechanism, link_width, pin_diameter, low, high, slot_ends, division=division)
    below = _find_lower_plates(parts, division)
    met = _find_meetings(mechanism, parts, below, low, high, gap)
    best = min(_list_choices(parts, below, met), key=lambda way: way.merit)
    names = [plate.name for plate in parts.plates] + [pin.name for pin in parts.pins]
    return DividedLayout(
        {plate.name: plane for plate, plane in zip(parts.plates, best.planes, strict=True)},
        {pin.joint: reached for pin, reached in zip(parts.pins, best.reaches, strict=True)},
        best.base,
        [Meeting((names[one], names[other]), at) for one, other, at in best.clashes],
    )


def is_buildable_divided(parts: Parts, division: Division, meeting: Sequence[tuple[int, int]]) -> bool:
    """Return whether planes exist for a divided linkage whose parts come too close in these pairs.

    The pairs are those of :func:`list_divided_pairs`.
    """
    met = [(one, other, 0.0) for one, other in meeting]
    return any(not way.clashes for way in _list_choices(parts, _find_lower_plates(parts, division), met))


def list_divided_pairs(parts: Parts, division: Division) -> list[tuple[int, int]]:
    """List all pairs of parts of a divided linkage that may collide, by their numbers: plates before pins."""
    return _list_pairs(parts, _find_lower_plates(parts, division))


def _find_lower_plates(parts: Parts, division: Division) -> set[int]:
    """Find the plates below the second base."""
    lower, _ = name_halves(division.link)
    return {n for n, plate in enumerate(parts.plates) if plate.name == lower or plate.link in division.inside}


def _list_choices(parts: Parts, below: set[int], met: _Met) -> Iterator[_SideChoice]:
    """List the arrangements for all choices of bases: shafts inside stand on the first or hang from the second."""
    free = [n for n, pin in enumerate(parts.pins) if pin.grounded and pin.plates <= below]
    for hung in product((False, True), repeat=len(free)):
        yield _SideChoice(parts, below, dict(zip(free, hung, strict=True)), met)


_Met = Sequence[tuple[int, int, float]]
"""Parts that come too close, by their numbers (plates before pins), and an input at which they do."""


def _find_meetings(mechanism: Mechanism, parts: Parts, below: set[int], low: float, high: float, gap: float) -> _Met:
    """Find plates and pins that come too close, among those that may collide."""
    pairs = _list_pairs(parts, below)
    outlines = [plate.outline for plate in parts.plates] + [pin.outline for pin in parts.pins]
    results = sweep_pairs(mechanism, outlines, pairs, low, high, gap, nearest="none")
    return [(*pair, result.at) for pair, result in zip(pairs, results, strict=True) if not result.keeps]


def _list_pairs(parts: Parts, below: set[int]) -> list[tuple[int, int]]:
    """List plates and pins that no pin joins and that may lie on one side of the base, or share a plate or base."""
    plates, pins = parts.plates, parts.pins
    count = len(plates)
    joined = {pair for pin in pins for pair in combinations(sorted(pin.plates), 2)}
    pairs = [(k, n) for k, n in combinations(range(count), 2) if (k, n) not in joined and (k in below) == (n in below)]
    pairs += [
        (k, count + n)
        for n, pin in enumerate(pins)
        for k in range(count)
        if k not in pin.plates and any((k in below) == (other in below) for other in pin.plates)
    ]
    pairs += [
        (count + n, count + m)
        for n, m in combinations(range(len(pins)), 2)
        if pins[n].plates & pins[m].plates or (pins[n].grounded and pins[m].grounded)
    ]
    return pairs


class _SideChoice:
    """Best planes of both sides for one choice of bases for the shafts inside.

    ``hung`` is true for each of these shafts that hangs from the second base.
    """

    def __init__(self, parts: Parts, below: set[int], hung: dict[int, bool], met: _Met) -> None:
        self._parts, self._hung, self._met = parts, hung, met
        self._count = len(parts.plates)
        sides = sorted(below), sorted(set(range(self._count)) - below)
        self._side = {plate: side for side, plates in enumerate(sides) for plate in plates}
        self._own = {plate: n for plates in sides for n, plate in enumerate(plates)}
        self._spindles = [[self._build_spindle(n, side) for n in range(len(parts.pins))] for side in (0, 1)]
        self._planes = [self._arrange_side(side, plates) for side, plates in enumerate(sides)]
        self.base = max(self._planes[0]) + 1
        self.planes = [
            self._planes[side][self._own[plate]] + side * self.base for plate, side in sorted(self._side.items())
        ]
        self.reaches = [self._find_reach(n) for n in range(len(parts.pins))]
        self.clashes = [pair for pair in met if not self._is_parted(*pair[:2])]

    @property
    def merit(self) -> tuple[int, int, int]:
        """Number of clashes, number of planes, and total length of the pins in planes; smaller is better."""
        return len(self.clashes), max(self.planes), sum(high - low for low, high in self.reaches)

    def _arrange_side(self, side: int, plates: Sequence[int]) -> tuple[int, ...]:
        """Find the best planes of the plates on one side of the second base."""
        pairs = [pair[:2] for pair in self._met if pair[1] < self._count]
        pairs += [pair for pin in self._parts.pins for pair in combinations(sorted(pin.plates), 2)]
        apart = [(self._own[k], self._own[n]) for k, n in pairs if self._side[k] == self._side[n] == side]
        spindles = [spindle for spindle in self._spindles[side] if spindle is not None]
        return stack_plates(len(plates), apart, spindles)

    def _build_spindle(self, number: int, side: int) -> Spindle | None:
        """Return the part of a pin on one side of the second base; None if it has no plate there."""
        pin = self._parts.pins[number]
        plates = frozenset(self._own[plate] for plate in pin.plates if self._side[plate] == side)
        if not plates:
            return None
        meets = frozenset(
            self._own[plate]
            for plate, other, _ in self._met
            if other == self._count + number and plate < self._count and self._side[plate] == side
        )
        bases = self._list_bases(number)
        return Spindle(plates, meets, below=side in bases, above=side == 0 and 1 in bases)

    def _list_bases(self, number: int) -> set[int]:
        """List the bases that hold a pin: 0 for the first, 1 for the second."""
        if not self._parts.pins[number].grounded:
            return set()
        # Shafts above the second base stand on it.
        return {0} if self._hung.get(number) is False else {1}

    def _find_reach(self, number: int) -> tuple[int, int]:
        """Return the lowest and the highest plane of a pin, counted from the first base."""
        ends = [
            side * self.base + plane
            for side in (0, 1)
            if (spindle := self._spindles[side][number]) is not None
            for plane in find_reach(self._planes[side], spindle)
        ]
        return min(ends), max(ends)

    def _is_parted(self, one: int, other: int) -> bool:
        """Return whether the arrangement separates two parts that come too close."""
        # Colliding plates of one side already lie in different planes.
        if other < self._count:
            return True
        if one >= self._count:
            n, m = one - self._count, other - self._count
            return not (
                self._parts.pins[n].plates & self._parts.pins[m].plates or self._list_bases(n) & self._list_bases(m)
            )
        side = self._side[one]
        spindle = self._spindles[side][other - self._count]
        return spindle is None or not is_in_the_way(self._planes[side], spindle, self._own[one])
