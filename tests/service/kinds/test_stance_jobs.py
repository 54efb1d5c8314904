"""Legs through HTTP: a stance is kept as another formulation drives it, drawn, and refused at its field."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from tests.oracles.loops import Loops
from tests.support.service.answers import drawn, finished

STRAIGHT = 100.0 * np.linspace(0.0, 1.0, 12) + 0j
LIFT = np.linspace(0.0, math.pi, 14)[1:-1]
FOOT = np.concatenate([STRAIGHT, 50.0 + 52.0 * np.cos(LIFT) + 26.0j * np.sin(LIFT)])
STANCE = {"points": [0, 11], "flatness": 1.5, "speed": "constant", "speed_tolerance": 0.25}


def listed(points: np.ndarray) -> list[dict[str, float]]:
    return [{"x": float(z.real), "y": float(z.imag)} for z in points]


LEG: dict[str, Any] = {
    "kind": "path",
    "method": "curve_match",
    "closed": True,
    "points": listed(FOOT),
    "stance": STANCE,
    "max_designs": 2,
}


def walked(design: dict[str, Any], first: int, last: int, points: np.ndarray) -> tuple[float, float]:
    """Height of P across the line of the stance, and the most that its speed is off the mean, by the links' loops."""
    inputs = np.radians([target["input_angle"] for target in design["targets"]])
    end = inputs[last] + (math.copysign(math.tau, inputs[-1] - inputs[0]) if first > last else 0.0)
    at = np.linspace(inputs[first], end, 401)
    met = Loops(design["mechanism"]["skeleton"]).followed(at - inputs[0])
    assert met.branch > 0.0
    way = points[last] - points[first]
    places = met.points * np.conj(way / abs(way))
    speeds = np.gradient(places.real, at, edge_order=2) * (at[-1] - at[0]) / (places[-1] - places[0]).real
    return float(np.ptp(places.imag)), float(np.abs(speeds - 1.0).max())


@pytest.mark.campaign
@pytest.mark.timeout(300)
@pytest.mark.parametrize(("kind", "begins"), [("fourbar", 0), ("fourbar", 7), ("stephenson_3", 0), ("watt_1", 0)])
def test_a_leg_walks_as_it_is_told_to(client, kind, begins):
    """The stance may begin anywhere among the points, and go on past the last of them."""
    points = np.roll(FOOT, -begins)
    first, last = -begins % 24, (11 - begins) % 24
    stated = LEG | {"points": listed(points), "stance": STANCE | {"points": [first, last]}, "mechanisms": [kind]}
    job = finished(client, stated)
    assert job["status"] == "succeeded", job
    designs = [design for design in job["result"]["designs"] if design["verification"]["passed"]]
    assert designs
    for design in designs:
        metrics = design["metrics"]
        flat, uneven = walked(design, first, last, points)
        assert flat <= 1.5
        assert flat == pytest.approx(metrics["stance_flatness"], rel=1e-3)
        assert uneven <= 0.25 + 1e-3
        assert uneven == pytest.approx(metrics["stance_speed_deviation"], abs=2e-3)
        assert {"stance_flatness", "stance_speed"} <= {check["name"] for check in design["verification"]["checks"]}
    place = f"/v1/jobs/{job['id']}/designs/0"
    root = drawn(client, place, designs[0])
    assert [e for e in root.iter() if e.get("data-curve") == "stance"]
    assert "The flattest stance lies within a band" in job["result"]["summary"]
    assert client.get(f"/v1/jobs/{job['id']}/report.html").status_code == 200


@pytest.mark.campaign
@pytest.mark.timeout(300)
def test_a_stance_is_kept_beside_other_demands(client):
    limits = {
        "min_transmission_angle": 25.0,
        "max_link_ratio": 6.0,
        "fixed_pivot_region": {"x": [-100.0, 250.0], "y": [-50.0, 200.0]},
    }
    stance = {"points": [0, 11], "flatness": 4.0, "speed": "constant", "speed_tolerance": 0.3}
    job = finished(client, LEG | {"mechanisms": ["stephenson_3"], "stance": stance, "constraints": limits})
    designs = [design for design in job["result"]["designs"] if design["verification"]["passed"]]
    assert designs
    for design in designs:
        flat, uneven = walked(design, 0, 11, FOOT)
        assert flat <= 4.0
        assert uneven <= 0.3 + 1e-3
        joints = design["mechanism"]["skeleton"]["joints"]
        assert all(-100.0 <= joints[name][0] <= 250.0 for name in ("O2", "O4", "O6"))
        assert all(-50.0 <= joints[name][1] <= 200.0 for name in ("O2", "O4", "O6"))
        lengths = design["mechanism"]["links"].values()
        assert max(lengths) <= 6.0 * min(lengths) * (1.0 + 1e-9)
        assert design["metrics"]["min_transmission_angle"] >= 25.0


