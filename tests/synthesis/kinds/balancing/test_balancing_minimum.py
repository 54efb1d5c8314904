"""Counterweights of least shaking: what they do is linear, no other weights do better, and the bound is below all."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from kinematics.dynamics.bodies import join_bodies, make_body
from kinematics.dynamics.reactions import compute_reactions
from synthesis.analyses.linkages.requested_motion import place_machine
from synthesis.dispatch import solve
from synthesis.kinds.balancing.linkage.effects import compute_quantities
from synthesis.kinds.balancing.linkage.minimize import build_setting, find_minimum
from synthesis.kinds.balancing.linkage.motion import build_balancing_task
from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.kinds.balancing.verification.minimum import verify_minimum
from synthesis.numerics.conic import ConeRows, solve_conic_program
from tests.support.synthesis.balanced_linkages import crank_rocker, fourbar, pair, sixbar, stated, turning_sixbar


def problem_of(statement: dict[str, Any]) -> BalancingProblem:
    problem = BalancingProblem.model_validate(statement)
    problem.require_consistent()
    return problem


def least(rng: np.random.Generator, make: Any = fourbar, **more: Any) -> dict[str, Any]:
    weights = {"total_mass": 3.0, "reach": 120.0, "density": 7800.0, "thickness": 20.0}
    objective = {"shaking_force": 1.0, "shaking_moment": 0.5, "drive": 0.3}
    return stated(rng, make, **{"goal": "minimize", "objective": objective, "counterweights": weights, **more})


@pytest.mark.parametrize("make", [fourbar, sixbar])
def test_what_a_weight_does_is_linear_in_its_parameters(make: Any) -> None:
    """Momentum and energy against the reactions of the linkage with the weight in it, gravity and acceleration too."""
    rng = np.random.default_rng(3)
    statement = least(rng, make)
    statement["dynamics"]["gravity"] = {"magnitude": 9.81, "angle": 250.0}
    statement["motion"]["acceleration"] = 200.0
    task = build_balancing_task(problem_of(statement))
    machine, links = task.machine, ["coupler", "output"]
    now = place_machine(machine, task.list_positions(40), task.speed, task.acceleration)
    known = compute_quantities(machine, now, links, ["A", "O2"])
    bodies, parameters = dict(machine.bodies), []
    for link in links:
        about = complex(now.reference(now.mechanism.links[link][0]))
        mass, arm, own = rng.uniform(0.2, 2.0), complex(*rng.normal(size=2)) * 0.1, rng.uniform(0.001, 0.01)
        bodies[link] = join_bodies([bodies[link], make_body(mass, about + arm, own)])
        parameters += [mass, mass * arm.real, mass * arm.imag, own + mass * abs(arm) ** 2]
    found = compute_reactions(replace(machine, bodies=bodies), now)
    named = {"shaking_force": found.shaking_force, "shaking_moment": found.shaking_moment, "drive": found.drive}
    for name, values in named.items():
        (part,) = known[name]
        assert np.abs(part.evaluate(np.array(parameters)) - values).max() < 1e-9 * np.abs(values).max()
    for joint in ("A", "O2"):
        for part, values in zip(known[f"joint {joint}"], found.joints[joint].values(), strict=True):
            assert np.abs(part.evaluate(np.array(parameters)) - values).max() < 1e-9 * np.abs(values).max()


def test_the_force_alone_is_balanced_as_the_exact_goal_balances_it() -> None:
    rng = np.random.default_rng(4)
    statement = stated(rng, fourbar, counterweights={"links": ["input", "output"], "radius": 100.0})
    exact = solve(problem_of(statement)).designs[0]
    weights = {"links": ["input", "output"], "reach": 100.0, "total_mass": 50.0}
    design = solve(problem_of({**statement, "goal": "minimize", "counterweights": weights})).designs[0]
    assert design.metrics.value < 1e-6
    for one, other in zip(exact.counterweights, design.counterweights, strict=True):
        assert other.moment == pytest.approx(one.moment, rel=1e-5)
        assert other.angle == pytest.approx(one.angle, abs=1e-3)


@pytest.mark.parametrize("norm", ["max", "rms"])
@pytest.mark.parametrize("make", [fourbar, sixbar, crank_rocker, turning_sixbar])
def test_no_weights_of_the_set_go_below_the_bound(make: Any, norm: str) -> None:
    rng = np.random.default_rng(5)
    statement = least(rng, make)
    statement["objective"] = {**statement["objective"], "norm": norm}
    problem = problem_of(statement)
    task = build_balancing_task(problem)
    setting = build_setting(problem, task)
    found = find_minimum(setting, task)
    design = verify_minimum(problem, task, found)
    assert design.verification.passed
    assert found.bound <= design.metrics.value
    assert design.metrics.gap <= 1e-3
    links, limits, count = len(setting.links), setting.limits, 200
    masses = rng.dirichlet(np.ones(links + 1), count)[:, :links] * limits.total
    arms = limits.reach * np.sqrt(rng.random((count, links))) * np.exp(1j * rng.uniform(-np.pi, np.pi, (count, links)))
    inertias = masses * np.abs(arms) ** 2 + masses**2 / limits.disc + rng.exponential(0.01, (count, links))
    moments = masses * arms
    drawn = np.stack([masses, moments.real, moments.imag, inertias], axis=2).reshape(count, -1)
    # Convex combinations with the optimum are in the set, and come as near to it as one likes.
    shares = np.where(rng.random(count) < 0.5, 1.0, 10.0 ** rng.uniform(-4.0, -1.0, count))[:, None]
    parameters = found.parameters + shares * (drawn - found.parameters)
    reached = sum(level.weight * level.evaluate_level(parameters) for level in setting.levels)
    assert np.all(reached >= found.bound)


def test_caps_and_limits_are_kept() -> None:
    rng = np.random.default_rng(6)
    weights = {"max_mass": 0.8, "total_mass": 2.0, "reach": 90.0, "max_gyration": 110.0}
    statement = least(rng, counterweights={**weights, "density": 7800.0, "thickness": 15.0, "max_disc_radius": 40.0})
    design = solve(problem_of({**statement, "caps": {"drive": 0.9, "joint_forces": {"A": 1.1}}})).designs[0]
    assert design.verification.passed
    levels = {(level.name, level.norm): level for level in design.metrics.levels}
    assert levels["drive", "max"].ratio <= 0.9009
    assert levels["joint A", "max"].ratio <= 1.1011
    assert design.metrics.added_mass <= 2.0 * (1.0 + 1e-9)
    for weight in design.counterweights:
        assert weight.mass <= 0.8 * (1.0 + 1e-9)
        assert weight.radius <= 90.0 * (1.0 + 1e-9)
        assert weight.disc_radius <= 40.0 * (1.0 + 1e-9)
        assert weight.inertia >= weight.mass**2 / (2.0 * np.pi * 7800.0 * 0.015) * (1.0 - 1e-9)
        gyration = np.sqrt(weight.inertia / weight.mass + (1e-3 * weight.radius) ** 2)
        assert gyration <= 0.110 * 1.001


@pytest.mark.slow
def test_more_of_everything_is_never_worse() -> None:
    rng = np.random.default_rng(7)
    statement = least(rng)
    values = []
    for mass, reach in ((0.5, 60.0), (1.0, 60.0), (1.0, 120.0), (4.0, 120.0)):
        weights = {**statement["counterweights"], "total_mass": mass, "reach": reach}
        values.append(solve(problem_of({**statement, "counterweights": weights})).designs[0].metrics)
    for one, other in pairwise(values):
        assert other.bound <= one.value
        assert other.value <= one.value * (1.0 + 1e-3)


def test_weights_that_are_moved_fail_the_proof() -> None:
    problem = problem_of(least(np.random.default_rng(8)))
    task = build_balancing_task(problem)
    found = find_minimum(build_setting(problem, task), task)
    moved = [weight._replace(at=weight.at + 0.02) for weight in found.weights]
    assert not verify_minimum(problem, task, found._replace(weights=moved)).verification.passed
    heavy = [weight._replace(mass=1.5 * weight.mass) for weight in found.weights]
    checks = verify_minimum(problem, task, found._replace(weights=heavy)).verification.checks
    assert not next(check for check in checks if check.name == "total_mass").passed
    lying = verify_minimum(problem, task, found._replace(bound=1.01 * found.bound)).verification.checks
    assert not next(check for check in lying if check.name == "bound").passed


def test_a_driven_slider_and_consistent_units() -> None:
    """A slider-crank driven by its piston, in units that nothing is converted of."""
    statement = {
        "kind": "balancing",
        "object": "linkage",
        "goal": "minimize",
        "length_unit": "in",
        "mechanism": {
            "type": "slider_crank",
            "fixed_pivot": [0.0, 0.0],
            "links": {"crank": 2.0, "coupler": 7.0},
            "slide": {"point": [0.0, 0.0], "angle": 0.0},
            "driven_by": "slider",
        },
        "motion": {"from": 5.6, "to": 8.4, "speed": 50.0},
        "dynamics": {
            "units": "consistent",
            "bodies": {"crank": {"mass": 0.02, "cg": {"distance": 0.8}, "inertia": 0.01}},
            "point_masses": [{"joint": "B", "mass": 0.03}],
        },
        "objective": {"shaking_force": 1.0, "drive": 0.5},
        "counterweights": {"total_mass": 0.05, "reach": 2.0},
    }
    design = solve(problem_of(statement)).designs[0]
    assert design.verification.passed
    assert design.metrics.value < 1.5


def test_a_conic_program_says_what_it_is() -> None:
    least_x = ConeRows("nonnegative", np.array([[-1.0]]), np.array([-2.0]))
    solved = solve_conic_program(np.array([1.0]), [least_x])
    assert (solved.status, solved.value) == ("solved", pytest.approx(2.0, abs=1e-6))
    assert solved.dual == pytest.approx(2.0, abs=1e-6)
    most_x = ConeRows("nonnegative", np.array([[1.0]]), np.array([1.0]))
    assert solve_conic_program(np.array([1.0]), [least_x, most_x]).status == "infeasible"
    assert solve_conic_program(np.array([-1.0]), [least_x]).status == "unbounded"
    disc = ConeRows("second_order", np.array([[0.0, 0.0], [-1.0, 0.0], [0.0, -1.0]]), np.array([1.0, 0.0, 0.0]), 3)
    round_one = solve_conic_program(np.array([3.0, 4.0]), [disc])
    assert round_one.x == pytest.approx([-0.6, -0.8], abs=1e-6)


def test_a_conic_program_of_reduced_accuracy_proves_nothing() -> None:
    """A place beyond a disc by 10⁻⁹ only; and x y ≥ 1 with x ≤ 10⁻⁵, where x comes as near to 0 as one likes."""
    disc = ConeRows("second_order", np.array([[0.0, 0.0], [-1.0, 0.0], [0.0, -1.0]]), np.array([1.0, 0.0, 0.0]), 3)
    statuses = []
    for beyond in (1e-2, 1e-9):
        far = ConeRows("nonnegative", np.array([[-1.0, 0.0]]), np.array([-(1.0 + beyond)]))
        statuses.append(solve_conic_program(np.array([0.0, 1.0]), [disc, far]).status)
    assert statuses == ["infeasible", "failed"]
    product = ConeRows("second_order", np.array([[-1.0, -1.0], [0.0, 0.0], [-1.0, 1.0]]), np.array([0.0, 2.0, 0.0]), 3)
    small = ConeRows("nonnegative", np.array([[1.0, 0.0]]), np.array([1e-5]))
    found = solve_conic_program(np.array([1.0, 0.0]), [product, small])
    assert found.status == "solved"
    assert found.dual == -np.inf


@pytest.mark.parametrize("disc", [{}, {"density": 7800.0, "thickness": 20.0}])
def test_gyration_is_limited_where_the_inertia_does_not_count(disc: dict[str, float]) -> None:
    problem = problem_of(
        least(
            np.random.default_rng(6),
            objective={"shaking_force": 1.0},
            counterweights={"total_mass": 4.0, "max_gyration": 20.0, **disc},
        )
    )
    result = solve(problem)
    assert result.designs, result.summary
    design = result.designs[0]
    assert {"gyration", "gap"} <= {check.name for check in design.verification.checks}
    for weight in design.counterweights:
        about = weight.inertia * 1e6 + weight.mass * weight.radius**2
        assert about <= weight.mass * 20.0**2 * 1.002


@pytest.mark.campaign
def test_forces_that_redundant_constraints_leave_open_are_no_objective() -> None:
    joints = {"O2": [0, 0], "O4": [280, 0], "O6": [140, 0], "A": [60, 80], "B": [340, 80], "C": [200, 80]}
    links = {"ground": ["O2", "O4", "O6"], "input": ["O2", "A"], "coupler": ["A", "B", "C"]}
    links |= {"output": ["O4", "B"], "third": ["O6", "C"]}
    listed = [{"name": name, "joints": of} for name, of in links.items()]
    skeleton = {"joints": joints, "links": listed, "slides": [], "gears": [], "input_link": "input"}
    statement = {
        "kind": "balancing",
        "object": "linkage",
        "goal": "minimize",
        "objective": {"joint_forces": {"C": 1.0}},
        "mechanism": {"type": "skeleton", "skeleton": skeleton},
        "motion": {"speed_rpm": 300.0, "start": 40.0, "end": 60.0},
        "dynamics": {"bodies": {"coupler": {"mass": 1.0, "cg": [200, 90], "inertia": 0.01}}},
        "counterweights": {"total_mass": 4.0},
    }
    result = solve(problem_of(statement))
    assert not result.designs
    assert not result.search.complete
    assert "redundant constraints" in result.summary


# Drawn problems whose programs stall where Clarabel scales them, and one where the value falls by seven times the share
# by which the cap is exceeded: joints, masses with centres and inertias, the motion, and what is wished.
STALLING = [
    (
        {"O2": 0j, "O4": 327.74118 + 0j, "A": 5.135253 - 33.368619j, "B": 29.663827 + 102.598887j},
        [(1.2972055, [4.0732679, -15.2108885], 1.0658e-4), (1.4354783, [2.3672281, 45.1638624], 2.8358e-3)],
        (1.6278712, [107.9110235, 91.1515520], 9.7852e-3),
        {"speed_rpm": 300.0, "from": -81.251121, "to": 278.748879},
        {"objective": {"shaking_force": 0.6, "joint_forces": {"A": 0.3}, "norm": "rms"}, "caps": {"drive": 1.2424}},
        {"reach": 124.387522, "total_mass": 1.1697771},
    ),
    (
        {"O2": 0j, "O4": 170.053371 + 0j, "A": 74.330428 + 4.731485j, "B": 50.400163 + 230.766754j},
        [(0.29504683, [21.2382074, -11.3348630], 1.37898e-4), (1.5428678, [26.1633511, 105.1792457], 7.14108e-3)],
        (0.28784548, [19.6502910, 184.2105638], 1.1033854e-3),
        {"speed_rpm": 300.0, "from": 3.642235, "to": 363.642235},
        {"objective": {"shaking_force": 0.488, "norm": "max"}, "caps": {"drive": 1.0145150316}},
        {"reach": 170.797436, "total_mass": 3.2964326},
    ),
]


@pytest.mark.slow
@pytest.mark.parametrize("drawn", STALLING)
def test_a_program_that_stalls_and_a_cap_that_binds_have_a_near_bound(drawn: Any) -> None:
    joints, (first, second), third, motion, wish, weights = drawn
    names = {"ground": ["O2", "O4"], "input": ["O2", "A"], "coupler": ["A", "B"], "output": ["O4", "B"]}
    masses = zip(("input", "coupler", "output"), (first, second, third), strict=True)
    skeleton = {
        "joints": {name: pair(z) for name, z in joints.items()},
        "links": [{"name": name, "joints": ends} for name, ends in names.items()],
        "input_link": "input",
    }
    statement = {
        "kind": "balancing",
        "object": "linkage",
        "goal": "minimize",
        "mechanism": {"type": "skeleton", "skeleton": skeleton},
        "motion": motion,
        "dynamics": {"bodies": {name: dict(zip(("mass", "cg", "inertia"), of, strict=True)) for name, of in masses}},
        "counterweights": weights,
        **wish,
    }
    metrics = solve(problem_of(statement)).designs[0].metrics
    assert metrics.bound <= metrics.value <= metrics.bound * (1.0 + 1e-4)
    for level in metrics.levels:
        assert level.cap is None or level.ratio <= level.cap * (1.0 + 1e-6)
