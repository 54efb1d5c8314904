"""Two to five positions of random crank-rockers, with every constraint 5 % looser than the planted linkage has it.

Answered where a design passes all checks.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from kinematics.linkage.fourbar import OPEN_ASSEMBLY, positions
from tests.support.demands.planted import around, crank_rocker, least_transmission, lengths, looser, pivots
from tests.support.demands.task import Task, passed

COUNTS = (2, 3, 4, 5)
"""Positions, one number after the other."""

TRANSMISSION = 20.0
"""Least transmission angle of the planted linkages, degrees."""


def tasks(count: int, seed: int) -> Iterator[Task]:
    """The statements."""
    rng = np.random.default_rng(seed)
    for n in range(count):
        planted = crank_rocker(rng, TRANSMISSION)
        number = COUNTS[n % len(COUNTS)]
        inputs = around(rng, number)
        carried = positions(planted, inputs, OPEN_ASSEMBLY)
        statement = {
            "kind": "motion",
            "positions": [
                {"x": float(p.real), "y": float(p.imag), "angle": math.degrees(float(turn))}
                for p, turn in zip(carried.p, carried.coupler_angle, strict=True)
            ],
            "constraints": looser(
                lengths(planted),
                *pivots(planted, float(inputs[0])),
                transmission=least_transmission(planted),
                grashof="crank_rocker",
            ),
        }
        yield Task(statement, passed, f"{n}: {number} positions")
