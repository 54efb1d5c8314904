"""Indexing drives through HTTP: all drives and files, the analysis of a drive, and refusals by field."""

from __future__ import annotations

import io
import math
from typing import Any

import ezdxf
import httpx
import pytest

from synthesis.registry import list_examples
from tests.campaign import further
from tests.support.service.answers import finished

Statement = dict[str, Any]


def indexing(**changes: Any) -> Statement:
    base = {"kind": "indexing", "drive": "geneva_external", "stations": 4, "roller_diameter": 10.0, "speed_rpm": 60.0}
    return base | changes


def outcome(client: httpx.Client, problem: Statement) -> Any:
    job = finished(client, problem)
    assert job["status"] == "succeeded", job["error"]
    return job["result"]


GENEVA = [one for one in list_examples("indexing") if one["drive"] != "ratchet" and "driver" not in one]
RATCHET = next(one for one in list_examples("indexing") if one["drive"] == "ratchet")


@pytest.mark.slow
@pytest.mark.parametrize("example", further(GENEVA, GENEVA[2:3]), ids=lambda one: f"{one['drive']} {one['stations']}")
def test_every_drive_is_drawn_and_moves(client: httpx.Client, example: Statement) -> None:
    job = finished(client, example)
    design = job["result"]["designs"][0]
    assert design["verification"]["passed"]
    place = f"/v1/jobs/{job['id']}/designs/0"
    for form in ("svg", "gif", "csv"):
        assert client.get(f"{place}.{form}").status_code == 200
    drawn = ezdxf.read(io.StringIO(client.get(f"{place}.dxf").text.replace("\r\n", "\n")))
    assert not drawn.audit().errors
    motion = client.get(f"{place}/motion?steps=72").raise_for_status().json()
    rollers, stations = design["mechanism"]["rollers"], design["mechanism"]["stations"]
    assert motion["angle"][-1] - motion["angle"][0] == pytest.approx(360.0 * rollers / stations)
    # The program and the motion are one: at the same angles of the crank, per radian.
    for at, omega, moves in zip(motion["input_angle"], motion["omega"], motion["moves"], strict=True):
        if moves and rollers == 1 and at <= design["index_angle"]:
            k = round(at / design["index_angle"] * 360)
            if abs(design["program"]["angle"][k] - at) < 1e-9:
                assert omega == pytest.approx(design["program"]["v"][k], abs=1e-9)
        elif not moves:
            assert omega == 0.0


@pytest.mark.campaign
def test_a_drag_link_through_http(client: httpx.Client) -> None:
    """The whole driven: the wheel of the answer and of its analysis move alike, and demands together are kept."""
    demands = {"steady_share": 0.3, "dwell_share": {"min": 0.45}, "min_transmission_angle": 35.0, "pin_force": 30.0}
    wanted = indexing(driver="drag_link", load_inertia=0.02, constraints=demands)
    job = finished(client, wanted)
    (design,) = job["result"]["designs"]
    metrics, program = design["metrics"], design["program"]
    assert metrics["steady_share"] >= 0.3
    assert design["dwell_share"] >= 0.45
    assert metrics["min_transmission_angle"] >= 35.0
    assert metrics["peak_pin_force"] <= 30.0 * (1.0 + 1e-9)
    assert metrics["peak_acceleration"] < 2.0
    body = {"mechanism": design["mechanism"], "motion": {"from": 0.0, "to": design["index_angle"], "steps": 360}}
    found = client.post("/v1/analyses", json=body).raise_for_status().json()
    for name, told in (("angle", program["s"]), ("omega", program["v"]), ("alpha", program["a"])):
        assert found[name][1:-1] == pytest.approx(told[1:-1], abs=1e-7)
    assert all(found["moves"][1:-1])
    place = f"/v1/jobs/{job['id']}/designs/0"
    for form in ("svg", "gif", "dxf", "csv"):
        assert client.get(f"{place}.{form}").status_code == 200
    assert 'data-part="drag_link"' in client.get(f"{place}.svg").text
    whole = client.get(f"{place}/motion?steps=360").raise_for_status().json()
    assert whole["angle"][-1] == pytest.approx(90.0, abs=1e-6)


