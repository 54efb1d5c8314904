"""Planetary trains for a ratio: published optima, plain loops over all teeth, planted trains, impossible demands."""

from __future__ import annotations

import itertools
import math
import random
from fractions import Fraction
from functools import cache
from typing import Any, get_args

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from kinematics.gear.arrangements import ARRANGEMENTS, Arrangement
from kinematics.gear.assembly import has_fit_at, is_coaxial, measure_gaps
from kinematics.gear.cut_space import measure_tip_depth
from kinematics.gear.planetary import compute_speed_ratio
from kinematics.gear.teeth import Gear, Mesh
from synthesis.dispatch import solve
from synthesis.kinds.planetary_train.design import PlanetaryMechanism, PlanetaryResult, PlanetPlaces
from synthesis.kinds.planetary_train.problem import PlanetaryProblem
from synthesis.kinds.planetary_train.ratio_form import derive_arrangement_form, evaluate_exactly
from synthesis.kinds.planetary_train.tooth_numbers import compute_ring_addendum
from synthesis.kinds.planetary_train.verification import compute_exact_ratio, compute_size, verify
from synthesis.model.gears import mesh_limits
from synthesis.model.gears.answer import Ratio, is_fillet_reached, shape_ring
from synthesis.registry import parse_problem
from tests.cases import Case, cases


def problem_of(**stated: Any) -> PlanetaryProblem:
    problem = parse_problem({"kind": "planetary_train", **stated})
    assert isinstance(problem, PlanetaryProblem)
    return problem


def answer(**stated: Any) -> PlanetaryResult:
    result = solve(problem_of(**stated), lambda fraction, message: None)
    assert isinstance(result, PlanetaryResult)
    assert result.search.complete
    assert result.search.candidates == result.search.accepted + sum(result.search.rejected.values())
    assert all(design.verification.passed for design in result.designs)
    return result


def sound_count(result: PlanetaryResult) -> int:
    return result.search.accepted + result.search.rejected.get("outranked", 0)


@pytest.mark.parametrize("case", cases("planetary", "gear"))
def test_best_simple_sets(case: Case) -> None:
    stated = case.inputs
    result = answer(
        ratio=stated["ratio"],
        arrangement="simple",
        planets=stated["n"],
        input=stated["inp"],
        output=stated["out"],
        teeth={"min": 17, "max": 300, "ring_max": 300, "gears": {"sun": {"min": 17, "max": 120}}},
    )
    best = result.designs[0]
    case.check(rel_error=abs(best.metrics.error), feasible=sound_count(result), **best.mechanism.teeth)


@pytest.mark.parametrize("case", cases("stepped", "gear"))
def test_best_stepped_sets(case: Case) -> None:
    stated = case.inputs
    result = answer(
        ratio=stated["ratio"],
        arrangement="stepped",
        planets=stated["n"],
        input=stated["inp"],
        output=stated["out"],
        teeth={"min": 17, "max": 45, "ring_max": 130},
    )
    best = result.designs[0]
    teeth = {name.replace("planet_", "p"): count for name, count in best.mechanism.teeth.items()}
    case.check(rel_error=abs(best.metrics.error), feasible=sound_count(result), **teeth)


def test_the_statement_names_every_arrangement() -> None:
    named = get_args(PlanetaryProblem.model_fields["arrangement"].annotation)
    assert set(named) == {"auto", *ARRANGEMENTS}


@pytest.mark.parametrize("name", ARRANGEMENTS)
def test_ratio_forms_agree_with_the_speed_equations(name: str) -> None:
    """Two routes to a ratio: expanded determinants, and elimination with numbers."""
    arrangement = ARRANGEMENTS[name]
    for k, roles in enumerate(itertools.permutations(arrangement.members, 3)):
        form = derive_arrangement_form(name, *roles)
        for seed in range(3):
            teeth = {gear: 11 + (7 * j * j + 5 * k + 13 * seed) % 47 for j, gear in enumerate(arrangement.gear_names)}
            over, under = evaluate_exactly(form.over, teeth), evaluate_exactly(form.under, teeth)
            found = compute_speed_ratio(arrangement.build_train(teeth), roles[0], roles[1], [roles[2]])
            assert found == (Fraction(over, under) if over and under else None)


