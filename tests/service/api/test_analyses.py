"""``POST /v1/analyses`` against the real service: numbers from the literature, laws of motion, and bad statements."""

import copy
import json
import math

import numpy as np
import pytest

from tests.cases import load
from tests.support.service.analyses import (
    EXAMPLE,
    FOURBAR,
    SIXBAR,
    STUCK,
    assert_as_documented,
    joint,
)

CASES = {case.id: case for case in load()}


def slider_crank(case, **fields):
    given = case.inputs
    return {
        "type": "slider_crank",
        "fixed_pivot": [0.0, 0.0],
        "links": {"crank": float(given["a"]), "coupler": float(given["b"])},
        "slide": {"point": [0.0, float(given["c"])], "angle": 0.0},
        "assembly": given["circuit"],
        **fields,
    }


def at(case, name="theta2"):
    speed = {"speed": float(case.inputs["omega2"])} if "omega2" in case.inputs else {}
    rate = {"acceleration": float(case.inputs["alpha2"])} if "alpha2" in case.inputs else {}
    return {"at": float(case.inputs[name]), **speed, **rate}


def test_the_documented_example_is_nortons_fourbar(client):
    answer = client.post("/v1/analyses", json=EXAMPLE)
    assert answer.headers["content-type"] == "application/json"
    found = answer.json()
    assert_as_documented(found)
    assert len(found["input_angle"]) == 361
    here = found["input_angle"].index(30.0)
    theta3, theta4 = found["links"]["coupler"]["angle"][here], found["links"]["output"]["angle"][here]
    CASES["ch4-S4-1-a-open"].check(theta3=theta3, theta4=theta4)
    assert math.isclose(theta3, 88.84, abs_tol=0.005)
    assert math.isclose(theta4, 117.29, abs_tol=0.005)
    CASES["ch4-S4-1-a-mu"].check(mu=found["transmission_angle"][here])
    assert found["classification"] == {"grashof": "crank_rocker", "barker": 2, "barker_code": "GCRR", "mobility": 1}
    assert found["toggles"] == []
    assert [len(circuit["branches"]) for circuit in found["circuits"]] == [1, 1]
    assert found["time"] is None
    assert all(found["valid"])
    assert min(found["links"]["output"]["angle"]) >= found["limits"]["output"][0] - 1e-9
    assert np.allclose(np.abs(joint(found, "A", "v")), 2.0 * 2.0 * math.pi), "60 rev/min"


def test_one_position(analyse):
    crossed = analyse({**FOURBAR, "assembly": "crossed"}, {"at": 30.0, "speed": 10.0, "acceleration": 0.0})
    assert len(crossed["input_angle"]) == len(crossed["valid"]) == 1
    CASES["ch4-S4-1-a-crossed"].check(
        theta3=crossed["links"]["coupler"]["angle"][0], theta4=crossed["links"]["output"]["angle"][0]
    )


def test_a_slider_crank(analyse):
    position, rates = CASES["ch4-S4-2-a-open"], CASES["ch6-S6-2-a-open"]
    found = analyse(slider_crank(rates), at(rates))
    # Norton's link 3 runs from the slider to the crank.
    position.check(theta3=found["links"]["coupler"]["angle"][0] % 360.0 + 180.0, d=found["slides"]["B"]["position"][0])
    velocity = joint(found, "A", "v")[0]
    rates.check(
        VA_mag=abs(velocity),
        VA_ang=math.degrees(np.angle(velocity)),
        omega3=found["links"]["coupler"]["omega"][0],
        VB=found["slides"]["B"]["velocity"][0],
    )


def test_a_slider_crank_that_the_slider_drives(analyse):
    case = CASES["ch4-S4-2-a-open"]
    driven = analyse(slider_crank(case), {"at": 45.0, "speed": 1.0})
    slider = driven["slides"]["B"]
    found = analyse(
        slider_crank(case, driven_by="slider", reference_input_angle=45.0),
        {"at": slider["position"][0], "speed": slider["velocity"][0], "acceleration": slider["acceleration"][0]},
    )
    crank = found["links"]["crank"]
    assert math.isclose(crank["angle"][0], 45.0, abs_tol=1e-9)
    assert math.isclose(crank["omega"][0], 1.0, abs_tol=1e-9)
    assert math.isclose(crank["alpha"][0], 0.0, abs_tol=1e-9)
    assert found["toggles"], "the slider has ends"


