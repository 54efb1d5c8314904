"""Rotors through HTTP: worked examples and problems of Norton, ch. 12, drawings, and what is refused where."""

from __future__ import annotations

import cmath
import math
import xml.etree.ElementTree as ET
from typing import Any

import httpx
import pytest

from synthesis.registry import list_examples
from tests.cases import Case, cases
from tests.support.service.answers import SVG, finished

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


@pytest.mark.parametrize("n", [0, 1])
def test_what_is_answered_is_drawn_and_can_be_analysed(client: httpx.Client, n: int) -> None:
    job = finished(client, list_examples("balancing")[n])
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
        square = (speed / list_examples("balancing")[n]["rpm"]) ** 2
        for bearing, told in zip(answer["bearings"], design["metrics"]["bearings"], strict=True):
            assert bearing["peak"] == pytest.approx(square * told["after"], rel=1e-6, abs=1e-9 * square)


TRIALS = list_examples("balancing")[1]["influence"]["trials"]
INITIAL = list_examples("balancing")[1]["influence"]["initial"]

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


def test_two_planes_at_one_place_are_one(client: httpx.Client) -> None:
    stated = {**ROTOR, "masses": masses([[1.0, 2.0, 30.0, 4.0], [0.5, 3.0, 80.0, 9.0]]), "rpm": 300.0}
    one, two = (best(client, {**stated, "planes": planes}) for planes in ([5.0], [5.0, 5.0]))
    assert two["mechanism"]["corrections"] == one["mechanism"]["corrections"]
    assert len(two["metrics"]["planes"]) == 1
    assert two["metrics"]["residual_couple"] == one["metrics"]["residual_couple"] > 0.0


LINKAGE: Statement = list_examples("balancing")[2]


def fourbar(links: dict[str, float]) -> Statement:
    """With O2 at the origin and the ground along x, as an analysis takes it."""
    return {
        "type": "fourbar",
        "fixed_pivots": {"input": [0.0, 0.0], "output": [float(links["ground"]), 0.0]},
        "links": {name: float(links[name]) for name in ("input", "coupler", "output")},
    }


def swept(mechanism: Statement) -> Statement:
    """A range of the input within which a fourbar can be assembled."""
    lengths, ground = mechanism["links"], mechanism["fixed_pivots"]["output"][0]
    a, b, c = lengths["input"], lengths["coupler"], lengths["output"]
    far = min(b + c, a + ground)
    cosine = (a * a + ground * ground - far * far) / (2.0 * a * ground)
    widest = math.degrees(math.acos(max(-1.0, min(1.0, cosine))))
    return {"from": 0.35 * widest, "to": 0.9 * widest, "speed": 10.0, "acceleration": 3.0}


@pytest.mark.parametrize("case", cases("force_balance", "dynamics"))
def test_a_fourbar_is_balanced_as_in_the_book(client: httpx.Client, case: Case) -> None:
    """Norton 12.8: moments of the cranks that are needed in all, and those that are to be added."""
    given: dict[str, Any] = case.inputs or {}
    mechanism = fourbar(given["links"])
    bodies = {
        link: {"mass": mass, "cg": {"distance": b, "angle": phi}}
        for link, mass, b, phi in zip(
            ("input", "coupler", "output"), given["m"], given["b"], given["phi_deg"], strict=True
        )
    }
    problem = {
        "kind": "balancing",
        "object": "linkage",
        "length_unit": "in",
        "mechanism": mechanism,
        "motion": swept(mechanism),
        "dynamics": {"units": "consistent", "bodies": bodies},
        "counterweights": {"links": ["input", "output"]},
    }
    design = best(client, problem)
    found = {}
    for number, link, body in ((2, "input", bodies["input"]), (4, "output", bodies["output"])):
        weight = next(weight for weight in design["counterweights"] if weight["link"] == link)
        added = cmath.rect(weight["moment"], math.radians(weight["angle"]))
        own = cmath.rect(body["mass"] * body["cg"]["distance"], math.radians(body["cg"]["angle"]))
        for name, value in (("added", added), ("total", added + own)):
            found |= {f"link{number}_{name}_mR": abs(value)}
            found |= {f"link{number}_{name}_angle": math.degrees(cmath.phase(value))}
    case.check(**found)


