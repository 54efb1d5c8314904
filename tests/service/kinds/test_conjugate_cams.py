"""Conjugate cams through HTTP: both cams, both rollers at one distance, what pushes when, drawn in every file."""

from __future__ import annotations

from typing import Any

import httpx
import numpy as np
import pytest

from tests.service.stated.cams import CAM
from tests.support.service.answers import finished
from tests.support.service.cam_springs import FAST, designed, refused

Answer = dict[str, Any]

SLIDE = {"type": "translating_roller", "roller_radius": 8.0, "offset": 4.0}
ARM = {"type": "oscillating_roller", "roller_radius": 5.0, "arm": 80.0, "pivot_distance": 100.0}
SWING = [{**segment, **({"lift": 12.0} if "lift" in segment else {})} for segment in CAM["segments"]]
FOLLOWERS: list[Answer] = [
    {"follower": SLIDE},
    {"follower": SLIDE, "rotation": "cw"},
    {"follower": ARM, "segments": SWING},
    {"follower": {**ARM, "sense": -1}, "segments": SWING, "rotation": "cw"},
]


def curve(points: Answer) -> np.ndarray:
    return np.array(points["x"]) + 1j * np.array(points["y"])


def pair(client: httpx.Client, changes: Answer, **more: Any) -> Answer:
    return designed(client, {"mass": 0.5}, closure="conjugate", **changes, **more)


@pytest.mark.slow
@pytest.mark.parametrize("changes", FOLLOWERS, ids=["slide", "slide, clockwise", "arm", "arm of the other sense"])
def test_the_rollers_stand_where_a_rigid_follower_carries_them(client: httpx.Client, changes: Answer) -> None:
    design = pair(client, changes)
    assert design["verification"]["passed"]
    mechanism, second = design["mechanism"], design["mechanism"]["second"]
    first, other = curve(mechanism["pitch_curve"]), curve(second["pitch_curve"])
    distance = np.abs(first - other)
    assert np.ptp(distance) <= 1e-12 * distance.max()
    assert distance[0] == pytest.approx(second["roller_distance"], rel=1e-12)
    # In the ground's frame the slide lies along x, the pivot stands still.
    sense = 1.0 if mechanism["rotation"] == "ccw" else -1.0
    turn = np.exp(1j * sense * np.radians(mechanism["pitch_curve"]["angle"]))
    one, two = first * turn, other * turn
    if "arm_angle" in second:
        angle = np.degrees(np.angle((one - 100.0) / (two - 100.0)))
        assert np.abs(angle) == pytest.approx(second["arm_angle"], abs=1e-9)
        assert np.ptp(angle) <= 1e-9
        assert np.abs(two - 100.0) == pytest.approx(80.0, rel=1e-12)
    else:
        assert np.abs((one - two).imag).max() <= 1e-9
    # The second profile is a roller's radius inside its pitch curve, and both cams are on the shaft.
    profile, radius = curve(second["profile"]), second["follower"]["roller_radius"]
    assert np.abs(profile - other) == pytest.approx(radius, rel=1e-9)
    nearest = [np.abs(profile - centre).min() for centre in other[::20]]
    assert min(nearest) >= radius * (1.0 - 1e-3)


@pytest.mark.slow
def test_limits_hold_for_the_second_cam_as_for_the_first(client: httpx.Client) -> None:
    wide = pair(client, {"follower": SLIDE})
    tight = pair(client, {"follower": SLIDE}, limits={"pressure_angle": 20.0, "hub_radius": 60.0})
    assert tight["verification"]["passed"]
    second = tight["metrics"]["second"]
    assert max(second["max_pressure_angle_rise"], second["max_pressure_angle_fall"]) <= 20.0 + 1e-3
    assert tight["mechanism"]["second"]["prime_radius"] >= 68.0
    assert wide["mechanism"]["second"]["prime_radius"] < 68.0
    by_angle = np.abs(np.degrees(np.angle(_tangents(wide["mechanism"]["second"]))))
    assert by_angle.max() == pytest.approx(30.0, abs=0.05)
    named = {check["name"] for check in wide["verification"]["checks"] if check["name"].startswith("second_")}
    assert {"second_pressure_angle", "second_curvature_ratio", "second_reproduces_program"} <= named
    small = pair(client, {"follower": SLIDE}, limits={"size": 47.0})
    failed = {check["name"] for check in small["verification"]["checks"] if not check["passed"]}
    assert failed == {"size", "second_size"}


