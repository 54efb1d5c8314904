"""Rotors through HTTP: worked examples and problems of Norton, ch. 12, drawings, and what is refused where."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import Any

import httpx
import pytest

from synthesis.registry import examples
from tests.cases import Case, cases
from tests.service.answers import SVG, finished

Statement = dict[str, Any]

ROTOR: Statement = {"kind": "balancing", "object": "rotor", "length_unit": "in", "units": "consistent"}

GRAMS = 453.592
"""In a pound, as the rows have it."""


def best(client: httpx.Client, problem: Statement) -> Any:
    job = finished(client, problem)
    assert job["status"] == "succeeded", job["error"]
    design = job["result"]["designs"][0]
    assert design["verification"]["passed"]
    return design


def masses(rows: list[list[float]]) -> list[Statement]:
    names = ("mass", "radius", "angle", "z")
    return [dict(zip(names, map(float, row), strict=False)) for row in rows]


@pytest.mark.parametrize("case", cases("static_balance", "dynamics"))
def test_one_plane_is_balanced_as_in_the_book(client: httpx.Client, case: Case) -> None:
    assert case.inputs is not None
    problem = {**ROTOR, "masses": masses(case.inputs["masses"]), "correction": {"radius": 0.806}}
    added = best(client, problem)["mechanism"]["corrections"][0]
    case.check(mR=added["unbalance"], angle=added["angle"], **{"mass_at_0.806": added["mass"]})


@pytest.mark.parametrize("case", cases("two_plane_balance", "dynamics"))
def test_two_planes_are_balanced_as_in_the_book(client: httpx.Client, case: Case) -> None:
    given: dict[str, Any] = case.inputs or {}
    planes = [float(given["plane_A"]), float(given["plane_B"])]
    rpm = {"rpm": float(given["rpm"])} if "rpm" in given else {}
    design = best(client, {**ROTOR, "masses": masses(given["masses"]), "planes": planes, **rpm})
    found = {}
    for name, added in zip("AB", design["mechanism"]["corrections"], strict=True):
        found |= {f"mR_{name}": added["unbalance"], f"angle_{name}": added["angle"]}
    metrics = design["metrics"]
    found |= {
        "shaking_force": metrics.get("shaking_force", 0.0),
        "shaking_moment_about_A": metrics.get("shaking_moment", 0.0),
    }
    case.check(**found)


@pytest.mark.parametrize("case", cases("balance_from_bearings", "dynamics"))
def test_a_wheel_is_balanced_by_the_forces_on_its_bearings(client: httpx.Client, case: Case) -> None:
    given: dict[str, Any] = case.inputs or {}
    readings = [dict(zip(("force", "angle", "z"), map(float, given[side]), strict=True)) for side in ("left", "right")]
    problem = {
        **ROTOR,
        "bearing_readings": readings,
        "rpm": float(given["rpm"]),
        "planes": [given["plane_A"], given["plane_B"]],
        "correction": {"radius": given["rim_diameter"] / 2.0},
    }
    found = {}
    for name, added in zip("AB", best(client, problem)["mechanism"]["corrections"], strict=True):
        found |= {f"m_{name}": added["mass"] * given["g"] * GRAMS, f"angle_{name}": added["angle"]}
    case.check(**found)


@pytest.mark.parametrize("n", range(len(examples("balancing"))))
def test_what_is_answered_is_drawn_and_can_be_analysed(client: httpx.Client, n: int) -> None:
    job = finished(client, examples("balancing")[n])
    design = job["result"]["designs"][0]
    place = f"/v1/jobs/{job['id']}/designs/0"
    root = ET.fromstring(client.get(f"{place}.svg").raise_for_status().text)
    drawn = {float(mark.get("data-angle", "nan")) for mark in root.iter(f"{SVG}circle") if mark.get("data-correction")}
    assert drawn == {added["angle"] for added in design["mechanism"]["corrections"]}
    assert "REMOVED" in client.get(f"{place}.dxf").raise_for_status().text
    rows = client.get(f"{place}.csv").raise_for_status().text.splitlines()
    assert len(rows) == 1 + len(design["mechanism"]["unbalances"]) + len(design["mechanism"]["corrections"])
    assert client.get(f"{place}.gif").status_code == 404
    assert client.get(f"{place}/forces").status_code == 409
    assert "Balancing" in client.get(f"/v1/jobs/{job['id']}/report.html").raise_for_status().text
    for speed in (300.0, 3000.0):
        body = {"mechanism": design["mechanism"], "motion": {"speed_rpm": speed}}
        answer = client.post("/v1/analyses", json=body).raise_for_status().json()
        square = (speed / examples("balancing")[n]["rpm"]) ** 2
        for bearing, told in zip(answer["bearings"], design["metrics"]["bearings"], strict=True):
            assert bearing["peak"] == pytest.approx(square * told["after"], rel=1e-6, abs=1e-9 * square)


TRIALS = examples("balancing")[1]["influence"]["trials"]
INITIAL = examples("balancing")[1]["influence"]["initial"]

REFUSED = {
    "/masses": {"masses": []},
    "/masses/0/mass": {"masses": [{"mass": -1.0, "radius": 1.0, "angle": 0.0}]},
    "/masses/0/radius": {"masses": [{"mass": 1.0, "radius": 1e10, "angle": 0.0}]},
    "/planes": {"planes": [0.0, 1e-9]},
    "/planes/0": {"planes": ["left", 1.0]},
    "/bearings": {"bearings": [5.0, 5.0]},
    "/rpm": {"masses": [], "bearing_readings": [{"force": 1.0, "angle": 0.0, "z": 0.0}]},
    "/rotor_mass": {"max_grade": 6.3, "rpm": 1000.0},
    "/max_grade": {"max_grade": 0.0, "rpm": 1000.0, "rotor_mass": 5.0},
    "/correction": {"correction": {"radius": 5.0, "mass": 1.0}},
    "/correction/holes": {"correction": {"holes": {"angles": 4, "radius": 5.0, "step": 1.0, "max_per_hole": 0.5}}},
    "/correction/holes/angles": {
        "correction": {"holes": {"angles": 1000, "radius": 5.0, "step": 1.0, "max_per_hole": 5.0}}
    },
    "/influence/trials": {"masses": [], "influence": {"initial": INITIAL, "trials": TRIALS[:1]}},
    "/influence/initial": {
        "masses": [],
        "influence": {"initial": INITIAL[:1], "trials": [{**run, "readings": run["readings"][:1]} for run in TRIALS]},
    },
    "/influence/trials/1/readings": {
        "masses": [],
        "influence": {"initial": INITIAL, "trials": [TRIALS[0], {**TRIALS[1], "readings": INITIAL[:1]}]},
    },
}


@pytest.mark.parametrize("path", REFUSED)
def test_what_contradicts_itself_is_refused_by_its_field(client: httpx.Client, path: str) -> None:
    stated = {**ROTOR, "masses": masses([[1.0, 2.0, 30.0, 4.0]]), "planes": [0.0, 10.0], **REFUSED[path]}
    answer = client.post("/v1/jobs", json={"problem": stated})
    assert answer.status_code == 422, answer.text
    assert {error["path"] for error in answer.json()["errors"]} == {f"/problem{path}"}


def test_trial_weights_that_change_alike_tell_no_planes_apart(client: httpx.Client) -> None:
    runs = [{**TRIALS[0], "mass": mass} for mass in (0.01, 0.01)]
    stated = {**ROTOR, "influence": {"initial": INITIAL, "trials": runs}, "planes": [0.0, 10.0]}
    answer = client.post("/v1/jobs", json={"problem": stated})
    assert [error["path"] for error in answer.json()["errors"]] == ["/problem/influence/trials"]


def test_a_couple_beside_one_plane_counts_in_the_grade(client: httpx.Client) -> None:
    opposite = masses([[0.001, 10.0, 0.0, 0.0], [0.001, 10.0, 180.0, 100.0]])
    stated = {**ROTOR, "length_unit": "mm", "masses": opposite, "rpm": 3000.0, "rotor_mass": 2.0, "max_grade": 1.0}
    answer = client.post("/v1/jobs", json={"problem": stated})
    assert [error["path"] for error in answer.json()["errors"]] == ["/problem/bearings"]
    job = finished(client, {**stated, "bearings": [0.0, 100.0]})
    assert job["result"]["designs"] == []
    assert "3.142 mm/s" in job["result"]["summary"]
    assert best(client, {**stated, "planes": [0.0, 100.0]})["metrics"]["grade"] < 1e-12