def sound(arrangement: Arrangement, teeth: dict[str, int], planets: int) -> bool:
    """The conditions by the analysis core, one train at a time."""
    if not is_coaxial(arrangement, teeth):
        return False
    turns = [Fraction(k, planets) for k in range(planets)]
    every = dict.fromkeys(arrangement.carriers, turns)
    if min((gap.room for gap in measure_gaps(arrangement, teeth, every)), default=1.0) < 1e-9:
        return False
    for members in arrangement.planet_sets:
        if not all(has_fit_at(arrangement, teeth, members, turn) for turn in turns):
            return False
    return all(sound_mesh(arrangement, teeth, one, other) for one, other in arrangement.meshes)


def sound_mesh(arrangement: Arrangement, teeth: dict[str, int], one: str, other: str) -> bool:
    if arrangement.places[one].internal:
        one, other = other, one
    counts: list[float] = [teeth[one], teeth[other]]
    if arrangement.bevel:
        counts = [z * math.hypot(*counts) / mate for z, mate in zip(counts, counts[::-1], strict=True)]
    return sound_pair(counts[0], counts[1], arrangement.places[other].internal)


@cache
def sound_pair(one: float, other: float, internal: bool) -> bool:
    """A full-depth mesh, its ring shortened to where it just does not interfere."""
    mesh = Mesh(Gear(one, 1.0), Gear(other, 1.0, internal=internal))
    if internal:
        addendum = min(1.0, mesh.gear.pitch_radius - mesh.gear_tip_limit - 2e-6)
        mesh = Mesh(mesh.pinion, Gear(other, 1.0, addendum=addendum, internal=True))
    return not mesh.interferes and mesh.contact_ratio >= 1.2


SMALL: list[tuple[str, dict[str, tuple[int, int]], int, str, tuple[str, str, str]]] = [
    ("simple", {"sun": (12, 30), "planet": (12, 20), "ring": (40, 66)}, 3, "4.3", ("sun", "carrier", "ring")),
    ("simple", {"sun": (12, 30), "planet": (12, 20), "ring": (40, 66)}, 4, "-pi", ("sun", "ring", "carrier")),
    (
        "double_planet",
        {"sun": (20, 26), "planet_1": (14, 17), "planet_2": (14, 17), "ring": (60, 66)},
        3,
        "-1.7",
        ("sun", "carrier", "ring"),
    ),
    (
        "stepped",
        {"sun": (17, 24), "planet_1": (24, 32), "planet_2": (17, 22), "ring": (60, 80)},
        3,
        "5.9",
        ("sun", "carrier", "ring"),
    ),
    (
        "stepped_suns",
        {"sun_1": (24, 30), "planet_1": (17, 22), "planet_2": (17, 22), "sun_2": (24, 30)},
        2,
        "50",
        ("carrier", "sun_2", "sun_1"),
    ),
    (
        "stepped_rings",
        {"ring_1": (50, 56), "planet_1": (17, 26), "planet_2": (17, 24), "ring_2": (44, 60)},
        3,
        "-20",
        ("carrier", "ring_2", "ring_1"),
    ),
    (
        "wolfrom",
        {"sun": (17, 23), "planet_1": (18, 21), "ring_1": (53, 65), "planet_2": (17, 21), "ring_2": (52, 65)},
        3,
        "60",
        ("sun", "ring_2", "ring_1"),
    ),
    (
        "ravigneaux",
        {
            "sun_small": (20, 26),
            "planet_short": (14, 18),
            "planet_long": (17, 19),
            "sun_large": (30, 36),
            "ring": (64, 74),
        },
        3,
        "2.7",
        ("sun_small", "ring", "carrier"),
    ),
    (
        "bevel_differential",
        {"side_1": (16, 24), "planet": (12, 16), "side_2": (16, 24)},
        4,
        "2",
        ("side_1", "carrier", "side_2"),
    ),
]


