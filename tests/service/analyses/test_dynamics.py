"""The block ``dynamics`` of ``POST /v1/analyses``: units, shapes, every type of mechanism, and bad statements."""

from __future__ import annotations

import copy
import math
from typing import Any

import httpx
import numpy as np
import pytest

from synthesis.analyses.linkages.linkage import LinkageAnalysis
from tests.support.service.analyses import STUCK
from tests.support.service.dynamics import (
    BAR,
    BLOCK,
    CRANK,
    OTHER_TYPES,
    TURN,
    Statement,
    agrees,
    asked,
    refused,
)


def test_without_dynamics_the_answer_is_the_same_as_before(client: httpx.Client) -> None:
    body = {"mechanism": CRANK, "motion": TURN, "points": {"G": {"link": "coupler", "distance": 3.0, "angle": 1.0}}}
    plain = client.post("/v1/analyses", json=body).json()
    assert plain.keys() == LinkageAnalysis.model_fields.keys() - {
        *("layout", "skeleton", "dynamics"),
        *("targets", "yield_", "manufacture"),
    }
    with_forces = client.post("/v1/analyses", json=body | {"dynamics": BLOCK}).json()
    assert {name: value for name, value in with_forces.items() if name not in ("skeleton", "dynamics")} == plain


def test_fourbar_of_shapes_and_loads(client: httpx.Client) -> None:
    found = asked(client, CRANK, BLOCK)
    agrees(found)
    forces = found["dynamics"]
    assert forces["status"] == ["ok"] * 73
    assert forces["length_unit"] == "mm"
    assert forces["shaking"]["about"] == [50.0, 0.0]
    assert set(forces["joints"]) == {"O2", "O4", "A", "B", "P"}
    assert forces["drive"] == pytest.approx(forces["virtual_work_drive"], abs=1e-12)
    assert found["skeleton"]["links"][0] == {"name": "ground", "joints": ["O2", "O4"]}
    # Bars of 7800 kg/m³, 10 mm thick, 20 mm wide; holes of 8 mm.
    area = 0.22 * 0.02 + math.pi * 0.02**2 / 4.0 - 2.0 * math.pi * 0.008**2 / 4.0
    bare = {name: value for name, value in CRANK.items() if name != "coupler_point"}
    hanging = {"gravity": {}, "bodies": {"coupler": BLOCK["bodies"]["coupler"]}}
    still = asked(client, bare, hanging, motion={"at": 40.0, "speed": 0.0})
    weight = 7800.0 * 0.01 * area * 9.80665
    assert still["dynamics"]["shaking"]["force"]["y"][0] == pytest.approx(-weight, rel=1e-12)


def test_si_of_another_length_unit_and_consistent_units_are_the_same_machine(client: httpx.Client) -> None:
    """The same machine in mm, in metres, and in consistent mm, t, N, N mm."""

    def scaled(factor: float) -> Statement:
        mechanism, block = copy.deepcopy(CRANK), copy.deepcopy(BLOCK)
        for pivot in mechanism["fixed_pivots"].values():
            pivot[:] = [factor * x for x in pivot]
        mechanism["links"] = {name: factor * length for name, length in mechanism["links"].items()}
        mechanism["coupler_point"]["distance"] *= factor
        block["bodies"]["input"]["cg"] = [factor * x for x in block["bodies"]["input"]["cg"]]
        for body in ("coupler", "output"):
            shape = block["bodies"][body]["shape"]
            shape["thickness"] *= factor
        coupler, output = block["bodies"]["coupler"]["shape"], block["bodies"]["output"]["shape"]
        coupler["width"] *= factor
        coupler["holes"] = {joint: factor * d for joint, d in coupler["holes"].items()}
        output["polygon"] = [[factor * x for x in corner] for corner in output["polygon"]]
        block["loads"][0]["point"] = [factor * x for x in block["loads"][0]["point"]]
        block["moment_about"] = [factor * x for x in block["moment_about"]]
        return {"mechanism": mechanism, "block": block}

    metres = scaled(1e-3)
    in_mm = asked(client, CRANK, BLOCK)["dynamics"]
    in_m = asked(client, metres["mechanism"], metres["block"], length_unit="m")["dynamics"]
    own = copy.deepcopy(BLOCK) | {"units": "consistent"}
    own["gravity"]["magnitude"] *= 1e3
    own["bodies"]["input"] = {"mass": 0.5e-3, "cg": [10.0, 5.0], "inertia": 0.001 * 1e3}
    own["bodies"]["coupler"]["shape"]["density"] *= 1e-12
    own["bodies"]["output"]["shape"]["density"] *= 1e-12
    own["point_masses"][0]["mass"] *= 1e-3
    own["loads"][2]["torque"]["constant"] *= 1e3
    consistent = asked(client, CRANK, own)["dynamics"]
    for there, moment in ((in_m, 1.0), (consistent, 1e3)):
        np.testing.assert_allclose(there["drive"], moment * np.array(in_mm["drive"]), rtol=1e-9)
        np.testing.assert_allclose(there["joints"]["A"]["input"]["x"], in_mm["joints"]["A"]["input"]["x"], rtol=1e-9)
        np.testing.assert_allclose(there["shaking"]["moment"], moment * np.array(in_mm["shaking"]["moment"]), rtol=1e-9)