def test_a_geared_fivebar(analyse):
    case = CASES["ch6-S6-4-a-open"]
    given = {name: float(value) for name, value in case.inputs.items() if name != "circuit"}
    found = analyse(
        {
            "type": "geared_fivebar",
            "fixed_pivots": {"input": [0.0, 0.0], "output": [given["f"], 0.0]},
            "links": {"input": given["a"], "coupler_1": given["b"], "coupler_2": given["c"], "output": given["d"]},
            "gear_ratio": given["lambda"],
            "phase": given["phi"],
            "assembly": case.inputs["circuit"],
            "reference_input_angle": given["theta2"],
        },
        at(case),
    )
    case.check(omega3=found["links"]["coupler_1"]["omega"][0], omega4=found["links"]["coupler_2"]["omega"][0])


def test_a_skeleton_alone_moves_as_rigid_links(analyse):
    found = analyse(SIXBAR, {"from": 0.0, "to": 360.0, "steps": 720, "speed": 2.0})
    assert all(found["valid"])
    places = SIXBAR["skeleton"]["joints"]
    for link in SIXBAR["skeleton"]["links"]:
        for one in link["joints"]:
            for other in link["joints"]:
                length = abs(complex(*places[one]) - complex(*places[other]))
                assert np.allclose(np.abs(joint(found, one) - joint(found, other)), length, atol=1e-9)
    step = math.radians(0.5) / 2.0  # seconds
    slope = np.gradient(joint(found, "P"), step)[1:-1]
    assert np.abs(slope - joint(found, "P", "v")[1:-1]).max() < 1e-3 * np.abs(joint(found, "P", "v")).max()


def test_a_skeleton_says_the_same_as_the_dimensions(analyse):
    by_dimensions = analyse(FOURBAR, {"at": 30.0})
    skeleton = {
        "joints": {name: [joint(by_dimensions, name)[0].real, joint(by_dimensions, name)[0].imag]
                   for name in ("O2", "O4", "A", "B", "P")},
        "links": [
            {"name": "ground", "joints": ["O2", "O4"]},
            {"name": "input", "joints": ["O2", "A"]},
            {"name": "coupler", "joints": ["A", "B", "P"]},
            {"name": "output", "joints": ["O4", "B"]},
        ],
        "input_link": "input",
    }  # fmt: skip
    found = analyse({"type": "fourbar", "skeleton": skeleton})
    same = analyse(FOURBAR)
    assert found["classification"] == same["classification"]
    assert np.allclose(joint(found, "B"), joint(same, "B"), atol=1e-9)


def test_a_run_in_time(analyse):
    motion = {"time": {"start": 0.0, "end": 1.0, "step": 0.1}, "at": 10.0, "speed": 2.0, "acceleration": 3.0}
    found = analyse(FOURBAR, motion)
    t = np.array(found["time"])
    assert np.allclose(t, np.linspace(0.0, 1.0, 11))
    assert np.allclose(found["input_angle"], 10.0 + np.degrees(2.0 * t + 1.5 * t * t))
    assert np.allclose(np.abs(joint(found, "A", "v")), 2.0 * (2.0 + 3.0 * t))


def test_where_it_cannot_be_assembled_numbers_are_null(analyse):
    found = analyse(STUCK)
    valid = np.array(found["valid"])
    assert 0 < valid.sum() < len(valid)
    for name, track in found["joints"].items():
        for values in (track["x"], track["vy"]):
            assert [value is None for value in values] == list(~valid), name
    assert found["toggles"]
    assert found["classification"]["grashof"] == "rocker_rocker"


def test_speeds(analyse):
    by_radian, by_rpm = analyse(FOURBAR, {"at": 30.0}), analyse(FOURBAR, {"at": 30.0, "speed_rpm": 30.0 / math.pi})
    assert by_radian["links"]["input"]["omega"] == [1.0]
    assert np.allclose(by_rpm["links"]["output"]["omega"], by_radian["links"]["output"]["omega"])


def test_further_points_of_links(client):
    """The coupler point as a further point of the coupler moves as P does; a point must be on a link that moves."""
    mechanism = EXAMPLE["mechanism"]
    point = {"link": "coupler", **mechanism["coupler_point"]}
    body = {"mechanism": mechanism, "motion": {"at": 30.0, "speed": 2.0}, "points": {"mass centre": point}}
    found = client.post("/v1/analyses", json=body).json()
    assert_as_documented(found)
    for field, values in found["points"]["mass centre"].items():
        assert values == pytest.approx(found["joints"]["P"][field])
    for link in ("ground", "none"):
        answer = client.post("/v1/analyses", json={**body, "points": {"a/b": {"link": link, "distance": 1.0}}})
        assert answer.status_code == 422
        assert [error["path"] for error in answer.json()["errors"]] == ["/points/a~1b/link"]


def changed(mechanism, path, value):
    out = copy.deepcopy(mechanism)
    *parents, last = path
    place = out
    for step in parents:
        place = place[step]
    place[last] = value
    return out


