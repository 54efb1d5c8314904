"""Curves drawn by hand, that no linkage draws exactly: a square, a heart, a foot, a D and an S.

Answered where the first design can be built, with a transmission angle of 20° and more, and draws the curve with an rms
distance of at most a twentieth of its size.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from tests.support.demands.planted import extent, listed
from tests.support.demands.task import Task

CURVES = {
    "square": [(0, 0), (12, -1), (25, 0), (38, 1), (50, 0), (51, 13), (50, 25), (49, 38), (50, 50), (37, 51), (25, 50),
               (12, 49), (0, 50), (-1, 37), (0, 25), (1, 12)],
    "heart": [(0, 24), (6, 32), (15, 37), (25, 36), (33, 30), (36, 20), (33, 9), (26, -2), (17, -13), (8, -22),
              (0, -31), (-8, -23), (-18, -13), (-27, -3), (-33, 8), (-36, 20), (-33, 30), (-25, 37), (-15, 37),
              (-6, 31)],
    "foot": [(0, 0), (14, -1), (29, 0), (44, 0), (58, -1), (72, 1), (80, 7), (79, 16), (70, 24), (57, 31), (43, 36),
             (28, 38), (14, 35), (3, 27), (-4, 17), (-5, 7)],
    "D": [(0, 0), (0, 12), (1, 25), (0, 38), (0, 50), (0, 62), (10, 61), (21, 57), (31, 49), (36, 38), (37, 27),
          (33, 15), (24, 6), (12, 1)],
    "S": [(34, 52), (27, 58), (18, 60), (8, 57), (3, 49), (5, 40), (13, 34), (22, 30), (31, 25), (36, 17), (33, 8),
          (25, 2), (15, 0), (5, 3), (0, 10)],
}  # fmt: skip
"""Points in the order in which they were drawn."""

OPEN = ("S",)
"""Strokes; the others are closed."""

NEAR, TRANSMISSION = 0.05, 20.0
"""Greatest rms distance as a share of the size, and least transmission angle, degrees."""


def tasks(count: int, seed: int) -> Iterator[Task]:
    """The statements: each curve once, ``count`` at most."""
    for name, corners in list(CURVES.items())[:count]:
        places = np.array([complex(x, y) for x, y in corners])
        statement = {
            "kind": "path",
            "method": "curve_match",
            "closed": name not in OPEN,
            "points": listed(places),
            "seed": seed,
        }

        def answered(result: Any, most: float = NEAR * extent(places)) -> bool:
            best = result.designs[0].metrics if result.designs else None
            return best is not None and best.min_transmission_angle >= TRANSMISSION and best.rms_distance <= most

        yield Task(statement, answered, name)
