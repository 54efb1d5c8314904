"""Code that several tests share: constraints."""

from __future__ import annotations

from typing import Any

from tests.support.synthesis.quality import CASES as CASES_OF_QUALITY
from tests.support.synthesis.quality import motion, path

STEERING = {"kind": "steering", "wheelbase": 2745.0, "pivot_distance": 1220.0, "lock": 35.0}

TIMED_PATH = {
    "kind": "path",
    "timing": "prescribed",
    "points": [
        {"x": -23.0, "y": 34.0, "crank_angle": 0.0},
        {"x": -17.0, "y": 32.0, "crank_angle": 40.0},
        {"x": -7.0, "y": 40.0, "crank_angle": 80.0},
        {"x": 4.0, "y": 55.0, "crank_angle": 120.0},
        {"x": 8.0, "y": 66.0, "crank_angle": 160.0},
    ],
}

CASES: dict[str, dict[str, Any]] = {
    name: statement for name, (statement, _) in CASES_OF_QUALITY.items() if name != "path of a fourbar"
}
"""The timed path, which has a closed form, stands for the paths of fourbars: all are verified by one function."""

CASES |= {
    "path of a slider-crank": path("slider_crank", points=3),
    "path of a geared fivebar": path("geared_fivebar", points=3),
    "motion by a sixbar": motion(driver_dyad={}, max_designs=2),
    "ackermann": STEERING | {"mechanism": "ackermann"},
    "davis": STEERING | {"mechanism": "davis"},
    "timed path": TIMED_PATH,
    "fitted motion": {
        "kind": "motion",
        "method": "least_squares",
        "positions": [
            {"x": x, "y": y, "angle": angle}
            for x, y, angle in ((0, 0, 0), (12, 7, -9), (26, 12, -17), (41, 14, -27), (55, 13, -38), (75, 5, -60))
        ],
    },
    "function": {
        "kind": "function",
        "function": {"name": "exponential", "x": [0.0, 1.0]},
        "input_range": 60.0,
        "output_range": 60.0,
    },
}
