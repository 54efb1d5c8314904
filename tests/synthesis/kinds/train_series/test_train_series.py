"""Trains in series: against a brute force, at their limits, and verification that fails where a tooth is changed."""

from __future__ import annotations

from fractions import Fraction
from random import Random
from typing import Any

import pytest

from kinematics.gear.planetary import solve_speeds
from synthesis.dispatch import solve
from synthesis.kinds.train_series import solver
from synthesis.kinds.train_series.design import TrainSeriesMechanism
from synthesis.kinds.train_series.verification import join_units, verify
from synthesis.registry import list_examples, parse_problem
from tests.campaign import further, sampled
from tests.support.independent.train_series import best_series, statements
from tests.support.problems.train_series import same

SET: dict[str, Any] = {
    "type": "planetary_train",
    "arrangement": "simple",
    "input": "sun",
    "output": "carrier",
    "fixed": "ring",
    "teeth": {"min": 17, "max": 40, "ring_max": 110},
}
GEARS: dict[str, Any] = {"type": "gear_train", "teeth": {"min": 17, "max": 60}}


def solved(ratio: float | str, *units: dict[str, Any], **stated: Any) -> Any:
    problem = parse_problem({"kind": "train_series", "ratio": ratio, "units": list(units), **stated})
    assert problem.find_contradictions() == []
    return solve(problem)


def series(seed: int) -> dict[str, Any]:
    """A random statement whose units are two small ones, so that a loop over all series takes a moment."""
    rng = Random(seed)
    return next(one for one in statements(50, rng) if len(one["units"]) == 2 and "max_stages" not in str(one))


@pytest.mark.slow
@pytest.mark.parametrize("seed", further(range(6), [0, 3]))
def test_the_nearest_series_is_that_of_a_brute_force(seed: int) -> None:
    statement = series(seed)
    result = solve(parse_problem(statement))
    assert same(result, best_series(statement)), (statement, result.summary)


@pytest.mark.campaign
@pytest.mark.timeout(600)
def test_further_series_against_the_brute_force() -> None:
    for statement in statements(sampled(40), Random(7)):
        assert same(solve(parse_problem(statement)), best_series(statement)), statement


def test_a_winch_that_one_set_does_not_reach() -> None:
    """333 : 1 is beyond one set; three of them have it, within a tenth of a thousandth and proven nearest."""
    statement = list_examples("train_series")[1]
    result = solve(parse_problem(statement))
    assert result.search.complete
    assert abs(result.designs[0].metrics.error) < 1e-4
    alone = {field: value for field, value in statement["units"][0].items() if field != "type"}
    single = solve(parse_problem({**alone, "kind": "planetary_train", "ratio": 333}))
    assert abs(single.designs[0].metrics.error) > 0.9
    mechanism = result.designs[0].mechanism
    turning = solve_speeds(join_units(mechanism), {"shaft_0": 1})
    assert 1 / turning.values["shaft_3"] == mechanism.ratio.exact
    assert mechanism.ratio.exact == Fraction(*_product(mechanism))


def _product(mechanism: Any) -> tuple[int, int]:
    total = Fraction(1)
    for unit in mechanism.units:
        total *= 1 + Fraction(unit.teeth["ring"], unit.teeth["sun"])
    return total.numerator, total.denominator


@pytest.mark.slow
def test_designs_are_ordered_and_different() -> None:
    result = solved(25, SET, SET, max_designs=40)
    keys = [(abs(design.metrics.error), design.metrics.total_teeth) for design in result.designs]
    assert keys == sorted(keys)
    told = [sorted(str(unit.teeth) for unit in design.mechanism.units) for design in result.designs]
    assert len({str(one) for one in told}) == len(told), "series of units stated alike are listed in one order"
    # Units that differ in anything may not change places.
    other = solved(25, SET, {**SET, "module": 2.0})
    assert other.search.combinations > result.search.combinations


def test_the_pareto_set_has_no_smaller_and_nearer_series() -> None:
    result = solved("3*pi", SET, GEARS | {"max_stages": 2, "teeth": {"min": 17, "max": 26}}, max_designs=40)
    front = [(one.total_teeth, abs(one.error)) for one in result.pareto]
    assert len(front) > 3
    assert front == sorted(front)
    assert [error for _, error in front] == sorted((error for _, error in front), reverse=True)
    for design in result.designs:
        mine = design.metrics.total_teeth, abs(design.metrics.error)
        assert any(size <= mine[0] and error <= mine[1] * (1 + 1e-12) for size, error in front)


@pytest.mark.slow
def test_the_smallest_series_within_a_tolerance() -> None:
    result = solved(20, SET, SET, tolerance=2e-3, rank_by="size", max_designs=30)
    keys = [(design.metrics.total_teeth, abs(design.metrics.error)) for design in result.designs]
    assert keys == sorted(keys)
    assert all(error <= 2e-3 for _, error in keys)
    nearest = solved(20, SET, SET, tolerance=2e-3, max_designs=200)
    assert keys[0][0] == min(design.metrics.total_teeth for design in nearest.designs)
    assert keys[0][0] == result.pareto[0].total_teeth


