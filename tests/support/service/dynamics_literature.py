"""Code that several tests share: dynamics literature."""

from __future__ import annotations

import cmath
import math
from typing import Any

import httpx

from tests.cases import Case

Answer = dict[str, Any]
Statement = dict[str, Any]


def analysed(client: httpx.Client, body: Statement) -> Answer:
    answer = client.post("/v1/analyses", json=body)
    assert answer.status_code == 200, answer.text
    return dict(answer.json())


def stated(case: Case) -> Statement:
    """A row as a request: the crank stands as in its skeleton."""
    given: dict[str, Any] = case.inputs or {}
    skeleton = given["skeleton"]
    first, second = (complex(*skeleton["joints"][joint]) for joint in ("O2", skeleton["links"][1]["joints"][1]))
    friction = {"friction": given["friction"]} if "friction" in given else {}
    return {
        "mechanism": {"type": "skeleton", "skeleton": skeleton},
        "motion": {
            "at": math.degrees(cmath.phase(second - first)),
            "speed": float(given["speed"]),
            "acceleration": float(given["acceleration"]),
        },
        "length_unit": "in",
        "dynamics": {
            "units": "consistent",
            "bodies": given["bodies"],
            "point_masses": [{"joint": joint, "mass": mass} for joint, mass in given.get("pin_masses", {}).items()],
            "loads": [
                *({"link": f["link"], "point": f["point"], "force": {"constant": f["force"]}} for f in given["forces"]),
                *({"link": t["link"], "torque": {"constant": t["torque"]}} for t in given["torques"]),
            ],
            **friction,
        },
    }
