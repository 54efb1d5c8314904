"""Three and four positions with tolerances and zones around a planted linkage.

A random crank-rocker carries a body through the positions. What is stated of a position is off by as much as its
tolerance; some are exact. Fixed and moving pivots have zones around the planted ones. Answered where a design passes.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from kinematics.linkage.fourbar import OPEN_ASSEMBLY, positions
from tests.support.demands.planted import around_pivots, crank_rocker, extent, pivots
from tests.support.demands.task import Task, passed

COUNTS = (3, 4)
"""Positions, one number after the other."""

TRANSMISSION = 25.0
"""Least transmission angle of the planted linkages, degrees."""

LENGTH, ANGLE = (0.02, 0.06), (2.0, 8.0)
"""Tolerances: shares of the extent of the positions, and degrees."""

EXACT = 0.25
"""Share of the positions that are exact."""

ZONE = 0.15
"""Margin of the zones, as a share of the distance between the two pivots."""


def tasks(count: int, seed: int) -> Iterator[Task]:
    """The statements."""
    rng = np.random.default_rng(seed)
    for n in range(count):
        planted = crank_rocker(rng, TRANSMISSION)
        number = COUNTS[n % len(COUNTS)]
        inputs = rng.uniform(0.0, math.tau) + np.cumsum(rng.uniform(0.3, 1.0, number))
        carried = positions(planted, inputs, OPEN_ASSEMBLY)
        fixed, moving = pivots(planted, float(inputs[0]))
        size = extent(np.asarray(carried.p))
        exact = rng.uniform(size=number) < EXACT
        if exact.all():
            exact[-1] = False
        poses: list[dict[str, Any]] = []
        for p, turn, held in zip(carried.p, carried.coupler_angle, exact, strict=True):
            off = rng.uniform(-1.0, 1.0, 3)
            width, angle = rng.uniform(*LENGTH) * size, rng.uniform(*ANGLE)
            stated = np.array([p.real, p.imag, math.degrees(turn)])
            tolerance = {"x": width, "y": width, "angle": angle}
            if not held:
                stated += off * [width, width, angle]
            x, y, degrees = (float(value) for value in stated)
            poses.append({"x": x, "y": y, "angle": degrees} | ({} if held else {"tolerance": tolerance}))
        statement = {
            "kind": "motion",
            "positions": poses,
            "constraints": {
                "fixed_pivot_region": around_pivots(fixed, ZONE),
                "moving_pivot_region": around_pivots(moving, ZONE),
            },
        }
        yield Task(statement, passed, f"{n}: {number} positions")