@pytest.mark.parametrize(
    ("ratio", "units", "reason"),
    [
        (-9, [SET, SET], "none turns input and output in the opposite direction"),
        (4000, [SET, SET], "the nearest has the ratio"),
        (
            9,
            [SET, {**SET, "teeth": {"min": 60, "max": 61, "ring_max": 62}}],
            "no train satisfies the constraints of unit 2",
        ),
    ],
)
def test_an_empty_answer_has_its_reason(ratio: float, units: list[dict[str, Any]], reason: str) -> None:
    result = solved(ratio, *units, tolerance=0.01)
    assert result.designs == []
    assert result.search.complete
    assert reason in result.summary


def test_an_idler_where_the_direction_asks_for_one() -> None:
    """One stage turns the direction round; where `same` is stated it has an idler, and the ratio its sign."""
    turned, straight = solved(-8, GEARS, SET), solved(8, {**GEARS, "direction": "same"}, SET)
    assert turned.designs[0].mechanism.units[0].idlers == []
    assert straight.designs[0].mechanism.units[0].idlers
    assert turned.search.least_error == straight.search.least_error
    assert solved(8, GEARS, SET).designs == []


@pytest.mark.parametrize(
    ("unit", "check"),
    [
        ({**GEARS, "teeth": None, "stock": [20, 25, 30, 40]}, "unit_1_stock"),
        ({**GEARS, "max_stages": 2, "reverted": True, "teeth": {"min": 17, "max": 30}}, "unit_1_coaxial"),
        ({**GEARS, "modules": [1.5, 2.0], "centre_distance": 70.0}, "unit_1_centre_distance"),
        ({**GEARS, "max_stages": 2, "max_stage_ratio": 1.5, "teeth": {"min": 17, "max": 26}}, "unit_1_stage_ratio"),
    ],
)
def test_demands_on_ordinary_units_are_kept(unit: dict[str, Any], check: str) -> None:
    """Every train that a unit can be keeps what its kind measures."""
    direction = "opposite" if "modules" in unit else "same"
    result = solved(-5 if "modules" in unit else 5, {**unit, "direction": direction}, SET, max_designs=20)
    assert result.designs
    assert result.search.rejected == {}
    for design in result.designs:
        assert check in [one.name for one in design.verification.checks]
        assert design.verification.passed


def test_series_that_cannot_be_made_leave_room_for_those_behind_them(monkeypatch: pytest.MonkeyPatch) -> None:
    """As many designs as asked for come back, the best of those that can be made, and the answer is no proof."""
    everyone = solved(25, SET, SET, max_designs=12).designs
    made, first = solver._build_mechanism, iter(range(7))
    monkeypatch.setattr(
        solver, "_build_mechanism", lambda *series: made(*series) if next(first, None) is None else None
    )
    result = solved(25, SET, SET, max_designs=5)
    assert result.search.rejected == {"idler": 7}
    assert not result.search.complete
    assert [design.mechanism for design in result.designs] == [design.mechanism for design in everyone[7:]]


def test_a_search_over_distances_says_that_it_is_one() -> None:
    """What a unit's distances may be is looked at in steps: the answer does not call itself a proof."""
    stated = {**GEARS, "modules": [1.5], "centre_distance": 60.0}
    proven = solved(-12, stated, SET)
    searched = solved(-12, {**stated, "centre_distance": {"min": 58.0, "max": 62.0}}, SET)
    assert proven.search.complete
    assert not searched.search.complete
    assert "searched in steps" in searched.summary
    assert searched.search.least_error <= proven.search.least_error


@pytest.mark.parametrize("changes", [{"sun": 1}, {"planet": 1}, {"ring": 1}, {"sun": 2, "ring": 2}])
@pytest.mark.parametrize("unit", [0, 1])
def test_a_changed_tooth_is_found(changes: dict[str, int], unit: int) -> None:
    problem = parse_problem({"kind": "train_series", "ratio": 25, "units": [SET, SET], "tolerance": 0.0})
    mechanism = solve(problem).designs[0].mechanism
    assert verify(problem, mechanism).verification.passed
    changed = mechanism.model_dump()
    for gear, more in changes.items():
        changed["units"][unit]["teeth"][gear] += more
    checked = verify(problem, TrainSeriesMechanism.model_validate(changed))
    assert checked is None or not checked.verification.passed


def test_efficiency_is_that_of_all_units() -> None:
    result = solved(25, SET, {**SET, "mesh_efficiency": 0.9})
    metrics = result.designs[0].metrics
    assert metrics.efficiency == pytest.approx(metrics.units[0].efficiency * metrics.units[1].efficiency)
    assert metrics.units[1].efficiency < metrics.units[0].efficiency
    assert solved(-8, GEARS, SET).designs[0].metrics.efficiency is None