def test_a_wheel_is_drawn_with_true_arcs(client: httpx.Client) -> None:
    job = finished(client, indexing(center_distance=100.0, rollers=1))
    mechanism = job["result"]["designs"][0]["mechanism"]
    drawn = ezdxf.read(io.StringIO(client.get(f"/v1/jobs/{job['id']}/designs/0.dxf").text.replace("\r\n", "\n")))
    arcs = [arc for arc in drawn.modelspace().query("ARC") if arc.dxf.layer == "WHEEL"]
    radii = sorted({round(arc.dxf.radius, 6) for arc in arcs})
    told = (0.5 * mechanism["slot_width"], mechanism["locking_arc_radius"], mechanism["wheel_radius"])
    assert radii == sorted(round(radius, 6) for radius in told)
    # Of a closed outline each end of a line or an arc is an end of one other.
    lines = [line for line in drawn.modelspace().query("LINE") if line.dxf.layer == "WHEEL"]
    ends = [end for arc in arcs for end in (arc.start_point, arc.end_point)]
    ends += [end for line in lines for end in (line.dxf.start, line.dxf.end)]
    for end in ends:
        assert sum(end.isclose(other, abs_tol=1e-6) for other in ends) == 2
    assert len(arcs) + len(lines) == 4 * 6


def test_a_drive_of_four_stations_as_textbooks_have_it(client: httpx.Client) -> None:
    (design,) = outcome(client, indexing(center_distance=100.0, rollers=1, load_inertia=0.01))["designs"]
    metrics, program = design["metrics"], design["program"]
    assert (design["index_angle"], design["dwell_share"]) == (pytest.approx(90.0), pytest.approx(0.75))
    assert metrics["peak_velocity"] == pytest.approx(2.4142, abs=1e-4)
    assert metrics["peak_acceleration"] == pytest.approx(5.409, rel=5e-4)
    assert metrics["peak_acceleration_angle"] == pytest.approx(45.0 - 11.4637, abs=1e-3)
    assert metrics["peak_wheel_torque"] == pytest.approx(0.01 * (2.0 * math.pi) ** 2 * metrics["peak_acceleration"])
    assert program["s"][-1] == pytest.approx(90.0)
    assert program["a"][0] == pytest.approx(1.0)
    assert design["mechanism"]["crank_radius"] == pytest.approx(100.0 / math.sqrt(2.0))


@pytest.mark.slow
def test_demands_together(client: httpx.Client) -> None:
    demands = {"dwell_share": {"min": 0.3, "max": 0.6}, "pin_force": 50.0, "drive_torque": 20.0, "size": 800.0}
    wanted = indexing(load_inertia=0.02, load_torque=1.0, wheel_shaft_diameter=20.0, constraints=demands)
    (design,) = outcome(client, wanted)["designs"]
    assert design["mechanism"]["rollers"] == 2
    assert design["metrics"]["peak_pin_force"] <= 50.0 * (1.0 + 1e-9)
    assert design["metrics"]["size"] <= 800.0
    tighter = outcome(client, wanted | {"constraints": demands | {"size": 500.0}})
    assert tighter["designs"] == []
    assert tighter["search"]["complete"]
    assert tighter["search"]["rejected"]["size"] == 1


def test_a_crank_that_enters_with_a_shock(client: httpx.Client) -> None:
    wanted = indexing(center_distance=100.0, crank_radius=85.0, roller_diameter=12.0, rollers=4, load_inertia=0.02)
    allowed = wanted | {"constraints": {"shock_free": False}}
    assert outcome(client, allowed)["search"]["rejected"] == {"roller_clears_wheel": 1}
    wide = allowed | {"clearances": {"slot": 2.3, "locking": 0.1}}
    (design,) = outcome(client, wide)["designs"]
    assert design["mechanism"]["rollers"] == 4
    assert design["metrics"]["entry_speed"] > 0.1
    loose = outcome(client, wide | {"clearances": {"slot": 2.3, "locking": 30.0}})
    assert loose["designs"] == []
    assert not loose["search"]["complete"]


def test_a_drive_is_analysed(client: httpx.Client) -> None:
    body: Statement = {
        "mechanism": {"type": "geneva_external", "stations": 4, "center_distance": 100.0},
        "motion": {"at": 45.0, "speed": 10.0},
    }
    found = client.post("/v1/analyses", json=body).raise_for_status().json()
    assert found["angle"] == pytest.approx([45.0])
    assert found["omega"] == pytest.approx([10.0 * (1.0 + math.sqrt(2.0))])
    resting = client.post("/v1/analyses", json=body | {"motion": {"at": 200.0}}).json()
    assert (resting["moves"], resting["omega"]) == ([False], [0.0])
    short = body["mechanism"] | {"crank_radius": 60.0}
    refused = client.post("/v1/analyses", json=body | {"mechanism": short})
    assert [error["path"] for error in refused.json()["errors"]] == ["/mechanism/crank_radius"]