@pytest.mark.campaign
def test_a_tighter_stance_is_another_leg(client):
    """Without a stance no linkage is looked at for it, and none tells of one; with half the flatness it is flatter."""
    open_stroke = {
        "kind": "path",
        "method": "least_squares",
        "mechanism": "slider_crank",
        "points": listed(FOOT[:12] + 2.0j * np.sin(np.pi * FOOT.real[:12] / 100.0)),
        "max_designs": 1,
    }
    free = finished(client, open_stroke)["result"]["designs"][0]
    assert "stance_flatness" not in free["metrics"]
    told = []
    for flatness in (1.5, 0.75):
        stated = open_stroke | {"stance": {"points": [2, 9], "flatness": flatness}}
        design = finished(client, stated)["result"]["designs"][0]
        assert design["verification"]["passed"]
        told.append(design["metrics"]["stance_flatness"])
        assert told[-1] <= flatness
    assert told[1] < told[0]


TIMED = [{"x": x, "y": x * x, "crank_angle": 30.0 * x} for x in (0.0, 1.0, 2.0)]


@pytest.mark.parametrize(
    ("stance", "more", "path"),
    [
        ({"points": [0, 24], "flatness": 1.0}, {}, "/stance/points/1"),
        ({"points": [30, 3], "flatness": 1.0}, {}, "/stance/points/0"),
        ({"points": [-1, 3], "flatness": 1.0}, {}, "/stance/points/0"),
        ({"points": [0.5, 3], "flatness": 1.0}, {}, "/stance/points/0"),
        ({"points": [0], "flatness": 1.0}, {}, "/stance/points"),
        ({"flatness": 1.0}, {}, "/stance/points"),
        ({"points": [3, 3], "flatness": 1.0}, {}, "/stance/points"),
        ({"points": [20, 3], "flatness": 1.0}, {"closed": False}, "/stance/points"),
        ({"points": [0, 2], "flatness": 1.0}, {"points": [*listed(FOOT[:2]), *listed(FOOT[:1]), *listed(FOOT[3:])]},
         "/stance/points"),
        ({"points": [0, 11]}, {}, "/stance"),
        ({"points": [0, 11], "flatness": 0.0}, {}, "/stance/flatness"),
        ({"points": [0, 11], "flatness": -1.0}, {}, "/stance/flatness"),
        ({"points": [0, 11], "flatness": 1.0, "speed": "even"}, {}, "/stance/speed"),
        ({"points": [0, 11], "flatness": 1.0, "speed_tolerance": 0.1}, {}, "/stance/speed_tolerance"),
        ({"points": [0, 11], "speed": "constant", "speed_tolerance": 0.0}, {}, "/stance/speed_tolerance"),
        ({"points": [0, 11], "flatness": 1.0, "height": 3.0}, {}, "/stance/height"),
        ({"points": [0, 5], "flatness": 1.0},
         {"method": "exact", "closed": False, "points": listed(FOOT[:6] + 1j * np.arange(6) ** 2)}, "/method"),
        ({"points": [0, 2], "flatness": 1.0},
         {"method": "auto", "closed": False, "timing": "prescribed", "points": TIMED}, "/timing"),
        (STANCE, {"placement_free": ["size"]}, "/placement_free"),
        (STANCE, {"constraints": {"in_order": False}}, "/constraints/in_order"),
    ],
)  # fmt: skip
@pytest.mark.parametrize("mechanisms", [None, ["watt_1"]])
def test_what_a_stance_cannot_be_is_refused_at_its_field(client, stance, more, path, mechanisms):
    answer = client.post("/v1/jobs", json={"problem": LEG | {"mechanisms": mechanisms} | more | {"stance": stance}})
    assert answer.status_code == 422, answer.text
    assert {error["path"] for error in answer.json()["errors"]} == {f"/problem{path}"}
