"""Helical stages that carry a power, through HTTP: found, posted back, and refused where something is not known."""

from __future__ import annotations

from typing import Any

import httpx
import pytest

from tests.support.service.answers import finished

Statement = dict[str, Any]

STRENGTH: Statement = {
    "power_kw": 8.0, "speed_rpm": 1450.0, "allowable_contact": [800.0, 750.0], "max_face_width": 14.0,
}  # fmt: skip

LOADED: Statement = {
    "kind": "gear_train", "ratio": "9.5", "teeth": {"min": 20, "max": 80}, "tolerance": 0.001, "max_designs": 1,
    "stages": [{"type": "helical", "helix_angle": 18.0}, {"type": "external"}],
    "modules": [1.5, 2.0, 2.5, 3.0, 4.0], "shift": {"min": 0.0, "max": 0.0}, "strength": STRENGTH,
}  # fmt: skip


def best(client: httpx.Client, **changes: Any) -> Any:
    job = finished(client, {**LOADED, **changes})
    assert job["status"] == "succeeded", job["error"]
    return job["result"]["designs"][0]


@pytest.mark.slow
def test_a_helical_stage_carries_its_power_when_it_is_posted_back(client: httpx.Client) -> None:
    design = best(client)
    stages = design["mechanism"]["stages"]
    assert [stage.get("type") for stage in stages] == ["helical", "external"]
    assert design["verification"]["passed"]
    body = {
        "mechanism": design["mechanism"], "motion": {"at": 0.0, "speed_rpm": 1450.0},
        "input_torque": 8000.0 / (1450.0 * 0.10471975511965977), "mesh_efficiency": 1.0,
        "strength": {name: STRENGTH[name] for name in ("allowable_contact", "max_face_width")},
    }  # fmt: skip
    said = client.post("/v1/analyses", json=body).raise_for_status().json()
    for mesh, told, stage in zip(said["meshes"], design["metrics"]["strength"], stages, strict=True):
        assert mesh["strength"]["least_face_width"] == pytest.approx(stage["face_width"])
        assert mesh["strength"].get("sharing_ratio") == pytest.approx(told.get("sharing_ratio"))
        for one, other in zip(mesh["strength"]["gears"], told["gears"], strict=True):
            assert one["contact_stress"] == pytest.approx(other["contact_stress"])
    assert [("sharing_ratio" in told) for told in design["metrics"]["strength"]] == [True, False]


@pytest.mark.slow
def test_the_helix_and_its_factors_count(client: httpx.Client) -> None:
    def made(**changes: Any) -> Any:
        return [(stage["module"], stage["face_width"]) for stage in best(client, **changes)["mechanism"]["stages"]]

    plain = made()
    steeper = [{"type": "helical", "helix_angle": 30.0}, {"type": "external"}]
    assert made(stages=steeper) != plain
    factors = {"bending_geometry": [0.3, 0.3]}
    weak = {**STRENGTH, "allowable_bending": [120.0, 120.0], "factors": factors}
    assert made(strength=weak) != plain
    assert made(strength={**STRENGTH, "factors": {"contact_geometry": 0.11}}) != plain


def test_a_helical_pair_has_stresses(client: httpx.Client) -> None:
    pair = {"type": "gear_pair", "teeth": [20, 50], "module": 2.0, "helix_angle": 18.0, "face_width": 30.0}
    body = {"mechanism": pair, "speed_rpm": 1450.0, "strength": {"power_kw": 3.0}}
    told = client.post("/v1/analyses", json=body).raise_for_status().json()["strength"]
    assert told["gears"][0]["bending_stress"] is None
    spur = client.post("/v1/analyses", json={**body, "mechanism": {**pair, "helix_angle": 0.0}}).json()["strength"]
    assert told["gears"][0]["contact_stress"] < spur["gears"][0]["contact_stress"]


@pytest.mark.parametrize(
    ("changes", "path"),
    [
        ({"strength": {**STRENGTH, "allowable_bending": [200.0, 200.0]}}, "/problem/strength/allowable_bending"),
        ({"strength": {"power_kw": 1.0, "speed_rpm": 9.0, "method": "lewis", "allowable_bending": [200.0, 200.0]}},
         "/problem/strength/method"),
        ({"strength": {**STRENGTH, "max_face_width": 10.0}}, "/problem/strength/max_face_width"),
        ({"stages": [{**LOADED["stages"][0], "face_width": 30.0}, LOADED["stages"][1]]},
         "/problem/stages/0/face_width"),
        ({"stages": [{"type": "bevel", "driver": 20, "driven": 30}, {"type": "external"}], "shift": None,
          "modules": None}, "/problem/stages/0/type"),
    ],
)  # fmt: skip
def test_faults_are_told_where_they_stand(client: httpx.Client, changes: Statement, path: str) -> None:
    reply = client.post("/v1/jobs", json={"problem": {**LOADED, **changes}})
    assert reply.status_code == 422
    assert path in [fault["path"] for fault in reply.json()["errors"]]
