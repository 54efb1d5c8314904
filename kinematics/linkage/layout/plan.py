"""A finished linkage arranged in planes: collisions in its motion, a plane for each plate, and remaining clashes.

Parts that come closer to each other than the gap *meet*. Plates that meet lie in different planes, and so do plates
joined by a pin; a plate that meets a pin must not lie between the planes that the pin joins
(:mod:`~kinematics.linkage.layout.planes`). If no arrangement is possible over the whole motion, the longest feasible
range of the input is found. It starts and ends where some pair begins or ceases to keep the gap, and a collision in a
range also occurs in every wider range, so a single pass over these ends finds it.

A through shaft at a fixed pivot rests in two bases and occupies every plane. If a plate meets it, the shaft is replaced
by a stub shaft from the better one of the bases to the farthest of its plates.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import combinations, product
from typing import NamedTuple

import numpy as np

from kinematics.errors import DimensionError
from kinematics.linkage.clearance import Part, find_free_ranges, sweep_pairs
from kinematics.linkage.clearance.scene import Scene
from kinematics.linkage.layout.parts import Parts, build_parts
from kinematics.linkage.layout.planes import Spindle, find_reach, is_in_the_way, stack_plates
from kinematics.linkage.planar.mechanism import Mechanism

Interval = tuple[float, float]

END_TOLERANCE = 1e-4
"""Accuracy of the ends of free ranges: radians, or share of the mechanism's size along an input slide."""

MAX_STEPS = 3**12
"""Maximum number of steps of an arrangement over all choices of sides for stub shafts; a free range needs some dozens
of arrangements."""

SEARCH_HALF_WIDTH, SEARCH_INPUTS, SEARCH_ROUNDS = 0.1, 33, 4
"""Search for the minimum distance near a known close position: half-width in the same units, number of inputs, and
number of rounds, each an eighth as wide as the one before."""


class Clash(NamedTuple):
    """Two parts that the planes do not separate, by their names.

    ``distance`` is the minimum distance of their outlines near the input ``at``, approximately that over the motion. It
    is negative if they overlap, but not below minus the sum of their radii.
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
        Plane of each plate, from 1; the base is plane 0.
    pins : dict of str to pair of int
        Lowest and highest plane of each pin, by its joint; 0 is the base, and the number of planes + 1 is the support
        of a through shaft at its other end.
    crossings : list of pairs of str
        Plates that cross, and plates that pass over pins, except those joined by a pin.
    clashes : list of Clash
        Crossings, and pairs of pins of one plate, that these planes do not separate.
    stub_shafts : list of str
        Joints at which a stub shaft has to replace a through shaft.
    free : pair of float or None
        Range of inputs without a clash: the whole motion if there is none; None if nothing can be built. For a whole
        cycle the range may begin anywhere.
    """

    planes: dict[str, int]
    pins: dict[str, tuple[int, int]]
    crossings: list[tuple[str, str]]
    clashes: list[Clash]
    stub_shafts: list[str]
    free: Interval | None

    @property
    def count(self) -> int:
        """Number of planes; proved to be the minimum."""
        return max(self.planes.values())


class _Pair(NamedTuple):
    """Two parts that come too close at the input ``near``: plates, a pin and a plate, or pins, each by its number."""

    parts: tuple[str, str]
    near: float
    plates: tuple[int, ...]
    pins: tuple[int, ...]


