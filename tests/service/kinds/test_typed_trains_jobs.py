"""Trains of typed stages through HTTP: answers, files, refusals, and analyses in which every field counts."""

from __future__ import annotations

import copy
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

PARALLEL: Statement = {
    "kind": "gear_train", "ratio": "10", "max_designs": 1, "teeth": {"min": 18, "max": 60}, "module": 2.0,
    "stages": [{"type": "helical", "helix_angle": 15.0}, {"type": "internal"}],
}  # fmt: skip
CROSSING: Statement = {
    "kind": "gear_train", "ratio": "60", "max_designs": 1, "module": [3.0, 4.0],
    "stages": [{"type": "bevel", "driver": 20, "driven": 30}, {"type": "worm", "driver": 1, "driven": 40}],
}  # fmt: skip


def design_of(client: httpx.Client, problem: Statement, **changes: Any) -> tuple[Any, str]:
    job = finished(client, {**problem, **changes})
    assert job["status"] == "succeeded", job["error"]
    design = job["result"]["designs"][0]
    assert design["verification"]["passed"]
    return design, f"/v1/jobs/{job['id']}/designs/0"


def outlines(client: httpx.Client, place: str, stage: int) -> list[np.ndarray]:
    document = ezdxf.read(io.StringIO(client.get(f"{place}.dxf").text))
    lines = document.modelspace().query(f"LWPOLYLINE[layer=='STAGE_{stage}_TEETH']")
    return [np.array([complex(x, y) for x, y in line.get_points("xy")]) for line in lines]


@pytest.mark.slow
def test_a_ring_is_drawn_around_its_pinion_in_mesh(client: httpx.Client) -> None:
    """The outlines of the CAD file: where the pinion reaches beyond the tips of the ring it lies in its spaces."""
    design, place = design_of(client, PARALLEL)
    assert [shaft["turns"] for shaft in design["metrics"]["shafts"]] == ["same", "opposite", "opposite"]
    pinion, ring = outlines(client, place, 2)
    rows = list(csv.DictReader(io.StringIO(client.get(f"{place}.csv").text)))
    assert [row["type"] for row in rows] == ["helical", "helical", "internal", "internal"]
    assert [float(row["helix_angle_deg"]) for row in rows] == [15.0, -15.0, 0.0, 0.0]
    centre = complex(float(rows[3]["centre_x_mm"]), float(rows[3]["centre_y_mm"]))
    inner = np.abs(ring - centre).min()
    # Where the pinion is farther out than the ring's tips it lies in spaces: at its angle the ring is farther out.
    reaching = pinion[np.abs(pinion - centre) > inner]
    assert len(reaching)
    angles = np.unwrap(np.angle(ring - centre))
    order = np.argsort(np.angle(ring - centre))
    around, radii = np.angle(ring - centre)[order], np.abs(ring - centre)[order]
    room = np.interp(np.angle(reaching - centre), around, radii, period=2.0 * math.pi) - np.abs(reaching - centre)
    assert abs(angles[-1] - angles[0]) > 6.0
    assert room.min() > -0.02
    sheet = client.get(f"{place}.svg").text
    assert "addendum of the ring" in sheet
    assert "right-handed driver" in sheet
    assert client.get(f"{place}.gif").content[:6] == b"GIF89a"


@pytest.mark.slow
def test_views_of_shafts_that_are_not_parallel(client: httpx.Client) -> None:
    design, place = design_of(client, CROSSING)
    mesh = design["metrics"]["meshes"][0]
    sheet = client.get(f"{place}.svg").text
    assert "stage 1: bevel, in the plane of its shafts" in sheet
    assert "stage 2: worm, in its gear" in sheet
    assert "self-locking" in sheet
    one, two = outlines(client, place, 1)
    # Both bodies reach from the apex as far as their tips: the cone distance and a module across.
    for body in (one, two):
        assert np.abs(body).max() == pytest.approx(math.hypot(mesh["cone_distance"], 3.75), rel=1e-6)
    words = [
        text.dxf.text for text in ezdxf.read(io.StringIO(client.get(f"{place}.dxf").text)).modelspace().query("TEXT")
    ]
    assert any("worm, in its gear's middle plane" in one for one in words)
    assert client.get(f"{place}.gif").content[:6] == b"GIF89a"


