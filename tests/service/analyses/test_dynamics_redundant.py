"""Forces of linkages with redundant constraints through ``POST /v1/analyses``."""

from __future__ import annotations

import copy
from typing import Any

import httpx
import numpy as np
import pytest

from tests.support.service.dynamics import asked

Statement = dict[str, Any]

TURN = {"from": 31.0, "to": 391.0, "steps": 72, "speed_rpm": 60.0}
CRANKS: Statement = {
    "type": "skeleton",
    "skeleton": {
        "joints": {
            "O2": [0.0, 0.0],
            "O4": [300.0, 0.0],
            "O6": [500.0, 130.0],
            "A": [60.0, 80.0],
            "B": [360.0, 80.0],
            "C": [560.0, 210.0],
        },
        "links": [
            {"name": "ground", "joints": ["O2", "O4", "O6"]},
            {"name": "input", "joints": ["O2", "A"]},
            {"name": "coupler", "joints": ["A", "B", "C"]},
            {"name": "rocker", "joints": ["O4", "B"]},
            {"name": "third", "joints": ["O6", "C"]},
        ],
        "input_link": "input",
    },
}
BLOCK: Statement = {
    "gravity": {},
    "bodies": {"coupler": {"mass": 2.0, "cg": [300.0, 150.0], "inertia": 0.02}},
    "loads": [{"joint": "C", "force": {"constant": [30.0, -10.0]}}],
}


def test_drive_and_shaking_are_known_and_forces_in_joints_are_not(client: httpx.Client) -> None:
    found = asked(client, CRANKS, BLOCK, motion=TURN)
    assert all(found["valid"])
    assert found["classification"]["mobility"] == 1
    forces = found["dynamics"]
    assert set(forces["status"]) == {"statically_indeterminate"}
    assert forces["checks"]["virtual_work"] < 1e-9
    assert forces["checks"]["momentum"] < 1e-9
    assert all(x is None for on in forces["joints"].values() for force in on.values() for x in force["x"] + force["y"])
    # The coupler moves on a circle: by hand, as if it were a particle at C that carries its weight and the load.
    angle = np.radians(found["input_angle"])
    arm = 0.1 * np.exp(1j * angle)
    expected = -((np.conj(1j * arm) * complex(30.0, -10.0 - 2.0 * 9.80665)).real)
    np.testing.assert_allclose(forces["drive"], expected, atol=1e-11)
    assert any(note.startswith("transmission_angle") for note in found["notes"])


def test_least_forces_are_given_where_they_are_wanted(client: httpx.Client) -> None:
    forces = asked(client, CRANKS, BLOCK | {"minimum_norm": True}, motion=TURN)["dynamics"]
    assert set(forces["status"]) == {"statically_indeterminate"}
    on_coupler = sum(
        complex(forces["joints"][joint]["coupler"]["x"][0], forces["joints"][joint]["coupler"]["y"][0])
        for joint in "ABC"
    )
    acceleration = -0.1 * np.exp(1j * np.radians(31.0)) * (2.0 * np.pi) ** 2
    assert on_coupler == pytest.approx(2.0 * (acceleration + 9.80665j), rel=1e-9)
    assert forces["extremes"]["joints"]["A"]["max"] > 0.0


def test_force_that_is_unique_at_one_position_is_given_there(client: httpx.Client) -> None:
    """Cranks along the line of the first two pivots push in that line; nothing but the third carries across it."""
    joints = asked(client, CRANKS, BLOCK, motion={"at": 180.0, "speed_rpm": 60.0})["dynamics"]["joints"]
    assert joints["B"]["rocker"] == {"x": [None], "y": [None]}
    assert joints["C"]["third"]["x"][0] is not None


GEARS: Statement = {
    "type": "skeleton",
    "skeleton": {
        "joints": {"O": [0.0, 0.0], "P": [50.0, 0.0], "Q": [0.0, 40.0], "R": [-30.0, 0.0]},
        "links": [
            {"name": "ground", "joints": ["O"]},
            {"name": "input", "joints": ["O", "P"]},
            {"name": "second", "joints": ["O", "Q"]},
            {"name": "last", "joints": ["O", "R"]},
        ],
        "gears": [
            {"links": ["input", "second"], "ratio": -2.0},
            {"links": ["second", "last"], "ratio": -0.5},
            {"links": ["input", "last"], "ratio": 1.0},
        ],
        "input_link": "input",
    },
}


