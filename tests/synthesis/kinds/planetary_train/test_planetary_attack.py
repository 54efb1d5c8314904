"""Random coupled planetary trains against brute force with formulas of its own: Wolfrom, two-stage, Simpson.

Every speed is c + k u: the carrier's, and a multiple of the speed u at which the planets turn past it; the multiples
are written down by hand. Planets fit where some whole number of their teeth makes them mesh with all their mates.
"""

from __future__ import annotations

import itertools
import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from synthesis.dispatch import solve
from synthesis.kinds.planetary_train.problem import PlanetaryProblem
from synthesis.registry import parse_problem

Speed = tuple[Fraction, Fraction]
"""Shares of c and u."""

ANGLE = math.radians(20.0)

MEMBERS = {
    "wolfrom": ("sun", "ring_1", "ring_2", "carrier"),
    "two_stage": ("sun_1", "ring", "carrier_1", "carrier_2"),
    "simpson": ("sun", "ring_1", "carrier_1", "carrier_2"),
}


def plus(speed: Speed, factor: Fraction, share: Speed) -> Speed:
    return speed[0] + factor * share[0], speed[1] + factor * share[1]


def speeds(name: str, z: dict[str, int]) -> dict[str, Speed]:
    """Of all members, by the carrier's speed c and the planets' u of one set; S u_s = −P u, R u_r = P u past it."""
    c, u = (Fraction(1), Fraction(0)), (Fraction(0), Fraction(1))
    if name == "wolfrom":
        return {
            "carrier": c,
            "sun": plus(c, Fraction(-z["planet_1"], z["sun"]), u),
            "ring_1": plus(c, Fraction(z["planet_1"], z["ring_1"]), u),
            "ring_2": plus(c, Fraction(z["planet_2"], z["ring_2"]), u),
        }
    sun_2 = plus(c, Fraction(-z["planet_2"], z["sun_2"]), u)
    ring_2 = plus(c, Fraction(z["planet_2"], z["ring_2"]), u)
    if name == "two_stage":
        # The second sun is on the first carrier, the rings are one: S (s − c₁) = −R (r − c₁).
        first = sun_2
        past = plus(ring_2, Fraction(-1), first)
        return {
            "carrier_2": c,
            "carrier_1": first,
            "ring": ring_2,
            "sun_1": plus(first, Fraction(-z["ring_1"], z["sun_1"]), past),
        }
    # Simpson: one sun, and the second ring is on the first carrier: R (r − c₁) = −S (s − c₁).
    past = plus(sun_2, Fraction(-1), ring_2)
    return {
        "carrier_2": c,
        "carrier_1": ring_2,
        "sun": sun_2,
        "ring_1": plus(ring_2, Fraction(-z["sun_1"], z["ring_1"]), past),
    }


def ratio_of(name: str, z: dict[str, int], roles: tuple[str, str, str]) -> Fraction | None:
    """Input over output speed with the third member held; None where one of both stands or anything turns."""
    of = speeds(name, z)
    held = of[roles[2]]
    if held == (0, 0):
        return None
    # c and u in proportion so that the held member stands.
    c, u = -held[1], held[0]
    given, taken = (of[role][0] * c + of[role][1] * u for role in roles[:2])
    return given / taken if given and taken else None


def both_sets_matter(name: str, roles: tuple[str, str, str]) -> bool:
    """Whether the ratio hangs on both sets; what one does alone is a simpler arrangement and no answer here."""
    if name == "wolfrom":
        return True
    names = ("sun_1", "planet_1", "ring_1", "sun_2", "planet_2", "ring_2")
    one, other = (20, 22, 64), (23, 31, 85)
    found = [
        ratio_of(name, dict(zip(names, teeth, strict=True)), roles)
        for teeth in ((*one, *one), (*other, *one), (*one, *other))
    ]
    return found[1] != found[0] != found[2]


def fits(planets: int, sun: int | None, own: list[tuple[int, int]]) -> bool:
    """Whether copies at equal angles mesh: ``own`` has the teeth of each planet gear and of its ring, the sun's first.

    A copy t turns on, itself turned by q: P q = (S + P) t and P q = (P − R) t but for whole teeth.
    """
    for k in range(1, planets):
        t = Fraction(k, planets)
        first, ring = own[0]
        if not any(
            (sun is None or (first * q - (sun + first) * t).denominator == 1)
            and all((p * q - (p - r) * t).denominator == 1 for p, r in own)
            for q in (((first - ring) * t + whole) / first for whole in range(first))
        ):
            return False
    return True


def external(one: int, other: int) -> bool:
    """No interference, and a contact ratio of 1.2; half modules along the line of action."""
    reach = [math.sqrt((z + 2) ** 2 - (z * math.cos(ANGLE)) ** 2) for z in (one, other)]
    whole = (one + other) * math.sin(ANGLE)
    return max(reach) <= whole and sum(reach) - whole >= 1.2 * 2.0 * math.pi * math.cos(ANGLE)


def internal(planet: int, ring: int) -> bool:
    """A ring that is shortened where it must be has a contact ratio of 1.2 left.

    Rings here have so many teeth more than their planets that tips never meet outside the line of action.
    """
    assert ring - planet > 12
    along = (ring - planet) * math.sin(ANGLE)
    tip = max(ring - 2.0, math.hypot(ring * math.cos(ANGLE), along))
    own = math.sqrt((planet + 2) ** 2 - (planet * math.cos(ANGLE)) ** 2)
    inner = math.sqrt(tip**2 - (ring * math.cos(ANGLE)) ** 2)
    # The shortening in whole steps of a millionth is beside the point unless the ratio is 1.2 to that.
    return own - inner + along >= 1.2 * 2.0 * math.pi * math.cos(ANGLE)


