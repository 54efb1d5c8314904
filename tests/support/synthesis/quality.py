"""Code that several tests share: quality."""

from __future__ import annotations

import math
from itertools import combinations
from typing import Any

CURVE = {
    "fixed_pivots": {"input": [0.0, 0.0], "output": [60.0, 0.0]},
    "links": {"input": 20.0, "coupler": 70.0, "output": 90.0},
    "coupler_point": {"distance": 60.0, "angle": 30.0},
}
BODY = [(0.0, 0.0, 0.0), (40.0, 15.0, -25.0), (75.0, 5.0, -60.0)]
OVAL = [(40.0, 30.0), (32.0, 42.0), (20.0, 45.0), (8.0, 40.0), (2.0, 30.0)]


def line(mechanism: str) -> dict[str, Any]:
    return {"kind": "straight_line", "length": 100.0, "mechanism": mechanism}


def returning(mechanism: str, **way: float) -> dict[str, Any]:
    return {"kind": "quick_return", "time_ratio": 1.3, "mechanism": mechanism, **way}


def motion(**fields: Any) -> dict[str, Any]:
    return {"kind": "motion", "positions": [{"x": x, "y": y, "angle": angle} for x, y, angle in BODY], **fields}


def path(mechanism: str, points: int = len(OVAL)) -> dict[str, Any]:
    places = [{"x": x, "y": y} for x, y in OVAL[:points]]
    return {"kind": "path", "points": places, "mechanism": mechanism, "rounds": 1, "max_designs": 3}


def chord_of_the_output(design: Any, links: dict[str, float]) -> float:
    """The way of the pin of an output that swings."""
    return 2.0 * links["output"] * math.sin(math.radians(0.5 * design.metrics.swing))


def span(points: list[Any]) -> float:
    return max(math.dist(p[:2], q[:2]) for p, q in combinations(points, 2))


CASES = {
    "motion by a fourbar": (motion(), lambda design, links: span(BODY)),
    "motion by a slider-crank": (motion(output_side={"dyad": "PR"}), lambda design, links: span(BODY)),
    "motion by a block": (motion(output_side={"dyad": "RP"}), lambda design, links: span(BODY)),
    "motion by a sixbar": (motion(driver_dyad={}), lambda design, links: span(BODY)),
    "path of a fourbar": (path("fourbar"), lambda design, links: span(OVAL)),
    "path of a slider-crank": (path("slider_crank"), lambda design, links: span(OVAL)),
    "path of a geared fivebar": (path("geared_fivebar"), lambda design, links: span(OVAL)),
    "function of a fourbar": (
        {"kind": "function", "pairs": [{"input": 40.0, "output": 70.0}, {"input": 45.0, "output": 76.0}]},
        lambda design, links: math.inf,
    ),
    "function of a slider-crank": (
        {
            "kind": "function",
            "mechanism": "slider_crank",
            "pairs": [{"input": x, "output": 10.0 * math.sin(x / 40.0)} for x in (0.0, 20.0, 40.0)],
        },
        lambda design, links: 10.0 * math.sin(1.0),
    ),
    "crank-rocker": (returning("fourbar", swing=60.0), chord_of_the_output),
    "drag link with a rocker": (returning("drag_link_rocker", swing=60.0), chord_of_the_output),
    "drag link with a slider": (returning("drag_link_slider", stroke=80.0), lambda design, links: 80.0),
    "offset slider-crank": (returning("offset_slider_crank", stroke=80.0), lambda design, links: 80.0),
    "crank-shaper": (returning("crank_shaper", stroke=80.0), lambda design, links: 80.0),
    "whitworth": (returning("whitworth", stroke=80.0), lambda design, links: 80.0),
    **{
        name: (line(name), lambda design, links: 100.0)
        for name in ("hoeken", "chebyshev", "watt", "roberts", "evans", "peaucellier", "hart", "scott_russell")
    },
    "dwell of a rocker": (
        {"kind": "dwell", "dwell_angle": 60.0, "output": {"type": "rocker", "swing": 90.0}, "mechanism": "pseudo_arc"},
        lambda design, links: 2.0 * links["input"],
    ),
    "dwell of a slot": (
        {
            "kind": "dwell",
            "dwell_angle": 40.0,
            "output": {"type": "rocker", "swing": 30.0},
            "mechanism": "straight_slot",
        },
        lambda design, links: 2.0 * links["input"],
    ),
    "dwell of a slider": (
        {"kind": "dwell", "dwell_angle": 60.0, "output": {"type": "slider", "stroke": 50.0}},
        lambda design, links: 50.0,
    ),
    "parallel motion": ({"kind": "parallel_motion", "linkage": CURVE}, lambda design, links: None),
}
