"""Trains in series through HTTP: an answer with its files, its analysis, and statements that are refused by field."""

from __future__ import annotations

import csv
import io
import xml.etree.ElementTree as ElementTree
from typing import Any

import ezdxf
import httpx
import pytest

from synthesis.registry import examples
from tests.service.answers import finished

STATED = examples("train_series")[2]


@pytest.fixture(scope="module")
def job(server: Any) -> Any:
    done = finished(server.client, STATED)
    assert done["status"] == "succeeded", done["error"]
    return done


def test_the_answer_and_its_files(client: httpx.Client, job: Any) -> None:
    result = job["result"]
    assert result["search"]["complete"]
    assert [unit["type"] for unit in result["designs"][0]["mechanism"]["units"]] == ["gear_train", "planetary_train"]
    assert all(check["passed"] for check in result["designs"][0]["verification"]["checks"])
    base = f"/v1/jobs/{job['id']}/designs/0"
    sheet = ElementTree.fromstring(client.get(f"{base}.svg").raise_for_status().text)
    panels = [one.get("data-panel") for one in sheet.iter() if one.get("data-panel")]
    assert panels == ["unit 1", "unit 2"]
    drawing = ezdxf.read(io.StringIO(client.get(f"{base}.dxf").raise_for_status().text))
    teeth = [entity for entity in drawing.modelspace() if entity.dxf.layer.endswith("_TEETH")]
    planets = job["problem"]["units"][1]["planets"]
    assert len(teeth) == 2 + 2 + planets
    rows = list(csv.DictReader(io.StringIO(client.get(f"{base}.csv").raise_for_status().text)))
    assert len(rows) == len(teeth)
    assert client.get(f"{base}.gif").raise_for_status().content[:6] == b"GIF89a"
    assert "Trains in series" in client.get(f"/v1/jobs/{job['id']}/report.html").raise_for_status().text


def test_the_analysis_of_a_design(client: httpx.Client, job: Any) -> None:
    design = job["result"]["designs"][0]
    body = {"mechanism": design["mechanism"], "motion": {"at": 90.0, "speed_rpm": 1000.0}, "input_torque": 3.0}
    told = client.post("/v1/analyses", json=body).raise_for_status().json()
    told = told.get("analysis", told)
    assert told["ratio"] == design["mechanism"]["ratio"]
    assert [shaft["speed_ratio"] for shaft in told["shafts"]] == pytest.approx(design["metrics"]["speeds"])
    output = told["shafts"][-1]
    assert output["angle"] == pytest.approx([90.0 / design["mechanism"]["ratio"]["value"]])
    entering = 3.0 * told["shafts"][0]["omega"][0]
    assert output["torque"] * output["omega"][0] == pytest.approx(entering * told["efficiency"])
    less = client.post("/v1/analyses", json={**body, "mesh_efficiency": 0.9}).raise_for_status().json()
    assert less.get("analysis", less)["efficiency"] < told["efficiency"]


SET = STATED["units"][1]
GEARS = STATED["units"][0]
TEETH = {"type": "planetary_train", "arrangement": "simple"}
WHEELS = {"type": "gear_train", "stages": [{"driver": 20, "driven": 30}]}


@pytest.mark.parametrize(
    ("change", "path"),
    [
        ({"units": [SET]}, "/problem/units"),
        ({"units": [SET] * 5}, "/problem/units"),
        ({"units": [SET, {**SET, "type": "cam"}]}, "/problem/units/1"),
        ({"units": [SET, {k: v for k, v in SET.items() if k != "type"}]}, "/problem/units/1"),
        ({"units": [SET, {**SET, "ratio": 3}]}, "/problem/units/1/ratio"),
        ({"units": [SET, {**SET, "tolerance": 0.1}]}, "/problem/units/1/tolerance"),
        ({"units": [{**GEARS, "strength": {"power_kw": 1.0}}, SET]}, "/problem/units/0/strength"),
        ({"units": [SET, {**SET, "planets": 0}]}, "/problem/units/1/planets"),
        ({"units": [SET, {**SET, "fixed": "sun"}]}, "/problem/units/1/fixed"),
        ({"units": [SET, {**SET, "input": "wheel"}]}, "/problem/units/1/input"),
        ({"units": [{**GEARS, "teeth": {"min": 40, "max": 20}}, SET]}, "/problem/units/0/teeth"),
        ({"units": [{**GEARS, "teeth": [{"min": 18}] * 4}, SET]}, "/problem/units/0/teeth"),
        ({"units": [{**GEARS, "stock": [20, 30]}, SET]}, "/problem/units/0/stock"),
        ({"units": [{**GEARS, "hunting_tooth": "prefer"}, SET]}, "/problem/units/0/hunting_tooth"),
        ({"units": [{**GEARS, "max_stages": 3}, SET]}, "/problem/units/0/teeth"),
        ({"units": [{"type": "planetary_train"}, SET]}, "/problem/units/0/teeth"),
        ({"units": [{"type": "planetary_train", "arrangement": "wolfrom", "input": "sun"}] * 3}, "/problem/units"),
        ({"tolerance": None}, "/problem/tolerance"),
        ({"ratio": 0}, "/problem/ratio"),
    ],
)
def test_a_refused_statement_names_the_field(client: httpx.Client, change: dict[str, Any], path: str) -> None:
    answer = client.post("/v1/jobs", json={"problem": {**STATED, **change}})
    assert answer.status_code == 422, answer.text
    assert path in [fault["path"] for fault in answer.json()["errors"]]


@pytest.mark.parametrize(
    ("unit", "path"),
    [
        (
            {"type": "planetary_train", "arrangement": "simple", "teeth": {"sun": 18, "planet": 27, "ring": 72}},
            "/input",
        ),
        ({"type": "planetary_train", "arrangement": "simple", "teeth": {"sun": 18}}, "/teeth"),
        (
            {"type": "gear_train", "stages": [{"driver": 20, "driven": 30}], "idlers": [{"stage": 2, "teeth": 20}]},
            "/idlers/0/stage",
        ),
    ],
)
def test_a_refused_analysis_names_the_field_of_the_unit(client: httpx.Client, unit: dict[str, Any], path: str) -> None:
    answer = client.post("/v1/analyses", json={"mechanism": {"type": "train_series", "units": [WHEELS, unit]}})
    assert answer.status_code == 422, answer.text
    assert f"/mechanism/units/1{path}" in [fault["path"] for fault in answer.json()["errors"]]
