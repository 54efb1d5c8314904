"""Trains for a centre distance and pairs of gears through HTTP: together with other demands, drawn, and refused."""

from __future__ import annotations

import csv
import io
import math
from typing import Any

import ezdxf
import httpx
import numpy as np
import pytest

from tests.support.service.answers import finished

Statement = dict[str, Any]

AT_120: Statement = {
    "kind": "gear_train", "ratio": "pi", "max_stages": 2, "teeth": {"min": 17, "max": 100}, "reverted": True,
    "modules": [1.0, 1.25, 1.5, 2.0], "centre_distance": 120.0, "max_designs": 5,
}  # fmt: skip


def designs(client: httpx.Client, **changes: Any) -> tuple[list[Any], str]:
    job = finished(client, {**AT_120, **changes})
    assert job["status"] == "succeeded", job["error"]
    found = job["result"]["designs"]
    assert all(design["verification"]["passed"] for design in found)
    return found, job["id"]


def pairs(design: Any) -> list[tuple[int, int, float]]:
    return [(stage["driver"], stage["driven"], stage["module"]) for stage in design["mechanism"]["stages"]]


def test_demands_together(client: httpx.Client) -> None:
    """Each further demand is kept with all before it, and makes the best train another one."""
    demands: list[Statement] = [
        {},
        {"min_contact_ratio": 1.6},
        {"max_stage_ratio": 1.9},
        {"min_tip_thickness": 0.78},
        {"shift": {"min": -0.4, "max": 0.4}},
        {"hunting_tooth": "require", "max_total_teeth": 270},
    ]
    stated: Statement = {}
    best = []
    for demand in demands:
        stated |= demand
        found, _ = designs(client, **stated)
        best.append(pairs(found[0]))
        for design in found:
            for mesh, stage in zip(design["metrics"]["meshes"], design["mechanism"]["stages"], strict=True):
                assert mesh["contact_ratio"] >= stated.get("min_contact_ratio", 1.2) - 1e-9
                tips = mesh["tip_thickness"].values()
                assert min(tips) / stage["module"] >= stated.get("min_tip_thickness", 0.25) - 1e-9
                limits = stated.get("shift", {"min": -0.5, "max": 1.0})
                assert all(limits["min"] - 1e-9 <= x <= limits["max"] + 1e-9 for x in stage["shift"].values())
                assert mesh["centre_distance"] == pytest.approx(120.0, rel=1e-12)
    assert len({str(one) for one in best}) >= 4


@pytest.mark.slow
def test_the_drawing_shows_shifted_teeth_in_mesh(client: httpx.Client) -> None:
    found, job = designs(client, max_designs=1)
    place = f"/v1/jobs/{job}/designs/0"
    sheet = client.get(f"{place}.svg").text
    assert "profile shifts" in sheet
    assert "0.65528, 0.94635" in sheet
    rows = list(csv.DictReader(io.StringIO(client.get(f"{place}.csv").text)))
    assert [float(row["profile_shift"]) for row in rows][:2] == list(
        found[0]["mechanism"]["stages"][0]["shift"].values()
    )
    document = ezdxf.read(io.StringIO(client.get(f"{place}.dxf").text))
    outlines = [
        np.array([complex(x, y) for x, y in line.get_points("xy")])
        for line in document.modelspace().query("LWPOLYLINE[layer=='STAGE_1_TEETH']")
    ]
    tips = found[0]["metrics"]["meshes"][0]["tip_diameter"]
    centres = [0.0, 120.0]
    for points, centre, tip in zip(outlines, centres, tips.values(), strict=True):
        assert 2.0 * np.abs(points - centre).max() == pytest.approx(tip)
    # Without play a flank of one touches a flank of the other, and no tooth is inside the mate.
    one, other = outlines
    near = other[np.abs(other) < 0.5 * tips["driver"]]
    radius, angle = np.abs(near), np.angle(near)
    order = np.argsort(np.angle(one))
    profile = np.interp(angle, np.angle(one)[order], np.abs(one)[order])
    assert len(near) > 10
    assert (radius - profile).min() > -0.05


def test_a_design_is_analysed_as_it_is(client: httpx.Client) -> None:
    found, _ = designs(client, max_designs=1)
    body = {"mechanism": found[0]["mechanism"], "input_torque": 20.0, "motion": {"at": 0.0, "speed_rpm": 100.0}}
    answer = client.post("/v1/analyses", json=body)
    assert answer.status_code == 200, answer.text
    said = answer.json()
    assert said["centre_distances"] == pytest.approx([120.0, 120.0])
    mesh = said["meshes"][0]
    assert mesh["working_pressure_angle"] == pytest.approx(22.7689, abs=1e-4)
    # The force acts on the working pitch circles, 57 and 100 parts of the distance.
    radius = 0.120 * 57.0 / 157.0
    assert mesh["tangential_force"] == pytest.approx(20.0 / radius)
    assert mesh["radial_force"] == pytest.approx(20.0 / radius * math.tan(math.radians(22.768896)))
    wrong = {**found[0]["mechanism"]}
    wrong["stages"] = [{**wrong["stages"][0], "centre_distance": 121.0}, wrong["stages"][1]]
    refused = client.post("/v1/analyses", json={"mechanism": wrong})
    assert refused.status_code == 422
    assert refused.json()["errors"][0]["path"].endswith("/mechanism/stages/0/centre_distance")