@pytest.mark.campaign
@pytest.mark.parametrize(("name", "ranges", "planets", "ratio", "roles"), SMALL)
def test_against_plain_loops_over_all_teeth(
    name: str, ranges: dict[str, tuple[int, int]], planets: int, ratio: str, roles: tuple[str, str, str]
) -> None:
    arrangement = ARRANGEMENTS[name]
    limits = {gear: {"min": low, "max": high} for gear, (low, high) in ranges.items()}
    result = answer(
        ratio=ratio,
        arrangement=name,
        planets=planets,
        input=roles[0],
        output=roles[1],
        fixed=roles[2],
        teeth={"gears": limits},
        max_designs=20,
    )
    target = problem_of(ratio=ratio).target
    fitting = [teeth for teeth in loops(arrangement, ranges) if sound(arrangement, teeth, planets)]
    assert sound_count(result) == len(fitting)
    scored = []
    for teeth in fitting:
        found = compute_speed_ratio(arrangement.build_train(teeth), roles[0], roles[1], [roles[2]])
        if found is not None and found * target > 0:
            size = compute_size(mechanism_of(name, teeth, planets, roles))
            scored.append((abs(found / target - 1), size, sum(teeth.values())))
    scored.sort()
    expected = [(float(error), size, total) for error, size, total in scored[:20]]
    assert [(abs(d.metrics.error), d.metrics.size, d.metrics.total_teeth) for d in result.designs] == [
        (pytest.approx(error, abs=1e-15), size, total) for error, size, total in expected
    ]
    assert result.ties == sum(error == scored[0][0] for error, _, _ in scored)
    front: list[tuple[float, float]] = []
    for error, size, _ in sorted(scored, key=lambda row: (row[1], row[0])):
        if not front or error < front[-1][0]:
            front.append((error, size))
    assert [(abs(t.error), t.size) for t in result.pareto] == [(pytest.approx(float(e)), s) for e, s in front]


def loops(arrangement: Arrangement, ranges: dict[str, tuple[int, int]]) -> list[dict[str, int]]:
    """All teeth within the ranges that are coaxial."""
    found = []
    names = list(ranges)
    for counts in itertools.product(*(range(low, high + 1) for low, high in ranges.values())):
        teeth = dict(zip(names, counts, strict=True))
        if is_coaxial(arrangement, teeth):
            found.append(teeth)
    return found


def mechanism_of(name: str, teeth: dict[str, int], planets: int, roles: tuple[str, str, str]) -> PlanetaryMechanism:
    arrangement = ARRANGEMENTS[name]
    found = compute_speed_ratio(arrangement.build_train(teeth), roles[0], roles[1], [roles[2]]) or Fraction(1)
    return PlanetaryMechanism(
        arrangement=name,
        teeth={gear: teeth[gear] for gear in arrangement.gear_names},
        planets=planets,
        places={p: PlanetPlaces(divisions=planets, steps=list(range(planets))) for p in arrangement.carriers},
        module=1.0,
        pressure_angle=20.0,
        addendum=dict.fromkeys(teeth, 1.0),
        input=roles[0],
        output=roles[1],
        fixed=roles[2],
        ratio=Ratio(numerator=found.numerator, denominator=found.denominator, value=float(found)),
    )