def arrange_planes(
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
        Minimum and maximum input of the motion, radians or positions along the input slide; the mechanism can be
        assembled at all inputs between them.
    link_width, pin_diameter, gap : float
        Length units; the pin is not wider than the link.
    through : bool
        Whether shafts at fixed pivots pass through all planes, held on both sides.
    closed : bool
        Whether the motion is one whole cycle, with equal configurations at both ends.
    slot_ends : float
        Length by which a link's slot extends beyond the travel of its joint at either end, for a block that is longer
        than its pin.
    addendum : float
        Height of gear teeth beyond their pitch circles.
    whole : bool
        Whether only the whole motion is acceptable. The free range, whose search takes most of the time, is then not
        searched.

    Raises
    ------
    TopologyError
        For gears without shafts.
    DimensionError
        For more plates than can be arranged, or too many stub shafts among them.
    """
    parts = build_parts(mechanism, link_width, pin_diameter, low, high, slot_ends, addendum)
    scene = _Scene(mechanism, parts, low, high, gap)
    found = scene.find_meetings()
    shafts = {n for n, pin in enumerate(parts.pins) if through and pin.grounded}
    # A through shaft that meets a plate anywhere must become a stub.
    stubs = {n for pair in found if pair.plates for n in pair.pins} & shafts
    builder = _Builder(parts, shafts, stubs)
    built = builder.find_best(found)
    unparted = built.find_unparted(found)
    free: Interval | None = None if unparted else (low, high)
    if unparted and not whole:

        @cache
        def is_buildable(meeting: tuple[int, ...]) -> bool:
            return builder.is_buildable([found[n] for n in meeting])

        longest = _find_longest_free(scene.free(found, closed=closed), low, high, is_buildable, closed=closed)
        if longest is not None:
            free, meeting = longest
            built = builder.find_best([found[n] for n in meeting])
            unparted = built.find_unparted(found)
    return Layout(
        {plate.name: plane for plate, plane in zip(parts.plates, built.planes, strict=True)},
        {pin.joint: find_reach(built.planes, held) for pin, held in zip(parts.pins, built.pins, strict=True)},
        [pair.parts for pair in found if pair.plates],
        scene.clashes(unparted),
        [parts.pins[n].joint for n in sorted(stubs)],
        free,
    )


class _Arrangement(NamedTuple):
    """Planes of the plates, and the pins with their bases."""

    planes: tuple[int, ...]
    pins: tuple[Spindle, ...]

    def find_unparted(self, pairs: Sequence[_Pair]) -> list[_Pair]:
        """Find the pairs that meet and are not separated."""
        return [pair for pair in pairs if not self._is_parted(pair)]

    def _is_parted(self, pair: _Pair) -> bool:
        # Two pins through one plate always share its plane.
        if len(pair.pins) == 2:
            return False
        if not pair.pins:
            return self.planes[pair.plates[0]] != self.planes[pair.plates[1]]
        return not is_in_the_way(self.planes, self.pins[pair.pins[0]], pair.plates[0])


class _Builder:
    """Search for the best planes; ``shafts`` should pass through all planes, and ``stubs`` are those that cannot."""

    def __init__(self, parts: Parts, shafts: set[int], stubs: set[int]) -> None:
        self._parts = parts
        self._apart = _list_joined(parts)
        self._shafts, self._stubs = shafts, sorted(stubs)
        steps = 3 ** len(parts.plates) << len(stubs)
        # Every choice of sides doubles the effort.
        if len(stubs) > 1 and steps > MAX_STEPS:
            raise DimensionError(
                "kinematics-stub-shafts", "kinematics-fewer-among-plates", len(stubs), count=len(parts.plates)
            )

    def find_best(self, pairs: Sequence[_Pair]) -> _Arrangement:
        """Find the planes with the fewest collisions among these pairs, then the fewest planes."""

        def rank_merit(way: _Arrangement) -> tuple[int, int, int]:
            reaches = [find_reach(way.planes, pin) for pin in way.pins]
            return len(way.find_unparted(pairs)), max(way.planes), sum(high - low for low, high in reaches)

        return min(self._list_arrangements(pairs), key=rank_merit)

    def is_buildable(self, pairs: Sequence[_Pair]) -> bool:
        """Return whether there are planes without a collision among these pairs."""
        return any(not way.find_unparted(pairs) for way in self._list_arrangements(pairs))

    def _list_arrangements(self, pairs: Sequence[_Pair]) -> Iterator[_Arrangement]:
        """List the best planes for each choice of sides for the stub shafts."""
        apart = self._apart + [(pair.plates[0], pair.plates[1]) for pair in pairs if not pair.pins]
        meets: dict[int, set[int]] = {}
        for pair in pairs:
            if len(pair.pins) == 1:
                meets.setdefault(pair.pins[0], set()).update(pair.plates)
        for hung in product((False, True), repeat=len(self._stubs)):
            pins = tuple(
                self._build_spindle(n, frozenset(meets.get(n, ())), dict(zip(self._stubs, hung, strict=True)))
                for n in range(len(self._parts.pins))
            )
            planes = stack_plates(len(self._parts.plates), apart, pins, self._parts.meshes)
            yield _Arrangement(planes, pins)

    def _build_spindle(self, number: int, meets: frozenset[int], hung: dict[int, bool]) -> Spindle:
        """Return a pin with the bases that hold it."""
        pin = self._parts.pins[number]
        if number in hung:
            return Spindle(pin.plates, meets, below=not hung[number], above=hung[number])
        return Spindle(pin.plates, meets, below=pin.grounded, above=number in self._shafts)


def _list_joined(parts: Parts) -> list[tuple[int, int]]:
    """List the pairs of plates that a pin joins."""
    return sorted({pair for pin in parts.pins for pair in combinations(sorted(pin.plates), 2)})


def list_separable_pairs(parts: Parts) -> list[tuple[tuple[int, ...], tuple[int, ...]]]:
    """List all pairs of parts that do not belong together: the numbers of their plates, and those of their pins."""
    plates, pins = parts.plates, parts.pins
    joined = {*_list_joined(parts), *(pair for mesh in parts.meshes for pair in combinations(mesh, 2))}
    pairs: list[tuple[tuple[int, ...], tuple[int, ...]]] = []
    pairs += [(pair, ()) for pair in combinations(range(len(plates)), 2) if pair not in joined]
    pairs += [((k,), (n,)) for n, pin in enumerate(pins) for k in range(len(plates)) if k not in pin.plates]
    # Two pins through the same plate, or on the base, share a plane there and cannot be separated.
    pairs += [
        ((), (n, m))
        for n, m in combinations(range(len(pins)), 2)
        if pins[n].plates & pins[m].plates or (pins[n].grounded and pins[m].grounded)
    ]
    return pairs


def is_buildable_in_planes(
    parts: Parts, meeting: Sequence[tuple[tuple[int, ...], tuple[int, ...]]], *, through: bool
) -> bool:
    """Return whether planes exist for parts of which these pairs of :func:`list_separable_pairs` come too close."""
    shafts = {n for n, pin in enumerate(parts.pins) if through and pin.grounded}
    stubs = {n for plates, pins in meeting if plates for n in pins} & shafts
    # Names and inputs only matter for reports.
    pairs = [_Pair(("", ""), 0.0, plates, pins) for plates, pins in meeting]
    return _Builder(parts, shafts, stubs).is_buildable(pairs)


class _Scene:
    """Parts of a mechanism in motion, and the pairs that come closer than the gap."""

    def __init__(self, mechanism: Mechanism, parts: Parts, low: float, high: float, gap: float) -> None:
        self._mechanism, self._parts = mechanism, parts
        self._outlines: list[Part] = [plate.outline for plate in parts.plates] + [pin.outline for pin in parts.pins]
        self._low, self._high, self._gap = low, high, gap

    def find_meetings(self) -> list[_Pair]:
        """Find all pairs that come too close somewhere, except those that belong together."""
        plates, pins = self._parts.plates, self._parts.pins
        pairs = list_separable_pairs(self._parts)
        names = [plate.name for plate in plates] + [pin.name for pin in pins]
        numbers = [self._get_numbers(*pair) for pair in pairs]
        results = sweep_pairs(
            self._mechanism, self._outlines, numbers, self._low, self._high, self._gap, nearest="none"
        )
        return [
            _Pair((names[one], names[other]), result.at, *pair)
            for pair, (one, other), result in zip(pairs, numbers, results, strict=True)
            if not result.keeps
        ]

    def _get_numbers(self, plates: tuple[int, ...], pins: tuple[int, ...]) -> tuple[int, int]:
        one, other = (*plates, *(len(self._parts.plates) + n for n in pins))
        return one, other

    def clashes(self, pairs: Sequence[_Pair]) -> list[Clash]:
        """Measure the minimum distance of pairs by an ever finer search around their known close positions."""
        if not pairs:
            return []
        scene = Scene(self._mechanism, self._outlines, [self._get_numbers(pair.plates, pair.pins) for pair in pairs])
        rows, none = np.repeat(np.arange(len(pairs)), SEARCH_INPUTS), np.zeros(len(pairs) * SEARCH_INPUTS)
        at, width = np.array([pair.near for pair in pairs]), SEARCH_HALF_WIDTH * scene.unit
        for _ in range(SEARCH_ROUNDS):
            around = at[:, None] + width * np.linspace(-1.0, 1.0, SEARCH_INPUTS)
            inputs = np.clip(around, self._low, self._high)
            apart = scene.distances(rows, inputs.ravel(), none)[0].reshape(inputs.shape)
            # NaN marks inputs without a position.
            nearest = np.nanargmin(apart, axis=1)[:, None]
            at = np.take_along_axis(inputs, nearest, axis=1)[:, 0]
            width *= 4.0 / (SEARCH_INPUTS - 1)
        least = np.take_along_axis(apart, nearest, axis=1)[:, 0]
        return [
            Clash(pair.parts, *found) for pair, found in zip(pairs, np.stack([least, at], axis=1).tolist(), strict=True)
        ]

    def free(self, pairs: Sequence[_Pair], *, closed: bool) -> list[list[Interval]]:
        """Find the ranges in which each pair keeps the gap; for a cycle over two consecutive cycles."""
        numbers = [self._get_numbers(pair.plates, pair.pins) for pair in pairs]
        fine = END_TOLERANCE * (_measure_size(self._mechanism) if self._mechanism.has_slide_input else 1.0)
        low, high = self._low, self._high
        ranges = find_free_ranges(self._mechanism, self._outlines, numbers, low, high, self._gap, fine)
        return [_join_cycles(own, high - low) for own in ranges] if closed else ranges


def _join_cycles(ranges: list[Interval], cycle: float) -> list[Interval]:
    """Return the ranges of two consecutive cycles, joining those that meet at the boundary."""
    again = [(start + cycle, end + cycle) for start, end in ranges]
    if ranges and again[0][0] - ranges[-1][1] <= END_TOLERANCE:
        return [*ranges[:-1], (ranges[-1][0], again[0][1]), *again[1:]]
    return [*ranges, *again]


def _measure_size(mechanism: Mechanism) -> float:
    """Measure the largest distance of two joints."""
    return max(abs(complex(z) - complex(w)) for z, w in combinations(mechanism.joints.values(), 2))


def _find_longest_free(
    ranges: Sequence[Sequence[Interval]],
    low: float,
    high: float,
    buildable: Callable[[tuple[int, ...]], bool],
    *,
    closed: bool,
) -> tuple[Interval, tuple[int, ...]] | None:
    """Find the longest buildable range, and the pairs that meet in it; None if there is none.

    It begins and ends where the motion or a free range of some pair does. As the start moves forward, the farthest
    feasible end never moves back, so each end is examined once.

    Parameters
    ----------
    ranges : sequence of sequences of pairs of float
        Ranges in which each pair keeps the gap, ascending; for a ``closed`` motion over two cycles.
    buildable : callable
        Whether an arrangement exists for a set of pairs that meet, by their numbers.
    """
    bounds = {x for own in ranges for interval in own for x in interval} | (set() if closed else {low, high})
    ends = sorted(bounds)
    best: tuple[Interval, tuple[int, ...]] | None = None
    reached = 0
    for first, begin in enumerate(ends):
        # Starts in the second cycle repeat those of the first.
        if closed and begin >= high:
            break
        farthest = begin + high - low if closed else high
        reached = max(reached, first)
        while reached + 1 < len(ends) and ends[reached + 1] <= farthest:
            if not buildable(_list_meeting(ranges, (begin, ends[reached + 1]))):
                break
            reached += 1
        span = begin, ends[reached]
        if span[1] > span[0] and (best is None or span[1] - span[0] > best[0][1] - best[0][0]):
            best = span, _list_meeting(ranges, span)
    return best


def _list_meeting(ranges: Sequence[Sequence[Interval]], span: Interval) -> tuple[int, ...]:
    """List the pairs that do not keep the gap throughout a range."""
    return tuple(
        n for n, own in enumerate(ranges) if not any(start <= span[0] and span[1] <= end for start, end in own)
    )