def test_a_unit_of_a_series_has_typed_stages(client: httpx.Client) -> None:
    unit = {"type": "gear_train", "stages": [{"type": "internal"}], "teeth": {"min": 18, "max": 60}}
    other = {"type": "gear_train", "teeth": {"min": 18, "max": 60}}
    series: Statement = {"kind": "train_series", "ratio": -6, "units": [unit, other], "max_designs": 1}
    design, place = design_of(client, series)
    assert design["mechanism"]["units"][0]["stages"][0]["type"] == "internal"
    assert "internal, " in client.get(f"{place}.svg").text
    told = client.post("/v1/analyses", json={"mechanism": design["mechanism"]})
    assert told.status_code == 200
    assert told.json()["ratio"]["numerator"] < 0
    for stages in (1, 2):
        counted = {**series, "units": [{**unit, "max_stages": stages}, other]}
        reply = client.post("/v1/jobs", json={"problem": counted})
        assert [fault["path"] for fault in reply.json()["errors"]] == ["/problem/units/0/max_stages"]


@pytest.mark.parametrize(
    ("changes", "path"),
    [
        ({"stages": [{"type": "helical"}]}, "/problem/stages/0/helix_angle"),
        ({"stages": [{"type": "bevel"}]}, "/problem/stages/0/driver"),
        ({"stages": [{"type": "internal"}], "ratio": "-3"}, "/problem/ratio"),
        ({"stages": [{"type": "internal", "friction": 0.1}]}, "/problem/stages/0/friction"),
        ({"stages": [{"type": "hypoid"}]}, "/problem/stages/0/type"),
        ({"stages": []}, "/problem/stages"),
        ({"max_stages": 4}, "/problem/max_stages"),
        ({"max_stages": 3}, "/problem/max_stages"),
        ({"max_stages": 2}, "/problem/max_stages"),
        ({"stages": [{"type": "internal", "driver": 40, "driven": 42}]}, "/problem/stages/0"),
        ({"stages": [{"type": "bevel", "driver": 20, "driven": 60, "shaft_angle": 120.0}]},
         "/problem/stages/0/shaft_angle"),
        ({"stages": [{"type": "internal", "driver": 20}], "teeth": [{"min": 30, "max": 31}, {"max": 90}]},
         "/problem/teeth/0"),
        ({"stages": [CROSSING["stages"][0], *[{"type": "external"}] * 3], "teeth": {"min": 12, "max": 2000}},
         "/problem/teeth"),
        ({"centre_distance": 60.0}, "/problem/stages/1/type"),
    ],
)  # fmt: skip
def test_faults_are_told_where_they_stand(client: httpx.Client, changes: Statement, path: str) -> None:
    reply = client.post("/v1/jobs", json={"problem": {**PARALLEL, **changes}})
    assert reply.status_code == 422
    assert path in [fault["path"] for fault in reply.json()["errors"]]


ANALYSED: Statement = {
    "mechanism": {
        "type": "gear_train",
        "stages": [
            {"driver": 20, "driven": 30, "module": 2.0, "type": "helical", "helix_angle": 15.0, "face_width": 20.0},
            {"driver": 20, "driven": 60, "type": "internal", "addendum": {"driver": 1.0, "driven": 0.8}},
            {"driver": 20, "driven": 25, "type": "bevel", "shaft_angle": 80.0, "face_width": 5.0},
            {"driver": 2, "driven": 40, "type": "worm", "diameter_quotient": 9.0, "hand": "right", "friction": 0.06},
        ],
    },
    "motion": {"at": 0.0, "speed_rpm": 1000.0},
    "input_torque": 10.0,
}


def analysed(client: httpx.Client, request: Statement) -> Any:
    reply = client.post("/v1/analyses", json=request)
    assert reply.status_code == 200, reply.text
    return reply.json()


@pytest.mark.parametrize(
    ("stage", "changes"),
    [
        (0, {"type": "external", "helix_angle": None, "face_width": None}),
        (0, {"helix_angle": -15.0}),
        (0, {"face_width": 25.0}),
        (1, {"addendum": {"driver": 1.0, "driven": 0.7}}),
        (1, {"addendum": None}),
        (1, {"addendum": {"driver": 0.9, "driven": 0.8}}),
        (2, {"shaft_angle": 70.0}),
        (2, {"face_width": None}),
        (3, {"diameter_quotient": 10.0}),
        (3, {"hand": "left"}),
        (3, {"friction": 0.1}),
        (3, {"driver": 1}),
    ],
)
def test_every_field_of_a_stage_counts_in_an_analysis(client: httpx.Client, stage: int, changes: Statement) -> None:
    other = copy.deepcopy(ANALYSED)
    other["mechanism"]["stages"][stage] |= changes
    assert analysed(client, ANALYSED) != analysed(client, other)


