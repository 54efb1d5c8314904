"""What comes nearest, through HTTP: zones of a driver's pivot that are out of reach."""

import math

import pytest

from tests.campaign import further
from tests.support.service.answers import finished

THREE = [{"x": 0, "y": 0, "angle": 0}, {"x": 40, "y": 15, "angle": -25}, {"x": 75, "y": 5, "angle": -60}]
TOLERATED = [THREE[0], *({**position, "tolerance": {"x": 2.0, "y": 2.0, "angle": 2.0}} for position in THREE[1:])]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("positions", "link"),
    further(
        [(positions, link) for positions in (THREE, TOLERATED) for link in ("any", "output", "coupler")],
        [(THREE, "output")],
    ),
)
def test_a_zone_of_the_drivers_pivot_out_of_reach_is_told_with_what_comes_nearest(client, positions, link):
    zone = {"x": [2000, 2010], "y": [-1500, -1490]}
    problem = {"kind": "motion", "positions": positions, "driver_dyad": {"link": link, "pivot_region": zone}}
    result = finished(client, problem)["result"]
    assert result["designs"] == []
    miss = result["nearest_miss"]
    (gap,) = miss["gaps"]
    x, y = miss["design"]["mechanism"]["skeleton"]["joints"]["O6"]
    outside = math.hypot(max(2000 - x, 0, x - 2010), max(-1500 - y, 0, y + 1490))
    assert (gap["check"], gap["limit"], gap["dimension"]) == ("driver_pivot_region", 0.0, "length")
    assert gap["value"] == pytest.approx(outside, rel=1e-12)
    assert [check["name"] for check in miss["design"]["verification"]["checks"] if not check["passed"]] == [
        gap["check"]
    ]
