"""All sound tooth numbers of one planet set, found by trying every combination of its independent gears.

Gears are chosen one after the other. The teeth of a second sun or ring of a planet follow from coaxiality. Every other
condition (limits, sound teeth, assembly, clearance) rejects combinations as soon as all its gears are chosen, for whole
blocks at a time. Lengths are in half modules, so that a pin's distance from the axis is an integer: s + p or r − p.

Assembly: a planet set can be assembled at the multiples of 1/M of a turn. M is the greatest common divisor of two kinds
of numbers: ±S ± R for two gears about the axis that mesh with one planet gear (or with two that mesh), and
(z₂ c₁ − z₁ c₂)/gcd(z₁, z₂) for two gears z₁, z₂ of a stepped planet, where c are the teeth of their rings or, with a
minus sign, of their suns. Equal spacing of n planets requires that n divides M.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Integers, Mask, Real
from kinematics.gear.arrangements import Arrangement
from synthesis.model.gears import mesh_limits

Block = dict[str, Integers]
"""Teeth by gear, one array each, of combinations that passed so far."""

ROUNDING_TOLERANCE = 1e-12
"""Share of half a turn within which two planets are opposite each other and cannot touch."""

MAX_BLOCK_SIZE = 1 << 17
"""Number of combinations tested at once: large enough for the arrays' overhead, small enough for the cache."""


class Demands(NamedTuple):
    """Constraints on sound tooth numbers.

    ``limits`` are the fewest and most teeth by gear, ``least_room`` is in modules, ``largest`` a pitch diameter in
    modules. ``clear_fillets`` refuses contact in fillets, and rings that their cutter trims.
    """

    limits: dict[str, tuple[int, int]]
    planets: int
    equal_spacing: bool
    pressure_angle: float
    least_contact: float
    least_room: float
    largest: float
    clear_fillets: bool


class _Rule(NamedTuple):
    reason: str
    gears: frozenset[str]
    test: Callable[[Block], Mask]