def test_gears_between_every_two_of_three_coaxial_links(client: httpx.Client) -> None:
    """How they share a torque is open; what it takes to drive is not, nor what the shaft carries."""
    block = {"loads": [{"link": "last", "torque": {"constant": -6.0}}], "point_masses": [{"joint": "Q", "mass": 2.0}]}
    shared, least = (asked(client, GEARS, block | more, motion=TURN) for more in ({}, {"minimum_norm": True}))
    for found in (shared, least):
        assert set(found["dynamics"]["status"]) == {"statically_indeterminate"}
        np.testing.assert_allclose(found["dynamics"]["drive"], 6.0, rtol=1e-12)
        weight = found["dynamics"]["joints"]["O"]["second"]
        force = np.hypot(np.array(weight["x"], float), np.array(weight["y"], float))
        np.testing.assert_allclose(force, 2.0 * 0.04 * (4.0 * np.pi) ** 2, rtol=1e-9)
    assert all(torque is None for gear in shared["dynamics"]["gears"] for torque in gear["torque"])
    to_second, to_last, direct = (gear["torque"][0] for gear in least["dynamics"]["gears"])
    assert to_last + direct == pytest.approx(6.0)
    assert to_second == pytest.approx(-0.5 * to_last)
    unequal = copy.deepcopy(GEARS)
    unequal["skeleton"]["gears"][2]["ratio"] = 1.01
    refused = client.post("/v1/analyses", json={"mechanism": unequal, "motion": TURN, "dynamics": block})
    assert refused.status_code == 422
    assert [error["path"] for error in refused.json()["errors"]] == ["/mechanism/skeleton"]


def test_bar_on_three_slides_that_one_of_them_drives(client: httpx.Client) -> None:
    """In millimetres: the drive is the weight's and the inertia's share along the slides."""
    skeleton = {
        "joints": {"O": [0.0, -50.0], "A": [0.0, 0.0], "B": [200.0, 30.0], "C": [100.0, 80.0]},
        "links": [{"name": "ground", "joints": ["O"]}, {"name": "bar", "joints": ["A", "B", "C"]}],
        "slides": [
            {"joint": "A", "link": "ground", "point": [0.0, 0.0], "angle": 30.0},
            {"joint": "B", "link": "ground", "point": [200.0, 30.0], "angle": 30.0},
            {"joint": "C", "link": "ground", "point": [100.0, 80.0], "angle": 30.0},
        ],
        "input_link": "A",
    }
    block = {"gravity": {}, "bodies": {"bar": {"mass": 3.0, "cg": [90.0, 40.0], "inertia": 0.1}}}
    motion = {"from": -500.0, "to": 500.0, "steps": 4, "speed": 100.0, "acceleration": 2000.0}
    found = asked(client, {"type": "skeleton", "skeleton": skeleton}, block, motion=motion)["dynamics"]
    assert set(found["status"]) == {"statically_indeterminate"}
    np.testing.assert_allclose(found["drive"], 3.0 * (2.0 + 9.80665 * 0.5), rtol=1e-9)
    assert found["checks"]["virtual_work"] < 1e-9
    assert found["checks"]["momentum"] < 1e-9
    assert all(normal is None for slide in found["slides"] for normal in slide["normal"])


def test_with_as_many_constraints_as_needed_the_field_changes_nothing(client: httpx.Client) -> None:
    two = copy.deepcopy(CRANKS)
    links = two["skeleton"]["links"]
    links.pop()
    links[0]["joints"].pop()
    two["skeleton"]["joints"].pop("O6")
    plain, least = (asked(client, two, block, motion=TURN) for block in (BLOCK, BLOCK | {"minimum_norm": True}))
    assert plain == least


def changed(**places: list[float]) -> Statement:
    mechanism = copy.deepcopy(CRANKS)
    mechanism["skeleton"]["joints"] |= places
    return mechanism


LOOSE = copy.deepcopy(CRANKS)
LOOSE["skeleton"]["joints"]["Q"] = [400.0, 300.0]
LOOSE["skeleton"]["links"].append({"name": "tail", "joints": ["C", "Q"]})


@pytest.mark.parametrize(
    ("mechanism", "block", "path"),
    [
        (changed(O6=[500.0, 131.0]), BLOCK, "/mechanism/skeleton"),
        (changed(C=[563.0, 214.0]), BLOCK, "/mechanism/skeleton"),
        (LOOSE, BLOCK, "/mechanism"),
        (CRANKS, BLOCK | {"friction": {"pins": {"A": {"mu": 0.1, "radius": 5.0}}}}, "/dynamics/friction"),
        (CRANKS, BLOCK | {"report": ["joint_force_index"]}, "/dynamics/report"),
        (CRANKS, BLOCK | {"minimum_norm": "yes"}, "/dynamics/minimum_norm"),
    ],
)
def test_what_is_no_mechanism_or_not_determined_is_refused_at_the_field(
    client: httpx.Client, mechanism: Statement, block: Statement, path: str
) -> None:
    answer = client.post("/v1/analyses", json={"mechanism": mechanism, "motion": TURN, "dynamics": block})
    assert answer.status_code == 422, answer.text
    assert path in [error["path"] for error in answer.json()["errors"]], answer.text
