"""A finished linkage laid out in planes: what meets in its motion, which plate lies where, and what cannot be built.

Parts that come nearer to each other than the gap *meet*. Plates that meet lie in different planes, and so do plates
that a pin joins; a plate that meets a pin lies nowhere between the planes that the pin joins
(:mod:`~kinematics.linkage.layout.planes`). Where no arrangement is possible over the whole motion, the longest range
of the input over which one is possible is found: its ends are ends of ranges in which some pair keeps the gap, and
what meets in a range meets in every wider one, so that one pass over these ends finds it.

A through shaft at a fixed pivot is held by two bases and fills every plane. A plate that meets it could lie nowhere: a
stub shaft has to stand in for it, from one of the bases, whichever is better, to the farthest of its plates.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import combinations, product
from typing import NamedTuple

import numpy as np

from kinematics.errors import DimensionError
from kinematics.linkage.clearance import Part, free_ranges, swept
from kinematics.linkage.clearance.scene import Scene
from kinematics.linkage.layout.parts import Parts, parts_of
from kinematics.linkage.layout.planes import Spindle, in_the_way, reach, stacked
from kinematics.linkage.planar.mechanism import Mechanism

Interval = tuple[float, float]

FINE = 1e-4
"""How finely the ends of free ranges are found: radians, or share of the mechanism's size along an input slide."""

MOST_STEPS = 3**12
"""Steps of an arrangement, with every choice of sides for the stub shafts, at most; a free range takes some dozens."""

NEAR, CLOSER, LOOKS = 0.1, 33, 4
"""How far from a place that is known to be near the nearest is looked for, in the same units; at how many inputs, and
how often: each time an eighth as wide."""


class Clash(NamedTuple):
    """Two parts that the planes do not keep apart, by their names.

    ``distance`` is the least of their outlines near the input ``at``, where they come about as near as anywhere; less
    than nothing where they overlap, but no less than the sum of what they are widened by.
    """

    parts: tuple[str, str]
    distance: float
    at: float


@dataclass(frozen=True)
class Layout:
    """A linkage in planes.

    Attributes
    ----------
    planes : dict of str to int
        Of each plate, from 1; the base is plane 0.
    pins : dict of str to pair of int
        The lowest and the highest plane that each pin joins, by its joint; 0 is the base, and one more than there are
        planes what holds a through shaft at its other end.
    crossings : list of pairs of str
        Plates that cross, and plates that pass over pins, but for those that a pin joins.
    clashes : list of Clash
        Those of them, and of the pins of one plate, that these planes do not part.
    stub_shafts : list of str
        Joints at which a stub shaft has to stand in for a through shaft.
    free : pair of float or None
        The inputs between which nothing clashes: the whole motion where there is no clash; None where nothing can be
        built. Of a whole cycle the range may begin anywhere in it.
    """

    planes: dict[str, int]
    pins: dict[str, tuple[int, int]]
    crossings: list[tuple[str, str]]
    clashes: list[Clash]
    stub_shafts: list[str]
    free: Interval | None

    @property
    def count(self) -> int:
        """The number of planes; the least there is."""
        return max(self.planes.values())


class _Pair(NamedTuple):
    """Two parts that come too near, at the input ``near``: plates, a pin and a plate, or pins, each by its number."""

    parts: tuple[str, str]
    near: float
    plates: tuple[int, ...]
    pins: tuple[int, ...]


def laid_out(
    mechanism: Mechanism,
    low: float,
    high: float,
    *,
    link_width: float,
    pin_diameter: float,
    gap: float,
    through: bool = False,
    closed: bool = False,
    slot_ends: float = 0.0,
    addendum: float = 0.0,
    whole: bool = False,
) -> Layout:
    """Lay a linkage out in planes.

    Parameters
    ----------
    mechanism : Mechanism
        A single design, of shape ().
    low, high : float
        Least and greatest input of the motion, radians or positions along the input slide; the mechanism can be
        assembled at all between them.
    link_width, pin_diameter, gap : float
        Length units; the pin is not wider than the link.
    through : bool
        Whether shafts at fixed pivots are to pass all planes, and are held on both sides.
    closed : bool
        Whether the motion is one whole cycle, at whose ends everything stands alike.
    slot_ends : float
        How much farther than its joint goes a slot of a link reaches at either end, for a block that is longer than
        the pin in it.
    addendum : float
        How far the teeth of gears reach beyond their pitch circles.
    whole : bool
        Whether only the whole motion will do: then no free range is looked for, which takes the longest.

    Raises
    ------
    TopologyError
        For gears without shafts.
    DimensionError
        For more plates, or stub shafts among them, than can be arranged.
    """
    parts = parts_of(mechanism, link_width, pin_diameter, low, high, slot_ends, addendum)
    scene = _Scene(mechanism, parts, low, high, gap)
    found = scene.met()
    shafts = {n for n, pin in enumerate(parts.pins) if through and pin.grounded}
    stubs = {n for pair in found if pair.plates for n in pair.pins} & shafts
    builder = _Builder(parts, shafts, stubs)
    built = builder.best(found)
    unparted = built.unparted(found)
    free: Interval | None = None if unparted else (low, high)
    if unparted and not whole:

        @cache
        def buildable(meeting: tuple[int, ...]) -> bool:
            return builder.parts([found[n] for n in meeting])

        longest = _longest_free(scene.free(found, closed=closed), low, high, buildable, closed=closed)
        if longest is not None:
            free, meeting = longest
            built = builder.best([found[n] for n in meeting])
            unparted = built.unparted(found)
    return Layout(
        {plate.name: plane for plate, plane in zip(parts.plates, built.planes, strict=True)},
        {pin.joint: reach(built.planes, held) for pin, held in zip(parts.pins, built.pins, strict=True)},
        [pair.parts for pair in found if pair.plates],
        scene.clashes(unparted),
        [parts.pins[n].joint for n in sorted(stubs)],
        free,
    )


