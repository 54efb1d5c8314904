"""Planetary trains that carry a stated power: against stresses by hand, a brute force over all teeth, and by laws."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction
from functools import cache
from typing import Any

import pytest

from kinematics.gear.arrangements import ARRANGEMENTS
from kinematics.gear.planetary import solve_speeds
from kinematics.gear.power import solve_power_flow
from synthesis.analyses import parse_request
from synthesis.dispatch import solve
from synthesis.kinds.planetary_train import power_capacity
from synthesis.kinds.planetary_train.design import PlanetaryResult
from synthesis.kinds.planetary_train.nearest import Candidate
from synthesis.kinds.planetary_train.power_capacity import compute_mesh_loads
from synthesis.kinds.planetary_train.problem import PlanetaryProblem
from synthesis.kinds.planetary_train.verification import verify
from synthesis.model.gears.planet_strength import mark_bent_both_ways
from synthesis.registry import parse_problem
from tests.campaign import further

POWER: dict[str, Any] = {
    "power_kw": 4.0,
    "speed_rpm": 1450.0,
    "allowable_bending": [200.0, 190.0],
    "allowable_contact": [800.0, 780.0],
    "max_face_width": 10.0,
}
OMEGA = POWER["speed_rpm"] * math.pi / 30.0
SIMPLE: dict[str, Any] = {
    "arrangement": "simple", "input": "sun", "output": "carrier", "fixed": "ring", "ratio": 4.5, "tolerance": 0.1,
    "teeth": {"min": 17, "max": 36, "ring_max": 100},
}  # fmt: skip


def problem_of(**stated: Any) -> PlanetaryProblem:
    problem = parse_problem({"kind": "planetary_train", **stated})
    assert isinstance(problem, PlanetaryProblem)
    assert problem.find_contradictions() == []
    return problem


def solved(**stated: Any) -> PlanetaryResult:
    result = solve(problem_of(**stated), lambda fraction, message: None)
    assert isinstance(result, PlanetaryResult)
    assert all(design.verification.passed for design in result.designs)
    assert result.search.candidates == result.search.accepted + sum(result.search.rejected.values())
    return result


def meshes(mechanism: dict[str, Any], strength: dict[str, Any], power: float = 4.0) -> list[dict[str, Any]]:
    """The meshes of a train under a power on its input, by the analysis, without losses."""
    asked = {
        "mechanism": {"type": "planetary_train", **mechanism}, "motion": {"at": 0.0, "speed": OMEGA},
        "torques": {mechanism["input"]: 1000.0 * power / OMEGA}, "mesh_efficiency": 1.0, "strength": strength,
    }  # fmt: skip
    request = parse_request(asked)
    assert request.find_errors() == []
    found: list[dict[str, Any]] = request.build_answer()["meshes"]
    return found


def made(sun: int, planet: int, planets: int, module: float = 2.0, **more: Any) -> dict[str, Any]:
    teeth = {"sun": sun, "planet": planet, "ring": sun + 2 * planet}
    members = {"input": "sun", "output": "carrier", "fixed": "ring"}
    return {"arrangement": "simple", "teeth": teeth, **members, "planets": planets, "module": module, **more}


@pytest.mark.parametrize(("planets", "sharing"), [(1, 1.0), (3, 1.0), (4, 1.2), (5, 1.3), (6, 1.4), (9, 1.4)])
def test_a_simple_set_by_hand(planets: int, sharing: float) -> None:
    """Forces from the sun's torque, speeds past the carrier, AGMA's equations with stated J, I and K's in few lines."""
    j, i, size, spread, over, elastic, width = (0.34, 0.41), 0.11, (1.1, 1.2), 1.3, 1.25, 191.0, 20.0
    factors = {
        "bending_geometry": j, "contact_geometry": i, "size": size, "load_distribution": spread, "overload": over,
        "elastic": elastic, "form": [0.3, 0.4],
    }  # fmt: skip
    stated = {"allowable_bending": [200.0, 190.0], "allowable_contact": [800.0, 780.0], "factors": factors}
    found = meshes(made(24, 42, planets, face_widths=[width]), {**stated, "quality": 8.0})
    radius = 0.024
    force = 4000.0 / OMEGA / radius / planets * sharing
    velocity = OMEGA * 108 / (24 + 108) * radius
    b = 0.25 * (12.0 - 8.0) ** (2.0 / 3.0)
    a = 50.0 + 56.0 * (1.0 - b)
    raised = force * over * ((a + math.sqrt(velocity / 0.00508)) / a) ** b * spread
    for mesh, small in zip(found, (48.0, 84.0), strict=True):
        told = mesh["strength"]
        assert told["load_sharing"] == sharing
        assert told["tangential_force"] == pytest.approx(force, rel=1e-12)
        assert told["pitch_line_velocity"] == pytest.approx(velocity, rel=1e-12)
        for place, gear in enumerate(told["gears"]):
            bent = raised * size[place] / (width * 2.0 * j[place])
            pressed = elastic * math.sqrt(raised * size[place] / (small * width * i))
            assert gear["bending_stress"] == pytest.approx(bent, rel=1e-9)
            assert gear["contact_stress"] == pytest.approx(pressed, rel=1e-9)
            both = mesh["first" if place == 0 else "second"] == "planet"
            assert gear["bending_safety"] == pytest.approx(
                (0.7 if both else 1.0) * (200.0, 190.0)[place] / bent, rel=1e-9
            )
            assert gear.get("bent_both_ways", False) == both