@pytest.mark.campaign
@pytest.mark.parametrize(
    ("name", "roles", "ratio"),
    [
        ("two_stage", ("sun_1", "carrier_2", "ring"), 17.3),
        ("two_stage", ("sun_1", "ring", "carrier_2"), -9.1),
        ("simpson", ("ring_1", "carrier_1", "carrier_2"), 2.45),
        ("simpson", ("sun", "ring_1", "carrier_2"), -2.2),
    ],
)
def test_coupled_sets_against_plain_loops(name: str, roles: tuple[str, str, str], ratio: float) -> None:
    arrangement = ARRANGEMENTS[name]
    simple = [
        (s, p, s + 2 * p) for s in range(17, 31) for p in range(17, 33) if (2 * s + 2 * p) % 3 == 0 and s + 2 * p <= 75
    ]
    result = answer(
        ratio=ratio,
        arrangement=name,
        input=roles[0],
        output=roles[1],
        fixed=roles[2],
        teeth={"max": 32, "ring_max": 75, "gears": {f"sun_{k}": {"min": 17, "max": 30} for k in (1, 2)}},
        max_designs=30,
    )
    scored = []
    for one, other in itertools.product(simple, simple):
        teeth = dict(zip(arrangement.gear_names, (*one, *other), strict=True))
        form = derive_arrangement_form(name, *roles)
        over, under = evaluate_exactly(form.over, teeth), evaluate_exactly(form.under, teeth)
        if over and under and Fraction(over, under) * problem_of(ratio=ratio).target > 0:
            error = abs(Fraction(over, under) / problem_of(ratio=ratio).target - 1)
            scored.append((error, max(one[2], other[2]), sum(one) + sum(other)))
    scored.sort()
    assert sound_count(result) == len(simple) ** 2
    assert [(d.metrics.size, d.metrics.total_teeth) for d in result.designs] == [row[1:] for row in scored[:30]]
    assert [abs(d.metrics.error) for d in result.designs] == [pytest.approx(float(row[0])) for row in scored[:30]]
    assert result.ties == sum(row[0] == scored[0][0] for row in scored)
    front: list[tuple[Fraction, int]] = []
    for error, size, _ in sorted(scored, key=lambda row: (row[1], row[0])):
        if not front or error < front[-1][0]:
            front.append((error, size))
    assert [(abs(t.error), t.size) for t in result.pareto] == [(pytest.approx(float(e)), s) for e, s in front]


@pytest.mark.campaign
@settings(max_examples=12, deadline=None, suppress_health_check=[HealthCheck.filter_too_much])
@given(st.sampled_from(["simple", "stepped", "stepped_suns", "stepped_rings", "wolfrom"]), st.data())
def test_planted_trains_are_found_again(name: str, data: st.DataObject) -> None:
    arrangement = ARRANGEMENTS[name]
    roles = data.draw(st.permutations(arrangement.members))[:3]
    teeth = {gear: data.draw(st.integers(18, 34)) for gear in arrangement.gear_names}
    for planet in arrangement.carriers:
        (own, first), *others = arrangement.list_central_meshes(planet)
        if arrangement.places[first].internal:
            teeth[first] = teeth[own] + 60
            apart = 60
        else:
            apart = teeth[first] + teeth[own]
        for gear, mate in others:
            teeth[mate] = apart + teeth[gear] if arrangement.places[mate].internal else apart - teeth[gear]
    if any(count < 12 for count in teeth.values()) or not sound(arrangement, teeth, 1):
        return
    ratio = compute_speed_ratio(arrangement.build_train(teeth), roles[0], roles[1], [roles[2]])
    if ratio is None:
        return
    limits = {gear: {"min": max(4, count - 2), "max": count + 2} for gear, count in teeth.items()}
    result = answer(
        ratio=f"{ratio.numerator}/{ratio.denominator}",
        arrangement=name,
        planets=1,
        input=roles[0],
        output=roles[1],
        fixed=roles[2],
        teeth={"gears": limits},
        max_designs=40,
    )
    assert result.designs[0].metrics.error == 0.0
    assert teeth in [design.mechanism.teeth for design in result.designs] or result.ties > 40


