"""Overturning moment of slides through HTTP: measured, limited, and what it makes of an offset."""

from __future__ import annotations

import math
from typing import Any

import httpx
import numpy as np
import pytest

from tests.support.service.answers import finished
from tests.support.service.cam_springs import FAST, check, designed, refused

Answer = dict[str, Any]

LOAD = {"mass": 0.5, "spring_rate": 8.0, "preload": 60.0}
ROLLER = {"type": "translating_roller", "roller_radius": 10.0, "overhang": 60.0}
FLAT = {"type": "translating_flat"}


def force(design: Answer) -> np.ndarray:
    """Along the motion, at the angles of the table."""
    s, a = (np.array(design["mechanism"]["program"][name]) for name in "sa")
    return np.asarray(0.5e-3 * (20.0 * math.pi) ** 2 * a + 8.0 * s + 60.0)


def moments(design: Answer) -> np.ndarray:
    """By the formulas, at the angles of the table."""
    s, v = (np.array(design["mechanism"]["program"][name]) for name in "sv")
    follower = design["mechanism"]["follower"]
    offset = follower.get("offset", 0.0)
    if follower["type"] == "translating_flat":
        return np.asarray(force(design) * (v - offset))
    d = math.sqrt(design["mechanism"]["prime_radius"] ** 2 - offset**2)
    return np.asarray(force(design) * (v - offset) / (d + s) * (60.0 - s))


@pytest.mark.parametrize("follower", [ROLLER, {**ROLLER, "offset": 6.0}, FLAT, {**FLAT, "offset": -4.0}])
def test_the_moment_is_that_of_the_table(client: httpx.Client, follower: Answer) -> None:
    for rotation in ("ccw", "cw"):
        design = designed(client, LOAD, follower=follower, rotation=rotation, limits={"overturning_moment": 1e6})
        found = np.abs(moments(design)).max()
        assert design["metrics"]["overturning_moment"] == pytest.approx(found, rel=1e-3)
        assert check(design, "overturning_moment")["value"] == design["metrics"]["overturning_moment"]
        assert check(design, "overturning_on_profile")["value"] == pytest.approx(found, rel=1e-3)


@pytest.mark.slow
def test_a_limit_makes_the_cam_larger_and_a_free_offset_smaller(client: httpx.Client) -> None:
    first = designed(client, LOAD, follower=ROLLER)
    limit = 0.7 * first["metrics"]["overturning_moment"]
    limits = {"overturning_moment": limit}
    larger = designed(client, LOAD, follower=ROLLER, limits=limits)
    assert larger["verification"]["passed"]
    assert larger["metrics"]["overturning_moment"] == pytest.approx(limit, rel=1e-6)
    assert larger["mechanism"]["prime_radius"] > 1.05 * first["mechanism"]["prime_radius"]
    free = designed(client, LOAD, follower={**ROLLER, "offset": "free"}, limits=limits)
    assert free["verification"]["passed"]
    assert free["metrics"]["overturning_moment"] <= limit * (1.0 + 1e-6)
    assert free["mechanism"]["prime_radius"] < 0.98 * larger["mechanism"]["prime_radius"]
    # Beside it no offset has a smaller cam.
    offset = free["mechanism"]["follower"]["offset"]
    for other in (offset - 0.5, offset + 0.5):
        beside = designed(client, LOAD, follower={**ROLLER, "offset": other}, limits=limits)
        assert beside["mechanism"]["prime_radius"] > free["mechanism"]["prime_radius"]
    stated = designed(client, LOAD, follower={**ROLLER, "prime_radius": 50.0}, limits=limits)
    assert not check(stated, "overturning_moment")["passed"]
    assert not check(stated, "overturning_on_profile")["passed"]


def test_a_face_has_the_offset_of_the_least_moment(client: httpx.Client) -> None:
    free = designed(client, LOAD, follower={**FLAT, "offset": "free"})
    least, offset = free["metrics"]["overturning_moment"], free["mechanism"]["follower"]["offset"]
    v, pressed = np.array(free["mechanism"]["program"]["v"]), force(free)
    for other in [*np.linspace(-20.0, 20.0, 81), offset - 0.01, offset + 0.01]:
        assert np.abs(pressed * (v - other)).max() >= least * (1.0 - 1e-4)
    assert least < designed(client, LOAD, follower=FLAT)["metrics"]["overturning_moment"]
    tight = designed(client, LOAD, follower={**FLAT, "offset": "free"}, limits={"overturning_moment": 0.9 * least})
    assert [c["name"] for c in tight["verification"]["checks"] if not c["passed"]] == [
        "overturning_moment",
        "overturning_on_profile",
    ]


@pytest.mark.slow
def test_with_a_free_spring_the_moment_is_that_of_the_chosen_one(client: httpx.Client) -> None:
    dynamics = {"mass": 0.5, "spring_rate": "free", "max_rpm": 700.0, "least_force": 5.0}
    first = designed(client, dynamics, follower=ROLLER)
    limit = 0.8 * first["metrics"]["overturning_moment"]
    design = designed(client, dynamics, follower={**ROLLER, "offset": "free"}, limits={"overturning_moment": limit})
    assert design["verification"]["passed"]
    assert design["metrics"]["forces"] == first["metrics"]["forces"]


@pytest.mark.slow
def test_the_slide_of_a_face_is_drawn_at_its_offset(client: httpx.Client) -> None:
    files = []
    for offset in (0.0, 9.0):
        job = finished(client, {**FAST, "follower": {**FLAT, "offset": offset}})
        place = f"/v1/jobs/{job['id']}/designs/0"
        files.append([client.get(f"{place}.{form}").raise_for_status().content for form in ("svg", "gif")])
        design = job["result"]["designs"][0]
        again = {"mechanism": design["mechanism"], "motion": {"from": 0.0, "to": 360.0, "steps": 12, "speed_rpm": 60.0}}
        assert client.post("/v1/analyses", json=again).status_code == 200
    assert all(first != second for first, second in zip(*files, strict=True))


@pytest.mark.parametrize(
    ("dynamics", "changes", "path"),
    [
        (None, {"follower": FLAT, "limits": {"overturning_moment": 50.0}}, "/limits/overturning_moment"),
        (None, {"follower": {**FLAT, "offset": "free"}}, "/follower/offset"),
        (None, {"follower": ROLLER}, "/follower/overhang"),
        (LOAD, {"limits": {"overturning_moment": 50.0}}, "/follower/overhang"),
        (LOAD, {"follower": {**ROLLER, "overhang": 25.0}}, "/follower/overhang"),
        (LOAD, {"limits": {"overturning_moment": 0.0}}, "/limits/overturning_moment"),
        (
            LOAD,
            {"follower": {"type": "barrel_roller", "roller_radius": 8.0}, "limits": {"overturning_moment": 50.0}},
            "/limits/overturning_moment",
        ),
    ],
)
def test_what_is_refused(client: httpx.Client, dynamics: Any, changes: Answer, path: str) -> None:
    assert f"/problem{path}" in refused(client, dynamics, **changes)
