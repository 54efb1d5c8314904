"""Sixbars that approximate given pairs: a search that meets pairs to rounding if that is possible.

The least-squares function of pairs has many minima, and most minima close to zero are not zero. They can be
distinguished only near the end of the descents, and few starts lead to the best minimum. Therefore many starts are
followed, at a subset of the pairs as long as that suffices to select:

1. All starts descend a few steps at nine of the pairs.
2. The best distinct ones are followed along their valleys (:mod:`synthesis.numerics.geodesic`) at fifteen pairs, and
   the best of these farther.
3. The remaining ones are followed until convergence at all pairs and limits.
4. If none meets the pairs to rounding, the best are perturbed along the directions in which the residuals change least,
   and followed again (basin hopping, Wales & Doye 1997, doi:10.1021/jp970984n).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Real
from kinematics.message import compose
from synthesis.kinds.function.sixbar.descents import Descents, SixbarCandidate, select_best, select_best_starts
from synthesis.kinds.function.sixbar.starts import Starts
from synthesis.kinds.function.statement.mechanism_types import Sixbar
from synthesis.model.kind import Progress


class Effort(NamedTuple):
    """Effort for one type: number of sampled sixbars; numbers of sixbars and steps along valleys at few pairs, in two
    stages; numbers of sixbars and steps at all pairs; and number of random perturbations."""

    drawn: int
    followed: tuple[int, int]
    followed_farther: tuple[int, int]
    followed_to_the_end: tuple[int, int]
    moves: int


FULL_EFFORT = Effort(60_000, (1000, 100), (150, 500), (16, 2000), 60)

EFFORTS: dict[Sixbar, Effort] = {
    "watt_2": FULL_EFFORT,
    "stephenson_3": FULL_EFFORT,
    "stephenson_2": Effort(60_000, (400, 100), (60, 500), (12, 2000), 20),
}
"""Effort by type. A Stephenson II, whose configuration must be solved iteratively, takes three times as long."""

FIRST_PAIR_COUNT, VALLEY_PAIR_COUNT = 9, 15
"""Numbers of pairs in the first descents, and in the first valleys."""

MAX_FIRST_STEPS, FIRST_TOLERANCE, FIRST_WEIGHT, LIMIT_WEIGHT = 15, 1e-5, 0.1, 1.0
"""First descents: maximum number of steps, relative decrease at which a descent ends, and weight of limits. The last
value is the weight of limits in later descents."""

SELECTION_PROBABILITY = 0.35
"""Probability that the best known sixbar is perturbed. Otherwise the next one is chosen with the same probability, and
so on."""

MAX_MOVE_STEPS, MAX_DIRECTIONS, MAX_CHANGE = 400, 5, 0.6
"""Perturbation: steps along the valley after it, maximum number of directions, and maximum change of an unknown."""


def select_pairs(points: Real, count: int) -> Real:
    """Select ``count`` evenly spread pairs from the points, with limits only there.

    ``points`` (4, m) as for :func:`~synthesis.kinds.function.sixbar.residuals.evaluate_rows`.
    """
    # Positive weights mark pairs; the other points only carry limits.
    pairs = np.flatnonzero(points[2] > 0.0)
    picked = pairs[np.unique(np.round(np.linspace(0, len(pairs) - 1, count)).astype(int))]
    few = np.ascontiguousarray(points[:, picked])
    # Weights that make the sum of squares the mean square.
    few[2:] = 1.0 / math.sqrt(len(picked))
    return few


class PairSearch:
    """Search for sixbars that meet the pairs of one task.

    Parameters
    ----------
    points : float, shape (4, m)
        As for :func:`~synthesis.kinds.function.sixbar.residuals.evaluate_rows`.
    least : float
        Minimum transmission angle, degrees.
    ratio : float, optional
        Maximum link ratio.
    met : float
        RMS error, radians, that counts as rounding and ends the search.
    """

    def __init__(self, points: Real, least: float, ratio: float | None, met: float) -> None:
        self._first, self._few, self._all = (
            Descents(places, least, ratio)
            for places in (select_pairs(points, FIRST_PAIR_COUNT), select_pairs(points, VALLEY_PAIR_COUNT), points)
        )
        self._met = met

    def find_sixbars(
        self, name: Sixbar, starts: Starts, most: int, rng: np.random.Generator, progress: Progress
    ) -> list[SixbarCandidate]:
        """Find the best sixbars from starts of a type, at most ``most``."""
        effort = EFFORTS[name]
        begun = self._first.descend_all(name, starts, FIRST_WEIGHT, MAX_FIRST_STEPS, FIRST_TOLERANCE)
        progress(0.3, compose("function-following-sixbars", count=len(starts.at), type=name))
        found = select_best_starts(name, *begun, effort.followed[0])
        # Two stages at few pairs preserve the ranking better than a direct step to all pairs.
        for descents, (_, steps), (kept, _) in (
            (self._few, effort.followed, effort.followed_farther),
            (self._few, effort.followed_farther, effort.followed_to_the_end),
            (self._all, effort.followed_to_the_end, (most, 0)),
        ):
            found = select_best([descents.follow_from(one, LIMIT_WEIGHT, steps) for one in found], kept)
        progress(0.7, compose("function-improving-sixbars", count=len(starts.at), type=name))
        return self._run_perturbations(found, effort.moves, most, rng)

    def _run_perturbations(
        self, found: list[SixbarCandidate], moves: int, most: int, rng: np.random.Generator
    ) -> list[SixbarCandidate]:
        """Improve sixbars by random perturbations until the pairs are met."""
        for _ in range(moves):
            if not found or found[0].error < self._met:
                break
            # Geometric choice: mostly the best, sometimes another to leave its basin.
            place = min(int(rng.geometric(SELECTION_PROBABILITY)), len(found)) - 1
            moved = self._all.perturb_and_follow(
                found[place], LIMIT_WEIGHT, MAX_MOVE_STEPS, MAX_DIRECTIONS, MAX_CHANGE, rng
            )
            # A perturbed sixbar joins the others only if it is distinct or better.
            found = select_best([*found, moved], most) if moved is not None else found
        return found
