"""Planetary trains that carry a power, through HTTP: posted back, drawn, field by field, and refused."""

from __future__ import annotations

import copy
import math
from typing import Any

import httpx
import pytest

from tests.service.stated.row import changed
from tests.support.service.answers import finished

Statement = dict[str, Any]

STRENGTH: Statement = {
    "power_kw": 5.0, "speed_rpm": 1450.0, "allowable_bending": [200.0, 200.0], "allowable_contact": [800.0, 800.0],
    "max_face_width": 12.0,
}  # fmt: skip
LOADED: Statement = {
    "kind": "planetary_train", "ratio": 5.5, "arrangement": "simple", "input": "sun", "output": "carrier",
    "fixed": "ring", "teeth": {"min": 17, "max": 60, "ring_max": 130}, "modules": [1.0, 1.5, 2.0, 2.5],
    "tolerance": 0.01, "max_designs": 2, "strength": STRENGTH,
}  # fmt: skip
GIVEN = {name: STRENGTH[name] for name in ("allowable_bending", "allowable_contact", "max_face_width")}
TRAIN: Statement = {
    "type": "planetary_train", "arrangement": "simple", "teeth": {"sun": 24, "planet": 42, "ring": 108},
    "input": "sun", "output": "carrier", "fixed": "ring", "planets": 3, "module": 2.0,
}  # fmt: skip
ASKED: Statement = {
    "mechanism": TRAIN, "motion": {"at": 0.0, "speed_rpm": 1450.0}, "torques": {"sun": 30.0}, "strength": GIVEN,
}  # fmt: skip


def solved(client: httpx.Client, **changes: Any) -> tuple[Any, str]:
    job = finished(client, {**LOADED, **changes})
    assert job["status"] == "succeeded", job["error"]
    return job["result"], job["id"]


def test_a_design_carries_its_power_when_it_is_posted_back(client: httpx.Client) -> None:
    result, job = solved(client)
    design = result["designs"][0]
    mechanism = design["mechanism"]
    assert mechanism["module"] == 1.5
    assert mechanism["face_widths"][0] <= 12.0 * 1.5
    assert "first estimate" in result["summary"]
    assert result["search"]["every_judged"]
    body = {
        "mechanism": mechanism, "motion": {"at": 0.0, "speed_rpm": 1450.0}, "mesh_efficiency": 1.0, "strength": GIVEN,
        "torques": {"sun": 5000.0 / (1450.0 * math.pi / 30.0)},
    }  # fmt: skip
    said = client.post("/v1/analyses", json=body).raise_for_status().json()
    for mesh, told in zip(said["meshes"], design["metrics"]["meshes"], strict=True):
        assert mesh["strength"]["face_width"] == mechanism["face_widths"][0]
        for one, other in zip(mesh["strength"]["gears"], told["strength"]["gears"], strict=True):
            assert one["bending_stress"] == pytest.approx(other["bending_stress"])
            assert one["contact_stress"] == pytest.approx(other["contact_stress"])
            assert one.get("bending_judged") == other.get("bending_judged")
    least = max(mesh["strength"]["least_face_width"] for mesh in said["meshes"])
    assert least == pytest.approx(mechanism["face_widths"][0])
    sheet = client.get(f"/v1/jobs/{job}/designs/0.svg").text
    assert "face width, a first estimate" in sheet


def test_without_strength_nothing_of_it_is_told(client: httpx.Client) -> None:
    result, _ = solved(client, strength=None, modules=None)
    assert "judged" not in result["search"]
    assert "face_widths" not in result["designs"][0]["mechanism"]
    assert "module" not in result["pareto"][0]
    assert "strength" not in result["designs"][0]["metrics"]["meshes"][0]


@pytest.mark.slow
def test_all_arrangements_are_those_of_spur_gears(client: httpx.Client) -> None:
    stated = {"arrangement": "auto", "teeth": {"min": 17, "max": 24, "ring_max": 80}, "ratio": -1.0, "modules": [4.0]}
    members = dict.fromkeys(("input", "output", "fixed"))
    plain, _ = solved(client, **{**stated, "modules": None, "strength": None, **members})
    result, _ = solved(client, **stated, **members)
    assert plain["designs"][0]["mechanism"]["arrangement"] == "bevel_differential"
    assert result["designs"]
    assert "bevel_differential" not in {design["mechanism"]["arrangement"] for design in result["designs"]}


def test_inches_are_inches(client: httpx.Client) -> None:
    metric, _ = solved(client, modules=[2.54], max_designs=1)
    inches, _ = solved(client, modules=[0.1], max_designs=1, length_unit="in")
    one, other = (result["designs"][0]["mechanism"] for result in (metric, inches))
    assert one["face_widths"] == pytest.approx([25.4 * width for width in other["face_widths"]])