def test_forces_of_an_analysis(client: httpx.Client) -> None:
    """Helical, Shigley eq. 13-40: W_a = W_t tan ψ, W_r = W_t tan φ_t; bevel, eq. 13-38, at the middle of the face."""
    told = analysed(client, ANALYSED)
    helical, _, bevel, worm = told["meshes"]
    assert helical["tangential_force"] == pytest.approx(2000.0 * 10.0 / (20 * 2.0 / math.cos(math.radians(15.0))))
    assert helical["axial_force"]["driver"] == pytest.approx(helical["tangential_force"] * math.tan(math.radians(15.0)))
    assert helical["axial_force"]["driven"] == -helical["axial_force"]["driver"]
    torque, cone = told["shafts"][2]["torque"], math.radians(bevel["cone_angle"]["driver"])
    middle = 10.0 - 2.5 * math.sin(cone)
    assert bevel["tangential_force"] == pytest.approx(abs(torque) * 1000.0 / middle)
    for name, part in (("radial_force", math.cos(cone)), ("axial_force", math.sin(cone))):
        found = bevel[name] if name == "radial_force" else bevel[name]["driver"]
        assert found == pytest.approx(bevel["tangential_force"] * math.tan(math.radians(20.0)) * part)
    assert worm["axial_force"] == {"driver": worm["tangential_force"], "driven": pytest.approx(
        2000.0 * abs(told["shafts"][3]["torque"]) / 9.0)}  # fmt: skip
    out = told["shafts"][4]
    assert abs(out["torque"]) == pytest.approx(worm["tangential_force"] * 0.02, rel=1e-12)
    assert out["axis"] is not None


def test_a_worm_that_locks_is_not_driven_back(client: httpx.Client) -> None:
    request = copy.deepcopy(ANALYSED)
    request["input_torque"] = -10.0
    assert analysed(client, request)["meshes"][3]["efficiency"] < analysed(client, ANALYSED)["meshes"][3]["efficiency"]
    request["mechanism"]["stages"][3]["friction"] = 0.3
    reply = client.post("/v1/analyses", json=request)
    assert reply.status_code == 422
    assert [fault["path"] for fault in reply.json()["errors"]] == ["/mechanism/stages/3/friction"]


def test_a_stated_efficiency_of_meshes_is_not_that_of_worms(client: httpx.Client) -> None:
    plain, told = analysed(client, ANALYSED), analysed(client, {**ANALYSED, "mesh_efficiency": 0.9})
    assert [mesh["efficiency"] for mesh in told["meshes"]] == [0.9, 0.9, 0.9, plain["meshes"][3]["efficiency"]]
    worm = {"type": "gear_train", "stages": ANALYSED["mechanism"]["stages"][3:]}
    reply = client.post("/v1/analyses", json={"mechanism": worm, "mesh_efficiency": 0.9})
    assert reply.status_code == 422
    assert [fault["path"] for fault in reply.json()["errors"]] == ["/mesh_efficiency"]


@pytest.mark.parametrize(
    ("stage", "changes", "path"),
    [
        (0, {"shaft_angle": 80.0}, "shaft_angle"),
        (1, {"driven": 20}, "driven"),
        (2, {"shift": {"driver": 0.1, "driven": 0.1}}, "shift"),
        (3, {"driver": 9}, "driver"),
        (3, {"face_width": 10.0}, "face_width"),
        (0, {"addendum": {"driver": 1.0, "driven": 1.0}}, "addendum"),
        (2, {"face_width": 20.0}, "face_width"),
        (3, {"friction": 1.0, "driver": 6, "diameter_quotient": 4.0}, "friction"),
    ],
)
def test_stages_of_an_analysis_are_refused_by_field(
    client: httpx.Client, stage: int, changes: Statement, path: str
) -> None:
    request = copy.deepcopy(ANALYSED)
    request["mechanism"]["stages"][stage] |= changes
    reply = client.post("/v1/analyses", json=request)
    assert reply.status_code == 422
    assert f"/mechanism/stages/{stage}/{path}" in [fault["path"] for fault in reply.json()["errors"]]
