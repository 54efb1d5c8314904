"""Function generators under demands: planted linkages whose constraints are a little looser are answered."""

import math

import numpy as np
import pytest

from synthesis import parse_problem
from synthesis.kinds.function.fourbar.constraints import GeneratorLimits
from synthesis.kinds.function.fourbar.task import make_function_task
from synthesis.kinds.function.problem import FunctionProblem
from synthesis.kinds.function.solver import solve_function
from tests.campaign import further, sampled
from tests.support.demands import function_constraints
from tests.support.demands.planted import box
from tests.support.synthesis.function_tasks import silent


@pytest.mark.slow
@pytest.mark.parametrize("task", list(function_constraints.tasks(sampled(24), 3)), ids=lambda task: task.name)
def test_all_constraints_a_little_looser_than_a_planted_linkage(task):
    assert task.answered(solve_function(parse_problem(task.statement), silent))


@pytest.mark.slow
@pytest.mark.parametrize("number", further([54, 84], [54]))
def test_members_of_a_family_are_moved_into_narrow_limits(number):
    # Of eight thousand members that are drawn none lies there.
    task = list(function_constraints.tasks(number + 1, 0))[number]
    assert task.answered(solve_function(parse_problem(task.statement), silent))


@pytest.mark.slow
@pytest.mark.parametrize("mechanism", ["fourbar", "slider_crank"])
@pytest.mark.parametrize("criterion", further(["minimax", "least_squares"], ["minimax"]))
def test_an_approximation_keeps_regions_of_its_own_place_without_loss(mechanism, criterion):
    limits = {"min_transmission_angle": 30.0, "max_link_ratio": 8.0}
    statement = {
        "kind": "function",
        "function": {"name": "exponential", "x": [0.0, 1.0]},
        "input_range": 80.0,
        "output_range": 70.0,
        "mechanism": mechanism,
        "criterion": criterion,
        "constraints": limits,
        "max_designs": 1,
    }
    (free,) = solve_function(parse_problem(statement), silent).designs
    joints = free.mechanism.skeleton.joints
    turned = [500.0 + 300.0j + np.exp(2.0j) * complex(*joints[name]) for name in joints]
    still = ("O2", "O4") if "O4" in joints else ("O2",)
    fixed = [z for name, z in zip(joints, turned, strict=True) if name in still]
    moving = [z for name, z in zip(joints, turned, strict=True) if name not in still]
    statement["constraints"] = {
        **limits,
        "fixed_pivot_region": box(fixed, 2.0),
        "moving_pivot_region": box(moving, 2.0),
    }
    (found,) = solve_function(parse_problem(statement), silent).designs
    assert found.verification.passed
    name = "max" if criterion == "minimax" else "rms"
    assert getattr(found.structural_error, name) <= getattr(free.structural_error, name) * (1.0 + 1e-6)


@pytest.mark.parametrize("grashof", ["any", "crank_rocker", "non_grashof"])
@pytest.mark.parametrize("mechanism", ["fourbar", "slider_crank"])
def test_derivatives_of_the_limits(mechanism, grashof):
    if mechanism == "slider_crank" and grashof != "any":
        grashof = "any"
    problem = FunctionProblem(
        kind="function",
        mechanism=mechanism,
        pairs=[{"input": 10.0 * k + 3.0, "output": 7.0 * k + 2.0 - 0.1 * k * k} for k in range(8)],
        constraints={
            "grashof": grashof,
            "min_transmission_angle": 20.0,
            "fixed_pivot_region": {"x": [0.0, 50.0], "y": [0.0, 70.0]},
            "moving_pivot_region": {"x": [10.0, 50.0], "y": [0.0, 70.0]},
            "link_length": {"min": 5.0, "max": 90.0},
        },
    )
    task = make_function_task(problem)
    limits, generators = GeneratorLimits(task), task.samples()
    rng = np.random.default_rng(0)
    for _ in range(5):
        lengths = [1.0, 3.0, 0.2] if problem.slides else [0.8, 1.3, 1.1]
        at = np.array([*lengths, *rng.uniform(-1.0, 1.0, 2), 1.1, 0.9, math.log(40.0), 0.3, 0.2, 0.1])
        slopes = limits.values(at, derivatives=True)[1]
        for j in range(len(at)):
            step = np.zeros(len(at))
            step[j] = 1e-6
            ends = [limits.values(generators.apply_step(at, sign * step))[0] for sign in (1.0, -1.0)]
            assert np.allclose(slopes[:, j], (ends[0] - ends[1]) / 2e-6, atol=1e-5)


@pytest.mark.parametrize("criterion", further(["minimax", "least_squares"], ["minimax"]))
@pytest.mark.campaign
def test_a_sine_over_a_right_angle_is_kept_from_the_change_point(criterion):
    # Crank and coupler of one length draw this sine without error, and meet a change point at its end.
    problem = FunctionProblem(
        kind="function",
        mechanism="slider_crank",
        function={"name": "sine", "x": [0.0, 90.0]},
        input_range=90.0,
        output_range=50.0,
        criterion=criterion,
    )
    # One that can be built precedes the most accurate one.
    best = min(solve_function(problem, silent).designs, key=lambda design: design.structural_error.max)
    assert best.verification.passed
    assert best.metrics.min_transmission_angle >= 30.0
    assert best.structural_error.max <= 0.02
