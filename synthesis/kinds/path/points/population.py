"""Starts of fourbars that descend together, as arrays."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics.arrays import Integers, Real
from synthesis.numerics.status import Status

EQUAL_COST_TOLERANCE = 1e-4
"""Relative difference below which costs belong to the same minimum."""


class Population(NamedTuple):
    """Starts that descend together.

    Unknowns have shape (k, unknowns), states (k, 3 points + limits), costs and the status of the last descent (k,).
    """

    starts: Real
    states: Real
    costs: Real
    statuses: Integers


def make_population(count: int, unknowns: int, points: int, limits: int) -> Population:
    """Return a population of zeros whose costs are not known yet."""
    return Population(
        np.zeros((count, unknowns)),
        np.zeros((count, 3 * points + limits)),
        np.full(count, np.inf),
        np.full(count, Status.STEP_LIMIT, np.int64),
    )


def join_populations(populations: list[Population]) -> Population:
    """Return all members of several populations."""
    return Population(*(np.concatenate(parts) for parts in zip(*populations, strict=True)))


def select_best(population: Population, count: int) -> Population:
    """Return copies of the best members with finite costs."""
    kept = np.argsort(population.costs, kind="stable")[:count]
    kept = kept[np.isfinite(population.costs[kept])]
    return Population._make(column[kept] for column in population)


def drop_duplicates(population: Population, count: int) -> Population:
    """Return the best members, best first, without those of equal cost, which are at the same minimum."""
    kept = np.flatnonzero(np.diff(population.costs, prepend=-1.0) > EQUAL_COST_TOLERANCE * population.costs)[:count]
    return Population._make(column[kept] for column in population)