class _Built(NamedTuple):
    """Planes of the plates, and the pins as they are held."""

    planes: tuple[int, ...]
    pins: tuple[Spindle, ...]

    def unparted(self, pairs: Sequence[_Pair]) -> list[_Pair]:
        """The pairs that meet and are not kept from each other."""
        return [pair for pair in pairs if not self._parts(pair)]

    def _parts(self, pair: _Pair) -> bool:
        if len(pair.pins) == 2:
            return False
        if not pair.pins:
            return self.planes[pair.plates[0]] != self.planes[pair.plates[1]]
        return not in_the_way(self.planes, self.pins[pair.pins[0]], pair.plates[0])


class _Builder:
    """Finds the best planes for what meets; ``shafts`` are to be through, ``stubs`` those of them that cannot."""

    def __init__(self, parts: Parts, shafts: set[int], stubs: set[int]) -> None:
        self._parts = parts
        self._apart = _joined(parts)
        self._shafts, self._stubs = shafts, sorted(stubs)
        steps = 3 ** len(parts.plates) << len(stubs)
        if len(stubs) > 1 and steps > MOST_STEPS:
            raise DimensionError("stub shafts", f"fewer among {len(parts.plates)} plates", len(stubs))

    def best(self, pairs: Sequence[_Pair]) -> _Built:
        """The planes in which the fewest of these pairs are in each other's way, then the fewest planes."""

        def merit(way: _Built) -> tuple[int, int, int]:
            reaches = [reach(way.planes, pin) for pin in way.pins]
            return len(way.unparted(pairs)), max(way.planes), sum(high - low for low, high in reaches)

        return min(self._ways(pairs), key=merit)

    def parts(self, pairs: Sequence[_Pair]) -> bool:
        """Whether there are planes in which none of these pairs is in each other's way."""
        return any(not way.unparted(pairs) for way in self._ways(pairs))

    def _ways(self, pairs: Sequence[_Pair]) -> Iterator[_Built]:
        """The best planes with each choice of sides for the stub shafts."""
        apart = self._apart + [(pair.plates[0], pair.plates[1]) for pair in pairs if not pair.pins]
        meets: dict[int, set[int]] = {}
        for pair in pairs:
            if len(pair.pins) == 1:
                meets.setdefault(pair.pins[0], set()).update(pair.plates)
        for hung in product((False, True), repeat=len(self._stubs)):
            pins = tuple(
                self._held(n, frozenset(meets.get(n, ())), dict(zip(self._stubs, hung, strict=True)))
                for n in range(len(self._parts.pins))
            )
            planes = stacked(len(self._parts.plates), apart, pins, self._parts.meshes)
            yield _Built(planes, pins)

    def _held(self, number: int, meets: frozenset[int], hung: dict[int, bool]) -> Spindle:
        """A pin with the bases that hold it."""
        pin = self._parts.pins[number]
        if number in hung:
            return Spindle(pin.plates, meets, below=not hung[number], above=hung[number])
        return Spindle(pin.plates, meets, below=pin.grounded, above=number in self._shafts)


def _joined(parts: Parts) -> list[tuple[int, int]]:
    """Plates that a pin joins."""
    return sorted({pair for pin in parts.pins for pair in combinations(sorted(pin.plates), 2)})


