"""Universal joints through HTTP."""

from __future__ import annotations

import math

import pytest


def analysed(client, **stated):
    body = {"mechanism": {"type": "universal_joint", **stated.pop("mechanism")}, **stated}
    return client.post("/v1/analyses", json=body)


def test_one_joint(client):
    """Rao, Solved Problem 4.12: 20°, 1000 rev/min, the driven fork at 45°."""
    at = math.degrees(math.atan(math.cos(math.radians(20.0))))
    stated = {"joints": [{"angle": 20.0}], "inertia": 0.9375}
    answer = analysed(client, mechanism=stated, motion={"at": at, "speed_rpm": 1000.0})
    assert answer.status_code == 200, answer.text
    found = answer.json()
    assert math.isclose(found["output_angle"][0], 45.0, abs_tol=1e-9)
    assert math.isclose(found["output_speed"][0], 104.92, abs_tol=0.005)
    assert math.isclose(found["output_acceleration"][0], -1367.774, abs_tol=0.01)
    assert math.isclose(found["output_torque"][0], -1282.6, abs_tol=0.35)
    assert not found["constant_velocity"]
    assert math.isclose(found["extremes"]["greatest_ratio"], 1.0 / math.cos(math.radians(20.0)))
    assert found["extremes"]["greatest_ratio_at"] == pytest.approx([0.0, 180.0], abs=1e-9)


@pytest.mark.parametrize(("offset", "even"), [(0.0, True), (180.0, True), (90.0, False), (10.0, False)])
def test_the_condition_of_the_double_joint(client, offset, even):
    stated = {"joints": [{"angle": 20.0}, {"angle": 20.0, "offset": offset}]}
    found = analysed(client, mechanism=stated, motion={"steps": 90, "speed": 10.0}).json()
    assert found["constant_velocity"] == even
    spread = max(found["speed_ratio"]) - min(found["speed_ratio"])
    assert (spread < 1e-12) == even
    if offset == 90.0:
        assert math.isclose(math.cos(math.radians(found["equivalent_angle"])), math.cos(math.radians(20.0)) ** 2)


def test_the_largest_angle_within_limits(client):
    """Rao, Solved Problem 4.10: 380 to 420 about 400 rev/min; the book's own 17.964° breaks the upper limit."""
    stated = {"joints": [{"angle": 0.0}]}
    found = analysed(client, mechanism=stated, limits={"least_ratio": 0.95, "greatest_ratio": 1.05}).json()
    assert math.isclose(found["largest_angle"], 17.7528, abs_tol=1e-4)
    found = analysed(client, mechanism=stated, limits={"fluctuation": 0.1}).json()
    assert math.isclose(found["largest_angle"], 17.964, abs_tol=5e-4)
    assert found["constant_velocity"]


@pytest.mark.parametrize(
    ("stated", "path"),
    [
        ({"mechanism": {"joints": [{"angle": 90.0}]}}, "/mechanism/joints/0/angle"),
        ({"mechanism": {"joints": [{"angle": -1.0}]}}, "/mechanism/joints/0/angle"),
        ({"mechanism": {"joints": []}}, "/mechanism/joints"),
        ({"mechanism": {"joints": [{"angle": 5.0, "offset": 3.0}]}}, "/mechanism/joints/0/offset"),
        ({"mechanism": {"joints": [{"angle": 5.0}]}, "limits": {}}, "/limits"),
    ],
)
def test_what_is_refused(client, stated, path):
    answer = analysed(client, **stated)
    assert answer.status_code == 422
    assert path in [error["path"] for error in answer.json()["errors"]]