@pytest.mark.slow
def test_auto_compares_arrangements_and_members() -> None:
    result = answer(ratio=-2.5, teeth={"min": 17, "max": 30, "ring_max": 90}, max_designs=50)
    assert result.designs[0].metrics.error == 0.0
    assert len({design.mechanism.arrangement for design in result.designs}) > 1
    one = answer(ratio=-2.5, arrangement="simple", teeth={"min": 17, "max": 30, "ring_max": 90})
    assert abs(one.designs[0].metrics.error) >= abs(result.designs[0].metrics.error)


def test_ranking_by_size_gives_the_smallest_within_the_tolerance() -> None:
    stated: dict[str, Any] = {"ratio": 4.2, "arrangement": "simple", "input": "sun", "output": "carrier"}
    by_size = answer(**stated, rank_by="size", tolerance=0.01, max_designs=200)
    sizes = [design.metrics.size for design in by_size.designs]
    assert sizes == sorted(set(sizes))
    assert all(abs(design.metrics.error) <= 0.01 for design in by_size.designs)
    by_error = answer(**stated, tolerance=0.01, max_designs=200)
    assert sizes[0] == min(design.metrics.size for design in by_error.designs)


def test_places_nearest_to_equal_spacing() -> None:
    """40/20/80 with seven planets cannot stand equally; 1/120 turns apart they can, and are checked there."""
    teeth = {"gears": {g: {"min": z, "max": z} for g, z in (("sun", 40), ("planet", 20), ("ring", 80))}}
    stated: dict[str, Any] = {"ratio": 3, "arrangement": "simple", "input": "sun", "output": "carrier", "teeth": teeth}
    assert not answer(**stated, planets=7).designs
    assert not answer(**stated, planets=9, spacing="nearest").designs
    found = answer(**stated, planets=7, spacing="nearest").designs[0].mechanism
    assert found.places["planet"].divisions == 120
    assert found.places["planet"].steps == [0, 17, 34, 51, 69, 86, 103]


@pytest.mark.parametrize(
    ("stated", "words"),
    [
        ({"ratio": -3, "input": "sun", "output": "carrier", "fixed": "ring"}, "opposite direction"),
        ({"ratio": 25, "tolerance": 0.01, "input": "sun", "output": "carrier"}, "nearest ratio"),
        ({"ratio": 3, "planets": 12, "teeth": {"min": 17, "max": 19}}, "No train keeps the limits"),
        ({"ratio": 3, "teeth": {"min": 17, "max": 20, "ring_max": 20}}, "tooth limits"),
        ({"ratio": 3, "max_size": 20.0}, "too large"),
        ({"ratio": 3, "min_clearance": 1000.0}, "clearance"),
        (
            {"ratio": 3, "arrangement": "simpson", "input": "sun", "output": "carrier_1", "fixed": "carrier_2"},
            "does not affect the ratio",
        ),
    ],
)
def test_impossible_demands_are_proven(stated: dict[str, Any], words: str) -> None:
    result = answer(**{"arrangement": "simple"} | stated)
    assert not result.designs
    assert result.search.accepted == 0
    assert words in result.summary


@pytest.mark.parametrize(
    ("stated", "path"),
    [
        ({"input": "moon"}, "/input"),
        ({"input": "sun", "output": "sun"}, "/output"),
        ({"arrangement": "simple", "input": "sun_1"}, "/input"),
        ({"input": "sun_1", "output": "ring_2"}, "/input"),
        ({"teeth": {"min": 30, "max": 20}}, "/teeth/max"),
        ({"teeth": {"gears": {"moon": {"min": 17, "max": 20}}}}, "/teeth/gears/moon"),
        ({"teeth": {"gears": {"sun": {"min": 30, "max": 20}}}}, "/teeth/gears/sun/max"),
        ({"rank_by": "size"}, "/tolerance"),
        ({"arrangement": "ravigneaux", "teeth": {"max": 600, "ring_max": 1000}}, "/teeth"),
    ],
)
def test_contradictions_name_their_field(stated: dict[str, Any], path: str) -> None:
    assert [found.path for found in problem_of(ratio=3, **stated).find_contradictions()] == [path]


