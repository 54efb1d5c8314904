"""Points on the curves of random crank-rockers, with every constraint 5 % looser than the planted linkage has it.

Five to eight points, which leave freedom, and twelve, which are fitted. Answered where a design passes all checks and,
where it is fitted, comes within a hundredth of the task's size.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from benchmarks.demands.planted import around, box, crank_rocker, curve, extent, least_transmission, listed
from benchmarks.demands.task import Task
from kinematics.linkage.fourbar import OPEN, positions

POINTS = (5, 6, 7, 8, 12)
"""Points, one number after the other."""

LOOSER = 0.05
"""Share by which a limit is looser than what the planted linkage has; of a region's size for regions."""

TRANSMISSION = 20.0
"""Least transmission angle of the planted linkages, degrees."""

NEAR = 0.01
"""Greatest distance from fitted points, as a share of their extent."""


def tasks(count: int, seed: int) -> Iterator[Task]:
    """The statements."""
    rng = np.random.default_rng(seed)
    for n in range(count):
        planted = crank_rocker(rng, TRANSMISSION)
        number = POINTS[n % len(POINTS)]
        inputs = around(rng, number)
        points = curve(planted, inputs)
        o2, o4 = complex(planted.input_pivot), complex(planted.output_pivot)
        stands = positions(planted, float(inputs[0]), OPEN)
        a, b = complex(stands.a), complex(stands.b)
        lengths = [abs(o4 - o2), float(planted.input), float(planted.coupler), float(planted.output)]
        p = complex(planted.coupler_point)
        statement = {
            "kind": "path",
            "points": listed(points),
            "constraints": {
                "min_transmission_angle": (1.0 - LOOSER) * least_transmission(planted),
                "grashof": "crank_rocker",
                "full_rotation": True,
                "same_branch": True,
                "in_order": True,
                "link_length": {"min": (1.0 - LOOSER) * min(lengths), "max": (1.0 + LOOSER) * max(lengths)},
                "max_link_ratio": (1.0 + LOOSER) * max(lengths) / min(lengths),
                "fixed_pivot_region": box([o2, o4], LOOSER * abs(o4 - o2)),
                "input_pivot_region": box([o2], LOOSER * abs(o4 - o2)),
                "moving_pivot_region": box([a, b], LOOSER * abs(b - a)),
                "coupler_point": {
                    "along": [p.real - LOOSER * abs(p), p.real + LOOSER * abs(p)],
                    "across": [p.imag - LOOSER * abs(p), p.imag + LOOSER * abs(p)],
                },
            },
        }

        def answered(result: Any, most: float = NEAR * extent(points)) -> bool:
            return any(design.metrics.max_distance <= most for design in result.designs)

        yield Task(statement, answered, f"{n}: {number} points")