@pytest.mark.parametrize("case", cases("moment_balance", "dynamics"))
def test_a_fourbar_shakes_neither_by_force_nor_by_moment(client: httpx.Client, case: Case) -> None:
    given: dict[str, Any] = case.inputs or {}
    a, b, c, d = given["links"]
    mechanism = fourbar({"input": a, "coupler": b, "output": c, "ground": d})
    inertia = {link: given[f"m{n}"] * given[f"k{n}"] ** 2 for n, link in ((2, "input"), (3, "coupler"), (4, "output"))}
    problem = {
        "kind": "balancing",
        "object": "linkage",
        "goal": "force_and_moment",
        "length_unit": "m",
        "mechanism": mechanism,
        "motion": {"speed": float(given["speed"]), "acceleration": float(given["acceleration"])},
        "dynamics": {
            "bodies": {
                "input": {"mass": 0.0, "inertia": inertia["input"]},
                "coupler": {"mass": given["m3"], "cg": {"distance": given["r3"]}, "inertia": inertia["coupler"]},
                "output": {"mass": 0.0, "inertia": inertia["output"]},
            }
        },
        "counterweights": {"mass": given["m2"]},
    }
    design = best(client, problem)
    moments = {weight["link"]: weight["moment"] * 1e-6 for weight in design["counterweights"]}
    counter = {gear["against"]: gear["inertia"] for gear in design["geared"]}
    body = {"mechanism": design["mechanism"], "motion": problem["motion"], "dynamics": design["dynamics"]}
    shaken = client.post("/v1/analyses", json={**body, "length_unit": "m"}).raise_for_status().json()["dynamics"]
    case.check(
        m2_r2=moments["input"],
        m4_r4=moments["output"],
        I2_counter=counter["input"],
        I4_counter=counter["output"],
        shaking_force_max=shaken["extremes"]["shaking_force"]["max"],
        shaking_moment_max=shaken["extremes"]["shaking_moment"]["max"],
    )


@pytest.mark.slow
@pytest.mark.parametrize("n", [2, 3])
def test_what_is_balanced_goes_to_an_analysis_as_it_is(client: httpx.Client, n: int) -> None:
    problem = list_examples("balancing")[n]
    job = finished(client, problem)
    design = job["result"]["designs"][0]
    place = f"/v1/jobs/{job['id']}/designs/0"
    body = {"mechanism": design["mechanism"], "motion": problem["motion"], "dynamics": design["dynamics"]}
    answer = client.post("/v1/analyses", json=body).raise_for_status().json()
    told = client.get(f"{place}/forces").raise_for_status().json()
    assert told["dynamics"] == answer["dynamics"]
    metrics = design["metrics"]
    assert answer["dynamics"]["extremes"]["shaking_force"]["max"] < 1e-9 * metrics["unbalanced_shaking_force"]
    assert answer["dynamics"]["extremes"]["shaking_moment"]["max"] == pytest.approx(
        metrics["shaking_moment"], rel=1e-3, abs=1e-9 * metrics["unbalanced_shaking_moment"]
    )
    stated = {"mechanism": problem["mechanism"], "motion": problem["motion"], "dynamics": problem["dynamics"]}
    before = client.post("/v1/analyses", json=stated).raise_for_status().json()["dynamics"]["extremes"]
    assert before["shaking_force"]["max"] == pytest.approx(metrics["unbalanced_shaking_force"], rel=1e-4)
    root = ET.fromstring(client.get(f"{place}.svg").raise_for_status().text)
    drawn = {mark.get("data-counterweight") for mark in root.iter(f"{SVG}circle")} - {None}
    assert drawn == {weight["link"] for weight in design["counterweights"] if weight["mass"] > 0.0}
    for form in ("gif", "dxf", "csv"):
        assert len(client.get(f"{place}.{form}").raise_for_status().content) > 1000
    assert "counterweight" in client.get(f"/v1/jobs/{job['id']}/report.html").raise_for_status().text.lower()