def test_broken_trains_do_not_pass() -> None:
    """Each check fails for a train that breaks what it stands for, and for that alone where it can."""
    stated: dict[str, Any] = {
        "ratio": 5,
        "arrangement": "simple",
        "input": "sun",
        "output": "carrier",
        "tolerance": 0.01,
    }
    problem = problem_of(**stated)
    good = answer(**stated).designs[0].mechanism

    def failing(demands: PlanetaryProblem = problem, **changed: Any) -> set[str]:
        return {check.name for check in verify(demands, good.model_copy(update=changed)).checks if not check.passed}

    assert failing() == set()
    sun, planet, ring = good.teeth.values()
    assert "coaxial" in failing(teeth={"sun": sun, "planet": planet, "ring": ring + 1})
    assert failing(ratio=Ratio(numerator=501, denominator=100, value=5.01)) == {"ratio"}
    assert failing(fixed="sun", input="ring") == {"ratio"}
    assert failing(places={"planet": PlanetPlaces(divisions=7, steps=[0, 2, 5])}) == {"assembly"}
    assert failing(places={"planet": PlanetPlaces(divisions=3, steps=[0, 1, 4])}) >= {"assembly", "clearance"}
    assert failing(module=2.0) == {"tooth_limits"}
    assert failing(problem_of(**stated, min_clearance=500.0)) == {"clearance"}
    assert failing(problem_of(**stated, min_contact_ratio=1.9)) == {"contact_ratio"}
    assert failing(problem_of(**stated, max_size=10.0)) == {"size"}
    tight = problem_of(**stated | {"tolerance": 0.0, "ratio": 5.001})
    assert failing(tight) == {"ratio"}
    thin = {"sun": 17, "planet": 17, "ring": 51}
    assert {"interference", "ratio"} <= failing(teeth=thin, addendum=dict.fromkeys(thin, 1.0))
    assert "interference" in failing(teeth={"sun": 8, "planet": 40, "ring": 88}, addendum=dict.fromkeys(thin, 1.0))
    full = {"sun": 1.0, "planet": 1.0, "ring": 1.0}
    assert failing(problem_of(**stated, fillets="refuse"), addendum=full) == {"fillet_interference"}
    assert compute_exact_ratio(good) == Fraction(good.ratio.numerator, good.ratio.denominator)


def test_pairs_that_the_search_takes_are_those_whose_tips_run_free() -> None:
    """The masks of the search against the geometry of each mesh and against its tools."""
    drawn = random.Random(62)
    taken = 0
    for _ in range(120):
        angle = math.radians(drawn.choice([14.0, 17.5, 20.0, 25.0, 30.0]))
        planet = drawn.randint(8, 90)
        ring = planet + drawn.randint(5, 90)
        one, two = np.array([float(planet)]), np.array([float(ring)])
        addendum = compute_ring_addendum(one, two, angle, True)
        free = mesh_limits.has_clear_tips(one, two, addendum, angle) & mesh_limits.has_clear_ring_fillet(
            one, two, angle
        )
        free &= mesh_limits.is_ring_untrimmed(two, addendum, angle)
        rim = Gear(ring, 1.0, angle, round(float(addendum[0]), 6), internal=True)
        mesh = Mesh(Gear(planet, 1.0, angle), rim)
        shaped = shape_ring(mesh)
        sound = not (mesh.interferes or is_fillet_reached(mesh) or shaped.is_trimmed)
        assert sound == bool(free[0])
        if sound:
            assert measure_tip_depth(mesh, shaped.cutter_teeth) < 1e-6
        taken += sound
    assert 20 < taken < 110