@pytest.mark.slow
def test_a_ratchet_is_found_drawn_and_moves(client: httpx.Client) -> None:
    wanted = RATCHET | {"pawls": {"friction": 0.2, "overlap": 2}, "constraints": {"pin_force": 500.0, "size": 120.0}}
    job = finished(client, wanted)
    designs = job["result"]["designs"]
    assert [len(one["mechanism"]["pawls"]) for one in designs] == [2, 4, 6]
    for number, design in enumerate(designs):
        assert design["metrics"]["tooth_force"] <= 500.0 * (1.0 + 1e-9)
        place = f"/v1/jobs/{job['id']}/designs/{number}"
        for form in ("svg", "dxf", "csv"):
            assert client.get(f"{place}.{form}").status_code == 200
        motion = client.get(f"{place}/motion?steps=360").raise_for_status().json()
        lifts = [max(pawl["lift"]) for pawl in motion["pawls"]]
        assert max(lifts) <= design["metrics"]["lift"] * (1.0 + 1e-9)
        assert min(lifts) > 0.8 * design["metrics"]["lift"]
    assert client.get(f"/v1/jobs/{job['id']}/report.html").status_code == 200
    small = wanted | {"constraints": {"pin_force": 500.0, "size": 60.0}}
    none = outcome(client, small)
    assert none["designs"] == []
    # A lower tooth or another pawl might do.
    assert not none["search"]["complete"]
    stated = wanted["pawls"] | {"count": 2, "tooth_height": 4.0, "length": 50.0}
    none = outcome(client, small | {"pawls": stated})
    assert none["designs"] == []
    assert none["search"]["complete"]


@pytest.mark.parametrize(
    ("problem", "path"),
    [
        (indexing(driver="drag_link", rollers=2), "/rollers"),
        (indexing(driver="drag_link", drive="geneva_spherical"), "/driver"),
        (indexing(constraints={"min_transmission_angle": 30.0}), "/constraints/min_transmission_angle"),
        (RATCHET | {"driver": "drag_link"}, "/driver"),
        (indexing(roller_diameter=None), "/roller_diameter"),
        (indexing(speed_rpm=None), "/speed_rpm"),
        (indexing(pawls={"count": 1}), "/pawls"),
        (indexing(stations=100), "/stations"),
        (RATCHET | {"speed_rpm": 10.0}, "/speed_rpm"),
        (RATCHET | {"load_inertia": 1.0}, "/load_inertia"),
        (RATCHET | {"clearances": {"slot": 0.1}}, "/clearances"),
        (RATCHET | {"wall_thickness": None}, "/wall_thickness"),
        (RATCHET | {"pawls": {"count": 5}}, "/pawls/count"),
        (RATCHET | {"stations": 7}, "/pawls/count"),
        (RATCHET | {"constraints": {"drive_torque": 1.0}}, "/constraints/drive_torque"),
        (RATCHET | {"constraints": {"shock_free": False}}, "/constraints/shock_free"),
        (indexing(stations=2), "/stations"),
        (indexing(drive="geneva_linear"), "/drive"),
        (indexing(rollers=4), "/rollers"),
        (indexing(drive="geneva_internal", rollers=2), "/rollers"),
        (indexing(sphere_radius=50.0), "/sphere_radius"),
        (indexing(drive="geneva_spherical", center_distance=50.0), "/center_distance"),
        (indexing(crank_radius=50.0), "/crank_radius"),
        (indexing(crank_radius=50.0, center_distance=100.0), "/crank_radius"),
        (indexing(crank_radius=100.0, center_distance=100.0), "/crank_radius"),
        (indexing(drive="geneva_internal", crank_shaft_diameter=5.0), "/crank_shaft_diameter"),
        (indexing(drive="geneva_internal", wheel_shaft_diameter=20.0), "/wheel_shaft_diameter"),
        (indexing(constraints={"shock_free": False}), "/constraints/shock_free"),
        (indexing(clearances={"relief": 0.01}), "/clearances/relief"),
        (indexing(clearances={"slot_end": 0.01}), "/clearances/slot_end"),
        (indexing(clearances={"slot": 31.0}), "/clearances/slot"),
        (indexing(clearances={"locking": 1e9}), "/clearances/locking"),
        (indexing(constraints={"dwell_share": {}}), "/constraints/dwell_share"),
        (indexing(constraints={"dwell_share": {"min": 0.7, "max": 0.6}}), "/constraints/dwell_share"),
        (indexing(load_inertia=-1.0), "/load_inertia"),
        (indexing(roller_diameter=0.0), "/roller_diameter"),
    ],
)
def test_a_refusal_names_the_field(client: httpx.Client, problem: Statement, path: str) -> None:
    answer = client.post("/v1/jobs", json={"problem": problem})
    assert answer.status_code == 422, answer.text
    assert f"/problem{path}" in [error["path"] for error in answer.json()["errors"]]
