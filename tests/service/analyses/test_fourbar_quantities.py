"""``include`` of ``POST /v1/analyses``: what only a fourbar has, each against the motion that the service computes."""

import cmath

import numpy as np
import pytest

from tests.support.service.analyses import EXAMPLE, SIXBAR, joint

FOURBAR = EXAMPLE["mechanism"]
EVERYTHING = ["cognates", "centrodes", "curvature", "coupler_curve"]


@pytest.fixture
def found(client):
    answer = client.post("/v1/analyses", json={**EXAMPLE, "include": EVERYTHING})
    assert answer.status_code == 200, answer.text
    return answer.json()


def distances(points, curve):
    """From each point to the nearest of a finely drawn closed curve's segments."""
    start, end = curve[None, :-1], curve[None, 1:]
    share = ((points[:, None] - start) / (end - start)).real.clip(0.0, 1.0)
    return np.abs(points[:, None] - start - share * (end - start)).min(axis=1)


def test_nothing_more_is_given_than_asked_for(client, analyse):
    assert analyse(FOURBAR)["fourbar"] is None
    answer = client.post("/v1/analyses", json={"mechanism": FOURBAR, "motion": {"at": 30.0}, "include": ["centrodes"]})
    assert {name for name, value in answer.json()["fourbar"].items() if value is not None} == {"centrodes"}


@pytest.mark.parametrize("name", ["left", "right", "geared_fivebar"])
def test_cognates_can_be_analysed_and_trace_the_same_curve(analyse, found, name):
    curve = joint(found, "P")
    stated = found["fourbar"]["cognates"][name]
    here = stated["reference_input_angle"]
    moved = analyse(stated, {"from": here - 20.0, "to": here + 20.0, "steps": 40})
    assert all(moved["valid"])
    step = np.abs(np.diff(curve)).max()
    assert distances(joint(moved, "P"), curve).max() < step**2
    at_reference = joint(analyse(stated, {"at": here}), "P")[0]
    reference = joint(analyse(FOURBAR, {"at": 30.0}), "P")[0]
    assert abs(at_reference - reference) < 1e-9


def test_the_parallel_motion_carries_a_link_without_turning_it(analyse, found):
    stated = found["fourbar"]["cognates"]["parallel_motion"]
    moved = analyse(stated, {"from": 0.0, "to": 360.0, "steps": 90})
    assert all(moved["valid"])
    offset = joint(moved, "Q") - joint(moved, "P")
    assert np.ptp(offset.real) < 1e-9
    assert np.ptp(offset.imag) < 1e-9
    assert np.allclose(moved["links"]["translating"]["omega"], 0.0, atol=1e-9)


def test_centrodes_roll_where_the_grounded_links_meet(found):
    at = 40
    o2, a, b, o4 = (joint(found, name)[at] for name in ("O2", "A", "B", "O4"))
    fixed, moving = found["fourbar"]["centrodes"]["fixed"], found["fourbar"]["centrodes"]["moving"]
    pole = complex(fixed["x"][at], fixed["y"][at])
    assert abs(((pole - o2) / (a - o2)).imag) < 1e-9
    assert abs(((pole - o4) / (b - o4)).imag) < 1e-9
    own = complex(moving["x"][at], moving["y"][at])
    assert abs(a + own * (b - a) / abs(b - a) - pole) < 1e-9


def test_curvature_is_that_of_the_motion(found):
    velocity, acceleration = joint(found, "P", "v"), joint(found, "P", "a")
    bend = (velocity.conj() * acceleration).imag / np.abs(velocity) ** 3
    curvature = np.array(found["fourbar"]["curvature"]["curvature"], float)
    assert np.allclose(curvature, bend, rtol=1e-8)
    center = found["fourbar"]["curvature"]["center"]
    away = np.array(center["x"], float) + 1j * np.array(center["y"], float) - joint(found, "P")
    assert np.allclose(np.abs(away) * np.abs(curvature), 1.0, rtol=1e-8)


def test_the_inflection_circle_holds_the_points_that_move_straight(found):
    """A point of the circle, carried by the coupler, has no normal acceleration."""
    at, circle = 100, found["fourbar"]["curvature"]
    center = complex(circle["inflection_center"]["x"][at], circle["inflection_center"]["y"][at])
    point = center + 0.5 * circle["inflection_diameter"][at] * cmath.exp(1.0j)
    a, va, aa = (joint(found, "A", order)[at] for order in ("", "v", "a"))
    omega, alpha = (found["links"]["coupler"][name][at] for name in ("omega", "alpha"))
    velocity = va + 1j * omega * (point - a)
    acceleration = aa + (1j * alpha - omega**2) * (point - a)
    assert abs((velocity.conjugate() * acceleration).imag) < 1e-7 * abs(velocity * acceleration)


def test_the_sextic_vanishes_on_the_curve_and_its_double_points_are_passed_twice(analyse, found):
    curve = found["fourbar"]["coupler_curve"]
    assert curve["degree"] == 6
    grid = np.array(curve["real"]) + 1j * np.array(curve["imaginary"])
    xi = (joint(found, "P") - joint(found, "O2")) / curve["unit"]
    value = sum(grid[j, k] * xi**j * xi.conj() ** k for j in range(4) for k in range(4))
    assert np.abs(value).max() < 1e-12
    for double in curve["double_points"]:
        for passed in double["configurations"]:
            stated = {**FOURBAR, "assembly": passed["assembly"], "reference_input_angle": passed["input_angle"]}
            here = joint(analyse(stated, {"at": passed["input_angle"]}), "P")[0]
            assert abs(here - complex(*double["point"])) < 1e-9
    assert len(curve["double_points"]) in (1, 3)


@pytest.mark.parametrize(
    ("mechanism", "include", "path"),
    [
        (SIXBAR, ["cognates"], "/mechanism"),
        ({**FOURBAR, "coupler_point": {"distance": 0.0}}, ["coupler_curve"], "/mechanism"),
        (FOURBAR, ["everything"], "/include/0"),
        (FOURBAR, "cognates", "/include"),
    ],
)
def test_what_a_mechanism_does_not_have_is_refused(client, mechanism, include, path):
    answer = client.post("/v1/analyses", json={"mechanism": mechanism, "motion": {"at": 30.0}, "include": include})
    assert answer.status_code == 422
    assert path in [error["path"] for error in answer.json()["errors"]]
