"""Closed curves of random crank-rockers with 1 % noise, a transmission limit and pivot zones about the planted linkage.

Answered where the best design's greatest deviation is at most 1.2 times that of the planted linkage.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from kinematics.linkage.fourbar import OPEN_ASSEMBLY, positions
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.verification.fourbar import verify_path
from synthesis.model.linkage.conversion import FourbarConfiguration, build_fourbar
from synthesis.registry import parse_problem
from tests.support.demands.planted import box, crank_rocker, curve, extent, least_transmission, listed
from tests.support.demands.task import Task

POINTS, NOISE = 64, 0.01
"""Samples at equal steps of the crank, and the root mean square of their noise as a share of the curve's size."""

BELOW = 2.0
"""The transmission limit is so many degrees below what the planted linkage has."""

ZONE = 0.1
"""Margin of the zones about the planted pivots, as a share of the curve's size."""

ALLOWED = 1.2
"""Greatest deviation that counts as an answer, over that of the planted linkage."""


def tasks(count: int, seed: int) -> Iterator[Task]:
    """The statements."""
    rng = np.random.default_rng(seed)
    for n in range(count):
        planted = crank_rocker(rng)
        exact = curve(planted, np.linspace(0.0, math.tau, POINTS, endpoint=False))
        size = extent(exact)
        noise = NOISE * size * math.sqrt(0.5) * (rng.normal(size=POINTS) + 1j * rng.normal(size=POINTS))
        o2, o4 = complex(planted.input_pivot), complex(planted.output_pivot)
        statement = {
            "kind": "path",
            "method": "curve_match",
            "closed": True,
            "points": listed(exact + noise),
            "constraints": {
                "min_transmission_angle": max(0.0, least_transmission(planted) - BELOW),
                "input_pivot_region": box([o2], ZONE * size),
                "fixed_pivot_region": box([o2, o4], ZONE * size),
            },
        }
        stands = positions(planted, 0.0, OPEN_ASSEMBLY)
        joints = FourbarConfiguration(o2, complex(stands.a), complex(stands.b), o4, complex(stands.p))
        problem = parse_problem(statement)
        assert isinstance(problem, PathProblem)
        own = verify_path(problem, build_fourbar(joints))
        assert own is not None
        assert own.verification.passed, own.verification

        def answered(result: Any, most: float = ALLOWED * own.metrics.max_distance) -> bool:
            return any(design.metrics.max_distance <= most for design in result.designs)

        yield Task(statement, answered, f"curve {n}")
