"""Gear trains fitted to centre distances by profile shift: against a brute force, by demands, and by their proof."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

from synthesis.dispatch import solve
from synthesis.kinds.gear_train.design import GearTrainDesign, GearTrainResult
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.gear_train.verification import verify
from synthesis.registry import parse_problem
from tests.campaign import sampled
from tests.support.independent.fitted_trains import best_train, same_answer, statements
from tests.support.problems.gears import compare_trains

TEETH, MODULES = {"min": 17, "max": 100}, [1.0, 1.25, 1.5, 2.0]


def solved(**fields: Any) -> GearTrainResult:
    problem = parse_problem({"kind": "gear_train", **fields})
    result = solve(problem, lambda fraction, message: None)
    assert isinstance(problem, GearTrainProblem)
    assert isinstance(result, GearTrainResult)
    # Where a distance is open which ones suit a pair is searched, not decided.
    assert result.search.complete == (not problem.searches_distances)
    assert all(design.verification.passed for design in result.designs)
    return result


def test_pi_at_120_millimetres() -> None:
    result = solved(
        ratio="pi", max_stages=2, teeth=TEETH, reverted=True, modules=MODULES, centre_distance=120.0, tolerance=1e-5
    )
    best = result.designs[0]
    stages = [(stage.driver, stage.driven, stage.module) for stage in best.mechanism.stages]
    assert stages == [(57, 100, 1.5), (43, 77, 2.0)]
    assert best.metrics.relative_error == pytest.approx(-5.66152e-6, rel=1e-5)
    assert best.metrics.centre_distances == pytest.approx([120.0, 120.0], rel=1e-12)
    for mesh in best.metrics.meshes:
        sliding = mesh.specific_sliding
        assert sliding is not None
        assert sliding.driver == pytest.approx(sliding.driven, rel=1e-9), (
            "nothing stands in the way of balanced sliding"
        )
        assert mesh.backlash == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("number", [0, 2, 4, 5, 7, 9, 10, 12, 14])
def test_a_brute_force_finds_the_same(number: int) -> None:
    statement = statements(15, 7)[number]
    problem = parse_problem(statement)
    result = solve(problem, lambda fraction, message: None)
    assert isinstance(problem, GearTrainProblem)
    assert isinstance(result, GearTrainResult)
    assert all(design.verification.passed for design in result.designs)
    answer, best, decided = result.model_dump(), best_train(statement), not problem.searches_distances
    assert same_answer(answer, best, decided) is None
    assert same_answer(answer, best, not decided) is not None
    assert best is None or same_answer(answer, None, decided) is not None
    if best is not None:
        others = [
            {"ties": best.ties + 1},
            {"error": best.error + 1e-9},
            {"ratio": best.ratio * Fraction(10**9 + 1, 10**9)},
        ]
        for other in others[: 3 if best.ties == 1 else 2]:
            assert same_answer(answer, best._replace(**other), decided) is not None


@pytest.mark.campaign
@pytest.mark.timeout(1800)
def test_a_brute_force_finds_the_same_in_many_tasks() -> None:
    count = sampled(200)
    found = compare_trains(count, 0)
    assert found.faults == []
    assert found.some > 0.3 * count
    assert found.none > 0.2 * count


def test_each_stage_has_its_own_distance() -> None:
    result = solved(ratio="pi", max_stages=2, teeth=TEETH, modules=MODULES, centre_distance=[120.0, 100.0])
    for design in result.designs:
        assert design.metrics.centre_distances == pytest.approx([120.0, 100.0], rel=1e-12)
        assert len({(stage.driver, stage.driven) for stage in design.mechanism.stages}) == 2


def test_modules_by_stage_keep_their_meaning() -> None:
    result = solved(
        ratio="pi", max_stages=2, teeth=TEETH, module=[1.0, 2.0], centre_distance={"min": 60.0, "max": 130.0}
    )
    assert result.designs
    for design in result.designs:
        assert [stage.module for stage in design.mechanism.stages] == [1.0, 2.0]


def test_coaxial_stages_agree_on_a_distance() -> None:
    limits = {"min": 110.0, "max": 130.0}
    result = solved(ratio="pi", max_stages=2, teeth=TEETH, modules=[1.5, 2.0], reverted=True, centre_distance=limits)
    for design in result.designs:
        one, other = design.metrics.centre_distances
        assert one == pytest.approx(other, rel=1e-12)
        assert 110.0 <= one <= 130.0


def test_a_shift_lets_fewer_teeth_do() -> None:
    stated: dict[str, Any] = {"ratio": "60/11", "max_stages": 1, "teeth": {"min": 9, "max": 60}, "tolerance": 0.0}
    assert not solved(**stated, min_contact_ratio=1.2).designs, "a rack undercuts a pinion of 11 teeth"
    best = solved(**stated, shift={"min": -0.5, "max": 1.0}).designs[0]
    pinion = best.mechanism.stages[0].shift
    assert (best.mechanism.stages[0].driver, best.mechanism.stages[0].driven) == (11, 60)
    assert pinion is not None
    assert pinion.driver >= 0.356


def test_pointed_teeth_and_too_little_contact_are_refused() -> None:
    stated: dict[str, Any] = {"ratio": "3", "max_stages": 1, "teeth": {"min": 15, "max": 70}, "centre_distance": 41.0}
    plain = solved(**stated).designs
    thick = solved(**stated, min_tip_thickness=0.6).designs
    long = solved(**stated, min_contact_ratio=1.5).designs
    assert min(m.contact_ratio for d in long for m in d.metrics.meshes) >= 1.5 - 1e-9
    assert min(m.contact_ratio for d in plain for m in d.metrics.meshes) < 1.5
    tips = [t for d in thick for m in d.metrics.meshes if (t := m.tip_thickness)]
    assert min(min(tip.driver, tip.driven) for tip in tips) >= 0.6 - 1e-9
    assert solved(**stated, min_contact_ratio=2.5).designs == []


def test_nothing_fits_so_far_apart() -> None:
    result = solved(ratio="3", max_stages=1, teeth={"min": 17, "max": 60}, modules=[1.0], centre_distance=500.0)
    assert result.designs == []
    assert "no two gears form a stage" in result.summary


TWO_INTERVALS: dict[str, Any] = {
    "pressure_angle": 25.0,
    "shift": {"min": -0.35, "max": 0.72},
    "tolerance": 0.0,
}
"""With these 12:33 has sums of shifts that suit below −0.2 and above 0.2, and none between."""


@pytest.mark.parametrize("distance", [{"min": 22.0, "max": 23.24}, 22.9])
def test_distances_that_suit_may_be_two_intervals(distance: float | dict[str, float]) -> None:
    """The range that contains a distance has a train wherever that distance has one."""
    stated = {**TWO_INTERVALS, "min_contact_ratio": 1.215, "min_tip_thickness": 0.455, "reverted": True}
    result = solved(ratio="891/240", max_stages=2, stock=[12, 20, 33, 27], centre_distance=distance, **stated)
    assert {mesh for d in result.designs for s in d.mechanism.stages for mesh in [(s.driver, s.driven)]} == {
        (12, 33),
        (20, 27),
    }


def test_a_gap_of_the_distances_is_not_taken_for_them() -> None:
    """Two stages of 12:33 agree on a distance on one side of the gap; alone it has the one nearest to its circles."""
    stated = {**TWO_INTERVALS, "min_contact_ratio": 1.22, "min_tip_thickness": 0.45}
    twice = solved(ratio="121/16", max_stages=2, stock=[12, 12, 33, 33], reverted=True, **stated).designs
    once = solved(ratio="33/12", max_stages=1, stock=[12, 33], **stated).designs
    beyond = solved(
        ratio="33/12", max_stages=1, stock=[12, 33], centre_distance={"min": 22.4, "max": 24.0}, **stated
    ).designs
    assert twice[0].metrics.centre_distances == pytest.approx([22.2876] * 2, abs=1e-4)
    assert once[0].metrics.centre_distances == pytest.approx([22.2876], abs=1e-4)
    assert beyond[0].metrics.centre_distances == pytest.approx([22.7176], abs=1e-4)


@pytest.fixture(scope="module")
def at_120() -> tuple[GearTrainProblem, GearTrainDesign]:
    problem = parse_problem(
        {"kind": "gear_train", "ratio": "pi", "max_stages": 2, "teeth": TEETH, "modules": MODULES, "reverted": True}
        | {"centre_distance": 120.0}
    )
    assert isinstance(problem, GearTrainProblem)
    result = solve(problem, lambda fraction, message: None)
    assert isinstance(result, GearTrainResult)
    return problem, result.designs[0]


@pytest.mark.parametrize(
    ("place", "value", "broken"),
    [
        (("shift", "driver"), 0.7, {"centre_distance"}),
        (("shift", "driver"), -0.6, {"centre_distance", "least_shift"}),
        (("centre_distance",), 120.1, {"centre_distance"}),
        (("module",), 1.75, {"module", "centre_distance", "coaxial"}),
        (("driven",), 99, {"centre_distance", "ratio"}),
    ],
)
def test_what_is_changed_is_noticed(
    at_120: tuple[GearTrainProblem, GearTrainDesign], place: tuple[str, ...], value: float, broken: set[str]
) -> None:
    problem, design = at_120
    data = design.mechanism.model_dump()
    holder = data["stages"][0]
    for name in place[:-1]:
        holder = holder[name]
    holder[place[-1]] = value
    changed = verify(problem, type(design.mechanism).model_validate(data))
    assert changed is not None
    assert broken <= {check.name for check in changed.verification.checks if not check.passed}


def test_an_unshifted_pinion_of_few_teeth_is_noticed(at_120: tuple[GearTrainProblem, GearTrainDesign]) -> None:
    _, design = at_120
    still = {"min": 0.0, "max": 0.0}
    stated = {"kind": "gear_train", "ratio": 4, "max_stages": 1, "teeth": {"min": 12, "max": 60}, "shift": still}
    problem = parse_problem(stated)
    assert isinstance(problem, GearTrainProblem)
    data = design.mechanism.model_dump() | {"ratio": {"numerator": -4, "denominator": 1, "value": -4.0}}
    stage = {
        "driver": 12,
        "driven": 48,
        "module": 1.0,
        "shift": {"driver": 0.0, "driven": 0.0},
        "centre_distance": 30.0,
    }
    changed = verify(problem, type(design.mechanism).model_validate({**data, "stages": [stage]}))
    assert changed is not None
    failed = {check.name for check in changed.verification.checks if not check.passed}
    assert failed == {"undercut", "fillet_interference"}


@pytest.mark.parametrize(
    ("fields", "path"),
    [
        ({"modules": [1.0], "module": 1.0}, "/modules"),
        ({"modules": [1.0], "diametral_pitch": 1.0}, "/modules"),
        ({"modules": [1.0, 1.0]}, "/modules"),
        ({"centre_distance": [30.0, 40.0, 50.0]}, "/centre_distance"),
        ({"centre_distance": [30.0, 40.0], "reverted": True}, "/centre_distance"),
        ({"shift": {"min": -0.2, "max": 0.4}, "reverted": True, "teeth": {"min": 12, "max": 1500}}, "/teeth"),
    ],
)
def test_contradictions(fields: dict[str, Any], path: str) -> None:
    problem = parse_problem({"kind": "gear_train", "ratio": 3, "max_stages": 2, **fields})
    assert [fault.path for fault in problem.find_contradictions()][:1] == [path]
