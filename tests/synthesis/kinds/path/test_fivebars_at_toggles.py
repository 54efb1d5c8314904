"""Geared fivebars whose motion ends at a toggle: metrics, checks and analysis report one minimum transmission angle."""

import math

import pytest

from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.limits import find_branches, find_reference_branch
from synthesis.analyses import parse_request
from synthesis.kinds.path.slider_cranks_and_fivebars import build_geared_fivebar
from synthesis.kinds.path.verification.linkage import verify_traced
from synthesis.mechanisms.geared_fivebar import GivenGearedFivebar
from synthesis.registry import parse_problem

GIVEN = GivenGearedFivebar.model_validate(
    {
        "type": "geared_fivebar",
        "fixed_pivots": {"input": [0.0, 0.0], "output": [6.0, 0.0]},
        "links": {"input": 1.0, "coupler_1": 7.0, "coupler_2": 9.0, "output": 4.0},
        "gear_ratio": 2.0,
        "phase": 60.0,
        "coupler_point": {"distance": 5.0, "angle": 20.0},
    }
)


@pytest.mark.parametrize("start", [1e-9, 1e-4, 3e-3, 0.1])
def test_a_fivebar_has_one_minimum_transmission_angle(start):
    """The nearer to the toggle the motion begins, the smaller the angle; coarse samples do not see it."""
    mechanism = GIVEN.build_mechanism()
    toggle = find_reference_branch(mechanism, find_branches(mechanism)).low
    inputs = toggle + start, toggle + 1.0, toggle + 3.0
    joints = {name: jet[0] for name, jet in drive(mechanism, inputs, order=0).joints.items()}
    points = [{"x": place.real, "y": place.imag} for place in joints["P"]]
    limits = {"min_transmission_angle": 1.0}
    problem = parse_problem(
        {"kind": "path", "points": points, "mechanism": "geared_fivebar", "gear_ratio": 2.0, "constraints": limits}
    )
    at = {name: complex(places[1]) for name, places in joints.items()}
    made = build_geared_fivebar(*(at[name] for name in ("O2", "A", "C", "B", "O5", "P")), 2.0, inputs[1])
    design = verify_traced(problem, made)
    least = design.metrics.min_transmission_angle
    (check,) = [check for check in design.verification.checks if check.name == "transmission_angle"]
    assert (check.value, check.passed) == (least, least >= 1.0)
    first, last = design.metrics.used_range
    for steps in (2, 7, 360):
        motion = {"from": first, "to": last, "steps": steps}
        answer = parse_request({"mechanism": made.model_dump(mode="json"), "motion": motion}).build_answer()
        assert answer["min_transmission_angle"] == pytest.approx(least, abs=1e-6)
    # Over the whole branch the motion reaches the toggle.
    whole = {"from": first - math.degrees(start) - 1.0, "to": last, "steps": 7}
    answer = parse_request({"mechanism": made.model_dump(mode="json"), "motion": whole}).build_answer()
    assert answer["min_transmission_angle"] == pytest.approx(0.0, abs=1e-3)