def test_the_planets_in_a_pair_by_itself() -> None:
    """Sun and planet are the pair of gears that turns as they do past the carrier, with a third of the torque."""
    stated = {"allowable_bending": [200.0, 190.0], "allowable_contact": [800.0, 780.0]}
    told = meshes(made(24, 42, 3, face_widths=[15.0]), stated)[0]["strength"]
    share = 108 / 132
    pair = {"type": "gear_pair", "teeth": [24, 42], "module": 2.0, "face_width": 15.0}
    lone = {"power_kw": 4.0 * share / 3.0, **stated}
    alone = parse_request({"mechanism": pair, "speed_rpm": 1450.0 * share, "strength": lone}).build_answer()["strength"]
    for one, other in zip(told["gears"], alone["gears"], strict=True):
        assert one["bending_stress"] == pytest.approx(other["bending_stress"])
        assert one["contact_stress"] == pytest.approx(other["contact_stress"])


def test_losses_raise_what_the_mesh_near_the_input_carries() -> None:
    """The driver's force: with losses the planet hands on less than the sun gives it."""
    asked: dict[str, Any] = {
        "mechanism": {"type": "planetary_train", **made(24, 42, 3)}, "motion": {"at": 0.0, "speed": -OMEGA},
        "torques": {"sun": -30.0}, "strength": {"allowable_contact": [800.0, 780.0]},
    }  # fmt: skip
    lossy, ideal = (
        [
            mesh["strength"]["tangential_force"]
            for mesh in parse_request(asked | {"mesh_efficiency": e}).build_answer()["meshes"]
        ]
        for e in (0.9, 1.0)
    )
    assert ideal == pytest.approx([30.0 / 0.024 / 3.0] * 2)
    assert lossy == pytest.approx([ideal[0], 0.9 * ideal[0]])


@cache
def faces(sun: int, planet: int, module: float) -> float | None:
    """The least face of a simple set with three planets, by its analysis; None where a mesh has none."""
    strength = {name: POWER[name] for name in ("allowable_bending", "allowable_contact", "max_face_width")}
    ring = solved_ring(sun, planet)
    found = [
        mesh["strength"].get("least_face_width") for mesh in meshes(made(sun, planet, 3, module, **ring), strength)
    ]
    return None if None in found else max(found)


def solved_ring(sun: int, planet: int) -> dict[str, Any]:
    """The addendum of the ring as a design has it."""
    gears = {"sun": {"min": sun, "max": sun}, "planet": {"min": planet, "max": planet}}
    result = solved(**{**SIMPLE, "teeth": {**SIMPLE["teeth"], "gears": gears}, "tolerance": None})
    return {"addendum": result.designs[0].mechanism.addendum}


