"""Sliding gears: which gears of a stage are shifted together, and which levels along the shafts that takes.

All pairs of a stage are dealt out to clusters of two at most, in the order of the answer. The drivers slide and the
driven gears are fixed::

    level of the range     0    1    2    3
    fixed gears            A              B
    sliding, A in mesh     a    b
    neutral                     a    b
    sliding, B in mesh               a    b

So no sliding gear passes a fixed one, whatever their teeth, and one pair is out before the other is in. A cluster of
one gear takes two levels, in mesh and beside. The pair of a fixed stage is always in mesh and takes one.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

PLACES = {1: 2, 2: 4}
"""Levels of the range of a cluster of so many gears."""


class Cluster(NamedTuple):
    """Gears of a stage that are shifted together.

    Attributes
    ----------
    stage : int
        From 0.
    pairs : tuple of int
        Numbers of its pairs in the stage, from 0: one or two.
    low : int
        The lowest level of its range.
    slides : bool
        Whether it is shifted at all.
    """

    stage: int
    pairs: tuple[int, ...]
    low: int
    slides: bool

    @property
    def top(self) -> int:
        """The highest level of its range."""
        return self.low + (PLACES[len(self.pairs)] - 1 if self.slides else 0)

    def fixed(self, place: int) -> int:
        """The level of the gear that its gear number ``place``, from 0, meshes with."""
        return self.top if place else self.low

    def shift(self, engaged: int) -> int:
        """How many levels it stands above its lowest place where a pair of its stage is engaged."""
        if not self.slides:
            return 0
        if engaged not in self.pairs:
            return 1
        return 2 * self.pairs.index(engaged)

    def at(self, place: int, engaged: int) -> int:
        """The level of its gear number ``place`` where a pair of its stage is engaged."""
        return self.low + place + self.shift(engaged)

    def visited(self, place: int) -> tuple[int, ...]:
        """All levels that its gear number ``place`` comes to."""
        most = self.top - len(self.pairs) + 1 - self.low
        return tuple(self.low + place + shift for shift in range(most + 1))


def clusters(counts: Sequence[int]) -> tuple[Cluster, ...]:
    """The clusters of all stages over one another, from level 1 on.

    Parameters
    ----------
    counts : sequence of int
        Pairs of each stage.
    """
    found: list[Cluster] = []
    for stage, count in enumerate(counts):
        for first in range(0, count, 2):
            pairs = tuple(range(first, min(first + 2, count)))
            found.append(Cluster(stage, pairs, found[-1].top + 1 if found else 1, count > 1))
    return tuple(found)