def _tangents(second: Answer) -> np.ndarray:
    """The normal of the pitch curve against the slide, from differences of its points."""
    z, angle = curve(second["pitch_curve"]), np.radians(second["pitch_curve"]["angle"])
    step = np.roll(z, -1) - np.roll(z, 1)
    normal = -1j * step / np.abs(step)
    along = -np.exp(-1j * angle)
    return np.asarray(normal / along * np.sign((normal / along).real))


@pytest.mark.slow
def test_the_cam_that_pushes_is_the_one_the_force_asks_for(client: httpx.Client) -> None:
    forces = pair(client, {"follower": SLIDE})["metrics"]["forces"]
    # Without a spring the acceleration alone decides: the first pushes while it is positive.
    assert forces["wall_changes"] == pytest.approx([135.0, 315.0])
    assert [(push["start"], push["cam"]) for push in forces["pushing"]] == [(135.0, 2), (315.0, 1)]
    sprung = designed(client, {"mass": 0.5, "preload": 1e4}, closure="conjugate", follower=SLIDE)["metrics"]["forces"]
    assert sprung["wall_changes"] == []
    assert [push["cam"] for push in sprung["pushing"]] == [1]
    assert "pushing" not in designed(client, {"mass": 0.5}, closure="form", follower=SLIDE)["metrics"]["forces"]


@pytest.mark.campaign
def test_both_cams_are_in_every_file(client: httpx.Client) -> None:
    for changes in FOLLOWERS[::2]:
        job = finished(client, {**FAST, "closure": "conjugate", **changes})
        place = f"/v1/jobs/{job['id']}/designs/0"
        sheet = client.get(f"{place}.svg").raise_for_status().text
        assert sheet.count('data-part="second cam"') == 1
        assert 'data-part="second follower"' in sheet
        assert "SECOND_PROFILE" in client.get(f"{place}.dxf").raise_for_status().text
        table = client.get(f"{place}.csv").raise_for_status().text
        assert "second_profile_x" in table
        moving = client.get(f"{place}.gif").raise_for_status().content
        alone = finished(client, {**FAST, **changes})
        assert moving != client.get(f"/v1/jobs/{alone['id']}/designs/0.gif").content
        report = client.get(f"/v1/jobs/{job['id']}/report.html").raise_for_status().text
        assert "roller distance" in report.lower()
        mechanism = job["result"]["designs"][0]["mechanism"]
        motion = {"from": 0.0, "to": 360.0, "steps": 12, "speed_rpm": 60.0}
        assert client.post("/v1/analyses", json={"mechanism": mechanism, "motion": motion}).status_code == 200


def test_rollers_of_a_range_are_alike_on_both(client: httpx.Client) -> None:
    free = {**SLIDE, "roller_radius": {"min": 5.0, "max": 30.0}, "offset": "free"}
    mechanism = pair(client, {"follower": free}, limits={"pressure_angle": 35.0, "curvature_ratio": 1.5})["mechanism"]
    assert mechanism["follower"]["roller_radius"] == mechanism["second"]["follower"]["roller_radius"] > 5.0


@pytest.mark.parametrize(
    ("changes", "path"),
    [
        ({"follower": {"type": "translating_flat"}}, "/closure"),
        ({"follower": {"type": "oscillating_flat", "pivot_distance": 200.0}, "segments": SWING}, "/closure"),
        ({"follower": {"type": "barrel_roller", "roller_radius": 8.0}}, "/closure"),
        ({"follower": {**SLIDE, "overhang": 60.0}}, "/follower/overhang"),
    ],
)
def test_what_no_pair_of_cams_holds_is_refused(client: httpx.Client, changes: Answer, path: str) -> None:
    assert f"/problem{path}" in refused(client, {"mass": 0.5}, closure="conjugate", **changes)


def test_springs_are_refused_between_two_cams(client: httpx.Client) -> None:
    assert refused(client, {"mass": 0.5, "spring_rate": "free"}, closure="conjugate") == [
        "/problem/dynamics/spring_rate"
    ]
    assert refused(client, {"mass": 0.5, "least_force": 3.0}, closure="conjugate") == ["/problem/dynamics/least_force"]
