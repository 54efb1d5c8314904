"""Code that several tests share: drawn poses."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np

Statement = dict[str, Any]

LID: list[Statement] = [
    {"x": 0.0, "y": 0.0, "angle": 0.0},
    {"x": 230.0, "y": 240.0, "angle": 40.0, "tolerance": {"x": 40.0, "y": 40.0, "angle": 15.0}},
    {"x": 190.0, "y": 470.0, "angle": 85.0, "tolerance": {"x": 30.0, "y": 30.0, "angle": 3.0}},
]
ZONES = {
    "fixed_pivot_region": {"x": [-250.0, -30.0], "y": [120.0, 290.0]},
    "moving_pivot_region": {"x": [-60.0, -10.0], "y": [-280.0, 280.0]},
}
"""Wide enough for no linkage that meets the three positions of the lid exactly."""


def planted_slider(seed: int) -> Statement:
    """Three positions of a slider-crank, two of them off by up to their tolerances, with zones around its pivots."""
    rng = np.random.default_rng(seed)
    crank, rod = rng.uniform(20.0, 40.0), rng.uniform(70.0, 120.0)
    point = complex(rng.uniform(-20.0, 60.0), rng.uniform(-60.0, 60.0))
    poses, pins = [], []
    for k, angle in enumerate(rng.uniform(0.0, math.tau) + np.array([0.0, 0.7, 1.5])):
        a = cmath.rect(crank, float(angle))
        b = complex(a.real + math.sqrt(rod**2 - a.imag**2), 0.0)
        spin = (b - a) / rod
        p = a + spin * point
        off = rng.uniform(-1.0, 1.0, 3) * (k > 0)
        turned = math.degrees(cmath.phase(spin))
        pose: Statement = {"x": p.real + 3.0 * off[0], "y": p.imag + 3.0 * off[1], "angle": turned + 4.0 * off[2]}
        poses.append(pose | ({"tolerance": {"x": 3.0, "y": 3.0, "angle": 4.0}} if k else {}))
        pins.append((a, b))
    (a, b), margin = pins[0], 12.0
    return {
        "kind": "motion",
        "positions": poses,
        "output_side": {"dyad": "PR"},
        "constraints": {
            "fixed_pivot_region": {"x": [-margin, margin], "y": [-margin, margin]},
            "moving_pivot_region": {
                "x": [min(a.real, b.real) - margin, max(a.real, b.real) + margin],
                "y": [min(a.imag, b.imag) - margin, max(a.imag, b.imag) + margin],
            },
        },
    }