PAIR: Statement = {"type": "gear_pair", "teeth": [20, 50]}


@pytest.mark.parametrize(
    ("field", "value", "told"),
    [
        ("teeth", [21, 50], "centre_distance"),
        ("module", 2.0, "centre_distance"),
        ("shift", [0.3, 0.0], "contact_ratio"),
        ("addendum", [1.0, 0.8], "contact_ratio"),
        ("internal", True, "sound"),
        ("helix_angle", 15.0, "contact_ratio"),
        ("pressure_angle", 25.0, "contact_ratio"),
        ("centre_distance", 35.1, "backlash"),
    ],
)
def test_every_field_of_a_pair_counts(client: httpx.Client, field: str, value: Any, told: str) -> None:
    plain = client.post("/v1/analyses", json={"mechanism": PAIR}).json()
    answer = client.post("/v1/analyses", json={"mechanism": {**PAIR, field: value}})
    assert answer.status_code == 200, answer.text
    assert answer.json()[told] != plain[told]
    helical = {**PAIR, "helix_angle": 15.0, "shift": [0.2, 0.1]}
    together = client.post("/v1/analyses", json={"mechanism": {**helical, field: value}}).json()
    without = client.post("/v1/analyses", json={"mechanism": helical}).json()
    assert (together == without) == (helical.get(field) == value)


def test_face_width_and_cutter_count(client: httpx.Client) -> None:
    helical = {**PAIR, "helix_angle": 15.0}
    wide = client.post("/v1/analyses", json={"mechanism": {**helical, "face_width": 20.0}}).json()
    assert wide["overlap_ratio"] == pytest.approx(20.0 * math.sin(math.radians(15.0)) / math.pi)
    ring = {**PAIR, "teeth": [20, 60], "internal": True, "addendum": [1.0, 0.7]}
    roots = [
        client.post("/v1/analyses", json={"mechanism": {**ring, "shift": [0.3, 0.3], "cutter_teeth": teeth}}).json()
        for teeth in (15, 40)
    ]
    assert roots[0]["gears"][1]["form_diameter"] != roots[1]["gears"][1]["form_diameter"]


def test_a_load_on_a_pair_and_on_a_train(client: httpx.Client) -> None:
    strength = {"power_kw": 3.0, "allowable_bending": [200.0, 180.0], "allowable_contact": [700.0, 650.0]}
    pair = {"type": "gear_pair", "teeth": [17, 52], "module": 2.5}
    said = client.post("/v1/analyses", json={"mechanism": pair, "speed_rpm": 1800.0, "strength": strength}).json()
    gears = said["strength"]["gears"]
    assert min(gear["contact_safety"] for gear in gears) == pytest.approx(1.0)
    assert said["strength"]["face_width"] == said["strength"]["least_face_width"]
    found, _ = designs(client, max_designs=1)
    del strength["power_kw"]
    body = {"mechanism": found[0]["mechanism"], "motion": {"at": 0.0, "speed_rpm": 900.0}, "input_torque": 30.0}
    answer = client.post("/v1/analyses", json={**body, "strength": strength})
    assert answer.status_code == 200, answer.text
    widths = [mesh["strength"]["face_width"] for mesh in answer.json()["meshes"]]
    assert all(width > 0.0 for width in widths)
    assert "strength" not in client.post("/v1/analyses", json=body).json()["meshes"][0]
    refused = client.post(
        "/v1/analyses",
        json={**body, "strength": {"method": "lewis", "allowable_contact": [1.0, 1.0], "factors": {"rim": 1.2}}},
    )
    assert refused.status_code == 422
    paths = {error["path"] for error in refused.json()["errors"]}
    assert {"/strength/allowable_contact", "/strength/factors/rim"} <= paths
    ring = {"type": "gear_pair", "teeth": [20, 60], "internal": True, "addendum": [1.0, 0.75], "module": 2.0}
    stated = {"power_kw": 3.0, "allowable_bending": [200.0, 1.0]}
    refused = client.post("/v1/analyses", json={"mechanism": ring, "speed_rpm": 1000.0, "strength": stated})
    assert [error["path"] for error in refused.json()["errors"]] == ["/strength/allowable_bending"]


@pytest.mark.parametrize(
    ("changes", "path"),
    [
        ({"centre_distance": -1.0}, "centre_distance"),
        ({"centre_distance": {"min": 5.0, "max": 4.0}}, "centre_distance"),
        ({"shift": {"min": 0.5, "max": 0.4}}, "shift"),
        ({"shift": {"min": 0.5}}, "shift/max"),
        ({"min_contact_ratio": 0.5}, "min_contact_ratio"),
        ({"min_tip_thickness": -0.1}, "min_tip_thickness"),
        ({"modules": []}, "modules"),
        ({"modules": [1.0], "module": 2.0}, "modules"),
        ({"centre_distance": [120.0]}, "centre_distance"),
    ],
)
def test_what_is_refused_is_told_by_its_place(client: httpx.Client, changes: Statement, path: str) -> None:
    answer = client.post("/v1/jobs", json={"problem": {**AT_120, **changes}})
    assert answer.status_code == 422, answer.text
    assert any(path in error["path"] for error in answer.json()["errors"])