class ToothNumbers:
    """The sound tooth numbers of one planet set.

    Attributes
    ----------
    teeth : dict
        Arrays of equal length, by gear.
    size : ndarray
        Largest pitch diameter around the axis, in modules.
    combinations : int
        Number of combinations of the independent gears that were covered.
    rejected : Counter
        Number of rejected combinations by condition, the first that each one fails.
    """

    def __init__(self, arrangement: Arrangement, planets: tuple[str, ...], demands: Demands) -> None:
        self._arrangement, self._planets, self._demands = arrangement, planets, demands
        self._free = list(arrangement.list_independent_gears(planets))
        self._counts = [max(0, high - low + 1) for low, high in (demands.limits[gear] for gear in self._free)]
        self._distance = {planet: arrangement.list_central_meshes(planet)[0] for planet in planets}
        self._rules = _build_rules(self)
        self.combinations = int(np.prod(self._counts, dtype=object))
        self.rejected: Counter[str] = Counter()
        blocks = list(self._extend_block({}, 0, 1)) if self.combinations else []
        names = [
            g.name
            for g in arrangement.gears
            if g.body in planets or set(arrangement.list_mates(g.name)) & self._planet_gears
        ]
        self.teeth: Block = {
            gear: np.concatenate([block[gear] for block in blocks]) if blocks else np.zeros(0, np.int64)
            for gear in names
        }
        self.size = self._compute_size(self.teeth)

    @property
    def count(self) -> int:
        """Number of sound combinations."""
        return len(self.size)

    @property
    def _planet_gears(self) -> set[str]:
        return {gear.name for gear in self._arrangement.gears if gear.body in self._planets}

    def _extend_block(self, block: Block, step: int, rows: int) -> Iterator[Block]:
        """Yield every combination that extends a block by the next independent gear."""
        if step == len(self._free):
            yield block
            return
        gear = self._free[step]
        values = np.arange(self.combinations and self._demands.limits[gear][0], self._demands.limits[gear][1] + 1)
        # Split the rows, so that the extended block stays within MAX_BLOCK_SIZE.
        at_once = max(1, MAX_BLOCK_SIZE // len(values))
        # Rules that only involve earlier gears were applied already.
        before = frozenset(block)
        for start in range(0, rows, at_once):
            part = {name: array[start : start + at_once] for name, array in block.items()}
            count = min(at_once, rows - start)
            wide = {name: np.repeat(array, len(values)) for name, array in part.items()}
            wide[gear] = np.tile(values, count)
            wide = self._filter_block(self._close_block(wide), before, step)
            left = len(wide[gear])
            if left:
                yield from self._extend_block(wide, step + 1, left)

    def _close_block(self, block: Block) -> Block:
        """Add the suns and rings whose teeth follow from coaxiality."""
        for planet, (own, first) in self._distance.items():
            if own in block and first in block:
                for gear, mate in self._arrangement.list_central_meshes(planet)[1:]:
                    if mate not in block and gear in block:
                        distance = self.compute_distance(block, planet)
                        internal = self._arrangement.places[mate].internal
                        if self._arrangement.bevel:
                            block[mate] = distance
                        else:
                            block[mate] = distance + block[gear] if internal else distance - block[gear]
        return block

    def _filter_block(self, block: Block, before: frozenset[str], step: int) -> Block:
        """Keep the combinations of a block that pass the conditions on its new gears."""
        # Every rejected row stands for all its extensions by the gears still to be chosen.
        ways = int(np.prod(self._counts[step + 1 :], dtype=object))
        for rule in self._rules:
            if rule.gears <= block.keys() and not rule.gears <= before:
                kept = rule.test(block)
                fallen = int(kept.size - np.count_nonzero(kept))
                if fallen:
                    self.rejected[rule.reason] += fallen * ways
                    block = {name: array[kept] for name, array in block.items()}
        return block

    def compute_distance(self, block: Block, planet: str) -> Integers:
        """Return a pin's distance from the axis, half modules; a bevel differential's side gear pitch radius."""
        own, first = self._distance[planet]
        if self._arrangement.bevel:
            return block[first]
        return block[first] + (-block[own] if self._arrangement.places[first].internal else block[own])

    def _compute_size(self, block: Block) -> Integers:
        parts = [array for gear, array in block.items() if self._arrangement.places[gear].internal]
        for planet in self._planets:
            for gear in self._arrangement.gears:
                if gear.body == planet:
                    reach = self.compute_distance(block, planet)
                    parts.append(block[gear.name] if self._arrangement.bevel else reach + block[gear.name])
            if self._arrangement.bevel:
                parts.append(self.compute_distance(block, planet))
        return np.asarray(np.max(np.stack(parts), axis=0), np.int64)


def compute_divisions(arrangement: Arrangement, planets: tuple[str, ...], block: Block) -> Integers:
    """Return M of each combination: a set can be at multiples of 1/M of a turn; 0 if it can be anywhere."""
    total = np.zeros(len(next(iter(block.values()))), np.int64)
    for _, form in _build_assembly_forms(arrangement, planets):
        total = np.gcd(total, form(block))
    return total


def _build_rules(numbers: ToothNumbers) -> list[_Rule]:
    arrangement, planets, demands = numbers._arrangement, numbers._planets, numbers._demands
    rules = [*_build_limit_rules(numbers), *_build_reach_rules(numbers)]
    forms = _build_assembly_forms(arrangement, planets)
    if demands.equal_spacing:
        for gears, form in forms:
            rules.append(_Rule("assembly", gears, _test_divisible(form, demands.planets)))
    else:
        every = frozenset().union(*(gears for gears, _ in forms))
        rules.append(
            _Rule(
                "assembly",
                every,
                lambda block: _test_enough(compute_divisions(arrangement, planets, block), demands.planets),
            )
        )
    return [*rules, *_build_mesh_rules(numbers), *_build_clearance_rules(numbers)]


def _test_divisible(form: Callable[[Block], Integers], planets: int) -> Callable[[Block], Mask]:
    return lambda block: np.asarray(form(block) % planets == 0, np.bool_)


def _test_enough(total: Integers, planets: int) -> Mask:
    return np.asarray((total == 0) | (total >= planets), np.bool_)


def _build_limit_rules(numbers: ToothNumbers) -> list[_Rule]:
    arrangement, demands = numbers._arrangement, numbers._demands
    rules = []
    for planet in numbers._planets:
        (own, first), *closed = arrangement.list_central_meshes(planet)
        for _, mate in closed:
            low, high = demands.limits[mate]
            rules.append(_Rule("tooth_limits", frozenset({mate}), _test_between(mate, low, high)))
        if arrangement.places[first].internal:
            gears = frozenset({own, first})
            rules.append(_Rule("not_coaxial", gears, _test_larger(first, own)))
    return rules


def _test_between(gear: str, low: int, high: int) -> Callable[[Block], Mask]:
    return lambda block: np.asarray((block[gear] >= low) & (block[gear] <= high), np.bool_)


def _test_larger(one: str, other: str) -> Callable[[Block], Mask]:
    return lambda block: np.asarray(block[one] > block[other], np.bool_)


def _build_reach_rules(numbers: ToothNumbers) -> list[_Rule]:
    """Build the rules for size, and for planets that mesh: they must reach each other."""
    arrangement, largest = numbers._arrangement, numbers._demands.largest
    rules = []
    for planet in numbers._planets:
        for gear in arrangement.gears:
            if gear.body == planet:
                gears = frozenset({gear.name, *numbers._distance[planet]})
                factor = 0 if arrangement.bevel else 1

                def test_size(block: Block, planet: str = planet, name: str = gear.name, factor: int = factor) -> Mask:
                    reach = numbers.compute_distance(block, planet)
                    return np.asarray(np.maximum(factor * reach + block[name], reach) <= largest, np.bool_)

                rules.append(_Rule("too_large", gears, test_size))
        for _, mate in arrangement.list_central_meshes(planet):
            if arrangement.places[mate].internal:
                rules.append(_Rule("too_large", frozenset({mate}), _test_between(mate, 0, int(min(largest, 10**9)))))
    for one, other in arrangement.meshes:
        bodies = arrangement.places[one].body, arrangement.places[other].body
        if set(bodies) <= set(numbers._planets):
            gears = frozenset({one, other, *numbers._distance[bodies[0]], *numbers._distance[bodies[1]]})

            def test_reach(block: Block, pair: tuple[str, str] = (one, other), ends: tuple[str, str] = bodies) -> Mask:
                near, far = (numbers.compute_distance(block, planet) for planet in ends)
                apart = block[pair[0]] + block[pair[1]]
                # The triangle inequality of axis, pin and pin.
                return np.asarray((np.abs(near - far) <= apart) & (apart <= near + far), np.bool_)

            rules.append(_Rule("not_coaxial", gears, test_reach))
    return rules


def _build_assembly_forms(
    arrangement: Arrangement, planets: tuple[str, ...]
) -> list[tuple[frozenset[str], Callable[[Block], Integers]]]:
    """Return integers that n must divide for n planets at equal angles, with the gears on which they depend."""
    # The phase of a gear's teeth depends on the signed teeth of its mates.
    phases = _list_phases(arrangement, planets)
    forms: list[tuple[frozenset[str], Callable[[Block], Integers]]] = []
    for (sign, gear), *others in phases.values():
        for other_sign, other in others:

            def add_phases(block: Block, a: int = sign, x: str = gear, b: int = other_sign, y: str = other) -> Integers:
                return np.asarray(a * block[x] - b * block[y])

            forms.append((frozenset({gear, other}), add_phases))
    for planet in planets:
        first, *others_on = [gear.name for gear in arrangement.gears if gear.body == planet]
        for second in others_on:
            (sign, gear), (other_sign, other) = phases[first][0], phases[second][0]

            def add_stepped_phases(
                block: Block,
                own: tuple[str, str] = (first, second),
                a: int = sign,
                x: str = gear,
                b: int = other_sign,
                y: str = other,
            ) -> Integers:
                one, two = block[own[0]], block[own[1]]
                return np.asarray((two * a * block[x] - one * b * block[y]) // np.gcd(one, two))

            forms.append((frozenset({first, second, gear, other}), add_stepped_phases))
    return forms


def _list_phases(arrangement: Arrangement, planets: tuple[str, ...]) -> dict[str, list[tuple[int, str]]]:
    """Return, for each planet gear, the signed suns and rings that determine its phase at an angle.

    A gear without a sun or ring takes the phases of the planet gear that it meshes with, with the opposite sign.
    """
    own = [gear.name for gear in arrangement.gears if gear.body in planets]
    meshing: dict[str, list[tuple[int, str]]] = {gear: [] for gear in own}
    for planet in planets:
        for gear, mate in arrangement.list_central_meshes(planet):
            meshing[gear].append((arrangement.sense(gear, mate), mate))
    direct = {gear: list(phases) for gear, phases in meshing.items()}
    for one, other in arrangement.meshes:
        if one in meshing and other in meshing:
            for here, there in ((one, other), (other, one)):
                meshing[here] += [(-sign, gear) for sign, gear in direct[there]]
    return meshing


def compute_ring_addendum(planet: Real, ring: Real, angle: float, fillets: bool) -> Real:
    """Return a ring's addendum for a planet, modules: full teeth, or shortened ones that do not dig into the planet.

    ``fillets``: they also clear the planet's fillet, and the usual cutter does not trim their flanks.
    """
    addendum = mesh_limits.compute_ring_addendum(planet, ring, angle, fillets)
    return np.minimum(addendum, mesh_limits.compute_untrimmed_addendum(ring, angle)) if fillets else addendum


def _build_mesh_rules(numbers: ToothNumbers) -> list[_Rule]:
    arrangement, angle, least = (
        numbers._arrangement,
        numbers._demands.pressure_angle,
        numbers._demands.least_contact,
    )
    own, fillets = numbers._planet_gears, numbers._demands.clear_fillets
    rules = []
    for one, other in arrangement.meshes:
        if not {one, other} & own:
            continue
        ring = next((gear for gear in (one, other) if arrangement.places[gear].internal), None)
        gears = frozenset({one, other})

        def read_pair(
            block: Block, one: str = one, other: str = other, ring: str | None = ring
        ) -> tuple[bool, Real, Real]:
            if ring is not None:
                planet = one if ring == other else other
                return True, block[planet].astype(np.float64), block[ring].astype(np.float64)
            first, second = block[one].astype(np.float64), block[other].astype(np.float64)
            if arrangement.bevel:
                # Bevel teeth act like spur gears with the teeth of the back cones (Tredgold; Norton, Sec. 9.7).
                length = np.hypot(first, second)
                return False, first * length / second, second * length / first
            return False, first, second

        def test_interference(block: Block, pair: Callable[[Block], tuple[bool, Real, Real]] = read_pair) -> Mask:
            internal, first, second = pair(block)
            if internal:
                return mesh_limits.has_clear_tips(
                    first, second, compute_ring_addendum(first, second, angle, fillets), angle
                )
            return mesh_limits.has_no_external_interference(first, second, angle)

        def test_contact_ratio(block: Block, pair: Callable[[Block], tuple[bool, Real, Real]] = read_pair) -> Mask:
            internal, first, second = pair(block)
            if internal:
                short = compute_ring_addendum(first, second, angle, fillets)
                return np.asarray(
                    mesh_limits.compute_internal_contact_ratio(first, second, short, angle) >= least, np.bool_
                )
            return np.asarray(mesh_limits.compute_external_contact_ratio(first, second, angle) >= least, np.bool_)

        def test_trimming(block: Block, pair: Callable[[Block], tuple[bool, Real, Real]] = read_pair) -> Mask:
            _, planet, rim = pair(block)
            return mesh_limits.is_ring_untrimmed(rim, compute_ring_addendum(planet, rim, angle, fillets), angle)

        def test_fillets(block: Block, pair: Callable[[Block], tuple[bool, Real, Real]] = read_pair) -> Mask:
            internal, first, second = pair(block)
            if internal:
                return mesh_limits.has_clear_ring_fillet(first, second, angle)
            return mesh_limits.has_clear_external_fillets(first, second, angle)

        rules += [_Rule("interference", gears, test_interference), _Rule("contact_ratio", gears, test_contact_ratio)]
        if fillets:
            rules.append(_Rule("fillet_interference", gears, test_fillets))
            if ring is not None:
                rules.append(_Rule("ring_trimmed", gears, test_trimming))
    return rules


def _build_clearance_rules(numbers: ToothNumbers) -> list[_Rule]:
    """Build the clearance rules: copies of a planet, different planets, planets and suns or rings."""
    arrangement, demands = numbers._arrangement, numbers._demands
    own = [gear for gear in arrangement.gears if gear.body in numbers._planets]
    need = 2.0 * demands.least_room
    rules = []
    for k, gear in enumerate(own):
        for other in own[k:]:
            if not set(gear.planes) & set(other.planes):
                continue
            if demands.planets > 1 or gear.body != other.body:
                rules.append(_build_copies_rule(numbers, gear.name, other.name, need))
        for central in arrangement.gears:
            if arrangement.is_planet(central.name) or not set(gear.planes) & set(central.planes):
                continue
            if central.name in arrangement.list_mates(gear.name):
                continue

            def test_clearance(
                block: Block,
                planet: str = gear.body,
                name: str = gear.name,
                mate: str = central.name,
                internal: bool = central.internal,
            ) -> Mask:
                distance = numbers.compute_distance(block, planet)
                if internal:
                    # Tip circles: pitch radius plus an addendum of one module, which is 2 half modules.
                    room = block[mate] - 2 - (distance + block[name] + 2)
                else:
                    room = distance - block[name] - 2 - block[mate] - 2
                return np.asarray(room >= need, np.bool_)

            gears = frozenset({gear.name, central.name, *numbers._distance[gear.body]})
            rules.append(_Rule("clearance", gears, test_clearance))
    return rules


def _build_copies_rule(numbers: ToothNumbers, one: str, other: str, need: float) -> _Rule:
    arrangement, demands = numbers._arrangement, numbers._demands
    here, there = arrangement.places[one].body, arrangement.places[other].body
    count = demands.planets
    meshing = other in arrangement.list_mates(one)
    needed = {one, other, *numbers._distance[here], *numbers._distance[there]}
    if not demands.equal_spacing:
        needed |= set().union(*(gears for gears, _ in _build_assembly_forms(arrangement, numbers._planets)))
    linking = _find_link(arrangement, here, there) if here != there else None
    if linking is not None:
        needed |= set(linking)

    def test_clearance(block: Block) -> Mask:
        near, far = (numbers.compute_distance(block, planet).astype(np.float64) for planet in (here, there))
        if arrangement.bevel:
            return _test_bevel_clearance(block[one], near, count, numbers, block, need)
        ahead = np.zeros(len(near))
        if linking is not None:
            apart = (block[linking[0]] + block[linking[1]]).astype(np.float64)
            # Law of cosines: the angle at the axis between two planets that mesh.
            ahead = np.arccos(np.clip((near**2 + far**2 - apart**2) / (2.0 * near * far), -1.0, 1.0))
        tips = block[one] + block[other] + 4.0
        kept = np.ones(len(near), np.bool_)
        for turn in _list_offsets(numbers, block, here != there and not meshing):
            # Distance of the pins at this offset, again by the law of cosines.
            between = np.sqrt(np.maximum(near**2 + far**2 - 2.0 * near * far * np.cos(ahead - turn), 0.0))
            kept &= between - tips >= need
        return kept

    return _Rule("clearance", frozenset(needed), test_clearance)


def _find_link(arrangement: Arrangement, here: str, there: str) -> tuple[str, str]:
    """Return the two gears through which two planets mesh."""
    for pair in arrangement.meshes:
        if {arrangement.places[gear].body for gear in pair} == {here, there}:
            return pair
    raise ValueError(f"planets {here} and {there} of one set do not mesh with each other")


def _list_offsets(numbers: ToothNumbers, block: Block, own_copy: bool) -> Iterator[Real]:
    """Yield angles from a planet to the copies of another, radians; angle 0 only if ``own_copy``."""
    demands = numbers._demands
    count = demands.planets
    if own_copy:
        yield np.zeros(len(next(iter(block.values()))))
    if demands.equal_spacing:
        for k in range(1, count):
            yield np.full(len(next(iter(block.values()))), 2.0 * np.pi * k / count)
        return
    total = compute_divisions(numbers._arrangement, numbers._planets, block)
    total = np.where(total == 0, count, total)
    for k in range(1, count):
        # The nearest assembly position may be rounded up or down: both must be clear.
        for rounded in (k * total // count, -(-k * total // count)):
            yield 2.0 * np.pi * rounded / total


def _test_bevel_clearance(
    planet: Integers, side: Real, count: int, numbers: ToothNumbers, block: Block, need: float
) -> Mask:
    """Test the clearance of bevel planets' large ends, half modules, like
    :func:`kinematics.gear.assembly.measure_gaps`."""
    narrowest = np.min(
        np.stack([np.minimum(turn, 2.0 * np.pi - turn) for turn in _list_offsets(numbers, block, False)]), 0
    )
    half = np.where(
        narrowest < np.pi * (1.0 - ROUNDING_TOLERANCE), side * np.tan(np.minimum(0.5 * narrowest, 1.57)), np.inf
    )
    return np.asarray(2.0 * (half - planet - 2.0 * side / np.hypot(side, planet)) >= need, np.bool_)