@pytest.mark.parametrize(
    ("place", "value"),
    [
        ("strength.method", "lewis"),
        ("strength.quality", 9.0),
        ("strength.allowable_bending", [50.0, 50.0]),
        ("strength.allowable_contact", [700.0, 700.0]),
        ("strength.max_face_width", 2.0),
        ("strength.load_sharing", 1.2),
        ("strength.factors.overload", 1.25),
        ("strength.factors.form", [0.3, 0.4]),
        ("strength.factors.dynamic", 1.5),
        ("strength.factors.size", [1.2, 1.1]),
        ("strength.factors.load_distribution", 1.5),
        ("strength.factors.rim", 1.2),
        ("strength.factors.bending_geometry", [0.3, 0.4]),
        ("strength.factors.contact_geometry", 0.1),
        ("strength.factors.elastic", 160.0),
        ("length_unit", "cm"),
        ("torques.sun", 40.0),
        ("mesh_efficiency", 0.9),
        ("mechanism.face_widths", [20.0]),
        ("mechanism.planets", 4),
        ("mechanism.module", 2.5),
        ("mechanism.pressure_angle", 25.0),
        ("mechanism.addendum.ring", 0.8),
    ],
)
def test_a_field_of_the_analysis_changes_the_stresses(client: httpx.Client, place: str, value: Any) -> None:
    base = copy.deepcopy(ASKED)
    if value == "lewis":
        base["strength"].pop("allowable_contact")
    one, other = (
        client.post("/v1/analyses", json=body).raise_for_status().json()
        for body in (base, changed(base, {place: value}))
    )
    told = [[mesh["strength"] for mesh in answer["meshes"]] for answer in (one, other)]
    assert told[0] != told[1]


@pytest.mark.parametrize(
    ("changes", "path"),
    [
        ({"strength.power_kw": 0.0}, "/strength/power_kw"),
        ({"strength.speed_rpm": None}, "/strength/speed_rpm"),
        ({"strength.allowable_bending": None, "strength.allowable_contact": None}, "/strength/allowable_bending"),
        ({"strength.method": "lewis"}, "/strength/allowable_contact"),
        ({"strength.load_sharing": 0.9}, "/strength/load_sharing"),
        ({"strength.load_sharing": 3.1}, "/strength/load_sharing"),
        ({"strength.factors": {"dynamics": 1.2}}, "/strength/factors/dynamics"),
        ({"strength": None}, "/modules"),
        ({"module": 2.0}, "/modules"),
        ({"modules": [2.0, 2.0]}, "/modules"),
        ({"modules": []}, "/modules"),
        ({"arrangement": "bevel_differential", "input": None, "output": None, "fixed": None}, "/strength"),
    ],
)
def test_what_is_refused_is_told_by_its_place(client: httpx.Client, changes: Statement, path: str) -> None:
    answer = client.post("/v1/jobs", json={"problem": changed(LOADED, changes)})
    assert answer.status_code == 422, answer.text
    assert any(path in error["path"] for error in answer.json()["errors"])


@pytest.mark.parametrize(
    ("changes", "path"),
    [
        ({"mechanism.module": None}, "/mechanism/module"),
        ({"mechanism.planets": None}, "/mechanism/planets"),
        ({"mechanism.planets": 0}, "/mechanism/planets"),
        ({"mechanism.addendum": {"moon": 1.0}}, "/mechanism/addendum/moon"),
        ({"mechanism.face_widths": [20.0, 20.0]}, "/mechanism/face_widths"),
        ({"mechanism.teeth.ring": 110}, "/mechanism/teeth"),
        ({"mechanism.input": None, "speeds": {"sun": 1.0, "ring": 0.0}}, "/mechanism/input"),
        ({"speeds": {"sun": 1.0, "ring": 0.0}}, "/speeds"),
        ({"locked": [["sun", "carrier"]]}, "/locked"),
        ({"torques": None}, "/strength"),
        ({"motion": {"at": 0.0, "speed_rpm": 0.0}}, "/strength"),
        ({"strength": {}}, "/mechanism/face_widths"),
        ({"strength.load_sharing": 4.0}, "/strength/load_sharing"),
        ({"strength.method": "lewis"}, "/strength/allowable_contact"),
        ({"strength.power_kw": 5.0}, "/strength/power_kw"),
    ],
)
def test_what_the_analysis_refuses(client: httpx.Client, changes: Statement, path: str) -> None:
    answer = client.post("/v1/analyses", json=changed(ASKED, changes))
    assert answer.status_code == 422, answer.text
    assert any(path in error["path"] for error in answer.json()["errors"])


def test_meshes_of_ones_own_are_not_judged(client: httpx.Client) -> None:
    meshes = [
        {"first": "sun", "second": "planet", "carrier": "carrier", "first_teeth": 24, "second_teeth": 42},
        {
            "first": "planet",
            "second": "ring",
            "carrier": "carrier",
            "first_teeth": 42,
            "second_teeth": 108,
            "internal": True,
        },
    ]
    given = {**TRAIN, "arrangement": None, "teeth": None, "meshes": meshes, "planet_bodies": ["planet"]}
    answer = client.post("/v1/analyses", json={**ASKED, "mechanism": given})
    assert answer.status_code == 422
    assert "/strength" in answer.json()["errors"][0]["path"]
    bevel = {**TRAIN, "arrangement": "bevel_differential", "teeth": {"side_1": 20, "planet": 20, "side_2": 20}}
    bevel |= {"input": "side_1", "fixed": "side_2"}
    assert (
        client.post("/v1/analyses", json={**ASKED, "mechanism": bevel, "torques": {"side_1": 3.0}}).status_code == 422
    )
