"""Whole curves over HTTP: the answer, its drawing with the demanded curve, its motion."""

from __future__ import annotations

import io
import math
import xml.etree.ElementTree as ET
import zipfile

import numpy as np
import pytest

from synthesis.registry import list_examples

SVG = "{http://www.w3.org/2000/svg}"
DRAWN = next(example for example in list_examples("path") if example.get("method") == "curve_match")


@pytest.mark.slow
def test_a_drawn_curve_is_matched_drawn_and_driven(server, client):
    job = client.post("/v1/jobs", json={"problem": DRAWN}, headers={"Prefer": "wait=30"}).json()
    job = server.reaches(job["id"], "succeeded", seconds=110.0)
    result = job["result"]
    assert result["search"]["method"] == "curve_match"
    assert not result["search"]["complete"]
    assert result["sweep"]["linkages"] >= 100_000
    best = result["designs"][0]
    assert best["verification"]["passed"]
    assert best["metrics"]["full_rotation"]
    assert best["metrics"]["rms_distance"] < 1.5
    assert best["metrics"]["curve_distance"] < 5.0
    assert len(best["targets"]) == len(DRAWN["points"])

    drawing = client.get(f"/v1/jobs/{job['id']}/designs/0.svg")
    root = ET.fromstring(drawing.text)
    curves = {e.get("data-curve") for e in root.iter(f"{SVG}path")}
    assert {"target", "used"} <= curves
    assert "target curve" in drawing.text

    motion = client.get(f"/v1/jobs/{job['id']}/designs/0/motion", params={"steps": 360}).json()
    traced = np.array(motion["joints"]["P"]["x"], float) + 1j * np.array(motion["joints"]["P"]["y"], float)
    off = [np.nanmin(np.abs(traced - complex(p["x"], p["y"]))) for p in DRAWN["points"]]
    assert math.sqrt(np.mean(np.square(off))) < best["metrics"]["rms_distance"] + 0.5


def test_what_no_curve_match_can_keep_is_refused_with_its_place(client):
    timed = {
        **DRAWN,
        "timing": "prescribed",
        "points": [{**p, "crank_angle": 9.0 * k} for k, p in enumerate(DRAWN["points"])],
    }
    refused = client.post("/v1/jobs", json={"problem": timed})
    assert refused.status_code == 422
    assert "/problem/timing" in [error["path"] for error in refused.json()["errors"]]
    many = {**DRAWN, "points": [{"x": float(k), "y": float(k % 7)} for k in range(5000)]}
    refused = client.post("/v1/jobs", json={"problem": many})
    assert refused.status_code == 422
    assert "/problem/points" in [error["path"] for error in refused.json()["errors"]]
    nowhere = {**DRAWN, "points": [{"x": 1.0, "y": 2.0}] * 8}
    refused = client.post("/v1/jobs", json={"problem": nowhere})
    assert refused.status_code == 422
    assert "/problem/points" in [error["path"] for error in refused.json()["errors"]]


@pytest.mark.slow
def test_a_geared_fivebar_is_fitted_drawn_and_driven(server, client):
    """The curve of a linkage of gear ratio −1: its design comes back, and its motion passes the points."""
    points = [
        (3.2, 0.6),
        (2.9, 1.3),
        (2.2, 1.9),
        (1.3, 2.2),
        (0.5, 2.1),
        (0.1, 1.6),
        (0.3, 1.0),
        (1.0, 0.5),
        (2.0, 0.3),
    ]
    problem = {
        "kind": "path",
        "method": "least_squares",
        "closed": True,
        "mechanism": "geared_fivebar",
        "gear_ratio": -1.0,
        "points": [{"x": x, "y": y} for x, y in points],
    }
    job = client.post("/v1/jobs", json={"problem": problem}, headers={"Prefer": "wait=30"}).json()
    job = server.reaches(job["id"], "succeeded", seconds=110.0)
    best = job["result"]["designs"][0]
    assert best["mechanism"]["type"] == "geared_fivebar"
    assert best["mechanism"]["skeleton"]["gears"] == [{"links": ["input", "output"], "ratio": -1.0}]
    motion = client.get(f"/v1/jobs/{job['id']}/designs/0/motion", params={"steps": 720}).json()
    traced = np.array(motion["joints"]["P"]["x"], float) + 1j * np.array(motion["joints"]["P"]["y"], float)
    off = [np.nanmin(np.abs(traced - complex(x, y))) for x, y in points]
    assert math.sqrt(np.mean(np.square(off))) < best["metrics"]["rms_distance"] + 0.02
    drawing = client.get(f"/v1/jobs/{job['id']}/designs/0.svg")
    assert drawing.status_code == 200
    assert "gear ratio" in drawing.text
    built = client.get(f"/v1/jobs/{job['id']}/designs/0/parts", params={"scale": 20.0})
    assert built.status_code == 200, built.text
    with zipfile.ZipFile(io.BytesIO(built.content)) as archive:
        assert {"dxf/gear_of_input.dxf", "dxf/gear_of_output.dxf"} <= set(archive.namelist())
        assert "18 of the gear of input, 18 of the gear of output" in archive.read("README.txt").decode()
