"""Intermediate results of a tooth number search: the best trains, and the minimum error of each size, compiled.

Two errors that differ by a share of less than :data:`TIE_TOLERANCE` count as a tie here; the callers sort the results
in exact arithmetic.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics.arrays import Integers, Real
from kinematics.compiling import njit
from synthesis.kinds.gear_train.search.pairing_rules import MAX_STAGES

TIE_TOLERANCE = 1e-14
"""Relative difference up to which errors count as tied in the loops: some thirty roundings."""

ERROR_NOISE = 1e-28
"""Error that a train of exactly the target's ratio can show: the target's two floats are accurate to 2⁻¹⁰⁵."""


class Shortlist(NamedTuple):
    """Intermediate results of a search, as arrays that the kernels write to.

    ``kept[0]`` trains are in ``error``, ``size``, ``teeth`` in the order of the ranking; ``least_error[s]`` belongs
    to the train ``least_teeth[s]`` of size s. Teeth are a₁...a₄ b₁...b₄ and marks₁...₄ of the stages, 0 for no stage.
    """

    kept: Integers
    error: Real
    size: Integers
    teeth: Integers
    least_error: Real
    least_teeth: Integers
    ties: Integers

    @classmethod
    def empty(cls, capacity: int, largest_size: int) -> Shortlist:
        """Create space for ``capacity`` best trains and for sizes up to ``largest_size``."""
        return cls(
            np.zeros(1, np.int64),
            np.full(capacity, np.inf),
            np.zeros(capacity, np.int64),
            np.zeros((capacity, 3 * MAX_STAGES), np.int64),
            np.full(largest_size + 1, np.inf),
            np.zeros((largest_size + 1, 3 * MAX_STAGES), np.int64),
            np.zeros(1, np.int64),
        )


@njit(cache=True, nogil=True)
def is_ranked_before(e: float, s: int, other_e: float, other_s: int, by_size: bool) -> bool:
    """Return whether a train of error e and size s ranks before another."""
    if by_size and s != other_s:
        return s < other_s
    slack = TIE_TOLERANCE * (e + other_e) + ERROR_NOISE
    if abs(e - other_e) > slack:
        return e < other_e
    return s < other_s


@njit(cache=True, nogil=True)
def is_improvement(e: float, s: int, shortlist: Shortlist, by_size: bool) -> bool:
    """Return whether a train would enter the best or improve on its size."""
    capacity, count = len(shortlist.error), shortlist.kept[0]
    if count < capacity or is_ranked_before(e, s, shortlist.error[capacity - 1], shortlist.size[capacity - 1], by_size):
        return True
    return bool(e < shortlist.least_error[s])


@njit(cache=True, nogil=True)
def enter(e: float, s: int, teeth: Integers, shortlist: Shortlist, by_size: bool) -> None:
    """Insert a train."""
    if e < shortlist.least_error[s]:
        shortlist.least_error[s] = e
        for i in range(len(teeth)):
            shortlist.least_teeth[s, i] = teeth[i]
    capacity, count = len(shortlist.error), shortlist.kept[0]
    if count == capacity and not is_ranked_before(
        e, s, shortlist.error[capacity - 1], shortlist.size[capacity - 1], by_size
    ):
        return
    # Shift worse trains down by one place; the last one drops out when the list is full.
    place = min(count, capacity - 1)
    while place > 0 and is_ranked_before(e, s, shortlist.error[place - 1], shortlist.size[place - 1], by_size):
        shortlist.error[place] = shortlist.error[place - 1]
        shortlist.size[place] = shortlist.size[place - 1]
        for i in range(len(teeth)):
            shortlist.teeth[place, i] = shortlist.teeth[place - 1, i]
        place -= 1
    shortlist.error[place], shortlist.size[place] = e, s
    for i in range(len(teeth)):
        shortlist.teeth[place, i] = teeth[i]
    shortlist.kept[0] = min(count + 1, capacity)
