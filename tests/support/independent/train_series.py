"""Trains in series by a brute force: every train of every unit, and every choice of one from each.

Nothing of the solver is used. A planetary unit is one sun, one ring and planets between them, or stepped planets; its
ratio comes from the formula of Willis written out by hand for each choice of members, its room and its assembly from
their definitions: all planets are put in one after the other, tooth by tooth. A unit of ordinary gears is a loop over
two or four tooth numbers.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from fractions import Fraction
from random import Random
from typing import Any, NamedTuple

Statement = dict[str, Any]

TIGHT = 1e-9
"""Room that is none, in half modules, and rounding."""


class Unit(NamedTuple):
    """A train of a unit: its ratio, the teeth of all gears, and what tells it from others."""

    ratio: Fraction
    total: int
    gears: tuple[Any, ...]


class Best(NamedTuple):
    """The nearest series: the least error, how many have it, the fewest teeth of these; and the number of all."""

    error: Fraction | None
    ties: int
    total: int | None
    combinations: int


def simple_trains(unit: Statement) -> Iterator[Unit]:
    """The trains of a simple planetary unit with standard teeth."""
    teeth, planets = unit["teeth"], unit["planets"]
    low, high, most = teeth["min"], teeth["max"], teeth["ring_max"]
    for sun in range(low, high + 1):
        for planet in range(low, high + 1):
            ring = sun + 2 * planet
            if not low <= ring <= most or not assembled(sun, planet, ring, planets):
                continue
            # Tips of neighbouring planets, half modules.
            apart = (sun + planet) * 2.0 * math.sin(math.pi / planets) if planets > 1 else math.inf
            if apart - (2 * planet + 4) < TIGHT or not _meshes_suit(sun, planet, ring):
                continue
            for members in itertools.permutations(("sun", "ring", "carrier")):
                stated = (unit.get("input"), unit.get("output"), unit.get("fixed"))
                if any(want not in (None, got) for want, got in zip(stated, members, strict=True)):
                    continue
                ratio = willis(sun, ring, members)
                yield Unit(ratio, sun + planet + ring, (*members, sun, planet, ring))


def willis(sun: int, ring: int, members: tuple[str, str, str]) -> Fraction:
    """Input over output speed of a simple train: N_s ω_s + N_r ω_r = (N_s + N_r) ω_c (Willis 1841)."""
    weight = {"sun": Fraction(sun), "ring": Fraction(ring), "carrier": Fraction(-sun - ring)}
    driving, driven, _ = members
    return -weight[driven] / weight[driving]


def assembled(sun: int, planet: int, ring: int, planets: int) -> bool:
    """Whether equally spaced planets can be put in: a tooth of each fits sun and ring at its place.

    Going round by a turn 1/n on a planet that rolls on the ring, held, moves the sun by the tooth pitches that are
    whole numbers where the planet's teeth come to stand in the spaces of the sun.
    """
    for k in range(1, planets):
        turned = Fraction(k, planets)
        # Pitches by which the planet at this place stands off the first one, seen from the ring and from the sun.
        by_ring = turned * ring
        by_sun = -turned * sun
        if (by_ring - by_sun).denominator != 1:
            return False
    return True


def _meshes_suit(sun: int, planet: int, ring: int) -> bool:
    """No interference and enough contact of full-depth teeth at 20°: from the coordinates of the line of action."""
    phi = math.radians(20.0)

    def reach(teeth: int, addendum: float) -> float:
        """How far the contact goes along the line of action from the foot of the base circle, in half modules."""
        outside, base = teeth + 2.0 * addendum, teeth * math.cos(phi)
        return math.sqrt(outside**2 - base**2) if outside > base else -1.0

    foot = {teeth: teeth * math.sin(phi) for teeth in (sun, planet, ring)}
    line = foot[sun] + foot[planet]
    if reach(sun, 1.0) > line + TIGHT or reach(planet, 1.0) > line + TIGHT:
        return False
    pitch = 2.0 * math.pi * math.cos(phi)
    return (reach(sun, 1.0) + reach(planet, 1.0) - line) / pitch >= 1.2


def ordinary_trains(unit: Statement) -> Iterator[Unit]:
    """The trains of a unit of ordinary gears: sets of drivers and of driven gears, each once."""
    low, high = unit["teeth"]["min"], unit["teeth"]["max"]
    numbers = range(low, high + 1)
    for stages in range(1, unit.get("max_stages", 1) + 1):
        for drivers in itertools.combinations_with_replacement(numbers, stages):
            for driven in itertools.combinations_with_replacement(numbers, stages):
                if not any(_allowed(unit, drivers, order) for order in set(itertools.permutations(driven))):
                    continue
                ratio = Fraction(math.prod(driven), math.prod(drivers)) * (-1) ** stages
                if unit.get("direction", "any") != "any":
                    ratio = abs(ratio) * (1 if unit["direction"] == "same" else -1)
                yield Unit(ratio, sum(drivers) + sum(driven), (drivers, driven))


def _allowed(unit: Statement, drivers: tuple[int, ...], driven: tuple[int, ...]) -> bool:
    pairs = list(zip(drivers, driven, strict=True))
    widest = unit.get("max_stage_ratio")
    if widest is not None and any(Fraction(max(pair), min(pair)) > Fraction(str(widest)) for pair in pairs):
        return False
    if unit.get("hunting_tooth") == "require" and any(math.gcd(*pair) > 1 for pair in pairs):
        return False
    total = unit.get("max_total_teeth")
    return total is None or sum(drivers) + sum(driven) <= total


def trains(unit: Statement) -> list[Unit]:
    """All trains of a unit."""
    listed = simple_trains(unit) if unit["type"] == "planetary_train" else ordinary_trains(unit)
    return list(listed)


def best_series(statement: Statement) -> Best:
    """The nearest series of a statement, by going through all of them.

    Series of units that are stated alike are the same if they have the same trains in any order.
    """
    target = Fraction(str(statement["ratio"]))
    units = statement["units"]
    listed = {str(unit): trains(unit) for unit in units}
    alike = [next(k for k, other in enumerate(units) if other == unit) for unit in units]
    sizes = {one.ratio: float(one.ratio) for every in listed.values() for one in every}
    least: Fraction | None = None
    ties, fewest, count = 0, None, 0
    for places in itertools.product(*(range(len(listed[str(unit)])) for unit in units)):
        if any(places[a] < places[b] for a, b in _same(alike)):
            continue
        count += 1
        chosen = [listed[str(unit)][place] for unit, place in zip(units, places, strict=True)]
        # What is clearly worse than the best so far needs no fractions.
        if least is not None:
            near = math.prod(sizes[one.ratio] for one in chosen) / float(target)
            if abs(near - 1.0) > (1.0 + TIGHT) * float(least) + TIGHT:
                continue
        ratio = math.prod(one.ratio for one in chosen)
        if ratio * target <= 0:
            continue
        error = abs(ratio / target - 1)
        if "tolerance" in statement and error > Fraction(str(statement["tolerance"])):
            continue
        total = sum(one.total for one in chosen)
        if least is None or error < least:
            least, ties, fewest = error, 1, total
        elif error == least:
            ties, fewest = ties + 1, min(fewest or total, total)
    return Best(least, ties, fewest, count)


def _same(alike: list[int]) -> list[tuple[int, int]]:
    """Neighbouring units that are stated alike."""
    return [
        (max(k for k in range(later) if alike[k] == first), later)
        for later, first in enumerate(alike)
        if any(alike[k] == first for k in range(later))
    ]


def statements(count: int, rng: Random) -> Iterator[Statement]:
    """Random statements of two or three units whose series a loop can go through."""
    for _ in range(count):
        kind = rng.choice(["two sets", "two alike", "set and gears", "gears and set", "three"])
        units = {
            "two sets": lambda: [drawn_set(rng, 30), drawn_set(rng, 30)],
            "two alike": lambda: [drawn_set(rng, 30)] * 2,
            "set and gears": lambda: [drawn_set(rng, 26), drawn_gears(rng, 2)],
            "gears and set": lambda: [drawn_gears(rng, 1), drawn_set(rng, 32)],
            "three": lambda: [drawn_set(rng, 22), *[drawn_gears(rng, 1)] * 2],
        }[kind]()
        sign = rng.choice([1, 1, -1])
        statement: Statement = {
            "kind": "train_series",
            "ratio": sign * round(math.exp(rng.uniform(0.0, 4.5)), rng.randint(0, 2)) or 3.0,
            "units": units,
            "max_designs": rng.randint(1, 12),
        }
        if rng.random() < 0.5:
            statement["tolerance"] = rng.choice([0.0, 1e-4, 1e-3, 1e-2])
        yield statement


def drawn_set(rng: Random, high: int) -> Statement:
    """A simple planetary unit, its members stated or not."""
    unit: Statement = {
        "type": "planetary_train",
        "arrangement": "simple",
        "planets": rng.choice([1, 2, 3, 3, 4]),
        "teeth": {"min": 17, "max": high, "ring_max": rng.choice([70, 80, 90])},
    }
    if rng.random() < 0.6:
        members = rng.sample(["sun", "ring", "carrier"], 3)
        unit |= dict(zip(("input", "output", "fixed"), members, strict=True))
    return unit


def drawn_gears(rng: Random, stages: int) -> Statement:
    """A unit of ordinary gears."""
    low = rng.randint(14, 20)
    unit: Statement = {"type": "gear_train", "teeth": {"min": low, "max": low + (16 if stages == 1 else 5)}}
    if stages > 1:
        unit["max_stages"] = stages
    if rng.random() < 0.3:
        unit["max_stage_ratio"] = rng.choice([1.2, 1.5])
    if rng.random() < 0.3:
        unit["hunting_tooth"] = "require"
    if rng.random() < 0.2:
        unit["max_total_teeth"] = stages * (2 * low + 12)
    return unit
