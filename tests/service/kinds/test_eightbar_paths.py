"""Paths by eightbars through HTTP: solved, driven by another formulation, drawn, analysed and made."""

from __future__ import annotations

import numpy as np
import pytest

from tests.oracles.loops import Loops
from tests.support.service.answers import drawn, finished
from tests.support.service.scripted_server import INSTANT
from tests.support.service.sixbar_paths import EIGHT, TASK

SIZE = float(np.abs(EIGHT[:, None] - EIGHT).max())
LAYOUT = {"link_width": 2.0, "pin_diameter": 1.0, "thickness": 1.0}


@pytest.mark.slow
@pytest.mark.timeout(300)
def test_an_eightbar_is_solved_driven_drawn_analysed_and_laid_out(client):
    limits = TASK["constraints"] | {"min_transmission_angle": 25.0}
    body = finished(client, TASK | {"mechanisms": ["eightbar"], "constraints": limits, "layout": LAYOUT})
    assert body["status"] == "succeeded", body
    design = body["result"]["designs"][0]
    assert design["verification"]["passed"]
    mechanism, metrics = design["mechanism"], design["metrics"]
    assert mechanism["type"] == "eightbar"
    assert len(mechanism["skeleton"]["links"]) == 8
    assert len(mechanism["skeleton"]["joints"]) == 11
    followed = Loops(mechanism["skeleton"]).followed(np.linspace(0.0, 2.0 * np.pi, 721))
    assert followed.branch > 0.0
    assert abs(followed.points[-1] - followed.points[0]) < 1e-8 * SIZE
    gaps = np.abs(EIGHT[:, None] - followed.points).min(axis=1)
    assert np.sqrt(np.mean(gaps**2)) < metrics["rms_distance"] + 0.005 * SIZE
    # Each dyad drives its first link; the least of all angles between two moving links there is the reported one.
    at_dyads = [
        min(angle for (_, *links), angle in followed.angles.items() if link in links and "ground" not in links)
        for link in metrics["transmission_angles"]
    ]
    assert len(at_dyads) == 3
    assert min(metrics["transmission_angles"].values()) == metrics["min_transmission_angle"] >= 25.0
    for reported in metrics["transmission_angles"].values():
        assert min(abs(angle - reported) for angle in followed.angles.values()) < 0.05
    assert "The best eightbar has P on" in body["result"]["summary"]
    place = f"/v1/jobs/{body['id']}/designs/0"
    drawn(client, place, design)
    assert "Eightbar" in client.get(f"{place}.svg").text
    analysis = client.post("/v1/analyses", json={"mechanism": mechanism})
    assert analysis.status_code == 200, analysis.text
    assert client.get(f"/v1/jobs/{body['id']}/report.html").status_code == 200
    parts = client.get(f"{place}/parts")
    assert parts.status_code == 200, parts.text


def test_requests_that_eightbars_do_not_support_are_refused_at_their_field(scripted):
    problem = TASK | {"seed": INSTANT, "mechanisms": ["eightbar"], "placement_free": ["size"]}
    answer = scripted.client.post("/v1/jobs", json={"problem": problem})
    assert answer.status_code == 422, answer.text
    (fault,) = answer.json()["errors"]
    assert fault["path"] == "/problem/placement_free"
    assert "sixbars and eightbars" in fault["detail"]
