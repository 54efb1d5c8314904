"""Selection of planetary trains by their efficiency, from the trains within the tolerance.

Trains of the same ratio can differ much in efficiency, because their meshes may roll with a multiple of the input
power. The search ranks trains without regard to it, so that the nearest ones are judged afterwards. If all trains
within the tolerance were judged, no other is better.
"""

from __future__ import annotations

from typing import NamedTuple

from kinematics.gear.arrangements import ARRANGEMENTS
from synthesis.kinds.planetary_train.nearest import Candidate
from synthesis.kinds.planetary_train.power_capacity import MAX_JUDGED, TrainListing
from synthesis.kinds.planetary_train.problem import PlanetaryProblem
from synthesis.kinds.planetary_train.verification import solve_efficiency


class EfficientTrains(NamedTuple):
    """Result of judging the trains of a search by efficiency.

    ``best`` are the trains with the required efficiency, in the requested order. ``failed`` of the ``judged`` trains
    lack it, and ``greatest`` is the greatest efficiency of all. ``every`` is true if these are all trains within the
    tolerance, ``proven`` if no train is better than ``best``.
    """

    best: list[Candidate]
    failed: int
    greatest: float
    judged: int
    every: bool
    proven: bool


def find_efficient_trains(problem: PlanetaryProblem, listing: TrainListing) -> EfficientTrains:
    """Find the best trains of a listing with the required efficiency."""
    listed = listing.list_nearest()
    every, by_size = len(listed) < MAX_JUDGED, problem.rank_by == "size"
    if by_size:
        listed = sorted(listed, key=lambda one: (one.size, one)) if every else listing.list_smallest()[0]
    efficiencies = [
        solve_efficiency(problem, ARRANGEMENTS[one.arrangement], dict(one.teeth), one.roles) for one in listed
    ]
    least = problem.min_efficiency or 0.0
    rated = [(one, value) for one, value in zip(listed, efficiencies, strict=True) if value >= least]
    failed = len(listed) - len(rated)
    if problem.rank_by == "efficiency":
        rated.sort(key=lambda pair: (-pair[1], pair[0]))
    kept = [one for one, _ in rated]
    if by_size:
        # One train, the nearest, for each size.
        kept = [one for k, one in enumerate(kept) if k == 0 or one.size != kept[k - 1].size]
    best = kept[: problem.max_designs]
    # In the order of the listing the first trains are the best, even if others were not judged.
    proven = every or (problem.rank_by != "efficiency" and len(best) == problem.max_designs)
    return EfficientTrains(best, failed, max(efficiencies, default=0.0), len(listed), every, proven)
