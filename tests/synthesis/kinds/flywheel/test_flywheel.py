"""Flywheels: known fluctuations, wheels that no other within the limits beats, and verification that notices."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from synthesis.dispatch import solve
from synthesis.kinds.flywheel.design import FlywheelResult
from synthesis.kinds.flywheel.problem import FlywheelProblem
from synthesis.kinds.flywheel.verification import verify_flywheel
from synthesis.registry import get_first_example, parse_problem

Statement = dict[str, Any]

SINE = {
    "table": [[a, 20.0 + 15.0 * math.sin(math.radians(a))] for a in range(0, 360, 5)],
    "interpolation": "periodic_cubic",
}
SPEED = 2.0 * math.pi * 5.0
"""Of 300 revolutions a minute, rad/s."""


def stated(**changes: Any) -> Statement:
    base = {
        "kind": "flywheel",
        "torque": SINE,
        "speed_rpm": 300.0,
        "coefficient": 0.1,
        "density": 7800.0,
        "limits": {"radius": {"max": 200.0}},
    }
    return {name: value for name, value in (base | changes).items() if value is not None}


def answered(**changes: Any) -> tuple[FlywheelProblem, FlywheelResult]:
    problem: Any = parse_problem(stated(**changes))
    result: Any = solve(problem, lambda fraction, message: None)
    return problem, result


def asked(**changes: Any) -> Any:
    _, result = answered(**changes)
    assert result.fluctuation is not None
    return result.fluctuation


def failed(**changes: Any) -> set[str]:
    """The checks of the first design that fail after a change of its dimensions, some of them by a factor."""
    problem, result = answered()
    wheel = result.designs[0].mechanism
    other = wheel.model_copy(update={name: factor * getattr(wheel, name) for name, factor in changes.items()})
    design = verify_flywheel(problem, other)
    assert design is not None
    return {check.name for check in design.verification.checks if not check.passed}


def test_a_sine() -> None:
    """∫ 15 sin θ over half a turn is 30, and to first order I = E/(k ω²)."""
    found = asked()
    assert (found.mean_torque, found.energy) == pytest.approx((20.0, 30.0), rel=1e-6)
    assert found.first_order_inertia == pytest.approx(30.0 / (0.1 * SPEED**2), rel=1e-6)
    assert [pulse.area for pulse in found.pulses] == pytest.approx([30.0, -30.0], rel=1e-6)
    assert found.inertia == pytest.approx(found.first_order_inertia, rel=0.01)


def test_a_trapezium_by_hand() -> None:
    """10 N·m, and 130 above it from 90° to 120° with flanks of 30°: T̄ = 10 + 130·60/360."""
    rows = [[0.0, 10.0], [60.0, 10.0], [90.0, 140.0], [120.0, 140.0], [150.0, 10.0]]
    found = asked(torque={"table": rows})
    above = 130.0 / 6.0
    assert found.mean_torque == pytest.approx(10.0 + above, rel=1e-12)
    flank = 30.0 * (1.0 - above / 130.0)
    area = (130.0 - above) * (30.0 + flank) * math.pi / 180.0
    assert found.energy == pytest.approx(area, rel=1e-12)


def test_a_torque_that_repeats_after_two_turns() -> None:
    """At every angle as before, but seen over twice the angle: all areas are twice as large."""
    once = asked()
    wide = {"table": [[2.0 * angle, torque] for angle, torque in SINE["table"]], "interpolation": "periodic_cubic"}
    twice = asked(torque={**wide, "turns": 2})
    assert twice.energy == pytest.approx(2.0 * once.energy, rel=1e-9)
    assert twice.inertia == pytest.approx(2.0 * once.inertia, rel=1e-6)


def test_what_an_engine_gives_is_what_a_machine_takes_negative() -> None:
    demand = asked(torque={"table": [[0.0, -5.0], [90.0, 20.0], [120.0, 3.0]]})
    supply = asked(torque={"table": [[0.0, 5.0], [90.0, -20.0], [120.0, -3.0]], "side": "supply"})
    assert (supply.energy, supply.inertia) == pytest.approx((demand.energy, demand.inertia), rel=1e-12)
    same_side = asked(torque={"table": [[0.0, 5.0], [90.0, -20.0], [120.0, -3.0]]})
    assert same_side.first_order_inertia == pytest.approx(demand.first_order_inertia, rel=1e-12)
    assert same_side.inertia != pytest.approx(demand.inertia, rel=1e-7)


def test_the_summary_has_units_where_the_statement_has() -> None:
    _, result = answered()
    metrics = result.designs[0].metrics
    told = f"a mass of {metrics.mass:.6g} kg and an inertia of {metrics.inertia:.6g} kg·m²."
    assert told in result.summary
    assert f"by {asked().energy:.6g} J over" in result.summary
    _, plain = answered(units="consistent")
    assert not any(unit in plain.summary for unit in (" J", " kg", "m²"))


def test_what_the_shaft_has_is_not_built_again() -> None:
    bare = asked().inertia
    assert asked(existing_inertia=0.1).inertia == pytest.approx(bare - 0.1)
    for enough in ({"existing_inertia": 1.01 * bare}, {"torque": {"table": [[0.0, 7.0], [180.0, 7.0]]}}):
        _, result = answered(**enough)
        assert result.fluctuation is not None
        assert (result.fluctuation.inertia, result.designs, result.search.complete) == (0.0, [], True)
        assert "No flywheel is needed" in result.summary


LIMITS = [
    {"radius": {"max": 150.0}},
    {"radius": {"max": 400.0}, "thickness": {"min": 8.0, "max": 20.0}},
    {"thickness": {"min": 5.0, "max": 30.0}},
    {"rim_speed": {"max": 6.0}, "thickness": {"max": 60.0}, "wall": {"min": 20.0}},
    {"radius_to_thickness": {"max": 10.0}, "wall": {"min": 15.0}},
    {"radius": {"max": 250.0}, "thickness": {"min": 10.0, "max": 12.0}},
    {"radius": {"max": 900.0}, "wall": {"min": 3.0}, "thickness": {"min": 4.0}},
    {"radius_to_thickness": {"max": 3.0}, "thickness": {"min": 4.0, "max": 200.0}, "radius": {"max": 300.0}},
]


@pytest.mark.parametrize("limits", LIMITS)
@pytest.mark.parametrize("form", ["disc", "rim"])
def test_no_wheel_within_the_limits_is_lighter(form: str, limits: Statement) -> None:
    """Against a hundred thousand wheels drawn at random, each as thick as its inertia needs."""
    limits = {name: value for name, value in limits.items() if form == "rim" or name != "wall"}
    if form == "rim" and not limits.get("wall") and (len(limits) == 1):
        limits |= {"wall": {"min": 12.0}}
    _, result = answered(form=form, limits=limits)
    (design,) = result.designs
    assert design.verification.passed
    assert design.metrics.at_limits
    inertia = design.metrics.inertia
    rng = np.random.default_rng(7)
    outer = np.exp(rng.uniform(math.log(0.02), math.log(1.0), 100_000))
    inner = outer * rng.uniform(0.0, 1.0, 100_000) ** 0.3 if form == "rim" else 0.0 * outer
    thick = inertia / (0.5 * math.pi * 7800.0 * (outer**4 - inner**4))
    span = limits.get("thickness", {})
    kept = (thick >= 1e-3 * span.get("min", 0.0)) & (thick <= 1e-3 * span.get("max", math.inf))
    kept &= outer <= 1e-3 * limits.get("radius", {}).get("max", math.inf)
    kept &= outer - inner >= 1e-3 * limits.get("wall", {}).get("min", 0.0)
    kept &= outer * design.metrics.greatest_speed * math.pi / 30.0 <= limits.get("rim_speed", {}).get("max", math.inf)
    kept &= outer <= thick * limits.get("radius_to_thickness", {}).get("max", math.inf)
    mass = math.pi * 7800.0 * thick * (outer**2 - inner**2)
    assert kept.sum() > 20
    assert mass[kept].min() >= design.metrics.mass * (1.0 - 1e-9)
    assert mass[kept].min() <= design.metrics.mass * 1.2, "some come near it"


def test_limits_that_allow_no_wheel() -> None:
    _, result = answered(limits={"radius": {"max": 50.0}, "thickness": {"max": 2.0}}, form="any")
    assert (result.designs, result.search.complete) == ([], True)
    assert "No disc" in result.summary
    assert "No rim" in result.summary


@pytest.mark.parametrize(
    ("changes", "broken"),
    [
        ({}, set()),
        ({"thickness": 1.0 - 1e-4}, {"coefficient"}),
        ({"radius": 1.001}, {"radius"}),
        ({"radius": 0.9, "thickness": 0.9**-4}, {"lightest"}),
    ],
)
def test_verification_notices_changed_dimensions(changes: dict[str, float], broken: set[str]) -> None:
    assert failed(**changes) >= broken
    assert bool(failed(**changes)) == bool(broken)


@pytest.mark.parametrize("coefficient", [0.002, 0.3, 0.9])
def test_the_integrated_coefficient_is_the_stated_one(coefficient: float) -> None:
    """Far beyond where the first order holds, for a smooth torque and for one with corners."""
    corners = {"table": [[0.0, 0.0], [3.0, 500.0], [4.0, 10.0], [200.0, -30.0], [359.0, 0.0]]}
    for torque in (SINE, corners):
        _, result = answered(coefficient=coefficient, torque=torque)
        assert result.designs[0].verification.passed
        assert result.designs[0].metrics.coefficient == pytest.approx(coefficient, rel=1e-6)


@pytest.mark.parametrize(
    ("changes", "path"),
    [
        ({"torque": None}, "/torque"),
        ({"machine": {"mechanism": {}, "dynamics": {}}}, "/torque"),
        ({"torque": {"table": [[0.0, 1.0], [360.0, 2.0]]}}, "/torque/table"),
        ({"torque": {"table": [[0.0, 1.0], [361.0, 1.0]]}}, "/torque/table"),
        ({"limits": {}}, "/limits"),
        ({"limits": {"thickness": {"max": 20.0}}}, "/limits"),
        ({"form": "rim"}, "/limits"),
        ({"form": "rim", "limits": {"thickness": {"min": 5.0, "max": 30.0}}}, "/limits"),
        ({"limits": {"radius": {"max": 9.0}, "wall": {"min": 1.0}}}, "/limits/wall"),
    ],
)
def test_faults_by_field(changes: Statement, path: str) -> None:
    assert path in {fault.path for fault in parse_problem(stated(**changes)).find_contradictions()}


def test_a_linkage_without_forces_all_round() -> None:
    rocker = {
        "type": "fourbar",
        "fixed_pivots": {"input": [0.0, 0.0], "output": [100.0, 0.0]},
        "links": {"input": 60.0, "coupler": 40.0, "output": 50.0},
    }
    _, result = answered(torque=None, machine={"mechanism": rocker, "dynamics": {}})
    assert (result.designs, result.fluctuation, result.search.complete) == ([], None, False)
    assert "not known over the whole cycle" in result.summary


def test_a_wheel_on_inches() -> None:
    """The same press and limits, stated in inches: the same mass in kilograms."""
    limits = {"radius": {"max": 254.0}, "thickness": {"max": 50.8}}
    inches = {"radius": {"max": 10.0}, "thickness": {"max": 2.0}}
    _, metric = answered(limits=limits, form="rim")
    _, imperial = answered(limits=inches, form="rim", length_unit="in")
    assert imperial.designs[0].metrics.mass == pytest.approx(metric.designs[0].metrics.mass, rel=1e-12)
    assert imperial.designs[0].mechanism.radius == pytest.approx(10.0)


def test_both_forms_of_the_example_the_lighter_first() -> None:
    problem: Any = parse_problem(get_first_example("flywheel"))
    result: Any = solve(problem, lambda fraction, message: None)
    assert [design.mechanism.form for design in result.designs] == ["rim", "disc"]
    assert result.designs[0].metrics.mass < result.designs[1].metrics.mass
