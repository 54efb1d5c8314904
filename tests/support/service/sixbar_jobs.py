"""Code that several tests share: sixbar jobs."""

from __future__ import annotations

from typing import Any

FIVE = [
    {"x": 0.0, "y": 0.0, "angle": 0.0},
    {"x": 35.0, "y": 12.0, "angle": 20.0},
    {"x": 70.0, "y": 8.0, "angle": 5.0},
    {"x": 100.0, "y": -20.0, "angle": -25.0},
    {"x": 115.0, "y": -60.0, "angle": -40.0},
]
TASK: dict[str, Any] = {"kind": "motion", "positions": FIVE, "mechanisms": ["watt_1"], "max_designs": 2}
