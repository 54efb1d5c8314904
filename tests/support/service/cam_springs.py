"""Code that several tests share: cam springs."""

from __future__ import annotations

from typing import Any

import httpx

from tests.service.stated.cams import CAM
from tests.support.service.answers import finished

Answer = dict[str, Any]
Statement = dict[str, Any]

FAST: Statement = {**CAM, "speed_rpm": 600.0, "include_failed": True}


def designed(client: httpx.Client, dynamics: Statement, **changes: Any) -> Answer:
    job = finished(client, {**FAST, "dynamics": dynamics, **changes})
    assert job["status"] == "succeeded", job["error"]
    (design,) = job["result"]["designs"]
    return dict(design)


def refused(client: httpx.Client, dynamics: Statement, **changes: Any) -> list[str]:
    answer = client.post("/v1/jobs", json={"problem": {**FAST, "dynamics": dynamics, **changes}})
    assert answer.status_code == 422, answer.text
    return [error["path"] for error in answer.json()["errors"]]


def check(design: Answer, name: str) -> Answer:
    return next(check for check in design["verification"]["checks"] if check["name"] == name)