MANY = {
    "joints": {"O0": [0.0, 0.0], "J0": [1.0, 0.3]}
    | {f"O{k}": [3.0 * k, 0.0] for k in range(1, 10)}
    | {f"J{k}": [3.0 * k + 0.2, 2.5 + 0.1 * k] for k in range(1, 10)},
    "links": [{"name": "ground", "joints": [f"O{k}" for k in range(10)]}, {"name": "input", "joints": ["O0", "J0"]}]
    + [{"name": f"coupler_{k}", "joints": [f"J{k - 1}", f"J{k}"]} for k in range(1, 10)]
    + [{"name": f"rocker_{k}", "joints": [f"O{k}", f"J{k}"]} for k in range(1, 10)],
    "input_link": "input",
}

THREE_LEGS = {
    "joints": {name: z for name, z in MANY["joints"].items() if name not in ("J7", "J8", "J9")}
    | {"A": [-2.7, 1.0], "C": [-2.2, 0.6], "B": [-1.5, 3.0], "D": [0.1, 2.2], "O": [-3.0, 0.0]},
    "links": [{"name": "ground", "joints": ["O", *(f"O{k}" for k in range(10))]},
              {"name": "input", "joints": ["O", "A", "C"]}, {"name": "leg_1", "joints": ["A", "B"]},
              {"name": "leg_2", "joints": ["C", "D"]}, {"name": "carried", "joints": ["B", "D", "J0"]},
              {"name": "leg_3", "joints": ["O0", "J0"]}, *MANY["links"][2:8], *MANY["links"][11:17]],
    "input_link": "input",
}  # fmt: skip
"""Stephenson II before six of the same fourbars."""

BAD_MECHANISMS = {
    "none": ({}, "/mechanism/skeleton"),
    "a negative length": (changed(FOURBAR, ("links", "input"), -1.0), "/mechanism/links/input"),
    "a text for a length": (changed(FOURBAR, ("links", "coupler"), "7"), "/mechanism/links/coupler"),
    "a length too many": (changed(FOURBAR, ("links", "rocker"), 1.0), "/mechanism/links/rocker"),
    "a length too few": (changed(FOURBAR, ("links",), {"input": 1.0, "coupler": 1.0}), "/mechanism/links/output"),
    "an absurd pivot": (changed(FOURBAR, ("fixed_pivots", "output"), [1e10, 0.0]), "/mechanism/fixed_pivots/output/0"),
    "half a pivot": (changed(FOURBAR, ("fixed_pivots", "input"), [1.0]), "/mechanism/fixed_pivots/input"),
    "one pivot twice": (changed(FOURBAR, ("fixed_pivots", "output"), [0.0, 0.0]), "/mechanism/fixed_pivots"),
    "links that do not reach": (changed(FOURBAR, ("links", "output"), 90.0), "/mechanism/links"),
    "an angle out of reach": ({**STUCK, "reference_input_angle": 180.0}, "/mechanism/reference_input_angle"),
    "a ground that is another": (changed(FOURBAR, ("links", "ground"), 7.0), "/mechanism/links/ground"),
    "an unknown assembly": ({**FOURBAR, "assembly": "left"}, "/mechanism/assembly"),
    "an unknown type": ({"type": "perpetuum_mobile", "skeleton": SIXBAR["skeleton"]}, "/mechanism/type"),
    "an unknown type of dimensions": ({**FOURBAR, "type": "perpetuum_mobile"}, None),
    "a joint without a name": (changed(SIXBAR, ("skeleton", "joints", ""), [0.0, 0.0]), "/mechanism/skeleton/joints/"),
    "a joint that is nowhere": (
        changed(SIXBAR, ("skeleton", "links", 1, "joints"), ["O2", "A", "Q"]), "/mechanism/skeleton",
    ),
    "an input that is no link": (changed(SIXBAR, ("skeleton", "input_link"), "link_3"), "/mechanism/skeleton"),
    "one link twice": (changed(SIXBAR, ("skeleton", "links", 2, "name"), "link_4"), "/mechanism/skeleton/links"),
    "too many freedoms": (
        changed(SIXBAR, ("skeleton", "links"), SIXBAR["skeleton"]["links"][:4]), "/mechanism/skeleton",
    ),
    "too many links outside dyads": ({"type": "skeleton", "skeleton": THREE_LEGS}, "/mechanism"),
}  # fmt: skip

