"""Starts of the continuation: all solutions of a path problem for one set of general complex parameters, as stored.

``tools/path_starts.py`` regenerates the files.
"""

from __future__ import annotations

from functools import cache
from importlib import resources
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex


class StoredStart(NamedTuple):
    """A stored start: solutions, shape (solutions, unknowns), for parameters of shape (parameters,)."""

    y: Complex
    p: Complex


@cache
def load_nine_point_start() -> StoredStart:
    """Load the start for nine points: one solution of each orbit, shape (1442, 16), for parameters of shape (16,)."""
    return _load_start("nine_point_start.npz")


@cache
def load_five_point_start() -> StoredStart:
    """Load the start for five points on given pivots: the solutions, shape (36, 8), for parameters of shape (12,)."""
    return _load_start("five_point_start.npz")


def _load_start(name: str) -> StoredStart:
    """Read solutions and parameters from a file of this package."""
    with resources.files(__package__).joinpath(name).open("rb") as opened, np.load(opened) as arrays:
        return StoredStart(arrays["y"], arrays["p"])
