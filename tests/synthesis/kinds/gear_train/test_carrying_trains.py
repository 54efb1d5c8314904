"""Gear trains that carry a stated power: against a brute force over pairs that are judged one by one, and by laws."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np
import pytest

from kinematics.gear.train import TrainStage
from synthesis.analyses import parse_request
from synthesis.dispatch import solve
from synthesis.kinds.gear_train.design import GearTrainResult
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.gear_train.verification import verify
from synthesis.model.gears.strength import CarriedPower, LoadedPair, StressCalculator, build_stage_contact
from synthesis.registry import parse_problem

POWER: dict[str, Any] = {
    "power_kw": 1.5,
    "speed_rpm": 1450.0,
    "allowable_bending": [200.0, 180.0],
    "allowable_contact": [700.0, 650.0],
    "max_face_width": 12.0,
}
FEW: dict[str, Any] = {"ratio": "5/4", "max_stages": 2, "teeth": {"min": 18, "max": 20}, "tolerance": 0.3}


def solved(**fields: Any) -> GearTrainResult:
    problem = parse_problem({"kind": "gear_train", **fields})
    assert problem.find_contradictions() == []
    result = solve(problem, lambda fraction, message: None)
    assert isinstance(result, GearTrainResult)
    assert all(design.verification.passed for design in result.designs)
    return result


@cache
def narrowest(driver: int, driven: int, module: float, speed: float) -> float | None:
    """The least face of a pair that stands alone, by the analysis of pairs."""
    stated = {name: POWER[name] for name in POWER if name != "speed_rpm"}
    pair = {"type": "gear_pair", "teeth": [driver, driven], "module": module}
    request = parse_request({"mechanism": pair, "speed_rpm": speed, "strength": stated})
    width = request.build_answer()["strength"].get("least_face_width")
    return None if width is None else float(width)


def carrying() -> dict[tuple[tuple[int, ...], ...], bool]:
    """Every train of :data:`FEW`, by its drivers and driven gears, and whether an arrangement of it carries."""
    numbers = range(18, 21)
    meshes = list(itertools.product(numbers, numbers))
    found: dict[tuple[tuple[int, ...], ...], bool] = {}
    for stages in [*((mesh,) for mesh in meshes), *itertools.product(meshes, meshes)]:
        ratio = math.prod(b / a for a, b in stages)
        if abs(ratio / 1.25 - 1.0) > 0.3:
            continue
        speed, carries = POWER["speed_rpm"], True
        for a, b in stages:
            carries = carries and any(narrowest(a, b, module, speed) is not None for module in (1.5, 2.0))
            speed *= a / b
        gears = tuple(tuple(sorted(side)) for side in zip(*stages, strict=True))
        found[gears] = found.get(gears, False) or carries
    return found


@pytest.mark.slow
def test_a_brute_force_finds_the_same() -> None:
    every = carrying()
    assert 1 < sum(every.values()) < len(every) - 1
    result = solved(**FEW, modules=[1.5, 2.0], strength=POWER, max_designs=200)
    found = {
        tuple(tuple(sorted(getattr(stage, side) for stage in design.mechanism.stages)) for side in ("driver", "driven"))
        for design in result.designs
    }
    assert found == {gears for gears, carries in every.items() if carries}
    assert result.search.rejected == {"strength": sum(not carries for carries in every.values())}
    assert result.search.complete
    errors = [abs(design.metrics.relative_error) for design in result.designs]
    assert errors == sorted(errors)
    for design in result.designs:
        speed = POWER["speed_rpm"]
        for stage in design.mechanism.stages:
            widths = [narrowest(stage.driver, stage.driven, module, speed) for module in (1.5, 2.0)]
            least = next((module, width) for module, width in zip((1.5, 2.0), widths, strict=True) if width is not None)
            assert (stage.module, stage.face_width) == pytest.approx(least), "not the least module and face"
            speed *= stage.driver / stage.driven


@pytest.mark.slow
@pytest.mark.parametrize("rank_by", ["error", "size"])
def test_ties_and_front_are_of_all_trains_that_carry(rank_by: str) -> None:
    """However few designs are asked for; by the same brute force."""
    few = [gears for gears, carries in carrying().items() if carries]
    assert len(few) < len(carrying())
    errors = {gears: abs(Fraction(math.prod(gears[1]), math.prod(gears[0])) / Fraction(5, 4) - 1) for gears in few}
    front: list[tuple[int, Fraction]] = []
    for size, error in sorted((sum(map(sum, gears)), error) for gears, error in errors.items()):
        if not front or error < front[-1][1]:
            front.append((size, error))
    assert len(front) > 2
    result = solved(**FEW, modules=[1.5, 2.0], strength=POWER, max_designs=1, rank_by=rank_by)
    assert result.search.every_judged
    assert result.search.ties == sum(error == min(errors.values()) for error in errors.values())
    found = [(one.size, abs(one.ratio.exact) / Fraction(5, 4) - 1) for one in result.pareto]
    assert [(size, abs(error)) for size, error in found] == front


@pytest.mark.slow
def test_trains_of_the_front_carry_the_power() -> None:
    """Each with the least modules and faces of its stages in their order, as it would be made as a design."""
    stated = {"ratio": "12.3", "max_stages": 2, "teeth": {"min": 18, "max": 90}, "tolerance": 0.01}
    result = solved(**stated, modules=[2.0, 3.0, 4.0], strength=POWER, max_designs=1)
    assert len(result.pareto) > 1
    for train in result.pareto:
        speed, ratio = POWER["speed_rpm"], Fraction(1)
        for stage in train.stages:
            widths = [(module, narrowest(stage.driver, stage.driven, module, speed)) for module in (2.0, 3.0, 4.0)]
            least = next((module, width) for module, width in widths if width is not None)
            assert (stage.module, stage.face_width) == pytest.approx(least)
            speed *= stage.driver / stage.driven
            ratio *= -Fraction(stage.driven, stage.driver)
        assert train.ratio.exact == ratio
    assert result.pareto[-1].stages == result.designs[0].mechanism.stages


@pytest.mark.slow
def test_the_ratio_of_a_train_of_the_front_counts_its_idler() -> None:
    stated: dict[str, Any] = {"ratio": "-4", "max_stages": 2, "teeth": {"min": 17, "max": 40}, "module": 4.0}
    result = solved(**stated, strength=POWER, max_designs=1)
    assert result.pareto
    for train in result.pareto:
        assert train.ratio.value < 0.0
        assert len(train.stages) + len(train.idlers or []) == 3


def test_too_much_power_is_told_with_what_is_carried() -> None:
    result = solved(**FEW, modules=[1.5, 2.0], strength={**POWER, "power_kw": 200.0})
    assert result.designs == []
    assert result.search.complete
    assert result.search.candidates == result.search.rejected["strength"]
    assert result.pareto == []
    most = float(result.summary.split("strongest carries ")[1].split(" kW")[0])
    assert solved(**FEW, modules=[1.5, 2.0], strength={**POWER, "power_kw": 0.99 * most}).designs
    assert not solved(**FEW, modules=[1.5, 2.0], strength={**POWER, "power_kw": 1.01 * most}).designs


def test_the_stages_stand_in_the_order_that_carries() -> None:
    """The shaft that turns slowest has the greatest torque: of two unlike stages the stronger one comes last."""
    stated = {**FEW, "ratio": "9", "teeth": {"min": 18, "max": 60}, "modules": [2.0], "tolerance": 0.0}
    strong = solved(**stated, max_designs=5, strength={**POWER, "power_kw": 0.8})
    assert strong.designs
    for design in strong.designs:
        widths = [stage.face_width or 0.0 for stage in design.mechanism.stages]
        assert widths[-1] == max(widths)
        assert max(widths) <= 12.0 * 2.0 * (1.0 + 1e-9)


@pytest.mark.slow
def test_with_a_distance_the_demands_hold_together() -> None:
    stated: dict[str, Any] = {
        "ratio": "pi", "max_stages": 2, "teeth": {"min": 17, "max": 100}, "reverted": True, "tolerance": 1e-4,
        "modules": [1.0, 1.25, 1.5, 2.0], "centre_distance": 120.0,
    }  # fmt: skip
    light, heavy = (solved(**stated, strength={**POWER, "power_kw": power}) for power in (0.5, 5.5))
    assert light.designs[0].mechanism.ratio.exact == solved(**stated).designs[0].mechanism.ratio.exact
    assert light.designs[0].mechanism != heavy.designs[0].mechanism
    assert heavy.search.rejected["strength"] > 0
    for design in heavy.designs:
        assert design.metrics.centre_distances == pytest.approx([120.0, 120.0], rel=1e-12)


@pytest.mark.slow
def test_an_idler_carries_too() -> None:
    stated: dict[str, Any] = {"ratio": "-4", "max_stages": 2, "teeth": {"min": 17, "max": 40}, "module": 4.0}
    designs = solved(**stated, strength=POWER, max_designs=2, max_total_teeth=160).designs
    assert designs
    for design in designs:
        assert design.metrics.strength is not None
        assert len(design.metrics.strength) == len(design.metrics.meshes) == 3
        for idler in design.mechanism.idlers:
            widths = [mesh.face_width for mesh in design.metrics.strength]
            assert widths[idler.stage - 1] == widths[idler.stage]


@pytest.mark.slow
def test_an_idler_bears_less_since_its_teeth_are_bent_both_ways() -> None:
    """0.7 of the allowable stress on it, in search, proof and analysis; all others bear what they do in a pair."""
    bending = {name: POWER[name] for name in ("power_kw", "speed_rpm", "allowable_bending", "max_face_width")}
    stated: dict[str, Any] = {"ratio": "2", "direction": "same", "max_stages": 1, "teeth": {"min": 20, "max": 40}}
    result = solved(**stated, module=4.0, strength=bending, max_designs=1)
    mechanism, strengths = result.designs[0].mechanism, result.designs[0].metrics.strength
    assert strengths is not None
    idler, stage = mechanism.idlers[0].teeth, mechanism.stages[0]
    omega = bending["speed_rpm"] * math.pi / 30.0
    strength = {name: bending[name] for name in ("allowable_bending", "max_face_width")}
    asked = {
        "mechanism": mechanism.model_dump(), "motion": {"at": 0.0, "speed": omega}, "mesh_efficiency": 1.0,
        "input_torque": 1000.0 * bending["power_kw"] / omega, "strength": strength,
    }  # fmt: skip
    meshes = parse_request(asked).build_answer()["meshes"]
    safeties = []
    for number, pair in enumerate([(stage.driver, idler), (idler, stage.driven)]):
        speed = bending["speed_rpm"] * stage.driver / pair[0]
        alone = {"mechanism": {"type": "gear_pair", "teeth": pair, "module": 4.0, "face_width": stage.face_width}}
        lone = {"power_kw": bending["power_kw"], **strength}
        gears = parse_request({**alone, "speed_rpm": speed, "strength": lone}).build_answer()["strength"]["gears"]
        for place, gear in enumerate(gears):
            is_idler = number + place == 1
            safety = (0.7 if is_idler else 1.0) * bending["allowable_bending"][place] / gear["bending_stress"]
            told = strengths[number].gears[place]
            assert told.bending_safety == pytest.approx(safety)
            assert meshes[number]["strength"]["gears"][place]["bending_safety"] == pytest.approx(safety)
            assert told.bent_both_ways == (True if is_idler else None)
            safeties.append(safety)
    assert min(safeties) == pytest.approx(1.0)
    assert safeties.index(min(safeties)) in (1, 2), "the idler decides"


def test_a_face_that_is_too_narrow_is_seen() -> None:
    problem = parse_problem({"kind": "gear_train", **FEW, "module": 3.0, "strength": POWER})
    assert isinstance(problem, GearTrainProblem)
    design = solve(problem, lambda fraction, message: None).designs[0]
    stage = design.mechanism.stages[0]
    thin = stage.model_copy(update={"face_width": 0.98 * stage.face_width})
    mechanism = design.mechanism.model_copy(update={"stages": [thin, *design.mechanism.stages[1:]]})
    judged = verify(problem, mechanism)
    assert judged is not None
    assert [check.name for check in judged.verification.checks if not check.passed] == ["strength"]


@pytest.mark.parametrize("module", [0.5, 3.0, 40.0])
def test_the_widest_face_bears_most(module: float) -> None:
    """What a mesh carries is judged on the widest face; a pinion of few teeth has the steepest load distribution."""
    stated = CarriedPower(**POWER | {"max_face_width": 100.0})
    gears = TrainStage(7, 60, module, (), (0.6, 0.0))
    judge = StressCalculator(LoadedPair(build_stage_contact(gears, 0, math.radians(20.0), 1.0), 1000.0, 100.0), stated)
    safeties = [
        [
            row[name] or 0.0
            for row in judge.compute_stresses(width).gears
            for name in ("bending_safety", "contact_safety")
        ]
        for width in np.geomspace(0.1 * module, 100.0 * module, 60)
    ]
    assert (np.diff(np.array(safeties), axis=0) > 0.0).all()


@pytest.mark.parametrize("binding", ["allowable_bending", "allowable_contact"])
def test_printed_stresses_give_the_printed_face(binding: str) -> None:
    """Shigley, 8th ed., Example 14-4, turned round: teeth that may bear its stresses are 1.5 in wide.

    17 and 52 teeth, 10 an inch, 4 hp at 1800 rev/min: σ = 6417 and 4854 psi, σ_c = 70 360 and 70 660 psi.
    """
    psi = 0.006894757293168
    printed = {"allowable_bending": [6417.0, 4854.0], "allowable_contact": [70_360.0, 70_660.0]}
    factors = {
        "form": [0.303, 0.412], "bending_geometry": [0.30, 0.40], "elastic": 2300.0 * math.sqrt(psi), "dynamic": 1.377,
        "size": [1.043, 1.052], "load_distribution": 1.22, "contact_geometry": 0.121,
    }  # fmt: skip
    stated = {
        "power_kw": 4.0 * 0.745699871582, "speed_rpm": 1800.0, "factors": factors,
        binding: [psi * stress for stress in printed[binding]],
    }  # fmt: skip
    teeth = [{"min": 17, "max": 17}, {"min": 52, "max": 52}]
    result = solved(ratio="52/17", max_stages=1, teeth=teeth, module=0.1, length_unit="in", strength=stated)
    assert result.designs[0].mechanism.stages[0].face_width == pytest.approx(1.5, rel=1e-3)