OF_LINKAGES: dict[str, Statement] = {
    "/mechanism": {"mechanism": None},
    "/dynamics": {"dynamics": None},
    "/masses": {"masses": [{"mass": 1.0, "radius": 1.0, "angle": 0.0}]},
    "/motion": {"motion": {"speed": 0.0}},
    "/motion/speed_rpm": {"motion": {"speed": 1.0, "speed_rpm": 1.0}},
    "/motion/steps": {"motion": {"steps": 0}},
    "/mechanism/links/output": {
        "mechanism": {**LINKAGE["mechanism"], "links": {"input": 1.0, "coupler": 3.0, "output": -2.0}}
    },
    "/mechanism/links": {"mechanism": {**LINKAGE["mechanism"], "links": {"input": 1.0, "coupler": 3.0, "output": 2.0}}},
    "/dynamics/bodies": {"dynamics": {}},
    "/dynamics/bodies/rocker": {"dynamics": {"bodies": {"rocker": {"mass": 1.0, "cg": [0.0, 0.0]}}}},
    "/dynamics/bodies/input/mass": {"dynamics": {"bodies": {"input": {"mass": -1.0, "cg": [0.0, 0.0]}}}},
    "/counterweights/links/1": {"counterweights": {"links": ["input", "ground"]}},
    "/counterweights": {"counterweights": {"radius": 10.0, "mass": 1.0}},
    "/counterweights/radius": {"counterweights": {"radius": -10.0}},
    "/counterweights/reach": {"counterweights": {"reach": 10.0}},
    "/counterweights/total_mass": {"goal": "minimize", "counterweights": {"reach": 10.0}},
    "/objective": {"goal": "minimize", "objective": {}, "counterweights": {"total_mass": 1.0}},
    "/caps": {"caps": {"drive": 1.0}},
    "/objective/joint_forces/Q": {
        "goal": "minimize",
        "objective": {"joint_forces": {"Q": 1.0}},
        "counterweights": {"total_mass": 1.0},
    },
    "/caps/joint_forces/Q": {
        "goal": "minimize",
        "caps": {"joint_forces": {"Q": 1.0}},
        "counterweights": {"total_mass": 1.0},
    },
    "/dynamics/friction": {
        "goal": "minimize",
        "counterweights": {"total_mass": 1.0},
        "dynamics": {**LINKAGE["dynamics"], "friction": {"pins": {"A": {"mu": 0.1, "radius": 5.0}}}},
    },
}


@pytest.mark.parametrize("path", OF_LINKAGES)
def test_what_contradicts_itself_of_a_linkage_is_refused_by_its_field(client: httpx.Client, path: str) -> None:
    answer = client.post("/v1/jobs", json={"problem": {**LINKAGE, **OF_LINKAGES[path]}})
    assert answer.status_code == 422, answer.text
    assert {error["path"] for error in answer.json()["errors"]} == {f"/problem{path}"}


@pytest.mark.slow
def test_the_best_weights_are_measured_as_they_are_promised(client: httpx.Client) -> None:
    """Peaks of an analysis of the answer, before and after, weighed as the objective says, are its value."""
    problem = list_examples("balancing")[4]
    job = finished(client, problem)
    design = job["result"]["designs"][0]
    metrics = design["metrics"]
    assert design["verification"]["passed"]
    assert metrics["bound"] <= metrics["value"]
    assert metrics["gap"] <= 0.005
    body = {"mechanism": design["mechanism"], "motion": {**problem["motion"], "steps": 2880}}
    after = client.post("/v1/analyses", json={**body, "dynamics": design["dynamics"]}).raise_for_status().json()
    before = client.post("/v1/analyses", json={**body, "dynamics": problem["dynamics"]}).raise_for_status().json()
    first, last = (one["dynamics"]["extremes"] for one in (before, after))

    def ratio(name: str) -> float:
        peaks = [max(abs(one[name]["max"]), abs(one[name].get("min", 0.0))) for one in (last, first)]
        return peaks[0] / peaks[1]

    value = sum(weight * ratio(name) for name, weight in problem["objective"].items())
    assert value == pytest.approx(metrics["value"], rel=1e-5)
    assert ratio("drive") <= problem["caps"]["drive"] * 1.001
    assert sum(weight["mass"] for weight in design["counterweights"]) <= problem["counterweights"]["total_mass"] * (
        1.0 + 1e-9
    )
    root = ET.fromstring(client.get(f"/v1/jobs/{job['id']}/designs/0.svg").raise_for_status().text)
    assert [mark for mark in root.iter() if mark.get("data-counterweight")]
    told = client.get(f"/v1/jobs/{job['id']}/designs/0/forces").raise_for_status().json()["dynamics"]["extremes"]
    assert told["shaking_force"]["max"] == pytest.approx(metrics["shaking_force"], rel=1e-3)


def test_caps_that_cannot_be_kept_are_named(client: httpx.Client) -> None:
    problem = {**list_examples("balancing")[4], "caps": {"shaking_moment": 0.05, "drive": 0.3}}
    result = finished(client, problem)["result"]
    assert result["designs"] == []
    assert result["search"]["complete"]
    assert "None exists" in result["summary"]
    assert "shaking moment" in result["summary"]
