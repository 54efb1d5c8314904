"""Two to five positions of random crank-rockers, with every constraint 5 % looser than the planted linkage has it.

Answered where a design passes all checks.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from benchmarks.demands.planted import around, box, crank_rocker, least_transmission
from benchmarks.demands.positions import passed
from benchmarks.demands.task import Task
from kinematics.linkage.fourbar import OPEN, positions

COUNTS = (2, 3, 4, 5)
"""Positions, one number after the other."""

LOOSER = 0.05
"""Share by which a limit is looser than what the planted linkage has; of a region's size for regions."""

TRANSMISSION = 20.0
"""Least transmission angle of the planted linkages, degrees."""


def tasks(count: int, seed: int) -> Iterator[Task]:
    """The statements."""
    rng = np.random.default_rng(seed)
    for n in range(count):
        planted = crank_rocker(rng, TRANSMISSION)
        number = COUNTS[n % len(COUNTS)]
        inputs = around(rng, number)
        carried = positions(planted, inputs, OPEN)
        o2, o4 = complex(planted.input_pivot), complex(planted.output_pivot)
        a, b = complex(carried.a[0]), complex(carried.b[0])
        lengths = [abs(o4 - o2), float(planted.input), float(planted.coupler), float(planted.output)]
        statement = {
            "kind": "motion",
            "positions": [
                {"x": float(p.real), "y": float(p.imag), "angle": math.degrees(float(turn))}
                for p, turn in zip(carried.p, carried.coupler_angle, strict=True)
            ],
            "constraints": {
                "min_transmission_angle": (1.0 - LOOSER) * least_transmission(planted),
                "grashof": "crank_rocker",
                "full_rotation": True,
                "same_branch": True,
                "in_order": True,
                "link_length": {"min": (1.0 - LOOSER) * min(lengths), "max": (1.0 + LOOSER) * max(lengths)},
                "max_link_ratio": (1.0 + LOOSER) * max(lengths) / min(lengths),
                "fixed_pivot_region": box([o2, o4], LOOSER * abs(o4 - o2)),
                "moving_pivot_region": box([a, b], LOOSER * abs(b - a)),
            },
        }
        yield Task(statement, passed, f"{n}: {number} positions")