def roomy(planets: int, apart: int, planet: int) -> bool:
    """Tips of neighbouring planets pass each other; centres stand ``apart`` half modules from the axis."""
    return 2.0 * apart * math.sin(math.pi / planets) - 2.0 * (planet + 2) > 1e-8


def simple_sets(sun: tuple[int, int], planet: tuple[int, int], planets: int) -> list[tuple[int, int, int]]:
    """Sound simple sets: sun, planet, ring."""
    return [
        (s, p, s + 2 * p)
        for s, p in itertools.product(range(sun[0], sun[1] + 1), range(planet[0], planet[1] + 1))
        if fits(planets, s, [(p, s + 2 * p)])
        and external(s, p)
        and internal(p, s + 2 * p)
        and (planets == 1 or roomy(planets, s + p, p))
    ]


def every_train(name: str, limits: dict[str, tuple[int, int]], planets: int) -> list[dict[str, int]]:
    if name != "wolfrom":
        sets = [simple_sets(limits[f"sun_{k}"], limits[f"planet_{k}"], planets) for k in (1, 2)]
        names = ("sun_1", "planet_1", "ring_1", "sun_2", "planet_2", "ring_2")
        return [dict(zip(names, (*one, *other), strict=True)) for one, other in itertools.product(*sets)]
    found = []
    for s, p, r in simple_sets(limits["sun"], limits["planet_1"], planets):
        for q in range(limits["planet_2"][0], limits["planet_2"][1] + 1):
            ring = s + p + q
            if (
                fits(planets, s, [(p, r), (q, ring)])
                and internal(q, ring)
                and (planets == 1 or roomy(planets, s + p, q))
            ):
                found.append({"sun": s, "planet_1": p, "ring_1": r, "planet_2": q, "ring_2": ring})
    return found


def random_statement(name: str, rng: np.random.Generator) -> dict[str, Any]:
    def limits() -> dict[str, int]:
        low = int(rng.integers(17, 24))
        return {"min": low, "max": low + int(rng.integers(4, 12))}

    gears = ("sun", "planet_1", "planet_2") if name == "wolfrom" else ("sun_1", "planet_1", "sun_2", "planet_2")
    one, two, three = (str(member) for member in rng.permutation(MEMBERS[name])[:3])
    ranges, planets = {gear: limits() for gear in gears}, int(rng.integers(1, 5))
    ratio = float(rng.choice([-1, 1]) * math.exp(rng.uniform(0.0, 4.0 if name == "wolfrom" else 3.0)))
    trains = every_train(name, {gear: (own["min"], own["max"]) for gear, own in ranges.items()}, planets)
    if trains and rng.random() < 0.7:
        # Near the ratio of one of them.
        planted = ratio_of(name, trains[rng.integers(len(trains))], (one, two, three))
        if planted is not None and 1e-3 < abs(planted) < 1e4:
            ratio = float(planted) * float(rng.uniform(0.95, 1.05))
    return {
        "kind": "planetary_train",
        "ratio": f"{ratio:.6f}",
        "arrangement": name,
        "planets": planets,
        "input": one,
        "output": two,
        "fixed": three,
        "teeth": {"min": 17, "max": 60, "ring_max": 200, "gears": ranges},
        "tolerance": float(rng.choice([0.3, 0.05])) if rng.random() < 0.5 else None,
        "max_designs": 15,
    }


def check(stated: dict[str, Any]) -> bool:
    """Compare one statement; whether it has an answer."""
    problem = parse_problem(stated)
    assert isinstance(problem, PlanetaryProblem)
    result: Any = solve(problem, lambda fraction, message: None)
    assert result.search.complete
    name, roles = stated["arrangement"], (stated["input"], stated["output"], stated["fixed"])
    limits = {gear: (own["min"], own["max"]) for gear, own in stated["teeth"]["gears"].items()}
    target = Fraction(stated["ratio"])
    errors = []
    for z in every_train(name, limits, stated["planets"]) if both_sets_matter(name, roles) else ():
        found = ratio_of(name, z, roles)
        if found is not None and found * target > 0:
            errors.append(abs(found / target - 1))
    errors.sort()
    limit = None if stated["tolerance"] is None else Fraction(str(stated["tolerance"]))
    within = [error for error in errors if limit is None or error <= limit]
    own = [abs(design.metrics.error) for design in result.designs]
    assert own == [pytest.approx(float(error), abs=1e-14) for error in within[:15]], stated
    assert not errors or result.ties == sum(error == errors[0] for error in errors), stated
    return bool(own)


@pytest.mark.campaign
@pytest.mark.parametrize("name", MEMBERS)
def test_random_coupled_trains(name: str) -> None:
    rng = np.random.default_rng(list(MEMBERS).index(name))
    answered = sum(check(random_statement(name, rng)) for _ in range(10))
    assert answered > 2


@pytest.mark.parametrize(
    ("name", "roles"),
    [("simpson", ("sun", "carrier_1", "ring_1")), ("two_stage", ("carrier_2", "ring", "carrier_1"))],
)
def test_what_one_set_does_alone_is_no_coupled_train(name: str, roles: tuple[str, str, str]) -> None:
    """The determinants have a factor of the other set in both; it cancels."""
    assert not both_sets_matter(name, roles)
    stated = dict(zip(("input", "output", "fixed"), roles, strict=True))
    problem = parse_problem({"kind": "planetary_train", "ratio": 4.1, "arrangement": name, **stated})
    result: Any = solve(problem, lambda fraction, message: None)
    assert result.designs == []
    assert "does not affect the ratio" in result.summary
