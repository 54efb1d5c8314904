"""Trains in series through HTTP: an answer with its files, its analysis, and statements that are refused by field."""

from __future__ import annotations

import csv
import io
import xml.etree.ElementTree as ElementTree
from typing import Any

import ezdxf
import httpx
import pytest

from synthesis.registry import list_examples
from tests.support.service.answers import finished

STATED = list_examples("train_series")[2]
SET = STATED["units"][1]
GEARS = STATED["units"][0]
WHEELS = {"type": "gear_train", "stages": [{"driver": 20, "driven": 30}]}


@pytest.fixture(scope="module")
def job(server: Any) -> Any:
    done = finished(server.client, STATED)
    assert done["status"] == "succeeded", done["error"]
    return done


@pytest.mark.slow
def test_the_answer_and_its_files(client: httpx.Client, job: Any) -> None:
    result = job["result"]
    assert result["search"]["complete"]
    assert [unit["type"] for unit in result["designs"][0]["mechanism"]["units"]] == ["gear_train", "planetary_train"]
    assert all(check["passed"] for check in result["designs"][0]["verification"]["checks"])
    base = f"/v1/jobs/{job['id']}/designs/0"
    sheet = ElementTree.fromstring(client.get(f"{base}.svg").raise_for_status().text)
    panels = [one.get("data-panel") for one in sheet.iter() if one.get("data-panel")]
    assert panels == ["unit 1", "unit 2"]
    words = ["".join(one.itertext()) for one in sheet.iter() if one.tag.endswith("text")]
    assert {"unit 1", "unit 2"} <= set(words)
    said = "".join(one for node in sheet.iter() if node.tag.endswith("desc") for one in node.itertext())
    assert "each unit to a scale of its own" in said
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


@pytest.mark.parametrize(
    ("demand", "check"),
    [
        ({"fillets": "refuse"}, "unit_2_ring_trimmed"),
        ({"max_size": 150.0}, "unit_2_size"),
        ({"planets": 4}, None),
    ],
)
def test_demands_of_a_planetary_unit(client: httpx.Client, demand: dict[str, Any], check: str | None) -> None:
    small = {**SET, "teeth": {"min": 12, "max": 30, "ring_max": 90}}
    stated = {**STATED, "ratio": -20, "tolerance": None, "rank_by": "error", "max_designs": 5}
    plain = finished(client, {**stated, "units": [GEARS, small]})["result"]
    kept = finished(client, {**stated, "units": [GEARS, {**small, **demand}]})["result"]
    assert kept["designs"]
    assert 0 < kept["search"]["combinations"] != plain["search"]["combinations"]
    for design in kept["designs"]:
        names = [one["name"] for one in design["verification"]["checks"]]
        assert check is None or check in names
        assert design["mechanism"]["units"][1]["planets"] == demand.get("planets", 3)


def test_the_smallest_or_the_nearest_first(client: httpx.Client, job: Any) -> None:
    nearest = finished(client, {**STATED, "rank_by": "error"})["result"]["designs"][0]["metrics"]
    smallest = job["result"]["designs"][0]["metrics"]
    assert abs(nearest["error"]) < abs(smallest["error"])
    assert nearest["total_teeth"] > smallest["total_teeth"]


def test_where_the_output_drives_it_brings_the_losses(client: httpx.Client, job: Any) -> None:
    """Whichever of torque and speed is negative; units are told as their own families tell them."""
    mechanism = job["result"]["designs"][0]["mechanism"]
    body = {"mechanism": mechanism, "mesh_efficiency": 0.95}

    def told(torque: float, speed: float) -> Any:
        asked = {**body, "input_torque": torque, "motion": {"at": 0.0, "speed": speed}}
        return client.post("/v1/analyses", json=asked).raise_for_status().json()

    forwards, backwards = told(3.0, 100.0), told(-3.0, 100.0)
    assert told(3.0, -100.0)["efficiency"] == backwards["efficiency"]
    assert told(-3.0, -100.0)["efficiency"] == forwards["efficiency"] != backwards["efficiency"]
    powers = [shaft["torque"] * shaft["omega"][0] for shaft in backwards["shafts"]]
    assert powers[0] == pytest.approx(-300.0)
    assert powers[-1] < powers[1] < powers[0]
    assert backwards["efficiency"] == pytest.approx(powers[0] / powers[-1])
    assert not backwards["self_locking"]
    planetary = mechanism["units"][1]
    alone = {
        "mechanism": planetary, "mesh_efficiency": 0.95, "torques": {planetary["input"]: -1.0},
        "motion": {"at": 0.0, "speed": 7.0},
    }  # fmt: skip
    single = client.post("/v1/analyses", json=alone).raise_for_status().json()
    assert powers[1] / powers[2] == pytest.approx(single["efficiency"]) == backwards["units"][1]["efficiency"]
    # Turning the other way with the torque turned round too, the powers are the same.
    turned = {**alone, "torques": {planetary["input"]: 1.0}, "motion": {"at": 0.0, "speed": -7.0}}
    again = client.post("/v1/analyses", json=turned).raise_for_status().json()
    assert again["efficiency"] == single["efficiency"]
    assert [one["power"] for one in again["bodies"]] == pytest.approx([one["power"] for one in single["bodies"]])


WOLFROM = {
    "type": "planetary_train", "arrangement": "wolfrom", "input": "sun", "output": "ring_2", "fixed": "ring_1",
    "teeth": {"sun": 18, "planet_1": 40, "planet_2": 39, "ring_1": 98, "ring_2": 97},
}  # fmt: skip


def test_a_series_that_locks_is_not_driven_back(client: httpx.Client) -> None:
    """Forwards it runs, with a small efficiency; backwards no torque on its output takes it along."""
    mechanism = {"type": "train_series", "units": [WHEELS, WOLFROM, WHEELS]}
    asked = {"mechanism": mechanism, "mesh_efficiency": 0.97, "motion": {"at": 0.0}}
    forwards, backwards = (
        client.post("/v1/analyses", json={**asked, "input_torque": torque}).raise_for_status().json()
        for torque in (1.0, -1.0)
    )
    assert not forwards["self_locking"]
    assert 0.0 < forwards["efficiency"] < 0.5
    assert backwards["self_locking"]
    assert backwards["efficiency"] == 0.0
    assert [shaft["torque"] is None for shaft in backwards["shafts"]] == [False, False, True, True]


def test_the_ratio_of_a_mechanism_is_compared(client: httpx.Client, job: Any) -> None:
    mechanism = job["result"]["designs"][0]["mechanism"]
    planetary = mechanism["units"][1]
    other = {"numerator": 999, "denominator": 7, "value": 999 / 7}
    inner = [mechanism["units"][0], {**planetary, "ratio": other}]
    for wrong, path in [
        ({**mechanism, "ratio": other}, "/mechanism/ratio"),
        ({**mechanism, "ratio": "nonsense"}, "/mechanism/ratio"),
        ({**mechanism, "ratio": {**mechanism["ratio"], "value": 1.0}}, "/mechanism/ratio"),
        ({**mechanism, "units": inner}, "/mechanism/units/1/ratio"),
        ({**planetary, "ratio": other}, "/mechanism/ratio"),
    ]:
        answer = client.post("/v1/analyses", json={"mechanism": wrong})
        assert answer.status_code == 422, answer.text
        assert path in [fault["path"] for fault in answer.json()["errors"]]
    assert client.post("/v1/analyses", json={"mechanism": planetary}).status_code == 200


TEETH = {"type": "planetary_train", "arrangement": "simple"}


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