class _Scene:
    """The parts of a mechanism in its motion, and which of them come nearer than the gap."""

    def __init__(self, mechanism: Mechanism, parts: Parts, low: float, high: float, gap: float) -> None:
        self._mechanism, self._parts = mechanism, parts
        self._outlines: list[Part] = [plate.outline for plate in parts.plates] + [pin.outline for pin in parts.pins]
        self._low, self._high, self._gap = low, high, gap

    def met(self) -> list[_Pair]:
        """All pairs that do so somewhere, but for those that belong together."""
        plates, pins = self._parts.plates, self._parts.pins
        joined = {*_joined(self._parts), *(pair for mesh in self._parts.meshes for pair in combinations(mesh, 2))}
        pairs: list[tuple[tuple[int, ...], tuple[int, ...]]] = []
        pairs += [(pair, ()) for pair in combinations(range(len(plates)), 2) if pair not in joined]
        pairs += [((k,), (n,)) for n, pin in enumerate(pins) for k in range(len(plates)) if k not in pin.plates]
        # A plate that two pins pierce keeps them in one plane; so does the base.
        pairs += [
            ((), (n, m))
            for n, m in combinations(range(len(pins)), 2)
            if pins[n].plates & pins[m].plates or (pins[n].grounded and pins[m].grounded)
        ]
        names = [plate.name for plate in plates] + [pin.name for pin in pins]
        numbers = [self._numbers(*pair) for pair in pairs]
        results = swept(self._mechanism, self._outlines, numbers, self._low, self._high, self._gap, nearest="none")
        return [
            _Pair((names[one], names[other]), result.at, *pair)
            for pair, (one, other), result in zip(pairs, numbers, results, strict=True)
            if not result.keeps
        ]

    def _numbers(self, plates: tuple[int, ...], pins: tuple[int, ...]) -> tuple[int, int]:
        one, other = (*plates, *(len(self._parts.plates) + n for n in pins))
        return one, other

    def clashes(self, pairs: Sequence[_Pair]) -> list[Clash]:
        """How near pairs come, looked for more and more closely around the places that are known."""
        if not pairs:
            return []
        scene = Scene(self._mechanism, self._outlines, [self._numbers(pair.plates, pair.pins) for pair in pairs])
        rows, none = np.repeat(np.arange(len(pairs)), CLOSER), np.zeros(len(pairs) * CLOSER)
        at, width = np.array([pair.near for pair in pairs]), NEAR * scene.unit
        for _ in range(LOOKS):
            around = at[:, None] + width * np.linspace(-1.0, 1.0, CLOSER)
            inputs = np.clip(around, self._low, self._high)
            apart = scene.distances(rows, inputs.ravel(), none)[0].reshape(inputs.shape)
            nearest = np.nanargmin(apart, axis=1)[:, None]
            at = np.take_along_axis(inputs, nearest, axis=1)[:, 0]
            width *= 4.0 / (CLOSER - 1)
        least = np.take_along_axis(apart, nearest, axis=1)[:, 0]
        return [
            Clash(pair.parts, *found) for pair, found in zip(pairs, np.stack([least, at], axis=1).tolist(), strict=True)
        ]

    def free(self, pairs: Sequence[_Pair], *, closed: bool) -> list[list[Interval]]:
        """The ranges in which each pair keeps the gap; of a cycle those of two, on end."""
        numbers = [self._numbers(pair.plates, pair.pins) for pair in pairs]
        fine = FINE * (_size(self._mechanism) if self._mechanism.driven_by_slide else 1.0)
        low, high = self._low, self._high
        ranges = free_ranges(self._mechanism, self._outlines, numbers, low, high, self._gap, fine)
        return [_on_end(own, high - low) for own in ranges] if closed else ranges


def _on_end(ranges: list[Interval], cycle: float) -> list[Interval]:
    """The ranges of two cycles, those that meet between them as one."""
    again = [(start + cycle, end + cycle) for start, end in ranges]
    if ranges and again[0][0] - ranges[-1][1] <= FINE:
        return [*ranges[:-1], (ranges[-1][0], again[0][1]), *again[1:]]
    return [*ranges, *again]


def _size(mechanism: Mechanism) -> float:
    """The greatest distance of two joints."""
    return max(abs(complex(z) - complex(w)) for z, w in combinations(mechanism.joints.values(), 2))


def _longest_free(
    ranges: Sequence[Sequence[Interval]],
    low: float,
    high: float,
    buildable: Callable[[tuple[int, ...]], bool],
    *,
    closed: bool,
) -> tuple[Interval, tuple[int, ...]] | None:
    """The longest range over which what meets can be built, and what meets in it; None where there is none.

    It begins and ends where the motion or a range of some pair does. The farthest end never moves back while the
    beginning moves on, so each is looked at once.

    Parameters
    ----------
    ranges : sequence of sequences of pairs of float
        Where each pair keeps the gap, in order; of a ``closed`` motion over two cycles.
    buildable : callable
        Whether there are planes for pairs that meet, by their numbers.
    """
    bounds = {x for own in ranges for interval in own for x in interval} | (set() if closed else {low, high})
    ends = sorted(bounds)
    best: tuple[Interval, tuple[int, ...]] | None = None
    reached = 0
    for first, begin in enumerate(ends):
        if closed and begin >= high:
            break
        farthest = begin + high - low if closed else high
        reached = max(reached, first)
        while reached + 1 < len(ends) and ends[reached + 1] <= farthest:
            if not buildable(_meeting(ranges, (begin, ends[reached + 1]))):
                break
            reached += 1
        span = begin, ends[reached]
        if span[1] > span[0] and (best is None or span[1] - span[0] > best[0][1] - best[0][0]):
            best = span, _meeting(ranges, span)
    return best


def _meeting(ranges: Sequence[Sequence[Interval]], span: Interval) -> tuple[int, ...]:
    """The pairs that do not keep the gap all over a range."""
    return tuple(
        n for n, own in enumerate(ranges) if not any(start <= span[0] and span[1] <= end for start, end in own)
    )
