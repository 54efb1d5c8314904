"""Forces in the search for motions: what is left out for them, and orders that search on."""

from __future__ import annotations

import numpy as np
import pytest

from kinematics.dynamics.fourbar import compute_peaks
from synthesis.dispatch import solve
from synthesis.mechanisms.fourbar_weights import build_fourbars, build_weights, is_closed_form
from synthesis.model.dynamics.request import DesignDynamics
from synthesis.registry import parse_problem
from synthesis.results.forces import STEP_COUNT, add_forces, apply_link_shape
from tests.service.stated.linkages import BOTH_OPEN, MOTION

PLATE = {"density": 7800.0, "thickness": 10.0, "width": 20.0, "holes": {"A": 8.0}}
BLOCK = {"gravity": {}, "links": PLATE, "point_masses": [{"joint": "P", "mass": 2.0}], "speed_rpm": 60.0}
OPEN = {**MOTION, **BOTH_OPEN, "max_designs": 3}


def answered(**changes):
    return solve(parse_problem({**OPEN, "dynamics": BLOCK, **changes}))


@pytest.fixture(scope="module")
def best():
    return answered(rank_by="drive_torque")


@pytest.mark.slow
def test_an_order_searches_on_and_says_how_far_it_looked(best):
    values = [design.forces.drive_torque.max for design in best.designs]
    assert values == sorted(values)
    usual = answered(max_designs=100).designs
    assert values[0] < 0.8 * min(design.forces.drive_torque.max for design in usual)
    assert not any(check.name == "drive_torque" for design in best.designs for check in design.verification.checks)


def test_a_limit_is_met_that_few_pairs_of_dyads_keep(best):
    limit = 1.05 * best.designs[0].forces.drive_torque.max
    found = answered(constraints={"max_drive_torque": limit}).designs
    assert found
    assert all(design.verification.passed and design.forces.drive_torque.max <= limit for design in found)


def test_what_is_looked_at_is_what_is_measured(best):
    """The closed form against the general equations, with the statement read twice."""
    stated = {
        **BLOCK,
        "links": None,
        "bodies": {
            "input": {"shape": PLATE},
            "coupler": {"mass": 1.5, "cg": [10.0, 20.0], "inertia": 0.002},
            "output": {"mass": 0.7, "cg": {"distance": 15.0, "angle": 30.0}, "inertia": 0.001},
        },
        "loads": [
            {"link": "output", "point": {"distance": 10.0}, "frame": "link", "force": {"constant": [3.0, -4.0]}},
            {"joint": "B", "force": {"constant": [1.0, 2.0]}},
            {"link": "coupler", "torque": {"constant": 0.3}},
        ],
        "moment_about": [5.0, -7.0],
    }
    problem = parse_problem({**OPEN, "dynamics": stated})
    for design in best.designs:
        measured = add_forces(problem, design.model_copy(update={"forces": None})).forces
        joints = design.mechanism.skeleton.joints
        row = np.array([[complex(*joints[name]) for name in ("O2", "A", "B", "O4", "P")]])
        block = apply_link_shape(DesignDynamics.model_validate(stated), {})
        assert is_closed_form(block)
        turned = np.subtract(*design.metrics.used_range[::-1]) if measured.over == "used" else 360.0
        found = compute_peaks(
            build_fourbars(row, np.radians([turned]), 1e-3),
            build_weights(block, row, "mm"),
            60.0 * np.pi / 30.0,
            400 * STEP_COUNT + 1,
        )[0]
        expected = [
            measured.drive_torque.max,
            measured.joint_force.max,
            measured.shaking_force.max,
            measured.shaking_moment.max,
            measured.power.max,
        ]
        assert found == pytest.approx(expected, rel=3e-4)


@pytest.mark.parametrize(
    "other",
    [
        {"springs": [{"torsion": 1.0, "links": ["ground", "output"]}]},
        {"friction": {"pins": {"A": {"mu": 0.1, "radius": 5.0}}}},
        {"loads": [{"joint": "A", "force": {"against_motion": {"forward": 1.0, "backward": 1.0}}}]},
        {"bodies": {"crank": {"mass": 1.0, "cg": [0.0, 0.0]}}},
        {"point_masses": [{"joint": "Q", "mass": 1.0}]},
    ],
    ids=lambda other: next(iter(other)),
)
def test_what_the_closed_form_does_not_know_is_not_looked_at(other):
    assert not is_closed_form(DesignDynamics.model_validate({**BLOCK, **other}))
