"""Sixbars towards stated pairs: what may be met to rounding is not left at a nearby minimum.

The least squares of pairs have many minima, and most of those that are nearly zero are not zero. What tells them apart
is seen only where the descents have nearly ended, and few starts lead to the least. So many are followed, at few of the
pairs as long as that is enough to choose:

1. All starts descend some steps at nine of the pairs.
2. The best that differ are followed along their valleys (:mod:`synthesis.numerics.geodesic`) at fifteen pairs, and the
   best of these farther.
3. The last ones are followed to their end at all pairs and limits.
4. Where none has arrived at rounding, the best are moved by chance along the directions in which the residuals change
   least, and followed again, each beside what was known (basin hopping, Wales & Doye 1997, doi:10.1021/jp970984n).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.kinds.function.sixbar_descents import Descents, Found, best, best_starts
from synthesis.kinds.function.sixbar_starts import Starts
from synthesis.kinds.function.stated_mechanisms import Sixbar
from synthesis.model.kind import Progress

Real = NDArray[np.float64]


class Effort(NamedTuple):
    """Of a type: how many sixbars are drawn; how many go along valleys at few pairs, and for how many steps, and so
    again; how many are followed to the end, and for how many steps; and how many moves by chance there are."""

    drawn: int
    followed: tuple[int, int]
    followed_farther: tuple[int, int]
    followed_to_the_end: tuple[int, int]
    moves: int


MUCH = Effort(60_000, (1000, 100), (150, 500), (16, 2000), 60)

EFFORTS: dict[Sixbar, Effort] = {
    "watt_2": MUCH,
    "stephenson_3": MUCH,
    "stephenson_2": Effort(60_000, (400, 100), (60, 500), (12, 2000), 20),
}
"""A Stephenson II, whose place is a root, takes three times as long as the others."""

FIRST_PLACES, PLACES = 9, 15
"""Pairs of the first descents, and of the valleys by which it is chosen."""

FIRST_STEPS, FIRST_TOLERANCE, FIRST_WEIGHT, WEIGHT = 15, 1e-5, 0.1, 1.0
"""Of the first descents: steps, the relative decrease at which one ends, and how much limits weigh; and later."""

LIKELY = 0.35
"""Chance that the best of those that are known is moved, and if not, that the next one is, and so on."""

MOVED_STEPS, FLATTEST, FARTHEST = 400, 5, 0.6
"""Of a move: steps along the valley after it, directions that are taken at most, and the greatest change."""


def few_of(points: Real, count: int) -> Real:
    """So many of the places that are pairs, spread evenly, with limits there alone.

    ``points`` (4, m) as :func:`~synthesis.kinds.function.sixbar_rows.rows` takes them.
    """
    pairs = np.flatnonzero(points[2] > 0.0)
    picked = pairs[np.unique(np.round(np.linspace(0, len(pairs) - 1, count)).astype(int))]
    few = np.ascontiguousarray(points[:, picked])
    few[2:] = 1.0 / math.sqrt(len(picked))
    return few


class PairSearch:
    """A search for sixbars that meet the pairs of one task.

    Parameters
    ----------
    points : float, shape (4, m)
        As :func:`~synthesis.kinds.function.sixbar_rows.rows` takes them.
    least : float
        Transmission angle, degrees, that is aimed at.
    ratio : float, optional
        Greatest link ratio.
    met : float
        Root mean square error, radians, that is rounding: nothing is left to improve.
    """

    def __init__(self, points: Real, least: float, ratio: float | None, met: float) -> None:
        self._first, self._few, self._all = (
            Descents(places, least, ratio) for places in (few_of(points, FIRST_PLACES), few_of(points, PLACES), points)
        )
        self._met = met

    def arrived(
        self, name: Sixbar, starts: Starts, most: int, rng: np.random.Generator, progress: Progress
    ) -> list[Found]:
        """The best sixbars that starts of a type lead to, so many at most."""
        effort = EFFORTS[name]
        begun = self._first.descended_each(name, starts, FIRST_WEIGHT, FIRST_STEPS, FIRST_TOLERANCE)
        progress(0.3, f"following the best of {len(starts.at)} sixbars of type {name}")
        found = best_starts(name, *begun, effort.followed[0])
        # What is followed at few pairs and then again keeps its order better than what is followed at all at once.
        for descents, (_, steps), (kept, _) in (
            (self._few, effort.followed, effort.followed_farther),
            (self._few, effort.followed_farther, effort.followed_to_the_end),
            (self._all, effort.followed_to_the_end, (most, 0)),
        ):
            found = best([descents.along(one, WEIGHT, steps) for one in found], kept)
        progress(0.7, f"improving the best of {len(starts.at)} sixbars of type {name}")
        return self._moved(found, effort.moves, most, rng)

    def _moved(self, found: list[Found], moves: int, most: int, rng: np.random.Generator) -> list[Found]:
        """Some, and what moves of them by chance have led to, until the pairs are met."""
        for _ in range(moves):
            if not found or found[0].error < self._met:
                break
            place = min(int(rng.geometric(LIKELY)), len(found)) - 1
            moved = self._all.moved(found[place], WEIGHT, MOVED_STEPS, FLATTEST, FARTHEST, rng)
            found = best([*found, moved], most) if moved is not None else found
        return found
