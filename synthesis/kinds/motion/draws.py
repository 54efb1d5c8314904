"""Random points around the body or around its positions, for what the client leaves open of a pivot.

Distances are spread evenly in logarithm, from a small part of the task's size to some multiples of it: beyond that
links get too short or too long.
"""

from __future__ import annotations

import math

import numpy as np

from synthesis.kinds.motion.task import Complex, Real

MIN_REACH, MAX_REACH = 0.05, 6.0
"""Distances between which points are drawn, in task sizes."""


def distances(rng: np.random.Generator, *shape: int) -> Real:
    """Random distances of a shape, in task sizes."""
    return np.asarray(np.exp(rng.uniform(math.log(MIN_REACH), math.log(MAX_REACH), shape)))


def points_around(centre: complex | Complex, rng: np.random.Generator, count: int) -> Complex:
    """Random points about a centre, in all directions, shape (count,)."""
    radius = distances(rng, count)
    return np.asarray(centre + radius * np.exp(1j * rng.uniform(-np.pi, np.pi, count)))