@pytest.mark.parametrize("name", OTHER_TYPES)
def test_other_mechanisms(client: httpx.Client, name: str) -> None:
    mechanism = OTHER_TYPES[name]
    moving = [link["name"] for link in asked(client, mechanism, {})["skeleton"]["links"] if link["name"] != "ground"]
    bodies = {link: {"mass": 1.0 + n, "cg": [3.0, 4.0 * n], "inertia": 0.01} for n, link in enumerate(moving)}
    force = {"link": moving[-1], "point": {"distance": 12.0, "angle": 30.0}, "force": {"constant": [20.0, -7.0]}}
    found = asked(client, mechanism, {"gravity": {}, "bodies": bodies, "loads": [force]})
    agrees(found)
    assert "ok" in found["dynamics"]["status"]


def test_slider_that_drives_is_moved_by_a_force(client: httpx.Client) -> None:
    mechanism = OTHER_TYPES["slider_crank"] | {"driven_by": "slider"}
    bodies = {"crank": {"mass": 2.0, "cg": [10.0, 0.0], "inertia": 0.01}, "coupler": BAR}
    block = {"bodies": bodies, "point_masses": [{"joint": "B", "mass": 1.5}], "gravity": {}, "drive": {"slide": 0}}
    found = asked(client, mechanism, block, motion={"steps": 20, "speed": 300.0, "acceleration": 50.0})
    agrees(found)
    # It stands at toggles at both ends, where no force on the slider moves the crank.
    assert found["dynamics"]["status"] == ["dead_centre", *["ok"] * 19, "dead_centre"]
    assert found["dynamics"]["drive"][0] is None
    assert refused(client, block | {"drive": "torque"}, mechanism, motion={"steps": 20, "speed": 1.0}) == [
        "/dynamics/drive"
    ]


def test_where_it_cannot_be_assembled_nothing_is_a_number_and_extremes_are_of_the_rest(client: httpx.Client) -> None:
    found = asked(client, STUCK, {"units": "consistent", "bodies": {"coupler": {"mass": 1.0, "cg": [1.0, 1.0]}}})
    forces = found["dynamics"]
    open_positions = [not valid for valid in found["valid"]]
    assert any(open_positions)
    assert [status == "not_assembled" for status in forces["status"]] == open_positions
    assert all(
        (value is None) == (status != "ok") for value, status in zip(forces["drive"], forces["status"], strict=True)
    )
    assert forces["extremes"]["drive"]["max"] > 0.0
    assert forces["extremes"]["drive"]["mean"] is None
    agrees(found)


def test_extremes_are_of_the_curve_and_means_of_one_cycle(client: httpx.Client) -> None:
    coarse, fine = (asked(client, CRANK, BLOCK, motion={**TURN, "steps": steps})["dynamics"] for steps in (60, 1440))
    for name in ("shaking_force", "shaking_moment"):
        assert coarse["extremes"][name]["max"] == pytest.approx(fine["extremes"][name]["max"], rel=1e-6)
        assert coarse["extremes"][name]["at"] == pytest.approx(fine["extremes"][name]["at"], abs=0.02)
    for name in ("max", "min", "mean", "rms"):
        assert coarse["extremes"]["drive"][name] == pytest.approx(fine["extremes"]["drive"][name], rel=1e-6)
    assert coarse["power"]["peak"] == pytest.approx(fine["power"]["peak"], rel=1e-6)
    assert max(abs(x) for x in fine["drive"]) <= fine["power"]["peak"] / (2.0 * math.pi) * (1.0 + 1e-9)