def test_self_locking_and_wasteful_trains_are_told() -> None:
    """A Ferguson train driven at its slow end does not move."""
    slow = answer(
        ratio="1/100", arrangement="stepped_suns", input="sun_2", output="carrier", fixed="sun_1",
        planets=1, teeth={"min": 40, "max": 60}, mesh_efficiency=0.98,
    ).designs[0].metrics  # fmt: skip
    assert slow.self_locking
    assert slow.efficiency == 0.0


WOLFROM: dict[str, Any] = {
    "ratio": 20,
    "arrangement": "wolfrom",
    "teeth": {"min": 17, "max": 40, "ring_max": 90},
    "tolerance": 0.02,
}


@pytest.fixture(scope="module")
def every() -> PlanetaryResult:
    """All trains within the tolerance."""
    result = answer(**WOLFROM, max_designs=100)
    assert len(result.designs) == 49
    return result


class TestEfficiency:
    """Compared with the efficiencies of all 49 trains within the tolerance, listed without regard to them."""

    def test_the_order_is_that_of_all_trains(self, every: PlanetaryResult) -> None:
        efficiencies = sorted((design.metrics.efficiency for design in every.designs), reverse=True)
        found = answer(**WOLFROM, rank_by="efficiency", max_designs=10)
        assert [design.metrics.efficiency for design in found.designs] == efficiencies[:10]
        # The nearest trains, in the default order, are not the most efficient ones.
        assert every.designs[0].metrics.efficiency < efficiencies[9]
        assert found.search.judged == 49
        assert found.search.every_judged

    def test_a_limit_keeps_the_order(self, every: PlanetaryResult) -> None:
        enough = [design.mechanism for design in every.designs if design.metrics.efficiency >= 0.92]
        found = answer(**WOLFROM, min_efficiency=0.92, max_designs=100)
        assert [design.mechanism for design in found.designs] == enough
        assert found.search.rejected["efficiency"] == 49 - len(enough)
        for design in found.designs:
            check = next(check for check in design.verification.checks if check.name == "efficiency")
            assert check.value == design.metrics.efficiency

    def test_by_size_each_size_has_its_nearest_train(self, every: PlanetaryResult) -> None:
        best: dict[float, tuple[float, PlanetaryMechanism]] = {}
        for design in every.designs:
            if design.metrics.efficiency >= 0.92:
                best.setdefault(design.metrics.size, (abs(design.metrics.error), design.mechanism))
        found = answer(**WOLFROM, min_efficiency=0.92, rank_by="size", max_designs=100)
        assert [design.mechanism for design in found.designs] == [best[size][1] for size in sorted(best)]

    def test_an_impossible_efficiency_names_the_greatest(self, every: PlanetaryResult) -> None:
        greatest = max(design.metrics.efficiency for design in every.designs)
        found = answer(**WOLFROM, min_efficiency=0.999)
        assert found.designs == []
        assert f"the greatest is {greatest:.4g}" in found.summary

    def test_a_broken_train_does_not_pass(self, every: PlanetaryResult) -> None:
        mechanism = every.designs[0].mechanism
        failures = verify(problem_of(**WOLFROM, min_efficiency=0.93), mechanism).failures
        assert [check.name for check in failures] == ["efficiency"]


def test_the_diameter_of_rings_is_limited(every: PlanetaryResult) -> None:
    small = [
        design.mechanism
        for design in every.designs
        if max(design.mechanism.teeth[ring] for ring in ("ring_1", "ring_2")) * 0.5 <= 36.0
    ]
    found = answer(**WOLFROM, module=0.5, max_ring_diameter=36.0, max_designs=100)
    assert [design.mechanism.teeth for design in found.designs] == [mechanism.teeth for mechanism in small]
    failures = verify(problem_of(**WOLFROM, max_ring_diameter=70.0), every.designs[0].mechanism).failures
    assert {check.name for check in failures} == {"ring_diameter", "tooth_limits"}