@cache
def sound() -> list[tuple[int, int]]:
    """All simple sets of :data:`SIMPLE` by plain loops, as the problem without a power has them."""
    result = solved(**SIMPLE, max_designs=200)
    found = [(one.mechanism.teeth["sun"], one.mechanism.teeth["planet"]) for one in result.designs]
    loops = [
        (sun, planet)
        for sun, planet in itertools.product(range(17, 37), repeat=2)
        if (2 * sun + 2 * planet) % 3 == 0
        and sun + 2 * planet <= 100
        and abs(Fraction(2 * sun + 2 * planet, sun) / Fraction(9, 2) - 1) <= Fraction(1, 10)
    ]
    assert sorted(found) == sorted(loops)
    return found


MODULES = (1.5, 1.6)


def borne(size: float = math.inf) -> dict[tuple[int, int], tuple[float, float]]:
    """Least module and face of every set that carries, with the largest pitch diameter limited, by brute force."""
    found = {}
    for sun, planet in sound():
        for module in MODULES:
            face = faces(sun, planet, module) if module * (sun + 2 * planet) <= size else None
            if face is not None:
                found[sun, planet] = module, face
                break
    return found


def error(sun: int, planet: int) -> Fraction:
    return abs(Fraction(2 * sun + 2 * planet, sun) / Fraction(9, 2) - 1)


@pytest.mark.slow
@pytest.mark.parametrize("limit", further([None, 120.0], [120.0]))
def test_a_brute_force_finds_the_same(limit: float | None) -> None:
    every = borne(limit or math.inf)
    assert 1 < len(every) < len(sound())
    assert limit or len({module for module, _ in every.values()}) > 1
    result = solved(**SIMPLE, modules=[1.6, 1.5], strength=POWER, max_designs=200, max_size=limit)
    found = {(one.mechanism.teeth["sun"], one.mechanism.teeth["planet"]): one.mechanism for one in result.designs}
    assert found.keys() == every.keys()
    for gears, mechanism in found.items():
        assert mechanism.module == every[gears][0]
        assert mechanism.face_widths == pytest.approx([every[gears][1]])
    assert result.search.complete
    assert result.search.every_judged
    assert result.search.rejected["strength"] == result.search.judged - len(every)
    ranked = [(error(*gears), every[gears][0] * (gears[0] + 2 * gears[1])) for gears in found]
    assert ranked == sorted(ranked)
    assert result.ties == sum(one == ranked[0][0] for one, _ in ranked)
    front: list[tuple[float, Fraction]] = []
    for size, miss in sorted((size, miss) for miss, size in ranked):
        if not front or miss < front[-1][1]:
            front.append((size, miss))
    assert [(one.size, abs(one.ratio.exact / Fraction(9, 2) - 1)) for one in result.pareto] == front
    for one in result.pareto:
        assert (one.module, one.face_widths) == (
            found[one.teeth["sun"], one.teeth["planet"]].module,
            found[one.teeth["sun"], one.teeth["planet"]].face_widths,
        )


@pytest.mark.slow
def test_the_smallest_of_each_size_that_carries() -> None:
    every = borne()
    least: dict[float, Fraction] = {}
    for gears, (module, _) in every.items():
        size = module * (gears[0] + 2 * gears[1])
        least[size] = min(least.get(size, Fraction(1)), error(*gears))
    result = solved(**SIMPLE, modules=list(MODULES), strength=POWER, rank_by="size", max_designs=200)
    told = [(one.metrics.size, abs(one.mechanism.ratio.exact / Fraction(9, 2) - 1)) for one in result.designs]
    assert told == sorted(least.items())
    assert len(least) < len(every)


@pytest.mark.slow
@pytest.mark.parametrize("rank_by", ["error", "size"])
@pytest.mark.parametrize("modules", further([[1.5], list(MODULES)], [[1.5]]))
def test_what_is_not_judged_is_told(monkeypatch: pytest.MonkeyPatch, rank_by: str, modules: list[float]) -> None:
    """With few trains judged the answer that calls itself complete is the one of all."""
    stated = {**SIMPLE, "modules": modules, "strength": POWER, "rank_by": rank_by}
    full = {n: solved(**stated, max_designs=n).designs for n in (1, 3)}
    complete = []
    for most, n in itertools.product((3, 33), full):
        monkeypatch.setattr(power_capacity, "MAX_JUDGED", most)
        result = solved(**stated, max_designs=n)
        assert result.search.every_judged is False
        assert result.search.judged is not None
        assert result.search.judged <= most
        complete.append(result.search.complete)
        if result.search.complete:
            assert [one.mechanism for one in result.designs] == [one.mechanism for one in full[n]]
    assert True in complete
    assert False in complete