def test_constant_loads_do_no_work_over_a_cycle(client: httpx.Client) -> None:
    loads = [{"joint": "P", "force": {"constant": [30.0, -50.0]}}, {"link": "output", "torque": {"constant": 25.0}}]
    extremes = asked(client, CRANK, {**BLOCK, "loads": loads}, motion={**TURN, "steps": 360})["dynamics"]["extremes"]
    assert abs(extremes["drive"]["mean"]) < 1e-9 * extremes["drive"]["max"]


def test_crank_alone_is_a_mechanism(client: httpx.Client) -> None:
    skeleton = {
        "joints": {"O2": [0.0, 0.0], "P": [100.0, 0.0]},
        "links": [{"name": "ground", "joints": ["O2"]}, {"name": "input", "joints": ["O2", "P"]}],
        "input_link": "input",
    }
    block = {"gravity": {}, "bodies": {"input": {"mass": 2.0, "cg": {"distance": 50.0}}}}
    found = asked(client, {"type": "skeleton", "skeleton": skeleton}, block, motion={"from": 0, "to": 360, "steps": 36})
    drive = 2.0 * 9.80665 * 0.05 * np.cos(np.radians(found["input_angle"]))
    np.testing.assert_allclose(found["dynamics"]["drive"], drive, atol=1e-12)
    assert found["circuits"] == [{"branches": [found["circuits"][0]["branches"][0]]}]


def changed(path: str, value: Any) -> Statement:
    block = copy.deepcopy(BLOCK)
    place: Any = block
    *parents, last = path.split("/")
    for step in parents:
        place = place[int(step) if isinstance(place, list) else step]
    place[int(last) if isinstance(place, list) else last] = value
    return block


BAD: dict[str, tuple[str, Any, str]] = {
    "no such link": ("bodies/rocker", {"mass": 1.0, "cg": [0, 0]}, "/dynamics/bodies/rocker"),
    "the ground": ("bodies/ground", {"mass": 1.0, "cg": [0, 0]}, "/dynamics/bodies/ground"),
    "negative mass": ("bodies/input/mass", -1.0, "/dynamics/bodies/input/mass"),
    "negative inertia": ("bodies/input/inertia", -0.1, "/dynamics/bodies/input/inertia"),
    "mass without a place": ("bodies/input", {"mass": 1.0}, "/dynamics/bodies/input"),
    "mass and shape": ("bodies/coupler/mass", 1.0, "/dynamics/bodies/coupler"),
    "hole elsewhere": ("bodies/coupler/shape/holes", {"O4": 3.0}, "/dynamics/bodies/coupler/shape/holes/O4"),
    "all hole": ("bodies/coupler/shape/holes", {"A": 300.0}, "/dynamics/bodies/coupler/shape"),
    "flat polygon": ("bodies/output/shape/polygon", [[0, 0], [1, 1], [2, 2]], "/dynamics/bodies/output/shape"),
    "width and polygon": ("bodies/output/shape/width", 3.0, "/dynamics/bodies/output/shape"),
    "square ends of a hull": ("bodies/coupler/shape/ends", "square", "/dynamics/bodies/coupler/shape/ends"),
    "mass on no joint": ("point_masses/0/joint", "Q", "/dynamics/point_masses/0/joint"),
    "load on no link": ("loads/2/link", "rocker", "/dynamics/loads/2/link"),
    "load on no joint": ("loads/1/joint", "Q", "/dynamics/loads/1/joint"),
    "load on the ground": ("loads/2/link", "ground", "/dynamics/loads/2/link"),
    "load without strength": ("loads/1/force", None, "/dynamics/loads/1"),
    "torque on a joint": ("loads/1", {"joint": "B", "torque": {"constant": 1.0}}, "/dynamics/loads/1"),
    "force on a link nowhere": ("loads/0/point", None, "/dynamics/loads/0"),
    "infinite": ("loads/1/force/constant", [1e300, 0.0], "/dynamics/loads/1/force/constant/0"),
    "expression": ("loads/1/force", {"expression": "sin(t)"}, "/dynamics/loads/1/force/expression"),
    "another drive": ("drive", {"slide": 0}, "/dynamics/drive/slide"),
    "units": ("units", "cgs", "/dynamics/units"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_blocks_are_refused_at_the_field(client: httpx.Client, name: str) -> None:
    path, value, expected = BAD[name]
    assert expected in refused(client, changed(path, value))


def test_other_families_have_no_forces(client: httpx.Client) -> None:
    mechanism = {"type": "universal_joint", "joints": [{"angle": 20.0}]}
    answer = client.post("/v1/analyses", json={"mechanism": mechanism, "dynamics": {}})
    assert answer.status_code == 422
