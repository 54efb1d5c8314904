"""What tests of a kind of problem ask of the service: a job to its end, the drawing of a design and its files."""

from __future__ import annotations

import copy
import json
import xml.etree.ElementTree as ET
from typing import Any

from tests.support.service.running import until

SVG = "{http://www.w3.org/2000/svg}"

ENDED_S = 240.0
"""A busy machine may need that long for what takes a second."""

_ended_jobs: dict[tuple[str, str], Any] = {}
"""Jobs of this session that succeeded, by the server's address and the problem: a seeded problem has one answer."""


def finished(client, problem, seconds=ENDED_S, fresh=False):
    """Return the job of a problem when it has ended, at most `seconds` later.

    A problem that a server has answered in this session is not posted again, unless it has to be a `fresh` job.
    """
    key = str(client.base_url), json.dumps(problem, sort_keys=True)
    if fresh or key not in _ended_jobs:
        job = _solve_job(client, problem, seconds)
        if job["status"] != "succeeded":
            return job
        _ended_jobs[key] = job
    return copy.deepcopy(_ended_jobs[key])


def _solve_job(client, problem, seconds):
    answer = client.post("/v1/jobs", json={"problem": problem}, headers={"Prefer": "wait=30"})
    assert answer.status_code in (200, 202), answer.text
    job = answer.json()

    def ended():
        now = client.get(f"/v1/jobs/{job['id']}").json()
        return None if now["status"] in ("queued", "running") else now

    return job if answer.status_code == 200 else until(ended, seconds, "the job's end")


def drawn(client, place, design):
    """The drawing of the design of a linkage, as a tree; all its joints are labelled, and its other files come."""
    drawing = client.get(f"{place}.svg")
    assert drawing.status_code == 200, drawing.text
    root = ET.fromstring(drawing.text)
    joints = {e.get("data-joint") for e in root.iter(f"{SVG}circle")} - {None}
    assert joints == set(design["mechanism"]["skeleton"]["joints"])
    for form in ("gif", "dxf", "csv"):
        file = client.get(f"{place}.{form}")
        assert file.status_code == 200, file.text
        assert len(file.content) > 10_000
    return root
