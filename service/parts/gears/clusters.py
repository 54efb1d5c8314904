"""Sliding gears: the gears of a stage that are shifted together, and the levels along the shafts that they need.

All pairs of a stage are divided into clusters of at most two, in the order of the answer. The drivers slide and the
driven gears are fixed::

    level of the range     0    1    2    3
    fixed gears            A              B
    sliding, A in mesh     a    b
    neutral                     a    b
    sliding, B in mesh               a    b

So no sliding gear has to pass a fixed one, whatever the numbers of teeth, and one pair leaves mesh before the other
enters it. A cluster of one gear needs two levels, one in mesh and one next to it. The pair of a stage without shifting
is always in mesh and needs one level.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

LEVELS_BY_GEARS = {1: 2, 2: 4}
"""Number of levels of a cluster's range, by its number of gears."""


class Cluster(NamedTuple):
    """Gears of a stage that are shifted together.

    Attributes
    ----------
    stage : int
        Index of the stage, from 0.
    pairs : tuple of int
        Indices of its pairs in the stage, from 0: one or two.
    low : int
        Lowest level of its range.
    slides : bool
        Whether it can be shifted.
    """

    stage: int
    pairs: tuple[int, ...]
    low: int
    slides: bool

    @property
    def top(self) -> int:
        """Highest level of its range."""
        return self.low + (LEVELS_BY_GEARS[len(self.pairs)] - 1 if self.slides else 0)

    def get_fixed_level(self, place: int) -> int:
        """Return the level of the gear that meshes with its gear number ``place``, from 0."""
        return self.top if place else self.low

    def get_shift(self, engaged: int) -> int:
        """Return the number of levels above its lowest place while a pair of its stage is engaged."""
        if not self.slides:
            return 0
        # Another cluster is engaged: this one is in neutral.
        if engaged not in self.pairs:
            return 1
        # Lower gear in mesh at 0, upper gear in mesh at 2.
        return 2 * self.pairs.index(engaged)

    def get_level(self, place: int, engaged: int) -> int:
        """Return the level of its gear number ``place`` while a pair of its stage is engaged."""
        return self.low + place + self.get_shift(engaged)

    def list_levels(self, place: int) -> tuple[int, ...]:
        """Return all levels that its gear number ``place`` can occupy."""
        most = self.top - len(self.pairs) + 1 - self.low
        return tuple(self.low + place + shift for shift in range(most + 1))


def make_clusters(counts: Sequence[int]) -> tuple[Cluster, ...]:
    """Return the clusters of all stages on top of one another, from level 1.

    Parameters
    ----------
    counts : sequence of int
        Number of pairs of each stage.
    """
    found: list[Cluster] = []
    for stage, count in enumerate(counts):
        for first in range(0, count, 2):
            pairs = tuple(range(first, min(first + 2, count)))
            found.append(Cluster(stage, pairs, found[-1].top + 1 if found else 1, count > 1))
    return tuple(found)
