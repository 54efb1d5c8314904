"""Forces of designs through HTTP: as part of an answer, demanded, ordered by, and asked for of a finished design."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

from synthesis.model.linkage.problem import FORCE_NAMES
from tests.service.stated.linkages import DWELL, MOTION, PARALLEL, QUICK_RETURN, STEERING
from tests.support.service.answers import finished

G = 9.80665
PLATE = {"density": 7800.0, "thickness": 10.0, "width": 2.0, "holes": {"A": 0.5}}
BLOCK = {
    "gravity": {"magnitude": G, "angle": 270.0},
    "links": PLATE,
    "loads": [{"joint": "A", "force": {"constant": [3.0, -12.0]}}],
    "speed_rpm": 120.0,
}
PAYLOAD = {"gravity": {}, "point_masses": [{"joint": "P", "mass": 2.0}], "speed_rpm": 1e-3}
ACKERMANN = {**STEERING, "mechanism": "ackermann"}
PEAKS = {"drive_torque", "joint_force", "shaking_force", "shaking_moment", "power", "joint_force_index"}


def designs(client, problem):
    job = finished(client, problem)
    assert job["status"] == "succeeded", job["error"]
    return job, job["result"]["designs"]


def forces_of(client, job, n, body=None, steps=360):
    path = f"/v1/jobs/{job['id']}/designs/{n}/forces"
    answer = (
        client.get(path, params={"steps": steps})
        if body is None
        else client.post(path, json=body, params={"steps": steps})
    )
    assert answer.status_code == 200, answer.text
    return answer.json()


@pytest.mark.slow
@pytest.mark.parametrize("problem", [MOTION, QUICK_RETURN, ACKERMANN, DWELL, PARALLEL], ids=lambda x: x["kind"])
def test_every_design_has_its_forces_as_an_analysis_of_the_skeleton_finds_them(client, problem):
    job, found = designs(client, {**problem, "dynamics": BLOCK, "max_designs": 2})
    assert found
    for n, design in enumerate(found):
        forces = design["forces"]
        assert set(forces) - {"remark"} >= PEAKS, forces
        moved = client.get(f"/v1/jobs/{job['id']}/designs/{n}/motion").json()
        skeleton = design["mechanism"]["skeleton"]
        bodies = {}
        for link in skeleton["links"]:
            if link["name"] != "ground":
                holes = {joint: 0.5 for joint in link["joints"] if joint == "A"}
                bodies[link["name"]] = {"shape": {**PLATE, "holes": holes}}
        start = moved["input_angle"][0]
        ends = (start, start + 360.0) if forces["over"] == "cycle" else design["metrics"]["used_range"]
        body = {
            "mechanism": {"type": "skeleton", "skeleton": skeleton},
            "motion": {"from": ends[0], "to": ends[1], "steps": 1440, "speed_rpm": 120.0},
            "length_unit": job["problem"]["length_unit"],
            "dynamics": {
                **{name: BLOCK[name] for name in ("gravity", "loads")},
                "bodies": bodies,
                "report": ["drive", "shaking", "joint_forces", "joint_force_index"],
            },
        }
        answer = client.post("/v1/analyses", json=body)
        assert answer.status_code == 200, answer.text
        there = answer.json()["dynamics"]
        near = pytest.approx
        assert forces["drive_torque"]["max"] == near(np.abs(there["drive"]).max(), rel=1e-3)
        force = np.hypot(there["shaking"]["force"]["x"], there["shaking"]["force"]["y"])
        assert forces["shaking_force"]["max"] == near(force.max(), rel=1e-3)
        assert forces["shaking_moment"]["max"] == near(np.abs(there["shaking"]["moment"]).max(), rel=1e-3)
        assert forces["power"]["max"] == near(np.abs(there["drive"]).max() * 4.0 * math.pi, rel=1e-3)
        loads = [np.hypot(f["x"], f["y"]).max() for on in there["joints"].values() for f in on.values()]
        assert forces["joint_force"]["max"] == near(max(loads), rel=1e-3)
        assert forces["joint_force_index"] == near(max(there["joint_force_index"]), rel=1e-3)


def test_a_payload_that_is_lifted_slowly_takes_the_torque_of_its_rise(client):
    job, found = designs(client, {**MOTION, "dynamics": PAYLOAD})
    for n, design in enumerate(found):
        forces = design["forces"]
        answer = forces_of(client, job, n, steps=2000)
        # By virtual work: torque is weight times rise over rotation, whatever the linkage.
        rise = np.array(answer["joints"]["P"]["vy"]) / (1e-3 * math.tau / 60.0)
        assert forces["drive_torque"]["max"] == pytest.approx(2.0 * G * 1e-3 * np.abs(rise).max(), rel=1e-4)
        assert forces["power"]["max"] == pytest.approx(forces["drive_torque"]["max"] * 1e-3 * math.tau / 60.0)


def test_what_a_slide_drives_has_a_force(client):
    _, found = designs(client, {**STEERING, "dynamics": PAYLOAD | {"point_masses": [{"joint": "A", "mass": 1.0}]}})
    for design in found:
        assert design["forces"]["remark"] == "/dynamics/speed: the input of this linkage slides; give its speed"
    block = {"links": {"density": 7800.0, "thickness": 10.0, "width": 40.0}, "speed": 100.0}
    job, found = designs(client, {**STEERING, "dynamics": block})
    assert found
    for n, design in enumerate(found):
        forces = design["forces"]
        assert "drive_torque" not in forces
        drive = np.abs(forces_of(client, job, n, steps=720)["dynamics"]["drive"])
        assert forces["drive_force"]["max"] == pytest.approx(drive.max(), rel=1e-4)
        assert forces["power"]["max"] == pytest.approx(0.1 * drive.max(), rel=1e-4), "100 mm/s"
    limited = {**STEERING, "dynamics": block, "constraints": {"max_drive_torque": 1.0}}
    refused = client.post("/v1/jobs", json={"problem": limited})
    assert [error["path"] for error in refused.json()["errors"]] == ["/problem/constraints/max_drive_torque"]


QUICK_RETURN_SLIDER = {"kind": "quick_return", "time_ratio": 1.25, "stroke": 45.0, "max_designs": 1}


def test_peaks_stand_at_an_angle_or_at_a_place_of_an_input_that_slides(client):
    both = {**BLOCK, "speed": 50.0}
    for sliding, stated, unit in (
        (False, {**QUICK_RETURN_SLIDER}, "°"),
        (True, {**MOTION, "input_side": {"dyad": "PR"}, "output_side": {}, "max_designs": 1}, "mm"),
    ):
        job, found = designs(client, {**stated, "dynamics": {**both, "loads": []}})
        assert found
        for design in found:
            drive = design["forces"]["drive_force" if sliding else "drive_torque"]
            assert drive.keys() == {"max", "at_place" if sliding else "at"}
            low, high = sorted(design["metrics"]["used_stroke" if sliding else "used_range"])
            if design["forces"]["over"] == "used":
                assert low - 1e-9 <= drive["at_place" if sliding else "at"] <= high + 1e-9
        report = client.get(f"/v1/jobs/{job['id']}/report.html").text
        rows = re.findall(r"power: at(?: place)?<.*?</tr>", report, re.DOTALL)
        assert rows
        assert all(re.search(rf"\d\s*{unit}", re.sub("<[^>]*>", " ", row)) for row in rows), rows


def test_a_torque_of_an_input_that_slides_is_refused(client):
    stated = {**MOTION, "input_side": {"dyad": "PR"}, "dynamics": {**BLOCK, "speed": 50.0}}
    for demand, path in (
        ({"constraints": {"max_drive_torque": 1.0}}, "/problem/constraints/max_drive_torque"),
        ({"rank_by": "drive_torque"}, "/problem/rank_by"),
    ):
        refused = client.post("/v1/jobs", json={"problem": {**stated, **demand}})
        assert refused.status_code == 422, refused.text
        assert path in [error["path"] for error in refused.json()["errors"]]


@pytest.mark.parametrize("name", sorted(FORCE_NAMES))
def test_each_limit_is_kept_and_each_order_is_held(client, name):
    asked = {**MOTION, "dynamics": BLOCK, "max_designs": 4}
    job, ordered = designs(client, {**asked, "rank_by": name})

    def value(design):
        found = design["forces"][name]
        return found if isinstance(found, float) else found["max"]

    values = [value(design) for design in ordered]
    assert values == sorted(values)
    assert f"Ranked by {name.replace('_', ' ')} (" in job["result"]["summary"]
    limit = 1.05 * values[0]
    job, kept = designs(client, {**asked, "constraints": {f"max_{name}": limit}})
    assert kept, job["result"]["summary"]
    for design in kept:
        assert value(design) <= limit
        (check,) = [check for check in design["verification"]["checks"] if check["name"] == name]
        assert (check["passed"], check["value"], check["limit"]) == (True, value(design), limit)


def test_a_limit_out_of_reach_is_told_with_its_gap(client):
    asked = {**MOTION, "dynamics": PAYLOAD, "constraints": {"max_drive_torque": 1e-6}}
    job, found = designs(client, asked)
    assert found == []
    miss = job["result"]["nearest_miss"]
    (gap,) = miss["gaps"]
    assert (gap["check"], gap["limit"]) == ("drive_torque", 1e-6)
    assert gap["value"] == miss["design"]["forces"]["drive_torque"]["max"] > 1e-6
    assert "drive_torque" in job["result"]["search"]["rejected"]


def test_without_the_block_there_are_no_forces(client):
    job, found = designs(client, QUICK_RETURN)
    assert job["problem"]["dynamics"] is None
    assert all("forces" not in design for design in found)
    refused = client.get(f"/v1/jobs/{job['id']}/designs/0/forces")
    assert (refused.status_code, refused.json()["type"]) == (409, "/problems/no-forces")
    answer = forces_of(client, job, 0, {"dynamics": {**BLOCK, "report": ["drive", "flywheel"]}}, steps=36)
    assert len(answer["input_angle"]) == 37
    assert answer["dynamics"]["flywheel"]["energy"] > 0.0
    assert "joints" not in answer["dynamics"]


def test_a_body_that_a_design_does_not_have_is_named(client):
    body = {"mass": 1.0, "cg": [0.0, 0.0]}
    misnamed = {**MOTION, "dynamics": {**PAYLOAD, "bodies": {"coupller": body}}}
    job, found = designs(client, {**misnamed, "constraints": {"max_power": 1.0}})
    assert found == []
    assert "forces are not known: /dynamics/bodies/coupller: no link in motion" in job["result"]["summary"]
    job, found = designs(client, misnamed)
    assert found
    for design in found:
        assert design["forces"]["remark"].startswith("/dynamics/bodies/coupller: no link in motion")
        assert set(design["forces"]) == {"units", "remark"}
    refused = client.get(f"/v1/jobs/{job['id']}/designs/0/forces")
    assert (refused.status_code, refused.json()["type"]) == (409, "/problems/no-forces")
    path = f"/v1/jobs/{job['id']}/designs/0/forces"
    for block, pointer in [
        ({**PAYLOAD, "bodies": {"coupller": body}}, "/dynamics/bodies/coupller"),
        ({**PAYLOAD, "speed_rpm": None}, "/dynamics"),
        ({**PAYLOAD, "point_masses": [{"joint": "Q", "mass": 1.0}]}, "/dynamics/point_masses/0/joint"),
        ({**PAYLOAD, "links": {"density": -1.0, "thickness": 1.0, "width": 1.0}}, "/dynamics/links/density"),
        ({**PAYLOAD, "drive": {"slide": 0}}, "/dynamics/drive/slide"),
        ({**PAYLOAD, "links": {**PLATE, "holes": {"A": 2.5}}}, "/dynamics/links/holes/A"),
        (
            {**PAYLOAD, "bodies": {"coupler": {"shape": {**PLATE, "holes": {"A": 2.5}}}}},
            "/dynamics/bodies/coupler/shape/holes/A",
        ),
    ]:
        refused = client.post(path, json={"dynamics": block})
        assert refused.status_code == 422, refused.text
        assert refused.json()["errors"][0]["path"] == pointer
    assert client.post(f"/v1/jobs/{job['id']}/designs/99/forces", json={"dynamics": PAYLOAD}).status_code == 404


@pytest.mark.parametrize(
    ("changes", "path"),
    [
        *(({"constraints": {f"max_{name}": 1.0}}, f"/problem/constraints/max_{name}") for name in sorted(FORCE_NAMES)),
        ({"rank_by": "joint_force"}, "/problem/rank_by"),
        ({"dynamics": PAYLOAD, "rank_by": "joint_force_index"}, "/problem/rank_by"),
        ({"dynamics": {**PAYLOAD, "speed_rpm": "fast"}}, "/problem/dynamics/speed_rpm"),
        ({"dynamics": {"gravity": {}}}, "/problem/dynamics"),
        ({"dynamics": {**PAYLOAD, "report": ["drive"]}}, "/problem/dynamics/report"),
        ({"dynamics": PAYLOAD, "constraints": {"max_power": -1.0}}, "/problem/constraints/max_power"),
    ],
)
def test_a_demand_that_nothing_is_stated_for_is_refused(client, changes, path):
    refused = client.post("/v1/jobs", json={"problem": {**MOTION, **changes}})
    assert refused.status_code == 422
    assert path in [error["path"] for error in refused.json()["errors"]]
