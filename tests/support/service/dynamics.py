"""Code that several tests share: dynamics."""

from __future__ import annotations

from typing import Any

import httpx

from synthesis.analyses.linkages.linkage import LinkageAnalysis
from tests.support.service.analyses import SIXBAR

Statement = dict[str, Any]

TURN = {"from": 0.0, "to": 360.0, "steps": 72, "speed_rpm": 60.0}
BAR = {"shape": {"density": 7800.0, "thickness": 10.0, "width": 20.0}}
CRANK = {
    "type": "fourbar",
    "fixed_pivots": {"input": [0.0, 0.0], "output": [200.0, 0.0]},
    "links": {"input": 60.0, "coupler": 220.0, "output": 150.0},
    "coupler_point": {"distance": 100.0, "angle": 20.0},
}
BLOCK = {
    "gravity": {"magnitude": 9.80665, "angle": 270.0},
    "bodies": {
        "input": {"mass": 0.5, "cg": [10.0, 5.0], "inertia": 0.001},
        "coupler": {"shape": {**BAR["shape"], "holes": {"A": 8.0, "B": 8.0}}},
        "output": {"shape": {"density": 2700.0, "thickness": 5.0, "polygon": [[0, 0], [200, 0], [200, 90], [0, 20]]}},
    },
    "point_masses": [{"joint": "B", "mass": 0.9}],
    "loads": [
        {"link": "coupler", "point": [80.0, 40.0], "frame": "link", "force": {"constant": [3.0, -12.0]}},
        {"joint": "P", "force": {"constant": [0.0, -5.0]}},
        {"link": "output", "torque": {"constant": 2.5}},
    ],
    "moment_about": [50.0, 0.0],
}
OTHER_TYPES: dict[str, Statement] = {
    "slider_crank": {
        "type": "slider_crank",
        "fixed_pivot": [0.0, 0.0],
        "links": {"crank": 40.0, "coupler": 120.0},
        "slide": {"point": [0.0, 10.0], "angle": 0.0},
        "assembly": "open",
    },
    "inverted_slider_crank": {
        "type": "inverted_slider_crank",
        "fixed_pivots": {"input": [0.0, 0.0], "output": [100.0, 0.0]},
        "links": {"input": 40.0, "output": 20.0},
        "slide": {"angle": 90.0},
        "assembly": "open",
    },
    "geared_fivebar": {
        "type": "geared_fivebar",
        "fixed_pivots": {"input": [0.0, 0.0], "output": [60.0, 0.0]},
        "links": {"input": 10.0, "coupler_1": 70.0, "coupler_2": 90.0, "output": 20.0},
        "gear_ratio": -1.0,
        "phase": 20.0,
        "coupler_point": {"distance": 0.0, "angle": 0.0},
        "assembly": "open",
    },
    "class III": SIXBAR,
}


def asked(client: httpx.Client, mechanism: Statement, block: Statement, **more: Any) -> Statement:
    body = {"mechanism": mechanism, "motion": TURN, "dynamics": block} | more
    answer = client.post("/v1/analyses", json=body)
    assert answer.status_code == 200, answer.text
    assert "NaN" not in answer.text
    found: Statement = answer.json()
    LinkageAnalysis.model_validate(found)
    return found


def refused(client: httpx.Client, block: Statement, mechanism: Statement = CRANK, **more: Any) -> list[str]:
    answer = client.post("/v1/analyses", json={"mechanism": mechanism, "motion": TURN, "dynamics": block} | more)
    assert answer.status_code == 422, answer.text
    return [fault["path"] for fault in answer.json()["errors"]]


def agrees(found: Statement) -> None:
    assert found["dynamics"]["checks"]["virtual_work"] < 1e-9
    assert found["dynamics"]["checks"]["momentum"] < 1e-9
