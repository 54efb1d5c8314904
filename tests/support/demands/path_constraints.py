"""Points on the curves of random crank-rockers, with every constraint 5 % looser than the planted linkage has it.

Five to eight points, which leave freedom, and twelve, which are fitted. Answered where a design passes all checks and,
where it is fitted, comes within a hundredth of the task's size.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from tests.support.demands.planted import (
    LOOSER,
    around,
    box,
    crank_rocker,
    curve,
    extent,
    least_transmission,
    lengths,
    listed,
    looser,
    pivots,
)
from tests.support.demands.task import Task

POINTS = (5, 6, 7, 8, 12)
"""Points, one number after the other."""

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
        fixed, moving = pivots(planted, float(inputs[0]))
        loose = looser(
            lengths(planted), fixed, moving, transmission=least_transmission(planted), grashof="crank_rocker"
        )
        p = complex(planted.coupler_point)
        statement = {
            "kind": "path",
            "points": listed(points),
            "constraints": {
                **loose,
                "input_pivot_region": box(fixed[:1], LOOSER * abs(fixed[1] - fixed[0])),
                "coupler_point": {
                    "along": [p.real - LOOSER * abs(p), p.real + LOOSER * abs(p)],
                    "across": [p.imag - LOOSER * abs(p), p.imag + LOOSER * abs(p)],
                },
            },
        }

        def answered(result: Any, most: float = NEAR * extent(points)) -> bool:
            return any(design.metrics.max_distance <= most for design in result.designs)

        yield Task(statement, answered, f"{n}: {number} points")
