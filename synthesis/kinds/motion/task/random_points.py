"""Random points around the body or its positions, for open coordinates of pivots.

Distances are log-uniform, from a small part of the task's size to a few times that size: outside this range links
become too short or too long.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Complex, Real

MIN_REACH, MAX_REACH = 0.05, 6.0
"""Range of the sampled distances, in task sizes."""


def sample_distances(rng: np.random.Generator, *shape: int) -> Real:
    """Sample random distances of a given shape, in task sizes."""
    return np.asarray(np.exp(rng.uniform(math.log(MIN_REACH), math.log(MAX_REACH), shape)))


def sample_points_around(centre: complex | Complex, rng: np.random.Generator, count: int) -> Complex:
    """Sample random points about a centre, uniform in direction, shape (count,)."""
    radius = sample_distances(rng, count)
    return np.asarray(centre + radius * np.exp(1j * rng.uniform(-np.pi, np.pi, count)))
