"""Trains that carry a power, through HTTP: with other demands, drawn, posted back, and refused."""

from __future__ import annotations

from typing import Any

import httpx
import pytest

from tests.campaign import further
from tests.support.service.answers import finished

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


@pytest.mark.slow
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


@pytest.mark.slow
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


STOCK = [18, 20, 24, 24, 30, {"teeth": 36, "count": 2}, 60, 72, 80]


@pytest.mark.slow
def test_from_a_stock(client: httpx.Client) -> None:
    stated = {"teeth": None, "stock": STOCK, "tolerance": 0.02}
    result, _ = solved(client, **stated)
    counts = {gear["teeth"]: gear["count"] for gear in STOCK if isinstance(gear, dict)} | {24: 2}
    assert result["designs"]
    for design in result["designs"]:
        gears = [stage[side] for stage in design["mechanism"]["stages"] for side in ("driver", "driven")]
        assert all(gears.count(teeth) <= counts.get(teeth, 1) for teeth in gears)
        assert set(gears) <= {18, 20, 24, 30, 36, 60, 72, 80}
        assert all(stage["face_width"] for stage in design["mechanism"]["stages"])
    assert solved(client, **stated, strength={**LOADED["strength"], "power_kw": 9.0})[0]["designs"] == []


def test_an_idler_is_bent_both_ways(client: httpx.Client) -> None:
    light = {"modules": None, "module": 3.0, "strength": {**LOADED["strength"], "power_kw": 1.0}}
    result, _ = solved(client, ratio="4", direction="same", max_stages=1, **light)
    design = result["designs"][0]
    assert len(design["mechanism"]["idlers"]) == 1
    both = [gear.get("bent_both_ways", False) for mesh in design["metrics"]["strength"] for gear in mesh["gears"]]
    assert both == [False, True, True, False]
    for train in result["pareto"]:
        assert len(train["idlers"]) == 1
        assert train["ratio"]["value"] > 0.0
    turned, _ = solved(client, ratio="4", direction="opposite", max_stages=1, **light)
    assert turned["designs"][0]["mechanism"]["idlers"] == []


def test_shifted_teeth_at_a_distance(client: httpx.Client) -> None:
    stated = {"reverted": True, "centre_distance": 150.0, "tolerance": 0.01}
    wide, narrow = (
        solved(client, **stated, shift={"min": -0.2, "max": most})[0]["designs"][0]["mechanism"]["stages"]
        for most in (0.6, 0.2)
    )
    for stages, most in ((wide, 0.6), (narrow, 0.2)):
        assert [stage["centre_distance"] for stage in stages] == pytest.approx([150.0] * 2)
        assert max(stage["shift"][side] for stage in stages for side in ("driver", "driven")) <= most + 1e-9
    assert wide != narrow


@pytest.mark.slow
@pytest.mark.parametrize("hunting", further(["prefer", "require"], ["require"]))
def test_teeth_that_hunt(client: httpx.Client, hunting: str) -> None:
    """Of trains that carry as well those that hunt come first, or alone."""
    stated = {"tolerance": 0.003, "max_designs": 30}
    usual, _ = solved(client, **stated)
    result, _ = solved(client, **stated, hunting_tooth=hunting)
    told, before = ([one["metrics"]["hunting_tooth"] for one in found["designs"]] for found in (result, usual))
    assert not before[0]
    assert told[0]
    assert all(told) == (hunting == "require")


@pytest.mark.campaign
def test_the_smallest_that_carries(client: httpx.Client) -> None:
    sizes, _ = solved(client, tolerance=0.01, rank_by="size", max_designs=4)
    teeth = [design["metrics"]["total_teeth"] for design in sizes["designs"]]
    assert teeth == sorted(teeth)
    assert teeth[0] == sizes["pareto"][0]["size"]
    errors, _ = solved(client, tolerance=0.01, max_designs=4)
    assert errors["designs"][0]["metrics"]["total_teeth"] > teeth[0]
    assert errors["pareto"] == sizes["pareto"] or not errors["search"]["every_judged"]
    heavy, _ = solved(client, tolerance=0.01, rank_by="size", strength={**LOADED["strength"], "power_kw": 4.5})
    assert heavy["designs"][0]["metrics"]["total_teeth"] > teeth[0], "the smallest does not carry this"


@pytest.mark.slow
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