def test_more_trains_of_the_smallest_size_than_are_judged(monkeypatch: pytest.MonkeyPatch) -> None:
    """The nearest of that size are judged, and the answer does not say that there are none."""
    one_ring = {"teeth": {"min": 17, "max": 36, "gears": {"ring": {"min": 96, "max": 96}}}}
    stated = {
        **SIMPLE,
        **one_ring,
        "tolerance": 0.2,
        "module": 1.6,
        "strength": POWER,
        "rank_by": "size",
        "max_designs": 1,
    }
    full = solved(**stated)
    assert full.search.judged is not None
    assert full.search.judged > 2
    monkeypatch.setattr(power_capacity, "MAX_JUDGED", 2)
    few = solved(**stated)
    assert few.search.judged == 2
    assert few.designs[0].mechanism == full.designs[0].mechanism
    weak = solved(**{**stated, "strength": {**POWER, "power_kw": 500.0}})
    assert not weak.search.complete
    assert "Further trains were not checked" in weak.summary


@pytest.mark.slow
def test_where_none_carries_the_strongest_is_told() -> None:
    stated = {**SIMPLE, "modules": [1.0, 1.25]}
    result = solved(**stated, strength={**POWER, "power_kw": 500.0})
    assert result.designs == []
    assert result.pareto == []
    assert result.search.complete
    most = float(result.summary.split("strongest carries ")[1].split(" kW")[0])
    assert solved(**stated, strength={**POWER, "power_kw": 0.99 * most}).designs
    assert not solved(**stated, strength={**POWER, "power_kw": 1.01 * most}).designs


TEETH = {
    "simple": (24, 42, 108), "double_planet": (30, 20, 22, 90), "stepped": (24, 40, 20, 84),
    "stepped_suns": (30, 28, 26, 32), "stepped_rings": (90, 30, 28, 88), "wolfrom": (19, 20, 59, 18, 57),
    "ravigneaux": (21, 17, 18, 27, 63), "two_stage": (21, 54, 129, 40, 44, 128), "simpson": (30, 18, 66, 30, 18, 66),
}  # fmt: skip


@pytest.mark.parametrize("name", TEETH)
def test_loads_by_the_other_route(name: str) -> None:
    """Those that the search solves for in floats are those of the exact flow of power, for every choice of members."""
    arrangement = ARRANGEMENTS[name]
    teeth = dict(zip(arrangement.gear_names, TEETH[name], strict=True))
    train = arrangement.build_train(teeth)
    tried = 0
    for roles in itertools.permutations(arrangement.members, 3):
        found = solve_speeds(train, {roles[2]: 0, roles[0]: 1})
        rates = {body: rate for body, rate in found.values.items() if rate is not None}
        if found.open or found.contradiction or not rates[roles[1]]:
            continue
        flow = solve_power_flow(train, rates, roles, {roles[0]: 1})
        assert flow is not None
        candidate = Candidate(Fraction(0), 0, 0, name, roles, tuple(teeth.items()), Fraction(1))
        loads = compute_mesh_loads(arrangement, candidate, 3.0, 7.0)
        for load, mesh, equation in zip(loads, flow.meshes, train.meshes, strict=True):
            assert load.torques == pytest.approx((3.0 * mesh.first_torque, 3.0 * mesh.second_torque), abs=1e-9)
            past = rates[equation.first] - rates[equation.carrier]
            assert load.speed == pytest.approx(7.0 * float(past), abs=1e-9)
            assert past != 0, "what rolls not past its carrier would carry at rest"
        tried += 1
    assert tried


