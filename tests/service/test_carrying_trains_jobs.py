"""Trains that carry a power, through HTTP: with other demands, drawn, posted back, and refused."""

from __future__ import annotations

from typing import Any

import httpx
import pytest

from tests.service.answers import finished

Statement = dict[str, Any]

LOADED: Statement = {
    "kind": "gear_train", "ratio": "12", "max_stages": 2, "teeth": {"min": 18, "max": 90},
    "modules": [1.5, 2.0, 2.5, 3.0], "tolerance": 0.001, "max_designs": 2,
    "strength": {
        "power_kw": 3.0, "speed_rpm": 1450.0, "allowable_bending": [200.0, 180.0], "allowable_contact": [800.0, 750.0],
        "max_face_width": 12.0,
    },
}  # fmt: skip


def solved(client: httpx.Client, **changes: Any) -> tuple[Any, str]:
    job = finished(client, {**LOADED, **changes})
    assert job["status"] == "succeeded", job["error"]
    return job["result"], job["id"]


def test_a_design_carries_its_power_when_it_is_posted_back(client: httpx.Client) -> None:
    result, job = solved(client)
    design = result["designs"][0]
    stages = design["mechanism"]["stages"]
    assert all(stage["face_width"] <= 12.0 * stage["module"] * (1.0 + 1e-9) for stage in stages)
    assert stages[0]["module"] < stages[1]["module"], "the slow shaft has more torque"
    assert "first estimate" in result["summary"]
    torque = 3000.0 / (1450.0 * 0.10471975511965977)
    strength = {name: LOADED["strength"][name] for name in ("allowable_bending", "allowable_contact", "max_face_width")}
    body = {
        "mechanism": design["mechanism"], "motion": {"at": 0.0, "speed_rpm": 1450.0}, "input_torque": torque,
        "mesh_efficiency": 1.0, "strength": strength,
    }  # fmt: skip
    said = client.post("/v1/analyses", json=body).raise_for_status().json()
    for mesh, told, stage in zip(said["meshes"], design["metrics"]["strength"], stages, strict=True):
        assert mesh["strength"]["face_width"] == stage["face_width"]
        assert mesh["strength"]["least_face_width"] == pytest.approx(stage["face_width"])
        for one, other in zip(mesh["strength"]["gears"], told["gears"], strict=True):
            assert one["bending_stress"] == pytest.approx(other["bending_stress"])
            assert one["contact_stress"] == pytest.approx(other["contact_stress"])
    sheet = client.get(f"/v1/jobs/{job}/designs/0.svg").text
    assert "face width, a first estimate" in sheet


def test_with_other_demands(client: httpx.Client) -> None:
    """Each demand is kept with those before it."""
    stated: Statement = {}
    best = []
    for demand in [
        {"reverted": True},
        {"max_stage_ratio": 4.0},
        {"hunting_tooth": "require", "tolerance": 0.005},
        {"max_total_teeth": 200},
    ]:
        stated |= demand
        result, _ = solved(client, **stated)
        assert result["designs"], result["summary"]
        best.append(result["designs"][0]["mechanism"]["stages"])
        for design in result["designs"]:
            assert design["verification"]["passed"]
            assert {"strength", "relative_face_width", "coaxial"} <= {
                check["name"] for check in design["verification"]["checks"]
            }
    assert best[0] != best[-1]
    weak, _ = solved(client, **stated, modules=[0.5])
    assert weak["designs"] == []
    assert "carries 3 kW" in weak["summary"]


def test_inches_are_inches(client: httpx.Client) -> None:
    metric, _ = solved(client, modules=[2.54], max_designs=1)
    inches, _ = solved(client, modules=[0.1], max_designs=1, length_unit="in")
    one, other = (result["designs"][0]["mechanism"]["stages"] for result in (metric, inches))
    assert [stage["face_width"] for stage in one] == pytest.approx([25.4 * stage["face_width"] for stage in other])


def test_without_strength_nothing_of_it_is_told(client: httpx.Client) -> None:
    result, _ = solved(client, strength=None)
    assert "strength" not in result["designs"][0]["metrics"]
    assert "face_width" not in result["designs"][0]["mechanism"]["stages"][0]


@pytest.mark.parametrize(
    ("changes", "path"),
    [
        ({"power_kw": 0.0}, "/strength/power_kw"),
        ({"speed_rpm": -5.0}, "/strength/speed_rpm"),
        ({"speed_rpm": None}, "/strength/speed_rpm"),
        ({"allowable_bending": [200.0]}, "/strength/allowable_bending"),
        ({"allowable_bending": None, "allowable_contact": None}, "/strength/allowable_bending"),
        ({"max_face_width": 0.5}, "/strength/max_face_width"),
        ({"method": "iso"}, "/strength/method"),
        ({"method": "lewis"}, "/strength/allowable_contact"),
        ({"method": "lewis", "allowable_contact": None, "factors": {"rim": 1.2}}, "/strength/factors/rim"),
        ({"factors": {"dynamics": 1.2}}, "/strength/factors/dynamics"),
        ({"face_width": 20.0}, "/strength/face_width"),
    ],
)
def test_what_is_refused_is_told_by_its_place(client: httpx.Client, changes: Statement, path: str) -> None:
    answer = client.post("/v1/jobs", json={"problem": {**LOADED, "strength": {**LOADED["strength"], **changes}}})
    assert answer.status_code == 422, answer.text
    assert any(path in error["path"] for error in answer.json()["errors"])
