"""Forces of ``POST /v1/analyses`` against the worked examples and problems of Norton, ch. 10 and 11."""

from __future__ import annotations

import cmath
import math
from dataclasses import replace
from typing import Any

import httpx
import pytest

from tests.cases import Case, cases
from tests.support.service.dynamics_literature import Answer, Statement, analysed, stated


def vector(series: dict[str, list[float]], x: str = "x", y: str = "y") -> complex:
    return complex(series[x][0], series[y][0])


def polar(name: str, value: complex) -> dict[str, float]:
    return {name: abs(value), f"{name}_angle": math.degrees(cmath.phase(value))}


def forces(answer: Answer) -> dict[str, float]:
    """Norton's names: F32 is the force of link 3 on link 2; link 4 is the output, or the block on the slide."""
    found, joints = answer["dynamics"], answer["dynamics"]["joints"]
    named = {"F12": vector(joints["O2"]["input"])}
    if "A" in joints:
        named["F32"] = vector(joints["A"]["input"])
    if "O4" in joints:
        named |= {"F43": vector(joints["B"]["coupler"]), "F14": vector(joints["O4"]["output"])}
    elif found["slides"]:
        slide = found["slides"][0]
        turned = cmath.exp(1j * math.radians(answer["skeleton"]["slides"][0]["angle"]))
        named |= {"F43": vector(joints["B"]["coupler"])}
        friction = slide.get("friction", [0.0])[0]
        named["F14"] = named["F13"] = (1j * slide["normal"][0] + friction) * turned
    values = {"T12": found["drive"][0]}
    for name, force in named.items():
        values |= polar(name, force) | {f"{name}x": force.real, f"{name}y": force.imag}
    shaking = vector(found["shaking"]["force"])
    return values | {"shaking_x": shaking.real, "shaking_y": shaking.imag}


def rates(answer: Answer) -> dict[str, float]:
    """Angles and rates of links 3 and 4; velocity and acceleration of the centres of gravity, 4 may be the block."""
    links, points = answer["links"], answer["points"]
    values = {}
    for number, link in (("2", "input"), ("3", "coupler"), ("4", "output")):
        if link in links:
            series = links[link]
            values |= {f"theta{number}": series["angle"][0], f"omega{number}": series["omega"][0]}
            values |= {f"alpha{number}": series["alpha"][0]}
        at = points[link] if link in points else answer["joints"].get("B")
        if at is not None:
            velocity, acceleration = vector(at, "vx", "vy"), vector(at, "ax", "ay")
            values |= polar(f"vG{number}", velocity) | polar(f"aG{number}", acceleration)
    if answer["slides"]:
        values["theta3"] += 180.0  # the table has the direction from B to A
    values |= {"aG": values["aG2"], "aG_angle": values["aG2_angle"]}
    if "B" in answer["joints"]:
        values["vB"] = abs(vector(answer["joints"]["B"], "vx", "vy"))
    return values


def with_centres(body: Statement, skeleton: dict[str, Any]) -> Statement:
    """The request with the centres of gravity as points of its links."""
    points = {}
    for link in skeleton["links"]:
        if link["name"] in body["dynamics"]["bodies"]:
            first, second = (complex(*skeleton["joints"][joint]) for joint in link["joints"][:2])
            cg = complex(*body["dynamics"]["bodies"][link["name"]]["cg"])
            place = (cg - first) / ((second - first) / abs(second - first))
            points[link["name"]] = {
                "link": link["name"],
                "distance": abs(place),
                "angle": math.degrees(cmath.phase(place)),
            }
    return body | {"points": points}


LOST = {"vP3", "vP3_angle"}
"""Of a point that the rows do not place."""

ROWS = [*cases("inverse_dynamics", "dynamics"), *cases("virtual_work", "dynamics"), *cases("cg_kinematics", "dynamics")]


@pytest.mark.parametrize("case", ROWS)
def test_forces_and_accelerations_are_those_of_the_book(client: httpx.Client, case: Case) -> None:
    assert case.inputs is not None
    body = with_centres(stated(case), case.inputs["skeleton"])
    answer = analysed(client, body)
    legible = {name: value for name, value in case.expected.items() if name not in LOST}
    replace(case, expected=legible).check(**rates(answer), **forces(answer))
    checks = answer["dynamics"]["checks"]
    assert checks["virtual_work"] < 1e-9
    assert checks["momentum"] < 1e-9


@pytest.mark.parametrize("case", cases("composite_mass", "dynamics"))
def test_masses_of_a_hammer_are_those_of_the_book(client: httpx.Client, case: Case) -> None:
    """Handle and head as parts of a pendulum that stands still at its handle's end.

    Without motion gravity along y gives the first moment by the drive, without gravity an acceleration of 1 the moment
    of inertia about the end.
    """
    given: dict[str, Any] = case.inputs or {}
    handle, head, g = given["handle"], given["head"], given["g"]
    weight = given["weight_density"]
    parts = [
        {
            "form": "cylinder",
            "axis": "in_plane",
            "at": [handle["length"] / 2.0, 0.0],
            "length": handle["length"],
            "diameter": handle["diameter"],
            "density": weight["wood"] / g,
        },
        {
            "form": "cylinder",
            "axis": "in_plane",
            "at": [head["centre"], 0.0],
            "length": head["height"],
            "diameter": head["diameter"],
            "density": weight[head["material"]] / g,
        },
    ]
    joints = {"O2": [0.0, 0.0], "P": [handle["length"], 0.0]}
    links = [{"name": "ground", "joints": ["O2"]}, {"name": "input", "joints": ["O2", "P"]}]
    body = {
        "mechanism": {"type": "skeleton", "skeleton": {"joints": joints, "links": links, "input_link": "input"}},
        "motion": {"at": 0.0, "speed": 0.0},
        "dynamics": {"units": "consistent", "bodies": {"input": {"shape": {"density": 1.0, "parts": parts}}}},
    }
    hanging = analysed(client, body | {"dynamics": {**body["dynamics"], "gravity": {"magnitude": 1.0}}})["dynamics"]
    mass, first = hanging["joints"]["O2"]["input"]["y"][0], hanging["drive"][0]
    turning = analysed(client, body | {"motion": {"at": 0.0, "speed": 0.0, "acceleration": 1.0}})["dynamics"]
    inertia = turning["drive"][0]
    case.check(cg=first / mass, Izz=inertia, k=math.sqrt(inertia / mass))