@pytest.mark.parametrize(
    ("name", "roles", "bent"),
    [
        ("simple", ("sun", "carrier", "ring"), {"planet"}),
        ("stepped", ("sun", "carrier", "ring"), set()),
        ("stepped_suns", ("carrier", "sun_1", "sun_2"), set()),
        ("double_planet", ("sun", "carrier", "ring"), {"planet_1", "planet_2"}),
        ("ravigneaux", ("sun_small", "ring", "carrier"), {"planet_short", "planet_long"}),
        ("ravigneaux", ("sun_large", "ring", "carrier"), {"planet_long"}),
        # Sun and second ring turn the planet one way, the first ring holds it: planet_1 is pressed on both flanks.
        ("wolfrom", ("sun", "ring_2", "ring_1"), {"planet_1"}),
        ("two_stage", ("sun_1", "carrier_2", "ring"), {"planet_1", "planet_2"}),
    ],
)
def test_who_is_bent_both_ways(name: str, roles: tuple[str, str, str], bent: set[str]) -> None:
    arrangement = ARRANGEMENTS[name]
    teeth = dict(zip(arrangement.gear_names, TEETH[name], strict=True))
    candidate = Candidate(Fraction(0), 0, 0, name, roles, tuple(teeth.items()), Fraction(1))
    ways = mark_bent_both_ways(arrangement, compute_mesh_loads(arrangement, candidate, 3.0, 7.0))
    found = {
        gear
        for pair, both in zip(arrangement.meshes, ways, strict=True)
        for gear, way in zip(pair, both, strict=True)
        if way
    }
    assert found == bent


@pytest.mark.slow
def test_bending_of_a_ring_is_judged_with_its_factor_only() -> None:
    stated = {"allowable_bending": [900.0, 40.0], "max_face_width": 16.0}
    free = meshes(made(24, 42, 3), stated)[1]["strength"]
    assert free["gears"][1]["bending_safety"] is None
    assert free["gears"][1]["bending_judged"] is False
    assert "least_face_width" in free
    held = meshes(made(24, 42, 3), {**stated, "factors": {"bending_geometry": [0.4, 0.5]}})[1]["strength"]
    assert "bending_judged" not in held["gears"][1]
    assert held["gears"][1]["bending_safety"] == pytest.approx(1.0)
    assert held["least_face_width"] > 2.0 * free["least_face_width"]
    sets = {**SIMPLE, "module": 1.5}
    bending = {**POWER, "allowable_contact": None}
    assert solved(**sets, strength={**bending, "allowable_bending": [400.0, 400.0]}).designs
    weak = {"allowable_bending": [400.0, 20.0], "factors": {"bending_geometry": [0.4, 0.5]}}
    assert not solved(**sets, strength={**bending, **weak}).designs


def test_a_plane_that_carries_nothing_has_no_face() -> None:
    """In a Ravigneaux train that the large sun drives, short planets and small sun turn along."""
    gears = {
        name: {"min": n, "max": n}
        for name, n in zip(ARRANGEMENTS["ravigneaux"].gear_names, TEETH["ravigneaux"], strict=True)
    }
    stated = {
        "arrangement": "ravigneaux",
        "teeth": {"gears": gears},
        "input": "sun_large",
        "output": "ring",
        "fixed": "carrier",
    }
    result = solved(**stated, ratio=-2.33, strength=POWER, module=2.0)
    design = result.designs[0]
    assert design.mechanism.face_widths is not None
    assert design.mechanism.face_widths[0] is None
    assert [mesh.strength is None for mesh in design.metrics.meshes] == [True, True, False, False]
    told = meshes(
        design.mechanism.model_dump(), {name: POWER[name] for name in ("allowable_bending", "allowable_contact")}
    )
    assert ["strength" in mesh for mesh in told] == [False, False, True, True]


@pytest.mark.slow
def test_a_face_that_is_too_narrow_is_seen() -> None:
    problem = problem_of(**SIMPLE, module=1.5, strength=POWER)
    mechanism = solve(problem, lambda fraction, message: None).designs[0].mechanism
    for share, broken in [(0.98, ["strength"]), (3.0, ["relative_face_width"])]:
        other = mechanism.model_copy(update={"face_widths": [share * mechanism.face_widths[0]]})
        assert [check.name for check in verify(problem, other).checks if not check.passed] == broken
