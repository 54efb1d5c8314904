"""How much a search of gear trains would cover, from the statement alone, and from where on it is refused."""

from __future__ import annotations

import math
from collections import Counter

import numpy as np

from synthesis.kinds.gear_train.stated_stages import GEARS, StatedStage
from synthesis.kinds.gear_train.stated_train import StatedTrain
from synthesis.model.statement import Contradiction

MOST_HALVES = 10_000_000
"""Choices of the drivers (or of the driven gears) of all stages that a search holds at most; 0.8 GB for both."""

FEW_TRAINS = 20_000_000
"""Trains that are gone through one by one, where they are no more than so many."""

MOST_COAXIAL = 3_000_000_000
"""Combinations of all stages but one that a search of coaxial trains goes through at most; a minute or two."""

MOST_FITTED = 500
"""Tooth numbers of which pairs are fitted to a range of distances; some 10⁵ pairs."""

HALVES = MOST_HALVES, "choices of drivers or driven gears"
COAXIAL = MOST_COAXIAL, "combinations of meshes"
"""What a search holds of trains whose stages have distances of their own, and what it goes through of coaxial ones."""


def beyond_search(stated: StatedTrain) -> list[Contradiction]:
    """A search that would hold or go through too much, of a train whose lists suit its stages."""
    k = stated.most_stages
    field = "/teeth" if stated.teeth is not None or not _is_given(stated) else "/stages"
    if stated.stock is not None:
        widths, field = [len(stated.stocked())] * (2 * k), "/stock"
    else:
        widths = [high - low + 1 for low, high in stated.position_ranges()]
    if stated.shares_distance and max(widths) > MOST_FITTED:
        detail = f"{max(widths)} tooth numbers are more than the {MOST_FITTED} whose pairs are fitted to a distance"
        return [Contradiction(field, f"{detail} that is left open; narrow them or state the distance")]
    covered, most, what = _extent(stated, widths)
    if covered <= most:
        return []
    detail = f"about {float(covered):.0e} {what} in {k} stages are more than the {most:.0e} that a search covers"
    return [Contradiction(field, f"{detail}; narrow the tooth numbers or allow fewer stages")]


def _extent(stated: StatedTrain, widths: list[int]) -> tuple[int, int, str]:
    """About how much a search holds or goes through, how much it may at most, and what that is.

    ``widths`` are the numbers of tooth numbers of driver and driven gear of each stage.
    """
    k = stated.most_stages
    if stated.stages is not None and not _are_alike(stated, stated.stages):
        most, what = COAXIAL if stated.reverted else HALVES
        return _of_unlike_stages(stated, widths), most, what
    if stated.reverted:
        meshes = max(widths) * len(stated.exact_modules())
        if not stated.is_fitted and stated.stages is None and not isinstance(stated.teeth, list):
            return _of_shared_distances(stated), *COAXIAL
        if not stated.is_fitted:
            return 2 * meshes * math.comb(meshes + k - 2, k - 1), *COAXIAL
        # At one distance the sums of teeth that a shift takes up; at an open one all pairs.
        meshes *= max(widths) if stated.shares_distance else _sums(stated)
        return math.comb(meshes + k - 2, k - 1), *COAXIAL
    if isinstance(stated.teeth, list):
        return max(math.prod(widths[0::2]), math.prod(widths[1::2])), *HALVES
    return math.comb(max(widths[:2]) + k - 1, k), *HALVES


def _of_shared_distances(stated: StatedTrain) -> int:
    """Choices of meshes for all stages but one, of each distance of pitch circles, where all have the same gears."""
    low, high = stated.position_ranges()[0]
    numbers = stated.stocked() if stated.stock is not None else range(low, high + 1)
    present = np.zeros(max(numbers) + 1, np.int64)
    present[list(numbers)] = 1
    meshes: Counter[int] = Counter()
    for total, pairs in enumerate(np.convolve(present, present).tolist()):
        for pitch in stated.pitches() if pairs else []:
            meshes[pitch * total] += pairs
    others = stated.most_stages - 1
    return sum(math.comb(count + others - 1, others) for count in meshes.values())


def _is_given(stated: StatedTrain) -> bool:
    """Whether the stages state all of their gears."""
    return all(stage.limits(name) is not None for stage in stated.stages or [] for name in GEARS)


def _are_alike(stated: StatedTrain, stages: list[StatedStage]) -> bool:
    """Whether gears may stand in any of the stages, so that each choice of them is met in one order only."""
    ranges = stated.position_ranges()
    own = stated.is_fitted and (stated.has_own_modules or isinstance(stated.centre_distance, list))
    return not own and len(set(ranges[0::2])) == len(set(ranges[1::2])) == len({s.likeness for s in stages}) == 1


def _of_unlike_stages(stated: StatedTrain, widths: list[int]) -> int:
    """About what a search of stages that are not alike holds or goes through: every stage's own choices."""
    modules, pairs = len(stated.exact_modules()), list(zip(widths[0::2], widths[1::2], strict=True))
    shifted = _sums(stated) if stated.is_fitted else 1
    meshes = [min(pair) * modules * shifted for pair in pairs]
    if stated.shares_distance:
        meshes = [one * two * modules for one, two in pairs]
    choices = math.prod(meshes[:-1])
    if stated.reverted:
        # Each distance has its own choices of all stages but one; it is one that every stage has.
        return choices if stated.is_fitted else choices * min(sum(pair) for pair in pairs) * modules
    halves = max(math.prod(widths[0::2]), math.prod(widths[1::2]))
    # Few fitted meshes are combined instead.
    return min(halves, MOST_HALVES) if stated.is_fitted and choices <= FEW_TRAINS else halves


def _sums(stated: StatedTrain) -> int:
    """How many sums of teeth a fitted pair may have at one distance.

    Both gears may be shifted, and a module of distance is as long as two teeth more in the sum.
    """
    low, high = stated.shift_limits
    return math.ceil(4.0 * (high - low)) + 1
