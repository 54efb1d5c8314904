"""Rotors: random ones to rounding, a worked example with trial weights, and what a fault in the answer would do."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest

from synthesis.dispatch import solve
from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.kinds.balancing.rotor.solver import balance_rotor, build_rotor
from synthesis.kinds.balancing.verification.rotor import verify_rotor
from synthesis.registry import list_examples


def stated(**fields: Any) -> BalancingProblem:
    problem = BalancingProblem.model_validate({"kind": "balancing", "object": "rotor", **fields})
    problem.require_consistent()
    return problem


def random_rotor(rng: np.random.Generator) -> dict[str, Any]:
    count = int(rng.integers(1, 8))
    low = float(rng.uniform(-200.0, 200.0))
    return {
        "masses": [
            {
                "mass": float(rng.uniform(0.0, 5.0)),
                "radius": float(rng.uniform(1.0, 300.0)),
                "angle": float(rng.uniform(-180.0, 540.0)),
                "z": float(rng.uniform(-500.0, 500.0)),
            }
            for _ in range(count)
        ],
        "planes": [low, low + float(rng.choice([-1, 1])) * float(rng.uniform(20.0, 400.0))],
        "bearings": [float(rng.uniform(-900.0, -600.0)), float(rng.uniform(600.0, 900.0))],
        "rpm": float(rng.uniform(10.0, 20000.0)),
    }


def test_random_rotors_are_balanced_to_rounding() -> None:
    rng = np.random.default_rng(11)
    for _ in range(100):
        problem = stated(**random_rotor(rng), correction={"radius": float(rng.uniform(5.0, 300.0))})
        design = solve(problem).designs[0]
        mechanism, metrics = design.mechanism, design.metrics
        rows = [(e.unbalance, e.angle, e.z) for e in mechanism.unbalances]
        rows += [(1e6 * e.mass * e.radius * 1e-3, e.angle, e.z) for e in mechanism.corrections]
        moments = [u * np.exp(1j * math.radians(angle)) for u, angle, _ in rows]
        size = sum(map(abs, moments))
        assert abs(sum(moments)) < 1e-12 * size
        couple = [moment * z for moment, (*_, z) in zip(moments, rows, strict=True)]
        assert abs(sum(couple)) < 1e-12 * sum(map(abs, couple))
        force = 1e-6 * size * (problem.rpm * math.pi / 30.0) ** 2
        assert all(bearing.after < 1e-10 * force for bearing in metrics.bearings)
        assert metrics.shaking_force == pytest.approx(sum(b.before for b in metrics.bearings), rel=1.0)


def test_trial_weights_find_the_unbalance_of_a_turbine() -> None:
    """Rao, Mechanical Vibrations, Example 9.2: 10.0561 oz at 145.5548° and 5.8774 oz at 248.2559°, at one radius."""
    design = solve(BalancingProblem.model_validate(list_examples("balancing")[1])).designs[0]
    for found, (ounces, angle) in zip(
        design.mechanism.unbalances, [(10.0561, 145.5548), (5.8774, 248.2559)], strict=True
    ):
        assert found.unbalance / 125.0 == pytest.approx(ounces, abs=5e-5)
        assert math.remainder(found.angle - angle, 360.0) == pytest.approx(0.0, abs=5e-5)


def test_runs_of_a_known_rotor_find_its_unbalance() -> None:
    rng = np.random.default_rng(5)
    for sensors in (2, 3):
        response = rng.normal(size=(sensors, 2)) + 1j * rng.normal(size=(sensors, 2))
        unbalance = np.array([120.0 * np.exp(0.4j), 70.0 * np.exp(-2j)])

        def readings(moments: Any, response: Any = response) -> list[dict[str, float]]:
            values = response @ moments
            return [{"amplitude": float(abs(v)), "angle": math.degrees(np.angle(v))} for v in values]

        trials = [(0, 3.0, 20.0, 40.0), (1, 2.0, 15.0, -70.0)]
        runs = []
        for plane, mass, radius, angle in trials:
            added = unbalance.copy()
            added[plane] += mass * radius * np.exp(1j * math.radians(angle))
            runs.append({"mass": mass, "radius": radius, "angle": angle, "readings": readings(added)})
        problem = stated(
            influence={"initial": readings(unbalance), "trials": runs}, planes=[0.0, 10.0], units="consistent"
        )
        design = solve(problem).designs[0]
        assert [entry.unbalance for entry in design.mechanism.unbalances] == pytest.approx([120.0, 70.0], rel=1e-12)
        assert max(design.metrics.residual_vibration) < 1e-9


def test_readings_of_bearings_and_masses_say_the_same() -> None:
    rng = np.random.default_rng(6)
    rotor = random_rotor(rng)
    before = solve(stated(**rotor)).designs[0]
    forces = []
    for bearing, z in zip(before.metrics.bearings, rotor["bearings"], strict=True):
        other = rotor["bearings"][1] if z == rotor["bearings"][0] else rotor["bearings"][0]
        moment = sum(
            m["mass"] * m["radius"] * np.exp(1j * math.radians(m["angle"])) * (m["z"] - other) / (z - other)
            for m in rotor["masses"]
        )
        force = moment * 1e-3 * (rotor["rpm"] * math.pi / 30.0) ** 2
        assert abs(force) == pytest.approx(bearing.before, rel=1e-12)
        forces.append({"force": float(abs(force)), "angle": math.degrees(np.angle(force)), "z": z})
    measured = solve(stated(bearing_readings=forces, rpm=rotor["rpm"], planes=rotor["planes"])).designs[0]
    for one, other in zip(before.mechanism.corrections, measured.mechanism.corrections, strict=True):
        assert one.unbalance == pytest.approx(other.unbalance, rel=1e-12)
        assert math.remainder(one.angle - other.angle, 360.0) == pytest.approx(0.0, abs=1e-9)


def test_fewer_holes_leave_more_and_the_bound_holds() -> None:
    problem = BalancingProblem.model_validate({**list_examples("balancing")[1], "max_designs": 50})
    designs = solve(problem).designs
    assert len(designs) > 3
    places = [design.metrics.places for design in designs]
    left = [design.metrics.residual_unbalance for design in designs]
    assert places == sorted(places)
    assert left == sorted(left, reverse=True)
    assert all(design.metrics.bound <= design.metrics.residual_unbalance for design in designs)
    assert designs[-1].metrics.bound == pytest.approx(left[-1], rel=1e-12)


def test_weights_in_stock_are_taken_as_they_are() -> None:
    stock = {"angles": [0.0, 50.0, 170.0, 260.0], "radius": 80.0, "masses": [0.01, 0.025], "max_places": 2}
    problem = stated(masses=[{"mass": 0.02, "radius": 90.0, "angle": 80.0}], correction={"stock": stock})
    design = solve(problem).designs[0]
    assert design.metrics.optimal
    assert {added.mass for added in design.mechanism.corrections} <= {0.01, 0.025}
    assert {added.angle for added in design.mechanism.corrections} <= set(stock["angles"])
    assert len(design.mechanism.corrections) <= 2


def test_a_mass_at_another_angle_fails_the_proof() -> None:
    problem = stated(**random_rotor(np.random.default_rng(7)))
    rotor = build_rotor(problem)
    found = balance_rotor(problem, rotor)[0]
    assert verify_rotor(problem, rotor, found).verification.passed
    wrong = found._replace(weights=[found.weights[0]._replace(angle=found.weights[0].angle + 1e-6), found.weights[1]])
    checks = verify_rotor(problem, rotor, wrong).verification.checks
    assert [check.passed for check in checks] == [False, False]


def test_a_balanced_rotor_needs_nothing() -> None:
    problem = stated(masses=[{"mass": 0.0, "radius": 1.0, "angle": 0.0, "z": 3.0}], planes=[0.0, 10.0], rpm=100.0)
    design = solve(problem).designs[0]
    assert design.mechanism.corrections == []
    assert design.verification.passed


def test_a_grade_at_bearings_beside_the_planes_proves_nothing() -> None:
    """A mass beside the only plane: as it is the rotor keeps the grade, and the balanced one does not."""
    fields = {
        "masses": [{"mass": 0.1, "radius": 100.0, "angle": 0.0, "z": 0.0}],
        "planes": [100.0],
        "bearings": [0.0, 100.0],
        "rpm": 3000.0,
        "rotor_mass": 40.0,
        "max_grade": 80.0,
    }
    result = solve(stated(**fields, correction={"radius": 100.0}))
    assert not result.designs
    assert not result.search.complete
    assert result.summary.startswith("No design found.")
    holes = {"angles": 4, "radius": 100.0, "step": 0.01, "max_per_hole": 0.2}
    result = solve(stated(**fields, correction={"holes": holes}))
    assert [design.metrics.places for design in result.designs] == [0]
    assert "The smallest residual found is 0 g·mm" in result.summary
    assert "its grade exceeds the limit" in result.summary
    assert not result.search.complete


@pytest.mark.slow
def test_many_places_are_used_where_they_reach_the_unbalance() -> None:
    """More choices than can be listed: those towards the unbalance come first, and nearly nothing is left."""
    holes = {"angles": 72, "radius": 800.0, "step": 0.01, "max_per_hole": 2.0, "max_places": 2}
    masses = [{"mass": 1.0, "radius": 1000.0, "angle": 113.4}]
    result = solve(stated(masses=masses, correction={"holes": holes}))
    assert result.designs[0].metrics.residual_unbalance < 1e-2 * result.designs[0].metrics.initial_unbalance


@pytest.mark.parametrize("field", [{"goal": "minimize"}, {"motion": {"speed_rpm": 300.0}}])
def test_a_rotor_has_nothing_of_a_linkage(field: dict[str, Any]) -> None:
    fields = {"kind": "balancing", "object": "rotor", "masses": [{"mass": 1.0, "radius": 10.0, "angle": 0.0}]}
    problem = BalancingProblem.model_validate({**fields, **field})
    assert [fault.path for fault in problem.find_contradictions()] == [f"/{next(iter(field))}"]


@pytest.mark.parametrize("field", [{"planes": [0.0, 100.0]}, {"rank_by": "places"}, {"units": "consistent"}])
def test_a_linkage_has_nothing_of_a_rotor(field: dict[str, Any]) -> None:
    problem = BalancingProblem.model_validate({**list_examples("balancing")[2], **field})
    assert [fault.path for fault in problem.find_contradictions()] == [f"/{next(iter(field))}"]


@pytest.mark.campaign
def test_planes_that_need_little_have_no_hole_where_few_are_wanted() -> None:
    """Against all pairs of the planes' own best: one hole in the plane that needs it keeps the grade."""
    holes = {"angles": 12, "radius": 100.0, "step": 0.001, "max_per_hole": 0.1}
    masses = [{"mass": 0.1, "radius": 100.0, "angle": 1.0}, {"mass": 0.003, "radius": 100.0, "angle": 40.0, "z": 100.0}]
    fields = {"masses": masses, "planes": [0.0, 100.0], "correction": {"holes": holes}, "rank_by": "places"}
    result = solve(stated(**fields, rpm=3000.0, rotor_mass=40.0, max_grade=5.0, max_designs=50))
    assert [plane.places for plane in result.designs[0].metrics.planes] == [1, 0]
    pairs = [(design.metrics.places, design.metrics.residual_unbalance) for design in result.designs]
    assert all(less > more for (_, less), (_, more) in itertools.pairwise(pairs))
    assert all(few < many for (few, _), (many, _) in itertools.pairwise(pairs))
