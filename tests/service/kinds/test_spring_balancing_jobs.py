"""Springs through HTTP: answers that go to an analysis as they are, drawings, and what is refused where."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import Any

import httpx
import pytest

from synthesis.registry import list_examples
from tests.support.service.answers import SVG, finished

Statement = dict[str, Any]

LEVER, REAL, BOTH, SOUGHT = list_examples("spring_balancing")

TWO_LEVERS: Statement = {
    "kind": "spring_balancing",
    "length_unit": "in",
    "mechanism": {
        "type": "skeleton",
        "skeleton": {
            "joints": {"O": [0.0, 0.0], "A": [8.0, 0.0], "Q": [20.0, 0.0], "B": [20.0, 10.0]},
            "links": [
                {"name": "ground", "joints": ["O", "Q"]},
                {"name": "arm", "joints": ["O", "A"]},
                {"name": "wheel", "joints": ["Q", "B"]},
            ],
            "gears": [{"links": ["arm", "wheel"], "ratio": -1.0}],
            "input_link": "arm",
        },
    },
    "motion": {"from": 10.0, "to": 160.0, "speed_rpm": 0.0},
    "dynamics": {
        "units": "consistent",
        "gravity": {"magnitude": 386.09},
        "bodies": {"arm": {"mass": 0.05, "cg": [5.0, 1.0]}, "wheel": {"mass": 0.02, "cg": [20.0, 4.0]}},
    },
    "springs": [
        {
            "ends": [
                {"link": "ground", "point": [0.0, 9.0]},
                {"link": "arm", "within": [[2.0, 0.0], [6.0, 0.0], [6.0, 4.0]]},
            ],
            "max_rate": 40.0,
        },
        {
            "ends": [{"link": "wheel", "point": [20.0, 3.0]}, {"link": "ground", "within": [[18.0, 9.0], [22.0, 9.0]]}],
            "max_rate": 40.0,
        },
    ],
}
"""Two geared arms of unlike weights, in inches, that is in none of the examples."""


def solved(client: httpx.Client, problem: Statement) -> Any:
    job = finished(client, problem)
    assert job["status"] == "succeeded", job["error"]
    assert job["result"]["designs"], job["result"]["summary"]
    assert all(design["verification"]["passed"] for design in job["result"]["designs"])
    return job


@pytest.mark.slow
@pytest.mark.parametrize(
    "problem", [LEVER, REAL, BOTH, SOUGHT, TWO_LEVERS], ids=["lever", "real", "both", "sought", "two"]
)
def test_what_is_balanced_goes_to_an_analysis_as_it_is(client: httpx.Client, problem: Statement) -> None:
    job = solved(client, problem)
    design = job["result"]["designs"][0]
    body = {
        "mechanism": design["mechanism"],
        "motion": {"speed": 0.0, **problem["motion"]} if "speed_rpm" not in problem["motion"] else problem["motion"],
        "dynamics": design["dynamics"],
        "length_unit": problem.get("length_unit", "mm"),
    }
    answer = client.post("/v1/analyses", json=body).raise_for_status().json()["dynamics"]
    place = f"/v1/jobs/{job['id']}/designs/0"
    assert client.get(f"{place}/forces").raise_for_status().json()["dynamics"]["drive"] == answer["drive"]
    metrics = design["metrics"]
    before = client.post("/v1/analyses", json={**body, "dynamics": problem["dynamics"]}).raise_for_status().json()
    peak = max(abs(torque) for torque in before["dynamics"]["drive"])
    assert peak == pytest.approx(metrics["unbalanced_drive"], rel=1e-3)
    left = max(abs(torque) for torque in answer["drive"])
    assert left == pytest.approx(metrics["drive"], rel=5e-3, abs=1e-9 * peak)
    root = ET.fromstring(client.get(f"{place}.svg").raise_for_status().text)
    drawn = {mark.get("data-spring") for mark in root.iter(f"{SVG}path")} - {None}
    assert drawn == {str(spring["number"]) for spring in design["springs"]}
    for form in ("gif", "dxf", "csv"):
        assert len(client.get(f"{place}.{form}").raise_for_status().content) > 1000
    assert "spring" in client.get(f"/v1/jobs/{job['id']}/report.html").raise_for_status().text.lower()


def test_two_levers_are_balanced_exactly(client: httpx.Client) -> None:
    result = solved(client, TWO_LEVERS)["result"]
    assert result["search"]["complete"]
    assert result["designs"][0]["metrics"]["exact"]
    assert result["designs"][0]["metrics"]["energy_variation"] < 1e-9


def test_limits_hold_together(client: httpx.Client) -> None:
    """Every sort of limit at once, beside a torsion spring, a load and another spring."""
    spring = {
        **REAL["springs"][0],
        "min_rate": 20.0,
        "min_length": 140.0,
        "max_length": 240.0,
        "max_force": 12.0,
        "max_deflection": 150.0,
    }
    damper = {
        "ends": [{"link": "ground", "point": [0.0, 90.0]}, {"link": "output", "point": [350.0, 0.0]}],
        "damping": 5.0,
    }
    stated = {**REAL, "springs": [spring, REAL["springs"][1]], "norm": "rms"}
    stated["dynamics"] = {**REAL["dynamics"], "springs": [damper]}
    design = solved(client, stated)["result"]["designs"][0]
    found = design["springs"][0]
    assert found["rate"] >= 20.0 * (1.0 - 1e-6)
    assert found["max_force"] <= 12.0 * (1.0 + 1e-4)
    assert found["max_length"] - found["free_length"] <= 150.0 * (1.0 + 1e-4)
    assert found["free_length"] <= 120.0 * (1.0 + 1e-6)
    assert {check["name"] for check in design["verification"]["checks"]} >= {
        *("min_length", "max_length", "max_force", "max_deflection", "extension", "free_length", "preload", "rate"),
    }
    assert len(design["dynamics"]["springs"]) == 1 + len(design["springs"])


def changed(**more: Any) -> Statement:
    return {"springs": [{**LEVER["springs"][0], **more}]}


def ended(**more: Any) -> Statement:
    return changed(ends=[LEVER["springs"][0]["ends"][0], {**LEVER["springs"][0]["ends"][1], **more}])


REFUSED: dict[str, Statement] = {
    "/mechanism": {"mechanism": 5},
    "/mechanism/skeleton/joints/A/0": {
        "mechanism": {"type": "skeleton", "skeleton": {**LEVER["mechanism"]["skeleton"], "joints": {"A": [None, 0.0]}}}
    },
    "/dynamics/bodies/lever/mass": {"dynamics": {"bodies": {"lever": {"mass": -5.0, "cg": [0.0, 0.0]}}}},
    "/dynamics/bodies": {"dynamics": {"gravity": {}}},
    "/dynamics/gravity": {"dynamics": {"bodies": LEVER["dynamics"]["bodies"]}},
    "/dynamics/friction": {"dynamics": {**LEVER["dynamics"], "friction": {"pins": {"O": {"mu": 0.1, "radius": 5.0}}}}},
    "/motion/speed_rpm": {"motion": {"speed": 1.0, "speed_rpm": 1.0}},
    "/springs": {"springs": []},
    "/springs/0": {"springs": [{}]},
    "/springs/0/ends/1/link": ended(link="rocker"),
    "/springs/0/ends/1": ended(point=[1.0, 1.0]),
    "/springs/0/ends/1/within": ended(within=[[1.0, 1.0]]),
    "/springs/0/ends/1/within/0/1": ended(within=[[1.0, 1e10], [0.0, 0.0]]),
    "/springs/0/ends/0/point": changed(ends=[{"link": "ground", "point": [0.0, 9e8]}, LEVER["springs"][0]["ends"][1]]),
    "/springs/0/max_rate": changed(max_rate=-1.0),
    "/springs/0/rate": changed(rate=1e10, max_rate=None),
    "/springs/0/free_length": changed(free_length=float(-1)),
    "/springs/0/form": changed(form="gas"),
    "/springs/0/max_force": changed(max_force=0.0),
    "/norm": {"norm": "mean"},
}

CONTRADICTORY: dict[str, Statement] = {
    "rates": changed(rate=1.0, max_rate=2.0),
    "turned limits": changed(min_rate=3.0, max_rate=2.0),
    "turned lengths": changed(min_length=3.0, max_length=2.0),
    "torsion of a spring with ends": changed(torsion=3.0),
    "turning spring with a rate": {"springs": [{"links": ["ground", "lever"], "rate": 3.0}]},
    "preloads": changed(preload=3.0, max_preload=1.0),
    "compression without length": changed(form="compression"),
    "diameter of no compression spring": changed(diameter=3.0),
    "free length without end": changed(min_free_length=3.0),
    "free angles": {"springs": [{"links": ["ground", "lever"], "min_free_angle": 5000.0}]},
}


@pytest.mark.parametrize("path", REFUSED)
def test_what_is_wrong_is_refused_by_its_field(client: httpx.Client, path: str) -> None:
    answer = client.post("/v1/jobs", json={"problem": {**LEVER, **REFUSED[path]}})
    assert answer.status_code == 422, answer.text
    assert f"/problem{path}" in {error["path"] for error in answer.json()["errors"]}


@pytest.mark.parametrize("name", CONTRADICTORY)
def test_springs_that_contradict_themselves_are_refused(client: httpx.Client, name: str) -> None:
    answer = client.post("/v1/jobs", json={"problem": {**LEVER, **CONTRADICTORY[name]}})
    assert answer.status_code == 422, answer.text
    assert {error["path"] for error in answer.json()["errors"]} == {"/problem/springs/0"}


def test_a_spring_between_points_of_one_link_is_refused(client: httpx.Client) -> None:
    answer = client.post("/v1/jobs", json={"problem": {**LEVER, **ended(link="ground")}})
    assert [error["path"] for error in answer.json()["errors"]] == ["/problem/springs/0/ends/1/link"]