BAD_MOTIONS = {
    "two speeds": ({"at": 1.0, "speed": 1.0, "speed_rpm": 1.0}, "/motion/speed_rpm"),
    "no steps": ({"steps": 0}, "/motion/steps"),
    "too many steps": ({"steps": 10_000}, "/motion/steps"),
    "half a step": ({"steps": 1.5}, "/motion/steps"),
    "a text": ({"from": "x"}, "/motion/from"),
    "an unknown field": ({"at": 1.0, "sped": 1.0}, "/motion/sped"),
    "backwards in time": ({"time": {"start": 1.0, "end": 0.0, "step": 0.1}}, "/motion/time/end"),
    "no end": ({"time": {"step": 0.1}}, "/motion/time/end"),
    "a step of no time": ({"time": {"end": 1.0, "step": 0.0}}, "/motion/time/step"),
    "too many moments": ({"time": {"end": 1e6, "step": 1.0}}, "/motion/time/step"),
    "a list": ([], "/motion"),
}


@pytest.mark.parametrize("name", BAD_MECHANISMS)
def test_a_bad_mechanism_is_refused_by_its_field(client, name):
    mechanism, path = BAD_MECHANISMS[name]
    answer = client.post("/v1/analyses", json={"mechanism": mechanism})
    assert answer.status_code == 422
    assert answer.headers["content-type"] == "application/problem+json"
    problem = answer.json()
    assert problem["type"] == "/problems/invalid-mechanism"
    paths = [error["path"] for error in problem["errors"]]
    assert "<" not in str(paths)
    assert all(found.startswith("/mechanism") for found in paths)
    assert path is None or path in paths
    assert all(error["detail"].endswith((".", "?")) for error in problem["errors"])


def test_what_has_too_many_assemblies_to_list_is_driven_all_the_same(client):
    found = client.post("/v1/analyses", json={"mechanism": {"type": "skeleton", "skeleton": MANY}}).json()
    assert sum(found["valid"]) > 300
    assert found["circuits"] == []
    note, _ = found["notes"]
    assert note.startswith("circuits, toggles, limits: ")


@pytest.mark.parametrize("name", BAD_MOTIONS)
def test_a_bad_motion_is_refused_by_its_field(client, name):
    motion, path = BAD_MOTIONS[name]
    answer = client.post("/v1/analyses", json={"mechanism": FOURBAR, "motion": motion})
    assert answer.status_code == 422
    assert answer.json()["type"] == "/problems/invalid-request"
    assert path in [error["path"] for error in answer.json()["errors"]]


@pytest.mark.parametrize(
    ("body", "status", "path"),
    [
        (b"", 400, None), (b"{", 400, None), (b"[" * 100_000, 400, None),
        (b"null", 422, ""), (b"[]", 422, ""), (b"3", 422, ""), (b"{}", 422, "/mechanism"),
        (b'{"mechanism": 3}', 422, "/mechanism"),
        (b'{"mechanism": {"type": []}}', 422, "/mechanism/type"),
        (json.dumps({"mechanism": FOURBAR, "x": 1}).encode(), 422, "/x"),
        (json.dumps({"mechanism": FOURBAR}).replace("7.0", "NaN").encode(), 422, "/mechanism/links/coupler"),
        (json.dumps({"mechanism": FOURBAR}).replace("7.0", "1e999").encode(), 422, "/mechanism/links/coupler"),
        (b'{"mechanism": [' + b"0," * 30_000 + b"0]}", 422, None),
        (b" " * (1 << 21), 413, None),
    ],
)  # fmt: skip
def test_a_bad_body(client, body, status, path):
    answer = client.post("/v1/analyses", content=body, headers={"Content-Type": "application/json"})
    assert answer.status_code == status
    assert answer.headers["content-type"] == "application/problem+json"
    assert "AnalysisRequest" not in answer.text
    assert path is None or path in [error["path"] for error in answer.json()["errors"]]


def test_another_media_type(client):
    answer = client.post("/v1/analyses", content=b"{}", headers={"Content-Type": "text/plain"})
    assert answer.status_code == 415


@pytest.mark.slow
def test_a_class_iii_mechanism_is_analysed_beside_other_requests(server, client):
    """Long analyses take no thread from the requests to the job store."""
    from concurrent.futures import ThreadPoolExecutor

    import httpx

    with ThreadPoolExecutor(6) as pool, httpx.Client(base_url=server.url, timeout=60.0) as other:
        body = {"mechanism": SIXBAR, "motion": {"steps": 9999}}
        under_way = [pool.submit(other.post, "/v1/analyses", json=body) for _ in range(6)]
        assert client.get("/v1/jobs?limit=1").status_code == 200
        assert all(answer.result().status_code == 200 for answer in under_way)


def test_no_request_here_was_met_with_a_defect(server):
    """Runs at the end of its module: the log of the session's server holds no traceback."""
    assert "Traceback" not in server.log()
